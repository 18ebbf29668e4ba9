/* What a skin is made of (skin.h). */
#ifndef MOTE_CORE_SKIN_DATA_H
#define MOTE_CORE_SKIN_DATA_H

#include "core/body/body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Weights are stored as multiples of 2^-24, so that those of a vertex add up to 1 exactly. */
typedef struct mote_skin {
    uint32_t bones, vertex_count;
    uint32_t most; /* bones of one vertex, at most */
    mote_vec3 origin;
    double unit;     /* s */
    uint32_t *start; /* [vertex_count + 1] */
    uint16_t *bone;  /* [start[vertex_count]], ascending for each vertex, each once */
    float *weight;   /* [start[vertex_count]], > 0 */
    double off;      /* the largest abs(sum - 1) of a vertex's weights as they were given */
} mote_skin;

/* The skin of a field that is known to have one. */
static inline const mote_skin *mote_skin_of(const mote_field *field)
{
    return (const mote_skin *)field->data;
}

#ifdef __cplusplus
}
#endif
#endif
