/* options.h: the program's command line.
 * Flow: argv -> [here] -> main. Threads: main's. */
#ifndef AFTERGLOW_OPTIONS_H
#define AFTERGLOW_OPTIONS_H

#include "afterglow/afterglow.h"
#include "frames.h"

#include <stdbool.h>

typedef enum progress_style {
    PROGRESS_AUTO,
    PROGRESS_BAR,
    PROGRESS_PICTURE, /* with a bar below */
    PROGRESS_PLAIN,
    PROGRESS_JSON,
    PROGRESS_NONE,
    PROGRESS_ALF
} progress_style;

/* How PROGRESS_PICTURE draws. */
typedef enum picture_form {
    PICTURE_FORM_AUTO, /* as the terminal says */
    PICTURE_FORM_BLOCKS,
    PICTURE_FORM_SIXELS
} picture_form;

/* A text that is printed instead of all work. */
typedef enum options_asked { OPTIONS_ASKED_NOTHING, OPTIONS_ASKED_HELP, OPTIONS_ASKED_VERSION } options_asked;

/* A setting of the renderer, as ag_render_settings_set takes it. */
typedef struct given_setting {
    const char *name, *value;
} given_setting;

/* The command line's values; the scene's hold where none was given. */
typedef struct options {
    const char *scene;
    const char **outfiles;         /* owned array, the strings are argv's */
    ag_sample_type *outfile_types; /* owned array: of each of them, AG_SAMPLE_DEFAULT: as --type says */
    char **typed_names;            /* owned array and strings: the names that were given with a type */
    int outfile_count;
    const char **confined_to; /* owned array, the strings are argv's */
    char *command_line;       /* owned */
    const char *stats, *photons_file;
    bool photons_only;         /* no picture */
    bool lists_displays;       /* there is no scene then */
    double checkpoint_seconds; /* 0: none but at signals, where resume is asked for */
    bool resume, preview, no_clobber;
    bool dry_run;               /* predicts, renders nothing */
    const char *display_server; /* HOST:PORT of a viewer; NULL: none */
    bool serves;                /* a page */
    int serve_port;             /* 0: one that is free */
    const char *serve_address;  /* a number; NULL: 127.0.0.1 */
    uint64_t memory_limit;      /* bytes of the process; 0: none */
    ag_definition *definitions; /* owned, as are its strings */
    size_t definition_count;
    bool seed_per_frame;                 /* the frame's number is added to the seed */
    const char *seed_pattern;            /* the seed, with a placeholder for the frame's number; NULL: there is none */
    int frame;                           /* of one of several pictures, its number */
    frame_list frames;                   /* empty: one picture, whose names have no placeholders */
    const struct options *of_all_frames; /* the options of all frames, of which one frame's were made */
    int tile_index, tile_count;          /* from 1 on; 0: the whole */
    double time_limit;                   /* s, 0: none */
    double deadline;                     /* main's, of each picture: when it is reached, in seconds of passes_seconds();
                                            INFINITY: never */
    progress_style progress;
    picture_form picture_form;
    int verbosity; /* -1 quiet, 0, 1 verbose, 2 debug */
    bool has_camera_from, has_camera_to;
    bool has_camera_detail; /* its up or its field of view */
    bool has_sky_detail;    /* its strength or its rotation */
    float sky_strength;
    ag_scene_settings asked; /* of the scene; without the definitions, which stand above */
    ag_context_settings context;
    ag_output_settings output;
    ag_render_settings render; /* our defaults, and the given settings over them */
    given_setting *given;      /* owned array, in the order of the command line; the strings are not */
    int given_count;
    options_asked asked_text;
    struct display_server *display; /* main's, while it renders, or NULL */
    struct page_server *page;       /* main's, while it renders, or NULL */
    struct progress *told;          /* main's, while it renders, or NULL */
} options;

typedef enum options_result { OPTIONS_RUN, OPTIONS_EXIT_OK, OPTIONS_EXIT_USAGE } options_result;

/* Prints help or version to standard output, mistakes to standard error. */
options_result options_parse(int argc, char **argv, options *out_options);
void options_reset(options *o);
void options_free_definition(ag_definition *definition); /* its strings */

/* How one of the outfiles is to be written. */
ag_output_settings options_output(const options *o, int index);

/* Puts what was given on the command line over the scene's settings. Returns false where the picture has fewer rows
 * than tiles. */
bool options_override(const options *o, const ag_scene *scene, ag_render_settings *settings);

#endif
