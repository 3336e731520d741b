/* test_light_emission.c: light that leaves carries the lamp's power, in the right directions; aimed at a ball it
 * carries the same flux there. Threads: one. */
#include "fixtures/test_scene.h"

enum { SAMPLES = 100000 / FEWER };

#define LAMP "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1] "

static const char *const SPOT =
    "LightSource \"spot\" \"rgb I\" [3 2 1] \"point3 from\" [1 2 3] \"point3 to\" [1 2 13]\n"
    "\"float coneangle\" [50] \"float conedeltaangle\" [20]\nShape \"sphere\" \"float radius\" [9]";

/* Means over many photons' starts. */
typedef struct emission {
    double flux[3];
    double mean_cos; /* to the lamp's normal or axis */
    double direction[3];
} emission;

typedef vec3 axis_fn(const scene *s, const light_emission *e);

static emission emit(const char *world, axis_fn *axis, uint32_t counts[BIN_COUNT])
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, world);
    const light *l = &s->lights[0];
    emission sum = {0};
    rng random = test_random(3);
    for (int i = 0; i < SAMPLES; i++) {
        light_emission e;
        assert_true(light_sample_emission(s, l, NULL, &random, &e));
        assert_close(vec3_length(e.direction), 1.0, 1e-5);
        sum.flux[0] += (double)e.flux.r / SAMPLES, sum.flux[1] += (double)e.flux.g / SAMPLES;
        sum.flux[2] += (double)e.flux.b / SAMPLES;
        sum.mean_cos += (double)vec3_dot(e.direction, axis(s, &e)) / SAMPLES;
        sum.direction[0] += (double)e.direction.x / SAMPLES, sum.direction[1] += (double)e.direction.y / SAMPLES;
        sum.direction[2] += (double)e.direction.z / SAMPLES;
        if (counts)
            counts[direction_bin(e.direction)]++;
    }
    /* the mean photon carries the lamp's power, in its colour */
    double tolerance = l->kind == LIGHT_AREA ? 5.0 / sqrt(SAMPLES) : 1e-6;
    assert_relative(sum.flux[0], l->power.r, tolerance);
    assert_relative(sum.flux[1], l->power.g, tolerance);
    assert_relative(sum.flux[2], l->power.b, tolerance);
    assert_relative(s->light_power.g, l->power.g, 1e-6);
    scene_destroy(s);
    test_run_reset(&r);
    return sum;
}

/* The outward normal of the lamp where the photon starts, found by looking back. */
static vec3 lamp_normal(const scene *s, const light_emission *e)
{
    const shape *lamp = &s->shapes[0];
    if (lamp->kind == SHAPE_SPHERE) {
        surface_hit hit;
        shape_surface_at(lamp, 0, 0.0f, 0.0f, e->origin, e->direction, 0.0f, &hit);
        return hit.geometric_normal;
    }
    surface_hit hit; /* flat lamps */
    shape_surface_at(lamp, 0, 0.3f, 0.3f, e->origin, e->direction, 0.0f, &hit);
    return hit.geometric_normal;
}

static vec3 z_axis(const scene *s, const light_emission *e) { return (void)s, (void)e, (vec3){0.0f, 0.0f, 1.0f}; }

static void area_lights_emit_by_the_cosine(void **state)
{
    (void)state;
    static const struct {
        const char *world;
        double area;
    } LAMPS[] = {
        {LAMP "Shape \"sphere\" \"float radius\" [2]", 4.0 * PI * 4.0},
        {"Rotate 40 1 2 3 " LAMP "Shape \"disk\" \"float radius\" [2] \"float innerradius\" [1]", PI * 3.0},
        {"Translate 3 4 5 " LAMP
         "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2] \"point3 P\" [0 0 0 2 0 0 0 3 0 2 3 0]",
         6.0},
        {LAMP "ReverseOrientation Shape \"sphere\" \"float radius\" [0.5]", 4.0 * PI * 0.25},
        {"Scale 1 3 1 " LAMP "Shape \"sphere\"", 0.0},
    };
    for (size_t i = 0; i < sizeof LAMPS / sizeof *LAMPS; i++) {
        emission e = emit(LAMPS[i].world, lamp_normal, NULL);
        if (LAMPS[i].area > 0.0) {
            assert_relative(e.flux[0], 3.0 * PI * LAMPS[i].area, 1e-4);
            assert_close(e.mean_cos, 2.0 / 3.0, 5.0 * sqrt(1.0 / 18.0 / SAMPLES) + 1e-5);
        }
    }
    /* both sides: as much to each, and twice the power */
    emission both = emit(LAMP "\"bool twosided\" true Shape \"disk\" \"float radius\" [2]", z_axis, NULL);
    assert_relative(both.flux[0], 3.0 * PI * 2.0 * PI * 4.0, 1e-4);
    assert_close(both.mean_cos, 0.0, 5.0 * sqrt(0.5 / SAMPLES));
    both = emit(LAMP "\"bool twosided\" true Shape \"sphere\" \"float radius\" [2]", lamp_normal, NULL);
    assert_relative(both.flux[0], 3.0 * PI * 2.0 * 4.0 * PI * 4.0, 1e-4);
    assert_close(both.mean_cos, 0.0, 5.0 * sqrt(0.5 / SAMPLES));
}

static double lambertian(void *user, vec3 d) { return (void)user, d.z > 0.0f ? (double)d.z / PI : 0.0; }
static double uniform(void *user, vec3 d) { return (void)user, (void)d, 1.0 / (4.0 * PI); }

static double spot_intensity(double c)
{
    double inner = cos(30.0 * PI / 180.0), outer = cos(50.0 * PI / 180.0);
    double x = fmin(fmax((c - outer) / (inner - outer), 0.0), 1.0);
    return x * x * (3.0 - 2.0 * x);
}

static double spot(void *user, vec3 d) { return spot_intensity((double)d.z) / *(double *)user; }

static void directions_are_spread_as_they_should(void **state)
{
    (void)state;
    static uint32_t counts[BIN_COUNT];
    static double bins[BIN_COUNT];
    memset(counts, 0, sizeof counts);
    emit(LAMP "Shape \"disk\" \"float radius\" [2]", z_axis, counts);
    integrate_bins(lambertian, NULL, 4, bins);
    assert_chi_square(counts, bins, SAMPLES, 1e-3);

    memset(counts, 0, sizeof counts);
    emission e = emit("LightSource \"point\" \"rgb I\" [3 2 1]", z_axis, counts);
    assert_relative(e.flux[1], 4.0 * PI * 2.0, 1e-6);
    integrate_bins(uniform, NULL, 1, bins);
    assert_chi_square(counts, bins, SAMPLES, 0.0);

    memset(counts, 0, sizeof counts);
    emit(LAMP "Rotate 50 1 2 3 Shape \"sphere\"", z_axis, counts);
    integrate_bins(uniform, NULL, 1, bins);
    assert_chi_square(counts, bins, SAMPLES, 0.0);

    memset(counts, 0, sizeof counts);
    e = emit(SPOT, z_axis, counts);
    double measure = 0.0, mean_cos = 0.0;
    for (int i = 0; i < 100000; i++) {
        double c = (i + 0.5) / 100000.0, share = 2.0 * PI * spot_intensity(c) / 100000.0;
        measure += share, mean_cos += share * c;
    }
    assert_relative(e.flux[0], 3.0 * measure, 1e-5);
    assert_close(e.mean_cos, mean_cos / measure, 5.0 * 0.1 / sqrt(SAMPLES));
    integrate_bins(spot, &measure, 16, bins);
    assert_chi_square(counts, bins, SAMPLES, 2e-3);
}

static void distant_light_fills_the_disc_around_the_scene(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(
        &r, "LightSource \"distant\" \"rgb L\" [3 2 1] \"point3 from\" [0 0 0] \"point3 to\" [1 2 2]\n"
            "Translate 5 6 7 Shape \"sphere\" \"float radius\" [2]");
    const light *l = &s->lights[0];
    double radius = s->bounding_radius, mean_square = 0.0;
    assert_relative(l->power.r, 3.0 * PI * radius * radius, 1e-5);
    rng random = test_random(4);
    uint32_t hits = 0;
    for (int i = 0; i < SAMPLES; i++) {
        light_emission e;
        surface_hit hit;
        assert_true(light_sample_emission(s, l, NULL, &random, &e));
        assert_close(vec3_dot(e.direction, l->as.distant.direction), 1.0, 1e-6);
        vec3 off = vec3_sub(e.origin, s->bounding_center);
        double along = vec3_dot(off, e.direction), square = vec3_length_squared(off) - along * along;
        assert_true(along <= -radius && square <= radius * radius * 1.0001);
        mean_square += square / SAMPLES;
        hits += scene_intersect(s, scene_ray_make(e.origin, e.direction), INFINITY, &hit);
    }
    assert_relative(mean_square, radius * radius / 2.0, 5.0 / sqrt(SAMPLES));
    /* what reaches the sphere is what its disc takes of it */
    assert_close((double)hits / SAMPLES, 4.0 / (radius * radius), 5.0 * 0.5 / sqrt(SAMPLES));
    scene_destroy(s);
    test_run_reset(&r);
}

/* Directions to a disc of h = 1 - cos a are uniform in the cone, and their mean cosine is 1 - h / 2. The flux through a
 * surface that faces its middle is that of a sun without extent, for photons as for samples from a point. */
static void a_sun_of_an_extent_gives_as_much(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(
        &r,
        "LightSource \"distant\" \"rgb L\" [3 2 1] \"point3 from\" [0 0 0] \"point3 to\" [1 2 2]\nShape \"sphere\"");
    light *l = &s->lights[0];
    const double plain_power = l->power.r, height = 1.0 - cos(20.0 * PI / 180.0);
    light_set_disc(l, 40.0 * PI / 180.0);
    assert_int_equal(light_commit(s, l), AG_OK);
    rng random = test_random(14);
    double facing = 0.0, cosines = 0.0, squares = 0.0, sampled = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
        light_emission e;
        light_sample at;
        assert_true(light_sample_emission(s, l, NULL, &random, &e));
        const double cosine = vec3_dot(e.direction, l->as.distant.direction);
        assert_true(cosine >= 1.0 - height - 1e-5);
        facing += e.flux.r * cosine / SAMPLES;
        cosines += cosine / SAMPLES;
        squares += (1.0 - cosine) * (1.0 - cosine) / SAMPLES;
        const vec2 u = {rng_float(&random), rng_float(&random)};
        assert_true(light_sample_from_point(s, l, (vec3){1.0f, 2.0f, 3.0f}, u, &at));
        sampled += at.radiance.r * -vec3_dot(at.direction, l->as.distant.direction) / SAMPLES;
    }
    assert_relative(cosines, 1.0 - height / 2.0, 5.0 * 0.3 * height / sqrt(SAMPLES));
    assert_relative(squares, height * height / 3.0, 5.0 / sqrt(SAMPLES));
    assert_relative(facing, plain_power, 5.0 * 0.3 * height / sqrt(SAMPLES));
    assert_relative(sampled, 3.0, 5.0 * 0.3 * height / sqrt(SAMPLES));
    scene_destroy(s);
    test_run_reset(&r);
}

/* --- light aimed at a ball --- */

static bool meets_ball(const light_emission *e, const light_target *ball)
{
    vec3 to_center = vec3_sub(ball->center, e->origin);
    float along = vec3_dot(to_center, e->direction);
    vec3 beside = vec3_add_scaled(to_center, e->direction, -along);
    return along > 0.0f && vec3_dot(beside, beside) <= ball->radius * ball->radius;
}

/* The flux through the ball is the same whether all of the light is sampled, or only what goes there; and of as many
 * photons more than `times` as many meet it. */
static void expect_aimed_flux(const char *world, light_target ball, double times)
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, world);
    const light *l = &s->lights[0];
    double flux[2] = {0.0, 0.0}, square[2] = {0.0, 0.0};
    uint32_t met[2] = {0, 0};
    enum { COUNT = 400000 / FEWER };
    for (int aimed = 0; aimed < 2; aimed++) {
        rng random = test_random(7);
        for (int i = 0; i < COUNT; i++) {
            light_emission e;
            if (!light_sample_emission(s, l, aimed ? &ball : NULL, &random, &e) || !meets_ball(&e, &ball))
                continue;
            met[aimed]++;
            flux[aimed] += (double)e.flux.g / COUNT;
            square[aimed] += (double)e.flux.g * (double)e.flux.g / COUNT;
        }
    }
    double variance = (square[0] - flux[0] * flux[0] + square[1] - flux[1] * flux[1]) / COUNT;
    assert_true(met[1] > times * met[0]);
    assert_close(flux[0], flux[1], 5.0 * sqrt(variance));
    scene_destroy(s);
    test_run_reset(&r);
}

static void aimed_light_carries_the_same_flux(void **state)
{
    (void)state;
    const light_target small = {{0.5f, 2.0f, 3.0f}, 0.4f};
    static const char GROUND[] = "Shape \"disk\" \"float radius\" [20]\n";
    char text[1024];
    static const char *const LIGHTS[] = {
        "LightSource \"point\" \"rgb I\" [3 2 1]\n",
        "LightSource \"spot\" \"point3 to\" [0 1 3] \"float coneangle\" [50] \"float conedeltaangle\" [30]\n",
        "LightSource \"distant\" \"point3 from\" [0 0 10] \"point3 to\" [1 1 0]\n",
        "LightSource \"infinite\" \"rgb L\" [1 2 3]\n",
        "AreaLightSource \"diffuse\" \"bool twosided\" true Shape \"disk\" \"float radius\" [0.7]\n",
        "AreaLightSource \"diffuse\" Shape \"sphere\" \"float radius\" [0.7]\n",
    };
    for (size_t i = 0; i < sizeof LIGHTS / sizeof *LIGHTS; i++) {
        snprintf(text, sizeof text, "AttributeBegin %s AttributeEnd\nTranslate 0 0 -5 %s", LIGHTS[i], GROUND);
        expect_aimed_flux(text, small, 5.0);
    }
    /* balls beside a lamp, of which its nearer points see too much to be aimed */
    static const light_target NEAR[] = {
        {{0.0f, 0.0f, 1.8f}, 1.0f}, {{0.0f, 0.0f, 1.0f}, 0.9f}, {{0.0f, 0.0f, 10.0f}, 9.0f}};
    static const char *const LAMPS[] = {"Shape \"sphere\" \"float radius\" [0.7]",
                                        "Shape \"disk\" \"float radius\" [0.7]"};
    for (size_t i = 0; i < sizeof NEAR / sizeof *NEAR; i++)
        for (size_t lamp = 0; lamp < sizeof LAMPS / sizeof *LAMPS; lamp++)
            for (int two_sided = 0; two_sided < 2; two_sided++) {
                snprintf(text, sizeof text,
                         "AttributeBegin AreaLightSource \"diffuse\" %s %s AttributeEnd\nTranslate 0 0 -5 %s",
                         two_sided ? "\"bool twosided\" true" : "", LAMPS[lamp], GROUND);
                expect_aimed_flux(text, NEAR[i], 0.9);
            }
}

/* The two lights from afar, whose irradiance across their directions is 4 pi times 2 and 2 in green. */
static const char *const FROM_AFAR[] = {"LightSource \"infinite\" \"rgb L\" [1 2 3]\n",
                                        "LightSource \"distant\" \"point3 from\" [1 2 9] \"rgb L\" [1 2 3]\n"};
static const double IRRADIANCE_FROM_AFAR[] = {8.0 * PI, 2.0};

/* The scene's only light, from afar, finds the ball often, and carries no more there, nor in all, than it should. */
static void expect_found(const scene *s, const light_target *ball, const light_target *focus, double irradiance)
{
    double flux = 0.0, all = 0.0, square = 0.0, square_all = 0.0;
    enum { COUNT = 400000 / FEWER };
    uint32_t met = 0;
    rng random = test_random(9);
    for (int i = 0; i < COUNT; i++) {
        light_emission e;
        emission_numbers numbers = emission_numbers_draw(&random);
        numbers.focus = focus;
        if (!light_emit(s, &s->lights[0], NULL, &numbers, &e))
            continue;
        all += (double)e.flux.g / COUNT;
        square_all += (double)e.flux.g * (double)e.flux.g / COUNT;
        if (!meets_ball(&e, ball))
            continue;
        met++;
        flux += (double)e.flux.g / COUNT;
        square += (double)e.flux.g * (double)e.flux.g / COUNT;
    }
    assert_true(met > COUNT / 50);
    double expected = PI * (double)ball->radius * (double)ball->radius * irradiance;
    assert_relative(flux, expected, 5.0 * sqrt(square / COUNT) / expected);
    assert_relative(all, s->lights[0].power.g, 5.0 * sqrt(square_all / COUNT) / all);
}

/* A ball on a ground ten thousand times as large: spread evenly, one ray in 10^8 would meet it. */
static void light_from_afar_finds_what_is_small(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        test_run r;
        test_run_init(&r, 1);
        char text[1024];
        snprintf(text, sizeof text,
                 "%sShape \"disk\" \"float radius\" [5000]\nTranslate 1000 30 1\nShape \"sphere\" \"float radius\" "
                 "[0.5]\n",
                 FROM_AFAR[k]);
        scene *s = test_scene_create(&r, text);
        assert_relative(s->detail_radius, 0.5 * sqrt(3.0), 1e-3);
        assert_close(s->detail_center.x, 1000.0, 1e-3);
        const light_target ball = {s->detail_center, 0.5f};
        expect_found(s, &ball, NULL, IRRADIANCE_FROM_AFAR[k]);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* A place on a ground without detail: spread evenly, one ray in 10^4 would meet it. A focus that is off the ground's
 * ball in part, or larger than that, takes no light away. */
static void light_from_afar_is_densest_around_a_focus(void **state)
{
    (void)state;
    static const light_target PLACE = {{70.0f, 60.0f, 0.0f}, 1.0f}, EDGE = {{0.0f, 99.0f, 10.0f}, 3.0f};
    for (int k = 0; k < 2; k++) {
        test_run r;
        test_run_init(&r, 1);
        char text[1024];
        snprintf(text, sizeof text, "%sShape \"disk\" \"float radius\" [100]\n", FROM_AFAR[k]);
        scene *s = test_scene_create(&r, text);
        assert_true(s->detail_radius == 0.0f);
        expect_found(s, &PLACE, &PLACE, IRRADIANCE_FROM_AFAR[k]);
        const light_target at_edge = {{0.0f, 97.0f, 0.0f}, 3.0f}, all = {s->bounding_center, s->bounding_radius},
                           larger = {PLACE.center, 2.0f * s->bounding_radius};
        expect_found(s, &at_edge, &EDGE, IRRADIANCE_FROM_AFAR[k]);
        expect_found(s, &all, &larger, IRRADIANCE_FROM_AFAR[k]);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* A ground and a pyramid on it in one mesh, as it stands and in an object, here and elsewhere, twice as large. */
static void what_is_small_is_found_in_instances(void **state)
{
    (void)state;
    static const char MESH[] = "Shape \"trianglemesh\" \"point3 P\" [-5000 -5000 0  5000 -5000 0  0 5000 0  "
                               "100 100 0  101 100 0  100 101 0  100 100 1]\n"
                               "\"integer indices\" [0 1 2  3 4 6  4 5 6  5 3 6]\n";
    static const char *const BEFORE[] = {"", "ObjectBegin \"it\"", "ObjectBegin \"it\""};
    static const char *const BEHIND[] = {"", "ObjectEnd ObjectInstance \"it\"",
                                         "ObjectEnd Translate 50 0 0 Scale 2 2 2 ObjectInstance \"it\""};
    for (int k = 0; k < 3; k++) {
        test_run r;
        test_run_init(&r, 1);
        char text[1024];
        snprintf(text, sizeof text, "%s %s %s", BEFORE[k], MESH, BEHIND[k]);
        scene *s = test_scene_create(&r, text);
        double scale = k == 2 ? 2.0 : 1.0;
        assert_relative(s->detail_radius, scale * 0.5 * sqrt(3.0), 1e-3);
        assert_close(s->detail_center.x, k == 2 ? 251.0 : 100.5, 1e-3);
        assert_close(s->detail_center.z, scale * 0.5, 1e-3);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

static void a_room_has_no_giants(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, "LightSource \"infinite\"\nShape \"disk\" \"float radius\" [5]\n"
                                     "Shape \"sphere\" \"float radius\" [0.5]\n");
    assert_true(s->detail_radius == 0.0f);
    scene_destroy(s);
    test_run_reset(&r);
}

/* A photon that begins by the numbers of a way from a point to a lamp passes that point along it. Where numbers end in
 * floats, the point is missed by some millionths of the scene. */
static void expect_numbers_of_ways(const char *world, bool are_known, const light_target *focus)
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, world);
    const light *l = &s->lights[0];
    rng random = test_random(5);
    uint32_t tried = 0;
    for (int i = 0; i < SAMPLES / 10; i++) {
        vec3 point = {2.0f * rng_float(&random) - 1.0f, 2.0f * rng_float(&random) - 1.0f, rng_float(&random) + 1.5f};
        vec2 u = rng_vec2(&random);
        emission_numbers numbers = emission_numbers_draw(&random);
        numbers.focus = focus;
        light_sample towards;
        light_emission e;
        if (!light_sample_from_point(s, l, point, u, &towards))
            continue;
        assert_int_equal(light_emission_numbers(s, l, point, u, &towards, &numbers), are_known);
        if (!are_known)
            break;
        assert_true(numbers.direction.x >= 0.0f && numbers.direction.x < 1.0f && numbers.direction.y >= 0.0f &&
                    numbers.direction.y < 1.0f && numbers.position.x >= 0.0f && numbers.position.x < 1.0f &&
                    numbers.position.y >= 0.0f && numbers.position.y < 1.0f && numbers.part >= 0.0f &&
                    numbers.part < 1.0f);
        assert_true(light_emit(s, l, NULL, &numbers, &e));
        vec3 off = vec3_sub(point, e.origin);
        off = vec3_add_scaled(off, e.direction, -vec3_dot(off, e.direction));
        assert_true(vec3_length(off) < 2e-3f + 1e-5f * s->bounding_radius);
        assert_true(vec3_dot(e.direction, towards.direction) < -0.99999f);
        tried++;
    }
    assert_true(!are_known || tried > SAMPLES / 100);
    scene_destroy(s);
    test_run_reset(&r);
}

static void ways_to_lamps_tell_where_photons_begin(void **state)
{
    (void)state;
    static const char FLOOR[] = "Translate 0 0 -3 Shape \"disk\" \"float radius\" [5]";
    static const char GROUND[] = "Shape \"disk\" \"float radius\" [5000] Shape \"sphere\" \"float radius\" [0.5]";
    static const struct {
        const char *lamp, *world;
        bool are_known;
    } cases[] = {
        {"LightSource \"infinite\"", FLOOR, true},
        {"LightSource \"infinite\"", GROUND, true},
        {"LightSource \"distant\" \"point3 from\" [1 2 9]", FLOOR, true},
        {"LightSource \"distant\" \"point3 from\" [1 2 9]", GROUND, true},
        {"AttributeBegin AreaLightSource \"diffuse\" Shape \"disk\" AttributeEnd", FLOOR, true},
        {"AttributeBegin AreaLightSource \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0] "
         "AttributeEnd",
         FLOOR, true},
        {"AttributeBegin Rotate 33 0 0 1 AreaLightSource \"diffuse\" Shape \"trianglemesh\" \"point3 P\" [-1 0 0 1 0 0 1 .001 "
         "0] AttributeEnd",
         FLOOR, true},
        {"AttributeBegin Rotate 180 1 0 0 AreaLightSource \"diffuse\" \"bool twosided\" true Shape \"disk\" "
         "AttributeEnd",
         FLOOR, true},
        {"AttributeBegin AreaLightSource \"diffuse\" Shape \"sphere\" AttributeEnd", FLOOR, true},
        {"AttributeBegin AreaLightSource \"diffuse\" \"bool twosided\" true Shape \"sphere\" \"float radius\" 2 AttributeEnd",
         FLOOR, true},
        {"AttributeBegin Translate 0 0 2 ReverseOrientation AreaLightSource \"diffuse\" Shape \"sphere\" \"float radius\" 4 "
         "AttributeEnd",
         FLOOR, true},
        {"AttributeBegin Scale 1 .9 1 AreaLightSource \"diffuse\" Shape \"sphere\" AttributeEnd", FLOOR, true},
        {"LightSource \"point\"", FLOOR, true},
        {"LightSource \"spot\" \"float coneangle\" 50 \"float conedeltaangle\" 20", FLOOR, true},
        {"LightSource \"spot\" \"float coneangle\" 40 \"float conedeltaangle\" 0", FLOOR, true},
        {"LightSource \"spot\" \"float coneangle\" 60 \"float conedeltaangle\" 60 \"bool cosine\" true", FLOOR, true},
    };
    char text[512];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(text, sizeof text, "%s %s", cases[i].lamp, cases[i].world);
        static const light_target FOCUS = {{0.5f, 0.0f, 2.0f}, 0.7f};
        expect_numbers_of_ways(text, cases[i].are_known, NULL);
        expect_numbers_of_ways(text, cases[i].are_known, &FOCUS);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(area_lights_emit_by_the_cosine),
        cmocka_unit_test(directions_are_spread_as_they_should),
        cmocka_unit_test(distant_light_fills_the_disc_around_the_scene),
        cmocka_unit_test(a_sun_of_an_extent_gives_as_much),
        cmocka_unit_test(aimed_light_carries_the_same_flux),
        cmocka_unit_test(light_from_afar_finds_what_is_small),
        cmocka_unit_test(light_from_afar_is_densest_around_a_focus),
        cmocka_unit_test(what_is_small_is_found_in_instances),
        cmocka_unit_test(a_room_has_no_giants),
        cmocka_unit_test(ways_to_lamps_tell_where_photons_begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
