/* fuzz_numbers.c: text files of numbers that a scene names: a spectrum, emitted and reflected, and a lens; plain and
 * gzip. Flow: bytes -> a file -> [here] -> pbrt_colors, spectra, pbrt_realistic. Threads: one. */
#include "fuzz_scene.h"
#include "pbrt/pbrt_parser.h"

#include <string.h>

static void read_scene(const char *text)
{
    fuzz_run run;
    fuzz_run_init(&run);
    scene *s = scene_create();
    FUZZ_CHECK(s);
    ag_status status = pbrt_parse_text(&run.context, "t", text, strlen(text), s);
    fuzz_check_said(&run, status);
    if (status == AG_OK) {
        FUZZ_CHECK(s->camera.lens_radius >= 0.0f);
        fuzz_look_at_scene(s, &run);
    }
    scene_destroy(s);
    fuzz_run_reset(&run);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_enter_folder();
    fuzz_write("n", data, size);
    read_scene("Camera \"perspective\" WorldBegin LightSource \"point\" \"spectrum I\" \"n\"");
    read_scene(
        "Camera \"perspective\" WorldBegin Material \"diffuse\" \"spectrum reflectance\" \"n\" Shape \"sphere\"");
    read_scene("Camera \"realistic\" \"string lensfile\" \"n\" WorldBegin Shape \"sphere\"");
    return 0;
}
