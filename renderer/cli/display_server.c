/* display_server.c: see display_server.h. */
#define _GNU_SOURCE
#include "display_server.h"

#include "display_address.h"
#include "display_packet.h"
#include "signals.h"

#include <errno.h>
#include <linux/sockios.h>
#include <math.h>
#include <netdb.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum {
    LOOK_INTERVAL_MS = 200,       /* between two looks at the film */
    POLL_MS = 100,                /* how long a wait for the network lasts before it is looked whether to go on */
    CONNECT_PATIENCE_MS = 3000,   /* for a host that does not answer */
    RETRY_MS = 2000,              /* between attempts to connect */
    SEND_PATIENCE_MS = 30000,     /* for a viewer that is busy, while there is still work to do */
    LEAVE_PATIENCE_MS = 5000,     /* for one that takes nothing, when nothing else is left to do */
    LEAVE_TOTAL_MS = 10000,       /* for one that takes something now and then, when nothing else is left to do */
    SEND_BUFFER_BYTES = 256 << 10 /* what the kernel holds back for a slow viewer */
};

struct display_server {
    display_address address;
    const char *address_text;
    ag_log_fn *warn;
    void *user;
    pthread_t thread;
    pthread_mutex_t lock; /* of all that follows */
    pthread_cond_t changed;
    const ag_film *film; /* borrowed; NULL: there is nothing to show */
    uint64_t *versions;  /* of its tiles, as the viewer has them */
    uint64_t turn;       /* which of the films it is */
    char name[512];
    bool is_leaving, is_done; /* main waits for the film to be sent; it is sent, or cannot be */
    bool is_stopping;
    bool is_reached; /* there has been a connection */
    bool has_warned;
    uint64_t sent_bytes;
    /* used by the sender's thread alone */
    int socket; /* -1: none */
    int64_t next_attempt_ms;
    uint64_t opened_turn;  /* which film the viewer has a picture of; 0: none */
    char opened_name[512]; /* the name of that picture */
};

static int64_t now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000 + t.tv_nsec / 1000000;
}

static bool is_wanted(display_server *d, uint64_t turn)
{
    pthread_mutex_lock(&d->lock);
    const bool wanted = !d->is_stopping && d->film && d->turn == turn;
    pthread_mutex_unlock(&d->lock);
    return wanted;
}

/* Warns of a failure, the first time only. */
static void warn(display_server *d, const char *what, const char *why)
{
    char text[512];
    pthread_mutex_lock(&d->lock);
    const bool has_warned = d->has_warned;
    d->has_warned = true;
    pthread_mutex_unlock(&d->lock);
    if (has_warned)
        return;
    snprintf(text, sizeof text, "--display-server %s: %s: %s; the picture is rendered all the same", d->address_text,
             what, why);
    d->warn(d->user, AG_LOG_WARNING, text);
}

/* --- the connection, the sender's --- */

static void disconnect(display_server *d)
{
    close(d->socket);
    d->socket = -1;
    d->opened_turn = 0;
}

/* Waits until the socket takes something, as long as the film is wanted. Returns 0, or an errno. */
static int wait_for_socket(display_server *d, uint64_t turn, int patience_ms)
{
    struct pollfd waiting = {.fd = d->socket, .events = POLLOUT};
    for (int waited = 0; waited < patience_ms; waited += POLL_MS) {
        if (!is_wanted(d, turn))
            return ECANCELED;
        const int ready = poll(&waiting, 1, POLL_MS);
        if (ready > 0)
            return 0;
        if (ready < 0 && errno != EINTR)
            return errno;
    }
    return ETIMEDOUT;
}

static int connect_to(display_server *d, const struct addrinfo *to, uint64_t turn)
{
    const int buffer = SEND_BUFFER_BYTES;
    d->socket = socket(to->ai_family, to->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, to->ai_protocol);
    if (d->socket < 0)
        return errno;
    setsockopt(d->socket, SOL_SOCKET, SO_SNDBUF, &buffer, sizeof buffer);
    int error = connect(d->socket, to->ai_addr, to->ai_addrlen) == 0 ? 0 : errno;
    if (error == EINPROGRESS) {
        socklen_t size = sizeof error;
        const int waited = wait_for_socket(d, turn, CONNECT_PATIENCE_MS);
        if (waited != 0)
            error = waited;
        else if (getsockopt(d->socket, SOL_SOCKET, SO_ERROR, &error, &size) != 0)
            error = errno;
    }
    if (error != 0)
        disconnect(d);
    return error;
}

static bool connect_to_viewer(display_server *d, uint64_t turn)
{
    const struct addrinfo hints = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM};
    struct addrinfo *found;
    if (now_ms() < d->next_attempt_ms)
        return false;
    d->next_attempt_ms = now_ms() + RETRY_MS;
    const int unknown = getaddrinfo(d->address.host, d->address.port, &hints, &found);
    if (!is_wanted(d, turn)) { /* that may have taken long */
        if (unknown == 0)
            freeaddrinfo(found);
        return false;
    }
    if (unknown != 0) {
        warn(d, "there is no such host", gai_strerror(unknown));
        return false;
    }
    int error = 0;
    for (const struct addrinfo *to = found; to && d->socket < 0 && error != ECANCELED; to = to->ai_next)
        error = connect_to(d, to, turn);
    freeaddrinfo(found);
    if (d->socket < 0 && error != ECANCELED)
        warn(d, "no viewer answers", strerror(error));
    if (d->socket < 0)
        return false;
    pthread_mutex_lock(&d->lock);
    d->is_reached = true;
    pthread_mutex_unlock(&d->lock);
    return true;
}

static void lose_viewer(display_server *d, int error)
{
    if (error != ECANCELED)
        warn(d, "the viewer is lost", strerror(error));
    d->next_attempt_ms = 0; /* it may be there again */
    disconnect(d);
}

static bool send_packet(display_server *d, const display_packet *packet, uint64_t turn)
{
    int error = packet->has_overflowed ? EMSGSIZE : 0;
    for (size_t sent = 0; sent < packet->size && error == 0;) {
        const ssize_t count = send(d->socket, packet->bytes + sent, packet->size - sent, MSG_NOSIGNAL);
        if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK))
            error = wait_for_socket(d, turn, SEND_PATIENCE_MS);
        else if (count < 0 && errno != EINTR)
            error = errno;
        if (count <= 0)
            continue;
        sent += (size_t)count;
        pthread_mutex_lock(&d->lock);
        d->sent_bytes += (uint64_t)count;
        pthread_mutex_unlock(&d->lock);
    }
    if (error != 0)
        lose_viewer(d, error);
    return error == 0;
}

/* Returns whether the viewer is still there, as far as can be told. */
static int connection_error(const display_server *d)
{
    unsigned char byte;
    const ssize_t count = recv(d->socket, &byte, sizeof byte, MSG_PEEK | MSG_DONTWAIT);
    return count > 0 || (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) ? 0
           : count == 0                                                                            ? EPIPE
                                                                                                   : errno;
}

/* Waits until the viewer's machine has all that was sent. */
static void await_arrival(display_server *d, uint64_t turn)
{
    int error = 0, underway = 1;
    while (error == 0 && underway > 0) {
        const struct timespec pause = {.tv_nsec = 2000000};
        error = connection_error(d);
        if (error == 0 && ioctl(d->socket, SIOCOUTQ, &underway) != 0)
            underway = 0;
        if (error == 0 && underway > 0) {
            error = is_wanted(d, turn) ? 0 : ECANCELED;
            nanosleep(&pause, NULL);
        }
    }
    if (error != 0)
        lose_viewer(d, error);
}

/* --- the film, the sender's --- */

/* Tells the viewer of a new picture. */
static bool open_picture(display_server *d, uint64_t turn)
{
    display_packet packet;
    pthread_mutex_lock(&d->lock);
    const bool is_there = d->film && d->turn == turn;
    if (is_there) {
        int width, height;
        ag_film_pixels(d->film, &width, &height);
        memcpy(d->opened_name, d->name, sizeof d->opened_name);
        display_packet_create_picture(&packet, d->opened_name, width, height);
        memset(d->versions, 0, ag_film_tile_count(d->film) * sizeof *d->versions);
    }
    pthread_mutex_unlock(&d->lock);
    if (!is_there || !send_packet(d, &packet, turn))
        return false;
    d->opened_turn = turn;
    return true;
}

/* Finds a tile that the viewer does not have as it is now, and counts it as sent. *which: where the search begins; it
 * then stands behind the tile. Returns false where there is none. */
static bool take_changed_tile(display_server *d, uint64_t turn, size_t *which, ag_tile *out_tile, float *out_pixels)
{
    bool is_taken = false;
    pthread_mutex_lock(&d->lock);
    for (; d->film && d->turn == turn && !is_taken && *which < ag_film_tile_count(d->film); ++*which)
        if (ag_film_read_tile(d->film, *which, d->versions[*which], out_tile, out_pixels)) {
            d->versions[*which] = out_tile->version;
            is_taken = true;
        }
    pthread_mutex_unlock(&d->lock);
    return is_taken;
}

/* Sends what has changed; waits until it has arrived where nothing more is to come. */
static void send_film(display_server *d, uint64_t turn, bool is_last)
{
    float pixels[3 * AG_TILE_SIZE * AG_TILE_SIZE];
    display_packet packet;
    ag_tile tile;
    size_t which = 0;
    const int error = d->socket >= 0 ? connection_error(d) : 0;
    if (error != 0)
        lose_viewer(d, error);
    if (d->socket < 0 && !connect_to_viewer(d, turn))
        return;
    if (d->opened_turn != turn && !open_picture(d, turn))
        return;
    while (take_changed_tile(d, turn, &which, &tile, pixels))
        for (int channel = 0; channel < 3; channel++) {
            display_packet_update_channel(&packet, d->opened_name, channel, &tile, pixels);
            if (!send_packet(d, &packet, turn))
                return;
        }
    if (is_last)
        await_arrival(d, turn);
}

static void wait_until(display_server *d, int64_t end_ms)
{
    const struct timespec end = {.tv_sec = (time_t)(end_ms / 1000), .tv_nsec = (long)(end_ms % 1000) * 1000000};
    pthread_cond_timedwait(&d->changed, &d->lock, &end);
}

static void *run(void *user)
{
    display_server *d = user;
    pthread_mutex_lock(&d->lock);
    while (!d->is_stopping) {
        const bool was_leaving = d->is_leaving;
        const uint64_t turn = d->turn;
        if (d->film) {
            pthread_mutex_unlock(&d->lock);
            send_film(d, turn, was_leaving);
            if (was_leaving && d->opened_turn != turn) /* the viewer was lost: the film is sent again if it is back */
                send_film(d, turn, true);
            pthread_mutex_lock(&d->lock);
        }
        if (was_leaving && d->turn == turn) {
            d->is_done = true;
            pthread_cond_broadcast(&d->changed);
        }
        if (!d->is_stopping && d->is_leaving == was_leaving)
            wait_until(d, now_ms() + LOOK_INTERVAL_MS);
    }
    pthread_mutex_unlock(&d->lock);
    return NULL;
}

/* --- main's --- */

/* Starts the thread with all signals blocked, since the main thread handles them. */
static bool start_thread(display_server *d)
{
    sigset_t all, before;
    pthread_attr_t attributes;
    sigfillset(&all);
    if (pthread_attr_init(&attributes) != 0)
        return false;
    pthread_attr_setstacksize(&attributes, (size_t)1 << 20);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const bool is_there = pthread_create(&d->thread, &attributes, run, d) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    pthread_attr_destroy(&attributes);
    return is_there;
}

static bool make_condition(pthread_cond_t *condition)
{
    pthread_condattr_t attributes;
    if (pthread_condattr_init(&attributes) != 0)
        return false;
    const bool is_made =
        pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC) == 0 && pthread_cond_init(condition, &attributes) == 0;
    pthread_condattr_destroy(&attributes);
    return is_made;
}

display_server *display_server_start(const char *address, ag_log_fn *warn_with, void *user)
{
    display_server *d = calloc(1, sizeof *d);
    if (!d)
        return NULL;
    d->socket = -1;
    d->warn = warn_with;
    d->user = user;
    d->address_text = address;
    if (display_address_parse(address, &d->address)) {
        pthread_mutex_init(&d->lock, NULL);
        if (make_condition(&d->changed)) {
            if (start_thread(d))
                return d;
            pthread_cond_destroy(&d->changed);
        }
        pthread_mutex_destroy(&d->lock);
    }
    free(d);
    return NULL;
}

void display_server_stop(display_server *d)
{
    struct timespec end;
    if (!d)
        return;
    pthread_mutex_lock(&d->lock);
    d->is_stopping = true;
    pthread_cond_broadcast(&d->changed);
    pthread_mutex_unlock(&d->lock);
    clock_gettime(CLOCK_REALTIME, &end);
    end.tv_sec += 1;
    if (pthread_timedjoin_np(d->thread, NULL, &end) != 0) {
        pthread_detach(d->thread); /* it waits for the name service, and needs its memory then */
        return;
    }
    if (d->socket >= 0)
        close(d->socket);
    pthread_cond_destroy(&d->changed);
    pthread_mutex_destroy(&d->lock);
    free(d->versions);
    free(d);
}

void display_server_show(display_server *d, const ag_film *film, const char *name)
{
    if (!d)
        return;
    uint64_t *versions = calloc(ag_film_tile_count(film) + 1, sizeof *versions);
    pthread_mutex_lock(&d->lock);
    free(d->versions);
    d->versions = versions;
    d->film = versions ? film : NULL;
    d->turn++;
    d->is_leaving = d->is_done = false;
    snprintf(d->name, sizeof d->name, "%s (%ld)", name, (long)getpid());
    pthread_cond_broadcast(&d->changed);
    pthread_mutex_unlock(&d->lock);
}

/* Waits, with the lock held, until the film is sent. Returns false where the patience is over first, or a signal to
 * stop has come. */
static bool await_sent(display_server *d, int64_t patience_ms)
{
    const int64_t end_ms = now_ms() + (patience_ms < LEAVE_TOTAL_MS ? patience_ms : LEAVE_TOTAL_MS);
    int64_t idle_end_ms = now_ms() + LEAVE_PATIENCE_MS;
    uint64_t sent = d->sent_bytes;
    while (!d->is_done) {
        const int64_t now = now_ms();
        if (d->sent_bytes != sent)
            idle_end_ms = now + LEAVE_PATIENCE_MS;
        sent = d->sent_bytes;
        if (signals_stop() || now >= end_ms || now >= idle_end_ms)
            return false;
        wait_until(d, now + POLL_MS < end_ms ? now + POLL_MS : end_ms);
    }
    return true;
}

void display_server_leave(display_server *d, double patience_seconds)
{
    if (!d)
        return;
    pthread_mutex_lock(&d->lock);
    d->is_leaving = d->film != NULL;
    pthread_cond_broadcast(&d->changed);
    const bool is_given_up = d->is_leaving && !await_sent(d, (int64_t)(1000.0 * fmin(patience_seconds, 3600.0)));
    const bool is_reached = d->is_reached;
    d->film = NULL;
    d->is_leaving = false;
    pthread_mutex_unlock(&d->lock);
    if (is_given_up && is_reached)
        d->warn(d->user, AG_LOG_WARNING,
                "--display-server: the viewer has not taken the whole picture: what it shows is not complete");
    else if (is_given_up)
        warn(d, "no viewer answers", "it is not waited for any longer");
}
