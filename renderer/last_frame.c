/* last_frame.c: see last_frame.h. */
#include "last_frame.h"

#include "irradiance_carry.h"

#include <stdlib.h>
#include <string.h>

void last_frame_destroy(last_frame *left)
{
    if (!left)
        return;
    photon_map_reset(&left->map);
    scene_forms_reset(&left->forms);
    free(left);
}

static void replace(ag_context *context, last_frame *by)
{
    last_frame_destroy(context->last_frame);
    context->last_frame = by;
}

void last_frame_leave(ag_context *context, photon_map *map, scene_forms *forms)
{
    last_frame *left = map->reaches_squared ? malloc(sizeof *left) : NULL;
    if (!left) /* without memory the next frame computes all anew */
        return;
    *left = (last_frame){*map, *forms};
    left->map.surfaces = NULL;
    photon_map_drop_spaces(&left->map); /* they are of that scene */
    *map = (photon_map){0};
    *forms = (scene_forms){0};
    replace(context, left);
}

ag_status last_frame_use(ag_context *context, const scene_forms *forms, photon_map *map)
{
    last_frame *before = context->last_frame;
    if (!before)
        return AG_OK;
    scene_difference difference;
    irradiance_carry carry = {0};
    ag_status status = scene_forms_compare(&before->forms, forms, &difference);
    if (status == AG_OK)
        status = irradiance_carry_over(&context->run, &before->map, &difference, map, &carry);
    context->statistics.photons_came += carry.came;
    context->statistics.photons_went += carry.went;
    context->statistics.irradiance_kept += carry.kept;
    if (status == AG_OK)
        log_message(context->log, AG_LOG_INFO, "irradiance is kept at %llu of %u photons: %llu came, %llu went",
                    (unsigned long long)carry.kept, map->irradiance_photons.count, (unsigned long long)carry.came,
                    (unsigned long long)carry.went);
    replace(context, NULL);
    return status;
}

void ag_context_take_frame(ag_context *context, ag_context *from)
{
    if (!context || !from || context == from || strcmp(context->isa, from->isa) != 0)
        return;
    replace(context, from->last_frame);
    from->last_frame = NULL;
}
