/* Edges of three or more faces, cut apart so that every edge has one or two. */
#ifndef MOTE_HARNESS_MESH_SPLIT_H
#define MOTE_HARNESS_MESH_SPLIT_H

#include "harness/mesh/mesh_soup.h"

/* Size of the text that locates the first edges, including the final 0. */
#define MOTE_SPLIT_TEXT 400
/* At most this many edges are listed there. */
#define MOTE_SPLIT_EDGES_TOLD 3

typedef struct mote_split {
    size_t edges;                /* with more than two faces */
    size_t vertices;             /* added, at the places of existing ones */
    char where[MOTE_SPLIT_TEXT]; /* "(0, 0, 0) to (0, 0, 1) with 4 faces on lines 9, 12, ..." */
} mote_split;

/* Gives faces that meet in such an edge their own vertices at the same places. The surface
   stays the same bit for bit, and so do the order of the faces and the numbers of the existing
   vertices; new ones follow. Around each edge, faces stay joined in pairs that have the inside
   between them (two solids that touch along an edge both stay closed); the remaining faces
   become open there. Vertices that are not on such an edge keep their fans.

   Cost O(v + t), and O(k log k) for each edge of k faces. */
void mote_soup_split(mote_soup *soup, mote_split *split);

#endif
