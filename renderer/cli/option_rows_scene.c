/* option_rows_scene.c: see option_row_lists.h. help is for --help; manual is for the man page, *bold* and _italic_. */
#define _GNU_SOURCE
#include "option_row_lists.h"

#include "option_values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Takes "NAME=VALUE"; of two with one name the last counts. Running out of memory counts as not valid. */
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

static bool take_texture_cache_size(const char *value, options *o)
{
    return parse_bytes(value, &o->asked.texture_cache_bytes);
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
    const float *up = o->asked.camera_up;
    o->has_camera_detail = true;
    return take_vector(value, o->asked.camera_up) && (up[0] != 0.0f || up[1] != 0.0f || up[2] != 0.0f);
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
    float numbers[4] = {0.0f, 0.0f, o->asked.sun_irradiance, o->asked.sun_angle_degrees};
    int count;
    if (!parse_floats(value, 4, numbers, &count) || count < 2 || fabsf(numbers[1]) > 90.0f || numbers[2] < 0.0f ||
        numbers[3] < 0.0f || numbers[3] > 180.0f)
        return false;
    o->asked.has_sun = true;
    o->asked.sun_azimuth_degrees = numbers[0];
    o->asked.sun_elevation_degrees = numbers[1];
    o->asked.sun_irradiance = numbers[2];
    o->asked.sun_angle_degrees = numbers[3];
    return true;
}

/* Takes a grey, a colour, or else a file. */
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

static bool take_confine_to(const char *value, options *o)
{
    o->context.is_confined = true;
    o->confined_to[o->context.confined_count++] = value;
    o->context.confined_to = o->confined_to;
    return true;
}

static const option_row ROWS[] = {
    {.text = {.name = "define",
              .argument = "NAME=VALUE",
              .section = "Scene",
              .help = "put VALUE instead of $NAME and ${NAME} in the scene's text; may be repeated; with "
                      "--frames $frame is the frame's number",
              .manual =
                  "Put _VALUE_ instead of $_NAME_ and ${_NAME_} in the scene's text, in strings and "
                  "outside of them, where it may also be several numbers. May be repeated; of two with one "
                  "name the last counts. ${_NAME_:-_OTHERWISE_} in a scene is _OTHERWISE_ where _NAME_ is not "
                  "defined. A name of the scene's that is not defined is an error, and so is a definition that "
                  "the scene does not use; without *-D*, strings with a $ in them stay as they are. With "
                  "*--frames* *$frame* is the frame's number, and the placeholders for it in _VALUE_ are filled in. "
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
    {.text = {.name = "camera-from",
              .argument = "X,Y,Z",
              .section = "Scene",
              .help = "where a camera stands that replaces the file's; world space",
              .manual = "Where a camera stands that replaces the file's, in world space; it is a pinhole that looks to "
                        "*--camera-to*."},
     .take = take_camera_from},
    {.text = {.name = "camera-to",
              .argument = "X,Y,Z",
              .section = "Scene",
              .help = "what the camera of --camera-from looks at",
              .manual = "What the camera of *--camera-from* looks at; the two go together."},
     .take = take_camera_to},
    {.text = {.name = "camera-up",
              .argument = "X,Y,Z",
              .section = "Scene",
              .help = "what is up for the camera of --camera-from (default: the axis of --up)",
              .manual = "What is up for the camera of *--camera-from*. Default: the axis that points up, see *--up*."},
     .take = take_camera_up},
    {.text =
         {.name = "fov",
          .argument = "DEGREES",
          .section = "Scene",
          .help = "field of view of the camera of --camera-from across the shorter side (default: 45)",
          .manual =
              "The field of view of the camera of *--camera-from*, across the shorter side of the picture. Default: "
              "45."},
     .take = take_fov},
    {.text = {.name = "up",
              .argument = "AXIS",
              .section = "Scene",
              .help = "which axis points up, for --sun, --sky and cameras that the file has not: x, y, z, -x, -y or -z "
                      "(default: y; in pbrt's text the one nearest to its camera's up)",
              .manual =
                  "Which axis of the world points up for *--sun*, *--sky*, *--camera-from*, and the camera that is "
                  "made up for a model without one: *x*, *y*, *z*, *-x*, *-y* or *-z*. The default is *y* in glTF "
                  "and models, and in pbrt's text the axis nearest to the up of the file's own camera."},
     .take = take_up},
    {.text = {.name = "sun",
              .argument = "AZ,ELEV[,E[,ANGLE]]",
              .section = "Scene",
              .help = "a sun beside the file's lights: degrees from north over east, degrees above the horizon, W/m^2 "
                      "on what faces it (E, default 3), degrees across it (ANGLE, default 0)",
              .manual =
                  "Add a sun: an azimuth in degrees from north over east, clockwise for who looks down; degrees "
                  "above the horizon; and the irradiance in W/m^2 on a surface that faces it, as the strength "
                  "of Blender's suns is, 3 by default, which makes white a little less than 1; and the degrees "
                  "across it, as the angle of Blender's suns is: 0 by default, which makes sharp shadows; ours is "
                  "0.53 wide. Mirrors do not show it. North is _-z_ where _y_ is up, and east is _x_; in pbrt's "
                  "world, which is left-handed unless its camera mirrors it, north is _+z_ then. Where _z_ is "
                  "up, north is _+y_. See *--up*. Where there is a sun or a sky, no light is made up for models "
                  "without any."},
     .take = take_sun},
    {.text = {.name = "sky",
              .argument = "SKY",
              .section = "Scene",
              .help = "a sky instead of the file's: a grey V, a colour R,G,B (radiance, W/m^2/sr), or a picture "
                      "of all directions",
              .manual = "Put a sky instead of the file's own infinite lights: a grey _V_ or a colour _R,G,B_, "
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
              .help = "turns the picture of --sky from north over east (default 0)",
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
          .help = "memory for pictures of textures, as 512M or 4G (default 1536M), at least 16M, 0: no bound; what is "
                  "beyond it lies in a temporary file, or is read again from files that hold tiles (.tx)",
          .manual =
              "Memory for the pictures of textures: bytes, or with K, M, G or T 1024, 1024^2, ... times as many; "
              "*1536M* by "
              "default, at least *16M*, *0* for no bound. Up to half of it pictures are held whole. What is "
              "beyond lies in a temporary file without a name, in $*TMPDIR* or _/tmp_, of "
              "less than twice the pixels' size, and tiles of it are held in the rest. Files that themselves hold "
              "tiles and coarser levels (.tx, tiled TIFF and OpenEXR) need no temporary file: their tiles are read "
              "from "
              "them while the picture is rendered, and they are not to be changed meanwhile. Pictures are decoded one "
              "at a time. The picture that is rendered is the same."},
     .take = take_texture_memory},
    {.text = {.name = "texture-cache",
              .argument = "FOLDER",
              .section = "Scene",
              .help = "keep what lies beyond --texture-memory in this folder between runs, instead of in a temporary "
                      "file: the next run decodes none of these pictures",
              .manual = "A folder for the pictures of textures beyond *--texture-memory*, made where it is missing: "
                        "instead of in a temporary file their tiles and coarser levels lie there, and the next run "
                        "decodes none of these pictures. Files are named by the bytes of the pictures, of a scene or "
                        "of many, so that changed ones are decoded anew; any number of runs may use the folder at "
                        "once, and one that is killed leaves nothing unfinished there. The file system must be able to "
                        "hold files without names (O_TMPFILE, which network file systems lack); where it cannot, that "
                        "is told, and the temporary file serves. What a picture will take is told with *-v*. Where the "
                        "libraries that decode pictures are replaced, the folder is to be emptied. The picture that is "
                        "rendered is the same."},
     TEXT(asked.texture_cache)},
    {.text = {.name = "texture-cache-size",
              .argument = "SIZE",
              .section = "Scene",
              .help = "how much --texture-cache may keep (default 32G): what was not used for the longest time is "
                      "removed",
              .manual =
                  "How much *--texture-cache* may keep, as *--texture-memory* (default 32G). Beyond that the files "
                  "that were not used for the longest time are removed; who still reads them is not disturbed."},
     .take = take_texture_cache_size},
    {.text =
         {.name = "confine",
          .section = "Scene",
          .help = "for scenes of strangers: read files below the scene's folder alone, and write only what the "
                  "command line names",
          .manual =
              "For scenes that are not trusted. Files are read below the scene's own folder alone, "
              "whatever it names and however (by \"..\", links, encoded URIs); of all else not even "
              "whether it is there shows in a message. The scene's own name for its picture is ignored: "
              "what is written is what the command line names. Formats that assimp reads are read where "
              "the kernel has Landlock, which holds assimp's process in those folders, else refused. How much "
              "a scene may take is bounded by *--memory*, and by *--time-limit* or a soft limit of CPU time (*ulimit "
              "-St*), which end its reading, too."},
     FLAG(context.is_confined)},
    {.text = {.name = "confine-to",
              .argument = "FOLDER",
              .section = "Scene",
              .help = "as --confine, and files below FOLDER may be read, too; may be repeated",
              .manual = "As with *--confine*, and files below _FOLDER_ may be read, too. May be repeated."},
     .take = take_confine_to},
};

const option_row_list option_rows_scene = {ROWS, sizeof ROWS / sizeof *ROWS};
