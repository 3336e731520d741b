/* coat.c: see coat.h. */
#include "material/coat.h"

#include "material/fresnel.h"
#include "material/microfacet.h"
#include "texture/texture.h"

/* The cosine at which the trapped lobe takes the conductor's reflectance: about its mean over the hemisphere. */
static const float MEAN_COSINE = 0.6f;
static const float GOLDEN_SECTION = 0.61803399f; /* its multiples lie evenly in [0, 1) */

vec3 coat_refract(const material *m, vec3 v)
{
    float sin2 = fmaxf(0.0f, 1.0f - v.z * v.z) / (m->ior * m->ior);
    return (vec3){v.x / m->ior, v.y / m->ior, copysignf(sqrtf(fmaxf(0.0f, 1.0f - sin2)), v.z)};
}

float coat_transmittance(const material *m, float cos_theta)
{
    float through = 1.0f - fresnel_dielectric(fabsf(cos_theta), m->ior);
    if (m->coat_thickness > 0.0f && through > 0.0f)
        through *= attenuation(m->coat_thickness / fabsf(coat_refract(m, (vec3){0.0f, 0.0f, cos_theta}).z));
    return through;
}

/* r + r (r back) + r (r back)^2 + …: light that goes to and fro between base and coat. */
static float diffuse_sum(const material *m, float r)
{
    float again = r * m->coat_return, lost = 1.0f;
    for (int i = 0; i < m->coat_bounces; i++)
        lost *= again;
    return r * (m->coat_bounces > 0 ? 1.0f - lost : 1.0f) / (1.0f - again);
}

/* What gets out of a coat is spread over a wider solid angle: the squared index. */
rgb coat_diffuse_albedo(const material *m)
{
    rgb r = m->reflectance;
    return rgb_scale((rgb){diffuse_sum(m, r.r), diffuse_sum(m, r.g), diffuse_sum(m, r.b)}, 1.0f / (m->ior * m->ior));
}

/* A geometric series. Of the coat's two reflectances the lesser keeps light in, so that both ways are the same and no
 * more leaves than got in. */
rgb coat_series(const material *m, rgb metal, float cos_o, float cos_i)
{
    float through = coat_transmittance(m, cos_o) * coat_transmittance(m, cos_i);
    if (!(through > 0.0f))
        return rgb_gray(0.0f); /* total reflection, by a coat of a lesser index than what is around */
    float back = fminf(fresnel_dielectric(fabsf(cos_o), m->ior), fresnel_dielectric(fabsf(cos_i), m->ior));
    return (rgb){through * metal.r / (1.0f - metal.r * back), through * metal.g / (1.0f - metal.g * back),
                 through * metal.b / (1.0f - metal.b * back)};
}

float coat_reflectance(const material *m, float cos_facet, float cos_o, float cos_i)
{
    float facet = fresnel_dielectric(cos_facet, m->ior);
    if (m->ior >= 1.0f)
        return facet;
    /* facets of a lesser index reflect totally where the surface as a whole, by which the base is reckoned, does not */
    return fminf(facet, fminf(fresnel_dielectric(fabsf(cos_o), m->ior), fresnel_dielectric(fabsf(cos_i), m->ior)));
}

/* --- the trapped lobe --- */

/* Inside, light is told by its cosine to the normal: STEPS of them. */
enum { STEPS = 12, FACETS = 512 };

/* Where light goes that meets a white conductor at a cosine inside: out, back to it at each cosine by a coat that
 * reflects in part, and by one that reflects totally. What is missing is masked, or absorbed by the coat. */
typedef struct conductor_ways {
    double out, back[STEPS], total[STEPS];
} conductor_ways;

static conductor_ways ways_from(const material *m, float cosine)
{
    conductor_ways w = {0};
    const vec3 o = {sqrtf(fmaxf(0.0f, 1.0f - cosine * cosine)), 0.0f, cosine};
    const float alpha = sqrtf(m->base_alpha_u * m->base_alpha_v);
    const ggx facets = {alpha, alpha};
    for (int k = 0; k < FACETS; k++) {
        vec2 u = {((float)k + 0.5f) / FACETS, (float)k * GOLDEN_SECTION - floorf((float)k * GOLDEN_SECTION)};
        vec3 i = reflect_about(o, ggx_sample_visible(facets, o, u));
        if (i.z <= 1e-3f)
            continue;
        double kept = (double)(ggx_masking_shadowing(facets, o, i) / ggx_masking(facets, o)) / FACETS;
        float once = m->coat_thickness > 0.0f ? attenuation(m->coat_thickness / i.z) : 1.0f;
        float reflected = fresnel_dielectric(i.z, 1.0f / m->ior);
        int step = (int)fminf(i.z * (float)STEPS, (float)STEPS - 1.0f);
        w.out += kept * (double)(once * (1.0f - reflected));
        (reflected < 1.0f ? w.back : w.total)[step] += kept * (double)(once * once * reflected);
    }
    return w;
}

static double sum_of(const double v[STEPS])
{
    double sum = 0.0;
    for (int k = 0; k < STEPS; k++)
        sum += v[k];
    return sum;
}

/* g: of light at a cosine outside, what gets in and is caught by total reflection once a white conductor has had it. */
static float caught(const material *m, float cos_theta)
{
    float place = fminf(fabsf(cos_theta), 1.0f) * (float)(COAT_TRAP_PLACES - 1);
    int step = place < (float)(COAT_TRAP_PLACES - 2) ? (int)place : COAT_TRAP_PLACES - 2;
    float u = place - (float)step;
    const float *at = &m->coat_trap.caught[step];
    return coat_transmittance(m, cos_theta) * ((1.0f - u) * at[0] + u * at[1]);
}

static void prepare_trap(material *m)
{
    conductor_ways inside[STEPS];
    double first[STEPS] = {0.0}, escaped_first = 0.0, escaped = 0.0;
    for (int k = 0; k < STEPS; k++)
        inside[k] = ways_from(m, ((float)k + 0.5f) / STEPS);
    for (int k = 0; k < STEPS; k++) {
        float cosine = ((float)k + 0.5f) / STEPS;
        conductor_ways w = ways_from(m, coat_refract(m, (vec3){0.0f, 0.0f, cosine}).z);
        for (int j = 0; j < STEPS; j++)
            first[j] += w.total[j] * (double)(cosine * coat_transmittance(m, cosine));
    }
    double all = sum_of(first);
    if (!(all > 1e-3))
        return;
    /* follow 1 of what was caught until next to nothing of it is left */
    for (int j = 0; j < STEPS; j++)
        first[j] /= all;
    for (int bounce = 0; bounce < 64; bounce++) {
        double next[STEPS] = {0.0};
        double out = 0.0;
        for (int k = 0; k < STEPS; k++) {
            out += first[k] * inside[k].out;
            for (int j = 0; j < STEPS; j++)
                next[j] += first[k] * (inside[k].back[j] + inside[k].total[j]);
        }
        escaped_first = bounce == 0 ? out : escaped_first;
        escaped += out;
        for (int j = 0; j < STEPS; j++)
            first[j] = next[j];
    }
    if (!(escaped > 0.0))
        return;
    for (int k = 0; k < COAT_TRAP_PLACES; k++) {
        float cosine = (float)k / (float)(COAT_TRAP_PLACES - 1);
        conductor_ways w = ways_from(m, coat_refract(m, (vec3){0.0f, 0.0f, cosine}).z);
        m->coat_trap.caught[k] = (float)sum_of(w.total);
    }
    double mean = 0.0;
    for (int k = 0; k < 64; k++) {
        float cosine = ((float)k + 0.5f) / 64.0f;
        mean += 2.0 * (double)(cosine * caught(m, cosine)) / 64.0;
    }
    m->coat_trap.mean = (float)mean;
    m->coat_trap.escape = (float)escaped_first;
    m->coat_trap.retain = (float)(1.0 - escaped_first / escaped);
}

void coat_prepare(material *m)
{
    m->coat_trap = (coat_trap){{0.0f}, 0.0f, 0.0f, 0.0f};
    if (m->kind == MATERIAL_COATED_DIFFUSE)
        m->coat_return = fresnel_dielectric_diffuse(1.0f / m->ior, m->coat_thickness);
    /* where the roughness varies it is not known here, and what is trapped stays lost */
    bool varies = m->base_alpha_u_texture != SCENE_NO_TEXTURE || m->base_alpha_v_texture != SCENE_NO_TEXTURE;
    if (m->kind == MATERIAL_COATED_CONDUCTOR && m->ior > 1.0f && m->coat_bounces != 1 && !varies &&
        !material_is_smooth(m->base_alpha_u, m->base_alpha_v))
        prepare_trap(m);
}

bool coat_has_trapped(const material *m) { return m->coat_trap.mean > 0.0f; }

/* The conductor takes its share twice, and at each bounce more. */
static float trapped_sum(const material *m, float metal)
{
    float again = metal * m->coat_trap.retain, lost = again;
    for (int i = 2; i < m->coat_bounces; i++)
        lost *= again;
    return metal * metal * m->coat_trap.escape * (m->coat_bounces > 0 ? 1.0f - lost : 1.0f) / (1.0f - again);
}

static rgb trapped_color(const material *m)
{
    rgb metal = fresnel_conductor(MEAN_COSINE, m->eta, m->k);
    return (rgb){trapped_sum(m, metal.r), trapped_sum(m, metal.g), trapped_sum(m, metal.b)};
}

rgb coat_trapped(const material *m, float cos_o, float cos_i)
{
    return rgb_scale(trapped_color(m), caught(m, cos_o) * caught(m, cos_i) / m->coat_trap.mean);
}

rgb coat_trapped_albedo(const material *m, float cos_o) { return rgb_scale(trapped_color(m), caught(m, cos_o)); }
