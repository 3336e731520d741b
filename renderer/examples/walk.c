/* walk.c: an interactive loop on one page: a scene from arrays, views along a walk through it that share one photon
 * map, and a window's copy of the picture that is brought up to date while each is rendered.
 *
 *     cc -std=c17 walk.c -o walk $(pkg-config --cflags --libs afterglow)
 *     ./walk /dev/shm/walk.map view
 *
 * It writes view1.png, view2.png and view3.png. */
#define _POSIX_C_SOURCE 200809L
#include <afterglow/afterglow.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { WIDTH = 160, HEIGHT = 90, SAMPLES = 4, VIEWS = 3 };

/* The picture that a window would show. */
static struct {
    const ag_film *film; /* that is rendered, or NULL */
    uint64_t version;    /* of the pixels below */
    float pixels[3 * WIDTH * HEIGHT];
    int updates;
} window;

/* A window would do this at its own pace, on its own thread; here the renderer's progress sets the pace. */
static void on_progress(void *user, ag_phase phase, double fraction)
{
    (void)user, (void)phase, (void)fraction;
    const uint64_t before = window.version;
    if (window.film)
        window.version = ag_film_read_picture(window.film, before, window.pixels);
    window.updates += window.version != before;
}

static void on_log(void *user, ag_log_level level, const char *message)
{
    (void)user;
    if (level <= AG_LOG_WARNING)
        fprintf(stderr, "%s\n", message);
}

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A box of 4 by 3 by 8 m, its inside; each wall two triangles, all of them in one mesh. */
static const float CORNERS[] = {-2, 0, -4, 2, 0, -4, 2, 3, -4, -2, 3, -4, -2, 0, 4, 2, 0, 4, 2, 3, 4, -2, 3, 4};
static const int32_t WALLS[] = {0, 5, 1, 0, 4, 5, 3, 2, 6, 3, 6, 7, 0, 1, 2, 0, 2, 3,
                                4, 6, 5, 4, 7, 6, 0, 3, 7, 0, 7, 4, 1, 5, 6, 1, 6, 2};
static const float WHITE[] = {0.75f, 0.75f, 0.75f}, RADIANCE[] = {25, 24, 22}, RADIUS = 0.4f, FOV = 60;

static ag_status make_room(ag_scene *scene)
{
    const ag_parameter reflectance = {"reflectance", AG_PARAMETER_RGB, 3, WHITE, NULL, NULL, NULL, NULL};
    const ag_parameter mesh[] = {{"P", AG_PARAMETER_POINT3, 24, CORNERS, NULL, NULL, NULL, NULL},
                                 {"indices", AG_PARAMETER_INTEGER, 36, NULL, NULL, WALLS, NULL, NULL}};
    const ag_parameter radius = {"radius", AG_PARAMETER_FLOAT, 1, &RADIUS, NULL, NULL, NULL, NULL};
    const ag_parameter radiance = {"L", AG_PARAMETER_RGB, 3, RADIANCE, NULL, NULL, NULL, NULL};
    const double high[16] = {1, 0, 0, 0, 0, 1, 0, 2.4, 0, 0, 1, 0, 0, 0, 0, 1};
    ag_shape walls = ag_default_shape(), lamp = ag_default_shape();
    ag_status status = ag_scene_add_material(scene, "plaster", "diffuse", &reflectance, 1);
    walls.type = "trianglemesh";
    walls.parameters = mesh;
    walls.parameter_count = 2;
    walls.material = "plaster";
    if (status == AG_OK)
        status = ag_scene_add_shape(scene, &walls, NULL);
    lamp.type = "sphere";
    lamp.parameters = &radius;
    lamp.parameter_count = 1;
    lamp.world_from_shape = high;
    lamp.is_light = true;
    lamp.light_parameters = &radiance;
    lamp.light_parameter_count = 1;
    if (status == AG_OK)
        status = ag_scene_add_shape(scene, &lamp, NULL);
    return status == AG_OK ? ag_scene_commit(scene) : status;
}

/* One view: the camera moves, the scene and the photon map stay. */
static ag_status show_view(ag_context *context, ag_scene *scene, const char *map, int view, const char *picture)
{
    const ag_parameter fov = {"fov", AG_PARAMETER_FLOAT, 1, &FOV, NULL, NULL, NULL, NULL};
    const double there[16] = {1, 0, 0, 0.5 * view - 1, 0, 1, 0, 1.5, 0, 0, 1, view - 3.8, 0, 0, 0, 1};
    ag_camera camera = ag_default_camera();
    ag_render_settings settings = ag_default_render_settings();
    ag_rendering *rendering;
    ag_film *film = NULL;
    const double begun = now_s();
    camera.parameters = &fov;
    camera.parameter_count = 1;
    camera.world_from_camera = there;
    settings.width = WIDTH;
    settings.height = HEIGHT;
    settings.samples_per_pixel = SAMPLES;
    settings.photon_count = 20000;
    settings.photon_map_file = map; /* traced for the first view, and opened for the others */
    ag_status status = ag_scene_set_camera(scene, &camera);
    if (status == AG_OK)
        status = ag_rendering_create(context, scene, &settings, &rendering);
    if (status != AG_OK)
        return status;
    window.version = 0;
    window.film = ag_rendering_film(rendering);
    status = ag_rendering_continue(rendering, 1);
    printf("view %d: a first picture after %.2f s\n", view, now_s() - begun);
    if (status == AG_OK)
        status = ag_rendering_continue(rendering, SAMPLES); /* where nothing calls it off, it refines */
    if (window.film)
        window.version = ag_film_read_picture(window.film, window.version, window.pixels);
    window.film = NULL;
    ag_rendering_finish(rendering, status == AG_OK ? &film : NULL);
    if (status == AG_OK)
        status = ag_film_write(context, film, NULL, picture);
    ag_film_destroy(film);
    return status;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: %s MAP NAME\n", argv[0]);
        return EXIT_FAILURE;
    }
    ag_context *context = NULL;
    ag_scene *scene = NULL;
    ag_context_settings settings = ag_default_context_settings();
    settings.log = on_log;
    settings.progress = on_progress;
    ag_status status = ag_context_create(&settings, &context);
    if (status == AG_OK)
        status = ag_scene_create(context, NULL, &scene);
    if (status == AG_OK)
        status = make_room(scene);
    for (int view = 1; view <= VIEWS && status == AG_OK; view++) {
        char picture[4096];
        snprintf(picture, sizeof picture, "%s%d.png", argv[2], view);
        status = show_view(context, scene, argv[1], view, picture);
    }
    printf("%d updates of the window\n", window.updates);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
    if (status != AG_OK)
        fprintf(stderr, "%s\n", ag_status_text(status));
    return status == AG_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
