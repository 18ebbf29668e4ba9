/* Damaged files of characters: each is read as a character whose poses are finite, or refused
   in one line, soon. MOTE_FULL=1 tries 10,000 files. */
#include "core/base/random.h"
#include "harness/base/clock.h"
#include "harness/base/file.h"
#include "harness/mesh/character.h"
#include "tests/support/bar.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Room for what a mutation inserts. */
#define GROWTH 256

typedef struct bytes {
    char *data;
    size_t size;
} bytes;

static bytes read_file(const char *path)
{
    bytes file = {NULL, 0};
    if (mote_file_read(path, (size_t)1 << 24, &file.data, &file.size) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return file;
}

static void overwrite(bytes *file, size_t at, const void *with, size_t size)
{
    if (at + size <= file->size)
        memcpy(file->data + at, with, size);
}

static void insert(bytes *file, size_t at, const char *word)
{
    memmove(file->data + at + strlen(word), file->data + at, file->size - at);
    memcpy(file->data + at, word, strlen(word));
    file->size += strlen(word);
}

/* A copy with one to four changes: a byte, an absurd number in binary or in text, a cut. */
static bytes mutate(const bytes *file, mote_random *random)
{
    static const char *const words[] = {"-1", "nan", "1e400", "4294967295",
                                        "\"", "}",   "[",     ";"};
    const float floats[] = {NAN, INFINITY, -3e38F, 1e-40F};
    const uint32_t numbers[] = {0, 0xffffffff, 0x7fffffff, 65536};
    bytes out = {malloc(file->size + GROWTH), file->size};
    assert_non_null(out.data);
    memcpy(out.data, file->data, file->size);
    for (uint64_t changes = 1 + mote_random_below(random, 4); changes > 0; --changes) {
        const size_t at = mote_random_below(random, out.size);
        const size_t which = mote_random_below(random, 4);
        switch (mote_random_below(random, 8)) {
        case 0:
            out.size = at + 1;
            break;
        case 1:
        case 2:
            overwrite(&out, at & ~(size_t)3, &floats[which], sizeof floats[which]);
            break;
        case 3:
        case 4:
            overwrite(&out, at & ~(size_t)3, &numbers[which], sizeof numbers[which]);
            break;
        case 5:
            insert(&out, at, words[which + (at % 2 ? 4 : 0)]);
            break;
        default:
            out.data[at] = (char)mote_random_below(random, 256);
            break;
        }
    }
    return out;
}

/* The sum of the coordinates of the bones' maps and of the amounts, in three poses a clip. */
static double pose_sum(const mote_character *c)
{
    mote_character_pose pose = mote_character_pose_create(c);
    double sum = 0;
    for (uint32_t k = 0; k < c->rig.clips_count; ++k) {
        for (int part = 0; part < 3; ++part) {
            mote_character_pose_set(c, k, c->rig.clips[k].seconds * part / 2, &pose);
            for (size_t b = 0; b < 12 * c->rig.bones_count; ++b)
                sum += pose.matrices[b / 12].m[b % 12 / 4][b % 4];
            for (size_t t = 0; t < c->rig.targets_count; ++t)
                sum += pose.morphs[t];
        }
    }
    mote_character_pose_free(&pose);
    return sum;
}

/* 1 where the file is read. */
static int try_file(const char *path)
{
    mote_character *c = NULL;
    const double start = mote_clock_seconds();
    const mote_status status = mote_character_import_file(path, &c, NULL);
    if (mote_clock_seconds() - start > 20)
        fail_msg("%s took %g s", path, mote_clock_seconds() - start);
    if (status != MOTE_OK) {
        assert_null(c);
        if (strncmp(mote_error_text(), path, strlen(path)) != 0 ||
            strchr(mote_error_text(), '\n') || !strstr(mote_error_text(), "; "))
            fail_msg("not clear: %s", mote_error_text());
        return 0;
    }
    if (!isfinite(pose_sum(c)))
        fail_msg("%s: a pose that is not finite", path);
    mote_character_destroy(c);
    return 1;
}

TEST(mote_character_import_damaged_files_are_read_or_refused)
{
    static const char *const names[] = {"hand.glb", "cube.gltf", "cube.bin", "bar.x",
                                        "hand-shapes.glb"};
    bytes whole[ROWS_OF(names)];
    mote_random random = {3};
    const int tries = getenv("MOTE_FULL") ? 10000 : 150;
    int read = 0;
    bar_write("bar.x", bar_default());
    for (size_t k = 0; k < ROWS_OF(names); ++k) {
        char path[512];
        (void)snprintf(path, sizeof path, "%s/datasets/characters/%s", MOTE_SOURCE_DIR,
                       names[k]);
        whole[k] = read_file(k == 3 ? names[k] : path);
        file_write(names[k], whole[k].data, whole[k].size);
    }
    for (int i = 0; i < tries; ++i) {
        const size_t k = (size_t)i % ROWS_OF(names);
        bytes damaged = mutate(&whole[k], &random);
        test_row("%s, try %d", names[k], i);
        file_write(names[k], damaged.data, damaged.size);
        read += try_file(k == 2 ? "cube.gltf" : names[k]);
        file_write(names[k], whole[k].data, whole[k].size);
        free(damaged.data);
    }
    assert_in_range(read, 1, tries - 1);
    for (size_t k = 0; k < ROWS_OF(names); ++k)
        free(whole[k].data);
}
