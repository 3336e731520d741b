/* color_cycle_ocio.cpp: colour spaces, looks and view transforms of a config that are made of one another must come to
 * an end: OpenColorIO follows them without looking, until the stack is full or the day is over.
 * Flow: color_ocio asks of every config. Threads: see color.h. */
#include "color/color_ocio_private.h"

#include <cstring>
#include <map>
#include <strings.h>

namespace ag_color
{

namespace
{

const double LARGEST_COST = 1e5; /* transforms in one, all that it is made of counted as often as it is met */
const int DEEPEST = 200;

[[noreturn]] void refuse(const std::string &what, const char *why)
{
    throw OCIO::Exception((what + " of the OpenColorIO config " + why).c_str());
}

class walk
{
  public:
    explicit walk(const OCIO::ConstConfigRcPtr &config_to_walk) : config(config_to_walk) {}

    double cost_of_space(const char *name)
    {
        if (const OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name))
            return cost_of("the colour space '" + std::string(space->getName()) + "'",
                           {space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE),
                            space->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE)});
        if (const OCIO::ConstNamedTransformRcPtr named = config->getNamedTransform(name))
            return cost_of(
                "the named transform '" + std::string(named->getName()) + "'",
                {named->getTransform(OCIO::TRANSFORM_DIR_FORWARD), named->getTransform(OCIO::TRANSFORM_DIR_INVERSE)});
        return 1.0;
    }

    /* Of those that stand in a list of looks; NULL: of all. */
    double cost_of_looks(const char *names)
    {
        double sum = 1.0;
        for (int i = 0; i < config->getNumLooks(); i++) {
            const OCIO::ConstLookRcPtr look = config->getLook(config->getLookNameByIndex(i));
            if (look && (!names || std::strstr(names, look->getName())))
                sum += cost_of("the look '" + std::string(look->getName()) + "'",
                               {look->getTransform(), look->getInverseTransform()}) +
                       cost_of_space(look->getProcessSpace());
        }
        return sum;
    }

    /* Of that name; NULL: of all. */
    double cost_of_view_transforms(const char *wanted)
    {
        double sum = 1.0;
        for (int i = 0; i < config->getNumViewTransforms(); i++) {
            const char *name = config->getViewTransformNameByIndex(i);
            const OCIO::ConstViewTransformRcPtr view = config->getViewTransform(name);
            if (view && (!wanted || strcasecmp(wanted, name) == 0))
                sum += cost_of("the view transform '" + std::string(name) + "'",
                               {view->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE),
                                view->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE)});
        }
        return sum;
    }

  private:
    OCIO::ConstConfigRcPtr config;
    std::map<std::string, double> costs; /* 0: under way */
    int depth = 0;

    double cost_of(const std::string &what, const std::vector<OCIO::ConstTransformRcPtr> &transforms)
    {
        const auto known = costs.find(what);
        if (known != costs.end() && known->second == 0.0)
            refuse(what, "is made of itself");
        if (known != costs.end())
            return known->second;
        if (++depth > DEEPEST)
            refuse(what, "is made of others too deep");
        costs[what] = 0.0;
        double sum = 1.0;
        for (const OCIO::ConstTransformRcPtr &transform : transforms)
            sum += cost_of_transform(transform);
        if (sum > LARGEST_COST)
            refuse(what, "is made of too many others");
        depth--;
        return costs[what] = sum;
    }

    double cost_of_transform(const OCIO::ConstTransformRcPtr &transform)
    {
        double sum = 1.0;
        if (const auto group = OCIO_DYNAMIC_POINTER_CAST<const OCIO::GroupTransform>(transform))
            for (int i = 0; i < group->getNumTransforms(); i++)
                sum += cost_of_transform(group->getTransform(i));
        else if (const auto hop = OCIO_DYNAMIC_POINTER_CAST<const OCIO::ColorSpaceTransform>(transform))
            sum += cost_of_space(hop->getSrc()) + cost_of_space(hop->getDst());
        else if (const auto look = OCIO_DYNAMIC_POINTER_CAST<const OCIO::LookTransform>(transform))
            sum += cost_of_space(look->getSrc()) + cost_of_space(look->getDst()) + cost_of_looks(look->getLooks());
        else if (const auto view = OCIO_DYNAMIC_POINTER_CAST<const OCIO::DisplayViewTransform>(transform))
            sum += cost_of_view(view);
        return sum;
    }

    double cost_of_view(const OCIO::ConstDisplayViewTransformRcPtr &transform)
    {
        const char *display = transform->getDisplay(), *view = transform->getView();
        const std::string shown = config->getDisplayViewColorSpaceName(display, view);
        const bool is_shown_by_display = strcasecmp(shown.c_str(), OCIO::OCIO_VIEW_USE_DISPLAY_NAME) == 0;
        return cost_of_space(transform->getSrc()) + cost_of_space(is_shown_by_display ? display : shown.c_str()) +
               cost_of_view_transforms(config->getDisplayViewTransformName(display, view)) +
               cost_of_looks(config->getDisplayViewLooks(display, view));
    }
};

} // namespace

void refuse_cycles(const OCIO::ConstConfigRcPtr &config)
{
    walk all(config);
    const int count = config->getNumColorSpaces(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL);
    for (int i = 0; i < count; i++)
        all.cost_of_space(config->getColorSpaceNameByIndex(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL, i));
    all.cost_of_looks(nullptr);
    all.cost_of_view_transforms(nullptr);
}

} // namespace ag_color
