/* photon_tracing.h: light from the lamps through the scene, into arrays of photons, with its energy balance.
 * Rests on: Jensen, "Global Illumination using Photon Maps", 1996; Jensen 2001, ch. 5 (emission, roulette).
 * Flow: scene -> [here] -> photon_map. Threads: paths are traced in blocks by the run's workers; the photons are the
 * same for any number of them: each path has its own random numbers, blocks are merged in their order, and the array is
 * cut at a prefix.
 *
 * Global map: every arrival at a gathered lobe, caustic paths included: L(S|D)*D. Caustic map: arrivals that came from
 * the lamp by way of traced lobes alone, at least one: LS+D, from an emission of its own. Where panes are direct, light
 * that a pane lets straight through has met no S there: the eye samples it at the lamp.
 *
 * A path that carries much more than others to where light is requested is split where a diffuse surface scatters it,
 * so that it leaves many photons as bright as the others' instead of a few bright ones (Booth, Hendricks, "Importance
 * estimation in forward Monte Carlo calculations", 1984: weight windows).
 *
 * Where something moves, each path has its own time of the shutter, so a map holds the mean over the shutter; it does
 * not tell which light arrives when. A photon on a moving surface lies where that point of the surface is when the
 * shutter opens, and lookups go there (surface_at_opening), so photons are not smeared along the motion. */
#ifndef AFTERGLOW_PHOTON_TRACING_H
#define AFTERGLOW_PHOTON_TRACING_H

#include "emission_guide.h"
#include "importance_map.h"
#include "photon_block.h"
#include "run_context.h"
#include "scene.h"

/* Tracing gives up after this many paths for each photon wanted. */
enum { PHOTON_PATHS_MAX = 16 };

typedef enum photon_kind { PHOTON_GLOBAL, PHOTON_CAUSTIC } photon_kind;

/* The flux by its destinations, W, of all emitted paths. emitted + gained = absorbed + escaped + lost + truncated;
 * arrived = stored + cut + thinned. With a guide each of them is right on average. */
typedef struct energy_balance {
    double emitted[3];   /* at the lamps */
    double gained[3];    /* by the survivors of roulette, and by the weights of guided paths, which may be below 1 */
    double absorbed[3];  /* by surfaces and media */
    double escaped[3];   /* out of the scene */
    double lost[3];      /* by the victims of roulette, and by paths of no use to a caustic map */
    double truncated[3]; /* at the cap of path length */
    double arrived[3];   /* at gathered lobes where this map stores */
    double stored[3];    /* in photons, as rounded to their shared exponents */
    double cut[3];       /* arrived on the last path after the map was full */
    double thinned[3];   /* in photons left out where no light is requested, less the flux that is added to others for
                            them */
} energy_balance;

typedef struct photon_set {
    photon *photons; /* owned, from photon_records_create */
    uint32_t count;
    uint64_t emitted_paths; /* a photon's flux is its stored flux / emitted_paths */
    uint64_t parts;         /* paths that splitting has added */
    uint64_t rays;
    uint64_t rays_cut; /* by TRANSMITTANCE_CROSSINGS_MAX (scene/rays/transmittance.h): absorbed */
    energy_balance balance;
} photon_set;

typedef struct photon_tracing_settings {
    photon_kind kind;
    uint32_t wanted;        /* photons to store, > 0 */
    uint64_t paths;         /* so many are emitted, unless `wanted` photons are stored before; 0: as many as it takes */
    int max_scatterings;    /* arrivals after more scatterings than this are not stored; >= 0 */
    bool media_are_bounded; /* scatterings by media count in that, too; else roulette alone ends paths there
                               (medium_roulette.h) */
    bool panes_are_direct;  /* light straight through panes (bsdf.h) counts as unscattered: no caustic */
    bool filters_textures;  /* over about the area that a photon stands for, and more behind diffuse vertices */
    uint64_t seed;
    /* Borrowed; NULL: paths begin by power alone, and every arrival is stored. */
    const emission_guide *guide;    /* where paths begin */
    const light_target *focus;      /* light from afar is densest around it; NULL: around the scene's detail */
    const importance_map *asked;    /* where light is requested; elsewhere no denser photons than by power alone */
    const importance_map *onward;   /* diffuse surfaces whose light arrives where it is requested */
    const struct onward_ways *ways; /* directions in which surfaces send it there */
    float stored_share; /* with a guide: the share of the photons that is stored, at random; their flux is divided by
                           it; (0, 1] */
    float split_above;  /* [W/m]: a path has its flux, summed over the colours, times the root of the importance onward,
                           over this as its number of parts; 0: paths are not split */
    float caustic_root; /* the root of importance of a caustic map, whose paths are split at rough traced lobes: the
                           mean over the photons of trials that arrive where light is requested */
    double progress_begin, progress_end; /* of AG_PHASE_PHOTONS */
} photon_tracing_settings;

/* Traces paths until `wanted` photons are stored; or fewer where light does not reach that many, with a warning that
 * says why. With a number of paths it stores what these bring, so that a photon does not change where other paths store
 * more or fewer; where that would be more than `wanted`, a warning says that fewer paths were emitted. A scene without
 * light gives an empty set, as do caustics where nothing has traced lobes. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status photon_tracing_run(const scene *s, run_context *run, const photon_tracing_settings *settings,
                             photon_set *out_set);
void photon_set_reset(photon_set *set);

/* The sums over all trials so far. */
typedef struct trial_counts {
    uint64_t paths, rays;
    uint64_t parts;          /* paths that splitting has added */
    uint64_t photons, asked; /* photons that arrive; and those of them that arrive where light is requested */
    double stored;           /* photons that would be stored in the mean, by stored_share 1 */
    double roots;            /* sum of the roots of importance where the asked ones arrive */
    double importance;       /* sum of importance where they arrive [1/m^2] */
} trial_counts;

/* Traces `count` trial paths from a number on, which store nothing. A trial's value is the sum, over the photons
 * that it would store, of their flux times the root of their points' importance, so that what is requested rarely does
 * not depend on a handful of photons. The paths differ from those of photon_tracing_run. The caustics of a scene
 * without traced lobes, and the light of one without lamps, have value 0. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status photon_tracing_try(const scene *s, run_context *run, const photon_tracing_settings *settings,
                             uint64_t first_path, uint32_t count, emission_trial *out_trials,
                             trial_counts *in_out_counts);

#endif
