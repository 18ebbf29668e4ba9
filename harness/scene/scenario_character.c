/* Reads the character of a body and the clip that it plays. */
#include "harness/scene/scenario_read.h"

#include <stdlib.h>

/* Clips longer than this are cut: nobody plays one for months. */
#define SECONDS_MAX 1e7

#define SUBDIVIDE_MAX 8

static const char *const own_keys[] = {"clip", "start", "speed", "loop", "subdivide"};

mote_status mote_scenario_check_body(const mote_json *body, const char *known)
{
    static const char *const others[] = {"letter", "triangles", "file", "field"};
    const bool is_character = mote_json_member(body, "character").value != NULL;
    const mote_json triangles = mote_json_member(body, "triangles");
    int64_t count;
    mote_status status = mote_json_object(body, known);
    if (status != MOTE_OK)
        return status;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        const mote_json key = mote_json_member(body, others[i]);
        if (is_character && key.value)
            return mote_json_fail(&key,
                                  "a character has no %s: its file says how it looks and "
                                  "deforms; take it away",
                                  others[i]);
    }
    for (size_t i = 0; i < sizeof own_keys / sizeof own_keys[0]; ++i) {
        const mote_json key = mote_json_member(body, own_keys[i]);
        if (!is_character && key.value)
            return mote_json_fail(&key, "%s without a character; add \"character\": FILE",
                                  own_keys[i]);
    }
    return triangles.value ? mote_scenario_read_triangles(body, &count) : MOTE_OK;
}

static mote_status import(const mote_json *node, mote_character **character)
{
    char *path = NULL;
    mote_character_import facts;
    mote_status status = mote_scenario_file_path(node, &path);
    if (status == MOTE_OK)
        status = mote_character_import_file(path, character, &facts);
    if (status == MOTE_OK)
        mote_import_tell_split(path, &facts.mesh);
    free(path);
    return mote_json_blame(node, status);
}

mote_status mote_scenario_read_character(const mote_json *body, mote_character **character)
{
    const mote_json node = mote_json_member(body, "character");
    mote_json key = mote_json_member(body, "subdivide");
    int64_t times = 0;
    *character = NULL;
    mote_status status = MOTE_OK;
    if (!node.value)
        return MOTE_OK;
    if (key.value)
        status = mote_json_integer(&key, 0, SUBDIVIDE_MAX, &times);
    if (status == MOTE_OK)
        status = import(&node, character);
    if (status == MOTE_OK)
        status = mote_json_blame(&key, mote_character_subdivide(*character, (uint32_t)times));
    return status;
}

void mote_scenario_set_samples(mote_player *player, double first, double last, mote_body *body)
{
    mote_player_sample(player, first, last);
    body->samples = player->samples;
    body->sample_count = MOTE_PLAYER_SAMPLES;
}

/* "clip": a name, or a number from 1; the default is the first clip. */
static mote_status find_clip(const mote_json *key, mote_player *player)
{
    int64_t number = 1;
    const char *name = NULL;
    mote_status status = MOTE_OK;
    if (json_is_string(key->value))
        status = mote_json_string(key, &name);
    else if (json_is_number(key->value))
        status = mote_json_integer(key, 1, UINT32_MAX, &number);
    else if (key->value)
        status = mote_json_refuse(key, "the name of a clip, or its number");
    if (status != MOTE_OK)
        return status;
    return name ? mote_character_find_clip(player->character, name, &player->clip)
                : mote_character_clip_numbered(player->character, number, &player->clip);
}

static mote_status read_clip(const mote_json *body, mote_player *player)
{
    const mote_json key = mote_json_member(body, "clip");
    const mote_json at = key.value ? key : mote_json_member(body, "character");
    return mote_json_blame(&at, find_clip(&key, player));
}

static mote_status read_play(const mote_json *body, mote_player *player)
{
    mote_status status = read_clip(body, player);
    mote_json key = mote_json_member(body, "start");
    if (status == MOTE_OK && key.value)
        status = mote_json_real(&key, -SECONDS_MAX, SECONDS_MAX, &player->start);
    key = mote_json_member(body, "speed");
    if (status == MOTE_OK && key.value)
        status = mote_json_real(&key, -1e3, 1e3, &player->speed);
    key = mote_json_member(body, "loop");
    if (status == MOTE_OK && key.value)
        status = mote_json_boolean(&key, &player->loop);
    return status;
}

mote_status mote_scenario_read_clip(const mote_json *body, const mote_mesh *mesh,
                                    mote_character *character, mote_field **field,
                                    mote_body_motion *motion)
{
    const mote_json node = mote_json_member(body, "character");
    const mote_status status =
        mote_json_blame(&node, mote_player_create(character, mesh, field, &motion->player));
    if (status != MOTE_OK)
        return status;
    motion->control_count = (*field)->count;
    return read_play(body, motion->player);
}
