/* test_scene_hash.c: two scenes have one fingerprint if they are the same, and no word of what they are is forgotten.
 * Threads: one. */
#include "fixtures/test_scene.h"

#include "light/environment.h"
#include "light/portal.h"
#include "light/projection.h"
#include "scene_hash.h"

/* A world with one of each kind: a mesh of one triangle with all it may have, a disk, curves, an instance that moves, a
 * picture. */
static const char WORLD[] =
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.1 .2 .3] \"rgb sigma_s\" [0 0 0]\n"
    "Texture \"cells\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [.1 .2 .3] \"rgb tex2\" [.4 .5 .6]\n"
    "MakeNamedMaterial \"cells\" \"string type\" \"diffuse\" \"texture reflectance\" \"cells\"\n"
    "LightSource \"infinite\" \"rgb L\" [.5 .5 .5]\n"
    "LightSource \"spot\" \"rgb I\" [1 2 3] \"float coneangle\" 40 \"string lightgroup\" \"key\"\n"
    "NamedMaterial \"cells\"\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [3 2 1]\n"
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1 0 0 1 0 0 1]\n"
    "  \"point2 uv\" [0 0 1 0 0 1] \"vector3 S\" [1 0 0 1 0 0 1 0 0] \"integer indices\" [0 1 2]\nAttributeEnd\n"
    "Shape \"disk\" \"float radius\" 2 \"float height\" 5\n"
    "Shape \"curve\" \"point3 P\" [0 0 0 1 0 1 2 0 1 3 0 0] \"string type\" \"flat\"\n"
    "ObjectBegin \"thing\" Shape \"sphere\" ObjectEnd\n"
    "AttributeBegin Translate 3 1 2 ObjectInstance \"thing\" AttributeEnd\n";

static scene *create(test_run *r, const char *world, const char *eye)
{
    char text[8192];
    scene *s = scene_create();
    assert_non_null(s);
    snprintf(text, sizeof text, "%s\nWorldBegin\n%s", eye, world);
    ag_status status = pbrt_parse_text(&r->run, "scene", text, strlen(text), s);
    if (status == AG_OK)
        status = scene_commit(s, &r->run, NULL);
    if (status != AG_OK)
        fail_msg("%s: %s", ag_status_text(status), r->said);
    return s;
}

/* A world without media of its own: fog is what the eye may be in. */
static const char EMPTY_WORLD[] = "LightSource \"point\"\nShape \"sphere\"\n";
#define FOG "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [1 1 1]\n"

static const char CAMERA[] = "LookAt 0 0 9 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 40";

static void hashes(const char *world, const char *eye, hash128 out[2])
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = create(&r, world, eye);
    out[0] = scene_hash_of_light(s);
    out[1] = scene_hash_of_view(s);
    scene_destroy(s);
    test_run_reset(&r);
}

static void test_same_and_other(void **state)
{
    (void)state;
    hash128 first[2], other[2];
    hashes(WORLD, CAMERA, first);
    hashes(WORLD, CAMERA, other);
    assert_true(hash128_is_equal(first[0], other[0]) && hash128_is_equal(first[1], other[1]));
    hashes(WORLD, "LookAt 0 1 9 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 40", other);
    assert_true(hash128_is_equal(first[0], other[0]));
    assert_false(hash128_is_equal(first[1], other[1]));

    static const char *const changes[][2] = {
        {"sigma_a\" [.1 .2 .3]", "sigma_a\" [.1 .2 .4]"},
        {"sigma_s\" [0 0 0]", "sigma_s\" [0 0 1]"},
        {"sigma_s\" [0 0 0]", "sigma_s\" [0 0 0] \"float g\" 0.5"},
        {"tex2\" [.4 .5 .6]", "tex2\" [.4 .5 .7]"},
        {"[1 2 3] \"float", "[1 2 4] \"float"},
        {"coneangle\" 40", "coneangle\" 41"},
        {"[0 0 0 1 0 0 0 1 0]", "[0 0 0 1 0 0 0 1 1]"},
        {"[3 2 1]", "[3 2 2]"},
        {"radius\" 2", "radius\" 3"},
        {"height\" 5", "height\" 6"},
        {"[0 0 0 1 0 1 2", "[0 0 0 1 1 1 2"},
        {"Translate 3 1 2", "Translate 3 1 3"},
        {"Shape \"sphere\"", "Shape \"cylinder\""},
        {"\"diffuse\" \"texture", "\"diffusetransmission\" \"texture"},
        {"NamedMaterial \"cells\"\nA", "\nA"},
    };
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        char world[4096];
        const char *at = strstr(WORLD, changes[i][0]);
        assert_non_null(at);
        snprintf(world, sizeof world, "%.*s%s%s", (int)(at - WORLD), WORLD, changes[i][1], at + strlen(changes[i][0]));
        hashes(world, CAMERA, other);
        if (hash128_is_equal(first[0], other[0]))
            fail_msg("'%s' makes no difference", changes[i][1]);
    }
    /* what lamps and things are called is the picture's alone */
    static const char *const names[][2] = {{"\"key\"", "\"rim\""}, {"\"thing\"", "\"stuff\""}};
    for (size_t i = 0; i < 2; i++) {
        char world[4096] = {0};
        for (const char *from = WORLD; *from;) {
            bool is_here = strncmp(from, names[i][0], strlen(names[i][0])) == 0;
            if (is_here) {
                strcat(world, names[i][1]);
                from += strlen(names[i][0]);
            } else {
                world[strlen(world)] = *from++;
            }
        }
        hashes(world, CAMERA, other);
        assert_true(hash128_is_equal(first[0], other[0]));
        assert_false(hash128_is_equal(first[1], other[1]));
    }
}

/* Bytes of a struct that do not count: pointers, gaps, what scene_commit works out. */
typedef struct range {
    size_t begin, size;
} range;
#define FIELD(type, name)                                                                                              \
    {                                                                                                                  \
        offsetof(type, name), sizeof(((type *)0)->name)                                                                \
    }
#define FROM(type, name)                                                                                               \
    {                                                                                                                  \
        offsetof(type, name), sizeof(type) - offsetof(type, name)                                                      \
    }
#define WORDS_COUNT(type, item, ...)                                                                                   \
    words_count(s, #type, (item), sizeof(type), (const range[]){__VA_ARGS__},                                          \
                sizeof((const range[]){__VA_ARGS__}) / sizeof(range))

/* Changes the first bit of each word in turn, and sees whether the hashes follow. */
static void words_count(const scene *s, const char *name, void *item, size_t size, const range *excepted,
                        size_t excepted_count)
{
    unsigned char *bytes = item;
    hash128 way = scene_hash_of_light(s), view = scene_hash_of_view(s);
    for (size_t at = 0; at < size; at += 4) {
        bool counts = true;
        for (size_t i = 0; i < excepted_count; i++)
            counts = counts && !(at >= excepted[i].begin && at < excepted[i].begin + excepted[i].size);
        if (!counts)
            continue;
        bytes[at] ^= 1;
        bool is_seen = !hash128_is_equal(way, scene_hash_of_light(s)) || !hash128_is_equal(view, scene_hash_of_view(s));
        bytes[at] ^= 1;
        if (!is_seen)
            fail_msg("scene_hash.c does not know the field at byte %zu of %s", at, name);
    }
    assert_true(hash128_is_equal(way, scene_hash_of_light(s)));
}

/* A value that one member has instead of another makes a difference: a default is told from the value beside it. */
static void values_keep_their_names(material *m, const scene *s)
{
    const material kept = *m;
    hash128 seen[3];
    m->eta = m->k = m->sheen = rgb_gray(0.0f);
    rgb *const colors[] = {&m->eta, &m->k, &m->sheen};
    for (int i = 0; i < 3; i++) {
        *colors[i] = rgb_gray(0.3f);
        seen[i] = scene_hash_of_light(s);
        *colors[i] = rgb_gray(0.0f);
        for (int other = 0; other < i; other++)
            assert_false(hash128_is_equal(seen[other], seen[i]));
    }
    *m = kept;
    uint32_t *const textures[] = {&m->eta_texture, &m->k_texture, &m->displacement_texture};
    for (int i = 0; i < 3; i++) {
        *m = kept;
        m->eta_texture = m->k_texture = m->displacement_texture = SCENE_NO_TEXTURE;
        *textures[i] = 0;
        seen[i] = scene_hash_of_light(s);
        for (int other = 0; other < i; other++)
            assert_false(hash128_is_equal(seen[other], seen[i]));
    }
    *m = kept;
}

static shape *find_shape(scene *s, shape_kind kind)
{
    uint32_t i = 0;
    while (i < s->shape_count && s->shapes[i].kind != kind)
        i++;
    assert_true(i < s->shape_count);
    return &s->shapes[i];
}

static void test_no_word_is_forgotten(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = create(&r, WORLD, CAMERA);
    const size_t as = offsetof(shape, as);

    /* between the kind and the first value lies what scene_add_material works out of the rest */
    WORDS_COUNT(material, &s->materials[s->material_count - 1],
                {sizeof(material_kind), offsetof(material, reflectance) - sizeof(material_kind)},
                {offsetof(material, mixed) + sizeof(uint32_t[2]), 4});
    values_keep_their_names(&s->materials[s->material_count - 1], s);
    WORDS_COUNT(texture, &s->textures.items[0], {0, 0});
    WORDS_COUNT(medium, &s->media[0], FIELD(medium, kind));
    WORDS_COUNT(scene_instance, &s->instances[0], {0, 0});
    /* with more motion segments there would be more vertices or points: see test_mesh_motion.c */
    WORDS_COUNT(shape, find_shape(s, SHAPE_MESH), {as + offsetof(mesh, motion_segments), sizeof(shape)});
    WORDS_COUNT(shape, find_shape(s, SHAPE_DISK), {as + offsetof(quadric, center), sizeof(shape)});
    WORDS_COUNT(shape, find_shape(s, SHAPE_CURVES), {as + offsetof(curves, capacity), sizeof(shape)});

    const shape *mesh_shape = find_shape(s, SHAPE_MESH), *hair = find_shape(s, SHAPE_CURVES);
    const mesh *m = &mesh_shape->as.mesh;
    assert_true(m->normals && m->uvs && m->tangents);
    words_count(s, "positions", m->positions, 9 * sizeof(float), NULL, 0);
    words_count(s, "normals", m->normals, 9 * sizeof(float), NULL, 0);
    words_count(s, "uvs", m->uvs, 6 * sizeof(float), NULL, 0);
    words_count(s, "tangents", m->tangents, 9 * sizeof(float), NULL, 0);
    words_count(s, "indices", m->indices, 3 * sizeof(uint32_t), NULL, 0);
    words_count(s, "curve points", hair->as.curves.points, 4 * sizeof(curve_point), NULL, 0);
    words_count(s, "instance steps", s->instance_steps, sizeof *s->instance_steps, NULL, 0);

    s->camera.is_moving = s->camera.has_screen_window = true;
    memset(&s->camera.motion, 0, sizeof s->camera.motion);
    WORDS_COUNT(camera, &s->camera, {4, 4}, FIELD(camera, tan_half_fov), {offsetof(camera, medium) + 4, 4});
    scene_destroy(s);
    test_run_reset(&r);
}

/* Tests the numbers of a kind of light, up to its last one; pictures and tables follow. Of a goniometric light a gap of
 * 4 bytes lies behind the position. */
#define LIGHT_WORDS_COUNT(source, last)                                                                                \
    WORDS_COUNT(light, l, FIELD(light, kind), FROM(light, power),                                                      \
                {offsetof(light, as) + offsetof(source, last) + sizeof(((source *)0)->last), sizeof(light)},           \
                {offsetof(light, as) + sizeof(vec3), kind == LIGHT_GONIOMETRIC ? 4 : 0})

/* Photons draw other random numbers where any medium in use scatters, so an eye in fog makes other photon maps, though
 * no surface touches the fog. */
static void test_an_eye_in_fog_counts(void **state)
{
    (void)state;
    hash128 outside[2], within[2];
    hashes(EMPTY_WORLD, FOG "Camera \"perspective\"", outside);
    hashes(EMPTY_WORLD, FOG "MediumInterface \"\" \"fog\" Camera \"perspective\"\nMediumInterface \"\" \"\"", within);
    assert_false(hash128_is_equal(outside[0], within[0]));
}

static void test_lights(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = create(&r, WORLD, CAMERA);
    light *l = &s->lights[0], kept = *l;
    rgb pixel = {1.0f, 2.0f, 3.0f};
    projection slide = {.width = 1, .height = 1, .pixels = &pixel};
    hash128 hashes_of[LIGHT_KIND_COUNT];
    for (int kind = 0; kind < LIGHT_KIND_COUNT; kind++) {
        *l = light_make((light_kind)kind);
        switch ((light_kind)kind) {
        case LIGHT_POINT: LIGHT_WORDS_COUNT(point_source, intensity); break;
        case LIGHT_SPOT: LIGHT_WORDS_COUNT(spot_source, dims_by_cosine); break;
        case LIGHT_GONIOMETRIC: LIGHT_WORDS_COUNT(goniometric_source, intensity.world_from_light); break;
        case LIGHT_PROJECTION:
            l->as.projection.picture = &slide;
            LIGHT_WORDS_COUNT(projection_source, intensity);
            break;
        case LIGHT_DISTANT: LIGHT_WORDS_COUNT(distant_source, disc_one_minus_cos); break;
        case LIGHT_AREA: LIGHT_WORDS_COUNT(area_source, radiance_texture); break;
        case LIGHT_INFINITE: LIGHT_WORDS_COUNT(infinite_source, radiance.world_from_light); break;
        case LIGHT_KIND_COUNT: break;
        }
        hashes_of[kind] = scene_hash_of_light(s);
        for (int other = 0; other < kind; other++)
            assert_false(hash128_is_equal(hashes_of[other], hashes_of[kind]));
    }
    *l = kept;
    scene_destroy(s);
    test_run_reset(&r);
}

/* Tests the numbers of a kind of medium, up to its last one; what it owns follows. */
#define MEDIUM_WORDS_COUNT(source, last)                                                                               \
    WORDS_COUNT(medium, m, FIELD(medium, kind),                                                                        \
                {offsetof(medium, as) + offsetof(source, last) + sizeof(((source *)0)->last), sizeof(medium)})

static void test_media(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = create(&r, WORLD, CAMERA);
    medium *m = &s->media[0], kept = *m;
    for (int kind = 0; kind < MEDIUM_KIND_COUNT; kind++) {
        bool is_known = false;
        *m = medium_make((medium_kind)kind);
        switch ((medium_kind)kind) {
        case MEDIUM_HOMOGENEOUS:
            MEDIUM_WORDS_COUNT(homogeneous_parameters, sigma_s);
            is_known = true;
            break;
        case MEDIUM_KIND_COUNT: break;
        }
        if (!is_known)
            fail_msg("nothing here says which numbers medium %d has", kind);
    }
    *m = kept;
    scene_destroy(s);
    test_run_reset(&r);
}

/* Pictures of lights and textures, by pixels and by shape. */
static void test_pixels(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = create(&r, WORLD, CAMERA);
    rgb pixels[2] = {{1.0f, 2.0f, 3.0f}, {4.0f, 5.0f, 6.0f}};
    environment e = {.width = 1, .height = 1, .pixels = pixels};
    projection p = {.width = 1, .height = 1, .pixels = pixels};
    portal door = {.width = 1.0f};
    hash128 before = scene_hash_of_light(s);
    light *l = &s->lights[0], kept = *l;
    l->as.infinite.radiance.picture = &e;
    assert_false(hash128_is_equal(before, scene_hash_of_light(s)));
    words_count(s, "environment pixels", pixels, sizeof *pixels, NULL, 0);
    WORDS_COUNT(environment, &e, {offsetof(environment, height) + 4, sizeof e});
    *l = light_make(LIGHT_PROJECTION);
    l->as.projection.picture = &p;
    words_count(s, "projection pixels", pixels, sizeof *pixels, NULL, 0);
    WORDS_COUNT(projection, &p, FIELD(projection, pixels), FIELD(projection, picks), FROM(projection, integral));
    *l = kept;
    l->as.infinite.portal = &door;
    WORDS_COUNT(portal, &door, FROM(portal, size));
    *l = kept;

    unsigned char bytes[4] = {1, 2, 3, 4};
    float values[1] = {0.5f};
    texture_image picture = {.width = 1, .height = 1, .channel_count = 3, .bytes = bytes}, *pictures[1] = {&picture};
    s->textures.images = pictures;
    s->textures.image_count = 1;
    words_count(s, "bytes", bytes, 1, NULL, 0);
    WORDS_COUNT(texture_image, &picture, FIELD(texture_image, path), FIELD(texture_image, encoding),
                FIELD(texture_image, version), FIELD(texture_image, share),
                {offsetof(texture_image, channel_count), sizeof(uint32_t)}, /* odd: one more would be too many */
                FIELD(texture_image, bytes), FIELD(texture_image, values), {offsetof(texture_image, bytes) - 4, 4},
                FROM(texture_image, alpha_bytes));
    picture = (texture_image){.width = 1, .height = 1, .channel_count = 1, .values = values, .alpha_values = values};
    words_count(s, "values", values, sizeof values, NULL, 0);
    words_count(s, "primaries", s->space.primaries, sizeof s->space.primaries, NULL, 0);
    picture.colors.has_matrix = true;
    words_count(s, "matrix", picture.colors.matrix, sizeof picture.colors.matrix, NULL, 0);
    s->textures.images = NULL;
    s->textures.image_count = 0;
    assert_true(hash128_is_equal(before, scene_hash_of_light(s)));
    scene_destroy(s);
    test_run_reset(&r);
}

/* Close things have far hashes, and pieces do not run into each other. */
static void test_hash128(void **state)
{
    (void)state;
    unsigned char bytes[64] = {0};
    for (size_t size = 0; size <= sizeof bytes; size++)
        for (size_t bit = 0; bit < 8 * size; bit++) {
            hash128 a = hash128_begin(), b = a;
            hash128_add(&a, bytes, size);
            bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
            hash128_add(&b, bytes, size);
            bytes[bit / 8] = 0;
            int differing = __builtin_popcountll(a.bits[0] ^ b.bits[0]) + __builtin_popcountll(a.bits[1] ^ b.bits[1]);
            assert_true(differing > 30 && differing < 98);
        }
    hash128 a = hash128_begin(), b = a, c = a, d = a;
    hash128_add(&a, "ab", 2);
    hash128_add(&a, "c", 1);
    hash128_add(&b, "a", 1);
    hash128_add(&b, "bc", 2);
    assert_false(hash128_is_equal(a, b));
    hash128_add_text(&c, NULL);
    hash128_add_text(&d, "");
    assert_false(hash128_is_equal(c, d));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hash128),
        cmocka_unit_test(test_same_and_other),
        cmocka_unit_test(test_no_word_is_forgotten),
        cmocka_unit_test(test_an_eye_in_fog_counts),
        cmocka_unit_test(test_lights),
        cmocka_unit_test(test_media),
        cmocka_unit_test(test_pixels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
