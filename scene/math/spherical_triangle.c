/* spherical_triangle.c: see spherical_triangle.h. */
#include "math/spherical_triangle.h"

#include "math/angle.h"

static double dot(double3 a, double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static double3 scale(double3 a, double s) { return (double3){a.x * s, a.y * s, a.z * s}; }
static double3 subtract(double3 a, double3 b) { return (double3){a.x - b.x, a.y - b.y, a.z - b.z}; }

static double3 cross(double3 a, double3 b)
{
    return (double3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double3 relative(vec3 at, vec3 point)
{
    return (double3){(double)at.x - (double)point.x, (double)at.y - (double)point.y, (double)at.z - (double)point.z};
}

/* Twice the area of a triangle, along its normal. */
static double3 area_vector(double3 a, double3 b, double3 c) { return cross(subtract(b, a), subtract(c, a)); }

void spherical_triangle_see(vec3 point, vec3 a, vec3 b, vec3 c, spherical_triangle *out)
{
    const double3 ra = relative(a, point), rb = relative(b, point), rc = relative(c, point);
    const double volume = dot(ra, area_vector(ra, rb, rc)); /* small triangles far away keep their digits so */
    const double la = sqrt(dot(ra, ra)), lb = sqrt(dot(rb, rb)), lc = sqrt(dot(rc, rc));
    const double below = la * lb * lc + dot(ra, rb) * lc + dot(ra, rc) * lb + dot(rb, rc) * la;
    out->a = ra, out->b = rb, out->c = rc;
    out->turns = 2.0 * angle_turns(fabs(volume), below);
    out->is_from_back = !(volume < 0.0);
}

double spherical_triangle_area(const spherical_triangle *t)
{
    const double3 normal = area_vector(t->a, t->b, t->c);
    return 0.5 * sqrt(dot(normal, normal));
}

static double3 normalize(double3 v)
{
    const double square = dot(v, v);
    return scale(v, square > 0.0 ? 1.0 / sqrt(square) : 0.0);
}

/* Returns the unit vector at the given cosine from the unit vector `from`, towards `to`. */
static double3 turn_towards(double3 from, double3 to, double cosine)
{
    const double sine = sqrt(double_max(1.0 - cosine * cosine, 0.0));
    const double3 along = scale(from, cosine);
    const double3 across = scale(normalize(subtract(to, scale(from, dot(from, to)))), sine);
    return (double3){along.x + across.x, along.y + across.y, along.z + across.z};
}

static double clamp_cosine(double x) { return double_clamp(x, -1.0, 1.0); }

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
static double cut_cosine(double3 a, double3 b, double3 c, double turns, double share)
{
    const double3 ba = cross(b, a), bc = cross(b, c);
    double sin_part, cos_part;
    const double cos_side = dot(a, b), scale_of_both = sqrt(dot(ba, ba) * dot(bc, bc));
    const double cos_b = dot(ba, bc) / scale_of_both, sin_b = fabs(dot(c, ba)) / scale_of_both;
    sincos_turns_double(share * turns, &sin_part, &cos_part);
    const double s = sin_part * cos_b - cos_part * sin_b, t = cos_part * cos_b + sin_part * sin_b; /* of part - b */
    const double u = t - cos_b, v = s + sin_b * cos_side;
    const double above = (v * t - u * s) * cos_b - v, below = (v * s + u * t) * sin_b;
    return scale_of_both > 0.0 && below != 0.0 ? clamp_cosine(above / below) : 1.0;
}

vec2 spherical_triangle_sample(const spherical_triangle *t, vec2 u)
{
    const double3 a = normalize(t->a), b = normalize(t->b), c = normalize(t->c);
    /* a fan about the first corner: quadrilaterals mostly come as two fans that join, and numbers stay neighbours */
    const double3 cut = turn_towards(b, c, cut_cosine(a, b, c, t->turns, (double)u.x));
    const double3 direction = turn_towards(a, cut, 1.0 - (double)u.y * (1.0 - dot(cut, a)));

    /* the direction as a sum of the corners, by Cramer's rule */
    const double3 bc = cross(t->b, t->c), ca = cross(t->c, t->a), ab = cross(t->a, t->b);
    const double sign = dot(t->a, bc) < 0.0 ? -1.0 : 1.0;
    const double wa = double_max(sign * dot(direction, bc), 0.0), wb = double_max(sign * dot(direction, ca), 0.0);
    const double wc = double_max(sign * dot(direction, ab), 0.0), sum = wa + wb + wc;
    return sum > 0.0 ? (vec2){(float)(wb / sum), (float)(wc / sum)} : (vec2){0.0f, 0.0f};
}
