/* bsdf_principled.h: the traced lobes of MATERIAL_PRINCIPLED: reflection and transmission by the interface, and the
 * coat. Private to bsdf.c and bsdf_lobe.c. Rests on: Khronos, glTF 2.0 and KHR_materials_transmission (of a thin wall:
 * the lobe of reflection, mirrored); Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007.
 * Flow: principled -> [here] -> bsdf_lobe. Threads: pure functions. */
#ifndef AFTERGLOW_BSDF_PRINCIPLED_H
#define AFTERGLOW_BSDF_PRINCIPLED_H

#include "material/bsdf.h"

/* Value, density and sampling of LOBE_PRINCIPLED and LOBE_CLEARCOAT, as bsdf_lobe_type has them (bsdf_lobe.h). */
void bsdf_principled_evaluate(const material *m, bsdf_lobe_kind kind, bsdf_transport transport, vec3 o, vec3 i,
                              rgb *out_value, float *out_pdf);
bool bsdf_principled_sample_smooth(const material *m, bsdf_lobe_kind kind, bsdf_transport transport, vec3 o,
                                   float u_lobe, vec3 *out_local, rgb *out_weight);
bool bsdf_principled_sample_rough(const material *m, bsdf_lobe_kind kind, vec3 o, float u_lobe, vec2 u,
                                  vec3 *out_local);

#endif
