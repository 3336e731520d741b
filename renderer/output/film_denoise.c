/* film_denoise.c: a film through Open Image Denoise, with its layers of albedo and normals where it has them.
 * Flow: film -> [here] -> denoise -> film. Threads: as in afterglow.h. */
#include "context.h"
#include "film/film_channels.h"
#include "film/film_tiles.h"
#include "output/denoise.h"

#include <stdlib.h>

ag_status ag_denoise_check(ag_context *context)
{
    char message[1024];
    if (!context)
        return AG_ERROR_ARGUMENT;
    ag_status status = denoise_check(message, sizeof message);
    if (status != AG_OK)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    return status;
}

ag_status ag_film_denoise(ag_context *context, ag_film *film)
{
    if (!context || !film)
        return AG_ERROR_ARGUMENT;
    size_t size = (size_t)film->width * (size_t)film->height * 3;
    bool has_albedo = aov_has(&film->layout, SUM_ALBEDO), has_normal = aov_has(&film->layout, SUM_NORMAL);
    float *albedo = has_albedo ? malloc(size * sizeof *albedo) : NULL;
    float *normal = has_normal ? malloc(size * sizeof *normal) : NULL;
    char message[1024] = "";
    phase_begin begin = context_begin_phase();
    ag_status status = (has_albedo && !albedo) || (has_normal && !normal) ? AG_ERROR_MEMORY : AG_OK;
    if (status == AG_OK) {
        if (albedo)
            film_read_sum(film, SUM_ALBEDO, albedo);
        if (normal)
            film_read_sum(film, SUM_NORMAL, normal);
        film_tiles_begin_change(film->tiles);
        status = denoise_picture(film->width, film->height, film->pixels, albedo, normal, context->statistics.threads,
                                 message, sizeof message);
        film_tiles_end_change(film->tiles);
    }
    if (message[0])
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    free(albedo);
    free(normal);
    context_add_to_phase(context, AG_PHASE_WRITE, begin);
    return status;
}
