/* bench_json.c: see bench_json.h. */
#include "bench/bench_json.h"

#include "bench/bench_score.h"

#include <math.h>
#include <stdio.h>

static json_t *number(double value) { return isfinite(value) ? json_real(value) : json_null(); }
static json_t *count(uint64_t value) { return json_integer((json_int_t)value); }
/* 0 and "" stand for what the system does not tell. */
static json_t *told(double value) { return value > 0.0 ? number(value) : json_null(); }
static json_t *told_text(const char *text) { return text[0] ? json_string(text) : json_null(); }

static json_t *interval_json(bench_interval i)
{
    return json_pack("{s:o, s:o, s:o, s:o}", "median", number(i.median), "least", number(i.least), "most",
                     number(i.most), "spread", number(bench_spread(i)));
}

static json_t *turns_json(const double *values, unsigned turns)
{
    json_t *list = json_array();
    for (unsigned i = 0; i < turns; i++)
        json_array_append_new(list, number(values[i]));
    return list;
}

/* --- the machine and the build --- */

static json_t *machine_json(const bench_run *run)
{
    const bench_machine *m = &run->machine;
    return json_pack("{s:s, s:o, s:o, s:i, s:i, s:i, s:i, s:i, s:o, s:o, s:o, s:o, s:o}", "cpu", m->cpu_name, "maker",
                     told_text(m->maker), "system", told_text(m->kernel), "threads", (int)m->cpu_count, "cores",
                     (int)m->core_count, "packages", (int)m->package_count, "numa_nodes", (int)m->numa_count,
                     "threads_allowed", (int)m->entitled, "memory_bytes", told((double)m->memory_bytes),
                     "clock_least_mhz", told(run->clock_least_mhz), "clock_most_mhz", told(run->clock_most_mhz),
                     "clock_is_fixed", m->clock_is_fixed < 0 ? json_null() : json_boolean(m->clock_is_fixed),
                     "governor", told_text(m->governor));
}

static json_t *build_json(const bench_build *b)
{
    return json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:s}", "version", ag_version(), "sources", b->sources, "compiler",
                     b->compiler, "embree", b->embree, "libm", b->libm, "isa", b->isa, "maker", b->maker);
}

static json_t *levels_json(const bench_run *run)
{
    json_t *list = json_array();
    for (unsigned i = 0; i < run->level_count; i++) {
        const bench_level *l = &run->levels[i];
        json_array_append_new(list, json_pack("{s:i, s:i, s:i, s:b, s:b, s:b, s:o, s:o, s:o}", "threads",
                                              (int)l->threads, "cores", (int)l->cores, "numa_nodes", (int)l->numa_nodes,
                                              "pinned", l->is_pinned, "oversubscribed", l->is_oversubscribed,
                                              "all_phases", l->has_all_phases, "arithmetic_per_s",
                                              interval_json(bench_interval_of(l->arithmetic, run->turns)),
                                              "arithmetic_share", number(l->arithmetic_share), "memory_bytes_per_s",
                                              interval_json(bench_interval_of(l->memory, run->turns))));
    }
    return list;
}

/* --- parts --- */

static json_t *part_json(const bench_run *run, bench_scene where, bench_phase phase, unsigned level)
{
    const bench_part *p = &run->parts[where][phase][level];
    bench_scaling s = bench_scaling_of(run, where, phase, level);
    char hash[33];
    bench_hash_text(p->hash, hash);
    json_t *part = json_pack(
        "{s:s, s:s, s:i, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:s, s:o, s:o}", "scene",
        bench_scene_name(where), "phase", bench_phase_name(phase), "threads", (int)run->levels[level].threads, "item",
        bench_phase_item(phase), "items", count(p->items), "units", count(p->units), "seconds", number(p->seconds),
        "cpu_s", number(p->cpu_s), "rate", interval_json(bench_interval_of(p->rate, run->turns)), "turns",
        turns_json(p->rate, run->turns), "speedup", number(s.speedup), "efficiency", number(s.efficiency),
        "efficiency_of_arithmetic", number(s.of_arithmetic), "efficiency_of_memory", number(s.of_memory), "hash", hash,
        "count", count(p->count), "duplicated", count(p->duplicated));
    if (!part)
        return NULL;
    bool known = p->counts.is_known;
    json_object_set_new(part, "cycles", known ? count(p->counts.cycles) : json_null());
    json_object_set_new(part, "instructions", known ? count(p->counts.instructions) : json_null());
    if (phase != BENCH_PHASE_FRAME)
        return part;
    double requests = (double)p->requests;
    json_object_set_new(part, "requests", count(p->requests));
    json_object_set_new(part, "computed", count(p->computed));
    json_object_set_new(part, "deferred", count(p->deferred));
    json_object_set_new(part, "waited", count(p->waited));
    json_object_set_new(part, "waiting_share", number(p->cpu_s > 0.0 ? p->waited_s / p->cpu_s : 0.0));
    json_object_set_new(part, "cache_hits", number(requests > 0.0 ? 1.0 - (double)p->computed / requests : 0.0));
    return part;
}

static json_t *parts_json(const bench_run *run)
{
    json_t *list = json_array();
    for (int where = 0; where < BENCH_SCENE_COUNT; where++)
        for (int phase = 0; phase < BENCH_PHASE_COUNT; phase++)
            for (unsigned level = 0; level < run->level_count; level++)
                if (run->parts[where][phase][level].is_measured)
                    json_array_append_new(list, part_json(run, (bench_scene)where, (bench_phase)phase, level));
    return list;
}

/* --- certificate and scores --- */

void bench_certify(const bench_run *run, const bench_build *build, certificate *out)
{
    enum { ENTRIES_MAX = BENCH_SCENE_COUNT * BENCH_PHASE_COUNT * BENCH_LEVELS_MAX };
    static certificate_entry entries[ENTRIES_MAX];
    unsigned entry_count = 0;
    for (int where = 0; where < BENCH_SCENE_COUNT; where++)
        for (int phase = 0; phase < BENCH_PHASE_COUNT; phase++)
            for (unsigned level = 0; level < run->level_count; level++) {
                const bench_part *p = &run->parts[where][phase][level];
                if (p->is_measured)
                    entries[entry_count++] = (certificate_entry){bench_scene_name((bench_scene)where),
                                                                 bench_phase_name((bench_phase)phase),
                                                                 run->levels[level].threads,
                                                                 p->hash,
                                                                 p->count,
                                                                 p->expected,
                                                                 p->duplicated,
                                                                 p->is_steady,
                                                                 p->is_sound};
            }
    hash128 hash;
    bool is_known = bench_known_hash(build, bench_size_name(run->size), &hash);
    certificate_judge(entries, entry_count, is_known ? &hash : NULL, out);
}

static json_t *certificate_json(const certificate *c)
{
    static const char *const known[] = {"unknown", "matches", "differs"};
    char hash[33];
    json_t *reasons = json_array();
    bench_hash_text(c->hash, hash);
    for (unsigned i = 0; i < c->reason_count; i++)
        json_array_append_new(reasons, json_string(c->reasons[i]));
    return json_pack("{s:b, s:s, s:s, s:o, s:o}", "valid", c->is_valid, "hash", hash, "known_build", known[c->known],
                     "duplicated", count(c->duplicated), "reasons", reasons);
}

static json_t *scores_json(const bench_run *run, unsigned level)
{
    json_t *phases = json_object();
    for (int phase = 0; phase < BENCH_PHASE_COUNT; phase++)
        json_object_set_new(phases, bench_phase_name((bench_phase)phase),
                            interval_json(bench_score(run, (bench_phase)phase, level)));
    bench_interval whole = bench_score(run, BENCH_PHASE_FRAME, level);
    return json_pack("{s:i, s:o, s:b, s:o}", "threads", (int)run->levels[level].threads, "whole", interval_json(whole),
                     "steady", bench_spread(whole) <= BENCH_SPREAD_MOST, "phases", phases);
}

static json_t *refusals_json(const bench_run *run, const certificate *c, bool *out_is_busy)
{
    json_t *refused = json_array();
    char reasons[BENCH_LOAD_REASONS_MAX][BENCH_LOAD_REASON_SIZE];
    unsigned busy = bench_load_judge(&run->load, bench_arithmetic_share(run), reasons);
    *out_is_busy = run->size != BENCH_QUICK && busy > 0;
    if (!c->is_valid)
        json_array_append_new(refused, json_string("the certificate is not valid"));
    if (run->size == BENCH_QUICK)
        json_array_append_new(refused, json_string("the quick size times nothing"));
    for (unsigned i = 0; i < busy && *out_is_busy; i++)
        json_array_append_new(refused, json_string(reasons[i]));
    return refused;
}

json_t *bench_json(const bench_run *run, const bench_build *build, const certificate *c)
{
    bool is_busy;
    json_t *refused = refusals_json(run, c, &is_busy);
    bool has_score = json_array_size(refused) == 0;
    const bench_load *load = &run->load;
    return json_pack("{s:s, s:i, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:b, s:o}", "program",
                     "afterglow-bench", "format", BENCH_FORMAT, "size", bench_size_name(run->size), "machine",
                     machine_json(run), "build", build_json(build), "certificate", certificate_json(c), "score_one",
                     has_score ? scores_json(run, 0) : json_null(), "score_best",
                     has_score ? scores_json(run, bench_best_level(run)) : json_null(), "refused", refused, "load",
                     json_pack("{s:o, s:o, s:o, s:o, s:o}", "others_share",
                               load->is_known ? number(load->others_share) : json_null(), "stolen_share",
                               load->is_known ? number(load->stolen_share) : json_null(), "involuntary_per_cpu_s",
                               number(load->involuntary_rate), "arithmetic_share", number(bench_arithmetic_share(run)),
                               "elapsed_s", number(load->elapsed_s)),
                     "seconds", number(run->seconds), "levels", levels_json(run), "busy", is_busy, "parts",
                     parts_json(run));
}

/* "215 on 8", or "215 (210 to 220) on 8"; "-" where there is none. */
static void describe_score(const json_t *score, char *out, size_t size)
{
    const json_t *whole = json_object_get(score, "whole");
    double median = json_number_value(json_object_get(whole, "median"));
    char interval[48] = "";
    if (!json_is_true(json_object_get(score, "steady")))
        snprintf(interval, sizeof interval, " (%.0f to %.0f)", json_number_value(json_object_get(whole, "least")),
                 json_number_value(json_object_get(whole, "most")));
    if (whole)
        snprintf(out, size, "%.0f%s on %d", median, interval,
                 (int)json_integer_value(json_object_get(score, "threads")));
    else
        snprintf(out, size, "-");
}

void bench_line(const json_t *result, char *out_line, size_t size)
{
    char one[96], best[96];
    const json_t *machine = json_object_get(result, "machine"), *c = json_object_get(result, "certificate");
    describe_score(json_object_get(result, "score_one"), one, sizeof one);
    describe_score(json_object_get(result, "score_best"), best, sizeof best);
    snprintf(out_line, size, "| %s | %d cores, %d threads | %s | %s | %s | %s, %.8s |",
             json_string_value(json_object_get(machine, "cpu")),
             (int)json_integer_value(json_object_get(machine, "cores")),
             (int)json_integer_value(json_object_get(machine, "threads")),
             json_string_value(json_object_get(result, "size")), one, best,
             json_is_true(json_object_get(c, "valid")) ? "valid" : "NOT VALID",
             json_string_value(json_object_get(c, "hash")));
}
