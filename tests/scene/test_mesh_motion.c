/* test_mesh_motion.c: meshes whose vertices move: what a ray of a time meets is the mesh that stands still there, with
 * its normals, tangents, holes and place in instances; where it was at the opening of the shutter; what is refused.
 * Threads: the build's. */
/* ctest: sanitize */
#include "fixtures/test_scene.h"

#include "material/bsdf.h"
#include "rays/clear_space.h"
#include "scene_hash.h"
#include "shape/mesh_motion.h"

enum { SIDE = 4, POINTS = SIDE * SIDE, STEPS = 4, TEXT_SIZE = 1 << 15 };

/* A wavy sheet at each step, with normals, tangents and uvs. */
typedef struct sheet {
    vec3 p[STEPS][POINTS], n[STEPS][POINTS], s[STEPS][POINTS];
} sheet;

static sheet random_sheet(uint64_t seed)
{
    sheet made;
    rng random = test_random(seed);
    for (int k = 0; k < STEPS; k++)
        for (int i = 0; i < POINTS; i++) {
            const float x = (float)(i % SIDE) / (SIDE - 1), y = (float)(i / SIDE) / (SIDE - 1);
            made.p[k][i] = random_in_box(&random, (vec3){x, y, -0.2f}, (vec3){x + 0.2f, y + 0.2f, 0.2f});
            made.p[k][i].x += 0.7f * (float)k;
            made.n[k][i] = vec3_normalize(vec3_add_scaled((vec3){0, 0, 1}, random_direction(&random), 0.4f));
            made.s[k][i] = (vec3){1.0f, rng_float(&random) - 0.5f, rng_float(&random) - 0.5f}; /* of largest number 1 */
        }
    return made;
}

static void append_vectors(char *text, const char *name, const vec3 *v, int count)
{
    size_t at = strlen(text);
    at += (size_t)snprintf(text + at, TEXT_SIZE - at, "\"%s\" [", name);
    for (int i = 0; i < count; i++)
        at += (size_t)snprintf(text + at, TEXT_SIZE - at, "%.9g %.9g %.9g ", (double)v[i].x, (double)v[i].y,
                               (double)v[i].z);
    snprintf(text + at, TEXT_SIZE - at, "] ");
}

/* Writes a Shape of `count` sheets, one after the other. */
static void write_sheet(char *text, const sheet *s, int count, const char *before, const char *after)
{
    snprintf(text, TEXT_SIZE, "%s Shape \"trianglemesh\" %s ", before, after);
    append_vectors(text, "point3 P", s->p[0], count * POINTS);
    append_vectors(text, "normal N", s->n[0], count * POINTS);
    append_vectors(text, "vector3 S", s->s[0], count * POINTS);
    size_t at = strlen(text);
    at += (size_t)snprintf(text + at, TEXT_SIZE - at, "\"integer motionsteps\" %d \"point2 uv\" [", count);
    for (int i = 0; i < POINTS; i++)
        at += (size_t)snprintf(text + at, TEXT_SIZE - at, "%g %g ", i % SIDE * 0.5, i / SIDE * 0.25);
    at += (size_t)snprintf(text + at, TEXT_SIZE - at, "] \"integer indices\" [");
    for (int y = 0; y + 1 < SIDE; y++)
        for (int x = 0; x + 1 < SIDE; x++) {
            const int c = y * SIDE + x;
            at += (size_t)snprintf(text + at, TEXT_SIZE - at, "%d %d %d %d %d %d ", c, c + 1, c + SIDE, c + 1,
                                   c + SIDE + 1, c + SIDE);
        }
    snprintf(text + at, TEXT_SIZE - at, "]\n");
}

/* The sheet as it stands at a time. */
static sheet sheet_at(const sheet *s, float time)
{
    sheet still = *s;
    const float at = time * (STEPS - 1), step = fminf(floorf(at), STEPS - 2), share = at - step;
    const int k = (int)step;
    for (int i = 0; i < POINTS; i++) {
        still.p[0][i] = vec3_add(vec3_scale(s->p[k][i], 1.0f - share), vec3_scale(s->p[k + 1][i], share));
        still.n[0][i] = vec3_add(vec3_scale(s->n[k][i], 1.0f - share), vec3_scale(s->n[k + 1][i], share));
        still.s[0][i] = vec3_add(vec3_scale(s->s[k][i], 1.0f - share), vec3_scale(s->s[k + 1][i], share));
    }
    return still;
}

static scene_ray random_ray(rng *random, const scene *s, float time)
{
    vec3 from = vec3_add_scaled(s->bounding_center, random_direction(random), 3.0f * s->bounding_radius);
    vec3 to = random_in_box(random, s->bounds_min, s->bounds_max);
    scene_ray ray = scene_ray_make(from, vec3_normalize(vec3_sub(to, from)));
    ray.time = time;
    return ray;
}

static void expect_near(vec3 a, vec3 b, float tolerance)
{
    if (!(vec3_length(vec3_sub(a, b)) <= tolerance))
        fail_msg("(%g %g %g) is not (%g %g %g)", (double)a.x, (double)a.y, (double)a.z, (double)b.x, (double)b.y,
                 (double)b.z);
}

/* Holds a hit of what moves against that of what stands there: where, how it is turned and how it runs. */
static void expect_same_hit(const scene *moving, const surface_hit *a, const scene *still, const surface_hit *b)
{
    expect_near(a->position, b->position, 2e-5f);
    expect_near(a->geometric_normal, b->geometric_normal, 1e-4f);
    expect_near(a->shading_normal, b->shading_normal, 1e-3f);
    assert_close(a->uv.x, b->uv.x, 1e-3);
    assert_close(a->uv.y, b->uv.y, 1e-3);
    assert_true(a->epsilon >= 0.9f * b->epsilon && a->epsilon < 1e-3f);
    const surface_differentials of_a = surface_differentials_at(moving, a), of_b = surface_differentials_at(still, b);
    expect_near(of_a.dpdu, of_b.dpdu, 1e-3f * vec3_length(of_b.dpdu) + 1e-5f);
    expect_near(of_a.dpdv, of_b.dpdv, 1e-3f * vec3_length(of_b.dpdv) + 1e-5f);
    expect_near(of_a.dndu, of_b.dndu, 1e-2f * vec3_length(of_b.dndu) + 1e-3f);
    expect_near(of_a.dndv, of_b.dndv, 1e-2f * vec3_length(of_b.dndv) + 1e-3f);
    vec3 along_a, aside_a, along_b, aside_b;
    surface_tangents(moving, a, &along_a, &aside_a);
    surface_tangents(still, b, &along_b, &aside_b);
    expect_near(along_a, along_b, 2e-3f);
    assert_true(surface_uv_axes(moving, a, &along_a, &aside_a) && surface_uv_axes(still, b, &along_b, &aside_b));
    expect_near(along_a, along_b, 1e-3f * vec3_length(along_b) + 1e-5f);
}

/* before: places the shape, without a stretch, under which a mean of normals would differ from one at rest. */
static void expect_met_where_it_is(test_run *r, const char *before, const char *after, const char *end, uint64_t seed)
{
    static char text[TEXT_SIZE], whole[TEXT_SIZE + 1024];
    rng random = test_random(seed);
    const sheet s = random_sheet(seed);
    write_sheet(text, &s, STEPS, before, after);
    snprintf(whole, sizeof whole, "%s %s", text, end);
    scene *moving = test_scene_create(r, whole);
    uint32_t met = 0, different = 0;
    assert_true(moving->has_motion && moving->has_deforming);
    for (int t = 0; t <= 10; t++) {
        const float time = (float)t / 10.0f;
        const sheet at = sheet_at(&s, time);
        write_sheet(text, &at, 1, before, after);
        snprintf(whole, sizeof whole, "%s %s", text, end);
        scene *still = test_scene_create(r, whole);
        assert_false(still->has_deforming);
        for (uint32_t i = 0; i < 2000 / FEWER; i++) {
            const scene_ray ray = random_ray(&random, moving, time);
            surface_hit a, b;
            const bool is_a = scene_intersect(moving, ray, INFINITY, &a),
                       is_b = scene_intersect(still, ray, INFINITY, &b);
            assert_int_equal(is_a, scene_occluded(moving, ray, INFINITY));
            if (is_a && is_b && a.primitive_index == b.primitive_index && fabsf(a.distance - b.distance) < 1e-3f) {
                met++;
                if (fabsf(vec3_dot(ray.direction, b.geometric_normal)) > 0.1f)
                    expect_same_hit(moving, &a, still, &b);
            } else {
                different += is_a != is_b; /* an edge */
            }
        }
        scene_destroy(still);
    }
    assert_true(met > 400 / FEWER);
    assert_true(different <= 4);
    scene_destroy(moving);
}

static void vertices_are_met_where_they_are(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    expect_met_where_it_is(&r, "", "", "", 1);
    expect_met_where_it_is(&r, "Translate 1 2 -1 Rotate 40 1 2 3 Scale -2 2 2 ReverseOrientation", "", "", 2);
    expect_met_where_it_is(&r, "ObjectBegin \"a\"", "",
                           "ObjectEnd Rotate 70 1 0 1 Scale 1 -2 1 ObjectInstance \"a\" Translate 0 0 4 "
                           "ObjectInstance \"a\"",
                           3);
    /* the two motions one after the other */
    expect_met_where_it_is(&r, "ActiveTransform EndTime Translate 1 0 0 Rotate 60 0 1 0 ActiveTransform All", "", "",
                           4);
    expect_met_where_it_is(&r, "ObjectBegin \"a\" Scale 2 2 2", "",
                           "ObjectEnd ActiveTransform EndTime Translate 1 3 0 Rotate 60 0 1 0 ActiveTransform All "
                           "ObjectInstance \"a\"",
                           5);
    test_run_reset(&r);
}

/* Holes go with the surface, or stay in space, as their texture does. */
static void alpha_is_that_of_the_time(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    expect_met_where_it_is(&r,
                           "Texture \"holes\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" 1 "
                           "\"float uscale\" 4 \"float vscale\" 8",
                           "\"texture alpha\" \"holes\"", "", 6);
    expect_met_where_it_is(&r,
                           "AttributeBegin Scale .1 .1 .1 Texture \"holes\" \"float\" \"checkerboard\" "
                           "\"integer dimension\" 3 \"float tex1\" 0 \"float tex2\" 1 AttributeEnd",
                           "\"texture alpha\" \"holes\"", "", 7);
    test_run_reset(&r);
}

/* A ray that leaves a triangle does not meet it again, also where it comes by from far away, and its own coordinates
 * are small then. */
static void starts_are_clean(void **state)
{
    (void)state;
    static const double AWAY[] = {0.0, 100.0, 1e5};
    static char text[TEXT_SIZE];
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(8);
    for (int a = 0; a < 3; a++) {
        sheet s = random_sheet(9);
        for (int i = 0; i < POINTS; i++)
            for (int k = 0; k < STEPS; k++) {
                const float off = (float)AWAY[a] * (k % 2 ? 1.0f : -1.0f);
                s.p[k][i] = vec3_add(s.p[k][i], (vec3){off, 0.5f * off, 0.0f});
            }
        write_sheet(text, &s, STEPS, "", "");
        scene *made = test_scene_create(&r, text);
        uint32_t met = 0;
        for (uint32_t i = 0; i < 20000 / FEWER; i++) {
            const float time = a == 0 ? rng_float(&random) : (0.5f + 1e-3f * rng_float(&random)) / (STEPS - 1);
            const sheet at = sheet_at(&s, time);
            const vec3 to = vec3_add_scaled(at.p[0][5], random_direction(&random), 0.3f);
            const vec3 from = vec3_add_scaled(to, random_direction(&random), 5.0f);
            scene_ray ray = scene_ray_make(from, vec3_normalize(vec3_sub(to, from)));
            ray.time = time;
            surface_hit hit, again;
            if (!scene_intersect(made, ray, INFINITY, &hit))
                continue;
            met++;
            const scene_ray next = surface_ray(&hit, ray, random_direction(&random));
            if (scene_intersect(made, next, INFINITY, &again) && again.primitive_index == hit.primitive_index)
                fail_msg("a ray meets its own triangle, %g from it", (double)again.distance);
        }
        assert_true(met > 100 / FEWER);
        scene_destroy(made);
    }
    test_run_reset(&r);
}

/* Three times as large in the end, and elsewhere; also while an instance moves it and makes it larger still. */
static void a_surface_is_found_where_it_was_at_first(void **state)
{
    (void)state;
    static const char *const MOVES[] = {
        "", "ActiveTransform EndTime Translate 5 0 1 Rotate 80 1 0 1 Scale 2 2 2 ActiveTransform All ",
        "Scale 2 2 2 Translate 1 1 1 ReverseOrientation "};
    static char text[TEXT_SIZE];
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(10);
    for (int move = 0; move < 3; move++) {
        sheet s = random_sheet(11);
        memset(s.n, 0, sizeof s.n); /* the triangles' own normals, whose outside does not change */
        for (int i = 0; i < POINTS; i++)
            for (int k = 1; k < STEPS; k++) {
                const float t = (float)k / (STEPS - 1);
                s.p[k][i] = vec3_add_scaled(vec3_scale(s.p[0][i], 1.0f + 2.0f * t), (vec3){4, 0, 1}, t);
            }
        write_sheet(text, &s, STEPS, MOVES[move], "");
        scene *made = test_scene_create(&r, text);
        uint32_t checked = 0;
        for (uint32_t i = 0; i < 20000 / FEWER; i++) {
            const float time = rng_float(&random);
            const scene_ray ray = random_ray(&random, made, time);
            surface_hit hit, first;
            if (!scene_intersect(made, ray, INFINITY, &hit))
                continue;
            const surface_rest rest = surface_at_opening(made, &hit);
            const double scale = (1.0 + 2.0 * (double)time) * (move == 1 ? 1.0 + (double)time : 1.0);
            assert_relative(rest.area_ratio, 1.0 / (scale * scale), 2e-3);
            assert_close(vec3_length(rest.geometric_normal), 1.0, 1e-5);
            const vec3 above = vec3_add_scaled(rest.position, rest.geometric_normal, 1e-3f);
            if (!scene_intersect(made, scene_ray_make(above, vec3_negate(rest.geometric_normal)), 3e-3f, &first) ||
                first.primitive_index != hit.primitive_index)
                continue; /* an edge */
            checked++;
            expect_near(first.position, rest.position, 1e-4f);
            expect_near(first.geometric_normal, rest.geometric_normal, 2e-3f);
            assert_close(first.uv.x, hit.uv.x, 2e-3);
            assert_close(first.uv.y, hit.uv.y, 2e-3);
        }
        assert_true(checked > 200 / FEWER);
        scene_destroy(made);
    }
    test_run_reset(&r);
}

/* Of a triangle 4000 times as long as it is wide each point is found where it was, also where it is tilted. */
static void a_sliver_is_found_where_it_was_at_first(void **state)
{
    (void)state;
    static const vec3 SLIVERS[][3] = {{{0, 0, 0}, {2, 0, 0}, {2, 5e-4f, 0}},
                                      {{0.3f, -0.2f, 0.1f}, {1.5f, 1.0f, 1.1f}, {1.50035f, 0.99965f, 1.1f}}};
    for (int i = 0; i < 2; i++) {
        vec3 positions[7] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        uint32_t indices[3] = {0, 1, 2};
        const mesh m = {3, 1, 1, positions, .indices = indices};
        memcpy(positions + 3, SLIVERS[i], sizeof SLIVERS[i]);
        const vec3 e1 = vec3_sub(positions[4], positions[3]), e2 = vec3_sub(positions[5], positions[3]),
                   normal = vec3_normalize(vec3_cross(e1, e2));
        const float square = vec3_length_squared(vec3_cross(e1, e2)), tolerance = i == 0 ? 1e-5f : 2e-3f;
        for (int k = 0; k <= 10; k++)
            for (int j = 0; j <= 10 - k; j++) {
                const float b1 = 0.1f * (float)k, b2 = 0.1f * (float)j;
                vec3 point = vec3_add_scaled(vec3_add_scaled(positions[3], e1, b1), e2, b2);
                double area[3] = {(double)normal.x, (double)normal.y, (double)normal.z};
                mesh_move_to_opening(&m, 0, 1.0f, &point, area);
                expect_near(point, (vec3){b1, b2, 0.0f}, tolerance);
                assert_true(fabs(area[0]) + fabs(area[1]) < 1e-9);
                assert_relative(area[2], 1.0 / sqrt((double)square), 1e-3);
            }
    }
}

#define OPENING_AND_END "\"integer motionsteps\" 2 \"integer indices\" [0 1 2] \"point3 P\" "

/* A triangle that has no area at the opening of the shutter takes no photons, and that is told. */
static void what_opens_from_nothing_is_told(void **state)
{
    (void)state;
    static const char TEXT[] =
        "WorldBegin Shape \"trianglemesh\" " OPENING_AND_END "[0 0 0 0 0 0 0 0 0  0 0 0 1 0 0 0 1 0]";
    test_run r;
    test_run_init(&r, 1);
    scene *s = scene_create();
    assert_int_equal(pbrt_parse_text(&r.run, "t", TEXT, strlen(TEXT), s), AG_OK);
    assert_non_null(strstr(r.said, "1 of 1 triangles have no area when the shutter opens"));
    assert_int_equal(scene_commit(s, &r.run, NULL), AG_OK);
    scene_ray ray = scene_ray_make((vec3){0.1f, 0.1f, 1.0f}, (vec3){0, 0, -1});
    surface_hit hit;
    assert_false(scene_intersect(s, ray, INFINITY, &hit));
    ray.time = 0.5f;
    assert_true(scene_intersect(s, ray, INFINITY, &hit));
    const surface_rest rest = surface_at_opening(s, &hit);
    assert_true(rest.area_ratio == 0.0f);
    assert_close(vec3_length(rest.geometric_normal), 1.0, 1e-5);
    expect_near(rest.position, (vec3){0, 0, 0}, 0.0f);
    scene_destroy(s);
    test_run_reset(&r);
}

/* Bounds hold all that the vertices reach; what is looked for in a mesh at rest alone is not looked for in a moving
 * one. */
static void the_scene_knows_of_the_motion(void **state)
{
    (void)state;
    static const char SLAB[] = "Material \"dielectric\" Shape \"trianglemesh\" %s "
                               "\"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7] \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0 "
                               "0 0 .01 1 0 .01 1 1 .01 0 1 .01 %s]";
    static const char LATER[] = "0 0 2 1 0 2 1 1 2 0 1 2 0 0 2.01 1 0 2.01 1 1 2.01 0 1 2.01";
    char text[1024];
    test_run r;
    test_run_init(&r, 1);
    snprintf(text, sizeof text, SLAB, "", "");
    scene *still = test_scene_create(&r, text);
    snprintf(text, sizeof text, SLAB, "\"integer motionsteps\" 2", LATER);
    scene *moving = test_scene_create(&r, text);
    assert_true(still->bounds_max.z == 0.01f && moving->bounds_max.z == 2.01f);
    assert_true(still->surface_area == moving->surface_area);
    assert_true(clear_space_is_told(still) && !clear_space_is_told(moving));
    assert_true(still->slab_faces && !moving->slab_faces);
    const hash128 of_still = scene_hash_of_light(still), of_moving = scene_hash_of_light(moving);
    const hash128 form = scene_hash_of_form(moving, 0);
    assert_false(hash128_is_equal(of_still, of_moving));
    moving->shapes[0].as.mesh.positions[15].z += 1.0f;
    const hash128 changed = scene_hash_of_form(moving, 0);
    assert_false(hash128_is_equal(form, changed));
    scene_destroy(still);
    scene_destroy(moving);
    test_run_reset(&r);
}

/* A step of a subdivided mesh is the step's control mesh, subdivided. */
static void subdivision_is_of_each_step(void **state)
{
    (void)state;
    static const char CAGE[] = "WorldBegin Shape \"loopsubdiv\" \"integer levels\" 2 %s \"integer indices\" "
                               "[0 2 1 0 1 3 0 3 2 1 2 3] \"point3 P\" [%s]";
    static const char *const POSES[] = {"0 0 0 1 0 0 0 1 0 0 0 1 ", "0 0 0 2 0 0 0 1 .5 1 0 1 ",
                                        "3 0 0 2 0 0 0 1 0 0 0 1 "};
    char text[1024], all[512] = "";
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < 3; k++)
        strcat(all, POSES[k]);
    scene *moving = scene_create(), *still[3];
    snprintf(text, sizeof text, CAGE, "\"integer motionsteps\" 3", all);
    assert_int_equal(pbrt_parse_text(&r.run, "t", text, strlen(text), moving), AG_OK);
    const mesh *m = &moving->shapes[0].as.mesh;
    assert_int_equal(m->motion_segments, 2);
    for (int k = 0; k < 3; k++) {
        still[k] = scene_create();
        snprintf(text, sizeof text, CAGE, "", POSES[k]);
        assert_int_equal(pbrt_parse_text(&r.run, "t", text, strlen(text), still[k]), AG_OK);
        const mesh *own = &still[k]->shapes[0].as.mesh;
        const size_t count = own->vertex_count;
        assert_int_equal(m->vertex_count, count);
        assert_int_equal(m->triangle_count, own->triangle_count);
        assert_memory_equal(m->positions + (size_t)k * count, own->positions, count * sizeof *own->positions);
        assert_memory_equal(m->normals + (size_t)k * count, own->normals, count * sizeof *own->normals);
        assert_memory_equal(m->indices, own->indices, own->triangle_count * 3 * sizeof *own->indices);
        scene_destroy(still[k]);
    }
    scene_destroy(moving);
    test_run_reset(&r);
}

/* A lamp stands still, as it does where a matrix would move it, and loses the triangles that have no area then; what
 * does not shine moves and keeps them. What is said last tells of it, and nothing of photons. */
static void a_lamp_stands_still(void **state)
{
    (void)state;
    static const struct {
        const char *material, *indices;
        int warnings;
        const char *last;
        uint32_t lights, triangles;
    } CASES[] = {
        {"diffuse", "0 1 2", 1, "it stands as it does at the opening of the shutter", 1, 1},
        {"diffuse", "0 1 2 3 4 5", 2, "1 of 2 triangles have no area and are left out", 1, 1},
        {"diffuse", "3 4 5", 3, "is empty and is left out, and its area light with it", 0, 0},
        {"interface", "0 1 2 3 4 5", 1, "\"interface\" cannot shine", 0, 2},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[512];
        test_run r;
        test_run_init(&r, 1);
        scene *s = scene_create();
        snprintf(
            text, sizeof text,
            "WorldBegin Material \"%s\" AreaLightSource \"diffuse\" Shape \"trianglemesh\" \"integer motionsteps\" 2 "
            "\"integer indices\" [%s] \"point3 P\" [0 0 0 1 0 0 0 1 0 8 8 8 8 8 8 8 8 8 "
            "0 0 5 1 0 5 0 1 5 8 8 8 9 8 8 8 9 8]",
            CASES[i].material, CASES[i].indices);
        assert_int_equal(pbrt_parse_text(&r.run, "t", text, strlen(text), s), AG_OK);
        assert_int_equal(r.warning_count, CASES[i].warnings);
        assert_non_null(strstr(r.said, CASES[i].last));
        assert_int_equal(s->light_count, CASES[i].lights);
        assert_int_equal(s->shape_count, CASES[i].triangles > 0);
        if (s->shape_count > 0) {
            assert_int_equal(s->shapes[0].as.mesh.triangle_count, CASES[i].triangles);
            assert_int_equal(scene_commit(s, &r.run, NULL), AG_OK);
            assert_true(s->has_motion == (CASES[i].lights == 0));
            assert_true(s->bounds_max.x == (s->has_motion ? 9.0f : 8.0f));
        }
        scene_destroy(s);
        test_run_reset(&r);
    }
}

static void nonsense_is_refused(void **state)
{
    (void)state;
    static const char *const CASES[][2] = {
        {"\"trianglemesh\" \"integer motionsteps\" 0 \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 1 0]",
         "\"motionsteps\" should be from 1 to 129"},
        {"\"trianglemesh\" \"integer motionsteps\" 130 \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 1 0]",
         "\"motionsteps\" should be from 1 to 129"},
        {"\"trianglemesh\" \"integer motionsteps\" 2 \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 1 0]",
         "\"P\" has 3 points, which is no multiple of the 2 of \"motionsteps\""},
        {"\"trianglemesh\" " OPENING_AND_END "[0 0 0 1 0 0 0 1 0 2 0 0]",
         "index 2 (value 3 of \"indices\") is out of range, there are 2 vertices"},
        {"\"trianglemesh\" " OPENING_AND_END "[0 0 0 1 0 0 0 1 0  0 0 0 1 0 0 0 1e19 0]",
         "a vertex lies beyond 1e18 units in world space"},
        {"\"bilinearmesh\" \"integer motionsteps\" 1 \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
         "Shape \"bilinearmesh\" cannot have \"motionsteps\""},
        {"\"loopsubdiv\" \"integer motionsteps\" 2 \"integer levels\" 13 \"integer indices\" [0 1 2] \"point3 P\" "
         "[0 0 0 1 0 0 0 1 0  0 0 1 1 0 0 0 1 0]",
         "1 triangles subdivided 13 times, in each of 2 motion steps, are more than 67108864"},
        {"\"loopsubdiv\" \"integer motionsteps\" 200 \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 1 0]",
         "\"motionsteps\" should be from 1 to 129"},
    };
    test_run r;
    test_run_init(&r, 1);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[1024];
        scene *s = scene_create();
        snprintf(text, sizeof text, "WorldBegin Shape %s", CASES[i][0]);
        assert_int_equal(pbrt_parse_text(&r.run, "t", text, strlen(text), s), AG_ERROR_SCENE);
        if (!strstr(r.said, CASES[i][1]))
            fail_msg("'%s' is not in: %s", CASES[i][1], r.said);
        scene_destroy(s);
    }
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertices_are_met_where_they_are),
        cmocka_unit_test(alpha_is_that_of_the_time),
        cmocka_unit_test(starts_are_clean),
        cmocka_unit_test(a_surface_is_found_where_it_was_at_first),
        cmocka_unit_test(a_sliver_is_found_where_it_was_at_first),
        cmocka_unit_test(what_opens_from_nothing_is_told),
        cmocka_unit_test(the_scene_knows_of_the_motion),
        cmocka_unit_test(subdivision_is_of_each_step),
        cmocka_unit_test(a_lamp_stands_still),
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
