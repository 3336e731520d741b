/* fuzz_obj.c: a Wavefront OBJ file and, behind a line "#MTL", the MTL file that it names t.mtl.
 * Flow: bytes -> two files -> [here] -> obj_file, mtl_file. Threads: one. */
#define _GNU_SOURCE /* memmem */
#include "fuzz_scene.h"
#include "scene_reader.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char MARK[] = "#MTL\n";
    fuzz_enter_folder_with_files();
    const uint8_t *mark = size > 0 ? memmem(data, size, MARK, sizeof MARK - 1) : NULL;
    size_t obj_size = mark ? (size_t)(mark - data) : size;
    fuzz_write("t.obj", data, obj_size);
    fuzz_write("t.mtl", data + obj_size, size - obj_size);
    fuzz_read_scene(obj_load_file, "t.obj");
    return 0;
}
