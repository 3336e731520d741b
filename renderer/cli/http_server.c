/* http_server.c: see http_server.h. */
#define _GNU_SOURCE
#include "http_server.h"

#include <arpa/inet.h>
#include <errno.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum {
    CONNECTIONS_MOST = 48,       /* with more, the one that has been without a whole request for longest is closed */
    CONNECTIONS_OVER = 16,       /* connections beyond that, until it is closed */
    CONNECTION_BYTES = 16 << 10, /* of headers and what is sent at once */
    IDLE_SECONDS = 10,           /* of a connection on which nothing moves */
    ANSWER_SECONDS = 30,         /* for an answer to be taken */
    PIECE_BYTES = 8 << 10,
    LAST_PAUSES = 100,    /* of 5 ms, at most, for answers at the end */
    STACK_BYTES = 8 << 20 /* views of OpenColorIO are made on it */
};

struct http_server {
    struct MHD_Daemon *daemon;
    http_guard guard;
    http_answer_fn *answer;
    void *user;
    struct visitor {
        bool is_there, is_asking; /* asking: its request has been let in, and not been answered to the end */
        int socket;
        uint64_t since; /* counts connections and ended requests: its value at this one's last */
    } visitors[CONNECTIONS_MOST + CONNECTIONS_OVER]; /* used by the server's thread alone */
    uint64_t turn;
    atomic_int underway; /* requests that have been let in and not been answered to the end */
};

/* A request under way: its body as it comes. */
typedef struct underway {
    size_t size;
    char body[HTTP_BODY_MOST + 1];
} underway;

/* An answer under way. */
typedef struct reading {
    shared_bytes *held;
    time_t end; /* s of the monotonic clock */
} reading;

static time_t now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec;
}

/* --- answers --- */

static ssize_t read_piece(void *user, uint64_t at, char *out, size_t most)
{
    const reading *r = user;
    const size_t left = r->held->size - (size_t)at, size = left < most ? left : most;
    if (now_s() > r->end)
        return MHD_CONTENT_READER_END_WITH_ERROR;
    memcpy(out, r->held->bytes + at, size);
    return (ssize_t)size;
}

static void end_reading(void *user)
{
    reading *r = user;
    shared_bytes_drop(r->held);
    free(r);
}

static struct MHD_Response *make_response(const http_answer *answer)
{
    if (!answer->held) /* the text is only read */
        return MHD_create_response_from_buffer(strlen(answer->text), (void *)(uintptr_t)answer->text,
                                               MHD_RESPMEM_PERSISTENT);
    reading *r = malloc(sizeof *r);
    if (!r) {
        shared_bytes_drop(answer->held);
        return NULL;
    }
    *r = (reading){.held = answer->held, .end = now_s() + ANSWER_SECONDS};
    struct MHD_Response *response =
        MHD_create_response_from_callback(answer->held->size, PIECE_BYTES, read_piece, r, end_reading);
    if (!response)
        end_reading(r);
    return response;
}

/* What the browser may do with the page: load nothing besides it, show it in no frame, and read it from
 * nowhere else. */
static const char *const HEADERS[][2] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src 'self' blob:; "
     "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Frame-Options", "DENY"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cache-Control", "no-store"},
};

static enum MHD_Result send_answer(struct MHD_Connection *connection, const http_answer *answer, bool closes)
{
    struct MHD_Response *response = make_response(answer);
    if (!response)
        return MHD_NO;
    MHD_add_response_header(response, "Content-Type", answer->type ? answer->type : "text/plain; charset=utf-8");
    for (size_t i = 0; i < sizeof HEADERS / sizeof *HEADERS; i++)
        MHD_add_response_header(response, HEADERS[i][0], HEADERS[i][1]);
    if (answer->status == MHD_HTTP_METHOD_NOT_ALLOWED)
        MHD_add_response_header(response, "Allow", "GET, POST");
    if (closes)
        MHD_add_response_header(response, "Connection", "close");
    const enum MHD_Result result = MHD_queue_response(connection, answer->status, response);
    MHD_destroy_response(response);
    return result;
}

/* --- requests --- */

typedef struct header_search {
    const char *name, *value;
    int count;
} header_search;

static enum MHD_Result note_header(void *user, enum MHD_ValueKind kind, const char *name, const char *value)
{
    header_search *search = user;
    (void)kind;
    if (strcasecmp(name, search->name) == 0) {
        search->value = value ? value : "";
        search->count++;
    }
    return MHD_YES;
}

static header_search find_header(struct MHD_Connection *connection, const char *name)
{
    header_search search = {.name = name};
    MHD_get_connection_values(connection, MHD_HEADER_KIND, note_header, &search);
    return search;
}

const char *http_request_value(const http_request *request, const char *name)
{
    return MHD_lookup_connection_value(request->connection, MHD_GET_ARGUMENT_KIND, name);
}

static http_answer refusal(unsigned status, const char *text) { return (http_answer){.status = status, .text = text}; }

/* Finds the announced length of the body. Returns false where it is not a number, or is announced in no way that is
 * known. */
static bool body_length(struct MHD_Connection *connection, size_t *out_length)
{
    const header_search length = find_header(connection, "Content-Length");
    *out_length = 0;
    if (find_header(connection, "Transfer-Encoding").count > 0 || length.count > 1)
        return false;
    if (length.count == 0)
        return true;
    for (const char *digit = length.value; *digit; digit++) {
        if (*digit < '0' || *digit > '9')
            return false;
        if (*out_length <= HTTP_BODY_MOST)
            *out_length = 10 * *out_length + (size_t)(*digit - '0');
    }
    return *length.value != '\0';
}

/* Returns the refusal of a request whose method, headers or length are not as they should be; status 0: it is not
 * refused. */
static http_answer check_request(const http_server *s, struct MHD_Connection *connection, const char *method)
{
    size_t length;
    const bool is_post = strcmp(method, MHD_HTTP_METHOD_POST) == 0;
    const header_search host = find_header(connection, "Host"), origin = find_header(connection, "Origin");
    if (!is_post && strcmp(method, MHD_HTTP_METHOD_GET) != 0)
        return refusal(MHD_HTTP_METHOD_NOT_ALLOWED, "Only GET and POST are answered.\n");
    if (host.count != 1)
        return refusal(MHD_HTTP_BAD_REQUEST, "A request has one Host header.\n");
    if (!http_guard_is_own_host(&s->guard, host.value))
        return refusal(MHD_HTTP_FORBIDDEN, "The Host header names another machine.\n");
    if (origin.count > 1 || (origin.count == 1 && !http_guard_is_own_origin(origin.value, host.value)))
        return refusal(MHD_HTTP_FORBIDDEN, "The request comes from a page of another origin.\n");
    if (!http_guard_knows(&s->guard, MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "token")))
        return refusal(MHD_HTTP_FORBIDDEN, "The URL that the program has told holds a token, which is missing here.\n");
    if (!body_length(connection, &length))
        return refusal(MHD_HTTP_LENGTH_REQUIRED, "The length of the body is not known.\n");
    if (length > (is_post ? HTTP_BODY_MOST : 0))
        return refusal(MHD_HTTP_CONTENT_TOO_LARGE, "The body is too long.\n");
    return (http_answer){0};
}

/* --- who is there --- */

/* Where there are too many connections, closes the one that has waited longest for a whole request, so that slow ones
 * do not keep others out. */
static void make_room(http_server *s)
{
    struct visitor *oldest = NULL;
    int count = 0;
    for (size_t i = 0; i < sizeof s->visitors / sizeof *s->visitors; i++) {
        struct visitor *v = &s->visitors[i];
        count += v->is_there;
        if (v->is_there && !v->is_asking && (!oldest || v->since < oldest->since))
            oldest = v;
    }
    if (count <= CONNECTIONS_MOST || !oldest)
        return;
    shutdown(oldest->socket, SHUT_RDWR); /* libmicrohttpd sees its end, and closes it */
    oldest->since = ++s->turn;
}

static void on_visit(void *user, struct MHD_Connection *connection, void **visitor,
                     enum MHD_ConnectionNotificationCode what)
{
    http_server *s = user;
    if (what == MHD_CONNECTION_NOTIFY_CLOSED) {
        if (*visitor)
            *(struct visitor *)*visitor = (struct visitor){0};
        *visitor = NULL;
        return;
    }
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    for (size_t i = 0; info && i < sizeof s->visitors / sizeof *s->visitors; i++)
        if (!s->visitors[i].is_there) {
            s->visitors[i] = (struct visitor){.is_there = true, .socket = info->connect_fd, .since = ++s->turn};
            *visitor = &s->visitors[i];
            break;
        }
    make_room(s);
}

static void set_asking(http_server *s, struct MHD_Connection *connection, bool is_asking)
{
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    struct visitor *v = info ? info->socket_context : NULL;
    if (!v)
        return;
    v->is_asking = is_asking;
    v->since = ++s->turn;
}

static enum MHD_Result on_request(void *user, struct MHD_Connection *connection, const char *path, const char *method,
                                  const char *version, const char *upload, size_t *upload_size, void **request)
{
    http_server *s = user;
    underway *u = *request;
    (void)version;
    if (!u) { /* the headers are there, the body is not */
        const http_answer refused = check_request(s, connection, method);
        if (refused.status != 0)
            return send_answer(connection, &refused, true);
        *request = calloc(1, sizeof *u);
        if (!*request)
            return MHD_NO;
        atomic_fetch_add(&s->underway, 1);
        set_asking(s, connection, true);
        return MHD_YES;
    }
    if (*upload_size > 0) {
        if (*upload_size > HTTP_BODY_MOST - u->size)
            return MHD_NO;
        memcpy(u->body + u->size, upload, *upload_size);
        u->size += *upload_size;
        *upload_size = 0;
        return MHD_YES;
    }
    const http_request asked = {
        .path = path, .is_post = strcmp(method, MHD_HTTP_METHOD_POST) == 0, .body = u->body, .connection = connection};
    const http_answer answer = s->answer(s->user, &asked);
    return send_answer(connection, &answer, false);
}

static void on_end(void *user, struct MHD_Connection *connection, void **request,
                   enum MHD_RequestTerminationCode ending)
{
    http_server *s = user;
    (void)ending;
    if (*request) {
        atomic_fetch_sub(&s->underway, 1);
        set_asking(s, connection, false);
    }
    free(*request);
    *request = NULL;
}

/* --- the server --- */

typedef union socket_address {
    struct sockaddr any;
    struct sockaddr_in four;
    struct sockaddr_in6 six;
} socket_address;

static bool parse_address(const char *text, int port, socket_address *out)
{
    memset(out, 0, sizeof *out);
    if (inet_pton(AF_INET, text, &out->four.sin_addr) == 1) {
        out->four.sin_family = AF_INET;
        out->four.sin_port = htons((uint16_t)port);
        return true;
    }
    if (inet_pton(AF_INET6, text, &out->six.sin6_addr) != 1)
        return false;
    out->six.sin6_family = AF_INET6;
    out->six.sin6_port = htons((uint16_t)port);
    return true;
}

static bool is_loopback(const socket_address *at)
{
    return at->any.sa_family == AF_INET ? ntohl(at->four.sin_addr.s_addr) >> 24 == 127
                                        : IN6_IS_ADDR_LOOPBACK(&at->six.sin6_addr);
}

/* Opens the listening socket here, since libmicrohttpd does not say why it fails. Returns -1, with errno. */
static int listen_at(const socket_address *at)
{
    const int on = 1, listener = socket(at->any.sa_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (listener < 0)
        return -1;
    setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    const socklen_t size = at->any.sa_family == AF_INET ? sizeof at->four : sizeof at->six;
    if (bind(listener, &at->any, size) == 0 && listen(listener, CONNECTIONS_MOST) == 0)
        return listener;
    const int error = errno;
    close(listener);
    errno = error;
    return -1;
}

static unsigned port_of(int listener)
{
    socket_address at;
    socklen_t size = sizeof at;
    if (getsockname(listener, &at.any, &size) != 0)
        return 0;
    return ntohs(at.any.sa_family == AF_INET ? at.four.sin_port : at.six.sin6_port);
}

/* Starts the threads with all signals blocked, since the main thread handles them. */
static struct MHD_Daemon *start_daemon(http_server *s, int listener)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    struct MHD_Daemon *daemon = MHD_start_daemon(
        MHD_USE_AUTO_INTERNAL_THREAD, 0, NULL, NULL, on_request, s, MHD_OPTION_LISTEN_SOCKET, listener,
        MHD_OPTION_CONNECTION_LIMIT, (unsigned)(CONNECTIONS_MOST + CONNECTIONS_OVER),
        MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)CONNECTION_BYTES, MHD_OPTION_CONNECTION_TIMEOUT,
        (unsigned)IDLE_SECONDS, MHD_OPTION_THREAD_STACK_SIZE, (size_t)STACK_BYTES, MHD_OPTION_STRICT_FOR_CLIENT, 1,
        MHD_OPTION_NOTIFY_COMPLETED, on_end, s, MHD_OPTION_NOTIFY_CONNECTION, on_visit, s, MHD_OPTION_END);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return daemon;
}

/* Returns the name by which the machine itself reaches the address. */
static void make_url(const http_guard *guard, bool is_any, char *out, size_t size)
{
    const char *host = !is_any ? guard->address : guard->machine[0] ? guard->machine : "localhost";
    const bool is_six = strchr(host, ':') != NULL;
    snprintf(out, size, "http://%s%s%s:%u/?token=%s", is_six ? "[" : "", host, is_six ? "]" : "", guard->port,
             guard->token);
}

http_server *http_server_start(const char *address, int port, http_answer_fn *answer, void *user, char *out_url,
                               size_t url_size, char *out_why, size_t why_size)
{
    socket_address at;
    http_server *s = calloc(1, sizeof *s);
    snprintf(out_why, why_size, "there is no memory or thread for it");
    if (!s)
        return NULL;
    s->answer = answer;
    s->user = user;
    int listener = -1;
    if (!parse_address(address, port, &at))
        snprintf(out_why, why_size, "'%s' is no address", address);
    else if (!http_guard_make_token(&s->guard) || (listener = listen_at(&at)) < 0)
        snprintf(out_why, why_size, "%s", strerror(errno));
    if (listener >= 0) {
        const bool is_any = at.any.sa_family == AF_INET ? at.four.sin_addr.s_addr == INADDR_ANY
                                                        : IN6_IS_ADDR_UNSPECIFIED(&at.six.sin6_addr);
        s->guard.is_loopback = is_loopback(&at);
        s->guard.port = port_of(listener);
        snprintf(s->guard.address, sizeof s->guard.address, "%s", address);
        if (gethostname(s->guard.machine, sizeof s->guard.machine - 1) != 0)
            s->guard.machine[0] = '\0';
        make_url(&s->guard, is_any, out_url, url_size);
        if ((s->daemon = start_daemon(s, listener)))
            return s;
        close(listener);
    }
    free(s);
    return NULL;
}

void http_server_stop(http_server *server)
{
    const struct timespec pause = {.tv_nsec = 5000000};
    if (!server)
        return;
    const int listener = MHD_quiesce_daemon(server->daemon);
    for (int i = 0; i < LAST_PAUSES && atomic_load(&server->underway) > 0; i++)
        nanosleep(&pause, NULL); /* lets the answer to a request to end be sent */
    MHD_stop_daemon(server->daemon);
    if (listener >= 0)
        close(listener);
    free(server);
}
