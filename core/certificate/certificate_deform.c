/* Deforming blocks on demand: the part that is the same for all kinds of bounds. */
#include "core/certificate/certificate_bounds.h"
#include "core/certificate/certificate_state.h"

#define WIDTH MOTE_CERT_WIDTH

void mote_cert_side_begin(mote_cert_side *side, const mote_body_state *state, mote_vec3 origin)
{
    const mote_cert_tree *tree = side->tree;
    const mote_pose *pose = &state->pose;
    side->state = state;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            side->rotation[r][c] = (float)pose->rotation.m[r][c];
    }
    const mote_vec3 moved = mote_rotate(&pose->rotation, tree->origin);
    const mote_vec3 t =
        mote_scale(mote_add(moved, mote_sub(pose->translation, origin)), tree->scale);
    side->exact_translation = t;
    side->translation[0] = (float)t.x;
    side->translation[1] = (float)t.y;
    side->translation[2] = (float)t.z;
    side->world =
        (mote_largest_coordinate(pose->translation) + mote_largest_coordinate(moved)) *
        tree->scale;
    side->project = tree->bounds->project;
    side->node_count = 0;
    side->reached = NULL;
    for (size_t i = 0; i < MOTE_CERT_HULLS; ++i)
        side->hulls[i].leaf = NULL;
    tree->bounds->begin(side);
}

void mote_cert_side_face(mote_cert_side *side, mote_vec3 facing, double threshold)
{
    const mote_vec3 local = mote_rotate_back(&side->state->pose.rotation, facing);
    side->facing = facing;
    side->facing_f[0] = (float)local.x;
    side->facing_f[1] = (float)local.y;
    side->facing_f[2] = (float)local.z;
    side->facing_world[0] = (float)facing.x;
    side->facing_world[1] = (float)facing.y;
    side->facing_world[2] = (float)facing.z;
    side->shift = (float)mote_dot(side->exact_translation, facing);
    side->threshold = threshold;
    side->threshold_f = (float)threshold;
    side->tree->bounds->face(side);
}

/* Projects a node onto the plane's normal. */
static mote_cert_node *face_node(mote_certificate *c, int s, mote_cert_node *node)
{
    const mote_cert_side *side = &c->side[s];
    node->generation = c->generation;
    side->project(side, node->block, node);
    return node;
}

static mote_cert_node *new_node(mote_certificate *c, int s, const mote_cert_block *block,
                                mote_cert_node *node)
{
    node->block = block;
    node->boxes = node->spans = node->aligned = false;
    node->wide = node->unmeasured = 0;
    for (size_t l = 0; l < WIDTH; ++l)
        node->child[l] = -1;
    ++c->counters.blocks;
    return face_node(c, s, node);
}

/* Projects a kept node again if the plane has changed since. */
static mote_cert_node *known_node(mote_certificate *c, int s, mote_cert_node *node)
{
    return node->generation == c->generation ? node : face_node(c, s, node);
}

void mote_cert_make_boxes(mote_certificate *c, int s, mote_cert_node *node)
{
    if (node->boxes)
        return;
    const mote_cert_side *side = &c->side[s];
    side->tree->bounds->boxes(side, node->block, node);
    node->boxes = true;
}

mote_cert_node *mote_cert_root(mote_certificate *c, int s)
{
    mote_cert_side *side = &c->side[s];
    if (side->node_count > 0)
        return known_node(c, s, &side->nodes[0]);
    side->node_count = 1;
    return new_node(c, s, &side->tree->blocks[0], &side->nodes[0]);
}

mote_cert_node *mote_cert_child(mote_certificate *c, int s, mote_cert_node *node, size_t lane,
                                uint32_t depth)
{
    mote_cert_side *side = &c->side[s];
    if (node->child[lane] >= 0)
        return known_node(c, s, &side->nodes[node->child[lane]]);
    const mote_cert_block *block = &side->tree->blocks[node->block->child[lane]];
    if (side->node_count >= side->node_room)
        return new_node(c, s, block, &c->spare[depth]);
    node->child[lane] = (int32_t)side->node_count;
    return new_node(c, s, block, &side->nodes[side->node_count++]);
}
