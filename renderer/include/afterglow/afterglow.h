/* afterglow.h: the public interface of Afterglow, a photon-mapping global illumination renderer.
 * Four objects, in the order in which the data moves: context, scene, film, file.
 *
 *     ag_context_create -> ag_scene_load -> ag_render -> ag_film_write
 *
 * Threads: a context and what was made with it belong to one thread at a time, but for ag_context_cancel and
 * ag_context_pause, which any thread and any signal handler may call, and for ag_film_read_tile,
 * ag_film_read_picture and ag_view_apply, which any thread may; once one view has been made with a context, other
 * threads may make more of them with ag_view_create. Several contexts may work side by side.
 * Errors: what can fail returns ag_status and writes its out-parameters on AG_OK alone; the text goes to the log. An
 * argument that is NULL and may not be is AG_ERROR_ARGUMENT; functions without a status then do nothing, and return 0
 * or NULL. So it is with an enum's value that is none of its own. What has been destroyed cannot be told from what has
 * not: a program does not use it again. Settings, and the structs that describe parts of a scene, are plain structs
 * that ag_default_...() fills: a program changes the members that it cares for, and later releases add some. The first
 * member, struct_size, is the struct's size as the program was compiled with it, and no more than that is written. A
 * call that gets a size which is not the library's does nothing, and gives AG_ERROR_ARGUMENT, with a message where a
 * context is among its arguments: the struct was not filled, or the program was compiled with the headers of another
 * release. Structs that the library writes for the program (ag_statistics, ag_prediction, ag_growth, ag_noise,
 * ag_photon_map_info) have their size as well, and are filled as far as both sides know them (statistics.h). Structs
 * without a size do not change, but for ag_setting and ag_layer_info, which only the library makes, and to which later
 * releases may add members at the end. The SONAME, which changes whenever a public struct or enum does, keeps releases
 * apart too. Each of the headers below may be included alone. */
#ifndef AFTERGLOW_AFTERGLOW_H
#define AFTERGLOW_AFTERGLOW_H

#include "afterglow/base.h"
#include "afterglow/context.h"
#include "afterglow/film.h"
#include "afterglow/layers.h"
#include "afterglow/output.h"
#include "afterglow/photon_map.h"
#include "afterglow/render_settings.h"
#include "afterglow/rendering.h"
#include "afterglow/scene.h"
#include "afterglow/scene_editing.h"
#include "afterglow/scene_making.h"
#include "afterglow/statistics.h"
#include "afterglow/structs.h"

#endif
