/* ply_scene.c: the reader of PLY files (scene_reader.h): one mesh, grey, as it stands in the file.
 * Flow: ply_file -> [here] -> importer -> scene. Threads: one per scene. */
#include "model/importer.h"
#include "model/ply_file.h"
#include "scene_reader.h"
#include "status.h"

ag_status ply_load_file(run_context *run, const char *path, scene *out_scene)
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
