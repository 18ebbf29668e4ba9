#include "harness/sequence/point_cache.h"

#include "harness/base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define MAGIC "POINTCACHE2" /* with its 0 byte */
#define MDD_HEADER 8

static uint32_t word(const unsigned char *at, bool big_endian)
{
    return big_endian
               ? (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3]
               : (uint32_t)at[3] << 24 | (uint32_t)at[2] << 16 | (uint32_t)at[1] << 8 | at[0];
}

static void put_word(uint32_t value, unsigned char *at)
{
    for (int k = 0; k < 4; ++k)
        at[k] = (unsigned char)(value >> (8 * k));
}

/* Reads all bytes of a range. */
static bool read_at(int file, void *data, size_t size, uint64_t place)
{
    unsigned char *to = data;
    while (size > 0) {
        const ssize_t got = pread(file, to, size, (off_t)place);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        to += got;
        size -= (size_t)got;
        place += (uint64_t)got;
    }
    return true;
}

/* Reads the header in one byte order. */
static mote_point_cache interpret(const unsigned char *header, bool is_mdd, bool big_endian)
{
    mote_point_cache cache = {.big_endian = big_endian};
    if (is_mdd) {
        cache.frames = word(header, big_endian);
        cache.points = word(header + 4, big_endian);
        cache.start = MDD_HEADER + (uint64_t)4 * cache.frames;
    } else {
        cache.points = word(header + 16, big_endian);
        cache.frames = word(header + 28, big_endian);
        cache.start = MOTE_POINT_CACHE_HEADER;
    }
    return cache;
}

/* The length of the file that a header describes; 0 if its numbers are impossible. */
static uint64_t length_of(const mote_point_cache *cache)
{
    const uint64_t points = cache->points, frames = cache->frames;
    if (points < 3 || frames < 1 || points > INT32_MAX || frames > INT32_MAX ||
        points > UINT64_MAX / 16 / frames)
        return 0;
    return cache->start + 12 * points * frames;
}

static mote_status choose(const char *path, const unsigned char *header, bool is_mdd,
                          uint64_t size, mote_point_cache *cache)
{
    const mote_point_cache usual = interpret(header, is_mdd, is_mdd);
    const mote_point_cache other = interpret(header, is_mdd, !is_mdd);
    const uint64_t usual_length = length_of(&usual), other_length = length_of(&other);
    if (usual_length == size ||
        (usual_length > 0 && usual_length < size && other_length != size))
        *cache = usual;
    else if (other_length == size)
        *cache = other;
    else if (usual_length == 0)
        return mote_fail(MOTE_EINVAL,
                         "%s: %u vertices in %u frames by its header; give a %s file with at "
                         "least 3 vertices in 1 frame",
                         path, usual.points, usual.frames, is_mdd ? "MDD" : "PC2");
    else
        return mote_fail(
            MOTE_EINVAL,
            "%s: ends in frame %llu: %llu bytes, where %u frames of %u vertices "
            "take %llu; give the whole file",
            path,
            size < usual.start
                ? 1ULL
                : (unsigned long long)((size - usual.start) / 12 / usual.points + 1),
            (unsigned long long)size, usual.frames, usual.points,
            (unsigned long long)usual_length);
    return MOTE_OK;
}

static mote_status read_header(const char *path, int file, mote_point_cache *cache)
{
    unsigned char header[MOTE_POINT_CACHE_HEADER] = {0};
    struct stat info;
    const bool is_mdd = mote_name_ends(path, ".mdd");
    const size_t header_size = is_mdd ? MDD_HEADER : MOTE_POINT_CACHE_HEADER;
    if (fstat(file, &info) != 0)
        return mote_fail(MOTE_EIO, "%s: %s; name a point cache", path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return mote_fail(MOTE_EINVAL, "%s: not a regular file; name a point cache", path);
    if ((uint64_t)info.st_size < header_size || !read_at(file, header, header_size, 0))
        return mote_fail(MOTE_EINVAL, "%s: %lld bytes are too few for the header of %zu", path,
                         (long long)info.st_size, header_size);
    if (!is_mdd && memcmp(header, MAGIC, sizeof MAGIC) != 0)
        return mote_fail(MOTE_EINVAL, "%s: does not begin with " MAGIC "; give a PC2 file",
                         path);
    if (!is_mdd && word(header + 12, false) != 1 && word(header + 12, true) != 1)
        return mote_fail(MOTE_EINVAL, "%s: version %u of PC2; give version 1", path,
                         word(header + 12, false));
    return choose(path, header, is_mdd, (uint64_t)info.st_size, cache);
}

mote_status mote_point_cache_open(const char *path, mote_point_cache *cache)
{
    /* Not blocking, so a FIFO is refused without waiting for a writer. */
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        return mote_fail(MOTE_EIO, "%s: %s; name a point cache", path, strerror(errno));
    const mote_status status = read_header(path, file, cache);
    (void)close(file);
    return status;
}

mote_status mote_point_cache_read(int file, const mote_point_cache *cache, uint32_t frame,
                                  unsigned char *bytes, double *xyz)
{
    const size_t size = (size_t)12 * cache->points;
    if (!read_at(file, bytes, size, cache->start + (uint64_t)(frame - 1) * size))
        return mote_fail(MOTE_EIO, "ends early");
    for (size_t i = 0; i < (size_t)3 * cache->points; ++i) {
        const uint32_t bits = word(bytes + 4 * i, cache->big_endian);
        float value;
        memcpy(&value, &bits, sizeof value);
        xyz[i] = (double)value;
    }
    return MOTE_OK;
}

void mote_point_cache_put_header(uint32_t points, uint32_t frames,
                                 unsigned char header[MOTE_POINT_CACHE_HEADER])
{
    const float first = 1, step = 1;
    uint32_t bits;
    memset(header, 0, MOTE_POINT_CACHE_HEADER);
    memcpy(header, MAGIC, sizeof MAGIC);
    put_word(1, header + 12);
    put_word(points, header + 16);
    memcpy(&bits, &first, sizeof bits);
    put_word(bits, header + 20);
    memcpy(&bits, &step, sizeof bits);
    put_word(bits, header + 24);
    put_word(frames, header + 28);
}

void mote_point_cache_put(const double *xyz, uint32_t points, unsigned char *bytes)
{
    for (size_t i = 0; i < (size_t)3 * points; ++i) {
        const float value = (float)xyz[i];
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        put_word(bits, bytes + 4 * i);
    }
}
