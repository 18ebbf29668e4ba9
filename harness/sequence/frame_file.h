/* The positions in one file of a sequence, and a hash of its topology; read frame by frame in a
   separate process (sequence_reader.h). */
#ifndef MOTE_HARNESS_FRAME_FILE_H
#define MOTE_HARNESS_FRAME_FILE_H

#include "harness/mesh/mesh_soup.h"

/* The contents of a file. Set xyz and room (0: positions are not wanted) and zero the rest. */
typedef struct mote_frame_file {
    double *xyz;       /* [3 * room]: those of the first vertices of the file */
    size_t room;       /* further vertices are counted but not stored */
    size_t count;      /* vertices in the file */
    uint64_t topology; /* hash of its faces: corner counts and vertices */
} mote_frame_file;

/* Reads the vertices and faces of an OBJ text (ended by a 0 byte) like mote_soup_read_obj,
   without making triangles. MOTE_EINVAL with "FILE:LINE: what". */
mote_status mote_frame_file_read_obj(const char *path, const char *text, mote_frame_file *file);

/* Reads a PLY file (data ends with a 0 byte that size does not count): ASCII, little- or
   big-endian, any type of number, properties and elements in any order. soup (unless NULL)
   receives its vertices and triangles. MOTE_EINVAL with the file and the place. */
mote_status mote_frame_file_read_ply(const char *path, const char *data, size_t size,
                                     mote_frame_file *file, mote_soup *soup);

/* Adds a face of a file to its hash: first the number of corners, then each vertex. */
static inline uint64_t mote_frame_file_hash(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 32;
}

#endif
