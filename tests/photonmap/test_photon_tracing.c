/* test_photon_tracing.c: the energy balances, closed rooms are tight, and the photons are the same for any number of
 * threads. Threads: those of the tracing. */
#include "photon_tracing.h"

#include "fixtures/test_scene.h"

/* The unit sphere around a lamp; the whole of its light stays within. */
static const char *const SPHERE = "LightSource \"point\" \"rgb I\" [3 2 1] \"point3 from\" [0.3 -0.2 0.4]\n"
                                  "Material \"diffuse\" \"rgb reflectance\" [%g %g %g]\n"
                                  "Shape \"sphere\" \"float radius\" [1]\n";

static const char *const BOX = "Shape \"trianglemesh\" \"integer indices\" [0 1 3 0 3 2 4 7 5 4 6 7 0 5 1 0 4 5 2 3 7 "
                               "2 7 6 0 2 6 0 6 4 1 5 7 1 7 3]\n"
                               "\"point3 P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1]\n";

/* A turned room with coloured walls, two boxes, a mirror, glass smooth and rough, and an area light below the
 * ceiling. */
static const char *const ROOM =
    "Rotate 33 1 2 3\nTranslate 100 20 -7\n"
    "AttributeBegin\nScale 5 4 6\nMaterial \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.2]\n%s AttributeEnd\n"
    "AttributeBegin\nTranslate -2 -3 1\nRotate 20 0 1 0\nMaterial \"diffuse\" \"rgb reflectance\" [0.2 0.6 0.7]\n%s "
    "AttributeEnd\n"
    "AttributeBegin\nTranslate 2.5 -2.5 -2\nRotate -15 0 1 0\nScale 1 1.5 1\n"
    "Material \"conductor\" \"rgb reflectance\" [0.9 0.8 0.7] \"float roughness\" [0]\n%s AttributeEnd\n"
    "AttributeBegin\nTranslate 1 1 2\nMaterial \"dielectric\" \"float eta\" [1.5]\nShape \"sphere\" \"float radius\" "
    "[1.2]\n"
    "AttributeEnd\n"
    "AttributeBegin\nTranslate -2 1 -2\nScale 1 0.7 1.3\nMaterial \"dielectric\" \"float eta\" [1.4] \"float "
    "roughness\" "
    "[0.2]\nShape \"sphere\" \"float radius\" [1]\nAttributeEnd\n"
    "AttributeBegin\nTranslate 0 3.9 0\nRotate 90 1 0 0\nAreaLightSource \"diffuse\" \"rgb L\" [3 2 1]\n"
    "Shape \"disk\" \"float radius\" [0.8]\nAttributeEnd\n";

static scene *sphere_scene(test_run *r, double red, double green, double blue)
{
    char text[512];
    snprintf(text, sizeof text, SPHERE, red, green, blue);
    return test_scene_create(r, text);
}

static scene *room_scene(test_run *r)
{
    char text[4096];
    snprintf(text, sizeof text, ROOM, BOX, BOX, BOX);
    return test_scene_create(r, text);
}

static photon_set trace(test_run *r, const scene *s, photon_kind kind, uint32_t wanted, int max_scatterings)
{
    photon_tracing_settings settings = {
        .kind = kind, .wanted = wanted, .max_scatterings = max_scatterings, .seed = 1, .progress_end = 1.0};
    photon_set set;
    assert_int_equal(photon_tracing_run(s, &r->run, &settings, &set), AG_OK);
    return set;
}

static void expect_balance(const photon_set *set)
{
    const energy_balance *b = &set->balance;
    for (int c = 0; c < 3; c++) {
        double in = b->emitted[c] + b->gained[c];
        assert_true(b->emitted[c] > 0.0);
        assert_close(b->absorbed[c] + b->escaped[c] + b->lost[c] + b->truncated[c], in, 1e-6 * in);
        /* photons are rounded, each by less than a step, without bias */
        assert_close(b->stored[c] + b->cut[c], b->arrived[c], 1e-3 * WIDER * b->arrived[c]);
    }
    /* what the photons themselves say */
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < set->count; i++) {
        rgb flux = flux_decode(set->photons[i].flux);
        sum[0] += flux.r, sum[1] += flux.g, sum[2] += flux.b;
    }
    for (int c = 0; c < 3; c++)
        assert_relative(sum[c] / (double)set->emitted_paths, b->stored[c], 1e-9);
}

static void expect_good_photons(const scene *s, const photon_set *set)
{
    vec3 margin = vec3_scale((vec3){1.0f, 1.0f, 1.0f}, 1e-5f * s->bounding_radius);
    vec3 low = vec3_sub(s->bounds_min, margin), high = vec3_add(s->bounds_max, margin);
    for (uint32_t i = 0; i < set->count; i++) {
        const photon *p = &set->photons[i];
        assert_true(p->position[0] >= low.x && p->position[0] <= high.x && p->position[1] >= low.y &&
                    p->position[1] <= high.y && p->position[2] >= low.z && p->position[2] <= high.z);
        assert_true(p->flux != 0);
        assert_int_equal(irradiance_slot_read(&p->slot), 0);
        /* it arrives at the side that its normal names; both are rounded */
        assert_true(vec3_dot(arrival_direction(p->direction), direction_decode(p->normal)) < 0.05f);
    }
}

static void energy_balances_in_a_room_of_everything(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = room_scene(&r);
    for (int kind = PHOTON_GLOBAL; kind <= PHOTON_CAUSTIC; kind++)
        for (int max = 0; max <= 100; max = max ? max * 10 : 1) {
            if (kind == PHOTON_CAUSTIC && max == 0)
                continue; /* stores nothing */
            photon_set set = trace(&r, s, (photon_kind)kind, 20000 / FEWER, max);
            assert_int_equal(set.count, 20000 / FEWER);
            assert_true(set.rays >= set.emitted_paths);
            expect_balance(&set);
            expect_good_photons(s, &set);
            /* every path carries the lamp's power */
            assert_relative(set.balance.emitted[0], s->light_power.r, 1e-5);
            assert_relative(set.balance.emitted[2], s->light_power.b, 1e-5);
            photon_set_reset(&set);
        }
    assert_int_equal(r.warning_count, 0);
    scene_destroy(s);
    test_run_reset(&r);
}

/* Every arrival is stored: flux, rho flux, rho^2 flux, ... */
static void a_closed_sphere_stores_flux_over_one_minus_rho(void **state)
{
    (void)state;
    static const double RHO[] = {0.2, 0.5, 0.8};
    test_run r;
    test_run_init(&r, 2);
    for (int i = 0; i < 3; i++) {
        scene *s = sphere_scene(&r, RHO[i], RHO[i], RHO[i]);
        photon_set set = trace(&r, s, PHOTON_GLOBAL, 100000 / FEWER, 100);
        assert_int_equal(set.count, 100000 / FEWER);
        expect_balance(&set);
        /* the number of arrivals is geometric: its deviation is sqrt(rho) / (1 - rho) a path */
        double tolerance = 4.0 * sqrt(RHO[i] / (double)set.emitted_paths);
        assert_relative(set.balance.arrived[0], 4.0 * PI * 3.0 / (1.0 - RHO[i]), tolerance);
        assert_relative(set.balance.arrived[2], 4.0 * PI * 1.0 / (1.0 - RHO[i]), tolerance);
        /* the first arrival of each path is marked as straight from the lamp, all others not */
        uint64_t straight = 0;
        for (uint32_t k = 0; k < set.count; k++)
            straight += !arrival_is_diffuse(set.photons[k].direction);
        assert_int_equal(straight, set.emitted_paths);
        for (int c = 0; c < 3; c++) {
            assert_true(set.balance.escaped[c] == 0.0);
            assert_true(set.balance.truncated[c] <= 1e-8 * set.balance.emitted[c]);
            /* what roulette gives and takes is even */
            assert_close(set.balance.gained[c], set.balance.lost[c], 4.0 * set.balance.arrived[c] / sqrt(set.count));
        }
        photon_set_reset(&set);
        scene_destroy(s);
    }
    /* each channel by itself */
    scene *s = sphere_scene(&r, 0.8, 0.5, 0.2);
    photon_set set = trace(&r, s, PHOTON_GLOBAL, 200000 / FEWER, 100);
    expect_balance(&set);
    assert_relative(set.balance.arrived[0], 4.0 * PI * 3.0 / 0.2, 0.03 * WIDER);
    assert_relative(set.balance.arrived[1], 4.0 * PI * 2.0 / 0.5, 0.03 * WIDER);
    assert_relative(set.balance.arrived[2], 4.0 * PI * 1.0 / 0.8, 0.03 * WIDER);
    photon_set_reset(&set);
    scene_destroy(s);
    test_run_reset(&r);
}

/* All light of a lamp within a thick ball of fog that absorbs nothing leaves it, most of it after more than a hundred
 * scatterings, and arrives at the wall. */
static void thick_fog_keeps_no_light(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = test_scene_create(
        &r,
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [20 20 20] \"rgb sigma_a\" [0 0 0]\n"
        "MediumInterface \"\" \"fog\" LightSource \"point\" \"rgb I\" [1 2 3]\n"
        "MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\" MediumInterface \"\" \"\"\n"
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"sphere\" \"float radius\" 2\n");
    photon_set set = trace(&r, s, PHOTON_GLOBAL, 20000 / FEWER, 0);
    expect_balance(&set);
    for (int c = 0; c < 3; c++) {
        assert_relative(set.balance.arrived[c], set.balance.emitted[c], 0.03 * WIDER);
        assert_relative(set.balance.truncated[c], set.balance.arrived[c], 1e-6); /* at the wall */
        assert_true(set.balance.gained[c] > 0.1 * set.balance.emitted[c]);
    }
    assert_true(set.rays > 100 * set.emitted_paths);
    photon_set_reset(&set);
    scene_destroy(s);
    test_run_reset(&r);
}

/* A lamp in the middle of a sphere full of a medium: what of its light arrives at the wall, and of what the wall sends
 * on; the mean of e^-sd over the chords d, of density d / (2 R^2). A ball within, of the same medium, is not to be
 * felt. */
static void media_take_their_share(void **state)
{
    (void)state;
    static const char *const BALLS[] = {
        "", "Material \"interface\" MediumInterface \"m\" Shape \"sphere\" \"float radius\" 0.5\n",
        "Material \"interface\" MediumInterface \"m\" \"n\" Shape \"sphere\" \"float radius\" 0.5\n"
        "MakeNamedMedium \"n\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0]\n"
        "\"rgb sigma_a\" [0.2 1 0.4]\n"};
    static const double SIGMA[3] = {0.2, 1.0, 0.4};
    for (int i = 0; i < 3; i++) {
        char text[1024];
        snprintf(
            text, sizeof text,
            "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" [0.2 1 "
            "0.4]\n"
            "MediumInterface \"\" \"m\" LightSource \"point\" \"rgb I\" [1 1 1]\n"
            "MediumInterface \"m\" \"\" Material \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8] Shape \"sphere\"\n%s",
            BALLS[i]);
        test_run r;
        test_run_init(&r, 2);
        scene *s = test_scene_create(&r, text);
        photon_set set = trace(&r, s, PHOTON_GLOBAL, 200000 / FEWER, 100);
        expect_balance(&set);
        for (int c = 0; c < 3; c++) {
            double sigma = SIGMA[c], power = 4.0 * PI;
            double t = (1.0 - exp(-2.0 * sigma) * (1.0 + 2.0 * sigma)) / (2.0 * sigma * sigma);
            double arrived = power * exp(-sigma) / (1.0 - 0.8 * t);
            assert_relative(set.balance.arrived[c], arrived, 0.02 * WIDER);
            /* the wall takes a fifth, the medium all the rest; roulette is even */
            assert_relative(set.balance.absorbed[c] + set.balance.lost[c] - set.balance.gained[c], power, 1e-6);
            assert_close(set.balance.gained[c], set.balance.lost[c], 0.03 * WIDER * arrived);
            assert_true(set.balance.escaped[c] == 0.0);
        }
        assert_int_equal(set.rays_cut, 0);
        photon_set_reset(&set);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* Light from infinitely far does not come through a medium without bound; where the first interface that it meets
 * says that there is none outside, all of it comes, whatever medium the light was declared in. */
static void light_from_afar_comes_through_what_is_outside(void **state)
{
    (void)state;
    static const char *const LIGHTS[] = {"LightSource \"distant\" \"rgb L\" [1 1 1]\n",
                                         "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"};
    static const struct {
        const char *sphere;
        double share[3]; /* of the light that goes into the scene's ball, of which the sphere takes up a third */
    } CASES[] = {
        {"Material \"interface\" MediumInterface \"m\" \"\" Shape \"sphere\" \"float radius\" 3\n",
         {1.0 / 3.0, 1.0 / 3.0, 1.0}},
        {"Material \"interface\" MediumInterface \"\" \"m\" Shape \"sphere\" \"float radius\" 3\n", {0.0, 0.0, 1.0}},
        {"Material \"diffuse\" Shape \"sphere\" \"float radius\" 3\n", {0.0, 0.0, 1.0}}};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++) {
            char text[1024];
            snprintf(text, sizeof text,
                     "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" "
                     "[0.2 1 0]\n"
                     "MediumInterface \"\" \"m\" %s%s"
                     "MediumInterface \"\" \"\" Material \"diffuse\" Shape \"sphere\"\n",
                     LIGHTS[i], CASES[k].sphere);
            test_run r;
            test_run_init(&r, 2);
            scene *s = test_scene_create(&r, text);
            photon_set set = trace(&r, s, PHOTON_GLOBAL, 20000 / FEWER, 100);
            const double power[3] = {s->light_power.r, s->light_power.g, s->light_power.b};
            for (int c = 0; c < 3; c++)
                assert_close(set.balance.emitted[c], CASES[k].share[c] * power[c],
                             0.05 * WIDER * CASES[k].share[c] * power[c]);
            photon_set_reset(&set);
            scene_destroy(s);
            test_run_reset(&r);
        }
}

static void depth_limits_what_is_stored(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = sphere_scene(&r, 0.5, 0.5, 0.5);
    double expected = 4.0 * PI * 3.0, sum = expected;
    for (int max = 0; max < 3; max++) {
        photon_set set = trace(&r, s, PHOTON_GLOBAL, 100000 / FEWER, max);
        assert_relative(set.balance.arrived[0], sum, 0.01 * WIDER);
        /* what goes on beyond the limit is truncated before the surface absorbs any of it */
        assert_relative(set.balance.truncated[0], expected, 0.01 * WIDER);
        expect_balance(&set);
        photon_set_reset(&set);
        sum += expected *= 0.5;
    }
    scene_destroy(s);
    test_run_reset(&r);
}

static void any_number_of_threads_traces_the_same_photons(void **state)
{
    (void)state;
    static const unsigned WORKERS[] = {1, 2, 3, 8, 64};
    enum { COUNT = 12000 / FEWER };
    for (int kind = PHOTON_GLOBAL; kind <= PHOTON_CAUSTIC; kind++) {
        photon_set first = {0};
        for (size_t w = 0; w < sizeof WORKERS / sizeof *WORKERS; w++) {
            test_run r;
            test_run_init(&r, WORKERS[w]);
            scene *s = room_scene(&r);
            photon_set set = trace(&r, s, (photon_kind)kind, COUNT, 100);
            scene_destroy(s);
            test_run_reset(&r);
            assert_int_equal(set.count, COUNT);
            if (w == 0) {
                first = set;
                continue;
            }
            assert_int_equal(set.emitted_paths, first.emitted_paths);
            assert_int_equal(set.rays, first.rays);
            assert_memory_equal(set.photons, first.photons, COUNT * sizeof *set.photons);
            assert_memory_equal(&set.balance, &first.balance, sizeof set.balance);
            photon_set_reset(&set);
        }
        photon_set_reset(&first);
    }
}

static void seeds_and_counts_make_a_difference(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = sphere_scene(&r, 0.5, 0.5, 0.5);
    for (uint32_t wanted = 1; wanted < 5000; wanted = wanted * 5 + 1) { /* met exactly; a prefix of the larger ones */
        photon_set a = trace(&r, s, PHOTON_GLOBAL, wanted, 100), b = trace(&r, s, PHOTON_GLOBAL, 5000, 100);
        assert_int_equal(a.count, wanted);
        assert_memory_equal(a.photons, b.photons, wanted * sizeof *a.photons);
        expect_balance(&b);
        photon_set_reset(&a);
        photon_set_reset(&b);
    }
    photon_tracing_settings settings = {.kind = PHOTON_GLOBAL, .wanted = 100, .max_scatterings = 100, .seed = 1};
    photon_set a, b;
    assert_int_equal(photon_tracing_run(s, &r.run, &settings, &a), AG_OK);
    settings.seed = 2;
    assert_int_equal(photon_tracing_run(s, &r.run, &settings, &b), AG_OK);
    assert_true(memcmp(a.photons, b.photons, 100 * sizeof *a.photons) != 0);
    photon_set_reset(&a);
    photon_set_reset(&b);
    scene_destroy(s);
    test_run_reset(&r);
}

/* --- where light cannot reach that many --- */

static void expect_shortage(const char *world, photon_kind kind, uint32_t at_most, const char *said)
{
    test_run r;
    test_run_init(&r, 2);
    scene *s = test_scene_create(&r, world);
    photon_set set = trace(&r, s, kind, 10000, 100);
    assert_true(set.count <= at_most);
    assert_int_equal(r.warning_count, 1);
    assert_non_null(strstr(r.said, said));
    photon_set_reset(&set);
    scene_destroy(s);
    test_run_reset(&r);
}

static void a_shortage_is_explained(void **state)
{
    (void)state;
    static const char *const FAR_DISK =
        "LightSource \"point\"\nTranslate 0 0 1000 Shape \"disk\" \"float radius\" [10]\n";
    expect_shortage(FAR_DISK, PHOTON_GLOBAL, 200, "of 10000 photons stored");
    expect_shortage("LightSource \"point\"\n", PHOTON_GLOBAL, 0, "(100.0 % of the emitted light leaves the scene)");
    /* nothing diffuse: a room of black mirrors */
    expect_shortage("LightSource \"point\"\nMaterial \"conductor\" \"rgb reflectance\" [0.02 0.02 0.02]\n"
                    "Shape \"sphere\"\n",
                    PHOTON_GLOBAL, 0, "too few meet a diffuse surface");
}

/* A plate goes through a narrow beam, by which it is met for so much of the time; the floor below has the rest. Photons
 * on the plate lie where those points are when it starts. */
static void paths_have_times_of_their_own(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    /* three wide, its front edge goes from -3 to 7: it is in the beam from 0.3 to 0.6 */
    scene *s = test_scene_create(
        &r, "LightSource \"spot\" \"point3 from\" [0 0 9] \"point3 to\" [0 0 0] \"float coneangle\" 0.01 "
            "\"float conedeltaangle\" 0\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
            "Shape \"disk\" \"float radius\" 5\nActiveTransform EndTime Translate 10 0 0 ActiveTransform All\n"
            "Shape \"trianglemesh\" \"point3 P\" [-6 -1 1 -3 -1 1 -3 1 1 -6 1 1] \"integer indices\" [0 1 2 0 2 3]\n");
    assert_true(s->has_motion);
    photon_set set = trace(&r, s, PHOTON_GLOBAL, 100000 / FEWER, 100);
    double floor_flux = 0.0, plate_flux = 0.0;
    for (uint32_t i = 0; i < set.count; i++) {
        const float *at = set.photons[i].position;
        double flux = (double)flux_decode(set.photons[i].flux).r / (double)set.emitted_paths;
        if (at[2] < 0.5f) {
            assert_close(at[0], 0.0, 0.01);
            floor_flux += flux;
        } else {
            assert_true(at[0] > -6.01f && at[0] < -2.99f);
            plate_flux += flux;
        }
    }
    assert_relative(floor_flux, 0.7 * s->light_power.r, 0.02 * WIDER);
    assert_relative(plate_flux, 0.3 * s->light_power.r, 0.02 * WIDER);
    photon_set_reset(&set);
    scene_destroy(s);
    test_run_reset(&r);
}

/* Nothing specular, or only in an object that is nowhere: not one path is traced. */
static void without_traced_lobes_there_are_no_caustics(void **state)
{
    (void)state;
    static const char *const WORLDS[] = {
        "LightSource \"point\" Shape \"sphere\" \"float radius\" 3\n",
        "LightSource \"point\" Shape \"sphere\" \"float radius\" 3 ObjectBegin \"a\" Material \"dielectric\" "
        "Shape \"sphere\" ObjectEnd\n"};
    for (int i = 0; i < 2; i++) {
        test_run r;
        test_run_init(&r, 2);
        scene *s = test_scene_create(&r, WORLDS[i]);
        photon_set set = trace(&r, s, PHOTON_CAUSTIC, 1000, 100);
        assert_true(set.count == 0 && set.emitted_paths == 0);
        assert_int_equal(r.warning_count, 0);
        photon_set_reset(&set);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

static void a_scene_without_light_has_no_photons(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = test_scene_create(&r, "Shape \"sphere\"\n");
    photon_set set = trace(&r, s, PHOTON_GLOBAL, 1000, 100);
    assert_int_equal(set.count, 0);
    assert_null(set.photons);
    scene_destroy(s);
    test_run_reset(&r);
}

static void a_black_room_is_met_once_a_path(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = sphere_scene(&r, 0.0, 0.0, 0.0);
    photon_set set = trace(&r, s, PHOTON_GLOBAL, 10000, 100);
    assert_int_equal(set.count, 10000);
    assert_int_equal(set.emitted_paths, 10000);
    assert_relative(set.balance.absorbed[0] + set.balance.lost[0], set.balance.emitted[0], 1e-6);
    photon_set_reset(&set);
    scene_destroy(s);
    test_run_reset(&r);
}

/* --- closed rooms do not leak --- */

static void expect_tight(const char *world, uint32_t wanted)
{
    test_run r;
    test_run_init(&r, 2);
    scene *s = test_scene_create(&r, world);
    photon_set set = trace(&r, s, PHOTON_GLOBAL, wanted / FEWER, 100);
    assert_int_equal(set.count, wanted / FEWER);
    assert_true(set.emitted_paths >= 200000 / FEWER);
    for (int c = 0; c < 3; c++)
        assert_true(set.balance.escaped[c] == 0.0);
    photon_set_reset(&set);
    scene_destroy(s);
    test_run_reset(&r);
}

static void closed_rooms_do_not_leak(void **state)
{
    (void)state;
    char text[4096];
    /* a box, turned, stretched, far from the origin */
    snprintf(text, sizeof text, "Translate 300 -200 100\nRotate 40 3 1 2\nScale 20 0.5 3\nLightSource \"point\"\n%s",
             BOX);
    expect_tight(text, 420000);
    /* a sphere of Embree's, and an ellipsoid of ours */
    snprintf(text, sizeof text, "Translate 30 -20 10\nScale 7 7 7\n%s", SPHERE);
    char filled[4096];
    snprintf(filled, sizeof filled, text, 0.5, 0.5, 0.5);
    expect_tight(filled, 420000);
    expect_tight("Translate 3 -2 1\nRotate 30 1 1 1\nScale 4 1 0.3\nLightSource \"point\"\nShape \"sphere\"\n", 420000);
}

static void a_furnished_room_does_not_leak(void **state)
{
    (void)state;
    char text[4096];
    snprintf(text, sizeof text, ROOM, BOX, BOX, BOX);
    expect_tight(text, 800000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_balances_in_a_room_of_everything),
        cmocka_unit_test(a_closed_sphere_stores_flux_over_one_minus_rho),
        cmocka_unit_test(media_take_their_share),
        cmocka_unit_test(thick_fog_keeps_no_light),
        cmocka_unit_test(light_from_afar_comes_through_what_is_outside),
        cmocka_unit_test(depth_limits_what_is_stored),
        cmocka_unit_test(any_number_of_threads_traces_the_same_photons),
        cmocka_unit_test(seeds_and_counts_make_a_difference),
        cmocka_unit_test(a_shortage_is_explained),
        cmocka_unit_test(paths_have_times_of_their_own),
        cmocka_unit_test(without_traced_lobes_there_are_no_caustics),
        cmocka_unit_test(a_scene_without_light_has_no_photons),
        cmocka_unit_test(a_black_room_is_met_once_a_path),
        cmocka_unit_test(closed_rooms_do_not_leak),
        cmocka_unit_test(a_furnished_room_does_not_leak),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
