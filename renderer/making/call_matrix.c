/* call_matrix.c: see call_matrix.h. */
#include "call_matrix.h"

#include "status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Whether the last row is 0 0 0 1, up to the rounding of a caller who has inverted a matrix. */
static bool is_affine(const double *rows)
{
    static const double ROUNDING = 1e-6;
    return fabs(rows[12]) <= ROUNDING && fabs(rows[13]) <= ROUNDING && fabs(rows[14]) <= ROUNDING &&
           fabs(rows[15] - 1.0) <= ROUNDING;
}

bool call_matrix_transform(const double *rows, transform *out_transform)
{
    double m[4][4];
    *out_transform = transform_identity();
    if (!rows)
        return true;
    memcpy(m, rows, sizeof m);
    return transform_from_matrix((const double(*)[4])m, out_transform);
}

static ag_status refuse(log_sink *log, file_location where, const char *what)
{
    log_at(log, AG_LOG_ERROR, where, "%s", what);
    return AG_ERROR_ARGUMENT;
}

enum { NUMBERS = 16 };

static ag_status check(log_sink *log, file_location where, const double *rows)
{
    transform unused;
    for (int i = 0; i < NUMBERS; i++)
        if (!isfinite(rows[i]))
            return refuse(log, where, "a number of its matrix is not finite");
    if (!is_affine(rows))
        return refuse(log, where,
                      "the last row of its matrix is not 0 0 0 1: the 16 numbers go row by row, and the translation "
                      "is in the last column");
    if (!call_matrix_transform(rows, &unused))
        return refuse(log, where, "its matrix cannot be undone");
    return AG_OK;
}

ag_status call_matrix_copy(log_sink *log, file_location where, const double *rows, size_t count, double **out)
{
    if (!rows)
        return AG_OK;
    for (size_t i = 0; i < count; i++)
        AG_TRY(check(log, where, rows + NUMBERS * i));
    *out = malloc(NUMBERS * count * sizeof **out);
    if (!*out)
        return AG_ERROR_MEMORY;
    memcpy(*out, rows, NUMBERS * count * sizeof **out);
    return AG_OK;
}
