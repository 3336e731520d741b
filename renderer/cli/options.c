/* options.c: see options.h. One table makes both the parser and the help. */
#define _GNU_SOURCE
#include "options.h"

#include "option_values.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum {
    OPT_SEED = 256,
    OPT_SPP,
    OPT_SIZE,
    OPT_CROP,
    OPT_INTEGRATOR,
    OPT_CACHE,
    OPT_ONLY,
    OPT_PANE_LIGHT,
    OPT_PHOTONS,
    OPT_CAUSTIC_PHOTONS,
    OPT_NEAREST,
    OPT_RADIUS,
    OPT_IRRADIANCE_FRACTION,
    OPT_GATHER_GUIDING,
    OPT_PHOTON_AIM,
    OPT_DIRECT_GUIDING,
    OPT_GATHER,
    OPT_MAX_DEPTH,
    OPT_TYPE,
    OPT_AOV,
    OPT_CLAMP_DIRECT,
    OPT_CLAMP_INDIRECT,
    OPT_DENOISE,
    OPT_DUMP_PHOTONS,
    OPT_PHOTONS_ONLY,
    OPT_PHOTON_MAP,
    OPT_PHOTON_MAP_REFRESH,
    OPT_TILED,
    OPT_REPRODUCIBLE,
    OPT_OCIO,
    OPT_DISPLAY,
    OPT_VIEW,
    OPT_LOOK,
    OPT_EXPOSURE,
    OPT_WORKING_SPACE,
    OPT_OUTPUT_SPACE,
    OPT_LIST_DISPLAYS,
    OPT_STATS,
    OPT_CHECKPOINT,
    OPT_RESUME,
    OPT_TIME_LIMIT,
    OPT_PREVIEW,
    OPT_FRAMES,
    OPT_NO_CLOBBER,
    OPT_CONFINE,
    OPT_CONFINE_TO,
    OPT_TILE,
    OPT_NOISE,
    OPT_MIN_SPP,
    OPT_PROGRESS,
    OPT_ISA,
    OPT_VERSION
};

typedef struct option_line {
    int code;
    const char *name, *argument; /* NULL: takes none */
    const char *help;            /* lines after the first are indented by the printer */
} option_line;

static const option_line LINES[] = {
    {'o', "outfile", "FILE",
     "write the picture to FILE; may be repeated; .exr is scene-linear,\n.png, .tif and .jpg go through a display and "
     "view (default: the Film's\nfilename, else SCENE.exr)"},
    {'D', "define", "NAME=VALUE",
     "put VALUE in the place of $NAME and ${NAME} in the scene's text; may be\nrepeated; with --frames $frame is the "
     "frame's number"},
    {'t', "nthreads", "N", "threads (default: what affinity mask and cgroup quota allow)"},
    {OPT_SEED, "seed", "N", "seed of all random numbers (default: the scene's, else 0)"},
    {OPT_SPP, "spp", "N",
     "samples per pixel; with --noise the most of them (default 1024), with\n--noise 0 just as many (default: the "
     "scene's, else 16)"},
    {OPT_NOISE, "noise", "LEVEL",
     "as many samples up to --spp as it takes for this noise in what is\nshown, where white is 1: 0.02 is fair, 0.01 "
     "good, 0.003 clean; the\ndefault is 0.02, but 0 with --spp, and for scenes that have Integrator\n\"photonmap\" "
     "and a Sampler"},
    {OPT_MIN_SPP, "min-spp", "N", "samples per pixel at least, with --noise (default 16)"},
    {OPT_SIZE, "size", "WxH", "size of the full picture in pixels"},
    {OPT_CROP, "cropwindow", "X0,X1,Y0,Y1", "part of the picture to render, each in [0, 1]"},
    {OPT_TILE, "tile", "I/N", "the I-th of N bands of the picture, from the top, from 1 on"},
    {OPT_INTEGRATOR, "integrator", "NAME", "photonmap (default) or path"},
    {OPT_CACHE, "cache", "MODE",
     "irradiance at the photons: on-demand (default) and precompute give the\nsame bits; off computes it at every "
     "gather hit instead, with other bits"},
    {OPT_ONLY, "only", "indirect", "leave out emission, and direct light at the first non-specular hit"},
    {OPT_PANE_LIGHT, "pane-light", "MODE",
     "light straight through thin glass: direct (default), sampled at its\nlamp, or traced, like light through other "
     "glass"},
    {OPT_PHOTONS, "photons", "N", "photons to store in the global map (default 1000000)"},
    {OPT_CAUSTIC_PHOTONS, "caustic-photons", "N",
     "photons to store in the caustic map (default 500000, where there is\nspecular matter)"},
    {OPT_NEAREST, "nearest", "K", "photons of an irradiance estimate (default 50)"},
    {OPT_RADIUS, "radius", "R", "largest radius of an estimate, scene units; 0: from the photons' density"},
    {OPT_IRRADIANCE_FRACTION, "irradiance-fraction", "F",
     "irradiance is borne by this fraction of the photons, above 0, 1 at\nmost (default 1): 0.125 is faster, and a "
     "little more blurred"},
    {OPT_GATHER, "gather-samples", "N", "gather rays for each camera sample (default: 256 a pixel in all)"},
    {OPT_GATHER_GUIDING, "gather-guiding", "F",
     "how much photons decide where gather rays go, from 0 (not at all) to 1\n(default 0.5); the rest is the cosine"},
    {OPT_PHOTON_AIM, "photon-aim", "F",
     "share of the photon paths that begin where they bring light to where the\npicture asks for it, from 0 to 0.8 "
     "(default 0.8; of a map that is kept 0)"},
    {OPT_DIRECT_GUIDING, "direct-guiding", "F",
     "share of the shadow rays that go to what a pilot has seen of sun, sky and\nlamps from there, from 0 to 0.8 "
     "(default 0.8; with --integrator path 0)"},
    {OPT_MAX_DEPTH, "max-depth", "N", "scatterings between lamp and eye at most, up to 100 (default: roulette)"},
    {OPT_CLAMP_DIRECT, "clamp-direct", "V", "no sample gets more than V of direct light; 0 (default): unbounded"},
    {OPT_CLAMP_INDIRECT, "clamp-indirect", "V", "the same of indirect light"},
    {OPT_TYPE, "type", "NAME", "stored samples: half, float, uint8 or uint16"},
    {OPT_AOV, "aov", "LIST",
     "layers of .exr files, by commas: A, Z, albedo, N, P, uv; the parts of\nlight: emission, direct, indirect, "
     "caustic, "
     "specular, or all five: light;\nirradiance, variance, samples, id, lightgroups; photon_density,\ncache_state, "
     "photon_distance, gather_distance, tile_time;\ncrypto_object, crypto_material, or both: crypto; gbuffer; or all"},
    {OPT_DENOISE, "denoise", NULL, "take the noise out with Open Image Denoise, where its library is there"},
    {OPT_DUMP_PHOTONS, "dump-photons", "FILE", "write the photons as PLY"},
    {OPT_PHOTONS_ONLY, "photons-only", NULL,
     "render no picture: for --photon-map, which later runs read, or\n--dump-photons"},
    {OPT_PHOTON_MAP, "photon-map", "FILE",
     "keep the photon map and its irradiances in FILE: read where it is there,\nelse traced; processes that use it at "
     "once fill it together"},
    {OPT_PHOTON_MAP_REFRESH, "photon-map-refresh", NULL,
     "trace the map anew where that of FILE is of another scene or settings,\nor damaged"},
    {OPT_TILED, "tiled", NULL, "write .exr files in tiles, not in lines"},
    {OPT_REPRODUCIBLE, "reproducible", NULL,
     "leave out of .exr files what differs from run to run: times, threads, ..."},
    {OPT_OCIO, "ocio", "FILE", "OpenColorIO config (default: $OCIO, else the one built in)"},
    {OPT_DISPLAY, "display", "NAME", "display of the config"},
    {OPT_VIEW, "view", "NAME", "view of the display"},
    {OPT_LOOK, "look", "NAMES",
     "looks of the config, with commas between them, - before one that is\nto be undone; none: not even the view's "
     "own"},
    {OPT_EXPOSURE, "exposure", "STOPS", "of pictures for displays: light times 2^STOPS, before the view"},
    {OPT_WORKING_SPACE, "working-space", "NAME",
     "colour space that light is carried in (default: the config's role\nrendering, else scene_linear)"},
    {OPT_OUTPUT_SPACE, "output-space", "NAME", "colour space of .exr files (default: the working space)"},
    {OPT_LIST_DISPLAYS, "list-displays", NULL, "print the config's displays, views, looks, colour spaces and roles"},
    {OPT_STATS, "stats", "FILE", "write statistics as JSON"},
    {OPT_FRAMES, "frames", "LIST",
     "render frames, as 1-100, 1-100x2 or 1,5,9; %d, %04d and #### in names of\nfiles, SCENE too, and in -D's values are "
     "the frame's number"},
    {OPT_CONFINE, "confine", NULL,
     "for scenes of strangers: read files below the scene's folder alone, and\nwrite only what the command line names"},
    {OPT_CONFINE_TO, "confine-to", "FOLDER", "the same, and files below FOLDER may be read, too; may be repeated"},
    {OPT_NO_CLOBBER, "no-clobber", NULL, "skip pictures that are there already, and complete"},
    {OPT_CHECKPOINT, "checkpoint", "SECONDS",
     "write down what there is so often, and at a signal, to OUTFILE.afterglow-checkpoint"},
    {OPT_TIME_LIMIT, "time-limit", "TIME", "stop after so many seconds, or HH:MM:SS, with the samples that there are"},
    {OPT_PREVIEW, "preview", NULL, "write the picture after 1, 2, 4, ... samples per pixel, too"},
    {OPT_RESUME, "resume", NULL, "go on from that file, where it is there, to the same bits"},
    {OPT_PROGRESS, "progress", "STYLE", "auto (default), bar, plain (or lines), alf, json or none (or off)"},
    {OPT_ISA, "isa", "NAME",
     "widest instruction set of ray traversal: sse2, sse4.2, avx, avx2\n(default), avx512; another one may give other "
     "bits"},
    {'q', "quiet", NULL, "errors only"},
    {'v', "verbose", NULL, "also say what was done; twice: also what is harmless in the scene"},
    {'h', "help", NULL, "this text"},
    {OPT_VERSION, "version", NULL, "the program's version"},
};
enum { LINE_COUNT = sizeof LINES / sizeof *LINES };

static void print_help(void)
{
    printf("usage: afterglow [options] SCENE\n"
           "Renders a scene with photon mapping and final gathering: pbrt-v4 text (plain or gzip; - is standard "
           "input), glTF,\n"
           "OBJ, PLY, STL, Collada, FBX and what else assimp reads.\n"
           "Values that are not given come from the scene, else from defaults.\n\n");
    for (int i = 0; i < LINE_COUNT; i++) {
        char left[64];
        int at = LINES[i].code < 256 ? snprintf(left, sizeof left, "-%c, ", LINES[i].code)
                                     : snprintf(left, sizeof left, "    ");
        snprintf(left + at, sizeof left - (size_t)at, "--%s%s%s", LINES[i].name, LINES[i].argument ? " " : "",
                 LINES[i].argument ? LINES[i].argument : "");
        printf("  %-32s", left);
        for (const char *c = LINES[i].help; *c; c++) {
            putchar(*c);
            if (*c == '\n')
                printf("%34s", "");
        }
        putchar('\n');
    }
    printf("\nExit status: 0 every file is complete on disk; 1 scene or input error; 2 usage; 3 system;\n"
           "128 + n ended by signal n.\n");
}

#define WORDS(...)                                                                                                     \
    (const char *const[]){__VA_ARGS__}, (int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *))

/* "NAME=VALUE"; of two with one name the last counts. Out of memory is told as not valid. */
static bool take_definition(const char *text, options *o)
{
    size_t length = strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_"), i = 0;
    if (text[length] != '=' || length == 0 || (text[0] >= '0' && text[0] <= '9'))
        return false;
    ag_definition *larger = realloc(o->definitions, (o->definition_count + 1) * sizeof *larger);
    char *name = strndup(text, length), *value = strdup(text + length + 1);
    if (larger)
        o->definitions = larger;
    if (!larger || !name || !value) {
        free(name);
        free(value);
        return false;
    }
    while (i < o->definition_count && strcmp(o->definitions[i].name, name) != 0)
        i++;
    if (i == o->definition_count)
        o->definition_count++;
    else
        options_free_definition(&o->definitions[i]);
    o->definitions[i] = (ag_definition){.name = name, .value = value};
    return true;
}

/* One option; false when its argument is not valid. */
static bool take_option(int code, const char *value, options *o)
{
    ag_render_settings *r = &o->render;
    int word = 0;
    bool is_valid = true;
    switch (code) {
    case 'o': o->outfiles[o->outfile_count++] = value; break;
    case 'D': is_valid = take_definition(value, o); break;
    case 't': {
        int threads;
        is_valid = parse_int(value, 1, 4096, &threads);
        o->context.thread_count = is_valid ? (unsigned)threads : 0;
        break;
    }
    /* what JSON can hold as an integer */
    case OPT_SEED: is_valid = o->has_seed = parse_unsigned(value, INT64_MAX, &r->seed); break;
    case OPT_SPP: is_valid = o->has_spp = parse_int(value, 1, 1 << 20, &r->samples_per_pixel); break;
    case OPT_SIZE: is_valid = o->has_size = parse_size(value, &r->width, &r->height); break;
    case OPT_CROP: is_valid = o->has_crop = parse_crop(value, r->crop_window); break;
    case OPT_INTEGRATOR:
        is_valid = o->has_integrator = parse_word(value, WORDS("photonmap", "path"), &word);
        r->integrator = (ag_integrator)word;
        break;
    case OPT_CACHE:
        is_valid = parse_word(value, WORDS("on-demand", "precompute", "off"), &word);
        r->cache = (ag_cache_mode)word;
        break;
    case OPT_ONLY:
        is_valid = parse_word(value, WORDS("indirect"), &word);
        r->only = AG_ONLY_INDIRECT;
        break;
    case OPT_PANE_LIGHT:
        is_valid = parse_word(value, WORDS("direct", "traced"), &word);
        r->pane_light = (ag_pane_light)word;
        break;
    case OPT_PHOTONS: is_valid = o->has_photons = parse_count(value, 1, &r->photon_count); break;
    case OPT_CAUSTIC_PHOTONS:
        is_valid = o->has_caustic_photons = parse_count(value, 0, &r->caustic_photon_count);
        break;
    case OPT_NEAREST: is_valid = o->has_nearest = parse_int(value, 1, 65536, &r->nearest); break;
    case OPT_RADIUS: is_valid = o->has_radius = parse_bound(value, &r->radius); break;
    case OPT_IRRADIANCE_FRACTION:
        is_valid = o->has_irradiance_fraction = parse_fraction(value, &r->irradiance_fraction);
        break;
    case OPT_GATHER_GUIDING: is_valid = o->has_gather_guiding = parse_share(value, &r->gather_guiding); break;
    case OPT_DIRECT_GUIDING:
        is_valid = o->has_direct_guiding =
            parse_share(value, &r->direct_guiding) && r->direct_guiding <= AG_DEFAULT_DIRECT_GUIDING;
        break;
    case OPT_PHOTON_AIM:
        is_valid = o->has_photon_aim = parse_share(value, &r->photon_aim) && r->photon_aim <= AG_DEFAULT_PHOTON_AIM;
        break;
    case OPT_AOV: {
        uint32_t layers = 0;
        is_valid = ag_layers_parse(value, &layers) == AG_OK;
        r->layers |= layers;
        break;
    }
    case OPT_CLAMP_DIRECT: is_valid = parse_bound(value, &r->clamp_direct); break;
    case OPT_CLAMP_INDIRECT: is_valid = parse_bound(value, &r->clamp_indirect); break;
    case OPT_DENOISE: r->denoise = true; break;
    case OPT_DUMP_PHOTONS: o->photons_file = value; break;
    case OPT_PHOTONS_ONLY: o->photons_only = true; break;
    case OPT_PHOTON_MAP: r->photon_map_file = value; break;
    case OPT_PHOTON_MAP_REFRESH: r->photon_map_refresh = true; break;
    case OPT_TILED: o->output.tiled = true; break;
    case OPT_REPRODUCIBLE: o->output.reproducible = true; break;
    case OPT_GATHER: is_valid = o->has_gather_samples = parse_int(value, 1, 65536, &r->gather_samples); break;
    case OPT_MAX_DEPTH: is_valid = o->has_max_depth = parse_int(value, 0, 100, &r->max_depth); break;
    case OPT_TYPE:
        is_valid = parse_word(value, WORDS("default", "uint8", "uint16", "half", "float"), &word);
        o->output.type = (ag_sample_type)word;
        break;
    case OPT_CHECKPOINT: is_valid = parse_seconds(value, &o->checkpoint_seconds); break;
    case OPT_TIME_LIMIT: is_valid = parse_time(value, &o->time_limit); break;
    case OPT_PREVIEW: o->preview = true; break;
    case OPT_NOISE: is_valid = o->has_noise = parse_bound(value, &r->noise_level); break;
    case OPT_MIN_SPP: is_valid = o->has_noise_min_samples = parse_int(value, 2, 1 << 20, &r->noise_min_samples); break;
    case OPT_FRAMES:
        frames_reset(&o->frames);
        is_valid = frames_parse(value, &o->frames);
        break;
    case OPT_CONFINE: o->context.is_confined = true; break;
    case OPT_CONFINE_TO:
        o->context.is_confined = true;
        o->confined_to[o->context.confined_count++] = value;
        o->context.confined_to = o->confined_to;
        break;
    case OPT_NO_CLOBBER: o->no_clobber = true; break;
    case OPT_TILE: is_valid = parse_tile(value, &o->tile_index, &o->tile_count); break;
    case OPT_RESUME: o->resume = true; break;
    case OPT_OCIO: o->context.color_config = value; break;
    case OPT_DISPLAY: o->output.display = value; break;
    case OPT_VIEW: o->output.view = value; break;
    case OPT_LOOK: o->output.look = value; break;
    case OPT_EXPOSURE:
        is_valid = parse_float(value, &o->output.exposure_stops) && fabsf(o->output.exposure_stops) <= 100.0f;
        break;
    case OPT_WORKING_SPACE: o->context.working_space = value; break;
    case OPT_OUTPUT_SPACE: o->output.color_space = value; break;
    case OPT_LIST_DISPLAYS: o->lists_displays = true; break;
    case OPT_STATS: o->stats = value; break;
    case OPT_PROGRESS:
        is_valid = parse_word(value, WORDS("auto", "bar", "plain", "json", "none", "alf", "lines", "off"), &word);
        o->progress = word == 6 ? PROGRESS_PLAIN : word == 7 ? PROGRESS_NONE : (progress_style)word;
        break;
    case OPT_ISA:
        is_valid = parse_word(value, WORDS("sse2", "sse4.2", "avx", "avx2", "avx512"), &word);
        o->context.isa = value;
        break;
    case 'q': o->verbosity = -1; break;
    case 'v': o->verbosity = o->verbosity < 0 ? 1 : o->verbosity + 1; break;
    default: break;
    }
    return is_valid;
}

static const option_line *option_line_of(int code)
{
    int i = 0;
    while (LINES[i].code != code)
        i++;
    return &LINES[i];
}

/* Frames would be written one over the other. */
static bool has_frames_in_one_file(const options *o)
{
    const char *name = o->stats && !frames_has_place(o->stats) ? o->stats : NULL;
    if (o->photons_file && !frames_has_place(o->photons_file))
        name = o->photons_file;
    for (int i = 0; i < o->outfile_count; i++)
        if (!frames_has_place(o->outfiles[i]))
            name = o->outfiles[i];
    if (name)
        fprintf(stderr, "afterglow: '%s' has no place for the frame's number: %%04d or ####\n", name);
    return name;
}

/* With a blank between; to be freed, NULL when out of memory. */
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

/* What is asked for must be for one of the files, where they are known. */
static bool has_idle_picture_option(const options *o)
{
    int exr_count = 0;
    for (int i = 0; i < o->outfile_count; i++) {
        size_t length = strlen(o->outfiles[i]);
        exr_count += length >= 4 && strcasecmp(o->outfiles[i] + length - 4, ".exr") == 0;
    }
    if (o->outfile_count == 0)
        return false;
    const ag_output_settings *s = &o->output;
    const char *of_displays = s->display               ? "display"
                              : s->view                ? "view"
                              : s->look                ? "look"
                              : s->exposure_stops != 0 ? "exposure"
                                                       : NULL;
    if (of_displays && exr_count == o->outfile_count)
        fprintf(stderr, "afterglow: --%s is for pictures that are not .exr, and there is none\n", of_displays);
    else if (s->color_space && exr_count == 0)
        fprintf(stderr, "afterglow: --output-space is for .exr files, and there is none\n");
    else if (o->render.layers && exr_count == 0)
        fprintf(stderr, "afterglow: --aov is for .exr files, and there is none\n");
    else
        return false;
    return true;
}

/* Where the config is to be shown, nothing is rendered. */
static bool has_scene_to_list(const options *o, int rest)
{
    if (!o->lists_displays || (rest == 0 && o->outfile_count == 0))
        return false;
    fprintf(stderr, "afterglow: --list-displays renders nothing: it goes with %s\n",
            rest > 0 ? "no scene" : "no --outfile");
    return true;
}

/* Where there is no picture, nothing may be asked of it. */
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
                                                     : NULL;
    if (idle)
        fprintf(stderr, "afterglow: --photons-only renders no picture: it does not go with %s\n", idle);
    else if (!has_file)
        fprintf(stderr, "afterglow: --photons-only: nothing is to be written: give --photon-map or --dump-photons\n");
    return idle || !has_file;
}

options_result options_parse(int argc, char **argv, options *out_options)
{
    struct option longs[LINE_COUNT + 1];
    for (int i = 0; i < LINE_COUNT; i++)
        longs[i] =
            (struct option){LINES[i].name, LINES[i].argument ? required_argument : no_argument, NULL, LINES[i].code};
    longs[LINE_COUNT] = (struct option){0};

    options o = {.context = ag_default_context_settings(), .output = ag_default_output_settings()};
    o.outfiles = calloc((size_t)argc + 1, sizeof *o.outfiles);
    o.confined_to = calloc((size_t)argc + 1, sizeof *o.confined_to);
    o.command_line = join_arguments(argc, argv); /* before getopt moves them */
    if (!o.outfiles || !o.confined_to || !o.command_line) {
        options_reset(&o);
        return OPTIONS_EXIT_USAGE;
    }
    options_result result = OPTIONS_RUN;
    int code;
    while (result == OPTIONS_RUN && (code = getopt_long(argc, argv, "o:D:t:qvh", longs, NULL)) != -1) {
        if (code == '?') {
            result = OPTIONS_EXIT_USAGE; /* getopt has said what is wrong */
        } else if (code == 'h') {
            print_help();
            result = OPTIONS_EXIT_OK;
        } else if (code == OPT_VERSION) {
            printf("afterglow %s\n", ag_version());
            result = OPTIONS_EXIT_OK;
        } else if (!take_option(code, optarg, &o)) {
            const option_line *line = option_line_of(code);
            fprintf(stderr, "afterglow: --%s: '%s' is not valid: %s %s: %s\n", line->name, optarg, line->name,
                    line->argument, line->help);
            result = OPTIONS_EXIT_USAGE;
        }
    }
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
    if (result == OPTIONS_RUN && (has_idle_picture_option(&o) || has_picture_of_photons_only(&o)))
        result = OPTIONS_EXIT_USAGE;
    if (result == OPTIONS_EXIT_USAGE)
        fprintf(stderr, "Try 'afterglow --help'.\n");
    if (result != OPTIONS_RUN) {
        options_reset(&o);
        return result;
    }
    o.scene = o.lists_displays ? NULL : argv[optind];
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
    free(o->outfiles);
    free((void *)o->confined_to);
    frames_reset(&o->frames);
    free(o->command_line);
    *o = (options){0};
}

/* A band of the crop window's rows. */
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

bool options_override(const options *o, const ag_scene *scene, ag_render_settings *settings)
{
    const ag_render_settings *r = &o->render;
    settings->cache = r->cache;
    settings->only = r->only;
    settings->integrator = r->integrator;
    settings->layers |= r->layers;
    settings->denoise = r->denoise;
    settings->photon_map_file = r->photon_map_file;
    settings->photon_map_refresh = r->photon_map_refresh;
    settings->pane_light = r->pane_light;
    settings->clamp_direct = r->clamp_direct;
    settings->clamp_indirect = r->clamp_indirect;
    settings->noise_level = o->has_noise                                    ? r->noise_level
                            : o->has_spp || ag_scene_has_own_samples(scene) ? 0.0f
                                                                            : AG_DEFAULT_NOISE_LEVEL;
    settings->shown_exposure_stops = o->output.exposure_stops;
    if (o->has_irradiance_fraction)
        settings->irradiance_fraction = r->irradiance_fraction;
    if (o->has_noise_min_samples)
        settings->noise_min_samples = r->noise_min_samples;
    if (o->has_seed)
        settings->seed = r->seed;
    if (o->has_size)
        settings->width = r->width, settings->height = r->height;
    if (o->has_crop)
        memcpy(settings->crop_window, r->crop_window, sizeof settings->crop_window);
    if (o->has_photons)
        settings->photon_count = r->photon_count;
    if (o->has_caustic_photons)
        settings->caustic_photon_count = r->caustic_photon_count;
    if (o->has_nearest)
        settings->nearest = r->nearest;
    if (o->has_radius)
        settings->radius = r->radius;
    if (o->has_max_depth)
        settings->max_depth = r->max_depth;
    if (o->has_spp)
        settings->samples_per_pixel = r->samples_per_pixel;
    else if (settings->noise_level > 0.0f)
        settings->samples_per_pixel = AG_DEFAULT_SAMPLES_MOST;
    if (o->has_gather_guiding)
        settings->gather_guiding = r->gather_guiding;
    if (o->has_direct_guiding)
        settings->direct_guiding = r->direct_guiding;
    if (o->has_photon_aim)
        settings->photon_aim = r->photon_aim;
    if (o->has_gather_samples)
        settings->gather_samples = r->gather_samples;
    return o->tile_count == 0 || take_tile(o, settings);
}
