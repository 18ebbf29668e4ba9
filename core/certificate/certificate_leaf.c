/* Positions of a leaf's vertices: by their coordinates in its deformed box, which costs a few
   operations a vertex; by the field in single precision; exactly.

   Margins, with u and B as in certificate_fitted.c. A vertex's coordinate z in its box is
   rounded to a float, so that a sum over k of z_k a_k is wrong by at most u sum |a_k|, which is
   at most u B in a coordinate. The sums themselves have five roundings of terms whose absolute
   values add up to B in a coordinate or sqrt(3) B along a direction: 9 u B. A projection on a
   direction of length <= 1 + 6 u, of such sums or of what is added up, a difference of two of
   them, and the rounding of the direction and of a threshold add 14 u B, sums along it of the
   widths no more. leaf_margin is 32 u B. */
#include "core/base/clones.h"
#include "core/certificate/certificate_bounds.h"
#include "core/certificate/certificate_state.h"

#include <assert.h>

#define WIDTH MOTE_CERT_WIDTH

static inline const mote_cert_leaf *leaf_of(const mote_cert_tree *tree,
                                            const mote_cert_node *node, size_t lane)
{
    return &tree->leaves[~node->block->child[lane]];
}

/* base + sum over k of z_k a_k for a group's vertices. */
MOTE_INLINE void add_up(const mote_cert_group *restrict group, float base, const float a[3],
                        float sum[WIDTH])
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        sum[l] = base + (group->z[0][l] * a[0] + group->z[1][l] * a[1] + group->z[2][l] * a[2]);
    }
}

/* Which of eight are not at most a limit. */
MOTE_INLINE uint32_t bits_above(const float x[WIDTH], float limit)
{
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        bits |= x[l] <= limit ? 0 : 1u << l;
    return bits;
}

/* base + sum_k z_k slant_k of a leaf's vertices; returns the largest. Bit i of *above: vertex i
   is not at most a limit. */
MOTE_CLONES
static float place_along(const mote_cert_group *restrict groups, uint32_t count, float base,
                         const float slant[3], float limit, uint64_t *above)
{
    float most[WIDTH];
    add_up(&groups[0], base, slant, most);
    uint64_t bits = bits_above(most, limit);
    for (uint32_t g = 1; g < count; ++g) {
        float more[WIDTH];
        add_up(&groups[g], base, slant, more);
        bits |= (uint64_t)bits_above(more, limit) << (g * WIDTH);
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l)
            most[l] = most[l] > more[l] ? most[l] : more[l];
    }
    *above = bits;
    return mote_cert_largest(most);
}

/* The same, only the largest. */
MOTE_CLONES
static float farthest_along(const mote_cert_group *restrict groups, uint32_t count, float base,
                            const float slant[3])
{
    float most[WIDTH];
    add_up(&groups[0], base, slant, most);
    for (uint32_t g = 1; g < count; ++g) {
        float more[WIDTH];
        add_up(&groups[g], base, slant, more);
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l)
            most[l] = most[l] > more[l] ? most[l] : more[l];
    }
    return mote_cert_largest(most);
}

MOTE_CLONES
void mote_cert_leaf_hull(const mote_cert_side *restrict side,
                         const mote_cert_node *restrict node, size_t lane,
                         mote_cert_hull *restrict hull)
{
    const mote_cert_leaf *leaf = leaf_of(side->tree, node, lane);
    const mote_cert_group *groups = side->tree->groups + leaf->first_group;
    hull->leaf = leaf;
    hull->groups = mote_cert_group_count(leaf);
    for (size_t r = 0; r < 3; ++r) {
        const float a[3] = {node->axis[0][r][lane], node->axis[1][r][lane],
                            node->axis[2][r][lane]};
        for (size_t g = 0; g < hull->groups; ++g)
            add_up(&groups[g], node->centre[r][lane], a, hull->x[r] + g * WIDTH);
        hull->width[r] = node->width[r][lane] + node->leaf_margin;
    }
}

float mote_cert_leaf_reach(mote_cert_side *side, const mote_cert_node *node, size_t lane,
                           const float d[3], uint32_t stamp)
{
    const mote_cert_leaf *leaf = leaf_of(side->tree, node, lane);
    if (side->reached == leaf && side->reached_stamp == stamp)
        return side->reached_at;
    float base = 0, slant[3] = {0, 0, 0};
    for (size_t r = 0; r < 3; ++r) {
        base += node->centre[r][lane] * d[r];
        for (size_t k = 0; k < 3; ++k)
            slant[k] += node->axis[k][r][lane] * d[r];
    }
    side->reached = leaf;
    side->reached_stamp = stamp;
    side->reached_at = farthest_along(side->tree->groups + leaf->first_group,
                                      mote_cert_group_count(leaf), base, slant);
    return side->reached_at;
}

/* The slot for the near hull of a leaf. */
static mote_cert_hull *hull_place(mote_cert_side *side, const mote_cert_node *node, size_t lane)
{
    return &side->hulls[(uint32_t)~node->block->child[lane] % MOTE_CERT_HULLS];
}

const mote_cert_hull *mote_cert_leaf_known_hull(mote_cert_side *side,
                                                const mote_cert_node *node, size_t lane)
{
    const mote_cert_hull *hull = hull_place(side, node, lane);
    return hull->leaf == leaf_of(side->tree, node, lane) ? hull : NULL;
}

const mote_cert_hull *mote_cert_leaf_near_hull(mote_cert_side *side, const mote_cert_node *node,
                                               size_t lane)
{
    const mote_cert_leaf *leaf = leaf_of(side->tree, node, lane);
    mote_cert_hull *hull = hull_place(side, node, lane);
    if (hull->leaf == leaf)
        return hull;
    hull->leaf = leaf;
    hull->groups = mote_cert_group_count(leaf);
    if (side->tree->bounds->hull(side, node, lane, hull))
        return hull;
    hull->leaf = NULL;
    return NULL;
}

/* The least and the most of x, or of x less y where y is not NULL. */
MOTE_INLINE void ends_of(const float *restrict x, const float *restrict y, uint32_t groups,
                         float *least, float *most)
{
    float low[WIDTH], high[WIDTH];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        low[l] = high[l] = y ? x[l] - y[l] : x[l];
    for (uint32_t g = 1; g < groups; ++g) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            const size_t i = g * WIDTH + l;
            const float at = y ? x[i] - y[i] : x[i];
            low[l] = at < low[l] ? at : low[l];
            high[l] = at > high[l] ? at : high[l];
        }
    }
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        low[l] = -low[l];
    *least = -mote_cert_largest(low);
    *most = mote_cert_largest(high);
}

/* Narrows a leaf's box to what its vertices by the field are off where it places them. Margins.
   A vertex is within near->width of its evaluated position; where the box places it is computed
   to 5 u B, and what tests of boxes round is at most 40 u B (certificate_fitted.c). Twice
   leaf_margin is 64 u B. */
MOTE_INLINE bool narrow_box(mote_cert_node *restrict node, size_t lane,
                            const mote_cert_hull *restrict near,
                            const mote_cert_hull *restrict placed)
{
    bool narrowed = false;
    for (size_t r = 0; r < 3; ++r) {
        float least, most;
        ends_of(near->x[r], placed->x[r], near->groups, &least, &most);
        const float width = 0.5F * (most - least) + near->width[r] + 2 * node->leaf_margin;
        if (width < node->width[r][lane]) {
            node->centre[r][lane] += 0.5F * (most + least);
            node->width[r][lane] = width;
            narrowed = true;
        }
    }
    return narrowed;
}

/* A hull's width covers the rounding of its ends and of what is done with them. */
MOTE_CLONES
bool mote_cert_narrow(mote_cert_side *side, mote_cert_node *node, size_t lane)
{
    mote_cert_hull placed;
    const mote_cert_hull *hull = &placed;
    bool narrowed = false;
    mote_cert_leaf_hull(side, node, lane, &placed);
    if (node->wide >> lane & 1) {
        hull = mote_cert_leaf_near_hull(side, node, lane);
        assert(hull);
        narrowed = narrow_box(node, lane, hull, &placed);
    }
    for (size_t r = 0; r < 3; ++r) {
        float least, most;
        ends_of(hull->x[r], NULL, hull->groups, &least, &most);
        node->low[r][lane] = least - hull->width[r];
        node->high[r][lane] = most + hull->width[r];
    }
    node->wide &= ~(1u << lane);
    node->unmeasured &= ~(1u << lane);
    return narrowed;
}

uint32_t mote_cert_narrow_row(mote_certificate *c, int s, mote_cert_node *node, size_t lane,
                              mote_cert_node *other, uint32_t undecided, float bound[WIDTH])
{
    uint32_t left = undecided & other->unmeasured;
    const bool own = node->unmeasured >> lane & 1;
    if (!own && !left)
        return undecided;
    bool narrowed = own && mote_cert_narrow(&c->side[s], node, lane);
    for (; left; left &= left - 1)
        narrowed = mote_cert_narrow(&c->side[1 - s], other, mote_lowest_bit(left)) || narrowed;
    if (node->spans && other->spans) /* fields of other kinds have none */
        undecided = mote_cert_row_spans(node, lane, other, c->need, undecided, bound);
    if (!undecided || !narrowed)
        return undecided;
    return mote_cert_row_boxes(node, lane, other, c->need, undecided, bound);
}

/* The exact coordinate of a vertex towards the other body. */
static double exact_reach(mote_certificate *c, int s, uint32_t vertex)
{
    mote_cert_side *side = &c->side[s];
    const mote_vec3 p = mote_lazy_position(&side->lazy, vertex);
    return mote_dot(mote_sub(p, c->origin), side->facing) * c->scale;
}

/* By the linear fit, the vertex at z has the coordinate middle + sum_k z_k slant_k, and `loose`
   bounds the difference to the true one. Only vertices that this leaves undecided are
   evaluated. */
bool mote_cert_leaf_clear(mote_certificate *c, int s, const mote_cert_node *node, size_t lane,
                          double *reach)
{
    const mote_cert_side *side = &c->side[s];
    const mote_cert_leaf *leaf = leaf_of(side->tree, node, lane);
    const float slant[3] = {node->slant[0][lane], node->slant[1][lane], node->slant[2][lane]};
    const double loose = (double)(node->loose[lane] + node->leaf_margin);
    const float doubtful = (float)(side->threshold - loose) - node->leaf_margin;
    uint64_t left;
    const double most =
        (double)place_along(side->tree->groups + leaf->first_group, mote_cert_group_count(leaf),
                            node->middle[lane], slant, doubtful, &left);
    *reach = most + loose;
    if (*reach <= side->threshold)
        return true;
    if (most - loose > side->threshold)
        return false;
    const uint32_t *vertices = side->tree->leaf_vertices + leaf->first_vertex;
    double farthest = side->threshold;
    for (left &= ((uint64_t)1 << leaf->vertex_count) - 1; left; left &= left - 1) {
        const double exact = exact_reach(c, s, vertices[mote_lowest_bit_of_64(left)]);
        if (exact > side->threshold + c->noise)
            return false;
        farthest = exact > farthest ? exact : farthest;
    }
    *reach = farthest;
    return true;
}
