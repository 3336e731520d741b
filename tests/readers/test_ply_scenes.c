/* test_ply_scenes.c: the PLY files of public scenes, where they are there, load whole.
 * Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/shared_folder.h"
#include "fixtures/temporary_folder.h"
#include "model/ply_file.h"

#include <dirent.h>

static int load_folder(const char *path)
{
    int count = 0;
    DIR *directory = opendir(path);
    if (!directory)
        return 0;
    for (const struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        const char *dot = strrchr(entry->d_name, '.');
        char file[1100];
        ply_mesh m;
        if (!dot || strcmp(dot, ".ply") != 0)
            continue;
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        if (ply_file_read(file, NULL, message, sizeof message, &m) != AG_OK)
            fail_msg("%s", message);
        assert_true(m.mesh.vertex_count > 0 && m.mesh.triangle_count > 0);
        assert_int_equal(m.lines + m.odd_vectors, 0);
        vec3 low = m.mesh.positions[0], high = low;
        for (uint32_t i = 0; i < m.mesh.vertex_count; i++) {
            low = vec3_min(low, m.mesh.positions[i]);
            high = vec3_max(high, m.mesh.positions[i]);
        }
        assert_true(vec3_is_finite(low) && vec3_is_finite(high) && vec3_max_abs(vec3_sub(high, low)) > 0.0f);
        for (uint32_t i = 0; i < 3 * m.mesh.triangle_count; i++)
            assert_true(m.mesh.indices[i] < m.mesh.vertex_count);
        ply_mesh_reset(&m);
        count++;
    }
    closedir(directory);
    return count;
}

static void scenes_of_others_load(void **state)
{
    (void)state;
    char path[512];
    int count = 0;
    snprintf(path, sizeof path, "%s/scenes", shared_folder() ? shared_folder() : "none");
    DIR *scenes = opendir(path);
    if (!scenes)
        skip();
    for (const struct dirent *entry = readdir(scenes); entry; entry = readdir(scenes)) {
        char models[800];
        snprintf(models, sizeof models, "%s/%s/models", path, entry->d_name);
        count += load_folder(models);
    }
    closedir(scenes);
    assert_true(count > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_of_others_load),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
