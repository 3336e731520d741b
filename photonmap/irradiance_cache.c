/* irradiance_cache.c: see irradiance_cache.h; the protocol is irradiance_slot.h's.
 * Threads: any number ask at once; each has counters and scratch memory of its own. */
#define _POSIX_C_SOURCE 200809L
#include "irradiance_cache.h"

#include "clock.h"
#include "parallel_for.h"

#include <sched.h>
#include <stdlib.h>

enum { PRECOMPUTE_BLOCK = 512 };
/* A rendering takes less memory than that for each worker after the cache has been made. */
static const uint64_t SPARE_BYTES_PER_WORKER = (uint64_t)12 << 20;
/* Reading a thread's CPU time is a system call, so that one of this many estimates is timed. */
enum { TIMED_EVERY = 16 };

static bool scratch_create(irradiance_scratch *s, const photon_map *map)
{
    s->neighbors = malloc(photon_map_scratch_count(map) * sizeof *s->neighbors);
    s->order[0] = malloc(IRRADIANCE_BATCH_MAX * sizeof *s->order[0]);
    s->order[1] = malloc(IRRADIANCE_BATCH_MAX * sizeof *s->order[1]);
    s->leaves = malloc(IRRADIANCE_BATCH_MAX * sizeof *s->leaves);
    s->distances_squared = malloc(IRRADIANCE_BATCH_MAX * sizeof *s->distances_squared);
    return s->neighbors && s->order[0] && s->order[1] && s->leaves && s->distances_squared;
}

static void scratch_reset(irradiance_scratch *s)
{
    free(s->neighbors);
    free(s->order[0]);
    free(s->order[1]);
    free(s->leaves);
    free(s->distances_squared);
}

ag_status irradiance_cache_create(photon_map *map, irradiance_cache_mode mode, unsigned worker_count,
                                  irradiance_cache *out_cache)
{
    irradiance_cache c = {.map = map, .mode = mode, .worker_count = worker_count};
    c.counters = aligned_alloc(_Alignof(irradiance_counters), worker_count * sizeof *c.counters);
    c.shown = aligned_alloc(_Alignof(irradiance_shown), worker_count * sizeof *c.shown);
    c.scratch = calloc(worker_count, sizeof *c.scratch);
    bool is_complete = c.counters && c.shown && c.scratch;
    for (unsigned i = 0; is_complete && i < worker_count; i++) {
        c.counters[i] = (irradiance_counters){0};
        store_relaxed_u64(&c.shown[i].requests, 0);
        store_relaxed_u64(&c.shown[i].computed, 0);
        is_complete = scratch_create(&c.scratch[i], map);
    }
    if (!is_complete) {
        irradiance_cache_reset(&c);
        return AG_ERROR_MEMORY;
    }
    photon_map_make_spaces(map, worker_count * SPARE_BYTES_PER_WORKER);
    if (map->has_been_cached)
        c.ready_before = photon_map_count_ready(map);
    map->has_been_cached = true;
    *out_cache = c;
    return AG_OK;
}

void irradiance_cache_reset(irradiance_cache *cache)
{
    for (unsigned i = 0; cache->scratch && i < cache->worker_count; i++)
        scratch_reset(&cache->scratch[i]);
    free(cache->scratch);
    free(cache->counters);
    free(cache->shown);
    *cache = (irradiance_cache){0};
}

/* Estimates the irradiance at a point, and counts and times that for the worker. leaf: the leaf of the map's tree that
 * has a photon at the point, or PHOTON_NONE. out_reach_squared may be NULL. */
static irradiance_extent estimate(irradiance_cache *cache, uint32_t leaf, vec3 position, vec3 normal,
                                  unsigned worker_index, rgb *out_irradiance, float *out_reach_squared)
{
    irradiance_counters *counters = &cache->counters[worker_index];
    irradiance_scratch *scratch = &cache->scratch[worker_index];
    scratch->hint.leaf = leaf;
    bool is_timed = (counters->computed + counters->uncached) % TIMED_EVERY == 0;
    double begin = is_timed ? clock_thread_cpu_seconds() : 0.0;
    irradiance_extent extent =
        irradiance_estimate_find_reach(cache->map, position, normal, scratch->neighbors, &scratch->hint,
                                       &counters->rays, out_irradiance, out_reach_squared);
    if (is_timed) {
        counters->timed_seconds += clock_thread_cpu_seconds() - begin;
        counters->timed++;
    }
    return extent;
}

/* Estimates the irradiance at a point that no photon stands for. Returns whether the estimate holds there. */
static bool estimate_at_point(irradiance_cache *cache, vec3 position, vec3 normal, unsigned worker_index,
                              rgb *out_irradiance)
{
    bool holds =
        estimate(cache, PHOTON_NONE, position, normal, worker_index, out_irradiance, NULL) != IRRADIANCE_HOLDS_NOWHERE;
    cache->counters[worker_index].uncached++;
    return holds;
}

void irradiance_cache_share(irradiance_cache *cache, claim_owners *owners) { cache->owners = owners; }

/* Returns the number that the worker writes into its claims: its own, or in a shared map that of its process. */
static uint32_t claimer_of(const irradiance_cache *cache, unsigned worker_index)
{
    return cache->owners ? load_relaxed_u32(&cache->owners->claimer) : worker_index;
}

/* Makes a word final, and before that its check byte. Returns false where the claim was not the claimer's any more. */
static bool publish(const photon_map *map, uint32_t index, uint32_t claimer, uint32_t word)
{
    if (map->checks)
        store_relaxed_u8(&map->checks[index], irradiance_word_check(index, word));
    return irradiance_slot_publish(photon_map_slot(map, index), claimer, word);
}

/* Computes and publishes the irradiance of a photon that the worker has claimed under that number. Returns the slot's
 * word. */
static uint32_t compute(irradiance_cache *cache, uint32_t index, uint32_t claimer, unsigned worker_index)
{
    const photon_map *map = cache->map;
    const photon_block *blocks = map->irradiance_photons.blocks;
    rgb irradiance;
    uint32_t leaf = photon_map_index(map, index) / PHOTON_BLOCK_LANES;
    irradiance_extent extent = estimate(cache, leaf, photon_block_position(blocks, index),
                                        direction_decode(photon_block_normal(blocks, index)), worker_index, &irradiance,
                                        map->reaches_squared ? &map->reaches_squared[index] : NULL);
    uint32_t word = irradiance_estimate_word(map, index, extent, irradiance);
    if (publish(map, index, claimer, word)) {
        cache->counters[worker_index].computed++;
        store_relaxed_u64(&cache->shown[worker_index].computed, cache->counters[worker_index].computed);
    } else {
        cache->counters[worker_index].duplicated++;
        claim_owners_renew(cache->owners, claimer); /* only in a shared map can a claim be lost */
    }
    return word;
}

/* Returns the word of an irradiance photon. Where nobody has claimed it, it is computed first; where another thread
 * has, it need not be ready. */
static uint32_t demand(irradiance_cache *cache, uint32_t irradiance_photon, unsigned worker_index)
{
    irradiance_slot *slot = photon_map_slot(cache->map, irradiance_photon);
    uint32_t word = irradiance_slot_read(slot), claimer = claimer_of(cache, worker_index);
    if (irradiance_word_state(word) == IRRADIANCE_EMPTY && irradiance_slot_try_claim(slot, claimer, &word))
        word = compute(cache, irradiance_photon, claimer, worker_index);
    return word;
}

/* Waits for the word of a photon that another thread is computing, and returns it; where the run is cancelled
 * meanwhile, the word may be any. No claim is held while waiting; one that is taken over is computed at once. */
static uint32_t await(irradiance_cache *cache, const run_context *run, uint32_t index, unsigned worker_index)
{
    irradiance_slot *slot = photon_map_slot(cache->map, index);
    claim_wait wait = {0};
    uint32_t word = irradiance_slot_read(slot);
    while (!irradiance_word_is_ready(word) && !(run && run_is_cancelled(run))) {
        if (!cache->owners) {
            sched_yield(); /* the claimer may need this processor */
        } else if (claim_owners_wait(cache->owners, &wait, word)) {
            uint32_t claimer = claimer_of(cache, worker_index); /* read after the wait, in which it may be renewed */
            if (irradiance_slot_take_over(slot, &word, claimer)) {
                cache->counters[worker_index].reclaimed++;
                return compute(cache, index, claimer, worker_index);
            }
        }
        word = irradiance_slot_read(slot);
    }
    return word;
}

typedef struct precompute_job {
    irradiance_cache *cache;
    run_context *run;
} precompute_job;

static void precompute_block(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker_index)
{
    (void)block;
    const precompute_job *job = user;
    irradiance_cache *cache = job->cache;
    for (uint64_t i = begin; i < end && !run_is_cancelled(job->run); i++) {
        demand(cache, (uint32_t)i, worker_index);
        run_look(job->run); /* searches in what is left of a lost map are slow */
    }
    /* other processes may still be computing some, or have died over them; no claim is held while waiting for those */
    for (uint64_t i = begin; cache->owners && i < end && !run_is_cancelled(job->run); i++)
        await(cache, job->run, (uint32_t)i, worker_index);
}

ag_status irradiance_cache_precompute(irradiance_cache *cache, run_context *run)
{
    precompute_job job = {cache, run};
    ag_status status = parallel_for(run, cache->map->irradiance_photons.count, PRECOMPUTE_BLOCK, precompute_block, &job,
                                    AG_PHASE_PRECOMPUTE, 0.0, 1.0);
    return status == AG_OK && run_is_cancelled(run) ? AG_CANCELLED : status;
}

void irradiance_cache_save(const irradiance_cache *cache, uint32_t *out_words)
{
    for (uint32_t i = 0; i < cache->map->irradiance_photons.count; i++) {
        uint32_t word = irradiance_slot_read(photon_map_slot(cache->map, i));
        out_words[i] = irradiance_word_is_ready(word) ? word : 0;
    }
}

void irradiance_cache_restore(irradiance_cache *cache, const uint32_t *words)
{
    uint64_t ready = photon_map_count_ready(cache->map);
    for (uint32_t i = 0; i < cache->map->irradiance_photons.count; i++) {
        uint32_t found;
        irradiance_slot *slot = photon_map_slot(cache->map, i);
        uint32_t claimer = claimer_of(cache, 0);
        if (irradiance_word_is_ready(words[i]) && irradiance_slot_try_claim(slot, claimer, &found))
            publish(cache->map, i, claimer, words[i]);
    }
    cache->ready_before += photon_map_count_ready(cache->map) - ready;
}

/* Answers a query that no photon stands for: by an estimate at the point where there is none near (PHOTON_NONE), and by
 * nothing where the nearest one is out of sight (PHOTON_HIDDEN). Returns whether there is an answer. */
static bool answer_without_photon(irradiance_cache *cache, const irradiance_query *query, uint32_t nearest,
                                  unsigned worker_index, rgb *out_irradiance)
{
    bool holds = nearest == PHOTON_NONE &&
                 estimate_at_point(cache, query->position, query->normal, worker_index, out_irradiance);
    if (!holds)
        *out_irradiance = rgb_gray(0.0f);
    cache->counters[worker_index].refused += !holds;
    return holds;
}

/* Answers a query by an irradiance photon, at that squared distance, whose word is ready. Returns whether there is an
 * answer. */
static bool answer_by_word(irradiance_cache *cache, const irradiance_query *query, uint32_t irradiance_photon,
                           float distance_squared, uint32_t word, unsigned worker_index, rgb *out_irradiance)
{
    const photon_map *map = cache->map;
    uint32_t value = word & IRRADIANCE_VALUE_MASK;
    bool holds = value != PHOTON_NO_IRRADIANCE;
    rgb irradiance = holds ? photon_map_decode_irradiance(map, value) : rgb_gray(0.0f);
    if (holds && !photon_map_may_hold(map, irradiance_photon, distance_squared, irradiance))
        return answer_without_photon(cache, query, PHOTON_NONE, worker_index, out_irradiance);
    if (irradiance_word_state(word) == IRRADIANCE_READY_IN_SIGHT && map->surfaces)
        holds = !photon_map_is_hidden(map, map->irradiance_photons.blocks, query->position, query->normal,
                                      irradiance_photon, &cache->counters[worker_index].rays);
    *out_irradiance = holds ? irradiance : rgb_gray(0.0f);
    cache->counters[worker_index].refused += !holds;
    return holds;
}

/* answer_by_word for a request, whose photon's distance is not kept. */
static void answer_request(irradiance_cache *cache, uint32_t word, unsigned worker_index, irradiance_request *request)
{
    vec3 at = photon_block_position(cache->map->irradiance_photons.blocks, request->irradiance_photon);
    request->holds =
        answer_by_word(cache, &request->query, request->irradiance_photon,
                       vec3_distance_squared(request->query.position, at), word, worker_index, &request->irradiance);
    request->irradiance_photon = PHOTON_NONE;
}

void irradiance_cache_get(irradiance_cache *cache, vec3 position, vec3 normal, unsigned worker_index,
                          irradiance_request *out_request)
{
    irradiance_counters *counters = &cache->counters[worker_index];
    uint32_t irradiance_photon = PHOTON_NONE;
    if (cache->mode != IRRADIANCE_UNCACHED)
        irradiance_photon = photon_map_nearest(cache->map, position, normal, &counters->rays);
    counters->requests++;
    *out_request = (irradiance_request){.query = {position, normal}, .irradiance_photon = PHOTON_NONE};
    if (irradiance_photon >= PHOTON_HIDDEN) {
        out_request->holds = answer_without_photon(cache, &out_request->query, irradiance_photon, worker_index,
                                                   &out_request->irradiance);
        return;
    }
    out_request->irradiance_photon = irradiance_photon;
    uint32_t word = demand(cache, irradiance_photon, worker_index);
    if (irradiance_word_is_ready(word))
        answer_request(cache, word, worker_index, out_request);
    else
        counters->deferred++;
}

/* Sorts the queries into the map's order. Returns an array with a query's number in the low half of each entry, and the
 * leaf that it lies in in the high half. It is a radix sort of the leaves, with as few digits as leave a digit's
 * counts in the first cache. */
static uint64_t *put_in_order(const photon_map *map, irradiance_scratch *scratch, const irradiance_query *queries,
                              uint32_t count)
{
    enum { DIGIT_BITS_MAX = 12 };
    const uint32_t *leaves = scratch->leaves;
    uint32_t depth = map->irradiance_photons.depth, digits = (depth + DIGIT_BITS_MAX - 1) / DIGIT_BITS_MAX;
    uint32_t bits = digits > 0 ? (depth + digits - 1) / digits : 1, mask = (1u << bits) - 1;
    uint64_t *from = scratch->order[1], *to = scratch->order[0];
    photon_map_leaves(map, &queries->position.x, sizeof *queries / sizeof(float), count, scratch->leaves);
    for (uint32_t shift = 0; shift == 0 || shift < depth; shift += bits) {
        uint32_t begin[1 << DIGIT_BITS_MAX] = {0}, sum = 0;
        for (uint32_t i = 0; i < count; i++)
            begin[leaves[i] >> shift & mask]++;
        for (uint32_t d = 0; d <= mask; d++) {
            uint32_t of_digit = begin[d];
            begin[d] = sum;
            sum += of_digit;
        }
        for (uint32_t i = 0; i < count; i++) {
            uint64_t next = shift == 0 ? (uint64_t)leaves[i] << 32 | i : from[i];
            to[begin[next >> (32 + shift) & mask]++] = next;
        }
        uint64_t *hold = from;
        from = to;
        to = hold;
    }
    return from;
}

/* Finds the irradiance photon that stands for each query, and puts it into the high half of the query's entry, and its
 * squared distance beside. */
static void find_irradiance_photons(const photon_map *map, const irradiance_query *queries, uint64_t *order,
                                    uint32_t count, uint64_t *in_out_rays, float *out_distances_squared)
{
    enum { AT_ONCE = PHOTON_LOOKUPS_MAX };
    photon_walk walk;
    photon_walk_init(&walk, &map->irradiance_photons);
    for (uint32_t begin = 0; begin < count; begin += AT_ONCE) {
        uint32_t some = count - begin < AT_ONCE ? count - begin : AT_ONCE, irradiance_photons[AT_ONCE];
        photon_lookup lookups[AT_ONCE];
        for (uint32_t k = 0; k < some; k++) {
            const irradiance_query *q = &queries[(uint32_t)order[begin + k]];
            lookups[k] = (photon_lookup){q->position, q->normal, (uint32_t)(order[begin + k] >> 32)};
        }
        for (uint32_t k = begin + some; k < begin + some + AT_ONCE && k < count; k++) { /* the next ones */
            const irradiance_query *next = &queries[(uint32_t)order[k]];
            __builtin_prefetch(&next->position.x);
            __builtin_prefetch(&next->normal.z); /* may lie on another line */
        }
        photon_map_nearest_many(map, &walk, lookups, some, in_out_rays, irradiance_photons,
                                out_distances_squared + begin);
        for (uint32_t k = 0; k < some; k++)
            order[begin + k] = (uint64_t)irradiance_photons[k] << 32 | (uint32_t)order[begin + k];
    }
}

/* Prefetches what demand and answer_by_word read, and where the answer is written. */
static void prefetch_answer(const photon_map *map, uint32_t irradiance_photon, const rgb *out_irradiance)
{
    __builtin_prefetch(out_irradiance, 1);
    if (irradiance_photon >= PHOTON_HIDDEN)
        return;
    __builtin_prefetch(photon_map_slot(map, irradiance_photon));
    uint32_t index = photon_map_index(map, irradiance_photon);
    __builtin_prefetch(&map->blocks[index / PHOTON_BLOCK_LANES].flux[index % PHOTON_BLOCK_LANES]);
}

/* Demands the irradiance of each photon in the order, and answers the queries whose photons' words are ready then or
 * that no photon stands for. The entries of the others, which other threads are computing, are moved to the front;
 * *out_waiting: how many there are. Returns false where the run is cancelled meanwhile. */
static bool answer_most(irradiance_cache *cache, run_context *run, const irradiance_query *queries, uint64_t *order,
                        uint32_t count, unsigned worker_index, rgb *out_irradiance, bool *out_holds,
                        uint32_t *out_waiting)
{
    enum { CANCEL_EVERY = 16, AHEAD = 16 };
    const float *distances_squared = cache->scratch[worker_index].distances_squared;
    *out_waiting = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t i = (uint32_t)order[k], irradiance_photon = (uint32_t)(order[k] >> 32);
        if (k % CANCEL_EVERY == 0) {
            run_look(run);
            if (run_is_cancelled(run))
                return false;
        }
        if (k + AHEAD < count)
            prefetch_answer(cache->map, (uint32_t)(order[k + AHEAD] >> 32),
                            &out_irradiance[(uint32_t)order[k + AHEAD]]);
        if (irradiance_photon >= PHOTON_HIDDEN) {
            out_holds[i] =
                answer_without_photon(cache, &queries[i], irradiance_photon, worker_index, &out_irradiance[i]);
            continue;
        }
        uint32_t word = demand(cache, irradiance_photon, worker_index);
        if (irradiance_word_is_ready(word))
            out_holds[i] = answer_by_word(cache, &queries[i], irradiance_photon, distances_squared[k], word,
                                          worker_index, &out_irradiance[i]);
        else
            order[(*out_waiting)++] = order[k];
    }
    return true;
}

/* Works in sweeps, so that each has the processor's caches to itself: it looks up the photons in the map's order, then
 * computes what nobody has claimed and reads what is ready, and waits for the rest at the end. */
void irradiance_cache_get_many(irradiance_cache *cache, run_context *run, const irradiance_query *queries,
                               uint32_t count, unsigned worker_index, rgb *out_irradiance, bool *out_holds)
{
    const photon_map *map = cache->map;
    irradiance_scratch *scratch = &cache->scratch[worker_index];
    irradiance_counters *counters = &cache->counters[worker_index];
    uint64_t *order = put_in_order(map, scratch, queries, count);
    uint32_t waiting;
    counters->requests += count;
    store_relaxed_u64(&cache->shown[worker_index].requests, counters->requests);
    if (cache->mode != IRRADIANCE_UNCACHED && map->irradiance_photons.count > 0)
        find_irradiance_photons(map, queries, order, count, &counters->rays, scratch->distances_squared);
    else
        for (uint32_t k = 0; k < count; k++)
            order[k] = (uint64_t)PHOTON_NONE << 32 | (uint32_t)order[k];
    if (!answer_most(cache, run, queries, order, count, worker_index, out_irradiance, out_holds, &waiting))
        return;
    counters->deferred += waiting;
    for (uint32_t k = 0; k < waiting; k++) {
        uint32_t i = (uint32_t)order[k];
        irradiance_request request = {.query = queries[i], .irradiance_photon = (uint32_t)(order[k] >> 32)};
        irradiance_cache_retry(cache, run, &request, worker_index);
        out_irradiance[i] = request.irradiance;
        out_holds[i] = request.holds;
    }
}

void irradiance_cache_retry(irradiance_cache *cache, const run_context *run, irradiance_request *request,
                            unsigned worker_index)
{
    uint32_t word = irradiance_slot_read(photon_map_slot(cache->map, request->irradiance_photon));
    if (!irradiance_word_is_ready(word)) {
        irradiance_counters *counters = &cache->counters[worker_index];
        double begin = clock_thread_cpu_seconds();
        word = await(cache, run, request->irradiance_photon, worker_index);
        counters->waited++;
        counters->waited_seconds += clock_thread_cpu_seconds() - begin;
    }
    if (!irradiance_word_is_ready(word)) /* cancelled */
        word = irradiance_word(IRRADIANCE_READY, PHOTON_NO_IRRADIANCE);
    answer_request(cache, word, worker_index, request);
}

void irradiance_cache_look(const irradiance_cache *cache, uint64_t *out_requests, uint64_t *out_computed)
{
    *out_requests = *out_computed = 0;
    for (unsigned i = 0; i < cache->worker_count; i++) {
        *out_requests += load_relaxed_u64(&cache->shown[i].requests);
        *out_computed += load_relaxed_u64(&cache->shown[i].computed);
    }
}

irradiance_counters irradiance_cache_counters(const irradiance_cache *cache)
{
    irradiance_counters sum = {0};
    for (unsigned i = 0; i < cache->worker_count; i++) {
        const irradiance_counters *c = &cache->counters[i];
        sum.requests += c->requests;
        sum.computed += c->computed;
        sum.deferred += c->deferred;
        sum.waited += c->waited;
        sum.duplicated += c->duplicated;
        sum.reclaimed += c->reclaimed;
        sum.uncached += c->uncached;
        sum.refused += c->refused;
        sum.rays += c->rays;
        sum.timed += c->timed;
        sum.timed_seconds += c->timed_seconds;
        sum.waited_seconds += c->waited_seconds;
    }
    return sum;
}

double irradiance_counters_estimate_seconds(const irradiance_counters *counters)
{
    double estimates = (double)(counters->computed + counters->duplicated + counters->uncached);
    return counters->timed > 0 ? counters->timed_seconds * estimates / (double)counters->timed : 0.0;
}

uint64_t irradiance_cache_distinct(const irradiance_cache *cache)
{
    return photon_map_count_ready(cache->map) - cache->ready_before;
}
