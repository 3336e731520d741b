/* light_type.c: see light_type.h. */
#include "light/light_type.h"

const light_type *const light_types[LIGHT_KIND_COUNT] = {
#define LIGHT_TYPE_ROW(kind, type) [kind] = &(type),
    LIGHT_KIND_LIST(LIGHT_TYPE_ROW)
#undef LIGHT_TYPE_ROW
};
