/* pbrt_subdivision.c: Shape "loopsubdiv" of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Shapes".
 * Flow: pbrt_shapes -> [here] -> loop_subdivision -> pbrt_add_mesh. Threads: one per scene. */
#include "pbrt/pbrt_meshes.h"
#include "shape/loop_subdivision.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Turns the mesh over, indices and normals: pbrt goes round a vertex clockwise, and so has the outside where triangles
 * look clockwise. */
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

/* Appends the positions and normals of the next set to those of the sets before. */
static bool append(const loop_mesh *m, size_t set, double **in_out_positions, double **in_out_normals)
{
    const double *const from[2] = {m->positions, m->normals};
    double **const to[2] = {in_out_positions, in_out_normals};
    const size_t count = 3 * m->vertex_count;
    for (int i = 0; i < 2; i++) {
        double *larger = realloc(*to[i], ((set + 1) * count + 1) * sizeof *larger);
        if (!larger)
            return false;
        memcpy(larger + set * count, from[i], count * sizeof *larger);
        *to[i] = larger;
    }
    return true;
}

/* Subdivides each set of positions by itself: triangles alone decide which vertices there are. positions and normals of
 * *out_fine are to be freed, on failure too; indices on success. */
static ag_status subdivide(const pbrt_mesh *control, size_t triangle_count, int levels, char *error, size_t error_size,
                           pbrt_mesh *out_fine)
{
    double *positions = NULL, *normals = NULL;
    ag_status status = AG_OK;
    *out_fine = (pbrt_mesh){.motion_segments = control->motion_segments};
    for (size_t set = 0; set <= control->motion_segments && status == AG_OK; set++) {
        loop_mesh m;
        status = loop_subdivide(control->positions + 3 * set * control->vertex_count, control->vertex_count,
                                control->indices, triangle_count, levels, error, error_size, &m);
        if (status == AG_OK) {
            turn_over(&m);
            if (!append(&m, set, &positions, &normals))
                status = AG_ERROR_MEMORY;
        }
        if (set == 0) {
            out_fine->vertex_count = m.vertex_count;
            out_fine->triangle_count = m.triangle_count;
            out_fine->indices = m.indices;
            m.indices = NULL;
        }
        loop_mesh_reset(&m);
    }
    out_fine->positions = positions;
    out_fine->normals = normals;
    if (status != AG_OK) {
        free(out_fine->indices);
        out_fine->indices = NULL;
    }
    return status;
}

/* Returns whether all sets together have no more triangles than the finest mesh may have. */
static bool is_in_reach(size_t triangle_count, int64_t levels, uint32_t motion_segments)
{
    size_t most = LOOP_MAX_TRIANGLES / (motion_segments + 1);
    for (int64_t i = 0; i < levels && most > 0; i++)
        most /= 4;
    return motion_segments == 0 || triangle_count <= most; /* of one set loop_subdivide tells */
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
    if (!is_in_reach(index_count / 3, levels, control.motion_segments)) {
        free(control.indices);
        return pbrt_refuse(parser, list, "levels",
                           "%zu triangles subdivided %lld times, in each of %u motion steps, are more than %zu",
                           index_count / 3, (long long)levels, control.motion_segments + 1, LOOP_MAX_TRIANGLES);
    }
    char error[192] = "";
    pbrt_mesh fine;
    ag_status status =
        subdivide(&control, index_count / 3, levels > 100 ? 100 : (int)levels, error, sizeof error, &fine);
    free(control.indices);
    if (status == AG_ERROR_SCENE)
        return pbrt_refuse(parser, list, "indices", "%s", error);
    if (status == AG_ERROR_ARGUMENT)
        return pbrt_refuse(parser, list, "levels", "%zu triangles subdivided %lld times are more than %zu",
                           index_count / 3, (long long)levels, LOOP_MAX_TRIANGLES);
    if (status == AG_OK)
        status = pbrt_add_mesh(parser, list, &fine); /* which takes the indices */
    free((double *)(uintptr_t)fine.positions);
    free((double *)(uintptr_t)fine.normals);
    return status;
}
