/* bsdf_lobe.c: see bsdf_lobe.h. Directions o (out) and i are in the shading frame, z up to the outside.
 * Threads: pure functions. */
#include "material/bsdf_lobe.h"

#include "material/fresnel.h"

vec3 bsdf_lobe_mirror(vec3 o, vec3 *out_normal)
{
    *out_normal = (vec3){0.0f, 0.0f, o.z >= 0.0f ? 1.0f : -1.0f};
    return reflect_about(o, *out_normal);
}

bool bsdf_lobe_sample_facet(ggx facets, vec3 o, vec2 u, vec3 *out_upper, vec3 *out_facet, float *out_side)
{
    if (o.z == 0.0f)
        return false;
    *out_side = o.z >= 0.0f ? 1.0f : -1.0f;
    *out_upper = vec3_scale(o, *out_side);
    *out_facet = ggx_sample_visible(facets, *out_upper, u);
    return true;
}

bool bsdf_lobe_reflection(ggx facets, vec3 o, vec3 i, float *out_cosine, float *out_value, float *out_pdf)
{
    if (!(o.z * i.z > 0.0f))
        return false;
    vec3 h = ggx_half_vector(o, i);
    *out_cosine = fabsf(vec3_dot(o, h));
    *out_value = ggx_reflection(facets, o, i, h);
    *out_pdf = ggx_reflection_pdf(facets, o, h);
    return true;
}

bool bsdf_lobe_sample_reflection(ggx facets, vec3 o, vec2 u, vec3 *out_local)
{
    vec3 upper, h;
    float side;
    if (!bsdf_lobe_sample_facet(facets, o, u, &upper, &h, &side))
        return false;
    vec3 i = reflect_about(upper, h);
    *out_local = vec3_scale(i, side);
    return i.z > 0.0f;
}

/* Walter 2007, eq. 20, 21; the density's factors follow Pharr et al., 9.7. */
bool bsdf_lobe_refraction(ggx facets, float ior, bsdf_transport transport, vec3 o, vec3 i, float *out_cosine,
                          float *out_value, float *out_pdf)
{
    float eta = o.z > 0.0f ? ior : 1.0f / ior;
    vec3 h = vec3_add(vec3_scale(i, eta), o);
    float square = vec3_length_squared(h);
    if (o.z == 0.0f || i.z == 0.0f || square == 0.0f)
        return false;
    h = vec3_scale(h, 1.0f / sqrtf(square));
    if (h.z < 0.0f)
        h = vec3_negate(h);
    float oh = vec3_dot(o, h), ih = vec3_dot(i, h);
    if (ih * i.z < 0.0f || oh * o.z < 0.0f)
        return false; /* a back-facing microfacet */
    vec3 upper = o.z > 0.0f ? o : vec3_negate(o);
    float sum = ih + oh / eta, jacobian = fabsf(ih) / (sum * sum);
    *out_cosine = fabsf(oh);
    *out_value = ggx_density(facets, h) * ggx_masking_shadowing(facets, o, i) * fabsf(ih * oh / (o.z * sum * sum));
    if (transport == BSDF_RADIANCE)
        *out_value /= eta * eta;
    *out_pdf = ggx_visible_density(facets, upper, h) * jacobian;
    return true;
}

/* --- all kinds --- */

const bsdf_lobe_type *const bsdf_lobe_types[LOBE_KIND_COUNT] = {
#define BSDF_LOBE_ROW(kind, type) [kind] = &(type),
    BSDF_LOBE_LIST(BSDF_LOBE_ROW)
#undef BSDF_LOBE_ROW
};
