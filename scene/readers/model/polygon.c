/* polygon.c: see polygon.h. Threads: pure functions. */
#include "model/polygon.h"

enum { MAX_CONCAVE = 4096 }; /* ears are looked for in quadratic time */

void polygon_area_vector(const vec3 *p, size_t count, double out[3])
{
    out[0] = out[1] = out[2] = 0.0;
    for (size_t i = 0; i < count; i++) {
        vec3 a = p[i], b = p[(i + 1) % count], o = p[0]; /* from the first corner: far from the origin it stays exact */
        double u[3] = {(double)a.x - o.x, (double)a.y - o.y, (double)a.z - o.z};
        double v[3] = {(double)b.x - o.x, (double)b.y - o.y, (double)b.z - o.z};
        for (int k = 0; k < 3; k++)
            out[k] += u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
}

static double component(vec3 v, int axis) { return axis == 0 ? (double)v.x : axis == 1 ? (double)v.y : (double)v.z; }

/* The polygon seen along one axis, counter-clockwise. */
typedef struct outline {
    const vec3 *corners;
    int x_axis, y_axis;
} outline;

/* Returns twice the area of a triangle; positive where it runs counter-clockwise. */
static double turn(const outline *o, uint32_t a, uint32_t b, uint32_t c)
{
    const vec3 *p = o->corners;
    double ax = component(p[a], o->x_axis), ay = component(p[a], o->y_axis);
    double ux = component(p[b], o->x_axis) - ax, uy = component(p[b], o->y_axis) - ay;
    double vx = component(p[c], o->x_axis) - ax, vy = component(p[c], o->y_axis) - ay;
    return ux * vy - uy * vx;
}

static bool is_convex(const outline *o, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (turn(o, (uint32_t)i, (uint32_t)((i + 1) % count), (uint32_t)((i + 2) % count)) < 0.0)
            return false;
    return true;
}

/* Returns whether the corner in the middle can be cut off: none of the others lies in the triangle. */
static bool is_ear(const outline *o, const uint32_t *rest, size_t count, size_t middle)
{
    uint32_t a = rest[(middle + count - 1) % count], b = rest[middle], c = rest[(middle + 1) % count];
    if (turn(o, a, b, c) <= 0.0)
        return false;
    for (size_t i = 0; i < count; i++) {
        uint32_t p = rest[i];
        if (p != a && p != b && p != c && turn(o, a, b, p) >= 0.0 && turn(o, b, c, p) >= 0.0 && turn(o, c, a, p) >= 0.0)
            return false;
    }
    return true;
}

static void put(uint32_t **out, uint32_t a, uint32_t b, uint32_t c)
{
    *(*out)++ = a;
    *(*out)++ = b;
    *(*out)++ = c;
}

static void cut_fan(const uint32_t *rest, size_t count, uint32_t **out)
{
    for (size_t i = 1; i + 1 < count; i++)
        put(out, rest[0], rest[i], rest[i + 1]);
}

void polygon_triangulate(const vec3 *corners, size_t count, uint32_t *rest, uint32_t *out)
{
    double n[3];
    for (size_t i = 0; i < count; i++)
        rest[i] = (uint32_t)i;
    polygon_area_vector(corners, count, n);
    int axis = fabs(n[0]) > fabs(n[1]) ? (fabs(n[0]) > fabs(n[2]) ? 0 : 2) : (fabs(n[1]) > fabs(n[2]) ? 1 : 2);
    const outline o = {corners, (axis + (n[axis] >= 0.0 ? 1 : 2)) % 3, (axis + (n[axis] >= 0.0 ? 2 : 1)) % 3};
    if (count > 3 && count <= MAX_CONCAVE && !is_convex(&o, count)) {
        size_t tried = 0, at = 0;
        while (count > 3 && tried < count) {
            at %= count;
            if (!is_ear(&o, rest, count, at)) {
                at++;
                tried++;
                continue;
            }
            put(&out, rest[(at + count - 1) % count], rest[at], rest[(at + 1) % count]);
            for (size_t i = at; i + 1 < count; i++)
                rest[i] = rest[i + 1];
            count--;
            tried = 0;
        }
    }
    cut_fan(rest, count, &out);
}
