/* large_scene.c: the program afterglow-large-scene, which writes scenes of a size that shows what memory and time go
 * with: a hilly floor of so many triangles as a binary PLY, so many instances of one small thing, so many spheres, of
 * one material or of a material each, under a lamp; or so many lamps. Flow: -> a folder; afterglow renders what is in
 * it. Threads: one. */
#include "bench/path.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char USAGE[] = "usage: afterglow-large-scene triangles|instances|spheres|materials|lamps COUNT DIR\n"
                            "Writes DIR/KIND.pbrt, and for triangles DIR/triangles.ply.\n";

#define FLOOR "Shape \"trianglemesh\" \"point3 P\" [-8 0 -8  8 0 -8  8 0 8  -8 0 8] \"integer indices\" [0 2 1 0 3 2]\n"

#define VIEW                                                                                                           \
    "LookAt 0 4 -9  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\n"                                           \
    "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 48\nWorldBegin\n"

static const char BEGIN[] = VIEW "AttributeBegin\n"
                                 "AreaLightSource \"diffuse\" \"rgb L\" [20 20 20]\n"
                                 "Shape \"bilinearmesh\" \"point3 P\" [-1 8 -1  1 8 -1  -1 8 1  1 8 1]\n"
                                 "AttributeEnd\n"
                                 "Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n";

static bool is_host_little_endian(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

/* side * side vertices over [-8, 8]^2, two triangles to each square between them. */
static void write_hills(FILE *file, uint32_t side)
{
    const uint64_t squares = (uint64_t)(side - 1) * (side - 1);
    fprintf(
        file,
        "ply\nformat binary_%s_endian 1.0\nelement vertex %llu\nproperty float x\nproperty float y\nproperty float z\n"
        "element face %llu\nproperty list uchar uint vertex_indices\nend_header\n",
        is_host_little_endian() ? "little" : "big", (unsigned long long)side * side, (unsigned long long)(2 * squares));
    for (uint32_t i = 0; i < side; i++)
        for (uint32_t j = 0; j < side; j++) {
            double x = 16.0 * j / (side - 1) - 8.0, z = 16.0 * i / (side - 1) - 8.0;
            float p[3] = {(float)x, (float)(0.3 * sin(2.0 * x) * cos(3.0 * z) + 0.01 * sin(90.0 * x + 70.0 * z)),
                          (float)z};
            fwrite(p, sizeof p, 1, file);
        }
    for (uint32_t i = 0; i + 1 < side; i++)
        for (uint32_t j = 0; j + 1 < side; j++) {
            uint32_t a = i * side + j, corners[2][3] = {{a, a + side, a + 1}, {a + 1, a + side, a + side + 1}};
            for (int k = 0; k < 2; k++) {
                fputc(3, file);
                fwrite(corners[k], sizeof corners[k], 1, file);
            }
        }
}

/* Tetrahedra on a square grid, each turned its own way. */
static void write_instances(FILE *file, uint32_t count)
{
    uint32_t side = (uint32_t)ceil(sqrt((double)count));
    double size = 16.0 / side;
    fprintf(file,
            "%s" FLOOR "ObjectBegin \"t\"\nShape \"trianglemesh\" \"point3 P\" [1 1 1  1 -1 -1  -1 1 -1  -1 -1 1]\n"
            "    \"integer indices\" [0 1 2 0 3 1 0 2 3 1 3 2]\nObjectEnd\n",
            BEGIN);
    for (uint32_t i = 0; i < count; i++)
        fprintf(file,
                "AttributeBegin Translate %g %g %g Rotate %u 1 2 3 Scale %g %g %g ObjectInstance \"t\" AttributeEnd\n",
                (i % side + 0.5) * size - 8.0, 0.5 * size, (i / side + 0.5) * size - 8.0, i % 360, 0.3 * size,
                0.3 * size, 0.3 * size);
}

/* Spheres on a square grid, some higher than others, on a floor. */
static void write_balls(FILE *file, uint32_t count, bool has_materials)
{
    uint32_t side = (uint32_t)ceil(sqrt((double)count));
    double size = 16.0 / side;
    fprintf(file, "%s" FLOOR, BEGIN);
    for (uint32_t i = 0; i < count; i++) {
        fputs("AttributeBegin ", file);
        if (has_materials)
            fprintf(file, "Material \"diffuse\" \"rgb reflectance\" [%g %g %g] ", 0.2 + 0.005 * (i % 101),
                    0.2 + 0.004 * (i % 127), 0.2 + 0.003 * (i % 149));
        fprintf(file, "Translate %g %g %g Shape \"sphere\" \"float radius\" %g AttributeEnd\n",
                (i % side + 0.5) * size - 8.0, (0.5 + 0.1 * (i % 7)) * size, (i / side + 0.5) * size - 8.0,
                0.45 * size);
    }
}

static void write_spheres(FILE *file, uint32_t count) { write_balls(file, count, false); }
static void write_materials(FILE *file, uint32_t count) { write_balls(file, count, true); }

/* Squares that face down, on a square grid above the floor, each of its own colour; all together are as bright as one
 * alone. */
static void write_lamps(FILE *file, uint32_t count)
{
    uint32_t side = (uint32_t)ceil(sqrt((double)count));
    double size = 16.0 / side, half = 0.25 * size;
    fputs(VIEW "Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n" FLOOR, file);
    for (uint32_t i = 0; i < count; i++) {
        double x = (i % side + 0.5) * size - 8.0, z = (i / side + 0.5) * size - 8.0, y = 3.0 + 0.2 * (i % 5);
        fprintf(file,
                "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [%g %g %g]\n"
                "Shape \"bilinearmesh\" \"point3 P\" [%g %g %g  %g %g %g  %g %g %g  %g %g %g] AttributeEnd\n",
                1.0 + i % 3, 1.0 + i % 5, 1.0 + i % 7, x - half, y, z - half, x + half, y, z - half, x - half, y,
                z + half, x + half, y, z + half);
    }
}

static FILE *create(const char *folder, const char *name)
{
    char path[PATH_SIZE];
    if (!path_join(folder, name, path))
        return NULL;
    FILE *file = fopen(path, "wb");
    if (!file)
        perror(path);
    return file;
}

static bool finish(FILE *file)
{
    bool is_whole = !ferror(file);
    is_whole = fclose(file) == 0 && is_whole;
    if (!is_whole)
        fputs("afterglow-large-scene: error: the file cannot be written to its end\n", stderr);
    return is_whole;
}

static void write_triangles(FILE *file, uint32_t count)
{
    (void)count;
    fprintf(file, "%sShape \"plymesh\" \"string filename\" \"triangles.ply\"\n", BEGIN);
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name, *file;
        void (*write)(FILE *file, uint32_t count);
    } KINDS[] = {{"triangles", "triangles.pbrt", write_triangles},
                 {"instances", "instances.pbrt", write_instances},
                 {"spheres", "spheres.pbrt", write_spheres},
                 {"materials", "materials.pbrt", write_materials},
                 {"lamps", "lamps.pbrt", write_lamps}};
    enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS, TRIANGLES = 0 };
    char *end = NULL;
    const unsigned long count = argc == 4 ? strtoul(argv[2], &end, 10) : 0;
    int kind = 0;
    while (argc == 4 && kind < KIND_COUNT && strcmp(argv[1], KINDS[kind].name) != 0)
        kind++;
    if (argc != 4 || kind == KIND_COUNT || *end != '\0' || count < 2 || count > 1000000000) {
        fputs(USAGE, stderr);
        return 2;
    }
    FILE *file = create(argv[3], KINDS[kind].file);
    if (!file)
        return 1;
    KINDS[kind].write(file, (uint32_t)count);
    if (!finish(file))
        return 1;
    if (kind != TRIANGLES)
        return 0;
    if (!(file = create(argv[3], "triangles.ply")))
        return 1;
    write_hills(file, (uint32_t)ceil(sqrt((double)count / 2.0)) + 1);
    return finish(file) ? 0 : 1;
}
