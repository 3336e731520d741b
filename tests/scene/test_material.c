/* test_material.c: what is known of materials without a bsdf: which of two a mix picks at a point, and whether they
 * have lobes that are traced. Threads: one. */
#include "fixtures/bsdf_fixture.h"

enum { SAMPLES = 60000 / FEWER };

static const char MIXES[] =
    "MakeNamedMaterial \"white\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n"
    "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"\n"
    "MakeNamedMaterial \"metal\" \"string type\" \"conductor\" \"float roughness\" 0.1\n"
    "MakeNamedMaterial \"two\" \"string type\" \"mix\" \"float amount\" %s\n"
    "\"string materials\" [ \"white\" \"glass\" ]\n"
    "MakeNamedMaterial \"three\" \"string type\" \"mix\" \"float amount\" 0.4\n"
    "\"string materials\" [ \"two\" \"metal\" ]\n"
    "NamedMaterial \"two\" Shape \"sphere\" Translate 3 0 0 NamedMaterial \"three\" Shape \"sphere\"\n"
    "Translate 3 0 0 NamedMaterial \"white\" Shape \"sphere\"";

static scene *mixes_create(test_run *run, const char *amount)
{
    char text[1024];
    snprintf(text, sizeof text, MIXES, amount);
    return test_scene_create(run, text);
}

/* Shares of diffuse, dielectric and conductor over many points of a shape: scattered about, or a fine row. */
static void mix_shares(const scene *s, uint32_t shape_index, bool in_a_row, double out_shares[3])
{
    int counts[3] = {0, 0, 0};
    rng random = test_random(16);
    for (int i = 0; i < SAMPLES; i++) {
        surface_hit hit = {.geometric_normal = UP, .shading_normal = UP, .shape_index = shape_index};
        hit.position = in_a_row ? (vec3){1e-4f * (float)i, 0.5f, 0.0f} : random_direction(&random);
        bsdf b;
        bsdf_init(s, &hit, direction_at(30.0, 20.0), &b);
        material_kind kind = b.material.kind;
        assert_true(kind == MATERIAL_DIFFUSE || kind == MATERIAL_DIELECTRIC || kind == MATERIAL_CONDUCTOR);
        counts[kind == MATERIAL_DIFFUSE ? 0 : kind == MATERIAL_DIELECTRIC ? 1 : 2]++;
        /* a point has one material for all rays that meet it */
        bsdf again;
        bsdf_init(s, &hit, direction_at(i % 180, 10.0 * i), &again);
        assert_int_equal(again.material.kind, kind);
        assert_int_equal(again.gathered_lobes & 1, kind == MATERIAL_DIFFUSE);
    }
    for (int k = 0; k < 3; k++)
        out_shares[k] = (double)counts[k] / SAMPLES;
}

static void check_shares(const double shares[3], double white, double glass, double metal)
{
    const double expected[3] = {white, glass, metal};
    for (int k = 0; k < 3; k++)
        assert_close(shares[k], expected[k], 5.0 * sqrt(expected[k] * (1.0 - expected[k]) / SAMPLES));
}

static void mixes_pick_by_point(void **state)
{
    (void)state;
    static const char *const AMOUNTS[] = {"0", "0.25", "0.8", "1", "-3", "7"};
    static const double SECOND[] = {0.0, 0.25, 0.8, 1.0, 0.0, 1.0};
    test_run run;
    test_run_init(&run, 1);
    for (int i = 0; i < 6; i++) {
        scene *s = mixes_create(&run, AMOUNTS[i]);
        double shares[3];
        for (int row = 0; row < 2; row++) {
            mix_shares(s, 0, row, shares);
            check_shares(shares, 1.0 - SECOND[i], SECOND[i], 0.0);
            mix_shares(s, 1, row, shares); /* nested: what the outer one picks says nothing of the inner one's */
            check_shares(shares, 0.6 * (1.0 - SECOND[i]), 0.6 * SECOND[i], 0.4);
            mix_shares(s, 2, row, shares);
            check_shares(shares, 1.0, 0.0, 0.0);
        }
        assert_true(material_is_traced(s, s->shapes[0].material_index));
        assert_true(material_is_traced(s, s->shapes[1].material_index));
        assert_false(material_is_traced(s, s->shapes[2].material_index));
        scene_destroy(s);
    }
    test_run_reset(&run);
}

static void materials_know_whether_they_are_traced(void **state)
{
    (void)state;
    static const struct {
        const char *type;
        bool is_traced;
    } CASES[] = {{"diffuse", false},       {"diffusetransmission", false}, {"conductor", true},
                 {"dielectric", true},     {"thindielectric", true},       {"coateddiffuse", true},
                 {"coatedconductor", true}};
    test_run run;
    test_run_init(&run, 1);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[256];
        snprintf(text, sizeof text, "Material \"%s\" Shape \"sphere\"", CASES[i].type);
        scene *s = test_scene_create(&run, text);
        assert_int_equal(material_is_traced(s, s->shapes[0].material_index), CASES[i].is_traced);
        surface_hit hit = {.geometric_normal = UP, .shading_normal = UP};
        bsdf b;
        bsdf_init(s, &hit, UP, &b);
        assert_int_equal(bsdf_has(&b, BSDF_TRACED), CASES[i].is_traced);
        scene_destroy(s);
    }
    test_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mixes_pick_by_point),
        cmocka_unit_test(materials_know_whether_they_are_traced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
