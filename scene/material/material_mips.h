/* material_mips.h: filtering of a material's textures, and the coarser levels of their pictures. Only colours in
 * which light is linear are filtered: the mean of the light is then the light of the mean colour. Roughness, metals'
 * indices, bases under coats, normals, heights, emission and cut-outs are not.
 * Flow: scene_commit -> [here] -> texture_mips; material asks. Threads: one commits; then pure. */
#ifndef AFTERGLOW_MATERIAL_MIPS_H
#define AFTERGLOW_MATERIAL_MIPS_H

#include "afterglow/base.h"
#include "run_context.h"
#include "scene.h"

/* Returns whether reflectance_texture and transmittance_texture are filtered. */
bool material_is_filtered(const scene *s, const material *m);

/* Builds the coarser levels of all pictures that may be filtered, and sets filters_textures. Errors: AG_ERROR_MEMORY,
 * AG_CANCELLED. */
ag_status material_mips_make(scene *s, run_context *run);

#endif
