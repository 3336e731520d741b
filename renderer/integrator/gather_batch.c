/* gather_batch.c: see gather_batch.h. */
#include "integrator/gather_batch.h"

#include "large_alloc.h"

#include <stdlib.h>
#include <string.h>

gather_batch *gather_batch_create(float most_indirect)
{
    gather_batch *b = large_alloc(sizeof *b);
    if (!b)
        return NULL;
    b->most_indirect = most_indirect;
    gather_batch_reset(b);
    return b;
}

void gather_batch_reset(gather_batch *b)
{
    b->query_count = b->gather_count = 0;
    b->is_open = false;
    memset(b->gathered, 0, sizeof b->gathered);
}

void gather_batch_destroy(gather_batch *b) { free(b); }

void gather_batch_begin(gather_batch *b, uint32_t sample, bool is_first, rgb throughput, float share,
                        uint32_t ray_count, uint64_t key)
{
    b->gathers[b->gather_count++] = (gather){.throughput = throughput,
                                             .most = b->most_indirect * share,
                                             .ray_count = ray_count,
                                             .sample = sample,
                                             .is_first = is_first,
                                             .key = key};
    b->is_open = true;
}

void gather_batch_end(gather_batch *b, rgb known)
{
    gather *g = &b->gathers[b->gather_count - 1];
    g->known = known;
    g->query_end = b->query_count;
    b->is_open = false;
}

void gather_ends_pick(gather_ends *in_out_ends, float u)
{
    gather_ends *e = in_out_ends;
    if (e->count < 2)
        return;
    float both = rgb_max(e->weight[0]) + rgb_max(e->weight[1]);
    float second_share = both > 0.0f ? rgb_max(e->weight[1]) / both : 0.0f;
    bool is_second = u < second_share;
    e->end[0] = e->end[is_second];
    e->weight[0] = rgb_scale(e->weight[is_second], 1.0f / (is_second ? second_share : 1.0f - second_share));
    e->count = 1;
}

/* Returns the gather that a query belongs to, which is the first one whose queries end behind it. */
static const gather *gather_of(const gather_batch *b, uint32_t query)
{
    uint32_t low = 0, high = b->gather_count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        bool is_open = b->is_open && middle == b->gather_count - 1;
        if (!is_open && b->gathers[middle].query_end <= query)
            low = middle + 1;
        else
            high = middle;
    }
    return &b->gathers[low];
}

uint32_t gather_batch_make_detours(gather_batch *b, uint32_t *in_out_query)
{
    uint32_t count = 0, i = *in_out_query;
    for (; i < b->query_count && count < GATHER_BATCH_DETOURS; i++) {
        if (b->holds[i])
            continue;
        const gather_query_rest *rest = &b->rests[i];
        surface_point point = {b->queries[i].position, b->queries[i].normal, rest->epsilon};
        const gather *g = gather_of(b, i);
        gather_end end = {point, rest->medium, rest->scatterings_left};
        uint64_t key = rest->is_second_end ? hash_combine(g->key, GATHER_ENDS_MAX) : g->key;
        b->detours[count++] = (gather_detour){i, rest->number, key, end, b->weights[i], rgb_max(g->throughput)};
        b->weights[i] = rgb_gray(1.0f);
        b->irradiance[i] = rgb_gray(0.0f);
    }
    *in_out_query = i;
    return count;
}

/* Returns the variance of a gather's light at the eye, in the mean of the three colours, by how much its rays differ.
 * The light of a single ray stands for its own deviation. */
static float sum_variance(const gather *g)
{
    float count = (float)g->ray_count, sum = rgb_mean(rgb_add(g->known, g->read)), weight = rgb_mean(g->throughput);
    float squares = g->known_squares + g->read_squares;
    float of_ray = g->ray_count > 1 ? float_max(squares - sum * sum / count, 0.0f) / (count - 1.0f) : squares * 0.5f;
    return weight * weight * count * of_ray;
}

void gather_batch_sum(gather_batch *b)
{
    if (b->is_open)
        b->gathers[b->gather_count - 1].query_end = b->query_count;
    uint32_t query = 0, over = b->gather_count - (b->is_open ? 1 : 0);
    for (uint32_t i = 0; i < b->gather_count; i++) {
        gather *g = &b->gathers[i];
        float brought = 0.0f; /* by the queries of one ray */
        for (; query < g->query_end; query++) {
            rgb read = rgb_mul(b->weights[query], b->irradiance[query]);
            bool is_over = query + 1 == g->query_end || !b->rests[query + 1].is_second_end;
            brought += rgb_mean(read) + b->rests[query].known;
            g->read = rgb_add(g->read, read);
            if (!is_over)
                continue;
            g->read_squares += brought * brought;
            brought = 0.0f;
        }
        if (i >= over)
            break;
        gathered_light *sum = &b->gathered[g->sample];
        rgb seen = rgb_mul(g->throughput, rgb_add(g->known, g->read)), *to = g->is_first ? &sum->first : &sum->behind;
        *to = rgb_add(*to, rgb_scale(seen, eye_bound(g->most, seen)));
        sum->variance += sum_variance(g);
    }
    if (b->is_open)
        b->gathers[0] = b->gathers[over];
    b->gather_count -= over;
    b->query_count = 0;
}
