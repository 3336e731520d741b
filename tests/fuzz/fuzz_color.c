/* fuzz_color.c: OpenColorIO configs: what is accepted lists what it has, and shows a colour on every view as finite or
 * not, but shows it. Flow: bytes -> a file -> [here] -> color_ocio. Threads: one. */
#include "color/color.h"
#include "color/working_space.h"
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

static void use(color_processor *processor)
{
    char message[512];
    float pixels[6] = {0.18f, 0.18f, 0.18f, 4.0f, -0.1f, 0.5f};
    FUZZ_CHECK(color_processor_apply(processor, pixels, 2, message, sizeof message) == AG_OK);
    color_processor_destroy(processor);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char message[512];
    color_config *config;
    color_processor *processor;
    fuzz_enter_folder();
    fuzz_write("c.ocio", data, size);
    if (color_config_create("c.ocio", NULL, NULL, message, sizeof message, &config) != AG_OK) {
        FUZZ_CHECK(message[0] != '\0' && !config);
        return 0;
    }
    char *text = NULL;
    if (color_config_describe(config, message, sizeof message, &text) == AG_OK)
        FUZZ_CHECK(strstr(text, "roles:\n"));
    free(text);
    double from_rec709[9], matrix[9];
    working_space space;
    color_config_from_rec709(config, from_rec709);
    if (working_space_make(from_rec709, &space)) {
        rgb c = working_space_reflectance(&space, rgb_make(0.8f, 0.2f, 0.1f));
        FUZZ_CHECK(c.r >= 0.0f && c.g >= 0.0f && c.b >= 0.0f);
    }
    const color_view plain = {0}, looked = {.look = "Warm, -Flat", .exposure = 1.0f};
    if (color_processor_create(config, &plain, message, sizeof message, &processor) == AG_OK)
        use(processor);
    if (color_processor_create(config, &looked, message, sizeof message, &processor) == AG_OK)
        use(processor);
    color_curve curve;
    const char *rule = color_config_rule(config, "a_log.png");
    if (rule && color_config_study_space(config, rule, message, sizeof message, &curve, matrix) == AG_OK &&
        color_decoder_create(config, rule, message, sizeof message, &processor) == AG_OK)
        use(processor);
    color_config_destroy(config);
    return 0;
}
