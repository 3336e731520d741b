/* aov.c: see aov.h. */
#include "film/aov.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const int SUM_WIDTH[FILM_SUM_COUNT] = {
    [SUM_RADIANCE] = 3,    [SUM_ALPHA] = 1,        [SUM_PARTS] = 3 * LIGHT_PART_COUNT,
    [SUM_ALBEDO] = 3,      [SUM_NORMAL] = 3,       [SUM_GEOMETRIC_NORMAL] = 3,
    [SUM_POSITION] = 3,    [SUM_UV] = 2,           [SUM_SLOPE] = 2,
    [SUM_IRRADIANCE] = 3,  [SUM_SQUARES] = 3,      [SUM_DEVELOPED] = 3,
    [SUM_HIT_SQUARES] = 3, [SUM_HIT_DEVELOPED] = 3};

typedef struct layer_name {
    const char *name;
    uint32_t layers;
} layer_name;

/* As the command line names them. */
static const layer_name NAMES[] = {
    {"A", AG_LAYER_ALPHA},
    {"Z", AG_LAYER_DEPTH},
    {"albedo", AG_LAYER_ALBEDO},
    {"N", AG_LAYER_NORMAL},
    {"P", AG_LAYER_POSITION},
    {"uv", AG_LAYER_UV},
    {"emission", AG_LAYER_EMISSION},
    {"direct", AG_LAYER_DIRECT},
    {"indirect", AG_LAYER_INDIRECT},
    {"caustic", AG_LAYER_CAUSTIC},
    {"specular", AG_LAYER_SPECULAR},
    {"irradiance", AG_LAYER_IRRADIANCE},
    {"variance", AG_LAYER_VARIANCE},
    {"samples", AG_LAYER_SAMPLES},
    {"id", AG_LAYER_ID},
    {"lightgroups", AG_LAYER_LIGHT_GROUPS},
    {"gbuffer", AG_LAYER_GBUFFER},
    {"photon_density", AG_LAYER_PHOTON_DENSITY},
    {"cache_state", AG_LAYER_CACHE_STATE},
    {"photon_distance", AG_LAYER_PHOTON_DISTANCE},
    {"gather_distance", AG_LAYER_GATHER_DISTANCE},
    {"tile_time", AG_LAYER_TILE_TIME},
    {"crypto_object", AG_LAYER_CRYPTO_OBJECT},
    {"crypto_material", AG_LAYER_CRYPTO_MATERIAL},
    {"crypto", AG_LAYER_CRYPTO_OBJECT | AG_LAYER_CRYPTO_MATERIAL},
    {"light", AG_LAYERS_LIGHT},
    {"all", AG_LAYERS_ALL},
};

const char *aov_layer_name(uint32_t layer)
{
    size_t i = 0;
    while (i + 1 < sizeof NAMES / sizeof *NAMES && NAMES[i].layers != layer)
        i++;
    return NAMES[i].name;
}

ag_status ag_layers_parse(const char *list, uint32_t *out_layers)
{
    if (!list || !out_layers)
        return AG_ERROR_ARGUMENT;
    uint32_t layers = 0;
    for (const char *at = list;; at++) {
        size_t length = strcspn(at, ",");
        uint32_t found = 0;
        for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++)
            if (strlen(NAMES[i].name) == length && strncmp(NAMES[i].name, at, length) == 0)
                found = NAMES[i].layers;
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

/* --- what is summed --- */

static void want(aov_layout *layout, bool is_wanted, film_sum sum, int width)
{
    if (!is_wanted || layout->offset[sum] >= 0)
        return;
    layout->offset[sum] = layout->sum_count;
    layout->sum_count += width;
}

static void lay_out_sums(aov_layout *layout, aov_needs also)
{
    uint32_t layers = layout->layers;
    const struct {
        uint32_t layers;
        film_sum sum;
    } needs[] = {
        {AG_LAYERS_LIGHT, SUM_PARTS},
        {AG_LAYER_ALPHA | AG_LAYER_POSITION | AG_LAYER_UV | AG_LAYER_GBUFFER, SUM_ALPHA},
        {AG_LAYER_ALBEDO | AG_LAYER_GBUFFER, SUM_ALBEDO},
        {AG_LAYER_NORMAL | AG_LAYER_GBUFFER, SUM_NORMAL},
        {AG_LAYER_GBUFFER, SUM_GEOMETRIC_NORMAL},
        {AG_LAYER_POSITION | AG_LAYER_GBUFFER, SUM_POSITION},
        {AG_LAYER_UV | AG_LAYER_GBUFFER, SUM_UV},
        {AG_LAYER_GBUFFER, SUM_SLOPE},
        {AG_LAYER_IRRADIANCE, SUM_IRRADIANCE},
        {AG_LAYER_VARIANCE, SUM_SQUARES},
        {AG_LAYER_VARIANCE, SUM_DEVELOPED},
        {AG_LAYER_GBUFFER, SUM_HIT_SQUARES},
        {AG_LAYER_GBUFFER, SUM_HIT_DEVELOPED},
    };
    for (int i = 0; i < FILM_SUM_COUNT; i++)
        layout->offset[i] = -1;
    want(layout, true, SUM_RADIANCE, SUM_WIDTH[SUM_RADIANCE]);
    for (size_t i = 0; i < sizeof needs / sizeof *needs; i++)
        want(layout, layers & needs[i].layers, needs[i].sum, SUM_WIDTH[needs[i].sum]);
    want(layout, also.albedo_and_normal, SUM_ALBEDO, SUM_WIDTH[SUM_ALBEDO]);
    want(layout, also.albedo_and_normal, SUM_NORMAL, SUM_WIDTH[SUM_NORMAL]);
    want(layout, also.variance, SUM_SQUARES, SUM_WIDTH[SUM_SQUARES]);
    want(layout, also.variance, SUM_DEVELOPED, SUM_WIDTH[SUM_DEVELOPED]);
    want(layout, layers & AG_LAYER_LIGHT_GROUPS, SUM_GROUPS, 3 * (layout->group_count + 1));
    layout->needs_nearest = layers & (AG_LAYER_DEPTH | AG_LAYER_ID);
    layout->has_matte[CRYPTOMATTE_OBJECT] = layers & AG_LAYER_CRYPTO_OBJECT;
    layout->has_matte[CRYPTOMATTE_MATERIAL] = layers & AG_LAYER_CRYPTO_MATERIAL;
    layout->needs_first_hit = layout->needs_nearest || layout->has_matte[0] || layout->has_matte[1] ||
                              aov_has(layout, SUM_ALPHA) || aov_has(layout, SUM_ALBEDO) ||
                              aov_has(layout, SUM_NORMAL) || aov_has(layout, SUM_IRRADIANCE);
    int of_radiance = SUM_WIDTH[SUM_RADIANCE];
    if (aov_has(layout, SUM_SQUARES))
        of_radiance += SUM_WIDTH[SUM_SQUARES] + SUM_WIDTH[SUM_DEVELOPED];
    layout->needs_layers = layout->sum_count > of_radiance || layout->needs_first_hit;
}

/* --- channels --- */

typedef struct channel_style {
    channel_source source;
    film_sum sum;
    int skipped; /* components of the sum that lie before */
    bool is_exact;
} channel_style;

static void add_channel(aov_layout *layout, channel_style style, int component, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static void add_channel(aov_layout *layout, channel_style style, int component, const char *format, ...)
{
    film_channel made = {.source = style.source, .sum = style.sum, .component = component, .is_exact = style.is_exact};
    made.offset = layout->offset[style.sum] + style.skipped;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(made.name, sizeof made.name, format, arguments);
    va_end(arguments);
    for (int i = 0; i < layout->channel_count; i++)
        if (strcmp(layout->channels[i].name, made.name) == 0)
            return;
    layout->channels[layout->channel_count++] = made;
}

/* One for each letter. */
static void add_channels(aov_layout *layout, channel_style style, const char *layer, const char *letters)
{
    for (int i = 0; letters[i]; i++)
        add_channel(layout, style, i, "%s%s%c", layer, *layer ? "." : "", letters[i]);
}

static void add_gbuffer(aov_layout *layout)
{
    add_channels(layout, (channel_style){CHANNEL_MEAN, SUM_ALBEDO, 0, false}, "Albedo", "RGB");
    add_channels(layout, (channel_style){CHANNEL_HIT_MEAN, SUM_POSITION, 0, true}, "P", "XYZ");
    add_channel(layout, (channel_style){CHANNEL_ABSOLUTE, SUM_SLOPE, 0, true}, 0, "dzdx");
    add_channel(layout, (channel_style){CHANNEL_ABSOLUTE, SUM_SLOPE, 0, true}, 1, "dzdy");
    add_channels(layout, (channel_style){CHANNEL_DIRECTION, SUM_GEOMETRIC_NORMAL, 0, false}, "N", "XYZ");
    add_channels(layout, (channel_style){CHANNEL_DIRECTION, SUM_NORMAL, 0, false}, "Ns", "XYZ");
    add_channels(layout, (channel_style){CHANNEL_HIT_MEAN, SUM_UV, 0, true}, "", "uv");
    add_channels(layout, (channel_style){CHANNEL_VARIANCE, SUM_HIT_SQUARES, 0, true}, "Variance", "RGB");
    add_channels(layout, (channel_style){CHANNEL_RELATIVE_VARIANCE, SUM_HIT_SQUARES, 0, true}, "RelativeVariance",
                 "RGB");
}

/* Two ranks to a layer: id and coverage, id and coverage. */
static void add_cryptomatte(aov_layout *layout, cryptomatte_kind kind, const char *name)
{
    for (int i = 0; layout->has_matte[kind] && i < 2 * CRYPTOMATTE_RANKS; i++) {
        channel_source source = i % 2 == 0 ? CHANNEL_CRYPTO_ID : CHANNEL_CRYPTO_COVERAGE;
        add_channel(layout, (channel_style){source, SUM_RADIANCE, 0, true}, i / 2 + CRYPTOMATTE_RANKS * (int)kind,
                    "%s%02d.%c", name, i / 4, "RGBA"[i % 4]);
    }
}

static void lay_out_channels(aov_layout *layout)
{
    static const struct {
        uint32_t layer;
        const char *name;
    } parts[LIGHT_PART_COUNT] = {[PART_EMISSION] = {AG_LAYER_EMISSION, "emission"},
                                 [PART_DIRECT] = {AG_LAYER_DIRECT, "direct"},
                                 [PART_INDIRECT] = {AG_LAYER_INDIRECT, "indirect"},
                                 [PART_CAUSTIC] = {AG_LAYER_CAUSTIC, "caustic"},
                                 [PART_SPECULAR] = {AG_LAYER_SPECULAR, "specular"}};
    const struct {
        uint32_t layer;
        channel_style style;
        const char *name, *letters;
    } simple[] = {
        {AG_LAYER_ALBEDO, {CHANNEL_MEAN, SUM_ALBEDO, 0, false}, "albedo", "RGB"},
        {AG_LAYER_NORMAL, {CHANNEL_MEAN, SUM_NORMAL, 0, false}, "N", "XYZ"},
        {AG_LAYER_POSITION, {CHANNEL_HIT_MEAN, SUM_POSITION, 0, true}, "P", "XYZ"},
        {AG_LAYER_UV, {CHANNEL_HIT_MEAN, SUM_UV, 0, true}, "", "uv"},
        {AG_LAYER_IRRADIANCE, {CHANNEL_COLOR, SUM_IRRADIANCE, 0, false}, "irradiance", "RGB"},
        {AG_LAYER_VARIANCE, {CHANNEL_VARIANCE, SUM_SQUARES, 0, true}, "variance", "RGB"},
    };
    uint32_t layers = layout->layers;
    add_channels(layout, (channel_style){CHANNEL_BEAUTY, SUM_RADIANCE, 0, false}, "", "RGB");
    if (layers & AG_LAYER_ALPHA)
        add_channel(layout, (channel_style){CHANNEL_MEAN, SUM_ALPHA, 0, false}, 0, "A");
    if (layers & AG_LAYER_GBUFFER)
        add_gbuffer(layout); /* first: where a layer of ours has the same name, it is pbrt's */
    if (layers & AG_LAYER_DEPTH)
        add_channel(layout, (channel_style){CHANNEL_DEPTH, SUM_RADIANCE, 0, true}, 0, "Z");
    for (int i = 0; i < LIGHT_PART_COUNT; i++)
        if (layers & parts[i].layer)
            add_channels(layout, (channel_style){CHANNEL_COLOR, SUM_PARTS, 3 * i, false}, parts[i].name, "RGB");
    for (size_t i = 0; i < sizeof simple / sizeof *simple; i++)
        if (layers & simple[i].layer)
            add_channels(layout, simple[i].style, simple[i].name, simple[i].letters);
    if (layers & AG_LAYER_SAMPLES)
        add_channel(layout, (channel_style){CHANNEL_SAMPLES, SUM_RADIANCE, 0, true}, 0, "samples");
    if (layers & AG_LAYER_ID) {
        add_channel(layout, (channel_style){CHANNEL_OBJECT, SUM_RADIANCE, 0, true}, 0, "id.object");
        add_channel(layout, (channel_style){CHANNEL_MATERIAL, SUM_RADIANCE, 0, true}, 0, "id.material");
    }
    static const struct {
        uint32_t layer;
        film_view view;
        const char *name;
    } views[] = {{AG_LAYER_PHOTON_DENSITY, VIEW_PHOTON_DENSITY, "photon_density"},
                 {AG_LAYER_CACHE_STATE, VIEW_CACHE_STATE, "cache_state"},
                 {AG_LAYER_PHOTON_DISTANCE, VIEW_PHOTON_DISTANCE, "photon_distance"},
                 {AG_LAYER_GATHER_DISTANCE, VIEW_GATHER_DISTANCE, "gather_distance"},
                 {AG_LAYER_TILE_TIME, VIEW_TILE_TIME, "tile_time"}};
    for (size_t i = 0; i < sizeof views / sizeof *views; i++)
        if (layers & views[i].layer) {
            layout->has_view[views[i].view] = true;
            add_channel(layout, (channel_style){CHANNEL_VIEW, SUM_RADIANCE, 0, true}, (int)views[i].view, "%s",
                        views[i].name);
        }
    add_cryptomatte(layout, CRYPTOMATTE_OBJECT, "CryptoObject");
    add_cryptomatte(layout, CRYPTOMATTE_MATERIAL, "CryptoMaterial");
    for (int i = 0; (layers & AG_LAYER_LIGHT_GROUPS) && i <= layout->group_count; i++) {
        char name[64];
        snprintf(name, sizeof name, "light_%.50s", i < layout->group_count ? layout->group_names[i] : "photons");
        add_channels(layout, (channel_style){CHANNEL_COLOR, SUM_GROUPS, 3 * i, false}, name, "RGB");
    }
}

ag_status aov_layout_create(uint32_t layers, aov_needs also, bool is_path, const char *const *group_names,
                            int group_count, aov_layout *out_layout)
{
    aov_layout layout = {.layers = layers, .group_count = group_count, .group_names = group_names};
    if (is_path) /* what only the photon map knows */
        layout.layers &= ~(uint32_t)(AG_LAYER_IRRADIANCE | AG_LAYER_PHOTON_DENSITY | AG_LAYER_CACHE_STATE |
                                     AG_LAYER_PHOTON_DISTANCE | AG_LAYER_GATHER_DISTANCE);
    layout.is_gbuffer = layout.layers & AG_LAYER_GBUFFER;
    lay_out_sums(&layout, also);
    layout.channels = calloc((size_t)(96 + 3 * (LIGHT_PART_COUNT + group_count + 1)), sizeof *layout.channels);
    if (!layout.channels)
        return AG_ERROR_MEMORY;
    lay_out_channels(&layout);
    *out_layout = layout;
    return AG_OK;
}

void aov_layout_reset(aov_layout *layout)
{
    free(layout->channels);
    *layout = (aov_layout){0};
}
