/* light_fixture.h: what the tests of lights with pictures share: scenes of a few lines and one light more, pictures of
 * noise, and a disc through which photons carry what direct light says. Threads: one at a time. */
#ifndef AFTERGLOW_TESTS_LIGHT_FIXTURE_H
#define AFTERGLOW_TESTS_LIGHT_FIXTURE_H

#include "environment.h"
#include "portal.h"
#include "projection.h"

#include "test_scene.h"

/* Not committed yet; l NULL: none. */
static inline scene *scene_with_light(test_run *r, const char *world, const light *l)
{
    char text[4096];
    uint32_t index;
    scene *s = scene_create();
    assert_non_null(s);
    snprintf(text, sizeof text, "WorldBegin\n%s\n", world);
    ag_status status = pbrt_parse_text(&r->run, "scene", text, strlen(text), s);
    if (status != AG_OK || r->warning_count > 0)
        fail_msg("%s: %s", ag_status_text(status), r->said);
    if (l)
        assert_int_equal(scene_add_light(s, l, &index), AG_OK);
    return s;
}

/* Some of it black, some bright; from malloc. */
static inline rgb *noise_pixels(uint32_t width, uint32_t height, uint64_t seed)
{
    rng random = test_random(seed);
    rgb *pixels = malloc((size_t)width * height * sizeof *pixels);
    assert_non_null(pixels);
    for (uint32_t i = 0; i < width * height; i++) {
        float x = rng_float(&random), y = rng_float(&random), z = rng_float(&random);
        pixels[i] = x < 0.2f ? rgb_gray(0.0f) : x > 0.95f ? rgb_make(8.0f, 5.0f, 2.0f) : rgb_make(x, y, z);
    }
    return pixels;
}

/* --- lights with pictures --- */

static inline frame odd_frame(void)
{
    frame f = frame_from_z(vec3_normalize(vec3_make(1.0f, -2.0f, 0.5f)));
    f.y = vec3_negate(f.y); /* a reflection too */
    return f;
}

static inline light goniometric(environment_mapping mapping, uint32_t width, uint32_t height, rgb *pixels)
{
    light l = light_make(LIGHT_GONIOMETRIC);
    l.position = vec3_make(1.0f, 2.0f, 3.0f);
    l.intensity = rgb_make(3.0f, 2.0f, 1.0f);
    l.world_from_light = odd_frame();
    assert_int_equal(environment_create(mapping, width, height, pixels, &l.environment), AG_OK);
    return l;
}

static inline light projector(uint32_t width, uint32_t height, rgb *pixels, float fov)
{
    light l = light_make(LIGHT_PROJECTION);
    l.position = vec3_make(1.0f, 2.0f, 3.0f);
    l.intensity = rgb_make(3.0f, 2.0f, 1.0f);
    l.world_from_light = odd_frame();
    l.direction = l.world_from_light.z;
    assert_int_equal(projection_create(width, height, pixels, fov, &l.projection), AG_OK);
    return l;
}

/* Each pixel as part x part ones: over smaller ones intensity and density are nearly proportional. */
static inline rgb *enlarged(uint32_t width, uint32_t height, uint32_t part, uint64_t seed)
{
    rgb *small = noise_pixels(width, height, seed),
        *large = malloc((size_t)width * height * part * part * sizeof *large);
    assert_non_null(large);
    for (uint32_t y = 0; y < height * part; y++)
        for (uint32_t x = 0; x < width * part; x++)
            large[(size_t)y * width * part + x] = small[(y / part) * width + x / part];
    free(small);
    return large;
}

/* A window of 2 x 1.5 that faces +x from the origin's side, a little askew. */
static inline void make_corners(vec3 out_corners[4])
{
    frame f = frame_from_z(vec3_normalize(vec3_make(1.0f, 0.2f, -0.1f)));
    vec3 corner = vec3_make(2.0f, -1.0f, -0.5f);
    out_corners[0] = corner;
    out_corners[1] = vec3_add_scaled(corner, f.y, 1.5f);
    out_corners[2] = vec3_add_scaled(out_corners[1], f.x, 2.0f);
    out_corners[3] = vec3_add_scaled(corner, f.x, 2.0f);
}

/* pixels NULL: constant. */
static inline light window_light(environment_mapping mapping, uint32_t width, uint32_t height, rgb *pixels)
{
    light l = light_make(LIGHT_INFINITE);
    vec3 corners[4];
    portal placed;
    l.radiance = rgb_make(3.0f, 2.0f, 1.0f);
    l.world_from_light = frame_from_z(vec3_normalize(vec3_make(1.0f, -2.0f, 0.5f)));
    if (pixels)
        assert_int_equal(environment_create(mapping, width, height, pixels, &l.environment), AG_OK);
    make_corners(corners);
    assert_true(portal_place(corners, &placed));
    assert_int_equal(portal_create(&placed, &l, &l.portal), AG_OK);
    return l;
}

static inline light window_light_number(int k)
{
    switch (k) {
    case 0: return window_light(ENVIRONMENT_OCTAHEDRAL, 0, 0, NULL);
    case 1: return window_light(ENVIRONMENT_OCTAHEDRAL, 16, 16, noise_pixels(16, 16, 1));
    case 2: return window_light(ENVIRONMENT_LATITUDE_LONGITUDE, 24, 12, noise_pixels(24, 12, 2));
    default: return window_light(ENVIRONMENT_OCTAHEDRAL, 150, 150, noise_pixels(150, 150, 3));
    }
}
enum { WINDOW_LIGHT_COUNT = 4 };

/* --- photons against direct light --- */

typedef struct disc {
    vec3 center, normal; /* light counts that comes against the normal */
    float radius;
} disc;

/* Sums of samples and of their squares, each over the count of samples. */
typedef struct mean {
    double value, square;
} mean;

static inline void mean_add(mean *m, double sample, double count)
{
    m->value += sample / count, m->square += sample * sample / count;
}

static inline double mean_error(mean m, double count) { return sqrt(fmax(0.0, m.square - m.value * m.value) / count); }

static inline bool disc_is_met(const disc *d, const light_emission *e)
{
    float along = vec3_dot(e->direction, d->normal);
    float t = along < 0.0f ? vec3_dot(vec3_sub(d->center, e->origin), d->normal) / along : -1.0f;
    vec3 at = vec3_add_scaled(e->origin, e->direction, t);
    return t > 0.0f && vec3_distance_squared(at, d->center) < d->radius * d->radius;
}

/* The flux of light 0 through a disc that nothing shadows, W of green: by its photons (aimed: those for a ball around
 * the disc), and by samples towards places on the disc. The two agree; gives the latter. */
static inline double expect_flux_through_disc(const scene *s, const disc *d, int count)
{
    const light *l = &s->lights[0];
    rng random = test_random(31);
    frame f = frame_from_z(d->normal);
    mean direct = {0.0, 0.0};
    for (int i = 0; i < count; i++) {
        vec2 at = sample_disk_concentric(rng_vec2(&random));
        vec3 point = vec3_add(d->center, frame_to_world(&f, (vec3){at.x * d->radius, at.y * d->radius, 0.0f}));
        light_sample sample;
        bool is_lit = light_sample_from_point(s, l, point, rng_vec2(&random), &sample);
        double cosine = is_lit ? fmax(0.0, (double)vec3_dot(sample.direction, d->normal)) : 0.0;
        double value = cosine > 0.0 ? cosine * (double)sample.radiance.g / (double)sample.pdf_solid_angle : 0.0;
        mean_add(&direct, value * PI * (double)d->radius * d->radius, count);
    }
    for (int aimed = 0; aimed < 2; aimed++) {
        light_target ball = {d->center, d->radius * 1.001f};
        mean photons = {0.0, 0.0};
        for (int i = 0; i < count; i++) {
            light_emission e;
            bool is_sent = light_sample_emission(s, l, aimed ? &ball : NULL, &random, &e);
            if (is_sent)
                assert_close(vec3_length(e.direction), 1.0, 1e-5);
            mean_add(&photons, is_sent && disc_is_met(d, &e) ? (double)e.flux.g : 0.0, count);
        }
        double error = hypot(mean_error(photons, count), mean_error(direct, count));
        assert_true(error < 0.1 * WIDER * direct.value); /* that the test says something */
        assert_close(photons.value, direct.value, 5.0 * error);
    }
    return direct.value;
}

/* The mean photon carries the light's power. */
static inline void expect_power_of_photons(const scene *s, int count)
{
    const light *l = &s->lights[0];
    rng random = test_random(32);
    mean flux[3] = {{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}};
    for (int i = 0; i < count; i++) {
        light_emission e;
        if (!light_sample_emission(s, l, NULL, &random, &e))
            continue;
        mean_add(&flux[0], e.flux.r, count), mean_add(&flux[1], e.flux.g, count), mean_add(&flux[2], e.flux.b, count);
    }
    const float power[3] = {l->power.r, l->power.g, l->power.b};
    for (int c = 0; c < 3; c++)
        assert_close(flux[c].value, power[c], 5.0 * mean_error(flux[c], count) + 1e-4 * (double)power[c]);
}

#endif
