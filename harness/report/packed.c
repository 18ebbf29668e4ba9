#include "harness/report/packed.h"

#include "harness/base/escape.h"

#include <stdlib.h>
#define ZLIB_CONST /* its input is const */
#include <zlib.h>

/* A negative window: no header and no checksum around the compressed bytes. */
#define RAW_WINDOW (-15)
#define MEMORY_LEVEL 8

void mote_packed_add(mote_text *text, const void *data, size_t size)
{
    z_stream stream = {0};
    if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, RAW_WINDOW, MEMORY_LEVEL,
                     Z_DEFAULT_STRATEGY) != Z_OK) {
        text->failed = 1;
        return;
    }
    const uLong bound = deflateBound(&stream, (uLong)size);
    unsigned char *bytes = malloc(bound);
    stream.next_in = data;
    stream.avail_in = (uInt)size;
    stream.next_out = bytes;
    stream.avail_out = (uInt)bound;
    if (bytes && deflate(&stream, Z_FINISH) == Z_STREAM_END)
        mote_base64(text, bytes, stream.total_out);
    else
        text->failed = 1;
    (void)deflateEnd(&stream);
    free(bytes);
}
