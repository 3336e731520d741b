/* scene_load.h: what scenes from files and scenes from memory have in common.
 * Flow: scene_load, scene_memory -> [here] -> scene. Threads: as in afterglow.h. */
#ifndef AFTERGLOW_SCENE_LOAD_H
#define AFTERGLOW_SCENE_LOAD_H

#include "context.h"

/* Says in the log what is wrong with settings; gives AG_ERROR_ARGUMENT. */
ag_status scene_settings_refuse(ag_context *context, const char *what);
/* Borrows the strings of the settings. Errors: AG_ERROR_ARGUMENT (one is out of its range; the log says which). */
ag_status scene_request_make(ag_context *context, const ag_scene_settings *settings, scene_request *out_request);

/* Before anything is read: colours, what is asked for, and which files may be read; name: the scene's file. Borrows
 * request and name. Errors: those of context_color_config, AG_ERROR_ARGUMENT, AG_ERROR_MEMORY. */
ag_status scene_prepare(ag_context *context, const char *name, const scene_request *request, scene *s,
                        input_files *inputs);

/* When all is read: gives back what was borrowed, and builds what rays need. Errors: those of scene_commit. */
ag_status scene_complete(ag_context *context, scene *s);

/* A scene on its way, see making/scene_making.h. NULL is fine. */
void scene_making_destroy(struct scene_making *making);

#endif
