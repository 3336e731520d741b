/* display_packet.c: see display_packet.h. */
#include "display_packet.h"

#include <stdint.h>
#include <string.h>

enum { PACKET_UPDATE = 3, PACKET_CREATE = 4 };

static const char *const CHANNELS[] = {"R", "G", "B"};

static void put_bytes(display_packet *packet, const void *bytes, size_t size)
{
    if (size > sizeof packet->bytes - packet->size) {
        packet->has_overflowed = true;
        return;
    }
    memcpy(packet->bytes + packet->size, bytes, size);
    packet->size += size;
}

static void write_u32(unsigned char bytes[4], uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (unsigned char)(value >> 8 * i);
}

static void put_u32(display_packet *packet, uint32_t value)
{
    unsigned char bytes[4];
    write_u32(bytes, value);
    put_bytes(packet, bytes, sizeof bytes);
}

static void put_text(display_packet *packet, const char *text) { put_bytes(packet, text, strlen(text) + 1); }

static void begin(display_packet *packet, unsigned char type, bool grabs_focus, const char *name)
{
    const unsigned char head[] = {type, grabs_focus};
    packet->size = 0;
    packet->has_overflowed = false;
    put_u32(packet, 0); /* the length, when it is known */
    put_bytes(packet, head, sizeof head);
    put_text(packet, name);
}

static void end(display_packet *packet) { write_u32(packet->bytes, (uint32_t)packet->size); }

void display_packet_create_picture(display_packet *packet, const char *name, int width, int height)
{
    begin(packet, PACKET_CREATE, true, name);
    put_u32(packet, (uint32_t)width);
    put_u32(packet, (uint32_t)height);
    put_u32(packet, 3);
    for (int i = 0; i < 3; i++)
        put_text(packet, CHANNELS[i]);
    end(packet);
}

void display_packet_update_channel(display_packet *packet, const char *name, int channel, const ag_tile *tile,
                                   const float *pixels)
{
    begin(packet, PACKET_UPDATE, false, name);
    put_text(packet, CHANNELS[channel]);
    put_u32(packet, (uint32_t)tile->x);
    put_u32(packet, (uint32_t)tile->y);
    put_u32(packet, (uint32_t)tile->width);
    put_u32(packet, (uint32_t)tile->height);
    for (int i = 0; i < tile->width * tile->height; i++) {
        uint32_t bits;
        memcpy(&bits, &pixels[3 * i + channel], sizeof bits);
        put_u32(packet, bits);
    }
    end(packet);
}
