/* test_program_texture_cache.c: pictures kept in a folder between runs: the same bits with it and without, from its
 * files and while they are made, by many processes at once, after kills, changes, damage and a bound; a folder that
 * cannot be written is told. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_textures.h"
#include "math/rng.h"

#include <dirent.h>
#include <signal.h>
#include <sys/stat.h>

enum { SIDE = 1300 };

static void write_pictures(uint64_t seed)
{
    float *pixels = malloc((size_t)SIDE * SIDE * 4 * sizeof *pixels);
    assert_non_null(pixels);
    for (int i = 0; i < 4 * SIDE * SIDE; i++) {
        rng random = rng_make(1, seed, (uint64_t)i);
        pixels[i] = i / (4 * SIDE) % 64 < 32 ? rng_float(&random) : 0.25f; /* some tiles can be packed */
    }
    write_square("bytes.png", SIDE, 4, IMAGE_UINT8, pixels);
    write_square("floats.exr", SIDE, 3, IMAGE_FLOAT, pixels);
    free(pixels);
}

static const char *room(uint64_t seed)
{
    write_pictures(seed);
    return write_room_of("bytes.png", "floats.exr");
}

#define SETTINGS "--integrator=path", "--max-depth=2", "--noise=0", "--spp=1", "--texture-memory=18M"
#define KEPT     SETTINGS, "--texture-cache=kept"

static void expect_same(const picture *a, const picture *b)
{
    assert_memory_equal(a->pixels, b->pixels, 3 * (size_t)a->width * (size_t)a->height * sizeof *a->pixels);
}

/* Writes the paths of the folder's files, as many as there is room for; gives how many there are. All are whole. */
static int list_kept(char out_paths[][512], int room_for)
{
    char kept[256];
    snprintf(kept, sizeof kept, "%s", in_folder("kept"));
    DIR *all = opendir(kept);
    int count = 0;
    assert_non_null(all);
    for (struct dirent *entry; (entry = readdir(all));) {
        if (entry->d_name[0] == '.' && strspn(entry->d_name, ".") == strlen(entry->d_name))
            continue;
        assert_non_null(strstr(entry->d_name, ".afterglow-tiles"));
        if (count < room_for)
            snprintf(out_paths[count], 512, "%s/%s", kept, entry->d_name);
        count++;
    }
    closedir(all);
    return count;
}

/* A whole run, whose standard error is looked at. */
static picture render_told(const char *scene, const char *const *arguments, const char *told)
{
    program_run run = program_execute(NULL, arguments);
    (void)scene;
    expect_exit(&run, 0);
    if (told)
        expect_said(&run, told);
    program_run_reset(&run);
    return picture_read(in_folder("told.exr"));
}

#define RENDER_TOLD(scene, told, ...)                                                                                  \
    render_told(scene, ARGUMENTS(__VA_ARGS__, "-v", "--type=float", "-o", "told.exr", scene), told)

static void test_same_bits(void **state)
{
    (void)state;
    const char *scene = room(1);
    char paths[4][512];
    picture whole = RENDER(scene, SETTINGS, "--texture-memory=0"), temporary = RENDER(scene, SETTINGS),
            first = RENDER_TOLD(scene, "of tiles are kept in", KEPT),
            second = RENDER_TOLD(scene, "of tiles are in", KEPT, "--nthreads=7", "--stats=second.json");
    expect_same(&temporary, &whole);
    expect_same(&first, &whole);
    expect_same(&second, &whole);
    assert_int_equal(list_kept(paths, 4), 2);
    json_t *stats = stats_read(in_folder("second.json"));
    assert_int_equal(stats_integer(stats, "texture.file_bytes"), 0);
    json_decref(stats);
    program_run plan = RUN(SETTINGS, "--dry-run", scene);
    expect_exit(&plan, 0);
    assert_non_null(strstr(plan.out, "textures, in $TMPDIR"));
    program_run_reset(&plan);
    plan = RUN(KEPT, "--dry-run", scene);
    expect_exit(&plan, 0);
    assert_null(strstr(plan.out, "textures, in $TMPDIR"));
    program_run_reset(&plan);
    /* a map that was made from one holds for the other */
#define WITH_MAP "--integrator=photonmap", "--photons=1e3", "--gather-samples=4", "--photon-map=a.map"
    picture with_map = RENDER(scene, KEPT, WITH_MAP), again = RENDER(scene, SETTINGS, WITH_MAP);
    expect_same(&with_map, &again);
    /* pictures that have changed, under the same names */
    (void)room(2);
    picture changed = RENDER(scene, SETTINGS), kept = RENDER_TOLD(scene, "of tiles are kept in", KEPT);
    expect_same(&kept, &changed);
    assert_true(memcmp(kept.pixels, whole.pixels, 3 * 24 * 24 * sizeof *kept.pixels) != 0);
    assert_int_equal(list_kept(paths, 4), 4);
    picture *all[] = {&whole, &temporary, &first, &second, &with_map, &again, &changed, &kept};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        picture_reset(all[k]);
}

static void flip_byte(const char *path, long at)
{
    FILE *file = fopen(path, "r+");
    assert_non_null(file);
    assert_int_equal(fseek(file, at, at < 0 ? SEEK_END : SEEK_SET), 0);
    const int byte = fgetc(file);
    assert_int_equal(fseek(file, at, at < 0 ? SEEK_END : SEEK_SET), 0);
    assert_int_equal(fputc(byte ^ 4, file), byte ^ 4);
    assert_int_equal(fclose(file), 0);
}

/* Of a damaged file either nothing is used, or the damaged tile ends the run; the next one makes it anew. */
static void test_damage(void **state)
{
    (void)state;
    const char *scene = room(1);
    char paths[3][512];
    picture whole = RENDER(scene, SETTINGS);
    for (int damage = 0; damage < 4; damage++) {
        picture made = RENDER(scene, KEPT);
        expect_same(&made, &whole);
        picture_reset(&made);
        assert_int_equal(list_kept(paths, 3), 2);
        for (int k = 0; k < 2; k++) {
            struct stat file;
            assert_int_equal(stat(paths[k], &file), 0);
            if (damage == 0)
                assert_int_equal(truncate(paths[k], file.st_size / 2), 0);
            else if (damage == 1)
                flip_byte(paths[k], 70); /* of the header */
            else if (damage == 2)
                flip_byte(paths[k], -3); /* of the parts */
            else
                for (long at = 4096; at < (long)file.st_size - 100000; at += 4096)
                    flip_byte(paths[k], at);
        }
        program_run run = RUN(KEPT, "--type=float", "-o", "damaged.exr", scene);
        if (damage == 3) {
            expect_exit(&run, 1);
            expect_said(&run, "are damaged, and are removed");
            assert_true(list_kept(paths, 3) < 2);
            assert_true(access(in_folder("damaged.exr"), F_OK) != 0);
        } else {
            expect_exit(&run, 0);
            picture now = picture_read(in_folder("damaged.exr"));
            assert_int_equal(unlink(in_folder("damaged.exr")), 0);
            expect_same(&now, &whole);
            picture_reset(&now);
        }
        program_run_reset(&run);
    }
    picture_reset(&whole);
}

/* Files that do not say whether theirs was the first of several pictures are made anew. */
static void test_earlier_files(void **state)
{
    (void)state;
    static const char EARLIER[8] = "AGTILES";
    const char *scene = room(1);
    char paths[3][512];
    picture whole = RENDER_TOLD(scene, "of tiles are kept in", KEPT),
            again = RENDER_TOLD(scene, "of tiles are in", KEPT);
    expect_same(&again, &whole);
    assert_int_equal(list_kept(paths, 3), 2);
    for (int k = 0; k < 2; k++) {
        FILE *file = fopen(paths[k], "r+");
        assert_non_null(file);
        assert_int_equal(fwrite(EARLIER, 1, sizeof EARLIER, file), sizeof EARLIER);
        assert_int_equal(fclose(file), 0);
    }
    picture anew = RENDER_TOLD(scene, "of tiles are kept in", KEPT);
    expect_same(&anew, &whole);
    assert_int_equal(list_kept(paths, 3), 2);
    picture_reset(&whole);
    picture_reset(&again);
    picture_reset(&anew);
}

/* Pictures are removed until the folder is within its bound, the longest unused first. A picture that is larger than
 * the bound is not kept. */
static void test_bound(void **state)
{
    (void)state;
    const char *scene = room(1);
    char paths[4][512];
    picture whole = RENDER(scene, SETTINGS),
            small = RENDER_TOLD(scene, "they are more than --texture-cache-size", KEPT, "--texture-cache-size=1M");
    expect_same(&small, &whole);
    assert_int_equal(list_kept(paths, 4), 0);
    picture some = RENDER(scene, KEPT, "--texture-cache-size=30M"); /* one of floats takes some 25 */
    expect_same(&some, &whole);
    long long bytes = 0;
    const int count = list_kept(paths, 4);
    for (int k = 0; k < count; k++) {
        struct stat file;
        assert_int_equal(stat(paths[k], &file), 0);
        bytes += file.st_size;
    }
    assert_true(count >= 1 && bytes <= 30 << 20);
    picture_reset(&whole);
    picture_reset(&small);
    picture_reset(&some);
}

static void test_no_folder(void **state)
{
    (void)state;
    const char *scene = room(1);
    picture whole = RENDER(scene, SETTINGS);
    write_text("file", "no folder\n");
    static const char *const FOLDERS[] = {"--texture-cache=file", "--texture-cache=there/is/none"};
    for (int k = 0; k < 2; k++) {
        picture p = RENDER_TOLD(scene, "textures cannot be kept in the folder", SETTINGS, FOLDERS[k]);
        expect_same(&p, &whole);
        picture_reset(&p);
    }
    program_run run = RUN(SETTINGS, "--texture-cache=", "-o", "x.exr", scene);
    expect_exit(&run, 2);
    program_run_reset(&run);
    /* a disk that is full: what lies in the temporary file is bounded likewise, so that this fails, too */
    const program_setting full = {.file_size_limit = 1 << 20};
    run = program_execute(&full, ARGUMENTS(KEPT, "-o", "x.exr", scene));
    assert_true(run.exit_code > 0);
    program_run_reset(&run);
    char paths[1][512];
    assert_int_equal(list_kept(paths, 1), 0);
    picture_reset(&whole);
}

/* Several at once, of which some are killed on the way: no file is left unfinished, and pictures have their bits. */
static void test_crowd(void **state)
{
    (void)state;
    enum { ROUNDS = 3, CROWD = 3 };
    const program_setting usual = {0};
    const char *scene = room(1);
    char paths[4][512], names[CROWD][32];
    picture whole = RENDER(scene, SETTINGS);
    for (int round = 0; round < ROUNDS; round++) {
        program_process crowd[CROWD];
        for (int k = 0; k < CROWD; k++) {
            snprintf(names[k], sizeof names[k], "%d.exr", k);
            crowd[k] = program_start(&usual, ARGUMENTS(KEPT, "--type=float", "-q", "-o", names[k], scene));
        }
        for (int k = 0; k < 150 * round; k++)
            program_pause();
        for (int k = 0; k < CROWD; k++) {
            if (k > 0)
                kill(crowd[k].id, SIGKILL);
            program_run run = program_finish(&crowd[k]);
            assert_true(run.exit_code == 0 || (k > 0 && run.signal == SIGKILL));
            if (run.exit_code == 0) {
                picture p = picture_read(in_folder(names[k]));
                expect_same(&p, &whole);
                picture_reset(&p);
            }
            program_run_reset(&run);
        }
        assert_int_equal(list_kept(paths, 4), 2);
        for (int k = 0; k < 2 && round % 2; k++)
            assert_int_equal(unlink(paths[k]), 0);
    }
    picture_reset(&whole);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_same_bits), TEST_IN_FOLDER(test_damage),    TEST_IN_FOLDER(test_earlier_files),
        TEST_IN_FOLDER(test_bound),     TEST_IN_FOLDER(test_no_folder), TEST_IN_FOLDER(test_crowd),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
