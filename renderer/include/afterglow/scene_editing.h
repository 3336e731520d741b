/* scene_editing.h: changes to a committed scene that was built by calls.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_SCENE_EDITING_H
#define AFTERGLOW_PUBLIC_SCENE_EDITING_H

#include "afterglow/scene_making.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A scene of ag_scene_create whose settings say is_editable can be changed once it is committed, as long as no
 * rendering borrows it:
 *
 *     ag_scene_commit -> ag_render -> ag_scene_change_..., ag_scene_add_..., ag_scene_remove -> ag_scene_commit -> ...
 *
 * Calls of the functions below and of those of scene_making.h take effect together at the next ag_scene_commit; until
 * then nothing can be rendered. The pictures then have the bits of a scene that was built anew by the calls in effect,
 * each object in the order of its first call: images and everything with a name first, then the shapes of objects, then
 * the rest. Materials may therefore refer to textures that were added later, and shapes can be added to objects that
 * have instances.
 *
 * A call that fails has no effect. A call's own errors are reported at once; whether the names in it exist is reported
 * by the commit, with the number of the call. A commit that fails drops all calls since the last successful commit, and
 * leaves the scene, with its camera, as that one left it. The scene then uses the borrowed arrays that the shapes had
 * before: a host that changes such a shape passes other arrays, and keeps the former ones unchanged until the commit
 * has succeeded. If they were overwritten nevertheless, rendering and commits fail with AG_ERROR_ARGUMENT and a message
 * that names the shape, until it has been changed again or removed and a commit has succeeded.
 *
 * A commit rebuilds only what changed. Changes of camera, lights, materials, textures and hints keep meshes and
 * acceleration structures. Images of textures and skies are kept while they are referred to and neither pixels nor
 * encoding change (images of files: while the file's size and modification time stay; those beyond texture_memory_bytes
 * are read again). Each object has an acceleration structure of its own, which is kept until one of its shapes changes;
 * that of the world holds the instances and the shapes outside of objects, and is rebuilt when any of these changes:
 * hosts should put shapes that change often into objects. Photons are traced anew after any change but the camera's; a
 * photon_map_file is then of another scene, and is refused unless photon_map_refresh is set (render_settings.h). Files
 * of meshes (plymesh) are read when the shape is added or changed, and not by later commits. The library keeps the
 * arguments of calls without the arrays of meshes, some 500 bytes for each call, and a second copy of the pixels of
 * images in memory. Each commit may call find_file of the scene's settings: find_file_user stays valid until the scene
 * is destroyed. */

/* Replace a shape, light or instance as a whole. Errors: those of scene_making.h; AG_ERROR_ARGUMENT (there is no such
 * handle). */
AG_API ag_status ag_scene_change_shape(ag_scene *scene, ag_handle handle, const ag_shape *shape);
AG_API ag_status ag_scene_change_light(ag_scene *scene, ag_handle handle, const ag_light *light);
AG_API ag_status ag_scene_change_instance(ag_scene *scene, ag_handle handle, const ag_instance *instance);
/* Replace the material, medium or image of a name, or the texture of a name and kind of value. Errors: those of
 * scene_making.h; AG_ERROR_ARGUMENT (there is none of that name). */
AG_API ag_status ag_scene_change_material(ag_scene *scene, const char *name, const char *type,
                                          const ag_parameter *parameters, size_t parameter_count);
AG_API ag_status ag_scene_change_medium(ag_scene *scene, const char *name, const char *type,
                                        const ag_parameter *parameters, size_t parameter_count);
AG_API ag_status ag_scene_change_texture(ag_scene *scene, const ag_texture *texture);
AG_API ag_status ag_scene_change_image(ag_scene *scene, const char *name, const ag_image *image);

/* Replaces the matrices of a light, an instance or a shape, as in ag_light, ag_instance and ag_shape. world_from_own
 * NULL: the identity, not its former matrix; world_from_own_end NULL: it does not move. world_from_own_end is one
 * matrix: for more, use ag_scene_change_instance. Meshes cannot be moved, since the library does not keep their arrays
 * in their own space: use their object's instances, or ag_scene_change_shape. Errors: those of scene_making.h;
 * AG_ERROR_ARGUMENT (the handle is a mesh's; a light has an end). */
AG_API ag_status ag_scene_move(ag_scene *scene, ag_handle handle, const double *world_from_own,
                               const double *world_from_own_end);
/* Replaces the material of a shape and keeps its arrays; NULL: diffuse, grey. */
AG_API ag_status ag_scene_assign_material(ag_scene *scene, ag_handle shape, const char *material);

/* Removes a shape, a light or an instance. The instances of an object must be removed with its last shape, else the
 * commit fails. */
AG_API ag_status ag_scene_remove(ag_scene *scene, ag_handle handle);
typedef enum ag_named {
    AG_NAMED_MATERIAL,
    AG_NAMED_MEDIUM,
    AG_NAMED_FLOAT_TEXTURE,
    AG_NAMED_SPECTRUM_TEXTURE,
    AG_NAMED_IMAGE
} ag_named;
/* Removes the object of a kind and name. Errors: those of scene_making.h; AG_ERROR_ARGUMENT (there is none). */
AG_API ag_status ag_scene_remove_named(ag_scene *scene, ag_named kind, const char *name);

/* Counts of the work of all commits of an editable scene. This struct will not change. */
typedef struct ag_commit_counts {
    uint64_t commits;                 /* commits with changes */
    uint64_t meshes_made;             /* shapes whose arrays were read */
    uint64_t trees_built, trees_kept; /* acceleration structures: the world's, and one of each object with instances */
    uint64_t pictures_read, pictures_kept; /* images of textures and skies */
} ag_commit_counts;
/* Returns the counts of a scene; all 0 for a scene that is not editable, and for NULL. */
AG_API ag_commit_counts ag_scene_commit_counts(const ag_scene *scene);

#ifdef __cplusplus
}
#endif
#endif
