/* test_photon_tree.c: the kd-tree against brute force, and the same tree for any number of threads.
 * Threads: the build's. */
#include "disc_kernels.h"

#include "fixtures/test_scene.h"

typedef enum cloud { RANDOM, COPLANAR, COLLINEAR, COINCIDENT, GRID, TWO_CLUSTERS, MINUTE, CLOUD_KINDS } cloud;

/* Photons that carry their number as flux, so that they can be told apart. One normal in three points another way. */
static photon *make_photons(cloud kind, uint32_t count, uint64_t seed)
{
    photon *p = photon_records_create(count);
    assert_non_null(p);
    memset(p, 0, count * sizeof *p);
    rng random = test_random(seed);
    for (uint32_t i = 0; i < count; i++) {
        vec3 at = random_in_box(&random, (vec3){-1.0f, -1.0f, -1.0f}, (vec3){1.0f, 1.0f, 1.0f});
        switch (kind) {
        case COPLANAR: at.y = 0.25f; break;
        case COLLINEAR: at = vec3_scale((vec3){1.0f, 0.5f, -0.25f}, at.x); break;
        case COINCIDENT: at = (vec3){0.5f, 0.5f, 0.5f}; break;
        case GRID: at = (vec3){(float)(i % 7) * 0.25f, (float)(i / 7 % 7) * 0.25f, (float)(i / 49) * 0.25f}; break;
        case TWO_CLUSTERS: at = vec3_add_scaled((vec3){i % 2 ? 50.0f : -50.0f, 0.0f, 0.0f}, at, 0.001f); break;
        case MINUTE: at = vec3_scale(at, 1e-20f); break; /* squared distances vanish, or nearly */
        default: break;
        }
        p[i].position[0] = at.x, p[i].position[1] = at.y, p[i].position[2] = at.z;
        p[i].flux = i;
        vec3 normal = rng_float(&random) < 0.67f ? (vec3){0.0f, 1.0f, 0.0f} : random_direction(&random);
        p[i].normal = direction_encode(normal);
    }
    return p;
}

static int compare_neighbors(const void *a, const void *b)
{
    photon_neighbor x = *(const photon_neighbor *)a, y = *(const photon_neighbor *)b;
    float dx = photon_neighbor_distance_squared(x), dy = photon_neighbor_distance_squared(y);
    uint32_t ix = photon_neighbor_index(x), iy = photon_neighbor_index(y);
    return dx != dy ? (dx < dy ? -1 : 1) : ix < iy ? -1 : ix > iy;
}

/* All photons within the radius with a like normal, nearest first. */
static uint32_t brute_force(const photon_tree *tree, vec3 at, vec3 normal, float min_cos, float radius,
                            photon_neighbor *out)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < tree->count; i++) {
        vec3 p = photon_block_position(tree->blocks, i);
        float x = p.x - at.x, y = p.y - at.y, z = p.z - at.z;
        float d = x * x + y * y + z * z;
        if (d <= radius * radius && vec3_dot(direction_decode(photon_block_normal(tree->blocks, i)), normal) > min_cos)
            out[count++] = photon_neighbor_make(d, i);
    }
    if (count > 0)
        qsort(out, count, sizeof *out, compare_neighbors);
    return count;
}

/* The squared distance of the nearest photon that is neither like the normal nor its opposite. */
static float other_by_brute_force(const photon_tree *tree, vec3 at, vec3 normal, float min_cos)
{
    float nearest = INFINITY;
    for (uint32_t i = 0; i < tree->count; i++) {
        vec3 p = photon_block_position(tree->blocks, i);
        float x = p.x - at.x, y = p.y - at.y, z = p.z - at.z;
        float cosine = vec3_dot(direction_decode(photon_block_normal(tree->blocks, i)), normal);
        if (cosine <= min_cos && cosine > -0.5f)
            nearest = fminf(nearest, x * x + y * y + z * z);
    }
    return nearest;
}

/* Holds the k nearest photons that one set of kernels finds against brute force. */
static void check_k_nearest(const disc_kernels *kernels, const photon_tree *tree, vec3 at, vec3 normal, float min_cos,
                            float radius, uint32_t wanted, const photon_neighbor *expected, uint32_t all,
                            photon_neighbor *found)
{
    float other, nearest_other = other_by_brute_force(tree, at, normal, min_cos);
    uint32_t count = photon_tree_k_nearest_by(kernels, tree, at, normal, min_cos, radius, wanted, found, &other);
    assert_int_equal(count, all < wanted ? all : wanted);
    photon_neighbor last = found[count > 0 ? count - 1 : 0];
    float searched = count < wanted ? radius * radius : photon_neighbor_distance_squared(last);
    if (nearest_other <= searched)
        assert_true(other == nearest_other);
    else
        assert_true(other > searched);
    if (count > 0)
        qsort(found, count, sizeof *found, compare_neighbors);
    for (uint32_t i = 0; i < count; i++)
        assert_true(found[i] == expected[i]);
    if (count == wanted)
        assert_true(last == expected[wanted - 1]);
}

static void check_query(const photon_tree *tree, vec3 at, vec3 normal, float min_cos, float radius, uint32_t wanted,
                        photon_neighbor *expected, photon_neighbor *found)
{
    uint32_t all = brute_force(tree, at, normal, min_cos, radius, expected);
    float d;
    uint32_t nearest = photon_tree_nearest(tree, at, normal, min_cos, radius, &d);
    assert_int_equal(nearest, all > 0 ? photon_neighbor_index(expected[0]) : PHOTON_NONE);
    if (all > 0)
        assert_true(d == photon_neighbor_distance_squared(expected[0]));
    check_k_nearest(&disc_kernels_plain, tree, at, normal, min_cos, radius, wanted, expected, all, found);
    if (disc_kernels_avx2())
        check_k_nearest(disc_kernels_avx2(), tree, at, normal, min_cos, radius, wanted, expected, all, found);
    if (disc_kernels_avx512())
        check_k_nearest(disc_kernels_avx512(), tree, at, normal, min_cos, radius, wanted, expected, all, found);
}

static void searches_find_what_brute_force_finds(void **state)
{
    (void)state;
    static const uint32_t COUNTS[] = {0, 1, 2, 3, 15, 16, 17, 31, 33, 100, 343, 1500};
    static const uint32_t WANTED[] = {1, 2, 20, 51, 2000};
    static const float RADII[] = {0.0f, 0.1f, 0.25f, 0.7f, 200.0f, INFINITY};
    test_run r;
    test_run_init(&r, 2);
    photon_neighbor *expected = malloc(2000 * sizeof *expected);
    photon_neighbor *found = malloc(photon_neighbors_capacity(2000) * sizeof *found);
    assert_true(expected && found);
    for (int kind = 0; kind < CLOUD_KINDS; kind++)
        for (size_t c = 0; c < sizeof COUNTS / sizeof *COUNTS; c++) {
            uint32_t count = COUNTS[c];
            photon *photons = make_photons((cloud)kind, count, 100 * (uint64_t)kind + c);
            photon_tree tree;
            assert_int_equal(photon_tree_build(&r.run, photons, count, 0.0, 1.0, &tree), AG_OK);
            rng random = test_random(900 + 100 * (uint64_t)kind + c);
            int queries = 96 / (FEWER > 1 ? 4 : 1);
            for (int q = 0; q < queries; q++) {
                vec3 at = random_in_box(&random, (vec3){-1.2f, -1.2f, -1.2f}, (vec3){1.2f, 1.2f, 1.2f});
                if (count > 0 && q % 2 == 0) { /* at a photon, or half-way between two */
                    at = photon_block_position(tree.blocks, (uint32_t)(rng_next(&random) % count));
                    if (q % 4)
                        at = vec3_scale(
                            vec3_add(at, photon_block_position(tree.blocks, (uint32_t)(rng_next(&random) % count))),
                            0.5f);
                }
                vec3 normal = q % 3 == 0 ? random_direction(&random) : (vec3){0.0f, 1.0f, 0.0f};
                check_query(&tree, at, normal, q % 5 == 0 ? 0.0f : 0.5f, RADII[q % 6], WANTED[q / 2 % 5], expected,
                            found);
            }
            photon_tree_reset(&tree);
            free(photons);
        }
    free(expected);
    free(found);
    test_run_reset(&r);
}

static void the_radius_is_inclusive(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon *p = photon_records_create(1);
    assert_non_null(p);
    memset(p, 0, sizeof *p);
    p[0].position[0] = 3.0f, p[0].position[1] = 4.0f;
    p[0].normal = direction_encode((vec3){0.0f, 0.0f, 1.0f});
    photon_tree tree;
    assert_int_equal(photon_tree_build(&r.run, p, 1, 0.0, 1.0, &tree), AG_OK);
    vec3 origin = {0.0f, 0.0f, 0.0f}, up = {0.0f, 0.0f, 1.0f};
    float d;
    photon_neighbor *n = malloc(photon_neighbors_capacity(5) * sizeof *n);
    assert_non_null(n);
    assert_int_equal(photon_tree_nearest(&tree, origin, up, 0.5f, 5.0f, &d), 0);
    assert_int_equal(photon_tree_nearest(&tree, origin, up, 0.5f, 4.999f, &d), PHOTON_NONE);
    assert_int_equal(photon_tree_k_nearest(&tree, origin, up, 0.5f, 5.0f, 5, n, &d), 1);
    assert_int_equal(photon_tree_k_nearest(&tree, origin, up, 0.5f, 4.999f, 5, n, &d), 0);
    /* the cosine has to be above its bound */
    assert_int_equal(photon_tree_nearest(&tree, origin, up, 1.0f, 5.0f, &d), PHOTON_NONE);
    free(n);
    photon_tree_reset(&tree);
    free(p);
    test_run_reset(&r);
}

/* A thin wall: the photons of the far side are nearer, and many, and must not use up the search. */
static void normals_are_tested_inside_the_search(void **state)
{
    (void)state;
    enum { EACH = 1000 };
    test_run r;
    test_run_init(&r, 2);
    photon *p = photon_records_create(2 * EACH);
    assert_non_null(p);
    memset(p, 0, 2 * EACH * sizeof *p);
    rng random = test_random(5);
    for (uint32_t i = 0; i < 2 * EACH; i++) {
        bool front = i < EACH;
        p[i].position[0] = rng_float(&random) * (front ? 1.0f : 0.1f);
        p[i].position[1] = rng_float(&random) * (front ? 1.0f : 0.1f);
        p[i].position[2] = front ? 0.01f : 0.0f;
        p[i].normal = direction_encode((vec3){0.0f, 0.0f, front ? 1.0f : -1.0f});
    }
    photon_tree tree;
    assert_int_equal(photon_tree_build(&r.run, p, 2 * EACH, 0.0, 1.0, &tree), AG_OK);
    photon_neighbor *n = malloc(photon_neighbors_capacity(50) * sizeof *n);
    assert_non_null(n);
    vec3 up = {0.0f, 0.0f, 1.0f};
    float other;
    uint32_t count = photon_tree_k_nearest(&tree, (vec3){0.05f, 0.05f, 0.0f}, up, 0.5f, 1.0f, 50, n, &other);
    assert_int_equal(count, 50);
    assert_true(isinf(other)); /* what faces away is no edge */
    for (uint32_t i = 0; i < count; i++)
        assert_true(photon_block_position(tree.blocks, photon_neighbor_index(n[i])).z > 0.0f);
    float d;
    uint32_t nearest = photon_tree_nearest(&tree, (vec3){0.05f, 0.05f, 0.0f}, up, 0.9f, 1.0f, &d);
    assert_true(nearest != PHOTON_NONE && photon_block_position(tree.blocks, nearest).z > 0.0f);
    free(n);
    photon_tree_reset(&tree);
    free(p);
    test_run_reset(&r);
}

static void any_number_of_threads_builds_the_same_tree(void **state)
{
    (void)state;
    static const unsigned WORKERS[] = {1, 2, 3, 8};
    enum { COUNT = 20000 };
    for (int kind = 0; kind < CLOUD_KINDS; kind++) {
        photon *input = make_photons((cloud)kind, COUNT, (uint64_t)kind), *first = NULL;
        photon_tree first_tree = {0};
        for (size_t w = 0; w < sizeof WORKERS / sizeof *WORKERS; w++) {
            test_run r;
            test_run_init(&r, WORKERS[w]);
            photon *p = make_photons((cloud)kind, COUNT, (uint64_t)kind);
            photon_tree tree;
            assert_int_equal(photon_tree_build(&r.run, p, COUNT, 0.0, 1.0, &tree), AG_OK);
            test_run_reset(&r);
            assert_true(photon_tree_bytes(&tree) <= COUNT); /* 8 bytes for each block and at most another */
            if (w == 0) {
                first = p;
                first_tree = tree;
                continue;
            }
            assert_int_equal(tree.depth, first_tree.depth);
            assert_memory_equal(tree.nodes, first_tree.nodes, photon_tree_bytes(&tree));
            assert_memory_equal(p, first, COUNT * sizeof *p);
            photon_tree_reset(&tree);
            free(p);
        }
        /* no photon is lost or doubled by the reordering: their flux is their number */
        uint64_t sum = 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            uint32_t number = photon_block_flux(first_tree.blocks, i);
            vec3 at = photon_block_position(first_tree.blocks, i);
            assert_true(number < COUNT);
            assert_memory_equal(&at, input[number].position, sizeof at);
            assert_int_equal(photon_block_normal(first_tree.blocks, i), input[number].normal);
            sum += number;
        }
        assert_int_equal(sum, (uint64_t)COUNT * (COUNT - 1) / 2);
        photon_tree_reset(&first_tree);
        free(first);
        free(input);
    }
}

/* Half of the photons lie on a wall across the longest way, a quarter on a floor: what is on a plane stays together. */
static void planes_do_not_part_a_wall(void **state)
{
    (void)state;
    enum { COUNT = 20000, ULPS = 3 };
    test_run r;
    test_run_init(&r, 2);
    photon *p = photon_records_create(COUNT);
    rng random = test_random(5);
    for (uint32_t i = 0; i < COUNT; i++) {
        vec3 at = random_in_box(&random, (vec3){0.0f, 0.0f, 0.0f}, (vec3){40.0f, 30.0f, 30.0f});
        if (i % 2)
            at.x = 40.0f - (float)(rng_next(&random) % ULPS) * 0x1p-18f;
        else if (i % 4 == 0)
            at.y = 0.0f;
        p[i] = (photon){.position = {at.x, at.y, at.z}};
    }
    photon_tree tree;
    assert_int_equal(photon_tree_build(&r.run, p, COUNT, 0.0, 1.0, &tree), AG_OK);
    for (uint32_t level = 0; level < tree.depth; level++) {
        uint32_t each = (uint32_t)PHOTON_BLOCK_LANES << (tree.depth - level);
        for (uint32_t low = 0; low + each / 2 < COUNT; low += each) {
            uint32_t high = low + each < COUNT ? low + each : COUNT, on_it = 0;
            photon_tree_node n = tree.nodes[(1u << level) - 1 + low / each];
            for (uint32_t i = low; i < high; i++) {
                vec3 at = photon_block_position(tree.blocks, i);
                float along = n.axis == 0 ? at.x : n.axis == 1 ? at.y : at.z;
                on_it += fabsf(along - n.split) < 1e-5f;
            }
            assert_true(on_it <= (high - low) / 8);
        }
    }
    photon_tree_reset(&tree);
    free(p);
    test_run_reset(&r);
}

static void a_cancelled_build_says_so(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    photon *p = make_photons(RANDOM, 1000, 1);
    photon_tree tree;
    run_cancel(&r.run);
    assert_int_equal(photon_tree_build(&r.run, p, 1000, 0.0, 1.0, &tree), AG_CANCELLED);
    free(p);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(searches_find_what_brute_force_finds),
        cmocka_unit_test(the_radius_is_inclusive),
        cmocka_unit_test(normals_are_tested_inside_the_search),
        cmocka_unit_test(any_number_of_threads_builds_the_same_tree),
        cmocka_unit_test(planes_do_not_part_a_wall),
        cmocka_unit_test(a_cancelled_build_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
