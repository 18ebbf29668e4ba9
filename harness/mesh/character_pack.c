/* Sends a draft from the child process that read it to the parent. */
#include "harness/mesh/character_parts.h"

#include "harness/base/memory.h"
#include "harness/process/child.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The header: how many elements each array has. The arrays follow in this order. */
#define COUNT(type, name) uint64_t name;
typedef struct header {
    uint64_t vertices, triangles;
    MOTE_RIG_ARRAYS(COUNT)
    MOTE_CHARACTER_ARRAYS(COUNT)
    mote_character_import import;
} header;
#undef COUNT

/* Sends more bytes unless an earlier send failed. */
static mote_status put(mote_status status, int output, const void *data, size_t size)
{
    return status == MOTE_OK && size > 0 ? mote_child_put(output, data, size) : status;
}

mote_status mote_character_send(int output, const mote_character_draft *draft)
{
    const mote_soup *soup = &draft->soup;
    const mote_character *made = &draft->made;
    const mote_rig *rig = &made->rig;
    header head;
    memset(&head, 0, sizeof head);
    head.vertices = soup->vertex_count;
    head.triangles = soup->triangle_count;
    head.import = draft->import;
#define COUNT_RIG(type, name) head.name = rig->name##_count;
#define COUNT_OWN(type, name) head.name = made->name##_count;
    MOTE_RIG_ARRAYS(COUNT_RIG)
    MOTE_CHARACTER_ARRAYS(COUNT_OWN)
    mote_status status = put(MOTE_OK, output, &head, sizeof head);
    status = put(status, output, soup->xyz, 3 * soup->vertex_count * sizeof *soup->xyz);
    status =
        put(status, output, soup->indices, 3 * soup->triangle_count * sizeof *soup->indices);
#define PUT_RIG(type, name)                                                                    \
    status = put(status, output, rig->name, rig->name##_count * sizeof(type));
#define PUT_OWN(type, name)                                                                    \
    status = put(status, output, made->name, made->name##_count * sizeof(type));
    MOTE_RIG_ARRAYS(PUT_RIG)
    MOTE_CHARACTER_ARRAYS(PUT_OWN)
    return status;
}

typedef struct cursor {
    const char *at;
    size_t left;
    bool ended_early;
} cursor;

/* A copy of the next elements; never NULL. */
static void *copy_next(cursor *from, uint64_t count, size_t size, size_t *taken)
{
    if (from->ended_early || count > from->left / size) {
        from->ended_early = true;
        *taken = 0;
        return mote_allocate(0, size);
    }
    void *copy = mote_copy(from->at, count * size);
    from->at += count * size;
    from->left -= count * size;
    *taken = count;
    return copy;
}

static void copy_arrays(cursor *from, const header *head, mote_character_draft *draft)
{
    mote_soup *soup = &draft->soup;
    mote_character *made = &draft->made;
    mote_rig *rig = &made->rig;
    soup->xyz = copy_next(from, head->vertices, 3 * sizeof *soup->xyz, &soup->vertex_count);
    soup->indices =
        copy_next(from, head->triangles, 3 * sizeof *soup->indices, &soup->triangle_count);
#define TAKE_RIG(type, name)                                                                   \
    rig->name = copy_next(from, head->name, sizeof(type), &rig->name##_count);                 \
    rig->name##_capacity = rig->name##_count;
#define TAKE_OWN(type, name)                                                                   \
    made->name = copy_next(from, head->name, sizeof(type), &made->name##_count);               \
    made->name##_capacity = made->name##_count;
    MOTE_RIG_ARRAYS(TAKE_RIG)
    MOTE_CHARACTER_ARRAYS(TAKE_OWN)
}

/* Whether start[vertices + 1] rises from 0 to the end of an array. */
static bool is_index(const uint32_t *start, size_t count, size_t vertices, size_t end)
{
    if (count != vertices + 1 || start[0] != 0 || start[vertices] != end)
        return false;
    for (size_t v = 0; v < vertices; ++v) {
        if (start[v] > start[v + 1])
            return false;
    }
    return true;
}

/* Whether the arrays of weights and shifts are valid. */
static bool are_arrays_whole(const mote_character_draft *draft)
{
    const mote_character *c = &draft->made;
    const size_t vertices = draft->soup.vertex_count;
    if (c->weight_count != c->bone_count || c->shift_count != c->target_count ||
        !is_index(c->start, c->start_count, vertices, c->bone_count) ||
        !is_index(c->shift_start, c->shift_start_count, vertices, c->target_count))
        return false;
    for (size_t i = 0; i < c->bone_count; ++i) {
        if (c->bone[i] >= c->rig.bones_count || !(c->weight[i] > 0) || !(c->weight[i] <= 1))
            return false;
    }
    for (size_t i = 0; i < c->target_count; ++i) {
        if (c->target[i] >= c->rig.targets_count)
            return false;
    }
    return true;
}

static bool is_track_whole(const mote_rig *rig, const mote_rig_track *track, size_t width)
{
    const size_t numbers = track->mode == MOTE_TRACK_CUBIC ? 3 * width : width;
    return track->mode <= MOTE_TRACK_CUBIC && track->count >= 1 &&
           (size_t)track->time + track->count <= rig->times_count &&
           track->value + track->count * numbers <= rig->values_count;
}

static bool is_clip_whole(const mote_rig *rig, const mote_rig_clip *clip)
{
    bool whole = (size_t)clip->channel + clip->channel_count <= rig->channels_count &&
                 (size_t)clip->morph + clip->morph_count <= rig->morphs_count &&
                 clip->name < rig->names_count && clip->seconds >= 0 && isfinite(clip->seconds);
    for (size_t k = 0; whole && k < clip->channel_count; ++k) {
        const mote_rig_channel *channel = &rig->channels[clip->channel + k];
        whole = channel->node < rig->nodes_count &&
                is_track_whole(rig, &channel->position, 3) &&
                is_track_whole(rig, &channel->rotation, 4) &&
                is_track_whole(rig, &channel->scale, 3);
    }
    for (size_t k = 0; whole && k < clip->morph_count; ++k) {
        const mote_rig_morph *morph = &rig->morphs[clip->morph + k];
        whole = morph->target < rig->targets_count && is_track_whole(rig, &morph->weight, 1);
    }
    return whole;
}

static bool is_rig_whole(const mote_rig *rig)
{
    bool whole = rig->nodes_count > 0 && rig->bones_count > 0 &&
                 rig->bones_count <= UINT16_MAX && rig->names_count > 0 &&
                 rig->names[rig->names_count - 1] == '\0';
    for (size_t n = 0; whole && n < rig->nodes_count; ++n)
        whole = (rig->nodes[n].parent == MOTE_RIG_NONE || rig->nodes[n].parent < n) &&
                rig->nodes[n].name < rig->names_count;
    for (size_t b = 0; whole && b < rig->bones_count; ++b)
        whole = rig->bones[b].node < rig->nodes_count;
    for (size_t t = 0; whole && t < rig->targets_count; ++t)
        whole =
            rig->targets[t].node < rig->nodes_count && rig->targets[t].name < rig->names_count;
    for (size_t k = 0; whole && k < rig->clips_count; ++k)
        whole = is_clip_whole(rig, &rig->clips[k]);
    return whole;
}

mote_status mote_character_receive(const char *path, const char *data, size_t size,
                                   mote_character_draft *draft)
{
    header head;
    if (size < sizeof head)
        return mote_fail(MOTE_EIO, "%s: reading it gave no result", path);
    memcpy(&head, data, sizeof head);
    mote_character_draft made = {.import = head.import};
    made.import.mesh.split.where[MOTE_SPLIT_TEXT - 1] = '\0';
    cursor from = {data + sizeof head, size - sizeof head, false};
    copy_arrays(&from, &head, &made);
    if (from.ended_early || from.left > 0 || !is_rig_whole(&made.made.rig) ||
        !are_arrays_whole(&made)) {
        mote_character_draft_free(&made);
        return mote_fail(MOTE_EIO, "%s: reading it ended early", path);
    }
    *draft = made;
    return MOTE_OK;
}
