/* test_pbrt_curves.c: Shape "curve" as the pbrt reader makes it: each basis and degree as a cubic, widths, ribbons'
 * normals, what has its own space, what is joined, and every error by its message. Threads: one. */
#include "fixtures/pbrt_fixture.h"

static const double FOUR[4][3] = {{0, 1, 2}, {3, -1, 0.5}, {1, 4, 1}, {-2, 0, 3}};
#define POINTS_3 "\"point3 P\" [0 1 2 3 -1 .5 1 4 1] "
#define POINTS_4 "\"point3 P\" [0 1 2 3 -1 .5 1 4 1 -2 0 3] "

/* The point of a segment at u. */
static void at(const curves *c, uint32_t segment, double u, double out[3])
{
    double w = 1.0 - u, b[4] = {w * w * w, 3 * u * w * w, 3 * u * u * w, u * u * u};
    out[0] = out[1] = out[2] = 0.0;
    for (int k = 0; k < 4; k++) {
        vec3 p = c->points[4 * segment + (uint32_t)k].at;
        out[0] += b[k] * (double)p.x, out[1] += b[k] * (double)p.y, out[2] += b[k] * (double)p.z;
    }
}

/* Weights of the first points in each basis at u, by its definition. */
static void weigh(int degree, bool is_bspline, double u, double b[4])
{
    double w = 1.0 - u;
    b[3] = 0.0;
    if (degree == 2 && is_bspline) {
        b[0] = w * w / 2, b[1] = (-2 * u * u + 2 * u + 1) / 2, b[2] = u * u / 2;
    } else if (degree == 2) {
        b[0] = w * w, b[1] = 2 * u * w, b[2] = u * u;
    } else if (is_bspline) {
        b[0] = w * w * w / 6, b[1] = (3 * u * u * u - 6 * u * u + 4) / 6;
        b[2] = (-3 * u * u * u + 3 * u * u + 3 * u + 1) / 6, b[3] = u * u * u / 6;
    } else {
        b[0] = w * w * w, b[1] = 3 * u * w * w, b[2] = 3 * u * u * w, b[3] = u * u * u;
    }
}

static void every_basis_is_a_cubic(void **state)
{
    (void)state;
    for (int degree = 2; degree <= 3; degree++)
        for (int is_bspline = 0; is_bspline < 2; is_bspline++)
            for (int is_flat = 0; is_flat < 2; is_flat++) { /* flat ones are cut into pieces, whose spans tell where */
                char text[512];
                snprintf(text, sizeof text,
                         "WorldBegin Shape \"curve\" \"string type\" \"%s\" \"integer degree\" %d \"string basis\" "
                         "\"%s\" \"float width0\" 0.002 \"float width1\" .001 %s",
                         is_flat ? "flat" : "cylinder", degree, is_bspline ? "bspline" : "bezier",
                         degree == 2 ? POINTS_3 : POINTS_4);
                reading r = reading_of(text);
                const curves *c = &r.scene->shapes[0].as.curves;
                assert_int_equal(r.scene->shapes[0].kind, SHAPE_CURVES);
                assert_true(is_flat ? c->segment_count > 2 : c->segment_count == 1);
                float reached = 0.0f;
                for (uint32_t k = 0; k < c->segment_count; k++) {
                    assert_true(c->spans[k].x == reached);
                    reached = c->spans[k].y;
                    for (int i = 0; i <= 4; i++) {
                        double u = (double)c->spans[k].x + i / 4.0 * ((double)c->spans[k].y - (double)c->spans[k].x);
                        double b[4], p[3], expected[3] = {0, 0, 0};
                        weigh(degree, is_bspline, u, b);
                        at(c, k, i / 4.0, p);
                        for (int j = 0; j < 3; j++) {
                            for (int n = 0; n < 4; n++)
                                expected[j] += b[n] * FOUR[n][j];
                            assert_near(p[j], expected[j], 1e-5);
                        }
                    }
                    assert_near((double)c->points[4 * k].radius, 0.001 - 0.0005 * (double)c->spans[k].x, 1e-8);
                }
                assert_true(reached == 1.0f);
                reading_destroy(&r);
            }
}

/* Segments go on where the one before ends; widths run over all of them. */
static void segments_hang_together(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        uint32_t count;
    } CASES[] = {
        {"\"string basis\" \"bezier\" \"point3 P\" [0 0 0 1 0 0 2 1 0 3 0 0 4 1 1 5 1 1 6 0 0]", 2},
        {"\"string basis\" \"bspline\" \"point3 P\" [0 0 0 1 0 0 2 1 0 3 0 0 4 1 1 5 1 1 6 0 0]", 4},
        {"\"integer degree\" 2 \"point3 P\" [0 0 0 1 0 0 2 1 0 3 0 0 4 1 1 5 1 1 6 0 0]", 3},
        {"\"integer degree\" 2 \"string basis\" \"bspline\" \"point3 P\" [0 0 0 1 0 0 2 1 0 3 0 0 4 1 1]", 3},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "WorldBegin Scale 2 2 2 Shape \"curve\" \"string type\" \"cylinder\" \"float width0\" 1 "
                 "\"float width1\" 3 \"integer splitdepth\" 2 %s",
                 CASES[i].text);
        reading r = reading_of(text);
        const curves *c = &r.scene->shapes[0].as.curves;
        assert_int_equal(c->segment_count, CASES[i].count);
        for (uint32_t k = 0; k < c->segment_count; k++) {
            double end[3], begin[3];
            at(c, k, 1.0, end);
            if (k + 1 < c->segment_count) {
                at(c, k + 1, 0.0, begin);
                for (int j = 0; j < 3; j++)
                    assert_near(begin[j], end[j], 1e-5);
            }
            assert_near((double)c->points[4 * k + 3].radius, 1.0 + 2.0 * (k + 1) / c->segment_count, 1e-5);
        }
        reading_destroy(&r);
    }
}

/* A bent ribbon is cut; at each cut its normal is the part across the curve of the one that turns evenly. */
static void a_ribbons_normals_turn_evenly(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin Scale 1 1 -1 Shape \"curve\" \"string type\" \"ribbon\" " POINTS_4
                           "\"normal N\" [0 2 0 0 0 -5]");
    const curves *c = &r.scene->shapes[0].as.curves;
    float reached = 0.0f;
    assert_true(r.scene->shapes[0].flip_normal); /* as a mesh in a mirror */
    assert_true(c->segment_count > 4);
    for (uint32_t k = 0; k < c->segment_count; k++) {
        assert_true(c->spans[k].x == reached);
        reached = c->spans[k].y;
        for (int end = 0; end < 2; end++) {
            double u = (double)(end ? c->spans[k].y : c->spans[k].x);
            const curve_point *q = c->points + 4 * k;
            vec3 n = c->normals[4 * k + (end ? 3 : 0)];
            vec3 even = {0.0f, (float)cos(u * 1.5707963), (float)sin(u * 1.5707963)};
            vec3 along = vec3_normalize(end ? vec3_sub(q[3].at, q[2].at) : vec3_sub(q[1].at, q[0].at));
            vec3 expected = vec3_normalize(vec3_add_scaled(even, along, -vec3_dot(even, along)));
            assert_near((double)vec3_dot(vec3_normalize(n), expected), 1.0, 1e-5);
        }
    }
    assert_true(reached == 1.0f);
    reading_destroy(&r);
}

/* Embree needs a direction at each end of a ribbon. Where two control points coincide, they do not tell one. */
static void a_ribbon_knows_its_direction(void **state)
{
    (void)state;
    static const char *const POINTS[] = {"0 0 0 0 0 0 0 1 2 0 0 3", "0 0 0 0 1 1 0 0 3 0 0 3",
                                         "0 0 0 0 0 0 0 0 3 0 0 3", "0 0 0 0 0 0 0 0 0 0 0 3"};
    for (int i = 0; i < 4; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "WorldBegin Shape \"curve\" \"string type\" \"ribbon\" \"normal N\" [1 0 0 1 1 0] \"point3 P\" [%s]",
                 POINTS[i]);
        reading r = reading_of(text);
        const curves *c = &r.scene->shapes[0].as.curves;
        const curve_point *first = c->points, *last = c->points + 4 * (c->segment_count - 1);
        vec3 to = vec3_sub(last[3].at, last[2].at), from = vec3_sub(first[1].at, first[0].at);
        assert_true(from.z > 0.002f * first[3].at.z && to.z > 0.002f * (last[3].at.z - last[0].at.z));
        assert_true(first[0].at.z == 0.0f && last[3].at.z == 3.0f);
        reading_destroy(&r);
    }
}

/* Fur is one shape, as long as it is alike; what is stretched, and alike, one object. */
static void alike_curves_are_joined(void **state)
{
    (void)state;
#define CURVE "Shape \"curve\" " POINTS_4
    static const struct {
        const char *text;
        uint32_t shapes, objects, instances;
    } CASES[] = {
        {CURVE CURVE "Translate 1 0 0 " CURVE, 1, 0, 0},
        {CURVE "Shape \"curve\" \"string type\" \"cylinder\" " POINTS_4 CURVE, 3, 0, 0},
        {CURVE "Material \"diffuse\" " CURVE CURVE, 2, 0, 0},
        {CURVE "ReverseOrientation " CURVE, 2, 0, 0},
        {CURVE "Shape \"curve\" \"float alpha\" .5 " POINTS_4, 2, 0, 0},
        {"Scale 1 2 1 " CURVE CURVE, 1, 1, 1},
        {"Scale 1 2 1 " CURVE "Scale 1 2 1 " CURVE, 2, 2, 2},
        {"Scale 1 2 1 " CURVE "Material \"diffuse\" " CURVE, 2, 1, 1},
        {"ObjectBegin \"a\" " CURVE CURVE "ObjectEnd " CURVE "ObjectInstance \"a\" ObjectInstance \"a\"", 2, 1, 2},
        {"ObjectBegin \"a\" Scale 1 2 1 " CURVE CURVE "ObjectEnd ObjectInstance \"a\"", 1, 2, 2},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[1024];
        snprintf(text, sizeof text, "WorldBegin %s", CASES[i].text);
        reading r = reading_of(text);
        assert_int_equal(r.scene->shape_count, CASES[i].shapes);
        assert_int_equal(r.scene->object_count, CASES[i].objects);
        assert_int_equal(r.scene->instance_count, CASES[i].instances);
        reading_destroy(&r);
    }
}

static void what_is_wrong_is_told(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } ERRORS[] = {
        {"", "t:1:12: error: Bezier curves of degree 3 have 4 points, and as many as the degree more for each further "
             "segment, not 0"},
        {"\"point3 P\" [0 0 0 1 1 1 2 2 2 3 3 3 4 4 4]", "for each further segment, not 5"},
        {"\"integer degree\" 2 " POINTS_4, "Bezier curves of degree 2 have 3 points"},
        {"\"string basis\" \"bspline\" " POINTS_3, "a B-spline of degree 3 has 4 points or more, not 3"},
        {"\"string basis\" \"hermite\" " POINTS_4, "unknown basis \"hermite\": it should be \"bezier\" or \"bspline\""},
        {"\"integer degree\" 4 " POINTS_4, "\"degree\" should be 2 or 3"},
        {"\"string type\" \"round\" " POINTS_4, "unknown type \"round\""},
        {"\"float width\" -1 " POINTS_4, "a curve's width should not be below 0"},
        {"\"float width1\" -1 " POINTS_4, "a curve's width should not be below 0"},
        {"\"float width\" \"wide\" " POINTS_4, "width"},
        {"\"point3 P\" [0 0 0 1 1 1 2 2 2 1e30 3 3]", "the curve reaches beyond 1e18 units in world space"},
        {"\"float width\" 1e30 " POINTS_4, "the curve reaches beyond 1e18 units in world space"},
        {"\"point3 P\" [0 0 0 1 1 1 2 2 2 nan 3 3]", "error"},
        {"\"string type\" \"ribbon\" " POINTS_4, "a \"ribbon\" needs normals \"N\" at the ends of its segments"},
        {"\"string type\" \"ribbon\" \"normal N\" [0 0 1] " POINTS_4,
         "a \"ribbon\" of 1 segments needs 2 normals, not 1"},
        {"\"string type\" \"ribbon\" \"normal N\" [0 0 1 0 0 0] " POINTS_4, "a ribbon's normal has no usable length"},
        {"\"string type\" \"ribbon\" \"normal N\" [0 0 1 0 0 -1] " POINTS_4,
         "opposite: which way does the ribbon turn?"},
        {"\"integer motionsteps\" 2 " POINTS_4, "for each further segment, not 2"},
        {"\"integer motionsteps\" 3 " POINTS_4, "\"P\" has 4 points, which is no multiple of the 3 of \"motionsteps\""},
        {"\"string type\" \"ribbon\" \"integer motionsteps\" 4 \"normal N\" [0 0 1 0 0 1] " POINTS_4,
         "a \"ribbon\" cannot have \"motionsteps\""},
    };
    static const struct {
        const char *text, *message;
        uint32_t shapes;
    } WARNINGS[] = {
        {"\"float width\" 0 " POINTS_4, "1 of 1 segments have no length or no width and are left out", 0},
        {"\"point3 P\" [1 1 1 1 1 1 1 1 1 1 1 1]", "1 of 1 segments have no length or no width and are left out", 0},
        {"\"point3 P\" [1 1 1 1 1 1 1 1 1 1 1 1 2 2 2 3 3 3 4 4 4]", "1 of 2 segments have no length", 1},
        {"\"normal N\" [0 0 1 0 0 1] " POINTS_4, "\"N\" is for curves of the type \"ribbon\" and is left out", 1},
    };
    char text[512];
    for (size_t i = 0; i < sizeof ERRORS / sizeof *ERRORS; i++) {
        int length = snprintf(text, sizeof text, "WorldBegin Shape \"curve\" %s", ERRORS[i].text);
        reading r = reading_create(NULL, text, (size_t)length);
        if (r.status == AG_OK || !r.said[AG_LOG_ERROR] || !strstr(r.said[AG_LOG_ERROR], ERRORS[i].message))
            fail_msg("%s: %s", text, r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "no error");
        reading_destroy(&r);
    }
    for (size_t i = 0; i < sizeof WARNINGS / sizeof *WARNINGS; i++) {
        int length = snprintf(text, sizeof text, "WorldBegin Shape \"curve\" %s", WARNINGS[i].text);
        reading r = reading_create(NULL, text, (size_t)length);
        assert_int_equal(r.status, AG_OK);
        if (!r.said[AG_LOG_WARNING] || !strstr(r.said[AG_LOG_WARNING], WARNINGS[i].message))
            fail_msg("%s: %s", text, r.said[AG_LOG_WARNING] ? r.said[AG_LOG_WARNING] : "no warning");
        assert_int_equal(r.scene->shape_count, WARNINGS[i].shapes);
        reading_destroy(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_basis_is_a_cubic),        cmocka_unit_test(segments_hang_together),
        cmocka_unit_test(a_ribbons_normals_turn_evenly), cmocka_unit_test(a_ribbon_knows_its_direction),
        cmocka_unit_test(alike_curves_are_joined),       cmocka_unit_test(what_is_wrong_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
