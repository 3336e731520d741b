/* bench_scenes.c: see bench_scenes.h. Lengths in metres, but for the paper's room. */
#define _GNU_SOURCE
#include "bench/bench_scenes.h"

#include "rooms/room_file.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

const char *bench_scene_name(bench_scene which)
{
    static const char *const names[] = {"room", "interior", "glass"};
    return names[which];
}

const char *bench_size_name(bench_size size)
{
    static const char *const names[] = {"quick", "small", "large"};
    return names[size];
}

const bench_work *bench_work_of(bench_size size)
{
    static const bench_work works[] = {
        [BENCH_QUICK] = {.photons = 2000,
                         .rays = 4000,
                         .frame_side = 16,
                         .gather_rays = 16,
                         .shading_side = 16,
                         .shading_samples = 1,
                         .color_pixels = 4096,
                         .arithmetic_units = 1,
                         .stream_bytes = 3 << 20,
                         .stream_thread_bytes = 1 << 16,
                         .stream_passes = 1,
                         .turns = 1},
        [BENCH_SMALL] = {.photons = 100000,
                         .rays = 500000,
                         .frame_side = 80,
                         .gather_rays = 64,
                         .shading_side = 320,
                         .shading_samples = 4,
                         .color_pixels = 1920 * 1080,
                         .arithmetic_units = 8,
                         .stream_bytes = (uint64_t)256 << 20,
                         .stream_thread_bytes = (uint64_t)16 << 20,
                         .stream_passes = 8,
                         .turns = 5,
                         .turn_s = 0.5},
        [BENCH_LARGE] = {.photons = 1000000,
                         .rays = 2000000,
                         .frame_side = 200,
                         .gather_rays = 64,
                         .shading_side = 640,
                         .shading_samples = 8,
                         .color_pixels = 3840 * 2160,
                         .arithmetic_units = 8,
                         .stream_bytes = (uint64_t)1 << 30,
                         .stream_thread_bytes = (uint64_t)16 << 20,
                         .stream_passes = 4,
                         .turns = 3,
                         .turn_s = 0.7},
    };
    return &works[size];
}

/* --- parts of scenes --- */

/* The side that it faces does not matter: lamps have two sides, or face the room by the order of their corners. */
static void quad(FILE *file, double p[4][3])
{
    fprintf(file, "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [");
    for (int i = 0; i < 4; i++)
        fprintf(file, " %.10g %.10g %.10g", p[i][0], p[i][1], p[i][2]);
    fprintf(file, " ]\n");
}

/* A rectangle at right angles to an axis, x0 to x1 along the next one and y0 to y1 along the one after that. */
static void wall(FILE *file, int axis, double at, double x0, double x1, double y0, double y1)
{
    const double corners[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    double p[4][3];
    for (int i = 0; i < 4; i++) {
        p[i][axis] = at;
        p[i][(axis + 1) % 3] = corners[i][0];
        p[i][(axis + 2) % 3] = corners[i][1];
    }
    quad(file, p);
}

static void box(FILE *file, const double low[3], const double high[3])
{
    for (int axis = 0; axis < 3; axis++) {
        int next = (axis + 1) % 3, last = (axis + 2) % 3;
        wall(file, axis, low[axis], low[next], high[next], low[last], high[last]);
        wall(file, axis, high[axis], low[next], high[next], low[last], high[last]);
    }
}

static void diffuse(FILE *file, double red, double green, double blue)
{
    fprintf(file, "Material \"diffuse\" \"rgb reflectance\" [%.3g %.3g %.3g]\n", red, green, blue);
}

static void sphere(FILE *file, double x, double y, double z, double radius)
{
    fprintf(file, "AttributeBegin Translate %g %g %g Shape \"sphere\" \"float radius\" %g AttributeEnd\n", x, y, z,
            radius);
}

/* --- an interior: 4 x 2.6 x 6 --- */

static const double WIDTH = 4.0, HEIGHT = 2.6, DEPTH = 6.0;
static const double SILL = 0.9, LINTEL = 2.2, WINDOW_Z[2][2] = {{1.2, 2.6}, {3.4, 4.8}};

/* The wall x = WIDTH, about its windows, and their panes. */
static void write_window_wall(FILE *file)
{
    const double stops[4] = {0.0, WINDOW_Z[0][0], WINDOW_Z[1][0], DEPTH};
    diffuse(file, 0.75, 0.74, 0.7);
    wall(file, 0, WIDTH, 0.0, SILL, 0.0, DEPTH);
    wall(file, 0, WIDTH, LINTEL, HEIGHT, 0.0, DEPTH);
    wall(file, 0, WIDTH, SILL, LINTEL, stops[0], WINDOW_Z[0][0]);
    wall(file, 0, WIDTH, SILL, LINTEL, WINDOW_Z[0][1], WINDOW_Z[1][0]);
    wall(file, 0, WIDTH, SILL, LINTEL, WINDOW_Z[1][1], stops[3]);
    fprintf(file, "Material \"thindielectric\" \"float eta\" 1.5\n");
    for (int i = 0; i < 2; i++)
        wall(file, 0, WIDTH, SILL, LINTEL, WINDOW_Z[i][0], WINDOW_Z[i][1]);
}

static void write_shelves(FILE *file)
{
    enum { SHELVES = 5, BOOKS = 24 };
    for (int shelf = 0; shelf < SHELVES; shelf++) {
        double y = 0.25 + 0.42 * shelf;
        diffuse(file, 0.5, 0.36, 0.22);
        box(file, (const double[3]){0.02, y - 0.03, 2.0}, (const double[3]){0.32, y, 5.0});
        for (int book = 0; book < BOOKS; book++) {
            unsigned lot = (unsigned)(shelf * BOOKS + book) * 2654435761u; /* Knuth's multiplicative hash */
            double z = 2.02 + 0.123 * book, height = 0.2 + 0.015 * (double)(lot >> 28);
            diffuse(file, 0.15 + 0.04 * (double)(lot >> 24 & 15), 0.15 + 0.03 * (double)(lot >> 20 & 15),
                    0.12 + 0.03 * (double)(lot >> 16 & 15));
            box(file, (const double[3]){0.04, y + 0.001, z}, (const double[3]){0.26, y + height, z + 0.09});
        }
    }
}

static void write_interior(FILE *file)
{
    fprintf(file, "LookAt 3.4 1.5 0.3  1.2 1.1 4.5  0 1 0\nCamera \"perspective\" \"float fov\" 65\n"
                  "WorldBegin\n"
                  "LightSource \"distant\" \"point3 from\" [9 6 1] \"point3 to\" [0 0 3] \"rgb L\" [40 36 30]\n"
                  "LightSource \"infinite\" \"rgb L\" [1.2 1.5 2]\n");
    diffuse(file, 0.42, 0.3, 0.2);
    wall(file, 1, 0.0, 0.0, DEPTH, 0.0, WIDTH);
    diffuse(file, 0.8, 0.8, 0.78);
    wall(file, 1, HEIGHT, 0.0, DEPTH, 0.0, WIDTH);
    diffuse(file, 0.75, 0.74, 0.7);
    wall(file, 2, 0.0, 0.0, WIDTH, 0.0, HEIGHT);
    wall(file, 2, DEPTH, 0.0, WIDTH, 0.0, HEIGHT);
    diffuse(file, 0.62, 0.3, 0.22);
    wall(file, 0, 0.0, 0.0, HEIGHT, 0.0, DEPTH);
    write_window_wall(file);
    write_shelves(file);
    diffuse(file, 0.55, 0.42, 0.3); /* a table and what stands on it */
    box(file, (const double[3]){1.4, 0.7, 2.6}, (const double[3]){2.4, 0.74, 4.2});
    box(file, (const double[3]){1.45, 0.0, 2.65}, (const double[3]){1.52, 0.7, 2.72});
    box(file, (const double[3]){2.28, 0.0, 2.65}, (const double[3]){2.35, 0.7, 2.72});
    box(file, (const double[3]){1.45, 0.0, 4.08}, (const double[3]){1.52, 0.7, 4.15});
    box(file, (const double[3]){2.28, 0.0, 4.08}, (const double[3]){2.35, 0.7, 4.15});
    diffuse(file, 0.2, 0.35, 0.6);
    sphere(file, 1.8, 0.861, 3.0, 0.12);
    fprintf(file, "Material \"conductor\" \"float roughness\" 0.1\n");
    sphere(file, 2.05, 0.841, 3.6, 0.1);
}

/* --- glass and caustics: 4 x 3 x 4 --- */

static void write_glass(FILE *file)
{
    fprintf(file, "LookAt 0 1.5 -3.6  0 0.8 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\nWorldBegin\n"
                  "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [60 56 50]\n"
                  "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
                  "Shape \"bilinearmesh\" \"point3 P\" [-0.3 2.95 -0.3  0.3 2.95 -0.3  -0.3 2.95 0.3  0.3 2.95 0.3]\n"
                  "AttributeEnd\n");
    diffuse(file, 0.7, 0.68, 0.64);
    wall(file, 1, 0.0, -4.0, 2.0, -2.0, 2.0);
    wall(file, 1, 3.0, -4.0, 2.0, -2.0, 2.0);
    wall(file, 2, 2.0, -2.0, 2.0, 0.0, 3.0);
    wall(file, 2, -4.0, -2.0, 2.0, 0.0, 3.0);
    diffuse(file, 0.66, 0.2, 0.12);
    wall(file, 0, -2.0, 0.0, 3.0, -4.0, 2.0);
    diffuse(file, 0.14, 0.4, 0.5);
    wall(file, 0, 2.0, 0.0, 3.0, -4.0, 2.0);
    fprintf(file, "Material \"dielectric\" \"float eta\" 1.5\n");
    sphere(file, -0.75, 0.501, -0.3, 0.5);
    sphere(file, 0.85, 0.301, -0.9, 0.3);
    fprintf(
        file,
        "AttributeBegin Translate 0.55 0.601 0.6 Rotate 30 0 1 0\n"
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3 4 6 5 4 7 6 0 5 1 0 4 5 "
        "3 2 6 3 6 7 1 6 2 1 5 6 0 3 7 0 7 4]\n  \"point3 P\" [-0.35 -0.6 -0.35  0.35 -0.6 -0.35  0.35 -0.6 0.35  -0.35 -0.6 0.35 "
        " -0.35 0.6 -0.35  0.35 0.6 -0.35  0.35 0.6 0.35  -0.35 0.6 0.35]\nAttributeEnd\n"
        "Material \"conductor\" \"float roughness\" 0\n"
        "AttributeBegin Translate -0.6 0.001 1.0 Rotate -90 1 0 0\n" /* a ring on the floor */
        "Shape \"cylinder\" \"float radius\" 0.45 \"float zmin\" 0 \"float zmax\" 0.25\nAttributeEnd\n");
}

/* --- files --- */

static ag_status write_by(int descriptor, void (*write_scene)(FILE *file))
{
    int copy = dup(descriptor);
    FILE *file = copy >= 0 ? fdopen(copy, "w") : NULL;
    if (!file) {
        if (copy >= 0)
            close(copy);
        return AG_ERROR_SYSTEM;
    }
    write_scene(file);
    bool is_whole = !ferror(file);
    is_whole = fclose(file) == 0 && is_whole;
    return is_whole ? AG_OK : AG_ERROR_OUTPUT;
}

ag_status bench_scene_open(bench_scene which, int *out_descriptor)
{
    enum { ROOM = 20 };
    int descriptor = memfd_create(bench_scene_name(which), MFD_CLOEXEC);
    if (descriptor < 0)
        return AG_ERROR_SYSTEM;
    ag_status status = AG_OK;
    if (which == BENCH_SCENE_ROOM) {
        char path[64];
        room_sphere spheres[ROOM_COUNT];
        snprintf(path, sizeof path, "/proc/self/fd/%d", descriptor);
        status = room_layout_place(ROOM_SEED, spheres);
        if (status == AG_OK)
            status = room_file_write(path, spheres, ROOM, 64);
    } else {
        status = write_by(descriptor, which == BENCH_SCENE_INTERIOR ? write_interior : write_glass);
    }
    if (status == AG_OK)
        *out_descriptor = descriptor;
    else
        close(descriptor);
    return status;
}
