/* film.h: the film: for each pixel what its samples add up to, sums in double precision, in the order of the samples. A
 * pixel knows how many it has had, so that rendering may stop after any sample and go on later: samples [0, a) and then
 * [a, b) give the bits of [0, b) at once, whatever the tiles, threads or passes. Flow: film_sums fills it -> [here] ->
 * film_channels. Threads: a pixel belongs to one worker at a time; resolved when none is at work. */
#ifndef AFTERGLOW_FILM_H
#define AFTERGLOW_FILM_H

#include "film/aov.h"
#include "film/film_response.h"
#include "film/noise.h"
#include "film/pixel_filter.h"
#include "film/sample_split.h"

/* The surface nearest to the eye that a pixel's samples met, which is what depth and ids mean; no mean of them means
 * anything. */
typedef struct film_nearest {
    float depth;
    uint32_t object_id, material_id; /* 0: nothing met yet */
} film_nearest;

/* The settings and transforms that a file's header says the picture was made with. */
typedef struct film_origin {
    ag_render_settings settings; /* nothing left open */
    float world_to_camera[16];   /* as OpenEXR has it: row by row, of row vectors; when the shutter opens */
    float world_to_ndc[16];      /* to (0, 0) in the display window's upper left corner and (1, 1) opposite */
    bool has_ndc;
    char *defined; /* of the scene, see scene.h; owned, or NULL */
} film_origin;

/* Some pixels of the full picture. */
typedef struct film_area {
    int x0, y0, width, height;
} film_area;

/* Adaptive sampling and splitting decide for blocks of this many pixels in width and height, aligned to the full
 * picture. */
enum { FILM_BLOCK = 8 };

typedef struct film_tiles film_tiles; /* see film_tiles.h */

struct ag_film {
    int x0, y0, width, height; /* the crop, in pixels of the full picture */
    unsigned trial_step;       /* above 1: one in so many of its blocks is rendered, as a trial of the whole */
    unsigned trial_first;      /* the first one of the first row: below trial_step */
    unsigned trial_turn;       /* by how many columns a row's blocks are apart from those of the next */
    film_area area;            /* what is rendered: the crop; where blocks are decided on, all that it touches, so that
                                  its pixels get the samples that they have in the full picture */
    int full_width, full_height;
    bool float_samples;  /* as in ag_render_settings */
    working_space space; /* of all colours */
    pixel_filter filter;
    film_response response;
    aov_layout layout;
    film_origin origin;

    /* Arrays of the pixels of the area, top row first; all owned. */
    double *sums;                  /* [layout.sum_count], of filters with negative lobes twice: by the samples' sign */
    uint32_t *counts;              /* samples so far */
    uint32_t *wanted;              /* samples that it is to have, see adaptive.h; NULL: as many as all */
    split_sums *splits;            /* see sample_split.h; NULL: all samples are split alike */
    uint32_t *negatives;           /* samples with sign -1; NULL where the filter has no signs */
    float *views[FILM_VIEW_COUNT]; /* a plane each; NULL where not asked for */
    cryptomatte mattes[CRYPTOMATTE_KIND_COUNT];
    cryptomatte_slot *slots[CRYPTOMATTE_KIND_COUNT]; /* [CRYPTOMATTE_SLOTS]; NULL where not asked for */
    film_nearest *nearest;                           /* NULL where not asked for */
    float *pixels;                                   /* 3, RGB, of the crop: set by film_resolve and film_show */
    film_tiles *tiles;                               /* which of them have changed */

    split_prior prior; /* of the splits; without splits nothing is in it */

    noise_lattice noise; /* of some of them */
};

/* Returns an empty film of the settings' crop; takes the layout, on failure too (it is then reset). NULL when out of
 * memory. A crop that holds no pixel has width 0. splits_samples: see sample_split.h. */
struct ag_film *film_create(const ag_render_settings *settings, const working_space *space, const pixel_filter *filter,
                            bool splits_samples, aov_layout *layout);

static inline size_t film_area_count(const struct ag_film *film)
{
    return (size_t)film->area.width * (size_t)film->area.height;
}

static inline size_t film_crop_count(const struct ag_film *film) { return (size_t)film->width * (size_t)film->height; }

/* Returns the number of doubles among the sums that belong to a pixel. */
static inline size_t film_sums_of_pixel(const struct ag_film *film)
{
    return (size_t)film->layout.sum_count * (film->filter.has_signs ? 2 : 1);
}

/* Returns the number in the area of a pixel of the full picture. */
static inline size_t film_pixel_at(const struct ag_film *film, int x, int y)
{
    return (size_t)(y - film->area.y0) * (size_t)film->area.width + (size_t)(x - film->area.x0);
}

/* Returns the number in the area of a pixel of the crop, by its number there. */
static inline size_t film_pixel_of_crop(const struct ag_film *film, size_t pixel)
{
    size_t width = (size_t)film->width;
    return film_pixel_at(film, film->x0 + (int)(pixel % width), film->y0 + (int)(pixel / width));
}

/* Returns how many further camera rays samples may have, of so many: none where they have signs by the filter, since
 * each camera ray would have its own. */
static inline uint32_t film_further(const struct ag_film *film, uint32_t further)
{
    return film->filter.has_signs ? 0 : further;
}

/* Returns how the first samples are split where nothing is known of the picture. */
split_counts film_first_split(const struct ag_film *film, const ag_render_settings *settings);

/* Sets how the first samples of all pixels are split; does nothing where blocks do not choose. */
void film_set_first_splits(struct ag_film *film, const ag_render_settings *settings);

/* Removes all samples; keeps what the pilot has told. */
void film_clear(struct ag_film *film, const ag_render_settings *settings);

/* Makes all pixels of the sums, for all to see. */
void film_resolve(struct ag_film *film);

/* An array that samples or the pilot have filled, for checkpoints to write and read. film_planes gives all of them, and
 * returns how many there are. */
typedef struct film_plane {
    void *bytes; /* the film's */
    size_t size;
} film_plane;
enum { FILM_PLANES_MAX = 8 + FILM_VIEW_COUNT + CRYPTOMATTE_KIND_COUNT };
int film_planes(struct ag_film *film, film_plane out_planes[FILM_PLANES_MAX]);

/* Returns the number, row by row, of the block that a pixel of the full picture lies in, among those that the area
 * touches. */
size_t film_block_number(const struct ag_film *film, int x, int y);

/* Returns a block's pixels, those of the area alone, by its column and row there. */
film_area film_block_at(const struct ag_film *film, int column, int row);

/* Returns whether a trial leaves a pixel out. Its blocks form a lattice that is spread evenly: Korobov, "The
 * approximate computation of multiple integrals", 1959. */
static inline bool film_is_left_out(const struct ag_film *film, size_t pixel)
{
    size_t width = (size_t)film->area.width;
    size_t column = pixel % width / FILM_BLOCK, row = pixel / width / FILM_BLOCK;
    return film->trial_step > 1 && (column + film->trial_turn * row) % film->trial_step != film->trial_first;
}

/* Returns the number of samples that a pixel is to have in a pass that brings all to `all`. */
static inline uint32_t film_goal(const struct ag_film *film, size_t pixel, uint32_t all)
{
    if (film_is_left_out(film, pixel))
        return 0;
    return film->wanted && film->wanted[pixel] < all ? film->wanted[pixel] : all;
}

/* The numbers of samples that pixels of the crop have had. */
typedef struct film_count {
    uint32_t least, most;
    double mean;
} film_count;
film_count film_count_samples(const struct ag_film *film);

#endif
