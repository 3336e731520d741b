/* fuzz_ply.c: a PLY file: header, ascii and both binary forms, plain and gzip.
 * Flow: bytes -> a file -> [here] -> ply_file. Threads: one. */
#include "fuzz.h"
#include "model/ply_file.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char error[768] = "";
    ply_mesh read;
    fuzz_enter_folder();
    fuzz_write("a.ply", data, size);
    ag_status status = ply_file_read("a.ply", NULL, error, sizeof error, &read);
    FUZZ_CHECK(status == AG_OK || status == AG_ERROR_MEMORY || (status == AG_ERROR_INPUT && strlen(error) > 8));
    for (size_t i = 0; i < 3 * (size_t)read.mesh.triangle_count; i++)
        FUZZ_CHECK(read.mesh.indices[i] < read.mesh.vertex_count);
    for (uint32_t i = 0; i < read.mesh.vertex_count; i++)
        FUZZ_CHECK(vec3_is_finite(read.mesh.positions[i]));
    ply_mesh_reset(&read);
    return 0;
}
