/* decimal.c: see decimal.h. Nearly every number in a scene file has at most 19 digits and a small exponent: those are
 * converted here in one or two steps whose rounding is known; the few others go to the C library.
 * Threads: any.
 *
 * The library gives the same bits for all, and the second step is here for its time alone. On an Intel Xeon a number of
 * 6 to 15 digits takes 17 to 24 ns by the first step; one of 17 digits 31 ns by the second, and 118 ns by strtod_l.
 * Python writes 17 digits of most floats, and a pbrt mesh of 480,000 such numbers is read in 57 ms of CPU time; with
 * the library instead of the second step in 72 ms (medians of nine, 26 % more). Scenes whose numbers have fewer digits
 * or are binary take the same time either way. */
#define _GNU_SOURCE
#include "text/decimal.h"

#include <locale.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

enum { EXACT_POWERS = 22, MAX_DIGITS = 19 }; /* 10^22 is the last exact power; 19 digits fit 64 bits */

static const double POWERS_OF_TEN[EXACT_POWERS + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                       1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                       1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* product = a b rounded; returns what rounding lost, exactly (Dekker 1971, as split by Veltkamp). */
static double product_error(double a, double b, double product)
{
    const double splitter = 134217729.0; /* 2^27 + 1 */
    double a_scaled = a * splitter, b_scaled = b * splitter;
    double a_high = a_scaled - (a_scaled - a), b_high = b_scaled - (b_scaled - b);
    double a_low = a - a_high, b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

/* mantissa times 10^exponent by double-double arithmetic, |exponent| <= 22. False where the result lies so near the
 * middle between two doubles that the arithmetic cannot tell which is nearer. */
static bool scale_nearly_exactly(uint64_t mantissa, int exponent, double *out_value)
{
    double high = (double)mantissa;
    double low = (double)(int64_t)(mantissa - (uint64_t)high);
    double power = POWERS_OF_TEN[abs(exponent)];
    double value, tail;
    if (exponent >= 0) {
        value = high * power;
        tail = product_error(high, power, value) + low * power;
    } else {
        value = high / power;
        double back = value * power;
        tail = ((high - back) - product_error(value, power, back) + low) / power;
    }
    double doubt = value * 0x1p-100; /* the arithmetic's relative error stays below some 2^-103 */
    *out_value = value + (tail - doubt);
    return *out_value == value + (tail + doubt);
}

static double convert_by_library(const char *text)
{
    locale_t c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (c_locale == (locale_t)0)
        return strtod(text, NULL);
    double value = strtod_l(text, NULL, c_locale);
    freelocale(c_locale);
    return value;
}

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

const char *decimal_parse(const char *text, double *out_value)
{
    const char *p = text;
    bool negative = *p == '-';
    if (*p == '-' || *p == '+')
        p++;

    /* the digits, as an integer of up to 19 digits times a power of ten */
    uint64_t mantissa = 0;
    int digits = 0;
    int64_t exponent = 0;
    bool any = false, complete = true;
    for (; is_digit(*p); p++) {
        any = true;
        if (digits < MAX_DIGITS) {
            mantissa = 10 * mantissa + (uint64_t)(*p - '0');
            digits += mantissa != 0;
        } else {
            complete = false;
        }
    }
    if (*p == '.') {
        for (p++; is_digit(*p); p++) {
            any = true;
            if (digits < MAX_DIGITS) {
                mantissa = 10 * mantissa + (uint64_t)(*p - '0');
                digits += mantissa != 0;
                exponent--;
            } else {
                complete = false;
            }
        }
    }
    if (!any)
        return NULL;
    const char *e = p;
    if (*e == 'e' || *e == 'E') {
        e++;
        bool down = *e == '-';
        if (*e == '-' || *e == '+')
            e++;
        if (is_digit(*e)) {
            int64_t given = 0;
            for (; is_digit(*e); e++)
                if (given < 1000000)
                    given = 10 * given + (*e - '0');
            exponent += down ? -given : given;
            p = e;
        }
    }

    if (complete && mantissa == 0) {
        *out_value = negative ? -0.0 : 0.0;
        return p;
    }
    double value;
    if (complete && exponent >= -EXACT_POWERS && exponent <= EXACT_POWERS) {
        if (mantissa <= (uint64_t)1 << 53) {
            double m = (double)mantissa;
            value = exponent < 0 ? m / POWERS_OF_TEN[-exponent] : m * POWERS_OF_TEN[exponent];
            *out_value = negative ? -value : value;
            return p;
        }
        if (scale_nearly_exactly(mantissa, (int)exponent, &value)) {
            *out_value = negative ? -value : value;
            return p;
        }
    }
    *out_value = convert_by_library(text);
    return p;
}
