/* Meshes as assimp reads and triangulates them, without any code of harness/mesh. */
#ifndef MOTE_TESTS_READERS_ASSIMP_H
#define MOTE_TESTS_READERS_ASSIMP_H

#include "tests/studies/readers_compare.h"

#include <stdint.h>

/* Faces of three or more corners, as in the file. */
typedef struct polygons {
    mote_vec3 *at; /* [vertex_count] */
    uint32_t *corners;
    size_t *first; /* [face_count + 1] where a face's corners begin */
    size_t vertex_count, corner_count, face_count;
    size_t vertex_capacity, corner_capacity, face_capacity;
} polygons;

/* Reads the faces of a file in any format. If there are none, said is assimp's message. */
void polygons_read(const char *path, polygons *p, char *said, size_t size);
void polygons_free(polygons *p);

/* The same, triangulated by assimp. */
void surface_read_assimp(const char *path, surface *s, char *said, size_t size);

/* The area if every face is flat and simple: the sum of Newell's. *thickness: twice the largest
   distance of a corner from the plane of its face. */
double polygons_area(const polygons *p, double *thickness);

/* Triangulates each face as a fan from its first corner, which is right for convex faces. */
void surface_of_fans(const polygons *p, surface *s);

#endif
