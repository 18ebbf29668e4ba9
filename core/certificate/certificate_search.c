/* The plane pass and the traversal of both trees. */
#include "core/certificate/certificate_state.h"

#include <float.h>

#define WIDTH MOTE_CERT_WIDTH

static bool clear_node(mote_certificate *c, int s, mote_cert_node *node, uint32_t depth,
                       float *reach);

/* Whether a leaf has a vertex of the best pair's face. Where such a leaf crosses the plane,
   sliding the pair is likely to come nearer. */
static bool touches_witness(const mote_certificate *c, int s, const mote_cert_node *node,
                            size_t lane)
{
    const mote_cert_tree *tree = c->side[s].tree;
    const mote_cert_leaf *leaf = &tree->leaves[~node->block->child[lane]];
    const uint32_t *face = c->best.triangle[s];
    for (uint32_t i = 0; i < leaf->vertex_count; ++i) {
        const uint32_t v = tree->leaf_vertices[leaf->first_vertex + i];
        if (v == face[0] || v == face[1] || v == face[2])
            return true;
    }
    return false;
}

/* Opens child `lane` of a node; its reach becomes that of what is inside. */
static void open_child(mote_certificate *c, int s, mote_cert_node *node, size_t lane,
                       uint32_t depth)
{
    float reach = 0;
    bool clear;
    if (node->block->child[lane] < 0) {
        double exact;
        clear = mote_cert_leaf_clear(c, s, node, lane, &exact);
        reach = (float)exact + c->side[s].reach_margin;
        c->crossed = c->unrefined && !clear && touches_witness(c, s, node, lane);
    } else {
        mote_cert_node *child = mote_cert_child(c, s, node, lane, depth);
        clear = clear_node(c, s, child, depth + 1, &reach);
    }
    if (c->crossed)
        return;
    if (clear)
        node->clear |= 1u << lane;
    node->crossing &= ~(1u << lane);
    if (reach < node->reach[lane])
        node->reach[lane] = reach;
}

size_t mote_cert_farthest_child(const mote_cert_node *node)
{
    size_t best = 0;
    for (size_t l = 1; l < node->block->children; ++l)
        best = node->reach[l] > node->reach[best] ? l : best;
    return best;
}

/* All but the root have eight children. */
float mote_cert_farthest_reach(const mote_cert_node *node)
{
    if (node->block->children == WIDTH)
        return mote_cert_largest(node->reach);
    float most = -FLT_MAX;
    for (size_t l = 0; l < node->block->children; ++l)
        most = node->reach[l] > most ? node->reach[l] : most;
    return most;
}

/* Whether all of a node is clear of the plane. *reach is its reach in either case. Where the
   first crossing ends the pass, the child that reaches farthest is opened first. */
static bool clear_node(mote_certificate *c, int s, mote_cert_node *node, uint32_t depth,
                       float *reach)
{
    uint32_t left = node->crossing;
    if (c->unrefined && left) {
        const size_t first = mote_cert_farthest_child(node);
        if (left >> first & 1)
            open_child(c, s, node, first, depth);
        left &= ~(1u << first);
    }
    for (; left && !c->crossed; left &= left - 1)
        open_child(c, s, node, mote_lowest_bit(left), depth);
    *reach = mote_cert_farthest_reach(node);
    return node->clear == node->block->mask;
}

bool mote_cert_plane_pass(mote_certificate *c, int s)
{
    float reach = 0;
    return clear_node(c, s, mote_cert_root(c, s), 0, &reach);
}

/* One box of side s (child `lane` of a node) against all of a node of the other side. */
typedef struct row {
    int s;
    mote_cert_node *node;
    size_t lane;
    mote_cert_node *other;
} row;

static void visit_row(mote_certificate *c, row r, uint32_t depth);

/* Opens the larger of the boxes, or measures two leaves. */
static void visit_pair(mote_certificate *c, row r, size_t k, uint32_t depth)
{
    const bool leaf = r.node->block->child[r.lane] < 0;
    const bool other_leaf = r.other->block->child[k] < 0;
    if (leaf && other_leaf) {
        const mote_cert_node *nodes[2];
        size_t lanes[2];
        nodes[r.s] = r.node;
        nodes[1 - r.s] = r.other;
        lanes[r.s] = r.lane;
        lanes[1 - r.s] = k;
        mote_cert_leaf_pair(c, nodes, lanes);
    } else if (other_leaf || (!leaf && r.node->size[r.lane] > r.other->size[k])) {
        mote_cert_node *child = mote_cert_child(c, r.s, r.node, r.lane, depth);
        visit_row(c, (row){1 - r.s, r.other, k, child}, depth + 1);
    } else {
        mote_cert_node *child = mote_cert_child(c, 1 - r.s, r.other, k, depth);
        visit_row(c, (row){r.s, r.node, r.lane, child}, depth + 1);
    }
}

/* Keeps the smallest bound of the pairs that the budget leaves unvisited: a lower bound of the
   distance. */
static void bound_unvisited(mote_certificate *c, const float bound[WIDTH], uint32_t undecided)
{
    for (size_t l = 0; l < WIDTH; ++l) {
        if (undecided >> l & 1 && (double)bound[l] < c->unvisited)
            c->unvisited = (double)bound[l];
    }
}

static void visit_row(mote_certificate *c, row r, uint32_t depth)
{
    float bound[WIDTH];
    uint32_t undecided = mote_cert_row_plane(r.node, r.lane, r.other, c->need, bound);
    if (undecided) {
        mote_cert_make_boxes(c, r.s, r.node);
        mote_cert_make_boxes(c, 1 - r.s, r.other);
        if (r.node->spans && r.other->spans)
            undecided = mote_cert_row_spans(r.node, r.lane, r.other, c->need, undecided, bound);
        if (undecided && !(r.node->aligned && r.other->aligned))
            undecided = mote_cert_row_boxes(r.node, r.lane, r.other, c->need, undecided, bound);
        if (undecided && (r.node->unmeasured | r.other->unmeasured))
            undecided = mote_cert_narrow_row(c, r.s, r.node, r.lane, r.other, undecided, bound);
    }
    ++c->counters.rows;
    c->counters.box_tests += r.other->block->children;
    while (undecided && !c->done) {
        if (c->counters.box_tests >= c->options.budget) {
            c->stopped = true;
            bound_unvisited(c, bound, undecided);
            return;
        }
        const size_t k = mote_lowest_bit(undecided);
        undecided &= ~(1u << k);
        if (!(bound[k] >= c->need))
            visit_pair(c, r, k, depth);
    }
}

void mote_cert_traverse(mote_certificate *c)
{
    mote_cert_node *a = mote_cert_root(c, 0);
    mote_cert_node *b = mote_cert_root(c, 1);
    for (size_t l = 0; l < WIDTH && !c->done; ++l) {
        if (a->block->mask >> l & 1)
            visit_row(c, (row){0, a, l, b}, 0);
    }
}

/* The pair of lanes whose centres are nearest to each other; the first ones, which every block
   has, where no square of a distance is a float. */
static void nearest_centres(const mote_cert_node *a, const mote_cert_node *b, size_t lane[2])
{
    float best = FLT_MAX;
    lane[0] = lane[1] = 0;
    for (size_t i = 0; i < WIDTH; ++i) {
        if (!(a->block->mask >> i & 1))
            continue;
        for (size_t k = 0; k < WIDTH; ++k) {
            const float x = a->centre[0][i] - b->centre[0][k];
            const float y = a->centre[1][i] - b->centre[1][k];
            const float z = a->centre[2][i] - b->centre[2][k];
            const float squared = x * x + y * y + z * z;
            if (squared < best && b->block->mask >> k & 1) {
                best = squared;
                lane[0] = i;
                lane[1] = k;
            }
        }
    }
}

void mote_cert_descend(mote_certificate *c, uint32_t vertex[2])
{
    mote_cert_node *node[2] = {mote_cert_root(c, 0), mote_cert_root(c, 1)};
    size_t lane[2];
    for (uint32_t depth = 0;; depth += 2) {
        mote_cert_make_boxes(c, 0, node[0]);
        mote_cert_make_boxes(c, 1, node[1]);
        nearest_centres(node[0], node[1], lane);
        bool ended = true;
        for (int s = 0; s < 2; ++s) {
            if (node[s]->block->child[lane[s]] < 0)
                continue;
            node[s] = mote_cert_child(c, s, node[s], lane[s], depth + (uint32_t)s);
            ended = false;
        }
        if (ended)
            break;
    }
    for (int s = 0; s < 2; ++s) {
        const mote_cert_tree *tree = c->side[s].tree;
        const mote_cert_leaf *leaf = &tree->leaves[(uint32_t)~node[s]->block->child[lane[s]]];
        vertex[s] = tree->leaf_vertices[leaf->first_vertex];
    }
}
