/* Data of the page, made small: compressed (RFC 1951, "deflate-raw" to a browser), then in
   base 64. plots/page/packed.js unpacks it. */
#ifndef MOTE_HARNESS_PACKED_H
#define MOTE_HARNESS_PACKED_H

#include "harness/base/file.h"

/* Appends `size` bytes, packed: letters, digits, '+', '/' and '=' only. text fails where memory
   runs out. About 20 ms a megabyte. */
void mote_packed_add(mote_text *text, const void *data, size_t size);

#endif
