/* light_bounds.c: what the light tree knows of a lamp: see light_tree.h. Threads: read-only. */
#include "light/light_tree.h"
#include "light/projection.h"
#include "scene.h"

static const float ALL_AROUND = -1.0f;
/* For rounding. */
static const float SLACK = 1e-3f;

static float mean(rgb c) { return (c.r + c.g + c.b) / 3.0f; }

/* The triangle's normals: as surface_hit has it, vertex normals say which way is outside, and may disagree. */
static void add_normal(const mesh *m, uint32_t triangle, vec3 n, vec3 axis, float *least_cos)
{
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    bool is_turned = false, is_kept = !m->normals;
    for (int k = 0; m->normals && k < 3; k++)
        *(vec3_dot(n, m->normals[index[k]]) < 0.0f ? &is_turned : &is_kept) = true;
    float cosine = vec3_dot(n, axis);
    if (is_kept)
        *least_cos = fminf(*least_cos, cosine);
    if (is_turned)
        *least_cos = fminf(*least_cos, -cosine);
}

static vec3 triangle_normal(const shape *s, uint32_t triangle, float *out_area)
{
    const mesh *m = &s->as.mesh;
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    vec3 p = m->positions[index[0]];
    vec3 n = vec3_cross(vec3_sub(m->positions[index[1]], p), vec3_sub(m->positions[index[2]], p));
    float length = vec3_length(n);
    *out_area = 0.5f * length;
    if (!(length > 0.0f && isfinite(length)))
        return (vec3){0.0f, 0.0f, 0.0f};
    return vec3_scale(n, (s->flip_normal ? -1.0f : 1.0f) / length);
}

/* The mean normal, and how far the others are off. */
static void find_mesh_normals(const shape *s, light_bounds *b)
{
    const mesh *m = &s->as.mesh;
    vec3 sum = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        float area;
        vec3 n = triangle_normal(s, i, &area);
        if (m->normals)
            n = vec3_face_forward(n, m->normals[m->indices[3 * (size_t)i]]);
        sum = vec3_add_scaled(sum, n, area / s->area);
    }
    float length = vec3_length(sum);
    if (!(length > SLACK))
        return;
    b->axis = vec3_scale(sum, 1.0f / length);
    float least = 1.0f;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        float area;
        vec3 n = triangle_normal(s, i, &area);
        if (area > 0.0f)
            add_normal(m, i, n, b->axis, &least);
        else
            least = ALL_AROUND; /* a sliver, whose normal single precision does not know */
    }
    b->cos_normals = fmaxf(least - SLACK, ALL_AROUND);
}

static void find_area_bounds(const scene *s, const light *l, light_bounds *b)
{
    const shape *lamp = &s->shapes[l->shape_index];
    vec3 low, high;
    shape_bounds(lamp, &low, &high);
    b->center = vec3_add_scaled(low, vec3_sub(high, low), 0.5f);
    b->radius = 0.5f * vec3_length(vec3_sub(high, low));
    b->cos_emission = 0.0f;
    b->least_cos = 0.0f;
    b->two_sided = l->two_sided;
    b->intensity = mean(l->power) * AG_INV_PI * (l->two_sided ? 0.5f : 1.0f);
    if (lamp->kind == SHAPE_DISK) {
        surface_sample at = shape_sample_area(lamp, (vec2){0.5f, 0.5f});
        b->axis = at.geometric_normal;
        b->cos_normals = 1.0f - SLACK;
    } else if (lamp->kind == SHAPE_MESH) {
        find_mesh_normals(lamp, b);
    }
    if (b->cos_normals < 0.0f)
        b->intensity *= 0.25f; /* Cauchy: a convex body shows a quarter of its surface, on average */
}

bool light_find_bounds(const scene *s, const light *l, light_bounds *out_bounds)
{
    light_bounds *b = out_bounds;
    *b = (light_bounds){.center = l->position,
                        .axis = l->direction,
                        .cos_normals = ALL_AROUND,
                        .cos_emission = ALL_AROUND,
                        .least_cos = 1.0f,
                        .intensity = mean(l->power) * 0.25f * AG_INV_PI};
    switch (l->kind) {
    case LIGHT_DISTANT:
    case LIGHT_INFINITE: return false;
    case LIGHT_POINT:
    case LIGHT_GONIOMETRIC: break;
    case LIGHT_SPOT:
        b->cos_normals = 1.0f;
        b->cos_emission = fmaxf(1.0f - l->falloff_end - SLACK, ALL_AROUND);
        b->intensity = mean(l->intensity);
        break;
    case LIGHT_PROJECTION: {
        float corner = projection_corner_cosine(l->projection);
        b->cos_normals = 1.0f;
        b->cos_emission = corner - SLACK;
        b->intensity = mean(l->power) / (2.0f * AG_PI * fmaxf(1.0f - corner, 1e-6f));
        break;
    }
    case LIGHT_AREA: find_area_bounds(s, l, b); break;
    }
    return true;
}
