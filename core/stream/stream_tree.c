#include "core/stream/stream_tree.h"

#include "core/body/leaf_order.h"

#include <stdlib.h>
#include <string.h>

#define WIDTH MOTE_STREAM_WIDTH
#define RUN MOTE_STREAM_RUN

/* Vertices of a group's leaves, at most. */
#define GROUP_VERTICES (3 * MOTE_STREAM_GROUP)

/* Numbers the blocks of all levels. */
static void lay_out(mote_stream_tree *tree)
{
    uint32_t count[MOTE_STREAM_LEVELS];
    uint32_t nodes = tree->groups;
    do {
        nodes = (nodes + WIDTH - 1) / WIDTH;
        count[tree->height++] = nodes;
    } while (nodes > 1);
    for (uint32_t l = 0; l < tree->height; ++l)
        tree->first_block[l + 1] = tree->first_block[l] + count[tree->height - 1 - l];
}

/* Lists the vertices of a leaf, each once, from `list` on; returns how many there are. */
static uint32_t list_leaf(mote_stream_tree *tree, uint32_t leaf, uint32_t *list)
{
    uint32_t count = 0;
    const size_t first = (size_t)leaf * MOTE_STREAM_LEAF;
    for (size_t i = first; i < first + mote_stream_leaf_faces(tree, leaf); ++i) {
        for (int k = 0; k < 3; ++k) {
            const uint32_t vertex = tree->mesh->triangles[tree->order[i]][k];
            uint32_t at = 0;
            while (at < count && list[at] != vertex)
                ++at;
            if (at == count)
                list[count++] = vertex;
            tree->corners[i][k] = (uint8_t)at;
        }
    }
    return count;
}

static void list_leaves(mote_stream_tree *tree)
{
    for (uint32_t leaf = 0; leaf < tree->leaves; ++leaf) {
        const size_t start = tree->leaf_start[leaf];
        tree->leaf_start[leaf + 1] = start + list_leaf(tree, leaf, tree->leaf_vertices + start);
    }
}

static int by_number(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a;
    const uint32_t y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

/* The vertices of a group, ascending, each once; returns how many there are. */
static uint32_t vertices_of(const mote_stream_tree *tree, uint32_t group,
                            uint32_t list[GROUP_VERTICES])
{
    const uint32_t first = group * WIDTH;
    const uint32_t end = tree->leaves - first < WIDTH ? tree->leaves : first + WIDTH;
    const size_t from = tree->leaf_start[first];
    const size_t count = tree->leaf_start[end] - from;
    memcpy(list, tree->leaf_vertices + from, count * sizeof *list);
    qsort(list, count, sizeof *list, by_number);
    uint32_t unique = 0;
    for (size_t i = 0; i < count; ++i) {
        if (unique == 0 || list[i] != list[unique - 1])
            list[unique++] = list[i];
    }
    return unique;
}

/* Splits a group's vertices into runs and singles. A stretch of at least RUN in a row is
   covered by runs, the last of which is set back over vertices of the stretch. */
static void split_group(mote_stream_tree *tree, uint32_t group)
{
    uint32_t list[GROUP_VERTICES];
    const uint32_t count = vertices_of(tree, group, list);
    const uint32_t last = tree->mesh->vertex_count - 1;
    size_t runs = tree->run_start[group];
    size_t singles = tree->single_start[group];
    for (uint32_t i = 0, end = 0; i < count; i = end) {
        for (end = i + 1; end < count && list[end] == list[end - 1] + 1; ++end)
            continue;
        for (uint32_t k = i; end - i >= RUN && k < end; k += RUN)
            tree->runs[runs++] = list[k + RUN <= end ? k : end - RUN];
        for (uint32_t k = i; end - i < RUN && k < end; ++k) {
            if (list[k] == last)
                tree->last[group] = true;
            else
                tree->singles[singles++] = list[k];
        }
    }
    while ((singles - tree->single_start[group]) % 4) {
        tree->singles[singles] = tree->singles[singles - 1];
        ++singles;
    }
    tree->run_start[group + 1] = runs;
    tree->single_start[group + 1] = singles;
}

/* A list cut to its length; the list itself where that fails. */
static uint32_t *cut(uint32_t *list, size_t count)
{
    uint32_t *shorter = realloc(list, (count + 1) * sizeof *list);
    return shorter ? shorter : list;
}

static bool allocate(mote_stream_tree *tree)
{
    const size_t triangles = tree->mesh->triangle_count;
    const size_t groups = tree->groups;
    tree->order = malloc(triangles * sizeof *tree->order);
    tree->leaf_start = calloc((size_t)tree->leaves + 1, sizeof *tree->leaf_start);
    tree->leaf_vertices = malloc(3 * triangles * sizeof *tree->leaf_vertices);
    tree->corners = malloc(triangles * sizeof *tree->corners);
    tree->run_start = calloc(groups + 1, sizeof *tree->run_start);
    tree->single_start = calloc(groups + 1, sizeof *tree->single_start);
    tree->last = calloc(groups, sizeof *tree->last);
    return tree->order && tree->leaf_start && tree->leaf_vertices && tree->corners &&
           tree->run_start && tree->single_start && tree->last;
}

/* Makes the lists of vertices, which take no more room than those of all leaves, filled up. */
static mote_status list_vertices(mote_stream_tree *tree)
{
    list_leaves(tree);
    const size_t vertices = tree->leaf_start[tree->leaves];
    tree->leaf_vertices = cut(tree->leaf_vertices, vertices);
    tree->runs = malloc((vertices / RUN * 2 + 1) * sizeof *tree->runs);
    tree->singles = malloc((vertices + 3 * (size_t)tree->groups) * sizeof *tree->singles);
    if (!tree->runs || !tree->singles)
        return mote_fail(MOTE_ENOMEM, "no memory for the vertices of %u groups", tree->groups);
    for (uint32_t g = 0; g < tree->groups; ++g)
        split_group(tree, g);
    tree->runs = cut(tree->runs, tree->run_start[tree->groups]);
    tree->singles = cut(tree->singles, tree->single_start[tree->groups]);
    return MOTE_OK;
}

mote_status mote_stream_tree_create(const mote_body *body, mote_stream_tree **tree)
{
    const uint32_t triangles = body->mesh->triangle_count;
    mote_stream_tree *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a tree of %u triangles", triangles);
    made->mesh = body->mesh;
    made->body.mesh = body->mesh;
    made->leaves = (triangles - 1) / MOTE_STREAM_LEAF + 1;
    made->groups = (made->leaves - 1) / WIDTH + 1;
    lay_out(made);
    mote_status status =
        allocate(made)
            ? mote_leaf_order(body, MOTE_STREAM_LEAF, made->order)
            : mote_fail(MOTE_ENOMEM, "no memory for a tree of %u triangles", triangles);
    if (status == MOTE_OK)
        status = list_vertices(made);
    if (status == MOTE_OK)
        *tree = made;
    else
        mote_stream_tree_destroy(made);
    return status;
}

void mote_stream_tree_destroy(mote_stream_tree *tree)
{
    if (!tree)
        return;
    free(tree->order);
    free(tree->leaf_start);
    free(tree->leaf_vertices);
    free(tree->corners);
    free(tree->run_start);
    free(tree->single_start);
    free(tree->runs);
    free(tree->singles);
    free(tree->last);
    free(tree);
}

size_t mote_stream_tree_bytes(const mote_stream_tree *tree)
{
    const size_t lists = tree->leaf_start[tree->leaves] + tree->run_start[tree->groups] +
                         tree->single_start[tree->groups];
    return sizeof *tree +
           tree->mesh->triangle_count * (sizeof *tree->order + sizeof *tree->corners) +
           (tree->leaves + (size_t)1) * sizeof *tree->leaf_start +
           lists * sizeof *tree->leaf_vertices +
           (tree->groups + (size_t)1) *
               (sizeof *tree->run_start + sizeof *tree->single_start + sizeof *tree->last);
}
