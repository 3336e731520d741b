/* bsdf_init.c: which lobes a material has at a point, and how often each is picked. One row for each kind of
 * material. Flow: material_point -> [here] -> bsdf. Threads: pure functions. */
#include "material/bsdf.h"
#include "material/bsdf_lobe.h"
#include "material/fresnel.h"
#include "material/pane.h"
#include "material/shading_frame.h"
#include "material/slab.h"
#include "scene.h"

/* No lobe of two is picked more rarely. */
static const float PROBABILITY_MIN = 0.1f;

static void add_lobe(bsdf *b, bsdf_lobe_kind kind, bsdf_lobes group, bool is_delta, float share)
{
    b->lobes[b->lobe_count++] = (bsdf_lobe){(uint8_t)kind, (uint8_t)group, is_delta, share};
}

static bool are_smooth(ggx facets) { return material_is_smooth(facets.alpha_u, facets.alpha_v); }

/* --- the kinds of materials --- */

static void add_diffuse(bsdf *b) { add_lobe(b, LOBE_DIFFUSE, BSDF_GATHERED, false, 1.0f); }

static void add_diffuse_transmission(bsdf *b)
{
    add_lobe(b, LOBE_DIFFUSE, BSDF_GATHERED, false, rgb_max(b->material.diffuse.reflectance));
    add_lobe(b, LOBE_DIFFUSE_THROUGH, BSDF_GATHERED, false, rgb_max(b->material.diffuse.transmittance));
}

static void add_conductor(bsdf *b)
{
    add_lobe(b, LOBE_CONDUCTOR, BSDF_TRACED, are_smooth(b->material.metal.facets), 1.0f);
}

static void add_dielectric(bsdf *b)
{
    const glass_point *m = &b->material.glass;
    /* where the index does not change nothing is bent, however rough: half vectors do not exist there */
    add_lobe(b, LOBE_DIELECTRIC, BSDF_TRACED, are_smooth(m->facets) || m->ior == 1.0f, 1.0f);
}

static void add_thin_dielectric(bsdf *b) { add_lobe(b, LOBE_THIN_DIELECTRIC, BSDF_TRACED, true, 1.0f); }

/* The coat's own lobes, after that of its base. */
static void add_coat(bsdf *b, float reflected, float cosine)
{
    const coat_point *m = &b->material.coat;
    rgb scattered = coat_scattered_albedo(m, cosine);
    if (m->ior != 1.0f)
        add_lobe(b, LOBE_COAT, BSDF_TRACED, are_smooth(m->interface), reflected);
    if (!rgb_is_black(scattered))
        add_lobe(b, LOBE_COAT_SCATTERED, BSDF_TRACED, false, rgb_max(scattered));
}

static void add_coated_diffuse(bsdf *b)
{
    const coat_point *m = &b->material.coat;
    float cosine = vec3_dot(b->out, b->shading.z), reflected = fresnel_dielectric(fabsf(cosine), m->ior);
    add_lobe(b, LOBE_COATED_BASE, BSDF_GATHERED, false, (1.0f - reflected) * rgb_max(m->reflectance));
    add_coat(b, reflected, cosine);
}

static void add_coated_conductor(bsdf *b)
{
    const coat_point *m = &b->material.coat;
    float cosine = vec3_dot(b->out, b->shading.z);
    add_lobe(b, LOBE_CONDUCTOR_UNDER_COAT, BSDF_TRACED, coat_is_smooth(m) && are_smooth(m->base),
             rgb_max(coat_metal_lobe_albedo(m, cosine)));
    add_coat(b, fresnel_dielectric(fabsf(cosine), m->ior), cosine);
}

static void add_hair(bsdf *b) { add_lobe(b, LOBE_HAIR, BSDF_TRACED, false, 1.0f); }

static void add_principled(bsdf *b)
{
    const principled_point *m = &b->material.principled;
    float cosine = vec3_dot(b->out, b->shading.z);
    principled_shares shares = principled_shares_at(m, fminf(fabsf(cosine), 1.0f));
    bool has_interface = principled_has_interface(m);
    if (!rgb_is_black(principled_base_albedo(m)) || !has_interface)
        add_lobe(b, LOBE_PRINCIPLED_BASE, BSDF_GATHERED, false, shares.base);
    if (has_interface)
        add_lobe(b, LOBE_PRINCIPLED, BSDF_TRACED, material_is_smooth(m->alpha, m->alpha), shares.interface);
    float coat_alpha = m->clearcoat_roughness * m->clearcoat_roughness;
    if (m->clearcoat > 0.0f && !(cosine < 0.0f && principled_is_solid(m)))
        add_lobe(b, LOBE_CLEARCOAT, BSDF_TRACED, material_is_smooth(coat_alpha, coat_alpha), shares.coat);
}

/* add: its lobes, a diffuse one that reflects before all others. base: that one's kind. NULL: no lobe at all. */
typedef struct material_lobes {
    void (*add)(bsdf *b);
    bsdf_lobe_kind base; /* LOBE_DIFFUSE also where there is none: nothing keeps light from it */
} material_lobes;

static const material_lobes LOBES[] = {
    [MATERIAL_DIFFUSE] = {add_diffuse, LOBE_DIFFUSE},
    [MATERIAL_DIFFUSE_TRANSMISSION] = {add_diffuse_transmission, LOBE_DIFFUSE},
    [MATERIAL_CONDUCTOR] = {add_conductor, LOBE_DIFFUSE},
    [MATERIAL_DIELECTRIC] = {add_dielectric, LOBE_DIFFUSE},
    [MATERIAL_THIN_DIELECTRIC] = {add_thin_dielectric, LOBE_DIFFUSE},
    [MATERIAL_INTERFACE] = {NULL, LOBE_DIFFUSE}, /* rays do not stop there */
    [MATERIAL_COATED_DIFFUSE] = {add_coated_diffuse, LOBE_COATED_BASE},
    [MATERIAL_COATED_CONDUCTOR] = {add_coated_conductor, LOBE_DIFFUSE},
    [MATERIAL_HAIR] = {add_hair, LOBE_DIFFUSE},
    [MATERIAL_PRINCIPLED] = {add_principled, LOBE_PRINCIPLED_BASE},
    [MATERIAL_MIX] = {NULL, LOBE_DIFFUSE}, /* one of two others has been picked before */
};
_Static_assert(sizeof LOBES / sizeof *LOBES == MATERIAL_KIND_COUNT, "a row for each kind of material");

const bsdf_lobe_type *bsdf_base_of_kind(material_kind kind) { return bsdf_lobe_types[LOBES[kind].base]; }

/* --- probabilities --- */

/* Gives each of three lobes that carries anything the least share, at the cost of the others. */
static void normalize_many(bsdf *b)
{
    float sum = 0.0f, free_sum = 0.0f, left = 1.0f;
    for (int k = 0; k < b->lobe_count; k++)
        sum += b->lobes[k].probability;
    for (int k = 0; k < b->lobe_count; k++) {
        float *p = &b->lobes[k].probability;
        *p = sum > 0.0f ? *p / sum : 1.0f / (float)b->lobe_count;
        if (*p > 0.0f && *p <= PROBABILITY_MIN) {
            *p = PROBABILITY_MIN;
            left -= PROBABILITY_MIN;
        } else {
            free_sum += *p;
        }
    }
    for (int k = 0; k < b->lobe_count; k++)
        if (b->lobes[k].probability > PROBABILITY_MIN)
            b->lobes[k].probability *= left / free_sum;
}

/* Shares become probabilities; a lobe that carries anything is not neglected. */
static void normalize_probabilities(bsdf *b)
{
    if (b->lobe_count > 2) {
        normalize_many(b);
        return;
    }
    if (b->lobe_count < 2) {
        b->lobes[0].probability = 1.0f;
        return;
    }
    float a = b->lobes[0].probability, sum = a + b->lobes[1].probability;
    float p = sum > 0.0f ? a / sum : 0.5f;
    if (p > 0.0f && p < 1.0f)
        p = fminf(fmaxf(p, PROBABILITY_MIN), 1.0f - PROBABILITY_MIN);
    b->lobes[0].probability = p;
    b->lobes[1].probability = 1.0f - p;
}

/* --- a bsdf --- */

/* b's material is there already. */
static void set_up(bsdf *b, frame shading, bool is_tilted, const surface_hit *hit, vec3 out)
{
    b->shading = shading;
    b->geometric_normal = hit->geometric_normal;
    b->out = out;
    b->is_pane = pane_is_of(&b->material);
    b->is_tilted = is_tilted;
    b->lobe_count = 0;
    if (b->material.kind == MATERIAL_HAIR) {
        hair_point *h = &b->material.hair;
        float v = hit->is_mirrored ? 1.0f - hit->uv.y : hit->uv.y;
        *h = hair_point_at(h->fibre, h->sigma_a, v, frame_to_local(&b->shading, out));
        h->faces_rays = hit->faces_rays;
    }
    if (LOBES[b->material.kind].add)
        LOBES[b->material.kind].add(b);
    normalize_probabilities(b);
    for (int k = 0; hit->is_strand && k < b->lobe_count; k++)
        b->lobes[k].group = BSDF_TRACED;
}

void bsdf_init_of(const material_point *m, const surface_hit *hit, vec3 out, bsdf *out_bsdf)
{
    out_bsdf->material = *m;
    set_up(out_bsdf, frame_from_z(hit->shading_normal), false, hit, out);
}

/* Makes one hit of both faces of a slab and what is between them. */
static void make_slab(const scene *s, const surface_hit *hit, bsdf *b)
{
    const medium *between = hit->slab.medium < s->medium_count ? &s->media[hit->slab.medium] : NULL;
    b->is_pane = true;
    b->lobe_count = 0;
    add_lobe(b, LOBE_SLAB, BSDF_TRACED, true, 1.0f);
    b->material.slab =
        slab_point_at(&b->material, fabsf(vec3_dot(b->out, b->geometric_normal)), hit->slab.thickness, between);
}

void bsdf_init(const scene *s, const surface_hit *hit, vec3 out, bsdf *b)
{
    const material *m = material_at(s, hit, &b->material);
    frame shading = shading_frame_at(s, hit, m, material_point_has_grain(&b->material));
    set_up(b, shading, shading_frame_is_tilted(m), hit, out);
    b->is_pane = b->is_pane && s->shapes[hit->shape_index].light_index == SHAPE_NO_LIGHT;
    if (hit->slab.thickness > 0.0f)
        make_slab(s, hit, b);
}
