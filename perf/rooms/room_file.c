/* room_file.c: prints a room, directive by directive.
 * Format: pbrt-v4's scene description; the integrator's words are those of pbrt-v2's photon map.
 * Flow: room_layout -> [here] -> the renderer. Threads: any, on different paths. */
#include "rooms/room_file.h"

#include <stdbool.h>
#include <stdio.h>

/* Corners in an order that turns (p1 - p0) x (p2 - p0) into the room. */
typedef struct wall {
    const char *name;
    const char *reflectance;
    double corner[4][3];
} wall;

#define S ROOM_SIZE
static const wall walls[6] = {
    {"floor", "0.7 0.7 0.7", {{0, 0, 0}, {0, 0, S}, {S, 0, S}, {S, 0, 0}}},
    {"ceiling", "0.7 0.7 0.7", {{0, S, 0}, {S, S, 0}, {S, S, S}, {0, S, S}}},
    {"wall behind the eye", "0.7 0.7 0.7", {{0, 0, 0}, {S, 0, 0}, {S, S, 0}, {0, S, 0}}},
    {"wall before the eye", "0.7 0.7 0.7", {{0, 0, S}, {0, S, S}, {S, S, S}, {S, 0, S}}},
    {"left wall, red", "0.7 0.1 0.1", {{0, 0, 0}, {0, S, 0}, {0, S, S}, {0, 0, S}}},
    {"right wall, green", "0.1 0.7 0.1", {{S, 0, 0}, {S, 0, S}, {S, S, S}, {S, S, 0}}},
};
#undef S

static void print_quad(FILE *file, const double corner[4][3])
{
    fprintf(file, "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ]\n    \"point3 P\" [");
    for (int i = 0; i < 4; ++i) {
        fprintf(file, "  %.10g %.10g %.10g", corner[i][0], corner[i][1], corner[i][2]);
    }
    fprintf(file, " ]\n");
}

static void print_view(FILE *file, int gather_samples)
{
    fprintf(file, "LookAt %g %g %g  %g %g %g  0 1 0\n", ROOM_EYE_X, ROOM_EYE_Y, ROOM_EYE_Z, ROOM_EYE_X, ROOM_EYE_Y,
            ROOM_SIZE);
    fprintf(file,
            "Camera \"perspective\" \"float fov\" [ 90 ]\n"
            "Film \"rgb\" \"integer xresolution\" [ 400 ] \"integer yresolution\" [ 400 ]\n"
            "PixelFilter \"box\"\n"
            "Sampler \"independent\" \"integer pixelsamples\" [ 1 ]\n"
            "Integrator \"photonmap\"\n"
            "    \"integer indirectphotons\" [ %d ] \"integer causticphotons\" [ 0 ]\n"
            "    \"integer nused\" [ 300 ] \"float maxdist\" [ 3 ]\n"
            "    \"integer finalgathersamples\" [ %d ]\n",
            ROOM_PHOTON_COUNT, gather_samples);
}

static void print_light(FILE *file)
{
    /* The lamp's corners run as the ceiling's do, so it shines down; it is black, so it only shines. */
    const double low = 0.5 * (ROOM_SIZE - ROOM_LIGHT_SIZE), high = 0.5 * (ROOM_SIZE + ROOM_LIGHT_SIZE);
    const double height = ROOM_LIGHT_HEIGHT;
    const double corner[4][3] = {{low, height, low}, {high, height, low}, {high, height, high}, {low, height, high}};
    fprintf(file, "\nAttributeBegin # light\n"
                  "AreaLightSource \"diffuse\" \"rgb L\" [ 100 100 100 ]\n"
                  "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n");
    print_quad(file, corner);
    fprintf(file, "AttributeEnd\n");
}

static void print_room(FILE *file, const room_sphere *spheres, int sphere_count, int gather_samples)
{
    fprintf(file,
            "# Room %d of 40: a closed box, a light under its ceiling, %d diffuse sphere%s.\n"
            "# After the test suite of Neilson & Yang, TR 04-21, 2004; written by afterglow-rooms.\n",
            sphere_count, sphere_count, sphere_count == 1 ? "" : "s");
    print_view(file, gather_samples);
    fprintf(file, "\nWorldBegin\n");
    for (int i = 0; i < 6; ++i) {
        fprintf(file, "\n# %s\nMaterial \"diffuse\" \"rgb reflectance\" [ %s ]\n", walls[i].name, walls[i].reflectance);
        print_quad(file, walls[i].corner);
    }
    print_light(file);
    fprintf(file, "\nMaterial \"diffuse\" \"rgb reflectance\" [ 0.7 0.7 0.7 ]\n");
    for (int i = 0; i < sphere_count; ++i) {
        fprintf(file,
                "AttributeBegin Translate %.3f %.3f %.3f Shape \"sphere\" \"float radius\" [ %.3f ] AttributeEnd\n",
                spheres[i].center[0], spheres[i].center[1], spheres[i].center[2], spheres[i].radius);
    }
}

void room_file_name(int number, char *out_name, size_t size) { snprintf(out_name, size, "room-%02d.pbrt", number); }

ag_status room_file_write(const char *path, const room_sphere *spheres, int sphere_count, int gather_samples)
{
    FILE *file = fopen(path, "w");
    if (file == NULL) {
        return AG_ERROR_OUTPUT;
    }
    print_room(file, spheres, sphere_count, gather_samples);
    const bool failed = ferror(file) != 0;
    if (fclose(file) != 0 || failed) {
        return AG_ERROR_OUTPUT;
    }
    return AG_OK;
}
