/* test_disc_kernels.c: step by step, what the kernels for AVX2 write is what the plain ones write, to the bit; and what
 * a disc's photons add up to. That both find what brute force finds is test_photon_tree.c's. */
#include "disc_kernels.h"

#include "fixtures/test_scene.h"

enum { COUNT = 3000, MOST = 700 };

/* A surface that bends, with photons off it here and there, of weak and strong flux. */
static photon_tree make_tree(test_run *r, photon **out_photons)
{
    photon *p = photon_records_create(COUNT);
    assert_non_null(p);
    rng random = test_random(1);
    for (uint32_t i = 0; i < COUNT; i++) {
        vec3 at = vec3_normalize(random_in_box(&random, (vec3){-0.5f, -0.5f, 0.6f}, (vec3){0.5f, 0.5f, 1.0f}));
        vec3 normal = at;
        if (i % 9 == 0)
            normal = random_direction(&random);
        if (i % 7 == 0)
            at.z += 0.2f * rng_float(&random) - 0.1f;
        /* octaves from 0 to 255 below the strongest, most of them few */
        uint32_t exponent = i % 11 ? 200u - i % 5 : (uint32_t)(rng_next(&random) % 201);
        p[i] = (photon){.position = {at.x, at.y, at.z},
                        .normal = direction_encode(normal),
                        .flux = exponent << 24 | (uint32_t)(rng_next(&random) & 0xffffff)};
    }
    photon_tree tree;
    assert_int_equal(photon_tree_build(&r->run, p, COUNT, 0.0, 1.0, &tree), AG_OK);
    *out_photons = p;
    return tree;
}

/* Neighbours of every kind: of any number, in any order, each once. */
static uint32_t pick_neighbors(rng *random, const photon_tree *tree, vec3 at, photon_neighbor *out)
{
    uint32_t count = (uint32_t)(rng_next(random) % MOST), index = (uint32_t)(rng_next(random) % tree->count);
    for (uint32_t i = 0; i < count; i++) {
        index = (index + 1237) % tree->count; /* a prime that does not divide COUNT */
        float d = vec3_distance_squared(photon_block_position(tree->blocks, index), at);
        out[i] = photon_neighbor_make(d, index);
    }
    return count;
}

static void sums_are_the_same(void **state)
{
    (void)state;
    const disc_kernels *plain = &disc_kernels_plain, *best = disc_kernels_best();
    static const float LEVELS[] = {INFINITY, 0.02f, 0.0f, 0.2f};
    test_run r;
    test_run_init(&r, 2);
    photon *photons;
    photon_tree tree = make_tree(&r, &photons);
    rng random = test_random(2);
    uint32_t doubtful_sum = 0;
    for (int round = 0; round < 400 / FEWER; round++) {
        photon_neighbor n[2][MOST + 8], doubtful[2][MOST + 8];
        uint32_t photon_index = (uint32_t)(rng_next(&random) % tree.count), kept[2];
        photon_disc disc = {.blocks = tree.blocks,
                            .position = photon_block_position(tree.blocks, photon_index),
                            .normal = direction_decode(photon_block_normal(tree.blocks, photon_index)),
                            .radius = 3.0f,
                            .level = LEVELS[round % 4],
                            .flux_exponent_max = 72};
        uint32_t count = pick_neighbors(&random, &tree, disc.position, n[0]);
        photon_disc_sums sums[2];
        memcpy(n[1], n[0], sizeof n[0]);
        kept[0] = plain->sum_on_level(&disc, n[0], count, &sums[0], doubtful[0]);
        kept[1] = best->sum_on_level(&disc, n[1], count, &sums[1], doubtful[1]);
        assert_int_equal(kept[0], kept[1]);
        assert_true(kept[0] <= count);
        assert_memory_equal(n[0], n[1], kept[0] * sizeof **n);
        assert_memory_equal(doubtful[0], doubtful[1], (count - kept[0]) * sizeof **n);
        assert_memory_equal(&sums[0], &sums[1], sizeof sums[0]);
        if (disc.level == INFINITY)
            assert_int_equal(kept[0], count);
        doubtful_sum += count - kept[0];

        /* what the kept ones add up to, in floating point */
        double flux[3] = {0.0, 0.0, 0.0}, offset[3] = {0.0, 0.0, 0.0};
        for (uint32_t i = 0; i < kept[0]; i++) {
            uint32_t index = photon_neighbor_index(n[0][i]), code = photon_block_flux(tree.blocks, index);
            vec3 off = vec3_sub(photon_block_position(tree.blocks, index), disc.position);
            offset[0] += (double)off.x, offset[1] += (double)off.y, offset[2] += (double)off.z;
            for (int c = 0; c < 3; c++)
                flux[c] += ldexp(code >> (16 - 8 * c) & 255, 32 + flux_exponent(code) - disc.flux_exponent_max);
        }
        for (int c = 0; c < 3; c++) {
            assert_true(fabs((double)sums[0].flux[c] - flux[c]) <= kept[0]); /* rounded down, each */
            double unit = (double)disc.radius / (double)PHOTON_DISC_OFFSET_UNIT;
            assert_true(fabs(sums[0].offset[c] * unit - offset[c]) <= (kept[0] + 1e-3) * unit);
        }
    }
    assert_true(doubtful_sum > 0);
    photon_tree_reset(&tree);
    free(photons);
    test_run_reset(&r);
}

static int by_value(const void *a, const void *b)
{
    photon_neighbor x = *(const photon_neighbor *)a, y = *(const photon_neighbor *)b;
    return x < y ? -1 : x > y;
}

/* Distances spread evenly, all in one step, all the same, and 0. */
static void the_nearest_are_selected(void **state)
{
    (void)state;
    const disc_kernels *kernels[] = {&disc_kernels_plain, disc_kernels_best()};
    rng random = test_random(3);
    for (int round = 0; round < 2000 / FEWER; round++) {
        photon_neighbor sorted[MOST], n[MOST + 8];
        uint32_t count = 1 + (uint32_t)(rng_next(&random) % (MOST - 1)),
                 wanted = 1 + (uint32_t)(rng_next(&random) % count);
        float limit = round % 5 == 4 ? 0.0f : ldexpf(1.0f, round % 60 - 30);
        for (uint32_t i = 0; i < count; i++) {
            float d = round % 5 == 3 ? limit : limit * rng_float(&random) * (round % 5 == 2 ? 1e-4f : 1.0f);
            sorted[i] = photon_neighbor_make(d, i * 7919u);
        }
        for (int k = 0; k < 2; k++) {
            memcpy(n, sorted, sizeof sorted);
            kernels[k]->select(n, count, wanted, limit);
            photon_neighbor last = n[wanted - 1];
            photon_neighbor *expected = malloc(count * sizeof *expected);
            assert_non_null(expected);
            memcpy(expected, sorted, count * sizeof *expected);
            qsort(expected, count, sizeof *expected, by_value);
            qsort(n, wanted, sizeof *n, by_value);
            assert_memory_equal(n, expected, wanted * sizeof *n);
            assert_true(last == expected[wanted - 1]);
            free(expected);
        }
    }
}

/* All kernels find the same leaves of every subtree, from points within and without, and leave out none that holds a
 * photon within reach. */
static void leaves_of_subtrees_are_found(void **state)
{
    (void)state;
    const disc_kernels *plain = &disc_kernels_plain, *best = disc_kernels_best();
    test_run r;
    test_run_init(&r, 2);
    photon *photons;
    photon_tree tree = make_tree(&r, &photons);
    assert_true(tree.depth > PHOTON_SUBTREE_LEVELS);
    rng random = test_random(4);
    uint32_t base = (1u << (tree.depth - PHOTON_SUBTREE_LEVELS)) - 1, found_sum = 0;
    for (uint32_t trial = 0; trial < 60 / FEWER; trial++) {
        vec3 at = random_in_box(&random, (vec3){-1.0f, -1.0f, 0.0f}, (vec3){1.0f, 1.0f, 1.5f});
        photon_query q;
        photon_query_init(&q, &tree, at, (vec3){0.0f, 0.0f, 1.0f}, 0.5f);
        float most = trial % 7 == 0 ? INFINITY : rng_float(&random);
        for (uint32_t i = 0; i <= base; i++) {
            uint32_t leaves[2][PHOTON_SUBTREE_LEAVES];
            photon_subtree subtree = {photon_lanes_fill(0.0f), base + i};
            if (i % 3 == 0)
                subtree.offset = (photon_lanes){0.1f * rng_float(&random), 0.0f, -0.2f, 0.0f};
            uint32_t count = plain->find_leaves(&q, subtree, most, leaves[0]);
            assert_int_equal(count, best->find_leaves(&q, subtree, most, leaves[1]));
            assert_memory_equal(leaves[0], leaves[1], count * sizeof **leaves);
            found_sum += count;
            for (uint32_t leaf = i * PHOTON_SUBTREE_LEAVES; i % 3 && leaf < (i + 1) * PHOTON_SUBTREE_LEAVES; leaf++) {
                _Alignas(16) float d[PHOTON_BLOCK_LANES];
                bool is_found = false;
                for (uint32_t k = 0; k < count; k++)
                    is_found = is_found || leaves[0][k] == leaf;
                if (!is_found && leaf < photon_block_count(tree.count))
                    assert_int_equal(photon_block_within(&tree.blocks[leaf], q.position, most * 0.9999f, d), 0);
            }
        }
    }
    assert_true(found_sum > 0);
    photon_tree_reset(&tree);
    free(photons);
    test_run_reset(&r);
}

/* Trees of all fillings of the last subtree, with blocks behind the last one that are not theirs: of another map, they
 * would be found. */
static void nothing_behind_the_last_leaf_is_found(void **state)
{
    (void)state;
    enum { BLOCKS_MIN = 513, BLOCKS_MAX = 528, BEHIND = 8, WANTED = 20 }; /* deep: the tree's parts are built apart */
    const disc_kernels *kernels[] = {&disc_kernels_plain, disc_kernels_best()};
    const vec3 up = {0.0f, 0.0f, 1.0f}, low = {-1.0f, -0.1f, 0.0f}, high = {0.02f, 0.0f, 0.0f};
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(5);
    for (uint32_t blocks = BLOCKS_MIN; blocks <= BLOCKS_MAX; blocks++) {
        uint32_t count = blocks * PHOTON_BLOCK_LANES - blocks % 3;
        photon *p = photon_records_create((blocks + BEHIND) * PHOTON_BLOCK_LANES);
        assert_non_null(p);
        for (uint32_t i = 0; i < (blocks + BEHIND) * PHOTON_BLOCK_LANES; i++) {
            vec3 at = random_in_box(&random, low, high);
            p[i] = (photon){.position = {at.x, at.y, at.z}, .normal = direction_encode(up)};
        }
        for (uint32_t i = blocks; i < blocks + BEHIND; i++)
            photon_block_from_records((photon_block *)(void *)p + i, PHOTON_BLOCK_LANES);
        photon_tree tree;
        assert_int_equal(photon_tree_build(&r.run, p, count, 0.0, 1.0, &tree), AG_OK);
        for (int round = 0; round < 200; round++) {
            vec3 at = random_in_box(&random, low, high);
            float radius = 0.2f * rng_float(&random);
            for (int k = 0; k < 2; k++) {
                photon_neighbor n[2 * WANTED + 64];
                float other;
                uint32_t found = disc_kernels_k_nearest(kernels[k], &tree, at, up, 0.5f, radius, WANTED, n, &other),
                         within = 0;
                for (uint32_t i = 0; i < count; i++)
                    within += vec3_distance_squared(photon_block_position(tree.blocks, i), at) <= radius * radius;
                assert_int_equal(found, within < WANTED ? within : WANTED);
                for (uint32_t i = 0; i < found; i++)
                    assert_true(photon_neighbor_index(n[i]) < count);
            }
        }
        photon_tree_reset(&tree);
        free(p);
    }
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_are_the_same),
        cmocka_unit_test(the_nearest_are_selected),
        cmocka_unit_test(leaves_of_subtrees_are_found),
        cmocka_unit_test(nothing_behind_the_last_leaf_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
