/* A glTF 2.0 file, text or binary: its JSON, and the bytes of its buffers. */
#ifndef MOTE_HARNESS_GLTF_FILE_H
#define MOTE_HARNESS_GLTF_FILE_H

#include "core/base/status.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MOTE_GLTF_BYTES ((size_t)4 << 30) /* the largest file that is read */
#define MOTE_GLTF_FLOATS 5126             /* the componentType of 32-bit floats */

/* Bytes of a buffer; own: to be freed, NULL if they belong to something else. */
typedef struct mote_gltf_bytes {
    const char *data; /* NULL: not loaded */
    size_t size;
    char *own;
} mote_gltf_bytes;

typedef struct mote_gltf {
    char *path;
    json_t *root;
    bool is_binary;
    const char *bin; /* buffer 0 of a binary file, in the file's data; otherwise NULL */
    size_t bin_size;
    mote_gltf_bytes *buffers; /* [buffer_count]; the last one is not in the file */
    size_t buffer_count;
} mote_gltf;

/* Whether a file is glTF, by its name or its content: assimp goes by both. */
bool mote_gltf_is(const char *path, const char *data, size_t size);

/* Reads a file of size bytes, which must outlive gltf if it is binary. path locates buffers in
   other files, and is for messages. Numbers such as 16.0 are 16 from here on. MOTE_EINVAL: a
   binary file that ends early or whose JSON fills no whole words, or text that is no JSON.
   Close with mote_gltf_close. */
mote_status mote_gltf_open(const char *path, const char *data, size_t size, mote_gltf *gltf);
void mote_gltf_close(mote_gltf *gltf);

/* Whether the file says that it is of version 2, and not of version 1, which is another
   format. */
bool mote_gltf_is_2(const mote_gltf *gltf);

/* Entry number index of the file's list of that name, or NULL. */
const json_t *mote_gltf_entry(const mote_gltf *gltf, const char *list, int64_t index);

/* The value of a member that is a whole number of at least 0, otherwise -1. */
int64_t mote_gltf_whole(const json_t *object, const char *key);

/* The same of a member that may be left out, and then is 0. */
int64_t mote_gltf_whole_or_0(const json_t *object, const char *key);

/* The name of a node; "nodes[3]" if it has none. The caller frees it. */
char *mote_gltf_node_name(const mote_gltf *gltf, size_t node);

/* Whether a channel of an animation moves a node: one without a node, or with a path that only
   an extension knows, has to be ignored (glTF 2.0, section 5.5). */
bool mote_gltf_moves(const mote_gltf *gltf, const json_t *channel);

/* The sampler of a channel, or NULL. */
const json_t *mote_gltf_sampler(const json_t *animation, const json_t *channel);

/* Checks for what assimp silently reads wrongly: it takes numbers of any type for 32-bit
   floats, finds none where they are compressed, and reads beyond the end of views. moves:
   checks bones, morph targets and clips, too. MOTE_EINVAL with the entry and what would be
   right. */
mote_status mote_gltf_check(const mote_gltf *gltf, bool moves);

/* Checks that the numbers of joints in vertices are those of joints, and that weights are
   finite and not negative: assimp ignores others. Reads buffers. MOTE_EINVAL with the
   accessor. */
mote_status mote_gltf_check_joints(mote_gltf *gltf);

/* Gives the bytes of a buffer, which belong to gltf: loads them if need be from the file, from
   a data URI, or from the file that the buffer names. MOTE_EINVAL: there is no such buffer, it
   lies outside of the file's folder, or is shorter than it says; MOTE_EIO: it cannot be read.
 */
mote_status mote_gltf_load(mote_gltf *gltf, size_t buffer, mote_gltf_bytes *bytes);

/* The sizes of the files that buffers name, together; of those that may be read. */
uint64_t mote_gltf_bytes_beside(const mote_gltf *gltf);

/* The numbers of an accessor. */
typedef struct mote_gltf_numbers {
    double *values;
    size_t count; /* of elements */
} mote_gltf_numbers;

/* Reads an accessor with `width` numbers an element: floats, or 8 or 16 bits without sign.
   MOTE_EINVAL, with `what` it has, if it has others or lies beyond its buffer. The caller frees
   out->values. */
mote_status mote_gltf_read(mote_gltf *gltf, const char *what, int64_t accessor, size_t width,
                           bool floats, mote_gltf_numbers *out);

/* The name by which mote_gltf_text calls a buffer is this, followed by its number. */
#define MOTE_GLTF_BUFFER "buffer"

/* The file as a text that assimp 5.2 reads as it is meant, where it would not do so otherwise:
   - the name of a node is its number, since assimp finds nodes by names, which need not differ;
   - channels that move no node are left out, which assimp takes for channels of some node;
   - a mesh that nodes have with several skins is there for each of them, since assimp keeps the
     bones of one;
   - a skin without inverse bind matrices has them: assimp crashes without;
   - all buffers are in files named as above.
   moves: false leaves out what moves. Adds to the buffers. The caller frees it. */
char *mote_gltf_text(mote_gltf *gltf, bool moves);

#endif
