/* mesh_import_assimp.h: models in the formats that assimp reads: STL, Collada, FBX, 3DS and some forty others, as
 * records. Its only user is import_program.c: whatever assimp does to a file of a stranger's, it does in a process of
 * its own. Flow: file -> assimp -> [here] -> records (import_model.h). Threads: the only one of that process. */
#ifndef AFTERGLOW_MESH_IMPORT_ASSIMP_H
#define AFTERGLOW_MESH_IMPORT_ASSIMP_H

#include <stdbool.h>
#include <stdio.h>

/* Writes whether assimp reads files whose names end so: extension with its dot, in any case. */
bool assimp_reads_extension(const char *extension);

/* Reads the file, and writes its records, or one that says why assimp cannot read it. False: they cannot be written. */
bool assimp_write_records(const char *path, FILE *answer);
/* Written instead of records when the file is not to be read. */
bool assimp_write_refusal(const char *text, FILE *answer);

#endif
