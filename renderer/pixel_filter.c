/* pixel_filter.c: see pixel_filter.h. */
#include "pixel_filter.h"

#include <string.h>

typedef enum filter_kind { FILTER_BOX, FILTER_TRIANGLE, FILTER_GAUSSIAN } filter_kind;

static double filter_value(filter_kind kind, double x, double radius, double sigma)
{
    switch (kind) {
    case FILTER_BOX: return 1.0;
    case FILTER_TRIANGLE: return fmax(0.0, radius - fabs(x));
    case FILTER_GAUSSIAN:
        /* pbrt takes away the value at the edge */
        return fmax(0.0, exp(-x * x / (2.0 * sigma * sigma)) - exp(-radius * radius / (2.0 * sigma * sigma)));
    }
    return 0.0;
}

/* false: the filter is nothing but rounding at this resolution. */
static bool tabulate(filter_kind kind, float radius, float sigma, float *cdf)
{
    double sum = 0.0, step = 2.0 * (double)radius / PIXEL_FILTER_STEPS, running[PIXEL_FILTER_STEPS + 1];
    running[0] = 0.0;
    for (int i = 0; i < PIXEL_FILTER_STEPS; i++) {
        sum += filter_value(kind, -(double)radius + (i + 0.5) * step, (double)radius, (double)sigma);
        running[i + 1] = sum;
    }
    for (int i = 0; i <= PIXEL_FILTER_STEPS; i++)
        cdf[i] = (float)(running[i] / sum);
    return sum > 0.0;
}

ag_status pixel_filter_create(parameter_list *directive, log_sink *log, pixel_filter *out_filter)
{
    filter_kind kind = FILTER_GAUSSIAN;
    float radius[2] = {1.5f, 1.5f}, sigma = 0.5f;
    bool is_known = true;
    if (directive->name && strcmp(directive->name, "box") == 0) {
        kind = FILTER_BOX;
        radius[0] = radius[1] = 0.5f;
    } else if (directive->name && strcmp(directive->name, "triangle") == 0) {
        kind = FILTER_TRIANGLE;
        radius[0] = radius[1] = 2.0f;
    } else if (directive->name && strcmp(directive->name, "gaussian") != 0) {
        is_known = false;
        log_at_once(log, AG_LOG_WARNING, directive->where, "pixel filter",
                    "PixelFilter \"%s\" is not supported yet; pbrt's default, \"gaussian\", stands in", directive->name);
    }
    if (directive->name && is_known) {
        ag_status status = parameter_get_float(directive, log, "xradius", &radius[0]);
        if (status == AG_OK)
            status = parameter_get_float(directive, log, "yradius", &radius[1]);
        if (status == AG_OK && kind == FILTER_GAUSSIAN)
            status = parameter_get_float(directive, log, "sigma", &sigma);
        if (status != AG_OK)
            return status;
        if (!(radius[0] > 0.0f && radius[0] <= 64.0f && radius[1] > 0.0f && radius[1] <= 64.0f && sigma > 0.0f)) {
            log_at(log, AG_LOG_ERROR, directive->where, "PixelFilter: radii must be in (0, 64], sigma above 0");
            return AG_ERROR_SCENE;
        }
        parameter_list_warn_unused(directive, log);
    }
    for (int axis = 0; axis < 2; axis++) {
        out_filter->radius[axis] = radius[axis];
        if (!tabulate(kind, radius[axis], sigma, out_filter->cdf[axis])) {
            log_at(log, AG_LOG_ERROR, directive->where, "PixelFilter: \"sigma\" is too small for the radius");
            return AG_ERROR_SCENE;
        }
    }
    return AG_OK;
}

static float sample_axis(const float *cdf, float radius, float u)
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
    return radius * (2.0f * ((float)low + within) / PIXEL_FILTER_STEPS - 1.0f);
}

vec2 pixel_filter_sample(const pixel_filter *filter, vec2 u)
{
    return (vec2){sample_axis(filter->cdf[0], filter->radius[0], u.x), sample_axis(filter->cdf[1], filter->radius[1], u.y)};
}
