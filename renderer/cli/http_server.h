/* http_server.h: answers requests over HTTP: the one file that knows libmicrohttpd. Every request is checked before
 * anybody else sees it: method, Host, Origin, token, length of its body. A thread of its own does all the work, one
 * request after the other, and waits for no reader: readers who are slow take their answers piece by piece, for half a
 * minute at the most. There are at most some tens of connections at once, each of a bounded size; of too many, the one
 * that has been without a whole request for longest is closed. Flow: page_server -> [here]. Threads: main starts and
 * stops; requests are answered on the server's thread. */
#ifndef AFTERGLOW_HTTP_SERVER_H
#define AFTERGLOW_HTTP_SERVER_H

#include "http_guard.h"
#include "shared_bytes.h"

#include <stdbool.h>

enum { HTTP_BODY_MOST = 1024 }; /* bytes of a request's body */

typedef struct http_request {
    const char *path; /* with the slash in front */
    bool is_post;     /* else GET */
    const char *body; /* of POST; a zero behind it */
    void *connection;
} http_request;

/* Returns a value of the URL's query; NULL: it is not there. Lives as long as the request. */
const char *http_request_value(const http_request *request, const char *name);

typedef struct http_answer {
    unsigned status;
    const char *type;   /* of the content, as in its header; NULL: text */
    const char *text;   /* the content; borrowed for good, as a literal is; or */
    shared_bytes *held; /* the content, whose holder the server becomes */
} http_answer;

typedef http_answer http_answer_fn(void *user, const http_request *request);

typedef struct http_server http_server;

/* Listens at an address in numbers, of IPv4 or IPv6, and a port, 0 for any that is free. out_url: of the path / with
 * the token. Returns NULL where it cannot, and out_why, of why_size bytes, says why. */
http_server *http_server_start(const char *address, int port, http_answer_fn *answer, void *user, char *out_url,
                               size_t url_size, char *out_why, size_t why_size);
/* Ends all connections within half a second; what can be answered by then is. NULL is fine. */
void http_server_stop(http_server *server);

#endif
