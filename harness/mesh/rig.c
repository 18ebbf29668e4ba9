#include "harness/mesh/rig.h"

#include "core/base/quaternion.h"
#include "harness/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAME_MAX_BYTES 200

void *mote_rig_grow(void *array, size_t *count, size_t *capacity, size_t more, size_t size)
{
    if (more >= UINT32_MAX - *count)
        mote_out_of_memory(SIZE_MAX);
    char *grown = mote_reserve(array, *count + more, capacity, size);
    memset(grown + *count * size, 0, more * size);
    *count += more;
    return grown;
}

uint32_t mote_rig_add_name(mote_rig *rig, const char *name)
{
    const size_t at = rig->names_count, length = strnlen(name, NAME_MAX_BYTES);
    MOTE_RIG_GROW(rig, names, length + 1);
    for (size_t i = 0; i < length; ++i) {
        const unsigned char c = (unsigned char)name[i];
        rig->names[at + i] = (char)(c < ' ' || c == 0x7f ? ' ' : c);
    }
    return (uint32_t)at;
}

void mote_rig_free(mote_rig *rig)
{
#define FREE(type, name) free(rig->name);
    MOTE_RIG_ARRAYS(FREE)
#undef FREE
    *rig = (mote_rig){0};
}

static mote_track track_of(const mote_rig *rig, const mote_rig_track *t)
{
    return (mote_track){(mote_track_mode)t->mode, t->count, rig->times + t->time,
                        rig->values + t->value};
}

/* translation * rotation * scale */
static mote_affine local_map(const mote_rig *rig, const mote_rig_channel *channel,
                             double seconds)
{
    double p[3], q[4], s[3];
    const mote_track position = track_of(rig, &channel->position);
    const mote_track rotation = track_of(rig, &channel->rotation);
    const mote_track scale = track_of(rig, &channel->scale);
    mote_track_evaluate(&position, 3, seconds, p);
    mote_track_rotation(&rotation, seconds, q);
    mote_track_evaluate(&scale, 3, seconds, s);
    const mote_mat3 turn = mote_quaternion_matrix((mote_quaternion){q[0], q[1], q[2], q[3]});
    mote_affine map;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            map.m[r][c] = turn.m[r][c] * s[c];
        map.m[r][3] = p[r];
    }
    return map;
}

void mote_rig_globals(const mote_rig *rig, uint32_t clip, double seconds, mote_affine *globals)
{
    for (size_t n = 0; n < rig->nodes_count; ++n)
        globals[n] = rig->nodes[n].rest;
    if (clip != MOTE_RIG_NONE) {
        const mote_rig_clip *playing = &rig->clips[clip];
        for (uint32_t k = 0; k < playing->channel_count; ++k) {
            const mote_rig_channel *channel = &rig->channels[playing->channel + k];
            globals[channel->node] = local_map(rig, channel, seconds);
        }
    }
    for (size_t n = 0; n < rig->nodes_count; ++n) { /* a parent precedes its children */
        if (rig->nodes[n].parent != MOTE_RIG_NONE)
            globals[n] = mote_affine_multiply(&globals[rig->nodes[n].parent], &globals[n]);
    }
}

void mote_rig_matrices(const mote_rig *rig, const mote_affine *globals, mote_affine *matrices)
{
    for (size_t b = 0; b < rig->bones_count; ++b)
        matrices[b] = mote_affine_multiply(&globals[rig->bones[b].node], &rig->bones[b].bind);
}

void mote_rig_morph_weights(const mote_rig *rig, uint32_t clip, double seconds, double *weights)
{
    for (size_t t = 0; t < rig->targets_count; ++t)
        weights[t] = rig->targets[t].weight;
    if (clip == MOTE_RIG_NONE)
        return;
    const mote_rig_clip *playing = &rig->clips[clip];
    for (uint32_t k = 0; k < playing->morph_count; ++k) {
        const mote_rig_morph *morph = &rig->morphs[playing->morph + k];
        const mote_track track = track_of(rig, &morph->weight);
        mote_track_evaluate(&track, 1, seconds, &weights[morph->target]);
    }
}

double mote_rig_clip_time(const mote_rig_clip *clip, double seconds, int loop)
{
    if (!(clip->seconds > 0))
        return 0;
    if (!loop)
        return fmin(fmax(seconds, 0), clip->seconds);
    const double rest = fmod(seconds, clip->seconds);
    return rest < 0 ? rest + clip->seconds : rest;
}
