/* Two leaves: directions that separate them, then their triangles. */
#include "core/certificate/certificate_state.h"
#include "core/body/triangle.h"

#include <string.h>

/* The traversal starts again when the upper bound falls below this part of its value: much less
   is left to look at then. */
#define WORTH_RESTART 0.95

/* Two leaves, and the hulls that stand for them. */
typedef struct pair {
    const mote_cert_leaf *leaf[2];
    const mote_cert_hull *hull[2];
    mote_cert_hulls hulls;
} pair;

/* Looks for a direction that separates two leaves, starting from p->nearest. One that is found
   is tried first on the next leaves. */
static bool find_direction(mote_certificate *c, pair *p)
{
    if (!mote_cert_hulls_search(&p->hulls, c->need))
        return false;
    memcpy(c->memory.direction, p->hulls.nearest, sizeof c->memory.direction);
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
    return mote_cert_far_enough(-reach - loose * (1 + 0x1p-21F), c->need, squared);
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

/* Measures the pairs of faces of two leaves that may be nearer than the limit; true when the
   upper bound improved. */
static bool measure_all(mote_certificate *c, const pair *p)
{
    mote_cert_near near;
    exact_face exact[2][MOTE_CERT_LEAF_TRIANGLES];
    ++c->compared;
    mote_cert_hulls_near(&p->hulls, c->need, c->side[0].facing_world, &near);
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

/* Chooses the hull of one leaf. */
static void set_hull(const mote_certificate *c, pair *p, int s, const mote_cert_hull *hull)
{
    const mote_cert_leaf *leaf = hull->leaf;
    p->leaf[s] = leaf;
    p->hull[s] = hull;
    p->hulls.leaf[s] = (mote_cert_points){
        .x = {hull->x[0], hull->x[1], hull->x[2]},
        .groups = hull->groups,
        .corners = (const uint8_t(*)[3])c->side[s].tree->corners + leaf->first_corner,
        .faces = leaf->triangle_count};
}

static void set_loose(pair *p)
{
    for (size_t r = 0; r < 3; ++r)
        p->hulls.loose[r] = (p->hull[0]->width[r] + p->hull[1]->width[r]) * (1 + 0x1p-22F);
}

/* Replaces the hulls by those with the field evaluated; false when the field offers none. */
static bool use_evaluated_hulls(mote_certificate *c, pair *p,
                                const mote_cert_node *const nodes[2], const size_t lanes[2])
{
    for (int s = 0; s < 2; ++s) {
        const mote_cert_hull *hull = mote_cert_leaf_near_hull(&c->side[s], nodes[s], lanes[s]);
        if (!hull)
            return false;
        set_hull(c, p, s, hull);
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
        const mote_cert_hull *hull = mote_cert_leaf_known_hull(&c->side[s], nodes[s], lanes[s]);
        if (!hull) {
            mote_cert_leaf_hull(&c->side[s], nodes[s], lanes[s], &hulls[s]);
            hull = &hulls[s];
            near = false;
        }
        set_hull(c, &p, s, hull);
    }
    set_loose(&p);
    for (size_t r = 0; r < 3; ++r)
        p.hulls.nearest[r] = nodes[1]->centre[r][lanes[1]] - nodes[0]->centre[r][lanes[0]];
    if (c->options.directions && find_direction(c, &p))
        return;
    if (!near && use_evaluated_hulls(c, &p, nodes, lanes) && c->options.directions &&
        find_direction(c, &p))
        return;
    const double before = c->upper;
    if (measure_all(c, &p) && !c->done && c->upper < WORTH_RESTART * before &&
        c->restarts < c->options.restarts) {
        c->improved = true;
        c->done = true;
    }
}
