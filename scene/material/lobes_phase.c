/* lobes_phase.c: the one lobe of a point in a medium: its phase function. Threads: pure functions. */
#include "material/bsdf_lobe.h"

#include "medium/phase_function.h"

static void evaluate_phase(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                           float *out_pdf)
{
    (void)transport, (void)o, (void)i;
    *out_pdf = phase_function_density(&b->material.phase, -vec3_dot(b->out, direction));
    *out_value = rgb_gray(*out_pdf);
}

/* The frame's z axis is `out`. */
static bool sample_phase(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)transport, (void)o, (void)u_lobe;
    *out_local = phase_function_sample(&b->material.phase, (vec3){0.0f, 0.0f, -1.0f}, u);
    return true;
}

const bsdf_lobe_type bsdf_lobe_phase = {
    .side = LOBE_BY_MEDIUM,
    .evaluate = evaluate_phase,
    .sample_rough = sample_phase,
    .passes = true,
};
