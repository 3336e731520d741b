/* jpeg_end.h: whether a JPEG file was cut short. Its library fills what is missing with grey, and OpenImageIO says
 * nothing of it. Rests on: ITU-T T.81, 1992, annex B (markers). Flow: image_reader -> [here]. Threads: pure
 * functions. */
#ifndef AFTERGLOW_JPEG_END_H
#define AFTERGLOW_JPEG_END_H

#include <stdbool.h>
#include <stddef.h>

/* Returns whether bytes begin as a JPEG file and hold the beginning of a scan, but no end of the image behind it. */
bool jpeg_is_cut_short(const unsigned char *bytes, size_t size);
/* Returns whether a JPEG file ends before its picture does; false where it cannot be read. */
bool jpeg_file_is_cut_short(const char *path);

#endif
