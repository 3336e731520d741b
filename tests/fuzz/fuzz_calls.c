/* fuzz_calls.c: calls of the public interface in any order, with odd values: two scenes that are made, committed,
 * changed, rendered and destroyed. Whatever the bytes say, a call that cannot be gives an error and no crash, and a
 * scene that its host has not destroyed goes on. Flow: bytes, each a choice -> [here] -> the public interface. Threads:
 * one of the program's. */
#include "afterglow/afterglow.h"
#include "fuzz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCENES = 2, HANDLES = 16, PARAMETERS = 5, VALUES = 24 };

/* The state of a host program whose choices the fuzzer's bytes make. Behind the last byte all choices are 0. */
typedef struct host {
    const uint8_t *bytes;
    size_t left;
    ag_context *context;
    ag_scene *scenes[SCENES];
    ag_rendering *renderings[SCENES];
    ag_handle handles[HANDLES];
    /* the arrays of one call */
    ag_parameter parameters[2][PARAMETERS];
    float floats[2][PARAMETERS][VALUES];
    double doubles[2][PARAMETERS][VALUES], matrices[2][16];
    int32_t integers[2][PARAMETERS][VALUES];
    bool bools[2][PARAMETERS][VALUES];
    const char *strings[2][PARAMETERS][VALUES];
    unsigned char pixels[64];
    float values[64];
} host;

static unsigned choose(host *h, unsigned count)
{
    if (h->left == 0)
        return 0;
    h->left--;
    return *h->bytes++ % count;
}

/* Mostly false. */
static bool seldom(host *h) { return choose(h, 16) == 15; }

#define PICK(h, words) ((words)[choose((h), sizeof(words) / sizeof *(words))])

static double number(host *h)
{
    static const double NUMBERS[] = {0.0,  1.0,  -1.0, 0.5,  2.0, 3.0,      0.1,    -0.5,         10.0, 0.25,
                                     1e-7, 1e10, -2.0, 1e30, NAN, INFINITY, -1e300, 2147483647.0, 4.0,  100.0};
    /* the odd ones at the end of the list are rare */
    return choose(h, 8) ? NUMBERS[choose(h, 10)] : PICK(h, NUMBERS);
}

static const char *name(host *h)
{
    static const char *const NAMES[] = {"a", "b", "c", "d", "", NULL, "imagemap", "a rather long name of something"};
    return choose(h, 8) ? NAMES[choose(h, 4)] : PICK(h, NAMES);
}

static const char *type(host *h)
{
    static const char *const TYPES[] = {"trianglemesh",
                                        "sphere",
                                        "bilinearmesh",
                                        "curve",
                                        "disk",
                                        "cylinder",
                                        "loopsubdiv",
                                        "plymesh",
                                        "diffuse",
                                        "conductor",
                                        "dielectric",
                                        "coateddiffuse",
                                        "coatedconductor",
                                        "mix",
                                        "interface",
                                        "hair",
                                        "principled",
                                        "point",
                                        "spot",
                                        "distant",
                                        "infinite",
                                        "goniometric",
                                        "projection",
                                        "imagemap",
                                        "scale",
                                        "checkerboard",
                                        "constant",
                                        "mix",
                                        "perspective",
                                        "spherical",
                                        "orthographic",
                                        "realistic",
                                        "homogeneous",
                                        "rgb",
                                        "gbuffer",
                                        "independent",
                                        "photonmap",
                                        "gaussian",
                                        "box",
                                        NULL,
                                        "",
                                        "nothing"};
    return PICK(h, TYPES);
}

/* --- descriptions --- */

static size_t size_of(host *h, size_t size) { return seldom(h) ? choose(h, 200) : size; }

static void fill_arrays(host *h, int set, int i, ag_parameter *p)
{
    for (int k = 0; k < VALUES; k++) {
        h->doubles[set][i][k] = number(h);
        h->floats[set][i][k] = (float)h->doubles[set][i][k];
        h->integers[set][i][k] = (int32_t)choose(h, 4) - 2 * (int32_t)seldom(h);
        h->bools[set][i][k] = choose(h, 2) != 0;
        h->strings[set][i][k] = name(h);
    }
    const unsigned which = seldom(h) ? choose(h, 32) : 0;
    const bool is_text = p->type == AG_PARAMETER_STRING || p->type == AG_PARAMETER_TEXTURE;
    p->integers = p->type == AG_PARAMETER_INTEGER || which & 1 ? h->integers[set][i] : NULL;
    p->bools = p->type == AG_PARAMETER_BOOL || which & 2 ? h->bools[set][i] : NULL;
    p->strings = is_text || which & 4 ? h->strings[set][i] : NULL;
    if (!p->integers && !p->bools && !p->strings && choose(h, 2))
        p->doubles = h->doubles[set][i];
    else if (!p->integers && !p->bools && !p->strings)
        p->floats = h->floats[set][i];
    if (which & 8)
        p->floats = h->floats[set][i];
    if (which & 16) { /* nothing is there, and it is much */
        p->integers = NULL, p->bools = NULL, p->strings = NULL, p->doubles = NULL, p->floats = NULL;
        p->count = SIZE_MAX / (1 + choose(h, 9));
    }
}

static size_t parameters(host *h, int set, const ag_parameter **out)
{
    static const struct {
        const char *name;
        ag_parameter_type type;
        unsigned count;
    } KNOWN[] = {{"P", AG_PARAMETER_POINT3, 12},           {"indices", AG_PARAMETER_INTEGER, 6},
                 {"N", AG_PARAMETER_NORMAL, 12},           {"uv", AG_PARAMETER_POINT2, 8},
                 {"S", AG_PARAMETER_VECTOR3, 12},          {"alpha", AG_PARAMETER_FLOAT, 1},
                 {"alpha", AG_PARAMETER_TEXTURE, 1},       {"radius", AG_PARAMETER_FLOAT, 1},
                 {"filename", AG_PARAMETER_STRING, 1},     {"reflectance", AG_PARAMETER_RGB, 3},
                 {"reflectance", AG_PARAMETER_TEXTURE, 1}, {"roughness", AG_PARAMETER_FLOAT, 1},
                 {"materials", AG_PARAMETER_STRING, 2},    {"scale", AG_PARAMETER_FLOAT, 1},
                 {"tex", AG_PARAMETER_TEXTURE, 1},         {"L", AG_PARAMETER_RGB, 3},
                 {"I", AG_PARAMETER_BLACKBODY, 1},         {"power", AG_PARAMETER_FLOAT, 1},
                 {"from", AG_PARAMETER_POINT3, 3},         {"portal", AG_PARAMETER_POINT3, 12},
                 {"width", AG_PARAMETER_FLOAT, 1},         {"levels", AG_PARAMETER_INTEGER, 1},
                 {"fov", AG_PARAMETER_FLOAT, 1},           {"shutterclose", AG_PARAMETER_FLOAT, 1},
                 {"sigma_a", AG_PARAMETER_SPECTRUM, 4},    {"twosided", AG_PARAMETER_BOOL, 1},
                 {"type", AG_PARAMETER_STRING, 1},         {"iso", AG_PARAMETER_FLOAT, 1},
                 {"motionsteps", AG_PARAMETER_INTEGER, 1}};
    const size_t count = choose(h, PARAMETERS + 1);
    memset(h->parameters[set], 0, sizeof h->parameters[set]);
    for (size_t i = 0; i < count; i++) {
        ag_parameter *p = &h->parameters[set][i];
        const size_t which = choose(h, sizeof KNOWN / sizeof *KNOWN);
        *p = (ag_parameter){KNOWN[which].name, KNOWN[which].type, KNOWN[which].count, NULL, NULL, NULL, NULL, NULL};
        if (seldom(h))
            p->name = name(h);
        if (seldom(h))
            p->type = (ag_parameter_type)choose(h, 20);
        if (seldom(h))
            p->count = choose(h, VALUES + 1);
        fill_arrays(h, set, (int)i, p);
    }
    *out = seldom(h) ? NULL : h->parameters[set];
    return seldom(h) && *out == NULL ? SIZE_MAX : count;
}

static const double *matrix(host *h, int set)
{
    static const double IDENTITY[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    if (choose(h, 2))
        return NULL;
    memcpy(h->matrices[set], IDENTITY, sizeof IDENTITY);
    for (unsigned k = choose(h, 5); k > 0; k--)
        h->matrices[set][choose(h, 16)] = number(h);
    return h->matrices[set];
}

/* Arrays that stay as they are, as the interface asks for; now and then none that can be borrowed. */
static void borrow(host *h, ag_shape *s)
{
    static const float POINTS[13] = {-1, -1, 2, 1, -1, 2, 1, 1, 2, -1, 1, 2, 0}, UVS[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    static const int32_t INDICES[] = {0, 1, 2, 0, 2, 3, 1, 1, 2, 0, 4, -1};
    s->borrows_arrays = true;
    if (seldom(h))
        return;
    const ag_parameter all[] = {
        {"P", AG_PARAMETER_POINT3, 12 - choose(h, 2) * choose(h, 3), POINTS, NULL, NULL, NULL, NULL},
        {"indices", AG_PARAMETER_INTEGER, 6 + (size_t)choose(h, 2) * choose(h, 7), NULL, NULL, INDICES, NULL, NULL},
        {"uv", AG_PARAMETER_POINT2, 8, UVS, NULL, NULL, NULL, NULL}};
    memcpy(h->parameters[0], all, sizeof all);
    s->parameters = h->parameters[0];
    s->parameter_count = 2 + choose(h, 2);
}

static ag_shape describe_shape(host *h)
{
    ag_shape s = ag_default_shape();
    s.struct_size = size_of(h, sizeof s);
    s.type = choose(h, 2) ? "trianglemesh" : type(h);
    s.parameter_count = parameters(h, 0, &s.parameters);
    s.material = choose(h, 2) ? NULL : name(h);
    s.object = choose(h, 2) ? NULL : name(h);
    s.world_from_shape = matrix(h, 0);
    s.world_from_shape_end = choose(h, 4) ? NULL : matrix(h, 1);
    s.is_light = choose(h, 4) == 0;
    s.light_parameter_count = s.is_light ? parameters(h, 1, &s.light_parameters) : 0;
    s.medium_inside = choose(h, 4) ? NULL : name(h);
    s.reverse_orientation = choose(h, 2) != 0;
    if (choose(h, 4) == 0)
        borrow(h, &s);
    return s;
}

static ag_light describe_light(host *h)
{
    ag_light l = ag_default_light();
    l.struct_size = size_of(h, sizeof l);
    l.type = type(h);
    l.parameter_count = parameters(h, 0, &l.parameters);
    l.world_from_light = matrix(h, 0);
    l.medium_outside = choose(h, 4) ? NULL : name(h);
    return l;
}

static ag_instance describe_instance(host *h)
{
    ag_instance i = ag_default_instance();
    i.struct_size = size_of(h, sizeof i);
    i.object = name(h);
    i.world_from_object = matrix(h, 0);
    i.world_from_object_end = choose(h, 4) ? NULL : matrix(h, 1);
    return i;
}

static ag_texture describe_texture(host *h)
{
    ag_texture t = ag_default_texture();
    t.struct_size = size_of(h, sizeof t);
    t.name = name(h);
    t.value = (ag_texture_value)choose(h, seldom(h) ? 9 : 2);
    t.type = type(h);
    t.parameter_count = parameters(h, 0, &t.parameters);
    t.world_from_texture = matrix(h, 0);
    return t;
}

static ag_image describe_image(host *h)
{
    ag_image i = ag_default_image();
    i.struct_size = size_of(h, sizeof i);
    i.width = (int)choose(h, 5);
    i.height = seldom(h) && i.width == 0 ? -1 : (int)choose(h, 5);
    i.channel_count = (int)choose(h, 6); /* at most 4 x 4 x 4 count */
    if (seldom(h) && i.channel_count > 4)
        i.width = i.height = 1 << 30;
    for (size_t k = 0; k < sizeof h->pixels; k++)
        h->values[k] = (float)(h->pixels[k] = (unsigned char)(37 * k + choose(h, 256)));
    h->values[3] = (float)number(h);
    i.bytes = choose(h, 2) ? h->pixels : NULL;
    i.floats = !i.bytes || seldom(h) ? h->values : NULL;
    return i;
}

/* --- calls --- */

static void render(host *h, unsigned which)
{
    ag_render_settings settings;
    if (ag_render_settings_from_scene(h->context, h->scenes[which], &settings) != AG_OK)
        return;
    settings.struct_size = size_of(h, settings.struct_size);
    settings.integrator = (ag_integrator)choose(h, seldom(h) ? 7 : 2);
    settings.width = settings.height = 1 + (int)choose(h, 3);
    settings.crop_window[0] = settings.crop_window[2] = 0.0;
    settings.crop_window[1] = settings.crop_window[3] = 1.0;
    settings.samples_per_pixel = 1;
    settings.noise_level = 0.0f;
    settings.photon_count = settings.caustic_photon_count = 30;
    settings.nearest = 4;
    settings.gather_samples = 2;
    settings.max_depth = 4;
    if (h->renderings[which] ||
        ag_rendering_create(h->context, h->scenes[which], &settings, &h->renderings[which]) != AG_OK)
        return;
    if (choose(h, 4))
        (void)ag_rendering_continue(h->renderings[which], (int)choose(h, 3));
    if (choose(h, 2)) {
        ag_film *film = NULL;
        ag_rendering_finish(h->renderings[which], &film);
        h->renderings[which] = NULL;
        ag_film_destroy(film);
    }
}

static void create(host *h, unsigned which)
{
    ag_scene_settings settings = ag_default_scene_settings();
    settings.struct_size = size_of(h, sizeof settings);
    settings.is_editable = choose(h, 4) != 0;
    settings.has_sky = choose(h, 4) == 0;
    settings.has_camera = choose(h, 4) == 0;
    settings.camera_from[2] = (float)number(h);
    settings.camera_to[0] = (float)number(h);
    settings.sky_radiance[1] = (float)number(h);
    ag_rendering_finish(h->renderings[which], NULL);
    h->renderings[which] = NULL;
    ag_scene_destroy(h->scenes[which]);
    h->scenes[which] = NULL;
    (void)ag_scene_create(h->context, choose(h, 8) ? &settings : NULL, choose(h, 32) == 31 ? NULL : &h->scenes[which]);
}

static void add(host *h, ag_scene *s)
{
    ag_handle *out = choose(h, 8) ? &h->handles[choose(h, HANDLES)] : NULL;
    const ag_parameter *items;
    const unsigned what = choose(h, 10);
    if (what < 4) {
        const ag_shape d = describe_shape(h);
        (void)ag_scene_add_shape(s, seldom(h) ? NULL : &d, out);
    } else if (what == 4) {
        const ag_light d = describe_light(h);
        (void)ag_scene_add_light(s, seldom(h) ? NULL : &d, out);
    } else if (what == 5) {
        const ag_instance d = describe_instance(h);
        (void)ag_scene_add_instance(s, seldom(h) ? NULL : &d, out);
    } else if (what == 6) {
        const ag_texture d = describe_texture(h);
        (void)ag_scene_add_texture(s, seldom(h) ? NULL : &d);
    } else if (what == 7) {
        const ag_image d = describe_image(h);
        (void)ag_scene_add_image(s, name(h), seldom(h) ? NULL : &d);
    } else {
        const size_t count = parameters(h, 0, &items);
        (void)(what == 8 ? ag_scene_add_material : ag_scene_add_medium)(s, name(h), type(h), items, count);
    }
}

static void change(host *h, ag_scene *s)
{
    ag_handle handle = h->handles[choose(h, HANDLES)];
    const ag_parameter *items;
    const unsigned what = choose(h, 12);
    if (seldom(h))
        handle += choose(h, 5) - (ag_handle)2;
    if (what < 2) {
        const ag_shape d = describe_shape(h);
        (void)ag_scene_change_shape(s, handle, seldom(h) ? NULL : &d);
    } else if (what == 2) {
        const ag_light d = describe_light(h);
        (void)ag_scene_change_light(s, handle, seldom(h) ? NULL : &d);
    } else if (what == 3) {
        const ag_instance d = describe_instance(h);
        (void)ag_scene_change_instance(s, handle, seldom(h) ? NULL : &d);
    } else if (what == 4) {
        const ag_texture d = describe_texture(h);
        (void)ag_scene_change_texture(s, seldom(h) ? NULL : &d);
    } else if (what == 5) {
        const ag_image d = describe_image(h);
        (void)ag_scene_change_image(s, name(h), seldom(h) ? NULL : &d);
    } else if (what < 8) {
        const size_t count = parameters(h, 0, &items);
        (void)(what == 6 ? ag_scene_change_material : ag_scene_change_medium)(s, name(h), type(h), items, count);
    } else if (what == 8) {
        const double *start = matrix(h, 0);
        (void)ag_scene_move(s, handle, start, choose(h, 2) ? matrix(h, 1) : NULL);
    } else if (what == 9) {
        (void)ag_scene_assign_material(s, handle, name(h));
    } else if (what == 10) {
        (void)ag_scene_remove(s, handle);
    } else {
        (void)ag_scene_remove_named(s, (ag_named)choose(h, 7), name(h));
    }
}

static void call(host *h)
{
    const unsigned which = choose(h, SCENES);
    ag_scene *s = h->scenes[which];
    const ag_parameter *items;
    switch (choose(h, 16)) {
    case 0: create(h, which); break;
    case 1:
    case 2:
    case 3:
    case 4:
    case 5: add(h, s); break;
    case 6:
    case 7:
    case 8: change(h, s); break;
    case 9:
    case 10: (void)ag_scene_commit(s); break;
    case 11: {
        ag_camera c = ag_default_camera();
        c.struct_size = size_of(h, sizeof c);
        c.type = choose(h, 2) ? c.type : type(h);
        c.parameter_count = parameters(h, 0, &c.parameters);
        c.world_from_camera = matrix(h, 0);
        c.world_from_camera_end = choose(h, 4) ? NULL : matrix(h, 1);
        c.medium = choose(h, 4) ? NULL : name(h);
        (void)ag_scene_set_camera(s, seldom(h) ? NULL : &c);
        break;
    }
    case 12: {
        const size_t count = parameters(h, 0, &items);
        (void)ag_scene_set_hint(s, (ag_scene_hint)choose(h, 6), type(h), items, count);
        break;
    }
    case 13:
    case 14:
        if (s)
            render(h, which);
        break;
    default:
        (void)ag_scene_commit_counts(s);
        if (s && choose(h, 4) == 0) { /* renderings keep it */
            ag_scene_destroy(s);
            h->scenes[which] = NULL;
            if (h->renderings[which])
                (void)ag_rendering_continue(h->renderings[which], 1);
            ag_rendering_finish(h->renderings[which], NULL);
            h->renderings[which] = NULL;
        }
    }
}

/* A triangle of an object with an instance, a material and a camera, so that more of what follows makes sense. */
static void begin_scene(host *h, ag_scene **out)
{
    static const float POINTS[] = {-1, -1, 2, 1, -1, 2, 0, 1, 2};
    const ag_parameter points = {"P", AG_PARAMETER_POINT3, 9, POINTS, NULL, NULL, NULL, NULL};
    ag_scene_settings editable = ag_default_scene_settings();
    ag_camera camera = ag_default_camera();
    ag_shape triangle = ag_default_shape();
    ag_instance shown = ag_default_instance();
    editable.is_editable = true;
    triangle.type = "trianglemesh";
    triangle.parameters = &points;
    triangle.parameter_count = 1;
    triangle.object = shown.object = "a";
    FUZZ_CHECK(ag_scene_create(h->context, &editable, out) == AG_OK);
    FUZZ_CHECK(ag_scene_set_camera(*out, &camera) == AG_OK);
    FUZZ_CHECK(ag_scene_add_material(*out, "a", "diffuse", NULL, 0) == AG_OK);
    FUZZ_CHECK(ag_scene_add_shape(*out, &triangle, &h->handles[0]) == AG_OK);
    FUZZ_CHECK(ag_scene_add_instance(*out, &shown, &h->handles[1]) == AG_OK);
}

static void hear(void *user, ag_log_level level, const char *message)
{
    (void)user;
    if (getenv("FUZZ_VERBOSE"))
        fprintf(stderr, "%d %s\n", (int)level, message);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { CALLS_MAX = 200 };
    static host h; /* large */
    fuzz_enter_folder();
    h = (host){.bytes = data, .left = size};
    ag_context_settings settings = ag_default_context_settings();
    settings.thread_count = 1;
    settings.log = hear;
    FUZZ_CHECK(ag_context_create(&settings, &h.context) == AG_OK);
    for (int i = 0; i < SCENES; i++)
        begin_scene(&h, &h.scenes[i]);
    for (int i = 0; i < CALLS_MAX && h.left > 0; i++)
        call(&h);
    for (int i = 0; i < SCENES; i++) {
        ag_rendering_finish(h.renderings[i], NULL);
        ag_scene_destroy(h.scenes[i]);
    }
    ag_context_destroy(h.context);
    return 0;
}
