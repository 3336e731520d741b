/* layer_table.c: see layer_table.h. */
#include "film/layer_table.h"

#include <string.h>

#define CHANNELS(...) ((const layer_channels[]){__VA_ARGS__, {0}})
/* The channels of a part of light. */
#define PART(word, part)                                                                                               \
    .info.group = "light", .channels = CHANNELS({word, "RGB", CHANNEL_COLOR, .sum = SUM_PARTS, .skipped = 3 * (part)})
/* Values of a pixel as a whole. */
#define VIEW(word, view) .channels = CHANNELS({word, NULL, CHANNEL_VIEW, .component = (view), .is_exact = true})

static const layer_row ROWS[] = {
    {.info = {AG_LAYER_ALPHA, "A",
              .about = "how much of the background is hidden: all by a surface, a part by media before the sky"},
     .channels = CHANNELS({"A", NULL, CHANNEL_MEAN, .sum = SUM_ALPHA})},
    /* before the others: where a layer of ours has a channel of the same name, it is pbrt's */
    {.info = {AG_LAYER_GBUFFER, "gbuffer", .about = "what pbrt's film of that name writes", .is_left_out_of_all = true},
     .channels =
         CHANNELS({"Albedo", "RGB", CHANNEL_MEAN, .sum = SUM_ALBEDO},
                  {"P", "XYZ", CHANNEL_HIT_MEAN, .sum = SUM_POSITION, .is_exact = true},
                  {"dzdx", NULL, CHANNEL_ABSOLUTE, .sum = SUM_SLOPE, .is_exact = true},
                  {"dzdy", NULL, CHANNEL_ABSOLUTE, .sum = SUM_SLOPE, .component = 1, .is_exact = true},
                  {"N", "XYZ", CHANNEL_DIRECTION, .sum = SUM_GEOMETRIC_NORMAL},
                  {"Ns", "XYZ", CHANNEL_DIRECTION, .sum = SUM_NORMAL},
                  {"", "uv", CHANNEL_HIT_MEAN, .sum = SUM_UV, .is_exact = true},
                  {"Variance", "RGB", CHANNEL_VARIANCE, .sum = SUM_HIT_SQUARES, .is_exact = true},
                  {"RelativeVariance", "RGB", CHANNEL_RELATIVE_VARIANCE, .sum = SUM_HIT_SQUARES, .is_exact = true})},
    {.info = {AG_LAYER_DEPTH, "Z",
              .about = "the depth of the nearest surface along the camera's axis, 1e10 where there is none"},
     .channels = CHANNELS({"Z", NULL, CHANNEL_DEPTH, .is_exact = true})},
    {.info = {AG_LAYER_EMISSION, "emission", .about = "light straight from lamps and sky to the eye"},
     PART("emission", PART_EMISSION)},
    {.info = {AG_LAYER_DIRECT, "direct",
              .about = "light straight from lamps, reflected by the first surface's diffuse lobes"},
     PART("direct", PART_DIRECT)},
    {.info = {AG_LAYER_INDIRECT, "indirect", .about = "what else these lobes reflect, but for caustics"},
     PART("indirect", PART_INDIRECT)},
    {.info = {AG_LAYER_CAUSTIC, "caustic",
              .about = "what comes to these lobes from lamps by way of mirrors and glass alone"},
     PART("caustic", PART_CAUSTIC)},
    {.info = {AG_LAYER_SPECULAR, "specular",
              .about = "all light by way of the first surface's other lobes, or of a medium"},
     PART("specular", PART_SPECULAR)},
    {.info = {AG_LAYER_ALBEDO, "albedo", .about = "how much of the light the first surface reflects"},
     .channels = CHANNELS({"albedo", "RGB", CHANNEL_MEAN, .sum = SUM_ALBEDO})},
    {.info = {AG_LAYER_NORMAL, "N", .about = "the first surface's shading normal, in world space"},
     .channels = CHANNELS({"N", "XYZ", CHANNEL_MEAN, .sum = SUM_NORMAL})},
    {.info = {AG_LAYER_POSITION, "P", .about = "where the first surface is, in world space"},
     .channels = CHANNELS({"P", "XYZ", CHANNEL_HIT_MEAN, .sum = SUM_POSITION, .is_exact = true})},
    {.info = {AG_LAYER_UV, "uv", .about = "the first surface's coordinates"},
     .channels = CHANNELS({"", "uv", CHANNEL_HIT_MEAN, .sum = SUM_UV, .is_exact = true})},
    {.info = {AG_LAYER_IRRADIANCE, "irradiance",
              .about = "the irradiance by the photon map at the first surface, W/m^2"},
     .channels = CHANNELS({"irradiance", "RGB", CHANNEL_COLOR, .sum = SUM_IRRADIANCE}),
     .is_of_photon_map = true},
    {.info = {AG_LAYER_VARIANCE, "variance", .about = "the variance of the pixel's samples"},
     .channels = CHANNELS({"variance", "RGB", CHANNEL_VARIANCE, .sum = SUM_SQUARES, .is_exact = true})},
    {.info = {AG_LAYER_SAMPLES, "samples", .about = "how many samples the pixel has had"},
     .channels = CHANNELS({"samples.V", NULL, CHANNEL_SAMPLES, .is_exact = true})},
    {.info = {AG_LAYER_ID, "id", .about = "the numbers of the nearest surface's object and material, from 1 on"},
     .channels = CHANNELS({"id.object.V", NULL, CHANNEL_OBJECT, .is_exact = true},
                          {"id.material.V", NULL, CHANNEL_MATERIAL, .is_exact = true})},
    {.info = {AG_LAYER_PHOTON_DENSITY, "photon_density",
              .about = "photons per area, 1/m^2, at what the pixel's middle shows"},
     VIEW("photon_density.V", VIEW_PHOTON_DENSITY),
     .is_of_photon_map = true},
    {.info = {AG_LAYER_CACHE_STATE, "cache_state",
              .about =
                  "1: irradiance was not demanded at the photon nearest to there, 2: it was, with *--photon-map* by "
                  "any picture so far"},
     VIEW("cache_state.V", VIEW_CACHE_STATE),
     .is_of_photon_map = true},
    {.info = {AG_LAYER_PHOTON_DISTANCE, "photon_distance", .about = "how far that photon is"},
     VIEW("photon_distance.V", VIEW_PHOTON_DISTANCE),
     .is_of_photon_map = true},
    {.info = {AG_LAYER_GATHER_DISTANCE, "gather_distance", .about = "how far gather rays from there go, harmonic mean"},
     VIEW("gather_distance.V", VIEW_GATHER_DISTANCE),
     .is_of_photon_map = true},
    {.info = {AG_LAYER_TILE_TIME, "tile_time", .about = "how many seconds the pixel's tile took",
              .is_left_out_of_all = true},
     VIEW("tile_time.V", VIEW_TILE_TIME)},
    {.info = {AG_LAYER_CRYPTO_OBJECT, "crypto_object", "crypto",
              .about = "Cryptomatte by the names of objects: instances, glTF nodes, mesh files"},
     .expansion = LAYER_BY_RANK,
     .matte = CRYPTOMATTE_OBJECT,
     .matte_name = "CryptoObject"},
    {.info = {AG_LAYER_CRYPTO_MATERIAL, "crypto_material", "crypto", .about = "Cryptomatte by the names of materials"},
     .expansion = LAYER_BY_RANK,
     .matte = CRYPTOMATTE_MATERIAL,
     .matte_name = "CryptoMaterial"},
    {.info = {AG_LAYER_LIGHT_GROUPS, "lightgroups",
              .about =
                  "the light of the lamps of each group (\"string lightgroup\" of a light in the scene; the others "
                  "are _default_), and of what came through the photon map"},
     .expansion = LAYER_BY_LIGHT_GROUP},
};

const layer_row *layer_at(size_t index) { return index < sizeof ROWS / sizeof *ROWS ? &ROWS[index] : NULL; }

const ag_layer_info *ag_layer_at(size_t index)
{
    const layer_row *row = layer_at(index);
    return row ? &row->info : NULL;
}

/* --- their names --- */

const char *layer_name(uint32_t layer)
{
    for (size_t i = 0; layer_at(i); i++)
        if ((uint32_t)layer_at(i)->info.layer == layer)
            return layer_at(i)->info.name;
    return "";
}

uint32_t layers_known(void)
{
    uint32_t layers = 0;
    for (size_t i = 0; layer_at(i); i++)
        layers |= (uint32_t)layer_at(i)->info.layer;
    return layers;
}

static bool is_word(const char *name, const char *word, size_t length)
{
    return name && strlen(name) == length && strncmp(name, word, length) == 0;
}

/* The layers that a word names: one, those of a group, or all; 0: none. */
static uint32_t layers_of_word(const char *word, size_t length)
{
    uint32_t layers = 0;
    for (size_t i = 0; layer_at(i); i++) {
        const ag_layer_info *info = &layer_at(i)->info;
        if (is_word(info->name, word, length) || is_word(info->group, word, length) ||
            (is_word("all", word, length) && !info->is_left_out_of_all))
            layers |= (uint32_t)info->layer;
    }
    return layers;
}

ag_status ag_layers_parse(const char *list, uint32_t *out_layers)
{
    if (!list || !out_layers)
        return AG_ERROR_ARGUMENT;
    uint32_t layers = 0;
    for (const char *at = list;; at++) {
        size_t length = strcspn(at, ",");
        uint32_t found = layers_of_word(at, length);
        if (!found)
            return AG_ERROR_ARGUMENT;
        layers |= found;
        at += length;
        if (*at == '\0')
            break;
    }
    *out_layers = layers;
    return AG_OK;
}
