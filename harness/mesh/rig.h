/* A rig: the nodes of a file, the bones that attach vertices to them, morph targets, and clips,
   which are animations over time. */
#ifndef MOTE_HARNESS_RIG_H
#define MOTE_HARNESS_RIG_H

#include "harness/mesh/affine.h"
#include "harness/mesh/track.h"

#include <stddef.h>
#include <stdint.h>

#define MOTE_RIG_NONE UINT32_MAX

typedef struct mote_rig_node {
    uint32_t parent; /* smaller than the node's own number; MOTE_RIG_NONE: a root */
    uint32_t name;   /* index of its first character in names; the same for all names below */
    mote_affine rest;
} mote_rig_node;

/* Maps a vertex at rest to where its node moves it: global(node) * bind. */
typedef struct mote_rig_bone {
    uint32_t node;
    mote_affine bind;
} mote_rig_bone;

typedef struct mote_rig_target {
    uint32_t name;
    uint32_t node;   /* that its mesh belongs to */
    uint32_t number; /* among the targets of that mesh, from 0 */
    double weight;   /* unless a clip sets it */
} mote_rig_target;

/* A track; its keys begin at these indices in times and values. */
typedef struct mote_rig_track {
    uint32_t mode; /* mote_track_mode */
    uint32_t count;
    uint32_t time, value;
} mote_rig_track;

/* A clip's effect on a node: its local map is translation * rotation * scale. */
typedef struct mote_rig_channel {
    uint32_t node;
    mote_rig_track position, rotation, scale;
} mote_rig_channel;

/* A clip's effect on a morph target: tracks of width 1. */
typedef struct mote_rig_morph {
    uint32_t target;
    mote_rig_track weight;
} mote_rig_morph;

typedef struct mote_rig_clip {
    uint32_t name;
    uint32_t channel, channel_count; /* from channels */
    uint32_t morph, morph_count;     /* from morphs */
    double seconds;                  /* its length, >= 0 */
} mote_rig_clip;

/* X(type, name): the arrays that a rig consists of. */
#define MOTE_RIG_ARRAYS(X)                                                                     \
    X(mote_rig_node, nodes)                                                                    \
    X(mote_rig_bone, bones)                                                                    \
    X(mote_rig_target, targets)                                                                \
    X(mote_rig_clip, clips)                                                                    \
    X(mote_rig_channel, channels)                                                              \
    X(mote_rig_morph, morphs)                                                                  \
    X(double, times)                                                                           \
    X(double, values)                                                                          \
    X(char, names)

#define MOTE_RIG_ARRAY(type, name)                                                             \
    type *name;                                                                                \
    size_t name##_count, name##_capacity;

/* Zero-initialised: an empty rig. Everything is owned. */
typedef struct mote_rig {
    MOTE_RIG_ARRAYS(MOTE_RIG_ARRAY)
} mote_rig;

/* Grows an array by `more` elements set to 0. A size of 2^32 or more counts as out of
   memory. */
#define MOTE_RIG_GROW(rig, name, more)                                                         \
    ((rig)->name = mote_rig_grow((rig)->name, &(rig)->name##_count, &(rig)->name##_capacity,   \
                                 (more), sizeof *(rig)->name))
void *mote_rig_grow(void *array, size_t *count, size_t *capacity, size_t more, size_t size);

/* Adds a name, cut to 200 bytes and without control characters; returns its index in names. */
uint32_t mote_rig_add_name(mote_rig *rig, const char *name);

void mote_rig_free(mote_rig *rig);

/* Computes globals[nodes_count]: the local maps of nodes, at rest or in a clip, multiplied with
   those of their parents. clip: from 0, or MOTE_RIG_NONE. Cost O(nodes + channels log keys). */
void mote_rig_globals(const mote_rig *rig, uint32_t clip, double seconds, mote_affine *globals);

/* Computes matrices[bones_count]; each maps a vertex at rest to its place. */
void mote_rig_matrices(const mote_rig *rig, const mote_affine *globals, mote_affine *matrices);

/* Computes weights[targets_count] of the morph targets. */
void mote_rig_morph_weights(const mote_rig *rig, uint32_t clip, double seconds,
                            double *weights);

/* The time within a clip after so many seconds, from 0 to its length: beyond it the clip
   restarts, or stays at its end. Negative times are allowed. */
double mote_rig_clip_time(const mote_rig_clip *clip, double seconds, int loop);

#endif
