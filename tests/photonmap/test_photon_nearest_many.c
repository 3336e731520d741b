/* test_photon_nearest_many.c: many points at once find the photons that each finds alone, and the kernels for AVX2
 * and for AVX-512 do what the plain ones do, to the bit. */
#include "fixtures/test_scene.h"
#include "lookup_kernels.h"

#include <stdlib.h>
#include <string.h>

enum { COUNT = 6000, POINTS = 61 * PHOTON_LOOKUPS_MAX / 2 };

typedef enum cloud { BALL, WALLS, GRID, COINCIDENT, TWO_CLUSTERS, SOME, FEW, CLOUD_KINDS } cloud;

/* The kernels that are held against the plain ones: main runs all tests with each. */
static const lookup_kernels *wide;

static photon_tree make_tree(test_run *r, cloud kind, photon **out_photons)
{
    uint32_t count = kind == FEW ? 11 : kind == SOME ? 400 : COUNT;
    photon *p = photon_records_create(count);
    rng random = test_random((uint64_t)kind);
    assert_non_null(p);
    for (uint32_t i = 0; i < count; i++) {
        vec3 normal = random_direction(&random), at = normal;
        switch (kind) {
        case WALLS:
            at = random_in_box(&random, (vec3){-1.0f, -1.0f, -1.0f}, (vec3){1.0f, 1.0f, 1.0f});
            normal = (vec3){0.0f, 1.0f, 0.0f};
            if (i % 2)
                at.y = -1.0f;
            else
                at.x = 1.0f, normal = (vec3){-1.0f, 0.0f, 0.0f};
            break;
        case GRID:
            at = (vec3){(float)(i % 18) * 0.0625f - 0.5f, (float)(i / 18 % 18) * 0.0625f - 0.5f,
                        (float)(i / 324) * 0.0625f - 0.5f};
            break;
        case COINCIDENT: at = (vec3){0.5f, 0.5f, 0.5f}; break;
        case TWO_CLUSTERS: at = vec3_add_scaled((vec3){i % 2 ? 0.9f : -0.9f, 0.0f, 0.0f}, at, 1e-3f); break;
        default: break;
        }
        p[i] = (photon){.position = {at.x, at.y, at.z}, .normal = direction_encode(normal)};
    }
    photon_tree tree;
    assert_int_equal(photon_tree_build(&r->run, p, count, 0.0, 1.0, &tree), AG_OK);
    *out_photons = p;
    return tree;
}

static int by_leaf(const void *a, const void *b)
{
    uint32_t x = ((const photon_lookup *)a)->leaf, y = ((const photon_lookup *)b)->leaf;
    return x < y ? -1 : x > y;
}

/* At photons, near them, and anywhere; half of the normals are a photon's. */
static void make_lookups(const photon_tree *tree, uint64_t seed, photon_lookup *lookups)
{
    rng random = test_random(seed);
    for (uint32_t i = 0; i < POINTS; i++) {
        uint32_t photon_index = (uint32_t)(rng_next(&random) % tree->count);
        vec3 at = random_in_box(&random, (vec3){-1.5f, -1.5f, -1.5f}, (vec3){1.5f, 1.5f, 1.5f});
        if (i % 3 < 2)
            at = vec3_add_scaled(photon_block_position(tree->blocks, photon_index), at, i % 3 ? 0.02f : 0.0f);
        vec3 normal =
            i % 2 ? random_direction(&random) : direction_decode(photon_block_normal(tree->blocks, photon_index));
        lookups[i] = (photon_lookup){at, normal, photon_tree_leaf(tree, at)};
    }
    qsort(lookups, POINTS, sizeof *lookups, by_leaf);
}

static void check_kernels(const photon_tree *tree, const lookup_kernels *kernels, const photon_lookup *lookups)
{
    static const float RADII[] = {0.01f, 0.3f, 5.0f, 1e18f};
    photon_walk walk;
    photon_walk_init(&walk, tree);
    walk.kernels = kernels;
    uint32_t found_count = 0, missed_count = 0;
    for (uint32_t begin = 0, round = 0, count; begin < POINTS; begin += count, round++) {
        photon_neighbor many[PHOTON_LOOKUPS_MAX];
        count = round % 3 ? PHOTON_LOOKUPS_MAX : 1 + round % PHOTON_LOOKUPS_MAX;
        count = POINTS - begin < count ? POINTS - begin : count;
        float radius = RADII[round / 3 % 4], min_cos = round % 2 ? 0.9f : 0.0f;
        photon_walk_nearest_many(&walk, lookups + begin, count, min_cos, radius, many);
        for (uint32_t i = 0; i < count; i++) {
            const photon_lookup *l = &lookups[begin + i];
            float d;
            uint32_t alone = photon_tree_nearest(tree, l->position, l->normal, min_cos, radius, &d);
            assert_int_equal(photon_neighbor_index(many[i]), alone);
            assert_true(many[i] == photon_neighbor_make(d, alone));
            found_count += alone != PHOTON_NONE;
            missed_count += alone == PHOTON_NONE;
        }
    }
    assert_true(found_count > 0 && missed_count > 0);
}

static void many_find_what_each_finds_alone(void **state)
{
    (void)state;
    static photon_lookup lookups[POINTS];
    test_run r;
    test_run_init(&r, 2);
    for (int kind = 0; kind < CLOUD_KINDS; kind++) {
        photon *photons;
        photon_tree tree = make_tree(&r, (cloud)kind, &photons);
        make_lookups(&tree, 100 + (uint64_t)kind, lookups);
        check_kernels(&tree, &lookup_kernels_plain, lookups);
        check_kernels(&tree, wide, lookups);
        photon_tree_reset(&tree);
        free(photons);
    }
    test_run_reset(&r);
}

/* Any number of points, the ends of vectors among them. */
static void leaves_are_those_of_each_alone(void **state)
{
    (void)state;
    static photon_lookup lookups[POINTS];
    test_run r;
    test_run_init(&r, 2);
    const lookup_kernels *kernels[] = {&lookup_kernels_plain, wide};
    for (int kind = 0; kind < CLOUD_KINDS; kind++) {
        photon *photons;
        photon_tree tree = make_tree(&r, (cloud)kind, &photons);
        make_lookups(&tree, 200 + (uint64_t)kind, lookups);
        for (int k = 0; k < 2; k++)
            for (uint32_t count = 0; count < 70; count++) {
                uint32_t leaves[71];
                memset(leaves, 0xff, sizeof leaves);
                kernels[k]->find_leaves(&tree, &lookups[7 * count].position.x, sizeof *lookups / sizeof(float), count,
                                        leaves);
                for (uint32_t i = 0; i < count; i++)
                    assert_int_equal(leaves[i], lookups[7 * count + i].leaf);
                assert_int_equal(leaves[count], UINT32_MAX);
            }
        photon_tree_reset(&tree);
        free(photons);
    }
    test_run_reset(&r);
}

/* Returns some of the lookups' points as columns, a fifth of them without a reach. */
static lookup_columns points_of(const photon_lookup lookups[POINTS])
{
    lookup_columns points;
    rng random = test_random(4);
    for (uint32_t i = 0; i < PHOTON_LOOKUPS_MAX; i++) {
        vec3 at = lookups[30 * i].position;
        points.column[0][i] = at.x, points.column[1][i] = at.y, points.column[2][i] = at.z;
        points.column[LOOKUP_REACH_SQUARED][i] = i % 5 ? 0.02f * rng_float(&random) : -1.0f;
    }
    return points;
}

/* Each step by itself, in order: what the plain kernels write is what the others write. */
static void kernels_write_the_same(void **state)
{
    (void)state;
    const lookup_kernels *plain = &lookup_kernels_plain;
    static photon_lookup lookups[POINTS];
    static lookup_visits from, to[2], found[2];
    static float distances[2][sizeof found->node / sizeof *found->node];
    test_run r;
    test_run_init(&r, 2);
    photon *photons;
    photon_tree tree = make_tree(&r, BALL, &photons);
    make_lookups(&tree, 3, lookups);
    lookup_columns points = points_of(lookups);
    for (uint32_t node = 0; node < (1u << tree.depth) - 1; node++)
        assert_true(plain->meet_plane(&points, tree.nodes[node]) == wide->meet_plane(&points, tree.nodes[node]));
    from.count = 0;
    for (uint32_t i = 0; i < PHOTON_LOOKUPS_MAX - 3; i++) {
        from.lookup[from.count] = i;
        from.node[from.count++] = 0;
    }
    for (uint32_t level = 0; level < tree.depth; level++) {
        plain->descend(&tree, &points, &from, &to[0]);
        wide->descend(&tree, &points, &from, &to[1]);
        assert_true(to[0].count <= LOOKUP_VISITS_MAX);
        /* in any order: that of a level does not reach the answer */
        assert_int_equal(to[0].count, to[1].count);
        uint64_t sums[2] = {0, 0};
        for (int k = 0; k < 2; k++)
            for (uint32_t i = 0; i < to[k].count; i++)
                sums[k] += hash_mix64((uint64_t)to[k].lookup[i] << 32 | to[k].node[i]);
        assert_true(sums[0] == sums[1]);
        from = to[0];
    }
    assert_true(from.count > PHOTON_LOOKUPS_MAX);
    for (uint32_t i = 0; i < from.count; i++)
        from.node[i] -= (1u << tree.depth) - 1;
    plain->scan(tree.blocks, &points, &from, &found[0], distances[0]);
    wide->scan(tree.blocks, &points, &from, &found[1], distances[1]);
    assert_true(found[0].count > 0 && found[0].count < from.count);
    assert_int_equal(found[0].count, found[1].count);
    assert_memory_equal(found[0].lookup, found[1].lookup, found[0].count * sizeof *found->lookup);
    assert_memory_equal(found[0].node, found[1].node, found[0].count * sizeof *found->node);
    assert_memory_equal(distances[0], distances[1], found[0].count * sizeof **distances);
    photon_tree_reset(&tree);
    free(photons);
    test_run_reset(&r);
}

/* Nodes in a file that is overwritten may be anything: ways down still end at leaves that the tree's depth allows. */
static void nodes_may_hold_anything(void **state)
{
    (void)state;
    static photon_lookup lookups[POINTS];
    static lookup_visits from, to;
    test_run r;
    test_run_init(&r, 2);
    photon *photons;
    photon_tree tree = make_tree(&r, BALL, &photons);
    make_lookups(&tree, 3, lookups);
    rng random = test_random(5);
    lookup_columns points = points_of(lookups);
    for (uint32_t node = 0; node < (1u << tree.depth) - 1; node++)
        tree.nodes[node] = (photon_tree_node){rng_float(&random) - 0.5f, (uint32_t)rng_next(&random)};
    const lookup_kernels *const both[] = {&lookup_kernels_plain, wide};
    for (int k = 0; k < 2; k++) {
        uint32_t leaves[PHOTON_LOOKUPS_MAX];
        both[k]->find_leaves(&tree, &lookups[0].position.x, sizeof *lookups / sizeof(float), PHOTON_LOOKUPS_MAX,
                             leaves);
        for (uint32_t i = 0; i < PHOTON_LOOKUPS_MAX; i++)
            assert_true(leaves[i] < 1u << tree.depth);
        from = (lookup_visits){.count = PHOTON_LOOKUPS_MAX};
        for (uint32_t i = 0; i < PHOTON_LOOKUPS_MAX; i++)
            from.lookup[i] = i;
        for (uint32_t level = 0; level < tree.depth && from.count <= LOOKUP_VISITS_MAX; level++) {
            both[k]->descend(&tree, &points, &from, &to);
            assert_true(to.count >= from.count && to.count <= 2 * from.count);
            for (uint32_t i = 0; i < to.count; i++)
                assert_true(to.node[i] >= (2u << level) - 1 && to.node[i] < (4u << level) - 1);
            from = to;
        }
    }
    photon_tree_reset(&tree);
    free(photons);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_find_what_each_finds_alone),
        cmocka_unit_test(leaves_are_those_of_each_alone),
        cmocka_unit_test(kernels_write_the_same),
        cmocka_unit_test(nodes_may_hold_anything),
    };
    const lookup_kernels *const all[] = {lookup_kernels_avx2(), lookup_kernels_avx512()};
    static const char *const NAMES[] = {"AVX2", "AVX-512"};
    int failed = 0;
    for (int i = 0; i < 2; i++) {
        if (!all[i]) {
            print_message("no %s here\n", NAMES[i]);
            if (i > 0)
                continue; /* the first group has tested the plain kernels by themselves */
        }
        wide = all[i] ? all[i] : &lookup_kernels_plain;
        failed += cmocka_run_group_tests_name(NAMES[i], tests, NULL, NULL);
    }
    return failed;
}
