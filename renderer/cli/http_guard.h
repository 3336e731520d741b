/* http_guard.h: whom a server on this machine answers: who knows the token, by a name that is this machine's own, and
 * from no page but its own. A page of the network that a browser shows could otherwise send requests to this machine,
 * by a name of its own that it has made to lead here (DNS rebinding).
 * Rests on: RFC 9110, 7.2 (Host); RFC 6454 (Origin). Flow: http_server -> [here]. Threads: any, of a finished guard. */
#ifndef AFTERGLOW_HTTP_GUARD_H
#define AFTERGLOW_HTTP_GUARD_H

#include <stdbool.h>

enum { HTTP_TOKEN_LENGTH = 32, HTTP_HOST_SIZE = 264 };

typedef struct http_guard {
    char token[HTTP_TOKEN_LENGTH + 1]; /* hexadecimal digits */
    char address[64];                  /* that the server listens at, as a number */
    char machine[256];                 /* the machine's name */
    bool is_loopback;                  /* that address is reached from this machine alone */
    unsigned port;
} http_guard;

/* Makes a token that nobody can guess. Returns false where the system gives no random numbers. */
bool http_guard_make_token(http_guard *guard);
/* Compares in a time that does not tell how much of the text is right. token NULL: returns false. */
bool http_guard_knows(const http_guard *guard, const char *token);
/* Returns whether a Host header names this server: localhost, or an address in numbers, or, where others can reach the
 * server, the machine's name. Any other name may be an attacker's, and is refused. */
bool http_guard_is_own_host(const http_guard *guard, const char *host);
/* Returns whether an Origin header is of a page that this server has sent to that host. */
bool http_guard_is_own_origin(const char *origin, const char *host);

#endif
