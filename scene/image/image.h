/* image.h: what a picture is, as it is read and as it is written.
 * Flow: image_reader, image_file (renderer) -> image_module. Declarations only. */
#ifndef AFTERGLOW_IMAGE_H
#define AFTERGLOW_IMAGE_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How a file stores a value. */
typedef enum image_sample_type { IMAGE_UINT8, IMAGE_UINT16, IMAGE_HALF, IMAGE_FLOAT } image_sample_type;

/* A picture that was read: packed per pixel, top row first, in just one of the two arrays. Floats made of integers are
 * their shares of the largest integer, 0 to 1. No curve is taken out, no alpha multiplied in. */
typedef struct image {
    int width, height;           /* of the data window */
    int x, y;                    /* of its top left corner in the display window, */
    int full_width, full_height; /* which has this size */
    int channel_count;
    image_sample_type type; /* of the file; what is neither 8-bit, 16-bit nor half counts as float */
    float *pixels;
    unsigned char *bytes;        /* of 8-bit files, where they were asked for */
    bool is_multiplied_by_alpha; /* the file says so of its colours, and they are as stored */
    bool is_first_of_several;    /* the file holds other pictures beside it, which are not read: parts, pages, frames */
    bool has_chromaticities;
    float chromaticities[8]; /* that the file brings: of red, green, blue, white, each x and y */
} image;

/* Which channels of a picture to read. Its colours are red, green and blue and, where the same layer has it, alpha;
 * where no channels are named so, they are all channels. */
typedef enum image_wish {
    IMAGE_ALL_CHANNELS,  /* from the colours on, as floats */
    IMAGE_COLORS,        /* as floats */
    IMAGE_COMPACT_COLORS /* as bytes where the file has 8 bits, else as floats */
} image_wish;

/* Returns whether reading is to end. The thread that reads calls it before each piece of a picture. */
typedef bool image_cancelled_fn(const void *user);

typedef struct image_request {
    image_wish wish;
    image_cancelled_fn *is_cancelled; /* NULL: it never is */
    const void *user;                 /* for is_cancelled; borrowed */
} image_request;

/* A file that holds tiles, and coarser levels, each half as large as the one before. */
enum { IMAGE_LEVELS_MAX = 32 };
typedef struct image_level {
    int width, height;
    int tile_width_bits, tile_height_bits; /* logarithms of the sides of a tile */
} image_level;

typedef struct image_levels_header {
    image picture;          /* without pixels; its channels are the colours and alpha alone, */
    int file_channel_count; /* which are the first of so many */
    int level_count;
    image_level levels[IMAGE_LEVELS_MAX];
} image_levels_header;

typedef struct image_attribute {
    const char *name;
    const char *text;     /* a string attribute, or NULL: numbers */
    const float *numbers; /* float attribute, count 1 or an array; 16: a matrix */
    int number_count;
} image_attribute;

/* The picture to write: float channels, packed per pixel, top row first. */
typedef struct image_description {
    int width, height;           /* of the pixels given (the data window) */
    int x, y;                    /* of its top left corner in the full picture */
    int full_width, full_height; /* the full picture (the display window), from (0, 0) */
    int channel_count;           /* 3 or 4, or more for EXR */
    const char *const *channel_names;
    image_sample_type type;                 /* as stored; a format that cannot hold it is an error */
    const image_sample_type *channel_types; /* of each channel, EXR alone; NULL: all of the type above */
    bool is_tiled;                          /* EXR: in tiles, else in lines */
    const char *color_space;                /* oiio:ColorSpace of formats other than EXR, or NULL */
    const image_attribute *attributes;
    int attribute_count;
} image_description;

#ifdef __cplusplus
}
#endif
#endif
