/* photon_aim.c: see photon_aim.h. */
#include "photon_aim.h"

#include "math/compare_floats.h"
#include "status.h"

#include <stdlib.h>

/* Paths of a round, as a share of the photons wanted and within bounds; the first round, by power alone, has half of
 * that, and more while hardly any path arrives; each further one follows what the rounds before have learned. */
enum { PHOTONS_PER_TRIAL = 8, ROUND_TRIALS_MIN = 1 << 12, ROUND_TRIALS_MAX = 1 << 16, ROUNDS = 4 };
/* Before these rounds another one follows the starts that were found from where light is requested, if there are at
 * least STARTS_LEAST. */
enum { ROUNDS_MAX = ROUNDS + 1, STARTS_LEAST = 64 };
enum { UNGUIDED_ROUNDS_MAX = 8, USEFUL_LEAST = 32 };
/* A guide that lowers the variance by less than this factor is not used, since uneven photon weights cost more. Nor is
 * one where, by power alone, this share of the photons is useful, and a path leaves this many useful ones. */
static const float LEAST_GAIN = 1.5f;
static const double ENOUGH_USEFUL = 0.5, ENOUGH_PER_PATH = 0.25;
/* Paths are split that are worth more than SPLIT_RATIO times the tenth percentile of the useful paths' worths, and so
 * much more that no more than about PARTS_PER_PATH come to one path. The first round with a guide splits above a high
 * percentile by power alone, and each further one above no less than a SPLIT_STEP of that, so that no round takes
 * long. */
static const float SPLIT_RATIO = 1.0f, PARTS_PER_PATH = 1.0f, SPLIT_STEP = 0.1f;
static const float LOW_PERCENTILE = 0.1f, HIGH_PERCENTILE = 0.9f;

typedef struct learner {
    const scene *s;
    run_context *run;
    photon_tracing_settings settings;
    const struct onward_ways *ways; /* of the settings; by power alone paths are not guided by them */
    float share;                    /* of the paths that follow a guide */
    emission_trial *trials;
    uint32_t count;                        /* of trials so far, of all rounds */
    uint32_t round_trials;                 /* of a round with a guide */
    uint32_t round;                        /* 0: by power alone; else that of guides */
    float split_above;                     /* of the next round, if it has a guide */
    float stored_share;                    /* of the last round */
    emission_guide guides[ROUNDS_MAX + 1]; /* by which the rounds were traced; then the last one */
    const emission_guide *starts_guide;    /* the one of them that was built from the starts; NULL: none */
    trial_counts counts, unguided;         /* of all trials; of those by power alone */
} learner;

static uint32_t last_round(const learner *l) { return l->starts_guide ? ROUNDS_MAX : ROUNDS; }

/* Sets what the next round splits by a round's trials, as bright as its guide made them, and by its number of parts. */
static ag_status set_split(learner *l, const emission_trial *trials, uint32_t count, uint64_t parts)
{
    uint32_t useful = 0;
    float *worths = malloc(count * sizeof *worths);
    if (!worths)
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        if (trials[i].value > 0.0f)
            worths[useful++] = trials[i].value / trials[i].density;
    qsort(worths, useful, sizeof *worths, compare_floats);
    if (useful > 0 && l->round == 0) {
        l->split_above = worths[(uint32_t)(HIGH_PERCENTILE * (float)useful)];
    } else if (useful > 0) {
        float by_worth = SPLIT_RATIO * worths[(uint32_t)(LOW_PERCENTILE * (float)useful)];
        float by_parts = l->split_above * (float)parts / (PARTS_PER_PATH * (float)count);
        float least = l->round == last_round(l) - 1 ? l->split_above : l->split_above * SPLIT_STEP;
        l->split_above = float_max(float_max(by_worth, by_parts), least);
    }
    free(worths);
    return AG_OK;
}

/* Photons of one path tell the same of how much light arrives. So up to so many paths are emitted for each photon that
 * is stored, and so large a share of them is stored at least. */
static const double PATHS_PER_PHOTON = 4.0, STORED_SHARE_LEAST = 0.25;

static float stored_share(uint64_t paths, double stored)
{
    double share = stored > 0.0 ? (double)paths / (PATHS_PER_PHOTON * stored) : 1.0;
    return (float)double_clamp(share, STORED_SHARE_LEAST, 1.0);
}

static float caustic_root(const learner *l)
{
    return l->counts.asked > 0 ? (float)(l->counts.roots / (double)l->counts.asked) : 0.0f;
}

static ag_status trace_round(learner *l, uint32_t count)
{
    trial_counts before = l->counts;
    emission_trial *trials = l->trials + l->count;
    l->settings.guide = &l->guides[l->round];
    l->settings.split_above = l->round > 0 ? l->split_above : 0.0f;
    l->settings.ways = l->round > 0 ? l->ways : NULL;
    l->settings.caustic_root = caustic_root(l);
    ag_status status = photon_tracing_try(l->s, l->run, &l->settings, l->count, count, trials, &l->counts);
    l->count += count;
    if (status == AG_OK && (l->settings.onward || l->settings.kind == PHOTON_CAUSTIC))
        status = set_split(l, trials, count, l->counts.parts - before.parts);
    l->stored_share = stored_share(l->counts.paths - before.paths, l->counts.stored - before.stored);
    return status;
}

static uint32_t least_of(uint32_t a, uint32_t b) { return a < b ? a : b; }

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

/* The guide of a further round, by the starts or by the trials before. */
static ag_status make_guide(learner *l, uint32_t round, const emission_starts *starts)
{
    emission_guide *next = &l->guides[round];
    if (round > 1 || starts->count < STARTS_LEAST)
        return emission_guide_create(l->trials, l->count, l->share, l->starts_guide, next);
    AG_TRY(emission_guide_create(starts->trials, starts->count, l->share, NULL, next));
    l->starts_guide = next;
    return AG_OK;
}

/* Returns the share of useful photons, each weighted by the root of its importance; 1 where light is requested
 * evenly. */
static double useful_share(const trial_counts *counts)
{
    double of_even = (double)counts->photons * counts->importance;
    return of_even > 0.0 ? counts->roots * counts->roots / of_even : 0.0;
}

/* Moves the last guide, and the one of the starts, which is borrowed by it, to the aim. */
static void hand_over_guides(learner *l, emission_guide *last, photon_aim *out_aim)
{
    out_aim->guide = *last;
    *last = (emission_guide){0};
    if (!l->starts_guide)
        return;
    out_aim->starts_guide = l->guides[1];
    out_aim->guide.other = &out_aim->starts_guide;
    l->guides[1] = (emission_guide){0};
}

/* Traces rounds of trials, by power alone and then by what those before have told, and makes the last guide of them
 * all, unless enough paths arrive without one, and without a focus. */
static ag_status learn(learner *l, const emission_starts *starts, photon_aim *out_aim)
{
    uint32_t counts[ROUNDS_MAX + 1] = {0};
    ag_status status = trace_round(l, l->round_trials / 2);
    while (status == AG_OK && count_useful(l) < USEFUL_LEAST && l->count < UNGUIDED_ROUNDS_MAX * l->round_trials)
        status = trace_round(l, least_of(l->count, UNGUIDED_ROUNDS_MAX * l->round_trials - l->count));
    counts[0] = l->count;
    l->unguided = l->counts;
    if (!l->settings.focus && useful_share(&l->unguided) >= ENOUGH_USEFUL &&
        (double)l->unguided.asked >= ENOUGH_PER_PATH * (double)l->unguided.paths)
        return status;
    for (uint32_t round = 1; status == AG_OK; round++) {
        emission_guide *next = &l->guides[round];
        AG_TRY(make_guide(l, round, starts));
        if (!next->nodes || (!l->settings.focus && next != l->starts_guide && next->gain < LEAST_GAIN))
            return AG_OK;
        if (round == last_round(l)) {
            hand_over_guides(l, next, out_aim);
            return AG_OK;
        }
        l->round = round;
        counts[round] = l->round_trials;
        status = trace_round(l, l->round_trials);
        weigh_trials(l, counts, round + 1);
    }
    return status;
}

/* Light is requested around the focus if the scene is so many times as large. */
static const float FOCUS_RATIO = 4.0f;

/* Returns the focus of the requests; NULL where it is no small part of what light from afar falls on, or where there is
 * no such light. */
static const light_target *focus_of(const scene *s, const importance_map *asked)
{
    float around = s->detail_radius > 0.0f ? s->detail_radius : s->bounding_radius;
    bool is_small = asked->focus.radius > 0.0f && FOCUS_RATIO * asked->focus.radius <= around;
    return is_small && s->everywhere_count > 0 ? &asked->focus : NULL;
}

void emission_starts_move(const scene *s, const importance_map *asked, emission_starts *in_out_starts)
{
    const light_target *focus = focus_of(s, asked);
    for (uint32_t i = 0; focus && i < in_out_starts->count; i++) {
        emission_start *start = &in_out_starts->trials[i].start;
        float probability;
        light_emission sent;
        const light *lamp = &s->lights[scene_pick_light_by_power(s, start->u[0], &probability)];
        emission_numbers numbers = emission_start_numbers(start, NULL);
        if (!light_is_everywhere(lamp) || !light_emit(s, lamp, NULL, &numbers, &sent))
            continue;
        const light_sample towards = {.direction = vec3_negate(sent.direction), .distance = INFINITY};
        numbers.focus = focus;
        if (light_emission_numbers(s, lamp, sent.origin, numbers.direction, &towards, &numbers))
            *start = emission_start_of(start->u[0], &numbers);
    }
}

/* The least that is worth an estimate, where power alone would store next to none. */
enum { WANTED_LEAST = 20000 };

/* Returns how many photons to store with a guide: as many as are wanted, or as tracing by power alone would have stored
 * before it gave up. */
static uint32_t wanted_by_power(const trial_counts *unguided, uint32_t wanted)
{
    double stored = (double)unguided->photons / (double)unguided->paths * PHOTON_PATHS_MAX * wanted;
    double most = double_max(stored, WANTED_LEAST);
    return most < (double)wanted ? (uint32_t)most : wanted;
}

uint32_t photon_aim_round_trials(uint64_t wanted)
{
    const uint64_t trials = wanted / PHOTONS_PER_TRIAL,
                   at_least = trials > ROUND_TRIALS_MIN ? trials : ROUND_TRIALS_MIN;
    return (uint32_t)(at_least < ROUND_TRIALS_MAX ? at_least : ROUND_TRIALS_MAX);
}

ag_status photon_aim_learn(const scene *s, run_context *run, const photon_tracing_settings *settings,
                           const emission_starts *starts, float share, photon_aim *out_aim)
{
    *out_aim = (photon_aim){.wanted = settings->wanted, .stored_share = 1.0f};
    if (!(share > 0.0f) || !settings->asked || !settings->asked->nodes)
        return AG_OK;
    learner l = {.s = s, .run = run, .settings = *settings, .ways = settings->ways, .share = share};
    l.settings.focus = focus_of(s, settings->asked);
    l.round_trials = photon_aim_round_trials(settings->wanted);
    l.trials = malloc((size_t)(UNGUIDED_ROUNDS_MAX + ROUNDS_MAX) * l.round_trials * sizeof *l.trials);
    ag_status status = l.trials ? learn(&l, starts, out_aim) : AG_ERROR_MEMORY;
    out_aim->tried = l.counts;
    if (out_aim->guide.nodes) {
        out_aim->focus = l.settings.focus;
        out_aim->wanted = wanted_by_power(&l.unguided, settings->wanted);
        out_aim->stored_share = settings->paths == 0 ? l.stored_share : 1.0f;
        out_aim->split_above = l.split_above;
        out_aim->caustic_root = l.settings.caustic_root; /* from the last round, which has set what is split */
    }
    for (int i = 0; i <= ROUNDS_MAX; i++)
        emission_guide_reset(&l.guides[i]);
    free(l.trials);
    return status;
}

void photon_aim_apply(const photon_aim *aim, photon_tracing_settings *in_out_settings)
{
    bool is_aimed = aim->guide.nodes;
    in_out_settings->guide = is_aimed ? &aim->guide : NULL;
    in_out_settings->focus = aim->focus;
    in_out_settings->asked = is_aimed ? in_out_settings->asked : NULL;
    in_out_settings->ways = is_aimed ? in_out_settings->ways : NULL;
    in_out_settings->wanted = aim->wanted;
    in_out_settings->stored_share = aim->stored_share;
    in_out_settings->split_above = aim->split_above;
    in_out_settings->caustic_root = aim->caustic_root;
}

void photon_aim_reset(photon_aim *aim)
{
    emission_guide_reset(&aim->guide);
    emission_guide_reset(&aim->starts_guide);
    *aim = (photon_aim){0};
}
