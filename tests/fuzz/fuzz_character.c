/* Any bytes as what the child process that reads characters sends: welded as there, and
   accepted, checked, cut finer, scaled, posed and made a field of the core as in the parent.
   Also as a glTF file, text or binary, with the nodes and clips of a small rig. */
#include "harness/base/memory.h"
#include "harness/mesh/character.h"
#include "harness/mesh/character_parts.h"
#include "harness/gltf/gltf_file.h"
#include "harness/scene/player.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>
#include <string.h>

/* Poses every clip at both ends and in between. */
static void pose(const mote_rig *rig)
{
    mote_affine *globals = calloc(rig->nodes_count + 1, sizeof *globals);
    mote_affine *matrices = calloc(rig->bones_count + 1, sizeof *matrices);
    double *weights = calloc(rig->targets_count + 1, sizeof *weights);
    for (uint32_t k = 0; globals && matrices && weights && k < rig->clips_count; ++k) {
        for (int part = 0; part <= 2; ++part) {
            const double seconds =
                mote_rig_clip_time(&rig->clips[k], part * rig->clips[k].seconds / 2, 0);
            mote_rig_globals(rig, k, seconds, globals);
            mote_rig_matrices(rig, globals, matrices);
            mote_rig_morph_weights(rig, k, seconds, weights);
        }
    }
    free(globals);
    free(matrices);
    free(weights);
}

/* One node and one target with linear keys, which the file may change. */
static void read_keys(mote_gltf *gltf)
{
    const size_t count = json_array_size(json_object_get(gltf->root, "nodes"));
    uint32_t *nodes = mote_allocate(count, sizeof *nodes); /* all are the rig's one */
    mote_rig rig = {0};
    const uint32_t name = mote_rig_add_name(&rig, "Part");
    const mote_rig_track track = {MOTE_TRACK_LINEAR, 1, 0, 0};
    MOTE_RIG_GROW(&rig, times, 1);
    MOTE_RIG_GROW(&rig, values, 4);
    MOTE_RIG_GROW(&rig, nodes, 1);
    rig.nodes[0] = (mote_rig_node){MOTE_RIG_NONE, name, mote_affine_identity()};
    MOTE_RIG_GROW(&rig, targets, 1);
    rig.targets[0] = (mote_rig_target){.name = name};
    MOTE_RIG_GROW(&rig, channels, 1);
    rig.channels[0] = (mote_rig_channel){0, track, track, track};
    MOTE_RIG_GROW(&rig, morphs, 1);
    rig.morphs[0] = (mote_rig_morph){0, track};
    MOTE_RIG_GROW(&rig, clips, 1);
    rig.clips[0] = (mote_rig_clip){name, 0, 1, 0, 1, 1};
    if (mote_character_set_gltf_keys(gltf, nodes, &rig) == MOTE_OK &&
        mote_character_check_rig("any.gltf", &rig) == MOTE_OK)
        pose(&rig);
    mote_rig_free(&rig);
    free(nodes);
}

/* The text for assimp is JSON, with the nodes that the file has. */
static void rewrite(mote_gltf *gltf, bool moves)
{
    mote_gltf made;
    char *text = mote_gltf_text(gltf, moves);
    if (mote_gltf_open("any", text, strlen(text), &made) != MOTE_OK ||
        json_array_size(json_object_get(made.root, "nodes")) !=
            json_array_size(json_object_get(gltf->root, "nodes")))
        abort();
    mote_gltf_close(&made);
    free(text);
}

/* What is done before and after assimp reads a file. */
static void read_gltf(const char *data, size_t size)
{
    mote_gltf gltf;
    if (!mote_gltf_is("any", data, size) || mote_gltf_open("any", data, size, &gltf) != MOTE_OK)
        return;
    if (mote_gltf_check(&gltf, true) == MOTE_OK && mote_gltf_check(&gltf, false) != MOTE_OK)
        abort(); /* less is refused where nothing moves */
    (void)mote_gltf_check_joints(&gltf);
    if (mote_gltf_is_2(&gltf)) {
        rewrite(&gltf, false);
        rewrite(&gltf, true);
    }
    read_keys(&gltf);
    mote_gltf_close(&gltf);
}

/* The path of a scenario: finer, scaled, with sample poses. Takes the character. */
static void play(mote_character *character)
{
    mote_field *field;
    mote_player *player;
    const mote_vec3 factor = {2, 0.5, 1e-3};
    uint32_t clip;
    if (mote_character_subdivide(character, 1) != MOTE_OK ||
        mote_character_scale(character, factor) != MOTE_OK ||
        mote_character_clip_numbered(character, 1, &clip) != MOTE_OK ||
        mote_player_create(character, character->mesh, &field, &player) != MOTE_OK) {
        mote_character_destroy(character);
        return;
    }
    player->start = -0.25;
    player->speed = -1.5;
    mote_player_sample(player, 1, 1 + mote_player_frames(player));
    mote_field_destroy(field);
    mote_player_destroy(player);
}

/* As the child process does with what assimp gave, whose indices it has checked. */
static void weld(mote_character_draft *draft)
{
    mote_soup *soup = &draft->soup;
    if (soup->vertex_count == 0)
        return;
    soup->lines = mote_allocate(soup->triangle_count, sizeof *soup->lines);
    for (size_t i = 0; i < 3 * soup->triangle_count; ++i)
        soup->indices[i] %= (uint32_t)soup->vertex_count;
    (void)mote_character_weld("any.glb", draft);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    mote_character_draft draft;
    mote_character *character;
    read_gltf((const char *)data, size);
    if (mote_character_receive("any.glb", (const char *)data, size, &draft) != MOTE_OK)
        return 0;
    weld(&draft);
    mote_character_draft_free(&draft);
    if (mote_character_receive("any.glb", (const char *)data, size, &draft) != MOTE_OK)
        return 0;
    if (mote_character_check_rig("any.glb", &draft.made.rig) == MOTE_OK)
        pose(&draft.made.rig);
    if (mote_character_make("any.glb", &draft, &character) == MOTE_OK) {
        mote_soup_free(&draft.soup);
        play(character);
    } else {
        mote_character_draft_free(&draft);
    }
    return 0;
}
