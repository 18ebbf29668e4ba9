/* The trees of aabb-tree for several bodies. */
#include "baselines/aabb_tree.h"
#include "baselines/body_trees.h"
#include "baselines/float_positions.h"

#include <stdlib.h>

/* A tree in use for one body: its boxes and positions are its own, everything else is shared by
   the shape. */
typedef struct served {
    mote_box_tree tree;
    mote_vec3 *vertices;
} served;

typedef struct shape_trees {
    mote_box_tree rest;
    served *trees; /* [room] */
    uint32_t count, room, used;
} shape_trees;

typedef struct aabb_bodies {
    mote_body_trees_setup setup;
    double scale;
    float coordinate_max; /* largest absolute coordinate in any tree of the step */
    shape_trees *shapes;  /* [shape_count] */
    uint32_t *place;      /* [body_count]: which tree of its shape a body has */
} aabb_bodies;

static void destroy(void *state)
{
    aabb_bodies *s = state;
    if (!s)
        return;
    for (uint32_t i = 0; s->shapes && i < s->setup.shape_count; ++i) {
        for (uint32_t k = 0; k < s->shapes[i].count; ++k) {
            free(s->shapes[i].trees[k].tree.blocks);
            free(s->shapes[i].trees[k].tree.position);
            free(s->shapes[i].trees[k].vertices);
        }
        free(s->shapes[i].trees);
        mote_box_tree_free(&s->shapes[i].rest);
    }
    free(s->shapes);
    free(s->place);
    free(s);
}

static mote_status add_tree(shape_trees *shape)
{
    if (shape->count == shape->room) {
        const uint32_t room = shape->room ? 2 * shape->room : 8;
        served *grown = realloc(shape->trees, room * sizeof *grown);
        if (!grown)
            return mote_fail(MOTE_ENOMEM, "no memory for %u trees", room);
        shape->trees = grown;
        shape->room = room;
    }
    const mote_box_tree *rest = &shape->rest;
    const size_t vertices = rest->mesh->vertex_count;
    served made = {.tree = *rest};
    made.tree.blocks =
        aligned_alloc(64, rest->first_block[rest->height] * sizeof *made.tree.blocks);
    made.tree.position = malloc(vertices * sizeof *made.tree.position);
    made.vertices = malloc(vertices * sizeof *made.vertices);
    if (!made.tree.blocks || !made.tree.position || !made.vertices) {
        free(made.tree.blocks);
        free(made.tree.position);
        free(made.vertices);
        return mote_fail(MOTE_ENOMEM, "no memory for a tree of %zu vertices", vertices);
    }
    shape->trees[shape->count++] = made;
    return MOTE_OK;
}

static mote_status create(const mote_body_trees_setup *setup, void **state)
{
    aabb_bodies *s = calloc(1, sizeof *s);
    if (!s)
        return mote_fail(MOTE_ENOMEM, "no memory for aabb-tree");
    s->setup = *setup;
    s->scale = ldexp(1, -ilogb(setup->length));
    s->shapes = calloc(setup->shape_count, sizeof *s->shapes);
    s->place = calloc(setup->body_count, sizeof *s->place);
    mote_status status = MOTE_OK;
    if (!s->shapes || !s->place)
        status = mote_fail(MOTE_ENOMEM, "no memory for aabb-tree");
    for (uint32_t i = 0; i < setup->shape_count && status == MOTE_OK; ++i)
        status = mote_box_tree_init(&s->shapes[i].rest, setup->shapes[i], false);
    for (uint32_t i = 0; setup->every && i < setup->body_count && status == MOTE_OK; ++i)
        status = add_tree(&s->shapes[setup->shape_of[i]]);
    if (status == MOTE_OK)
        *state = s;
    else
        destroy(s);
    return status;
}

static void begin(void *state)
{
    aabb_bodies *s = state;
    s->coordinate_max = 0;
    for (uint32_t i = 0; i < s->setup.shape_count; ++i)
        s->shapes[i].used = 0;
}

static served *tree_of(const aabb_bodies *s, uint32_t body)
{
    return &s->shapes[s->setup.shape_of[body]].trees[s->place[body]];
}

static mote_status room(void *state, uint32_t body, mote_vec3 **vertices)
{
    aabb_bodies *s = state;
    shape_trees *shape = &s->shapes[s->setup.shape_of[body]];
    if (shape->used == shape->count) {
        mote_status status = add_tree(shape);
        if (status != MOTE_OK)
            return status;
    }
    s->place[body] = shape->used++;
    *vertices = tree_of(s, body)->vertices;
    return MOTE_OK;
}

static mote_status move(void *state, uint32_t body)
{
    aabb_bodies *s = state;
    served *t = tree_of(s, body);
    float most;
    const mote_status status =
        mote_float_positions(t->tree.position, t->vertices, t->tree.mesh->vertex_count,
                             mote_vec3_make(0, 0, 0), s->scale, (int)body, &most);
    if (status == MOTE_OK)
        s->coordinate_max = most > s->coordinate_max ? most : s->coordinate_max;
    return status;
}

static mote_status refit(void *state)
{
    aabb_bodies *s = state;
    for (uint32_t i = 0; i < s->setup.shape_count; ++i) {
        for (uint32_t k = 0; k < s->shapes[i].used; ++k)
            mote_box_tree_refit(&s->shapes[i].trees[k].tree, s->coordinate_max);
    }
    return MOTE_OK;
}

static void box(const void *state, uint32_t body, mote_scene_box *box)
{
    const aabb_bodies *s = state;
    const mote_box *root = &tree_of(s, body)->tree.root;
    double low[3], high[3];
    for (int k = 0; k < 3; ++k) {
        low[k] = ((double)root->centre[k] - (double)root->half[k]) / s->scale;
        high[k] = ((double)root->centre[k] + (double)root->half[k]) / s->scale;
    }
    box->low = mote_vec3_make(low[0], low[1], low[2]);
    box->high = mote_vec3_make(high[0], high[1], high[2]);
}

static mote_status query(void *state, const uint32_t body[2], mote_body_trees_memory *memory,
                         mote_answer *answer)
{
    const aabb_bodies *s = state;
    const served *a = tree_of(s, body[0]), *b = tree_of(s, body[1]);
    mote_aabb_pair pair = {.tree = {&a->tree, &b->tree},
                           .vertices = {a->vertices, b->vertices},
                           .scale = s->scale,
                           .coordinate_max = s->coordinate_max,
                           .ask = s->setup.ask,
                           .tolerance = s->setup.tolerance,
                           .last = {memory->triangle[0], memory->triangle[1]},
                           .has_last = memory->known};
    mote_status status = mote_aabb_pair_query(&pair, answer);
    *memory = (mote_body_trees_memory){{pair.last[0], pair.last[1]}, pair.has_last};
    return status;
}

const mote_body_trees_kind mote_aabb_body_trees = {.name = "aabb-tree",
                                                   .create = create,
                                                   .destroy = destroy,
                                                   .begin = begin,
                                                   .room = room,
                                                   .move = move,
                                                   .refit = refit,
                                                   .box = box,
                                                   .query = query};
