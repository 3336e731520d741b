/* display_packet.h: the packets that a viewer is sent, see display_server.h.
 * Flow: display_server -> [here] -> its socket. Threads: pure functions. */
#ifndef AFTERGLOW_DISPLAY_PACKET_H
#define AFTERGLOW_DISPLAY_PACKET_H

#include "afterglow/afterglow.h"

#include <stdbool.h>
#include <stddef.h>

enum { DISPLAY_PACKET_BYTES_MAX = AG_TILE_SIZE * AG_TILE_SIZE * 4 + 1024 };

typedef struct display_packet {
    size_t size;
    bool has_overflowed; /* it would be larger than the buffer, and is not to be sent */
    unsigned char bytes[DISPLAY_PACKET_BYTES_MAX];
} display_packet;

/* Makes the packet of a new picture, black, with the channels R, G and B; the viewer is to show it. */
void display_packet_create_picture(display_packet *out_packet, const char *name, int width, int height);

/* Makes a packet with one channel of a tile. pixels: RGB, rows without gaps; channel: 0, 1, 2. */
void display_packet_update_channel(display_packet *out_packet, const char *name, int channel, const ag_tile *tile,
                                   const float *pixels);

#endif
