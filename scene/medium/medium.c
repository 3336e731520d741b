/* medium.c: what all media have, and which file knows the rest: see medium_type.h. Threads: read-only. */
#include "medium/medium_roulette.h"
#include "medium/medium_type.h"

#include <string.h>

const medium_type *const medium_types[MEDIUM_KIND_COUNT] = {
#define MEDIUM_TYPE_ROW(kind, type) [kind] = &(type),
    MEDIUM_KIND_LIST(MEDIUM_TYPE_ROW)
#undef MEDIUM_TYPE_ROW
};

medium medium_make(medium_kind kind)
{
    medium m;
    memset(&m, 0, sizeof m);
    m.kind = kind;
    return m;
}

void medium_reset(medium *m)
{
    const medium_type *type = medium_type_of(m->kind);
    if (type->reset)
        type->reset(m);
    *m = medium_make(m->kind);
}

bool medium_scatters(const medium *m) { return medium_type_of(m->kind)->scatters(m); }

rgb medium_transmittance(const medium *m, const medium_stretch *way)
{
    return medium_type_of(m->kind)->transmittance(m, way);
}

void medium_add_hash(const medium *m, hash128 *h)
{
    const int roulette_after = MEDIUM_ROULETTE_AFTER; /* another beginning of roulette gives other photons */
    HASH128_ADD(h, m->kind);
    medium_type_of(m->kind)->add_hash(m, h);
    phase_function_add_hash(&m->phase, h);
    if (medium_scatters(m))
        HASH128_ADD(h, roulette_after);
}
