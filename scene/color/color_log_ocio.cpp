/* color_log_ocio.cpp: what OpenColorIO says of configs and files, which it would write to standard error: into the log
 * of whom it works for. There is one function for the whole process, so it asks who is at work on its thread.
 * Flow: OpenColorIO -> [here] -> log. Threads: any. */
#include "color/color_ocio_private.h"

extern "C" {
#include "log.h"
}

#include <cstdio>
#include <cstring>
#include <mutex>

namespace ag_color
{

namespace
{

thread_local const listening *innermost = nullptr;

const struct {
    const char *prefix;
    ag_log_level level;
} LEVELS[] = {{"[OpenColorIO Error]: ", AG_LOG_ERROR},
              {"[OpenColorIO Warning]: ", AG_LOG_WARNING},
              {"[OpenColorIO Info]: ", AG_LOG_INFO},
              {"[OpenColorIO Debug]: ", AG_LOG_DEBUG}};

} // namespace

listening::listening(struct log_sink *log_to_use) noexcept : outer(innermost), log(log_to_use)
{
    static std::once_flag once;
    innermost = this;
    try {
        std::call_once(once, [] { OCIO::SetLoggingFunction(hear); });
    } catch (...) {
        /* then it says on standard error what it has to say */
    }
}

listening::~listening() { innermost = outer; }

void listening::hear(const char *text)
{
    if (!innermost) { /* the work of others in this process, who find it where OpenColorIO leaves it */
        std::fputs(text, stderr);
        return;
    }
    ag_log_level level = AG_LOG_INFO;
    for (const auto &known : LEVELS)
        if (std::strncmp(text, known.prefix, std::strlen(known.prefix)) == 0) {
            level = known.level;
            text += std::strlen(known.prefix);
            break;
        }
    log_once(innermost->log, level, text, "OpenColorIO: %s", text);
}

} // namespace ag_color
