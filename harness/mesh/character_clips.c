/* Clips read by assimp, which supports linear keys only: see character_gltf.c for the
   others. */
#include "harness/mesh/character_parts.h"
#include "harness/mesh/mesh_assimp.h"

#include "harness/base/memory.h"

#include <assimp/cimport.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Ticks per second if the file does not say; assimp's own viewer uses the same number. */
#define TICKS 25.0

typedef struct clip_reader {
    const struct aiAnimation *animation;
    double tick; /* seconds */
    double last; /* key, seconds */
    const mote_node_name *names;
    mote_rig *rig;
    bool *taken; /* [nodes, then targets]: whether they have keys in this clip */
} clip_reader;

/* Reserves memory for keys; *times and *values point to it. */
static mote_rig_track add_track(clip_reader *r, uint32_t count, uint32_t width, double **times,
                                double **values)
{
    mote_rig *rig = r->rig;
    const mote_rig_track track = {MOTE_TRACK_LINEAR, count, (uint32_t)rig->times_count,
                                  (uint32_t)rig->values_count};
    MOTE_RIG_GROW(rig, times, count);
    MOTE_RIG_GROW(rig, values, (size_t)count * width);
    *times = rig->times + track.time;
    *values = rig->values + track.value;
    return track;
}

/* A time that is not finite is kept, for mote_character_check_rig to name. */
static double key_time(clip_reader *r, double ticks)
{
    const double seconds = ticks * r->tick;
    r->last = seconds > r->last && isfinite(seconds) ? seconds : r->last;
    return seconds;
}

/* Without keys, makes one key from the node's own map. */
static mote_rig_track add_vectors(clip_reader *r, const struct aiVectorKey *keys,
                                  unsigned count, struct aiVector3D otherwise)
{
    double *times, *values;
    const struct aiVectorKey one = {.mTime = 0, .mValue = otherwise};
    const mote_rig_track track = add_track(r, count > 0 ? count : 1, 3, &times, &values);
    for (unsigned k = 0; k < track.count; ++k) {
        const struct aiVectorKey *key = count > 0 ? &keys[k] : &one;
        times[k] = key_time(r, key->mTime);
        values[3 * (size_t)k] = (double)key->mValue.x;
        values[3 * (size_t)k + 1] = (double)key->mValue.y;
        values[3 * (size_t)k + 2] = (double)key->mValue.z;
    }
    return track;
}

static mote_rig_track add_rotations(clip_reader *r, const struct aiNodeAnim *from,
                                    struct aiQuaternion otherwise)
{
    double *times, *values;
    const unsigned count = from->mNumRotationKeys;
    const struct aiQuatKey one = {.mTime = 0, .mValue = otherwise};
    const mote_rig_track track = add_track(r, count > 0 ? count : 1, 4, &times, &values);
    for (unsigned k = 0; k < track.count; ++k) {
        const struct aiQuatKey *key = count > 0 ? &from->mRotationKeys[k] : &one;
        times[k] = key_time(r, key->mTime);
        values[4 * (size_t)k] = (double)key->mValue.w;
        values[4 * (size_t)k + 1] = (double)key->mValue.x;
        values[4 * (size_t)k + 2] = (double)key->mValue.y;
        values[4 * (size_t)k + 3] = (double)key->mValue.z;
    }
    return track;
}

static void decompose_rest(const mote_affine *rest, struct aiVector3D *position,
                           struct aiQuaternion *rotation, struct aiVector3D *scale)
{
    struct aiMatrix4x4 m;
    aiIdentityMatrix4(&m);
    m.a1 = (float)rest->m[0][0], m.a2 = (float)rest->m[0][1], m.a3 = (float)rest->m[0][2];
    m.b1 = (float)rest->m[1][0], m.b2 = (float)rest->m[1][1], m.b3 = (float)rest->m[1][2];
    m.c1 = (float)rest->m[2][0], m.c2 = (float)rest->m[2][1], m.c3 = (float)rest->m[2][2];
    m.a4 = (float)rest->m[0][3], m.b4 = (float)rest->m[1][3], m.c4 = (float)rest->m[2][3];
    aiDecomposeMatrix(&m, scale, rotation, position);
}

/* Adds a channel. Of two channels for a node the first counts; a channel for an unknown node
   moves nothing here. */
static void add_channel(clip_reader *r, const struct aiNodeAnim *from)
{
    const uint32_t node = mote_node_find(r->names, r->rig->nodes_count, from->mNodeName.data);
    if (node == MOTE_RIG_NONE || r->taken[node])
        return;
    struct aiVector3D position, scale;
    struct aiQuaternion rotation;
    decompose_rest(&r->rig->nodes[node].rest, &position, &rotation, &scale);
    const mote_rig_channel made = {
        node, add_vectors(r, from->mPositionKeys, from->mNumPositionKeys, position),
        add_rotations(r, from, rotation),
        add_vectors(r, from->mScalingKeys, from->mNumScalingKeys, scale)};
    const size_t own = r->rig->channels_count;
    MOTE_RIG_GROW(r->rig, channels, 1);
    r->rig->channels[own] = made;
    r->taken[node] = true;
}

/* What a key says of a target, or NULL. */
static const double *weight_in(const struct aiMeshMorphKey *key, uint32_t number)
{
    const double *weight = NULL;
    for (unsigned i = 0; i < key->mNumValuesAndWeights; ++i) {
        if (key->mValues[i] == number)
            weight = &key->mWeights[i];
    }
    return weight;
}

static uint32_t count_weights(const struct aiMeshMorphAnim *from, uint32_t number)
{
    uint32_t count = 0;
    for (unsigned k = 0; k < from->mNumKeys; ++k)
        count += weight_in(&from->mKeys[k], number) != NULL;
    return count;
}

/* The weight of one target at the `count` keys that name it: assimp merges the keys of all
   targets of an FBX mesh into one list, in which each names those that have a key then. */
static mote_rig_track add_weights(clip_reader *r, const struct aiMeshMorphAnim *from,
                                  uint32_t number, uint32_t count)
{
    double *times, *values;
    const mote_rig_track track = add_track(r, count, 1, &times, &values);
    for (unsigned k = 0, own = 0; k < from->mNumKeys; ++k) {
        const double *weight = weight_in(&from->mKeys[k], number);
        if (!weight)
            continue;
        times[own] = key_time(r, from->mKeys[k].mTime);
        values[own++] = *weight;
    }
    return track;
}

/* A channel names a node; in an FBX file, as "NODE*" and a number. */
static void add_morph(clip_reader *r, const struct aiMeshMorphAnim *from)
{
    char name[MAXLEN];
    (void)strncpy(name, from->mName.data, sizeof name - 1);
    name[sizeof name - 1] = '\0';
    uint32_t node = mote_node_find(r->names, r->rig->nodes_count, name);
    if (node == MOTE_RIG_NONE && strrchr(name, '*')) {
        *strrchr(name, '*') = '\0';
        node = mote_node_find(r->names, r->rig->nodes_count, name);
    }
    for (uint32_t t = 0; t < r->rig->targets_count; ++t) {
        bool *taken = &r->taken[r->rig->nodes_count + t];
        const uint32_t number = r->rig->targets[t].number;
        const bool is_moved =
            node != MOTE_RIG_NONE && r->rig->targets[t].node == node && !*taken;
        const uint32_t keys = is_moved ? count_weights(from, number) : 0;
        if (keys == 0)
            continue;
        const mote_rig_morph made = {t, add_weights(r, from, number, keys)};
        const size_t own = r->rig->morphs_count;
        MOTE_RIG_GROW(r->rig, morphs, 1);
        r->rig->morphs[own] = made;
        *taken = true;
    }
}

static void add_clip(clip_reader *r)
{
    mote_rig *rig = r->rig;
    const struct aiAnimation *from = r->animation;
    const double ticks = from->mTicksPerSecond;
    r->tick = 1 / (ticks > 0 && isfinite(ticks) ? ticks : TICKS);
    r->last = 0;
    mote_rig_clip made = {.name = mote_rig_add_name(rig, from->mName.data),
                          .channel = (uint32_t)rig->channels_count,
                          .morph = (uint32_t)rig->morphs_count};
    for (unsigned c = 0; c < from->mNumChannels; ++c)
        add_channel(r, from->mChannels[c]);
    for (unsigned c = 0; c < from->mNumMorphMeshChannels; ++c)
        add_morph(r, from->mMorphMeshChannels[c]);
    made.channel_count = (uint32_t)rig->channels_count - made.channel;
    made.morph_count = (uint32_t)rig->morphs_count - made.morph;
    const double seconds = from->mDuration * r->tick;
    made.seconds = seconds > 0 && isfinite(seconds) ? seconds : r->last;
    const size_t own = rig->clips_count;
    MOTE_RIG_GROW(rig, clips, 1);
    rig->clips[own] = made;
}

void mote_character_read_clips(const struct aiScene *scene, const mote_node_name *names,
                               mote_rig *rig)
{
    for (unsigned a = 0; a < scene->mNumAnimations; ++a) {
        clip_reader r = {
            .animation = scene->mAnimations[a],
            .names = names,
            .rig = rig,
            .taken = mote_allocate(rig->nodes_count + rig->targets_count, sizeof *r.taken)};
        add_clip(&r);
        free(r.taken);
    }
}
