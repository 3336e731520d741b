/* page_html.h: the page that --serve shows, of page.html, which the build turns into C (embed_file.cmake).
 * Flow: page.html -> [here] -> page_server. Threads: constant. */
#ifndef AFTERGLOW_PAGE_HTML_H
#define AFTERGLOW_PAGE_HTML_H

#include <stddef.h>

extern const unsigned char page_html[]; /* a zero byte follows the text */
extern const size_t page_html_size;     /* bytes, without that zero */

#endif
