/* scene_parameters.h: parameters as a caller hands them over, as the readers have them.
 * Flow: scene_memory -> [here] -> pbrt_builder. Threads: any. */
#ifndef AFTERGLOW_SCENE_PARAMETERS_H
#define AFTERGLOW_SCENE_PARAMETERS_H

#include "afterglow/afterglow.h"
#include "text/file_location.h"

struct pbrt_items;

enum { SCENE_PARAMETERS_MAX = 1000 }; /* that one call may have */

/* Copies parameters into *out_items, which scene_parameters_free frees with what its items still hold. where: of the
 * call; the log names the number of a parameter that is wrong. Errors: AG_ERROR_ARGUMENT, AG_ERROR_MEMORY. */
ag_status scene_parameters_copy(log_sink *log, file_location where, const ag_parameter *given, size_t count,
                                struct pbrt_items *out_items);
/* Copies items that were taken already, with all that they hold. Errors: AG_ERROR_MEMORY. */
ag_status scene_parameters_duplicate(const struct pbrt_items *from, struct pbrt_items *out);
/* Frees the items with all that they still hold. */
void scene_parameters_free(struct pbrt_items *items);

#endif
