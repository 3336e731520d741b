/* test_program_display.c: --display-server: a viewer that speaks tev's protocol is shown the picture while it is
 * rendered, and has the file's pixels in the end; one that is not there, goes, or does not listen costs a warning and
 * no more. Threads: the viewer's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"
#include "fixtures/viewer.h"

static const char *address_of(const viewer *v)
{
    static char text[32];
    snprintf(text, sizeof text, "127.0.0.1:%d", v->port);
    return text;
}

static int count_said(const char *text, const char *what)
{
    int count = 0;
    for (const char *at = strstr(text, what); at; at = strstr(at + 1, what))
        count++;
    return count;
}

static void start(viewer *v)
{
    if (!viewer_start(v))
        fail_msg("no viewer can listen here");
}

/* Stops it; what it was sent last, under a name that begins so, is what the file has. */
static void expect_shown(viewer *v, const char *file, const char *named)
{
    picture expected = picture_read(in_folder(file));
    const viewer_picture *shown = NULL;
    for (int i = 0; i < v->picture_count; i++)
        if (strncmp(v->pictures[i].name, named, strlen(named)) == 0)
            shown = &v->pictures[i];
    assert_string_equal(v->wrong, "");
    if (!shown)
        fail_msg("%s was not shown", named);
    assert_int_equal(shown->width, expected.width);
    assert_int_equal(shown->height, expected.height);
    assert_memory_equal(shown->pixels, expected.pixels,
                        3 * (size_t)expected.width * (size_t)expected.height * sizeof *expected.pixels);
    picture_reset(&expected);
}

static void the_viewer_has_the_files_pixels(void **state)
{
    (void)state;
    const char *scene = PROGRAM_SCENES "glass_and_metal.pbrt";
    viewer v = {0};
    start(&v);
    program_run run = RUN("-q", "--type", "float", "--size", "90x70", "--spp", "16", "--photons", "5000", "-o",
                          "picture.exr", "--display-server", address_of(&v), scene);
    viewer_stop(&v);
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    program_run_reset(&run);
    expect_shown(&v, "picture.exr", "picture.exr (");
    assert_int_equal(v.connections, 1);
    assert_int_equal(v.picture_count, 1);
    assert_in_range(v.packets, 1 + 3 * 9, 100000); /* of 3 by 3 tiles */
    picture unwatched = RENDER(scene, "--size", "90x70", "--spp", "16", "--photons", "5000");
    assert_memory_equal(v.pictures[0].pixels, unwatched.pixels, 3 * 90 * 70 * sizeof *unwatched.pixels);
    picture_reset(&unwatched);
    viewer_reset(&v);
}

static void crops_and_frames_are_shown_too(void **state)
{
    (void)state;
    viewer v = {0};
    start(&v);
    program_run run = RUN("-q", "--type", "float", "--size", "80x60", "--cropwindow", "0.11,0.9,0.13,1", "--integrator",
                          "path", "--spp", "2", "--frames", "4-5", "--seed-per-frame", "-o", "frame%02d.exr",
                          "--display-server", address_of(&v), PROGRAM_SCENES "box_with_blocks.pbrt");
    viewer_stop(&v);
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    program_run_reset(&run);
    expect_shown(&v, "frame04.exr", "frame04.exr (");
    expect_shown(&v, "frame05.exr", "frame05.exr (");
    assert_int_equal(v.connections, 1);
    assert_int_equal(v.picture_count, 2);
    viewer_reset(&v);
}

/* The port was free a moment ago. */
static void a_viewer_that_is_not_there_costs_a_warning(void **state)
{
    (void)state;
    viewer v = {0};
    start(&v);
    viewer_stop(&v);
    const char *arguments[] = {"--display-server",
                               address_of(&v),
                               "--size",
                               "16x16",
                               "--spp",
                               "2",
                               "--frames",
                               "1-2",
                               "-o",
                               "out%d.exr",
                               PROGRAM_SCENES "box_with_blocks.pbrt",
                               NULL,
                               NULL};
    program_run run = program_execute(NULL, arguments);
    expect_exit(&run, 0);
    assert_int_equal(count_said(run.err, "--display-server"), 1);
    assert_int_equal(count_said(run.err, "warning: --display-server 127.0.0.1:"), 1);
    expect_said(&run, "no viewer answers: Connection refused");
    program_run_reset(&run);
    expect_listing("out1.exr out2.exr");
    arguments[11] = "-q";
    run = program_execute(NULL, arguments);
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    program_run_reset(&run);
}

/* The picture is more than a connection can hold at once. */
static program_run render_large_picture(viewer *v)
{
    return RUN("--progress", "none", "--type", "float", "--size", "400x400", "--integrator", "path", "--max-depth", "1",
               "--spp", "1", "-o", "picture.exr", "--display-server", address_of(v), PROGRAM_SCENES "lamp_point.pbrt");
}

/* There is more to be sent than the connection can hold, so the viewer goes while the picture is sent. */
static void a_viewer_that_comes_back_is_shown_all_again(void **state)
{
    (void)state;
    viewer v = {.leaves_after = 2};
    start(&v);
    program_run run = render_large_picture(&v);
    viewer_stop(&v);
    expect_exit(&run, 0);
    assert_int_equal(count_said(run.err, "--display-server"), 1);
    expect_said(&run, "the viewer is lost");
    program_run_reset(&run);
    assert_int_equal(v.connections, 2);
    expect_shown(&v, "picture.exr", "picture.exr (");
    viewer_reset(&v);
}

static void a_viewer_that_does_not_listen_holds_nobody_up(void **state)
{
    (void)state;
    viewer v = {.is_deaf = true};
    start(&v);
    program_run run = render_large_picture(&v);
    viewer_stop(&v);
    expect_exit(&run, 0);
    assert_int_equal(count_said(run.err, "--display-server"), 1);
    expect_said(&run, "the viewer has not taken the whole picture");
    program_run_reset(&run);
    expect_listing("picture.exr");
    viewer_reset(&v);
}

/* A picture of 8 MB, of which the viewer reads a small part. */
static program_process start_for_a_slow_viewer(const viewer *v)
{
    const program_setting usual = {0};
    return program_start(&usual, ARGUMENTS("--progress", "none", "--type", "float", "--size", "800x800", "--integrator",
                                           "path", "--max-depth", "1", "--spp", "1", "-o", "picture.pfm",
                                           "--display-server", address_of(v), PROGRAM_SCENES "lamp_point.pbrt"));
}

static void a_slow_viewer_is_not_waited_for_without_end(void **state)
{
    (void)state;
    viewer v = {.is_slow = true};
    start(&v);
    program_process process = start_for_a_slow_viewer(&v);
    program_run run = program_finish(&process);
    viewer_stop(&v);
    expect_exit(&run, 0);
    expect_said(&run, "the viewer has not taken the whole picture");
    program_run_reset(&run);
    expect_listing("picture.pfm");
}

/* The file is there while the viewer still reads, and a signal then ends the wait, not the picture. */
static void the_file_does_not_wait_for_a_slow_viewer(void **state)
{
    (void)state;
    viewer v = {.is_slow = true};
    start(&v);
    program_process process = start_for_a_slow_viewer(&v);
    siginfo_t info = {0};
    while (access(in_folder("picture.pfm"), F_OK) != 0 && info.si_pid == 0) {
        assert_int_equal(waitid(P_PID, (id_t)process.id, &info, WEXITED | WNOHANG | WNOWAIT), 0);
        program_pause();
    }
    assert_int_equal(waitid(P_PID, (id_t)process.id, &info, WEXITED | WNOHANG | WNOWAIT), 0);
    assert_int_equal(info.si_pid, 0); /* it waits for the viewer */
    assert_true(v.slow_bytes < 800 * 800 * 12 * 3 / 4);
    assert_int_equal(kill(process.id, SIGTERM), 0);
    program_run run = program_finish(&process);
    viewer_stop(&v);
    expect_exit(&run, 0);
    program_run_reset(&run);
    expect_listing("picture.pfm");
    picture written = picture_read(in_folder("picture.pfm"));
    assert_int_equal(written.width, 800);
    picture_reset(&written);
}

/* The queue of its listener is full, so that nobody gets an answer. */
static void a_viewer_that_never_answers_is_not_said_to_be_slow(void **state)
{
    (void)state;
    enum { WAITING = 4 };
    int waiting[WAITING];
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof address;
    viewer v = {.listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    assert_int_equal(bind(v.listener, (const struct sockaddr *)&address, sizeof address), 0);
    assert_int_equal(listen(v.listener, 0), 0);
    assert_int_equal(getsockname(v.listener, (struct sockaddr *)&address, &size), 0);
    v.port = ntohs(address.sin_port);
    for (int i = 0; i < WAITING; i++) {
        waiting[i] = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        connect(waiting[i], (const struct sockaddr *)&address, sizeof address);
    }
    program_run run = RUN("--progress", "none", "--size", "16x16", "--spp", "1", "-o", "picture.exr",
                          "--display-server", address_of(&v), PROGRAM_SCENES "lamp_point.pbrt");
    for (int i = 0; i < WAITING; i++)
        close(waiting[i]);
    close(v.listener);
    expect_exit(&run, 0);
    assert_int_equal(count_said(run.err, "--display-server"), 1);
    expect_said(&run, "no viewer answers");
    program_run_reset(&run);
    expect_listing("picture.exr");
}

static void addresses_are_checked_before_any_work(void **state)
{
    (void)state;
    static const char *const wrong[] = {"",        "host", "host:",     ":14158",   "host:0", "host:65536", "host:-1",
                                        "host:1x", "::1",  "::1:14158", "[]:14158", "[::1]",  "host:1:"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        program_run run = RUN("--display-server", wrong[i], "-o", "out.exr", PROGRAM_SCENES "box_with_blocks.pbrt");
        expect_exit(&run, 2);
        expect_said(&run, "--display-server");
        program_run_reset(&run);
    }
    expect_listing("");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_viewer_has_the_files_pixels, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(crops_and_frames_are_shown_too, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_viewer_that_is_not_there_costs_a_warning, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_viewer_that_comes_back_is_shown_all_again, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_viewer_that_does_not_listen_holds_nobody_up, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_slow_viewer_is_not_waited_for_without_end, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(the_file_does_not_wait_for_a_slow_viewer, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_viewer_that_never_answers_is_not_said_to_be_slow, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(addresses_are_checked_before_any_work, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
