/* path_settings.h: what settings mean for paths, wherever they are followed. Flow: settings -> [here] -> transport,
 * photon tracing. Threads: pure functions. */
#ifndef AFTERGLOW_PATH_SETTINGS_H
#define AFTERGLOW_PATH_SETTINGS_H

#include "afterglow/afterglow.h"

/* The max_depth that asks for no bound: roulette ends paths then, and surfaces alone scatter them no oftener than
 * this. */
enum { DEPTH_BY_ROULETTE = 100 };
/* Whether max_depth bounds scatterings by media too. */
static inline bool settings_bound_media(const ag_render_settings *settings)
{
    return settings->max_depth < DEPTH_BY_ROULETTE;
}

/* Whether light straight through panes is direct light; else panes are glass like any other. */
static inline bool settings_panes_are_direct(const ag_render_settings *settings)
{
    return settings->pane_light == AG_PANE_LIGHT_DIRECT;
}

#endif
