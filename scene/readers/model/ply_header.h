/* ply_header.h: what a PLY file says it holds.
 * Rests on: Turk, "The PLY Polygon File Format", 1994; names of properties as pbrt-v4 and its exporters have them.
 * Flow: ply_stream -> [here] -> ply_file. Threads: one per file. */
#ifndef AFTERGLOW_PLY_HEADER_H
#define AFTERGLOW_PLY_HEADER_H

#include "model/ply_stream.h"

enum { PLY_MAX_ELEMENTS = 64, PLY_MAX_PROPERTIES = 512 };

/* The meaning of a property: the first eight are a vertex's, the last a face's. */
enum {
    PLY_X,
    PLY_Y,
    PLY_Z,
    PLY_NX,
    PLY_NY,
    PLY_NZ,
    PLY_U,
    PLY_V,
    PLY_VERTEX_SLOTS,
    PLY_CORNERS = PLY_VERTEX_SLOTS,
    PLY_NO_SLOT = -1
};

typedef struct ply_property {
    ply_type type;
    ply_type count_type; /* of lists */
    bool is_list;
    int slot;
} ply_property;

typedef struct ply_element {
    char name[48]; /* cut to fit */
    uint64_t count;
    uint64_t line;                  /* of the header that says so */
    const ply_property *properties; /* the header's */
    size_t property_count;
    bool has_list;
    uint64_t least_bytes;              /* of one; without a list just what one takes, in a binary file */
    int of_slot[PLY_VERTEX_SLOTS + 1]; /* which of the properties, -1 for none */
} ply_element;

typedef struct ply_header {
    ply_element elements[PLY_MAX_ELEMENTS]; /* in the file's order */
    size_t element_count;
    ply_property properties[PLY_MAX_PROPERTIES];
    size_t property_count;
    const ply_element *vertex, *face; /* among the elements; not NULL */
} ply_header;

/* Reads the header and sets the stream's format. A header is whole: there are x, y and z of vertices, and lists of the
 * corners of faces. Errors as those of ply_stream.h. */
ag_status ply_header_read(ply_stream *s, ply_header *out_header);

#endif
