/* test_name_table.c: names are found, replaced, and told apart, however many there are.
 * Threads: one. */
#include "text/name_table.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <string.h>

static void names_are_found_again(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    name_table table;
    memset(&table, 0, sizeof table);
    uint32_t value;
    char name[16];
    assert_false(name_table_find(&table, "n0", &value));
    for (uint32_t i = 0; i < COUNT; i++) {
        snprintf(name, sizeof name, "n%u", (unsigned)i);
        assert_int_equal(name_table_set(&table, name, i), AG_OK);
    }
    assert_int_equal(name_table_set(&table, "n7", 70), AG_OK);
    assert_int_equal(name_table_set(&table, "", 1), AG_OK);
    assert_int_equal(table.count, COUNT + 1);
    for (uint32_t i = 0; i < COUNT; i++) {
        snprintf(name, sizeof name, "n%u", (unsigned)i);
        assert_true(name_table_find(&table, name, &value));
        assert_int_equal(value, i == 7 ? 70 : i);
    }
    assert_true(name_table_find(&table, "", &value));
    assert_false(name_table_find(&table, "n20000", &value));
    name_table_reset(&table);
    assert_false(name_table_find(&table, "n0", &value));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(names_are_found_again)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
