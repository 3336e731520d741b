/* scene_editing.h: changes of a scene that calls have put together, and that is committed.
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
 * All calls of the functions below and of those of scene_making.h take effect with the next ag_scene_commit at once;
 * until then nothing can be rendered. The scene is then, to the last bit of its pictures, one that was made afresh by
 * the calls that now hold: each thing in the place of its first call, pictures and whatever has a name first, then the
 * shapes of objects, then the rest. So materials may name textures that were made after them, and shapes can be added
 * to objects that have instances.
 *
 * Where a call fails it has no effect. What can be told of a call alone is told at once, whether the names in it are
 * there by the commit, with the number of the call. Where a commit fails, all calls since the last one that did not are
 * dropped, and the scene is as it left it: so is the camera, where it was set after another of these calls. The scene
 * then reads the borrowed arrays of the shapes as they were before: whoever changes such a shape hands over other
 * arrays, and leaves the former ones as they are until the commit has succeeded. Where numbers were written in place
 * all the same, that is noticed: until such a shape has been changed once more, or removed, and a commit has succeeded,
 * rendering and commits give AG_ERROR_ARGUMENT, and a message tells which shape it is.
 *
 * What is kept: camera and settings of a rendering change nothing in the scene. Lights, materials, textures and hints
 * keep meshes and trees of rays; pictures of textures and skies, read and filtered, are kept as long as they are named
 * and neither their pixels nor their encoding change (those of files as long as the file's size and time stay; those
 * that are not held in memory, see texture_memory_bytes, are read anew). Each object has a tree of its own, which is
 * kept until one of its shapes changes; instances are in the tree of the world. That is made anew where an instance
 * moves, or any shape changes that is part of no object: hosts put what changes often into objects. A map of photons in
 * memory is traced anew where anything but the camera has changed; one in photon_map_file is then of another scene, and
 * the picture is refused unless photon_map_refresh is set (render_settings.h). The files of meshes (plymesh) are read
 * when the shape is added or changed, and not looked at again by a commit. The library remembers what the calls said,
 * without the arrays of meshes (some 500 bytes for each call), and pixels of pictures in memory once more. find_file of
 * the scene's settings may be called by every commit: find_file_user stays valid until the scene is destroyed. */

/* Whatever was said of it is replaced. */
AG_API ag_status ag_scene_change_shape(ag_scene *scene, ag_handle handle, const ag_shape *shape);
AG_API ag_status ag_scene_change_light(ag_scene *scene, ag_handle handle, const ag_light *light);
AG_API ag_status ag_scene_change_instance(ag_scene *scene, ag_handle handle, const ag_instance *instance);
/* Of that name; a texture, of that name and kind of value. Errors also: AG_ERROR_ARGUMENT (there is none). */
AG_API ag_status ag_scene_change_material(ag_scene *scene, const char *name, const char *type,
                                          const ag_parameter *parameters, size_t parameter_count);
AG_API ag_status ag_scene_change_medium(ag_scene *scene, const char *name, const char *type,
                                        const ag_parameter *parameters, size_t parameter_count);
AG_API ag_status ag_scene_change_texture(ag_scene *scene, const ag_texture *texture);
AG_API ag_status ag_scene_change_image(ag_scene *scene, const char *name, const ag_image *image);

/* Places a light, an instance or a shape by other matrices, as in ag_light, ag_instance and ag_shape; world_from_own
 * NULL: the identity, not the matrix that it had; world_from_own_end NULL: it does not move. Not a mesh, copied or
 * borrowed, of which the library keeps no arrays in its own space: meshes of objects are moved by their instances, all
 * are by ag_scene_change_shape. Errors also: AG_ERROR_ARGUMENT (a mesh; an end for a light). */
AG_API ag_status ag_scene_move(ag_scene *scene, ag_handle handle, const double *world_from_own,
                               const double *world_from_own_end);
/* Another material for a shape, of which nothing is read anew; NULL: diffuse, grey. */
AG_API ag_status ag_scene_assign_material(ag_scene *scene, ag_handle shape, const char *material);

/* A shape, a light or an instance. An object without shapes is none: its instances have to go too. */
AG_API ag_status ag_scene_remove(ag_scene *scene, ag_handle handle);
typedef enum ag_named {
    AG_NAMED_MATERIAL,
    AG_NAMED_MEDIUM,
    AG_NAMED_FLOAT_TEXTURE,
    AG_NAMED_SPECTRUM_TEXTURE,
    AG_NAMED_IMAGE
} ag_named;
/* Errors also: AG_ERROR_ARGUMENT (there is none). */
AG_API ag_status ag_scene_remove_named(ag_scene *scene, ag_named kind, const char *name);

/* What the commits of a scene that can be changed have made, in all. This struct will not change. */
typedef struct ag_commit_counts {
    uint64_t commits;                      /* that made the scene anew; without changes there is nothing to do */
    uint64_t meshes_made;                  /* arrays of shapes that were read */
    uint64_t trees_built, trees_kept;      /* of rays: the world's, and of each object that has an instance */
    uint64_t pictures_read, pictures_kept; /* of textures and skies */
} ag_commit_counts;
/* All 0 for other scenes, and for NULL. */
AG_API ag_commit_counts ag_scene_commit_counts(const ag_scene *scene);

#ifdef __cplusplus
}
#endif
#endif
