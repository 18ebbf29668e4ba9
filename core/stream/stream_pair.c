/* Two leaves: directions that separate them, then their triangles. */
#include "core/stream/stream_state.h"

#include "core/body/triangle.h"

#include <string.h>

/* Pairs of faces that are tested at once; so few are not worth a search for a direction. */
#define FEW MOTE_CERT_FACE_LANES

/* A face of a leaf, exactly. */
typedef struct exact_face {
    mote_vec3 corner[3];
    const uint32_t *vertex; /* [3] */
} exact_face;

static exact_face place_face(const mote_stream_search *s, int side, uint32_t leaf, size_t place)
{
    const mote_stream_body *body = s->side[side].body;
    const mote_stream_tree *tree = body->tree;
    const size_t number = (size_t)leaf * MOTE_STREAM_LEAF + place;
    exact_face face = {.vertex = tree->mesh->triangles[tree->order[number]]};
    for (int k = 0; k < 3; ++k)
        face.corner[k] = mote_position_at(&body->positions, face.vertex[k]);
    return face;
}

/* The gap of two faces along the direction of the best witnesses, which changes with them. */
static double gap_of(const mote_stream_search *s, const exact_face *a, const exact_face *b)
{
    double most = -HUGE_VAL, least = HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
        const double p = mote_dot(mote_sub(a->corner[k], s->origin), s->toward);
        const double q = mote_dot(mote_sub(b->corner[k], s->origin), s->toward);
        most = p > most ? p : most;
        least = q < least ? q : least;
    }
    return (least - most) * s->scale;
}

/* Measures two faces, and keeps them where they are the nearest so far. */
static void measure(mote_stream_search *s, const exact_face *a, const exact_face *b)
{
    if (gap_of(s, a, b) >= s->limit)
        return;
    const double limit = s->limit / s->scale;
    mote_vec3 p, q;
    ++s->counters.triangle_tests;
    const double squared =
        mote_triangle_triangle_below(a->corner, b->corner, limit * limit, &p, &q);
    if (!(squared < limit * limit && squared < s->best.squared))
        return;
    s->best.witness[0] = p;
    s->best.witness[1] = q;
    memcpy(s->best.triangle[0], a->vertex, sizeof s->best.triangle[0]);
    memcpy(s->best.triangle[1], b->vertex, sizeof s->best.triangle[1]);
    mote_stream_set_best(s, squared);
}

/* Tests pairs of faces one by one, and measures those that may be nearer than the limit. */
static void measure_pairs(mote_stream_search *s, const uint32_t leaf[2],
                          const mote_cert_hulls *hulls, const mote_cert_near *left)
{
    mote_cert_near near;
    mote_cert_hulls_test(hulls, s->need, left, &near);
    for (; near.used && !s->done; near.used &= near.used - 1) {
        const size_t i = mote_lowest_bit(near.used);
        const exact_face a = place_face(s, 0, leaf[0], i);
        for (uint32_t open = near.undecided[i]; open && !s->done; open &= open - 1) {
            const exact_face b = place_face(s, 1, leaf[1], mote_lowest_bit(open));
            measure(s, &a, &b);
        }
    }
}

static mote_cert_points points_of(const mote_stream_tree *tree, const mote_stream_slot *slot)
{
    return (mote_cert_points){.x = {slot->x[0], slot->x[1], slot->x[2]},
                              .groups = slot->groups,
                              .corners = (const uint8_t(*)[3])tree->corners +
                                         (size_t)slot->leaf * MOTE_STREAM_LEAF,
                              .faces = mote_stream_leaf_faces(tree, slot->leaf)};
}

/* Searches for a direction that separates two leaves, and keeps it. */
static bool separate(mote_stream_search *s, mote_cert_hulls *hulls)
{
    if (!mote_cert_hulls_search(hulls, s->need))
        return false;
    memcpy(s->direction, hulls->nearest, sizeof s->direction);
    s->has_direction = true;
    return true;
}

/* Whether the last direction, or that of the gap, separates two leaves. Where the gap is
   bounded by parallel faces, many leaves are exactly as far apart as the witnesses, which
   single precision cannot tell from nearer. */
static bool apart(mote_stream_search *s, mote_stream_slot *const slot[2],
                  const mote_cert_hulls *hulls)
{
    return (s->has_direction && mote_cert_hulls_along(hulls, s->direction, s->need)) ||
           -(mote_stream_reach(s, 0, slot[0]) + mote_stream_reach(s, 1, slot[1])) >= s->limit;
}

/* Whether directions are looked for before the faces are boxed. A direction serves the pairs
   that follow too, but where a sheet lies on a body few leaves have one. Boxes first take 20 %
   less time on a cloth at rest, and 3 to 5 % more on ww, fast-100 and a jelly. */
static bool searches_pay(const mote_stream_search *s)
{
    return 5 * s->separated >= 2 * s->searches;
}

/* Whether a direction is found that separates two leaves. */
static bool separated_first(mote_stream_search *s, mote_stream_slot *const slot[2],
                            mote_cert_hulls *hulls)
{
    if (apart(s, slot, hulls))
        return true;
    const bool separated = separate(s, hulls);
    ++s->searches;
    s->separated += separated;
    return separated;
}

/* Drops pairs of faces that the mean normal of either leaf shows to be far enough apart. In a
   sheet that lies on a body the leaves' gap is along these, wherever the nearest pair is. That
   saves 15 % of the time of such a sheet; where searches pay, it costs 2 % (fast-100, twist).
 */
static void drop_along_normals(mote_stream_search *s, mote_stream_slot *const slot[2],
                               mote_cert_hulls *hulls, mote_cert_near *left)
{
    for (int side = 0; side < 2 && left->used; ++side) {
        const float *n = mote_stream_normal(s, side, slot[side]);
        float along = 0;
        for (size_t k = 0; k < 3; ++k)
            along += n[k] * ((slot[1]->low[k] + slot[1]->high[k]) -
                             (slot[0]->low[k] + slot[0]->high[k]));
        for (size_t k = 0; k < 3; ++k)
            hulls->nearest[k] = along < 0 ? -n[k] : n[k];
        mote_cert_hulls_drop(hulls, s->need, left);
    }
}

void mote_stream_leaf_pair(mote_stream_search *s, const uint32_t leaf[2])
{
    mote_stream_slot *slot[2];
    mote_cert_hulls hulls;
    ++s->counters.leaf_pairs;
    for (int k = 0; k < 2; ++k) {
        slot[k] = mote_stream_leaf(s, k, leaf[k]);
        hulls.leaf[k] = points_of(s->side[k].body->tree, slot[k]);
    }
    memcpy(hulls.loose, s->loose, sizeof hulls.loose);
    for (size_t k = 0; k < 3; ++k)
        hulls.nearest[k] = slot[1]->x[k][0] - slot[0]->x[k][0];
    const bool first = searches_pay(s);
    if (first && separated_first(s, slot, &hulls))
        return;
    mote_cert_near left;
    const uint32_t pairs = mote_stream_near_faces(s, slot, &left);
    if (pairs > FEW) {
        if (!first && (apart(s, slot, &hulls) || separate(s, &hulls)))
            return;
        mote_cert_hulls_drop(&hulls, s->need, &left);
        if (!first)
            drop_along_normals(s, slot, &hulls, &left);
    }
    if (left.used)
        measure_pairs(s, leaf, &hulls, &left);
}
