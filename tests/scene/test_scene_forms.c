/* test_scene_forms.c: where two scenes differ as rays meet them: what moved, came, went or was deformed is within the
 * boxes, also where there are more such things than boxes; colours, lamps and order make no difference.
 * Threads: one. */
#include "fixtures/test_scene.h"

#include "scene_forms.h"

static char text[1 << 17];

static scene_forms forms_of(const char *world)
{
    test_run r;
    scene_forms forms;
    test_run_init(&r, 1);
    scene *s = scene_create();
    assert_non_null(s);
    ag_status status = pbrt_parse_text(&r.run, "scene", world, strlen(world), s);
    if (status == AG_OK)
        status = scene_commit(s, &r.run, NULL);
    if (status != AG_OK)
        fail_msg("%s: %s", ag_status_text(status), r.said);
    assert_int_equal(scene_forms_create(s, &forms), AG_OK);
    scene_destroy(s);
    test_run_reset(&r);
    return forms;
}

static scene_difference difference_of(const char *one, const char *other)
{
    static const char BEGIN[] = "Camera \"perspective\"\nWorldBegin\n";
    scene_forms forms[2];
    scene_difference d, back;
    for (int i = 0; i < 2; i++) {
        char *whole = malloc(sizeof text + sizeof BEGIN);
        assert_non_null(whole);
        strcpy(whole, BEGIN);
        strcat(whole, i == 0 ? one : other);
        forms[i] = forms_of(whole);
        free(whole);
    }
    assert_int_equal(scene_forms_compare(&forms[0], &forms[1], &d), AG_OK);
    assert_int_equal(scene_forms_compare(&forms[1], &forms[0], &back), AG_OK);
    assert_true(d.is_known == back.is_known && d.count == back.count);
    scene_forms_reset(&forms[0]);
    scene_forms_reset(&forms[1]);
    return d;
}

static bool is_near(const scene_difference *d, float x, float y, float z, float distance)
{
    return scene_difference_is_near(d, (vec3){x, y, z}, distance * distance);
}

#define BALL(x) "AttributeBegin Translate " #x " 0 0 Shape \"sphere\" AttributeEnd\n"

static void test_same(void **state)
{
    (void)state;
    scene_difference d = difference_of(BALL(0) BALL(5) "LightSource \"point\" \"rgb I\" [1 2 3]\n",
                                       "Material \"conductor\"\n" BALL(5) BALL(0));
    assert_true(d.is_known && d.count == 0 && !is_near(&d, 0, 0, 0, 100));
    /* a lamp has the form of what does not shine */
    d = difference_of(BALL(0), "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n" BALL(0));
    assert_true(d.is_known && d.count == 0);
}

static void test_moved(void **state)
{
    (void)state;
    scene_difference d = difference_of(BALL(0) BALL(5), BALL(0) BALL(9));
    assert_true(d.is_known && d.count == 2);
    assert_true(is_near(&d, 5, 0, 0, 0.1f) && is_near(&d, 9.9f, 0, 0, 0.1f) && is_near(&d, 3, 0, 0, 1.1f));
    assert_true(!is_near(&d, 3, 0, 0, 0.9f) && !is_near(&d, 0, 0, 0, 3.9f) && is_near(&d, 0, 0, 0, 4.1f));
    d = difference_of(BALL(0), BALL(0) BALL(0)); /* one more in the same place */
    assert_true(d.is_known && d.count == 1 && is_near(&d, 0, 0, 0, 0.1f));
    d = difference_of(BALL(0) BALL(5), BALL(0) "Translate 5 0 0 Shape \"sphere\" \"float zmax\" .5");
    assert_true(d.is_known && d.count == 2 && is_near(&d, 5, 0, 0, 0.1f) && !is_near(&d, 0, 0, 0, 1));
}

#define OBJECT(radius) "ObjectBegin \"thing\" Shape \"sphere\" \"float radius\" " #radius " ObjectEnd\n"
#define PLACED(x)      "AttributeBegin Translate " #x " 0 0 ObjectInstance \"thing\" AttributeEnd\n"

static void test_instances(void **state)
{
    (void)state;
    scene_difference d = difference_of(OBJECT(1) PLACED(0) PLACED(5), OBJECT(1) PLACED(0) PLACED(9));
    assert_true(d.is_known && d.count == 2);
    assert_true(is_near(&d, 5, 0, 0, 0.1f) && is_near(&d, 9, 0, 0, 0.1f) && !is_near(&d, 0, 0, 0, 3.9f));
    d = difference_of(OBJECT(1) PLACED(0) PLACED(5), OBJECT(2) PLACED(0) PLACED(5)); /* both of another form */
    assert_true(d.is_known && d.count == 4 && is_near(&d, 0, 0, 0, 0.1f) && is_near(&d, 6.9f, 0, 0, 0.1f));
    /* wherever it is while the shutter is open */
    d = difference_of(OBJECT(1) PLACED(5), OBJECT(1) "AttributeBegin Translate 5 0 0 ActiveTransform EndTime "
                                                     "Translate 0 8 0 ActiveTransform All ObjectInstance \"thing\" "
                                                     "AttributeEnd");
    assert_true(d.is_known && is_near(&d, 5, 8.9f, 0, 0.1f));
    /* an object without instances is nowhere */
    d = difference_of(BALL(0), OBJECT(3) BALL(0));
    assert_true(d.is_known && d.count == 0);
}

/* Five hundred small balls that all move. */
static void test_many(void **state)
{
    (void)state;
    static char other[sizeof text];
    rng random = test_random(3);
    vec3 at[500];
    size_t lengths[2] = {0, 0};
    for (int i = 0; i < 500; i++) {
        at[i] = (vec3){10.0f * rng_float(&random), 10.0f * rng_float(&random), 10.0f * rng_float(&random)};
        for (int k = 0; k < 2; k++) {
            char *out = k == 0 ? text : other;
            lengths[k] += (size_t)snprintf(out + lengths[k], sizeof text - lengths[k],
                                           "AttributeBegin Translate %.9g %.9g %.9g Shape \"sphere\" \"float radius\" "
                                           ".01 AttributeEnd\n",
                                           (double)at[i].x, (double)at[i].y, (double)at[i].z + 0.1 * k);
        }
    }
    scene_difference d = difference_of(text, other);
    assert_true(d.is_known && d.count == SCENE_DIFFERENCE_BOXES);
    for (int i = 0; i < 500; i++) {
        assert_true(is_near(&d, at[i].x, at[i].y, at[i].z, 1e-4f));
        assert_true(is_near(&d, at[i].x, at[i].y, at[i].z + 0.1f, 1e-4f));
    }
    assert_false(is_near(&d, 5, 5, -2, 1.9f));
}

static void test_unknown(void **state)
{
    (void)state;
#define CURVE  "Shape \"curve\" \"point3 P\" [9 0 0 9 0 1 9 0 2 9 0 3] \"float width\" .1\n"
#define NET    "Texture \"net\" \"float\" \"checkerboard\" \"float tex1\" 1 \"float tex2\" "
#define FOG    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0 0 0]\n"
#define MIST   FOG "MediumInterface \"fog\" \"\" Material \"interface\"\n" BALL(9)
#define NETTED "\nAttributeBegin Translate 9 0 0 Shape \"disk\" \"texture alpha\" \"net\" AttributeEnd\n"
    assert_true(difference_of(CURVE BALL(0), CURVE BALL(0) "LightSource \"point\"").is_known);
    assert_false(difference_of(CURVE BALL(0), CURVE BALL(1)).is_known);
    assert_true(difference_of(NET "0" NETTED BALL(0), NET "0" NETTED BALL(1)).is_known);
    assert_false(difference_of(NET "0" NETTED BALL(0), NET ".5" NETTED BALL(0)).is_known);
    assert_false(difference_of(BALL(0), BALL(0) NET "0" NETTED).is_known);
    assert_false(difference_of(BALL(0), BALL(0) MIST).is_known);
    /* where rays pass some matter, all of it counts */
    assert_true(difference_of(BALL(0) MIST, BALL(0) MIST).is_known);
    assert_false(difference_of(BALL(0) MIST, "Material \"conductor\"\n" BALL(0) MIST).is_known);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same), cmocka_unit_test(test_moved),
                                       cmocka_unit_test(test_instances), cmocka_unit_test(test_many),
                                       cmocka_unit_test(test_unknown)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
