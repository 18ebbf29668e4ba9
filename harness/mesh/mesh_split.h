/* Edges of three or more faces, cut apart so that every edge has one or two. */
#ifndef MOTE_HARNESS_MESH_SPLIT_H
#define MOTE_HARNESS_MESH_SPLIT_H

#include "harness/mesh/mesh_soup.h"

/* Where the first of the edges are, cut to this many bytes with the final 0. */
#define MOTE_SPLIT_TEXT 400
/* At most this many are named there. */
#define MOTE_SPLIT_EDGES_TOLD 3

typedef struct mote_split {
    size_t edges;                /* that had more than two faces */
    size_t vertices;             /* added, at the places of others */
    char where[MOTE_SPLIT_TEXT]; /* "(0, 0, 0) to (0, 0, 1) with 4 faces on lines 9, 12, ..." */
} mote_split;

/* Gives faces that meet in such an edge vertices of their own, at the same places. The surface
   stays the same bit for bit; so do the order of the faces and the numbers of the vertices that
   were there, which new ones follow. Around each edge, faces stay joined in pairs that have
   the inside between them (two solids that touch along an edge both stay closed); the faces
   left over become open there. Vertices that are on no such edge keep their fans.

   Cost O(v + t), and O(k log k) for each edge of k faces. */
void mote_soup_split(mote_soup *soup, mote_split *split);

#endif
