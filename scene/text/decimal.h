/* decimal.h: decimal text to double, correctly rounded, whatever the locale.
 * Rests on: Clinger, "How to Read Floating Point Numbers Accurately", PLDI 1990 (the exact case); Dekker, "A
 * Floating-Point Technique for Extending the Available Precision", Numer. Math. 18, 1971 (the nearly exact one).
 * Flow: pbrt_lexer reads the numbers of a scene file with it. Threads: any. */
#ifndef AFTERGLOW_DECIMAL_H
#define AFTERGLOW_DECIMAL_H

/* Reads [+-]digits[.digits][e[+-]digits] at text, with at least one digit before or behind the point; text ends with
 * a NUL. Returns the address behind the number and writes its value, +-INFINITY where it is too large for a double;
 * returns NULL where there is no number. */
const char *decimal_parse(const char *text, double *out_value);

#endif
