/* gltf_images.c: the pictures of textures: files, data URIs, and parts of buffers.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.8.3 (images).
 * Flow: gltf_textures -> [here] -> gltf_buffers, gltf_uri -> texture_image. Threads: one per scene. */
#include "gltf/gltf_private.h"

#include "texture/texture_image_load.h"

#include <stdio.h>
#include <stdlib.h>

static ag_status load_from_file(gltf_reader *r, const gltf_value *uri, const char *text, image_encoding encoding,
                                uint32_t *out_image_index)
{
    const char *wrong;
    char message[1024] = "";
    char *path = gltf_uri_to_path(r, text, &wrong);
    if (!path)
        return wrong ? gltf_error(r, uri, "%s", wrong) : AG_ERROR_MEMORY;
    ag_status status =
        texture_image_load(r->run, &r->scene->textures, path, encoding, out_image_index, message, sizeof message);
    if (status != AG_OK && status != AG_CANCELLED)
        gltf_error(r, uri, "%s", message[0] ? message : ag_status_text(status));
    free(path);
    return status;
}

/* Decodes a data URI's bytes, once. */
static ag_status decode_uri(gltf_reader *r, uint32_t index, const gltf_value *uri, const char *text,
                            gltf_bytes *out_bytes)
{
    const char *wrong;
    gltf_file *file = &r->images[index];
    if (!file->data)
        file->data = gltf_uri_decode_data(text, &file->size, &wrong);
    if (!file->data)
        return wrong ? gltf_error(r, uri, "%s", wrong) : AG_ERROR_MEMORY;
    *out_bytes = (gltf_bytes){file->data, file->size};
    return AG_OK;
}

ag_status gltf_load_image(gltf_reader *r, uint32_t index, image_encoding encoding, uint32_t *out_image_index)
{
    const char *text = NULL;
    char name[512], message[1024] = "";
    uint32_t view_index = GLTF_NONE, stride;
    gltf_bytes bytes;
    gltf_value at;
    AG_TRY(gltf_get_item(r, GLTF_IMAGES, index, &at));
    gltf_value uri = gltf_member(&at, "uri");
    AG_TRY(gltf_get_text(r, &at, "uri", &text));
    AG_TRY(gltf_get_index(r, &at, "bufferView", GLTF_BUFFER_VIEWS, &view_index));
    if (!text && view_index == GLTF_NONE)
        return gltf_error(r, &at, "has neither a uri nor a bufferView");
    if (text && !gltf_uri_is_data(text))
        return load_from_file(r, &uri, text, encoding, out_image_index);
    AG_TRY(text ? decode_uri(r, index, &uri, text, &bytes) : gltf_buffer_view(r, view_index, &bytes, &stride));
    snprintf(name, sizeof name, "%.400s#images[%u]", r->where.file, index);
    ag_status status = texture_image_load_memory(r->run, &r->scene->textures, name, bytes.data, bytes.size, encoding,
                                                 out_image_index, message, sizeof message);
    if (status != AG_OK && status != AG_CANCELLED)
        gltf_error(r, text ? &uri : &at, "%s", message[0] ? message : ag_status_text(status));
    return status;
}
