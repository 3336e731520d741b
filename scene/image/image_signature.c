/* image_signature.c: see image_signature.h. */
#include "image/image_signature.h"

#include <stdbool.h>
#include <string.h>
#include <strings.h>

typedef struct signature {
    const char *reader;
    size_t at, size;
    const char *bytes;
} signature;

/* The bytes are arrays of characters with their NUL, which size leaves out. */
#define SIGNATURE(reader, at, bytes)                                                                                   \
    {                                                                                                                  \
        reader, at, sizeof(bytes) - 1, bytes                                                                           \
    }

static const signature SIGNATURES[] = {
    SIGNATURE("openexr", 0, "\x76\x2f\x31\x01"),
    SIGNATURE("png", 0, "\x89PNG\r\n\x1a\n"),
    SIGNATURE("jpeg", 0, "\xff\xd8\xff"),
    SIGNATURE("tiff", 0, "II*\0"),
    SIGNATURE("tiff", 0, "MM\0*"),
    SIGNATURE("tiff", 0, "II+\0"),
    SIGNATURE("tiff", 0, "MM\0+"),
    SIGNATURE("hdr", 0, "#?"),
    SIGNATURE("bmp", 0, "BM"),
    SIGNATURE("gif", 0, "GIF8"),
    SIGNATURE("psd", 0, "8BPS"),
    SIGNATURE("dds", 0, "DDS "),
    SIGNATURE("webp", 8, "WEBP"),
    SIGNATURE("jpeg2000", 0, "\0\0\0\x0cjP  "),
    SIGNATURE("jpeg2000", 0, "\xff\x4f\xff\x51"),
    SIGNATURE("heif", 4, "ftyp"),
    SIGNATURE("iff", 0, "FOR4"),
    SIGNATURE("sgi", 0, "\x01\xda"),
    SIGNATURE("dpx", 0, "SDPX"),
    SIGNATURE("dpx", 0, "XPDS"),
    SIGNATURE("cineon", 0, "\x80\x2a\x5f\xd7"),
    SIGNATURE("cineon", 0, "\xd7\x5f\x2a\x80"),
    SIGNATURE("fits", 0, "SIMPLE"),
};

/* Formats without a signature. */
static const struct {
    const char *ending, *reader;
} ENDINGS[] = {{".tga", "targa"}, {".tpic", "targa"}, {".vda", "targa"}, {".icb", "targa"},    {".vst", "targa"},
               {".rla", "rla"},   {".rpf", "rla"},    {".ico", "ico"},   {".pic", "softimage"}};

/* Cameras' raw pictures: most begin as TIFF files, whose reader would show the small picture that they hold. */
static const char *const RAW_ENDINGS[] = {".3fr", ".arw", ".cr2", ".cr3", ".crw", ".dcr", ".dng", ".erf", ".iiq",
                                          ".kdc", ".mef", ".mos", ".mrw", ".nef", ".nrw", ".orf", ".pef", ".raf",
                                          ".raw", ".rw2", ".rwl", ".sr2", ".srf", ".srw", ".x3f"};

/* PBM, PGM, PPM and PFM. */
static bool is_portable_map(const unsigned char *bytes, size_t size)
{
    return size >= 3 && bytes[0] == 'P' && strchr("123456Ff", bytes[1]) && bytes[1] != '\0' &&
           strchr(" \t\r\n#", bytes[2]) && bytes[2] != '\0';
}

const char *image_signature_reader(const char *path, const unsigned char *bytes, size_t size)
{
    const char *ending = strrchr(path, '.');
    for (size_t i = 0; ending && i < sizeof RAW_ENDINGS / sizeof RAW_ENDINGS[0]; i++)
        if (strcasecmp(ending, RAW_ENDINGS[i]) == 0)
            return "raw";
    for (size_t i = 0; i < sizeof SIGNATURES / sizeof SIGNATURES[0]; i++) {
        const signature *s = &SIGNATURES[i];
        if (size >= s->at + s->size && memcmp(bytes + s->at, s->bytes, s->size) == 0)
            return s->reader;
    }
    if (is_portable_map(bytes, size))
        return "pnm";
    for (size_t i = 0; ending && i < sizeof ENDINGS / sizeof ENDINGS[0]; i++)
        if (strcasecmp(ending, ENDINGS[i].ending) == 0)
            return ENDINGS[i].reader;
    return NULL;
}
