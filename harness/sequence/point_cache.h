/* Point caches: the positions of all vertices at every frame in one file, in single precision.
   PC2 (3ds Max): "POINTCACHE2" and a 0 byte, version 1, vertices, first frame and frames
   between samples (floats), samples; then x, y, z of every vertex, sample by sample. MDD
   (Lightwave): samples, vertices, the time of each sample (floats); then the same. In both,
   each sample is a frame: the times are not used. */
#ifndef MOTE_HARNESS_POINT_CACHE_H
#define MOTE_HARNESS_POINT_CACHE_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct mote_point_cache {
    uint32_t frames, points;
    uint64_t start;  /* of frame 1, in bytes */
    bool big_endian; /* usual for MDD; for PC2 only from incorrect writers */
} mote_point_cache;

/* Reads the header; .mdd means MDD, anything else PC2. MOTE_EIO: cannot be read. MOTE_EINVAL:
   not in this format, or shorter than the header says. */
mote_status mote_point_cache_open(const char *path, mote_point_cache *cache);

/* Reads xyz[3 * points] of a frame, 1 .. frames, from an open file. MOTE_EIO. bytes: room for
   12 per point. */
mote_status mote_point_cache_read(int file, const mote_point_cache *cache, uint32_t frame,
                                  unsigned char *bytes, double *xyz);

/* Writes a PC2: a header of MOTE_POINT_CACHE_HEADER bytes, and bytes [12 * points], the
   positions rounded to single precision. */
#define MOTE_POINT_CACHE_HEADER 32
void mote_point_cache_put_header(uint32_t points, uint32_t frames,
                                 unsigned char header[MOTE_POINT_CACHE_HEADER]);
void mote_point_cache_put(const double *xyz, uint32_t points, unsigned char *bytes);

#endif
