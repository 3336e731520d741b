/* integrator.c: see integrator.h. */
#include "integrator/integrator.h"

const integrator *integrator_of(ag_integrator kind)
{
    static const integrator *const INTEGRATORS[] = {
#define INTEGRATOR_ROW(kind, word, about) [kind] = &(word##_integrator),
        AG_INTEGRATOR_LIST(INTEGRATOR_ROW)
#undef INTEGRATOR_ROW
    };
    return (unsigned)kind < sizeof INTEGRATORS / sizeof *INTEGRATORS ? INTEGRATORS[kind] : NULL;
}

bool ag_integrator_has_photons(ag_integrator kind)
{
    const integrator *known = integrator_of(kind);
    return known && known->has_photon_map;
}
