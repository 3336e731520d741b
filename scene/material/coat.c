/* coat.c: see coat.h. */
#include "material/coat.h"

#include "material/coat_lobe.h"
#include "material/coat_table.h"
#include "material/fresnel.h"
#include "material/material.h"
#include "math/attenuation.h"
#include "texture/texture.h"

/* The cosine at which light that has lost its direction meets the metal: about its mean over the hemisphere. */
static const float MEAN_COSINE = 0.6f;

coat_point coat_point_of(const material *m)
{
    return (coat_point){.interface = {m->alpha_u, m->alpha_v},
                        .base = {m->base_alpha_u, m->base_alpha_v},
                        .ior = m->ior,
                        .thickness = m->coat_thickness,
                        .table = m->table,
                        .eta = m->eta,
                        .k = m->k,
                        .reflectance = m->reflectance,
                        .bounces = m->coat_bounces,
                        .has_metal = m->kind == MATERIAL_COATED_CONDUCTOR,
                        .scatters = !rgb_is_black(m->coat_albedo)};
}

bool coat_is_smooth(const coat_point *m)
{
    return material_is_smooth(m->interface.alpha_u, m->interface.alpha_v) || m->ior == 1.0f;
}

bool coat_needs_table(const material *m)
{
    if (m->kind == MATERIAL_COATED_DIFFUSE)
        return true;
    if (m->kind != MATERIAL_COATED_CONDUCTOR)
        return false;
    coat_point constant = coat_point_of(m);
    bool varies = m->alpha_u_texture != SCENE_NO_TEXTURE || m->alpha_v_texture != SCENE_NO_TEXTURE ||
                  m->base_alpha_u_texture != SCENE_NO_TEXTURE || m->base_alpha_v_texture != SCENE_NO_TEXTURE;
    return varies || constant.scatters || !coat_is_smooth(&constant) ||
           !material_is_smooth(m->base_alpha_u, m->base_alpha_v);
}

vec3 coat_refract(const coat_point *m, vec3 v)
{
    float sin2 = float_max(1.0f - v.z * v.z, 0.0f) / (m->ior * m->ior);
    return (vec3){v.x / m->ior, v.y / m->ior, copysignf(sqrtf(float_max(1.0f - sin2, 0.0f)), v.z)};
}

float coat_crossing(const coat_point *m, float cos_theta)
{
    float through = 1.0f - fresnel_dielectric(fabsf(cos_theta), m->ior);
    if (m->thickness > 0.0f && through > 0.0f)
        through *= attenuation(m->thickness / fabsf(coat_refract(m, (vec3){0.0f, 0.0f, cos_theta}).z));
    return through;
}

static rgb sum_of_series(rgb first, rgb again)
{
    return (rgb){first.r / (1.0f - again.r), first.g / (1.0f - again.g), first.b / (1.0f - again.b)};
}

/* --- a diffuse base --- */

float coat_entry(const coat_point *m, float cos_theta)
{
    if (coat_is_smooth(m) && !m->scatters)
        return coat_crossing(m, cos_theta);
    coat_blend blend;
    coat_table_find(m->table, m->interface, m->base, &blend);
    return coat_blend_at(&blend, COAT_ENTRY, fabsf(cos_theta));
}

/* Light that leaves a coat is spread over a wider solid angle: the squared index. */
rgb coat_diffuse_albedo(const coat_point *m)
{
    coat_blend blend;
    coat_table_find(m->table, m->interface, m->base, &blend);
    rgb back = rgb_gray(0.0f), tint = rgb_gray(0.0f), r = m->reflectance;
    for (int k = 0; k < blend.count; k++) {
        back = rgb_add(back, rgb_scale(blend.cells[k]->back, blend.weights[k]));
        tint = rgb_add(tint, rgb_scale(blend.cells[k]->entry_tint, blend.weights[k]));
    }
    /* r + r (r back) + r (r back)^2 + ...: light that goes to and fro between base and coat */
    rgb again = rgb_mul(r, back), lost = rgb_gray(m->bounces > 0 ? 1.0f : 0.0f);
    for (int i = 0; i < m->bounces; i++)
        lost = rgb_mul(lost, again);
    rgb sum = sum_of_series(rgb_mul(r, rgb_sub(rgb_gray(1.0f), lost)), again);
    return rgb_scale(rgb_mul(sum, tint), 1.0f / (m->ior * m->ior));
}

/* --- a metal --- */

rgb coat_series(const coat_point *m, rgb metal, float cos_theta)
{
    float crossing = coat_crossing(m, cos_theta), back = fresnel_dielectric(fabsf(cos_theta), m->ior);
    if (!(crossing > 0.0f))
        return rgb_gray(0.0f); /* total reflection, by a coat of a lower index than the outside */
    if (m->thickness > 0.0f)
        back *= attenuation(2.0f * m->thickness / fabsf(coat_refract(m, (vec3){0.0f, 0.0f, cos_theta}).z));
    return sum_of_series(rgb_scale(metal, crossing * crossing), rgb_scale(metal, back));
}

/* Each order of reflection by its share. */
static rgb by_orders(const rgb shares[COAT_ORDERS], rgb metal)
{
    rgb sum = rgb_gray(0.0f);
    for (int n = COAT_ORDERS - 1; n >= 0; n--)
        sum = rgb_add(rgb_mul(sum, metal), shares[n]);
    return sum;
}

static rgb lobe_color(const coat_blend *blend, rgb metal)
{
    rgb shares[COAT_ORDERS];
    for (int n = 0; n < COAT_ORDERS; n++) {
        float share = 0.0f;
        for (int k = 0; k < blend->count; k++)
            share += blend->weights[k] * blend->cells[k]->lobe_share[n];
        shares[n] = rgb_gray(share);
    }
    return by_orders(shares, metal);
}

static ggx outer_facets(const coat_point *m, const coat_blend *blend)
{
    float breadth = 0.0f;
    for (int k = 0; k < blend->count; k++)
        breadth += blend->weights[k] * blend->cells[k]->breadth;
    return coat_lobe_facets(m, breadth);
}

void coat_metal_lobe(const coat_point *m, vec3 o, vec3 i, rgb *out_value, float *out_pdf)
{
    *out_value = rgb_gray(0.0f);
    *out_pdf = 0.0f;
    vec3 oc = coat_refract(m, o), ic = coat_refract(m, i);
    if (o.z * i.z <= 0.0f)
        return;
    coat_blend blend;
    coat_table_find(m->table, m->interface, m->base, &blend);
    float scale = coat_blend_at(&blend, COAT_SCALE, fabsf(o.z)) * coat_blend_at(&blend, COAT_SCALE, fabsf(i.z));
    float value;
    if (coat_is_smooth(m)) {
        if (oc.z == 0.0f || ic.z == 0.0f)
            return; /* beyond total reflection, by a coat of a lesser index */
        vec3 h = ggx_half_vector(oc, ic);
        ggx facets = m->base;
        /* f |cos i|: reflection's value has |cos ic| in it; the squared index is the change of solid angles */
        float cosines = fabsf(i.z / ic.z) / (m->ior * m->ior);
        scale *= coat_crossing(m, o.z) * coat_crossing(m, i.z);
        value = ggx_reflection(facets, oc, ic, h) * cosines;
        *out_pdf = ggx_reflection_pdf(facets, oc, h) * cosines;
    } else {
        vec3 h = ggx_half_vector(o, i);
        ggx facets = outer_facets(m, &blend);
        value = ggx_reflection(facets, o, i, h);
        *out_pdf = ggx_reflection_pdf(facets, o, h);
    }
    rgb metal = fresnel_conductor(fabsf(vec3_dot(oc, ggx_half_vector(oc, ic))), m->eta, m->k);
    *out_value = rgb_scale(lobe_color(&blend, metal), scale * value);
}

bool coat_sample_metal_lobe(const coat_point *m, vec3 o, vec2 u, vec3 *out_i)
{
    if (!coat_is_smooth(m)) {
        coat_blend blend;
        coat_table_find(m->table, m->interface, m->base, &blend);
        *out_i = reflect_about(o, ggx_sample_visible(outer_facets(m, &blend), o, u));
        return out_i->z > 0.0f;
    }
    vec3 oc = coat_refract(m, o);
    vec3 ic = reflect_about(oc, ggx_sample_visible(m->base, oc, u));
    float sin2 = (1.0f - ic.z * ic.z) * m->ior * m->ior;
    if (ic.z <= 0.0f || sin2 >= 1.0f)
        return false;
    *out_i = (vec3){ic.x * m->ior, ic.y * m->ior, sqrtf(1.0f - sin2)};
    return true;
}

rgb coat_metal_lobe_albedo(const coat_point *m, float cos_o)
{
    rgb metal = fresnel_conductor(MEAN_COSINE, m->eta, m->k);
    if (!m->table)
        return coat_series(m, metal, cos_o);
    coat_blend blend;
    coat_table_find(m->table, m->interface, m->base, &blend);
    return rgb_scale(lobe_color(&blend, metal), coat_blend_at(&blend, COAT_ALBEDO, fabsf(cos_o)));
}

/* --- the scattered lobe --- */

/* The metal's reflectance at the mean cosine; 0 over a diffuse base. */
static rgb scattering_metal(const coat_point *m)
{
    return m->has_metal ? fresnel_conductor(MEAN_COSINE, m->eta, m->k) : rgb_gray(0.0f);
}

rgb coat_scattered_albedo(const coat_point *m, float cos_o)
{
    rgb sum = rgb_gray(0.0f);
    if (!m->table)
        return sum;
    coat_blend blend;
    coat_table_find(m->table, m->interface, m->base, &blend);
    rgb metal = scattering_metal(m);
    for (int k = 0; k < blend.count; k++)
        if (blend.cells[k]->scattered_mean > 0.0f) {
            coat_blend one = {{blend.cells[k]}, {1.0f}, 1};
            float share = blend.weights[k] * coat_blend_at(&one, COAT_SCATTERED, fabsf(cos_o));
            sum = rgb_add(sum, rgb_scale(by_orders(blend.cells[k]->scattered_share, metal), share));
        }
    return sum;
}

/* Poisson's kernel: 1 in the mean over all turns, whatever `eccentricity`, which is the mean cosine. */
static float turned(float eccentricity, vec3 o, vec3 i)
{
    float length = sqrtf((o.x * o.x + o.y * o.y) * (i.x * i.x + i.y * i.y));
    float cosine = length > 0.0f ? -(o.x * i.x + o.y * i.y) / length : 0.0f, e = eccentricity;
    return (1.0f - e * e) / (1.0f + e * e - 2.0f * e * cosine);
}

rgb coat_scattered(const coat_point *m, vec3 o, vec3 i)
{
    rgb sum = rgb_gray(0.0f);
    if (!m->table)
        return sum;
    coat_blend blend;
    coat_table_find(m->table, m->interface, m->base, &blend);
    rgb metal = scattering_metal(m);
    for (int k = 0; k < blend.count; k++)
        if (blend.cells[k]->scattered_mean > 0.0f) {
            coat_blend one = {{blend.cells[k]}, {1.0f}, 1};
            float product =
                coat_blend_at(&one, COAT_SCATTERED, fabsf(o.z)) * coat_blend_at(&one, COAT_SCATTERED, fabsf(i.z));
            product *= turned(
                coat_blend_at(&one, COAT_FORWARD, fabsf(o.z)) * coat_blend_at(&one, COAT_FORWARD, fabsf(i.z)), o, i);
            product *= blend.weights[k] / blend.cells[k]->scattered_mean;
            sum = rgb_add(sum, rgb_scale(by_orders(blend.cells[k]->scattered_share, metal), product));
        }
    return sum;
}
