/* The positions of a mesh frame by frame: numbered OBJ or PLY files of one topology, or a point
   cache (PC2, MDD) beside a mesh. Frames are read one at a time, so that memory depends on the
   mesh alone, however many there are (sequence_reader.h). */
#ifndef MOTE_HARNESS_SEQUENCE_H
#define MOTE_HARNESS_SEQUENCE_H

#include "harness/sequence/numbered_mesh.h"

typedef enum mote_sequence_kind {
    MOTE_SEQUENCE_FILES, /* a file a frame */
    MOTE_SEQUENCE_CACHE  /* all frames in one file, in single precision */
} mote_sequence_kind;

/* Immutable once open; any thread and any child process may read it. */
typedef struct mote_sequence {
    mote_sequence_kind kind;
    char *path;            /* of the first file, or of the cache */
    uint32_t frames;       /* that can be read */
    uint32_t vertex_count; /* of the mesh */
    uint32_t *file_vertex; /* [vertex_count]: which of the file's vertices; NULL: the same */
    uint32_t file_vertices;
    double limit;    /* no coordinate is larger: a billion times L away, distances are noise */
    mote_vec3 scale; /* of each coordinate; 1 once open */
    /* Of files: */
    uint64_t topology;
    size_t digits_at; /* of path, where its number starts */
    int digits;       /* of the number; shorter ones are filled with zeros */
    uint64_t first;   /* the number of frame 1 */
    /* Of a cache: */
    uint64_t start; /* of frame 1, in bytes */
    bool big_endian;
} mote_sequence;

/* Whether a path ends as that of a point cache does (.pc2, .mdd). */
bool mote_sequence_is_cache(const char *path);

/* Opens numbered files, of which path names the first: the last digits before the ending are
   the number, as in frames/0001.obj. Frame k is the file of that number plus k - 1, with as
   many digits at least. The first is read as a mesh; of the others it is checked that `frames`
   files are there, no more. MOTE_EINVAL: no number in the name, and what
   mote_numbered_mesh_read refuses; MOTE_EIO, with the frame, where a file is missing. The
   caller destroys both. */
mote_status mote_sequence_open_files(const char *path, uint32_t frames,
                                     mote_sequence **sequence, mote_mesh **mesh,
                                     mote_import *import);

/* Opens a cache. mesh_path: an OBJ or PLY file whose vertices are in the cache's order, read
   into *mesh; NULL: *mesh is there, in this order. Byte order: PC2 is written little-endian and
   MDD big-endian; the other one is accepted where only it agrees with the file's size.
   MOTE_EINVAL: a header that is not of these formats, another number of vertices than the mesh
   has, fewer frames than `frames`, a file that is shorter than its header says. */
mote_status mote_sequence_open_cache(const char *path, const char *mesh_path, uint32_t frames,
                                     mote_sequence **sequence, mote_mesh **mesh,
                                     mote_import *import);

void mote_sequence_destroy(mote_sequence *sequence); /* NULL is allowed */

/* The file of a frame, 1 .. frames. The caller frees it. */
char *mote_sequence_path(const mote_sequence *sequence, uint32_t frame);

#endif
