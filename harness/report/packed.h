/* Compresses the page's data (RFC 1951, "deflate-raw" in a browser), then encodes it in base
   64. plots/page/packed.js unpacks it. */
#ifndef MOTE_HARNESS_PACKED_H
#define MOTE_HARNESS_PACKED_H

#include "harness/base/file.h"

/* Appends `size` bytes, packed: letters, digits, '+', '/' and '=' only. Ends the program if
   memory runs out. About 20 ms per megabyte. */
void mote_packed_add(mote_text *text, const void *data, size_t size);

#endif
