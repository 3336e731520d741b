/* test_clear_spaces.c: any number of threads that ask for the same spaces at once get what one alone would find; a map
 * goes without them where they are of no use, or memory is short.
 * Threads: eight, more than there are processors. */
#include "photon_map.h"

#include "fixtures/test_scene.h"

enum { BLOCKS = 4096 / FEWER, WORKERS = 8 };

static const char SCENE[] = "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  10 0 0  0 0 10  10 0 10]\n"
                            "Shape \"bilinearmesh\" \"point3 P\" [0 0 5  0 3 5  10 0 5  10 3 5]\n"
                            "Translate 3 2 2 Shape \"sphere\" \"float radius\" 1.5\n";
static const float RADIUS = 1.0f;

typedef struct job {
    const scene *s;
    clear_spaces *spaces;
    atomic_u32 different;
} job;

static bool is_same(const clear_space *a, const clear_space *b)
{
    bool is_same = a->radius == b->radius && a->plane_count == b->plane_count;
    for (uint32_t i = 0; i < a->plane_count && is_same; i++)
        is_same = memcmp(&a->plane[i], &b->plane[i], sizeof a->plane[i]) == 0;
    return is_same &&
           (a->radius == 0.0f || (a->shape_index == b->shape_index && a->primitive_index == b->primitive_index));
}

static void ask_for_all(void *user, unsigned worker_index)
{
    (void)worker_index;
    job *j = user;
    for (int turn = 0; turn < 2; turn++)
        for (uint32_t i = 0; i < BLOCKS; i++) {
            clear_space spare, alone;
            const clear_space *space = clear_spaces_get(j->spaces, i, &spare);
            clear_space_find(j->s, photon_block_position(j->spaces->blocks, i * PHOTON_BLOCK_LANES),
                             direction_decode(photon_block_normal(j->spaces->blocks, i * PHOTON_BLOCK_LANES)), RADIUS,
                             &alone);
            if (!is_same(space, &alone))
                fetch_or_relaxed_u32(&j->different, 1);
        }
}

static void all_threads_get_the_same(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, WORKERS);
    scene *s = test_scene_create(&r, SCENE);
    photon_block *blocks = calloc(BLOCKS, sizeof *blocks);
    assert_non_null(blocks);
    rng random = test_random(7);
    for (uint32_t i = 0; i < BLOCKS; i++) {
        blocks[i].position[0][0] = 10.0f * rng_float(&random);
        blocks[i].position[2][0] = 10.0f * rng_float(&random);
        blocks[i].normal[0] = direction_encode((vec3){0.0f, 1.0f, 0.0f});
    }
    job j = {.s = s, .spaces = clear_spaces_create(s, blocks, BLOCKS, RADIUS)};
    assert_non_null(j.spaces);
    thread_pool_run(r.pool, ask_for_all, &j);
    assert_int_equal(load_relaxed_u32(&j.different), 0);

    uint32_t known = 0, parted = 0; /* beside the wall */
    for (uint32_t i = 0; i < BLOCKS; i++) {
        clear_space spare;
        const clear_space *space = clear_spaces_get(j.spaces, i, &spare);
        assert_true(space != &spare); /* it is kept */
        known += space->radius > 0.0f;
        parted += space->plane_count > 1;
    }
    assert_true(known > BLOCKS * 9 / 10 && parted > BLOCKS / 10 && parted < BLOCKS / 2);
    free(j.spaces);
    free(blocks);
    scene_destroy(s);
    test_run_reset(&r);
}

static void a_map_has_them_where_they_are_of_use(void **state)
{
    (void)state;
    static const char *const BESIDE[] = {
        "", "Shape \"curve\" \"point3 P\" [8 1 8  8 2 8  8 3 8  8 4 8] \"float width\" 0.1\n"};
    test_run r;
    test_run_init(&r, 1);
    photon_block *blocks = calloc(BLOCKS, sizeof *blocks);
    assert_non_null(blocks);
    for (int i = 0; i < 2; i++) {
        char text[1000];
        snprintf(text, sizeof text, "%s%s", SCENE, BESIDE[i]);
        scene *s = test_scene_create(&r, text);
        photon_map map = {.blocks = blocks, .surfaces = s, .is_borrowed = true, .mean_radius = RADIUS};
        photon_map_make_spaces(&map, 1000); /* of no photons */
        assert_null(map.spaces);
        map.set.count = BLOCKS * PHOTON_BLOCK_LANES - 1;
        const uint64_t without = photon_map_bytes(&map), bytes = photon_map_spaces_bytes(s, map.set.count);
        photon_map_make_spaces(&map, 1000);
        assert_int_equal(map.spaces != NULL, i == 0);
        assert_int_equal(photon_map_bytes(&map), without + bytes);
        assert_int_equal(bytes > BLOCKS * sizeof(clear_space), i == 0);
        photon_map_drop_spaces(&map);
        assert_null(map.spaces);
        assert_int_equal(photon_map_bytes(&map), without);
        if (FEWER == 1) { /* sanitizers end a program that asks for too much */
            photon_map_make_spaces(&map, (uint64_t)1 << 62);
            assert_null(map.spaces);
        }
        scene_destroy(s);
    }
    free(blocks);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_threads_get_the_same),
                                       cmocka_unit_test(a_map_has_them_where_they_are_of_use)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
