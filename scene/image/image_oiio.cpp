/* image_oiio.cpp: the only file that knows OpenImageIO; a module of its own, opened when the first picture is read, or
 * written other than as EXR. Its exceptions end here, as a status and a text. Flow: file -> [here] -> image_reader.c;
 * image_file.c (renderer) -> [here] -> bytes in memory. Threads: any; OpenImageIO itself is told to use none of its
 * own. */
#include "image/image_layout.h"
#include "image/image_module.h"
#include "image/image_signature.h"

#include <OpenImageIO/Imath.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <climits>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

const int largest_jpeg_side = 65500;  /* libjpeg ends the process beyond that */
const size_t jpeg_text_limit = 16384; /* ... and when metadata do not fit into a marker of 64 KiB */

/* A header may say anything: a picture of more values than the first must come of a file that can hold them. The
 * densest there is, a blank picture in OpenEXR's DWA, puts some 30000 into a byte. */
const std::uint64_t trusted_values = std::uint64_t(1) << 28;
const std::uint64_t values_per_byte = std::uint64_t(1) << 16;

/* Decoded bytes between two questions whether reading is to end: some 20 ms of the slowest format. */
const std::uint64_t piece_bytes = std::uint64_t(1) << 20;
/* Strips of a TIFF file that are larger are read row by row, which takes zlib twice the time of a whole strip. */
const std::uint64_t largest_strip_bytes = std::uint64_t(1) << 23;

struct cancelled {
}; /* thrown where reading is to end */

/* Runs work and is the only function where an exception becomes a status. */
template <typename Work>
ag_status guarded(ag_status failure, char *message, size_t message_size, Work &&work) noexcept
{
    try {
        std::snprintf(message, message_size, "%s", "");
        work();
        return AG_OK;
    } catch (const std::bad_alloc &) {
        std::snprintf(message, message_size, "out of memory");
        return AG_ERROR_MEMORY;
    } catch (const cancelled &) {
        return AG_CANCELLED;
    } catch (const std::exception &exception) {
        std::snprintf(message, message_size, "%s", exception.what());
    } catch (...) {
        std::snprintf(message, message_size, "OpenImageIO failed without saying why");
    }
    return failure;
}

/* reason: OpenImageIO's text, empty where it has none, of several lines where a library below it has failed, too. */
[[noreturn]] void fail(const std::string &what, std::string reason)
{
    for (size_t at = reason.find('\n'); at != std::string::npos; at = reason.find('\n', at))
        reason.replace(at, 1, "; ");
    throw std::runtime_error(reason.empty() ? what : what + ": " + reason);
}

OIIO::TypeDesc stored_type(image_sample_type type)
{
    switch (type) {
    case IMAGE_UINT8: return OIIO::TypeUInt8;
    case IMAGE_UINT16: return OIIO::TypeUInt16;
    case IMAGE_HALF: return OIIO::TypeHalf;
    case IMAGE_FLOAT: break;
    }
    return OIIO::TypeFloat;
}

void add_attributes(OIIO::ImageSpec &spec, const image_description &description, bool jpeg)
{
    size_t text_size = 0;
    bool dated = false;
    for (int i = 0; i < description.attribute_count; i++) {
        const image_attribute &attribute = description.attributes[i];
        text_size += std::strlen(attribute.name) + (attribute.text ? std::strlen(attribute.text) : 0);
        if (jpeg && text_size > jpeg_text_limit)
            break;
        dated = dated || std::strcmp(attribute.name, "DateTime") == 0;
        if (attribute.text)
            spec.attribute(attribute.name, attribute.text);
        else if (attribute.number_count == 1)
            spec.attribute(attribute.name, attribute.numbers[0]);
        else if (attribute.number_count == 16)
            spec.attribute(attribute.name, OIIO::TypeMatrix, attribute.numbers);
        else if (attribute.number_count > 1)
            spec.attribute(attribute.name, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, attribute.number_count),
                           attribute.numbers);
    }
    /* The writers add the time of day where there is no DateTime. One of a type that no format knows as a date keeps
     * them from that, and is itself dropped. */
    if (!dated) {
        const float no_date[2] = {0.0f, 0.0f};
        spec.attribute("DateTime", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 2), no_date);
    }
}

OIIO::ImageSpec make_spec(const image_description &description, const std::string &extension)
{
    const bool jpeg = extension == "jpg" || extension == "jpeg";
    const int channel_count = jpeg ? std::min(description.channel_count, 3) : description.channel_count;
    OIIO::ImageSpec spec(description.width, description.height, channel_count, stored_type(description.type));
    spec.x = description.x;
    spec.y = description.y;
    spec.full_x = 0;
    spec.full_y = 0;
    spec.full_width = description.full_width;
    spec.full_height = description.full_height;
    spec.channelnames.assign(description.channel_names, description.channel_names + channel_count);
    spec.alpha_channel = spec.channelindex("A");
    spec.z_channel = spec.channelindex("Z");
    if (description.color_space)
        spec.attribute("oiio:ColorSpace", description.color_space);
    add_attributes(spec, description, jpeg);
    if (jpeg) {
        if (description.width > largest_jpeg_side || description.height > largest_jpeg_side)
            throw std::runtime_error("a JPEG picture is at most 65500 pixels wide and high");
        spec.attribute("compression", "jpeg:95");
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    return spec;
}

/* The PNG writer says that all is well whatever happened: see that the last chunk is there. */
bool ends_as_png(const std::vector<unsigned char> &bytes)
{
    static const unsigned char end[] = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
    return bytes.size() > sizeof end && std::equal(std::begin(end), std::end(end), bytes.end() - sizeof end);
}

std::vector<unsigned char> encode_to_vector(const std::string &extension, const image_description &description,
                                            const float *pixels)
{
    const OIIO::ImageSpec spec = make_spec(description, extension);
    const std::string name = "picture." + extension; /* in error texts only: everything goes to the proxy */
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput proxy(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name);
    if (!output)
        fail("OpenImageIO has no writer for it", OIIO::geterror());
    output->threads(1);
    if (!output->supports("ioproxy") || !output->set_ioproxy(&proxy))
        fail("OpenImageIO cannot write it to memory", output->geterror());
    if (!output->open(name, spec))
        fail("OpenImageIO cannot begin it", output->geterror());
    /* By the strides the channels that JPEG does not keep are passed over. */
    const OIIO::stride_t pixel_size = description.channel_count * static_cast<OIIO::stride_t>(sizeof(float));
    if (!output->write_image(OIIO::TypeFloat, pixels, pixel_size, pixel_size * description.width))
        fail("OpenImageIO cannot encode it", output->geterror());
    if (!output->close())
        fail("OpenImageIO cannot finish it", output->geterror());
    if (bytes.empty() || (extension == "png" && !ends_as_png(bytes)))
        fail("OpenImageIO encoded it only in part", output->geterror());
    return bytes;
}

ag_status encode(const char *extension, const image_description *description, const float *pixels,
                 unsigned char **out_bytes, size_t *out_size, char *message, size_t message_size) noexcept
{
    *out_bytes = nullptr;
    *out_size = 0;
    return guarded(AG_ERROR_OUTPUT, message, message_size, [=] {
        const std::vector<unsigned char> bytes = encode_to_vector(extension, *description, pixels);
        *out_bytes = static_cast<unsigned char *>(std::malloc(bytes.size()));
        if (!*out_bytes)
            throw std::bad_alloc();
        std::memcpy(*out_bytes, bytes.data(), bytes.size());
        *out_size = bytes.size();
    });
}

image_sample_type sample_type_of(OIIO::TypeDesc format)
{
    switch (format.basetype) {
    case OIIO::TypeDesc::UINT8:
    case OIIO::TypeDesc::INT8: return IMAGE_UINT8;
    case OIIO::TypeDesc::UINT32:
    case OIIO::TypeDesc::INT32:
    case OIIO::TypeDesc::UINT16:
    case OIIO::TypeDesc::INT16: return IMAGE_UINT16;
    case OIIO::TypeDesc::HALF: return IMAGE_HALF;
    default: return IMAGE_FLOAT;
    }
}

/* Throws where the picture has more values than the file can hold, before they take memory. */
void check_size(const OIIO::ImageSpec &spec, std::uint64_t file_size)
{
    const std::uint64_t pixels = static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
    const std::uint64_t channels = static_cast<std::uint64_t>(spec.nchannels);
    if (pixels > std::numeric_limits<std::ptrdiff_t>::max() / sizeof(float) / channels ||
        (pixels * channels > trusted_values && pixels * channels / values_per_byte > file_size))
        throw std::runtime_error("its header promises " + std::to_string(spec.width) + " x " +
                                 std::to_string(spec.height) + " pixels of " + std::to_string(spec.nchannels) +
                                 " channels, which a file of " + std::to_string(file_size) + " bytes cannot hold");
}

struct channel_range {
    int begin, count;
};

/* The channels that are the picture: all where no layer has red, green and blue. */
channel_range find_colors(const OIIO::ImageSpec &spec)
{
    std::vector<const char *> names;
    for (const std::string &name : spec.channelnames)
        names.push_back(name.c_str());
    int begin;
    const int count = image_layout_find_colors(names.data(), static_cast<int>(names.size()), &begin);
    return count > 0 ? channel_range{begin, count} : channel_range{0, spec.nchannels};
}

void end_if_cancelled(const image_request &request)
{
    if (request.is_cancelled && request.is_cancelled(request.user))
        throw cancelled();
}

/* The rows that are best read together. Those of a strip of a TIFF file can be had one by one, unless each channel has
 * strips of its own: then each row would be searched from the beginning of all of them. */
int block_rows(const OIIO::ImageInput &input, const OIIO::ImageSpec &spec)
{
    const std::string format = input.format_name();
    if (format == "openexr")
        return image_layout_exr_rows(spec.get_string_attribute("compression").c_str());
    if (format != "tiff")
        return 1;
    const int told = spec.get_int_attribute("tiff:RowsPerStrip", 0);
    const int rows = told > 0 ? std::min(told, spec.height) : spec.height;
    const bool is_apart = spec.get_int_attribute("tiff:PlanarConfiguration", 1) != 1;
    return !is_apart && static_cast<std::uint64_t>(rows) * spec.scanline_bytes(true) > largest_strip_bytes ? 1 : rows;
}

/* Returns how many blocks make a piece, at least one. */
int blocks_of_piece(std::uint64_t block_bytes)
{
    return static_cast<int>(std::max<std::uint64_t>(piece_bytes / std::max<std::uint64_t>(block_bytes, 1), 1));
}

/* The end of a piece that begins at `at`. */
int piece_end(int at, int block_size, int block_count, int end)
{
    return static_cast<int>(std::min<std::int64_t>(at + static_cast<std::int64_t>(block_size) * block_count, end));
}

/* Where the pixels go. */
struct pixel_sink {
    unsigned char *bytes;
    OIIO::TypeDesc type;
    OIIO::stride_t pixel_size, row_size;
};

void read_rows(OIIO::ImageInput &input, const OIIO::ImageSpec &spec, const image_request &request,
               channel_range channels, const pixel_sink &sink)
{
    const int rows = block_rows(input, spec), bottom = spec.y + spec.height;
    const int count = blocks_of_piece(static_cast<std::uint64_t>(rows) * spec.scanline_bytes(true));
    for (int y = spec.y, end; y < bottom; y = end) {
        end_if_cancelled(request);
        end = piece_end(y, rows, count, bottom);
        if (!input.read_scanlines(0, 0, y, end, spec.z, channels.begin, channels.begin + channels.count, sink.type,
                                  sink.bytes + (y - spec.y) * sink.row_size, sink.pixel_size, sink.row_size))
            fail("OpenImageIO cannot decode it", input.geterror());
    }
}

void read_tile_rows(OIIO::ImageInput &input, const OIIO::ImageSpec &spec, const image_request &request,
                    channel_range channels, const pixel_sink &sink)
{
    const int right = spec.x + spec.width, bottom = spec.y + spec.height;
    const int count = blocks_of_piece(spec.tile_bytes(true));
    for (int y = spec.y, y_end; y < bottom; y = y_end) {
        y_end = piece_end(y, spec.tile_height, 1, bottom);
        for (int x = spec.x, x_end; x < right; x = x_end) {
            end_if_cancelled(request);
            x_end = piece_end(x, spec.tile_width, count, right);
            if (!input.read_tiles(0, 0, x, x_end, y, y_end, spec.z, spec.z + 1, channels.begin,
                                  channels.begin + channels.count, sink.type,
                                  sink.bytes + (y - spec.y) * sink.row_size + (x - spec.x) * sink.pixel_size,
                                  sink.pixel_size, sink.row_size))
                fail("OpenImageIO cannot decode it", input.geterror());
        }
    }
}

struct free_memory {
    void operator()(void *memory) const noexcept { std::free(memory); }
};

/* From malloc, as its owner frees it. */
template <typename Value>
using pixel_values = std::unique_ptr<Value, free_memory>;

template <typename Value>
pixel_values<Value> read_values(OIIO::ImageInput &input, const OIIO::ImageSpec &spec, const image_request &request,
                                channel_range channels, OIIO::TypeDesc type)
{
    const size_t row_values = static_cast<size_t>(spec.width) * static_cast<size_t>(channels.count);
    const size_t row_size = row_values * sizeof(Value);
    pixel_values<Value> values(static_cast<Value *>(std::malloc(row_size * static_cast<size_t>(spec.height))));
    if (!values)
        throw std::bad_alloc();
    const pixel_sink sink = {reinterpret_cast<unsigned char *>(values.get()), type,
                             static_cast<OIIO::stride_t>(static_cast<size_t>(channels.count) * sizeof(Value)),
                             static_cast<OIIO::stride_t>(row_size)};
    if (spec.tile_width > 0)
        read_tile_rows(input, spec, request, channels, sink);
    else
        read_rows(input, spec, request, channels, sink);
    return values;
}

/* The difference of two numbers of a file, clamped to the range of int. */
int difference(int a, int b)
{
    const long long exact = static_cast<long long>(a) - b;
    return static_cast<int>(std::min<long long>(std::max<long long>(exact, -INT_MAX), INT_MAX));
}

/* Without pixels. */
image describe(const OIIO::ImageSpec &spec)
{
    image read = image();
    read.width = spec.width;
    read.height = spec.height;
    read.x = difference(spec.x, spec.full_x);
    read.y = difference(spec.y, spec.full_y);
    read.full_width = spec.full_width;
    read.full_height = spec.full_height;
    read.channel_count = spec.nchannels;
    read.type = sample_type_of(spec.format);
    read.is_multiplied_by_alpha = spec.alpha_channel >= 0 && spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
    const OIIO::ParamValue *chromaticities =
        spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
    if (chromaticities) {
        read.has_chromaticities = true;
        std::memcpy(read.chromaticities, chromaticities->data(), sizeof read.chromaticities);
    }
    return read;
}

/* Whether an open file holds pictures beside the first: of Photoshop's files and icons these are layers and sizes of
 * it. The file then stands at another one. HEIF's reader decodes each picture that it is asked for. */
bool has_several(OIIO::ImageInput &input)
{
    const std::string format = input.format_name();
    if (format != "openexr" && format != "tiff" && format != "gif" && format != "heif" && format != "webp")
        return false;
    const bool has = input.seek_subimage(1, 0);
    input.geterror(); /* that there is none is no error */
    return has;
}

/* The name of the reader for a picture, by its first bytes. */
const char *find_reader(const std::string &path, const char *name, OIIO::Filesystem::IOProxy *proxy)
{
    unsigned char bytes[IMAGE_SIGNATURE_BYTES];
    const size_t size =
        proxy ? proxy->pread(bytes, sizeof bytes, 0) : OIIO::Filesystem::read_bytes(path, bytes, sizeof bytes);
    const char *reader = image_signature_reader(name, bytes, size);
    if (!reader)
        fail("OpenImageIO cannot open it", size == 0 ? "it is empty" : "it is no picture of a known format");
    return reader;
}

std::unique_ptr<OIIO::ImageInput> open_input(const std::string &path, const char *name,
                                             OIIO::Filesystem::IOProxy *proxy)
{
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1); /* colours as stored, not multiplied by alpha */
    if (proxy)
        wishes.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(find_reader(path, name, proxy));
    if (!input)
        fail("OpenImageIO cannot open it", OIIO::geterror());
    OIIO::ImageSpec spec;
    if (!input->open(path, spec, wishes))
        fail("OpenImageIO cannot open it", input->geterror());
    input->threads(1);
    return input;
}

/* proxy: the file's bytes, or NULL: they are read from path. */
image read_picture(const std::string &path, const char *name, const image_request &request,
                   OIIO::Filesystem::IOProxy *proxy)
{
    end_if_cancelled(request);
    const std::unique_ptr<OIIO::ImageInput> input = open_input(path, name, proxy);
    const OIIO::ImageSpec spec = input->spec();
    if (spec.deep)
        throw std::runtime_error("it is a deep picture, whose pixels hold several samples: flatten it first (oiiotool "
                                 "--flatten)");
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
        throw std::runtime_error("it is not a flat picture");
    image read = describe(spec);
    channel_range channels = find_colors(spec);
    if (request.wish == IMAGE_ALL_CHANNELS)
        channels.count = spec.nchannels - channels.begin;
    read.channel_count = channels.count;
    check_size(spec, proxy ? proxy->size() : OIIO::Filesystem::file_size(path));
    pixel_values<unsigned char> bytes;
    pixel_values<float> floats;
    if (request.wish == IMAGE_COMPACT_COLORS && read.type == IMAGE_UINT8)
        bytes = read_values<unsigned char>(*input, spec, request, channels, OIIO::TypeUInt8);
    else
        floats = read_values<float>(*input, spec, request, channels, OIIO::TypeFloat);
    end_if_cancelled(request);
    read.is_first_of_several = has_several(*input);
    read.bytes = bytes.release();
    read.pixels = floats.release();
    return read;
}

ag_status decode(const char *path, const char *name, const image_request *request, image *out_image, char *message,
                 size_t message_size) noexcept
{
    *out_image = image();
    return guarded(AG_ERROR_INPUT, message, message_size,
                   [=] { *out_image = read_picture(path, name, *request, nullptr); });
}

ag_status decode_memory(const char *extension, const unsigned char *bytes, size_t size, const image_request *request,
                        image *out_image, char *message, size_t message_size) noexcept
{
    *out_image = image();
    return guarded(AG_ERROR_INPUT, message, message_size, [=] {
        OIIO::Filesystem::IOMemReader proxy(const_cast<unsigned char *>(bytes), size); /* which only reads */
        const std::string name = std::string("picture.") + extension;
        *out_image = read_picture(name, name.c_str(), *request, &proxy);
    });
}

/* --- parts of files that hold tiles and coarser levels --- */

/* Other readers have no coarser levels, and some of them decode a picture as they open it. */
bool may_have_levels(const std::string &reader) { return reader == "openexr" || reader == "tiff" || reader == "dds"; }

/* Whether a level is one that parts are read of: a flat picture that fills its frame, in tiles, as the first but for
 * its size, which is half of the one before. */
bool is_usable_level(const OIIO::ImageSpec &spec, const image_levels_header &header)
{
    const image &picture = header.picture;
    if (spec.depth > 1 || spec.deep || spec.x != 0 || spec.y != 0 || spec.full_x != 0 || spec.full_y != 0 ||
        spec.full_width != spec.width || spec.full_height != spec.height || spec.tile_depth > 1 ||
        !image_layout_is_usable_tile(spec.tile_width, spec.width) ||
        !image_layout_is_usable_tile(spec.tile_height, spec.height))
        return false;
    if (header.level_count == 0)
        return true;
    const image_level &before = header.levels[header.level_count - 1];
    return spec.nchannels == header.file_channel_count && sample_type_of(spec.format) == picture.type &&
           image_layout_is_half(spec.width, before.width) && image_layout_is_half(spec.height, before.height);
}

ag_status open_levels(const char *path, const char *name, void **out_file, image_levels_header *out_header,
                      char *message, size_t message_size) noexcept
{
    *out_file = nullptr;
    *out_header = image_levels_header();
    return guarded(AG_ERROR_INPUT, message, message_size, [=] {
        if (!may_have_levels(find_reader(path, name, nullptr)))
            return;
        std::unique_ptr<OIIO::ImageInput> input = open_input(path, name, nullptr);
        image_levels_header header = image_levels_header();
        OIIO::ImageSpec spec = input->spec();
        if (spec.tile_width == 0 || spec.width < 1 || spec.height < 1 || spec.nchannels < 1 ||
            find_colors(spec).begin != 0)
            return;
        header.picture = describe(spec);
        header.picture.is_first_of_several = has_several(*input);
        if (!input->seek_subimage(0, 0))
            fail("OpenImageIO cannot go back to its first part", input->geterror());
        header.file_channel_count = spec.nchannels;
        header.picture.channel_count = find_colors(spec).count;
        check_size(spec, OIIO::Filesystem::file_size(path));
        while (header.level_count < IMAGE_LEVELS_MAX && is_usable_level(spec, header)) {
            header.levels[header.level_count++] = {spec.width, spec.height, image_layout_tile_bits(spec.tile_width),
                                                   image_layout_tile_bits(spec.tile_height)};
            if (!input->seek_subimage(0, header.level_count))
                break;
            spec = input->spec();
        }
        input->geterror(); /* that there is no further level is no error */
        /* Overviews that end before a single pixel leave what is far away unfiltered. */
        if (header.level_count < 2 || header.levels[header.level_count - 1].width != 1 ||
            header.levels[header.level_count - 1].height != 1)
            return;
        *out_header = header;
        *out_file = input.release();
    });
}

/* The file is asked for its sizes again whenever another level of it is read, and may have been written to. */
bool is_level_unchanged(const OIIO::ImageSpec &spec, const image_levels_header &header, const image_level &level)
{
    return spec.width == level.width && spec.height == level.height && spec.depth <= 1 &&
           spec.tile_width == 1 << level.tile_width_bits && spec.tile_height == 1 << level.tile_height_bits &&
           spec.tile_depth <= 1 && spec.nchannels == header.file_channel_count;
}

ag_status read_tile(void *file, const image_levels_header *header, int level, int x, int y, int channel_begin,
                    int channel_end, bool as_bytes, void *out_pixels) noexcept
{
    char message[256];
    return guarded(AG_ERROR_INPUT, message, sizeof message, [=] {
        OIIO::ImageInput &input = *static_cast<OIIO::ImageInput *>(file);
        const OIIO::ImageSpec spec = input.spec_dimensions(0, level);
        if (!is_level_unchanged(spec, *header, header->levels[level]))
            fail("its sizes are not those that it began with", input.geterror());
        const OIIO::stride_t pixel_size =
            (channel_end - channel_begin) * static_cast<int>(as_bytes ? 1 : sizeof(float));
        const int right = std::min(x + spec.tile_width, spec.width),
                  bottom = std::min(y + spec.tile_height, spec.height);
        if (x >= right || y >= bottom ||
            !input.read_tiles(0, level, x, right, y, bottom, 0, 1, channel_begin, channel_end,
                              as_bytes ? OIIO::TypeUInt8 : OIIO::TypeFloat, out_pixels, pixel_size,
                              pixel_size * spec.tile_width))
            fail("OpenImageIO cannot decode it", input.geterror());
    });
}

void close_levels(void *file) noexcept
{
    try {
        delete static_cast<OIIO::ImageInput *>(file);
    } catch (...) {
    }
}

} // namespace

extern "C" const image_module *afterglow_image_module(void)
{
    static const image_module table = {
        IMAGE_MODULE_INTERFACE, encode, decode, decode_memory, open_levels, read_tile, close_levels};
    try {
        /* Before anything else, or OpenImageIO and OpenEXR start a thread for every CPU. And Debian's build prints
         * debug messages to standard error unless told not to. */
        if (OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1) && OIIO::attribute("debug", 0))
            return &table;
    } catch (...) {
    }
    return nullptr;
}
