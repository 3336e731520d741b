/* light_pick.c: which light to sample: see scene.h. For a point of the scene each light that is everywhere has one
 * share, and the lamps together have one, which the light tree deals out; for photons it is power that counts. Rests
 * on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 12.6 (a fair share of infinite lights: how
 * much of them is hidden is not known). Threads: light_pick_commit by one thread; the rest read only. */
#include "light/light_pick.h"

#include "light/light_tree.h"
#include "light/light_type.h"
#include "status.h"

#include <stdlib.h>

/* The share of the photons that is divided evenly among all lights: a lamp in a room beside a sun that shines on all
 * the land would otherwise emit two or three, each as bright as the sun's. The sun's become brighter by a third at
 * most. */
static const double EVEN_SHARE = 0.25;

/* The mean of the channels: luminance would all but leave out blue lamps. */
static double mean_power(const light *l) { return ((double)l->power.r + l->power.g + l->power.b) / 3.0; }

static ag_status find_powers(scene *s, log_sink *log)
{
    uint32_t brightest = 0;
    for (uint32_t i = 0; i < s->light_count; i++) {
        AG_TRY(light_commit(s, &s->lights[i]));
        s->light_power = rgb_add(s->light_power, s->lights[i].power);
        if (!(mean_power(&s->lights[i]) <= mean_power(&s->lights[brightest])))
            brightest = i;
    }
    if (rgb_is_finite(s->light_power))
        return AG_OK;
    log_message(log, AG_LOG_ERROR,
                "the lights' power together is beyond what a float holds; the brightest is number %u of %u",
                brightest + 1, s->light_count);
    return AG_ERROR_SCENE;
}

static void deal_photons(scene *s)
{
    double total = 0.0, sum = 0.0, shares = 0.0;
    for (int pass = 0; pass < 3; pass++) {
        for (uint32_t i = 0; i < s->light_count; i++) {
            double power = mean_power(&s->lights[i]);
            if (pass == 0) {
                total += power;
                continue;
            }
            double share = power > 0.0 ? (1.0 - EVEN_SHARE) * power / total + EVEN_SHARE / s->lit_count : 0.0;
            share *= (double)s->lights[i].photons;
            if (pass == 1) {
                shares += share;
                continue;
            }
            sum += share;
            s->photon_probability[i] = shares > 0.0 ? (float)(share / shares) : 0.0f;
            s->photon_cdf[i] = shares > 0.0 ? (float)(sum / shares) : 0.0f;
        }
    }
}

ag_status light_pick_commit(scene *s, log_sink *log)
{
    if (s->light_count == 0)
        return AG_OK;
    AG_TRY(find_powers(s, log));
    uint32_t *lamps = malloc(s->light_count * sizeof *lamps), lamp_count = 0;
    s->photon_cdf = malloc(s->light_count * sizeof *s->photon_cdf);
    s->photon_probability = malloc(s->light_count * sizeof *s->photon_probability);
    s->infinite_lights = malloc(s->light_count * sizeof *s->infinite_lights);
    s->everywhere_lights = malloc(s->light_count * sizeof *s->everywhere_lights);
    if (!lamps || !s->photon_cdf || !s->photon_probability || !s->infinite_lights || !s->everywhere_lights) {
        free(lamps);
        return AG_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < s->light_count; i++) {
        const light *l = &s->lights[i];
        if (light_is_sky(l))
            s->infinite_lights[s->infinite_light_count++] = i;
        if (!(mean_power(l) > 0.0))
            continue;
        s->lit_count++;
        s->only_light = i;
        light_bounds bounds;
        if (light_find_bounds(s, l, &bounds))
            lamps[lamp_count++] = i;
        else
            s->everywhere_lights[s->everywhere_count++] = i;
    }
    ag_status status = lamp_count > 0 ? light_tree_create(s, lamps, lamp_count, &s->light_tree) : AG_OK;
    free(lamps);
    deal_photons(s);
    return status;
}

void light_pick_reset(scene *s)
{
    light_tree_destroy(s->light_tree);
    free(s->photon_cdf);
    free(s->photon_probability);
    free(s->infinite_lights);
    free(s->everywhere_lights);
}

/* --- for a point --- */

/* Whether a light that is everywhere may bring light from the side of the normal. */
static bool reaches(const light *l, vec3 point, vec3 normal)
{
    const light_type *type = light_type_of(l->kind);
    return !type->reaches || type->reaches(l, point, normal);
}

/* How many of those there are, and whether there are lamps. */
static uint32_t count_shares(const scene *s, vec3 point, vec3 normal, bool *out_has_lamps)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->everywhere_count; i++)
        count += reaches(&s->lights[s->everywhere_lights[i]], point, normal);
    *out_has_lamps = s->light_tree && light_tree_reaches(s->light_tree, point, normal);
    return count;
}

uint32_t scene_pick_light(const scene *s, vec3 point, vec3 normal, float u, float *out_probability)
{
    *out_probability = 1.0f;
    if (s->lit_count == 1)
        return s->only_light;
    if (s->everywhere_count == 0)
        return light_tree_pick(s->light_tree, point, normal, u, out_probability);
    bool has_lamps;
    uint32_t count = count_shares(s, point, normal, &has_lamps), shares = count + has_lamps;
    *out_probability = 0.0f;
    if (shares == 0)
        return 0;
    float scaled = u * (float)shares;
    uint32_t wanted = (uint32_t)scaled < shares ? (uint32_t)scaled : shares - 1;
    if (wanted == count) {
        u = float_below_one(scaled - (float)wanted);
        uint32_t lamp = light_tree_pick(s->light_tree, point, normal, u, out_probability);
        *out_probability /= (float)shares;
        return lamp;
    }
    uint32_t at = 0;
    while (!reaches(&s->lights[s->everywhere_lights[at]], point, normal) || wanted-- > 0)
        at++;
    *out_probability = 1.0f / (float)shares;
    return s->everywhere_lights[at];
}

float scene_light_probability(const scene *s, uint32_t light_index, vec3 point, vec3 normal)
{
    const light *l = &s->lights[light_index];
    if (!(mean_power(l) > 0.0))
        return 0.0f;
    if (s->lit_count == 1)
        return 1.0f;
    if (s->everywhere_count == 0)
        return light_tree_probability(s->light_tree, light_index, point, normal);
    bool has_lamps;
    uint32_t shares = count_shares(s, point, normal, &has_lamps);
    shares += has_lamps;
    if (light_is_everywhere(l))
        return reaches(l, point, normal) ? 1.0f / (float)shares : 0.0f;
    return has_lamps ? light_tree_probability(s->light_tree, light_index, point, normal) / (float)shares : 0.0f;
}

/* --- for photons --- */

bool scene_sends_photons(const scene *s) { return s->light_count > 0 && s->photon_cdf[s->light_count - 1] > 0.0f; }

uint32_t scene_pick_light_by_power(const scene *s, float u, float *out_probability)
{
    uint32_t low = 0, high = s->light_count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (s->photon_cdf[middle] > u)
            high = middle;
        else
            low = middle + 1;
    }
    while (low > 0 && s->photon_probability[low] == 0.0f) /* u beyond the last rounded sum */
        low--;
    *out_probability = s->photon_probability[low];
    return low;
}
