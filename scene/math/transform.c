/* transform.c: see transform.h. Matrices are inverted by Gauss-Jordan elimination with full row pivoting.
 * Threads: pure functions. */
#include "math/transform.h"

#include <string.h>

static const double DEGREES = 3.14159265358979323846 / 180.0;

transform transform_identity(void)
{
    transform t;
    memset(&t, 0, sizeof t);
    for (int i = 0; i < 4; i++)
        t.m[i][i] = t.inverse[i][i] = 1.0;
    return t;
}

static bool invert_matrix(const double m[4][4], double out_inverse[4][4])
{
    double a[4][8];
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 8; j++)
            a[i][j] = j < 4 ? m[i][j] : (j - 4 == i ? 1.0 : 0.0);
    for (int c = 0; c < 4; c++) {
        int pivot = c;
        for (int r = c + 1; r < 4; r++)
            if (fabs(a[r][c]) > fabs(a[pivot][c]))
                pivot = r;
        double p = a[pivot][c];
        if (!isfinite(p) || p == 0.0)
            return false;
        for (int j = 0; j < 8; j++) {
            double v = a[pivot][j];
            a[pivot][j] = a[c][j];
            a[c][j] = v / p;
        }
        for (int r = 0; r < 4; r++) {
            double f = a[r][c];
            if (r == c || f == 0.0)
                continue;
            for (int j = 0; j < 8; j++)
                a[r][j] -= f * a[c][j];
        }
    }
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            if (!isfinite(a[i][j + 4]))
                return false;
            out_inverse[i][j] = a[i][j + 4];
        }
    return true;
}

bool transform_from_matrix(const double m[4][4], transform *out_transform)
{
    transform t;
    if (!invert_matrix(m, t.inverse))
        return false;
    memcpy(t.m, m, sizeof t.m);
    *out_transform = t;
    return true;
}

static void multiply_matrices(const double a[4][4], const double b[4][4], double out_product[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            out_product[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] + a[i][3] * b[3][j];
}

transform transform_multiply(const transform *a, const transform *b)
{
    transform t;
    multiply_matrices(a->m, b->m, t.m);
    multiply_matrices(b->inverse, a->inverse, t.inverse);
    return t;
}

transform transform_invert(const transform *a)
{
    transform t;
    memcpy(t.m, a->inverse, sizeof t.m);
    memcpy(t.inverse, a->m, sizeof t.inverse);
    return t;
}

transform transform_translate(double x, double y, double z)
{
    transform t = transform_identity();
    const double d[3] = {x, y, z};
    for (int i = 0; i < 3; i++) {
        t.m[i][3] = d[i];
        t.inverse[i][3] = -d[i];
    }
    return t;
}

bool transform_scale(double x, double y, double z, transform *out_transform)
{
    double m[4][4] = {{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}, {0, 0, 0, 1}};
    return transform_from_matrix((const double(*)[4])m, out_transform);
}

bool transform_rotate(double degrees, double x, double y, double z, transform *out_transform)
{
    double length = sqrt(x * x + y * y + z * z);
    if (!isfinite(length) || length == 0.0 || !isfinite(degrees))
        return false;
    const double a[3] = {x / length, y / length, z / length};
    double s = sin(degrees * DEGREES), c = cos(degrees * DEGREES);
    transform t = transform_identity();
    const double cross[3][3] = {{0, -a[2], a[1]}, {a[2], 0, -a[0]}, {-a[1], a[0], 0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            t.m[i][j] = (i == j ? c : 0.0) + (1.0 - c) * a[i] * a[j] + s * cross[i][j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            t.inverse[j][i] = t.m[i][j];
    *out_transform = t;
    return true;
}

bool transform_look_at(const double eye[3], const double look[3], const double up[3], transform *out_transform)
{
    double z[3], x[3], y[3], length = 0.0;
    for (int i = 0; i < 3; i++)
        z[i] = look[i] - eye[i];
    length = sqrt(z[0] * z[0] + z[1] * z[1] + z[2] * z[2]);
    if (!isfinite(length) || length == 0.0)
        return false;
    for (int i = 0; i < 3; i++)
        z[i] /= length;
    /* left-handed: x = up x z */
    x[0] = up[1] * z[2] - up[2] * z[1];
    x[1] = up[2] * z[0] - up[0] * z[2];
    x[2] = up[0] * z[1] - up[1] * z[0];
    double up_length = sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]);
    length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    if (!isfinite(length) || length <= 1e-12 * up_length)
        return false;
    for (int i = 0; i < 3; i++)
        x[i] /= length;
    y[0] = z[1] * x[2] - z[2] * x[1];
    y[1] = z[2] * x[0] - z[0] * x[2];
    y[2] = z[0] * x[1] - z[1] * x[0];
    double world_from_camera[4][4] = {
        {x[0], y[0], z[0], eye[0]}, {x[1], y[1], z[1], eye[1]}, {x[2], y[2], z[2], eye[2]}, {0, 0, 0, 1}};
    transform t;
    if (!transform_from_matrix((const double(*)[4])world_from_camera, &t))
        return false;
    *out_transform = transform_invert(&t);
    return true;
}

vec3 transform_point(const transform *t, vec3 p)
{
    double v[4];
    for (int i = 0; i < 4; i++)
        v[i] = t->m[i][0] * (double)p.x + t->m[i][1] * (double)p.y + t->m[i][2] * (double)p.z + t->m[i][3];
    if (v[3] != 1.0)
        for (int i = 0; i < 3; i++)
            v[i] /= v[3];
    return vec3_make((float)v[0], (float)v[1], (float)v[2]);
}

static vec3 multiply_vector(const double m[4][4], bool transposed, vec3 v)
{
    double r[3];
    for (int i = 0; i < 3; i++)
        r[i] = transposed ? m[0][i] * (double)v.x + m[1][i] * (double)v.y + m[2][i] * (double)v.z
                          : m[i][0] * (double)v.x + m[i][1] * (double)v.y + m[i][2] * (double)v.z;
    return vec3_make((float)r[0], (float)r[1], (float)r[2]);
}

vec3 transform_vector(const transform *t, vec3 v) { return multiply_vector(t->m, false, v); }
vec3 transform_normal(const transform *t, vec3 n) { return multiply_vector(t->inverse, true, n); }

bool transform_swaps_handedness(const transform *t)
{
    const double(*m)[4] = t->m;
    double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return determinant < 0.0;
}

double transform_uniform_scale(const transform *t)
{
    double dots[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            dots[i][j] = t->m[0][i] * t->m[0][j] + t->m[1][i] * t->m[1][j] + t->m[2][i] * t->m[2][j];
    double square = dots[0][0], tolerance = 1e-6 * square;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (fabs(dots[i][j] - (i == j ? square : 0.0)) > tolerance)
                return 0.0;
    return sqrt(square);
}
