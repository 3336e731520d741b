/* coat_lobe.c: see coat_lobe.h. */
#include "material/coat_lobe.h"

#include "material/fresnel.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum {
    WALKS = 8192,      /* between the layers, to measure the breadth; also samples of the lobe, held against them */
    LOBE_FACETS = 512, /* of the lobe, for the scales, for each cosine */
    ROUNDS = 100       /* of scaling */
};

static vec2 lattice(int k, int count)
{
    double y = ((double)k + 0.5) * 0.61803398874989485; /* multiples of the golden section lie evenly */
    return (vec2){((float)k + 0.5f) / (float)count, (float)(y - floor(y))};
}

ggx coat_lobe_facets(const coat_point *m, float breadth)
{
    /* small angles: a facet of the interface turns light by ior - 1 times its tilt, twice; one of the metal by twice
     * its tilt, which refraction widens by ior */
    float bend = 0.70710678f * (m->ior - 1.0f), widen = m->ior;
    float u =
        bend * bend * m->interface.alpha_u * m->interface.alpha_u + widen * widen * m->base.alpha_u * m->base.alpha_u;
    float v =
        bend * bend * m->interface.alpha_v * m->interface.alpha_v + widen * widen * m->base.alpha_v * m->base.alpha_v;
    return (ggx){float_max(breadth * sqrtf(u), MATERIAL_SMOOTH_ALPHA),
                 float_max(breadth * sqrtf(v), MATERIAL_SMOOTH_ALPHA)};
}

/* The tangent of the half vector's angle that half of the lobe's light stays below. */
enum { TANGENT_BINS = 256 };

typedef struct tangents {
    float bins[TANGENT_BINS], sum, scale; /* scale: of bin k / (256 - k) */
} tangents;

static void add_tangent(tangents *t, vec3 h, float weight)
{
    float tangent = sqrtf(h.x * h.x + h.y * h.y) / (h.z * t->scale);
    int bin = (int)(tangent / (1.0f + tangent) * TANGENT_BINS);
    t->bins[bin < TANGENT_BINS ? bin : TANGENT_BINS - 1] += weight;
    t->sum += weight;
}

static float median_tangent(const tangents *t)
{
    float below = 0.0f;
    for (int k = 0; k < TANGENT_BINS; k++) {
        if (below + t->bins[k] >= 0.5f * t->sum && t->bins[k] > 0.0f) {
            float x = ((float)k + (0.5f * t->sum - below) / t->bins[k]) / TANGENT_BINS;
            return t->scale * x / (1.0f - float_min(x, 0.999f));
        }
        below += t->bins[k];
    }
    return t->scale;
}

/* A factor for the fitted breadth, measured on spheres under a lamp. Under a rough coat the light of a mirror
 * is less spread at grazing angles than GGX facets as rough would have it: 0.8. On a rough metal pbrt's value, which
 * lamps see, is larger than what its samples come to, since the two weights by which it joins its two estimates do not
 * sum to 1: by 3 % for a coat of 0.1 on a metal of 0.2, 14 % for one of 0.6. A broader lobe has the brightness of the
 * former towards lamps in front, within 6 %, and the albedo of the latter. */
static float breadth_correction(const coat_point *m)
{
    float metal = m->ior * m->ior * m->base.alpha_u * m->base.alpha_v, bend = 0.5f * (m->ior - 1.0f) * (m->ior - 1.0f);
    float share = metal / float_max(metal + bend * m->interface.alpha_u * m->interface.alpha_v, 1e-12f);
    return 0.8f + 0.2f * share + 1.5f * share * (1.0f - share);
}

/* How broad the lobe is where neither end is at grazing, against facets seen from there. */
float coat_lobe_fit_breadth(const coat_point *m, const coat_layers *layers, uint64_t key)
{
    static const float COSINE = 0.9f;
    vec3 out = coat_direction(COSINE);
    ggx facets = coat_lobe_facets(m, 1.0f);
    tangents walked = {.scale = sqrtf(facets.alpha_u * facets.alpha_v)};
    for (int k = 0; k < WALKS; k++) {
        coat_numbers numbers = coat_numbers_make(key, COAT_COSINES, (uint32_t)k);
        coat_path path = coat_walk_in(layers, out, &numbers);
        if (path.end == COAT_END_OUTSIDE && !path.was_trapped && path.scatter_count == 0)
            add_tangent(&walked, ggx_half_vector(out, path.direction), path.weight);
    }
    if (!(walked.sum > 0.0f))
        return 1.0f;
    float wanted = median_tangent(&walked), breadth = 1.0f;
    for (int round = 0; round < 4; round++) {
        tangents seen = {.scale = walked.scale};
        facets = coat_lobe_facets(m, breadth);
        for (int k = 0; k < WALKS; k++) {
            vec3 h = ggx_sample_visible(facets, out, lattice(k, WALKS)), i = reflect_about(out, h);
            if (i.z > 0.0f)
                add_tangent(&seen, h, ggx_masking_shadowing(facets, out, i) / ggx_masking(facets, out));
        }
        breadth = float_clamp(breadth * wanted / median_tangent(&seen), 0.25f, 4.0f);
    }
    return breadth * breadth_correction(m);
}

/* Samples of the lobe of a metal that reflects all, before it is scaled. */
typedef struct lobe_sample {
    float cosine, weight;
} lobe_sample;

static void sample_lobe(const coat_point *m, const coat_layers *layers, float breadth, float cosine,
                        lobe_sample out_samples[LOBE_FACETS])
{
    vec3 out = coat_direction(cosine);
    ggx facets = layers->interface_is_smooth ? layers->base : coat_lobe_facets(m, breadth);
    vec3 o = layers->interface_is_smooth ? coat_refract(m, out) : out;
    for (int k = 0; k < LOBE_FACETS; k++) {
        vec3 i = reflect_about(o, ggx_sample_visible(facets, o, lattice(k, LOBE_FACETS)));
        out_samples[k] = (lobe_sample){0.0f, 0.0f};
        if (i.z <= 0.0f)
            continue;
        float weight = ggx_masking_shadowing(facets, o, i) / ggx_masking(facets, o) / LOBE_FACETS;
        if (layers->interface_is_smooth) {
            float outside = 1.0f - (1.0f - i.z * i.z) * m->ior * m->ior;
            if (outside <= 0.0f)
                continue;
            i.z = sqrtf(outside);
            weight *= coat_crossing(m, cosine) * coat_crossing(m, i.z);
        }
        out_samples[k] = (lobe_sample){i.z, weight};
    }
}

static float lobe_albedo(const coat_cell *cell, const lobe_sample *samples, int number)
{
    float sum = 0.0f;
    for (int k = 0; k < LOBE_FACETS; k++) {
        lobe_sample s = samples[number * LOBE_FACETS + k];
        sum += s.weight > 0.0f ? s.weight * coat_interpolate(cell->scale, s.cosine) : 0.0f;
    }
    return sum * cell->scale[number];
}

bool coat_lobe_fit_scales(coat_cell *cell, const coat_point *m, const coat_layers *layers,
                          const float once[COAT_COSINES])
{
    lobe_sample *samples = calloc((size_t)COAT_COSINES * LOBE_FACETS, sizeof *samples);
    if (!samples)
        return false;
    for (int number = 0; number < COAT_COSINES; number++) {
        cell->scale[number] = 1.0f;
        sample_lobe(m, layers, cell->breadth, coat_cosine(number), samples + (ptrdiff_t)number * LOBE_FACETS);
    }
    for (int number = 0; number < COAT_COSINES && layers->interface_is_smooth; number++)
        if (once[number] > 0.0f)
            cell->albedo[number] *= lobe_albedo(cell, samples, number) / once[number];
    for (int round = 0; round < ROUNDS; round++) {
        float next[COAT_COSINES];
        for (int number = 0; number < COAT_COSINES; number++) {
            float sum = lobe_albedo(cell, samples, number);
            bool is_lit = sum > 1e-6f && cell->albedo[number] > 1e-6f;
            next[number] = is_lit ? float_min(cell->scale[number] * sqrtf(cell->albedo[number] / sum), 16.0f) : 1.0f;
        }
        memcpy(cell->scale, next, sizeof next);
    }
    free(samples);
    return true;
}
