/* film_response.h: from radiance to what the film holds: exposure, a bound on single samples, white balance.
 * Rests on: pbrt-v4's PixelSensor "cie1931" and RGBFilm: samples are bounded in CIE XYZ after the exposure; white
 * balance is the Bradford transform from daylight of a temperature to our white. Flow: radiance -> [here] -> film.
 * Threads: read-only once made. */
#ifndef AFTERGLOW_FILM_RESPONSE_H
#define AFTERGLOW_FILM_RESPONSE_H

#include "afterglow/afterglow.h"
#include "color/working_space.h"

typedef struct film_response {
    bool is_bounded, is_plain; /* is_plain: the pixel is the mean of its samples, bit for bit */
    double max_component;      /* of a sample's radiance, in XYZ */
    color_matrix xyz_from_rgb;
    color_matrix develop; /* exposure and white balance */
} film_response;

/* Returns the response of the settings. space: of the radiance and of the film. */
film_response film_response_make(const ag_render_settings *settings, const working_space *space);

/* Returns a sample's radiance, scaled down where it is too bright. Called only where is_bounded. */
rgb film_response_bound(const film_response *response, rgb radiance);

/* Develops a radiance, the mean of samples or one of them, in place. Called only where not is_plain. */
void film_response_develop(const film_response *response, double pixel[3]);

#endif
