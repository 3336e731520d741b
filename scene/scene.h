/* scene.h: the scene, which owns shapes, materials, lights, camera, and the file's hints for the renderer. Built
 * piece by piece (scene_add_…), then committed; read-only from then on.
 * Flow: scene file -> [here] -> bvh_embree -> photon map, renderer.
 * Threads: one builds; any number read once committed. */
#ifndef AFTERGLOW_SCENE_H
#define AFTERGLOW_SCENE_H

#include "camera.h"
#include "color/working_space.h"
#include "light/light.h"
#include "material/material.h"
#include "medium/medium.h"
#include "run_context.h"
#include "scene_hints.h"
#include "scene_names.h"
#include "scene_request.h"
#include "shape/instance.h"
#include "shape/shape.h"
#include "text/definitions.h"
#include "texture/texture_set.h"

struct bvh;
struct slab_faces;
struct light_tree;

enum { SCENE_LIGHT_GROUPS_MAX = 32 };

/* Counts of what a commit has made, and what it has kept of the scene before; textures count their own pictures. */
typedef struct scene_reuse {
    uint64_t trees_built, trees_kept; /* of the world and of objects */
    uint64_t light_pictures_read, light_pictures_kept;
} scene_reuse;

typedef struct scene {
    working_space space;            /* of all its colours; settled before anything is read */
    const definitions *definitions; /* of names in its text; borrowed while it is read; NULL: none */
    const scene_request *request;   /* borrowed while it is read; NULL: nothing is asked for; see scene_set_request */
    /* The scene that this one replaces after edits: its pictures, tables and trees are shared where they would be the
     * same. Borrowed until the commit is done; or NULL; see scene_set_before. */
    struct scene *before;
    scene_reuse reuse;
    material *materials;
    uint32_t material_count;
    struct material_table **material_tables; /* that materials keep beside their values (material/material_table.h) */
    uint32_t material_table_count;
    texture_set textures; /* textures.colors.config is borrowed while the scene is read */
    shape *shapes;
    uint32_t shape_count;
    scene_object *objects; /* what their shapes are is told by the shapes */
    uint32_t object_count;
    scene_instance *instances;
    uint32_t instance_count;
    affine *instance_steps; /* of all instances, see scene_instance */
    uint32_t instance_step_count;
    light *lights;
    uint32_t light_count;
    scene_names names;
    char **light_group_names; /* of light.group; the first is "default", of lights that name none */
    uint32_t light_group_count;
    medium *media;
    uint32_t medium_count;
    uint32_t camera_medium; /* that the eye is in, SCENE_NO_MEDIUM: none */
    camera camera;
    bool has_camera;
    bool is_camera_made_up, is_light_made_up; /* by import_defaults: see closed_room.h */
    frame world_from_upright;                 /* then: of a world whose y is up; axes all */
    char *camera_names; /* of the file's cameras, for a message: quoted, with commas; NULL: none has one */

    scene_hints hints; /* what its file says of the picture */

    char *defined;     /* which definitions its text has used, see definitions_describe; NULL: it was given none */
    char **file_names; /* interned, for file_location.file */
    uint32_t file_name_count;

    /* set by scene_commit */
    uint32_t *object_shapes;     /* indices of the shapes that belong to objects, object by object */
    bool has_deforming;          /* meshes or curves whose points move while the shutter is open */
    bool has_motion;             /* they, instances or the camera move then: what happens depends on the time */
    vec3 bounds_min, bounds_max; /* of all shapes, where instances put them; min > max when there is none */
    vec3 bounding_center;
    float bounding_radius;
    vec3 detail_center;  /* of a ball around all but a few giants */
    float detail_radius; /* 0: there are no such */
    float surface_area;  /* m^2, of all shapes where photons may lie: but interfaces and curves, in all instances */
    rgb light_power;     /* W, of all lights */
    uint32_t *infinite_lights; /* [infinite_light_count], indices of those that light_is_sky */
    uint32_t infinite_light_count;
    bool filters_textures;     /* any of them: see material_mips.h */
    bool has_scattering_media; /* eye, lamps or shapes are in media that scatter: see transmittance_travel */
    bool has_interfaces;       /* any shape that rays may pass unbent: see transmittance.h */
    bool has_glued_faces;      /* any shape that is_glued: see glued_faces.h */
    bool has_panes;            /* any shape that lets light straight through: see pane.h, slab_faces.h */
    /* Data for picking lights: see light_pick.c. */
    uint32_t lit_count;          /* lights with power */
    uint32_t only_light;         /* where there is but one of them, that one */
    uint32_t *everywhere_lights; /* [everywhere_count], indices of those with power that light_is_everywhere */
    uint32_t everywhere_count;
    struct light_tree *light_tree; /* over the others with power; NULL where there is none */
    float *photon_cdf;             /* [light_count], running sum of photon_probability */
    float *photon_probability;     /* [light_count], with which scene_pick_light_by_power picks it */
    struct bvh *bvh;
    struct slab_faces *slab_faces; /* which shapes are slabs of glass that light may pass straight; NULL: none */
} scene;

scene *scene_create(void);    /* NULL when out of memory */
void scene_destroy(scene *s); /* NULL is fine */

/* Sets what is asked of the scene beyond what its file says, and which scene it replaces; NULL: nothing, none. */
void scene_set_request(scene *s, const scene_request *request);
void scene_set_before(scene *s, scene *before);

/* Returns the interned copy of a file name; NULL when out of memory. */
const char *scene_intern_file_name(scene *s, const char *name);

/* Each adds a copy of *item and writes its index. The scene takes over a mesh's arrays, on failure too, when they are
 * freed. Errors: AG_ERROR_MEMORY. */
ag_status scene_add_material(scene *s, const material *item, uint32_t *out_index);
/* Finds the light group of a name, or adds it; "default" must be the first. Errors: AG_ERROR_MEMORY, AG_ERROR_SCENE
 * (more than SCENE_LIGHT_GROUPS_MAX; nothing is logged). */
ag_status scene_light_group(scene *s, const char *name, uint32_t *out_index);
/* The scene takes over what the medium owns, on failure too, when it is freed. */
ag_status scene_add_medium(scene *s, const medium *item, uint32_t *out_index);
ag_status scene_add_shape(scene *s, const shape *item, uint32_t *out_index);
/* Adds curves; they are joined with the shape before where they differ in nothing but their segments, since fur has
 * many. */
ag_status scene_add_curves(scene *s, uint32_t object_index, const shape *item);
/* Adds an object, which is visible by its instances. Its shapes emit no light. */
ag_status scene_add_object(scene *s, uint32_t *out_index);
ag_status scene_add_object_shape(scene *s, uint32_t object_index, const shape *item, uint32_t *out_index);
/* Adds an instance of an object added before, to which shapes may still be added; steps: see scene_instance, 1 at rest,
 * at most MOTION_STEPS_MAX. Errors: AG_ERROR_MEMORY, AG_ERROR_SCENE (a matrix is singular; nothing is logged). */
ag_status scene_add_instance(scene *s, uint32_t object_index, const affine *steps, uint32_t step_count,
                             uint32_t *out_index);
/* Adds a light. The shape of an area light must have been added before, outside of objects; its light_index is set
 * here. The scene takes over a light's pictures and tables, on failure too, when they are destroyed. */
ag_status scene_add_light(scene *s, const light *item, uint32_t *out_index);

/* Drops the lights of which is_dropped returns true, or all of them where it is NULL; their shapes stay, without
 * emission. To be called before the commit. */
void scene_drop_lights(scene *s, bool (*is_dropped)(const light *l));

/* Completes the scene: areas, powers, bounds and the BVH, on the run's threads alone. isa: Embree's name of the widest
 * instruction set to use ("sse2", "sse4.2", "avx", "avx2", "avx512"), NULL for "avx2". A scene without shapes is valid.
 * Errors: AG_ERROR_MEMORY, AG_ERROR_RAY_TRACING, AG_ERROR_SCENE, AG_CANCELLED. */
ag_status scene_commit(scene *s, run_context *run, const char *isa);
/* Undoes, after a failure with s->before, what scene_commit has changed in that scene. NULL is fine. */
void scene_restore_before(const scene *s);

/* Checks that rays of the camera, NULL for none, stay where they can be traced in the space of each instance;
 * scene_commit does so for the scene's. Errors: AG_ERROR_SCENE, told. */
ag_status scene_check_camera(const scene *s, const camera *c, log_sink *log);

/* Replaces the camera of a committed scene, which must not be rendered meanwhile, by one that scene_check_camera
 * has let pass; nothing else depends on the camera. */
void scene_set_camera(scene *s, const camera *c);

/* Returns whether any light that meets the shape is traced on, rather than gathered: see bsdf.h. */
bool scene_shape_is_traced(const scene *s, const shape *item);

/* Picks, for shading, one of the lights that may light a point, about in proportion to its light there, by u in [0, 1).
 * normal: unit, of a surface that scatters only light from its own side; zero: light from all sides. Returns the
 * light's index and writes its probability; 0 where no light reaches the point, and the index is undefined. The scene
 * must have a light with power. */
uint32_t scene_pick_light(const scene *s, vec3 point, vec3 normal, float u, float *out_probability);
/* Returns the probability with which scene_pick_light picks a light there. */
float scene_light_probability(const scene *s, uint32_t light_index, vec3 point, vec3 normal);

/* Picks, for photons, a light by its power, but none so rarely that its light would be a few bright specks; multiplied
 * by its `photons`. Probability 0: no light emits photons. */
uint32_t scene_pick_light_by_power(const scene *s, float u, float *out_probability);
bool scene_sends_photons(const scene *s);

#endif
