/* aabb-tree: a box tree tuned by us. Two trees of axis-aligned boxes over world positions,
   refitted in one pass in each frame and traversed together from the roots, nearer pairs first,
   with the last frame's closest pair of triangles as the first bound. */
#include "baselines/aabb_tree.h"
#include "baselines/box_tree.h"
#include "baselines/float_positions.h"
#include "baselines/input.h"
#include "core/body/sample_split.h"
#include "baselines/wide_triangle.h"
#include "core/base/clones.h"
#include "core/method/method.h"
#include "core/body/triangle.h"

#include <stdlib.h>

enum { SEED, ARITHMETIC, POSITIONS, BUILD, PARAMETER_COUNT };

static const mote_parameter parameters[PARAMETER_COUNT] = {
    [SEED] = {"seed", MOTE_PARAMETER_CHOICE, 0, 0, "none|previous", "previous",
              "first upper bound: none, or from the last query's triangle pair"},
    [ARITHMETIC] =
        {"arithmetic", MOTE_PARAMETER_CHOICE, 0, 0, "double|wide", "double",
         "of triangle distances: double, or 113 bits, 100 times slower, for disputes"},
    [POSITIONS] = {"positions", MOTE_PARAMETER_CHOICE, 0, 0, "deform|given", "deform",
                   "deform: pay for deforming all vertices; given: they come free of charge"},
    [BUILD] = {"build", MOTE_PARAMETER_CHOICE, 0, 0, MOTE_BUILD_CHOICES, "rest",
               MOTE_BUILD_HELP},
};

/* Pairs of nodes on the stack: opening one node replaces a pair by at most eight. */
#define STACK (MOTE_BOX_WIDTH * 2 * MOTE_BOX_LEVELS)

typedef struct tree_state {
    mote_setup setup;
    bool seeded, wide;
    mote_float_pair places;
    float coordinate_max; /* largest absolute coordinate in either tree */
    mote_box_tree tree[2];
    uint32_t last[2]; /* the last query's triangles */
    bool has_last;
} tree_state;

/* A pair of nodes, one of each tree, and four times the squared distance of their boxes. */
typedef struct node_pair {
    uint32_t node[2], level[2];
    float four_squared;
} node_pair;

/* A leaf's triangles: their boxes, and how far each extends along the current direction towards
   the other body. */
typedef struct leaf_view {
    uint32_t leaf, count;
    uint32_t improvements;                  /* of the best pair, when extent was computed */
    float extent[MOTE_BOX_WIDTH], farthest; /* of all triangles */
    mote_box_block boxes;
} leaf_view;

/* A query in progress. */
typedef struct search {
    const tree_state *state;
    const mote_vec3 *vertices[2];
    mote_counters *counters;
    double squared; /* the best distance so far and where it is */
    double enough;  /* a squared distance at which the search may stop */
    mote_vec3 p, q;
    uint32_t triangle[2];
    float limit;           /* pairs of boxes at four_squared >= limit are too far */
    float direction[3];    /* from p to q */
    float distance;        /* rounded up, and the margin, in the trees' unit */
    uint32_t improvements; /* of the best pair */
    uint32_t size;
    leaf_view view[2];
    node_pair stack[STACK];
} search;

static mote_traits traits(const double *values)
{
    bool given = values[POSITIONS] > 0;
    return (mote_traits){.needs_vertices = !given,
                         .given_vertices = given,
                         .keeps_state = values[SEED] > 0,
                         .samples = values[BUILD] > 0,
                         .exact = true};
}

static void destroy(void *state)
{
    tree_state *s = state;
    if (!s)
        return;
    for (int b = 0; b < 2; b++)
        mote_box_tree_free(&s->tree[b]);
    free(s);
}

static mote_status create(const mote_setup *setup, void **state)
{
    mote_status status = mote_input_check(setup);
    if (status != MOTE_OK)
        return status;
    tree_state *s = calloc(1, sizeof *s);
    if (!s)
        return mote_fail(MOTE_ENOMEM, "no memory for aabb-tree");
    s->setup = *setup;
    s->seeded = setup->values[SEED] > 0;
    s->wide = setup->values[ARITHMETIC] > 0;
    s->places.scale = ldexp(1, -ilogb(setup->length));
    for (int b = 0; b < 2 && status == MOTE_OK; b++) {
        status = mote_box_tree_init(&s->tree[b], setup->body[b], setup->values[BUILD] > 0);
        s->places.position[b] = s->tree[b].position;
        s->places.count[b] = setup->body[b]->mesh->vertex_count;
    }
    if (status != MOTE_OK) {
        destroy(s);
        return status;
    }
    *state = s;
    return MOTE_OK;
}

static mote_status update(void *state, const mote_frame *frame)
{
    tree_state *s = state;
    bool moved[2];
    const mote_status status = mote_float_pair_update(&s->places, frame, moved);
    if (status != MOTE_OK)
        return status;
    const float *most = s->places.coordinate_max;
    s->coordinate_max = most[0] > most[1] ? most[0] : most[1];
    for (int b = 0; b < 2; b++) {
        if (moved[b])
            mote_box_tree_refit(&s->tree[b], s->coordinate_max);
    }
    return MOTE_OK;
}

static void corners(const search *q, int b, uint32_t triangle, mote_vec3 corner[3])
{
    const uint32_t *t = q->state->tree[b].mesh->triangles[triangle];
    for (int k = 0; k < 3; k++)
        corner[k] = q->vertices[b][t[k]];
}

/* Updates the limit and the direction after a new best pair, or the first bound. */
static void set_limits(search *q)
{
    double scale = q->state->places.scale, distance = sqrt(q->squared) * scale;
    double limit = 4 * q->squared * scale * scale * (1 + 0x1p-20);
    q->limit =
        limit < 1e38 ? (float)limit + 0x1p-126f : HUGE_VALF; /* above 0: boxes that meet */
    q->distance = distance < 1e38 ? (float)(distance * (1 + 0x1p-20)) +
                                        mote_float_margin(q->state->coordinate_max)
                                  : HUGE_VALF;
    mote_vec3 u = mote_sub(q->q, q->p);
    double length = mote_length(u), inverse = length > 0 ? 1 / length : 0;
    q->direction[0] = (float)(u.x * inverse);
    q->direction[1] = (float)(u.y * inverse);
    q->direction[2] = (float)(u.z * inverse);
}

/* As mote_triangle_triangle_below, but in 113 bits for pairs that are about as near as the
   bound. */
static double measure_wide(const mote_vec3 s[3], const mote_vec3 t[3], double bound_squared,
                           mote_vec3 *p, mote_vec3 *q)
{
    double squared = mote_triangle_triangle(s, t, p, q);
    if (squared > 2 * bound_squared)
        return squared;
    return (double)reference_triangle_triangle(s, t);
}

static void measure(search *q, uint32_t a, uint32_t b)
{
    mote_vec3 s[3], t[3], p_s, p_t;
    corners(q, 0, a, s);
    corners(q, 1, b, t);
    q->counters->triangle_tests++;
    double squared = q->state->wide
                         ? measure_wide(s, t, q->squared, &p_s, &p_t)
                         : mote_triangle_triangle_below(s, t, q->squared, &p_s, &p_t);
    if (!(squared < q->squared))
        return;
    q->squared = squared;
    q->p = p_s;
    q->q = p_t;
    q->triangle[0] = a;
    q->triangle[1] = b;
    q->improvements++;
    set_limits(q);
}

/* Stores triangle i of a leaf, given its corners, in the leaf's view. */
static inline void view_triangle(leaf_view *view, int b, uint32_t i, const float *const p[3],
                                 const float *u, float margin)
{
    float x[3];
    for (int k = 0; k < 3; k++) {
        float low = mote_float_smallest(p[0][k], p[1][k], p[2][k]),
              high = mote_float_largest(p[0][k], p[1][k], p[2][k]);
        view->boxes.centre[k][i] = 0.5f * (low + high);
        view->boxes.half[k][i] = 0.5f * (high - low) + margin;
        x[k] = p[k][0] * u[0] + p[k][1] * u[1] + p[k][2] * u[2];
    }
    view->extent[i] =
        b == 0 ? mote_float_largest(x[0], x[1], x[2]) : mote_float_smallest(x[0], x[1], x[2]);
}

/* The view of a leaf of body b; often it is the last one used. */
static const leaf_view *view_leaf(search *q, int b, uint32_t leaf)
{
    leaf_view *view = &q->view[b];
    if (view->leaf == leaf && view->improvements == q->improvements)
        return view;
    const mote_box_tree *tree = &q->state->tree[b];
    uint32_t first = leaf * MOTE_BOX_LEAF, count = tree->mesh->triangle_count - first;
    view->leaf = leaf;
    view->improvements = q->improvements;
    view->count = count < MOTE_BOX_LEAF ? count : MOTE_BOX_LEAF;
    float margin = mote_float_margin(q->state->coordinate_max);
    for (uint32_t i = 0; i < view->count; i++) {
        const uint32_t *t = tree->mesh->triangles[tree->order[first + i]];
        const float *corner[3] = {tree->position[t[0]], tree->position[t[1]],
                                  tree->position[t[2]]};
        view_triangle(view, b, i, corner, q->direction, margin);
        float x = view->extent[i];
        bool farther = i == 0 || (b == 0 ? x > view->farthest : x < view->farthest);
        view->farthest = farther ? x : view->farthest;
    }
    return view;
}

/* Measures the pairs of triangles of two leaves that neither their boxes nor the current
   direction separate. */
MOTE_CLONES
static void measure_leaves(search *q, uint32_t leaf_a, uint32_t leaf_b)
{
    const leaf_view *a = view_leaf(q, 0, leaf_a), *b = view_leaf(q, 1, leaf_b);
    const uint32_t *a_order = q->state->tree[0].order + (size_t)leaf_a * MOTE_BOX_LEAF;
    const uint32_t *b_order = q->state->tree[1].order + (size_t)leaf_b * MOTE_BOX_LEAF;
    for (uint32_t i = 0; i < a->count; i++) {
        if (!(b->farthest - a->extent[i] < q->distance))
            continue;
        float four_squared[MOTE_BOX_WIDTH];
        mote_box box = mote_box_lane(&a->boxes, i);
        mote_box_block_distance(&box, &b->boxes, four_squared);
        q->counters->box_tests += b->count;
        for (uint32_t j = 0; j < b->count && q->squared > q->enough; j++) {
            if (four_squared[j] < q->limit && b->extent[j] - a->extent[i] < q->distance)
                measure(q, a_order[i], b_order[j]);
        }
    }
}

static float size_of(const mote_box *box)
{
    float size = box->half[0] > box->half[1] ? box->half[0] : box->half[1];
    return box->half[2] > size ? box->half[2] : size;
}

/* Opens the larger node of a pair: pushes the pairs of its children with the other node that
   are not too far apart, the nearest last. */
MOTE_CLONES
static void open_pair(search *q, const node_pair *pair)
{
    const mote_box_tree *tree = q->state->tree;
    mote_box box[2] = {mote_box_of(&tree[0], pair->level[0], pair->node[0]),
                       mote_box_of(&tree[1], pair->level[1], pair->node[1])};
    int side = size_of(&box[1]) > size_of(&box[0]);
    if (pair->level[side] == tree[side].height)
        side = 1 - side;
    float four_squared[MOTE_BOX_WIDTH];
    mote_box_block_distance(&box[1 - side],
                            mote_box_children(&tree[side], pair->level[side], pair->node[side]),
                            four_squared);
    q->counters->box_tests += MOTE_BOX_WIDTH;
    node_pair *bottom = q->stack + q->size;
    for (uint32_t i = 0; i < MOTE_BOX_WIDTH; i++) {
        if (!(four_squared[i] < q->limit))
            continue;
        node_pair *to = q->stack + q->size++;
        for (; to > bottom && to[-1].four_squared < four_squared[i]; to--)
            *to = to[-1];
        *to = *pair;
        to->node[side] = pair->node[side] * MOTE_BOX_WIDTH + i;
        to->level[side]++;
        to->four_squared = four_squared[i];
    }
}

static void traverse(search *q)
{
    const mote_box_tree *tree = q->state->tree;
    q->stack[q->size++] = (node_pair){0};
    while (q->size > 0 && q->squared > q->enough) {
        node_pair pair = q->stack[--q->size];
        if (!(pair.four_squared < q->limit))
            continue;
        if (pair.level[0] == tree[0].height && pair.level[1] == tree[1].height)
            measure_leaves(q, pair.node[0], pair.node[1]);
        else
            open_pair(q, &pair);
    }
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    tree_state *s = state;
    bool contact_only = s->setup.ask == MOTE_ASK_CONTACT;
    double enough = contact_only ? s->setup.tolerance * s->setup.tolerance : 0;
    search q = {.state = s,
                .vertices = {frame->body[0].vertices, frame->body[1].vertices},
                .counters = &answer->counters,
                .view = {{.leaf = UINT32_MAX}, {.leaf = UINT32_MAX}},
                .squared = contact_only ? nextafter(enough, HUGE_VAL) : HUGE_VAL,
                .enough = enough};
    set_limits(&q);
    if (s->seeded && s->has_last)
        measure(&q, s->last[0], s->last[1]);
    traverse(&q);
    /* Farther apart than floats can square (1e19 L): to the rounding of such distances, any
       pair is as near as any other. */
    if (q.improvements == 0 && isinf(q.limit))
        measure(&q, 0, 0);
    if (q.improvements > 0) {
        s->has_last = true;
        s->last[0] = q.triangle[0];
        s->last[1] = q.triangle[1];
    }
    double distance = sqrt(q.squared);
    answer->has_contact = true;
    answer->contact = contact_only ? q.squared <= enough : distance <= s->setup.tolerance;
    if (contact_only)
        return MOTE_OK;
    answer->has_distance = answer->has_witness = true;
    answer->distance = distance;
    answer->witness[0] = q.p;
    answer->witness[1] = q.q;
    return MOTE_OK;
}

mote_status mote_aabb_pair_query(mote_aabb_pair *pair, mote_answer *answer)
{
    tree_state state = {.setup = {.ask = pair->ask, .tolerance = pair->tolerance},
                        .seeded = true,
                        .places = {.scale = pair->scale},
                        .coordinate_max = pair->coordinate_max,
                        .tree = {*pair->tree[0], *pair->tree[1]},
                        .last = {pair->last[0], pair->last[1]},
                        .has_last = pair->has_last};
    mote_frame frame = {.number = 1};
    for (int b = 0; b < 2; b++)
        frame.body[b].vertices = pair->vertices[b];
    mote_status status = query(&state, &frame, answer);
    pair->last[0] = state.last[0];
    pair->last[1] = state.last[1];
    pair->has_last = state.has_last;
    return status;
}

MOTE_METHOD(aabb_tree) = {
    .name = "aabb-tree",
    .summary = "our own tuned trees of axis-aligned boxes, refitted every frame",
    .parameters = parameters,
    .parameter_count = PARAMETER_COUNT,
    .traits = traits,
    .create = create,
    .destroy = destroy,
    .update = update,
    .query = query,
};
