/* color_builtin_config.h: the text of config.ocio, which the build turns into C (embed_file.cmake).
 * Flow: config.ocio -> [here] -> color_ocio.cpp. Threads: constant. */
#ifndef AFTERGLOW_COLOR_BUILTIN_CONFIG_H
#define AFTERGLOW_COLOR_BUILTIN_CONFIG_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

extern const unsigned char color_builtin_config[]; /* a zero byte follows the text */
extern const size_t color_builtin_config_size;     /* bytes, without that zero */

#ifdef __cplusplus
}
#endif
#endif
