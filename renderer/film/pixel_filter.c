/* pixel_filter.c: see pixel_filter.h. */
#include "film/pixel_filter.h"

#include <string.h>

/* Signs that sum up to less than this share of what they should are taken to cancel out. */
static const double LEAST_SIGN_SHARE = 0.5;

static const double PI = 3.14159265358979323846;

static double sinc(double x) { return x == 0.0 ? 1.0 : sin(PI * x) / (PI * x); }

/* Mitchell, Netravali, "Reconstruction Filters in Computer Graphics", 1988, equation 8; zero from 2 on. */
static double mitchell(double x, double b, double c)
{
    x = fabs(x);
    if (x >= 2.0)
        return 0.0;
    if (x >= 1.0)
        return (((-b - 6.0 * c) * x + 6.0 * b + 30.0 * c) * x - 12.0 * b - 48.0 * c) * x + 8.0 * b + 24.0 * c;
    return ((12.0 - 9.0 * b - 6.0 * c) * x - 18.0 + 12.0 * b + 6.0 * c) * x * x + 6.0 - 2.0 * b;
}

/* Along one axis, up to a factor. */
static double filter_value(const filter_hint *f, double x, double radius)
{
    double sigma = (double)f->sigma;
    switch (f->kind) {
    case FILTER_BOX: return 1.0;
    case FILTER_TRIANGLE: return double_max(radius - fabs(x), 0.0);
    case FILTER_GAUSSIAN:
        /* pbrt takes away the value at the edge */
        return double_max(exp(-x * x / (2.0 * sigma * sigma)) - exp(-radius * radius / (2.0 * sigma * sigma)), 0.0);
    case FILTER_MITCHELL: return mitchell(2.0 * x / radius, (double)f->b, (double)f->c);
    case FILTER_SINC: return sinc(x) * sinc(x / (double)f->tau);
    }
    return 0.0;
}

/* One axis of the filter; *out_mean_sign is its integral over that of its magnitude. false: it is nothing but rounding
 * at this resolution, or its lobes cancel out. */
static bool tabulate(const filter_hint *f, float radius, float *cdf, signed char *sign, double *out_mean_sign)
{
    double sum = 0.0, whole = 0.0, step = 2.0 * (double)radius / PIXEL_FILTER_STEPS, running[PIXEL_FILTER_STEPS + 1];
    running[0] = 0.0;
    for (int i = 0; i < PIXEL_FILTER_STEPS; i++) {
        double value = filter_value(f, -(double)radius + (i + 0.5) * step, (double)radius);
        sign[i] = value < 0.0 ? -1 : 1;
        whole += value;
        sum += fabs(value);
        running[i + 1] = sum;
    }
    for (int i = 0; i <= PIXEL_FILTER_STEPS; i++)
        cdf[i] = (float)(running[i] / sum);
    *out_mean_sign = whole / sum;
    return sum > 0.0 && *out_mean_sign > 0.05;
}

ag_status pixel_filter_create(const filter_hint *hint, bool is_centered, log_sink *log, pixel_filter *out_filter)
{
    out_filter->has_signs = false;
    out_filter->mean_sign = 1.0;
    for (int axis = 0; axis < 2; axis++) {
        double mean_sign;
        out_filter->radius[axis] = is_centered ? 0.0f : hint->radius[axis];
        if (!tabulate(hint, hint->radius[axis], out_filter->cdf[axis], out_filter->sign[axis], &mean_sign)) {
            log_at(log, AG_LOG_ERROR, hint->where, "PixelFilter: %s",
                   hint->kind == FILTER_GAUSSIAN ? "\"sigma\" is too small for the radius"
                                                 : "its negative lobes leave nothing of it");
            return AG_ERROR_SCENE;
        }
        if (is_centered)
            memset(out_filter->sign[axis], 1, sizeof out_filter->sign[axis]);
        else
            out_filter->mean_sign *= mean_sign;
        for (int i = 0; i < PIXEL_FILTER_STEPS; i++)
            out_filter->has_signs = out_filter->has_signs || out_filter->sign[axis][i] < 0;
    }
    return AG_OK;
}

static float sample_axis(const float *cdf, float radius, float u, int *out_step)
{
    int low = 0, high = PIXEL_FILTER_STEPS;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (cdf[middle] <= u)
            low = middle;
        else
            high = middle;
    }
    float share = cdf[low + 1] - cdf[low], within = share > 0.0f ? (u - cdf[low]) / share : 0.5f;
    *out_step = low;
    return radius * (2.0f * ((float)low + within) / PIXEL_FILTER_STEPS - 1.0f);
}

vec2 pixel_filter_sample(const pixel_filter *filter, vec2 u, int *out_sign)
{
    int x, y;
    vec2 offset = {sample_axis(filter->cdf[0], filter->radius[0], u.x, &x),
                   sample_axis(filter->cdf[1], filter->radius[1], u.y, &y)};
    *out_sign = filter->sign[0][x] * filter->sign[1][y];
    return offset;
}

void pixel_filter_resolve(const pixel_filter *filter, const pixel_sum *sum, double out_pixel[3])
{
    double signs = (double)sum->positive_count - sum->negative_count,
           count = (double)sum->positive_count + sum->negative_count;
    bool cancels = signs < LEAST_SIGN_SHARE * filter->mean_sign * count;
    for (int c = 0; c < 3; c++) {
        if (!cancels)
            out_pixel[c] = (sum->positive[c] - sum->negative[c]) / signs;
        else if (sum->positive_count > 0)
            out_pixel[c] = sum->positive[c] / sum->positive_count;
        else
            out_pixel[c] = sum->negative[c] / sum->negative_count;
    }
}
