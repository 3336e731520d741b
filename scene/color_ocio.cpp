/* color_ocio.cpp: the only file that knows OpenColorIO. Its exceptions end here, as a status and a text.
 * Flow: image file -> [here] -> texture; film -> [here] -> image file. Threads: see color.h; OpenColorIO's const
 * objects may be shared. */
#include "color.h"
#include "color_builtin_config.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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
    std::string working_space;
    double from_rec709[9]; /* to the working space */
    bool has_primaries;    /* that matrix is known */
};

struct color_processor {
    OCIO::ConstCPUProcessorRcPtr cpu;
    float factor; /* of the values that go in */
};

namespace
{

/* Linear Rec. 709 by names that can mean nothing else: OpenColorIO's own ACES configs (2.x), ACES 1.x, MaterialX,
 * Blender from 4.0, AgX. */
const std::vector<const char *> KNOWN_REC709 = {"lin_rec709",
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
const std::vector<const char *> LIKELY_REC709 = {"Linear"};

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

/* The config's name of the first of these that is there and no data; empty: none of them. */
std::string find_space(const OCIO::ConstConfigRcPtr &config, const std::vector<const char *> &names)
{
    for (const char *name : names) {
        const OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name);
        if (space && !space->isData())
            return space->getName();
    }
    return std::string();
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

std::vector<std::string> all_spaces(const OCIO::ConstConfigRcPtr &config)
{
    std::vector<std::string> names;
    const int count = config->getNumColorSpaces(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL);
    for (int i = 0; i < count; i++)
        names.emplace_back(config->getColorSpaceNameByIndex(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL, i));
    return names;
}

std::vector<std::string> all_looks(const OCIO::ConstConfigRcPtr &config)
{
    std::vector<std::string> names;
    for (int i = 0; i < config->getNumLooks(); i++)
        names.emplace_back(config->getLookNameByIndex(i));
    return names;
}

[[noreturn]] void refuse_space(const OCIO::ConstConfigRcPtr &config, const char *name)
{
    throw OCIO::Exception(
        (std::string("unknown colour space '") + name + "'; the OpenColorIO config has: " + joined(all_spaces(config)))
            .c_str());
}

/* By name, alias or role. */
OCIO::ConstColorSpaceRcPtr space_of(const OCIO::ConstConfigRcPtr &config, const char *name)
{
    const OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name);
    if (!space)
        refuse_space(config, name);
    return space;
}

/* ACES2065-1 from linear Rec. 709: what the interchange role of a config that has no Rec. 709 space leaves to us. */
OCIO::GroupTransformRcPtr aces_from_rec709()
{
    const OCIO::BuiltinTransformRcPtr acescg_from_rec709 = OCIO::BuiltinTransform::Create();
    acescg_from_rec709->setStyle("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD");
    acescg_from_rec709->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
    const OCIO::BuiltinTransformRcPtr aces_from_acescg = OCIO::BuiltinTransform::Create();
    aces_from_acescg->setStyle("ACEScg_to_ACES2065-1");
    const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
    group->appendTransform(acescg_from_rec709);
    group->appendTransform(aces_from_acescg);
    return group;
}

OCIO::ColorSpaceTransformRcPtr space_transform(const std::string &from, const std::string &to)
{
    const OCIO::ColorSpaceTransformRcPtr transform = OCIO::ColorSpaceTransform::Create();
    transform->setSrc(from.c_str());
    transform->setDst(to.c_str());
    return transform;
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

/* What of the config light is carried in. */
std::string working_space_of(const OCIO::ConstConfigRcPtr &config, const char *wanted)
{
    if (wanted) {
        const OCIO::ConstColorSpaceRcPtr space = space_of(config, wanted);
        if (space->isData())
            throw OCIO::Exception((std::string("the working space '") + wanted + "' is of data, not colours").c_str());
        return space->getName();
    }
    const std::string name = find_space(config, {OCIO::ROLE_RENDERING, OCIO::ROLE_SCENE_LINEAR});
    return name.empty() ? find_space(config, KNOWN_REC709) : name;
}

/* Settles the working space, and its primaries: by a space of the config that is linear Rec. 709 by its name, else by
 * the interchange space, ACES2065-1. */
void find_working_space(color_config *self, const char *wanted)
{
    const OCIO::ConstConfigRcPtr &config = self->config;
    self->working_space = working_space_of(config, wanted);
    if (self->working_space.empty())
        throw OCIO::Exception("the OpenColorIO config names no scene-linear colour space");
    set_unit_matrix(self->from_rec709);
    self->has_primaries = true;
    std::string rec709 = find_space(config, KNOWN_REC709);
    OCIO::ConstTransformRcPtr transform;
    if (rec709.empty() && config->hasRole(OCIO::ROLE_INTERCHANGE_SCENE)) {
        const OCIO::GroupTransformRcPtr group = aces_from_rec709();
        group->appendTransform(space_transform(OCIO::ROLE_INTERCHANGE_SCENE, self->working_space));
        transform = group;
    } else {
        if (rec709.empty())
            rec709 = find_space(config, LIKELY_REC709);
        self->has_primaries = !rec709.empty();
        if (rec709.empty() || rec709 == self->working_space)
            return;
        transform = space_transform(rec709, self->working_space);
    }
    if (!find_matrix(exact_processor(config, transform), self->from_rec709))
        throw OCIO::Exception(("the working space '" + self->working_space + "' is not linear").c_str());
}

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
    const std::string view =
        chosen(("view of display '" + display + "'").c_str(), wanted.view ? wanted.view : default_view.c_str(),
               all_views(config, display.c_str()));
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

void put_names(std::ostringstream &text, const char *title, const std::vector<std::string> &names)
{
    text << title << ":\n";
    for (const std::string &name : names)
        text << "  " << name << "\n";
    if (names.empty())
        text << "  none\n";
}

std::string described(const color_config *self)
{
    const OCIO::ConstConfigRcPtr &config = self->config;
    std::ostringstream text;
    text << "config: " << self->name << "\nworking space: " << self->working_space << "\ndisplays and their views:\n";
    const char *default_display = config->getDefaultDisplay();
    for (const std::string &display : all_displays(config)) {
        text << "  " << display << (display == default_display ? " (default)" : "") << "\n";
        const std::string default_view = config->getDefaultView(display.c_str(), self->working_space.c_str());
        for (const std::string &view : all_views(config, display.c_str())) {
            const std::string looks = config->getDisplayViewLooks(display.c_str(), view.c_str());
            text << "    " << view << (view == default_view ? " (default)" : "")
                 << (looks.empty() ? "" : ", with the looks " + looks) << "\n";
        }
    }
    put_names(text, "looks", all_looks(config));
    text << "colour spaces (and their other names):\n";
    for (const std::string &name : all_spaces(config)) {
        const OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name.c_str());
        text << "  " << name;
        for (size_t i = 0; space && i < space->getNumAliases(); i++)
            text << (i == 0 ? " (" : ", ") << space->getAlias(i) << (i + 1 == space->getNumAliases() ? ")" : "");
        text << "\n";
    }
    text << "roles:\n";
    for (int i = 0; i < config->getNumRoles(); i++)
        text << "  " << config->getRoleName(i) << ": " << config->getRoleColorSpace(i) << "\n";
    return text.str();
}

OCIO::ConstConfigRcPtr builtin_config()
{
    std::istringstream text(
        std::string(reinterpret_cast<const char *>(color_builtin_config), color_builtin_config_size));
    return OCIO::Config::CreateFromStream(text);
}

/* Makes a config of what load gives, under the name that load puts into it. */
template <typename Load>
ag_status create_config(const char *working_space, char *message, size_t message_size, color_config **out_config,
                        Load &&load) noexcept
{
    *out_config = nullptr;
    color_config *self = new (std::nothrow) color_config();
    if (!self) {
        put_message(message, message_size, ag_status_text(AG_ERROR_MEMORY));
        return AG_ERROR_MEMORY;
    }
    const ag_status status = guarded(message, message_size, [self, working_space, &load] {
        load(*self);
        if (self->config->getName()[0] != '\0')
            self->name = self->config->getName();
        /* Without a context: of the config's text alone, hence the same on every machine. */
        self->hash = self->config->getCacheID(OCIO::ConstContextRcPtr());
        find_working_space(self, working_space);
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

extern "C" ag_status color_config_create(const char *path, const char *working_space, char *message,
                                         size_t message_size, color_config **out_config)
{
    return create_config(working_space, message, message_size, out_config, [path](color_config &self) {
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
    return create_config(nullptr, message, message_size, out_config, [](color_config &self) {
        self.config = builtin_config();
        self.name = "built-in";
    });
}

extern "C" void color_config_destroy(color_config *config) { delete config; }

extern "C" const char *color_config_name(const color_config *config) { return config->name.c_str(); }

extern "C" const char *color_config_hash(const color_config *config) { return config->hash.c_str(); }

extern "C" const char *color_config_working_space(const color_config *config) { return config->working_space.c_str(); }

extern "C" bool color_config_from_rec709(const color_config *config, double out_matrix[9])
{
    std::copy(config->from_rec709, config->from_rec709 + 9, out_matrix);
    return config->has_primaries;
}

extern "C" ag_status color_config_describe(const color_config *config, char *message, size_t message_size,
                                           char **out_text)
{
    *out_text = nullptr;
    return guarded(message, message_size, [config, out_text] {
        *out_text = strdup(described(config).c_str());
        if (!*out_text)
            throw std::bad_alloc();
    });
}

extern "C" const char *color_config_find_space(const color_config *config, const char *name, char *message,
                                               size_t message_size)
{
    const char *found = nullptr;
    guarded(message, message_size, [config, name, &found] { found = space_of(config->config, name)->getName(); });
    return found;
}

extern "C" const char *color_config_rule(const color_config *config, const char *path)
{
    const char *found = nullptr;
    guarded(nullptr, 0, [config, path, &found] {
        const OCIO::ConstConfigRcPtr &ocio = config->config;
        if (!ocio->filepathOnlyMatchesDefaultRule(path))
            found = space_of(ocio, ocio->getColorSpaceFromFilepath(path))->getName();
    });
    return found;
}

extern "C" ag_status color_config_study_space(const color_config *config, const char *space, char *message,
                                              size_t message_size, color_curve *out_curve, double out_matrix[9])
{
    return guarded(message, message_size, [config, space, out_curve, out_matrix] {
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
    return create_processor(message, message_size, out_processor, [config, view](color_processor &self) {
        self.cpu = display_processor(config, *view)->getDefaultCPUProcessor();
        self.factor = std::exp2(view->exposure);
    });
}

extern "C" ag_status color_decoder_create(const color_config *config, const char *space, char *message,
                                          size_t message_size, color_processor **out_processor)
{
    return create_processor(message, message_size, out_processor, [config, space](color_processor &self) {
        const OCIO::ConstColorSpaceRcPtr from = space_of(config->config, space);
        self.cpu = exact_processor(config->config, space_transform(from->getName(), config->working_space));
        self.factor = 1.0f;
    });
}

extern "C" ag_status color_encoder_create(const color_config *config, const char *space, char *message,
                                          size_t message_size, color_processor **out_processor)
{
    return create_processor(message, message_size, out_processor, [config, space](color_processor &self) {
        const OCIO::ConstColorSpaceRcPtr to = space_of(config->config, space);
        self.cpu = exact_processor(config->config, space_transform(config->working_space, to->getName()));
        self.factor = 1.0f;
    });
}

extern "C" void color_processor_destroy(color_processor *processor) { delete processor; }

extern "C" ag_status color_processor_apply(const color_processor *processor, float *rgb_pixels, size_t count,
                                           char *message, size_t message_size)
{
    return guarded(message, message_size, [processor, rgb_pixels, count] {
        /* In short rows: OpenColorIO copies a row of packed RGB at a time, and one long row would be one large copy. */
        if (processor->factor != 1.0f)
            for (size_t i = 0; i < 3 * count; i++)
                rgb_pixels[i] *= processor->factor;
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
