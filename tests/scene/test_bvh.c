/* test_bvh.c: what rays meet, what stands between two points, and the same answers for any number of builders.
 * Threads: the build's. */
#define _GNU_SOURCE
#include "cpu_count.h"
#include "fixtures/test_scene.h"

#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <sys/wait.h>
#include <unistd.h>

/* Closed, round, from triangles: rings of them between two poles. */
static char *ball_text(int rings, int sectors, const char *before)
{
    size_t size = (size_t)(rings * sectors) * 200 + 1000, used;
    char *text = malloc(size);
    assert_non_null(text);
    used = (size_t)snprintf(text, size, "%s Shape \"trianglemesh\" \"point3 P\" [0 0 1", before);
    for (int i = 1; i < rings; i++)
        for (int j = 0; j < sectors; j++) {
            double t = PI * i / rings, p = 2.0 * PI * j / sectors;
            used +=
                (size_t)snprintf(text + used, size - used, " %.8g %.8g %.8g", sin(t) * cos(p), sin(t) * sin(p), cos(t));
        }
    int last = (rings - 1) * sectors + 1;
    used += (size_t)snprintf(text + used, size - used, " 0 0 -1] \"integer indices\" [");
    for (int j = 0; j < sectors; j++) {
        int next = (j + 1) % sectors;
        used += (size_t)snprintf(text + used, size - used, " 0 %d %d", 1 + j, 1 + next);
        for (int i = 0; i < rings - 2; i++) {
            int a = 1 + i * sectors, b = a + sectors;
            used += (size_t)snprintf(text + used, size - used, " %d %d %d %d %d %d", a + j, b + j, b + next, a + j,
                                     b + next, a + next);
        }
        int a = 1 + (rings - 2) * sectors;
        used += (size_t)snprintf(text + used, size - used, " %d %d %d", a + j, last, a + next);
    }
    snprintf(text + used, size - used, "]");
    return text;
}

static const char *const ROW = "Shape \"disk\" \"float radius\" [1]\n"                               /* 0, at z = 0 */
                               "Translate 0 0 5 Shape \"sphere\" \"float radius\" [1]\n"             /* 1, 4 to 6 */
                               "Translate 0 0 5 Scale 1 1 2 Shape \"sphere\" \"float radius\" [1]\n" /* 2, 8 to 12 */
                               "Translate 0 0 5 Shape \"trianglemesh\" \"point3 P\" [-9 -9 0 9 -9 0 0 9 0 9 9 0] "
                               "\"integer indices\" [1 3 2 0 1 2]\n"; /* 3, at z = 20 */

static void the_nearest_shape_is_met(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, ROW);
    vec3 z = {0.0f, 0.0f, 1.0f}, from = {0.1f, 0.1f, -3.0f};
    static const double AT[] = {-3, 0, 4.01, 8.02, 20};
    static const float STARTS[] = {-3.0f, 0.5f, 6.5f, 12.5f, 20.5f};
    surface_hit hit;
    for (uint32_t i = 0; i < 4; i++) {
        from.z = STARTS[i];
        assert_true(scene_intersect(s, scene_ray_make(from, z), INFINITY, &hit));
        assert_int_equal(hit.shape_index, i);
        assert_close(hit.position.z, AT[i + 1], 0.03);
        assert_close(hit.distance, hit.position.z - from.z, 1e-5);
        assert_int_equal(hit.primitive_index, i == 3 ? 1 : 0);
        /* a ray that ends before it, and one that ends behind */
        assert_false(scene_intersect(s, scene_ray_make(from, z), hit.distance * 0.999f, &hit));
        assert_true(scene_intersect(s, scene_ray_make(from, z), hit.distance * 1.001f, &hit));
    }
    from.z = STARTS[4];
    assert_false(scene_intersect(s, scene_ray_make(from, z), INFINITY, &hit));
    /* the other way round, from the far end; a direction of length 2 counts in its own lengths */
    assert_true(scene_intersect(s, scene_ray_make(from, (vec3){0.0f, 0.0f, -2.0f}), INFINITY, &hit));
    assert_int_equal(hit.shape_index, 3);
    assert_close(hit.distance, 0.25, 1e-6);
    /* the two triangles of the mesh */
    assert_true(scene_intersect(s, scene_ray_make((vec3){8.0f, 8.0f, 19.0f}, z), INFINITY, &hit));
    assert_int_equal(hit.primitive_index, 0);
    scene_destroy(s);
    test_run_reset(&r);
}

static void each_kind_of_shape_occludes(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, ROW);
    static const float BEFORE[] = {-1.0f, 3.0f, 7.0f, 19.0f}, BEHIND[] = {1.0f, 7.0f, 13.0f, 21.0f};
    for (int i = 0; i < 4; i++) {
        vec3 a = {0.2f, 0.1f, BEFORE[i]}, b = {0.2f, 0.1f, BEHIND[i]}, beside = {-30.0f, 0.1f, BEHIND[i]};
        assert_true(is_blocked_between(s, a, b));
        assert_true(is_blocked_between(s, b, a));
        assert_false(is_blocked_between(s, a, (vec3){a.x, a.y, a.z + 0.9f}));
        assert_false(is_blocked_between(s, b, (vec3){b.x, b.y, b.z - 0.9f}));
        assert_false(is_blocked_between(s, b, beside));
        assert_true(scene_occluded(s, scene_ray_make(a, (vec3){0.0f, 0.0f, 1.0f}), INFINITY));
        assert_false(scene_occluded(s, scene_ray_make(a, (vec3){-1.0f, 0.0f, 0.0f}), INFINITY));
    }
    scene_destroy(s);
    test_run_reset(&r);
}

static void an_empty_scene_is_met_by_nothing(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = test_scene_create(&r, "");
    surface_hit hit;
    vec3 origin = {0.0f, 0.0f, 0.0f}, z = {0.0f, 0.0f, 1.0f};
    assert_false(scene_intersect(s, scene_ray_make(origin, z), INFINITY, &hit));
    assert_false(is_blocked_between(s, origin, z));
    assert_false(scene_occluded(s, scene_ray_make(origin, z), INFINITY));
    scene_destroy(s);
    test_run_reset(&r);
}

/* Rays at points on the edges, closely past the vertices and anywhere, from inside of a closed mesh and of spheres.
 * (At a vertex itself, met to the last bit, Embree's robust mode misses some rays in a thousand.) */
/* Embree would end the process. */
static void rays_beyond_reach_meet_nothing(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, "Shape \"sphere\" Scale 1 1 2 Shape \"sphere\" \"float radius\" 1e17");
    static const float BAD[] = {NAN, INFINITY, -INFINITY, 2e18f, -3e38f};
    const vec3 z = {0.0f, 0.0f, 1.0f};
    surface_hit hit;
    assert_true(scene_intersect(s, (scene_ray){.direction = z}, INFINITY, &hit));
    assert_true(scene_occluded(s, (scene_ray){.direction = z}, INFINITY));
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++)
        for (int axis = 0; axis < 6; axis++) {
            float v[6] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f};
            v[axis] = BAD[i];
            scene_ray ray = {.origin = {v[0], v[1], v[2]}, .direction = {v[3], v[4], v[5]}};
            assert_false(scene_intersect(s, ray, INFINITY, &hit));
            assert_false(scene_occluded(s, ray, INFINITY));
        }
    assert_false(scene_intersect(s, (scene_ray){.direction = z}, NAN, &hit));
    assert_false(scene_occluded(s, (scene_ray){.direction = z}, -1.0f));
    scene_destroy(s);
    test_run_reset(&r);
}

static void closed_surfaces_let_nothing_through(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    char *text = ball_text(40, 60, "Translate 30 -40 100 Rotate 35 1 2 3 Scale 3 2 5");
    const char *const worlds[] = {text, "Translate 300 20 1 Scale 3 3 3 Shape \"sphere\"",
                                  "Translate 3 20 1 Rotate 10 1 2 3 Scale 3 1 0.2 Shape \"sphere\""};
    for (int k = 0; k < 3; k++) {
        scene *s = test_scene_create(&r, worlds[k]);
        rng random = test_random(1);
        const mesh *m = &s->shapes[0].as.mesh;
        for (uint32_t i = 0; i < 200000 / FEWER; i++) {
            vec3 from = vec3_add_scaled(s->bounding_center, random_direction(&random), 0.03f * s->bounding_radius);
            vec3 direction = random_direction(&random);
            if (k == 0 && i % 3 < 2) {
                const uint32_t *index = m->indices + 3 * (rng_next(&random) % m->triangle_count);
                vec3 a = m->positions[index[0]], b = m->positions[index[1]];
                vec3 beside = vec3_add_scaled(a, random_direction(&random), 1e-5f * s->bounding_radius);
                vec3 on_edge = vec3_add_scaled(a, vec3_sub(b, a), rng_float(&random));
                direction = vec3_normalize(vec3_sub(i % 3 == 0 ? beside : on_edge, from));
            }
            surface_hit hit;
            assert_true(scene_intersect(s, scene_ray_make(from, direction), INFINITY, &hit));
            assert_true(scene_occluded(s, scene_ray_make(from, direction), INFINITY));
        }
        scene_destroy(s);
    }
    free(text);
    test_run_reset(&r);
}

/* Two meshes that coincide, so that equal distances must be told apart, beside spheres of both kinds. */
static void any_number_of_builders_gives_the_same_hits(void **state)
{
    (void)state;
    static const unsigned WORKERS[] = {1, 2, 3, 8};
    enum { RAYS = 4000 };
    char *ball = ball_text(60, 120, "Translate 3 4 5");
    size_t size = 2 * strlen(ball) + 512;
    char *text = malloc(size);
    assert_non_null(text);
    snprintf(text, size,
             "AttributeBegin %s AttributeEnd\nAttributeBegin %s AttributeEnd\nTranslate 3 4 5 Shape \"sphere\" \"float "
             "radius\" "
             "[0.8]\nScale 0.2 1.2 0.2 Shape \"sphere\"\n",
             ball, ball);
    static surface_hit first[RAYS], hits[RAYS];
    for (size_t w = 0; w < sizeof WORKERS / sizeof *WORKERS; w++) {
        test_run r;
        test_run_init(&r, WORKERS[w]);
        scene *s = test_scene_create(&r, text);
        assert_true(bvh_memory_bytes(s->bvh) > 10000);
        assert_string_equal(bvh_isa(s->bvh), "avx2");
        rng random = test_random(2);
        uint32_t met = 0;
        memset(hits, 0, sizeof hits);
        for (uint32_t i = 0; i < RAYS; i++) {
            vec3 from = vec3_add_scaled(s->bounding_center, random_direction(&random), 4.0f);
            vec3 to = vec3_add_scaled(s->bounding_center, random_direction(&random), 1.1f);
            met += scene_intersect(s, scene_ray_make(from, vec3_normalize(vec3_sub(to, from))), INFINITY, &hits[i]);
        }
        assert_true(met > RAYS / 2 && met < RAYS);
        if (w == 0)
            memcpy(first, hits, sizeof hits);
        assert_memory_equal(hits, first, sizeof hits);
        scene_destroy(s);
        test_run_reset(&r);
    }
    free(text);
    free(ball);
}

/* Embree allocates by this. While memory is short on threads but the first, these get none for large pieces. */
static atomic_bool memory_is_short;
static atomic_int refused_count;
static pthread_t first_thread;

#if !IS_SANITIZED
__attribute__((visibility("default"))) int posix_memalign(void **out, size_t alignment, size_t size)
{
    enum { LARGE = 4096 };
    if (size >= LARGE && atomic_load(&memory_is_short) && !pthread_equal(pthread_self(), first_thread)) {
        atomic_fetch_add(&refused_count, 1);
        return ENOMEM;
    }
    *out = aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    return *out ? 0 : ENOMEM;
}
#endif

enum { THERE, NO_MEMORY, WRONG };

/* In a process of its own, which ends without releasing what it has. */
static int build_without_memory(const char *text)
{
    test_run r;
    test_run_init(&r, 4);
    scene *s = scene_create();
    surface_hit hit;
    if (pbrt_parse_text(&r.run, "t", text, strlen(text), s) != AG_OK)
        return WRONG;
    first_thread = pthread_self();
    atomic_store(&memory_is_short, true);
    const ag_status status = scene_commit(s, &r.run, NULL);
    atomic_store(&memory_is_short, false);
    if (atomic_load(&refused_count) > 0)
        return status == AG_ERROR_MEMORY ? NO_MEMORY : WRONG;
    const scene_ray ray = scene_ray_make((vec3){0.1f, 0.1f, -3.0f}, (vec3){0.0f, 0.0f, 1.0f});
    return status == AG_OK && scene_intersect(s, ray, INFINITY, &hit) ? THERE : WRONG;
}

/* Whichever of the builders meets the end of memory, the build says so. */
static void any_builder_without_memory_is_an_error(void **state)
{
    (void)state;
    int seen[WRONG + 1] = {0};
    if (IS_SANITIZED)
        skip(); /* memory is not refused there, and a child of TSan's may not begin threads */
    char *text = ball_text(400, 400, "WorldBegin");
    for (int i = 0; i < 8; i++) {
        const pid_t child = fork();
        int ended;
        assert_true(child >= 0);
        if (child == 0)
            _exit(build_without_memory(text));
        assert_int_equal(waitpid(child, &ended, 0), child);
        assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) <= WRONG);
        seen[WEXITSTATUS(ended)]++;
    }
    free(text);
    print_message("%d of 8 builds were without memory\n", seen[NO_MEMORY]);
    assert_int_equal(seen[WRONG], 0);
    if (cpu_count_available() > 1) /* else no other thread builds */
        assert_true(seen[NO_MEMORY] > 0);
}

static void a_cancelled_build_says_so(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = scene_create();
    assert_int_equal(pbrt_parse_text(&r.run, "t", "WorldBegin Shape \"sphere\"", 25, s), AG_OK);
    run_cancel(&r.run);
    assert_int_equal(scene_commit(s, &r.run, NULL), AG_CANCELLED);
    scene_destroy(s);
    test_run_reset(&r);
}

/* --- fans --- */

static ray_fan fan_from(vec3 from, uint32_t count, rng *random)
{
    ray_fan f;
    f.common = scene_ray_make(from, (vec3){0.0f, 0.0f, 0.0f});
    f.count = count;
    for (uint32_t i = 0; i < count; i++) {
        vec3 d = random_direction(random);
        f.direction[0][i] = d.x, f.direction[1][i] = d.y, f.direction[2][i] = d.z;
    }
    return f;
}

static scene_ray fan_ray(const ray_fan *f, uint32_t i)
{
    scene_ray ray = f->common;
    ray.direction = ray_fan_direction(f, i);
    return ray;
}

/* Whether ray i met what the ray alone does, but for rounding. */
static bool meets_the_same(const scene *s, const ray_fan *f, uint32_t i)
{
    surface_hit alone, hit;
    bool is_met = scene_intersect(s, fan_ray(f, i), INFINITY, &alone);
    if (!is_met || f->met[i].distance == INFINITY)
        return !is_met && f->met[i].distance == INFINITY;
    ray_fan_hit(s, f, i, &hit);
    if (hit.shape_index != alone.shape_index || hit.instance_index != alone.instance_index)
        return false;
    vec3 off = vec3_sub(hit.position, alone.position);
    surface_point at_hit;
    const rgb *albedo = ray_fan_plain_point(s, f, i, &at_hit);
    if (albedo) { /* it is the point of the hit, with its normal on the ray's side */
        assert_ptr_equal(albedo, &s->materials[s->shapes[hit.shape_index].material_index].reflectance);
        assert_memory_equal(&at_hit.position, &hit.position, sizeof at_hit.position);
        vec3 facing = vec3_face_forward(hit.geometric_normal, vec3_negate(ray_fan_direction(f, i)));
        assert_memory_equal(&at_hit.normal, &facing, sizeof at_hit.normal);
    }
    return vec3_length(off) < 1e-3f && fabsf(hit.distance - alone.distance) < 1e-3f &&
           vec3_dot(hit.geometric_normal, alone.geometric_normal) > 0.999f;
}

/* A world with every kind of shape: meshes with and without holes, both kinds of round shapes, curves and instances, in
 * a box. */
static char *fan_world(void)
{
    static const char *const REST =
        "AttributeBegin Translate 2 0 0 Scale 0.5 1 0.7 Shape \"sphere\" AttributeEnd\n"
        "AttributeBegin Translate -2 0 0 ReverseOrientation Shape \"sphere\" \"float radius\" 0.7 AttributeEnd\n"
        "AttributeBegin Translate 0 2 0 Shape \"cylinder\" \"float radius\" 0.5 AttributeEnd\n"
        "AttributeBegin Translate 0 -2 0 Shape \"disk\" AttributeEnd\n"
        "Texture \"holes\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" 1 \"float uscale\" 6 \"float "
        "vscale\" 6\n"
        "AttributeBegin Translate 0 0 2.5 Shape \"sphere\" \"texture alpha\" \"holes\" AttributeEnd\n"
        "Shape \"trianglemesh\" \"point3 P\" [-3 -3 -2 3 -3 -2 3 3 -2 -3 3 -2] \"integer indices\" [0 1 2 0 2 3] \"point2 "
        "uv\" [0 0 1 0 1 1 0 1] \"texture alpha\" \"holes\"\n"
        "Shape \"curve\" \"string type\" \"cylinder\" \"point3 P\" [-3 1 1 -1 2 1 1 0 1 3 1 1] \"float width\" 0.3\n"
        "ObjectBegin \"o\" Shape \"sphere\" Shape \"disk\" \"float radius\" 2 ObjectEnd\n"
        "AttributeBegin Translate 2 2 -1 Scale 0.4 0.5 0.6 ObjectInstance \"o\" AttributeEnd\n"
        "AttributeBegin Translate -2 2 -1 Rotate 40 1 2 3 Scale 0.4 0.4 0.4 ObjectInstance \"o\" AttributeEnd\n"
        "AttributeBegin Translate -2 -2 1 Scale 0.4 0.4 0.4 ActiveTransform EndTime Translate 3 1 0 Rotate 150 1 2 -1 "
        "ActiveTransform All ObjectInstance \"o\" AttributeEnd\n";
    char *ball = ball_text(20, 30, "Scale 6 6 6");
    size_t size = strlen(ball) + strlen(REST) + 64;
    char *text = malloc(size);
    assert_non_null(text);
    snprintf(text, size, "AttributeBegin %s AttributeEnd\n%s", ball, REST);
    free(ball);
    return text;
}

static void a_fan_meets_what_its_rays_meet_alone(void **state)
{
    (void)state;
    static const char *const ISAS[] = {"sse2", "sse4.2", "avx", "avx2"};
    char *text = fan_world();
    for (size_t k = 0; k < sizeof ISAS / sizeof *ISAS; k++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = scene_create();
        char *world = malloc(strlen(text) + 16);
        assert_non_null(world);
        sprintf(world, "WorldBegin\n%s", text);
        assert_int_equal(pbrt_parse_text(&r.run, "t", world, strlen(world), s), AG_OK);
        assert_int_equal(scene_commit(s, &r.run, ISAS[k]), AG_OK);
        free(world);
        rng random = test_random(4);
        uint32_t rays = 0, others = 0, seen[16] = {0}, in_instances = 0;
        for (uint32_t round = 0; round < 1200 / FEWER; round++) {
            uint32_t count = round % (RAY_FAN_MAX + 1);
            ray_fan f = fan_from(random_in_box(&random, (vec3){-3, -3, -3}, (vec3){3, 3, 3}), count, &random);
            f.common.alpha_rule = round % 2 ? RAY_MEETS_ALPHA : RAY_PASSES_ALPHA;
            f.common.time = rng_float(&random);
            scene_intersect_fan(s, &f);
            for (uint32_t i = 0; i < count; i++) {
                rays++;
                others += !meets_the_same(s, &f, i); /* at an outline, rounding decides */
                assert_true(f.met[i].distance < INFINITY);
                seen[f.met[i].geometry]++;
                surface_hit hit;
                ray_fan_hit(s, &f, i, &hit);
                in_instances += hit.instance_index != SCENE_NO_INSTANCE;
            }
        }
        assert_true(others <= rays / 2000);
        for (int i = 0; i < 8; i++)
            assert_true(seen[i] > 0);
        assert_true(in_instances > rays / 100);
        scene_destroy(s);
        test_run_reset(&r);
    }
    free(text);
}

static void fans_do_not_leave_closed_surfaces(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    char *text = ball_text(40, 60, "Translate 30 -40 100 Rotate 35 1 2 3 Scale 3 2 5");
    scene *s = test_scene_create(&r, text);
    const mesh *m = &s->shapes[0].as.mesh;
    rng random = test_random(5);
    for (uint32_t round = 0; round < 4000 / FEWER; round++) {
        vec3 from = vec3_add_scaled(s->bounding_center, random_direction(&random), 0.03f * s->bounding_radius);
        ray_fan f = fan_from(from, RAY_FAN_MAX, &random);
        for (uint32_t i = 0; i < RAY_FAN_MAX / 2; i++) { /* half of them at edges */
            const uint32_t *index = m->indices + 3 * (rng_next(&random) % m->triangle_count);
            vec3 a = m->positions[index[0]], b = m->positions[index[1]];
            vec3 d = vec3_normalize(vec3_sub(vec3_add_scaled(a, vec3_sub(b, a), rng_float(&random)), from));
            f.direction[0][i] = d.x, f.direction[1][i] = d.y, f.direction[2][i] = d.z;
        }
        scene_intersect_fan(s, &f);
        for (uint32_t i = 0; i < RAY_FAN_MAX; i++)
            assert_true(f.met[i].distance < 6.0f);
    }
    free(text);
    scene_destroy(s);
    test_run_reset(&r);
}

static void rays_of_a_fan_beyond_reach_meet_nothing(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, "Shape \"sphere\"");
    static const float BAD[] = {NAN, INFINITY, -INFINITY, 2e18f};
    rng random = test_random(6);
    for (uint32_t count = 1; count <= RAY_FAN_MAX; count++)
        for (size_t k = 0; k < sizeof BAD / sizeof *BAD; k++) {
            ray_fan f = fan_from((vec3){0.1f, 0.2f, 0.3f}, count, &random);
            f.direction[k % 3][count / 2] = BAD[k];
            scene_intersect_fan(s, &f);
            for (uint32_t i = 0; i < count; i++)
                assert_int_equal(f.met[i].distance < INFINITY, i != count / 2);
            f.common.origin.y = BAD[k];
            scene_intersect_fan(s, &f);
            for (uint32_t i = 0; i < count; i++)
                assert_true(f.met[i].distance == INFINITY);
        }
    scene_destroy(s);
    test_run_reset(&r);
}

static void the_instruction_set_can_be_chosen(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = scene_create();
    assert_int_equal(pbrt_parse_text(&r.run, "t", "WorldBegin Shape \"sphere\"", 25, s), AG_OK);
    assert_int_equal(scene_commit(s, &r.run, "sse2"), AG_OK);
    assert_string_equal(bvh_isa(s->bvh), "sse2");
    surface_hit hit;
    assert_true(
        scene_intersect(s, scene_ray_make((vec3){0.0f, 0.0f, -3.0f}, (vec3){0.0f, 0.0f, 1.0f}), INFINITY, &hit));
    assert_close(hit.distance, 2.0, 1e-5);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_shape_is_met),
        cmocka_unit_test(each_kind_of_shape_occludes),
        cmocka_unit_test(an_empty_scene_is_met_by_nothing),
        cmocka_unit_test(rays_beyond_reach_meet_nothing),
        cmocka_unit_test(closed_surfaces_let_nothing_through),
        cmocka_unit_test(any_number_of_builders_gives_the_same_hits),
        cmocka_unit_test(a_cancelled_build_says_so),
        cmocka_unit_test(any_builder_without_memory_is_an_error),
        cmocka_unit_test(a_fan_meets_what_its_rays_meet_alone),
        cmocka_unit_test(fans_do_not_leave_closed_surfaces),
        cmocka_unit_test(rays_of_a_fan_beyond_reach_meet_nothing),
        cmocka_unit_test(the_instruction_set_can_be_chosen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
