/* gltf_buffers.c: the bytes of buffers and of views into them, each buffer loaded when it is first needed.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.6.1 (buffers and buffer views).
 * Flow: gltf_accessors, gltf_images -> [here] -> gltf_uri, files. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "gltf/gltf_private.h"

#include "text/input_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Reads the first size bytes of a file. */
static ag_status read_file(const gltf_reader *r, const gltf_value *uri, const char *path, uint64_t size, gltf_file *out)
{
    struct stat status;
    char error[128];
    int descriptor = input_file_open(r->run, path, error, sizeof error);
    if (descriptor < 0)
        return gltf_error(r, uri, "cannot read '%s': %s", path, error), AG_ERROR_INPUT;
    FILE *file = fdopen(descriptor, "rb");
    if (!file || fstat(descriptor, &status) != 0) {
        close(descriptor);
        return AG_ERROR_MEMORY;
    }
    if ((uint64_t)status.st_size < size) {
        fclose(file);
        return gltf_error(r, uri, "'%s' has %lld bytes of the %llu that byteLength says", path,
                          (long long)status.st_size, (unsigned long long)size);
    }
    out->data = malloc((size_t)size);
    bool is_read = out->data && fread(out->data, 1, (size_t)size, file) == size;
    fclose(file);
    if (out->data && !is_read)
        return gltf_error(r, uri, "cannot read '%s' to its end", path), AG_ERROR_INPUT;
    out->size = (size_t)size;
    return out->data ? AG_OK : AG_ERROR_MEMORY;
}

static ag_status load_from_uri(const gltf_reader *r, const gltf_value *buffer, const char *text, uint64_t size,
                               gltf_file *out)
{
    const char *wrong;
    gltf_value uri = gltf_member(buffer, "uri");
    if (!gltf_uri_is_data(text)) {
        char *path = gltf_uri_to_path(r, text, &wrong);
        if (!path)
            return wrong ? gltf_error(r, &uri, "%s", wrong) : AG_ERROR_MEMORY;
        ag_status status = read_file(r, &uri, path, size, out);
        free(path);
        return status;
    }
    out->data = gltf_uri_decode_data(text, &out->size, &wrong);
    if (!out->data)
        return wrong ? gltf_error(r, &uri, "%s", wrong) : AG_ERROR_MEMORY;
    if (out->size < size)
        return gltf_error(r, &uri, "it has %zu bytes of the %llu that byteLength says", out->size,
                          (unsigned long long)size);
    out->size = (size_t)size;
    return AG_OK;
}

static ag_status load_buffer(gltf_reader *r, uint32_t index, gltf_bytes *out_bytes)
{
    gltf_file *file = &r->buffers[index];
    const char *uri = NULL;
    uint64_t size = 0;
    gltf_value buffer;
    AG_TRY(gltf_get_item(r, GLTF_BUFFERS, index, &buffer));
    AG_TRY(gltf_require(r, &buffer, "byteLength"));
    AG_TRY(gltf_get_uint(r, &buffer, "byteLength", &size));
    AG_TRY(gltf_get_text(r, &buffer, "uri", &uri));
    if (!uri) {
        if (index != 0 || !r->chunk.data)
            return gltf_error(r, &buffer, "has no uri%s", index == 0 ? ", nor the file a BIN chunk" : "");
        if (size > r->chunk.size)
            return gltf_error(r, &buffer, "its byteLength is %llu, but the BIN chunk has %zu bytes",
                              (unsigned long long)size, r->chunk.size);
        *out_bytes = (gltf_bytes){r->chunk.data, (size_t)size};
        return AG_OK;
    }
    if (size == 0)
        return gltf_error(r, &buffer, "its byteLength is 0");
    if (!file->data)
        AG_TRY(load_from_uri(r, &buffer, uri, size, file));
    *out_bytes = (gltf_bytes){file->data, file->size};
    return AG_OK;
}

ag_status gltf_buffer_view(gltf_reader *r, uint32_t index, gltf_bytes *out_bytes, uint32_t *out_stride)
{
    uint32_t buffer_index = GLTF_NONE;
    uint64_t offset = 0, size = 0, stride = 0;
    gltf_bytes buffer = {NULL, 0};
    gltf_value view;
    AG_TRY(gltf_get_item(r, GLTF_BUFFER_VIEWS, index, &view));
    AG_TRY(gltf_require(r, &view, "buffer"));
    AG_TRY(gltf_require(r, &view, "byteLength"));
    AG_TRY(gltf_get_index(r, &view, "buffer", GLTF_BUFFERS, &buffer_index));
    AG_TRY(gltf_get_uint(r, &view, "byteOffset", &offset));
    AG_TRY(gltf_get_uint(r, &view, "byteLength", &size));
    AG_TRY(gltf_get_uint(r, &view, "byteStride", &stride));
    AG_TRY(load_buffer(r, buffer_index, &buffer));
    if (stride > 252)
        return gltf_error(r, &view, "its byteStride is %llu; up to 252 are allowed", (unsigned long long)stride);
    if (offset > buffer.size || size > buffer.size - offset)
        return gltf_error(r, &view, "bytes %llu to %llu reach beyond the buffer, which has %zu",
                          (unsigned long long)offset, (unsigned long long)(offset + size), buffer.size);
    *out_bytes = (gltf_bytes){buffer.data + offset, (size_t)size};
    *out_stride = (uint32_t)stride;
    return AG_OK;
}

ag_status gltf_view_span(gltf_reader *r, const gltf_value *at, uint64_t offset, uint64_t count, size_t element_size,
                         gltf_bytes *out_bytes, size_t *out_stride)
{
    uint32_t view_index = GLTF_NONE, view_stride;
    gltf_bytes view;
    AG_TRY(gltf_require(r, at, "bufferView"));
    AG_TRY(gltf_get_index(r, at, "bufferView", GLTF_BUFFER_VIEWS, &view_index));
    AG_TRY(gltf_buffer_view(r, view_index, &view, &view_stride));
    size_t stride = view_stride ? view_stride : element_size;
    if (stride < element_size)
        return gltf_error(r, at, "an element has %zu bytes, but the view's byteStride is %zu", element_size, stride);
    /* count is below 2^32 and the stride below 256: nothing overflows */
    uint64_t needed = count > 0 ? (count - 1) * stride + element_size : 0;
    if (offset > view.size || needed > view.size - offset)
        return gltf_error(r, at, "its %llu elements take bytes %llu to %llu of the view, which has %zu",
                          (unsigned long long)count, (unsigned long long)offset, (unsigned long long)(offset + needed),
                          view.size);
    *out_bytes = (gltf_bytes){view.data + offset, (size_t)needed};
    *out_stride = stride;
    return AG_OK;
}
