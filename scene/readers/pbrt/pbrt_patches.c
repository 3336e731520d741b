/* pbrt_patches.c: Shape "bilinearmesh" of a pbrt-v4 scene, as triangles.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6.6: the corners of a patch are
 * p00, p10, p01, p11, and its outside is where dp/du x dp/dv points.
 * Flow: pbrt_shapes -> [here] -> pbrt_add_mesh. Threads: one per scene. */
#include "pbrt/pbrt_meshes.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_STEPS = 32, MAX_GRID_VERTICES = 1 << 28 };

static const double FLAT = 1e-6;      /* relative to the longest edge: what the digits of a file lose */
static const double DEVIATION = 1e-4; /* of the triangles from the patch, relative to the longest edge */

typedef struct patch {
    const double *p[4]; /* p00, p10, p01, p11 */
    double longest;     /* edge */
    double twist;       /* |p00 - p10 - p01 + p11|: 0 makes it a parallelogram */
} patch;

static void subtract(const double *a, const double *b, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static patch make_patch(const pbrt_mesh *source, size_t index)
{
    static const int EDGES[4][2] = {{0, 1}, {1, 3}, {3, 2}, {2, 0}};
    patch q = {.longest = 0.0};
    double d[3];
    for (int i = 0; i < 4; i++)
        q.p[i] = source->positions + 3 * (size_t)source->indices[4 * index + (size_t)i];
    for (int i = 0; i < 4; i++) {
        subtract(q.p[EDGES[i][0]], q.p[EDGES[i][1]], d);
        q.longest = double_max(q.longest, sqrt(dot(d, d)));
    }
    for (int i = 0; i < 3; i++)
        d[i] = (q.p[0][i] - q.p[1][i]) - (q.p[2][i] - q.p[3][i]);
    q.twist = sqrt(dot(d, d));
    return q;
}

/* Returns whether a patch is a convex quadrilateral in a plane: the normals at its corners agree, where they have a
 * length. */
static bool is_planar_convex(const patch *q)
{
    static const int AROUND[4] = {0, 1, 3, 2};
    double normals[4][3], sum[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < 4; i++) {
        double to_next[3], to_last[3];
        subtract(q->p[AROUND[(i + 1) % 4]], q->p[AROUND[i]], to_next);
        subtract(q->p[AROUND[(i + 3) % 4]], q->p[AROUND[i]], to_last);
        cross(to_next, to_last, normals[i]);
        for (int j = 0; j < 3; j++)
            sum[j] += normals[i][j];
    }
    double length = sqrt(dot(sum, sum)), tolerance = FLAT * q->longest * q->longest;
    if (!(length > tolerance))
        return false;
    for (int i = 0; i < 4; i++) {
        double along = dot(normals[i], sum) / length;
        if (along < -tolerance || dot(normals[i], normals[i]) - along * along > tolerance * tolerance)
            return false;
    }
    return true;
}

static bool has_one_normal(const pbrt_mesh *source, size_t index)
{
    const uint32_t *corner = source->indices + 4 * index;
    for (int i = 1; source->normals && i < 4; i++)
        if (memcmp(source->normals + 3 * (size_t)corner[i], source->normals + 3 * (size_t)corner[0],
                   3 * sizeof(double)))
            return false;
    return true;
}

/* Returns whether two triangles can stand for the patch. Those of a quadrilateral that is no parallelogram interpolate
 * otherwise. */
static bool is_flat(const pbrt_mesh *source, size_t index, const patch *q)
{
    if (q->twist <= FLAT * q->longest)
        return true;
    return is_planar_convex(q) && !source->uvs && has_one_normal(source, index);
}

/* Returns how finely all patches are cut, 1 when every one is flat. All are cut alike, so that neighbours share their
 * edges' points. */
static size_t count_steps(const pbrt_mesh *source, size_t patch_count)
{
    double steps = 1.0;
    for (size_t i = 0; i < patch_count; i++) {
        patch q = make_patch(source, i);
        if (!is_flat(source, i, &q))
            steps = double_max(steps, double_max(ceil(sqrt(q.twist / (4.0 * DEVIATION * q.longest))), 2.0));
    }
    steps = double_min(steps, MAX_STEPS);
    while (steps > 2.0 && (steps + 1.0) * (steps + 1.0) * (double)patch_count > MAX_GRID_VERTICES)
        steps -= 1.0;
    return (size_t)steps;
}

/* Makes two triangles per patch between the vertices there are. */
static ag_status split_flat(pbrt_mesh *m, size_t patch_count)
{
    static const int CORNERS[6] = {0, 1, 3, 0, 3, 2};
    uint32_t *indices = malloc(6 * patch_count * sizeof *indices + 1);
    if (indices)
        for (size_t i = 0; i < patch_count; i++)
            for (int c = 0; c < 6; c++)
                indices[6 * i + (size_t)c] = m->indices[4 * i + (size_t)CORNERS[c]];
    free(m->indices);
    m->indices = indices;
    m->triangle_count = 2 * patch_count;
    return indices ? AG_OK : AG_ERROR_MEMORY;
}

/* Returns one value at (u, v) between its four corners. Weights that are 0 add exactly nothing, and addition commutes,
 * so a shared edge gets the same points from both its patches. */
static double interpolate(const double *values, size_t width, size_t component, const uint32_t *corner, size_t i,
                          size_t j, size_t steps)
{
    double n = (double)steps, u = (double)i / n, v = (double)j / n, u1 = (double)(steps - i) / n,
           v1 = (double)(steps - j) / n;
    double a = values[width * corner[0] + component], b = values[width * corner[1] + component];
    double c = values[width * corner[2] + component], d = values[width * corner[3] + component];
    if (i == 0 || i == steps)
        return v1 * (i == 0 ? a : b) + v * (i == 0 ? c : d);
    return v1 * (u1 * a + u * b) + v * (u1 * c + u * d);
}

/* Makes a grid of steps x steps cells over each patch; positions, normals and uvs of grid become its own. */
static ag_status cut_into_grids(const pbrt_mesh *source, size_t patch_count, size_t steps, pbrt_mesh *out_grid,
                                double *out_arrays[3])
{
    static const size_t WIDTHS[3] = {3, 3, 2};
    const double *const inputs[3] = {source->positions, source->normals, source->uvs};
    size_t side = steps + 1, vertices = side * side;
    out_grid->indices = malloc(6 * steps * steps * patch_count * sizeof *out_grid->indices);
    if (!out_grid->indices)
        return AG_ERROR_MEMORY;
    for (int a = 0; a < 3; a++) {
        if (!inputs[a])
            continue;
        out_arrays[a] = malloc(vertices * patch_count * WIDTHS[a] * sizeof(double));
        if (!out_arrays[a])
            return AG_ERROR_MEMORY;
        double *out = out_arrays[a];
        for (size_t q = 0; q < patch_count; q++)
            for (size_t j = 0; j < side; j++)
                for (size_t i = 0; i < side; i++)
                    for (size_t c = 0; c < WIDTHS[a]; c++)
                        *out++ = interpolate(inputs[a], WIDTHS[a], c, source->indices + 4 * q, i, j, steps);
    }
    uint32_t *index = out_grid->indices;
    for (size_t q = 0; q < patch_count; q++)
        for (size_t j = 0; j < steps; j++)
            for (size_t i = 0; i < steps; i++) {
                uint32_t p00 = (uint32_t)(q * vertices + j * side + i), p10 = p00 + 1;
                uint32_t p01 = p00 + (uint32_t)side, p11 = p01 + 1;
                const uint32_t cell[6] = {p00, p10, p11, p00, p11, p01};
                memcpy(index, cell, sizeof cell);
                index += 6;
            }
    out_grid->positions = out_arrays[0];
    out_grid->normals = out_arrays[1];
    out_grid->uvs = out_arrays[2];
    out_grid->vertex_count = vertices * patch_count;
    out_grid->triangle_count = 2 * steps * steps * patch_count;
    out_grid->expects_degenerate = source->expects_degenerate;
    return AG_OK;
}

/* Returns the values of the patches' corners, each patch with corners of its own; NULL when out of memory. */
static double *unshare(const double *values, size_t width, const uint32_t *indices, size_t corner_count)
{
    double *own = malloc(corner_count * width * sizeof *own + 1);
    for (size_t i = 0; own && i < corner_count; i++)
        memcpy(own + width * i, values + width * indices[i], width * sizeof *own);
    return own;
}

/* Gives uvs to patches where the file has none: (0, 0), (1, 0), (0, 1), (1, 1) on every one. out_arrays: to be freed,
 * on failure too. */
static ag_status give_uvs(pbrt_mesh *m, size_t patch_count, double *out_arrays[3])
{
    static const double UVS[8] = {0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0};
    if (m->uvs)
        return AG_OK;
    out_arrays[0] = unshare(m->positions, 3, m->indices, 4 * patch_count);
    out_arrays[1] = m->normals ? unshare(m->normals, 3, m->indices, 4 * patch_count) : NULL;
    out_arrays[2] = malloc(patch_count * sizeof UVS + 1);
    if (!out_arrays[0] || (m->normals && !out_arrays[1]) || !out_arrays[2])
        return AG_ERROR_MEMORY;
    for (size_t i = 0; i < patch_count; i++) {
        memcpy(out_arrays[2] + 8 * i, UVS, sizeof UVS);
        for (size_t c = 4 * i; c < 4 * i + 4; c++)
            m->indices[c] = (uint32_t)c;
    }
    m->positions = out_arrays[0];
    m->normals = out_arrays[1];
    m->uvs = out_arrays[2];
    m->vertex_count = 4 * patch_count;
    return AG_OK;
}

/* Adds the patches, steps x steps cells of each; source->indices are freed or the scene's afterwards. */
static ag_status add_patches(pbrt_parser *parser, parameter_list *list, pbrt_mesh *source, size_t patch_count,
                             size_t steps)
{
    if (steps == 1) {
        AG_TRY(split_flat(source, patch_count));
        return pbrt_add_mesh(parser, list, source);
    }
    log_at(parser->log, AG_LOG_INFO, list->where,
           "Shape \"bilinearmesh\": %zu curved patch%s cut into %zu x %zu cells each", patch_count,
           patch_count == 1 ? " is" : "es are", steps, steps);
    pbrt_mesh grid;
    double *arrays[3] = {NULL, NULL, NULL};
    memset(&grid, 0, sizeof grid);
    ag_status status = cut_into_grids(source, patch_count, steps, &grid, arrays);
    if (status != AG_OK)
        free(grid.indices);
    else
        status = pbrt_add_mesh(parser, list, &grid);
    for (int i = 0; i < 3; i++)
        free(arrays[i]);
    free(source->indices);
    return status;
}

ag_status pbrt_bilinear_mesh(pbrt_parser *parser, parameter_list *list)
{
    pbrt_mesh source;
    size_t index_count;
    double *arrays[3] = {NULL, NULL, NULL};
    AG_TRY(pbrt_read_mesh_arrays(parser, list, 4, &source, &index_count));
    parameter_list_warn_unused(list, parser->log);
    source.expects_degenerate = true; /* a patch may well have two corners at one point */
    size_t patch_count = index_count / 4, steps = count_steps(&source, patch_count);
    ag_status status = give_uvs(&source, patch_count, arrays);
    if (status != AG_OK)
        free(source.indices);
    else
        status = add_patches(parser, list, &source, patch_count, steps);
    for (int i = 0; i < 3; i++)
        free(arrays[i]);
    return status;
}
