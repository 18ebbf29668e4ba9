/* A glTF 2.0 file, text or binary, as JSON. */
#ifndef MOTE_HARNESS_GLTF_FILE_H
#define MOTE_HARNESS_GLTF_FILE_H

#include "core/base/status.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MOTE_GLTF_BYTES ((size_t)4 << 30) /* the largest file that is read */
#define MOTE_GLTF_FLOATS 5126             /* the componentType of 32-bit floats */

typedef struct mote_gltf {
    json_t *root;
    bool is_binary;
    const char *bin; /* buffer 0 of a binary file, in the file's data; otherwise NULL */
    size_t bin_size;
} mote_gltf;

/* Whether a file is glTF, by its name or its content: assimp goes by both. */
bool mote_gltf_is(const char *path, const char *data, size_t size);

/* Reads a file of size bytes, which must outlive gltf->bin. MOTE_EINVAL: a binary file that
   ends early or whose JSON fills no whole words, or text that is no JSON. Close with
   mote_gltf_close. */
mote_status mote_gltf_open(const char *path, const char *data, size_t size, mote_gltf *gltf);
void mote_gltf_close(mote_gltf *gltf);

/* Entry number index of the file's list of that name, or NULL. */
const json_t *mote_gltf_entry(const mote_gltf *gltf, const char *list, int64_t index);

/* The value of a member that is a whole number of at least 0, 16.0 too, otherwise -1. */
int64_t mote_gltf_whole(const json_t *object, const char *key);

/* Checks for what assimp silently reads wrongly: it takes numbers of any type for 32-bit
   floats, and finds none where they are compressed. moves: checks bones, morph targets and
   clips, too. path is for messages. MOTE_EINVAL with the entry and what would be right. */
mote_status mote_gltf_check(const char *path, const mote_gltf *gltf, bool moves);

#endif
