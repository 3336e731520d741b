/* base.c: the texts behind base.h: statuses, phases, the version.
 * Flow: used everywhere; depends on nothing.
 * Threads: any; constant data only. */
#include "afterglow/base.h"

#ifndef AG_VERSION_STRING
#error "AG_VERSION_STRING is the project's version as a string; threads/CMakeLists.txt defines it"
#endif

/* Switches rather than tables: they need no range check, and the compiler counts the cases. */

const char *ag_status_text(ag_status status)
{
    switch (status) {
#define STATUS_CASE(code, text)                                                                                        \
    case code: return text;
        AG_STATUS_LIST(STATUS_CASE)
#undef STATUS_CASE
    }
    return "unknown status";
}

const char *ag_phase_name(ag_phase phase)
{
    switch (phase) {
#define PHASE_CASE(code, text)                                                                                         \
    case code: return text;
        AG_PHASE_LIST(PHASE_CASE)
#undef PHASE_CASE
    case AG_PHASE_COUNT: break;
    }
    return "unknown phase";
}

const char *ag_version(void) { return AG_VERSION_STRING; }
