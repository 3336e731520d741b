/* image_signature.h: which of OpenImageIO's readers a picture is for, by its first bytes.
 * OpenImageIO tries all its readers where the one of the name's ending fails; some of them (medical pictures, films,
 * volumes) work on any bytes for minutes or hours. Flow: image_oiio.cpp -> [here]. Threads: any. */
#ifndef AFTERGLOW_IMAGE_SIGNATURE_H
#define AFTERGLOW_IMAGE_SIGNATURE_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { IMAGE_SIGNATURE_BYTES = 16 }; /* how many first bytes are looked at */

/* Returns the name of the format's reader; NULL: it is no picture of a format that is read. path: its ending decides
 * where bytes do not: between formats that have no signature, and for cameras' raw pictures, which look like TIFF
 * files. */
const char *image_signature_reader(const char *path, const unsigned char *bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
