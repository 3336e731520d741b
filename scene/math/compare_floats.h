/* compare_floats.h: the order of floats, for qsort. Threads: a pure function. */
#ifndef AFTERGLOW_COMPARE_FLOATS_H
#define AFTERGLOW_COMPARE_FLOATS_H

/* Compares two floats that are numbers, for qsort: below 0, 0 or above 0, as the first is less, equal or greater. */
static inline int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

#endif
