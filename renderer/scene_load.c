/* scene_load.c: the scenes of the public interface: loading one from a file, destroying it. With scene_memory.c and
 * scene_parameters.c the only file above scene/ that sees the readers.
 * Flow: scene_file -> [here] -> render. Threads: as in afterglow.h. */
#include "scene_load.h"

#include "floating_point.h"
#include "rays/bvh.h"
#include "scene_file.h"
#include "status.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Copies them for the reader, which notes there what it uses; strings stay the caller's. */
static ag_status copy_definitions(ag_context *context, const ag_definition *given, size_t count,
                                  definitions *out_definitions)
{
    for (size_t i = 0; i < count; i++) {
        const char *wrong = !definition_name_is_valid(given[i].name) ? "is no name" : NULL;
        for (size_t k = 0; k < i && !wrong; k++)
            wrong = strcmp(given[k].name, given[i].name) == 0 ? "is defined twice" : NULL;
        if (wrong) {
            log_message(context->log, AG_LOG_ERROR, "'%s' %s", given[i].name, wrong);
            return AG_ERROR_ARGUMENT;
        }
    }
    *out_definitions = (definitions){.items = calloc(count + 1, sizeof *out_definitions->items), .count = count};
    for (size_t i = 0; out_definitions->items && i < count; i++)
        out_definitions->items[i] = (definition){given[i].name, given[i].value, given[i].is_optional, false};
    return out_definitions->items ? AG_OK : AG_ERROR_MEMORY;
}

static vec3 vec3_of(const float v[3]) { return vec3_make(v[0], v[1], v[2]); }

static bool is_in(float value, float least, float most) { return value >= least && value <= most; } /* no NaN is */

static const char *find_wrong_sun(const ag_scene_settings *s)
{
    if (!isfinite(s->sun_azimuth_degrees))
        return "sun_azimuth_degrees should be finite";
    if (!is_in(s->sun_elevation_degrees, -90.0f, 90.0f))
        return "sun_elevation_degrees should be from -90 to 90";
    if (!is_in(s->sun_irradiance, 0.0f, FLT_MAX))
        return "sun_irradiance should be finite, and not negative";
    return is_in(s->sun_angle_degrees, 0.0f, 180.0f) ? NULL : "sun_angle_degrees should be from 0 to 180";
}

static const char *find_wrong_sky(const ag_scene_settings *s)
{
    for (int i = 0; i < 3; i++)
        if (!is_in(s->sky_radiance[i], 0.0f, FLT_MAX))
            return "sky_radiance should be finite, and not negative";
    return isfinite(s->sky_rotation_degrees) ? NULL : "sky_rotation_degrees should be finite";
}

/* NULL: nothing is wrong. */
static const char *find_wrong_setting(const ag_scene_settings *s)
{
    if ((unsigned)s->gltf_light_units > AG_GLTF_LIGHT_UNITS_RAW)
        return "gltf_light_units is none that there is";
    if ((unsigned)s->up > AG_UP_MINUS_Z)
        return "up is no axis that there is";
    if (s->texture_memory_bytes > 0 && s->texture_memory_bytes < AG_TEXTURE_MEMORY_LEAST_BYTES)
        return "texture_memory_bytes should be 0, or at least AG_TEXTURE_MEMORY_LEAST_BYTES";
    if (s->texture_cache && s->texture_cache[0] == '\0')
        return "texture_cache should be a folder, or NULL";
    if (s->has_camera && s->camera_name)
        return "has_camera and camera_name exclude each other";
    const char *wrong = s->has_sun ? find_wrong_sun(s) : NULL;
    return !wrong && s->has_sky ? find_wrong_sky(s) : wrong;
}

ag_status scene_settings_refuse(ag_context *context, const char *what)
{
    log_message(context->log, AG_LOG_ERROR, "the settings of the scene: %s", what);
    return AG_ERROR_ARGUMENT;
}

ag_status scene_request_make(ag_context *context, const ag_scene_settings *settings, scene_request *out_request)
{
    AG_TRY(context_check_struct(context, "ag_scene_settings", settings->struct_size, sizeof *settings));
    const float *sky = settings->sky_radiance;
    const char *wrong = find_wrong_setting(settings);
    if (wrong)
        return scene_settings_refuse(context, wrong);
    *out_request = (scene_request){.gltf_light_units = (gltf_light_units)settings->gltf_light_units,
                                   .has_camera = settings->has_camera,
                                   .camera_from = vec3_of(settings->camera_from),
                                   .camera_to = vec3_of(settings->camera_to),
                                   .camera_up = vec3_of(settings->camera_up),
                                   .fov_degrees = settings->camera_fov_degrees,
                                   .camera_name = settings->camera_name,
                                   .drops_lights = settings->drops_lights,
                                   .texture_memory_bytes = settings->texture_memory_bytes,
                                   .texture_cache = settings->texture_cache,
                                   .texture_cache_bytes = settings->texture_cache_bytes,
                                   .up = (scene_up)settings->up,
                                   .has_sun = settings->has_sun,
                                   .sun_azimuth_degrees = settings->sun_azimuth_degrees,
                                   .sun_elevation_degrees = settings->sun_elevation_degrees,
                                   .sun_irradiance = settings->sun_irradiance,
                                   .sun_angle_degrees = settings->sun_angle_degrees,
                                   .has_sky = settings->has_sky,
                                   .sky_radiance = rgb_make(sky[0], sky[1], sky[2]),
                                   .sky_file = settings->sky_file,
                                   .sky_rotation_degrees = settings->sky_rotation_degrees,
                                   .find_file = settings->find_file,
                                   .find_file_user = settings->find_file_user};
    return AG_OK;
}

/* A scene is read from a file, or from text of that name. */
typedef struct scene_source {
    const char *name;
    const char *text; /* NULL: it is in the file */
    size_t size_bytes;
} scene_source;

ag_status scene_prepare(ag_context *context, const char *name, const scene_request *request, scene *s,
                        input_files *inputs)
{
    const color_config *colors;
    AG_TRY(context_color_config(context, &colors));
    s->space = context->working_space;
    s->textures.colors.config = colors;
    scene_set_request(s, request);
    const char *wrong;
    if (!context->is_confined || input_files_confine(inputs, name, (const char *const *)(void *)context->confined_to,
                                                     context->confined_count, &wrong))
        return AG_OK;
    if (!wrong)
        return AG_ERROR_MEMORY;
    log_message(context->log, AG_LOG_ERROR, "'%s': scenes cannot be confined to it: there is no such folder", wrong);
    return AG_ERROR_ARGUMENT;
}

ag_status scene_complete(ag_context *context, scene *s)
{
    const phase_begin begin = context_begin_phase();
    s->definitions = NULL; /* both were borrowed */
    scene_set_request(s, NULL);
    AG_TRY(scene_commit(s, &context->run, context->isa));
    context_end_phase(context, AG_PHASE_BVH, begin);
    context_count_textures(context, s);
    log_message(context->log, AG_LOG_INFO, "shapes: %u; lights: %u; materials: %u; BVH: %.1f MB (%s)", s->shape_count,
                s->light_count, s->material_count, (double)bvh_memory_bytes(s->bvh) / 1e6, bvh_isa(s->bvh));
    return AG_OK;
}

/* Reads and completes it. */
static ag_status load(ag_context *context, const scene_source *from, const definitions *d, const scene_request *request,
                      scene *s, input_files *inputs)
{
    const phase_begin begin = context_begin_phase();
    AG_TRY(scene_prepare(context, from->name, request, s, inputs));
    s->definitions = d;
    context->run.inputs = inputs;
    ag_status status = from->text ? scene_file_load_text(&context->run, from->name, from->text, from->size_bytes, s)
                                  : scene_file_load(&context->run, from->name, s);
    context->run.inputs = NULL;
    inputs->scene = NULL; /* it was borrowed */
    if (status != AG_OK)
        return status;
    s->defined = definitions_describe(d);
    if (!s->defined)
        return AG_ERROR_MEMORY;
    context_end_phase(context, AG_PHASE_LOAD, begin);
    return scene_complete(context, s);
}

ag_status ag_scene_load(ag_context *context, const char *path, ag_scene **out_scene)
{
    return ag_scene_load_as(context, path, NULL, out_scene);
}

ag_status ag_scene_load_with(ag_context *context, const char *path, const ag_definition *given, size_t count,
                             ag_scene **out_scene)
{
    ag_scene_settings settings = ag_default_scene_settings();
    settings.definitions = given;
    settings.definition_count = count;
    return ag_scene_load_as(context, path, &settings, out_scene);
}

static ag_status load_from(ag_context *context, const scene_source *from, const ag_scene_settings *settings,
                           ag_scene **out_scene)
{
    const ag_scene_settings defaults = ag_default_scene_settings();
    if (!settings)
        settings = &defaults;
    scene_request request;
    if (!context)
        return AG_ERROR_ARGUMENT;
    if (!from->name || !out_scene) {
        log_message(context->log, AG_LOG_ERROR, "a scene cannot be loaded: %s is NULL",
                    from->name ? "where it is to go" : "its name");
        return AG_ERROR_ARGUMENT;
    }
    AG_TRY(scene_request_make(context, settings, &request));
    const ag_definition *given = settings->definitions;
    const size_t count = settings->definition_count;
    if (!given && count > 0)
        return scene_settings_refuse(context, "definitions is NULL, and definition_count is not 0");
    for (size_t i = 0; i < count; i++)
        if (!given[i].name || !given[i].value)
            return scene_settings_refuse(context, "a name or a value of definitions is NULL");
    unsigned callers_arithmetic = floating_point_enter();
    definitions d = {0};
    ag_scene *loaded = calloc(1, sizeof *loaded);
    scene *s = scene_create();
    ag_status status = copy_definitions(context, given, count, &d);
    if (status == AG_OK)
        status = loaded && s ? load(context, from, &d, &request, s, &loaded->inputs) : AG_ERROR_MEMORY;
    if (status == AG_OK) {
        loaded->context = context;
        context_add_scene(context);
        loaded->s = s;
        *out_scene = loaded;
    } else {
        scene_destroy(s);
        if (loaded)
            input_files_reset(&loaded->inputs);
        free(loaded);
    }
    free(d.items);
    floating_point_leave(callers_arithmetic);
    return status;
}

ag_status ag_scene_load_as(ag_context *context, const char *path, const ag_scene_settings *settings,
                           ag_scene **out_scene)
{
    return load_from(context, &(scene_source){.name = path}, settings, out_scene);
}

ag_status ag_scene_load_text(ag_context *context, const char *name, const char *text, size_t size_bytes,
                             const ag_scene_settings *settings, ag_scene **out_scene)
{
    if (context && !text)
        log_message(context->log, AG_LOG_ERROR, "a scene cannot be loaded: its text is NULL");
    if (!text)
        return AG_ERROR_ARGUMENT;
    return load_from(context, &(scene_source){name, text, size_bytes}, settings, out_scene);
}

void ag_scene_destroy(ag_scene *scene_to_destroy)
{
    if (!scene_to_destroy)
        return;
    scene_to_destroy->is_dropped = true;
    if (scene_to_destroy->rendering_count > 0)
        return; /* the last of them does it */
    ag_context *context = scene_to_destroy->context;
    scene_making_destroy(scene_to_destroy->making);
    scene_destroy(scene_to_destroy->s);
    input_files_reset(&scene_to_destroy->inputs);
    free(scene_to_destroy);
    context_remove_scene(context);
}

const char *ag_scene_film_file_name(const ag_scene *loaded)
{
    return loaded && loaded->s ? loaded->s->hints.file_name : NULL;
}

bool ag_scene_was_read_from(const ag_scene *loaded, const char *path)
{
    struct stat status;
    return loaded && path && stat(path, &status) == 0 && S_ISREG(status.st_mode) &&
           input_files_has(&loaded->inputs, (uint64_t)status.st_dev, (uint64_t)status.st_ino);
}
