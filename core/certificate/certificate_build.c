/* Building the tree: binary splits to leaves that are all as many levels down, collapsed from
   the leaves up to blocks of eight, so that only the root may have fewer children. */
#include "core/certificate/certificate_bounds.h"
#include "core/certificate/certificate_fitted.h"
#include "core/certificate/certificate_box.h"
#include "core/certificate/certificate_split.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

typedef struct builder {
    mote_cert_tree *tree;
    mote_cert_tree_options options;
    mote_cert_item *items; /* [triangle_count], in the order of the tree */
    mote_cert_poses poses; /* at rest and the body's samples */
    uint32_t *seen;        /* [vertex_count] stamp of the last list that a vertex was put in */
    uint32_t *place;       /* [vertex_count] its index in that list */
    uint32_t *list;        /* [vertex_count] the vertices of one range */
    uint32_t stamp;
    void *fitter; /* of the tree's bounds */
    size_t block_room, leaf_room, vertex_room, group_room;
    uint32_t corner_count;
    uint32_t bits; /* binary levels in a block */
    mote_status status;
} builder;

typedef struct range {
    uint32_t begin, end;
    uint32_t levels; /* binary levels below it */
} range;

/* Lists the vertices of a range once each in b->list. */
static uint32_t list_vertices(builder *b, range r)
{
    const mote_mesh *mesh = b->tree->body->mesh;
    uint32_t count = 0;
    ++b->stamp;
    for (uint32_t i = r.begin; i < r.end; ++i) {
        const uint32_t *t = mesh->triangles[b->items[i].triangle];
        for (int k = 0; k < 3; ++k) {
            if (b->seen[t[k]] == b->stamp)
                continue;
            b->seen[t[k]] = b->stamp;
            b->place[t[k]] = count;
            b->list[count++] = t[k];
        }
    }
    return count;
}

/* Makes room for more elements of an array; returns it, or NULL and sets the status. */
static void *make_room(builder *b, void *array, size_t *room, size_t used, size_t more,
                       size_t size)
{
    if (used + more <= *room)
        return array;
    const size_t wanted = 2 * (used + more);
    void *moved = realloc(array, wanted * size);
    if (!moved) {
        b->status = mote_fail(MOTE_ENOMEM, "no memory for a tree of %u triangles",
                              b->tree->body->mesh->triangle_count);
        return NULL;
    }
    *room = wanted;
    return moved;
}

/* Appends the coordinates, in their box, of the vertices in b->list. */
static bool add_groups(builder *b, const mote_cert_box *box, uint32_t vertex_count)
{
    mote_cert_tree *tree = b->tree;
    const uint32_t count = (vertex_count + MOTE_CERT_WIDTH - 1) / MOTE_CERT_WIDTH;
    void *groups = make_room(b, tree->groups, &b->group_room, tree->group_count, count,
                             sizeof *tree->groups);
    if (!groups)
        return false;
    tree->groups = groups;
    double z[3][MOTE_CERT_FIT_CHUNK];
    (void)mote_cert_box_sample(tree, b->list, vertex_count, box, 1, z);
    for (uint32_t i = 0; i < count * MOTE_CERT_WIDTH; ++i) {
        const uint32_t place = i < vertex_count ? i : vertex_count - 1;
        mote_cert_group *group = &tree->groups[tree->group_count + i / MOTE_CERT_WIDTH];
        for (int k = 0; k < 3; ++k)
            group->z[k][i % MOTE_CERT_WIDTH] = (float)z[k][place];
    }
    tree->group_count += count;
    return true;
}

/* Appends a leaf for a range whose vertices are in b->list. */
static int32_t add_leaf(builder *b, range r, uint32_t vertex_count, const mote_cert_box *box)
{
    mote_cert_tree *tree = b->tree;
    void *leaves =
        make_room(b, tree->leaves, &b->leaf_room, tree->leaf_count, 1, sizeof *tree->leaves);
    if (!leaves)
        return -1;
    tree->leaves = leaves;
    void *vertices = make_room(b, tree->leaf_vertices, &b->vertex_room, tree->leaf_vertex_count,
                               vertex_count, sizeof(uint32_t));
    if (!vertices)
        return -1;
    tree->leaf_vertices = vertices;
    tree->leaves[tree->leaf_count] =
        (mote_cert_leaf){.first_vertex = tree->leaf_vertex_count,
                         .first_corner = b->corner_count,
                         .first_group = tree->group_count,
                         .vertex_count = (uint8_t)vertex_count,
                         .triangle_count = (uint8_t)(r.end - r.begin)};
    if (!add_groups(b, box, vertex_count))
        return -1;
    memcpy(tree->leaf_vertices + tree->leaf_vertex_count, b->list,
           vertex_count * sizeof(uint32_t));
    tree->leaf_vertex_count += vertex_count;
    for (uint32_t i = r.begin; i < r.end; ++i) {
        const uint32_t *t = tree->body->mesh->triangles[b->items[i].triangle];
        for (int k = 0; k < 3; ++k)
            tree->corners[b->corner_count][k] = (uint8_t)b->place[t[k]];
        ++b->corner_count;
    }
    return ~(int32_t)tree->leaf_count++;
}

/* Splits a range by at most `levels` binary levels into parts. */
static uint32_t split_levels(builder *b, range whole, uint32_t levels,
                             range parts[MOTE_CERT_WIDTH])
{
    uint32_t count = 1;
    parts[0] = whole;
    for (uint32_t level = 0; level < levels; ++level) {
        range next[MOTE_CERT_WIDTH];
        uint32_t made = 0;
        for (uint32_t i = 0; i < count; ++i) {
            const range r = parts[i];
            const uint32_t below = r.levels > 0 ? r.levels - 1 : 0;
            /* every leaf below gets a triangle, and none too many */
            const uint32_t least = 1u << below;
            const uint32_t most = least * MOTE_CERT_LEAF_TRIANGLES;
            const uint32_t middle = r.begin + mote_cert_split(&b->poses, b->items + r.begin,
                                                              r.end - r.begin, least, most);
            next[made++] = (range){r.begin, middle, below};
            next[made++] = (range){middle, r.end, below};
        }
        count = made;
        memcpy(parts, next, made * sizeof *parts);
    }
    return count;
}

static void store_box(mote_cert_block *block, uint32_t lane, const mote_cert_box *box,
                      const int32_t cut[3])
{
    block->centre[0][lane] = (float)box->centre.x;
    block->centre[1][lane] = (float)box->centre.y;
    block->centre[2][lane] = (float)box->centre.z;
    for (int k = 0; k < 3; ++k) {
        block->half[k][0][lane] = (float)box->half[k].x;
        block->half[k][1][lane] = (float)box->half[k].y;
        block->half[k][2][lane] = (float)box->half[k].z;
        block->cut[k][lane] = cut[k];
    }
}

mote_status mote_cert_tree_keep(mote_cert_tree *tree, mote_cert_block *block, size_t strips,
                                size_t active)
{
    if (tree->strip_count + strips > tree->strip_room) {
        const size_t room = 2 * (tree->strip_count + strips);
        void *moved = realloc(tree->strips, room * sizeof *tree->strips);
        if (!moved)
            return mote_fail(MOTE_ENOMEM, "no memory for %zu bounds of boxes", room);
        tree->strips = moved;
        tree->strip_room = room;
    }
    if (tree->active_count + active > tree->active_room) {
        const size_t room = 2 * (tree->active_count + active);
        void *moved = realloc(tree->active, room * sizeof *tree->active);
        if (!moved)
            return mote_fail(MOTE_ENOMEM, "no memory for %zu bounds of boxes", room);
        tree->active = moved;
        tree->active_room = room;
    }
    block->first_strip = (uint32_t)tree->strip_count;
    block->first_active = (uint32_t)tree->active_count;
    block->active_count = (uint32_t)active;
    if (strips > 0)
        memset(tree->strips + tree->strip_count, 0, strips * sizeof *tree->strips);
    if (active > 0)
        memset(tree->active + tree->active_count, 0, active * sizeof *tree->active);
    tree->strip_count += strips;
    tree->active_count += active;
    return MOTE_OK;
}

/* Which of the parts become leaves. */
static uint32_t leaves_of(builder *b, const range *parts, uint32_t count)
{
    uint32_t leaves = 0;
    for (uint32_t lane = 0; lane < count; ++lane) {
        if (parts[lane].levels == 0 && list_vertices(b, parts[lane]) <= MOTE_CERT_LEAF_VERTICES)
            leaves |= 1u << lane;
    }
    return leaves;
}

/* Box, bounds and leaf of one part. */
static void fill_lane(builder *b, range part, uint32_t lane, uint32_t leaves,
                      mote_cert_block *block)
{
    mote_cert_tree *tree = b->tree;
    const uint32_t vertices = list_vertices(b, part);
    const mote_cert_box box = mote_cert_box_of(tree, b->list, vertices);
    int32_t cut[3];
    mote_cert_cut_corners(tree, b->list, vertices, &box, cut);
    store_box(block, lane, &box, cut);
    const mote_cert_part own = {
        .lane = lane, .vertices = b->list, .count = vertices, .box = &box, .leaves = leaves};
    tree->bounds->fit(b->fitter, tree, &own);
    if (leaves >> lane & 1)
        block->child[lane] = add_leaf(b, part, vertices, &box);
}

/* Fills boxes, bounds and leaves of a block. Parts that need a block of their own are left to
   the caller. */
static void fill_block(builder *b, uint32_t id, const range *parts, uint32_t count)
{
    mote_cert_block block = {.children = count, .mask = (1u << count) - 1};
    const uint32_t leaves = leaves_of(b, parts, count);
    for (uint32_t lane = 0; lane < count && b->status == MOTE_OK; ++lane)
        fill_lane(b, parts[lane], lane, leaves, &block);
    for (uint32_t lane = count; lane < MOTE_CERT_WIDTH; ++lane) {
        for (int k = 0; k < 3; ++k) /* axes are never 0, not even in an empty lane */
            block.half[k][k][lane] = 0x1p-23F;
    }
    if (b->status == MOTE_OK)
        b->status = b->tree->bounds->store(b->fitter, b->tree, &block);
    b->tree->blocks[id] = block;
}

static int32_t build_block(builder *b, range whole, uint32_t depth)
{
    mote_cert_tree *tree = b->tree;
    void *blocks =
        make_room(b, tree->blocks, &b->block_room, tree->block_count, 1, sizeof *tree->blocks);
    if (!blocks)
        return -1;
    tree->blocks = blocks;
    const uint32_t id = tree->block_count++;
    tree->depth = depth > tree->depth ? depth : tree->depth;
    uint32_t levels = whole.levels % b->bits;
    if (levels == 0 && whole.levels > 0)
        levels = b->bits;
    else if (whole.levels == 0 && depth > 1)
        levels = 1; /* it has a leaf's triangles, but too many vertices for one */
    range parts[MOTE_CERT_WIDTH];
    const uint32_t count = split_levels(b, whole, levels, parts);
    fill_block(b, id, parts, count);
    for (uint32_t lane = 0; lane < count && b->status == MOTE_OK; ++lane) {
        if (tree->blocks[id].child[lane] < 0)
            continue;
        const int32_t child = build_block(b, parts[lane], depth + 1);
        tree->blocks[id].child[lane] = child;
    }
    return (int32_t)id;
}

/* The power of two near 1 / x. */
static double inverse_power(double x)
{
    return ldexp(1, -ilogb(x));
}

static mote_status allocate(builder *b)
{
    const mote_mesh *mesh = b->tree->body->mesh;
    b->items = malloc(mesh->triangle_count * sizeof *b->items);
    b->poses =
        (mote_cert_poses){.count = 1 + b->tree->body->sample_count,
                          .triangles = mesh->triangle_count,
                          .centres = malloc((1 + (size_t)b->tree->body->sample_count) *
                                            mesh->triangle_count * sizeof *b->poses.centres)};
    b->seen = calloc(mesh->vertex_count, sizeof *b->seen);
    b->place = malloc(mesh->vertex_count * sizeof *b->place);
    b->list = malloc(mesh->vertex_count * sizeof *b->list);
    b->tree->corners = malloc(mesh->triangle_count * sizeof *b->tree->corners);
    if (!b->items || !b->poses.centres || !b->seen || !b->place || !b->list ||
        !b->tree->corners)
        return mote_fail(MOTE_ENOMEM, "no memory to build a tree of %u triangles",
                         mesh->triangle_count);
    return MOTE_OK;
}

/* A vertex in a pose, in the tree's units. */
static mote_vec3 posed(const mote_cert_tree *tree, uint32_t pose, uint32_t vertex)
{
    return mote_scale(mote_sub(mote_body_sample(tree->body, pose, vertex), tree->origin),
                      tree->scale);
}

static void place_triangles(builder *b, uint32_t pose)
{
    const mote_mesh *mesh = b->tree->body->mesh;
    float(*centres)[3] = b->poses.centres + (size_t)pose * mesh->triangle_count;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        const uint32_t *v = mesh->triangles[t];
        const mote_vec3 sum =
            mote_add(mote_add(posed(b->tree, pose, v[0]), posed(b->tree, pose, v[1])),
                     posed(b->tree, pose, v[2]));
        b->items[t].triangle = t;
        centres[t][0] = (float)(sum.x / 3);
        centres[t][1] = (float)(sum.y / 3);
        centres[t][2] = (float)(sum.z / 3);
    }
}

static uint32_t levels_of(uint32_t triangles)
{
    uint32_t levels = 0;
    for (; triangles > MOTE_CERT_LEAF_TRIANGLES; ++levels)
        triangles = (triangles + 1) / 2;
    return levels;
}

/* Frees the unused end of an array. Where that fails, the array is simply kept. */
static void *shrunk(void *array, size_t count, size_t size)
{
    void *moved = count > 0 ? realloc(array, count * size) : NULL;
    return moved ? moved : array;
}

static void shrink(mote_cert_tree *tree)
{
    tree->blocks = shrunk(tree->blocks, tree->block_count, sizeof *tree->blocks);
    tree->leaves = shrunk(tree->leaves, tree->leaf_count, sizeof *tree->leaves);
    tree->leaf_vertices =
        shrunk(tree->leaf_vertices, tree->leaf_vertex_count, sizeof(uint32_t));
    tree->groups = shrunk(tree->groups, tree->group_count, sizeof *tree->groups);
    tree->strips = shrunk(tree->strips, tree->strip_count, sizeof *tree->strips);
    tree->active = shrunk(tree->active, tree->active_count, sizeof *tree->active);
}

static mote_status build(builder *b)
{
    const mote_mesh *mesh = b->tree->body->mesh;
    b->status = allocate(b);
    if (b->status != MOTE_OK)
        return b->status;
    b->status = b->tree->bounds->start(b->tree, b->options.linear_fits, &b->fitter);
    if (b->status != MOTE_OK)
        return b->status;
    for (uint32_t pose = 0; pose < b->poses.count; ++pose)
        place_triangles(b, pose);
    build_block(b, (range){0, mesh->triangle_count, levels_of(mesh->triangle_count)}, 1);
    b->tree->bounds->stop(b->fitter);
    if (b->status == MOTE_OK)
        shrink(b->tree);
    return b->status;
}

mote_status mote_cert_tree_create(const mote_body *body, const mote_cert_tree_options *options,
                                  mote_cert_tree **tree)
{
    if (mote_body_is_given(body))
        return mote_fail(MOTE_EUNSUPPORTED,
                         "the certified query needs a field, but of a body only positions are "
                         "known; use a method that works on positions, such as stream or "
                         "aabb-tree");
    const mote_mesh *mesh = body->mesh;
    builder *b = calloc(1, sizeof *b);
    mote_cert_tree *made = calloc(1, sizeof *made);
    mote_status status = MOTE_OK;
    if (!b || !made) {
        status = mote_fail(MOTE_ENOMEM, "no memory for a tree");
    } else {
        made->body = body;
        made->bounds =
            body->field->kind->bounds ? body->field->kind->bounds : &mote_cert_fitted;
        made->scale = inverse_power(options->length);
        made->origin = mote_scale(mote_add(mesh->low, mesh->high), 0.5);
        b->tree = made;
        b->options = *options;
        b->bits = options->width == 8 ? 3 : options->width == 4 ? 2 : 1;
        status = build(b);
        free(b->items);
        free(b->poses.centres);
        free(b->seen);
        free(b->place);
        free(b->list);
    }
    free(b);
    if (status != MOTE_OK) {
        mote_cert_tree_destroy(made);
        return status;
    }
    *tree = made;
    return MOTE_OK;
}

void mote_cert_tree_destroy(mote_cert_tree *tree)
{
    if (!tree)
        return;
    free(tree->blocks);
    free(tree->fixed);
    free(tree->strips);
    free(tree->active);
    free(tree->leaves);
    free(tree->leaf_vertices);
    free(tree->groups);
    free(tree->corners);
    free(tree);
}

size_t mote_cert_tree_bytes(const mote_cert_tree *tree)
{
    return sizeof *tree + tree->block_count * sizeof *tree->blocks +
           tree->strip_count * sizeof *tree->strips +
           tree->active_count * sizeof *tree->active + tree->fixed_bytes +
           tree->leaf_count * sizeof *tree->leaves +
           tree->leaf_vertex_count * sizeof(uint32_t) +
           tree->group_count * sizeof *tree->groups +
           (size_t)tree->body->mesh->triangle_count * sizeof *tree->corners;
}
