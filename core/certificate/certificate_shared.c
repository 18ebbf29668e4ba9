#include "core/certificate/certificate_shared.h"

#include "core/certificate/certificate_state.h"

#include <float.h>

void mote_cert_workspace_query(mote_certificate *workspace, mote_cert_tree *const trees[2],
                               const mote_frame *frame, double enough, mote_cert_memory *memory,
                               mote_certificate_answer *answer)
{
    for (int s = 0; s < 2; ++s) {
        workspace->side[s].tree = trees[s];
        workspace->side[s].lazy.body = trees[s]->body;
    }
    workspace->memory = *memory;
    mote_certificate_query(workspace, frame, NULL, enough, answer);
    *memory = workspace->memory;
}

/* The margin of a box covers the rounding of its half width and of world coordinates too
   (certificate_fitted.c); the sums here are in double precision. */
void mote_cert_workspace_bounds(mote_certificate *workspace, mote_cert_tree *tree,
                                const mote_body_state *state, mote_vec3 *low, mote_vec3 *high)
{
    mote_cert_side *side = &workspace->side[0];
    /* Relative to the middle of the body, where single precision loses least. */
    const mote_vec3 origin = mote_pose_apply(&state->pose, tree->origin);
    side->tree = tree;
    mote_cert_side_begin(side, state, origin);
    mote_cert_node *root = mote_cert_root(workspace, 0);
    mote_cert_make_boxes(workspace, 0, root);
    double least[3] = {DBL_MAX, DBL_MAX, DBL_MAX};
    double most[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (size_t l = 0; l < root->block->children; ++l) {
        for (int k = 0; k < 3; ++k) {
            const double centre = (double)root->centre[k][l];
            const double half = fabs((double)root->axis[0][k][l]) +
                                fabs((double)root->axis[1][k][l]) +
                                fabs((double)root->axis[2][k][l]) + (double)root->width[k][l];
            /* A NaN would stand in every lane, so that no comparison can hide it. */
            least[k] = centre - half >= least[k] ? least[k] : centre - half;
            most[k] = centre + half <= most[k] ? most[k] : centre + half;
        }
    }
    const double unit = 1 / tree->scale;
    *low = mote_add_scaled(origin, unit, mote_vec3_make(least[0], least[1], least[2]));
    *high = mote_add_scaled(origin, unit, mote_vec3_make(most[0], most[1], most[2]));
}

uint64_t mote_certificate_compared(const mote_certificate *certificate)
{
    return certificate->compared;
}
