/* light_type.c: see light_type.h. */
#include "light/light_type.h"

const light_type *light_type_of(light_kind kind)
{
    static const light_type *const TYPES[LIGHT_KIND_COUNT] = {
        [LIGHT_POINT] = &point_light,
        [LIGHT_SPOT] = &spot_light,
        [LIGHT_GONIOMETRIC] = &goniometric_light,
        [LIGHT_PROJECTION] = &projection_light,
        [LIGHT_DISTANT] = &distant_light,
        [LIGHT_AREA] = &area_light,
        [LIGHT_INFINITE] = &infinite_light,
    };
    return TYPES[kind];
}
