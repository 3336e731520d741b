/* sample_queue.h: a worker's camera samples that wait for their gathered light, and the way of complete ones into the
 * film. Rests on: pbrt-v4's film (a bound on each sample). Flow: shading, gather_batch -> [here] -> film.
 * Threads: a queue belongs to one worker, as do the pixels of its samples. */
#ifndef AFTERGLOW_SAMPLE_QUEUE_H
#define AFTERGLOW_SAMPLE_QUEUE_H

#include "film/film.h"
#include "integrator/gather_batch.h"

typedef struct queued_sample {
    eye_sample sample;
    size_t pixel; /* of the film */
} queued_sample;

enum { SAMPLE_QUEUE_LAYERS = GATHER_BATCH_SAMPLES / 8 }; /* samples with layers, which are large */

typedef struct sample_queue {
    uint32_t count, layers_count;
    sample_layers *layers; /* [SAMPLE_QUEUE_LAYERS] */
    queued_sample samples[GATHER_BATCH_SAMPLES];
} sample_queue;

/* Makes an empty queue; NULL when out of memory. */
sample_queue *sample_queue_create(void);
void sample_queue_destroy(sample_queue *q); /* NULL is fine */

static inline bool sample_queue_is_full(const sample_queue *q)
{
    return q->count == GATHER_BATCH_SAMPLES || q->layers_count == SAMPLE_QUEUE_LAYERS;
}

/* Begins the next sample of a queue that is not full, without anything in it; its number is what q->count was. The
 * samples of a pixel are begun in their order. */
eye_sample *sample_queue_begin(sample_queue *q, size_t pixel, bool with_layers);

/* Adds all samples to their pixels, in their order; the queue is empty then. gathered: [count], the light still to be
 * added to each, black afterwards; or NULL. gathered_group: the group of lights that it belongs to. Returns the number
 * of samples that were not finite, which count as black. */
uint32_t sample_queue_deliver(sample_queue *q, gathered_light *gathered, uint32_t gathered_group, ag_film *film);

#endif
