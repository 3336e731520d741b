/* gltf_reader.c: the reader of glTF 2.0 files (scene_reader.h), JSON or binary, which are told apart by their first
 * bytes; "-" is standard input. It takes the file's default scene. Messages give the path of the value they are about,
 * as "room.gltf: error: accessors[3].bufferView: ...". Radiance is what the file's luminance is (1 nit is 1 W/m^2/sr),
 * and lamps are measured alike (1 cd is 1 W/sr, 1 lx is 1 W/m^2); but Blender's exporter multiplies those of lamps
 * alone by 683 lm/W, which gltf_lights.c takes back.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, and the KHR extensions that gltf_document.c lists.
 * Flow: file -> gltf_document -> [here] -> gltf_nodes, and import_defaults for what is missing. Threads: one per
 * scene. */
#define _POSIX_C_SOURCE 200809L
#include "gltf/gltf_private.h"
#include "import_defaults.h"
#include "scene_reader.h"

#include <stdlib.h>
#include <string.h>

/* Returns the directory of a path with its slash, or "". NULL when out of memory. */
static char *directory_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return strndup(path, slash ? (size_t)(slash - path) + 1 : 0);
}

static ag_status begin(gltf_reader *r, const char *path)
{
    bool is_input = strcmp(path, "-") == 0;
    r->where.file = scene_intern_file_name(r->scene, is_input ? "standard input" : path);
    r->directory = directory_of(is_input ? "" : path);
    return r->where.file && r->directory ? AG_OK : AG_ERROR_MEMORY;
}

static ag_status allocate_lists(gltf_reader *r)
{
    r->buffers = calloc((size_t)r->list_counts[GLTF_BUFFERS] + 1, sizeof *r->buffers);
    r->images = calloc((size_t)r->list_counts[GLTF_IMAGES] + 1, sizeof *r->images);
    r->materials = calloc((size_t)r->list_counts[GLTF_MATERIALS] + 1, sizeof *r->materials);
    r->mesh_uses = calloc((size_t)r->list_counts[GLTF_MESHES] + 1, sizeof *r->mesh_uses);
    r->world_from_nodes = calloc((size_t)r->list_counts[GLTF_NODES] + 1, sizeof *r->world_from_nodes);
    return r->buffers && r->images && r->materials && r->mesh_uses && r->world_from_nodes ? AG_OK : AG_ERROR_MEMORY;
}

/* Warns of what a still picture has no use for, and of what the file lacks. */
static ag_status end(gltf_reader *r)
{
    gltf_value animations = gltf_member(&r->document, "animations");
    if (json_array_size(animations.json) > 0)
        gltf_warn_once(r, &animations, "animations", "animations are not supported: nodes are where the file has them");
    if (r->triangles_dropped > 0)
        log_at(r->run->log, AG_LOG_INFO, r->where, "%zu of %zu triangles have no area and are left out",
               r->triangles_dropped, r->triangles_read);
    gltf_set_picture_size(r);
    if (!r->scene->has_camera)
        AG_TRY(import_add_default_camera(r->scene, r->run->log));
    if (r->scene->light_count <= r->glow_count && r->is_blenders)
        log_at(r->run->log, AG_LOG_WARNING, r->where,
               "there is no lamp in it: Blender leaves area lamps and the world out of glTF files");
    return r->scene->light_count > r->glow_count ? AG_OK : import_add_default_light(r->scene, r->run->log);
}

static void reset(gltf_reader *r)
{
    for (uint32_t i = 0; r->buffers && i < r->list_counts[GLTF_BUFFERS]; i++)
        free(r->buffers[i].data);
    for (uint32_t i = 0; r->images && i < r->list_counts[GLTF_IMAGES]; i++)
        free(r->images[i].data);
    free(r->buffers);
    free(r->images);
    free(r->materials);
    free(r->mesh_uses);
    free(r->world_from_nodes);
    json_decref(r->root);
    free(r->text);
    free(r->directory);
}

ag_status gltf_load_file(run_context *run, const char *path, scene *out_scene)
{
    gltf_reader r;
    memset(&r, 0, sizeof r);
    r.run = run;
    r.scene = out_scene;
    run_progress(run, AG_PHASE_LOAD, 0.0);
    ag_status status = begin(&r, path);
    if (status == AG_OK)
        status = gltf_document_read(&r, path);
    if (status == AG_OK)
        status = allocate_lists(&r);
    if (status == AG_OK)
        status = gltf_add_nodes(&r);
    if (status == AG_OK)
        status = end(&r);
    if (status == AG_OK)
        run_progress(run, AG_PHASE_LOAD, 1.0);
    reset(&r);
    return status;
}
