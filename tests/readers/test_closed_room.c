/* test_closed_room.c: where the camera stands, and what light is made, for models that are closed rooms, and for those
 * that are not. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/model_fixture.h"

/* An OBJ box, its faces turned in or out. */
typedef struct box {
    float low[3], high[3];
    bool faces_in;
} box;

/* Boxes one after the other; open: without the face towards +z of the first. */
static reading read_boxes(const box *boxes, int count, bool is_open)
{
    static const int FACES[6][4] = {{5, 6, 8, 7}, {1, 3, 4, 2}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
    char text[8192];
    size_t used = 0;
    for (int k = 0; k < count; k++) {
        for (int v = 0; v < 8; v++)
            used += (size_t)snprintf(text + used, sizeof text - used, "v %g %g %g\n",
                                     (double)(v & 1 ? boxes[k].high[0] : boxes[k].low[0]),
                                     (double)(v & 2 ? boxes[k].high[1] : boxes[k].low[1]),
                                     (double)(v & 4 ? boxes[k].high[2] : boxes[k].low[2]));
        for (int f = is_open && k == 0 ? 1 : 0; f < 6; f++)
            for (int c = 0; c < 5; c++) {
                int corner = c < 4 ? FACES[f][boxes[k].faces_in ? 3 - c : c] + 8 * k : 0;
                used += (size_t)(c == 4   ? snprintf(text + used, sizeof text - used, "\n")
                                 : c == 0 ? snprintf(text + used, sizeof text - used, "f %d", corner)
                                          : snprintf(text + used, sizeof text - used, " %d", corner));
            }
    }
    return model_of("boxes.obj", text);
}

/* Committed, as ag_scene_load does it. */
static void commit(reading *r)
{
    run_context run;
    assert_int_equal(r->status, AG_OK);
    thread_pool *pool;
    assert_int_equal(thread_pool_create(1, &pool), AG_OK);
    log_sink *log = log_create(reading_hear, r);
    run_context_init(&run, pool, log, NULL, NULL);
    assert_int_equal(scene_commit(r->scene, &run, NULL), AG_OK);
    run_context_reset(&run);
    log_destroy(log);
    thread_pool_destroy(pool);
}

static bool is_within(const scene *s, vec3 p)
{
    return p.x > s->bounds_min.x && p.x < s->bounds_max.x && p.y > s->bounds_min.y && p.y < s->bounds_max.y &&
           p.z > s->bounds_min.z && p.z < s->bounds_max.z;
}

static vec3 eye_of(const scene *s)
{
    const double(*m)[4] = s->camera.world_from_camera.m;
    return vec3_make((float)m[0][3], (float)m[1][3], (float)m[2][3]);
}

#define ROOM                                                                                                           \
    {                                                                                                                  \
        {0, 0, 0}, {6, 3, 4}, true                                                                                     \
    }
#define CHAIR                                                                                                          \
    {                                                                                                                  \
        {4, 0, 1}, {5, 1, 2}, false                                                                                    \
    }
#define SOLID                                                                                                          \
    {                                                                                                                  \
        {0, 0, 0}, {6, 3, 4}, false                                                                                    \
    } /* a block, or one thin wall whose faces are turned out */
#define WALLS                                                                                                          \
    {                                                                                                                  \
        {-0.2f, -0.2f, -0.2f}, {6.2f, 3.2f, 4.2f}, false                                                               \
    }

/* The camera stands in a corner, at half the height, and looks along the room's length; a lamp under the ceiling lights
 * it, and no sun. */
static void the_camera_stands_in_the_room(void **state)
{
    (void)state;
    static const box rooms[][3] = {{ROOM}, {ROOM, CHAIR}, {WALLS, ROOM, CHAIR}, {SOLID, CHAIR}};
    static const int COUNTS[] = {1, 2, 3, 2};
    for (int k = 0; k < 4; k++) {
        reading r = read_boxes(rooms[k], COUNTS[k], false);
        commit(&r);
        const vec3 eye = eye_of(r.scene);
        const double(*m)[4] = (const double(*)[4])r.scene->camera.world_from_camera.m;
        if (!(eye.x > 0.0f && eye.x < 6.0f && eye.z > 0.0f && eye.z < 4.0f))
            fail_msg("room %d: the eye is at (%g, %g, %g)", k, (double)eye.x, (double)eye.y, (double)eye.z);
        assert_near(eye.y, 1.5, 0.01);
        assert_true(eye.x < 1.5f || eye.x > 4.5f);      /* near an end of its length */
        assert_true((eye.x < 3.0f) == (m[0][2] > 0.5)); /* it looks along the length */
        assert_near(m[1][2], 0.0, 1e-6);
        assert_near(m[1][1], 1.0, 1e-6); /* up is up */
        assert_int_equal(r.scene->light_count, 1);
        assert_int_equal(r.scene->lights[0].kind, LIGHT_POINT);
        const vec3 lamp = r.scene->lights[0].as.point.position;
        assert_true(lamp.x > 0.0f && lamp.x < 6.0f && lamp.z > 0.0f && lamp.z < 4.0f && lamp.y > 2.0f && lamp.y < 3.0f);
        reading_destroy(&r);
    }
}

/* Nothing to see from inside: solids, an open box, a solid turned inside out, one with a cavity that shows nothing. */
static void what_is_no_room_is_seen_from_outside(void **state)
{
    (void)state;
    const struct {
        box boxes[2];
        int count;
        bool is_open;
    } MODELS[] = {{{SOLID}, 1, false}, {{ROOM}, 1, true}, {{SOLID, {{8, 0, 0}, {9, 3, 4}, false}}, 2, false}};
    for (size_t k = 0; k < sizeof MODELS / sizeof *MODELS; k++) {
        reading r = read_boxes(MODELS[k].boxes, MODELS[k].count, MODELS[k].is_open);
        commit(&r);
        if (is_within(r.scene, eye_of(r.scene)))
            fail_msg("model %zu is looked at from inside", k);
        assert_int_equal(r.scene->light_count, 2);
        assert_int_equal(r.scene->lights[0].kind, LIGHT_INFINITE);
        reading_destroy(&r);
    }
    /* a ball of triangles, its faces turned in: no room, for its walls lie on no bounds */
    char ball[32768];
    size_t used = 0;
    enum { ROWS = 8, COLUMNS = 16 };
    for (int row = 0; row <= ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            double theta = 3.14159265358979 * row / ROWS, phi = 2 * 3.14159265358979 * column / COLUMNS;
            used += (size_t)snprintf(ball + used, sizeof ball - used, "v %g %g %g\n", sin(theta) * cos(phi), cos(theta),
                                     sin(theta) * sin(phi));
        }
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            int a = row * COLUMNS + column + 1, b = row * COLUMNS + (column + 1) % COLUMNS + 1;
            used +=
                (size_t)snprintf(ball + used, sizeof ball - used, "f %d %d %d %d\n", a, a + COLUMNS, b + COLUMNS, b);
        }
    for (int turned = 0; turned < 2; turned++) {
        reading r = model_of("ball.obj", ball);
        for (uint32_t i = 0; i < r.scene->shape_count; i++)
            r.scene->shapes[i].flip_normal = turned != 0;
        commit(&r);
        assert_true(!is_within(r.scene, eye_of(r.scene)));
        reading_destroy(&r);
    }
}

/* A lamp in the file stays the only one; a room with a hole keeps its sun beside the lamp that is made. */
static void light_is_made_where_there_is_none(void **state)
{
    (void)state;
    model_write_text("boxes.mtl", "newmtl lamp\nKd 0 0 0\nKe 1 1 1\n");
    reading r = model_of("lit.obj", "mtllib boxes.mtl\nv 0 0 0\nv 6 0 0\nv 0 3 0\nv 6 3 0\nv 0 0 4\nv 6 0 4\nv 0 3 4\n"
                                    "v 6 3 4\nf 7 8 6 5\nf 2 4 3 1\nf 5 6 2 1\nf 4 8 7 3\nf 3 7 5 1\nf 6 8 4 2\n"
                                    "v 2 2.9 2\nv 3 2.9 2\nv 3 2.9 3\nusemtl lamp\nf 9 10 11\n");
    commit(&r);
    assert_true(is_within(r.scene, eye_of(r.scene)));
    assert_int_equal(r.scene->light_count, 1);
    assert_int_equal(r.scene->lights[0].kind, LIGHT_AREA);
    reading_destroy(&r);

    /* a roof with a hole in it of a ninth */
    r = model_of("hole.obj", "v 0 0 0\nv 6 0 0\nv 0 3 0\nv 6 3 0\nv 0 0 4\nv 6 0 4\nv 0 3 4\nv 6 3 4\n"
                             "f 7 8 6 5\nf 2 4 3 1\nf 5 6 2 1\nf 3 7 5 1\nf 6 8 4 2\n"
                             "v 4 3 0\nv 4 3 4\nv 4 3 2\nv 6 3 2\nf 9 10 7 3\nf 4 12 11 9\n");
    commit(&r);
    assert_int_equal(r.scene->light_count, is_within(r.scene, eye_of(r.scene)) ? 3 : 2);
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(the_camera_stands_in_the_room),
        TEST_IN_FOLDER(what_is_no_room_is_seen_from_outside),
        TEST_IN_FOLDER(light_is_made_where_there_is_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
