/* test_scene_motion.c: meshes with motion steps by the C API: borrowed and copied arrays, doubles and a file have one
 * picture, by any number of threads; changes are seen; what is wrong with them is named. Shapes and instances along
 * matrices of more than two times. Threads: the context's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/scene_desk.h"

enum { STEPS = 3, VERTICES = 4, COUNT = 3 * SIZE * SIZE };

/* A square at three times, turned and bent; behind P there is room. */
static float positions[3 * STEPS * VERTICES + 1], normals[3 * STEPS * VERTICES];
static double doubles[3 * STEPS * VERTICES];
static const float UVS[] = {0, 0, 1, 0, 1, 1, 0, 1};
static const int32_t STEP_COUNT = STEPS, INDICES[] = {0, 1, 2, 0, 2, 3};

static void make_arrays(float bend)
{
    for (int k = 0; k < STEPS; k++)
        for (int i = 0; i < VERTICES; i++) {
            const float *corner = CORNERS + 3 * i, turn = 0.3f * (float)k;
            float *p = positions + 3 * (k * VERTICES + i), *n = normals + 3 * (k * VERTICES + i);
            p[0] = 0.7f * (corner[0] - turn * corner[1]);
            p[1] = 0.7f * (corner[1] + turn * corner[0]);
            p[2] = 0.25f + bend * (float)(k * i % 3);
            n[0] = 0.1f * (float)i, n[1] = 0.2f * (float)k, n[2] = -1.0f;
        }
    for (int i = 0; i < 3 * STEPS * VERTICES; i++)
        doubles[i] = (double)positions[i];
}

typedef struct words {
    ag_parameter parameters[5];
    ag_shape shape;
} words;

static void describe(bool is_borrowed, bool is_of_doubles, words *w)
{
    w->parameters[0] = (ag_parameter){"P", AG_PARAMETER_POINT3, 3 * STEPS * VERTICES, .floats = positions};
    if (is_of_doubles)
        w->parameters[0].doubles = doubles, w->parameters[0].floats = NULL;
    w->parameters[1] = (ag_parameter){"uv", AG_PARAMETER_POINT2, 2 * VERTICES, .floats = UVS};
    w->parameters[2] = (ag_parameter){"indices", AG_PARAMETER_INTEGER, 6, .integers = INDICES};
    w->parameters[3] = (ag_parameter){"motionsteps", AG_PARAMETER_INTEGER, 1, .integers = &STEP_COUNT};
    w->parameters[4] = (ag_parameter){"N", AG_PARAMETER_NORMAL, 3 * STEPS * VERTICES, .floats = normals};
    w->shape = ag_default_shape();
    w->shape.type = "trianglemesh";
    w->shape.parameters = w->parameters;
    w->shape.parameter_count = 5;
    w->shape.borrows_arrays = is_borrowed;
}

typedef enum variant { PLAIN, PLACED, MOVING, INSTANCE, MOVING_INSTANCE, VARIANT_COUNT } variant;

static void add_mesh(desk *d, words *w, variant v)
{
    ag_instance shown = ag_default_instance();
    w->shape.world_from_shape = v == PLACED ? ASIDE : NULL;
    w->shape.world_from_shape_end = v == MOVING ? ASIDE : NULL;
    w->shape.object = shown.object = v >= INSTANCE ? "o" : NULL;
    shown.world_from_object_end = v == MOVING_INSTANCE ? ASIDE : NULL;
    assert_int_equal(ag_scene_add_shape(d->made, &w->shape, NULL), AG_OK);
    if (v >= INSTANCE)
        assert_int_equal(ag_scene_add_instance(d->made, &shown, NULL), AG_OK);
}

static void add_floor(desk *d)
{
    square s;
    make_square(&s);
    s.shape.world_from_shape = (const double[]){3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 1, 0, 0, 0, 1};
    assert_int_equal(ag_scene_add_shape(d->made, &s.shape, NULL), AG_OK);
}

static void render_mesh(bool is_borrowed, bool is_of_doubles, bool is_editable, variant v, float *out_pixels)
{
    desk d;
    words w;
    if (is_editable)
        begin_lit_editable(&d);
    else
        begin_lit(&d);
    add_floor(&d);
    describe(is_borrowed, is_of_doubles, &w);
    add_mesh(&d, &w, v);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    render(d.context, d.made, out_pixels);
    if (d.said[0])
        fail_msg("said: %s", d.said);
    end(&d);
}

static void all_ways_have_one_picture(void **state)
{
    (void)state;
    float first[COUNT], other[COUNT], still[COUNT];
    make_arrays(0.05f);
    for (variant v = PLAIN; v < VARIANT_COUNT; v++) {
        desk_thread_count = 1;
        render_mesh(false, false, false, v, first);
        for (unsigned threads = 2; threads <= 5; threads += 3) {
            desk_thread_count = threads;
            render_mesh(false, false, false, v, other);
            assert_memory_equal(first, other, sizeof first);
        }
        desk_thread_count = 2;
        render_mesh(true, false, false, v, other);
        assert_memory_equal(first, other, sizeof first);
        render_mesh(false, true, false, v, other);
        assert_memory_equal(first, other, sizeof first);
        render_mesh(true, false, true, v, other);
        assert_memory_equal(first, other, sizeof first);
        if (v == PLAIN)
            memcpy(still, first, sizeof first);
        else if (v != INSTANCE)
            assert_memory_not_equal(still, first, sizeof first); /* something happens */
    }
}

enum { FIRST_TWO = 2 }; /* triangles */

/* The square and a third triangle, far away, which has no area until later; its first `steps` steps alone. */
static void render_lamp(const char *material, bool is_borrowed, bool is_editable, int32_t steps, int triangles,
                        float *out_pixels, char said[4096])
{
    static const float INK[] = {2, 2, 2}, NOTHING[] = {0, 0, 0}, SHINES[] = {3, 2, 1};
    static const int32_t THREE[] = {0, 1, 2, 0, 2, 3, 4, 5, 6};
    enum { CORNERS_EACH = 7 };
    static float p[3 * STEPS * CORNERS_EACH + 1];
    const ag_parameter ink[] = {{"sigma_a", AG_PARAMETER_RGB, 3, .floats = INK},
                                {"sigma_s", AG_PARAMETER_RGB, 3, .floats = NOTHING}},
                       light = {"L", AG_PARAMETER_RGB, 3, .floats = SHINES};
    desk d;
    words w;
    if (is_editable)
        begin_lit_editable(&d);
    else
        begin_lit(&d);
    add_floor(&d);
    assert_int_equal(ag_scene_add_medium(d.made, "ink", "homogeneous", ink, 2), AG_OK);
    assert_int_equal(ag_scene_add_material(d.made, "nothing", "interface", NULL, 0), AG_OK);
    for (int k = 0; k < STEPS; k++) {
        float *of_step = p + 3 * k * CORNERS_EACH;
        memcpy(of_step, positions + 3 * k * VERTICES, 3 * VERTICES * sizeof *p);
        for (int i = 0; i < 9; i++)
            of_step[3 * VERTICES + i] = i % 3 == 2 ? 0.75f : 5.0f + (float)k * (float)(i % 4);
    }
    describe(is_borrowed, false, &w);
    w.parameters[0] = (ag_parameter){"P", AG_PARAMETER_POINT3, (size_t)(3 * steps * CORNERS_EACH), .floats = p};
    w.parameters[1] = (ag_parameter){"motionsteps", AG_PARAMETER_INTEGER, 1, .integers = &steps};
    w.parameters[2] = (ag_parameter){"indices", AG_PARAMETER_INTEGER, (size_t)(3 * triangles), .integers = THREE};
    w.shape.parameter_count = 3;
    w.shape.is_light = true;
    w.shape.light_parameters = &light;
    w.shape.light_parameter_count = 1;
    w.shape.material = material;
    w.shape.medium_inside = material ? "ink" : NULL;
    assert_int_equal(ag_scene_add_shape(d.made, &w.shape, NULL), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    render(d.context, d.made, out_pixels);
    memcpy(said, d.said, sizeof d.said);
    end(&d);
}

/* A lamp stands as it does at first, without the triangle that has no area then; but the material "interface" does not
 * shine, so that it deforms. */
static void a_lamp_stands_still_where_it_has_a_surface(void **state)
{
    (void)state;
    float still[COUNT], first[COUNT], other[COUNT];
    char said[4096];
    make_arrays(0.05f);
    for (int has_surface = 0; has_surface < 2; has_surface++) {
        const char *material = has_surface ? NULL : "nothing";
        render_lamp(material, false, false, 1, FIRST_TWO, still, said);
        for (int way = 0; way < 4; way++) {
            render_lamp(material, way & 1, way & 2, STEPS, 3, way ? other : first, said);
            if (way > 0)
                assert_memory_equal(first, other, sizeof first);
            assert_non_null(strstr(said, has_surface ? "it stands as it does at the opening of the shutter"
                                                     : "a shape with the material \"interface\" cannot shine"));
            assert_null(strstr(said, has_surface ? "interface" : "it stands"));
            assert_null(strstr(said, "photon"));
        }
        if (has_surface)
            assert_memory_equal(still, first, sizeof first);
        else
            assert_memory_not_equal(still, first, sizeof first);
    }
}

/* A step that is written to and told of is seen, and what is not changed is kept. */
static void a_changed_step_is_seen(void **state)
{
    (void)state;
    desk d;
    words w;
    ag_handle handle;
    float first[COUNT], changed[COUNT], afresh[COUNT];
    for (int is_borrowed = 0; is_borrowed < 2; is_borrowed++) {
        make_arrays(0.05f);
        begin_lit_editable(&d);
        add_floor(&d);
        describe(is_borrowed, false, &w);
        assert_int_equal(ag_scene_add_shape(d.made, &w.shape, &handle), AG_OK);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        render(d.context, d.made, first);
        positions[3 * (2 * VERTICES + 1) + 2] += 0.2f; /* of the last step alone */
        doubles[3 * (2 * VERTICES + 1) + 2] = (double)positions[3 * (2 * VERTICES + 1) + 2];
        assert_int_equal(ag_scene_change_shape(d.made, handle, &w.shape), AG_OK);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        assert_int_equal(ag_scene_commit_counts(d.made).trees_built, 2);
        render(d.context, d.made, changed);
        end(&d);
        assert_memory_not_equal(first, changed, sizeof first);
        render_mesh(false, false, false, PLAIN, afresh);
        assert_memory_equal(changed, afresh, sizeof changed);
    }
}

/* The shutter of what moves by vertices alone may be another: its steps are spread over any, and it is a quarter as
 * bright. */
static void another_shutter_is_fine(void **state)
{
    (void)state;
    desk d;
    words w;
    make_arrays(0.05f);
    const float closing = 0.25f;
    const ag_parameter shutter = {"shutterclose", AG_PARAMETER_FLOAT, 1, .floats = &closing};
    ag_camera eye = ag_default_camera();
    eye.world_from_camera = AWAY;
    eye.parameters = &shutter;
    eye.parameter_count = 1;
    float first[COUNT], other[COUNT];
    begin_lit(&d);
    describe(false, false, &w);
    add_mesh(&d, &w, PLAIN);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    render(d.context, d.made, first);
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
    render(d.context, d.made, other);
    for (int i = 0; i < COUNT; i++)
        assert_true(first[i] == 4.0f * other[i]);
    end(&d);
}

static void expect_refused(desk *d, const words *w, ag_status status, const char *what)
{
    assert_int_equal(ag_scene_add_shape(d->made, &w->shape, NULL), status);
    expect_said(d, what);
}

static void mistakes_are_named(void **state)
{
    (void)state;
    static const int32_t NONE = 0, MANY = 130, FIVE = 5;
    float pixels[COUNT];
    make_arrays(0.05f);
    for (int is_borrowed = 0; is_borrowed < 2; is_borrowed++) {
        desk d;
        words w;
        begin_lit(&d);
        describe(is_borrowed, false, &w);
        w.parameters[3].integers = &NONE;
        expect_refused(&d, &w, AG_ERROR_SCENE,
                       "ag_scene_add_shape:1:4: error: \"motionsteps\" should be from 1 to 129");
        w.parameters[3].integers = &MANY;
        expect_refused(&d, &w, AG_ERROR_SCENE,
                       "ag_scene_add_shape:2:4: error: \"motionsteps\" should be from 1 to 129");
        w.parameters[3].integers = &FIVE;
        expect_refused(&d, &w, AG_ERROR_SCENE,
                       ":3:1: error: \"P\" has 12 points, which is no multiple of the 5 of \"motionsteps\"");
        describe(is_borrowed, false, &w);
        w.parameters[2].integers = (const int32_t[]){0, 1, 2, 0, 2, 4}; /* of the second step's */
        expect_refused(&d, &w, AG_ERROR_SCENE,
                       ":4:3: error: index 4 (value 6 of \"indices\") is out of range, there are 4 vertices");
        describe(is_borrowed, false, &w);
        positions[30] = NAN;
        expect_refused(&d, &w, AG_ERROR_ARGUMENT, is_borrowed ? "a value is not finite" : "value 31 is not finite");
        make_arrays(0.05f);
        describe(is_borrowed, false, &w);
        w.parameters[4].count = 3 * VERTICES; /* of one step alone */
        assert_int_equal(ag_scene_add_shape(d.made, &w.shape, NULL), AG_OK);
        expect_said(&d, "\"N\" should have 36 numbers as \"P\" goes, but has 12, and is ignored");
        describe(is_borrowed, false, &w);
        w.shape.is_light = true;
        assert_int_equal(ag_scene_add_shape(d.made, &w.shape, NULL), AG_OK);
        expect_said(&d, "a shape with an area light whose vertices move is not supported: it stands as it does at the "
                        "opening of the shutter");
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        render(d.context, d.made, pixels); /* which checks what is borrowed */
        assert_string_equal(d.said, "");
        end(&d);
    }
}

/* --- matrices of more than two times --- */

static const double STAYS[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
/* A path there and back, of which the two ends say nothing; and the half of the way there, straight on. */
static const double THERE_AND_BACK[2 * 16] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
static const double IN_HALVES[2 * 16] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                         1, 0, 0, 1,   0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

typedef enum shown_as { AS_SHAPE, AS_INSTANCE, AS_SHAPE_IN_OBJECT, AS_EDITED, SHOWN_AS_COUNT } shown_as;

/* A square that goes along these matrices. */
static void render_way(shown_as how, const double *ends, size_t count, float *out_pixels)
{
    desk d;
    square s;
    ag_handle handle;
    ag_instance shown = ag_default_instance();
    if (how == AS_EDITED)
        begin_lit_editable(&d);
    else
        begin_lit(&d);
    add_floor(&d);
    make_square(&s);
    assert_true(s.shape.end_count == 1 && shown.end_count == 1);
    s.shape.object = shown.object = how == AS_SHAPE ? NULL : "o";
    if (how == AS_SHAPE || how == AS_SHAPE_IN_OBJECT) {
        s.shape.world_from_shape_end = ends;
        s.shape.end_count = count;
    } else if (how == AS_INSTANCE) {
        shown.world_from_object_end = ends;
        shown.end_count = count;
    }
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_OK);
    if (how != AS_SHAPE)
        assert_int_equal(ag_scene_add_instance(d.made, &shown, &handle), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    if (how == AS_EDITED) {
        shown.world_from_object_end = ends;
        shown.end_count = count;
        assert_int_equal(ag_scene_change_instance(d.made, handle, &shown), AG_OK);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
    }
    render(d.context, d.made, out_pixels);
    if (d.said[0])
        fail_msg("said: %s", d.said);
    end(&d);
}

static double mean_difference(const float *a, const float *b)
{
    double sum = 0.0, all = 0.0;
    for (int i = 0; i < COUNT; i++) {
        sum += fabs((double)a[i] - (double)b[i]);
        all += (double)a[i];
    }
    return sum / all;
}

static void matrices_in_between_count(void **state)
{
    (void)state;
    float there_and_back[SHOWN_AS_COUNT][COUNT], still[COUNT], straight[COUNT], in_halves[COUNT], one_end[COUNT];
    for (shown_as how = AS_SHAPE; how < SHOWN_AS_COUNT; how++) {
        render_way(how, THERE_AND_BACK, 2, there_and_back[how]);
        render_way(how, STAYS, 1, still);
        render_way(how, THERE_AND_BACK, 1, one_end);
        render_way(how, ASIDE, 1, straight);
        render_way(how, IN_HALVES, 2, in_halves);
        assert_memory_equal(one_end, straight, sizeof straight); /* end_count 1 is as it ever was */
        print_message("%d: there and back: %.4f off what stands still; in halves %.4f off the straight way\n", how,
                      mean_difference(there_and_back[how], still), mean_difference(in_halves, straight));
        assert_true(mean_difference(there_and_back[how], still) > 0.05);
        assert_true(mean_difference(in_halves, straight) < 0.01);
    }
    assert_memory_equal(there_and_back[AS_INSTANCE], there_and_back[AS_EDITED], sizeof still);
}

static void wrong_matrices_in_between_are_told(void **state)
{
    (void)state;
    double wrong[2 * 16];
    desk d;
    ag_shape ball = ag_default_shape();
    begin_lit(&d);
    ball.type = "sphere";
    ball.world_from_shape_end = THERE_AND_BACK;
    for (int i = 0; i < 2; i++) {
        ball.end_count = i == 0 ? 0 : 129;
        assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_ERROR_ARGUMENT);
        expect_said(&d, "end_count should be from 1 to 128");
    }
    ball.world_from_shape_end = wrong;
    ball.end_count = 2;
    memcpy(wrong, THERE_AND_BACK, sizeof wrong);
    wrong[5] = 0.0;
    assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "its matrix cannot be undone");
    wrong[5] = -1.0; /* turned inside out in between alone */
    assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_ERROR_SCENE);
    expect_said(&d, "turns inside out on its way");
    ball.world_from_shape_end = NULL; /* of nothing any number will do */
    ball.end_count = 0;
    assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_OK);
    assert_string_equal(d.said, "");
    end(&d);
}

/* Hair of one object along one way shares a tree; along another one it does not. */
static void curves_share_a_way(void **state)
{
    (void)state;
    static const float STRAND[] = {0, -1, 0, 0, -0.5f, 0, 0, 0.5f, 0, 0, 1, 0};
    const ag_parameter points = {"P", AG_PARAMETER_POINT3, 12, .floats = STRAND};
    float pixels[2][COUNT];
    for (int is_editable = 0; is_editable < 2; is_editable++) {
        desk d;
        ag_shape strand = ag_default_shape();
        if (is_editable)
            begin_lit_editable(&d);
        else
            begin_lit(&d);
        strand.type = "curve";
        strand.parameters = &points;
        strand.parameter_count = 1;
        strand.end_count = 2;
        for (int i = 0; i < 4; i++) {
            strand.world_from_shape_end = i < 2 ? THERE_AND_BACK : IN_HALVES;
            assert_int_equal(ag_scene_add_shape(d.made, &strand, NULL), AG_OK);
        }
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        if (is_editable)
            assert_int_equal(ag_scene_commit_counts(d.made).trees_built, 3); /* the world's, and one of each way */
        render(d.context, d.made, pixels[is_editable]);
        end(&d);
    }
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_ways_have_one_picture), cmocka_unit_test(a_lamp_stands_still_where_it_has_a_surface),
        cmocka_unit_test(a_changed_step_is_seen),    cmocka_unit_test(another_shutter_is_fine),
        cmocka_unit_test(mistakes_are_named),        cmocka_unit_test(matrices_in_between_count),
        cmocka_unit_test(curves_share_a_way),        cmocka_unit_test(wrong_matrices_in_between_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
