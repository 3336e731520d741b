/* test_light_table.c: what must hold for every light, one row for each: samples towards a point fall as their density
 * says, bring the radiance that is seen there, and a ray that way has the same density; photons carry the light's
 * power, as much through a disc as direct light says (which is how the two ways of transport agree), aimed and unaimed;
 * those of points go by intensity. Threads: one. */
/* ctest: serial */
#include "fixtures/light_fixture.h"

enum { SAMPLES = 16000 / FEWER };

typedef enum builder { FROM_TEXT, GONIOMETRIC, PROJECTION, WINDOW, DIMMING } builder;

typedef struct light_row {
    const char *name, *text; /* the lamp, above the disc at the origin that faces up */
    const char *texture;     /* of an area light's radiance, or NULL */
    builder builder;
    int number;            /* of the builder's */
    bool hides_itself;     /* a part of the lamp shadows another: for photons through the disc no law is known */
    bool is_alpha_surface; /* rays meet it sometimes, or never: what they see is not what samples bring */
} light_row;

#define LAMP   "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1] "
#define MIDDLE "\"point3 from\" [.3 .2 3] "
/* Something gives the scene its size, and hides nothing: the disc is to be within for a sky. */
#define FLOOR "AttributeBegin Translate 0 0 -.6 Shape \"disk\" \"float radius\" 1.5 AttributeEnd "
#define FAR   "AttributeBegin Translate -9 0 -8 Shape \"disk\" \"float radius\" 3 AttributeEnd "

static const char CHECKS[] =
    "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [4 3 2] \"rgb tex2\" [0.5 0.4 0.3] \"float uscale\" 4 "
    "\"float vscale\" 4\n";
static const char SLOPE[] = "Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [0 0 0] \"rgb v01\" [0 0 0] "
                            "\"rgb v10\" [1 2 3] \"rgb v11\" [1 2 3]\n";
#define HOLES                                                                                                          \
    "Texture \"h\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" 1 \"float uscale\" 4 \"float vscale\" "  \
    "4 "

#define QUAD      "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 2 -1 1 2.5 1 -1 1.5 1.4 1 2]"
#define BALL      "Translate .3 .4 3 Rotate 70 1 0 0 " LAMP "Shape \"sphere\" \"float radius\" 1.2"
#define AROUND    "ReverseOrientation " LAMP "Shape \"sphere\" \"float radius\" 2"
#define EGG       "Translate 0 .3 3 Rotate 30 1 1 0 Scale 1 2 .5 " LAMP "Shape \"sphere\" \"float radius\" 1.2"
#define BOWL      "Translate 0 0 2.5 ReverseOrientation " LAMP "Shape \"sphere\" \"float zmin\" 0 \"float phimax\" 250"
#define PIPE      "Translate 0 0 3 Rotate 70 0 1 0 " LAMP "Shape \"cylinder\" \"float radius\" .7"
#define RING      "Translate .4 0 2 ReverseOrientation " LAMP "Shape \"disk\" \"float radius\" 1.2 \"float innerradius\" .4 "
#define STRETCHED "Rotate 20 1 2 0 Translate .7 .3 2 Scale 2 1 1 " LAMP "\"bool twosided\" true Shape \"disk\" "

static const light_row ROWS[] = {
    {"point", FLOOR "LightSource \"point\" \"rgb I\" [3 2 1] " MIDDLE, NULL, FROM_TEXT, 0, false, false},
    {"spot",
     FLOOR "LightSource \"spot\" \"rgb I\" [3 2 1] " MIDDLE "\"float coneangle\" 35 \"float conedeltaangle\" 20", NULL,
     FROM_TEXT, 0, false, false},
    {"spot that dims",
     FLOOR "LightSource \"spot\" \"rgb I\" [3 2 1] " MIDDLE "\"float coneangle\" 70 \"float conedeltaangle\" 30", NULL,
     DIMMING, 0, false, false},
    {"goniometric, octahedral", FAR, NULL, GONIOMETRIC, 0, false, false},
    {"goniometric, latitudes", FAR, NULL, GONIOMETRIC, 1, false, false},
    {"goniometric, even", FAR, NULL, GONIOMETRIC, 2, false, false},
    {"projection", FAR, NULL, PROJECTION, 0, false, false},
    {"projection, wide", FAR, NULL, PROJECTION, 1, false, false},
    {"projection, tall", FAR, NULL, PROJECTION, 2, false, false},
    {"distant", FLOOR "LightSource \"distant\" \"rgb L\" [3 2 1] \"point3 from\" [1 2 5]", NULL, FROM_TEXT, 0, false,
     false},
    {"sphere", BALL, NULL, FROM_TEXT, 0, false, false},
    {"sphere around", AROUND, NULL, FROM_TEXT, 0, false, false},
    {"ellipsoid", EGG, NULL, FROM_TEXT, 0, false, false},
    {"part of a sphere", BOWL, NULL, FROM_TEXT, 0, true, false},
    {"cylinder", PIPE, NULL, FROM_TEXT, 0, true, false},
    {"part of a disk", RING "\"float phimax\" 200", NULL, FROM_TEXT, 0, false, false},
    {"stretched disk, two-sided", STRETCHED, NULL, FROM_TEXT, 0, false, false},
    {"mesh, two-sided", LAMP "\"bool twosided\" true " QUAD, NULL, FROM_TEXT, 0, false, false},
    {"textured mesh", LAMP "\"bool twosided\" true " QUAD, CHECKS, FROM_TEXT, 0, false, false},
    {"mesh with a slope", LAMP "\"bool twosided\" true " QUAD, SLOPE, FROM_TEXT, 0, false, false},
    {"textured disk", RING, SLOPE, FROM_TEXT, 0, false, false},
    {"textured sphere", BALL, CHECKS, FROM_TEXT, 0, false, false},
    {"textured ellipsoid", EGG, SLOPE, FROM_TEXT, 0, false, false},
    {"textured cylinder", PIPE, CHECKS, FROM_TEXT, 0, true, false},
    {"alpha", RING "\"float alpha\" .5", NULL, FROM_TEXT, 0, false, true},
    {"holes", HOLES RING "\"texture alpha\" \"h\"", NULL, FROM_TEXT, 0, false, true},
    {"invisible", RING "\"float alpha\" 0", NULL, FROM_TEXT, 0, false, true},
    {"sky", FLOOR "LightSource \"infinite\" \"rgb L\" [3 2 1]", NULL, FROM_TEXT, 0, false, false},
    {"sky of a picture", FLOOR, NULL, WINDOW, 4, false, false},
    {"window", FAR, NULL, WINDOW, 0, false, false},
    {"window on a picture", FAR, NULL, WINDOW, 1, false, false},
    {"window on latitudes", FAR, NULL, WINDOW, 2, false, false},
    {"window on a large picture", FAR, NULL, WINDOW, 3, false, false},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

static light goniometric_number(int k)
{
    rgb *even = noise_pixels(1, 1, 1);
    *even = rgb_gray(1.0f);
    if (k != 2)
        free(even);
    return k == 0   ? goniometric(ENVIRONMENT_OCTAHEDRAL, 8, 8, noise_pixels(8, 8, 5))
           : k == 1 ? goniometric(ENVIRONMENT_LATITUDE_LONGITUDE, 12, 6, noise_pixels(12, 6, 6))
                    : goniometric(ENVIRONMENT_OCTAHEDRAL, 1, 1, even);
}

static light projection_number(int k)
{
    return k == 0   ? projector(60, 60, enlarged(6, 6, 10, 7), 100.0f)
           : k == 1 ? projector(120, 50, enlarged(12, 5, 10, 8), 60.0f)
                    : projector(30, 70, enlarged(3, 7, 10, 9), 120.0f);
}

static light sky(void)
{
    light l = light_make(LIGHT_INFINITE);
    l.as.infinite.radiance.value = rgb_make(3.0f, 2.0f, 1.0f);
    l.as.infinite.radiance.world_from_light = odd_frame();
    assert_int_equal(
        environment_create(ENVIRONMENT_OCTAHEDRAL, 16, 16, noise_pixels(16, 16, 4), &l.as.infinite.radiance.picture),
        AG_OK);
    return l;
}

static scene *row_scene(test_run *r, const light_row *row)
{
    char world[1024];
    light l = row->builder == GONIOMETRIC                  ? goniometric_number(row->number)
              : row->builder == PROJECTION                 ? projection_number(row->number)
              : row->builder == WINDOW && row->number == 4 ? sky()
              : row->builder == WINDOW                     ? window_light_number(row->number)
                                                           : light_make(LIGHT_POINT);
    snprintf(world, sizeof world, "%s%s", row->texture ? row->texture : "", row->text);
    scene *s = scene_with_light(r, world, row->builder == FROM_TEXT || row->builder == DIMMING ? NULL : &l);
    assert_int_equal(s->light_count, 1);
    if (row->builder == DIMMING)
        s->lights[0].as.spot.dims_by_cosine = true;
    if (row->texture)
        s->lights[0].as.area.radiance_texture = s->textures.count - 1;
    assert_int_equal(scene_commit(s, &r->run, NULL), AG_OK);
    return s;
}

/* The disc that a row's light is asked about. */
static disc row_disc(const light_row *row, const light *l, int which)
{
    disc d = {{0.1f, -0.2f, 0.0f}, {0.0f, 0.0f, 1.0f}, 0.8f};
    if (row->builder == GONIOMETRIC || row->builder == PROJECTION) {
        const frame *f = row->builder == GONIOMETRIC ? &l->as.goniometric.intensity.world_from_light
                                                     : &l->as.projection.world_from_light;
        vec3 z = f->z, x = f->x;
        vec3 away = which ? vec3_normalize(vec3_add_scaled(z, x, 0.4f)) : z;
        d = (disc){vec3_add_scaled(l->as.point.position, away, 3.0f),
                   vec3_normalize(vec3_make(-away.x, -away.y, -away.z + 0.3f)), 1.0f};
    } else if (row->builder == WINDOW && row->number < 4) {
        d = which ? (disc){{1.2f, 0.7f, 0.0f}, vec3_normalize(vec3_make(0.5f, -1.0f, 0.3f)), 0.4f}
                  : (disc){{0.9f, 0.3f, 0.0f}, vec3_normalize(vec3_make(1.0f, 0.3f, 0.2f)), 0.7f};
    } else if (which) {
        d.normal = vec3_normalize(vec3_make(0.3f, -0.4f, 0.8f));
        d.center = vec3_make(0.4f, 0.3f, -0.2f);
        d.radius = 0.4f;
    }
    return d;
}

static void every_kind_has_a_row(void **state)
{
    (void)state;
    bool is_there[LIGHT_KIND_COUNT] = {false}, has_portal = false, has_map = false, has_picture = false,
         has_numbers = false;
    for (int k = 0; k < ROW_COUNT; k++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = row_scene(&r, &ROWS[k]);
        const light *l = &s->lights[0];
        is_there[l->kind] = true;
        has_portal = has_portal || (l->kind == LIGHT_INFINITE && l->as.infinite.portal);
        has_map = has_map || (l->kind == LIGHT_AREA && l->as.area.map);
        has_picture =
            has_picture || (l->kind == LIGHT_INFINITE && l->as.infinite.radiance.picture && !l->as.infinite.portal);
        has_numbers = has_numbers || light_has_direction_numbers(l);
        assert_true(light_is_sky(l) == (light_can_be_met(l) && light_is_everywhere(l)));
        scene_destroy(s);
        test_run_reset(&r);
    }
    for (int kind = 0; kind < LIGHT_KIND_COUNT; kind++)
        assert_true(is_there[kind]);
    assert_true(has_portal && has_map && has_picture && has_numbers);
}

/* --- towards a point --- */

typedef struct view {
    const scene *s;
    vec3 point;
    bool sees_light[BIN_COUNT], sees_none[BIN_COUNT];
} view;

/* The density and radiance of the light in a direction. */
static double look(const scene *s, vec3 point, vec3 d, rgb *out_radiance)
{
    const light *l = &s->lights[0];
    *out_radiance = rgb_gray(0.0f);
    if (light_is_sky(l)) {
        *out_radiance = light_escaped_radiance(l, point, d);
        return light_escaped_pdf(l, point, d);
    }
    surface_hit hit;
    if (l->kind != LIGHT_AREA || !scene_intersect(s, scene_ray_make(point, d), INFINITY, &hit) ||
        s->shapes[hit.shape_index].light_index != 0)
        return 0.0;
    *out_radiance = light_emitted_radiance(s, l, &hit, vec3_negate(d));
    return rgb_is_black(*out_radiance) ? 0.0 : (double)light_pdf_from_point(s, l, point, &hit);
}

static double density(void *user, vec3 d)
{
    view *v = user;
    rgb radiance;
    double value = look(v->s, v->point, d, &radiance);
    *(value > 0.0 ? &v->sees_light[direction_bin(d)] : &v->sees_none[direction_bin(d)]) = true;
    return value;
}

/* Whether the numbers are found by which a direction is picked, and pick it from another point too. */
static bool is_picked_by(const scene *s, const light *l, vec3 point, vec3 direction, vec2 u)
{
    vec2 found;
    light_sample at;
    return light_direction_numbers(l, direction, &found) && fabsf(found.x - u.x) < 1e-3f &&
           fabsf(found.y - u.y) < 1e-3f && light_sample_from_point(s, l, point, u, &at) &&
           vec3_distance_squared(at.direction, direction) == 0.0f;
}

static void check_towards(const light_row *row, const scene *s, vec3 point)
{
    static uint32_t counts[BIN_COUNT];
    static double bins[BIN_COUNT];
    static view v;
    const light *l = &s->lights[0];
    bool is_unseen = l->kind == LIGHT_AREA && s->shapes[l->as.area.shape_index].alpha <= 0.0f;
    rng random = test_random(3);
    int seen = 0, strangers = 0;
    memset(counts, 0, sizeof counts);
    v = (view){.s = s, .point = point};
    for (int i = 0; i < SAMPLES; i++) {
        light_sample at;
        vec2 u = rng_vec2(&random);
        if (!light_sample_from_point(s, l, point, u, &at))
            continue;
        assert_close(vec3_length(at.direction), 1.0, 1e-5);
        assert_true(at.pdf_solid_angle > 0.0f && rgb_is_finite(at.radiance) && !rgb_is_black(at.radiance));
        assert_true(at.is_delta == (is_unseen || !light_can_be_met(l)));
        assert_true(isinf(at.distance) == light_is_everywhere(l));
        if (is_unseen)
            continue;
        if (light_has_direction_numbers(l))
            strangers += !is_picked_by(s, l, vec3_add(point, vec3_make(0.3f, 0.2f, 0.1f)), at.direction, u);
        if (at.is_delta) { /* one direction, and what intensity brings there */
            assert_true(at.pdf_solid_angle == 1.0f);
            if (light_is_everywhere(l))
                continue;
            vec3 to = vec3_sub(l->as.point.position, point);
            double square = vec3_length_squared(to);
            assert_relative((double)vec3_dot(to, at.direction), sqrt(square), 1e-5);
            assert_relative((double)at.radiance.g, (double)light_intensity(l, vec3_negate(at.direction)).g / square,
                            1e-3);
            continue;
        }
        if (l->kind == LIGHT_AREA && is_blocked_between(s, point, at.shadow_target))
            continue;
        rgb radiance;
        double pdf = look(s, point, at.direction, &radiance);
        seen++;
        counts[direction_bin(at.direction)]++;
        if (!row->is_alpha_surface)
            strangers += fabs(pdf / (double)at.pdf_solid_angle - 1.0) > 0.01 ||
                         fabsf(radiance.g - at.radiance.g) > 1e-3f * at.radiance.g;
    }
    if (!light_can_be_met(l))
        return;
    assert_true(strangers <= SAMPLES / 50); /* along outlines, and the borders of squares, pixels and cells */
    if (row->is_alpha_surface)
        return;
    double whole = integrate_bins(density, &v, FEWER > 1 ? 8 : 14, bins);
    /* a picture's black pixels have a little density too, and no light */
    bool is_picture = l->kind == LIGHT_INFINITE && l->as.infinite.radiance.picture;
    assert_close(whole, is_picture ? 1.0 : (double)seen / SAMPLES,
                 (is_picture && l->as.infinite.portal ? 0.08 : 0.03) * WIDER);
    bool is_round = l->kind == LIGHT_AREA && s->shapes[l->as.area.shape_index].kind == SHAPE_SPHERE;
    for (int i = 0; i < BIN_COUNT; i++)
        if (is_round && v.sees_light[i] && v.sees_none[i]) /* along whose outline densities may be infinite */
            bins[i] = counts[i] = 0;
    if (!(l->kind == LIGHT_AREA && l->as.area.map) &&
        !(l->kind == LIGHT_INFINITE && (l->as.infinite.radiance.picture || l->as.infinite.portal)) &&
        !row->hides_itself)
        assert_chi_square(counts, bins, SAMPLES, 0.02 * WIDER);
}

static void light_towards_a_point_is_as_is_said(void **state)
{
    (void)state;
    for (int k = 0; k < ROW_COUNT; k++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = row_scene(&r, &ROWS[k]);
        print_message("%s\n", ROWS[k].name); /* whose row it is, should one fail */
        for (int which = 0; which < 2; which++)
            check_towards(&ROWS[k], s, row_disc(&ROWS[k], &s->lights[0], which).center);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* --- photons --- */

static double density_by_intensity(void *user, vec3 d)
{
    const light *l = user;
    rgb i = light_intensity(l, d), p = l->power;
    return (double)(i.r / 3.0f + i.g / 2.0f + i.b) / (double)(p.r / 3.0f + p.g / 2.0f + p.b);
}

/* Power is the integral of intensity, and photons go where it is. */
static void check_point(const light_row *row, const scene *s)
{
    static uint32_t counts[BIN_COUNT];
    static double bins[BIN_COUNT];
    const light *l = &s->lights[0];
    double edges = l->kind == LIGHT_PROJECTION ? 0.02 : 0.01; /* of pixels, and of cones */
    rng random = test_random(4);
    memset(counts, 0, sizeof counts);
    for (int i = 0; i < SAMPLES; i++) {
        light_emission e;
        assert_true(light_sample_emission(s, l, NULL, &random, &e));
        assert_memory_equal(&e.origin, &l->as.point.position, sizeof(vec3));
        counts[direction_bin(e.direction)]++;
    }
    double whole = integrate_bins(density_by_intensity, (void *)(uintptr_t)l, 24, bins);
    if (fabs(whole - 1.0) > edges)
        fail_msg("%s: %g of the power", row->name, whole);
    assert_chi_square(counts, bins, SAMPLES, 3.0 * edges);
}

static void photons_carry_what_direct_light_says(void **state)
{
    (void)state;
    for (int k = 0; k < ROW_COUNT; k++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = row_scene(&r, &ROWS[k]);
        const light *l = &s->lights[0];
        print_message("%s\n", ROWS[k].name);
        expect_power_of_photons(s, SAMPLES);
        if (l->kind == LIGHT_POINT || l->kind == LIGHT_SPOT || l->kind == LIGHT_GONIOMETRIC ||
            l->kind == LIGHT_PROJECTION)
            check_point(&ROWS[k], s);
        for (int which = 0; which < (ROWS[k].builder == FROM_TEXT ? 1 : 2) && !ROWS[k].hides_itself; which++) {
            disc d = row_disc(&ROWS[k], l, which);
            assert_true(expect_flux_through_disc(s, &d, (ROWS[k].builder == WINDOW ? 8 : 3) * SAMPLES) > 0.0);
        }
        scene_destroy(s);
        test_run_reset(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_has_a_row),
        cmocka_unit_test(light_towards_a_point_is_as_is_said),
        cmocka_unit_test(photons_carry_what_direct_light_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
