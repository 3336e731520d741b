/* noise_hint.c: how noisy the picture is, and what would help most, in words.
 * Flow: film/noise.h -> [here] -> the program's last lines. Threads: as in afterglow.h. */
#include "integrator/integrator.h"
#include "light/light.h"
#include "public_structs.h"
#include "rendering.h"

#include <stdio.h>

/* A part of light that brings this share of the noise is what is to be helped first. */
static const double MOST = 0.5;
/* Noise below this is half a step of eight bits, and is not told. */
static const double NEGLIGIBLE = 0.002;
/* A sky that lights a smaller share of the samples than this comes in by windows. */
static const double FEW_WINDOWS = 0.4;

/* Whether a sky comes from everywhere: its samples know nothing of windows. A sky that picks directions by numbers
 * picks them alike at all places; one that does not, as behind a portal, picks them by place. */
static bool has_open_sky(const scene *s)
{
    for (uint32_t i = 0; i < s->infinite_light_count; i++)
        if (light_has_direction_numbers(&s->lights[s->infinite_lights[i]]))
            return true;
    return false;
}

/* The words for where the noise is and what helps. */
typedef struct advice {
    const char *where, *help;
} advice;

static const char MORE_SAMPLES[] = "more samples (--spp) help most";

static const char *find_windows_help(const struct ag_rendering *r)
{
    if (!has_open_sky(r->s))
        return MORE_SAMPLES;
    return r->settings.direct_guiding > 0.0f ? "a \"portal\" of the infinite light at each window helps most"
                                             : "guided shadow rays (--direct-guiding) help most";
}

static advice advise(const struct ag_rendering *r, ag_noise_source source, const noise_summary *noise)
{
    bool is_path = !integrator_of(r->settings.integrator)->has_photon_map;
    switch (source) {
    case AG_NOISE_EMISSION: return (advice){"at the edges of lamps and of the sky", MORE_SAMPLES};
    case AG_NOISE_LAMPS: return (advice){"in direct light from lamps", MORE_SAMPLES};
    case AG_NOISE_SKY:
        if (noise->sky_seen >= FEW_WINDOWS)
            return (advice){"in direct light from the sky", MORE_SAMPLES};
        return (advice){"in direct light from the sky, which comes in by few windows", find_windows_help(r)};
    case AG_NOISE_INDIRECT:
        if (is_path)
            return (advice){"in indirect light", "--integrator photonmap helps most"};
        return (advice){"in indirect light",
                        r->film->splits ? MORE_SAMPLES : "more gather rays (--gather-samples) help most"};
    case AG_NOISE_CAUSTIC:
        if (is_path)
            return (advice){"in caustics", "--integrator photonmap helps most"};
        return (advice){"in caustics", noise->is_caustic_grain
                                           ? "more photons (--caustic-photons, and --nearest with them) help most"
                                           : MORE_SAMPLES};
    case AG_NOISE_SPECULAR: return (advice){"in reflections and glass", MORE_SAMPLES};
    }
    return (advice){0};
}

static ag_noise noise_of(const ag_rendering *r)
{
    phase_begin begin = context_begin_phase();
    int nearest = r->t.caustic && r->t.caustic->set.count > 0 ? r->settings.nearest : 0;
    noise_summary summary = noise_lattice_read(&r->film->noise, noise_shown_scale(&r->settings), nearest);
    context_add_to_phase(r->context, AG_PHASE_RENDER, begin);
    ag_noise out = {.level = summary.level};
    int most = 0;
    for (int i = 0; i < AG_NOISE_SOURCE_COUNT; i++) {
        out.share[i] = summary.share[i];
        if (out.share[i] > out.share[most])
            most = i;
    }
    if (!(summary.level_with_grain > NEGLIGIBLE))
        return out;
    advice a = advise(r, (ag_noise_source)most, &summary);
    snprintf(out.hint, sizeof out.hint, "%s of the noise (%.0f %%) is %s: %s",
             out.share[most] >= MOST ? "most" : "the largest part", 100.0 * out.share[most], a.where, a.help);
    return out;
}

void ag_rendering_noise_fill(const ag_rendering *r, void *out_noise, size_t struct_size)
{
    const ag_noise noise = r ? noise_of(r) : (ag_noise){.level = -1.0};
    public_struct_write_part(&noise, sizeof noise, out_noise, struct_size);
}
