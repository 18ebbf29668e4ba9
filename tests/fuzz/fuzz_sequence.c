/* Any bytes as frames of a sequence of positions. The first byte says of which kind: O or P, an
   OBJ or a PLY file, whose count and topology must not depend on how many positions are asked
   for; C, a PC2 cache and an MDD cache (fuzz_two_files), in which every frame that a header
   promises must be. */
#include "harness/base/memory.h"
#include "harness/sequence/frame_file.h"
#include "harness/sequence/point_cache.h"
#include "tests/fuzz/fuzz.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef mote_status (*reader)(const char *text, size_t size, mote_frame_file *file);

static mote_status read_obj(const char *text, size_t size, mote_frame_file *file)
{
    (void)size;
    return mote_frame_file_read_obj("any.obj", text, file);
}

static mote_status read_ply(const char *text, size_t size, mote_frame_file *file)
{
    return mote_frame_file_read_ply("any.ply", text, size, file, NULL);
}

static mote_status read_ply_mesh(const char *text, size_t size, mote_frame_file *file)
{
    mote_soup soup = {0};
    const mote_status status = mote_frame_file_read_ply("any.ply", text, size, file, &soup);
    mote_soup_free(&soup);
    return status;
}

/* Counts first, then reads all vertices but one, as for a mesh that has fewer. */
static void read_text(reader read, const char *text, size_t size)
{
    mote_frame_file counted = {0};
    if (read(text, size, &counted) != MOTE_OK)
        return;
    const size_t room = counted.count > 0 ? counted.count - 1 : 0;
    mote_frame_file filled = {.xyz = mote_allocate(3 * room, sizeof(double)), .room = room};
    if (read(text, size, &filled) != MOTE_OK || filled.count != counted.count ||
        filled.topology != counted.topology)
        abort();
    free(filled.xyz);
}

/* Reads every frame of a cache into memory of exactly its size. */
static void read_cache(const char *path)
{
    mote_point_cache cache;
    if (mote_point_cache_open(path, &cache) != MOTE_OK)
        return;
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    unsigned char *bytes = mote_allocate(cache.points, 12);
    double *xyz = mote_allocate((size_t)3 * cache.points, sizeof *xyz);
    for (uint32_t k = 1; k <= cache.frames && k <= 4; ++k) {
        if (mote_point_cache_read(file, &cache, k, bytes, xyz) != MOTE_OK)
            abort();
    }
    if (cache.frames > 0 &&
        mote_point_cache_read(file, &cache, cache.frames, bytes, xyz) != MOTE_OK)
        abort();
    (void)close(file);
    free(bytes);
    free(xyz);
}

static void read_caches(const uint8_t *data, size_t size)
{
    static const char *const names[2] = {"any.pc2", "any.mdd"};
    const char *folder = fuzz_two_files(data, size, names);
    char path[160];
    for (int k = 0; k < 2; ++k) {
        (void)snprintf(path, sizeof path, "%s/%s", folder, names[k]);
        read_cache(path);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0)
        return 0;
    char *text = mote_allocate(size, 1);
    memcpy(text, data + 1, size - 1);
    if (data[0] == 'O')
        read_text(read_obj, text, size - 1);
    if (data[0] == 'P') {
        read_text(read_ply, text, size - 1);
        read_text(read_ply_mesh, text, size - 1);
    }
    if (data[0] == 'C')
        read_caches(data + 1, size - 1);
    free(text);
    return 0;
}
