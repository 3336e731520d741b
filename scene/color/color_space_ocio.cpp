/* color_space_ocio.cpp: what a config has, by its names: displays, views, looks, colour spaces, rules for files.
 * Flow: see color.h. Threads: see color.h. */
#include "color/color_ocio_private.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <strings.h>

namespace ag_color
{

namespace
{

std::string joined(const std::vector<std::string> &names)
{
    std::string text;
    for (const std::string &name : names)
        text += (text.empty() ? "'" : ", '") + name + "'";
    return text.empty() ? "none" : text;
}

std::vector<std::string> all_spaces(const OCIO::ConstConfigRcPtr &config)
{
    std::vector<std::string> names;
    const int count = config->getNumColorSpaces(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL);
    for (int i = 0; i < count; i++)
        names.emplace_back(config->getColorSpaceNameByIndex(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL, i));
    return names;
}

[[noreturn]] void refuse_space(const OCIO::ConstConfigRcPtr &config, const char *name)
{
    throw OCIO::Exception(
        (std::string("unknown colour space '") + name + "'; the OpenColorIO config has: " + joined(all_spaces(config)))
            .c_str());
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

/* Pairs of a display and a view, a zero behind each name. */
std::string listed_views(const color_config *self)
{
    const OCIO::ConstConfigRcPtr &config = self->config;
    const std::string display_first = config->getDefaultDisplay();
    const std::string view_first = config->getDefaultView(display_first.c_str(), self->working_space.c_str());
    std::string first, others;
    for (const std::string &display : all_displays(config))
        for (const std::string &view : all_views(config, display.c_str())) {
            const bool is_first = first.empty() && display == display_first && view == view_first;
            (is_first ? first : others).append(display).append(1, '\0').append(view).append(1, '\0');
        }
    return first + others;
}

} // namespace

std::string chosen(const char *what, const char *name, const std::vector<std::string> &names, const std::string &holder)
{
    const auto same = [name](const std::string &other) { return strcasecmp(other.c_str(), name) == 0; };
    const auto found = std::find_if(names.begin(), names.end(), same);
    if (found == names.end())
        throw OCIO::Exception(
            (std::string("unknown ") + what + " '" + name + "'; " + holder + " has: " + joined(names)).c_str());
    return *found;
}

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

std::vector<std::string> all_looks(const OCIO::ConstConfigRcPtr &config)
{
    std::vector<std::string> names;
    for (int i = 0; i < config->getNumLooks(); i++)
        names.emplace_back(config->getLookNameByIndex(i));
    return names;
}

OCIO::ConstColorSpaceRcPtr space_of(const OCIO::ConstConfigRcPtr &config, const char *name)
{
    const OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name);
    if (!space)
        refuse_space(config, name);
    return space;
}

} // namespace ag_color

using namespace ag_color;

extern "C" ag_status color_config_describe(const color_config *config, char *message, size_t message_size,
                                           char **out_text)
{
    *out_text = nullptr;
    return guarded(config->log, message, message_size, [config, out_text] {
        *out_text = strdup(described(config).c_str());
        if (!*out_text)
            throw std::bad_alloc();
    });
}

extern "C" ag_status color_config_list_views(const color_config *config, char *message, size_t message_size,
                                             char **out_pairs)
{
    *out_pairs = nullptr;
    return guarded(config->log, message, message_size, [config, out_pairs] {
        const std::string pairs = listed_views(config);
        *out_pairs = static_cast<char *>(calloc(pairs.size() + 1, 1));
        if (!*out_pairs)
            throw std::bad_alloc();
        memcpy(*out_pairs, pairs.data(), pairs.size());
    });
}

extern "C" const char *color_config_find_space(const color_config *config, const char *name, char *message,
                                               size_t message_size)
{
    const char *found = nullptr;
    guarded(config->log, message, message_size,
            [config, name, &found] { found = space_of(config->config, name)->getName(); });
    return found;
}

extern "C" const char *color_config_rule(const color_config *config, const char *path)
{
    const char *found = nullptr;
    guarded(config->log, nullptr, 0, [config, path, &found] {
        const OCIO::ConstConfigRcPtr &ocio = config->config;
        if (!ocio->filepathOnlyMatchesDefaultRule(path))
            found = space_of(ocio, ocio->getColorSpaceFromFilepath(path))->getName();
    });
    return found;
}
