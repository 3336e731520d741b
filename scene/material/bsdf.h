/* bsdf.h: scattering at a surface: evaluating, sampling and its density, lobe by lobe.
 * Rests on: Lambert; Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007 (GGX); Heitz,
 * "Sampling the GGX Distribution of Visible Normals", 2018; Pharr, Jakob, Humphreys, 4th ed., 2023, ch. 9; for coats,
 * Weidlich, Wilkie, "Arbitrarily Layered Micro-Facet Surfaces", 2007.
 * Flow: material_point + surface hit -> [here] -> photon tracing, shading, path tracing.
 * Threads: pure functions.
 *
 * One predicate splits the lobes, for photons and for the eye alike: GATHERED lobes (diffuse ones) store photons and
 * look up irradiance; all others, rough or smooth, are TRACED on. The S of the path notation is every traced lobe. A
 * gathered lobe is a product t(in) A t(out) / pi, where t is 1 but under a coat, which lets through 1 - Fresnel, or
 * under an interface of which t is what it does not reflect in all (principled.h): photons carry t(in), so
 * that irradiance times A t(out) / pi is the radiance that leaves. On curves every lobe is traced: a hair is thinner
 * than the disc of any estimate, and a flat one has no normal of its own that photons and eye could agree on.
 *
 * A second predicate, is_pane and is_straight of a sample, says where light goes on as if nothing were there: for
 * photons, eye and shadow rays alike, who may count such a hit as no surface of the path. */
#ifndef AFTERGLOW_BSDF_H
#define AFTERGLOW_BSDF_H

#include "material/material_point.h"
#include "scene.h"

/* The largest factor that a shading normal may multiply a photon's flux by: where it arrives at a surface, and where a
 * lobe that is not diffuse sends it on. Light nearer to the surface than that is some thousandths where normals lean by
 * 45 degrees, and its part beyond the factor is lost. */
#define BSDF_SHADING_NORMAL_MAX 32.0f

typedef enum bsdf_lobes { BSDF_GATHERED = 1, BSDF_TRACED = 2, BSDF_ALL = 3 } bsdf_lobes;

/* The quantity that is carried: radiance is scaled by the square of the relative index when it enters another medium,
 * flux is not. */
typedef enum bsdf_transport { BSDF_RADIANCE, BSDF_FLUX } bsdf_transport;

/* Every kind of lobe, with the bsdf_lobe_type that says what it is (bsdf_lobe.h). */
#define BSDF_LOBE_LIST(X)                                                                                              \
    X(LOBE_DIFFUSE, bsdf_lobe_diffuse)                 /* to the side it came from */                                  \
    X(LOBE_DIFFUSE_THROUGH, bsdf_lobe_diffuse_through) /* to the other side */                                         \
    X(LOBE_COATED_BASE, bsdf_lobe_coated_base)         /* diffuse, under a coat */                                     \
    X(LOBE_PRINCIPLED_BASE, bsdf_lobe_principled_base) /* diffuse, under the interface of the principled one */        \
    X(LOBE_CONDUCTOR, bsdf_lobe_conductor)                                                                             \
    X(LOBE_DIELECTRIC, bsdf_lobe_dielectric)           /* reflection and refraction */                                 \
    X(LOBE_THIN_DIELECTRIC, bsdf_lobe_thin_dielectric) /* a pane: reflection, and straight through */                  \
    X(LOBE_SLAB, bsdf_lobe_slab) /* a slab passed straight: reflection by both faces, and straight through */          \
    X(LOBE_COAT, bsdf_lobe_coat) /* reflection by a dielectric coat */                                                 \
    X(LOBE_CONDUCTOR_UNDER_COAT, bsdf_lobe_conductor_under_coat) /* refracted in, reflected, refracted out */          \
    X(LOBE_COAT_SCATTERED, bsdf_lobe_coat_scattered)             /* what leaves a coat at any angle (coat.h) */        \
    X(LOBE_HAIR, bsdf_lobe_hair)                                 /* all ways by a fibre (hair.h) */                    \
    X(LOBE_PRINCIPLED, bsdf_lobe_principled) /* of metal and dielectric: reflection, and straight or refracted */      \
    X(LOBE_CLEARCOAT, bsdf_lobe_clearcoat)   /* reflection by the coat of the principled one */

typedef enum bsdf_lobe_kind {
#define BSDF_LOBE_ENUM(kind, type) kind,
    BSDF_LOBE_LIST(BSDF_LOBE_ENUM)
#undef BSDF_LOBE_ENUM
        LOBE_KIND_COUNT
} bsdf_lobe_kind;

typedef struct bsdf_lobe {
    uint8_t kind;  /* bsdf_lobe_kind */
    uint8_t group; /* bsdf_lobes */
    bool is_delta;
    float probability; /* of being picked among all lobes; they sum to 1 */
} bsdf_lobe;

enum { BSDF_LOBES_MAX = 3 };

typedef struct bsdf {
    material_point material; /* what all lobes are evaluated from */
    frame shading;           /* z: shading normal, to the outside */
    vec3 geometric_normal;   /* to the outside */
    vec3 out;                /* back along the ray that arrived, unit */
    bool is_tilted;          /* by a bump or normal map: facets send nothing through the surface, which a room of walls
                                without thickness would see as light from outside */
    bool is_pane;            /* lets light straight through (pane.h, slab.h), and does not shine itself */
    uint8_t lobe_count;
    bsdf_lobe lobes[BSDF_LOBES_MAX]; /* a diffuse one that reflects is the first */
} bsdf;

_Static_assert(sizeof(bsdf_lobe) == 8, "each bsdf has BSDF_LOBES_MAX of them");
_Static_assert(sizeof(bsdf) <= 192, "three lines of the cache: each hit that is shaded makes a bsdf");

typedef struct bsdf_sample {
    vec3 direction;        /* unit, away from the surface */
    rgb weight;            /* f |cos| / pdf, shading-normal correction of flux included */
    float pdf_solid_angle; /* of all lobes asked for together, as they sample it; meaningless where is_delta */
    bool is_delta;
    bool is_straight; /* goes on through a pane, unbent */
    bsdf_lobes group; /* of the lobe that was picked */
} bsdf_sample;

/* out: back along the ray that met the surface, unit. The bsdf is filled where it stands: a struct returned would be
 * copied, twice. */
void bsdf_init(const scene *s, const surface_hit *hit, vec3 out, bsdf *out_bsdf);
/* bsdf_init of a material's values, about the hit's own shading normal: no map tilts it, and no grain turns it. */
void bsdf_init_of(const material_point *m, const surface_hit *hit, vec3 out, bsdf *out_bsdf);

bool bsdf_has(const bsdf *b, bsdf_lobes lobes);

/* A Lambertian lobe and no other: sampling it needs no u_lobe, so that a gather draws its directions many at once, and
 * may draw them where a guide says that light is. */
static inline bool bsdf_is_plain(const bsdf *b)
{
    return b->material.kind == MATERIAL_DIFFUSE && b->lobes[0].group == BSDF_GATHERED;
}

/* Whether `out` is on the inside, by the geometric normal: what does not go through stays there. */
static inline bool bsdf_is_below(const bsdf *b) { return vec3_dot(b->out, b->geometric_normal) < 0.0f; }

/* The share of light that goes straight through the surface to `out`, in [0, 1]; black where there is no pane. */
rgb bsdf_straight_transmittance(const bsdf *b);

/* Whether light can find these lobes by sampling a lamp: they are not all perfectly smooth. */
bool bsdf_is_sampled_from_light(const bsdf *b, bsdf_lobes lobes);

/* Whether samples of these lobes may leave in different directions, and not all in that of one mirror. */
bool bsdf_has_many_ways(const bsdf *b, bsdf_lobes lobes);

/* Whether any of these that a lamp can find scatter light that comes from behind the surface, as `out` sees it. */
bool bsdf_scatters_through(const bsdf *b, bsdf_lobes lobes);

/* The probability with which bsdf_sample_direction, asked for all lobes, picks one of these. */
float bsdf_probability(const bsdf *b, bsdf_lobes lobes);

/* The factor A t(out), of irradiance on out's side and on the other, each to be divided by pi: what leaves as
 * radiance. */
rgb bsdf_gathered_reflection(const bsdf *b);
rgb bsdf_gathered_transmission(const bsdf *b);

/* The index inside over that outside by which light that goes through is refracted; 1: it goes straight. */
float bsdf_index(const bsdf *b);

/* f |cos(direction, shading normal)| for light from `direction` (unit, away from the surface) leaving to out; smooth
 * lobes count as 0. */
rgb bsdf_evaluate(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 direction);
/* Of sampling. Radiance is sampled about shading normals; flux leaves diffuse lobes by the cosine to the geometric
 * one. */
float bsdf_pdf(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 direction);

/* Samples the way on. false: absorbed. */
bool bsdf_sample_direction(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, float u_lobe, vec2 u,
                           bsdf_sample *out_sample);

/* The factor that arriving flux, from out, is multiplied by when it is stored: t(in), and |cos to shading normal| /
 * |cos to geometric normal|, so that irradiance is that of the shading surface (Veach 1997, 5.3). */
float bsdf_arrival_factor(const bsdf *b);

/* bsdf_arrival_factor at a point that gathers nothing itself, while others of its surface do: beside the metal grains
 * of a mix, or the black texels of a base. An estimate takes photons per area of all the surface, so photons are stored
 * on all of it, as those others would have them. false: no point of the surface gathers. */
bool bsdf_arrival_factor_beside(const scene *s, const surface_hit *hit, const bsdf *b, float *out_factor);

#endif
