/* display_address.c: see display_address.h. */
#include "display_address.h"

#include "option_values.h"

#include <stdio.h>
#include <string.h>

bool display_address_parse(const char *text, display_address *out_address)
{
    enum { PORT_MAX = 65535 };
    const char *colon = strrchr(text, ':'), *host = text;
    int port;
    if (!colon || !parse_int(colon + 1, 1, PORT_MAX, &port))
        return false;
    size_t length = (size_t)(colon - text);
    const bool is_bracketed = length > 2 && text[0] == '[' && text[length - 1] == ']';
    if (is_bracketed) {
        host++;
        length -= 2;
    }
    if (length == 0 || length >= sizeof out_address->host || (!is_bracketed && strcspn(host, ":[]") < length))
        return false;
    snprintf(out_address->host, sizeof out_address->host, "%.*s", (int)length, host);
    snprintf(out_address->port, sizeof out_address->port, "%d", port);
    return true;
}
