/* large_scene.c: the program afterglow-large-scene, which writes scenes of a size that shows what memory and time go
 * with: a hilly floor of so many triangles as a binary PLY, so many instances of one small thing, or so many spheres,
 * under a lamp. Flow: -> a folder; afterglow renders what is in it. Threads: one. */
#include "bench/path.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char USAGE[] =
    "usage: afterglow-large-scene triangles|instances|spheres COUNT DIR\n"
    "Writes DIR/triangles.pbrt and DIR/triangles.ply, DIR/instances.pbrt, or DIR/spheres.pbrt.\n";

static const char BEGIN[] = "LookAt 0 4 -9  0 0 0  0 1 0\n"
                            "Camera \"perspective\" \"float fov\" 60\n"
                            "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 48\n"
                            "WorldBegin\n"
                            "AttributeBegin\n"
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
            "%sShape \"trianglemesh\" \"point3 P\" [-8 0 -8  8 0 -8  8 0 8  -8 0 8] \"integer indices\" [0 2 1 0 3 2]\n"
            "ObjectBegin \"t\"\nShape \"trianglemesh\" \"point3 P\" [1 1 1  1 -1 -1  -1 1 -1  -1 -1 1]\n"
            "    \"integer indices\" [0 1 2 0 3 1 0 2 3 1 3 2]\nObjectEnd\n",
            BEGIN);
    for (uint32_t i = 0; i < count; i++)
        fprintf(file,
                "AttributeBegin Translate %g %g %g Rotate %u 1 2 3 Scale %g %g %g ObjectInstance \"t\" AttributeEnd\n",
                (i % side + 0.5) * size - 8.0, 0.5 * size, (i / side + 0.5) * size - 8.0, i % 360, 0.3 * size,
                0.3 * size, 0.3 * size);
}

/* Spheres on a square grid, some higher than others, on a floor. */
static void write_spheres(FILE *file, uint32_t count)
{
    uint32_t side = (uint32_t)ceil(sqrt((double)count));
    double size = 16.0 / side;
    fprintf(
        file,
        "%sShape \"trianglemesh\" \"point3 P\" [-8 0 -8  8 0 -8  8 0 8  -8 0 8] \"integer indices\" [0 2 1 0 3 2]\n",
        BEGIN);
    for (uint32_t i = 0; i < count; i++)
        fprintf(file, "AttributeBegin Translate %g %g %g Shape \"sphere\" \"float radius\" %g AttributeEnd\n",
                (i % side + 0.5) * size - 8.0, (0.5 + 0.1 * (i % 7)) * size, (i / side + 0.5) * size - 8.0,
                0.45 * size);
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

int main(int argc, char **argv)
{
    char *end = NULL;
    const unsigned long count = argc == 4 ? strtoul(argv[2], &end, 10) : 0;
    const bool is_mesh = argc == 4 && strcmp(argv[1], "triangles") == 0;
    const bool is_spheres = argc == 4 && strcmp(argv[1], "spheres") == 0;
    if (argc != 4 || (!is_mesh && !is_spheres && strcmp(argv[1], "instances") != 0) || *end != '\0' || count < 2 ||
        count > 1000000000) {
        fputs(USAGE, stderr);
        return 2;
    }
    FILE *file = create(argv[3], is_mesh ? "triangles.pbrt" : is_spheres ? "spheres.pbrt" : "instances.pbrt");
    if (!file)
        return 1;
    if (!is_mesh) {
        (is_spheres ? write_spheres : write_instances)(file, (uint32_t)count);
        return finish(file) ? 0 : 1;
    }
    fprintf(file, "%sShape \"plymesh\" \"string filename\" \"triangles.ply\"\n", BEGIN);
    if (!finish(file) || !(file = create(argv[3], "triangles.ply")))
        return 1;
    write_hills(file, (uint32_t)ceil(sqrt((double)count / 2.0)) + 1);
    return finish(file) ? 0 : 1;
}
