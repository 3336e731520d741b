/* import_program.c: afterglow-import, which the reader of models starts for each file: assimp in a process of its own.
 * Use: afterglow-import reads EXTENSION: the answer is a byte, 1 or 0
 *      afterglow-import model MEMORY_BYTES PATH: the answer are the records of import_model.h
 *      afterglow-import confined MEMORY_BYTES PATH FOLDER...: reads below these folders alone, and writes nowhere
 * Flow: import_process starts it -> import_worker, import_confinement, mesh_import_assimp. Threads: main alone. */
#include "model/import_confinement.h"
#include "model/import_worker.h"
#include "model/mesh_import_assimp.h"

#include <stdlib.h>
#include <string.h>

/* The memory that is enough to ask whether assimp knows an extension. */
static const uint64_t LITTLE_MEMORY = UINT64_C(1) << 30;

int main(int count, char **arguments)
{
    const bool asks = count == 3 && strcmp(arguments[1], "reads") == 0;
    const bool is_confined = count >= 4 && strcmp(arguments[1], "confined") == 0;
    if (!asks && !is_confined && !(count == 4 && strcmp(arguments[1], "model") == 0))
        return 2;
    FILE *answer = import_worker_begin(asks ? LITTLE_MEMORY : strtoull(arguments[2], NULL, 10));
    if (!answer)
        return 1;
    if (asks)
        import_worker_end(answer, putc(assimp_reads_extension(arguments[2]), answer) != EOF);
    if (is_confined && !import_confine_process(arguments + 4, (size_t)count - 4))
        import_worker_end(
            answer, assimp_write_refusal("a confined scene of this format cannot be read: the kernel has no Landlock "
                                         "to hold assimp in its folder",
                                         answer));
    import_worker_end(answer, assimp_write_records(arguments[3], answer));
}
