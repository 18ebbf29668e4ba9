#include "core/certificate/certificate_hulls.h"

#include "core/base/clones.h"

#define WIDTH MOTE_CERT_WIDTH

/* Steps of the search for a direction that separates two leaves. */
#define STEPS 3

/* The largest coordinate along a direction in each lane of a hull, and the group that it is in;
   returns the largest of all. */
MOTE_INLINE float reach_along(const mote_cert_points *restrict hull, const float d[3],
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
    return mote_cert_largest(most);
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

/* Whether the gap along w, which points from body 0 to body 1, less the error of the hulls, is
   at least need times |w|. If not, at[] are the vertices that bound it. */
MOTE_INLINE bool apart_along(const mote_cert_hulls *restrict p, const float w[3], float need,
                             size_t at[2])
{
    const float back[3] = {-w[0], -w[1], -w[2]};
    float most[2][WIDTH];
    uint32_t group[2][WIDTH];
    const float reach0 = reach_along(&p->leaf[0], w, most[0], group[0]);
    const float reach1 = reach_along(&p->leaf[1], back, most[1], group[1]);
    const float gap =
        -(reach0 + reach1) -
        (p->loose[0] * fabsf(w[0]) + p->loose[1] * fabsf(w[1]) + p->loose[2] * fabsf(w[2]));
    if (mote_cert_far_enough(gap, need, w[0] * w[0] + w[1] * w[1] + w[2] * w[2]))
        return true;
    at[0] = vertex_at(most[0], group[0], reach0);
    at[1] = vertex_at(most[1], group[1], reach1);
    return false;
}

/* Gilbert's search for the least difference of two hulls: w, the difference of a point in each,
   is moved towards that of the vertices that bound the gap along it. True once w separates. */
MOTE_CLONES
static bool search_direction(const mote_cert_hulls *restrict p, float need, float w[3])
{
    for (int i = 0; i < STEPS; ++i) {
        size_t at[2];
        if (apart_along(p, w, need, at))
            return true;
        float d[3];
        float dd = 0x1p-100F;
        float along = 0;
        for (size_t r = 0; r < 3; ++r) {
            d[r] = (p->leaf[1].x[r][at[1]] - p->leaf[0].x[r][at[0]]) - w[r];
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

bool mote_cert_hulls_search(mote_cert_hulls *pair, float need)
{
    return search_direction(pair, need, pair->nearest);
}

MOTE_CLONES
bool mote_cert_hulls_along(const mote_cert_hulls *pair, const float direction[3], float need)
{
    size_t at[2];
    return apart_along(pair, direction, need, at);
}

/* Drops pairs that are far enough apart along a direction from the first leaf to the second.
   Keeps all where there is no direction. */
static void filter_along(const mote_cert_hulls *p, float need, const float direction[3],
                         mote_cert_near *left)
{
    const float *d = direction;
    const float back[3] = {-d[0], -d[1], -d[2]};
    const float squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (!(squared >= MOTE_CERT_SHORTEST_SQUARED))
        return;
    mote_cert_reaches reaches[2];
    mote_cert_reach_faces(&p->leaf[0], d, &reaches[0]);
    mote_cert_reach_faces(&p->leaf[1], back, &reaches[1]);
    const float length = sqrtf(squared);
    const float slack =
        p->loose[0] * fabsf(d[0]) + p->loose[1] * fabsf(d[1]) + p->loose[2] * fabsf(d[2]);
    /* pairs whose reaches add up to no more than this are far enough apart */
    const float least = -(need * length + slack) * (1 + 0x1p-19F);
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
MOTE_INLINE void test_gathered(const mote_cert_hulls *p, float need, bool normals,
                               gathered *pairs, mote_cert_near *near)
{
    mote_cert_face_lanes lanes[2];
    if (pairs->count == 0)
        return;
    for (int s = 0; s < 2; ++s)
        mote_cert_load_faces(&p->leaf[s], pairs->face[s], pairs->count, &lanes[s]);
    uint32_t left =
        mote_cert_near_pairs(&lanes[0], &lanes[1], (1u << pairs->count) - 1, need, p->loose);
    if (normals && left)
        left = mote_cert_near_along_normals(&lanes[0], &lanes[1], left, need, p->loose);
    for (; left; left &= left - 1) {
        const size_t l = mote_lowest_bit(left);
        near->undecided[pairs->face[0][l]] |= 1u << pairs->face[1][l];
        near->used |= 1u << pairs->face[0][l];
    }
    pairs->count = 0;
}

/* Adds the pairs in `left` that may be near to `near`. */
MOTE_INLINE void test_all_pairs(const mote_cert_hulls *p, float need, bool normals,
                                const mote_cert_near *left, mote_cert_near *near)
{
    gathered pairs;
    pairs.count = 0;
    for (uint32_t used = left->used; used; used &= used - 1) {
        const size_t i = mote_lowest_bit(used);
        for (uint32_t undecided = left->undecided[i]; undecided; undecided &= undecided - 1) {
            pairs.face[0][pairs.count] = (uint8_t)i;
            pairs.face[1][pairs.count++] = (uint8_t)mote_lowest_bit(undecided);
            if (pairs.count == MOTE_CERT_FACE_LANES)
                test_gathered(p, need, normals, &pairs, near);
        }
    }
    test_gathered(p, need, normals, &pairs, near);
}

void mote_cert_hulls_near(const mote_cert_hulls *p, float need, const float facing[3],
                          mote_cert_near *near)
{
    mote_cert_near left;
    const uint32_t all = 0xffffffffu >> (32u - p->leaf[1].faces);
    left.used = 0xffffffffu >> (32u - p->leaf[0].faces);
    near->used = 0;
    for (size_t i = 0; i < p->leaf[0].faces; ++i) {
        left.undecided[i] = all;
        near->undecided[i] = 0;
    }
    filter_along(p, need, facing, &left);
    if (left.used)
        filter_along(p, need, p->nearest, &left);
    if (left.used)
        test_all_pairs(p, need, false, &left, near);
}

void mote_cert_hulls_drop(const mote_cert_hulls *p, float need, mote_cert_near *left)
{
    filter_along(p, need, p->nearest, left);
}

void mote_cert_hulls_test(const mote_cert_hulls *p, float need, const mote_cert_near *left,
                          mote_cert_near *near)
{
    near->used = 0;
    for (size_t i = 0; i < p->leaf[0].faces; ++i)
        near->undecided[i] = 0;
    test_all_pairs(p, need, true, left, near);
}
