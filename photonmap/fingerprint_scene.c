/* fingerprint_scene.c: see fingerprint_scene.h. */
#include "fingerprint_scene.h"

#include "math/rng.h"
#include "status.h"

#include <assert.h>

/* The kinds of surfaces; of each run of sixteen discs most are PLAIN. */
typedef enum surface_of_disc { PLAIN, CHECKERED, METAL, PANE, CURTAIN, COATED, SURFACE_COUNT } surface_of_disc;

/* Indices of the materials, the texture and the medium that shapes refer to. */
typedef struct parts {
    uint32_t materials[SURFACE_COUNT], glass, interface;
    uint32_t holes; /* a texture of 0 and 1 */
    uint32_t fog;
} parts;

static surface_of_disc surface_of(int disc)
{
    static const surface_of_disc OF_SIXTEEN[16] = {
        [3] = METAL, [5] = CURTAIN, [7] = PANE, [9] = COATED, [13] = CHECKERED};
    return OF_SIXTEEN[disc % 16];
}

static float between(rng *random, float least, float most) { return least + (most - least) * rng_float(random); }

static void make_discs(fingerprint_disc discs[FINGERPRINT_DISCS])
{
    rng random = rng_make(1, 2, 4);
    discs[0] = (fingerprint_disc){{0.0f, 0.0f, 0.0f}, frame_identity(), 1.0f};
    for (int i = 1; i < FINGERPRINT_DISCS; i++) {
        float x = between(&random, -0.8f, 0.8f), y = between(&random, -0.8f, 0.8f), z = between(&random, -0.3f, 0.3f);
        float tilt = i % 3 == 0 ? 0.0f : i % 3 == 1 ? 0.1f : 2.0f;
        vec3 normal = {between(&random, -tilt, tilt), between(&random, -tilt, tilt), 1.0f};
        discs[i] =
            (fingerprint_disc){{x, y, z * z * z}, frame_from_z(vec3_normalize(normal)), between(&random, 0.05f, 0.35f)};
    }
}

/* Adds a checkerboard of the surface's u and v, of two values. */
static ag_status add_checkerboard(scene *s, bool is_spectrum, rgb even, rgb odd, uint32_t *out_index)
{
    texture t = texture_make(TEXTURE_CHECKERBOARD);
    t.is_spectrum = is_spectrum;
    t.mapping.scale = (vec2){6.0f, 6.0f};
    t.inputs[0] = (texture_input){SCENE_NO_TEXTURE, even};
    t.inputs[1] = (texture_input){SCENE_NO_TEXTURE, odd};
    return texture_set_add(&s->textures, &t, out_index);
}

static ag_status add_materials(scene *s, parts *out)
{
    uint32_t colors;
    AG_TRY(add_checkerboard(s, true, (rgb){0.8f, 0.4f, 0.2f}, (rgb){0.1f, 0.3f, 0.6f}, &colors));
    AG_TRY(add_checkerboard(s, false, rgb_gray(1.0f), rgb_gray(0.0f), &out->holes));

    material plain = material_make(MATERIAL_DIFFUSE), checkered = plain;
    material metal = material_make(MATERIAL_CONDUCTOR), pane = material_make(MATERIAL_THIN_DIELECTRIC);
    material curtain = material_make(MATERIAL_DIFFUSE_TRANSMISSION), coated = material_make(MATERIAL_PRINCIPLED);
    material glass = material_make(MATERIAL_DIELECTRIC), interface = material_make(MATERIAL_INTERFACE);
    plain.reflectance = rgb_gray(0.5f);
    checkered.reflectance_texture = colors;
    metal.eta = (rgb){0.2f, 0.9f, 1.2f}, metal.k = (rgb){3.9f, 2.5f, 2.2f};
    metal.alpha_u = metal.alpha_v = 0.2f;
    pane.ior = 1.5f;
    curtain.reflectance = rgb_gray(0.3f), curtain.transmittance = (rgb){0.4f, 0.5f, 0.2f};
    coated.reflectance = (rgb){0.6f, 0.2f, 0.1f}, coated.metallic = 0.0f, coated.roughness = 0.3f;
    coated.clearcoat = 0.5f;
    glass.ior = 1.5f;

    AG_TRY(scene_add_material(s, &plain, &out->materials[PLAIN]));
    AG_TRY(scene_add_material(s, &checkered, &out->materials[CHECKERED]));
    AG_TRY(scene_add_material(s, &metal, &out->materials[METAL]));
    AG_TRY(scene_add_material(s, &pane, &out->materials[PANE]));
    AG_TRY(scene_add_material(s, &curtain, &out->materials[CURTAIN]));
    AG_TRY(scene_add_material(s, &coated, &out->materials[COATED]));
    AG_TRY(scene_add_material(s, &glass, &out->glass));
    return scene_add_material(s, &interface, &out->interface);
}

/* Places a quadric by its center, the axes of its own space, and factors along these. */
static void place(shape *item, vec3 center, const frame *axes, vec3 scale)
{
    vec3 x = vec3_scale(axes->x, scale.x), y = vec3_scale(axes->y, scale.y), z = vec3_scale(axes->z, scale.z);
    const double m[4][4] = {{(double)x.x, (double)y.x, (double)z.x, (double)center.x},
                            {(double)x.y, (double)y.y, (double)z.y, (double)center.y},
                            {(double)x.z, (double)y.z, (double)z.z, (double)center.z},
                            {0.0, 0.0, 0.0, 1.0}};
    bool is_regular = transform_from_matrix(m, &item->as.quadric.world_from_object);
    assert(is_regular);
    (void)is_regular;
}

static ag_status add_disc(scene *s, const parts *of, const fingerprint_disc *d, int number, uint32_t *out_index)
{
    shape disc = shape_make(SHAPE_DISK);
    disc.as.quadric = (quadric){.radius = d->radius, .turn = 1.0f};
    place(&disc, d->center, &d->axes, (vec3){1.0f, 1.0f, 1.0f});
    disc.material_index = of->materials[surface_of(number)];
    disc.alpha = number % 16 == 6 ? 0.5f : 1.0f;
    disc.alpha_texture = number % 16 == 11 ? of->holes : SCENE_NO_TEXTURE;
    return scene_add_shape(s, &disc, out_index);
}

/* Returns an ellipsoid that is nearly a ball, since Embree computes the hits of balls itself. Its area, which takes
 * milliseconds to compute, is only the ball's. */
static shape make_ball(vec3 center, float radius, uint32_t material_index)
{
    shape ball = shape_make(SHAPE_SPHERE);
    const frame axes = frame_identity();
    ball.as.quadric = (quadric){.radius = radius, .z_min = -radius, .z_max = radius, .turn = 1.0f};
    place(&ball, center, &axes, (vec3){1.0f, 1.0f, 0.9f});
    ball.area = 4.0f * AG_PI * radius * radius;
    ball.material_index = material_index;
    return ball;
}

static ag_status add_balls(scene *s, const parts *of)
{
    shape glass = make_ball((vec3){-0.3f, 0.2f, 0.6f}, 0.2f, of->glass);
    shape fog = make_ball((vec3){0.4f, -0.2f, 0.5f}, 0.3f, of->interface);
    uint32_t index;
    fog.has_medium_interface = true;
    fog.medium_inside = of->fog;
    fog.medium_outside = SCENE_NO_MEDIUM;
    AG_TRY(scene_add_shape(s, &glass, &index));
    return scene_add_shape(s, &fog, &index);
}

/* Adds a lamp of each of five kinds; they emit about as much each. */
static ag_status add_lamps(scene *s, const parts *of)
{
    light point = light_make(LIGHT_POINT), spot = light_make(LIGHT_SPOT), sun = light_make(LIGHT_DISTANT);
    light lamp = light_make(LIGHT_AREA), sky = light_make(LIGHT_INFINITE);
    const fingerprint_disc panel = {{0.5f, 0.6f, 1.0f}, frame_from_z((vec3){0.0f, 0.0f, -1.0f}), 0.15f};
    uint32_t index;
    point.as.point = (point_source){{-0.6f, -0.5f, 1.1f}, {0.6f, 0.5f, 0.3f}};
    spot.as.spot.position = (vec3){-0.4f, 0.4f, 1.4f};
    spot.as.spot.direction = vec3_normalize((vec3){0.1f, -0.2f, -1.0f});
    spot.as.spot.intensity = (rgb){4.0f, 5.0f, 6.0f};
    light_set_cone(&spot, 0.3, 0.6);
    sun.as.distant.direction = vec3_normalize((vec3){0.2f, 0.3f, -1.0f});
    sun.as.distant.irradiance = (rgb){2.0f, 1.8f, 1.5f};
    sky.as.infinite.radiance.value = (rgb){0.2f, 0.3f, 0.5f};
    AG_TRY(add_disc(s, of, &panel, 0, &lamp.as.area.shape_index));
    lamp.as.area.radiance = (rgb){15.0f, 12.0f, 9.0f};
    AG_TRY(scene_add_light(s, &point, &index));
    AG_TRY(scene_add_light(s, &spot, &index));
    AG_TRY(scene_add_light(s, &sun, &index));
    AG_TRY(scene_add_light(s, &lamp, &index));
    return scene_add_light(s, &sky, &index);
}

static ag_status fill(scene *s, const fingerprint_disc discs[FINGERPRINT_DISCS])
{
    const medium fog = {.kind = MEDIUM_HOMOGENEOUS,
                        .phase = {.g = 0.4f},
                        .as.homogeneous = {.sigma_a = {0.3f, 0.5f, 0.7f}, .sigma_s = {12.0f, 12.0f, 12.0f}}};
    parts of;
    uint32_t index;
    AG_TRY(add_materials(s, &of));
    AG_TRY(scene_add_medium(s, &fog, &of.fog));
    for (int i = 0; i < FINGERPRINT_DISCS; i++)
        AG_TRY(add_disc(s, &of, &discs[i], i, &index));
    AG_TRY(add_balls(s, &of));
    return add_lamps(s, &of);
}

ag_status fingerprint_scene_create(run_context *run, const char *isa, fingerprint_disc out_discs[FINGERPRINT_DISCS],
                                   scene **out_scene)
{
    scene *s = scene_create();
    if (!s)
        return AG_ERROR_MEMORY;
    make_discs(out_discs);
    ag_status status = fill(s, out_discs);
    if (status == AG_OK)
        status = scene_commit(s, run, isa);
    if (status == AG_OK)
        *out_scene = s;
    else
        scene_destroy(s);
    return status;
}
