/* pbrt_ply.c: Shape "plymesh" of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Shapes".
 * Flow: pbrt_shapes -> [here] -> ply_file -> pbrt_add_object_mesh. Threads: one per scene. */
#include "model/ply_file.h"
#include "pbrt/pbrt_meshes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Warns of displacement, and of how finely it would cut the mesh. */
static void warn_displacement(pbrt_parser *parser, parameter_list *list)
{
    static const char *const NAMES[] = {"displacement", "edgelength"};
    for (size_t i = 0; i < list->count; i++)
        for (size_t n = 0; n < 2; n++)
            if (strcmp(list->items[i].name, NAMES[n]) == 0) {
                list->items[i].looked_up = true;
                log_at_once(parser->log, AG_LOG_WARNING, list->items[i].where, NAMES[n],
                            "Shape \"plymesh\": displacement is not supported yet: \"%s\" is ignored", NAMES[n]);
            }
}

ag_status pbrt_ply_mesh(pbrt_parser *parser, parameter_list *list)
{
    const char *name = NULL;
    char error[768] = "";
    ply_mesh m;
    AG_TRY(parameter_get_string(list, parser->log, "filename", &name));
    if (!name)
        return pbrt_refuse(parser, list, "filename", "\"string filename\" is missing");
    warn_displacement(parser, list);
    parameter_list_warn_unused(list, parser->log);
    char *path = pbrt_find_file(parser, name);
    if (!path)
        return AG_ERROR_MEMORY;
    ag_status status = ply_file_read(path, parser->run, error, sizeof error, &m);
    free(path);
    if (status == AG_ERROR_INPUT)
        pbrt_error(parser, list->where, strlen("Shape"), "Shape \"plymesh\": %s", error);
    AG_TRY(status);
    if (m.odd_vectors > 0)
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "Shape \"plymesh\": %zu normals or texture coordinates in \"%s\" are not finite, and are not used",
               m.odd_vectors, name);
    uint32_t shape_count = parser->scene->shape_count;
    AG_TRY(pbrt_add_object_mesh(parser, list, &m.mesh, m.lines, false));
    return parser->scene->shape_count > shape_count ? scene_set_name(parser->scene, NAMED_SHAPE, shape_count, name)
                                                    : AG_OK;
}
