/* film.c: see film.h. */
#include "film/film.h"

#include "film/film_tiles.h"

#include <stdlib.h>
#include <string.h>

/* Sets the crop, and the area: where blocks are decided on, all blocks that the crop touches. */
static void set_crop(ag_film *film, const ag_render_settings *settings, bool splits_samples)
{
    /* as pbrt: pixels from ceil(x0 width) on; a hair less, so that pixel / width times width is that pixel */
    const double *crop = settings->crop_window;
    int edges[4];
    for (int i = 0; i < 4; i++)
        edges[i] = (int)ceil(crop[i] * (i < 2 ? settings->width : settings->height) - 1e-6);
    film->x0 = edges[0];
    film->y0 = edges[2];
    film->width = edges[1] - edges[0];
    film->height = edges[3] - edges[2];
    film->full_width = settings->width;
    film->full_height = settings->height;
    if (film->width < 1 || film->height < 1)
        film->width = film->height = 0;
    film->area = (film_area){film->x0, film->y0, film->width, film->height};
    if ((settings->noise_level > 0.0f || sample_split_goes_on(settings, splits_samples)) && film->width > 0) {
        int x0 = edges[0] / FILM_BLOCK * FILM_BLOCK, y0 = edges[2] / FILM_BLOCK * FILM_BLOCK;
        int x1 = (edges[1] + FILM_BLOCK - 1) / FILM_BLOCK * FILM_BLOCK,
            y1 = (edges[3] + FILM_BLOCK - 1) / FILM_BLOCK * FILM_BLOCK;
        film->area = (film_area){x0, y0, (x1 < settings->width ? x1 : settings->width) - x0,
                                 (y1 < settings->height ? y1 : settings->height) - y0};
    }
}

size_t film_block_number(const ag_film *film, int x, int y)
{
    const film_area *all = &film->area;
    int column = all->x0 / FILM_BLOCK, columns = (all->x0 + all->width - 1) / FILM_BLOCK - column + 1;
    return (size_t)(y / FILM_BLOCK - all->y0 / FILM_BLOCK) * (size_t)columns + (size_t)(x / FILM_BLOCK - column);
}

/* Returns an array with an element for each of so many pixels, all 0; NULL where it is not wanted. Out of memory,
 * *in_out_is_whole becomes false. */
static void *make_plane(size_t pixels, size_t bytes_of_pixel, bool is_wanted, bool *in_out_is_whole)
{
    void *plane = is_wanted ? calloc(pixels, bytes_of_pixel) : NULL;
    *in_out_is_whole = *in_out_is_whole && (plane || !is_wanted);
    return plane;
}

/* Makes all arrays of the area's pixels. Returns false when out of memory. */
static bool make_planes(ag_film *film, const ag_render_settings *settings, bool splits_samples)
{
    const aov_layout *layout = &film->layout;
    const size_t count = film_area_count(film) + 1; /* never none */
    bool is_whole = true;
    film->sums = make_plane(count, film_sums_of_pixel(film) * sizeof *film->sums, true, &is_whole);
    film->counts = make_plane(count, sizeof *film->counts, true, &is_whole);
    film->wanted = make_plane(count, sizeof *film->wanted, settings->noise_level > 0.0f, &is_whole);
    film->splits = make_plane(count, sizeof *film->splits, sample_split_is_open(settings, splits_samples), &is_whole);
    film->negatives = make_plane(count, sizeof *film->negatives, film->filter.has_signs, &is_whole);
    for (int i = 0; i < FILM_VIEW_COUNT; i++)
        film->views[i] = make_plane(count, sizeof *film->views[i], layout->has_view[i], &is_whole);
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT; i++)
        film->slots[i] = make_plane(count, CRYPTOMATTE_SLOTS * sizeof *film->slots[i], layout->has_matte[i], &is_whole);
    film->nearest = make_plane(count, sizeof *film->nearest, layout->needs_nearest, &is_whole);
    return is_whole;
}

ag_film *film_create(const ag_render_settings *settings, const working_space *space, const pixel_filter *filter,
                     bool splits_samples, aov_layout *layout)
{
    ag_film *film = calloc(1, sizeof *film);
    if (!film) {
        aov_layout_reset(layout);
        return NULL;
    }
    set_crop(film, settings, splits_samples);
    film->float_samples = settings->float_samples;
    film->filter = *filter;
    film->space = *space;
    film->response = film_response_make(settings, space);
    film->layout = *layout;
    *layout = (aov_layout){0};
    film->pixels = calloc(film_crop_count(film) + 1, 3 * sizeof *film->pixels);
    film->tiles = film_tiles_create(film->width, film->height);
    if (make_planes(film, settings, splits_samples) && film->pixels && film->tiles &&
        noise_lattice_create(film->area.width, film->area.height, &film->noise) == AG_OK) {
        film_set_first_splits(film, settings);
        return film;
    }
    ag_film_destroy(film);
    return NULL;
}

void ag_film_destroy(ag_film *film)
{
    if (!film)
        return;
    free(film->sums);
    free(film->counts);
    free(film->wanted);
    free(film->splits);
    split_prior_reset(&film->prior);
    free(film->negatives);
    free(film->nearest);
    for (int i = 0; i < FILM_VIEW_COUNT; i++)
        free(film->views[i]);
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT; i++) {
        free(film->slots[i]);
        cryptomatte_reset(&film->mattes[i]);
    }
    free(film->pixels);
    film_tiles_destroy(film->tiles);
    noise_lattice_reset(&film->noise);
    free(film->origin.defined);
    aov_layout_reset(&film->layout);
    free(film);
}

/* Lists an array of the area's pixels, where the film has it. */
static void list_plane(const ag_film *film, void *bytes, size_t bytes_of_pixel, film_plane *out_planes,
                       int *in_out_count)
{
    if (bytes)
        out_planes[(*in_out_count)++] = (film_plane){bytes, film_area_count(film) * bytes_of_pixel};
}

/* The planes that samples fill. */
static int sample_planes(ag_film *film, film_plane out_planes[FILM_PLANES_MAX])
{
    int count = 0;
    list_plane(film, film->sums, film_sums_of_pixel(film) * sizeof *film->sums, out_planes, &count);
    list_plane(film, film->counts, sizeof *film->counts, out_planes, &count);
    list_plane(film, film->wanted, sizeof *film->wanted, out_planes, &count);
    list_plane(film, film->splits, sizeof *film->splits, out_planes, &count);
    list_plane(film, film->negatives, sizeof *film->negatives, out_planes, &count);
    for (int i = 0; i < FILM_VIEW_COUNT; i++)
        list_plane(film, film->views[i], sizeof *film->views[i], out_planes, &count);
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT; i++)
        list_plane(film, film->slots[i], CRYPTOMATTE_SLOTS * sizeof *film->slots[i], out_planes, &count);
    list_plane(film, film->nearest, sizeof *film->nearest, out_planes, &count);
    out_planes[count++] = (film_plane){film->noise.sums, noise_lattice_bytes(&film->noise)};
    return count;
}

int film_planes(ag_film *film, film_plane out_planes[FILM_PLANES_MAX])
{
    int count = sample_planes(film, out_planes);
    double *of_pilot = &film->prior.cost_per_variance;
    out_planes[count++] = (film_plane){of_pilot, sizeof *of_pilot};
    return count;
}

split_counts film_first_split(const ag_film *film, const ag_render_settings *settings)
{
    split_counts first = sample_split_first(settings, true);
    first.further = film_further(film, first.further);
    return first;
}

void film_set_first_splits(struct ag_film *film, const ag_render_settings *settings)
{
    const film_area *all = &film->area;
    for (int y = all->y0; film->splits && y < all->y0 + all->height; y++)
        for (int x = all->x0; x < all->x0 + all->width; x++)
            film->splits[film_pixel_at(film, x, y)].counts =
                film->prior.first ? film->prior.first[film_block_number(film, x, y)] : film_first_split(film, settings);
}

void film_clear(ag_film *film, const ag_render_settings *settings)
{
    film_plane planes[FILM_PLANES_MAX];
    for (int i = sample_planes(film, planes) - 1; i >= 0; i--)
        memset(planes[i].bytes, 0, planes[i].size);
    film_set_first_splits(film, settings);
}

film_area film_block_at(const ag_film *film, int column, int row)
{
    const film_area *all = &film->area;
    int x = column * FILM_BLOCK, y = row * FILM_BLOCK;
    int width = all->width - x < FILM_BLOCK ? all->width - x : FILM_BLOCK,
        height = all->height - y < FILM_BLOCK ? all->height - y : FILM_BLOCK;
    return (film_area){all->x0 + x, all->y0 + y, width, height};
}

film_count film_count_samples(const ag_film *film)
{
    film_count count = {.least = UINT32_MAX};
    uint64_t sum = 0;
    size_t pixels = film_crop_count(film);
    for (size_t i = 0; i < pixels; i++) {
        uint32_t samples = film->counts[film_pixel_of_crop(film, i)];
        sum += samples;
        count.least = samples < count.least ? samples : count.least;
        count.most = samples > count.most ? samples : count.most;
    }
    if (pixels == 0)
        return (film_count){0};
    count.mean = (double)sum / (double)pixels;
    return count;
}

void film_resolve(ag_film *film) { film_show(film, film->area); }
