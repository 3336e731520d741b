/* scene_file.c: see scene_file.h; and PLY files that are a scene by themselves. Threads: one per scene. */
#include "scene_file.h"

#include "gltf/gltf_reader.h"
#include "model/import_file.h"
#include "model/importer.h"
#include "model/obj_file.h"
#include "model/ply_file.h"
#include "pbrt/pbrt_parser.h"
#include "scene_overrides.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* A mesh alone: grey, as it stands in the file. */
static ag_status load_ply(run_context *run, const char *path, scene *out_scene)
{
    importer i;
    ply_mesh m;
    char error[768] = "";
    import_surface surface = {.alpha = 1.0f, .alpha_texture = SCENE_NO_TEXTURE, .radiance_texture = SCENE_NO_TEXTURE};
    material gray = material_make(MATERIAL_DIFFUSE);
    transform identity = transform_identity();
    AG_TRY(importer_init(&i, run, path, out_scene));
    run_progress(run, AG_PHASE_LOAD, 0.0);
    ag_status status = ply_file_read(path, run, error, sizeof error, &m);
    if (status == AG_ERROR_INPUT)
        log_message(run->log, AG_LOG_ERROR, "%s", error); /* begins with the file's name */
    if (status == AG_OK) {
        i.left_out_count = m.lines;
        i.odd_vector_count = m.odd_vectors;
        status = scene_add_material(out_scene, &gray, &surface.material_index);
    }
    if (status != AG_OK) {
        ply_mesh_reset(&m);
        return status;
    }
    AG_TRY(importer_add_mesh(&i, "vertex", &m.mesh, &identity, &surface)); /* takes the mesh */
    if (out_scene->shape_count > 0)
        AG_TRY(scene_set_name(out_scene, NAMED_SHAPE, 0, path));
    log_at(run->log, AG_LOG_INFO, i.where, "a PLY file has no materials: the mesh is grey");
    AG_TRY(importer_finish(&i));
    run_progress(run, AG_PHASE_LOAD, 1.0);
    return AG_OK;
}

typedef ag_status load_function(run_context *run, const char *path, scene *out_scene);

/* Ahead of assimp, which reads some of them too. */
static const struct {
    const char *ending;
    load_function *load;
} READERS[] = {
    {".pbrt", pbrt_parse_file}, {".pbrt.gz", pbrt_parse_file}, {".obj", obj_load_file},   {".obj.gz", obj_load_file},
    {".ply", load_ply},         {".ply.gz", load_ply},         {".gltf", gltf_load_file}, {".glb", gltf_load_file},
};

static bool ends_with(const char *path, const char *ending)
{
    size_t length = strlen(path), ending_length = strlen(ending);
    return length >= ending_length && strcasecmp(path + length - ending_length, ending) == 0;
}

/* Text whose name no reader knows may be of another renderer. */
static ag_status load_unknown(run_context *run, const char *path, scene *out_scene)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    ag_status status = pbrt_parse_file(run, path, out_scene);
    if (status == AG_ERROR_SCENE && dot && strcasecmp(dot, ".gz") != 0 && import_finds_program(run, AG_LOG_WARNING))
        log_message(run->log, AG_LOG_WARNING, "no reader knows files that end in %s: this one was read as pbrt text",
                    dot);
    return status;
}

/* out_load: the reader of files of that name. */
static ag_status find_reader(const run_context *run, const char *path, load_function **out_load)
{
    *out_load = load_unknown;
    for (size_t k = 0; k < sizeof READERS / sizeof *READERS; k++)
        if (ends_with(path, READERS[k].ending)) {
            *out_load = READERS[k].load;
            return AG_OK;
        }
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    bool is_models = false;
    if (dot && dot[1] != '\0')
        AG_TRY(import_reads_extension(run, dot, &is_models));
    if (is_models)
        *out_load = import_file_load;
    return AG_OK;
}

/* Does what is asked for beyond what the file says. */
static ag_status finish(run_context *run, const char *path, bool is_pbrt, scene *out_scene)
{
    if (out_scene->request)
        AG_TRY(scene_overrides_apply(run, path, is_pbrt, out_scene));
    const definition *unused = definitions_unused(out_scene->definitions);
    if (!unused)
        return AG_OK;
    log_message(run->log, AG_LOG_ERROR, "%s: error: the scene has no $%s, which -D %s=%s is for", path, unused->name,
                unused->name, unused->value);
    return AG_ERROR_ARGUMENT;
}

ag_status scene_file_load(run_context *run, const char *path, scene *out_scene)
{
    load_function *load;
    AG_TRY(find_reader(run, path, &load));
    AG_TRY(load(run, path, out_scene));
    return finish(run, path, load == pbrt_parse_file || load == load_unknown, out_scene);
}

ag_status scene_file_load_text(run_context *run, const char *name, const char *text, size_t size, scene *out_scene)
{
    AG_TRY(pbrt_parse_text(run, name, text, size, out_scene));
    return finish(run, name, true, out_scene);
}
