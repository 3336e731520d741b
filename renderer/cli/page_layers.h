/* page_layers.h: a film's channels as the layers that a page shows: three that belong together are one colour or one
 * vector, the ranks of a Cryptomatte are one layer; and how each becomes a picture to look at.
 * Flow: film's names and values -> [here] -> page_picture. Threads: pure functions. */
#ifndef AFTERGLOW_PAGE_LAYERS_H
#define AFTERGLOW_PAGE_LAYERS_H

#include "afterglow/afterglow.h"

#include <stdbool.h>
#include <stddef.h>

enum { PAGE_LAYER_CHANNELS = 12 };

typedef enum page_layer_kind {
    PAGE_LAYER_PICTURE, /* R, G and B themselves */
    PAGE_LAYER_COLOR,   /* light, or what reflects it: seen through the view, as the picture */
    PAGE_LAYER_VECTOR,
    PAGE_LAYER_NUMBER,
    PAGE_LAYER_MATTE /* a Cryptomatte: id and coverage by rank */
} page_layer_kind;

typedef struct page_layer {
    char name[64];
    page_layer_kind kind;
    int channels[PAGE_LAYER_CHANNELS]; /* of the film */
    int channel_count;
    ag_layer matte; /* of PAGE_LAYER_MATTE: AG_LAYER_CRYPTO_OBJECT or AG_LAYER_CRYPTO_MATERIAL */
} page_layer;

/* Lists all layers of the film, the picture first; to be freed. NULL: no memory. */
page_layer *page_layers_list(const ag_film *film, size_t *out_count);

/* Makes a picture, of 3 floats a pixel in [0, 1], of a layer that is not seen through a view: a unit vector as (1 + v)
 * / 2, other vectors and numbers from black at the least to white at the greatest value there is, a matte in a colour
 * for each id. planes: [channel_count], each of count values. */
void page_layer_draw(const page_layer *layer, const float *planes, size_t count, float *out_pixels);

#endif
