/* color_view_ocio.cpp: ways from colour space to colour space, and from the working space to displays.
 * Flow: see color.h. Threads: see color.h. */
#include "color/color_ocio_private.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <strings.h>

using namespace ag_color;

struct color_processor {
    struct log_sink *log;             /* the config's */
    OCIO::ConstCPUProcessorRcPtr cpu; /* nullptr: the stages do it */
    stages in_stages;
    float factor; /* of the values that go in */
};

namespace ag_color
{

OCIO::ColorSpaceTransformRcPtr space_transform(const std::string &from, const std::string &to)
{
    const OCIO::ColorSpaceTransformRcPtr transform = OCIO::ColorSpaceTransform::Create();
    transform->setSrc(from.c_str());
    transform->setDst(to.c_str());
    return transform;
}

OCIO::ConstCPUProcessorRcPtr exact_processor(const OCIO::ConstConfigRcPtr &config,
                                             const OCIO::ConstTransformRcPtr &transform)
{
    return config->getProcessor(transform)->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS);
}

void set_unit_matrix(double matrix[9])
{
    for (int i = 0; i < 9; i++)
        matrix[i] = i % 4 == 0 ? 1.0 : 0.0;
}

/* The matrix of a transform, row by row; false where it is none. Brightest is tried far above white, where curves that
 * end in a straight line would show. */
bool find_matrix(const OCIO::ConstCPUProcessorRcPtr &cpu, double out_matrix[9])
{
    float zero[3] = {0.0f, 0.0f, 0.0f};
    cpu->applyRGB(zero);
    for (int c = 0; c < 3; c++) {
        float unit[3] = {c == 0 ? 1.0f : 0.0f, c == 1 ? 1.0f : 0.0f, c == 2 ? 1.0f : 0.0f};
        cpu->applyRGB(unit);
        for (int i = 0; i < 3; i++)
            out_matrix[3 * i + c] = unit[i];
    }
    static const float tried[][3] = {
        {0.18f, 0.18f, 0.18f}, {0.9f, 0.02f, 0.4f}, {0.001f, 0.6f, 0.05f}, {3.0f, 7.0f, 1.5f}, {90.0f, 20.0f, 60.0f}};
    for (const auto &color : tried) {
        float out[3] = {color[0], color[1], color[2]};
        cpu->applyRGB(out);
        const double largest = std::max({color[0], color[1], color[2]});
        for (int i = 0; i < 3; i++) {
            double expected = 0.0;
            for (int c = 0; c < 3; c++)
                expected += out_matrix[3 * i + c] * static_cast<double>(color[c]);
            if (!(std::fabs(expected - static_cast<double>(out[i])) <= 1e-4 * largest))
                return false;
        }
    }
    return std::fabs(zero[0]) + std::fabs(zero[1]) + std::fabs(zero[2]) < 1e-6f;
}

} // namespace ag_color

namespace
{

/* Every look named is one of the config's; in OpenColorIO's own form, names with + or - before them. */
std::string chosen_looks(const OCIO::ConstConfigRcPtr &config, const char *text)
{
    std::istringstream rest(text);
    std::string part, looks;
    while (std::getline(rest, part, ',')) {
        const size_t begin = part.find_first_not_of(" +-"), end = part.find_last_not_of(' ');
        const size_t sign = part.find_first_not_of(' ');
        const std::string name = begin == std::string::npos ? "" : part.substr(begin, end - begin + 1);
        const bool is_undone = sign != std::string::npos && part[sign] == '-';
        looks += looks.empty() ? "" : ", ";
        looks += (is_undone ? "-" : "+") + chosen("look", name.c_str(), all_looks(config));
    }
    return looks;
}

/* A display and a view, never a bare hop between colour spaces: the view carries the tone curve. By the pipeline of the
 * tools, so that looks are where they have them. */
OCIO::ConstProcessorRcPtr display_processor(const color_config *self, const color_view &wanted)
{
    const OCIO::ConstConfigRcPtr &config = self->config;
    const std::vector<std::string> displays = all_displays(config);
    const std::string display =
        chosen("display", wanted.display ? wanted.display : config->getDefaultDisplay(), displays);
    const std::string default_view = config->getDefaultView(display.c_str(), self->working_space.c_str());
    const std::string view = chosen("view", wanted.view ? wanted.view : default_view.c_str(),
                                    all_views(config, display.c_str()), "display '" + display + "'");
    const OCIO::DisplayViewTransformRcPtr to_display = OCIO::DisplayViewTransform::Create();
    to_display->setSrc(self->working_space.c_str());
    to_display->setDisplay(display.c_str());
    to_display->setView(view.c_str());
    const OCIO::LegacyViewingPipelineRcPtr pipeline = OCIO::LegacyViewingPipeline::Create();
    pipeline->setDisplayViewTransform(to_display);
    if (wanted.look) {
        pipeline->setLooksOverrideEnabled(true);
        pipeline->setLooksOverride(strcasecmp(wanted.look, "none") == 0 ? ""
                                                                        : chosen_looks(config, wanted.look).c_str());
    }
    return pipeline->getProcessor(config, config->getCurrentContext());
}

/* Whether a space is the sRGB curve and a matrix behind it, which is then found; by trying. */
bool find_srgb_matrix(const OCIO::ConstCPUProcessorRcPtr &cpu, double out_matrix[9])
{
    const auto decoded = [](float v) {
        return v <= 0.04045f ? static_cast<double>(v) / 12.92 : std::pow((static_cast<double>(v) + 0.055) / 1.055, 2.4);
    };
    for (int c = 0; c < 3; c++) {
        float unit[3] = {c == 0 ? 1.0f : 0.0f, c == 1 ? 1.0f : 0.0f, c == 2 ? 1.0f : 0.0f};
        cpu->applyRGB(unit);
        for (int i = 0; i < 3; i++)
            out_matrix[3 * i + c] = unit[i];
    }
    for (int tried = 0; tried <= 64; tried++) {
        const float color[3] = {static_cast<float>(tried) / 64.0f, static_cast<float>(tried * 37 % 65) / 64.0f,
                                static_cast<float>(tried * 11 % 65) / 64.0f};
        float out[3] = {color[0], color[1], color[2]};
        cpu->applyRGB(out);
        for (int i = 0; i < 3; i++) {
            double expected = 0.0;
            for (int c = 0; c < 3; c++)
                expected += out_matrix[3 * i + c] * decoded(color[c]);
            if (!(std::fabs(expected - static_cast<double>(out[i])) <= 2e-5))
                return false;
        }
    }
    return true;
}

/* Makes a processor of what the work puts into it. */
template <typename Work>
ag_status create_processor(const color_config *config, char *message, size_t message_size,
                           color_processor **out_processor, Work &&work) noexcept
{
    *out_processor = nullptr;
    color_processor *self = new (std::nothrow) color_processor();
    if (!self) {
        put_message(message, message_size, ag_status_text(AG_ERROR_MEMORY));
        return AG_ERROR_MEMORY;
    }
    self->log = config->log;
    const ag_status status = guarded(self->log, message, message_size, [self, &work] { work(*self); });
    if (status == AG_OK)
        *out_processor = self;
    else
        delete self;
    return status;
}

} // namespace

extern "C" ag_status color_config_study_space(const color_config *config, const char *space, char *message,
                                              size_t message_size, color_curve *out_curve, double out_matrix[9])
{
    return guarded(config->log, message, message_size, [config, space, out_curve, out_matrix] {
        const OCIO::ConstColorSpaceRcPtr from = space_of(config->config, space);
        *out_curve = COLOR_CURVE_DATA;
        set_unit_matrix(out_matrix);
        if (from->isData())
            return;
        const OCIO::ConstCPUProcessorRcPtr cpu =
            exact_processor(config->config, space_transform(from->getName(), config->working_space));
        *out_curve = find_matrix(cpu, out_matrix)        ? COLOR_CURVE_LINEAR
                     : find_srgb_matrix(cpu, out_matrix) ? COLOR_CURVE_SRGB
                                                         : COLOR_CURVE_OTHER;
        if (*out_curve == COLOR_CURVE_OTHER)
            set_unit_matrix(out_matrix);
    });
}

extern "C" ag_status color_processor_create(const color_config *config, const color_view *view, char *message,
                                            size_t message_size, color_processor **out_processor)
{
    return create_processor(config, message, message_size, out_processor, [config, view](color_processor &self) {
        self.in_stages = stages(config->config, display_processor(config, *view));
        self.factor = std::exp2(view->exposure);
    });
}

extern "C" ag_status color_decoder_create(const color_config *config, const char *space, char *message,
                                          size_t message_size, color_processor **out_processor)
{
    return create_processor(config, message, message_size, out_processor, [config, space](color_processor &self) {
        const OCIO::ConstColorSpaceRcPtr from = space_of(config->config, space);
        self.cpu = exact_processor(config->config, space_transform(from->getName(), config->working_space));
        self.factor = 1.0f;
    });
}

extern "C" ag_status color_encoder_create(const color_config *config, const char *space, char *message,
                                          size_t message_size, color_processor **out_processor)
{
    return create_processor(config, message, message_size, out_processor, [config, space](color_processor &self) {
        const OCIO::ConstColorSpaceRcPtr to = space_of(config->config, space);
        self.cpu = exact_processor(config->config, space_transform(config->working_space, to->getName()));
        self.factor = 1.0f;
    });
}

extern "C" void color_processor_destroy(color_processor *processor) { delete processor; }

extern "C" ag_status color_processor_apply(const color_processor *processor, float *rgb_pixels, size_t count,
                                           char *message, size_t message_size)
{
    return guarded(processor->log, message, message_size, [processor, rgb_pixels, count] {
        /* By way of RGBA: packed RGB OpenColorIO would copy there and back itself, at twice the price of a curve. */
        const size_t row_size = 1024;
        const float factor = processor->factor;
        float row[4 * row_size];
        for (size_t begin = 0; begin < count; begin += row_size) {
            const size_t size = std::min(row_size, count - begin);
            float *pixels = rgb_pixels + 3 * begin;
            for (size_t i = 0; i < size; i++) {
                for (size_t c = 0; c < 3; c++)
                    row[4 * i + c] = factor * pixels[3 * i + c];
                row[4 * i + 3] = 1.0f;
            }
            if (processor->cpu) {
                OCIO::PackedImageDesc description(row, static_cast<long>(size), 1, 4);
                processor->cpu->apply(description);
            } else {
                processor->in_stages.apply(row, size);
            }
            for (size_t i = 0; i < size; i++)
                std::copy(row + 4 * i, row + 4 * i + 3, pixels + 3 * i);
        }
    });
}
