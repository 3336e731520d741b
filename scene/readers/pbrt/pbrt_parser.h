/* pbrt_parser.h: a scene in the pbrt-v4 text format, read into a scene.
 * Rests on the format's description, pbrt.org/fileformat-v4.
 * Flow: scene file -> [here] -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_PBRT_PARSER_H
#define AFTERGLOW_PBRT_PARSER_H

#include "scene.h"

/* path: a file (plain or gzip), or "-" for standard input. Fills an empty, uncommitted scene.
 * Every error is told to the run's log as FILE:LINE:COLUMN: error: ..., with the offending token; what is not supported
 * is named in a warning, once. Errors: AG_ERROR_INPUT (a file cannot be read), AG_ERROR_SCENE, AG_ERROR_MEMORY,
 * AG_CANCELLED. */
ag_status pbrt_parse_file(run_context *run, const char *path, scene *out_scene);

/* pbrt_parse_file of a text in memory, as if it had been read from a file of that name. */
ag_status pbrt_parse_text(run_context *run, const char *name, const char *text, size_t size, scene *out_scene);

#endif
