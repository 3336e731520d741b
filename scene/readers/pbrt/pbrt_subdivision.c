/* pbrt_subdivision.c: Shape "loopsubdiv" of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Shapes".
 * Flow: pbrt_shapes -> [here] -> loop_subdivision -> pbrt_add_mesh. Threads: one per scene. */
#include "pbrt/pbrt_meshes.h"
#include "shape/loop_subdivision.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* pbrt goes round a vertex clockwise, and so has the outside where triangles look clockwise: turned here, indices and
 * normals, so that the two agree. */
static void turn_over(loop_mesh *m)
{
    for (size_t i = 0; i < m->triangle_count; i++) {
        uint32_t *corners = m->indices + 3 * i, second = corners[1];
        corners[1] = corners[2];
        corners[2] = second;
    }
    for (size_t i = 0; i < 3 * m->vertex_count; i++)
        m->normals[i] = -m->normals[i];
}

ag_status pbrt_loop_subdivision(pbrt_parser *parser, parameter_list *list)
{
    int64_t levels = 3;
    const char *scheme = NULL;
    size_t index_count;
    pbrt_mesh control;
    AG_TRY(parameter_get_int(list, parser->log, "levels", &levels));
    AG_TRY(parameter_get_string(list, parser->log, "scheme", &scheme)); /* pbrt-v2's; there was only one */
    if (levels < 0)
        return pbrt_refuse(parser, list, "levels", "\"levels\" should be 0 or above");
    AG_TRY(pbrt_read_mesh_arrays(parser, list, 3, &control, &index_count));
    parameter_list_warn_unused(list, parser->log);
    char error[192] = "";
    loop_mesh m;
    ag_status status = loop_subdivide(control.positions, control.vertex_count, control.indices, index_count / 3,
                                      levels > 100 ? 100 : (int)levels, error, sizeof error, &m);
    free(control.indices);
    if (status == AG_ERROR_SCENE)
        return pbrt_refuse(parser, list, "indices", "%s", error);
    if (status == AG_ERROR_ARGUMENT)
        return pbrt_refuse(parser, list, "levels", "%zu triangles subdivided %lld times are more than %zu",
                           index_count / 3, (long long)levels, LOOP_MAX_TRIANGLES);
    AG_TRY(status);
    turn_over(&m);
    pbrt_mesh fine = {.positions = m.positions,
                      .normals = m.normals,
                      .vertex_count = m.vertex_count,
                      .indices = m.indices,
                      .triangle_count = m.triangle_count};
    m.indices = NULL; /* pbrt_add_mesh's now */
    status = pbrt_add_mesh(parser, list, &fine);
    loop_mesh_reset(&m);
    return status;
}
