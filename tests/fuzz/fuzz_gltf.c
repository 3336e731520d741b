/* fuzz_gltf.c: a glTF 2.0 file, JSON or binary: document, accessors, nodes, materials, lamps, cameras, pictures.
 * Flow: bytes -> a file -> [here] -> gltf_reader. Threads: one. */
#include "fuzz_scene.h"
#include "gltf/gltf_reader.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_enter_folder_with_files();
    fuzz_write("t.gltf", data, size);
    fuzz_run run;
    fuzz_run_init(&run);
    scene *s = scene_create();
    FUZZ_CHECK(s);
    ag_status status = gltf_load_file(&run.context, "t.gltf", s);
    fuzz_check_said(&run, status);
    if (status == AG_OK)
        fuzz_look_at_scene(s, &run);
    scene_destroy(s);
    fuzz_run_reset(&run);
    return 0;
}
