/* shading_frame.c: see shading_frame.h. Threads: pure functions. */
#include "material/shading_frame.h"

#include "math/sampling.h"
#include "scene.h"
#include "shape/tangents.h"

/* A tilted normal stays this far above the surface's own horizon, as a cosine: light that is on its side of the surface
 * is then, all but at the very edge, on that of the normal too. */
static const float COSINE_MIN = 0.02f;

bool shading_frame_is_tilted(const material *m)
{
    return m->normal_map_texture != SCENE_NO_TEXTURE || m->displacement_texture != SCENE_NO_TEXTURE;
}

/* x along a tangent as far as it goes across z; any where it does not. */
static frame frame_along(vec3 z, vec3 tangent)
{
    vec3 x = vec3_add_scaled(tangent, z, -vec3_dot(tangent, z));
    float square = vec3_length_squared(x);
    if (!(square > 0.0f && isfinite(square)))
        return frame_from_z(z);
    x = vec3_scale(x, 1.0f / sqrtf(square));
    return (frame){x, vec3_cross(z, x), z};
}

/* 2 c - 1 along dp/du, across it towards dp/dv, and along the normal. pbrt goes always counterclockwise from dp/du;
 * here mirrored uvs mirror the relief with them, as glTF's tangents do. */
static vec3 map_normal(const scene *s, const surface_hit *hit, const material *m)
{
    vec3 dpdu, dpdv;
    rgb c = texture_evaluate_rgb(&s->textures, m->normal_map_texture, hit);
    vec3 v = {m->normal_scale * (2.0f * c.r - 1.0f), m->normal_scale * (2.0f * c.g - 1.0f), 2.0f * c.b - 1.0f};
    surface_tangents(s, hit, &dpdu, &dpdv);
    frame f = frame_along(hit->shading_normal, dpdu);
    f.y = vec3_face_forward(f.y, dpdv);
    return frame_to_world(&f, v);
}

/* The displacement where the surface goes on by du, dv of its parameters. */
static float displacement_beside(const scene *s, const surface_hit *hit, const surface_differentials *d, uint32_t index,
                                 float du, float dv)
{
    surface_hit beside = *hit;
    beside.uv.x += du;
    beside.uv.y += dv;
    beside.position = vec3_add_scaled(vec3_add_scaled(hit->position, d->dpdu, du), d->dpdv, dv);
    return texture_evaluate_float(&s->textures, index, &beside);
}

/* The normal of the surface p + d n. Its tangents are dp + dd n + d dn; slopes are those between points before and
 * behind, half a pixel of the finest picture away: nearer, the slope would jump from pixel to pixel. */
static vec3 bump_normal(const scene *s, const surface_hit *hit, const material *m)
{
    surface_differentials d = surface_differentials_at(s, hit);
    vec3 n = hit->shading_normal;
    uint32_t index = m->displacement_texture;
    float step = s->textures.items[index].step, height = texture_evaluate_float(&s->textures, index, hit), rise_u,
          rise_v;
    rise_u = displacement_beside(s, hit, &d, index, step, 0.0f) - displacement_beside(s, hit, &d, index, -step, 0.0f);
    rise_v = displacement_beside(s, hit, &d, index, 0.0f, step) - displacement_beside(s, hit, &d, index, 0.0f, -step);
    /* the shading normal's own tangents, as pbrt has it: a smooth mesh stays smooth where nothing is raised */
    vec3 dpdu = vec3_add_scaled(d.dpdu, n, -vec3_dot(d.dpdu, n)),
         dpdv = vec3_add_scaled(d.dpdv, n, -vec3_dot(d.dpdv, n));
    dpdu = vec3_add_scaled(vec3_add_scaled(dpdu, n, rise_u / (2.0f * step)), d.dndu, height);
    dpdv = vec3_add_scaled(vec3_add_scaled(dpdv, n, rise_v / (2.0f * step)), d.dndv, height);
    return vec3_face_forward(vec3_cross(dpdu, dpdv), n);
}

/* Unit, above the horizon of the geometric normal; the shading normal where v gives no direction. */
static vec3 make_usable(vec3 v, const surface_hit *hit)
{
    float square = vec3_length_squared(v);
    if (!(square > 0.0f && isfinite(square)))
        return hit->shading_normal;
    v = vec3_scale(v, 1.0f / sqrtf(square));
    float cosine = vec3_dot(v, hit->geometric_normal);
    if (cosine >= COSINE_MIN)
        return v;
    v = vec3_add_scaled(v, hit->geometric_normal, COSINE_MIN - cosine);
    square = vec3_length_squared(v); /* COSINE_MIN squared, or less, where it stood upside down */
    return square > 4.0f * COSINE_MIN * COSINE_MIN ? vec3_scale(v, 1.0f / sqrtf(square)) : hit->shading_normal;
}

/* The frame whose x is the grain's, turned from that of dp/du. Mirrored uvs mirror the turn, as glTF's tangents do. A
 * tangent that the mesh has been given is turned counterclockwise about the normal, whatever uvs and mirroring
 * instances do: so Blender's Cycles turns its tangents. */
static frame turn(const scene *s, const surface_hit *hit, const material *m, frame f)
{
    vec3 dpdu, dpdv;
    float sine, cosine;
    sincos_turns(m->grain_turn, &sine, &cosine);
    if (m->grain_texture != SCENE_NO_TEXTURE) {
        const rgb c = texture_evaluate_rgb(&s->textures, m->grain_texture, hit);
        const float x = 2.0f * c.r - 1.0f, y = 2.0f * c.g - 1.0f, length = sqrtf(x * x + y * y);
        if (length > 0.0f && isfinite(length)) {
            const float turned = (cosine * x - sine * y) / length;
            sine = (sine * x + cosine * y) / length;
            cosine = turned;
        }
    }
    if (!surface_has_own_tangents(s, hit) && surface_uv_axes(s, hit, &dpdu, &dpdv) &&
        vec3_dot(vec3_cross(dpdu, dpdv), f.z) < 0.0f)
        sine = -sine;
    return frame_along(f.z, vec3_add(vec3_scale(f.x, cosine), vec3_scale(f.y, sine)));
}

frame shading_frame_at(const scene *s, const surface_hit *hit, const material *m, bool has_grain)
{
    vec3 z = hit->shading_normal, dpdu, dpdv;
    if (shading_frame_is_tilted(m)) {
        z = m->normal_map_texture != SCENE_NO_TEXTURE ? map_normal(s, hit, m) : bump_normal(s, hit, m);
        z = make_usable(z, hit);
    }
    if (!has_grain)
        return frame_from_z(z);
    surface_tangents(s, hit, &dpdu, &dpdv);
    const frame along = frame_along(z, dpdu);
    return m->grain_turn == 0.0f && m->grain_texture == SCENE_NO_TEXTURE ? along : turn(s, hit, m, along);
}
