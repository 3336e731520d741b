/* json_text.h: a text as JSON has it, in quotes. Bytes that are not UTF-8, as names of files may have, become U+FFFD.
 * Flow: progress, page_state -> [here]. Threads: any. */
#ifndef AFTERGLOW_JSON_TEXT_H
#define AFTERGLOW_JSON_TEXT_H

#include <stdio.h>

void json_text_put(FILE *file, const char *text);

#endif
