/* call_matrix.h: the 4 x 4 matrices that callers hand over, as rows of world from own space.
 * Flow: scene_call -> [here]. Threads: any. */
#ifndef AFTERGLOW_CALL_MATRIX_H
#define AFTERGLOW_CALL_MATRIX_H

#include "log.h"
#include "math/transform.h"
#include "text/file_location.h"

/* Copies `count` matrices of 16 numbers into *out, to be freed; NULL leaves *out as it is. A number that is not finite,
 * a last row that is not 0 0 0 1 and a matrix that has no inverse are told in the log, at where. Errors:
 * AG_ERROR_ARGUMENT, AG_ERROR_MEMORY. */
ag_status call_matrix_copy(log_sink *log, file_location where, const double *rows, size_t count, double **out);

/* Makes a transform of one of them; NULL gives the identity. False where it has no inverse. */
bool call_matrix_transform(const double *rows, transform *out_transform);

#endif
