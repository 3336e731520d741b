/* motion.c: see motion.h. Polar decompositions by Newton's iteration, scaled (Higham, "Computing the Polar
 * Decomposition with Applications", 1986). Threads: pure functions. */
#include "math/motion.h"

#include "math/angle.h"
#include "math/sampling.h"

#include <string.h>

/* Straight steps may stray so far, as a part of the linear map's size and of the way travelled; and as far as floats at
 * that point lie apart, which is some thousandth of that tolerance. */
static const double STEP_TOLERANCE = 1e-4, WAY_OF_ROUNDING = 1e-3;

/* Inverse transpose; false where there is none. */
static bool invert_transpose(const double a[3][3], double out[3][3])
{
    double determinant = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int p = (i + 1) % 3, q = (i + 2) % 3, k = (j + 1) % 3, l = (j + 2) % 3;
            out[i][j] = a[p][k] * a[q][l] - a[p][l] * a[q][k];
        }
    for (int j = 0; j < 3; j++)
        determinant += a[0][j] * out[0][j];
    if (determinant == 0.0 || !isfinite(determinant))
        return false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] /= determinant;
    return true;
}

static double norm(const double a[3][3])
{
    double sum = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            sum += a[i][j] * a[i][j];
    return sqrt(sum);
}

/* linear = rotation stretch, the stretch symmetric; where linear is a mirror, its sign goes into the stretch. */
static bool decompose(const double linear[3][3], double rotation[3][3], double stretch[3][3])
{
    double change = 1.0, inverse[3][3];
    memcpy(rotation, linear, 9 * sizeof(double));
    for (int iteration = 0; iteration < 100 && change > 1e-13; iteration++) {
        if (!invert_transpose((const double(*)[3])rotation, inverse))
            return false;
        double size = norm((const double(*)[3])rotation), scale = sqrt(norm((const double(*)[3])inverse) / size),
               sum = 0.0;
        if (!isfinite(scale))
            return false;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                double next = 0.5 * (scale * rotation[i][j] + inverse[i][j] / scale);
                sum += (next - rotation[i][j]) * (next - rotation[i][j]);
                rotation[i][j] = next;
            }
        change = sqrt(sum) / size;
    }
    double determinant = 0.0;
    for (int j = 0; j < 3; j++) {
        int k = (j + 1) % 3, l = (j + 2) % 3;
        determinant += rotation[0][j] * (rotation[1][k] * rotation[2][l] - rotation[1][l] * rotation[2][k]);
    }
    for (int i = 0; i < 3 && determinant < 0.0; i++)
        for (int j = 0; j < 3; j++)
            rotation[i][j] = -rotation[i][j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            stretch[i][j] =
                rotation[0][i] * linear[0][j] + rotation[1][i] * linear[1][j] + rotation[2][i] * linear[2][j];
    return true;
}

/* Computes the largest of the four components first, from which the others follow without loss. */
static void quaternion_of(const double r[3][3], double q[4])
{
    double squares[4] = {1.0 + r[0][0] + r[1][1] + r[2][2], 1.0 + r[0][0] - r[1][1] - r[2][2],
                         1.0 - r[0][0] + r[1][1] - r[2][2], 1.0 - r[0][0] - r[1][1] + r[2][2]};
    int largest = 0;
    for (int i = 1; i < 4; i++)
        if (squares[i] > squares[largest])
            largest = i;
    double x = r[2][1] - r[1][2], y = r[0][2] - r[2][0], z = r[1][0] - r[0][1];
    double xy = r[0][1] + r[1][0], xz = r[0][2] + r[2][0], yz = r[1][2] + r[2][1];
    const double rows[4][4] = {
        {squares[0], x, y, z}, {x, squares[1], xy, xz}, {y, xy, squares[2], yz}, {z, xz, yz, squares[3]}};
    double length = 0.0;
    for (int i = 0; i < 4; i++)
        length += rows[largest][i] * rows[largest][i];
    for (int i = 0; i < 4; i++)
        q[i] = rows[largest][i] / sqrt(length);
}

bool motion_make(const transform *start, const transform *end, double at_opening, double at_closing, motion *out_motion)
{
    const transform *const ends[2] = {start, end};
    motion m = {.at_opening = at_opening, .at_closing = at_closing};
    double sign[2], dot = 0.0;
    for (int e = 0; e < 2; e++) {
        affine rounded;
        double linear[3][3], rotation[3][3];
        if (!affine_from_transform(ends[e], &rounded))
            return false;
        sign[e] = affine_determinant(&rounded);
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++)
                linear[i][j] = ends[e]->m[i][j] / ends[e]->m[3][3];
            m.translation[e][i] = ends[e]->m[i][3] / ends[e]->m[3][3];
        }
        if (!decompose((const double(*)[3])linear, rotation, m.stretch[e]))
            return false;
        quaternion_of((const double(*)[3])rotation, m.rotation[e]);
    }
    if ((sign[0] < 0.0) != (sign[1] < 0.0))
        return false;
    for (int i = 0; i < 4; i++)
        dot += m.rotation[0][i] * m.rotation[1][i];
    for (int i = 0; i < 4 && dot < 0.0; i++) /* the shorter way round */
        m.rotation[1][i] = -m.rotation[1][i];
    *out_motion = m;
    return true;
}

/* The point at a share t of the great circle from a to b. */
static void slerp(const double a[4], const double b[4], double t, double q[4])
{
    double cosine = 0.0, sine = 0.0, across[4], length = 0.0;
    for (int i = 0; i < 4; i++)
        cosine += a[i] * b[i];
    for (int i = 0; i < 4; i++) {
        across[i] = b[i] - a[i] * cosine;
        sine += across[i] * across[i];
    }
    sine = sqrt(sine);
    if (sine < 1e-4) { /* so near that the chord is the arc */
        for (int i = 0; i < 4; i++)
            q[i] = a[i] + t * (b[i] - a[i]);
    } else {
        float s, c;
        sincos_turns((float)(t * angle_turns(sine, cosine)), &s, &c);
        for (int i = 0; i < 4; i++)
            q[i] = a[i] * (double)c + across[i] / sine * (double)s;
    }
    for (int i = 0; i < 4; i++)
        length += q[i] * q[i];
    for (int i = 0; i < 4; i++)
        q[i] /= sqrt(length);
}

void motion_at(const motion *m, double time, double out_matrix[3][4])
{
    double t = double_clamp(m->at_opening + time * (m->at_closing - m->at_opening), 0.0, 1.0), q[4];
    slerp(m->rotation[0], m->rotation[1], t, q);
    double w = q[0], x = q[1], y = q[2], z = q[3];
    const double rotation[3][3] = {{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
                                   {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
                                   {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double sum = 0.0;
            for (int k = 0; k < 3; k++)
                sum += rotation[i][k] * ((1.0 - t) * m->stretch[0][k][j] + t * m->stretch[1][k][j]);
            out_matrix[i][j] = sum;
        }
        out_matrix[i][3] = (1.0 - t) * m->translation[0][i] + t * m->translation[1][i];
    }
}

void motion_path_at(const motion_path *path, double time, double out_matrix[3][4])
{
    const motion *first = &path->segments[0];
    const double last = (double)(path->segment_count - 1);
    const double passed = first->at_opening + time * (first->at_closing - first->at_opening); /* segments */
    motion_at(first + (size_t)double_clamp(passed, 0.0, last), time, out_matrix);
}

/* --- steps --- */

static void product_at(const motion_path *outer, const motion_path *inner, double time, double out[3][4])
{
    double a[3][4], b[3][4];
    motion_path_at(outer, time, inner ? a : out);
    if (!inner)
        return;
    motion_path_at(inner, time, b);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] + (j == 3 ? a[i][3] : 0.0);
}

/* How far the middle and the quarters of a straight step are off the motion: linear part, translation. */
static bool is_straight(const motion_path *outer, const motion_path *inner, double begin, double end, double way)
{
    double first[3][4], last[3][4], at[3][4];
    product_at(outer, inner, begin, first);
    product_at(outer, inner, end, last);
    for (int k = 1; k < 4; k++) {
        double t = 0.25 * k, off = 0.0, size = 0.0, off_way = 0.0;
        product_at(outer, inner, begin + t * (end - begin), at);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 4; j++) {
                double d = (1.0 - t) * first[i][j] + t * last[i][j] - at[i][j];
                *(j < 3 ? &off : &off_way) += d * d;
                size += j < 3 ? at[i][j] * at[i][j] : 0.0;
            }
        if (off > STEP_TOLERANCE * STEP_TOLERANCE * size || off_way > STEP_TOLERANCE * STEP_TOLERANCE * way * way)
            return false;
    }
    return true;
}

static affine rounded_at(const motion_path *outer, const motion_path *inner, double time)
{
    double m[3][4];
    affine a;
    product_at(outer, inner, time, m);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            a.m[i][j] = (float)m[i][j];
    return a;
}

/* How many segments have a border wherever one of both paths has one, if that is a number that steps can have; else as
 * many as the longer path has. */
static uint32_t segments_of(const motion_path *outer, const motion_path *inner)
{
    const uint32_t a = outer->segment_count, b = inner ? inner->segment_count : 1;
    const uint32_t larger = a > b ? a : b, smaller = a > b ? b : a;
    for (uint32_t n = larger; n < MOTION_STEPS_MAX; n += larger)
        if (n % smaller == 0)
            return n;
    return larger;
}

/* Whether the map is the same, to the bit, at so many times and at the opening, which goes to *out_first. */
static bool is_at_rest(const motion_path *outer, const motion_path *inner, uint32_t count, affine *out_first)
{
    *out_first = rounded_at(outer, inner, 0.0);
    for (uint32_t i = 1; i <= count; i++) {
        const affine at = rounded_at(outer, inner, (double)i / count);
        if (memcmp(&at, out_first, sizeof at) != 0)
            return false;
    }
    return true;
}

uint32_t motion_steps(const motion_path *outer, const motion_path *inner, affine out_steps[MOTION_STEPS_MAX])
{
    const uint32_t least = segments_of(outer, inner); /* steps at every bend of the way */
    double way = 0.0, before[3][4], at[3][4] = {{0.0}};
    if (is_at_rest(outer, inner, 3 * least, &out_steps[0]))
        return 1;
    product_at(outer, inner, 0.0, before);
    for (uint32_t k = 1; k <= 16 * least; k++) {
        double square = 0.0;
        product_at(outer, inner, k / (16.0 * least), at);
        for (int i = 0; i < 3; i++)
            square += (at[i][3] - before[i][3]) * (at[i][3] - before[i][3]);
        way += sqrt(square);
        memcpy(before, at, sizeof before);
    }
    way += WAY_OF_ROUNDING * sqrt(at[0][3] * at[0][3] + at[1][3] * at[1][3] + at[2][3] * at[2][3]);
    uint32_t segments = least;
    for (; 2 * segments < MOTION_STEPS_MAX; segments *= 2) {
        bool suffices = true;
        for (uint32_t i = 0; suffices && i < segments; i++)
            suffices = is_straight(outer, inner, (double)i / segments, (double)(i + 1) / segments, way);
        if (suffices)
            break;
    }
    for (uint32_t i = 0; i <= segments; i++)
        out_steps[i] = rounded_at(outer, inner, (double)i / segments);
    return segments + 1;
}
