/* color_ocio.cpp: the only file that knows OpenColorIO. Its exceptions end here, as a status and a text.
 * Flow: image file -> [here] -> texture; film -> [here] -> image file. Threads: see color.h; OpenColorIO's const
 * objects may be shared. */
#include "color.h"
#include "color_builtin_config.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <sstream>
#include <string>
#include <strings.h>
#include <vector>

namespace OCIO = OCIO_NAMESPACE;

struct color_config {
    OCIO::ConstConfigRcPtr config;
    std::string name;
    std::string hash;
    std::string input_space;
    bool input_by_interchange; /* input_space is ACES2065-1, reached from Rec. 709 by a matrix of ours */
};

struct color_processor {
    OCIO::ConstCPUProcessorRcPtr cpu;
};

namespace
{

void put_message(char *message, size_t message_size, const char *text) noexcept
{
    if (message && message_size > 0)
        std::snprintf(message, message_size, "%s", text);
}

/* Runs work and is the one place where an exception becomes a status. */
template <typename Work>
ag_status guarded(char *message, size_t message_size, Work &&work) noexcept
{
    try {
        put_message(message, message_size, "");
        work();
        return AG_OK;
    } catch (const std::bad_alloc &) {
        put_message(message, message_size, ag_status_text(AG_ERROR_MEMORY));
        return AG_ERROR_MEMORY;
    } catch (const std::exception &exception) {
        put_message(message, message_size, exception.what());
    } catch (...) {
        put_message(message, message_size, "OpenColorIO failed without saying why");
    }
    return AG_ERROR_COLOR;
}

/* Loads the config at path; OpenColorIO's own text is kept, after the place that named the file. */
OCIO::ConstConfigRcPtr config_from_file(const char *path, const char *named_by)
{
    try {
        return OCIO::Config::CreateFromFile(path);
    } catch (const OCIO::Exception &exception) {
        throw OCIO::Exception(
            (std::string("OpenColorIO config '") + path + "' (" + named_by + "): " + exception.what()).c_str());
    }
}

/* The name of a scene-linear space with Rec. 709 primaries, as known configs call it; empty: none of these. */
std::string find_space(const OCIO::ConstConfigRcPtr &config, const std::vector<const char *> &names)
{
    for (const char *name : names) {
        const OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name);
        if (space && !space->isData())
            return space->getName();
    }
    return std::string();
}

/* Settles what our pixels, linear Rec. 709, are called in this config. */
void find_input_space(color_config *self)
{
    /* Names that can mean nothing else: OpenColorIO's own ACES configs (2.x), ACES 1.x, MaterialX, Blender from 4.0,
     * AgX. */
    static const std::vector<const char *> certain = {"lin_rec709",
                                                      "lin_rec709_srgb",
                                                      "lin_rec709_scene",
                                                      "Linear Rec.709 (sRGB)",
                                                      "Linear Rec.709",
                                                      "scene-linear Rec.709-sRGB",
                                                      "Utility - Linear - Rec.709",
                                                      "Utility - Linear - sRGB",
                                                      "lin_srgb",
                                                      "Linear BT.709"};
    /* Blender before 4.0, Filmic and the Nuke default: Rec. 709 there, but another config may mean other primaries. */
    static const std::vector<const char *> likely = {"Linear"};

    self->input_by_interchange = false;
    self->input_space = find_space(self->config, certain);
    if (self->input_space.empty() && self->config->hasRole(OCIO::ROLE_INTERCHANGE_SCENE)) {
        self->input_space = find_space(self->config, {OCIO::ROLE_INTERCHANGE_SCENE});
        self->input_by_interchange = !self->input_space.empty();
    }
    if (self->input_space.empty())
        self->input_space = find_space(self->config, likely);
    if (self->input_space.empty())
        self->input_space = find_space(self->config, {OCIO::ROLE_RENDERING, OCIO::ROLE_SCENE_LINEAR});
    if (self->input_space.empty())
        throw OCIO::Exception("the OpenColorIO config names no scene-linear colour space");
}

std::string joined(const std::vector<std::string> &names)
{
    std::string text;
    for (const std::string &name : names)
        text += (text.empty() ? "'" : ", '") + name + "'";
    return text.empty() ? "none" : text;
}

/* The config's own spelling of name among names; unknown: an error that lists them. */
std::string chosen(const char *what, const char *name, const std::vector<std::string> &names)
{
    const auto same = [name](const std::string &other) { return strcasecmp(other.c_str(), name) == 0; };
    const auto found = std::find_if(names.begin(), names.end(), same);
    if (found == names.end())
        throw OCIO::Exception(
            (std::string("unknown ") + what + " '" + name + "'; the OpenColorIO config has: " + joined(names)).c_str());
    return *found;
}

/* Inactive displays and views may be asked for by name too, so all are listed, not only those a menu would show. */
std::vector<std::string> all_displays(const OCIO::ConstConfigRcPtr &config)
{
    std::vector<std::string> names;
    for (int i = 0; i < config->getNumDisplaysAll(); i++)
        names.emplace_back(config->getDisplayAll(i));
    return names;
}

std::vector<std::string> all_views(const OCIO::ConstConfigRcPtr &config, const char *display)
{
    std::vector<std::string> names;
    for (const OCIO::ViewType type : {OCIO::VIEW_SHARED, OCIO::VIEW_DISPLAY_DEFINED})
        for (int i = 0; i < config->getNumViews(type, display); i++)
            names.emplace_back(config->getView(type, display, i));
    return names;
}

/* ACES2065-1 from linear Rec. 709, or back: what the interchange role of a config that has no Rec. 709 space leaves to
 * us. */
OCIO::GroupTransformRcPtr aces_from_rec709(OCIO::TransformDirection direction)
{
    const OCIO::BuiltinTransformRcPtr acescg_from_rec709 = OCIO::BuiltinTransform::Create();
    acescg_from_rec709->setStyle("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD");
    acescg_from_rec709->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
    const OCIO::BuiltinTransformRcPtr aces_from_acescg = OCIO::BuiltinTransform::Create();
    aces_from_acescg->setStyle("ACEScg_to_ACES2065-1");
    const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
    group->appendTransform(acescg_from_rec709);
    group->appendTransform(aces_from_acescg);
    group->setDirection(direction);
    return group;
}

/* A display and a view, never a bare hop between colour spaces: the view carries the tone curve. */
OCIO::ConstTransformRcPtr display_transform(const color_config *self, const char *display, const char *view)
{
    const OCIO::DisplayViewTransformRcPtr to_display = OCIO::DisplayViewTransform::Create();
    to_display->setSrc(self->input_space.c_str());
    to_display->setDisplay(display);
    to_display->setView(view);
    if (!self->input_by_interchange)
        return to_display;
    const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
    group->appendTransform(aces_from_rec709(OCIO::TRANSFORM_DIR_FORWARD));
    group->appendTransform(to_display);
    return group;
}

/* Out of a colour space into linear Rec. 709. */
OCIO::ConstTransformRcPtr decoding_transform(const color_config *self, const char *space)
{
    const OCIO::ColorSpaceTransformRcPtr out_of_space = OCIO::ColorSpaceTransform::Create();
    out_of_space->setSrc(space);
    out_of_space->setDst(self->input_space.c_str());
    if (!self->input_by_interchange)
        return out_of_space;
    const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
    group->appendTransform(out_of_space);
    group->appendTransform(aces_from_rec709(OCIO::TRANSFORM_DIR_INVERSE));
    return group;
}

OCIO::ConstConfigRcPtr builtin_config()
{
    std::istringstream text(
        std::string(reinterpret_cast<const char *>(color_builtin_config), color_builtin_config_size));
    return OCIO::Config::CreateFromStream(text);
}

/* Makes a config of what load gives, under the name that load puts into it. */
template <typename Load>
ag_status create_config(char *message, size_t message_size, color_config **out_config, Load &&load) noexcept
{
    *out_config = nullptr;
    color_config *self = new (std::nothrow) color_config();
    if (!self) {
        put_message(message, message_size, ag_status_text(AG_ERROR_MEMORY));
        return AG_ERROR_MEMORY;
    }
    const ag_status status = guarded(message, message_size, [self, &load] {
        load(*self);
        if (self->config->getName()[0] != '\0')
            self->name = self->config->getName();
        /* Without a context: of the config's text alone, hence the same on every machine. */
        self->hash = self->config->getCacheID(OCIO::ConstContextRcPtr());
        find_input_space(self);
    });
    if (status == AG_OK)
        *out_config = self;
    else
        delete self;
    return status;
}

/* Makes a processor of what the work puts into it. */
template <typename Work>
ag_status create_processor(char *message, size_t message_size, color_processor **out_processor, Work &&work) noexcept
{
    *out_processor = nullptr;
    color_processor *self = new (std::nothrow) color_processor();
    if (!self) {
        put_message(message, message_size, ag_status_text(AG_ERROR_MEMORY));
        return AG_ERROR_MEMORY;
    }
    const ag_status status = guarded(message, message_size, [self, &work] { work(*self); });
    if (status == AG_OK)
        *out_processor = self;
    else
        delete self;
    return status;
}

} // namespace

extern "C" ag_status color_config_create(const char *path, char *message, size_t message_size,
                                         color_config **out_config)
{
    return create_config(message, message_size, out_config, [path](color_config &self) {
        const char *environment = std::getenv("OCIO");
        if (path) {
            self.config = config_from_file(path, "given");
            self.name = path;
        } else if (environment && environment[0] != '\0') { /* set but empty counts as unset */
            self.config = config_from_file(environment, "from $OCIO");
            self.name = environment;
        } else {
            self.config = builtin_config();
            self.name = "built-in";
        }
    });
}

extern "C" ag_status color_config_create_builtin(char *message, size_t message_size, color_config **out_config)
{
    return create_config(message, message_size, out_config, [](color_config &self) {
        self.config = builtin_config();
        self.name = "built-in";
    });
}

extern "C" void color_config_destroy(color_config *config) { delete config; }

extern "C" const char *color_config_name(const color_config *config) { return config->name.c_str(); }

extern "C" const char *color_config_hash(const color_config *config) { return config->hash.c_str(); }

extern "C" const char *color_config_input_space(const color_config *config) { return config->input_space.c_str(); }

extern "C" ag_status color_processor_create(const color_config *config, const char *display, const char *view,
                                            char *message, size_t message_size, color_processor **out_processor)
{
    return create_processor(message, message_size, out_processor, [config, display, view](color_processor &self) {
        const OCIO::ConstConfigRcPtr &ocio = config->config;
        const std::vector<std::string> displays = all_displays(ocio);
        const std::string display_name = chosen("display", display ? display : ocio->getDefaultDisplay(), displays);
        const std::string default_view = ocio->getDefaultView(display_name.c_str(), config->input_space.c_str());
        const std::string view_name = chosen(("view of display '" + display_name + "'").c_str(),
                                             view ? view : default_view.c_str(), all_views(ocio, display_name.c_str()));
        const OCIO::ConstTransformRcPtr transform = display_transform(config, display_name.c_str(), view_name.c_str());
        self.cpu = ocio->getProcessor(transform)->getDefaultCPUProcessor();
    });
}

extern "C" ag_status color_decoder_create(const color_config *config, const char *space, char *message,
                                          size_t message_size, color_processor **out_processor)
{
    return create_processor(message, message_size, out_processor, [config, space](color_processor &self) {
        const OCIO::ConstTransformRcPtr transform = decoding_transform(config, space);
        self.cpu = config->config->getProcessor(transform)->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS);
    });
}

extern "C" void color_processor_destroy(color_processor *processor) { delete processor; }

extern "C" ag_status color_processor_apply(const color_processor *processor, float *rgb_pixels, size_t count,
                                           char *message, size_t message_size)
{
    return guarded(message, message_size, [processor, rgb_pixels, count] {
        /* In short rows: OpenColorIO copies a row of packed RGB at a time, and one long row would be one large copy. */
        const size_t row_size = 1024;
        const size_t row_count = count / row_size;
        const size_t rest = count % row_size;
        const OCIO::CPUProcessor &cpu = *processor->cpu;
        if (row_count > 0) {
            OCIO::PackedImageDesc rows(rgb_pixels, static_cast<long>(row_size), static_cast<long>(row_count), 3);
            cpu.apply(rows);
        }
        if (rest > 0) {
            OCIO::PackedImageDesc last(rgb_pixels + 3 * row_size * row_count, static_cast<long>(rest), 1, 3);
            cpu.apply(last);
        }
    });
}
