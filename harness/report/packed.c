#include "harness/report/packed.h"

#include "harness/base/escape.h"
#include "harness/base/memory.h"

#include <assert.h>
#include <stdlib.h>
#define ZLIB_CONST /* its input is const */
#include <zlib.h>

/* Negative: no header and no checksum around the compressed bytes. */
#define RAW_WINDOW (-15)
#define MEMORY_LEVEL 8

void mote_packed_add(mote_text *text, const void *data, size_t size)
{
    z_stream stream = {0};
    /* The parameters are valid and the room suffices, so only memory can be missing. */
    if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, RAW_WINDOW, MEMORY_LEVEL,
                     Z_DEFAULT_STRATEGY) != Z_OK)
        mote_out_of_memory(0);
    const uLong bound = deflateBound(&stream, (uLong)size);
    unsigned char *bytes = mote_allocate(bound, 1);
    stream.next_in = data;
    stream.avail_in = (uInt)size;
    stream.next_out = bytes;
    stream.avail_out = (uInt)bound;
    const int ended = deflate(&stream, Z_FINISH);
    assert(ended == Z_STREAM_END);
    (void)ended;
    mote_base64(text, bytes, stream.total_out);
    (void)deflateEnd(&stream);
    free(bytes);
}
