/* fuzz_gltf.c: a glTF 2.0 file, JSON or binary: document, accessors, nodes, materials, lamps, cameras, pictures.
 * Flow: bytes -> a file -> [here] -> gltf_reader. Threads: one. */
#include "fuzz_scene.h"
#include "scene_reader.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_enter_folder_with_files();
    fuzz_write("t.gltf", data, size);
    fuzz_read_scene(gltf_load_file, "t.gltf");
    return 0;
}
