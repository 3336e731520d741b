/* test_scene_changes_many.c: ten thousand changes of a scene, each committed and rendered, leave no memory behind.
 * Threads: one. */
#define _GNU_SOURCE
#include "fixtures/changing_scene.h"
#include "fixtures/sanitizer.h"

#include <malloc.h>

static size_t used_bytes(void)
{
    const struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
}

/* A few pixels of it. */
static void glance(desk *d, bool is_by_paths)
{
    ag_render_settings settings;
    ag_film *film;
    assert_int_equal(ag_render_settings_from_scene(d->context, d->made, &settings), AG_OK);
    settings.width = settings.height = 1;
    settings.samples_per_pixel = 1;
    settings.photon_count = settings.caustic_photon_count = 20;
    settings.gather_samples = 1;
    settings.noise_level = 0.0f;
    if (is_by_paths)
        settings.integrator = AG_INTEGRATOR_PATH;
    assert_int_equal(ag_render(d->context, d->made, &settings, &film), AG_OK);
    ag_film_destroy(film);
}

/* The scene is now larger, now smaller: what counts is the least of a while at the beginning, and at the end. */
static void ten_thousand_edits_leave_no_memory_behind(void **state)
{
    (void)state;
    enum { EDITS = IS_SANITIZED ? 200 : 10000, WHILE = EDITS / 5 };
    desk d;
    changing c;
    chance random = {11};
    size_t least[2] = {SIZE_MAX, SIZE_MAX};
    desk_thread_count = 1; /* more take longer for so little work */
    begin_changing(&d, &c);
    for (int i = 0; i < EDITS; i++) {
        change_anything(&d, &c, &random);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        glance(&d, i % 32 != 0); /* maps take a hundred times as long as paths */
        d.said[0] = '\0';
        const size_t used = used_bytes();
        const int when = i < WHILE ? 0 : i >= EDITS - WHILE ? 1 : -1;
        if (when >= 0 && used < least[when])
            least[when] = used;
    }
    print_message("of %d edits the first fifth left %zu bytes in use at the least, the last %zu\n", EDITS, least[0],
                  least[1]);
    if (least[1] > least[0] + 16 * 1024)
        fail_msg("%zu bytes were in use, and %zu are", least[0], least[1]);
    end(&d);
}

int main(int argc, char **argv)
{
    /* without caches of threads, which count as in use whatever is in them */
    static char exact[] = "GLIBC_TUNABLES=glibc.malloc.tcache_count=0";
    (void)argc;
    if (!getenv("GLIBC_TUNABLES") && putenv(exact) == 0)
        execv("/proc/self/exe", argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(ten_thousand_edits_leave_no_memory_behind, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
