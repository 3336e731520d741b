/* program_agreement.h: whether photon map and path tracer show the same light in a scene without a closed form. Both
 * render small pictures; their means, and means over blocks, are compared. Bounds are from noise that was measured over
 * seeds: of 40 comparisons the whole differed by 0.5 % (standard deviation), most blocks by 0.4 %, the median block was
 * 0.6 to 3.5 % off and nine in ten within 1.7 to 7.2 %. An error of three hundredths fails.
 * Flow: program_picture.h -> [here] -> tests/test_program_agreement*.c. Threads: the program's. */
#ifndef AFTERGLOW_PROGRAM_AGREEMENT_H
#define AFTERGLOW_PROGRAM_AGREEMENT_H

#include "program_picture.h"

enum { AGREEMENT_SIDE = 24, AGREEMENT_BLOCK = 4, AGREEMENT_BLOCKS = 36 };

static inline double block_luminance(const picture *p, int block)
{
    int across = AGREEMENT_SIDE / AGREEMENT_BLOCK, x = block % across * AGREEMENT_BLOCK,
        y = block / across * AGREEMENT_BLOCK;
    return 0.2126 * picture_block(p, x, y, AGREEMENT_BLOCK, 0) + 0.7152 * picture_block(p, x, y, AGREEMENT_BLOCK, 1) +
           0.0722 * picture_block(p, x, y, AGREEMENT_BLOCK, 2);
}

static inline int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct agreement_bounds {
    double whole;  /* of the error of the mean luminance, caustics and all their noise in it */
    double middle; /* of the mean error, signed, of the blocks but the highest and the lowest tenth */
    double median; /* of the median block's error, unsigned */
    double most;   /* of nine blocks in ten */
} agreement_bounds;

static inline void expect_agreement(const char *what, const picture *map, const picture *path, agreement_bounds bounds)
{
    enum { TENTH = AGREEMENT_BLOCKS / 10 };
    double error[AGREEMENT_BLOCKS], a = 0.0, b = 0.0, middle = 0.0;
    for (int i = 0; i < AGREEMENT_BLOCKS; i++) {
        double of_map = block_luminance(map, i), of_path = block_luminance(path, i);
        error[i] = of_map / of_path - 1.0;
        a += of_map, b += of_path;
    }
    qsort(error, AGREEMENT_BLOCKS, sizeof *error, compare_doubles);
    for (int i = TENTH; i < AGREEMENT_BLOCKS - TENTH; i++)
        middle += error[i] / (AGREEMENT_BLOCKS - 2 * TENTH);
    for (int i = 0; i < AGREEMENT_BLOCKS; i++)
        error[i] = fabs(error[i]);
    qsort(error, AGREEMENT_BLOCKS, sizeof *error, compare_doubles);
    double whole = a / b - 1.0, median = error[AGREEMENT_BLOCKS / 2], most = error[AGREEMENT_BLOCKS - 1 - TENTH];
    print_message("%s: %+.2f %%, most blocks %+.2f %%, the median block %.2f %%, nine in ten within %.2f %%\n", what,
                  100.0 * whole, 100.0 * middle, 100.0 * median, 100.0 * most);
    assert_true(fabs(whole) <= bounds.whole);
    assert_true(fabs(middle) <= bounds.middle);
    assert_true(median <= bounds.median);
    assert_true(most <= bounds.most);
}

/* only: NULL, or the argument for indirect light alone. Small estimates: what is lost along the edges of surfaces stays
 * below half a hundredth. fraction: NULL, or the argument that says how many photons bear irradiance. */
static inline void compare_integrators_with(const char *name, const char *path_samples, const char *only,
                                            const char *fraction, agreement_bounds bounds)
{
    char scene[512], what[128];
    snprintf(scene, sizeof scene, PROGRAM_SCENES "%s.pbrt", name);
    snprintf(what, sizeof what, "%s, %s light%s%s", name, only ? "indirect" : "all", fraction ? ", " : "",
             fraction ? fraction : "");
    picture map = RENDER(scene, "--size=24x24", "--photons=4e5", "--caustic-photons=1e5", "--nearest=16", "--spp=20",
                         "--gather-samples=10", only ? only : "--clamp-direct=0", fraction);
    picture path = RENDER(scene, "--size=24x24", "--integrator=path", path_samples, only);
    expect_agreement(what, &map, &path, bounds);
    picture_reset(&map);
    picture_reset(&path);
}

static inline void compare_integrators(const char *name, const char *path_samples, const char *only,
                                       agreement_bounds bounds)
{
    compare_integrators_with(name, path_samples, only, NULL, bounds);
}

#endif
