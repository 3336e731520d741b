/* base.h: what every part of Afterglow shares with its callers: status codes, log levels, phases, version.
 * Part of the public contract; the rest of it is afterglow.h. Declarations only.
 * Threads: ag_status_text and ag_version may be called from any thread. */
#ifndef AFTERGLOW_BASE_H
#define AFTERGLOW_BASE_H

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define AG_API                                  __attribute__((visibility("default")))
#define AG_PRINTF(format_index, first_argument) __attribute__((format(printf, format_index, first_argument)))
#else
#define AG_API
#define AG_PRINTF(format_index, first_argument)
#endif

/* Every status with its text, in one list. */
#define AG_STATUS_LIST(X)                                                                                              \
    X(AG_OK, "success")                                                                                                \
    X(AG_ERROR_ARGUMENT, "invalid argument")                                                                           \
    X(AG_ERROR_MEMORY, "out of memory")                                                                                \
    X(AG_ERROR_INPUT, "an input file cannot be read")                                                                  \
    X(AG_ERROR_SCENE, "the scene is not valid")                                                                        \
    X(AG_ERROR_COLOR, "the colour configuration is not usable")                                                        \
    X(AG_ERROR_OUTPUT, "an output file cannot be written")                                                             \
    X(AG_ERROR_RAY_TRACING, "the ray tracing library failed")                                                          \
    X(AG_ERROR_SYSTEM, "a system resource is not available")                                                           \
    X(AG_CANCELLED, "cancelled")                                                                                       \
    X(AG_PAUSED, "paused")

typedef enum ag_status {
#define AG_STATUS_ENUM(code, text) code,
    AG_STATUS_LIST(AG_STATUS_ENUM)
#undef AG_STATUS_ENUM
} ag_status;

/* One line of plain text, never NULL, never freed. */
AG_API const char *ag_status_text(ag_status status);

/* Levels by how often they speak: errors end the work; warnings once per cause; info once per phase; debug more
 * often. */
typedef enum ag_log_level { AG_LOG_ERROR, AG_LOG_WARNING, AG_LOG_INFO, AG_LOG_DEBUG } ag_log_level;

/* Receives one message without a line end; about a location in a file "FILE:LINE:COLUMN: error: ...", others do not say
 * their level. Calls are serialised, on the thread that speaks. Of this interface it may call ag_context_cancel,
 * ag_context_pause, ag_film_read_tile and ag_film_read_picture, and nothing else with the context that it is called
 * for. */
typedef void ag_log_fn(void *user, ag_log_level level, const char *message);

/* The phases of a run, in their order. */
#define AG_PHASE_LIST(X)                                                                                               \
    X(AG_PHASE_LOAD, "load")                                                                                           \
    X(AG_PHASE_BVH, "bvh")                                                                                             \
    X(AG_PHASE_PHOTONS, "photons")                                                                                     \
    X(AG_PHASE_MAP, "map")                                                                                             \
    X(AG_PHASE_PRECOMPUTE, "precompute")                                                                               \
    X(AG_PHASE_RENDER, "render")                                                                                       \
    X(AG_PHASE_WRITE, "write")

typedef enum ag_phase {
#define AG_PHASE_ENUM(code, text) code,
    AG_PHASE_LIST(AG_PHASE_ENUM)
#undef AG_PHASE_ENUM
        AG_PHASE_COUNT
} ag_phase;

/* The phase's short name, as in the statistics; never NULL. */
AG_API const char *ag_phase_name(ag_phase phase);

/* Told how far a phase is, fraction in [0, 1], never decreasing within a phase; at 1 the phase is over. Calls are
 * serialised. It may call what an ag_log_fn may. */
typedef void ag_progress_fn(void *user, ag_phase phase, double fraction);

/* "MAJOR.MINOR.PATCH", by semantic versioning. */
AG_API const char *ag_version(void);

#ifdef __cplusplus
}
#endif
#endif
