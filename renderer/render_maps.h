/* render_maps.h: light's side of a rendering: photons are traced, or read from a file; maps and the cache made of them.
 * Rests on: Jensen 1996; Christensen 1999; Neilson, Yang, TR 04-21, 2004.
 * Flow: render.c -> [here]. Threads: each phase on all of the context's workers. */
#ifndef AFTERGLOW_RENDER_MAPS_H
#define AFTERGLOW_RENDER_MAPS_H

#include "rendering.h"

/* Counts what it did, phase by phase, in the context's statistics; precomputes where the settings say so. One holder;
 * to be released, on failure too. Borrows scene and context. Errors: AG_ERROR_MEMORY, AG_CANCELLED, those of
 * map_file_obtain. */
ag_status maps_create(ag_context *context, const scene *s, const ag_render_settings *settings, maps **out_maps);
/* Returns a hash of which photons both maps have; computed when it is first asked for. */
hash128 maps_photons_hash(maps *m);
maps *maps_hold(maps *m);
void maps_release(maps *m); /* NULL is fine */

/* From now on phases are broken off when the file of the maps is cut short or overwritten, until run_end_watch: begun
 * by maps_create as soon as there is a file. */
void maps_watch(const maps *m);

/* Whether photons are traced into the caustic map: there is something that focuses light, and they are wanted. */
bool maps_have_caustics(const scene *s, const ag_render_settings *settings);

#endif
