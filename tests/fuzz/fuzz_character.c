/* Any bytes as what the child that reads characters sends: taken, checked, posed. */
#include "harness/mesh/character_parts.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>

/* Every clip at its ends and between. */
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

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    mote_character_draft draft;
    if (mote_character_take("any.glb", (const char *)data, size, &draft) != MOTE_OK)
        return 0;
    if (mote_character_check_rig("any.glb", &draft.made.rig) == MOTE_OK)
        pose(&draft.made.rig);
    mote_character_draft_free(&draft);
    return 0;
}
