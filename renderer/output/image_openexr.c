/* image_openexr.c: see image_openexr.h. The only file that knows OpenEXR. Threads: see image_openexr.h. */
#include "output/image_openexr.h"

#include <openexr.h>

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TILE_SIDE = 64, ZIP_LEVEL = 4, SHORT_NAME_MAX = 31, FIRST_CAPACITY = 1 << 16 };

static const float LARGEST_HALF = 65504.0f;

typedef struct exr_file {
    const image_description *description;
    const float *pixels;
    exr_context_t context;
    unsigned char *bytes;
    size_t size, capacity;
    exr_encode_pipeline_t pipeline;
    exr_result_t (*compress)(exr_encode_pipeline_t *pipeline); /* OpenEXR's own */
    int *indices;                                              /* of each channel of the file, in the description */
    float *planes;                                             /* the values of one chunk, channel by channel */
    bool lacks_memory;
    char *message; /* the first one of OpenEXR's */
    size_t message_size;
} exr_file;

/* --- what OpenEXR calls --- */

static void keep_first_message(exr_const_context_t context, exr_result_t code, const char *text)
{
    void *user = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS)
        return;
    exr_file *file = user;
    if (file->message[0] == '\0')
        snprintf(file->message, file->message_size, "OpenEXR cannot encode it: %s", text);
}

/* The table of the chunks' offsets is written last, over the zeros at its place. */
static int64_t write_bytes(exr_const_context_t context, void *user, const void *bytes, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t report)
{
    exr_file *file = user;
    (void)context, (void)report;
    const size_t end = (size_t)(offset + size);
    if (end > file->capacity) {
        size_t capacity = file->capacity > 0 ? file->capacity : FIRST_CAPACITY;
        while (capacity < end)
            capacity *= 2;
        unsigned char *grown = realloc(file->bytes, capacity);
        if (!grown) {
            file->lacks_memory = true;
            return -1;
        }
        file->bytes = grown;
        file->capacity = capacity;
    }
    if (offset > file->size)
        memset(file->bytes + file->size, 0, (size_t)offset - file->size);
    memcpy(file->bytes + offset, bytes, (size_t)size);
    file->size = end > file->size ? end : file->size;
    return (int64_t)size;
}

/* --- the header --- */

static image_sample_type type_of_channel(const image_description *description, int channel)
{
    return description->channel_types ? description->channel_types[channel] : description->type;
}

static const char *name_of_attribute(const image_attribute *attribute)
{
    return attribute->text && strcmp(attribute->name, "DateTime") == 0 ? "capDate" : attribute->name;
}

/* Names beyond 31 letters raise a flag that old readers do not know. */
static bool has_long_names(const image_description *description)
{
    bool is_long = false;
    for (int c = 0; c < description->channel_count; c++)
        is_long = is_long || strlen(description->channel_names[c]) > SHORT_NAME_MAX;
    for (int i = 0; i < description->attribute_count; i++)
        is_long = is_long || strlen(description->attributes[i].name) > SHORT_NAME_MAX;
    return is_long;
}

static exr_result_t add_attribute(exr_context_t context, const image_attribute *attribute)
{
    const char *name = name_of_attribute(attribute);
    if (attribute->text)
        return exr_attr_set_string(context, 0, name, attribute->text);
    if (attribute->number_count == 1)
        return exr_attr_set_float(context, 0, name, attribute->numbers[0]);
    if (attribute->number_count == 16) {
        exr_attr_m44f_t matrix;
        memcpy(matrix.m, attribute->numbers, sizeof matrix.m);
        return exr_attr_set_m44f(context, 0, name, &matrix);
    }
    if (attribute->number_count == 8 && strcmp(name, "chromaticities") == 0) {
        const float *n = attribute->numbers;
        const exr_attr_chromaticities_t corners = {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]};
        return exr_attr_set_chromaticities(context, 0, name, &corners);
    }
    return exr_attr_set_float_vector(context, 0, name, attribute->number_count, attribute->numbers);
}

static exr_result_t write_header(exr_file *file)
{
    const image_description *d = file->description;
    const exr_attr_box2i_t display = {.max = {.x = d->full_width - 1, .y = d->full_height - 1}};
    const exr_attr_box2i_t data = {.min = {.x = d->x, .y = d->y},
                                   .max = {.x = d->x + d->width - 1, .y = d->y + d->height - 1}};
    const exr_attr_v2f_t center = {.x = 0.0f, .y = 0.0f};
    exr_context_t context = file->context;
    int part;
    exr_result_t result = EXR_ERR_SUCCESS;
    if (has_long_names(d))
        result = exr_set_longname_support(context, 1);
    if (result == EXR_ERR_SUCCESS)
        result = exr_add_part(context, NULL, d->is_tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part);
    if (result == EXR_ERR_SUCCESS)
        result = exr_initialize_required_attr(context, 0, &display, &data, 1.0f, &center, 1.0f,
                                              EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP);
    if (result == EXR_ERR_SUCCESS && d->is_tiled)
        result = exr_set_tile_descriptor(context, 0, TILE_SIDE, TILE_SIDE, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN);
    if (result == EXR_ERR_SUCCESS)
        result = exr_set_zip_compression_level(context, 0, ZIP_LEVEL);
    for (int c = 0; c < d->channel_count && result == EXR_ERR_SUCCESS; c++)
        result = (exr_result_t)exr_add_channel(context, 0, d->channel_names[c],
                                               type_of_channel(d, c) == IMAGE_HALF ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (int i = 0; i < d->attribute_count && result == EXR_ERR_SUCCESS; i++)
        result = add_attribute(context, &d->attributes[i]);
    return result == EXR_ERR_SUCCESS ? exr_write_header(context) : result;
}

/* --- the pixels --- */

/* The file orders channels by their names, the description by layers. */
static bool find_channels(exr_file *file)
{
    const image_description *d = file->description;
    file->indices = malloc((size_t)d->channel_count * sizeof *file->indices);
    for (int c = 0; file->indices && c < file->pipeline.channel_count; c++) {
        file->indices[c] = 0;
        while (strcmp(d->channel_names[file->indices[c]], file->pipeline.channels[c].channel_name) != 0)
            file->indices[c]++;
    }
    return file->indices != NULL;
}

/* Copies the chunk whose first pixel is (x, y) of those given, and tells the pipeline of it. */
static void fill_planes(exr_file *file, int x, int y)
{
    const image_description *d = file->description;
    const size_t width = (size_t)file->pipeline.chunk.width, height = (size_t)file->pipeline.chunk.height;
    const size_t stride = (size_t)d->channel_count;
    for (size_t line = 0; line < height; line++) {
        const float *first = file->pixels + (((size_t)y + line) * (size_t)d->width + (size_t)x) * stride;
        for (size_t c = 0; c < stride; c++) {
            const float *from = first + file->indices[c];
            float *to = file->planes + (c * height + line) * width;
            if (file->pipeline.channels[c].data_type == EXR_PIXEL_HALF)
                for (size_t i = 0; i < width; i++) /* beyond the largest half lies infinity */
                    to[i] = fminf(fmaxf(from[i * stride], -LARGEST_HALF), LARGEST_HALF);
            else
                for (size_t i = 0; i < width; i++)
                    to[i] = from[i * stride];
        }
    }
    for (size_t c = 0; c < stride; c++) {
        exr_coding_channel_info_t *channel = &file->pipeline.channels[c];
        channel->encode_from_ptr = (const uint8_t *)(file->planes + c * height * width);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_pixel_stride = sizeof(float);
        channel->user_line_stride = (int32_t)(width * sizeof(float));
    }
}

/* A chunk that is as long as its pixels is read as not compressed. OpenEXR 3.1 keeps one that compression has left at
 * just that length, which is then read as noise. */
static exr_result_t compress(exr_encode_pipeline_t *pipeline)
{
    const exr_file *file = pipeline->encoding_user_data;
    exr_result_t result = file->compress(pipeline);
    if (result == EXR_ERR_SUCCESS && pipeline->compressed_bytes == pipeline->packed_bytes)
        memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, (size_t)pipeline->packed_bytes);
    return result;
}

static exr_result_t write_chunk(exr_file *file, const exr_chunk_info_t *chunk, int x, int y)
{
    const bool is_first = !file->indices;
    exr_encode_pipeline_t *pipeline = &file->pipeline;
    exr_result_t result = is_first ? exr_encoding_initialize(file->context, 0, chunk, pipeline)
                                   : exr_encoding_update(file->context, 0, chunk, pipeline);
    if (result != EXR_ERR_SUCCESS)
        return result;
    if (is_first && !find_channels(file))
        return EXR_ERR_OUT_OF_MEMORY;
    fill_planes(file, x, y);
    if (is_first) {
        result = exr_encoding_choose_default_routines(file->context, 0, pipeline);
        file->compress = pipeline->compress_fn;
        pipeline->encoding_user_data = file;
        pipeline->compress_fn = compress;
    }
    return result == EXR_ERR_SUCCESS ? exr_encoding_run(file->context, 0, pipeline) : result;
}

static exr_result_t write_lines(exr_file *file)
{
    const image_description *d = file->description;
    int32_t lines = 1;
    exr_result_t result = exr_get_scanlines_per_chunk(file->context, 0, &lines);
    file->planes = malloc((size_t)d->width * (size_t)lines * (size_t)d->channel_count * sizeof *file->planes);
    if (!file->planes)
        return EXR_ERR_OUT_OF_MEMORY;
    for (int y = 0; y < d->height && result == EXR_ERR_SUCCESS; y += lines) {
        exr_chunk_info_t chunk;
        result = exr_write_scanline_chunk_info(file->context, 0, d->y + y, &chunk);
        if (result == EXR_ERR_SUCCESS)
            result = write_chunk(file, &chunk, 0, y);
    }
    return result;
}

static exr_result_t write_tiles(exr_file *file)
{
    const image_description *d = file->description;
    exr_result_t result = EXR_ERR_SUCCESS;
    file->planes = malloc((size_t)TILE_SIDE * TILE_SIDE * (size_t)d->channel_count * sizeof *file->planes);
    if (!file->planes)
        return EXR_ERR_OUT_OF_MEMORY;
    for (int y = 0; y < d->height; y += TILE_SIDE)
        for (int x = 0; x < d->width && result == EXR_ERR_SUCCESS; x += TILE_SIDE) {
            exr_chunk_info_t chunk;
            result = exr_write_tile_chunk_info(file->context, 0, x / TILE_SIDE, y / TILE_SIDE, 0, 0, &chunk);
            if (result == EXR_ERR_SUCCESS)
                result = write_chunk(file, &chunk, x, y);
        }
    return result;
}

ag_status image_openexr_encode(const image_description *description, const float *pixels, unsigned char **out_bytes,
                               size_t *out_size, char *message, size_t message_size)
{
    exr_file file = {.description = description, .pixels = pixels, .message = message, .message_size = message_size};
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = keep_first_message;
    start.user_data = &file;
    start.write_fn = write_bytes;
    snprintf(message, message_size, "%s", "");

    /* The name is for error texts alone: all bytes go to write_bytes. */
    exr_result_t result = exr_start_write(&file.context, "picture.exr", EXR_WRITE_FILE_DIRECTLY, &start);
    if (result == EXR_ERR_SUCCESS)
        result = write_header(&file);
    if (result == EXR_ERR_SUCCESS)
        result = description->is_tiled ? write_tiles(&file) : write_lines(&file);
    exr_encoding_destroy(file.context, &file.pipeline);
    const exr_result_t finished = exr_finish(&file.context);
    result = result == EXR_ERR_SUCCESS ? finished : result;
    free(file.indices);
    free(file.planes);
    if (result == EXR_ERR_SUCCESS) {
        *out_bytes = file.bytes;
        *out_size = file.size;
        return AG_OK;
    }
    free(file.bytes);
    const bool lacks_memory = file.lacks_memory || result == EXR_ERR_OUT_OF_MEMORY;
    if (lacks_memory)
        snprintf(message, message_size, "there is no memory for it");
    else if (message[0] == '\0')
        snprintf(message, message_size, "OpenEXR cannot encode it: %s", exr_get_error_code_as_string(result));
    return lacks_memory ? AG_ERROR_MEMORY : AG_ERROR_OUTPUT;
}
