/* lobes_hair.c: the one lobe of a fibre (hair.h). Threads: pure functions. */
#include "material/bsdf_lobe.h"

static void evaluate_hair(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                          float *out_pdf)
{
    (void)o;
    hair_evaluate(&b->material.hair, transport == BSDF_FLUX, bsdf_is_same_side(b, direction), i, out_value, out_pdf);
}

static bool sample_hair(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)o;
    *out_local = hair_sample(&b->material.hair, transport == BSDF_FLUX, u_lobe, u);
    return true;
}

const bsdf_lobe_type bsdf_lobe_hair = {
    .side = LOBE_BY_FIBRE,
    .evaluate = evaluate_hair,
    .sample_rough = sample_hair,
    .passes = true,
};
