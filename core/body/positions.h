/* Positions of a body's vertices in the caller's memory: double or single precision, one after
   the other or inside larger records. */
#ifndef MOTE_CORE_POSITIONS_H
#define MOTE_CORE_POSITIONS_H

#include "core/base/vec3.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Vertex i has its x, y, z at data + i * stride bytes. data is aligned to its numbers, stride a
   multiple of their size and at least three of them. Only x, y, z of the vertices that a mesh
   has, and what lies between them, are read. */
typedef struct mote_positions {
    const void *data;
    size_t stride; /* bytes */
    bool single;   /* float, else double */
} mote_positions;

/* An array of vectors. */
static inline mote_positions mote_positions_of(const mote_vec3 *vertices)
{
    const mote_positions positions = {vertices, sizeof *vertices, false};
    return positions;
}

static inline mote_vec3 mote_position_at(const mote_positions *positions, uint32_t vertex)
{
    const char *at = (const char *)positions->data + vertex * positions->stride;
    if (positions->single) {
        const float *p = (const float *)(const void *)at;
        return mote_vec3_make((double)p[0], (double)p[1], (double)p[2]);
    }
    const double *p = (const double *)(const void *)at;
    return mote_vec3_make(p[0], p[1], p[2]);
}

#endif
