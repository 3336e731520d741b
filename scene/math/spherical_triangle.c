/* spherical_triangle.c: see spherical_triangle.h. */
#include "math/spherical_triangle.h"

#include "math/angle.h"

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

static void relative(vec3 at, vec3 point, double out[3])
{
    out[0] = (double)at.x - (double)point.x;
    out[1] = (double)at.y - (double)point.y;
    out[2] = (double)at.z - (double)point.z;
}

/* Twice the triangle's area, along its normal. */
static void find_normal(const spherical_triangle *t, double out[3])
{
    double ab[3], ac[3];
    subtract(t->b, t->a, ab);
    subtract(t->c, t->a, ac);
    cross(ab, ac, out);
}

spherical_triangle spherical_triangle_seen(vec3 point, vec3 a, vec3 b, vec3 c)
{
    spherical_triangle t;
    relative(a, point, t.a);
    relative(b, point, t.b);
    relative(c, point, t.c);
    double normal[3];
    find_normal(&t, normal);
    const double volume = dot(t.a, normal); /* by the normal: small triangles far away keep their digits */
    const double la = sqrt(dot(t.a, t.a)), lb = sqrt(dot(t.b, t.b)), lc = sqrt(dot(t.c, t.c));
    const double below = la * lb * lc + dot(t.a, t.b) * lc + dot(t.a, t.c) * lb + dot(t.b, t.c) * la;
    t.turns = 2.0 * angle_turns(fabs(volume), below);
    t.is_from_back = !(volume < 0.0);
    return t;
}

double spherical_triangle_area(const spherical_triangle *t)
{
    double normal[3];
    find_normal(t, normal);
    return 0.5 * sqrt(dot(normal, normal));
}

static void normalize(double v[3])
{
    const double square = dot(v, v), inverse = square > 0.0 ? 1.0 / sqrt(square) : 0.0;
    for (int i = 0; i < 3; i++)
        v[i] *= inverse;
}

/* Writes the unit vector at the given cosine from the unit vector `from`, towards `to`. */
static void turn_towards(const double from[3], const double to[3], double cosine, double out[3])
{
    double across[3];
    const double along = dot(from, to), sine = sqrt(fmax(0.0, 1.0 - cosine * cosine));
    for (int i = 0; i < 3; i++)
        across[i] = to[i] - along * from[i];
    normalize(across);
    for (int i = 0; i < 3; i++)
        out[i] = cosine * from[i] + sine * across[i];
}

static double clamp_cosine(double x) { return fmin(fmax(x, -1.0), 1.0); }

/* Sine and cosine of 2 pi u, u in [0, 1], by Taylor series about the nearest quarter turn: right to 1e-15, since
 * cut_cosine takes differences of nearly equal ones; sincos_turns is right to floats alone, in half the steps. */
static void sincos_turns_double(double u, double *out_sin, double *out_cos)
{
    const double quarter = floor(u * 4.0 + 0.5), x = (u - quarter * 0.25) * 6.283185307179586477, x2 = x * x;
    double s = 1.0, c = 1.0;
    for (int k = 16; k >= 2; k -= 2) {
        s = 1.0 - s * x2 * (1.0 / (k * (k + 1)));
        c = 1.0 - c * x2 * (1.0 / ((k - 1) * k));
    }
    s *= x;
    switch ((int)quarter & 3) {
    case 0: *out_sin = s, *out_cos = c; break;
    case 1: *out_sin = c, *out_cos = -s; break;
    case 2: *out_sin = -s, *out_cos = -c; break;
    default: *out_sin = -c, *out_cos = s; break;
    }
}

/* Returns the cosine between b and the point of the side from b to c where a great circle through a cuts off that share
 * of the triangle's solid angle, on the side of b. All corners are unit vectors. */
static double cut_cosine(const double a[3], const double b[3], const double c[3], double turns, double share)
{
    double ba[3], bc[3], sin_part, cos_part;
    cross(b, a, ba);
    cross(b, c, bc);
    const double cos_side = dot(a, b), scale = sqrt(dot(ba, ba) * dot(bc, bc));
    const double cos_b = dot(ba, bc) / scale, sin_b = fabs(dot(c, ba)) / scale;
    sincos_turns_double(share * turns, &sin_part, &cos_part);
    const double s = sin_part * cos_b - cos_part * sin_b, t = cos_part * cos_b + sin_part * sin_b; /* of part - b */
    const double u = t - cos_b, v = s + sin_b * cos_side;
    const double above = (v * t - u * s) * cos_b - v, below = (v * s + u * t) * sin_b;
    return scale > 0.0 && below != 0.0 ? clamp_cosine(above / below) : 1.0;
}

vec2 spherical_triangle_sample(const spherical_triangle *t, vec2 u)
{
    double a[3], b[3], c[3], cut[3], direction[3];
    for (int i = 0; i < 3; i++)
        a[i] = t->a[i], b[i] = t->b[i], c[i] = t->c[i];
    normalize(a);
    normalize(b);
    normalize(c);
    /* a fan about the first corner: quadrilaterals mostly come as two fans that join, and numbers stay neighbours */
    turn_towards(b, c, cut_cosine(a, b, c, t->turns, (double)u.x), cut);
    turn_towards(a, cut, 1.0 - (double)u.y * (1.0 - dot(cut, a)), direction);

    /* the direction as a sum of the corners, by Cramer's rule */
    double bc[3], ca[3], ab[3];
    cross(t->b, t->c, bc);
    cross(t->c, t->a, ca);
    cross(t->a, t->b, ab);
    double sign = dot(t->a, bc) < 0.0 ? -1.0 : 1.0;
    double wa = fmax(sign * dot(direction, bc), 0.0), wb = fmax(sign * dot(direction, ca), 0.0);
    double wc = fmax(sign * dot(direction, ab), 0.0), sum = wa + wb + wc;
    return sum > 0.0 ? (vec2){(float)(wb / sum), (float)(wc / sum)} : (vec2){0.0f, 0.0f};
}
