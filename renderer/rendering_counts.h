/* rendering_counts.h: what a rendering has done, for the context's statistics.
 * Flow: render -> [here] -> statistics. Threads: the context's. */
#ifndef AFTERGLOW_RENDERING_COUNTS_H
#define AFTERGLOW_RENDERING_COUNTS_H

#include "rendering.h"

/* Adds the workers' counts since the last call to the statistics. */
void rendering_count_rays(struct ag_rendering *r);
/* Adds what the maps' cache has counted since the last call with finds_distinct, by any rendering; distinct photons are
 * looked for with that alone, since it takes time. */
void rendering_count_irradiance(ag_statistics *statistics, maps *m, bool finds_distinct);

#endif
