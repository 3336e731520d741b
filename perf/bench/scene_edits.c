/* scene_edits.c: the program afterglow-scene-edits: how long it takes from a change of a scene to the scene, and to a
 * first full picture of it, beside building the scene afresh, in turn in one run; and the heap that the scene takes. As
 * CSV. Flow: afterglow.h -> [here]. Threads: the context's. */
#define _GNU_SOURCE
#include "afterglow/afterglow.h"
#include "clock.h"

#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 5, SMALL_SIDE = 50 };

/* A change of the scene, each kind measured apart; FRESH makes the whole scene anew. */
typedef enum change { FRESH, CAMERA, LIGHT, MATERIAL, INSTANCE, SMALL_MESH, LARGE_MESH, CHANGES } change;

typedef struct sheet {
    float *points;
    int32_t *indices;
    size_t point_count, index_count;
} sheet;

typedef struct bench {
    ag_context *context;
    ag_scene *scene;
    sheet large, small;
    ag_handle lamp, copy, large_shape, small_shape;
    double moved; /* by which whatever is changed is so */
    int change_count;
} bench;

static bool make_sheet(int side, sheet *out)
{
    const size_t n = (size_t)side;
    *out = (sheet){malloc(3 * n * n * sizeof(float)), malloc(6 * (n - 1) * (n - 1) * sizeof(int32_t)), 3 * n * n,
                   6 * (n - 1) * (n - 1)};
    if (!out->points || !out->indices)
        return false;
    for (size_t i = 0; i < n * n; i++) {
        const double x = 2.0 * (double)(i % n) / (double)(n - 1) - 1.0,
                     y = 2.0 * (double)(i / n) / (double)(n - 1) - 1.0;
        const float p[3] = {(float)x, (float)y, (float)(0.1 * sin(20.0 * x) * cos(17.0 * y))};
        memcpy(out->points + 3 * i, p, sizeof p);
    }
    int32_t *to = out->indices;
    for (int y = 0; y + 1 < side; y++)
        for (int x = 0; x + 1 < side; x++) {
            const int32_t at = y * side + x, cell[6] = {at, at + 1, at + side, at + 1, at + side + 1, at + side};
            memcpy(to, cell, sizeof cell);
            to += 6;
        }
    return true;
}

/* handle 0: adds it. */
static ag_status say_sheet(bench *b, const sheet *s, const char *object, ag_handle *handle)
{
    const ag_parameter parameters[] = {
        {.name = "P", .type = AG_PARAMETER_POINT3, .count = s->point_count, .floats = s->points},
        {.name = "indices", .type = AG_PARAMETER_INTEGER, .count = s->index_count, .integers = s->indices}};
    ag_shape shape = ag_default_shape();
    shape.type = "trianglemesh";
    shape.parameters = parameters;
    shape.parameter_count = 2;
    shape.material = "clay";
    shape.object = object;
    return *handle ? ag_scene_change_shape(b->scene, *handle, &shape) : ag_scene_add_shape(b->scene, &shape, handle);
}

static ag_status say_light(bench *b)
{
    const float from[3] = {(float)b->moved, 2.0f, -3.0f}, intensity[3] = {20.0f, 20.0f, 20.0f};
    const ag_parameter parameters[] = {{.name = "from", .type = AG_PARAMETER_POINT3, .count = 3, .floats = from},
                                       {.name = "I", .type = AG_PARAMETER_RGB, .count = 3, .floats = intensity}};
    ag_light light = ag_default_light();
    light.type = "point";
    light.parameters = parameters;
    light.parameter_count = 2;
    return b->lamp ? ag_scene_change_light(b->scene, b->lamp, &light) : ag_scene_add_light(b->scene, &light, &b->lamp);
}

static ag_status say_material(bench *b, bool is_change)
{
    const float rgb[3] = {(float)b->moved, 0.5f, 0.5f};
    const ag_parameter p = {.name = "reflectance", .type = AG_PARAMETER_RGB, .count = 3, .floats = rgb};
    return (is_change ? ag_scene_change_material : ag_scene_add_material)(b->scene, "clay", "diffuse", &p, 1);
}

static ag_status say_camera(bench *b)
{
    const double away[16] = {1, 0, 0, 0.1 * b->moved, 0, 1, 0, 0, 0, 0, 1, -3, 0, 0, 0, 1};
    ag_camera camera = ag_default_camera();
    camera.world_from_camera = away;
    return ag_scene_set_camera(b->scene, &camera);
}

static ag_status say_copy(bench *b, const char *object, double z, ag_handle *handle)
{
    const double there[16] = {1, 0, 0, 0.1 * b->moved, 0, 1, 0, 0, 0, 0, 1, z, 0, 0, 0, 1};
    ag_instance copy = ag_default_instance();
    copy.object = object;
    copy.world_from_object = there;
    return *handle ? ag_scene_move(b->scene, *handle, there, NULL) : ag_scene_add_instance(b->scene, &copy, handle);
}

static ag_status make_all(bench *b)
{
    ag_scene_settings settings = ag_default_scene_settings();
    ag_handle large_copy = 0;
    settings.is_editable = true;
    b->lamp = b->copy = b->large_shape = b->small_shape = 0;
    ag_scene_destroy(b->scene);
    b->scene = NULL;
    ag_status status = ag_scene_create(b->context, &settings, &b->scene);
    if (status == AG_OK)
        status = say_camera(b);
    if (status == AG_OK)
        status = say_material(b, false);
    if (status == AG_OK)
        status = say_light(b);
    if (status == AG_OK)
        status = say_sheet(b, &b->large, "large", &b->large_shape);
    if (status == AG_OK)
        status = say_sheet(b, &b->small, "small", &b->small_shape);
    if (status == AG_OK)
        status = say_copy(b, "large", 0.0, &large_copy);
    return status == AG_OK ? say_copy(b, "small", -0.5, &b->copy) : status;
}

static ag_status apply(bench *b, change what)
{
    b->small.points[2] = b->large.points[2] =
        0.001f * (float)++b->change_count; /* else meshes would be those they were */
    switch (what) {
    case CAMERA: return say_camera(b);
    case LIGHT: return say_light(b);
    case MATERIAL: return say_material(b, true);
    case INSTANCE: return say_copy(b, "small", -0.5, &b->copy);
    case SMALL_MESH: return say_sheet(b, &b->small, "small", &b->small_shape);
    case LARGE_MESH: return say_sheet(b, &b->large, "large", &b->large_shape);
    default: return make_all(b);
    }
}

/* Renders one sample a pixel, with the photons that it needs. */
static ag_status look(bench *b)
{
    ag_render_settings settings;
    ag_film *film = NULL;
    ag_status status = ag_render_settings_from_scene(b->context, b->scene, &settings);
    if (status != AG_OK)
        return status;
    settings.width = 160;
    settings.height = 90;
    settings.samples_per_pixel = 1;
    settings.noise_level = 0.0f;
    settings.photon_count = 20000;
    settings.gather_samples = 4;
    status = ag_render(b->context, b->scene, &settings, &film);
    ag_film_destroy(film);
    return status;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* CPU milliseconds of all threads, [change][round]. */
static ag_status measure(bench *b, double to_scene[CHANGES][ROUNDS], double to_picture[CHANGES][ROUNDS])
{
    for (int round = 0; round < ROUNDS; round++)
        for (int what = FRESH; what < CHANGES; what++) {
            b->moved = 0.2 + 0.1 * round;
            const double begin = clock_process_cpu_seconds();
            ag_status status = apply(b, (change)what);
            if (status == AG_OK)
                status = ag_scene_commit(b->scene);
            const double made = clock_process_cpu_seconds();
            if (status == AG_OK)
                status = look(b);
            if (status != AG_OK)
                return status;
            to_scene[what][round] = 1e3 * (made - begin);
            to_picture[what][round] = 1e3 * (clock_process_cpu_seconds() - begin);
        }
    return AG_OK;
}

static size_t used_bytes(void)
{
    const struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
}

static void say(void *user, ag_log_level level, const char *message)
{
    (void)user;
    if (level <= AG_LOG_WARNING)
        fprintf(stderr, "%s\n", message);
}

int main(int argc, char **argv)
{
    static const char *const NAMES[CHANGES] = {
        "fresh", "camera", "light", "material", "instance", "mesh of an object", "largest mesh"};
    static double to_scene[CHANGES][ROUNDS], to_picture[CHANGES][ROUNDS];
    const int side = argc == 2 ? atoi(argv[1]) : 0;
    if (side < 2 || side > 10000) {
        fputs("usage: afterglow-scene-edits SIDE\nThe largest mesh has 2 SIDE^2 triangles. Prints, of each change, CPU "
              "milliseconds to the scene and to a first picture, and both as a share of a fresh build: medians.\n",
              stderr);
        return 2;
    }
    bench b = {.moved = 0.1};
    ag_context_settings settings = ag_default_context_settings();
    settings.log = say;
    ag_status status = make_sheet(side, &b.large) && make_sheet(SMALL_SIDE, &b.small) ? AG_OK : AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = ag_context_create(&settings, &b.context);
    const size_t before = used_bytes();
    if (status == AG_OK)
        status = measure(&b, to_scene, to_picture);
    for (int what = FRESH; what < CHANGES && status == AG_OK; what++) {
        qsort(to_scene[what], ROUNDS, sizeof(double), compare);
        qsort(to_picture[what], ROUNDS, sizeof(double), compare);
        const double made = to_scene[what][ROUNDS / 2], seen = to_picture[what][ROUNDS / 2];
        if (what == FRESH)
            puts("change,scene_ms,picture_ms,scene_of_fresh,picture_of_fresh");
        printf("%s,%.2f,%.1f,%.4f,%.3f\n", NAMES[what], made, seen, made / to_scene[FRESH][ROUNDS / 2],
               seen / to_picture[FRESH][ROUNDS / 2]);
    }
    if (status == AG_OK)
        printf("heap of the scene without its trees,%.1f MB\n", (double)(used_bytes() - before) / 1e6);
    else
        fprintf(stderr, "afterglow-scene-edits: error: %s\n", ag_status_text(status));
    ag_scene_destroy(b.scene);
    ag_context_destroy(b.context);
    free(b.large.points);
    free(b.large.indices);
    free(b.small.points);
    free(b.small.indices);
    return status == AG_OK ? 0 : 1;
}
