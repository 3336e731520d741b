/* options.c: see options.h. What options there are is in option_rows.c, and in renderer/settings_rows.c. */
#define _GNU_SOURCE
#include "options.h"

#include "option_guess.h"
#include "option_help.h"
#include "option_rows.h"

#include <assert.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { OPTIONS_MAX = 128, FIRST_CODE = 256 }; /* codes below are letters */

/* Refuses a name without a placeholder, under which each frame would be written over the one before. */
static bool has_frames_in_one_file(const options *o)
{
    const char *name = o->stats && !frames_has_placeholder(o->stats) ? o->stats : NULL;
    if (o->photons_file && !frames_has_placeholder(o->photons_file))
        name = o->photons_file;
    for (int i = 0; i < o->outfile_count; i++)
        if (!frames_has_placeholder(o->outfiles[i]))
            name = o->outfiles[i];
    if (name)
        fprintf(stderr, "afterglow: '%s' has no placeholder for the frame's number: %%04d or ####\n", name);
    return name;
}

/* Joins the arguments with blanks between; the text is to be freed, NULL when out of memory. */
static char *join_arguments(int argc, char **argv)
{
    size_t size = 1;
    for (int i = 0; i < argc; i++)
        size += strlen(argv[i]) + 1;
    char *joined = calloc(size, 1);
    for (int i = 0; joined && i < argc; i++) {
        strcat(joined, argv[i]);
        if (i + 1 < argc)
            strcat(joined, " ");
    }
    return joined;
}

/* Refuses a seed for each frame where there are no frames. */
static bool has_odd_seeds(const options *o)
{
    if (!o->seed_per_frame && !o->seed_pattern)
        return false;
    if (o->frames.count == 0)
        fprintf(stderr, "afterglow: %s is for --frames, which is not given\n",
                o->seed_per_frame ? "--seed-per-frame" : "a placeholder for the frame's number in --seed");
    else if (o->seed_per_frame && o->seed_pattern)
        fprintf(stderr, "afterglow: --seed-per-frame, and a placeholder for the frame's number in --seed: give one\n");
    else
        return false;
    return true;
}

/* A camera is asked for by its position and what it looks at. */
static bool has_half_a_camera(const options *o)
{
    const int parts = o->has_camera_from + o->has_camera_to;
    if (parts == 2 || (parts == 0 && !o->has_camera_detail))
        return false;
    fprintf(stderr, "afterglow: a camera is asked for by --camera-from and --camera-to together\n");
    return true;
}

/* An option about a camera, a sun or a sky is a mistake where none of that kind is asked for. */
static bool has_idle_scene_option(const options *o)
{
    const ag_scene_settings *asked = &o->asked;
    if (o->has_sky_detail && !asked->has_sky)
        fprintf(stderr, "afterglow: --sky-strength and --sky-rotation are for --sky, which is not given\n");
    else if (asked->camera_name && asked->has_camera)
        fprintf(stderr, "afterglow: --camera and --camera-from are two cameras: give one\n");
    else
        return false;
    return true;
}

/* Refuses an address to listen at where nothing listens. */
static bool has_idle_address(const options *o)
{
    if (!o->serve_address || o->serves)
        return false;
    fprintf(stderr, "afterglow: --serve-address is for --serve, which is not given\n");
    return true;
}

/* Settings that follow from several options together. */
static void settle_scene_options(options *o)
{
    for (int i = 0; i < 3; i++)
        o->asked.sky_radiance[i] *= o->sky_strength;
}

/* Each wish must be for one of the files, where they are known. */
static bool has_idle_picture_option(const options *o)
{
    int exr_count = 0, linear_count = 0;
    for (int i = 0; i < o->outfile_count; i++) {
        const char *dot = strrchr(o->outfiles[i], '.');
        const bool is_exr = dot && strcasecmp(dot, ".exr") == 0;
        exr_count += is_exr;
        linear_count += is_exr || (dot && (strcasecmp(dot, ".hdr") == 0 || strcasecmp(dot, ".pfm") == 0));
    }
    if (o->outfile_count == 0)
        return false;
    const ag_output_settings *s = &o->output;
    const char *of_displays = s->display               ? "display"
                              : s->view                ? "view"
                              : s->look                ? "look"
                              : s->exposure_stops != 0 ? "exposure"
                                                       : NULL;
    const bool is_shown = o->progress == PROGRESS_PICTURE || o->serves; /* these show it by display and view */
    if (of_displays && linear_count == o->outfile_count && !is_shown)
        fprintf(stderr, "afterglow: --%s is for pictures that are not .exr, .hdr or .pfm, and there is none\n",
                of_displays);
    else if (s->color_space && linear_count == 0)
        fprintf(stderr, "afterglow: --output-space is for .exr, .hdr and .pfm files, and there is none\n");
    else if (o->render.layers && exr_count == 0 && !o->serves)
        fprintf(stderr, "afterglow: --aov is for .exr files, and there is none\n");
    else
        return false;
    return true;
}

/* Refuses a scene or an outfile where the displays are to be listed, since nothing is rendered then. */
static bool has_scene_to_list(const options *o, int rest)
{
    if (!o->lists_displays || (rest == 0 && o->outfile_count == 0))
        return false;
    fprintf(stderr, "afterglow: --list-displays renders nothing: it goes with %s\n",
            rest > 0 ? "no scene" : "no --outfile");
    return true;
}

/* Where photons alone are made, refuses options of a picture, and that no photons are written. */
static bool has_picture_of_photons_only(const options *o)
{
    if (!o->photons_only)
        return false;
    bool has_file = o->photons_file || o->render.photon_map_file;
    const char *idle = o->outfile_count > 0          ? "--outfile"
                       : o->preview                  ? "--preview"
                       : o->resume                   ? "--resume"
                       : o->checkpoint_seconds > 0.0 ? "--checkpoint"
                       : o->no_clobber               ? "--no-clobber"
                       : o->render.denoise           ? "--denoise"
                       : o->serves                   ? "--serve"
                                                     : NULL;
    if (idle)
        fprintf(stderr, "afterglow: --photons-only renders no picture: it does not go with %s\n", idle);
    else if (!has_file)
        fprintf(stderr, "afterglow: --photons-only: nothing is to be written: give --photon-map or --dump-photons\n");
    return idle || !has_file;
}

/* Returns the option that getopt_long has found: by its number, which is no character's, or by its letter. */
static listed_option option_of_code(int code)
{
    listed_option option;
    if (code >= FIRST_CODE) {
        (void)option_at((size_t)(code - FIRST_CODE), &option);
        return option;
    }
    for (size_t i = 0; option_at(i, &option) && !(option.row && option.row->letter == code); i++)
        ;
    return option;
}

/* Tells, in a message of our own, which option getopt_long did not take. */
static void tell_wrong_option(int code, char **argv)
{
    char name[64];
    const char *word = argv[optind - 1];
    if (code == ':') {
        listed_option option = option_of_code(optopt);
        fprintf(stderr, "afterglow: --%s needs a value: ", option.text->name);
        option_help_print_line(stderr, option.text);
    } else if (optopt >= FIRST_CODE) {
        fprintf(stderr, "afterglow: '%s': --%s takes no value\n", word, option_of_code(optopt).text->name);
    } else if (optopt > 0) {
        fprintf(stderr, "afterglow: there is no option -%c\n", optopt);
    } else {
        snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
        const size_t length = strlen(name);
        listed_option option;
        int begun = 0;
        for (size_t i = 0; length > 0 && option_at(i, &option); i++) {
            if (strncmp(option.text->name, name, length) != 0)
                continue;
            if (begun++ == 0)
                fprintf(stderr, "afterglow: --%s is the beginning of several options", name);
            fprintf(stderr, "%s --%s", begun == 1 ? ":" : ",", option.text->name);
        }
        const char *guess = begun == 0 ? option_guess(name) : NULL;
        if (begun > 0)
            fputc('\n', stderr);
        else if (guess)
            fprintf(stderr, "afterglow: there is no option --%s: did you mean --%s?\n", name, guess);
        else
            fprintf(stderr, "afterglow: there is no option --%s\n", name);
    }
}

/* getopt_long's tables, with each option's number in the list as its code. */
static void describe_options(struct option longs[OPTIONS_MAX + 1], char letters[2 * OPTIONS_MAX + 2])
{
    listed_option option;
    size_t count = 0, used = 0;
    letters[used++] = ':'; /* getopt_long tells a missing value from an unknown option */
    for (; option_at(count, &option); count++) {
        assert(count < OPTIONS_MAX);
        longs[count] = (struct option){option.text->name, option.text->argument ? required_argument : no_argument, NULL,
                                       FIRST_CODE + (int)count};
        if (option.row && option.row->letter) {
            letters[used++] = option.row->letter;
            if (option.text->argument)
                letters[used++] = ':';
        }
    }
    longs[count] = (struct option){0};
    letters[used] = '\0';
}

/* Takes one option after the other, until one is wrong, or asks for a text. */
static options_result take_options(int argc, char **argv, options *o)
{
    struct option longs[OPTIONS_MAX + 1];
    char letters[2 * OPTIONS_MAX + 2];
    int code;
    opterr = 0; /* tell_wrong_option says it */
    describe_options(longs, letters);
    while ((code = getopt_long(argc, argv, letters, longs, NULL)) != -1) {
        if (code == '?' || code == ':') {
            tell_wrong_option(code, argv);
            return OPTIONS_EXIT_USAGE;
        }
        listed_option option = option_of_code(code);
        if (!option_take(&option, optarg, o)) {
            fprintf(stderr, "afterglow: --%s: '%s' is not valid: ", option.text->name, optarg);
            option_help_print_line(stderr, option.text);
            return OPTIONS_EXIT_USAGE;
        }
        if (o->asked_text == OPTIONS_ASKED_HELP)
            option_help_print(stdout);
        else if (o->asked_text == OPTIONS_ASKED_VERSION)
            printf("afterglow %s\n", ag_version());
        if (o->asked_text != OPTIONS_ASKED_NOTHING)
            return OPTIONS_EXIT_OK;
    }
    return OPTIONS_RUN;
}

options_result options_parse(int argc, char **argv, options *out_options)
{
    options o = {.asked = ag_default_scene_settings(),
                 .context = ag_default_context_settings(),
                 .output = ag_default_output_settings(),
                 .render = ag_default_render_settings(),
                 .sky_strength = 1.0f};
    o.outfiles = calloc((size_t)argc + 1, sizeof *o.outfiles);
    o.outfile_types = calloc((size_t)argc + 1, sizeof *o.outfile_types);
    o.typed_names = calloc((size_t)argc + 1, sizeof *o.typed_names);
    o.confined_to = calloc((size_t)argc + 1, sizeof *o.confined_to);
    o.given = calloc((size_t)argc + 1, sizeof *o.given);
    o.command_line = join_arguments(argc, argv); /* before getopt_long reorders them */
    if (!o.outfiles || !o.outfile_types || !o.typed_names || !o.confined_to || !o.given || !o.command_line) {
        options_reset(&o);
        return OPTIONS_EXIT_USAGE;
    }
    options_result result = take_options(argc, argv, &o);
    if (result == OPTIONS_RUN && has_scene_to_list(&o, argc - optind))
        result = OPTIONS_EXIT_USAGE;
    if (result == OPTIONS_RUN && !o.lists_displays && optind != argc - 1) {
        fprintf(stderr,
                optind < argc ? "afterglow: one scene at a time: '%s' is one too many\n"
                              : "afterglow: no scene given%s\n",
                optind < argc ? argv[optind + 1] : "");
        result = OPTIONS_EXIT_USAGE;
    }
    if (result == OPTIONS_RUN && o.frames.count > 1 && has_frames_in_one_file(&o))
        result = OPTIONS_EXIT_USAGE;
    if (result == OPTIONS_RUN &&
        (has_odd_seeds(&o) || has_half_a_camera(&o) || has_idle_scene_option(&o) || has_idle_picture_option(&o) ||
         has_picture_of_photons_only(&o) || has_idle_address(&o)))
        result = OPTIONS_EXIT_USAGE;
    if (result == OPTIONS_EXIT_USAGE)
        fprintf(stderr, "Try 'afterglow --help'.\n");
    if (result != OPTIONS_RUN) {
        options_reset(&o);
        return result;
    }
    o.scene = o.lists_displays ? NULL : argv[optind];
    settle_scene_options(&o);
    o.output.command_line = o.command_line;
    *out_options = o;
    return OPTIONS_RUN;
}

void options_free_definition(ag_definition *definition)
{
    free((void *)(uintptr_t)definition->name);
    free((void *)(uintptr_t)definition->value);
}

void options_reset(options *o)
{
    for (size_t i = 0; i < o->definition_count; i++)
        options_free_definition(&o->definitions[i]);
    free(o->definitions);
    for (int i = 0; o->typed_names && i < o->outfile_count; i++)
        free(o->typed_names[i]);
    free(o->typed_names);
    free(o->outfile_types);
    free(o->outfiles);
    free((void *)o->confined_to);
    free(o->given);
    frames_reset(&o->frames);
    free(o->command_line);
    *o = (options){0};
}

/* Cuts the crop window down to a band of its rows. */
static bool take_tile(const options *o, ag_render_settings *settings)
{
    double height = settings->height, *crop = settings->crop_window;
    int begin = (int)ceil(crop[2] * height - 1e-6), rows = (int)ceil(crop[3] * height - 1e-6) - begin;
    if (o->tile_count > rows)
        return false;
    crop[2] = (begin + (int)((long)rows * (o->tile_index - 1) / o->tile_count)) / height;
    crop[3] = (begin + (int)((long)rows * o->tile_index / o->tile_count)) / height;
    return true;
}

static bool has_setting(const options *o, const char *name)
{
    for (int i = 0; i < o->given_count; i++)
        if (strcmp(o->given[i].name, name) == 0)
            return true;
    return false;
}

ag_output_settings options_output(const options *o, int index)
{
    ag_output_settings settings = o->output;
    if (o->outfile_types[index] != AG_SAMPLE_DEFAULT)
        settings.type = o->outfile_types[index];
    return settings;
}

bool options_override(const options *o, const ag_scene *scene, ag_render_settings *settings)
{
    for (int i = 0; i < o->given_count; i++)
        (void)ag_render_settings_set(settings, o->given[i].name, o->given[i].value); /* options_parse has tried it */
    if (o->render.photon_map_file)
        settings->photon_map_file = o->render.photon_map_file; /* its name has the frame's number in it */
    bool has_own_seed = o->seed_pattern || o->seed_per_frame;
    if (has_own_seed && settings->photon_map_file && settings->photon_seed == AG_PHOTON_SEED_AUTOMATIC)
        settings->photon_seed = settings->seed; /* one map for all frames */
    if (o->seed_pattern)
        (void)ag_render_settings_set(settings, "seed", o->seed_pattern); /* options_parse has tried it */
    if (o->seed_per_frame)
        settings->seed += (uint64_t)o->frame;
    bool has_spp = has_setting(o, "spp");
    if (!has_setting(o, "noise"))
        settings->noise_level = has_spp || ag_scene_has_own_samples(scene) ? 0.0f : AG_DEFAULT_NOISE_LEVEL;
    if (!has_spp && settings->noise_level > 0.0f)
        settings->samples_per_pixel = AG_DEFAULT_SAMPLES_MOST;
    settings->shown_exposure_stops = o->output.exposure_stops;
    return o->tile_count == 0 || take_tile(o, settings);
}
