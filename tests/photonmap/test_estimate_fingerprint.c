/* test_estimate_fingerprint.c: the fingerprint of photons and estimates that a photon map's file keeps: the same for
 * any number of threads and any ISA of ray traversal, another for every other estimate, however little it differs and
 * wherever, and for photons that are traced otherwise.
 * Threads: one and several. */
#include "fixtures/photon_field.h"

#include "estimate_fingerprint.h"

static hash128 fingerprint_by(unsigned threads, const char *isa, photon_tracing_fn *trace, irradiance_estimate_fn *find)
{
    test_run r;
    hash128 hash;
    test_run_init(&r, threads);
    assert_int_equal(estimate_fingerprint(&r.run, isa, trace, find, &hash), AG_OK);
    assert_int_equal(r.warning_count, 0);
    test_run_reset(&r);
    return hash;
}

static hash128 fingerprint(unsigned threads, const char *isa, irradiance_estimate_fn *find)
{
    return fingerprint_by(threads, isa, photon_tracing_run, find);
}

static void same_for_threads_and_isas(void **state)
{
    (void)state;
    hash128 one = fingerprint(1, "avx2", irradiance_estimate_find);
    assert_true(hash128_is_equal(one, fingerprint(1, "avx2", irradiance_estimate_find)));
    assert_true(hash128_is_equal(one, fingerprint(4, "avx2", irradiance_estimate_find)));
    assert_true(hash128_is_equal(one, fingerprint(3, "sse2", irradiance_estimate_find)));
}

/* Count calls of without_surfaces, those that give another value, and how far the map's own estimates hold. */
static int calls, at_rims, of_extent[IRRADIANCE_HOLDS_EVERYWHERE + 1];

/* The estimate of irradiance, brighter by one unit in the last place. */
static irradiance_extent brighter(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                                  uint64_t *in_out_rays, rgb *out)
{
    irradiance_extent extent = irradiance_estimate_find(map, position, normal, scratch, in_out_rays, out);
    out->g = nextafterf(out->g, INFINITY);
    return extent;
}

/* A photon less in each estimate. */
static irradiance_extent of_fewer(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                                  uint64_t *in_out_rays, rgb *out)
{
    photon_map other = *map;
    other.nearest--;
    return irradiance_estimate_find(&other, position, normal, scratch, in_out_rays, out);
}

/* Blind to where surfaces end: what lies in the open stays as it is. */
static irradiance_extent without_surfaces(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                                          uint64_t *in_out_rays, rgb *out)
{
    photon_map other = *map;
    rgb with;
    other.surfaces = NULL;
    of_extent[irradiance_estimate_find(map, position, normal, scratch, in_out_rays, &with)]++;
    irradiance_extent extent = irradiance_estimate_find(&other, position, normal, scratch, in_out_rays, out);
    calls++;
    at_rims += map->surfaces && memcmp(&with, out, sizeof with) != 0;
    return extent;
}

/* An estimate with the map's own values that says they hold everywhere. */
static irradiance_extent sure(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                              uint64_t *in_out_rays, rgb *out)
{
    irradiance_estimate_find(map, position, normal, scratch, in_out_rays, out);
    return IRRADIANCE_HOLDS_EVERYWHERE;
}

/* Brighter by one unit in the last place in maps that are steady. */
static irradiance_extent brighter_if_steady(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                                            uint64_t *in_out_rays, rgb *out)
{
    irradiance_extent extent = irradiance_estimate_find(map, position, normal, scratch, in_out_rays, out);
    if (map->is_steady)
        out->g = nextafterf(out->g, INFINITY);
    return extent;
}

static void depends_on_the_estimate(void **state)
{
    (void)state;
    static irradiance_estimate_fn *const OTHERS[] = {brighter, brighter_if_steady, of_fewer, without_surfaces, sure};
    hash128 one = fingerprint(1, "avx2", irradiance_estimate_find);
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++)
        if (hash128_is_equal(one, fingerprint(1, "avx2", OTHERS[i])))
            fail_msg("the fingerprint does not tell estimate %zu from ours", i);
    assert_true(at_rims > calls / 16); /* at many points, and not at all of them */
    assert_true(at_rims < calls / 2);
    for (int i = 0; i <= IRRADIANCE_HOLDS_EVERYWHERE; i++)
        assert_true(of_extent[i] > calls / 64); /* rules that are never met would not be in the fingerprint */
}

/* --- tracing --- */

/* One thing that photons are traced by, changed. The scene is a copy with lights, materials and shapes of its own; rays
 * meet the shapes that the tree has, whatever the copy says. */
typedef void tracing_change(scene *s, photon_tracing_settings *settings);

static void without_panes(scene *s, photon_tracing_settings *t) { (void)s, t->panes_are_direct = false; }
static void without_filter(scene *s, photon_tracing_settings *t) { (void)s, t->filters_textures = false; }
static void with_bounded_media(scene *s, photon_tracing_settings *t) { (void)s, t->media_are_bounded = true; }
static void shorter(scene *s, photon_tracing_settings *t) { (void)s, t->max_scatterings--; }
static void with_fewer_stored(scene *s, photon_tracing_settings *t) { (void)s, t->stored_share *= 0.75f; }
static void with_fewer_parts(scene *s, photon_tracing_settings *t)
{
    (void)s;
    if (t->kind == PHOTON_GLOBAL)
        t->split_above *= 2.0f;
}
static void with_fewer_caustic_parts(scene *s, photon_tracing_settings *t) { (void)s, t->caustic_root *= 0.5f; }
static void without_ways(scene *s, photon_tracing_settings *t) { (void)s, t->ways = NULL; }
static void without_guide(scene *s, photon_tracing_settings *t) { (void)s, t->guide = NULL; }
static void unasked(scene *s, photon_tracing_settings *t)
{
    static const importance_map NOTHING;
    (void)s, t->asked = t->asked ? &NOTHING : NULL;
}
static void unscattered(scene *s, photon_tracing_settings *t) { (void)t, s->has_scattering_media = false; }
static void denser(scene *s, photon_tracing_settings *t)
{
    (void)t;
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (s->shapes[i].alpha < 1.0f)
            s->shapes[i].alpha *= 1.5f;
}
static void without_holes(scene *s, photon_tracing_settings *t)
{
    (void)t;
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (s->shapes[i].alpha_texture != SCENE_NO_TEXTURE)
            s->shapes[i].alpha = 0.5f, s->shapes[i].alpha_texture = SCENE_NO_TEXTURE;
}

static uint32_t number; /* of the light, or the material */

static void with_other_light(scene *s, photon_tracing_settings *t)
{
    light *l = &s->lights[number];
    (void)t;
    switch (l->kind) {
    case LIGHT_DISTANT: l->as.distant.irradiance = rgb_gray(1.0f); break;
    case LIGHT_AREA: l->as.area.radiance = rgb_gray(1.0f); break;
    case LIGHT_INFINITE: l->as.infinite.radiance.value = rgb_gray(1.0f); break;
    default: l->as.point.position.x += 0.125f; break;
    }
}

static void with_other_material(scene *s, photon_tracing_settings *t)
{
    (void)t;
    s->materials[number] = material_make(MATERIAL_DIFFUSE);
    s->materials[number].reflectance = rgb_gray(0.25f);
    material_prepare(&s->materials[number]);
}

static tracing_change *change;
static uint32_t light_count, material_count; /* of the built-in scene */

static ag_status trace_changed(const scene *s, run_context *run, const photon_tracing_settings *settings,
                               photon_set *out_set)
{
    scene copy = *s;
    photon_tracing_settings other = *settings;
    light_count = s->light_count, material_count = s->material_count;
    copy.lights = malloc(s->light_count * sizeof *s->lights);
    copy.materials = malloc(s->material_count * sizeof *s->materials);
    copy.shapes = malloc(s->shape_count * sizeof *s->shapes);
    assert_true(copy.lights && copy.materials && copy.shapes);
    memcpy(copy.lights, s->lights, s->light_count * sizeof *s->lights);
    memcpy(copy.materials, s->materials, s->material_count * sizeof *s->materials);
    memcpy(copy.shapes, s->shapes, s->shape_count * sizeof *s->shapes);
    change(&copy, &other);
    ag_status status = photon_tracing_run(&copy, run, &other, out_set);
    free(copy.lights), free(copy.materials), free(copy.shapes);
    return status;
}

static bool is_noticed(tracing_change *what)
{
    change = what;
    return !hash128_is_equal(fingerprint(1, "avx2", irradiance_estimate_find),
                             fingerprint_by(1, "avx2", trace_changed, irradiance_estimate_find));
}

static void nothing(scene *s, photon_tracing_settings *t) { (void)s, (void)t; }

/* The fingerprint notices when tracing treats any one of these otherwise. */
static void depends_on_tracing(void **state)
{
    (void)state;
    static tracing_change *const CHANGES[] = {without_panes,
                                              without_filter,
                                              with_bounded_media,
                                              shorter,
                                              with_fewer_stored,
                                              with_fewer_parts,
                                              with_fewer_caustic_parts,
                                              without_ways,
                                              without_guide,
                                              unasked,
                                              unscattered,
                                              denser,
                                              without_holes};
    assert_false(is_noticed(nothing));
    for (size_t i = 0; i < sizeof CHANGES / sizeof *CHANGES; i++)
        if (!is_noticed(CHANGES[i]))
            fail_msg("change %zu is not noticed", i);
    assert_true(light_count >= 5 && material_count >= 8);
    for (number = 0; number < light_count; number++)
        if (!is_noticed(with_other_light))
            fail_msg("light %u sends no photons", number);
    for (number = 0; number < material_count; number++)
        if (!is_noticed(with_other_material))
            fail_msg("material %u has no photons", number);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_for_threads_and_isas),
                                       cmocka_unit_test(depends_on_the_estimate), cmocka_unit_test(depends_on_tracing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
