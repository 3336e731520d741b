/* color_ocio_private.h: what the files that know OpenColorIO share: color_ocio.cpp (configs), color_space_ocio.cpp
 * (what a config has, by its names), color_cycle_ocio.cpp (what would not end), color_log_ocio.cpp (what OpenColorIO
 * says), color_view_ocio.cpp (ways from space to space, and to displays) and color_table_ocio.cpp (these, quicker).
 * Its exceptions end in guarded. Threads: see color.h; OpenColorIO's const objects may be shared. */
#ifndef AFTERGLOW_COLOR_OCIO_PRIVATE_H
#define AFTERGLOW_COLOR_OCIO_PRIVATE_H

#include "color/color.h"

#include <OpenColorIO/OpenColorIO.h>

#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace OCIO = OCIO_NAMESPACE;

struct color_config {
    struct log_sink *log; /* may be nullptr */
    OCIO::ConstConfigRcPtr config;
    std::string name;
    std::string hash;
    std::string working_space;
    double from_rec709[9]; /* to the working space */
    bool has_primaries;    /* that matrix is known */
};

namespace ag_color
{

/* Cut where it does not fit, and always terminated. */
void put_message(char *message, size_t message_size, const char *text) noexcept;

/* --- color_log_ocio.cpp --- */

/* While a listening lives, OpenColorIO's messages on this thread go to a log; nullptr: they are dropped. */
class listening
{
  public:
    explicit listening(struct log_sink *log) noexcept;
    ~listening();
    listening(const listening &) = delete;
    listening &operator=(const listening &) = delete;

  private:
    const listening *outer;
    struct log_sink *log;
    static void hear(const char *text);
};

/* Runs work and is the only function where an exception becomes a status. */
template <typename Work>
ag_status guarded(struct log_sink *log, char *message, size_t message_size, Work &&work) noexcept
{
    const listening listens(log);
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

/* --- color_space_ocio.cpp --- */

/* Inactive displays and views may be asked for by name too, so all are listed, not only those a menu would show. */
std::vector<std::string> all_displays(const OCIO::ConstConfigRcPtr &config);
std::vector<std::string> all_views(const OCIO::ConstConfigRcPtr &config, const char *display);
std::vector<std::string> all_looks(const OCIO::ConstConfigRcPtr &config);

/* The config's own spelling of name among names; unknown: an error that lists them. */
std::string chosen(const char *what, const char *name, const std::vector<std::string> &names,
                   const std::string &holder = "the OpenColorIO config");

/* Finds a space by name, alias or role; throws an error that lists the config's where there is none. */
OCIO::ConstColorSpaceRcPtr space_of(const OCIO::ConstConfigRcPtr &config, const char *name);

/* --- color_cycle_ocio.cpp --- */

/* Throws where something in the config is made of itself, or of so much else that it would not end. */
void refuse_cycles(const OCIO::ConstConfigRcPtr &config);

/* --- color_view_ocio.cpp --- */

OCIO::ColorSpaceTransformRcPtr space_transform(const std::string &from, const std::string &to);
OCIO::ConstCPUProcessorRcPtr exact_processor(const OCIO::ConstConfigRcPtr &config,
                                             const OCIO::ConstTransformRcPtr &transform);
/* The matrix of a transform, row by row; false where it is none. */
bool find_matrix(const OCIO::ConstCPUProcessorRcPtr &cpu, double out_matrix[9]);
void set_unit_matrix(double matrix[9]);

/* --- color_table_ocio.cpp --- */

struct curve_table;

/* The steps of a processor, one after the other, faster where they may be. */
class stages
{
  public:
    stages() = default;
    stages(const OCIO::ConstConfigRcPtr &config, const OCIO::ConstProcessorRcPtr &processor);
    void apply(float *rgba, size_t count) const;

  private:
    struct stage {
        OCIO::ConstCPUProcessorRcPtr cpu;
        std::shared_ptr<const curve_table> table; /* nullptr: there is none */
    };
    std::vector<stage> list;
};

} // namespace ag_color

#endif
