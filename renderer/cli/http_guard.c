/* http_guard.c: see http_guard.h. */
#define _GNU_SOURCE
#include "http_guard.h"

#include "option_values.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>

bool http_guard_make_token(http_guard *guard)
{
    unsigned char random[HTTP_TOKEN_LENGTH / 2];
    if (getrandom(random, sizeof random, 0) != (ssize_t)sizeof random)
        return false;
    for (size_t i = 0; i < sizeof random; i++)
        snprintf(guard->token + 2 * i, 3, "%02x", random[i]);
    return true;
}

bool http_guard_knows(const http_guard *guard, const char *token)
{
    unsigned differing = 0;
    if (!token || strlen(token) != HTTP_TOKEN_LENGTH)
        return false;
    for (int i = 0; i < HTTP_TOKEN_LENGTH; i++)
        differing |= (unsigned)(token[i] ^ guard->token[i]);
    return differing == 0;
}

/* Finds the name in a Host header; its port must be the server's, and HTTP's own may be left out. Returns false where
 * it is not so. */
static bool split_host(const char *host, unsigned port, char *out_name, size_t size)
{
    const char *end = host[0] == '[' ? strchr(host, ']') : strchr(host, ':');
    int given = 80;
    if (host[0] == '[' && !end)
        return false;
    const size_t length = !end ? strlen(host) : host[0] == '[' ? (size_t)(end + 1 - host) : (size_t)(end - host);
    if (length == 0 || length >= size)
        return false;
    snprintf(out_name, size, "%.*s", (int)length, host);
    if (host[length] == ':' && !parse_int(host + length + 1, 1, 65535, &given))
        return false;
    return (host[length] == ':' || host[length] == '\0') && (unsigned)given == port;
}

/* Returns whether the name is an address in numbers; those in brackets are IPv6. */
static bool is_number(const char *name, bool *out_is_loopback)
{
    struct in_addr four;
    struct in6_addr six;
    char inner[HTTP_HOST_SIZE];
    if (inet_pton(AF_INET, name, &four) == 1) {
        *out_is_loopback = ntohl(four.s_addr) >> 24 == 127;
        return true;
    }
    const size_t length = strlen(name);
    if (length < 3 || name[0] != '[' || name[length - 1] != ']')
        return false;
    snprintf(inner, sizeof inner, "%.*s", (int)length - 2, name + 1);
    if (inet_pton(AF_INET6, inner, &six) != 1)
        return false;
    *out_is_loopback = IN6_IS_ADDR_LOOPBACK(&six);
    return true;
}

bool http_guard_is_own_host(const http_guard *guard, const char *host)
{
    char name[HTTP_HOST_SIZE];
    bool is_loopback = false;
    if (!split_host(host, guard->port, name, sizeof name))
        return false;
    if (is_number(name, &is_loopback))
        return is_loopback || !guard->is_loopback;
    if (strcasecmp(name, "localhost") == 0)
        return true;
    return !guard->is_loopback && guard->machine[0] && strcasecmp(name, guard->machine) == 0;
}

bool http_guard_is_own_origin(const char *origin, const char *host)
{
    static const char SCHEME[] = "http://";
    return strncasecmp(origin, SCHEME, sizeof SCHEME - 1) == 0 && strcasecmp(origin + sizeof SCHEME - 1, host) == 0;
}
