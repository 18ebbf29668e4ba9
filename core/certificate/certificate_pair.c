/* Two leaves: directions that separate them, then their triangles. */
#include "core/certificate/certificate_state.h"
#include "core/base/clones.h"
#include "core/body/triangle.h"

#include <float.h>
#include <string.h>

#define WIDTH MOTE_CERT_WIDTH

/* The traversal starts again when the upper bound falls below this part of its value: much less
   is left to look at then. */
#define WORTH_RESTART 0.95

/* Steps of the search for a direction that separates two leaves. */
#define STEPS 3

/* Two leaves' hulls, and by how much a difference of a vertex of each may be wrong in each
   coordinate. */
typedef struct pair {
    const mote_cert_leaf *leaf[2];
    const mote_cert_hull *hull[2];
    float loose[3];
    float nearest[3]; /* about the direction from the first to the second at their nearest */
} pair;

/* The largest of eight, in a fixed order. */
MOTE_INLINE float largest_of(const float x[WIDTH])
{
    float four[4], two[2];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < 4; ++l)
        four[l] = x[l] > x[l + 4] ? x[l] : x[l + 4];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < 2; ++l)
        two[l] = four[l] > four[l + 2] ? four[l] : four[l + 2];
    return two[0] > two[1] ? two[0] : two[1];
}

/* The largest coordinate along a direction in each lane of a hull, and the group that it is in;
   returns the largest of all. */
MOTE_INLINE float reach_along(const mote_cert_hull *restrict hull, const float d[3],
                              float most[WIDTH], uint32_t group[WIDTH])
{
    for (size_t l = 0; l < WIDTH; ++l) {
        most[l] = -FLT_MAX;
        group[l] = 0;
    }
    for (uint32_t g = 0; g < hull->groups * WIDTH; g += WIDTH) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            const float p =
                hull->x[0][g + l] * d[0] + hull->x[1][g + l] * d[1] + hull->x[2][g + l] * d[2];
            group[l] = p > most[l] ? g : group[l];
            most[l] = p > most[l] ? p : most[l];
        }
    }
    return largest_of(most);
}

/* A vertex that attains the largest coordinate. */
MOTE_INLINE size_t vertex_at(const float most[WIDTH], const uint32_t group[WIDTH],
                             float largest)
{
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        bits |= most[l] >= largest ? 1u << l : 0;
    const size_t lane = bits ? mote_lowest_bit(bits) : 0;
    return group[lane] + lane;
}

/* A shorter vector is not used as a direction, since its squared length loses bits as a float,
   and a zero vector separates nothing. Where hulls intersect, the search ends at such vectors.
 */
#define SHORTEST_SQUARED 0x1p-100F

/* Whether a gap along a vector is at least need times its length. False where the squares leave
   the range of floats, from 10^9 L on. */
MOTE_INLINE bool far_enough(float gap, float need, float length_squared)
{
    return gap > 0 && length_squared >= SHORTEST_SQUARED && gap * gap <= FLT_MAX &&
           gap * gap >= need * need * (1 + 0x1p-18F) * length_squared;
}

/* Whether the gap along w, which points from body 0 to body 1, less the error of the hulls, is
   at least need times |w|. If not, at[] are the vertices that bound it. */
MOTE_INLINE bool apart_along(const pair *restrict p, const float w[3], float need, size_t at[2])
{
    const float back[3] = {-w[0], -w[1], -w[2]};
    float most[2][WIDTH];
    uint32_t group[2][WIDTH];
    const float reach0 = reach_along(p->hull[0], w, most[0], group[0]);
    const float reach1 = reach_along(p->hull[1], back, most[1], group[1]);
    const float gap =
        -(reach0 + reach1) -
        (p->loose[0] * fabsf(w[0]) + p->loose[1] * fabsf(w[1]) + p->loose[2] * fabsf(w[2]));
    if (far_enough(gap, need, w[0] * w[0] + w[1] * w[1] + w[2] * w[2]))
        return true;
    at[0] = vertex_at(most[0], group[0], reach0);
    at[1] = vertex_at(most[1], group[1], reach1);
    return false;
}

/* Gilbert's search for the least difference of two hulls: w, the difference of a point in each,
   is moved towards that of the vertices that bound the gap along it. True once w separates. */
MOTE_CLONES
static bool search_direction(const pair *restrict p, float need, float w[3])
{
    for (int i = 0; i < STEPS; ++i) {
        size_t at[2];
        if (apart_along(p, w, need, at))
            return true;
        float d[3];
        float dd = 0x1p-100F;
        float along = 0;
        for (size_t r = 0; r < 3; ++r) {
            d[r] = (p->hull[1]->x[r][at[1]] - p->hull[0]->x[r][at[0]]) - w[r];
            dd += d[r] * d[r];
            along -= d[r] * w[r];
        }
        const float part = along / dd;
        const float share = part < 1 ? part : 1;
        if (!(share > 0))
            return false;
        for (size_t r = 0; r < 3; ++r)
            w[r] += share * d[r];
        if (w[0] * w[0] + w[1] * w[1] + w[2] * w[2] < need * need)
            return false; /* two points of the hulls are nearer than that */
    }
    return false;
}

/* Looks for a direction that separates two leaves, starting from p->nearest. One that is found
   is tried first on the next leaves. */
static bool find_direction(mote_certificate *c, pair *p)
{
    if (!search_direction(p, c->need, p->nearest))
        return false;
    memcpy(c->memory.direction, p->nearest, sizeof c->memory.direction);
    c->memory.has_direction = true;
    ++c->direction_stamp;
    return true;
}

/* Whether the last direction found separates two leaves. It usually does, and testing it costs
   less than making the hulls. */
static bool latest_separates(mote_certificate *c, const mote_cert_node *const nodes[2],
                             const size_t lanes[2])
{
    if (!c->memory.has_direction)
        return false;
    const float *d = c->memory.direction;
    const float back[3] = {-d[0], -d[1], -d[2]};
    const float reach =
        mote_cert_leaf_reach(&c->side[0], nodes[0], lanes[0], d, c->direction_stamp) +
        mote_cert_leaf_reach(&c->side[1], nodes[1], lanes[1], back, c->direction_stamp);
    const float margin = nodes[0]->leaf_margin + nodes[1]->leaf_margin;
    float loose = 0;
    float squared = 0;
    for (size_t r = 0; r < 3; ++r) {
        loose += (nodes[0]->width[r][lanes[0]] + nodes[1]->width[r][lanes[1]] + margin) *
                 fabsf(d[r]);
        squared += d[r] * d[r];
    }
    return far_enough(-reach - loose * (1 + 0x1p-21F), c->need, squared);
}

/* The vertices of a leaf's face. */
static void face_vertices(const mote_cert_tree *tree, const mote_cert_leaf *leaf, size_t face,
                          uint32_t vertices[3])
{
    const uint8_t *places = tree->corners[leaf->first_corner + face];
    for (int k = 0; k < 3; ++k)
        vertices[k] = tree->leaf_vertices[leaf->first_vertex + places[k]];
}

/* A face of a leaf, exactly. */
typedef struct exact_face {
    mote_vec3 corner[3];
    uint32_t vertex[3];
    double reach; /* towards the other body, in the trees' units */
} exact_face;

/* Exact corners of the faces in `wanted`. */
static void place_faces(mote_certificate *c, int s, const pair *p, uint32_t wanted,
                        exact_face exact[MOTE_CERT_LEAF_TRIANGLES])
{
    mote_cert_side *side = &c->side[s];
    for (; wanted; wanted &= wanted - 1) {
        const size_t l = mote_lowest_bit(wanted);
        exact_face *face = &exact[l];
        face->reach = -HUGE_VAL;
        face_vertices(side->tree, p->leaf[s], l, face->vertex);
        for (int k = 0; k < 3; ++k) {
            face->corner[k] = mote_lazy_position(&side->lazy, face->vertex[k]);
            const mote_vec3 d = mote_sub(face->corner[k], c->origin);
            const double reach = mote_dot(d, side->facing) * c->scale;
            face->reach = reach > face->reach ? reach : face->reach;
        }
    }
}

/* Measures two faces; true when they are nearer than the best pair. */
static bool measure(mote_certificate *c, const exact_face *s, const exact_face *t)
{
    if (-(s->reach + t->reach) >= c->limit)
        return false;
    const double limit = c->limit / c->scale;
    mote_vec3 p, q;
    ++c->counters.triangle_tests;
    const double squared =
        mote_triangle_triangle_below(s->corner, t->corner, limit * limit, &p, &q);
    if (!(squared < limit * limit && squared < c->best.squared))
        return false;
    c->best.witness[0] = p;
    c->best.witness[1] = q;
    memcpy(c->best.triangle[0], s->vertex, sizeof s->vertex);
    memcpy(c->best.triangle[1], t->vertex, sizeof t->vertex);
    mote_cert_set_best(c, squared);
    return true;
}

/* Pairs of faces that may be near: bit k of undecided[i] stands for face i of the first leaf
   and face k of the second. */
typedef struct left_pairs {
    uint32_t used; /* bit i: undecided[i] is not 0 */
    uint32_t undecided[MOTE_CERT_LEAF_TRIANGLES];
} left_pairs;

/* Drops pairs that are far enough apart along a direction from the first leaf to the second.
   Keeps all where there is no direction. */
static void filter_along(const mote_certificate *c, const pair *p, const float direction[3],
                         left_pairs *left)
{
    const float *d = direction;
    const float back[3] = {-d[0], -d[1], -d[2]};
    const float squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (!(squared >= SHORTEST_SQUARED))
        return;
    mote_cert_reaches reaches[2];
    mote_cert_reach_faces(c->side[0].tree, p->hull[0], d, &reaches[0]);
    mote_cert_reach_faces(c->side[1].tree, p->hull[1], back, &reaches[1]);
    const float length = sqrtf(squared);
    const float slack =
        p->loose[0] * fabsf(d[0]) + p->loose[1] * fabsf(d[1]) + p->loose[2] * fabsf(d[2]);
    /* pairs whose reaches add up to no more than this are far enough apart */
    const float least = -(c->need * length + slack) * (1 + 0x1p-19F);
    uint32_t used = left->used & mote_cert_reaching(&reaches[0], least - reaches[1].farthest);
    left->used = 0;
    for (; used; used &= used - 1) {
        const size_t i = mote_lowest_bit(used);
        left->undecided[i] &= mote_cert_reaching(&reaches[1], least - reaches[0].reach[i]);
        left->used |= left->undecided[i] ? 1u << i : 0;
    }
}

/* Pairs of faces gathered for a test. */
typedef struct gathered {
    uint8_t face[2][MOTE_CERT_FACE_LANES];
    uint32_t count;
} gathered;

/* Adds the gathered pairs that may be near to `near`, and empties the list. */
static void test_gathered(const mote_certificate *c, const pair *p, gathered *pairs,
                          left_pairs *near)
{
    mote_cert_face_lanes lanes[2];
    if (pairs->count == 0)
        return;
    for (int s = 0; s < 2; ++s) {
        for (uint32_t l = pairs->count; l < MOTE_CERT_FACE_LANES; ++l)
            pairs->face[s][l] = pairs->face[s][0];
        mote_cert_load_faces(c->side[s].tree, p->hull[s], pairs->face[s], &lanes[s]);
    }
    uint32_t left =
        mote_cert_near_pairs(&lanes[0], &lanes[1], (1u << pairs->count) - 1, c->need, p->loose);
    for (; left; left &= left - 1) {
        const size_t l = mote_lowest_bit(left);
        near->undecided[pairs->face[0][l]] |= 1u << pairs->face[1][l];
        near->used |= 1u << pairs->face[0][l];
    }
    pairs->count = 0;
}

/* Adds the pairs in `left` that may be near to `near`. */
static void test_all_pairs(const mote_certificate *c, const pair *p, const left_pairs *left,
                           left_pairs *near)
{
    gathered pairs;
    pairs.count = 0;
    for (uint32_t used = left->used; used; used &= used - 1) {
        const size_t i = mote_lowest_bit(used);
        for (uint32_t undecided = left->undecided[i]; undecided; undecided &= undecided - 1) {
            pairs.face[0][pairs.count] = (uint8_t)i;
            pairs.face[1][pairs.count++] = (uint8_t)mote_lowest_bit(undecided);
            if (pairs.count == MOTE_CERT_FACE_LANES)
                test_gathered(c, p, &pairs, near);
        }
    }
    test_gathered(c, p, &pairs, near);
}

/* The pairs of faces of two leaves that may be nearer than the limit. */
static void find_near(const mote_certificate *c, const pair *p, left_pairs *near)
{
    left_pairs left;
    const uint32_t all = 0xffffffffu >> (32u - p->leaf[1]->triangle_count);
    left.used = 0xffffffffu >> (32u - p->leaf[0]->triangle_count);
    near->used = 0;
    for (size_t i = 0; i < p->leaf[0]->triangle_count; ++i) {
        left.undecided[i] = all;
        near->undecided[i] = 0;
    }
    filter_along(c, p, c->side[0].facing_world, &left);
    if (left.used)
        filter_along(c, p, p->nearest, &left);
    if (left.used)
        test_all_pairs(c, p, &left, near);
}

/* Measures the pairs of faces of two leaves that may be nearer than the limit; true when the
   upper bound improved. */
static bool measure_all(mote_certificate *c, const pair *p)
{
    left_pairs near;
    exact_face exact[2][MOTE_CERT_LEAF_TRIANGLES];
    find_near(c, p, &near);
    uint32_t wanted = 0;
    for (uint32_t left = near.used; left; left &= left - 1)
        wanted |= near.undecided[mote_lowest_bit(left)];
    place_faces(c, 0, p, near.used, exact[0]);
    place_faces(c, 1, p, wanted, exact[1]);
    bool improved = false;
    for (; near.used; near.used &= near.used - 1) {
        const size_t i = mote_lowest_bit(near.used);
        for (uint32_t left = near.undecided[i]; left && !c->done; left &= left - 1)
            improved = measure(c, &exact[0][i], &exact[1][mote_lowest_bit(left)]) || improved;
    }
    return improved;
}

static void set_loose(pair *p)
{
    for (size_t r = 0; r < 3; ++r)
        p->loose[r] = (p->hull[0]->width[r] + p->hull[1]->width[r]) * (1 + 0x1p-22F);
}

/* Replaces the hulls by those with the field evaluated; false when the field offers none. */
static bool use_evaluated_hulls(mote_certificate *c, pair *p,
                                const mote_cert_node *const nodes[2], const size_t lanes[2])
{
    for (int s = 0; s < 2; ++s) {
        const mote_cert_hull *hull = mote_cert_leaf_near_hull(&c->side[s], nodes[s], lanes[s]);
        if (!hull)
            return false;
        p->hull[s] = hull;
    }
    set_loose(p);
    return true;
}

void mote_cert_leaf_pair(mote_certificate *c, const mote_cert_node *const nodes[2],
                         const size_t lanes[2])
{
    pair p;
    mote_cert_hull hulls[2];
    ++c->counters.leaf_pairs;
    if (c->options.directions && latest_separates(c, nodes, lanes))
        return;
    bool near = true;
    for (int s = 0; s < 2; ++s) {
        p.hull[s] = mote_cert_leaf_known_hull(&c->side[s], nodes[s], lanes[s]);
        if (!p.hull[s]) {
            mote_cert_leaf_hull(&c->side[s], nodes[s], lanes[s], &hulls[s]);
            p.hull[s] = &hulls[s];
            near = false;
        }
        p.leaf[s] = p.hull[s]->leaf;
    }
    set_loose(&p);
    for (size_t r = 0; r < 3; ++r)
        p.nearest[r] = nodes[1]->centre[r][lanes[1]] - nodes[0]->centre[r][lanes[0]];
    if (c->options.directions && find_direction(c, &p))
        return;
    if (!near && use_evaluated_hulls(c, &p, nodes, lanes) && c->options.directions &&
        find_direction(c, &p))
        return;
    const double before = c->upper;
    if (measure_all(c, &p) && c->upper < WORTH_RESTART * before &&
        c->restarts < c->options.restarts) {
        c->improved = true;
        c->done = true;
    }
}
