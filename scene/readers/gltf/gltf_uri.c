/* gltf_uri.c: what a URI in a glTF file stands for: bytes of its own, or a file beside it.
 * Rests on: RFC 2397 (data URIs), RFC 4648 (base64), RFC 3986 (percent-encoding); "glTF 2.0 Specification", 2021, 2.8.
 * Flow: gltf_buffers, gltf_images -> [here]. Threads: pure functions. */
#include "gltf/gltf_private.h"

#include <stdlib.h>
#include <string.h>

/* Returns the value of a base64 digit of either alphabet; -1: it is none. */
static int base64_value(char c)
{
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

bool gltf_uri_is_data(const char *uri) { return strncmp(uri, "data:", 5) == 0; }

unsigned char *gltf_uri_decode_data(const char *uri, size_t *out_size, const char **out_wrong)
{
    const char *comma = strchr(uri, ',');
    *out_size = 0;
    *out_wrong = NULL;
    if (!comma || comma - uri < 7 || strncmp(comma - 7, ";base64", 7) != 0) {
        *out_wrong = "the data URI is not in base64";
        return NULL;
    }
    const char *digits = comma + 1;
    size_t count = strlen(digits), size = 0;
    while (count > 0 && digits[count - 1] == '=')
        count--;
    unsigned char *bytes = malloc(count / 4 * 3 + 4);
    if (!bytes)
        return NULL;
    uint32_t bits = 0;
    int bit_count = 0;
    for (size_t i = 0; i < count; i++) {
        int value = base64_value(digits[i]);
        if (value < 0) {
            *out_wrong = "the data URI holds what is not base64";
            free(bytes);
            return NULL;
        }
        bits = (bits << 6 | (uint32_t)value) & 0xffffff;
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            bytes[size++] = (unsigned char)(bits >> bit_count);
        }
    }
    *out_size = size;
    return bytes;
}

static int hexadecimal_value(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* Returns whether a URI has a scheme: a letter, then letters, digits, + - . up to a colon, before any slash. A single
 * letter would be a drive. */
static bool has_scheme(const char *uri)
{
    size_t i = 0;
    while ((uri[i] | 0x20) >= 'a' && (uri[i] | 0x20) <= 'z')
        i++;
    if (i == 0)
        return false;
    while (((uri[i] | 0x20) >= 'a' && (uri[i] | 0x20) <= 'z') || (uri[i] >= '0' && uri[i] <= '9') ||
           (uri[i] && strchr("+-.", uri[i])))
        i++;
    return uri[i] == ':' && i > 1;
}

char *gltf_uri_to_path(const gltf_reader *r, const char *uri, const char **out_wrong)
{
    *out_wrong = NULL;
    if (has_scheme(uri) || !uri[0]) {
        *out_wrong = uri[0] ? "it has a scheme: a file's path is expected, from the scene's folder on" : "it is empty";
        return NULL;
    }
    size_t length = uri[0] == '/' ? 0 : strlen(r->directory);
    char *path = malloc(length + strlen(uri) + 1);
    if (!path)
        return NULL;
    memcpy(path, r->directory, length);
    for (const char *c = uri; *c; c++) {
        int high = *c == '%' ? hexadecimal_value(c[1]) : -1, low = high >= 0 ? hexadecimal_value(c[2]) : -1;
        bool is_encoded = low >= 0 && (high > 0 || low > 0); /* else a plain % in a file's name, as some write it */
        char decoded = (char)(16 * high + low);
        path[length++] = is_encoded ? decoded : *c;
        c += is_encoded ? 2 : 0;
    }
    path[length] = '\0';
    return path;
}
