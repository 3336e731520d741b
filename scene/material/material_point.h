/* material_point.h: a material at one point of a surface: mixes picked, textures looked up. It holds only the values
 * from which lobes are evaluated, since each bsdf has one; the scene file's description is in material.h.
 * Flow: material + surface hit -> [here] -> bsdf, which makes lobes of it. Threads: pure functions. */
#ifndef AFTERGLOW_MATERIAL_POINT_H
#define AFTERGLOW_MATERIAL_POINT_H

#include "material/coat.h"
#include "material/hair.h"
#include "material/principled.h"
#include "medium/phase_function.h"

struct scene;
struct surface_hit;

typedef struct diffuse_point {
    rgb reflectance, transmittance; /* [0, 1], together at most 1 */
} diffuse_point;

typedef struct metal_point {
    ggx facets;
    rgb eta, k;
} metal_point;

typedef struct glass_point {
    ggx facets; /* none for thin glass */
    float ior;
} glass_point;

/* Both faces of a plate and the medium between them, treated as one surface (slab.h). */
typedef struct slab_point {
    rgb reflected, through;
} slab_point;

typedef struct material_point {
    material_kind kind; /* never MATERIAL_MIX */
    union {
        diffuse_point diffuse;       /* MATERIAL_DIFFUSE, MATERIAL_DIFFUSE_TRANSMISSION */
        metal_point metal;           /* MATERIAL_CONDUCTOR */
        glass_point glass;           /* MATERIAL_DIELECTRIC, MATERIAL_THIN_DIELECTRIC */
        coat_point coat;             /* MATERIAL_COATED_DIFFUSE, MATERIAL_COATED_CONDUCTOR */
        principled_point principled; /* MATERIAL_PRINCIPLED */
        hair_point hair;             /* MATERIAL_HAIR; bsdf_init adds the direction to fibre and colour */
        slab_point slab;             /* for a bsdf with LOBE_SLAB, whatever the kind */
        phase_function phase;        /* for a bsdf with LOBE_PHASE, whose kind is MATERIAL_INTERFACE */
    };
} material_point;

_Static_assert(sizeof(material_point) <= 96, "each hit on a surface makes a material_point");

/* Writes the point of a prepared material without textures, or before they are evaluated. */
void material_point_of(const material *m, material_point *out_point);

/* Returns the material at a hit, with mixes picked, and its values there. */
const material *material_at(const struct scene *s, const struct surface_hit *hit, material_point *out_point);

/* Finds, for a surface that gathers light anywhere (bsdf.h), the material by which it does, at a point where another
 * one may have been picked or the texture is black. Returns false where no point of the surface gathers. */
bool material_gathering_at(const struct scene *s, const struct surface_hit *hit, material_point *out_point);

/* Returns whether scattering depends on the surface's grain or on a fibre's axis. */
bool material_point_has_grain(const material_point *p);

#endif
