/* A page that is one file and loads nothing: its head with the style, data, and scripts. */
#ifndef MOTE_HARNESS_PAGE_H
#define MOTE_HARNESS_PAGE_H

#include "harness/base/file.h"

#include <jansson.h>

/* Begins a page: head, style, and the start of the body. */
mote_status mote_page_begin(const char *title, mote_text *text);

/* Adds an element with data, reals with ten digits; no text in it can end the element. Takes
   ownership of data. */
void mote_page_data(const char *id, json_t *data, mote_text *text);

/* Adds a script element; `name` is its source in messages. MOTE_EINVAL if the source contains
   what would end the element. */
mote_status mote_page_script(const char *name, const char *source, size_t size,
                             mote_text *text);

/* Adds the scripts of plots/page that every page has, then `last`, the page's own. */
mote_status mote_page_scripts(const char *last, mote_text *text);

void mote_page_end(mote_text *text);

#endif
