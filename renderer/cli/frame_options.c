/* frame_options.c: see frame_options.h. */
#define _POSIX_C_SOURCE 200809L
#include "frame_options.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Makes the definitions of one frame: its number in their values, and as "frame" where that is not defined. */
static bool define_frame(const options *o, int frame, options *one)
{
    char number[16];
    snprintf(number, sizeof number, "%d", frame);
    one->definition_count = 0;
    one->definitions = calloc(o->definition_count + 1, sizeof *one->definitions);
    bool is_whole = one->definitions != NULL, is_named = false;
    for (size_t i = 0; is_whole && i < o->definition_count; i++) {
        const ag_definition *from = &o->definitions[i];
        ag_definition *to = &one->definitions[one->definition_count++];
        is_named = is_named || strcmp(from->name, "frame") == 0;
        *to = (ag_definition){.name = strdup(from->name), .value = frames_name(from->value, frame)};
        is_whole = to->name && to->value;
    }
    if (is_whole && !is_named) {
        ag_definition *to = &one->definitions[one->definition_count++];
        *to = (ag_definition){.name = strdup("frame"), .value = strdup(number), .is_optional = true};
        is_whole = to->name && to->value;
    }
    return is_whole;
}

bool frame_options_make(const options *o, int frame, options *out_one)
{
    options one = *o;
    bool is_whole = define_frame(o, frame, &one);
    one.outfiles = calloc((size_t)o->outfile_count + 1, sizeof *one.outfiles);
    for (int i = 0; one.outfiles && i < o->outfile_count; i++)
        is_whole = (one.outfiles[i] = frames_name(o->outfiles[i], frame)) && is_whole;
    one.scene = frames_name(o->scene, frame);
    one.seed_pattern = o->seed_pattern ? frames_name(o->seed_pattern, frame) : NULL;
    one.frame = frame;
    one.of_all_frames = o;
    one.stats = o->stats ? frames_name(o->stats, frame) : NULL;
    one.photons_file = o->photons_file ? frames_name(o->photons_file, frame) : NULL;
    one.render.photon_map_file = o->render.photon_map_file ? frames_name(o->render.photon_map_file, frame) : NULL;
    one.asked.sky_file = o->asked.sky_file ? frames_name(o->asked.sky_file, frame) : NULL;
    *out_one = one;
    return is_whole && one.outfiles && one.scene && (one.stats || !o->stats) &&
           (one.photons_file || !o->photons_file) && (one.seed_pattern || !o->seed_pattern) &&
           (one.render.photon_map_file || !o->render.photon_map_file) && (one.asked.sky_file || !o->asked.sky_file);
}

void frame_options_reset(options *one, int outfile_count)
{
    for (int i = 0; one->outfiles && i < outfile_count; i++)
        free((void *)(uintptr_t)one->outfiles[i]);
    free((void *)one->outfiles);
    free((void *)(uintptr_t)one->scene);
    free((void *)(uintptr_t)one->stats);
    free((void *)(uintptr_t)one->photons_file);
    free((void *)(uintptr_t)one->render.photon_map_file);
    free((void *)(uintptr_t)one->asked.sky_file);
    free((void *)(uintptr_t)one->seed_pattern);
    for (size_t i = 0; i < one->definition_count; i++)
        options_free_definition(&one->definitions[i]);
    free(one->definitions);
}
