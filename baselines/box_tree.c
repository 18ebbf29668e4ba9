#include "baselines/box_tree.h"

#include "core/base/clones.h"

#include <stdlib.h>
#include <string.h>

void mote_box_tree_free(mote_box_tree *tree)
{
    free(tree->blocks);
    free(tree->order);
    free(tree->leaf_start);
    free(tree->leaf_vertex);
    free(tree->position);
    *tree = (mote_box_tree){0};
}

/* --- building -------------------------------------------------------------------------------
 */

/* Data that only building needs. */
typedef struct builder {
    mote_box_tree *tree;
    mote_vec3 *centroid; /* [poses][triangle_count], times three */
    uint32_t poses;      /* rest and the body's samples */
} builder;

static double coordinate(mote_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* A direction to split along: centroids in one pose, and an axis. */
typedef struct direction {
    const mote_vec3 *centroid;
    int axis;
} direction;

/* The pose and the axis in which the centroids of a range of triangles have the largest extent.
 */
static direction longest_axis(const builder *b, uint32_t first, uint32_t end)
{
    direction best = {b->centroid, 0};
    double longest = -1;
    for (uint32_t i = 0; i < 3 * b->poses; i++) {
        const direction d = {b->centroid + (size_t)(i / 3) * b->tree->mesh->triangle_count,
                             (int)(i % 3)};
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (uint32_t k = first; k < end; k++) {
            double x = coordinate(d.centroid[b->tree->order[k]], d.axis);
            low = x < low ? x : low;
            high = x > high ? x : high;
        }
        if (high - low > longest) {
            longest = high - low;
            best = d;
        }
    }
    return best;
}

static double median_of_three(double a, double b, double c)
{
    double low = a < b ? a : b, high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
}

/* Reorders the triangles first .. end - 1 so that along the axis none before `middle` is above
   one from `middle` on (Hoare's selection). */
static void select_middle(const builder *b, direction d, uint32_t first, uint32_t end,
                          uint32_t middle)
{
    const mote_vec3 *centroid = d.centroid;
    const int axis = d.axis;
    uint32_t *order = b->tree->order;
    int64_t low = first, high = (int64_t)end - 1;
    while (low < high) {
        double pivot = median_of_three(coordinate(centroid[order[low]], axis),
                                       coordinate(centroid[order[(low + high) / 2]], axis),
                                       coordinate(centroid[order[high]], axis));
        int64_t i = low, j = high;
        while (i <= j) {
            while (coordinate(centroid[order[i]], axis) < pivot)
                i++;
            while (coordinate(centroid[order[j]], axis) > pivot)
                j--;
            if (i <= j) {
                uint32_t kept = order[i];
                order[i++] = order[j];
                order[j--] = kept;
            }
        }
        if (middle <= j)
            high = j;
        else if (middle >= i)
            low = i;
        else
            return;
    }
}

/* Arranges `count` leaves, starting at leaf `first`, into subtrees of `unit` leaves each (the
   last may have fewer), by halving along the longest axis down to single leaves. */
static void arrange(const builder *b, uint32_t first, uint32_t count, uint32_t unit)
{
    while (unit > 1 && count <= unit)
        unit /= MOTE_BOX_WIDTH;
    if (count <= unit)
        return;
    uint32_t children = (count + unit - 1) / unit, left = children / 2 * unit;
    uint32_t triangles = b->tree->mesh->triangle_count, from = first * MOTE_BOX_LEAF;
    uint32_t end = (first + count) * MOTE_BOX_LEAF;
    end = end < triangles ? end : triangles;
    select_middle(b, longest_axis(b, from, end), from, end, from + left * MOTE_BOX_LEAF);
    arrange(b, first, left, unit);
    arrange(b, first + left, count - left, unit);
}

static uint32_t leaf_end(const mote_box_tree *tree, uint32_t leaf)
{
    uint32_t end = (leaf + 1) * MOTE_BOX_LEAF;
    return end < tree->mesh->triangle_count ? end : tree->mesh->triangle_count;
}

/* Appends a vertex to a leaf's list unless it is already there. */
static uint32_t add_vertex(uint32_t *list, uint32_t from, uint32_t end, uint32_t vertex)
{
    for (uint32_t i = from; i < end; i++) {
        if (list[i] == vertex)
            return end;
    }
    list[end] = vertex;
    return end + 1;
}

/* Lists the vertices of every leaf, each once, and shrinks the list to its length. */
static void list_vertices(mote_box_tree *tree)
{
    uint32_t end = 0;
    for (uint32_t leaf = 0; leaf < tree->leaves; leaf++) {
        tree->leaf_start[leaf] = end;
        for (uint32_t i = leaf * MOTE_BOX_LEAF; i < leaf_end(tree, leaf); i++) {
            for (int k = 0; k < 3; k++)
                end = add_vertex(tree->leaf_vertex, tree->leaf_start[leaf], end,
                                 tree->mesh->triangles[tree->order[i]][k]);
        }
    }
    tree->leaf_start[tree->leaves] = end;
    uint32_t *cut = realloc(tree->leaf_vertex, (end > 0 ? end : 1) * sizeof *cut);
    tree->leaf_vertex = cut ? cut : tree->leaf_vertex;
}

/* Numbers the blocks of all levels. */
static void lay_out(mote_box_tree *tree)
{
    uint32_t count[MOTE_BOX_LEVELS], height = 0, nodes = tree->leaves;
    do {
        nodes = (nodes + MOTE_BOX_WIDTH - 1) / MOTE_BOX_WIDTH;
        count[height++] = nodes;
    } while (nodes > 1);
    tree->height = height;
    tree->first_block[0] = 0;
    for (uint32_t level = 0; level < height; level++)
        tree->first_block[level + 1] = tree->first_block[level] + count[height - 1 - level];
}

static bool allocate(mote_box_tree *tree)
{
    size_t triangles = tree->mesh->triangle_count;
    tree->blocks = aligned_alloc(64, tree->first_block[tree->height] * sizeof *tree->blocks);
    tree->order = calloc(triangles, sizeof *tree->order);
    tree->leaf_start = malloc(((size_t)tree->leaves + 1) * sizeof *tree->leaf_start);
    tree->leaf_vertex = malloc(3 * triangles * sizeof *tree->leaf_vertex);
    tree->position = malloc(tree->mesh->vertex_count * sizeof *tree->position);
    return tree->blocks && tree->order && tree->leaf_start && tree->leaf_vertex &&
           tree->position;
}

/* The centroids in one pose, times three. */
static void place_centroids(const builder *b, const mote_body *body, uint32_t pose)
{
    const mote_mesh *mesh = body->mesh;
    mote_vec3 *centroid = b->centroid + (size_t)pose * mesh->triangle_count;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        centroid[i] = mote_add(
            mote_add(mote_body_sample(body, pose, t[0]), mote_body_sample(body, pose, t[1])),
            mote_body_sample(body, pose, t[2]));
    }
}

mote_status mote_box_tree_init(mote_box_tree *tree, const mote_body *body)
{
    const mote_mesh *mesh = body->mesh;
    *tree = (mote_box_tree){.mesh = mesh};
    tree->leaves = (mesh->triangle_count + MOTE_BOX_LEAF - 1) / MOTE_BOX_LEAF;
    lay_out(tree);
    builder b = {.tree = tree, .poses = 1 + body->sample_count};
    b.centroid = malloc((size_t)b.poses * mesh->triangle_count * sizeof *b.centroid);
    if (!b.centroid || !allocate(tree)) {
        free(b.centroid);
        return mote_fail(MOTE_ENOMEM, "no memory for a tree of %u triangles",
                         mesh->triangle_count);
    }
    for (uint32_t pose = 0; pose < b.poses; pose++)
        place_centroids(&b, body, pose);
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        tree->order[i] = i;
    uint32_t unit = 1;
    for (uint32_t level = 1; level < tree->height; level++)
        unit *= MOTE_BOX_WIDTH;
    arrange(&b, 0, tree->leaves, unit);
    free(b.centroid);
    list_vertices(tree);
    return MOTE_OK;
}

/* --- refit ----------------------------------------------------------------------------------
 */

static inline float smaller(float a, float b)
{
    return a < b ? a : b;
}

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

MOTE_CLONES
float mote_box_tree_move(mote_box_tree *tree, const mote_vec3 *world, mote_vec3 origin,
                         double scale)
{
    float coordinate_max[4] = {0, 0, 0, 0}, bad[4] = {0, 0, 0, 0};
    for (uint32_t i = 0; i < tree->mesh->vertex_count; i++) {
        float p[4] = {(float)((world[i].x - origin.x) * scale),
                      (float)((world[i].y - origin.y) * scale),
                      (float)((world[i].z - origin.z) * scale), 0};
        for (int k = 0; k < 4; k++) {
            tree->position[i][k] = p[k];
            coordinate_max[k] = larger(fabsf(p[k]), coordinate_max[k]);
            bad[k] += p[k] - p[k];
        }
    }
    return larger(larger(coordinate_max[0], coordinate_max[1]), coordinate_max[2]) +
           (bad[0] + bad[1] + bad[2]);
}

/* Writes the box of leaf i to its lane. */
static inline void refit_leaf(mote_box_tree *tree, uint32_t leaf, float margin)
{
    const uint32_t *v = tree->leaf_vertex + tree->leaf_start[leaf];
    const uint32_t *end = tree->leaf_vertex + tree->leaf_start[leaf + 1];
    float low[4], high[4];
    memcpy(low, tree->position[*v], sizeof low);
    memcpy(high, low, sizeof high);
    while (++v < end) {
        const float *p = tree->position[*v];
        for (int k = 0; k < 4; k++) {
            low[k] = smaller(p[k], low[k]);
            high[k] = larger(p[k], high[k]);
        }
    }
    mote_box_block *block =
        &tree->blocks[tree->first_block[tree->height - 1] + leaf / MOTE_BOX_WIDTH];
    for (int k = 0; k < 3; k++) {
        block->centre[k][leaf % MOTE_BOX_WIDTH] = 0.5f * (low[k] + high[k]);
        block->half[k][leaf % MOTE_BOX_WIDTH] = 0.5f * (high[k] - low[k]) + margin;
    }
}

/* The box around the boxes of a block, along axis k. */
static inline void enclose(const mote_box_block *block, int k, float margin, float *centre,
                           float *half)
{
    float low[MOTE_BOX_WIDTH], high[MOTE_BOX_WIDTH];
    for (int i = 0; i < MOTE_BOX_WIDTH; i++) {
        bool empty = block->half[k][i] < 0;
        low[i] = empty ? HUGE_VALF : block->centre[k][i] - block->half[k][i];
        high[i] = empty ? -HUGE_VALF : block->centre[k][i] + block->half[k][i];
    }
    for (int width = MOTE_BOX_WIDTH / 2; width > 0; width /= 2) {
        for (int i = 0; i < width; i++) {
            low[i] = smaller(low[i], low[i + width]);
            high[i] = larger(high[i], high[i + width]);
        }
    }
    *centre = 0.5f * (low[0] + high[0]);
    *half = 0.5f * (high[0] - low[0]) + margin;
}

/* Marks the lanes without a child in the last block of a level as empty. */
static void empty_lanes(mote_box_tree *tree, uint32_t level, uint32_t nodes)
{
    mote_box_block *block =
        &tree->blocks[tree->first_block[level] + (nodes - 1) / MOTE_BOX_WIDTH];
    for (uint32_t i = (nodes - 1) % MOTE_BOX_WIDTH + 1; i < MOTE_BOX_WIDTH; i++) {
        for (int k = 0; k < 3; k++) {
            block->centre[k][i] = 0;
            block->half[k][i] = -HUGE_VALF;
        }
    }
}

MOTE_CLONES
void mote_box_tree_refit(mote_box_tree *tree, float coordinate_max)
{
    float margin = mote_box_margin(coordinate_max);
    for (uint32_t leaf = 0; leaf < tree->leaves; leaf++)
        refit_leaf(tree, leaf, margin);
    empty_lanes(tree, tree->height - 1, tree->leaves);
    for (uint32_t level = tree->height - 1; level > 0; level--) {
        uint32_t nodes = tree->first_block[level + 1] - tree->first_block[level];
        for (uint32_t i = 0; i < nodes; i++) {
            const mote_box_block *from = &tree->blocks[tree->first_block[level] + i];
            mote_box_block *to =
                &tree->blocks[tree->first_block[level - 1] + i / MOTE_BOX_WIDTH];
            for (int k = 0; k < 3; k++)
                enclose(from, k, margin, &to->centre[k][i % MOTE_BOX_WIDTH],
                        &to->half[k][i % MOTE_BOX_WIDTH]);
        }
        empty_lanes(tree, level - 1, nodes);
    }
    for (int k = 0; k < 3; k++)
        enclose(tree->blocks, k, margin, &tree->root.centre[k], &tree->root.half[k]);
}
