/* photon_aim.c: see photon_aim.h. */
#include "photon_aim.h"

#include <stdlib.h>

/* Paths of a round, as a share of the photons wanted and within bounds; the first round, by power alone, has half of
 * that, and more while hardly any path arrives; each further one follows what the rounds before have learned. */
enum { PHOTONS_PER_TRIAL = 8, ROUND_TRIALS_MIN = 1 << 12, ROUND_TRIALS_MAX = 1 << 16, ROUNDS = 4 };
enum { BLIND_ROUNDS_MAX = 8, USEFUL_LEAST = 32 };
/* A guide that lowers the variance by less than this is not worth its weights. Nor is one where by power alone so many
 * of the photons are of use, and a path leaves so many of those. */
static const float LEAST_GAIN = 1.5f;
static const double ENOUGH_ASKED = 0.5, ENOUGH_PER_PATH = 0.25;

typedef struct learner {
    const scene *s;
    run_context *run;
    photon_tracing_settings settings;
    float share;
    emission_trial *trials;
    uint32_t count, round_trials, round_count;
    emission_guide guides[ROUNDS + 1]; /* by which the rounds were traced; then the last one */
    trial_counts counts, blind;        /* of all trials; of those by power alone */
} learner;

static ag_status trace_round(learner *l, uint32_t count)
{
    l->settings.guide = &l->guides[l->round_count];
    ag_status status =
        photon_tracing_try(l->s, l->run, &l->settings, l->count, count, l->trials + l->count, &l->counts);
    l->count += count;
    return status;
}

static uint32_t count_useful(const learner *l)
{
    uint32_t useful = 0;
    for (uint32_t i = 0; i < l->count; i++)
        useful += l->trials[i].value > 0.0f;
    return useful;
}

/* Each trial counts by the density of all rounds together (Veach, Guibas 1995: the balance heuristic). */
static void weigh_trials(learner *l, const uint32_t counts[], uint32_t rounds)
{
    for (uint32_t i = 0; i < l->count; i++) {
        double density = 0.0;
        for (uint32_t r = 0; r < rounds; r++)
            density += (double)counts[r] * (double)emission_guide_density(&l->guides[r], &l->trials[i].start);
        l->trials[i].density = (float)(density / l->count);
    }
}

static ag_status learn(learner *l, emission_guide *out_guide)
{
    uint32_t counts[ROUNDS + 1] = {0};
    ag_status status = trace_round(l, l->round_trials / 2);
    while (status == AG_OK && count_useful(l) < USEFUL_LEAST && l->count < BLIND_ROUNDS_MAX * l->round_trials)
        status = trace_round(l, l->count);
    counts[0] = l->count;
    l->blind = l->counts;
    double asked = (double)l->counts.asked;
    if (asked >= ENOUGH_ASKED * (double)l->counts.photons && asked >= ENOUGH_PER_PATH * (double)l->counts.paths)
        return status;
    for (uint32_t round = 1; status == AG_OK; round++) {
        emission_guide *next = &l->guides[round];
        status = emission_guide_create(l->trials, l->count, l->share, next);
        if (status != AG_OK)
            return status;
        if (!next->nodes || next->gain < LEAST_GAIN)
            return AG_OK;
        if (round == ROUNDS) {
            *out_guide = *next;
            *next = (emission_guide){0};
            return AG_OK;
        }
        l->round_count = round;
        counts[round] = l->round_trials;
        status = trace_round(l, l->round_trials);
        weigh_trials(l, counts, round + 1);
    }
    return status;
}

/* The least that is worth an estimate, where power alone would store next to none. */
enum { WANTED_LEAST = 20000 };

static uint32_t fewer_by_power(const trial_counts *blind, uint32_t wanted)
{
    double stored = (double)blind->photons / (double)blind->paths * PHOTON_PATHS_MAX * wanted;
    double most = fmax(stored, WANTED_LEAST);
    return most < (double)wanted ? (uint32_t)most : wanted;
}

ag_status photon_aim_learn(const scene *s, run_context *run, const photon_tracing_settings *settings, float share,
                           emission_guide *out_guide, trial_counts *out_counts, uint32_t *out_wanted)
{
    *out_guide = (emission_guide){0};
    *out_counts = (trial_counts){0};
    *out_wanted = settings->wanted;
    if (!(share > 0.0f) || !settings->asked || !settings->asked->nodes)
        return AG_OK;
    learner l = {.s = s, .run = run, .settings = *settings, .share = share};
    l.round_trials = settings->wanted / PHOTONS_PER_TRIAL;
    if (l.round_trials < ROUND_TRIALS_MIN)
        l.round_trials = ROUND_TRIALS_MIN;
    if (l.round_trials > ROUND_TRIALS_MAX)
        l.round_trials = ROUND_TRIALS_MAX;
    l.trials = malloc((size_t)(BLIND_ROUNDS_MAX + ROUNDS) * l.round_trials * sizeof *l.trials);
    ag_status status = l.trials ? learn(&l, out_guide) : AG_ERROR_MEMORY;
    *out_counts = l.counts;
    if (out_guide->nodes)
        *out_wanted = fewer_by_power(&l.blind, settings->wanted);
    for (int i = 0; i <= ROUNDS; i++)
        emission_guide_reset(&l.guides[i]);
    free(l.trials);
    return status;
}
