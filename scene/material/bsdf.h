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

/* The largest factor by which a shading normal may multiply a photon's flux: on arrival at a surface, and where a lobe
 * that is not diffuse scatters it. With normals that lean by 45 degrees, a few thousandths of the light arrive at
 * smaller angles to the surface, and their part beyond the factor is lost. */
#define BSDF_SHADING_NORMAL_MAX 32.0f

/* The largest such factor of fibres on surfaces that do not face rays, at a grazing angle: little light arrives there,
 * but what they scatter is as bright as elsewhere. Whoever traces photons splits paths by bsdf_flux_gain. */
#define BSDF_FIBRE_FLUX_MAX 1024.0f

typedef enum bsdf_lobes { BSDF_GATHERED = 1, BSDF_TRACED = 2, BSDF_ALL = 3 } bsdf_lobes;

/* The quantity that is transported: radiance is scaled by the square of the relative index when it enters another
 * medium, flux is not. */
typedef enum bsdf_transport { BSDF_RADIANCE, BSDF_FLUX } bsdf_transport;

/* The most lobes that a kind of material may add; MATERIAL_KIND_LIST says how many each adds. */
enum { BSDF_LOBES_MAX = 6 };

typedef struct bsdf {
    material_point material; /* the values that all lobes are evaluated from */
    frame shading;           /* z: shading normal, to the outside */
    vec3 geometric_normal;   /* to the outside */
    vec3 out;                /* back along the ray that arrived, unit */
    bool is_tilted; /* tilted by a bump or normal map: facets then transmit nothing through the surface, which would
                       look like light from outside in a room of walls without thickness */
    bool is_pane;   /* transmits light straight (pane.h, slab.h), and is not emissive */
    uint8_t lobe_count;
    uint8_t gathered_lobes, traced_lobes, smooth_lobes; /* sets: bit k stands for lobes[k] */
    uint8_t lobes[BSDF_LOBES_MAX];                      /* bsdf_lobe_kind; a diffuse one that reflects comes first */
    float probabilities[BSDF_LOBES_MAX];                /* of picking each lobe; together 1 */
} bsdf;

_Static_assert(LOBE_KIND_COUNT <= UINT8_MAX && BSDF_LOBES_MAX <= 8, "kinds and sets of lobes are bytes");
_Static_assert(sizeof(bsdf) <= 192, "three lines of the cache: each hit that is shaded makes a bsdf");

typedef struct bsdf_sample {
    vec3 direction;        /* unit, away from the surface */
    rgb weight;            /* f |cos| / pdf, shading-normal correction of flux included */
    float pdf_solid_angle; /* of all lobes sampled together; undefined where is_delta */
    bool is_delta;
    bool is_straight; /* passes a pane straight */
    bsdf_lobes group; /* of the lobe that was picked */
} bsdf_sample;

/* Initialises the bsdf of a hit in place, since a returned struct would be copied twice. out: back along the ray that
 * met the surface, unit. */
void bsdf_init(const scene *s, const surface_hit *hit, vec3 out, bsdf *out_bsdf);
/* bsdf_init from a material's values, about the hit's own shading normal, without a map that tilts it or a grain that
 * turns it. */
void bsdf_init_of(const material_point *m, const surface_hit *hit, vec3 out, bsdf *out_bsdf);
/* The bsdf of a point in a medium: one traced lobe, the phase function, whose value has no cosine. How much the medium
 * scatters is in the weight of the ray that has met the point. */
void bsdf_init_in_medium(const medium *m, vec3 out, bsdf *out_bsdf);

/* Returns the set of these lobes: bit k stands for lobes[k]. */
static inline unsigned bsdf_lobe_set(const bsdf *b, bsdf_lobes lobes)
{
    return (lobes & BSDF_GATHERED ? b->gathered_lobes : 0u) | (lobes & BSDF_TRACED ? b->traced_lobes : 0u);
}

static inline bool bsdf_has(const bsdf *b, bsdf_lobes lobes) { return bsdf_lobe_set(b, lobes) != 0; }

/* Returns whether the bsdf is one Lambertian lobe: sampling it needs no u_lobe, so that a gather samples its directions
 * in batches, and may follow a guide. */
static inline bool bsdf_is_plain(const bsdf *b) { return b->material.kind == MATERIAL_DIFFUSE && b->gathered_lobes; }

/* Returns whether `out` is on the inside, by the geometric normal; reflected light stays there. */
static inline bool bsdf_is_below(const bsdf *b) { return vec3_dot(b->out, b->geometric_normal) < 0.0f; }

/* Returns the share of light that passes straight through the surface to `out`, [0, 1]; black where it is no pane. */
rgb bsdf_straight_transmittance(const bsdf *b);

/* Returns whether sampling a lamp can contribute to these lobes: they are not all perfectly smooth. */
static inline bool bsdf_is_sampled_from_light(const bsdf *b, bsdf_lobes lobes)
{
    return (bsdf_lobe_set(b, lobes) & ~(unsigned)b->smooth_lobes) != 0;
}

/* Returns whether samples of these lobes may have different directions, unlike those of one mirror. */
bool bsdf_has_many_ways(const bsdf *b, bsdf_lobes lobes);

/* Returns the share of u_lobe, from 0 up, in which bsdf_sample_direction reflects, where these lobes are one smooth
 * lobe that transmits too; less than 0 where they are not. */
float bsdf_smooth_reflection_share(const bsdf *b, bsdf_lobes lobes);

/* Returns whether any of these lobes that is not smooth scatters light from behind the surface, as seen from `out`. */
bool bsdf_scatters_through(const bsdf *b, bsdf_lobes lobes);

/* Returns whether these lobes are rough ones that reflect, at least one and no others. */
bool bsdf_is_rough_reflection(const bsdf *b, bsdf_lobes lobes);

/* Returns the probability that bsdf_sample_direction of all lobes picks one of these. */
float bsdf_probability(const bsdf *b, bsdf_lobes lobes);

/* Return the factor A t(out) of irradiance on out's side, and on the other side; divided by pi it gives the radiance
 * that leaves. */
rgb bsdf_gathered_reflection(const bsdf *b);
rgb bsdf_gathered_transmission(const bsdf *b);

/* Returns the refractive index inside over that outside for transmitted light; 1: it goes straight. */
float bsdf_index(const bsdf *b);

/* Returns f |cos(direction, shading normal)| for light from `direction` (unit, away from the surface) that leaves to
 * out; smooth lobes count as 0. */
rgb bsdf_evaluate(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 direction);
/* Returns the density of bsdf_sample_direction, 1/sr. Radiance is sampled about shading normals; flux leaves diffuse
 * lobes by the cosine to the geometric normal. */
float bsdf_pdf(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 direction);

/* Samples a direction; returns false where the light is absorbed. */
bool bsdf_sample_direction(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, float u_lobe, vec2 u,
                           bsdf_sample *out_sample);

/* Returns the factor of arriving flux, from out, when it is stored: t(in), and |cos to shading normal| / |cos to
 * geometric normal|, so that irradiance is that of the shading surface (Veach 1997, 5.3). */
float bsdf_arrival_factor(const bsdf *b);

/* About how many times its flux all ways on from the point carry away together, at least 1: much at a fibre's surface
 * that is met at a grazing angle. */
float bsdf_flux_gain(const bsdf *b);

/* bsdf_arrival_factor at a point that gathers no light itself, while other points of its surface do, as between the
 * metal grains of a mix or the black texels of a base. An estimate takes photons per area of the whole surface, so they
 * are stored on all of it, with the factor of those other points. Returns false where no point of the surface
 * gathers. */
bool bsdf_arrival_factor_beside(const scene *s, const surface_hit *hit, const bsdf *b, float *out_factor);

#endif
