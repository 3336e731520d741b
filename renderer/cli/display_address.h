/* display_address.h: where a viewer listens, as text: HOST:PORT, or [HOST]:PORT where the host is an IPv6 address.
 * Flow: options -> [here] -> display_server. Threads: pure functions. */
#ifndef AFTERGLOW_DISPLAY_ADDRESS_H
#define AFTERGLOW_DISPLAY_ADDRESS_H

#include <stdbool.h>

typedef struct display_address {
    char host[256], port[8];
} display_address;

/* Returns false where the text is no such address; the port is a number in [1, 65535]. */
bool display_address_parse(const char *text, display_address *out_address);

#endif
