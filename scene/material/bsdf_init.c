/* bsdf_init.c: the lobes that a material has at a point, and how often each is picked. Flow: material_point -> [here]
 * -> bsdf. Threads: pure functions. */
#include "material/bsdf.h"
#include "material/bsdf_lobe.h"
#include "material/material_type.h"
#include "material/pane.h"
#include "material/shading_frame.h"
#include "material/slab.h"
#include "scene.h"

#include <assert.h>

/* No lobe that carries light is picked more rarely than this. */
static const float PROBABILITY_MIN = 0.1f;

const bsdf_lobe_type *bsdf_base_of_kind(material_kind kind) { return bsdf_lobe_types[material_type_of(kind)->base]; }

/* --- probabilities --- */

/* Raises the probability of each lobe that carries anything to a least share, at the cost of the others. */
static void normalize_many(bsdf *b)
{
    float sum = 0.0f, free_sum = 0.0f, left = 1.0f;
    for (int k = 0; k < b->lobe_count; k++)
        sum += b->probabilities[k];
    for (int k = 0; k < b->lobe_count; k++) {
        float *p = &b->probabilities[k];
        *p = sum > 0.0f ? *p / sum : 1.0f / (float)b->lobe_count;
        if (*p > 0.0f && *p <= PROBABILITY_MIN) {
            *p = PROBABILITY_MIN;
            left -= PROBABILITY_MIN;
        } else {
            free_sum += *p;
        }
    }
    for (int k = 0; k < b->lobe_count; k++)
        if (b->probabilities[k] > PROBABILITY_MIN)
            b->probabilities[k] *= left / free_sum;
}

/* Shares become probabilities; a lobe that carries anything is not neglected. */
static void normalize_probabilities(bsdf *b)
{
    if (b->lobe_count > 2) {
        normalize_many(b);
        return;
    }
    if (b->lobe_count < 2) {
        b->probabilities[0] = 1.0f;
        return;
    }
    float a = b->probabilities[0], sum = a + b->probabilities[1];
    float p = sum > 0.0f ? a / sum : 0.5f;
    if (p > 0.0f && p < 1.0f)
        p = float_clamp(p, PROBABILITY_MIN, 1.0f - PROBABILITY_MIN);
    b->probabilities[0] = p;
    b->probabilities[1] = 1.0f - p;
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
    bsdf_remove_lobes(b);
    const material_type *type = material_type_of(b->material.kind);
    if (type->add_lobes)
        type->add_lobes(b, hit);
    assert(b->lobe_count <= material_lobes_max[b->material.kind]);
    normalize_probabilities(b);
    if (hit->is_strand) {
        b->traced_lobes |= b->gathered_lobes;
        b->gathered_lobes = 0;
    }
}

void bsdf_init_of(const material_point *m, const surface_hit *hit, vec3 out, bsdf *out_bsdf)
{
    out_bsdf->material = *m;
    set_up(out_bsdf, frame_from_z(hit->shading_normal), false, hit, out);
}

void bsdf_init_in_medium(const medium *m, vec3 out, bsdf *b)
{
    b->material.kind = MATERIAL_INTERFACE;
    b->material.phase = m->phase;
    b->shading = frame_from_z(out);
    b->geometric_normal = b->out = out;
    b->is_tilted = b->is_pane = false;
    bsdf_remove_lobes(b);
    bsdf_add_lobe(b, LOBE_PHASE, BSDF_TRACED, false, 1.0f);
}

/* Combines both faces of a slab and the medium between them into one hit. */
static void make_slab(const scene *s, const surface_hit *hit, bsdf *b)
{
    const medium *between = hit->slab.medium < s->medium_count ? &s->media[hit->slab.medium] : NULL;
    b->is_pane = true;
    bsdf_remove_lobes(b);
    bsdf_add_lobe(b, LOBE_SLAB, BSDF_TRACED, true, 1.0f);
    b->material.slab = slab_point_at(&b->material, fabsf(vec3_dot(b->out, b->geometric_normal)), hit, between);
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
