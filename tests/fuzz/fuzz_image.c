/* fuzz_image.c: a picture as texture and as light from everywhere: OpenImageIO decodes it, what it says is ours to
 * judge. Flow: bytes -> a file -> [here] -> image_reader, texture_image, pbrt_environments. Threads: one. */
#include "fuzz_scene.h"
#include "image/image_module_loader.h"
#include "pbrt/pbrt_parser.h"

#include <stdio.h>
#include <string.h>

/* Names formats by their first bytes, as OpenImageIO would find out by trying all of its readers. */
static const char *name_of(const uint8_t *data, size_t size)
{
    static const struct {
        const char *bytes, *name;
    } KINDS[] = {{"\x76\x2f\x31\x01", "a.exr"},
                 {"\x89PNG", "a.png"},
                 {"#?", "a.hdr"},
                 {"P", "a.pfm"},
                 {"II*", "a.tif"},
                 {"MM", "a.tif"},
                 {"\xff\xd8", "a.jpg"}};
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++)
        if (size >= strlen(KINDS[i].bytes) && memcmp(data, KINDS[i].bytes, strlen(KINDS[i].bytes)) == 0)
            return KINDS[i].name;
    return "a.tga";
}

static void read_scene(const char *name, const char *before, const char *behind)
{
    char text[512];
    snprintf(text, sizeof text, "Camera \"perspective\" WorldBegin %s \"string filename\" \"%s\" %s", before, name,
             behind);
    fuzz_run run;
    fuzz_run_init(&run);
    scene *s = scene_create();
    FUZZ_CHECK(s);
    ag_status status = pbrt_parse_text(&run.context, "t", text, strlen(text), s);
    fuzz_check_said(&run, status);
    if (status == AG_OK)
        fuzz_look_at_scene(s, &run);
    scene_destroy(s);
    fuzz_run_reset(&run);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char SPHERE[] = "Material \"diffuse\" \"texture reflectance\" \"i\" Shape \"sphere\"";
    char message[1024];
    fuzz_enter_folder();
    FUZZ_CHECK(image_module_get(message, sizeof message)); /* else there is nothing to look at */
    const char *name = name_of(data, size);
    fuzz_write(name, data, size);
    read_scene(name, "Texture \"i\" \"spectrum\" \"imagemap\"", SPHERE);
    read_scene(name, "Texture \"i\" \"float\" \"imagemap\" \"string encoding\" \"gamma 2\"", "Shape \"sphere\"");
    read_scene(name, "LightSource \"infinite\"", "Shape \"sphere\"");
    remove(name);
    return 0;
}
