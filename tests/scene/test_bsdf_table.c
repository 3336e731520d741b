/* test_bsdf_table.c: what must hold for every material, one row for each: samples fall as their density says, weigh
 * f cos / pdf, gain nothing as flux or as radiance, and go both ways alike; what photons store and the eye looks up is
 * the value. Some rows come from scene text, with the position of a hit: mixes, textures, alpha, interfaces. Rests on:
 * Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, 5.2 (reciprocity where light is bent).
 * Threads: one. */
/* ctest: serial */
#include "fixtures/bsdf_fixture.h"
#include "material/material_type.h"
#include "material/principled.h"

enum { SAMPLES = 20000 / FEWER };

/* A material made here, or the text of one, met at a point of a disk that faces up. */
typedef struct row {
    const char *name, *text;
    material_point point;
    scene *s; /* of the text */
    surface_hit hit;
} row;

enum { ROWS_MAX = 64 };

typedef struct table {
    row rows[ROWS_MAX];
    int count;
    test_run run;
} table;

static void add(table *t, const char *name, material m)
{
    assert_true(t->count < ROWS_MAX);
    prepare(&m);
    t->rows[t->count++] = (row){.name = name, .point = point_of(&m)};
}

/* The text sets the material of what follows; x: the point on the disk. */
static void add_text(table *t, const char *name, const char *text, const char *more, float x)
{
    char world[1024];
    row r = {.name = name, .text = text};
    snprintf(world, sizeof world, "%s Shape \"disk\" \"float radius\" 9 %s", text, more);
    r.s = test_scene_create(&t->run, world);
    scene_ray down = scene_ray_make((vec3){x, 0.3f, 2.0f}, (vec3){0.0f, 0.0f, -1.0f});
    down.alpha_rule = RAY_MEETS_ALPHA;
    assert_true(scene_intersect(r.s, down, INFINITY, &r.hit));
    material_at(r.s, &r.hit, &r.point);
    assert_true(t->count < ROWS_MAX);
    t->rows[t->count++] = r;
}

static bsdf row_bsdf(const row *r, vec3 out)
{
    bsdf b;
    if (!r->s)
        return bsdf_of_point(&r->point, UP, out);
    bsdf_init(r->s, &r->hit, out, &b);
    return b;
}

static material thin(float ior)
{
    material m = material_make(MATERIAL_THIN_DIELECTRIC);
    m.ior = ior;
    return m;
}

/* A coat whose medium scatters. */
static material milky(material m)
{
    m.coat_thickness = 0.5f, m.coat_albedo = (rgb){0.9f, 0.5f, 0.1f}, m.coat_g = 0.4f;
    return m;
}

#define PARTS                                                                                                          \
    "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [.7 .2 .4] MakeNamedMaterial \"b\" "      \
    "\"string type\" \"conductor\" \"float roughness\" .3 \"rgb reflectance\" [.9 .7 .3] "
#define CHECKS                                                                                                         \
    "Texture \"checks\" \"spectrum\" \"checkerboard\" \"float uscale\" 3 \"rgb tex1\" [.9 .4 .1] \"rgb tex2\" [.2 .7 " \
    ".8] "

static table *table_create(void)
{
    table *t = calloc(1, sizeof *t);
    assert_non_null(t);
    test_run_init(&t->run, 1);
    add(t, "diffuse", diffuse());
    add(t, "diffuse transmission", diffuse_transmission());
    add(t, "mirror", conductor(0.0f, 0.0f));
    add(t, "metal .15", conductor(0.15f, 0.15f));
    add(t, "metal .3", conductor(0.3f, 0.3f));
    add(t, "metal .8", conductor(0.8f, 0.8f));
    add(t, "brushed metal", conductor(0.2f, 0.6f));
    add(t, "glass", dielectric(1.5f, 0.0f, 0.0f));
    add(t, "rough glass .2", dielectric(1.5f, 0.2f, 0.2f));
    add(t, "rough glass .5", dielectric(1.33f, 0.5f, 0.5f));
    add(t, "brushed glass", dielectric(1.33f, 0.6f, 0.25f));
    add(t, "rough bubble", dielectric(0.7f, 0.4f, 0.4f));
    add(t, "index of one", dielectric(1.0f, 0.3f, 0.3f));
    add(t, "pane", thin(1.5f));
    add(t, "coated diffuse", coated_diffuse(0.0f, 0.0f));
    add(t, "rough coated diffuse", coated_diffuse(0.4f, 0.25f));
    add(t, "coated mirror", coated_conductor(0.0f, 0.0f, 0.0f));
    add(t, "coated brushed metal", coated_conductor(0.0f, 0.3f, 0.5f));
    add(t, "rough coated mirror", coated_conductor(0.3f, 0.0f, 0.0f));
    add(t, "rough coated metal", coated_conductor(0.4f, 0.3f, 0.3f));
    add(t, "milky coated diffuse", milky(coated_diffuse(0.0f, 0.0f)));
    add(t, "milky coated metal", milky(coated_conductor(0.3f, 0.3f, 0.3f)));
    for (int k = 0; k < PRINCIPLED_SORTS; k++)
        add(t, "principled", principled_sort(k));
    add_text(t, "interface",
             "LightSource \"point\" MediumInterface \"\" \"\" Material \"mix\" \"string materials\" [\"a\" \"i\"] "
             "\"float amount\" 1 " PARTS "MakeNamedMaterial \"i\" \"string type\" \"interface\"",
             "", 0.1f);
    add_text(t, "mix, its first", PARTS "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .0", "",
             0.1f);
    add_text(t, "mix, its second", PARTS "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" 1", "",
             0.2f);
    add_text(t, "textured",
             CHECKS "Material \"coateddiffuse\" \"texture reflectance\" \"checks\" \"float roughness\" .3", "", 0.7f);
    add_text(t, "alpha", "Material \"diffuse\" \"rgb reflectance\" [.7 .2 .4]", "\"float alpha\" .5", 0.4f);
    add_text(t, "hair",
             "Material \"hair\" \"rgb color\" [.7 .2 .4] \"float beta_m\" .5 \"float beta_n\" .6 Shape \"curve\" "
             "\"string type\" \"ribbon\" \"point3 P\" [0 -4 1 0 -1 1 0 2 1 0 4 1] \"float width\" 6 \"normal N\" "
             "[0 0 1 0 0 1]",
             "", 0.5f);
    add_text(t, "curve",
             "Material \"coateddiffuse\" \"rgb reflectance\" [.7 .2 .4] \"float roughness\" .4 Shape \"curve\" "
             "\"string type\" \"ribbon\" \"point3 P\" [0 -4 1 0 -1 1 0 2 1 0 4 1] \"float width\" 6 \"normal N\" "
             "[0 0 1 0 0 1]",
             "", 0.5f);
    return t;
}

static void table_destroy(table *t)
{
    for (int k = 0; k < t->count; k++)
        scene_destroy(t->rows[k].s);
    test_run_reset(&t->run);
    free(t);
}

static int set_up(void **state)
{
    *state = table_create();
    return 0;
}

static int tear_down(void **state)
{
    table_destroy(*state);
    return 0;
}

/* A kind that has no row would be tested by nothing. */
static void every_kind_has_a_row(void **state)
{
    const table *t = *state;
    bool is_there[MATERIAL_KIND_COUNT] = {false};
    for (int k = 0; k < t->count; k++) {
        is_there[t->rows[k].point.kind] = true;
        if (t->rows[k].s &&
            t->rows[k].s->materials[t->rows[k].s->shapes[t->rows[k].hit.shape_index].material_index].kind ==
                MATERIAL_MIX)
            is_there[MATERIAL_MIX] = true;
    }
    for (int kind = 0; kind < MATERIAL_KIND_COUNT; kind++)
        assert_true(is_there[kind]);
}

/* A bsdf has room for as many lobes as the row of a kind says, so no more are added; and some material of each kind
 * has all of them. */
static void kinds_add_the_lobes_of_their_rows(void **state)
{
    const table *t = *state;
    int most[MATERIAL_KIND_COUNT] = {0};
    for (int k = 0; k < t->count; k++)
        for (double degrees = 5.0; degrees < 180.0; degrees += 5.0) {
            bsdf b = row_bsdf(&t->rows[k], direction_at(degrees, 40.0));
            material_kind kind = b.material.kind;
            if (b.lobe_count > material_lobes_max[kind])
                fail_msg("%s has %d lobes, and by its row %d", t->rows[k].name, b.lobe_count, material_lobes_max[kind]);
            most[kind] = b.lobe_count > most[kind] ? b.lobe_count : most[kind];
        }
    for (int kind = 0; kind < MATERIAL_KIND_COUNT; kind++)
        if (most[kind] < material_lobes_max[kind])
            fail_msg("of kind %d no row has more than %d of the %d lobes", kind, most[kind], material_lobes_max[kind]);
}

/* Hair does not scatter alike both ways, by its model; test_hair.c says what holds for photons in it. */
static bool scatters_one_way(const row *r) { return r->point.kind == MATERIAL_HAIR; }

/* --- (a), (d): density, weight; (b): flux --- */

static void check_row(const row *r)
{
    static const bsdf_lobes GROUPS[] = {BSDF_GATHERED, BSDF_TRACED, BSDF_ALL};
    static const double ANGLES[] = {8, 50, 78, 130};
    for (int i = 0; i < 4; i++) {
        bsdf b = row_bsdf(r, direction_at(ANGLES[i], 25.0 + 130.0 * i));
        double probability = 0.0;
        for (int k = 0; k < b.lobe_count; k++)
            probability += (double)b.probabilities[k];
        bool is_empty = r->point.kind == MATERIAL_INTERFACE;
        assert_close(probability, is_empty ? 0.0 : 1.0, 1e-6);
        assert_close(bsdf_probability(&b, BSDF_ALL), probability, 1e-6);
        assert_close(bsdf_probability(&b, BSDF_GATHERED) + bsdf_probability(&b, BSDF_TRACED), probability, 1e-6);
        for (int g = 0; g < 3; g++) {
            assert_true(bsdf_has(&b, GROUPS[g]) == (bsdf_probability(&b, GROUPS[g]) > 0.0f));
            if (bsdf_has(&b, GROUPS[g])) {
                bool is_all = bsdf_probability(&b, GROUPS[g]) >= 1.0f - 1e-6f;
                if (g == 2 || !is_all) /* a group that is all comes once */
                    check_lobes(&b, GROUPS[g], SAMPLES, !scatters_one_way(r));
                continue;
            }
            bsdf_sample s;
            assert_false(bsdf_sample_direction(&b, GROUPS[g], BSDF_FLUX, 0.5f, (vec2){0.5f, 0.5f}, &s));
            assert_true(bsdf_pdf(&b, GROUPS[g], BSDF_FLUX, UP) == 0.0f);
            assert_true(rgb_is_black(bsdf_evaluate(&b, GROUPS[g], BSDF_FLUX, UP)));
        }
    }
}

static void samples_fall_and_weigh_as_is_said(void **state)
{
    const table *t = *state;
    for (int k = 0; k < t->count; k++) {
        print_message("%s\n", t->rows[k].name); /* whose row it is, should one fail */
        check_row(&t->rows[k]);
    }
}

/* --- (b): radiance --- */

/* The square of the index beyond over that on out's side, where what passes is bent; else 1. */
static double square_beyond(const bsdf *b)
{
    const material_point *m = &b->material;
    bool bends =
        m->kind == MATERIAL_DIELECTRIC || (m->kind == MATERIAL_PRINCIPLED && principled_is_solid(&m->principled));
    double index = (double)bsdf_index(b), square = bends ? index * index : 1.0;
    return vec3_dot(b->out, UP) > 0.0f ? square : 1.0 / square;
}

/* Over the square of the index, which is what is kept, radiance weighs what flux does that goes the same way. */
static void radiance_gains_no_more_than_flux(void **state)
{
    const table *t = *state;
    for (int k = 0; k < t->count; k++)
        for (double degrees = scatters_one_way(&t->rows[k]) ? 180.0 : 10.0; degrees < 180.0; degrees += 37.0) {
            bsdf b = row_bsdf(&t->rows[k], direction_at(degrees, 70.0));
            double energy[3] = {0.0, 0.0, 0.0}, square = square_beyond(&b);
            enum { COUNT = 4000 };
            rng random = test_random(8);
            for (int i = 0; i < COUNT; i++) {
                bsdf_sample s, f;
                float u_lobe = rng_float(&random);
                vec2 u = rng_vec2(&random);
                bool is_there = bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, u_lobe, u, &s);
                assert_true(is_there == bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, u_lobe, u, &f));
                if (!is_there)
                    continue;
                float there = s.direction.z * b.out.z < 0.0f ? (float)square : 1.0f;
                rgb kept = rgb_scale(s.weight, there);
                assert_relative(kept.r, f.weight.r, 1e-3);
                assert_relative(kept.b, f.weight.b, 1e-3);
                assert_true(kept.r >= 0.0f && kept.g >= 0.0f && kept.b >= 0.0f);
                energy[0] += (double)kept.r / COUNT, energy[1] += (double)kept.g / COUNT;
                energy[2] += (double)kept.b / COUNT;
            }
            for (int c = 0; c < 3; c++)
                if (!(energy[c] <= 1.0 + 5.0 / sqrt(COUNT)))
                    fail_msg("%s, %g degrees: %g of radiance", t->rows[k].name, degrees, energy[c]);
        }
}

/* --- (c): both ways alike --- */

static void scattering_is_reciprocal(void **state)
{
    const table *t = *state;
    rng random = test_random(21);
    for (int k = 0; k < t->count; k++) {
        const row *r = &t->rows[k];
        if (scatters_one_way(r))
            continue;
        int compared = 0, expected = 0;
        for (int i = 0; i < 3000; i++) {
            vec3 o = random_direction(&random), d = random_direction(&random);
            if (fabs((double)o.z) < 0.03 || fabs((double)d.z) < 0.03)
                continue; /* cancellation near grazing */
            bsdf eye = row_bsdf(r, o), photon = row_bsdf(r, d);
            expected += bsdf_is_sampled_from_light(&eye, BSDF_ALL);
            rgb there = rgb_scale(bsdf_evaluate(&eye, BSDF_ALL, BSDF_RADIANCE, d), 1.0f / fabsf(d.z));
            rgb back = rgb_scale(bsdf_evaluate(&photon, BSDF_ALL, BSDF_RADIANCE, o), 1.0f / fabsf(o.z));
            rgb flux = rgb_scale(bsdf_evaluate(&photon, BSDF_ALL, BSDF_FLUX, o), 1.0f / fabsf(o.z));
            /* photons and the eye: f with the roles of in and out changed */
            const float radiances[3] = {there.r, there.g, there.b}, fluxes[3] = {flux.r, flux.g, flux.b};
            if (o.z * d.z < 0.0f) { /* f over the square of the index where light arrives */
                there = rgb_scale(there, (float)sqrt(square_beyond(&eye)));
                back = rgb_scale(back, (float)sqrt(square_beyond(&photon)));
            }
            const float a[3] = {there.r, there.g, there.b}, c[3] = {back.r, back.g, back.b};
            for (int j = 0; j < 3; j++) {
                if (!(fabsf(a[j] - c[j]) <= 1e-2f * fabsf(c[j]) + 1e-5f) ||
                    !(fabsf(radiances[j] - fluxes[j]) <= 1e-2f * fabsf(fluxes[j]) + 1e-5f))
                    fail_msg("%s: %g there, %g back; %g of radiance, %g of flux", r->name, (double)a[j], (double)c[j],
                             (double)radiances[j], (double)fluxes[j]);
            }
            compared += back.g > 0.0f;
        }
        assert_true(expected == 0 || compared > 500);
    }
}

/* Photons' share and the eye's share of a gathered lobe multiply to its value, also where the shading normal leans. */
static void gathered_lobes_are_products(void **state)
{
    const table *t = *state;
    rng random = test_random(15);
    int rows = 0;
    for (int k = 0; k < t->count; k++) {
        const row *r = &t->rows[k];
        if (r->s)
            continue;
        int compared = 0;
        for (int i = 0; i < 3000; i++) {
            vec3 normal = i % 2 ? UP : vec3_face_forward(random_direction(&random), UP);
            vec3 o = random_direction(&random), d = random_direction(&random);
            bsdf out = bsdf_of_point(&r->point, normal, o), in = bsdf_of_point(&r->point, normal, d);
            if (vec3_dot(d, normal) / d.z > 7.9f)
                continue; /* bounded, at grazing silhouettes */
            double expected = (double)bsdf_arrival_factor(&in) * fabs((double)d.z) / PI;
            rgb factor = o.z * d.z > 0.0f ? bsdf_gathered_reflection(&out) : bsdf_gathered_transmission(&out);
            rgb value = bsdf_evaluate(&out, BSDF_GATHERED, BSDF_RADIANCE, d);
            assert_close(value.r, expected * (double)factor.r, 1e-4 * (double)value.r + 1e-6);
            assert_close(value.g, expected * (double)factor.g, 1e-4 * (double)value.g + 1e-6);
            assert_close(value.b, expected * (double)factor.b, 1e-4 * (double)value.b + 1e-6);
            compared += value.g > 0.0f;
        }
        rows += compared > 500;
    }
    assert_true(rows >= 8);
}

/* Every lobe on a curve is traced; elsewhere diffuse lobes are gathered. */
static void curves_gather_nothing(void **state)
{
    const table *t = *state;
    const row *curve = &t->rows[t->count - 1], *textured = &t->rows[t->count - 3];
    bsdf on_curve = row_bsdf(curve, direction_at(30.0, 0.0)), on_disk = row_bsdf(textured, direction_at(30.0, 0.0));
    assert_true(curve->hit.is_strand && !bsdf_has(&on_curve, BSDF_GATHERED) && bsdf_has(&on_curve, BSDF_TRACED));
    assert_true(!textured->hit.is_strand && bsdf_has(&on_disk, BSDF_GATHERED));
    assert_true(scene_shape_is_traced(curve->s, &curve->s->shapes[curve->hit.shape_index]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_has_a_row),
        cmocka_unit_test(kinds_add_the_lobes_of_their_rows),
        cmocka_unit_test(samples_fall_and_weigh_as_is_said),
        cmocka_unit_test(radiance_gains_no_more_than_flux),
        cmocka_unit_test(scattering_is_reciprocal),
        cmocka_unit_test(gathered_lobes_are_products),
        cmocka_unit_test(curves_gather_nothing),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
