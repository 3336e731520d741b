/* photon_map_integrator.c: the integrator that gathers from a photon map: its maps and cache, its workers' batches.
 * Rests on: Jensen 1996; Christensen 1999; Neilson, Yang, TR 04-21, 2004.
 * Flow: render -> [here] -> render_maps, split_pilot; shading, final_gather. Threads: see integrator.h. */
#include "integrator/final_gather.h"
#include "integrator/integrator.h"
#include "integrator/shading.h"
#include "render_maps.h"
#include "split_pilot.h"
#include "status.h"

enum { ARENA_BLOCK_BYTES = 1 << 16 };

/* A gather ray shorter than this many mean radii of an estimate does not use the cache. */
static const float GATHER_MIN_DISTANCE_RADII = 1.0f;

static ag_status prepare(struct ag_rendering *r)
{
    AG_TRY(maps_create(r->context, r->s, &r->settings, &r->maps));
    maps *m = r->maps;
    r->t.caustic = &m->caustic;
    r->t.cache = &m->cache;
    r->t.incident = m->incident.cells ? &m->incident : NULL;
    r->t.gather_min_distance = GATHER_MIN_DISTANCE_RADII * m->global.mean_radius;
    return AG_OK;
}

static bool reserve(const transport *t, eye_worker *worker)
{
    float most_indirect = t->settings->clamp_indirect > 0.0f ? t->settings->clamp_indirect : INFINITY;
    worker->batch = gather_batch_create(most_indirect);
    worker->scratch = arena_create(ARENA_BLOCK_BYTES);
    if (!worker->batch || !worker->scratch)
        return false;
    arena_mark mark = arena_save(worker->scratch);
    bool fits = eye_worker_neighbors(worker, t->caustic) != NULL;
    /* only these layers ask the global map outside of the cache */
    if (aov_has(t->layout, SUM_IRRADIANCE) || t->layout->has_view[VIEW_PHOTON_DENSITY])
        fits = fits && eye_worker_neighbors(worker, t->cache->map);
    arena_restore(worker->scratch, mark);
    return fits;
}

const integrator photonmap_integrator = {.has_photon_map = true,
                                         .splits_samples = true,
                                         .direct_guiding = AG_DEFAULT_DIRECT_GUIDING,
                                         .prepare = prepare,
                                         .reserve = reserve,
                                         .begin_pass = split_pilot_run,
                                         .sample = shading_radiance,
                                         .complete = final_gather_resolve};
