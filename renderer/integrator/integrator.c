/* integrator.c: see integrator.h. */
#include "integrator/integrator.h"

const integrator *integrator_of(ag_integrator kind)
{
    static const integrator *const INTEGRATORS[] = {
        [AG_INTEGRATOR_PHOTONMAP] = &photon_map_integrator,
        [AG_INTEGRATOR_PATH] = &path_integrator,
    };
    return (unsigned)kind < sizeof INTEGRATORS / sizeof *INTEGRATORS ? INTEGRATORS[kind] : NULL;
}
