/* What a skin is made of (skin.h). */
#ifndef MOTE_CORE_SKIN_DATA_H
#define MOTE_CORE_SKIN_DATA_H

#include "core/body/body.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MOTE_MORPH_TARGETS_MAX 65535

/* Morph targets as they are given. Target k moves vertex[i] by move[i], in rest axes, for
   start[k] <= i < start[k + 1]; start[0] is 0. Vertices may be in any order; those that are not
   named stay where they are. */
typedef struct mote_morph_targets {
    uint32_t count;        /* 1 .. MOTE_MORPH_TARGETS_MAX */
    const uint32_t *start; /* [count + 1] */
    const uint32_t *vertex;
    const mote_vec3 *move;
} mote_morph_targets;

/* Morph targets, by vertex. A displacement is a float times the size of its target, a power of
   two near the longest of the target, or 0 for one that moves nothing, in rest axes. */
typedef struct mote_morph {
    uint32_t targets; /* 0: none, and nothing else is set */
    uint32_t most;    /* targets of one vertex, at most */
    uint32_t *start;  /* [vertex_count + 1] */
    uint16_t *target; /* [start[vertex_count]], ascending for each vertex */
    float (*move)[3]; /* [start[vertex_count]], not all three 0 */
    double *size;     /* [targets] */
} mote_morph;

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
    mote_morph morph;
} mote_skin;

/* The skin of a field that is known to have one. */
static inline const mote_skin *mote_skin_of(const mote_field *field)
{
    return (const mote_skin *)field->data;
}

/* Weight vectors: of the bones, and with targets those of the pose's rotation and of the
   targets, which are numbers in x. */
static inline uint32_t mote_morph_first(const mote_skin *skin)
{
    return 4 * skin->bones + 3;
}

static inline uint32_t mote_skin_functions(const mote_skin *skin)
{
    return skin->morph.targets ? mote_morph_first(skin) + skin->morph.targets : 4 * skin->bones;
}

#ifdef __cplusplus
}
#endif
#endif
