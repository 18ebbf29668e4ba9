/* The positions of a mesh frame by frame: numbered OBJ or PLY files of one topology, or a point
   cache (PC2, MDD) with a mesh. Frames are read one at a time, so memory depends only on the
   mesh, not on the number of frames (sequence_reader.h). */
#ifndef MOTE_HARNESS_SEQUENCE_H
#define MOTE_HARNESS_SEQUENCE_H

#include "harness/sequence/numbered_mesh.h"

typedef enum mote_sequence_kind {
    MOTE_SEQUENCE_FILES, /* one file per frame */
    MOTE_SEQUENCE_CACHE  /* all frames in one file, in single precision */
} mote_sequence_kind;

/* Immutable once open; any thread or child process may read it. */
typedef struct mote_sequence {
    mote_sequence_kind kind;
    char *path;            /* of the first file, or of the cache */
    uint32_t frames;       /* readable frames */
    uint32_t vertex_count; /* of the mesh */
    uint32_t *file_vertex; /* [vertex_count]: number in the file; NULL: the same */
    uint32_t file_vertices;
    double limit;    /* largest coordinate allowed: at a billion times L, distances are noise */
    mote_vec3 scale; /* factor of each coordinate; 1 once open */
    /* Numbered files: */
    uint64_t topology;
    size_t digits_at; /* where the number starts in path */
    int digits;       /* of the number; shorter numbers are padded with zeros */
    uint64_t first;   /* number of frame 1 */
    /* Cache: */
    uint64_t start; /* offset of frame 1, in bytes */
    bool big_endian;
} mote_sequence;

/* Whether a path has the ending of a point cache (.pc2, .mdd). */
bool mote_sequence_is_cache(const char *path);

/* Opens numbered files; path names the first: the last digits before the ending are the number,
   as in frames/0001.obj. Frame k is the file with that number plus k - 1, with at least as many
   digits. The first is read as a mesh; of the others, only their existence is checked, up to
   `frames`. MOTE_EINVAL: no number in the name, or mote_numbered_mesh_read refuses the first
   file; MOTE_EIO, with the frame, if a file is missing. The caller destroys both. */
mote_status mote_sequence_open_files(const char *path, uint32_t frames,
                                     mote_sequence **sequence, mote_mesh **mesh,
                                     mote_import *import);

/* Opens a cache. mesh_path: an OBJ or PLY file with vertices in the cache's order, read into
   *mesh; NULL: *mesh is given, in this order. Byte order: PC2 is little-endian and MDD
   big-endian; the other order is accepted if only that one matches the file's size.
   MOTE_EINVAL: a header that is not of these formats, a number of vertices other than the
   mesh's, fewer frames than `frames`, a file shorter than its header says. */
mote_status mote_sequence_open_cache(const char *path, const char *mesh_path, uint32_t frames,
                                     mote_sequence **sequence, mote_mesh **mesh,
                                     mote_import *import);

void mote_sequence_destroy(mote_sequence *sequence); /* NULL is allowed */

/* The file of a frame, 1 .. frames. The caller frees it. */
char *mote_sequence_path(const mote_sequence *sequence, uint32_t frame);

#endif
