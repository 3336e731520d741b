/* test_material_table.c: which materials share what their kind keeps beside them, and for how long it lives.
 * Threads: one. */
#include "fixtures/test_scene.h"
#include "material/hair.h"
#include "material/material_table.h"

static const material *add(scene *s, const material *item)
{
    uint32_t index;
    assert_int_equal(scene_add_material(s, item, &index), AG_OK);
    return &s->materials[index];
}

static material hair(float beta_m, float sigma_a)
{
    material m = material_make(MATERIAL_HAIR);
    m.ior = 1.55f;
    m.hair_beta_m = beta_m;
    m.hair_sigma_a = rgb_gray(sigma_a);
    return m;
}

static material coated(float alpha)
{
    material m = material_make(MATERIAL_COATED_DIFFUSE);
    m.alpha_u = m.alpha_v = alpha;
    return m;
}

static void fibres_are_shared_whatever_their_colour(void **state)
{
    (void)state;
    const material items[] = {hair(0.3f, 0.1f), hair(0.3f, 2.0f), hair(0.6f, 0.1f), coated(0.2f), hair(0.3f, 0.5f)};
    const void *tables[5];
    scene *s = scene_create();
    assert_non_null(s);
    for (int i = 0; i < 5; i++) {
        tables[i] = add(s, &items[i])->table;
        assert_non_null(tables[i]);
    }
    assert_int_equal(s->material_table_count, 3);
    assert_ptr_equal(tables[0], tables[1]);
    assert_ptr_equal(tables[0], tables[4]);
    assert_ptr_not_equal(tables[0], tables[2]);
    assert_ptr_not_equal(tables[0], tables[3]);
    assert_float_equal(((const hair_fibre *)tables[0])->ior, 1.55, 1e-6);
    scene_destroy(s);
}

static void what_a_fibre_is_made_of_parts_tables(void **state)
{
    (void)state;
    material items[] = {hair(0.3f, 0.1f), hair(0.3f, 0.1f), hair(0.3f, 0.1f), hair(0.3f, 0.1f)};
    items[1].ior = 1.4f;
    items[2].hair_beta_n = 0.7f;
    items[3].hair_tilt_degrees = 3.0f;
    scene *s = scene_create();
    assert_non_null(s);
    for (uint32_t i = 0; i < 4; i++) {
        add(s, &items[i]);
        assert_int_equal(s->material_table_count, i + 1);
    }
    scene_destroy(s);
}

static void kinds_without_a_table_have_none(void **state)
{
    (void)state;
    const material plain = material_make(MATERIAL_DIFFUSE);
    material smooth = material_make(MATERIAL_COATED_CONDUCTOR); /* smooth on smooth is in closed form */
    smooth.eta = rgb_gray(0.2f), smooth.k = rgb_gray(3.0f);
    scene *s = scene_create();
    assert_non_null(s);
    assert_null(add(s, &plain)->table);
    assert_null(add(s, &smooth)->table);
    assert_int_equal(s->material_table_count, 0);
    scene_destroy(s);
}

/* A scene that takes another one's place keeps its tables, which outlive it. */
static void tables_pass_on_to_the_next_scene(void **state)
{
    (void)state;
    const material items[] = {hair(0.3f, 0.1f), coated(0.2f)};
    scene *first = scene_create(), *second = scene_create();
    assert_true(first && second);
    const void *tables[2];
    for (int i = 0; i < 2; i++)
        tables[i] = add(first, &items[i])->table;
    scene_set_before(second, first);
    const material other = coated(0.4f);
    for (int i = 1; i >= 0; i--)
        assert_ptr_equal(add(second, &items[i])->table, tables[i]);
    assert_non_null(add(second, &other)->table);
    assert_int_equal(second->material_table_count, 3);
    scene_set_before(second, NULL);
    scene_destroy(first);
    assert_float_equal(((const hair_fibre *)tables[0])->ior, 1.55, 1e-6); /* read after free where it was not held */
    scene_destroy(second);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fibres_are_shared_whatever_their_colour),
        cmocka_unit_test(what_a_fibre_is_made_of_parts_tables),
        cmocka_unit_test(kinds_without_a_table_have_none),
        cmocka_unit_test(tables_pass_on_to_the_next_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
