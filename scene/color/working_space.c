/* working_space.c: see working_space.h. Threads: pure functions. */
#include "color/working_space.h"

static const double SAME = 1e-3; /* of a matrix: as far as configs round */

static bool is_near(const color_matrix *a, const color_matrix *b, double tolerance)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (!(fabs(a->m[i][k] - b->m[i][k]) <= tolerance))
                return false;
    return true;
}

working_space working_space_rec709(void)
{
    working_space s = {.is_rec709 = true, .keeps_gray = true};
    for (int i = 0; i < 3; i++)
        s.from_rec709.m[i][i] = 1.0;
    s.to_xyz = color_xyz_from_rec709();
    s.from_xyz = color_rec709_from_xyz();
    s.luminance = rgb_make(0.2126f, 0.7152f, 0.0722f);
    color_space_chromaticities(COLOR_SPACE_SRGB, s.primaries, s.white);
    return s;
}

/* The published ones of the space that the matrix leads to; else as D65 sees them. */
static void find_chromaticities(working_space *s)
{
    for (color_space known = COLOR_SPACE_SRGB; known < COLOR_SPACE_COUNT; known++) {
        color_matrix to_rec709 = color_space_to_rec709(known, false), from_rec709;
        if (color_matrix_invert(&to_rec709, &from_rec709) && is_near(&from_rec709, &s->from_rec709, SAME)) {
            color_space_chromaticities(known, s->primaries, s->white);
            return;
        }
    }
    double xyz[4][3] = {{0.0}};
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 3; i++) {
            xyz[c][i] = s->to_xyz.m[i][c];
            xyz[3][i] += s->to_xyz.m[i][c];
        }
    for (int c = 0; c < 4; c++) {
        double sum = xyz[c][0] + xyz[c][1] + xyz[c][2];
        double *xy = c < 3 ? s->primaries[c] : s->white;
        for (int i = 0; i < 2; i++)
            xy[i] = sum != 0.0 ? xyz[c][i] / sum : 0.0;
    }
}

bool working_space_make(const double from_rec709[9], working_space *out_space)
{
    working_space rec709 = working_space_rec709(), s = {0};
    for (int i = 0; i < 9; i++)
        s.from_rec709.m[i / 3][i % 3] = from_rec709[i];
    *out_space = rec709;
    if (is_near(&s.from_rec709, &rec709.from_rec709, SAME))
        return true;
    s.keeps_gray = true;
    for (int i = 0; i < 3; i++) {
        const double *row = s.from_rec709.m[i];
        s.keeps_gray = s.keeps_gray && fabs(row[0] + row[1] + row[2] - 1.0) <= SAME;
    }
    for (int i = 0; s.keeps_gray && i < 3; i++) {
        double *row = s.from_rec709.m[i], sum = row[0] + row[1] + row[2];
        for (int k = 0; k < 3; k++)
            row[k] /= sum;
    }
    color_matrix to_rec709;
    if (!color_matrix_invert(&s.from_rec709, &to_rec709))
        return false;
    s.to_xyz = color_matrix_multiply(&rec709.to_xyz, &to_rec709);
    s.from_xyz = color_matrix_multiply(&s.from_rec709, &rec709.from_xyz);
    float *const luminance[3] = {&s.luminance.r, &s.luminance.g, &s.luminance.b};
    for (int i = 0; i < 3; i++) /* by the same rounded weights: what a lamp's power makes of it is the same */
        *luminance[i] =
            (float)((double)rec709.luminance.r * to_rec709.m[0][i] + (double)rec709.luminance.g * to_rec709.m[1][i] +
                    (double)rec709.luminance.b * to_rec709.m[2][i]);
    find_chromaticities(&s);
    *out_space = s;
    return true;
}

static rgb convert(const working_space *space, rgb rec709, double bound)
{
    if (space->keeps_gray && rec709.r == rec709.g && rec709.g == rec709.b)
        return rec709;
    double c[3] = {(double)rec709.r, (double)rec709.g, (double)rec709.b};
    color_matrix_apply(&space->from_rec709, c, c);
    for (int i = 0; i < 3; i++)
        c[i] = double_clamp(c[i], 0.0, bound);
    return rgb_make((float)c[0], (float)c[1], (float)c[2]);
}

rgb working_space_light(const working_space *space, rgb rec709)
{
    return !space || space->is_rec709 ? rec709 : convert(space, rec709, INFINITY);
}

rgb working_space_reflectance(const working_space *space, rgb rec709)
{
    return !space || space->is_rec709 ? rec709 : convert(space, rec709, rgb_max(rec709) <= 1.0f ? 1.0 : INFINITY);
}

/* Gulbrandsen's reflectance and tint of the edge. */
typedef struct artist_metal {
    double reflectance, edge;
} artist_metal;

static artist_metal artist_from_index(double n, double k)
{
    double below = (n - 1.0) * (n - 1.0) + k * k, above = (n + 1.0) * (n + 1.0) + k * k;
    double r = double_clamp(below / above, 0.0, 0.9999), root = sqrt(r);
    double largest = (1.0 + root) / (1.0 - root), least = (1.0 - r) / (1.0 + r);
    return (artist_metal){r, largest - least > 1e-9 ? (largest - n) / (largest - least) : 0.0};
}

static void index_from_artist(artist_metal a, double *n, double *k)
{
    double r = double_clamp(a.reflectance, 0.0, 0.9999), root = sqrt(r), edge = double_clamp(a.edge, 0.0, 1.0);
    *n = edge * (1.0 - r) / (1.0 + r) + (1.0 - edge) * (1.0 + root) / (1.0 - root);
    *k = sqrt(double_max((r * (*n + 1.0) * (*n + 1.0) - (*n - 1.0) * (*n - 1.0)) / (1.0 - r), 0.0));
}

void working_space_metal(const working_space *space, rgb *in_out_eta, rgb *in_out_k)
{
    if (!space || space->is_rec709)
        return;
    const double eta[3] = {(double)in_out_eta->r, (double)in_out_eta->g, (double)in_out_eta->b};
    const double k[3] = {(double)in_out_k->r, (double)in_out_k->g, (double)in_out_k->b};
    double reflectance[3], edge[3], new_eta[3], new_k[3];
    const bool absorbs = k[0] > 0.0 || k[1] > 0.0 || k[2] > 0.0;
    for (int i = 0; i < 3; i++) {
        artist_metal a = artist_from_index(eta[i], k[i]);
        reflectance[i] = a.reflectance;
        edge[i] = a.edge;
    }
    color_matrix_apply(&space->from_rec709, reflectance, reflectance);
    color_matrix_apply(&space->from_rec709, edge, edge);
    for (int i = 0; i < 3; i++)
        index_from_artist((artist_metal){reflectance[i], edge[i]}, &new_eta[i], &new_k[i]);
    *in_out_eta = rgb_make((float)new_eta[0], (float)new_eta[1], (float)new_eta[2]);
    *in_out_k = absorbs ? rgb_make((float)new_k[0], (float)new_k[1], (float)new_k[2]) : rgb_gray(0.0f);
}

void working_space_chromaticities(const working_space *space, float out_chromaticities[8])
{
    working_space rec709 = working_space_rec709();
    const working_space *s = space ? space : &rec709;
    for (int i = 0; i < 8; i++)
        out_chromaticities[i] = (float)(i < 6 ? s->primaries[i / 2][i % 2] : s->white[i % 2]);
}
