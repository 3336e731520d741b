/* test_texture_udim.c: pictures in tiles: names that would stand for tiles of tiles are errors; alpha is that of all
 * tiles together.
 * Flow: tests of scene/texture/texture_udim.c, texture_image_load.c. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/texture_fixture.h"
#include "texture/texture_udim.h"

static const float GRAY[3] = {.5f, .5f, .5f};

static void two_tokens_are_an_error(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"t<UDIM><UDIM>.exr", "t<udim>_<UVTILE>.exr"};
    write_image("t1001<UDIM>.exr", 1, 1, 3, IMAGE_FLOAT, GRAY);
    write_image("t1001_<UVTILE>.exr", 1, 1, 3, IMAGE_FLOAT, GRAY);
    for (int k = 0; k < 4; k++) {
        char world[256];
        snprintf(world, sizeof world, "Texture \"t\" \"%s\" \"imagemap\" \"string filename\" \"%s\"",
                 k % 2 ? "float" : "spectrum", NAMES[k / 2]);
        reading r = read_world(world);
        assert_int_equal(r.status, AG_ERROR_INPUT);
        assert_non_null(strstr(r.said[AG_LOG_ERROR], "it holds more than one of <UDIM> and <UVTILE>"));
        reading_destroy(&r);
    }
    assert_false(texture_udim_is_ambiguous("<UDIM>/t<UDIM>.exr"));
    assert_false(texture_udim_is_ambiguous("t.exr"));
}

static const texture_image *whole_of(const reading *r)
{
    return r->scene->textures.images[r->scene->textures.items[r->scene->textures.count - 1].image_index];
}

/* Where any tile has alpha, numbers are read from alpha on all tiles; a tile without it counts as 1. */
static void alpha_of_one_tile_is_that_of_all(void **state)
{
    (void)state;
    static const float CUT[4] = {.5f, .5f, .5f, .25f};
    static const char WORLD[] = "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"t<UDIM>.exr\"";
    write_image("t1001.exr", 1, 1, 3, IMAGE_FLOAT, GRAY);
    write_image("t1002.exr", 1, 1, 3, IMAGE_FLOAT, GRAY);
    reading r = good_world(WORLD);
    assert_false(texture_image_has_alpha(whole_of(&r)));
    assert_near(last_float(&r, hit_at(.5f, .5f, 0, 0, 0)), .5, 1e-6);
    reading_destroy(&r);
    write_image("t1002.exr", 1, 1, 4, IMAGE_FLOAT, CUT);
    r = good_world(WORLD);
    assert_true(texture_image_has_alpha(whole_of(&r)));
    assert_near(last_float(&r, hit_at(.5f, .5f, 0, 0, 0)), 1, 1e-6);
    assert_near(last_float(&r, hit_at(1.5f, .5f, 0, 0, 0)), .25, 1e-6);
    assert_near(last_float(&r, hit_at(5.5f, .5f, 0, 0, 0)), 0, 0);
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(two_tokens_are_an_error),
        TEST_IN_FOLDER(alpha_of_one_tile_is_that_of_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
