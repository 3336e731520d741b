/* option_rows_output.c: see option_row_lists.h. help is for --help; manual is for the man page, *bold* and _italic_. */
#define _GNU_SOURCE
#include "option_row_lists.h"

#include "option_values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool take_outfile(const char *value, options *o)
{
    static const char *const TYPES[] = {":uint8", ":uint16", ":half", ":float"};
    const size_t length = strlen(value);
    o->outfiles[o->outfile_count] = value;
    for (int i = 0; i < 4; i++) {
        const size_t end = strlen(TYPES[i]);
        if (length <= end || strcmp(value + length - end, TYPES[i]) != 0)
            continue;
        char *name = strndup(value, length - end);
        if (!name)
            return false;
        o->outfiles[o->outfile_count] = o->typed_names[o->outfile_count] = name;
        o->outfile_types[o->outfile_count] = (ag_sample_type)(AG_SAMPLE_UINT8 + i);
    }
    o->outfile_count++;
    return true;
}

static bool take_type(const char *value, options *o)
{
    int word;
    bool is_valid = parse_word(value, WORDS("default", "uint8", "uint16", "half", "float"), &word);
    o->output.type = (ag_sample_type)word;
    return is_valid;
}

static bool take_exposure(const char *value, options *o)
{
    return parse_float(value, &o->output.exposure_stops) && fabsf(o->output.exposure_stops) <= 100.0f;
}

static const option_row ROWS[] = {
    {.text = {.name = "outfile",
              .argument = "FILE[:TYPE]",
              .section = "Output",
              .help = "write the picture to FILE, its samples of TYPE (default: --type); may be repeated; .exr, .hdr "
                      "and .pfm are scene-linear, .png, .tif and .jpg go through a display and view (default: the "
                      "Film's filename, else SCENE.exr)",
              .manual = "Write the picture to _FILE_. May be repeated. The extension chooses the format: _.exr_, "
                        "_.hdr_ (Radiance, shared exponents) and _.pfm_ (floats) are scene-linear, of which _.exr_ "
                        "alone has layers and says its colour space; _.png_, _.tif_ and _.jpg_ go through a display "
                        "and a view. _TYPE_ is one of those of *--type*, for this file alone: _a.exr:float_. A file "
                        "appears "
                        "complete or not at all. Without this option, the file that the scene's Film names is "
                        "written, else _SCENE_ with _.exr_ for its extension, in the working directory."},
     .letter = 'o',
     .take = take_outfile},
    {.text = {.name = "type",
              .argument = "NAME",
              .section = "Output",
              .help = "stored samples of files that name no type: half, float, uint8 or uint16",
              .manual = "How samples are stored, in files of *-o* that name no type of their own: *half*, *float*, "
                        "*uint8* or *uint16*. The default is *half* for OpenEXR, *float* for Radiance and PFM, "
                        "*uint16* for TIFF, and *uint8* for the others."},
     .take = take_type},
    {.text = {.name = "tiled",
              .section = "Output",
              .help = "write .exr files in tiles, not in lines",
              .manual = "Write _.exr_ files in tiles of 64 by 64 pixels, not in lines."},
     FLAG(output.tiled)},
    {.text = {.name = "reproducible",
              .section = "Output",
              .help = "leave out of .exr files what differs from run to run: times, threads, ...",
              .manual = "Leave out of _.exr_ files what differs from run to run: command line, times, memory, CPU, "
                        "threads. Then equal pictures are equal files."},
     FLAG(output.reproducible)},
    {.text = {.name = "dump-photons",
              .argument = "FILE",
              .section = "Output",
              .help = "write the photons as PLY",
              .manual = "Write the photons as PLY, with normals, directions, power, their map, and whether "
                        "irradiance was computed there."},
     TEXT(photons_file)},
    {.text = {.name = "photons-only",
              .section = "Output",
              .help = "render no picture: for --photon-map, which later runs read, or --dump-photons",
              .manual = "Trace the photons and render no picture: a farm's first job, whose photon map "
                        "(*--photon-map*) the others read, or photons for a viewer (*--dump-photons*). With *--cache "
                        "precompute* all irradiances are computed, too."},
     FLAG(photons_only)},
    {.text = {.name = "ocio",
              .argument = "FILE",
              .section = "Output",
              .help = "OpenColorIO config (default: $OCIO, else the one built in)",
              .manual = "OpenColorIO config. The default is *$OCIO*, else the config that is built in."},
     TEXT(context.color_config)},
    {.text = {.name = "display",
              .argument = "NAME",
              .section = "Output",
              .help = "display of the config",
              .manual = "Display of the config. This and the next three are for all pictures but OpenEXR."},
     TEXT(output.display)},
    {.text = {.name = "view",
              .argument = "NAME",
              .section = "Output",
              .help = "view of the display",
              .manual = "View of the display."},
     TEXT(output.view)},
    {.text = {.name = "look",
              .argument = "NAMES",
              .section = "Output",
              .help = "looks of the config, with commas between them, - before one that is to be undone; none: not "
                      "even the view's own",
              .manual = "Looks of the config instead of the view's own, with commas between them; *-* before one "
                        "undoes it, *none* leaves out the view's own too."},
     TEXT(output.look)},
    {.text = {.name = "exposure",
              .argument = "STOPS",
              .section = "Output",
              .help = "of pictures for displays: light times 2^STOPS, before the view",
              .manual = "Light is multiplied by 2 to this, before the look and the view."},
     .take = take_exposure},
    {.text = {.name = "working-space",
              .argument = "NAME",
              .section = "Output",
              .help = "colour space that light is carried in (default: the config's role rendering, else "
                      "scene_linear)",
              .manual = "Colour space of the config that light is carried in, by its name, an alias or a role; it "
                        "must be linear. Colours, spectra and pictures of the scene are converted to it as they are "
                        "read. The default is the config's role *rendering*, else *scene_linear*, which is linear "
                        "Rec. 709 in the config that is built in."},
     TEXT(context.working_space)},
    {.text = {.name = "output-space",
              .argument = "NAME",
              .section = "Output",
              .help = "colour space of .exr files (default: the working space)",
              .manual = "Colour space of OpenEXR files; the default is the working space. They say which it is, and "
                        "the chromaticities of its primaries and white."},
     TEXT(output.color_space)},
    {.text = {.name = "list-displays",
              .section = "Output",
              .help = "print the config's displays, views, looks, colour spaces and roles",
              .manual = "Print the displays and views, looks, colour spaces and roles of the config, and end; goes "
                        "with no scene."},
     FLAG(lists_displays)},
    {.text =
         {.name = "stats",
          .argument = "FILE",
          .section = "Output",
          .help = "write statistics as JSON",
          .manual =
              "Write statistics (counts, times, memory) as JSON, also of a picture that a signal has ended, or not let "
              "begin. "
              "Its end.reason is _samples_ (all that *--spp* allows), _noise_ (that of *--noise* was reached "
              "before), _photons_ (*--photons-only*), _dry-run_, _memory_ (there was not enough), _time-limit_ or "
              "_signal_, where *--resume* goes on from "
              "a checkpoint if there is one (a signal before the first picture writes none); end.noise is the noise "
              "reached, as *--noise* measures it, null where it is not "
              "known, and end.samples tells how many samples pixels have had."},
     TEXT(stats)},
};

const option_row_list option_rows_output = {ROWS, sizeof ROWS / sizeof *ROWS};
