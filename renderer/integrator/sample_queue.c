/* sample_queue.c: see sample_queue.h. */
#include "integrator/sample_queue.h"

#include "large_alloc.h"

#include <stdlib.h>

enum { CAPACITY_WITH_LAYERS = GATHER_BATCH_SAMPLES / 8 };

sample_queue *sample_queue_create(bool with_layers)
{
    sample_queue *q = large_alloc(sizeof *q);
    if (!q)
        return NULL;
    q->count = 0;
    q->capacity = with_layers ? CAPACITY_WITH_LAYERS : GATHER_BATCH_SAMPLES;
    q->layers = with_layers ? malloc(CAPACITY_WITH_LAYERS * sizeof *q->layers) : NULL;
    if (!with_layers || q->layers)
        return q;
    free(q);
    return NULL;
}

void sample_queue_destroy(sample_queue *q)
{
    if (q)
        free(q->layers);
    free(q);
}

eye_sample *sample_queue_begin(sample_queue *q, size_t pixel)
{
    uint32_t number = q->count++;
    queued_sample *s = &q->samples[number];
    *s = (queued_sample){.sample = {.layers = q->layers ? &q->layers[number] : NULL}, .pixel = pixel};
    if (q->layers)
        q->layers[number] = (sample_layers){0};
    return &s->sample;
}

/* Its bounds have been kept to already. */
static void add_gathered(eye_sample *s, const gathered_light *gathered, uint32_t group)
{
    s->radiance = rgb_add(s->radiance, rgb_add(gathered->first, gathered->behind));
    if (!s->layers)
        return;
    eye_sample_note(s, PART_INDIRECT, gathered->first);
    eye_sample_note(s, PART_SPECULAR, gathered->behind);
    eye_sample_add_group(s, group, rgb_add(gathered->first, gathered->behind));
}

static void scale_layers(sample_layers *layers, float factor)
{
    for (int i = 0; i < LIGHT_PART_COUNT; i++)
        layers->parts[i] = rgb_scale(layers->parts[i], factor);
    for (int i = 0; i <= LIGHT_GROUPS_MAX; i++)
        layers->groups[i] = rgb_scale(layers->groups[i], factor);
}

/* Of samples that are too bright all parts are scaled alike. false: it was not finite. */
static bool bound_sample(const film_response *response, eye_sample *sample)
{
    bool is_finite = rgb_is_finite(sample->radiance);
    for (int i = 0; sample->layers && i < LIGHT_PART_COUNT; i++)
        is_finite = is_finite && rgb_is_finite(sample->layers->parts[i]);
    if (!is_finite) {
        sample->radiance = rgb_gray(0.0f);
        if (sample->layers) {
            const first_hit first = sample->layers->first;
            *sample->layers = (sample_layers){.first = first};
        }
    } else if (response->is_bounded) {
        rgb bounded = film_response_bound(response, sample->radiance);
        float before = rgb_max(sample->radiance);
        if (sample->layers && before > 0.0f && rgb_max(bounded) < before)
            scale_layers(sample->layers, rgb_max(bounded) / before);
        sample->radiance = bounded;
    }
    return is_finite;
}

uint32_t sample_queue_deliver(sample_queue *q, gathered_light *gathered, uint32_t gathered_group, ag_film *film)
{
    uint32_t not_finite = 0;
    for (uint32_t i = 0; i < q->count; i++) {
        eye_sample *s = &q->samples[i].sample;
        if (gathered) {
            add_gathered(s, &gathered[i], gathered_group);
            gathered[i] = (gathered_light){0};
        }
        not_finite += !bound_sample(&film->response, s);
        film_add(film, q->samples[i].pixel, s);
    }
    q->count = 0;
    return not_finite;
}
