/* Which pairs of faces of two leaves may be near. */
#include "core/certificate/certificate_hulls.h"
#include "core/base/clones.h"

#define WIDTH MOTE_CERT_WIDTH
#define LANES MOTE_CERT_FACE_LANES

void mote_cert_load_faces(const mote_cert_points *restrict leaf, const uint8_t *restrict faces,
                          uint32_t count, mote_cert_face_lanes *restrict lanes)
{
    const float *const x[3] = {leaf->x[0], leaf->x[1], leaf->x[2]};
    for (size_t l = 0; l < count; ++l) {
        const uint8_t *places = leaf->corners[faces[l]];
        for (size_t k = 0; k < 3; ++k) {
            for (size_t r = 0; r < 3; ++r)
                lanes->corner[k][r][l] = x[r][places[k]];
        }
    }
    for (size_t l = count; l < LANES; ++l) {
        for (size_t k = 0; k < 3; ++k) {
            for (size_t r = 0; r < 3; ++r)
                lanes->corner[k][r][l] = lanes->corner[k][r][0];
        }
    }
}

/* Coordinates of a leaf's points along a direction. */
MOTE_CLONES
static void project_points(const mote_cert_points *restrict leaf, const float direction[3],
                           float *restrict at)
{
    const float x = direction[0];
    const float y = direction[1];
    const float z = direction[2];
    for (size_t g = 0; g < leaf->groups * WIDTH; g += WIDTH) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l)
            at[g + l] = leaf->x[0][g + l] * x + leaf->x[1][g + l] * y + leaf->x[2][g + l] * z;
    }
}

/* The largest of the projections of a face's corners on a direction. */
void mote_cert_reach_faces(const mote_cert_points *leaf, const float direction[3],
                           mote_cert_reaches *reaches)
{
    const uint8_t(*corners)[3] = leaf->corners;
    const size_t count = leaf->faces;
    float at[MOTE_CERT_POINTS];
    project_points(leaf, direction, at);
    float most = -FLT_MAX;
    for (size_t i = 0; i < count; ++i) {
        const float a = at[corners[i][0]];
        const float b = at[corners[i][1]];
        const float c = at[corners[i][2]];
        const float ab = a > b ? a : b;
        const float abc = ab > c ? ab : c;
        reaches->reach[i] = abc;
        most = most > abc ? most : abc;
    }
    reaches->lanes = (count + WIDTH - 1) / WIDTH * WIDTH;
    for (size_t i = count; i < reaches->lanes; ++i)
        reaches->reach[i] = -FLT_MAX;
    reaches->farthest = most;
}

MOTE_CLONES
uint32_t mote_cert_reaching(const mote_cert_reaches *reaches, float least)
{
    uint32_t bits = 0;
    for (size_t g = 0; g < reaches->lanes; g += 8) {
        uint32_t here = 0;
        MOTE_LANE_LOOP
        for (size_t l = 0; l < 8; ++l)
            here |= reaches->reach[g + l] > least ? 1u << l : 0;
        bits |= here << g;
    }
    return bits;
}

/* State of the search for the nearest points of two triangles, one pair a lane. */
typedef struct search {
    float w[3][LANES];      /* difference of a point on each triangle */
    float clearance[LANES]; /* >= 0: the pair is far enough apart */
} search;

/* Projects both triangles on w, and moves w towards the difference of the corners that are
   nearest to each other along it: Gilbert's search for the least difference. The gap of the
   projections, less what the corners may be off, is at most |w| times the distance. */
MOTE_INLINE void step(const mote_cert_face_lanes *restrict s,
                      const mote_cert_face_lanes *restrict t, float need, const float loose[3],
                      search *restrict g)
{
    const float enough = need * need * (1 + 0x1p-18F);
    MOTE_LANE_LOOP
    for (size_t l = 0; l < LANES; ++l) {
        const float x = g->w[0][l];
        const float y = g->w[1][l];
        const float z = g->w[2][l];
        const float ax = t->corner[0][0][l], ay = t->corner[0][1][l], az = t->corner[0][2][l];
        const float bx = t->corner[1][0][l], by = t->corner[1][1][l], bz = t->corner[1][2][l];
        const float cx = t->corner[2][0][l], cy = t->corner[2][1][l], cz = t->corner[2][2][l];
        const float s0 =
            s->corner[0][0][l] * x + s->corner[0][1][l] * y + s->corner[0][2][l] * z;
        const float s1 =
            s->corner[1][0][l] * x + s->corner[1][1][l] * y + s->corner[1][2][l] * z;
        const float s2 =
            s->corner[2][0][l] * x + s->corner[2][1][l] * y + s->corner[2][2][l] * z;
        const float a = ax * x + ay * y + az * z;
        const float b = bx * x + by * y + bz * z;
        const float c = cx * x + cy * y + cz * z;
        const float s01 = s1 > s0 ? s1 : s0;
        const float ab = b < a ? b : a;
        const float most = s2 > s01 ? s2 : s01;
        const float least = c < ab ? c : ab;
        const float slack = loose[0] * fabsf(x) + loose[1] * fabsf(y) + loose[2] * fabsf(z);
        const float gap = (least - most) - slack;
        const float ww = x * x + y * y + z * z;
        const float over = gap * gap - enough * ww;
        g->clearance[l] = gap > 0 ? over : -1;
        const float px = s1 > s0 ? s->corner[1][0][l] : s->corner[0][0][l];
        const float py = s1 > s0 ? s->corner[1][1][l] : s->corner[0][1][l];
        const float pz = s1 > s0 ? s->corner[1][2][l] : s->corner[0][2][l];
        const float qx = b < a ? bx : ax;
        const float qy = b < a ? by : ay;
        const float qz = b < a ? bz : az;
        const float dx = ((c < ab ? cx : qx) - (s2 > s01 ? s->corner[2][0][l] : px)) - x;
        const float dy = ((c < ab ? cy : qy) - (s2 > s01 ? s->corner[2][1][l] : py)) - y;
        const float dz = ((c < ab ? cz : qz) - (s2 > s01 ? s->corner[2][2][l] : pz)) - z;
        const float along = -(x * dx + y * dy + z * dz);
        const float part = along / (dx * dx + dy * dy + dz * dz + 0x1p-100F);
        const float held = part < 1 ? part : 1;
        const float share = held > 0 ? held : 0;
        g->w[0][l] = x + share * dx;
        g->w[1][l] = y + share * dy;
        g->w[2][l] = z + share * dz;
    }
}

/* Steps of the search. Most pairs that are far apart are shown to be so by the first. */
#define STEPS 4

MOTE_CLONES
uint32_t mote_cert_near_pairs(const mote_cert_face_lanes *restrict s,
                              const mote_cert_face_lanes *restrict t, uint32_t undecided,
                              float need, const float loose[3])
{
    search g;
    for (size_t r = 0; r < 3; ++r) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < LANES; ++l)
            g.w[r][l] = ((t->corner[0][r][l] + t->corner[1][r][l] + t->corner[2][r][l]) -
                         (s->corner[0][r][l] + s->corner[1][r][l] + s->corner[2][r][l])) *
                        (1.0F / 3);
    }
    for (int i = 0; i < STEPS && undecided; ++i) {
        step(s, t, need, loose, &g);
        uint32_t far = 0;
        MOTE_LANE_LOOP
        for (size_t l = 0; l < LANES; ++l)
            far |= g.clearance[l] >= 0 ? 1u << l : 0;
        undecided &= ~far;
    }
    return undecided;
}

/* A normal whose square is below this is not used: times need squared it could be subnormal. A
   smaller need than 2^-27 is met wherever there is a gap beyond the error of the corners. */
#define SHORTEST_NORMAL_SQUARED 0x1p-60F

/* Whether lane l of both is at least the root of `enough` apart along the normal of s: >= 0. */
MOTE_INLINE float clear_of(const mote_cert_face_lanes *restrict s,
                           const mote_cert_face_lanes *restrict t, size_t l, float enough,
                           const float loose[3])
{
    const float ax = s->corner[0][0][l], ay = s->corner[0][1][l], az = s->corner[0][2][l];
    const float bx = s->corner[1][0][l] - ax, by = s->corner[1][1][l] - ay;
    const float bz = s->corner[1][2][l] - az, cx = s->corner[2][0][l] - ax;
    const float cy = s->corner[2][1][l] - ay, cz = s->corner[2][2][l] - az;
    const float x = by * cz - bz * cy;
    const float y = bz * cx - bx * cz;
    const float z = bx * cy - by * cx;
    const float s0 = ax * x + ay * y + az * z;
    const float s1 = s->corner[1][0][l] * x + s->corner[1][1][l] * y + s->corner[1][2][l] * z;
    const float s2 = s->corner[2][0][l] * x + s->corner[2][1][l] * y + s->corner[2][2][l] * z;
    const float t0 = t->corner[0][0][l] * x + t->corner[0][1][l] * y + t->corner[0][2][l] * z;
    const float t1 = t->corner[1][0][l] * x + t->corner[1][1][l] * y + t->corner[1][2][l] * z;
    const float t2 = t->corner[2][0][l] * x + t->corner[2][1][l] * y + t->corner[2][2][l] * z;
    const float s01 = s0 > s1 ? s0 : s1, s10 = s0 > s1 ? s1 : s0;
    const float t01 = t0 > t1 ? t0 : t1, t10 = t0 > t1 ? t1 : t0;
    const float s_most = s01 > s2 ? s01 : s2, s_least = s10 < s2 ? s10 : s2;
    const float t_most = t01 > t2 ? t01 : t2, t_least = t10 < t2 ? t10 : t2;
    const float above = t_least - s_most, below = s_least - t_most;
    const float slack = loose[0] * fabsf(x) + loose[1] * fabsf(y) + loose[2] * fabsf(z);
    const float gap = (above > below ? above : below) - slack;
    const float squared = x * x + y * y + z * z;
    const float over = gap * gap - enough * squared;
    const float used = squared >= SHORTEST_NORMAL_SQUARED ? over : -1;
    return gap > 0 ? used : -1;
}

MOTE_CLONES
uint32_t mote_cert_near_along_normals(const mote_cert_face_lanes *restrict s,
                                      const mote_cert_face_lanes *restrict t,
                                      uint32_t undecided, float need, const float loose[3])
{
    const float enough = need * need * (1 + 0x1p-18F);
    uint32_t far = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < LANES; ++l) {
        const float by_s = clear_of(s, t, l, enough, loose);
        const float by_t = clear_of(t, s, l, enough, loose);
        far |= (by_s > by_t ? by_s : by_t) >= 0 ? 1u << l : 0;
    }
    return undecided & ~far;
}
