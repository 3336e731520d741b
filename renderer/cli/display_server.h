/* display_server.h: the picture sent to a viewer while it is rendered, in the protocol of tev, which pbrt-v4 speaks as
 * well: packets of a length of 4 bytes, which counts itself, a type, and little-endian fields; strings end with a zero.
 * Rests on: tev (Müller), src/Ipc.cpp and include/tev/Ipc.h; pbrt-v4 (Pharr, Jakob, Humphreys),
 * src/pbrt/util/display.cpp. Flow: passes -> [here] -> a TCP connection. Threads: main calls; a thread of its own
 * connects and sends, so that no worker ever waits for the network. It looks at the film a few times a second and sends
 * the tiles that have changed: where the network is slow, there are fewer updates, and nothing queues up. */
#ifndef AFTERGLOW_DISPLAY_SERVER_H
#define AFTERGLOW_DISPLAY_SERVER_H

#include "afterglow/afterglow.h"

#include <stdbool.h>

typedef struct display_server display_server;

/* Begins to connect to "HOST:PORT", as display_address_is_valid has it. A viewer that cannot be reached, or is lost, is
 * told once, through warn, and looked for again every few seconds. NULL: there is no memory or thread for it. */
display_server *display_server_start(const char *address, ag_log_fn *warn, void *user);
/* Gives up what has not been sent. NULL is fine. */
void display_server_stop(display_server *d);

/* Shows a film, as a picture with the channels R, G and B under the name and the process's number. The film is borrowed
 * until display_server_leave. server NULL is fine, here and below. */
void display_server_show(display_server *d, const ag_film *film, const char *name);
/* Sends what has not been sent of the film, and lets go of it. Returns when all is sent, or the viewer is not there, or
 * has not taken anything for five seconds, or after ten seconds or patience_seconds (>= 0; INFINITY is fine) in all, or
 * at a signal to stop; a picture that is given up is told of. */
void display_server_leave(display_server *d, double patience_seconds);

#endif
