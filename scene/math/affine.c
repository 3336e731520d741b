/* affine.c: see affine.h.
 * Threads: pure functions. */
#include "math/affine.h"

/* Range of determinants that single precision can invert. */
static const double DETERMINANT_MIN = 1e-35, DETERMINANT_MAX = 1e35;

double affine_determinant(const affine *a)
{
    double c[3][3];
    affine_cofactors(a, c);
    return (double)a->m[0][0] * c[0][0] + (double)a->m[0][1] * c[0][1] + (double)a->m[0][2] * c[0][2];
}

void affine_cofactors(const affine *a, double out_cofactors[3][3])
{
    for (int i = 0; i < 3; i++) {
        const float *p = a->m[(i + 1) % 3], *q = a->m[(i + 2) % 3];
        for (int j = 0; j < 3; j++) {
            int k = (j + 1) % 3, l = (j + 2) % 3;
            out_cofactors[i][j] = (double)p[k] * (double)q[l] - (double)p[l] * (double)q[k];
        }
    }
}

bool affine_can_be_undone(const affine *a)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            if (!isfinite(a->m[i][j]))
                return false;
    double determinant = fabs(affine_determinant(a));
    return determinant >= DETERMINANT_MIN && determinant <= DETERMINANT_MAX;
}

bool affine_from_transform(const transform *t, affine *out_affine)
{
    const double(*m)[4] = t->m;
    if (m[3][0] != 0.0 || m[3][1] != 0.0 || m[3][2] != 0.0 || m[3][3] == 0.0)
        return false;
    affine a;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            a.m[i][j] = (float)(m[i][j] / m[3][3]);
    if (!affine_can_be_undone(&a))
        return false;
    *out_affine = a;
    return true;
}

affine affine_lerp(const affine *a, const affine *b, float t)
{
    affine r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            r.m[i][j] = (1.0f - t) * a->m[i][j] + t * b->m[i][j];
    return r;
}

vec3 affine_point(const affine *a, vec3 p)
{
    double r[3];
    for (int i = 0; i < 3; i++)
        r[i] = (double)a->m[i][0] * (double)p.x + (double)a->m[i][1] * (double)p.y + (double)a->m[i][2] * (double)p.z +
               (double)a->m[i][3];
    return (vec3){(float)r[0], (float)r[1], (float)r[2]};
}

vec3 affine_vector(const affine *a, vec3 v)
{
    double r[3];
    for (int i = 0; i < 3; i++)
        r[i] = (double)a->m[i][0] * (double)v.x + (double)a->m[i][1] * (double)v.y + (double)a->m[i][2] * (double)v.z;
    return (vec3){(float)r[0], (float)r[1], (float)r[2]};
}
