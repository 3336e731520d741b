/* settings_table.h: every field of ag_render_settings as a row of one table: what it is called, its default and range,
 * its help, and what it is a part of. Defaults, checks, ag_render_settings_set, --help, the man page's options, the
 * statistics, EXR headers, checkpoints and photon maps' files are made from it: cli/README.md tells how to add a row.
 * Rests on: FFmpeg's AVOption, for the idea. Flow: settings_rows -> [here] -> who asks. Threads: any; rows are
 * const. */
#ifndef AFTERGLOW_SETTINGS_TABLE_H
#define AFTERGLOW_SETTINGS_TABLE_H

#include "afterglow/afterglow.h"

typedef enum setting_kind {
    SETTING_WORD,    /* an enum; its words by value */
    SETTING_INTEGER, /* int */
    SETTING_COUNT,   /* uint64_t below 2^53; its text may be 2e6 */
    SETTING_SEED,    /* uint64_t; its text is below 2^63, as JSON has integers */
    SETTING_NUMBER,  /* float */
    SETTING_FLAG,    /* bool; set by being named */
    SETTING_SIZE,    /* int[2], "WIDTHxHEIGHT" */
    SETTING_WINDOW,  /* double[4], "X0,X1,Y0,Y1" within [0, 1] */
    SETTING_LAYERS,  /* uint32_t of AG_LAYER_...; text adds to it */
    SETTING_FILE     /* const char *, borrowed */
} setting_kind;

enum {
    SETTING_OF_PICTURE = 1, /* samples depend on it: a checkpoint holds for one value */
    SETTING_IN_HEADER = 2,  /* noted in EXR files */
    SETTING_OF_PHOTONS = 4  /* of no use to the path tracer, in whose EXR files it is not noted */
};

typedef struct setting_row {
    ag_setting text; /* text.name NULL: no option sets it */
    size_t offset, size;
    setting_kind kind;
    const char *const *words; /* of SETTING_WORD, ended by NULL */
    double initial;           /* the default, but for SETTING_SIZE and SETTING_WINDOW */
    double least, most;       /* inclusive; most FLT_MAX: any finite number, INFINITY: infinity, too */
    bool is_above_least;      /* least itself is out of range */
    bool has_automatic;       /* a value out of that range has a meaning of its own; text cannot set it */
    double automatic;
    const char *noun; /* for messages: "another NOUN" */
    const char *json; /* in the statistics: "object.name" or "name"; NULL: not there */
    unsigned marks;
} setting_row;

/* NULL: there are no more. */
const setting_row *setting_at(size_t index);
/* All settings at their defaults. */
ag_render_settings settings_table_defaults(void);

/* Whether the setting has a value in its range; where not, out says what it must be. */
bool setting_check(const setting_row *row, const ag_render_settings *settings, char *out, size_t size);

enum { SETTING_TEXT_MAX = 128 };
/* The value as text; a number as short as gives the same number back; "" for a file that is NULL. */
void setting_format(const setting_row *row, const ag_render_settings *settings, char out[SETTING_TEXT_MAX]);

/* All values that the picture's samples depend on, one behind the other; returns how many bytes they take. out NULL:
 * only that. */
size_t settings_of_picture(const ag_render_settings *settings, unsigned char *out, size_t size);
/* The noun of the first value that differs between two such; NULL: none does. */
const char *settings_of_picture_difference(const unsigned char *one, const unsigned char *other);

/* The settings that a kept photon map depends on, a line "NOUN: VALUE" for each setting, ended by a NUL. Returns its
 * length; out is whole where that is below size. */
size_t settings_of_photon_map(const ag_render_settings *settings, char *out, size_t size);

#endif
