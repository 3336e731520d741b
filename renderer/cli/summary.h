/* summary.h: what was done, as a table for a person.
 * Flow: ag_context_statistics -> [here] -> standard error. Threads: main's. */
#ifndef AFTERGLOW_SUMMARY_H
#define AFTERGLOW_SUMMARY_H

#include "afterglow/afterglow.h"

#include <stdio.h>

void summary_print(FILE *file, const ag_statistics *statistics);

/* Prints the predicted time and memory of a picture as a table. texture_file_bytes: of the temporary file that textures
 * lie in. */
void summary_print_prediction(FILE *file, const ag_prediction *prediction, uint64_t texture_file_bytes);

#endif
