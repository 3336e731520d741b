/* aov.c: see aov.h. */
#include "film/aov.h"

#include "film/layer_table.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- channels --- */

/* Adds the channels of the layers that are asked for; the first time through there is no room for any, and they are
 * counted. */
typedef struct channel_list {
    film_channel *channels; /* [capacity], or NULL */
    int count, capacity;
} channel_list;

static void add_channel(channel_list *list, const film_channel *style, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Adds a channel, unless there is one of that name. */
static void add_channel(channel_list *list, const film_channel *style, const char *format, ...)
{
    if (!list->channels) {
        list->count++;
        return;
    }
    film_channel made = *style;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(made.name, sizeof made.name, format, arguments);
    va_end(arguments);
    for (int i = 0; i < list->count; i++)
        if (strcmp(list->channels[i].name, made.name) == 0)
            return;
    assert(list->count < list->capacity);
    list->channels[list->count++] = made;
}

static void add_alike(channel_list *list, const layer_channels *c)
{
    film_channel style = {
        .source = c->source, .sum = c->sum, .component = c->component, .offset = c->skipped, .is_exact = c->is_exact};
    if (!c->letters)
        add_channel(list, &style, "%s", c->name);
    for (int i = 0; c->letters && c->letters[i]; i++, style.component++)
        add_channel(list, &style, "%s%s%c", c->name, c->name[0] ? "." : "", c->letters[i]);
}

/* Two ranks to a layer: id and coverage, id and coverage. */
static void add_cryptomatte(channel_list *list, const layer_row *row)
{
    for (int i = 0; i < 2 * CRYPTOMATTE_RANKS; i++) {
        film_channel style = {.source = i % 2 == 0 ? CHANNEL_CRYPTO_ID : CHANNEL_CRYPTO_COVERAGE,
                              .component = i / 2 + CRYPTOMATTE_RANKS * (int)row->matte,
                              .is_exact = true};
        add_channel(list, &style, "%s%02d.%c", row->matte_name, i / 4, "RGBA"[i % 4]);
    }
}

static void add_light_groups(channel_list *list, const aov_layout *layout)
{
    for (int i = 0; i <= layout->group_count; i++) {
        const char *group = i < layout->group_count ? layout->group_names[i] : "photons";
        film_channel style = {.source = CHANNEL_COLOR, .sum = SUM_GROUPS, .offset = 3 * i};
        for (; style.component < 3; style.component++)
            add_channel(list, &style, "light_%.50s.%c", group, "RGB"[style.component]);
    }
}

static void list_channels(channel_list *list, const aov_layout *layout)
{
    static const layer_channels beauty = {"", "RGB", CHANNEL_BEAUTY, .sum = SUM_RADIANCE};
    add_alike(list, &beauty);
    for (size_t i = 0; layer_at(i); i++) {
        const layer_row *row = layer_at(i);
        if (!(layout->layers & (uint32_t)row->info.layer))
            continue;
        for (const layer_channels *c = row->channels; c && c->name; c++)
            add_alike(list, c);
        if (row->expansion == LAYER_BY_RANK)
            add_cryptomatte(list, row);
        else if (row->expansion == LAYER_BY_LIGHT_GROUP)
            add_light_groups(list, layout);
    }
}

/* --- what they need --- */

/* The sums that a channel is read from, a bit each; and what else the film keeps for it. */
static uint32_t note_needs(const film_channel *channel, aov_layout *layout)
{
    const uint32_t sum = 1u << channel->sum, hits = 1u << SUM_HITS;
    switch (channel->source) {
    case CHANNEL_BEAUTY:
    case CHANNEL_COLOR:
    case CHANNEL_MEAN:
    case CHANNEL_DIRECTION: return sum;
    case CHANNEL_HIT_MEAN:
    case CHANNEL_ABSOLUTE: return sum | hits;
    case CHANNEL_VARIANCE:
    case CHANNEL_RELATIVE_VARIANCE:
        return channel->sum == SUM_HIT_SQUARES ? sum | 1u << SUM_HIT_DEVELOPED | hits : sum | 1u << SUM_DEVELOPED;
    case CHANNEL_DEPTH:
    case CHANNEL_OBJECT:
    case CHANNEL_MATERIAL: layout->needs_nearest = true; break;
    case CHANNEL_VIEW: layout->has_view[channel->component] = true; break;
    case CHANNEL_CRYPTO_ID:
    case CHANNEL_CRYPTO_COVERAGE: layout->has_matte[channel->component / CRYPTOMATTE_RANKS] = true; break;
    case CHANNEL_SAMPLES: break;
    }
    return 0;
}

static const struct {
    int width;
    bool needs_first_hit;
} SUMS[FILM_SUM_COUNT] = {
#define SUM_ROW(sum, width, needs_first_hit)             [sum] = {width, needs_first_hit},
#define SUM_OF_VALUE(sum, type, member, needs_first_hit) [sum] = {sizeof(type) / sizeof(float), needs_first_hit},
    FILM_SUM_LIST(SUM_ROW, SUM_OF_VALUE, SUM_OF_VALUE)
#undef SUM_ROW
#undef SUM_OF_VALUE
};

_Static_assert(FILM_SUM_COUNT <= 32, "lay_out_sums has a bit for each");

static int sum_width(const aov_layout *layout, film_sum sum)
{
    return sum == SUM_GROUPS ? 3 * (layout->group_count + 1) : SUMS[sum].width;
}

static void lay_out_sums(aov_layout *layout, aov_needs also)
{
    uint32_t sums = 1u << SUM_RADIANCE;
    for (int i = 0; i < layout->channel_count; i++)
        sums |= note_needs(&layout->channels[i], layout);
    if (also.albedo_and_normal)
        sums |= 1u << SUM_ALBEDO | 1u << SUM_NORMAL;
    if (also.variance)
        sums |= 1u << SUM_SQUARES | 1u << SUM_DEVELOPED;
    for (film_sum i = 0; i < FILM_SUM_COUNT; i++) {
        layout->offset[i] = sums >> i & 1u ? layout->sum_count : -1;
        layout->sum_count += sums >> i & 1u ? sum_width(layout, i) : 0;
    }
    for (int i = 0; i < layout->channel_count; i++)
        layout->channels[i].offset += layout->offset[layout->channels[i].sum];
    layout->needs_first_hit =
        layout->needs_nearest || layout->has_matte[CRYPTOMATTE_OBJECT] || layout->has_matte[CRYPTOMATTE_MATERIAL];
    for (film_sum i = 0; i < FILM_SUM_COUNT; i++)
        layout->needs_first_hit = layout->needs_first_hit || (aov_has(layout, i) && SUMS[i].needs_first_hit);
    int of_radiance = sum_width(layout, SUM_RADIANCE);
    if (aov_has(layout, SUM_SQUARES))
        of_radiance += sum_width(layout, SUM_SQUARES) + sum_width(layout, SUM_DEVELOPED);
    layout->needs_layers = layout->sum_count > of_radiance || layout->needs_first_hit;
}

ag_status aov_layout_create(uint32_t layers, aov_needs also, bool is_path, const char *const *group_names,
                            int group_count, aov_layout *out_layout)
{
    aov_layout layout = {.layers = layers, .group_count = group_count, .group_names = group_names};
    for (size_t i = 0; layer_at(i); i++)
        if (is_path && layer_at(i)->is_of_photon_map)
            layout.layers &= ~(uint32_t)layer_at(i)->info.layer;
    channel_list list = {0};
    list_channels(&list, &layout);
    list = (channel_list){.capacity = list.count, .channels = calloc((size_t)list.count, sizeof *list.channels)};
    if (!list.channels)
        return AG_ERROR_MEMORY;
    list_channels(&list, &layout);
    layout.channels = list.channels;
    layout.channel_count = list.count;
    lay_out_sums(&layout, also);
    *out_layout = layout;
    return AG_OK;
}

void aov_layout_reset(aov_layout *layout)
{
    free(layout->channels);
    *layout = (aov_layout){0};
}
