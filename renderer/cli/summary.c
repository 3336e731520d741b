/* summary.c: see summary.h. */
#include "summary.h"

#include <stdint.h>

/* 1234567 as "1.23 M". */
static void print_count(FILE *file, const char *name, uint64_t count)
{
    static const char *const units[] = {"", " k", " M", " G", " T"};
    double value = (double)count;
    int unit = 0;
    while (value >= 1000.0 && unit < 4) {
        value /= 1000.0;
        unit++;
    }
    if (count > 0)
        fprintf(file, "  %-24s %10.*f%s\n", name, unit == 0 ? 0 : 2, value, units[unit]);
}

static void print_share(FILE *file, const char *name, double seconds, double whole)
{
    if (seconds > 0.0)
        fprintf(file, "  %-24s %10.2f s %5.1f %%\n", name, seconds, 100.0 * seconds / whole);
}

void summary_print(FILE *file, const ag_statistics *s)
{
    double others = s->time_total_s;
    fprintf(file, "time\n");
    for (int i = 0; i < AG_PHASE_COUNT; i++) {
        print_share(file, ag_phase_name((ag_phase)i), s->time_s[i], s->time_total_s);
        others -= s->time_s[i];
    }
    print_share(file, "other", others, s->time_total_s);
    print_share(file, "total", s->time_total_s, s->time_total_s);
    fprintf(file, "  %-24s %10.2f s, %u threads\n", "processor", s->cpu_s, s->threads);
    fprintf(file, "rays\n");
    print_count(file, "camera", s->rays_camera);
    print_count(file, "shadow", s->rays_shadow);
    print_count(file, "gather", s->rays_gather);
    print_count(file, "photon", s->rays_photon);
    print_count(file, "path", s->rays_path);
    print_count(file, "estimate", s->rays_estimate);
    if (s->photons_emitted > 0) {
        fprintf(file, "photons\n");
        print_count(file, "paths", s->photons_emitted);
        print_count(file, "in the global map", s->photons_stored_global);
        print_count(file, "in the caustic map", s->photons_stored_caustic);
        fprintf(file, "irradiance\n");
        print_count(file, "asked for", s->irradiance_requests);
        print_count(file, "computed at photons", s->irradiance_computed);
        if (s->irradiance_kept > 0)
            print_count(file, "kept from last frame", s->irradiance_kept);
        print_count(file, "computed elsewhere", s->irradiance_uncached);
        print_count(file, "deferred", s->irradiance_deferred);
        print_count(file, "waited for", s->irradiance_waited);
    }
    fprintf(file, "memory\n  %-24s %10.1f MB\n", "peak", (double)s->memory_peak_bytes / 1e6);
    if (s->photon_bytes > 0)
        fprintf(file, "  %-24s %10.1f MB\n", "photon maps", (double)s->photon_bytes / 1e6);
    if (s->texture_whole_bytes > 0)
        fprintf(file, "  %-24s %10.1f MB\n", "textures", (double)s->texture_whole_bytes / 1e6);
    if (s->texture_file_bytes > 0) {
        fprintf(file, "  %-24s %10.1f MB\n", "tiles of textures", (double)s->texture_tile_bytes / 1e6);
        fprintf(file, "  %-24s %10.1f MB\n", "their temporary file", (double)s->texture_file_bytes / 1e6);
    }
}

void summary_print_prediction(FILE *file, const ag_prediction *p, uint64_t texture_file_bytes)
{
    fprintf(file, "time, on this machine idle\n");
    for (int i = 0; i < AG_PHASE_COUNT; i++)
        print_share(file, ag_phase_name((ag_phase)i), p->time_s[i], p->time_total_s);
    print_share(file, "total", p->time_total_s, p->time_total_s);
    fprintf(file, "  %-24s %10.2f s\n  %-24s %10.1f\n", "processor", p->cpu_s, "samples per pixel",
            p->samples_per_pixel);
    fprintf(file, "memory\n  %-24s %10.1f MB\n", "peak", (double)p->memory_peak_bytes / 1e6);
    const struct {
        const char *name;
        uint64_t bytes;
    } parts[] = {{"program and scene", p->memory_scene_bytes},
                 {"photon maps", p->memory_photon_bytes},
                 {"threads", p->memory_thread_bytes},
                 {"film", p->memory_film_bytes},
                 {"showing it meanwhile", p->memory_host_bytes},
                 {"a file on its way", p->memory_file_bytes}};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        fprintf(file, "  %-24s %10.1f MB\n", parts[i].name, (double)parts[i].bytes / 1e6);
    if (texture_file_bytes > 0)
        fprintf(file, "disk\n  %-24s %10.1f MB\n", "textures, in $TMPDIR", (double)texture_file_bytes / 1e6);
}
