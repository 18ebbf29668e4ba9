/* Meshes as assimp reads and triangulates them, with nothing of harness/mesh in between. */
#ifndef MOTE_TESTS_READERS_ASSIMP_H
#define MOTE_TESTS_READERS_ASSIMP_H

#include "tests/studies/readers_compare.h"

#include <stdint.h>

/* Faces of three or more corners, as they stand in a file. */
typedef struct polygons {
    mote_vec3 *at; /* [vertex_count] */
    uint32_t *corners;
    size_t *first; /* [face_count + 1] where a face's corners begin */
    size_t vertex_count, corner_count, face_count;
    size_t vertex_capacity, corner_capacity, face_capacity;
} polygons;

/* The faces of a file in any format, or no face: said is what assimp says then. */
void polygons_read(const char *path, polygons *p, char *said, size_t size);
void polygons_free(polygons *p);

/* The same, triangulated by assimp. */
void surface_read_assimp(const char *path, surface *s, char *said, size_t size);

/* What the area must be if every face is flat and simple: the sum of Newell's. *thickness: how
   far a corner is from the plane of its face at most, times two. */
double polygons_area(const polygons *p, double *thickness);

/* As triangles, each face a fan from its first corner: right where a face is convex. */
void surface_of_fans(const polygons *p, surface *s);

#endif
