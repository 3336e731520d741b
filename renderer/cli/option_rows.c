/* option_rows.c: see option_rows.h.
 * Text: help is for --help; manual is for the man page, *bold* and _italic_. */
#define _GNU_SOURCE
#include "option_rows.h"

#include "option_values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WORDS(...)                                                                                                     \
    (const char *const[]){__VA_ARGS__}, (int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *))

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

static bool take_gltf_light_units(const char *value, options *o)
{
    int word;
    bool is_valid = parse_word(value, WORDS("auto", "standard", "unitless", "raw"), &word);
    o->asked.gltf_light_units = (ag_gltf_light_units)word;
    return is_valid;
}

static bool take_texture_memory(const char *value, options *o)
{
    uint64_t *bytes = &o->asked.texture_memory_bytes;
    *bytes = 0;
    return strcmp(value, "0") == 0 || (parse_bytes(value, bytes) && *bytes >= AG_TEXTURE_MEMORY_LEAST_BYTES);
}

static bool take_vector(const char *value, float out_vector[3])
{
    int count;
    return parse_floats(value, 3, out_vector, &count) && count == 3;
}

static bool take_camera_from(const char *value, options *o)
{
    o->asked.has_camera = o->has_camera_from = true;
    return take_vector(value, o->asked.camera_from);
}

static bool take_camera_to(const char *value, options *o)
{
    o->has_camera_to = true;
    return take_vector(value, o->asked.camera_to);
}

static bool take_camera_up(const char *value, options *o)
{
    o->has_camera_detail = o->has_camera_up = true;
    return take_vector(value, o->asked.camera_up);
}

static bool take_fov(const char *value, options *o)
{
    o->has_camera_detail = true;
    return parse_float(value, &o->asked.camera_fov_degrees) && o->asked.camera_fov_degrees > 0.0f &&
           o->asked.camera_fov_degrees < 180.0f;
}

static bool take_up(const char *value, options *o)
{
    int word;
    if (!parse_word(value, WORDS("x", "y", "z", "-x", "-y", "-z"), &word))
        return false;
    o->asked.up = (ag_up_axis)(AG_UP_X + word);
    return true;
}

static bool take_sun(const char *value, options *o)
{
    float numbers[3] = {0.0f, 0.0f, o->asked.sun_irradiance};
    int count;
    if (!parse_floats(value, 3, numbers, &count) || count < 2 || fabsf(numbers[1]) > 90.0f || numbers[2] < 0.0f)
        return false;
    o->asked.has_sun = true;
    o->asked.sun_azimuth_degrees = numbers[0];
    o->asked.sun_elevation_degrees = numbers[1];
    o->asked.sun_irradiance = numbers[2];
    return true;
}

/* A grey, a colour, or else a file. */
static bool take_sky(const char *value, options *o)
{
    float color[3];
    int count;
    o->asked.has_sky = true;
    o->asked.sky_file = NULL;
    for (int i = 0; i < 3; i++)
        o->asked.sky_radiance[i] = 1.0f;
    if (!parse_floats(value, 3, color, &count)) {
        o->asked.sky_file = value;
        return value[0] != '\0' && strspn(value, "0123456789.,+-") < strlen(value);
    }
    for (int i = 0; i < 3; i++)
        o->asked.sky_radiance[i] = color[count == 1 ? 0 : i];
    return count != 2 && color[0] >= 0.0f && (count == 1 || (color[1] >= 0.0f && color[2] >= 0.0f));
}

static bool take_sky_strength(const char *value, options *o)
{
    o->has_sky_detail = true;
    return parse_float(value, &o->sky_strength) && o->sky_strength >= 0.0f && isfinite(o->sky_strength);
}

static bool take_sky_rotation(const char *value, options *o)
{
    o->has_sky_detail = true;
    return parse_float(value, &o->asked.sky_rotation_degrees) && isfinite(o->asked.sky_rotation_degrees);
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

static bool take_confine_to(const char *value, options *o)
{
    o->context.is_confined = true;
    o->confined_to[o->context.confined_count++] = value;
    o->context.confined_to = o->confined_to;
    return true;
}

static bool take_tile(const char *value, options *o) { return parse_tile(value, &o->tile_index, &o->tile_count); }

static bool take_threads(const char *value, options *o)
{
    int threads = 0;
    bool is_valid = parse_int(value, 1, 4096, &threads);
    o->context.thread_count = (unsigned)threads;
    return is_valid;
}

static bool take_isa(const char *value, options *o)
{
    int word;
    o->context.isa = value;
    return parse_word(value, WORDS("sse2", "sse4.2", "avx", "avx2", "avx512"), &word);
}

static bool take_frames(const char *value, options *o)
{
    frames_reset(&o->frames);
    return frames_parse(value, &o->frames);
}

static bool take_checkpoint(const char *value, options *o) { return parse_seconds(value, &o->checkpoint_seconds); }

static bool take_time_limit(const char *value, options *o) { return parse_time(value, &o->time_limit); }

static bool take_memory(const char *value, options *o) { return parse_bytes(value, &o->memory_limit); }

static bool take_progress(const char *value, options *o)
{
    static const progress_style styles[] = {PROGRESS_AUTO, PROGRESS_BAR, PROGRESS_PLAIN, PROGRESS_JSON,
                                            PROGRESS_NONE, PROGRESS_ALF, PROGRESS_PLAIN, PROGRESS_NONE};
    int word;
    if (!parse_word(value, WORDS("auto", "bar", "plain", "json", "none", "alf", "lines", "off"), &word))
        return false;
    o->progress = styles[word];
    return true;
}

static bool take_quiet(const char *value, options *o)
{
    (void)value;
    o->verbosity = -1;
    return true;
}

static bool take_verbose(const char *value, options *o)
{
    (void)value;
    o->verbosity = o->verbosity < 0 ? 1 : o->verbosity + 1;
    return true;
}

static bool take_help(const char *value, options *o)
{
    (void)value;
    o->asked_text = OPTIONS_ASKED_HELP;
    return true;
}

static bool take_version(const char *value, options *o)
{
    (void)value;
    o->asked_text = OPTIONS_ASKED_VERSION;
    return true;
}

#define FLAG(member) .kind = OPTION_FLAG, .offset = offsetof(options, member)
#define TEXT(member) .kind = OPTION_TEXT, .offset = offsetof(options, member)

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
              .manual = "Looks of the config in place of the view's own, with commas between them; *-* before one "
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
              "Write statistics (counts, times, memory) as JSON, also of a picture that a signal has ended. "
              "Its end.reason is _samples_ (all that *--spp* allows), _noise_ (that of *--noise* was reached "
              "before), _photons_ (*--photons-only*), _dry-run_, _memory_ (there was not enough), _time-limit_ or _signal_, where *--resume* goes on from "
              "a checkpoint; end.noise is the noise reached, as *--noise* measures it, null where it is not "
              "known, and end.samples tells how many samples pixels have had."},
     TEXT(stats)},
    {.text = {.name = "define",
              .argument = "NAME=VALUE",
              .section = "Scene",
              .help = "put VALUE in the place of $NAME and ${NAME} in the scene's text; may be repeated; with "
                      "--frames $frame is the frame's number",
              .manual = "Put _VALUE_ in the place of $_NAME_ and ${_NAME_} in the scene's text, in strings and "
                        "outside of them, where it may also be several numbers. May be repeated; of two with one "
                        "name the last counts. ${_NAME_:-_OTHERWISE_} in a scene is _OTHERWISE_ where _NAME_ is not "
                        "defined. A name of the scene's that is not defined is an error, and so is a definition that "
                        "the scene does not use; without *-D*, strings with a $ in them stay as they are. With "
                        "*--frames* *$frame* is the frame's number, and the places for it in _VALUE_ are filled in. "
                        "Scenes in other formats than pbrt's text have no such names."},
     .letter = 'D',
     .take = take_definition},
    {.text = {.name = "camera",
              .argument = "NAME",
              .section = "Scene",
              .help = "of the file's cameras this one (glTF, models; default: the first)",
              .manual = "Of the cameras in the file the one of this name; the default is the first. In glTF it is the "
                        "name of the node or of the camera. For another name the message says which there are. pbrt's "
                        "scenes have one camera, without a name."},
     TEXT(asked.camera_name)},
    {.text =
         {.name = "camera-from",
          .argument = "X,Y,Z",
          .section = "Scene",
          .help = "where a camera stands that takes the place of the file's; world space",
          .manual =
              "Where a camera stands that takes the place of the file's, in world space; it is a pinhole that looks to *--camera-to*."},
     .take = take_camera_from},
    {.text = {.name = "camera-to",
              .argument = "X,Y,Z",
              .section = "Scene",
              .help = "what that camera looks at",
              .manual = "What the camera of *--camera-from* looks at; the two go together."},
     .take = take_camera_to},
    {.text = {.name = "camera-up",
              .argument = "X,Y,Z",
              .section = "Scene",
              .help = "what is up for it (default: 0,1,0)",
              .manual = "What is up for the camera of *--camera-from*. Default: 0,1,0."},
     .take = take_camera_up},
    {.text =
         {.name = "fov",
          .argument = "DEGREES",
          .section = "Scene",
          .help = "its field of view across the shorter side (default: 45)",
          .manual =
              "The field of view of the camera of *--camera-from*, across the shorter side of the picture. Default: 45."},
     .take = take_fov},
    {.text = {.name = "up",
              .argument = "AXIS",
              .section = "Scene",
              .help = "which axis points up, for --sun, --sky and --camera-up: x, y, z, -x, -y or -z (default: y; in "
                      "pbrt's text the one nearest to the camera's up)",
              .manual = "Which axis of the world points up for *--sun* and *--sky*, and for *--camera-up* where that "
                        "is not given: *x*, *y*, *z*, *-x*, *-y* or *-z*. The default for *--sun* and *--sky* is *y* "
                        "in glTF and models, and in pbrt's text the axis nearest to the camera's up."},
     .take = take_up},
    {.text = {.name = "sun",
              .argument = "AZ,ELEV[,STRENGTH]",
              .section = "Scene",
              .help = "a sun beside the file's lights: degrees from north over east, degrees above the horizon, W/m^2 "
                      "on what faces it (default 3)",
              .manual = "Add a sun: an azimuth in degrees from north over east, clockwise for who looks down; degrees "
                        "above the horizon; and the irradiance in W/m^2 on a surface that faces it, as the strength "
                        "of Blender's suns is, 3 by default, which makes white a little less than 1. It has no "
                        "extent: its shadows are sharp. North is _-z_ where _y_ is up, and east is _x_; in pbrt's "
                        "world, which is left-handed unless its camera mirrors it, north is _+z_ then. Where _z_ is "
                        "up, north is _+y_. See *--up*. Where there is a sun or a sky, no light is made up for models "
                        "without any."},
     .take = take_sun},
    {.text = {.name = "sky",
              .argument = "SKY",
              .section = "Scene",
              .help = "a sky in the place of the file's: a grey V, a colour R,G,B (radiance, W/m^2/sr), or a picture "
                      "of all directions",
              .manual = "Put a sky in the place of the file's own infinite lights: a grey _V_ or a colour _R,G,B_, "
                        "linear Rec. 709, its radiance in W/m^2/sr; or a picture (OpenEXR, Radiance, ...) of all "
                        "directions: twice as wide as high, latitude-longitude, its middle in the east (+_x_ where "
                        "_y_ or _z_ is up) and north a quarter to the left of that, as Blender's worlds have it; or "
                        "square, octahedral. A picture whose name is numbers needs _./_ before it. Lamps and suns "
                        "of the file shine on, but for *--no-lights*."},
     .take = take_sky},
    {.text = {.name = "sky-strength",
              .argument = "F",
              .section = "Scene",
              .help = "multiplies the sky of --sky (default 1)",
              .manual = "Multiplies the radiance of *--sky*; 1 is the default."},
     .take = take_sky_strength},
    {.text = {.name = "sky-rotation",
              .argument = "DEGREES",
              .section = "Scene",
              .help = "turns its picture from north over east (default 0)",
              .manual = "Turns the picture of *--sky* from north over east, clockwise for who looks down; 0 is the "
                        "default."},
     .take = take_sky_rotation},
    {.text = {.name = "no-lights",
              .section = "Scene",
              .help = "nothing in the file shines: --sun and --sky alone light it",
              .manual = "No lamp, sun, sky or surface of the file shines, and no light is made up: *--sun* and *--sky* "
                        "alone light the scene."},
     FLAG(asked.drops_lights)},
    {.text = {.name = "gltf-light-units",
              .argument = "UNITS",
              .section = "Scene",
              .help = "what lamps of glTF files are measured in: auto (default; by the file's generator), standard (cd "
                      "and lx at 683 lm/W), unitless (W/sr and W/m^2) or raw (W), as Blender's exporter calls them",
              .manual = "What lamps of glTF files are measured in, beside surfaces that shine. *standard* is cd and lx "
                        "at 683 lm/W, *unitless* W/sr and W/m^2, *raw* W over the whole sphere, and W/m^2 of suns: the "
                        "names that the \"Lighting Mode\" of Blender's exporter has. *auto* (default) goes by the "
                        "file's generator: Blender's from version 3.4 on is standard, before that raw, others are "
                        "unitless."},
     .take = take_gltf_light_units},
    {.text =
         {.name = "texture-memory",
          .argument = "SIZE",
          .section = "Scene",
          .help = "memory for pictures of textures, as 512M or 4G (default), at least 16M, 0: no bound; what is "
                  "beyond it lies in a temporary file",
          .manual =
              "Memory for the pictures of textures: bytes, or with K, M, G or T 1024, 1024^2, ... times as many; *4G* by "
              "default, at least *16M*, *0* for no bound. Up to half of it pictures are held whole. What is "
              "beyond lies in a temporary file without a name, in $*TMPDIR* or _/tmp_, of "
              "less than twice the pixels' size, and tiles of it are held in the rest. Pictures are decoded one "
              "at a time. The picture that is rendered is the same."},
     .take = take_texture_memory},
    {.text = {.name = "confine",
              .section = "Scene",
              .help = "for scenes of strangers: read files below the scene's folder alone, and write only what the "
                      "command line names",
              .manual = "For scenes that are not trusted. Files are read below the scene's own folder alone, "
                        "whatever it names and however (by \"..\", links, encoded URIs); of all else not even "
                        "whether it is there shows in a message. The scene's own name for its picture is ignored: "
                        "what is written is what the command line names. Formats that assimp reads are read where "
                        "the kernel has Landlock, which holds assimp's process in those folders, else refused."},
     FLAG(context.is_confined)},
    {.text = {.name = "confine-to",
              .argument = "FOLDER",
              .section = "Scene",
              .help = "as --confine, and files below FOLDER may be read, too; may be repeated",
              .manual = "As with *--confine*, and files below _FOLDER_ may be read, too. May be repeated."},
     .take = take_confine_to},
    {.text = {.name = "tile",
              .argument = "I/N",
              .section = "Picture",
              .help = "the I-th of N bands of the picture, from the top, from 1 on",
              .manual = "The _I_-th of _N_ bands of the picture (or of its crop window), from the top, from 1 on, "
                        "for rendering it on several machines. The pixels are those of the whole picture, to the "
                        "last bit; in _.exr_ files the data window says where they belong, and *oiiotool* puts the "
                        "bands together, see EXAMPLES."},
     .take = take_tile},
    {.text = {.name = "nthreads",
              .argument = "N",
              .section = "Work",
              .help = "threads (default: what affinity mask and cgroup quota allow)",
              .manual = "Number of threads. The default is what the affinity mask and the cgroup's quota allow."},
     .letter = 't',
     .take = take_threads},
    {.text = {.name = "isa",
              .argument = "NAME",
              .section = "Work",
              .help = "widest instruction set of ray traversal: sse2, sse4.2, avx, avx2 (default), avx512; another "
                      "one may give other bits",
              .manual = "Widest instruction set of ray traversal: *sse2*, *sse4.2*, *avx*, *avx2* (default) or "
                        "*avx512*. Another one may give other bits."},
     .take = take_isa},
    {.text = {.name = "frames",
              .argument = "LIST",
              .section = "Work",
              .help = "render frames, as 1-100, 1-100x2 or 1,5,9; %d, %04d and #### in names of files, SCENE too, "
                      "and in -D's values are the frame's number",
              .manual = "Render the frames of _LIST_, one after the other: *1-100*, *1-100x2*, *1,5,9* or several of "
                        "these with commas between. In the names of outfiles, of _SCENE_ and of other files written, "
                        "and in the values of *-D*, *%d*, *%04d* and runs of *#* (a digit each, at least) are the "
                        "frame's number. Statistics and limits of time are each frame's own. The first frame that "
                        "fails ends the work."},
     .take = take_frames},
    {.text = {.name = "no-clobber",
              .section = "Work",
              .help = "skip pictures that are there already, and complete",
              .manual = "Skip pictures whose files are all there and complete; a message says so. What was left by a "
                        "render that ended early is not complete."},
     FLAG(no_clobber)},
    {.text = {.name = "seed-per-frame",
              .section = "Work",
              .help = "with --frames: each frame's number is added to the seed, so that noise differs from frame to "
                      "frame",
              .manual = "With *--frames*: each frame's number is added to the seed, so that noise does not stand still "
                        "over the moving picture. Without it all frames have one seed; *--seed* may also have a place "
                        "for the number, _%d_ or _####_. With *--photon-map* the photons keep one seed."},
     FLAG(seed_per_frame)},
    {.text = {.name = "checkpoint",
              .argument = "SECONDS",
              .section = "Work",
              .help = "write down what there is so often, and at a signal, to OUTFILE.afterglow-checkpoint",
              .manual = "Write down what there is so often, and at a signal, to _OUTFILE_.afterglow-checkpoint "
                        "beside the first outfile. It is removed when the picture is complete."},
     .take = take_checkpoint},
    {.text = {.name = "resume",
              .section = "Work",
              .help = "go on from that file, where it is there, to the same bits",
              .manual = "Go on from that file, where it is there. The picture has the bits of one that was never "
                        "cut, however its render ended: by a signal, SIGKILL, or a power failure. A checkpoint of "
                        "another scene, other settings or another version, and one that is damaged, is refused, and "
                        "the message says which; scenes are compared by what is in them, so that files may have "
                        "moved."},
     FLAG(resume)},
    {.text = {.name = "time-limit",
              .argument = "TIME",
              .section = "Work",
              .help = "stop after so many seconds, or HH:MM:SS, with the samples that there are",
              .manual = "Seconds, or HH:MM:SS, from the beginning of the scene's reading on. No pass over the "
                        "picture is begun that would not end in time, as the one before tells, so that all pixels "
                        "have the same number of samples; one sample is always taken. The picture counts as "
                        "complete, and a message says how many samples it has; with *--checkpoint* a checkpoint "
                        "stays for *--resume* to go on with."},
     .take = take_time_limit},
    {.text =
         {.name = "memory",
          .argument = "SIZE",
          .section = "Work",
          .help = "the process may have so much memory, in bytes or as 500M or 8G: a picture that would need more "
                  "is not begun",
          .manual =
              "The process may have so much memory: bytes, or with K, M, G or T at the end times 1024, "
              "1024^2, ... What a picture will need is predicted when the scene is there (see "
              "*--dry-run*): where it is more, a message tells how much and for what, and the exit status "
              "is 3. A run that needs more all the same ends for want of memory instead of taking it from "
              "others; since libraries reserve memory that they never touch, 24 MB beyond are allowed then, and 256 MB "
              "while the scene is read."},
     .take = take_memory},
    {.text =
         {.name = "dry-run",
          .section = "Work",
          .help = "render no picture: predict how long it would take and how much memory, and print that",
          .manual =
              "Load the scene, predict how long the picture would take on this machine, were it idle, and "
              "how much memory at the most, print that on standard output, and write no picture. For the "
              "time photons are traced, a million into each map at most, and some hundred blocks of the "
              "picture's pixels are rendered, or half of them where it is small. *--stats* has the times, the CPU time and "
              "the memory by its parts under _prediction_. What *--denoise* takes is not in it, and limits of time, checkpoints and "
              "photon maps that are kept already are not heeded."},
     FLAG(dry_run)},
    {.text = {.name = "preview",
              .section = "Work",
              .help = "write the picture after 1, 2, 4, ... samples per pixel, too",
              .manual = "Write the picture after 1, 2, 4, ... samples per pixel, too."},
     FLAG(preview)},
    {.text = {.name = "progress",
              .argument = "STYLE",
              .section = "Work",
              .help = "auto (default), bar, plain (or lines), alf, json or none (or off)",
              .manual = "*auto* (default: a bar on a terminal, else plain), *bar*, *plain* or *lines* (whole lines "
                        "with *Progress: NN%*), *alf* (lines with *ALF_PROGRESS NN%* on standard output, as render "
                        "queues read them), *json* (one object per line), *none* or *off*. Where it can be told, "
                        "each says how long the phase will take."},
     .take = take_progress},
    {.text = {.name = "quiet", .section = "Work", .help = "errors only", .manual = "Errors only."},
     .letter = 'q',
     .take = take_quiet},
    {.text = {.name = "verbose",
              .section = "Work",
              .help = "also say what was done; twice: also what is harmless in the scene",
              .manual = "Say more; twice: everything."},
     .letter = 'v',
     .take = take_verbose},
    {.text = {.name = "help",
              .section = "Work",
              .help = "print this text",
              .manual = "Print a summary of the options and exit."},
     .letter = 'h',
     .take = take_help},
    {.text = {.name = "version",
              .section = "Work",
              .help = "print the program's version",
              .manual = "Print the program's version and exit."},
     .take = take_version},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

static const char *const SECTIONS[] = {"Output", "Scene", "Picture", "Light", "Work"};
enum { SECTION_COUNT = sizeof SECTIONS / sizeof *SECTIONS };

bool option_at(size_t index, listed_option *out_option)
{
    const ag_setting *setting;
    for (int s = 0; s < SECTION_COUNT; s++) {
        for (int i = 0; i < ROW_COUNT; i++)
            if (strcmp(ROWS[i].text.section, SECTIONS[s]) == 0 && index-- == 0) {
                *out_option = (listed_option){&ROWS[i].text, &ROWS[i]};
                return true;
            }
        for (size_t i = 0; (setting = ag_setting_at(i)) != NULL; i++)
            if (strcmp(setting->section, SECTIONS[s]) == 0 && index-- == 0) {
                *out_option = (listed_option){setting, NULL};
                return true;
            }
    }
    return false;
}

/* A seed with a place for the frame's number is tried with one. */
static bool take_seed_pattern(const char *value, options *o)
{
    char *tried = frames_name(value, 1);
    const bool is_valid = tried && ag_render_settings_set(&o->render, "seed", tried) == AG_OK;
    free(tried);
    o->seed_pattern = value;
    return is_valid;
}

/* A setting is tried on o->render, and noted for options_override. */
static bool take_setting(const ag_setting *setting, const char *value, options *o)
{
    if (strcmp(setting->name, "seed") == 0) {
        o->seed_pattern = NULL; /* the last one counts */
        if (frames_has_placeholder(value))
            return take_seed_pattern(value, o);
    }
    if (ag_render_settings_set(&o->render, setting->name, value) != AG_OK)
        return false;
    o->given[o->given_count++] = (given_setting){setting->name, value};
    return true;
}

bool option_take(const listed_option *option, const char *value, options *o)
{
    const option_row *row = option->row;
    if (!row)
        return take_setting(option->text, value, o);
    switch (row->kind) {
    case OPTION_TAKEN: return row->take(value, o);
    case OPTION_FLAG: *(bool *)((unsigned char *)o + row->offset) = true; break;
    case OPTION_TEXT: *(const char **)(void *)((unsigned char *)o + row->offset) = value; break;
    }
    return true;
}
