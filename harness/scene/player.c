#include "harness/scene/player.h"

#include "core/skin/skin.h"
#include "harness/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Lists the morph targets by target, as the core requires; the character stores them by
   vertex. */
static mote_morph_targets list_targets(const mote_character *c, const mote_mesh *mesh)
{
    const uint32_t count = (uint32_t)c->rig.targets_count;
    uint32_t *start = mote_allocate((size_t)count + 1, sizeof *start);
    uint32_t *vertex = mote_allocate(c->target_count, sizeof *vertex);
    mote_vec3 *move = mote_allocate(c->target_count, sizeof *move);
    uint32_t *next = mote_allocate((size_t)count + 1, sizeof *next);
    for (size_t i = 0; i < c->target_count; ++i)
        ++start[c->target[i] + 1];
    for (uint32_t k = 0; k < count; ++k)
        next[k + 1] = start[k + 1] += start[k];
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        for (uint32_t i = c->shift_start[v]; i < c->shift_start[v + 1]; ++i) {
            const uint32_t at = next[c->target[i]]++;
            vertex[at] = v;
            move[at] = c->shift[i];
        }
    }
    free(next);
    return (mote_morph_targets){count, start, vertex, move};
}

static mote_status make_field(const mote_character *c, const mote_mesh *mesh,
                              mote_field **field)
{
    const uint32_t bones = (uint32_t)c->rig.bones_count;
    if (c->target_count == 0)
        return mote_field_create_skin(mesh, bones, c->start, c->bone, c->weight, field);
    const mote_morph_targets targets = list_targets(c, mesh);
    const mote_status status =
        mote_field_create_morphs(mesh, bones, c->start, c->bone, c->weight, &targets, field);
    free((void *)(uintptr_t)targets.start);
    free((void *)(uintptr_t)targets.vertex);
    free((void *)(uintptr_t)targets.move);
    return status;
}

mote_status mote_player_create(mote_character *character, const mote_mesh *mesh,
                               mote_field **field, mote_player **player)
{
    mote_field *made_field = NULL;
    const mote_status status = make_field(character, mesh, &made_field);
    if (status != MOTE_OK)
        return status;
    mote_player *made = mote_allocate(1, sizeof *made);
    made->character = character;
    made->field = made_field;
    made->speed = 1;
    made->loop = true;
    *field = made_field;
    *player = made;
    return MOTE_OK;
}

void mote_player_destroy(mote_player *player)
{
    if (!player)
        return;
    mote_character_destroy(player->character);
    free(player->sample_values);
    free(player);
}

void mote_player_weights(const mote_player *player, double frame, const mote_mat3 *rotation,
                         double *x, double *y, double *z)
{
    const mote_character *c = player->character;
    const double passed = player->start + (frame - 1) * player->speed / MOTE_PLAYER_RATE;
    mote_character_pose pose = mote_character_pose_create(c);
    mote_character_pose_set(
        c, player->clip, mote_rig_clip_time(&c->rig.clips[player->clip], passed, player->loop),
        &pose);
    mote_morph_weights(player->field, (const double(*)[3][4])pose.matrices,
                       c->target_count > 0 ? pose.morphs : NULL, rotation, x, y, z);
    mote_character_pose_free(&pose);
}

void mote_player_sample(mote_player *player, double first, double last)
{
    static const mote_mat3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const size_t padded = player->field->padded;
    free(player->sample_values);
    player->sample_values =
        mote_allocate(3 * padded * MOTE_PLAYER_SAMPLES, sizeof *player->sample_values);
    for (int k = 0; k < MOTE_PLAYER_SAMPLES; ++k) {
        double *x = player->sample_values + 3 * padded * (size_t)k;
        const double frame = first + (last - first) * (k + 0.5) / MOTE_PLAYER_SAMPLES;
        mote_player_weights(player, frame, &identity, x, x + padded, x + 2 * padded);
        player->samples[k] = (mote_weights){x, x + padded, x + 2 * padded, player->field->count,
                                            player->field->padded};
    }
}

double mote_player_frames(const mote_player *player)
{
    const double seconds = player->character->rig.clips[player->clip].seconds;
    return player->speed != 0 ? seconds * MOTE_PLAYER_RATE / fabs(player->speed) : 1;
}
