/* mtl_file.h: the materials of an MTL file, as the file says them.
 * Rests on: Wavefront, "MTL material format", 1995; the PBR extension as Clara.io and Blender write it.
 * Flow: text_lines -> [here] -> obj_file, which makes those that are used (import_material). Threads: one per scene. */
#ifndef AFTERGLOW_MTL_FILE_H
#define AFTERGLOW_MTL_FILE_H

#include "model/import_model.h"
#include "run_context.h"
#include "text/name_table.h"

/* Zeroed, it is empty. */
typedef struct mtl_library {
    import_material *materials;
    size_t count, capacity;
    name_table names; /* to indices; of two that have one name the later counts */
} mtl_library;

/* Adds what is in the file. What is not supported is named in a warning, once; a number that is none is an error, with
 * its location. file is for messages and lives as long as they. Errors: AG_ERROR_SCENE, AG_ERROR_MEMORY. */
ag_status mtl_library_read(mtl_library *library, log_sink *log, const char *file, const char *text, size_t size);
void mtl_library_reset(mtl_library *library);

/* Returns a material of a name with MTL's defaults. */
import_material mtl_material_make(const char *name);

#endif
