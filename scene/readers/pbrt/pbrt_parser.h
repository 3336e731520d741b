/* pbrt_parser.h: a scene in the pbrt-v4 text format. Errors in the text are told as FILE:LINE:COLUMN: error: ..., with
 * the offending token. The path that pbrt_parse_file (scene_reader.h) takes is a file, plain or gzip, or "-" for
 * standard input.
 * Rests on the format's description, pbrt.org/fileformat-v4.
 * Flow: scene file -> [here] -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_PBRT_PARSER_H
#define AFTERGLOW_PBRT_PARSER_H

#include "scene_reader.h"

/* Works as pbrt_parse_file, on a text in memory, as if it had been read from a file of that name. */
ag_status pbrt_parse_text(run_context *run, const char *name, const char *text, size_t size, scene *out_scene);

#endif
