/* color_ocio.cpp: configs of OpenColorIO: where they come from, and the space that light is carried in.
 * Flow: image file -> [here] -> texture; film -> [here] -> image file. Threads: see color.h; OpenColorIO's const
 * objects may be shared. */
#include "color/color_builtin_config.h"
#include "color/color_ocio_private.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <sys/stat.h>
#include <vector>

using namespace ag_color;

namespace ag_color
{

void put_message(char *message, size_t message_size, const char *text) noexcept
{
    if (message && message_size > 0)
        std::snprintf(message, message_size, "%s", text);
}

} // namespace ag_color

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

/* Loads the config at path; OpenColorIO's own text is kept, after the location that named the file. */
OCIO::ConstConfigRcPtr config_from_file(const char *path, const char *named_by)
{
    try {
        struct stat status;
        if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) /* a FIFO would be waited for */
            throw OCIO::Exception("it is not a regular file");
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

/* The colour space of the config that light is carried in. */
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

OCIO::ConstConfigRcPtr builtin_config()
{
    std::istringstream text(
        std::string(reinterpret_cast<const char *>(color_builtin_config), color_builtin_config_size));
    return OCIO::Config::CreateFromStream(text);
}

/* Makes a config of what load gives, under the name that load puts into it. */
template <typename Load>
ag_status create_config(const char *working_space, struct log_sink *log, char *message, size_t message_size,
                        color_config **out_config, Load &&load) noexcept
{
    *out_config = nullptr;
    color_config *self = new (std::nothrow) color_config();
    if (!self) {
        put_message(message, message_size, ag_status_text(AG_ERROR_MEMORY));
        return AG_ERROR_MEMORY;
    }
    self->log = log;
    const ag_status status = guarded(log, message, message_size, [self, working_space, &load] {
        load(*self);
        if (self->config->getName()[0] != '\0')
            self->name = self->config->getName();
        /* Without a context: of the config's text alone, hence the same on every machine. */
        self->hash = self->config->getCacheID(OCIO::ConstContextRcPtr());
        refuse_cycles(self->config);
        find_working_space(self, working_space);
    });
    if (status == AG_OK)
        *out_config = self;
    else
        delete self;
    return status;
}

} // namespace

extern "C" ag_status color_config_create(const char *path, const char *working_space, struct log_sink *log,
                                         char *message, size_t message_size, color_config **out_config)
{
    return create_config(working_space, log, message, message_size, out_config, [path](color_config &self) {
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
    return create_config(nullptr, nullptr, message, message_size, out_config, [](color_config &self) {
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
