/* layer_table.h: the layers of a picture, one row each: what the command line calls it, what it shows, the channels of
 * a file that it becomes. What the film sums follows from the channels, and so does how many there are. Rests on:
 * pbrt-v4's GBufferFilm (its channel names); Cryptomatte (Friedman, Jones, Psyop); the names that EXR files of PRMan,
 * Arnold and Cycles have in common. Flow: aov reads it. Threads: any; rows are const. */
#ifndef AFTERGLOW_LAYER_TABLE_H
#define AFTERGLOW_LAYER_TABLE_H

#include "film/aov.h"

/* Channels that are alike. */
typedef struct layer_channels {
    const char *name;    /* "albedo"; "" where the letters are all */
    const char *letters; /* "RGB": one for each, as "albedo.R"; NULL: one alone, called as name says */
    channel_source source;
    film_sum sum;  /* what they are read from, of sources that read one */
    int component; /* of the sum, or which film_view: the first channel's */
    int skipped;   /* components of the sum that lie before */
    bool is_exact; /* floats in every file: half would spoil it */
} layer_channels;

/* Channels whose number is not known beforehand. */
typedef enum layer_expansion { LAYER_AS_IT_STANDS, LAYER_BY_LIGHT_GROUP, LAYER_BY_RANK } layer_expansion;

typedef struct layer_row {
    ag_layer_info info;
    const layer_channels *channels; /* ended by one without a name; of LAYER_AS_IT_STANDS */
    layer_expansion expansion;
    cryptomatte_kind matte; /* of LAYER_BY_RANK */
    const char *matte_name; /* of LAYER_BY_RANK: its channels are called NAME00.R and so on */
    bool is_of_photon_map;  /* path tracing leaves it out */
} layer_row;

/* The rows in the order of their channels in a file; NULL: there are no more. */
const layer_row *layer_at(size_t index);

/* The name of one layer (AG_LAYER_...), as ag_layers_parse reads it; "" where there is none. */
const char *layer_name(uint32_t layer);
/* All layers that there are, a bit each. */
uint32_t layers_known(void);

#endif
