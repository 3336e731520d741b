/* fuzz_pbrt.c: the text of a pbrt-v4 scene: lexer, parameters, and every directive's interpreter.
 * Flow: bytes -> [here] -> pbrt_parser. Threads: one. */
#include "fuzz_scene.h"
#include "pbrt/pbrt_parser.h"

#include <string.h>

/* The values of $a, $b and $c. */
static const definition GIVEN[] = {{"a", "1", false, false}, {"b", "[ 0.5 2", false, false}, {"c", "x\"", true, false}};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_enter_folder_with_files();
    fuzz_run run;
    fuzz_run_init(&run);
    scene *s = scene_create();
    FUZZ_CHECK(s);
    definition items[3];
    memcpy(items, GIVEN, sizeof items);
    const definitions given = {items, 3};
    s->definitions = &given;
    ag_status status = pbrt_parse_text(&run.context, "t", (const char *)data, size, s);
    fuzz_check_said(&run, status);
    if (status == AG_OK)
        fuzz_look_at_scene(s, &run);
    scene_destroy(s);
    fuzz_run_reset(&run);
    return 0;
}
