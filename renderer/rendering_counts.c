/* rendering_counts.c: see rendering_counts.h. */
#include "rendering_counts.h"

#include "public_structs.h"
#include "rays/transmittance.h"

void rendering_count_rays(ag_rendering *r)
{
    ag_statistics *statistics = &r->context->statistics;
    uint64_t cut = 0;
    for (unsigned i = 0; i < statistics->threads; i++) {
        eye_worker *w = &r->workers[i];
        statistics->rays_camera += w->rays_camera + w->rays_further;
        statistics->rays_shadow += w->rays_shadow;
        statistics->rays_gather += w->rays_gather;
        statistics->rays_path += w->rays_path;
        statistics->rays_estimate += w->rays_estimate;
        r->camera_rays += w->rays_camera;
        r->camera_rays_met += w->camera_rays_met;
        statistics->samples_not_finite += w->samples_not_finite;
        cut += w->rays_cut;
        w->rays_camera = w->rays_further = w->rays_shadow = w->rays_gather = w->rays_path = w->rays_estimate = 0;
        w->camera_rays_met = w->samples_not_finite = w->rays_cut = 0;
    }
    transmittance_warn_of_cut(r->context->log, cut);
}

void rendering_count_irradiance(ag_statistics *statistics, maps *m, bool finds_distinct)
{
    const irradiance_counters c = irradiance_cache_counters(&m->cache), *before = &m->counted;
    statistics->irradiance_requests += c.requests - before->requests;
    statistics->irradiance_computed += c.computed - before->computed;
    statistics->irradiance_deferred += c.deferred - before->deferred;
    statistics->irradiance_waited += c.waited - before->waited;
    statistics->irradiance_duplicated += c.duplicated - before->duplicated;
    statistics->irradiance_reclaimed += c.reclaimed - before->reclaimed;
    statistics->irradiance_uncached += c.uncached - before->uncached;
    statistics->irradiance_refused += c.refused - before->refused;
    statistics->rays_estimate += c.rays - before->rays;
    statistics->irradiance_estimate_s +=
        irradiance_counters_estimate_seconds(&c) - irradiance_counters_estimate_seconds(before);
    statistics->irradiance_wait_s += c.waited_seconds - before->waited_seconds;
    if (!finds_distinct)
        return;
    const uint64_t distinct = irradiance_cache_distinct(&m->cache);
    statistics->irradiance_distinct += distinct - m->counted_distinct;
    m->counted_distinct = distinct;
    m->counted = c;
}

void ag_rendering_statistics_fill(const ag_rendering *r, void *out_statistics, size_t struct_size)
{
    ag_statistics statistics = ag_context_statistics(r ? r->context : NULL);
    if (r && r->maps)
        rendering_count_irradiance(&statistics, r->maps, false);
    public_struct_write_part(&statistics, sizeof statistics, out_statistics, struct_size);
}

void ag_rendering_growth_fill(const ag_rendering *r, void *out_growth, size_t struct_size)
{
    ag_growth growth = {0};
    if (r && r->maps && r->t.cache) {
        const photon_map *map = &r->maps->global;
        irradiance_cache_look(&r->maps->cache, &growth.irradiance_requests, &growth.irradiance_computed);
        growth.irradiance_photons = map->irradiance_photons.count;
        growth.photon_density = r->s->surface_area > 0.0f ? (double)map->tree.count / (double)r->s->surface_area : 0.0;
    }
    public_struct_write_part(&growth, sizeof growth, out_growth, struct_size);
}
