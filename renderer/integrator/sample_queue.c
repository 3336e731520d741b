/* sample_queue.c: see sample_queue.h. */
#include "integrator/sample_queue.h"

#include "film/film_sums.h"
#include "large_alloc.h"

#include <stdlib.h>

sample_queue *sample_queue_create(void)
{
    sample_queue *q = large_alloc(sizeof *q);
    if (!q)
        return NULL;
    q->count = q->layers_count = 0;
    q->layers = malloc(SAMPLE_QUEUE_LAYERS * sizeof *q->layers);
    if (q->layers)
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

eye_sample *sample_queue_begin(sample_queue *q, size_t pixel, bool with_layers)
{
    queued_sample *s = &q->samples[q->count++];
    *s = (queued_sample){.pixel = pixel};
    if (with_layers) {
        s->sample.layers = &q->layers[q->layers_count++];
        *s->sample.layers = (sample_layers){0};
    }
    return &s->sample;
}

/* Gathered light was bounded when it was found. */
static void add_gathered(eye_sample *s, const gathered_light *gathered, uint32_t group)
{
    s->radiance = rgb_add(s->radiance, rgb_add(gathered->first, gathered->behind));
    s->gather_variance = gathered->variance;
    s->own += rgb_mean(rgb_add(gathered->first, gathered->behind));
    if (!s->layers)
        return;
    eye_sample_add_part(s, PART_INDIRECT, gathered->first);
    eye_sample_add_part(s, PART_SPECULAR, gathered->behind);
    eye_sample_add_group(s, group, rgb_add(gathered->first, gathered->behind));
}

static void scale_layers(sample_layers *layers, float factor)
{
    for (int i = 0; i < LIGHT_PART_COUNT; i++)
        layers->parts[i] = rgb_scale(layers->parts[i], factor);
    layers->sky = rgb_scale(layers->sky, factor);
    for (int i = 0; i <= LIGHT_GROUPS_MAX; i++)
        layers->groups[i] = rgb_scale(layers->groups[i], factor);
}

static bool is_finite(const struct ag_film *film, const eye_sample *sample)
{
    bool parts_are = true;
    for (int i = 0; sample->layers && film->layout.needs_layers && i < LIGHT_PART_COUNT; i++)
        parts_are = parts_are && rgb_is_finite(sample->layers->parts[i]);
    return parts_are && rgb_is_finite(sample->radiance);
}

/* Takes all light from a sample; what its ray met first stays. */
static void blacken(eye_sample *sample)
{
    sample->radiance = rgb_gray(0.0f);
    sample->gather_variance = sample->light_variance = sample->caustic_square = sample->own = 0.0f;
    if (sample->layers) {
        const sample_layers seen = *sample->layers;
        *sample->layers = (sample_layers){.alpha = seen.alpha, .first = seen.first};
    }
}

/* Bounds a sample that is too bright, all its parts alike. */
static void bound(const film_response *response, eye_sample *sample)
{
    rgb bounded = film_response_bound(response, sample->radiance);
    float before = rgb_max(sample->radiance);
    sample->radiance = bounded;
    if (!(before > 0.0f && rgb_max(bounded) < before))
        return;
    float kept = rgb_max(bounded) / before;
    if (sample->layers)
        scale_layers(sample->layers, kept);
    sample->own *= kept;
    sample->gather_variance *= kept * kept;
    sample->light_variance *= kept * kept;
    sample->caustic_square *= kept * kept;
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
        if (!is_finite(film, s)) {
            blacken(s);
            not_finite++;
        } else if (film->response.is_bounded) {
            bound(&film->response, s);
        }
        film_add(film, q->samples[i].pixel, s);
    }
    q->count = q->layers_count = 0;
    return not_finite;
}
