/* test_disc_kernels.c: step by step, what the kernels for AVX2 and for AVX-512 write is what the plain ones write, to
 * the bit; and what a disc's photons add up to. That all find what brute force finds is test_photon_tree.c's. */
#include "disc_kernels.h"

#include "fixtures/test_scene.h"

enum { COUNT = 3000, LEAVES = 60 };

/* The kernels that are held against the plain ones: main runs all tests with each. */
static const disc_kernels *wide;

/* A surface that bends, with photons off it here and there, of strong flux, and of weak flux where so wanted. */
static photon_tree make_tree(test_run *r, bool has_weak, photon **out_photons)
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
        /* octaves from 0 to 200 below the strongest, most of them few */
        uint32_t exponent = i % 11 || !has_weak ? 200u - i % 5 : (uint32_t)(rng_next(&random) % 201);
        p[i] = (photon){.position = {at.x, at.y, at.z},
                        .normal = direction_encode(normal),
                        .flux = exponent << 24 | (uint32_t)(rng_next(&random) & 0xffffff)};
    }
    photon_tree tree;
    assert_int_equal(photon_tree_build(&r->run, p, COUNT, 0.0, 1.0, &tree), AG_OK);
    *out_photons = p;
    return tree;
}

/* Some leaves' photons, of each leaf any, at distances that may be equal. */
static void pick_photons(rng *random, const photon_tree *tree, vec3 at, photon_found *out)
{
    uint32_t leaf_count = (uint32_t)(rng_next(random) % LEAVES), blocks = (uint32_t)photon_block_count(tree->count);
    uint32_t leaf = (uint32_t)(rng_next(random) % blocks), few = (uint32_t)(rng_next(random) % 17);
    for (uint32_t i = 0; i < leaf_count; i++) {
        leaf = (leaf + 7) % blocks;
        out->leaves[i] = leaf;
        for (uint32_t lane = 0; lane < PHOTON_BLOCK_LANES; lane++) {
            uint32_t index = leaf * PHOTON_BLOCK_LANES + lane;
            bool counts = index < tree->count && rng_next(random) % 16 < few;
            float d = counts ? vec3_distance_squared(photon_block_position(tree->blocks, index), at) : NAN;
            out->distances_squared[i * PHOTON_BLOCK_LANES + lane] = lane % 5 ? d : roundf(8.0f * d) / 8.0f;
        }
    }
    out->leaf_count = leaf_count;
    out->limit = 3.0f * rng_float(random);
    out->count = 0;
    for (uint32_t i = 0; i < leaf_count * PHOTON_BLOCK_LANES; i++)
        out->count += out->distances_squared[i] <= out->limit;
}

static void assert_same_sums(const photon_disc_sums *a, const photon_disc_sums *b)
{
    assert_memory_equal(a->flux, b->flux, sizeof a->flux);
    assert_memory_equal(a->offset, b->offset, sizeof a->offset);
}

static void check_sums(const photon_disc *disc, const photon_found *found, const bool *is_summed, uint32_t count,
                       const photon_disc_sums *sums)
{
    double flux[3] = {0.0, 0.0, 0.0}, offset[3] = {0.0, 0.0, 0.0};
    uint32_t summed = 0;
    for (uint32_t i = 0; i < found->leaf_count * PHOTON_BLOCK_LANES; i++) {
        if (!is_summed[i])
            continue;
        summed++;
        uint32_t index = photon_found_index(found, i), code = photon_block_flux(disc->blocks, index);
        vec3 off = vec3_sub(photon_block_position(disc->blocks, index), disc->position);
        offset[0] += (double)off.x, offset[1] += (double)off.y, offset[2] += (double)off.z;
        for (int c = 0; c < 3; c++)
            flux[c] += ldexp(code >> (16 - 8 * c) & 255, 32 + flux_exponent(code) - disc->flux_exponent_max);
    }
    assert_int_equal(summed, count);
    for (int c = 0; c < 3; c++) {
        assert_true(fabs((double)sums->flux[c] - flux[c]) <= count); /* rounded down, each */
        double unit = (double)disc->radius / (double)PHOTON_DISC_OFFSET_UNIT;
        assert_true(fabs(sums->offset[c] * unit - offset[c]) <= (count + 1e-3) * unit);
    }
}

/* Strong fluxes alone, which the vectors sum in another way, and with weak ones among them. */
static void sums_are_the_same(void **state)
{
    (void)state;
    const disc_kernels *kernels[] = {&disc_kernels_plain, wide};
    static const float LEVELS[] = {INFINITY, 0.02f, 0.0f, 0.2f};
    test_run r;
    test_run_init(&r, 2);
    uint32_t doubtful_sum = 0, inside_sum = 0, outside_sum = 0;
    for (int weak = 0; weak < 2; weak++) {
        photon *photons;
        photon_tree tree = make_tree(&r, weak, &photons);
        rng random = test_random(2);
        photon_neighbor *scratch = malloc(photon_neighbors_capacity(LEAVES) * sizeof *scratch);
        assert_non_null(scratch);
        for (int round = 0; round < 400 / FEWER; round++) {
            photon_found found;
            photon_found_init(&found, &tree, LEAVES, scratch);
            uint32_t photon_index = (uint32_t)(rng_next(&random) % tree.count), kept[2], inside[2];
            photon_disc disc = {.blocks = tree.blocks,
                                .position = photon_block_position(tree.blocks, photon_index),
                                .normal = direction_decode(photon_block_normal(tree.blocks, photon_index)),
                                .radius = 3.0f,
                                .flat_height = LEVELS[round % 4],
                                .flux_exponent_max = 72,
                                .has_offsets = round % 3 > 0};
            pick_photons(&random, &tree, disc.position, &found);
            frame f = frame_from_z(disc.normal);
            surface_region region = {.center = disc.position, .x = f.x, .y = f.y};
            for (int i = 0; i < SURFACE_REGION_OCTANTS; i++)
                for (int a = 0; a < 2; a++)
                    region.line[i][a] = round % 5 ? 8.0f * rng_float(&random) - 4.0f : 0.0f;

            photon_disc_sums sums[2], sums_inside[2];
            static photon_neighbor doubtful[2][LEAVES * PHOTON_BLOCK_LANES];
            static bool is_on_surface[LEAVES * PHOTON_BLOCK_LANES], is_inside[LEAVES * PHOTON_BLOCK_LANES];
            for (int k = 0; k < 2; k++) {
                kept[k] = kernels[k]->sum_on_surface(&disc, &found, &sums[k], doubtful[k]);
                inside[k] = kernels[k]->sum_in_region(&disc, &region, &found, &sums_inside[k]);
            }
            assert_int_equal(kept[0], kept[1]);
            assert_true(kept[0] <= found.count);
            assert_memory_equal(doubtful[0], doubtful[1], (found.count - kept[0]) * sizeof **doubtful);
            assert_memory_equal(sums[0].flux, sums[1].flux, sizeof sums[0].flux);
            if (disc.has_offsets)
                assert_same_sums(&sums[0], &sums[1]);
            assert_int_equal(inside[0], inside[1]);
            assert_same_sums(&sums_inside[0], &sums_inside[1]);
            if (disc.flat_height == INFINITY)
                assert_int_equal(kept[0], found.count);
            doubtful_sum += found.count - kept[0];
            inside_sum += inside[0];
            outside_sum += found.count - inside[0];

            /* what the kept ones add up to, in floating point */
            for (uint32_t i = 0; i < found.leaf_count * PHOTON_BLOCK_LANES; i++) {
                bool is_found = found.distances_squared[i] <= found.limit;
                is_on_surface[i] = is_found;
                is_inside[i] =
                    is_found &&
                    surface_region_contains(&region, photon_block_position(tree.blocks, photon_found_index(&found, i)));
            }
            for (uint32_t i = 0; i < found.count - kept[0]; i++) {
                assert_true(is_on_surface[doubtful[0][i]]);
                is_on_surface[doubtful[0][i]] = false;
            }
            check_sums(&disc, &found, is_on_surface, kept[0], &sums[0]);
            check_sums(&disc, &found, is_inside, inside[0], &sums_inside[0]);
        }
        free(scratch);
        photon_tree_reset(&tree);
        free(photons);
    }
    assert_true(doubtful_sum > 0 && inside_sum > 0 && outside_sum > 0);
    test_run_reset(&r);
}

/* A direction near a photon's normal, mostly with the same code, or any. */
static vec3 pick_normal(rng *random, const photon_tree *tree, uint32_t index)
{
    vec3 any = random_direction(random), near = direction_decode(photon_block_normal(tree->blocks, index));
    return rng_next(random) % 4 ? vec3_normalize(vec3_add_scaled(near, any, 0.01f * rng_float(random))) : any;
}

/* All kernels collect the same photons, whichever way they face, for any limit of the angle: photons all over a sphere
 * and within it, whose normals are any. */
static void the_same_photons_are_collected(void **state)
{
    (void)state;
    enum { QUERIES = 8000 / FEWER, READ = 40 };
    static const float MIN_COS[] = {0.5f, 0.9f, 0.0f, 0.99f, 0.999f, 0.99999f, 0.25f, 0.75f};
    const disc_kernels *kernels[] = {&disc_kernels_plain, wide};
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(7);
    photon *p = photon_records_create(COUNT);
    assert_non_null(p);
    for (uint32_t i = 0; i < COUNT; i++) {
        vec3 at = random_direction(&random), normal = i % 5 ? at : random_direction(&random);
        p[i] = (photon){.position = {at.x, at.y, at.z}, .normal = direction_encode(normal)};
    }
    photon_tree tree;
    assert_int_equal(photon_tree_build(&r.run, p, COUNT, 0.0, 1.0, &tree), AG_OK);
    photon_neighbor *scratch[2];
    uint64_t collected = 0, refused = 0;
    for (int k = 0; k < 2; k++) {
        scratch[k] = malloc(photon_neighbors_capacity(READ * PHOTON_BLOCK_LANES) * sizeof **scratch);
        assert_non_null(scratch[k]);
    }
    for (uint32_t i = 0; i < QUERIES; i++) {
        uint32_t index = (uint32_t)(rng_next(&random) % tree.count);
        vec3 normal = pick_normal(&random, &tree, index), at = vec3_add_scaled(normal, random_direction(&random), 0.1f);
        float limit = 4.0f * rng_float(&random) * rng_float(&random);
        uint32_t leaves[READ], blocks = (uint32_t)photon_block_count(tree.count), read[2];
        for (uint32_t k = 0; k < READ; k++)
            leaves[k] = (uint32_t)(rng_next(&random) % blocks);
        leaves[0] = index / PHOTON_BLOCK_LANES;
        photon_found found[2];
        for (int k = 0; k < 2; k++) {
            photon_query q;
            photon_query_init(&q, &tree, at, normal, MIN_COS[i % 8]);
            photon_found_init(&found[k], &tree, READ * PHOTON_BLOCK_LANES, scratch[k]);
            found[k].limit = limit;
            read[k] = kernels[k]->collect(&q, leaves, READ, &found[k]);
        }
        assert_int_equal(read[0], READ);
        assert_int_equal(read[1], READ);
        assert_int_equal(found[0].count, found[1].count);
        assert_int_equal(found[0].leaf_count, found[1].leaf_count);
        assert_true(found[0].other_squared == found[1].other_squared);
        assert_memory_equal(found[0].leaves, found[1].leaves, found[0].leaf_count * sizeof *found->leaves);
        for (uint32_t k = 0; k < found[0].leaf_count * PHOTON_BLOCK_LANES; k++) {
            float d[2] = {found[0].distances_squared[k], found[1].distances_squared[k]};
            assert_true(isnan(d[0]) ? isnan(d[1]) : d[0] == d[1]);
            *(isnan(d[0]) ? &refused : &collected) += 1;
        }
    }
    assert_true(collected > QUERIES && refused > QUERIES);
    for (int k = 0; k < 2; k++)
        free(scratch[k]);
    photon_tree_reset(&tree);
    free(p);
    test_run_reset(&r);
}

static int by_value(const void *a, const void *b)
{
    photon_neighbor x = *(const photon_neighbor *)a, y = *(const photon_neighbor *)b;
    return x < y ? -1 : x > y;
}

/* Distances spread evenly, all nearly the same, all the same, and 0. */
static void the_nearest_are_kept(void **state)
{
    (void)state;
    enum { MOST = LEAVES * PHOTON_BLOCK_LANES };
    const disc_kernels *kernels[] = {&disc_kernels_plain, wide};
    rng random = test_random(3);
    const photon_tree tree = {0};
    photon_neighbor *scratch = malloc(photon_neighbors_capacity(MOST) * sizeof *scratch);
    assert_non_null(scratch);
    for (int round = 0; round < 2000 / FEWER; round++) {
        static photon_neighbor expected[MOST], kept[MOST];
        uint32_t leaf_count = 1 + (uint32_t)(rng_next(&random) % LEAVES), count = 0;
        float limit = round % 5 == 4 ? 0.0f : ldexpf(1.0f, round % 60 - 30);
        photon_found found;
        photon_found_init(&found, &tree, MOST, scratch);
        found.leaf_count = leaf_count;
        found.limit = limit;
        static float distances[MOST];
        for (uint32_t i = 0; i < leaf_count * PHOTON_BLOCK_LANES; i++) {
            float d = round % 5 == 3 ? limit : limit * 1.2f * rng_float(&random) * (round % 5 == 2 ? 1e-4f : 1.0f);
            found.leaves[i / PHOTON_BLOCK_LANES] = 3 + 2 * (i / PHOTON_BLOCK_LANES);
            distances[i] = i % 6 ? d : NAN;
            if (distances[i] <= limit)
                expected[count++] = photon_neighbor_make(d, photon_found_index(&found, i));
        }
        qsort(expected, count, sizeof *expected, by_value);
        uint32_t wanted = 1 + (uint32_t)(rng_next(&random) % count);
        for (int k = 0; k < 2; k++) {
            memcpy(found.distances_squared, distances, sizeof distances);
            found.limit = limit;
            found.count = count;
            photon_found_keep_nearest(kernels[k], &found, wanted);
            assert_int_equal(found.count, wanted);
            assert_true(found.farthest == expected[wanted - 1]);
            assert_true(found.limit == photon_neighbor_distance_squared(found.farthest));
            assert_int_equal(kernels[k]->list_between(&found, -1.0f, found.limit, kept), wanted);
            qsort(kept, wanted, sizeof *kept, by_value);
            assert_memory_equal(kept, expected, wanted * sizeof *kept);
            photon_found_forget(&found, found.farthest);
            assert_int_equal(kernels[k]->list_between(&found, -1.0f, found.limit, kept), wanted - 1);
        }
    }
    free(scratch);
}

/* All kernels find the same leaves of every subtree, from points within and without, and leave out none that holds a
 * photon within reach. */
static void leaves_of_subtrees_are_found(void **state)
{
    (void)state;
    const disc_kernels *plain = &disc_kernels_plain;
    test_run r;
    test_run_init(&r, 2);
    photon *photons;
    photon_tree tree = make_tree(&r, true, &photons);
    assert_true(tree.depth > DISC_SUBTREE_LEVELS_MAX);
    rng random = test_random(4);
    const uint32_t subtree_leaves = 1u << wide->subtree_levels;
    uint32_t base = (1u << (tree.depth - wide->subtree_levels)) - 1, found_sum = 0;
    for (uint32_t trial = 0; trial < 60 / FEWER; trial++) {
        vec3 at = random_in_box(&random, (vec3){-1.0f, -1.0f, 0.0f}, (vec3){1.0f, 1.0f, 1.5f});
        photon_query q;
        photon_query_init(&q, &tree, at, (vec3){0.0f, 0.0f, 1.0f}, 0.5f);
        float most = trial % 7 == 0 ? INFINITY : rng_float(&random);
        for (uint32_t i = 0; i <= base; i++) {
            uint32_t leaves[2][DISC_SUBTREE_LEAVES_MAX];
            photon_subtree subtree = {photon_lanes_fill(0.0f), base + i};
            if (i % 3 == 0)
                subtree.offset = (photon_lanes){0.1f * rng_float(&random), 0.0f, -0.2f, 0.0f};
            uint32_t count = plain->find_leaves(&q, subtree, most, leaves[0]);
            assert_int_equal(count, wide->find_leaves(&q, subtree, most, leaves[1]));
            assert_memory_equal(leaves[0], leaves[1], count * sizeof **leaves);
            found_sum += count;
            for (uint32_t leaf = i * subtree_leaves; i % 3 && leaf < (i + 1) * subtree_leaves; leaf++) {
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
    /* deep: the tree's lowest levels are built apart, and planes of parts that are empty are not written there */
    enum { BLOCKS_MIN = 2049, BLOCKS_MAX = 2064, BEHIND = 8, WANTED = 20 };
    const disc_kernels *kernels[] = {&disc_kernels_plain, wide};
    const vec3 up = {0.0f, 0.0f, 1.0f}, low = {-1.0f, -0.1f, 0.0f}, high = {0.02f, 0.0f, 0.0f},
               end = {-0.02f, -0.1f, 0.0f}; /* near the last leaves */
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(5);
    for (uint32_t blocks = BLOCKS_MIN; blocks <= BLOCKS_MAX; blocks++) {
        uint32_t count = blocks * PHOTON_BLOCK_LANES - blocks % 3;
        photon *p = photon_records_create((blocks + BEHIND) * PHOTON_BLOCK_LANES);
        assert_non_null(p);
        for (uint32_t i = 0; i < (blocks + BEHIND) * PHOTON_BLOCK_LANES; i++) {
            vec3 at = random_in_box(&random, i < count ? low : end, high);
            p[i] = (photon){.position = {at.x, at.y, at.z}, .normal = direction_encode(up)};
        }
        for (uint32_t i = blocks; i < blocks + BEHIND; i++)
            photon_block_from_records((photon_block *)(void *)p + i, PHOTON_BLOCK_LANES);
        photon_tree tree;
        assert_int_equal(photon_tree_build(&r.run, p, count, 0.0, 1.0, &tree), AG_OK);
        photon_neighbor *n = malloc(photon_neighbors_capacity(WANTED) * sizeof *n);
        assert_non_null(n);
        for (int round = 0; round < 200 / FEWER; round++) {
            vec3 at = random_in_box(&random, round % 2 ? low : end, high);
            float radius = 0.02f * rng_float(&random);
            uint32_t within = 0;
            for (uint32_t i = 0; i < count; i++)
                within += vec3_distance_squared(photon_block_position(tree.blocks, i), at) <= radius * radius;
            for (int k = 0; k < 2; k++) {
                float other;
                uint32_t found = photon_tree_k_nearest_by(kernels[k], &tree, at, up, 0.5f, radius, WANTED, n, &other);
                assert_int_equal(found, within < WANTED ? within : WANTED);
                for (uint32_t i = 0; i < found; i++)
                    assert_true(photon_neighbor_index(n[i]) < count);
            }
        }
        free(n);
        photon_tree_reset(&tree);
        free(p);
    }
    test_run_reset(&r);
}

/* A search finds the same photons whatever the worker has searched for before, near or far. */
static void hints_change_no_answer(void **state)
{
    (void)state;
    enum { WANTED = 51, SEARCHES = 4000 / FEWER };
    const vec3 up = {0.0f, 0.0f, 1.0f}, aside = {1.0f, 0.0f, 0.0f};
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(6);
    photon *p = photon_records_create(COUNT);
    assert_non_null(p);
    for (uint32_t i = 0; i < COUNT; i++)
        p[i] = (photon){.position = {rng_float(&random), rng_float(&random), 0.0f},
                        .normal = direction_encode(i % 64 ? up : aside)};
    photon_tree tree;
    assert_int_equal(photon_tree_build(&r.run, p, COUNT, 0.0, 1.0, &tree), AG_OK);
    photon_neighbor *scratch[2];
    photon_found found[2];
    for (int k = 0; k < 2; k++) {
        scratch[k] = aligned_alloc(64, (photon_neighbors_capacity(WANTED) * sizeof **scratch + 63) / 64 * 64);
        assert_non_null(scratch[k]);
        photon_found_init(&found[k], &tree, WANTED, scratch[k]);
    }
    photon_search_hint hint = {.leaf = PHOTON_NONE};
    vec3 at = {0.5f, 0.5f, 0.0f};
    for (uint32_t i = 0; i < SEARCHES; i++) {
        vec3 far = {rng_float(&random), rng_float(&random), 0.0f};
        vec3 step = vec3_scale(vec3_sub(far, at), i % 16 ? 0.05f : 1.0f);
        at = vec3_add(at, step);
        photon_found_search(&found[0], &tree, at, up, 0.5f, 1.0f, WANTED, NULL);
        photon_found_search(&found[1], &tree, at, up, 0.5f, 1.0f, WANTED, &hint);
        assert_int_equal(found[0].count, found[1].count);
        if (found[0].limit != found[1].limit || found[0].other_squared != found[1].other_squared)
            fail_msg("search %u: a limit of %.9g, %.9g with a hint; another photon at %.9g, %.9g", i,
                     (double)found[0].limit, (double)found[1].limit, (double)found[0].other_squared,
                     (double)found[1].other_squared);
    }
    for (int k = 0; k < 2; k++)
        free(scratch[k]);
    photon_tree_reset(&tree);
    free(p);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_are_the_same),
        cmocka_unit_test(the_same_photons_are_collected),
        cmocka_unit_test(the_nearest_are_kept),
        cmocka_unit_test(leaves_of_subtrees_are_found),
        cmocka_unit_test(nothing_behind_the_last_leaf_is_found),
        cmocka_unit_test(hints_change_no_answer),
    };
    const disc_kernels *const all[] = {disc_kernels_avx2(), disc_kernels_avx512()};
    static const char *const NAMES[] = {"AVX2", "AVX-512"};
    int failed = 0;
    for (int i = 0; i < 2; i++) {
        if (!all[i]) {
            print_message("no %s here\n", NAMES[i]);
            if (i > 0)
                continue; /* the first group has tested the plain kernels by themselves */
        }
        wide = all[i] ? all[i] : &disc_kernels_plain;
        failed += cmocka_run_group_tests_name(NAMES[i], tests, NULL, NULL);
    }
    return failed;
}
