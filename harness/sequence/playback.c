#include "harness/sequence/playback.h"

#include "harness/base/memory.h"
#include "harness/sequence/sequence_reader.h"

#include <math.h>
#include <stdlib.h>

struct mote_playback {
    const mote_sequence *sequence;
    mote_sequence_reader *reader;
    mote_vec3 *frame[2]; /* as they are in the sequence */
    uint32_t number[2];  /* 0: none yet */
};

mote_playback *mote_playback_create(const mote_sequence *sequence)
{
    mote_playback *made = mote_allocate(1, sizeof *made);
    made->sequence = sequence;
    made->reader = mote_sequence_reader_create(sequence);
    for (int k = 0; k < 2; ++k)
        made->frame[k] = mote_allocate(sequence->vertex_count, sizeof *made->frame[k]);
    return made;
}

void mote_playback_destroy(mote_playback *playback)
{
    if (!playback)
        return;
    mote_sequence_reader_destroy(playback->reader);
    free(playback->frame[0]);
    free(playback->frame[1]);
    free(playback);
}

/* Makes p->frame[slot] hold frame number. */
static mote_status fetch(mote_playback *p, int slot, uint32_t number)
{
    if (p->number[slot] == number)
        return MOTE_OK;
    if (p->number[!slot] == number) {
        mote_vec3 *other = p->frame[!slot];
        p->frame[!slot] = p->frame[slot];
        p->number[!slot] = p->number[slot];
        p->frame[slot] = other;
    } else {
        p->number[slot] = 0;
        const mote_status status = mote_sequence_read(p->reader, number, p->frame[slot]);
        if (status != MOTE_OK)
            return status;
    }
    p->number[slot] = number;
    return MOTE_OK;
}

mote_status mote_playback_at(mote_playback *playback, double place, const mote_pose *pose,
                             mote_vec3 *world)
{
    mote_playback *p = playback;
    const double inside = fmin(fmax(place, 1), p->sequence->frames);
    const uint32_t number = (uint32_t)inside;
    const double part = inside - number;
    mote_status status = fetch(p, 0, number);
    if (status == MOTE_OK && part > 0)
        status = fetch(p, 1, number + 1);
    if (status != MOTE_OK)
        return status;
    const mote_vec3 *from = p->frame[0], *to = p->frame[1];
    for (uint32_t v = 0; v < p->sequence->vertex_count; ++v) {
        const mote_vec3 at =
            part > 0 ? mote_add_scaled(from[v], part, mote_sub(to[v], from[v])) : from[v];
        world[v] = mote_pose_apply(pose, at);
    }
    return MOTE_OK;
}
