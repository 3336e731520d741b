/* importer.h: a scene as it is filled from a file of a foreign format: surfaces, then meshes, then what is missing.
 * Flow: import_scene, obj_file, ply_scene -> [here: importer.c, import_material.c, import_view.c] -> scene.
 * Threads: one per scene. */
#ifndef AFTERGLOW_IMPORTER_H
#define AFTERGLOW_IMPORTER_H

#include "model/import_model.h"
#include "scene.h"

/* Coordinates in world space are at most this, as in pbrt files. */
#define IMPORT_MAX_COORDINATE 1e18f

/* A picture within the file. */
typedef struct import_embedded {
    const unsigned char *bytes; /* borrowed */
    size_t size;                /* 0: it cannot be read */
} import_embedded;

typedef struct importer {
    run_context *run;
    log_sink *log;
    scene *scene;
    file_location where;             /* the file; no line */
    const import_embedded *embedded; /* [embedded_count], borrowed */
    size_t embedded_count;
    float bump_unit; /* height of a bump map's white, scene units */
    /* counts of what was left out, for importer_finish */
    size_t triangle_count, degenerate_count, left_out_count, odd_vector_count;
} importer;

/* Errors: AG_ERROR_MEMORY. */
ag_status importer_init(importer *i, run_context *run, const char *path, scene *out_scene);

/* Returns bump_unit from the bounds of the whole model: MTL gives no unit, and white is 0.002 of the diagonal high. */
float importer_bump_unit(vec3 bounds_min, vec3 bounds_max);

/* A mesh's material and other properties of its surface. */
typedef struct import_surface {
    uint32_t material_index;
    float alpha;
    uint32_t alpha_texture;
    rgb radiance; /* black: no lamp */
    uint32_t radiance_texture;
} import_surface;

/* Adds a material; import_material.c has the table of what becomes what. Pictures that cannot be read are named in a
 * warning. Errors: AG_ERROR_MEMORY. */
ag_status importer_add_material(importer *i, const import_material *m, import_surface *out_surface);

/* Adds a mesh, transformed to world space, which also is a lamp where its surface shines. Its arrays pass into the
 * scene's ownership, on failure too (they are then freed). Checks all: indices, coordinates; triangles without area are
 * left out. name is for messages. Errors: AG_ERROR_INPUT, AG_ERROR_MEMORY. */
ag_status importer_add_mesh(importer *i, const char *name, mesh *m, const transform *world_from_mesh,
                            const import_surface *surface);

/* Adds a camera: the requested one by name counts, else the first. Values that are not valid are left out with a
 * warning. Lights need shapes to be added before. Errors: AG_ERROR_MEMORY. */
ag_status importer_add_camera(importer *i, const import_camera *source);
ag_status importer_add_light(importer *i, const import_light *source);

/* Warns of what was left out, and adds a camera and light where there are none. Errors: AG_ERROR_INPUT (nothing to
 * see), AG_ERROR_MEMORY. */
ag_status importer_finish(importer *i);

/* Logs "FILE: error: ..." and returns AG_ERROR_INPUT. */
ag_status importer_refuse(importer *i, const char *format, ...) AG_PRINTF(2, 3);

#endif
