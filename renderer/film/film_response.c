/* film_response.c: see film_response.h. */
#include "film/film_response.h"

#include "color/cie.h"
#include "color/spectra.h"

/* The chromaticity that pbrt gives a temperature: below 4000 K daylight is not defined, and a black body stands in. */
static void light_chromaticity(double kelvin, double out_xy[2])
{
    if (kelvin >= 4000.0) {
        cie_daylight_chromaticity(kelvin, out_xy);
        return;
    }
    spectra_blackbody_chromaticity(kelvin, out_xy);
}

film_response film_response_make(const ag_render_settings *settings, const working_space *space)
{
    film_response r = {.is_bounded = settings->max_component > 0.0f && !isinf(settings->max_component)};
    r.is_plain = settings->exposure == 1.0f && settings->white_balance == 0.0f;
    r.max_component = (double)settings->max_component / settings->exposure;
    r.xyz_from_rgb = space->to_xyz;
    r.develop = (color_matrix){{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    if (settings->white_balance != 0.0f) {
        double from_xy[2];
        light_chromaticity((double)settings->white_balance * (1.4388 / 1.4380),
                           from_xy); /* c2 has changed since 1968 */
        color_matrix adapt = color_adaptation(from_xy, COLOR_WHITE_XY), back = space->from_xyz;
        adapt = color_matrix_multiply(&adapt, &r.xyz_from_rgb);
        r.develop = color_matrix_multiply(&back, &adapt);
    }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            r.develop.m[i][k] *= (double)settings->exposure;
    return r;
}

rgb film_response_bound(const film_response *response, rgb radiance)
{
    double xyz[3] = {radiance.r, radiance.g, radiance.b};
    color_matrix_apply(&response->xyz_from_rgb, xyz, xyz);
    double largest = double_max(xyz[0], double_max(xyz[1], xyz[2]));
    return largest > response->max_component ? rgb_scale(radiance, (float)(response->max_component / largest))
                                             : radiance;
}

void film_response_develop(const film_response *response, double pixel[3])
{
    color_matrix_apply(&response->develop, pixel, pixel);
}
