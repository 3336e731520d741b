/* settings_rows.c: the rows of settings_table.h, in the order of the fields of ag_render_settings.
 * Text: help is for --help; manual is for the man page, *bold* and _italic_, where it says more than help. %LAYERS% and
 * %PHOTON_MAP_SETTINGS% are replaced by lists, see cli/option_help.c. */
#include "integrator/integrator.h"
#include "integrator/path_settings.h"
#include "settings_table.h"

#include <float.h>
#include <math.h>

#define FIELD(member)                                                                                                  \
    .offset = offsetof(ag_render_settings, member), .size = sizeof(((const ag_render_settings *)0)->member)
#define SIZE_FIELDS .offset = offsetof(ag_render_settings, width), .size = 2 * sizeof(int)
#define WORDS(...)  ((const char *const[]){__VA_ARGS__, NULL})
_Static_assert(offsetof(ag_render_settings, height) == offsetof(ag_render_settings, width) + sizeof(int),
               "width and height are one setting");

static const char *const INTEGRATOR_WORDS[] = {
#define INTEGRATOR_WORD(kind, word, about) [kind] = #word,
    AG_INTEGRATOR_LIST(INTEGRATOR_WORD)
#undef INTEGRATOR_WORD
        NULL};
#define INTEGRATOR_HELP(kind, word, about)   "; " #word ": " about
#define INTEGRATOR_MANUAL(kind, word, about) "; *" #word "*: " about

static const setting_row ROWS[] = {
    {.text = {.name = "integrator",
              .argument = "NAME",
              .section = "Light",
              .help = "how light is found (default photonmap)" AG_INTEGRATOR_LIST(INTEGRATOR_HELP),
              .manual = "How light is found (default *photonmap*)" AG_INTEGRATOR_LIST(INTEGRATOR_MANUAL) "."},
     FIELD(integrator),
     .kind = SETTING_WORD,
     .words = INTEGRATOR_WORDS,
     .noun = "integrator",
     .json = "integrator",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {.text = {.name = "cache",
              .argument = "MODE",
              .section = "Light",
              .help = "irradiance at the photons: on-demand (default) and precompute give the same bits; off "
                      "computes it at every gather hit instead, with other bits",
              .manual = "When irradiance is computed at the photons: *on-demand* (default), *precompute* (at all of "
                        "them, before rendering; the picture is the same), or *off* (an estimate at every point that "
                        "a gather ray meets: another estimator, whose picture has other bits)."},
     FIELD(cache),
     .kind = SETTING_WORD,
     .words = WORDS("on-demand", "precompute", "off"),
     .noun = "cache mode",
     .json = "cache",
     .marks = SETTING_OF_PICTURE | SETTING_OF_PHOTONS},
    {.text = {.name = "pane-light",
              .argument = "MODE",
              .section = "Light",
              .help = "light straight through panes of glass: direct (default), sampled at its lamp, or traced, like "
                      "light through other glass",
              .manual = "Light that passes panes of glass: thin glass, a smooth interface of index 1, and slabs of "
                        "solid glass whose faces are flat, parallel and at least sixteen times as wide as the slab is "
                        "thick. *direct* (default) samples it at its lamp, as if nothing were in its way, so that suns "
                        "and points shine through windows; slabs then shift it sideways by nothing instead of by about "
                        "a third of their thickness, but the eye sees them refract. *traced* treats it like light by "
                        "way of any other glass.",
              .is_of_photon_map = true},
     FIELD(pane_light),
     .kind = SETTING_WORD,
     .words = WORDS("direct", "traced"),
     .noun = "choice of light through panes (--pane-light)",
     .json = "settings.pane_light",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {.text = {.name = "texture-filter",
              .argument = "MODE",
              .section = "Light",
              .help = "colours of pictures: on (default), their mean over what a ray stands for, or off, at single "
                      "points",
              .manual = "How pictures are looked up as colours of surfaces. *on* (default) takes their mean over what "
                        "a ray stands for: of a camera ray its share of the pixel, also in mirrors and through glass, "
                        "and what gather rays and photons meet more coarsely. So few samples show distant textures "
                        "without noise. *off* looks them up at single points. Where light is not proportional to the "
                        "picture's value, in roughness, normals, metals, coated bases, cut-outs and emission, nothing "
                        "is filtered.",
              .is_of_photon_map = true},
     FIELD(texture_filter),
     .kind = SETTING_WORD,
     .words = WORDS("on", "off"),
     .noun = "filtering of textures (--texture-filter)",
     .json = "settings.texture_filter",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {.text = {.name = "only",
              .argument = "LIGHT",
              .section = "Light",
              .help = "all (default), or indirect: leave out emission, and direct light at the first non-specular "
                      "hit",
              .manual = "*all* (default), or *indirect*: leave out emission, and direct light at the first "
                        "non-specular surface."},
     FIELD(only),
     .kind = SETTING_WORD,
     .words = WORDS("all", "indirect"),
     .noun = "choice of light (--only)",
     .json = "only",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {.text = {.name = "seed",
              .argument = "N",
              .section = "Picture",
              .help = "seed of all random numbers (default: the scene's, else 0)",
              .manual = "Seed of all random numbers (default: the scene's, else 0)."},
     FIELD(seed),
     .kind = SETTING_SEED,
     .noun = "seed",
     .json = "seed",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {.text = {.name = "size",
              .argument = "WxH",
              .section = "Picture",
              .help = "size of the full picture in pixels",
              .manual = "Size of the full picture in pixels."},
     SIZE_FIELDS,
     .kind = SETTING_SIZE,
     .least = 1,
     .most = 65536,
     .noun = "picture size",
     .json = "image",
     .marks = SETTING_OF_PICTURE},
    {.text = {.name = "cropwindow",
              .argument = "X0,X1,Y0,Y1",
              .section = "Picture",
              .help = "part of the picture to render, each in [0, 1]",
              .manual = "The part of the picture to render, each number in [0, 1], from the left and from the top."},
     FIELD(crop_window),
     .kind = SETTING_WINDOW,
     .most = 1,
     .noun = "crop window",
     .json = "image.crop_window",
     .marks = SETTING_OF_PICTURE},
    {.text = {.name = "spp",
              .argument = "N",
              .section = "Picture",
              .help = "samples per pixel; with --noise the most of them (default 1024), with --noise 0 just as many "
                      "(default: the scene's, else 16)",
              .manual = "Camera samples per pixel. With *--noise* they are the most that a pixel gets, 1024 by "
                        "default. With *--noise 0*, and by *--spp* alone, every pixel gets just as many; the default "
                        "is then the scene's number, else 16."},
     FIELD(samples_per_pixel),
     .kind = SETTING_INTEGER,
     .initial = 16,
     .least = 1,
     .most = 1 << 20,
     .noun = "number of samples per pixel",
     .json = "image.samples_per_pixel",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {FIELD(exposure), .kind = SETTING_NUMBER, .initial = 1, .is_above_least = true, .most = FLT_MAX, .noun = "exposure",
     .json = "settings.exposure", .marks = SETTING_OF_PICTURE},
    {FIELD(max_component), .kind = SETTING_NUMBER, .most = INFINITY, .noun = "largest component",
     .json = "settings.max_component", .marks = SETTING_OF_PICTURE},
    {FIELD(white_balance), .kind = SETTING_NUMBER, .least = 1000, .most = 25000, .has_automatic = true, .automatic = 0,
     .noun = "white balance", .json = "settings.white_balance", .marks = SETTING_OF_PICTURE},
    {FIELD(float_samples), .kind = SETTING_FLAG, .noun = "choice of floats", .json = "settings.float_samples"},
    {.text = {.name = "max-depth",
              .argument = "N",
              .section = "Light",
              .help = "scatterings between lamp and eye at most, up to 100 (default: roulette)",
              .manual = "Scatterings between lamp and eye at most, up to 100. By default, and at 100, Russian "
                        "roulette ends the paths, and surfaces scatter them no oftener than 100 times; a smaller "
                        "number bounds scatterings in media too.",
              .is_of_photon_map = true},
     FIELD(max_depth),
     .kind = SETTING_INTEGER,
     .initial = DEPTH_BY_ROULETTE,
     .least = 0,
     .most = DEPTH_BY_ROULETTE,
     .noun = "depth",
     .json = "settings.max_depth",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {.text = {.name = "photons",
              .argument = "N",
              .section = "Light",
              .help = "photons to store in the global map (default: by the number of samples, 1000000 at most)",
              .manual = "Photons to store in the global map. The default is two for each camera sample of the whole "
                        "frame, from 131072 to 1000000; with *--noise* for each of those of *--min-spp*. Small "
                        "pictures of open views, where few gather rays meet anything, have fewer, from 16384 on. "
                        "With *--photon-map* or *--photon-paths* it is 1000000. May be written as 2e6.",
              .is_of_photon_map = true},
     FIELD(photon_count),
     .kind = SETTING_COUNT,
     .initial = (double)AG_PHOTON_COUNT_AUTOMATIC,
     .least = 1,
     .most = UINT32_MAX - 1,
     .has_automatic = true,
     .automatic = (double)AG_PHOTON_COUNT_AUTOMATIC,
     .noun = "number of photons",
     .json = "settings.photon_count",
     .marks = SETTING_OF_PICTURE | SETTING_OF_PHOTONS},
    {.text = {.name = "photon-paths",
              .argument = "N",
              .section = "Light",
              .help = "paths of light that the global map's photons come from; 0 (default): as many as fill the map",
              .manual = "How many paths of light the global map's photons come from; 0, the default: as many as fill "
                        "the map. A fixed number is for *--frames* in which little moves: photons of paths that meet "
                        "nothing new stay as they are, and from one frame to the next irradiance is kept where "
                        "nothing has changed nearby. Each frame has the bits that it has when it is rendered alone. "
                        "*--photons* is then the most that are stored, and *--photon-aim* and *--gather-guiding* "
                        "are 0 unless they are given, since they change much where little does. May be written as 2e6.",
              .is_of_photon_map = true},
     FIELD(photon_paths),
     .kind = SETTING_COUNT,
     .most = 1e15,
     .noun = "number of photon paths",
     .json = "settings.photon_paths",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER | SETTING_OF_PHOTONS},
    {.text = {.name = "caustic-photons",
              .argument = "N",
              .section = "Light",
              .help = "photons to store in the caustic map, where there are mirrors or glass (default: by the number "
                      "of samples, 500000 at most)",
              .manual = "Photons to store in the caustic map, where there are mirrors or glass. The default is one for "
                        "each camera sample of the whole frame, from 65536 to 500000, whatever *--photons* is. A few "
                        "that are far stronger than the others are divided, so that a few more are kept.",
              .is_of_photon_map = true},
     FIELD(caustic_photon_count),
     .kind = SETTING_COUNT,
     .initial = (double)AG_PHOTON_COUNT_AUTOMATIC,
     .most = UINT32_MAX - 1,
     .has_automatic = true,
     .automatic = (double)AG_PHOTON_COUNT_AUTOMATIC,
     .noun = "number of caustic photons",
     .json = "settings.caustic_photon_count",
     .marks = SETTING_OF_PICTURE | SETTING_OF_PHOTONS},
    {.text = {.name = "nearest",
              .argument = "K",
              .section = "Light",
              .help = "photons of an irradiance estimate (default 50)",
              .manual = "Photons of an irradiance estimate.",
              .is_of_photon_map = true},
     FIELD(nearest),
     .kind = SETTING_INTEGER,
     .initial = 50,
     .least = 1,
     .most = 65536,
     .noun = "number of nearest photons",
     .json = "settings.nearest",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER | SETTING_OF_PHOTONS},
    {.text = {.name = "radius",
              .argument = "R",
              .section = "Light",
              .help = "largest radius of an estimate, scene units; 0: from the photons' density",
              .manual = "Largest radius of an estimate, in the scene's units; 0 takes it from the photons' density.",
              .is_of_photon_map = true},
     FIELD(radius),
     .kind = SETTING_NUMBER,
     .most = FLT_MAX,
     .noun = "radius",
     .json = "settings.radius",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER | SETTING_OF_PHOTONS},
    {.text = {.name = "irradiance-fraction",
              .argument = "F",
              .section = "Light",
              .help = "irradiance is kept at this fraction of the photons, above 0, 1 at most (default 1): 0.125 is "
                      "faster, and a little more blurred",
              .manual = "The fraction of the photons at which irradiance is kept: above 0, 1 at most, which is the "
                        "default. Gather rays look for the nearest of those; each irradiance is still estimated from "
                        "all photons. 0.125 is faster, and a little more blurred. Of no use with *--cache off*.",
              .is_of_photon_map = true},
     FIELD(irradiance_fraction),
     .kind = SETTING_NUMBER,
     .initial = 1,
     .is_above_least = true,
     .most = 1,
     .noun = "fraction of irradiance photons",
     .json = "settings.irradiance_fraction",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER | SETTING_OF_PHOTONS},
    {.text = {.name = "gather-guiding",
              .argument = "F",
              .section = "Light",
              .help = "how much photons decide where gather rays go, from 0 (not at all) to 1 (default 0.5; with "
                      "--photon-paths 0), and a quarter as much where rays of rough reflections do",
              .manual =
                  "How much photons decide where gather rays go, from 0 to 1; 0.5 is the default, and 0 with "
                  "*--photon-paths*, since each photon that comes or goes changes them. Of a "
                  "gather's rays this share goes where the photons around it came from, less where they are "
                  "few, and the rest by the cosine. A quarter of it is the share of the rays of rough reflections "
                  "that go where caustics came from. 0 guides none. The light is the same; noise is less where "
                  "light comes from few directions."},
     FIELD(gather_guiding),
     .kind = SETTING_NUMBER,
     .initial = AG_GATHER_GUIDING_AUTOMATIC,
     .most = 1,
     .has_automatic = true,
     .automatic = AG_GATHER_GUIDING_AUTOMATIC,
     .noun = "guiding of gather rays",
     .json = "settings.gather_guiding",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER | SETTING_OF_PHOTONS},
    {.text = {.name = "photon-seed",
              .argument = "N",
              .section = "Light",
              .help = "seed of the photons (default: --seed): pictures of other seeds can share a kept photon map",
              .manual =
                  "Seed of the photons (default: that of *--seed*). With it pictures of different seeds, the frames "
                  "of an animation for one, can share a kept photon map.",
              .is_of_photon_map = true},
     FIELD(photon_seed),
     .kind = SETTING_SEED,
     .initial = (double)AG_PHOTON_SEED_AUTOMATIC,
     .noun = "seed of photons",
     .json = "settings.photon_seed",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER | SETTING_OF_PHOTONS},
    {.text =
         {.name = "photon-aim",
          .argument = "F",
          .section = "Light",
          .help = "share of the photon paths that begin where they bring light to where the picture asks for it, "
                  "from 0 to 0.8 (default 0.8; of a map that is kept 0)",
          .manual =
              "The share of the photon paths that begin where a pilot has found that they bring light to "
              "where the picture asks for it, from 0 to 0.8; 0.8 is the default, and 0 with "
              "*--photon-map* and with *--photon-paths*. The others begin by power alone: the light is the same, and no photon is "
              "more than five times as bright as by that. The pilot looks at the whole frame, so that "
              "crops and tiles, and other sizes of one shape with the same *--photons*, have the same photons. "
              "A kept map that is aimed serves its own view alone.",
          .is_of_photon_map = true},
     FIELD(photon_aim),
     .kind = SETTING_NUMBER,
     .initial = AG_PHOTON_AIM_AUTOMATIC,
     .most = AG_DEFAULT_PHOTON_AIM,
     .has_automatic = true,
     .automatic = AG_PHOTON_AIM_AUTOMATIC,
     .noun = "aim of photons",
     .json = "settings.photon_aim",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER | SETTING_OF_PHOTONS},
    {.text = {.name = "direct-guiding",
              .argument = "F",
              .section = "Light",
              .help =
                  "share of the shadow rays that go to what a pilot has seen of sun, sky and lamps from there, from "
                  "0 to 0.8 (default 0.8; with --integrator path 0)",
              .manual =
                  "The share of the shadow rays that go to the lights, and the parts of the sky, that a pilot has "
                  "seen from about there, from 0 to 0.8; 0.8 is the default, and 0 with *--integrator path*. The "
                  "others go to all alike: the light is the same; noise is less where it comes through windows. "
                  "The pilot looks at the whole frame, so that crops, tiles and other sizes of one shape go by "
                  "the same. Scenes without a sun or a sky have nothing to be guided."},
     FIELD(direct_guiding),
     .kind = SETTING_NUMBER,
     .initial = AG_DIRECT_GUIDING_AUTOMATIC,
     .most = AG_DEFAULT_DIRECT_GUIDING,
     .has_automatic = true,
     .automatic = AG_DIRECT_GUIDING_AUTOMATIC,
     .noun = "guiding of direct light",
     .json = "settings.direct_guiding",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {.text = {.name = "aov",
              .argument = "LIST",
              .section = "Output",
              .help = "layers of .exr files, by commas: %LAYERS%",
              .manual = "Layers of _.exr_ files beside R, G and B, separated by commas; may be repeated. %LAYERS% The "
                        "parts of light add up to R, G and B in this order, in float files to the last bit; to them "
                        "thin glass that is looked through, or shone through, is not there (*--pane-light*), and a "
                        "slab that is shone through likewise."},
     FIELD(layers),
     .kind = SETTING_LAYERS,
     .noun = "set of layers",
     .json = "settings.layers",
     .marks = SETTING_OF_PICTURE},
    {.text = {.name = "denoise",
              .section = "Output",
              .help = "take the noise out with Open Image Denoise, where its library is there",
              .manual = "Take the noise out of R, G and B with Open Image Denoise. Its library, "
                        "_libOpenImageDenoise.so_, is looked for as the system's loader does; where it is not there, "
                        "nothing is rendered and the exit status is 3."},
     FIELD(denoise),
     .kind = SETTING_FLAG,
     .noun = "choice of denoising",
     .json = "settings.denoise",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {FIELD(layers_in_camera_space), .kind = SETTING_FLAG, .noun = "space of layers",
     .json = "settings.layers_in_camera_space", .marks = SETTING_OF_PICTURE},
    {.text = {.name = "clamp-direct",
              .argument = "V",
              .section = "Light",
              .help = "no sample gets more than V of direct light; 0 (default): unbounded",
              .manual = "No component of what a camera sample gets from a lamp, seen or by way of one surface, is "
                        "above _V_: brighter contributions are scaled down. 0, the default: unbounded."},
     FIELD(clamp_direct),
     .kind = SETTING_NUMBER,
     .most = INFINITY,
     .noun = "bound of direct light",
     .json = "settings.clamp_direct",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {.text = {.name = "clamp-indirect",
              .argument = "V",
              .section = "Light",
              .help = "no sample gets more than V of indirect light; 0 (default): unbounded",
              .manual = "No component of all other contributions to a camera sample is above _V_: brighter ones are "
                        "scaled down. It takes away fireflies, and light."},
     FIELD(clamp_indirect),
     .kind = SETTING_NUMBER,
     .most = INFINITY,
     .noun = "bound of indirect light",
     .json = "settings.clamp_indirect",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {.text = {.name = "noise",
              .argument = "LEVEL",
              .section = "Picture",
              .help = "as many samples up to --spp as it takes for this noise in what is shown, where white is 1: "
                      "0.02 is fair, 0.01 good, 0.003 clean; the default is 0.02, but 0 with --spp, and for scenes "
                      "that have Integrator \"photonmap\" and a Sampler",
              .manual = "Adaptive sampling: a block of 8 by 8 pixels gets no more samples when the noise left in it "
                        "is below _LEVEL_. Noise is the standard error of what a display shows, about the square "
                        "root of the value, where white is 1; of what is brighter than white, relative to it; with "
                        "*--exposure*, of what that shows. 0.02 is fair, 0.01 is good, 0.003 is clean. The default "
                        "is 0.02, with at most 1024 samples. It is 0 where *--spp* is given, and for scenes that are "
                        "written for this program: that have the Integrator \"photonmap\" and a Sampler. How many "
                        "samples a scene for another renderer wants is not heeded, unless *--noise 0* says so. It is "
                        "decided at fixed numbers of samples, so the picture is the same for any number of threads. "
                        "At the end the program says which noise is left, which part of the light brings most of it, "
                        "and what would help most; with *-v* it does so for all pictures."},
     FIELD(noise_level),
     .kind = SETTING_NUMBER,
     .most = INFINITY,
     .noun = "noise level",
     .json = "settings.noise_level",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER},
    {.text = {.name = "min-spp",
              .argument = "N",
              .section = "Picture",
              .help = "samples per pixel at least, with --noise (default 16)",
              .manual = "Samples per pixel at least, with *--noise*, 16 by default."},
     FIELD(noise_min_samples),
     .kind = SETTING_INTEGER,
     .initial = 16,
     .least = 2,
     .most = 1 << 20,
     .noun = "least number of samples",
     .json = "settings.noise_min_samples",
     .marks = SETTING_OF_PICTURE},
    {FIELD(shown_exposure_stops), .kind = SETTING_NUMBER, .least = -100, .most = 100,
     .noun = "exposure of what is shown", .json = "settings.shown_exposure_stops", .marks = SETTING_OF_PICTURE},
    {.text = {.name = "gather-samples",
              .argument = "N",
              .section = "Light",
              .help = "gather rays for each camera sample (default: each block of pixels chooses by its noise, from "
                      "about 256 a pixel on)",
              .manual = "Gather rays for each camera sample: exactly so many, a light sample for each eight of "
                        "them, and one camera ray. By default each block of 8 by 8 pixels chooses the three "
                        "numbers by the noise of its own samples; further camera rays bring all light but "
                        "gathered light and caustics. The first four samples of a pixel have 256 gather rays in "
                        "all, shared by *--spp*, but at least 4 each, and 16 light samples; where there are "
                        "fewer than 9 samples, or a noise level, they also have 8 further camera rays in all. "
                        "With *--noise 0* a small picture beforehand chooses these numbers by place, and "
                        "samples have no more gather rays than that, with a noise level 1 to 64. Then it is "
                        "decided, and again at four times as many samples."},
     FIELD(gather_samples),
     .kind = SETTING_INTEGER,
     .least = 1,
     .most = 65536,
     .has_automatic = true,
     .automatic = 0,
     .noun = "number of gather rays",
     .json = "settings.gather_samples",
     .marks = SETTING_OF_PICTURE | SETTING_IN_HEADER | SETTING_OF_PHOTONS},
    {.text = {.name = "photon-map",
              .argument = "FILE",
              .section = "Output",
              .help = "keep the photon map and its irradiances in FILE: read where it is there, else traced; "
                      "processes that use it at once fill it together",
              .manual = "Keep the photon map in _FILE_, with the irradiances that were computed at its photons: a "
                        "picture from another point, of another size or with other samples then begins where the "
                        "last one ended, and is the same, bit for bit, as without the file. Where _FILE_ is not "
                        "there yet, photons are traced and it is written, whole or not at all. Processes on one "
                        "machine that use it at the same time trace once and fill it together; what one that is "
                        "killed was computing is taken over by the others. A file that may not be written, or that "
                        "is on a network's file system, is used, but not filled. One that is damaged, or was made of "
                        "another scene, with other settings that photons depend on (%PHOTON_MAP_SETTINGS%, *--isa*), "
                        "aimed at another view, by another version or on another kind of machine, is refused. While "
                        "photons are traced, _FILE_.lock is beside it."},
     FIELD(photon_map_file),
     .kind = SETTING_FILE,
     .noun = "file of the photon map",
     .marks = SETTING_OF_PHOTONS},
    {.text = {.name = "photon-map-refresh",
              .section = "Output",
              .help = "trace the map anew where that of FILE is of another scene or settings, or damaged",
              .manual = "Where _FILE_ would be refused, trace the map anew and replace it."},
     FIELD(photon_map_refresh),
     .kind = SETTING_FLAG,
     .noun = "choice of a new photon map",
     .json = "settings.photon_map_refresh",
     .marks = SETTING_OF_PHOTONS},
};

const setting_row *setting_at(size_t index) { return index < sizeof ROWS / sizeof *ROWS ? &ROWS[index] : NULL; }
