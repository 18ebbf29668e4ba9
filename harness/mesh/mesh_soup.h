/* A triangle soup: the triangles of a file before they become a mesh. */
#ifndef MOTE_HARNESS_MESH_SOUP_H
#define MOTE_HARNESS_MESH_SOUP_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct mote_soup {
    double *xyz;       /* [3 * vertex_count] */
    uint32_t *indices; /* [3 * triangle_count] */
    uint32_t *lines;   /* [triangle_count] in the file; 0: unknown */
    uint32_t line;     /* line of the triangles added next */
    uint32_t *kind;    /* [vertex_count], or NULL; vertices of different kinds stay apart */
    size_t vertex_count, triangle_count;
    size_t vertex_capacity, index_capacity, line_capacity;
    bool single_precision; /* coordinates went through 32-bit floats */
    size_t welded;         /* vertices welded to another one at the same place */
    size_t collapsed;      /* triangles with a vertex twice, perhaps after welding, left out */
    size_t unused;         /* vertices not in any face, left out */
} mote_soup;

/* Adds to a zero-initialised soup. MOTE_EINVAL: 2^31 vertices. Free with mote_soup_free. */
mote_status mote_soup_add_vertex(mote_soup *soup, double x, double y, double z);
void mote_soup_add_triangle(mote_soup *soup, uint32_t a, uint32_t b, uint32_t c);

/* Adds a polygon as triangles, convex or not. corners: count >= 3 vertices of the soup, in
   order around it. A vertex that follows itself makes triangles that collapse. MOTE_EINVAL: a
   vertex occurs twice elsewhere, or mote_polygon_triangulate refuses the polygon; the text says
   what is wrong and what would be right, but not where. */
mote_status mote_soup_add_polygon(mote_soup *soup, const uint32_t *corners, size_t count);
void mote_soup_free(mote_soup *soup);

/* Removes the triangles with a vertex twice, and counts them. */
void mote_soup_drop_collapsed(mote_soup *soup);

/* MOTE_EINVAL if this has left no triangle. */
mote_status mote_soup_refuse_collapsed(const char *path, const mote_soup *soup);

/* Merges vertices with equal coordinates and kinds, and removes the faces that collapse.
   Expected cost O(v + t). */
void mote_soup_weld(mote_soup *soup);

/* Removes the vertices that are in no face, keeping the order of the others. Indices must be in
   range. */
void mote_soup_compact(mote_soup *soup);

/* Reads a Wavefront OBJ text (ended by a 0 byte) in double precision: v and f lines, any simple
   polygon, indices from 1 or from the end; other lines are ignored. path is for messages:
   MOTE_EINVAL with "FILE:LINE: what". */
mote_status mote_soup_read_obj(const char *path, const char *text, mote_soup *soup);

/* Reads an ASCII OFF text (ended by a 0 byte) in double precision: OFF, COFF, NOFF, STOFF and
   their combinations, any simple polygon. Anything after a vertex's coordinates or a face's
   corners is ignored. assimp would round the coordinates to 32 bits, drop faces of more than
   nine corners, and replace an index out of range with another one. MOTE_EINVAL with
   "FILE:LINE: what". */
mote_status mote_soup_read_off(const char *path, const char *text, size_t size,
                               mote_soup *soup);

/* The vertices of a file, numbered as there, without triangles: of a mesh, or of a frame of a
   sequence. Set xyz and room (0: positions are not wanted) and zero the rest. */
typedef struct mote_frame_file {
    double *xyz;       /* [3 * room]: those of the first vertices of the file */
    size_t room;       /* further vertices are counted but not stored */
    size_t count;      /* vertices in the file */
    uint64_t topology; /* hash of its faces: corner counts and vertices */
} mote_frame_file;

/* Adds a face of a file to its hash: first the number of corners, then each vertex. */
static inline uint64_t mote_frame_file_hash(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 32;
}

/* Reads a PLY file (data ends with a 0 byte that size does not count): ASCII, little- or
   big-endian, any type of number, properties in any order, several elements of faces and
   triangle strips (tristrips). soup (unless NULL) receives its vertices and triangles, those
   with a vertex twice included. assimp would round the coordinates to 32 bits, and drop all
   triangles of a strip but the last and all elements of faces but the last.
   MOTE_EINVAL with the file and the place. */
mote_status mote_frame_file_read_ply(const char *path, const char *data, size_t size,
                                     mote_frame_file *file, mote_soup *soup);

/* MOTE_EINVAL for an empty file. */
mote_status mote_soup_refuse_empty(const char *path);

/* MOTE_EINVAL for a file of text that is empty, in UTF-16, has a zero byte before its end, or
   carriage returns without line feeds. */
mote_status mote_soup_check_encoding(const char *path, const char *text, size_t size);

/* MOTE_EINVAL for a text with the line ends of old Macs, which would be taken for one line. */
mote_status mote_soup_check_line_ends(const char *path, const char *text);

/* Finds errors that assimp silently gets wrong (text ends with a 0 byte). ASCII STL: carriage
   returns without line feeds, an incomplete vertex or facet, or no end. MOTE_EINVAL with the
   file, and the line if there is one. Other formats, judged by the path's ending, pass. */
mote_status mote_soup_check_text(const char *path, const char *text, size_t size);

/* Reads any format that assimp knows; coordinates go through 32-bit floats. Call it in a child
   process with limits: assimp may crash, hang or request any amount of memory. */
mote_status mote_soup_read_assimp(const char *path, mote_soup *soup);

#endif
