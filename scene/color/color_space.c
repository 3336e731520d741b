/* color_space.c: see color_space.h.
 * Threads: pure functions. */
#define _POSIX_C_SOURCE 200809L
#include "color/color_space.h"

#include <strings.h>

const double COLOR_WHITE_XY[2] = {0.3127, 0.3290};

typedef struct chromaticities {
    const char *name;
    double primaries[3][2], white[2]; /* x, y */
} chromaticities;

static const chromaticities SPACES[] = {
    [COLOR_SPACE_SRGB] = {"srgb", {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}, {0.3127, 0.3290}},
    [COLOR_SPACE_DCI_P3] = {"dci-p3", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}, {0.3127, 0.3290}},
    [COLOR_SPACE_REC2020] = {"rec2020", {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}, {0.3127, 0.3290}},
    [COLOR_SPACE_ACES2065_1] = {"aces2065-1", {{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}}, {0.32168, 0.33767}},
    [COLOR_SPACE_ACESCG] = {"acescg", {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}}, {0.32168, 0.33767}},
};

bool color_space_find(const char *name, color_space *out_space)
{
    for (size_t i = 0; i < sizeof SPACES / sizeof *SPACES; i++)
        if (strcasecmp(name, SPACES[i].name) == 0) {
            *out_space = (color_space)i;
            return true;
        }
    return false;
}

void color_space_chromaticities(color_space space, double out_primaries[3][2], double out_white[2])
{
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < 3; c++)
            out_primaries[c][i] = SPACES[space].primaries[c][i];
        out_white[i] = SPACES[space].white[i];
    }
}

color_matrix color_matrix_multiply(const color_matrix *a, const color_matrix *b)
{
    color_matrix c;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            c.m[i][k] = a->m[i][0] * b->m[0][k] + a->m[i][1] * b->m[1][k] + a->m[i][2] * b->m[2][k];
    return c;
}

void color_matrix_apply(const color_matrix *a, const double in[3], double out[3])
{
    double x = in[0], y = in[1], z = in[2];
    for (int i = 0; i < 3; i++)
        out[i] = a->m[i][0] * x + a->m[i][1] * y + a->m[i][2] * z;
}

/* Inverts by cofactors. */
static color_matrix invert(const color_matrix *a)
{
    color_matrix c;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            int r0 = (k + 1) % 3, r1 = (k + 2) % 3, c0 = (i + 1) % 3, c1 = (i + 2) % 3;
            c.m[i][k] = a->m[r0][c0] * a->m[r1][c1] - a->m[r0][c1] * a->m[r1][c0];
        }
    double determinant = a->m[0][0] * c.m[0][0] + a->m[0][1] * c.m[1][0] + a->m[0][2] * c.m[2][0];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            c.m[i][k] /= determinant;
    return c;
}

bool color_matrix_invert(const color_matrix *a, color_matrix *out_inverse)
{
    *out_inverse = invert(a);
    for (int i = 0; i < 9; i++)
        if (!(fabs(out_inverse->m[i / 3][i % 3]) < 1e9)) /* NaN and infinity too */
            return false;
    return true;
}

/* The XYZ of a chromaticity at luminance 1. */
static void xyz_of(const double xy[2], double out_xyz[3])
{
    out_xyz[0] = xy[0] / xy[1];
    out_xyz[1] = 1.0;
    out_xyz[2] = (1.0 - xy[0] - xy[1]) / xy[1];
}

/* SMPTE RP 177: the primaries, each as bright as makes their sum white. */
static color_matrix xyz_from(const chromaticities *c)
{
    color_matrix primaries;
    double white[3], share[3];
    for (int k = 0; k < 3; k++) {
        primaries.m[0][k] = c->primaries[k][0];
        primaries.m[1][k] = c->primaries[k][1];
        primaries.m[2][k] = 1.0 - c->primaries[k][0] - c->primaries[k][1];
    }
    xyz_of(c->white, white);
    color_matrix inverse = invert(&primaries);
    color_matrix_apply(&inverse, white, share);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            primaries.m[i][k] *= share[k];
    return primaries;
}

color_matrix color_adaptation(const double from_xy[2], const double to_xy[2])
{
    static const color_matrix CONES = {
        {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
    double from[3], to[3];
    xyz_of(from_xy, from);
    xyz_of(to_xy, to);
    color_matrix_apply(&CONES, from, from);
    color_matrix_apply(&CONES, to, to);
    color_matrix scaled = CONES;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            scaled.m[i][k] *= to[i] / from[i];
    color_matrix back = invert(&CONES);
    return color_matrix_multiply(&back, &scaled);
}

color_matrix color_xyz_from_rec709(void) { return xyz_from(&SPACES[COLOR_SPACE_SRGB]); }

color_matrix color_rec709_from_xyz(void)
{
    color_matrix m = color_xyz_from_rec709();
    return invert(&m);
}

static color_matrix to_rec709(const chromaticities *c, bool is_light)
{
    color_matrix xyz = xyz_from(c), rec709 = color_rec709_from_xyz();
    if (!is_light) {
        color_matrix adapt = color_adaptation(c->white, COLOR_WHITE_XY);
        xyz = color_matrix_multiply(&adapt, &xyz);
    }
    return color_matrix_multiply(&rec709, &xyz);
}

color_matrix color_space_to_rec709(color_space from, bool is_light) { return to_rec709(&SPACES[from], is_light); }

bool color_chromaticities_to_rec709(const float chromaticities_xy[8], color_matrix *out_matrix)
{
    chromaticities c = {.name = "a picture's"};
    for (int i = 0; i < 8; i++)
        *(i < 6 ? &c.primaries[i / 2][i % 2] : &c.white[i % 2]) = (double)chromaticities_xy[i];
    color_matrix back;
    if (!(c.white[0] > 0.0 && c.white[1] > 0.0))
        return false;
    *out_matrix = to_rec709(&c, false);
    return color_matrix_invert(out_matrix, &back);
}
