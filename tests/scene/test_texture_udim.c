/* test_texture_udim.c: pictures in tiles: names that would stand for tiles of tiles are errors.
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(two_tokens_are_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
