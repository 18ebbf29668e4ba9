/* Faces of two leaves: which pairs of them may be near. */
#include "core/certificate_state.h"
#include "core/clones.h"

#include <string.h>

#define WIDTH MOTE_CERT_LEAF_TRIANGLES

void mote_cert_take_faces(const mote_cert_tree *tree, const mote_cert_leaf *leaf,
                          const mote_cert_hull *hull, mote_cert_faces *faces)
{
    const size_t lanes = (leaf->triangle_count + 7u) / 8 * 8;
    for (size_t i = 0; i < lanes; ++i) {
        const size_t l = i < leaf->triangle_count ? i : leaf->triangle_count - 1u;
        const uint8_t *places = tree->corners[leaf->first_corner + l];
        for (size_t k = 0; k < 3; ++k) {
            for (size_t r = 0; r < 3; ++r)
                faces->corner[k][r][i] = hull->x[r][places[k]];
        }
    }
    faces->lanes = lanes;
    faces->mask = 0xffffffffu >> (32u - leaf->triangle_count);
}

/* The largest of the projections of a face's corners on a direction. */
MOTE_CLONES
void mote_cert_reach_faces(const mote_cert_faces *restrict faces, const float direction[3],
                           mote_cert_reaches *restrict reaches)
{
    const float x = direction[0];
    const float y = direction[1];
    const float z = direction[2];
    float farthest[8];
    for (size_t g = 0; g < faces->lanes; g += 8) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < 8; ++l) {
            const float a = faces->corner[0][0][g + l] * x + faces->corner[0][1][g + l] * y +
                            faces->corner[0][2][g + l] * z;
            const float b = faces->corner[1][0][g + l] * x + faces->corner[1][1][g + l] * y +
                            faces->corner[1][2][g + l] * z;
            const float c = faces->corner[2][0][g + l] * x + faces->corner[2][1][g + l] * y +
                            faces->corner[2][2][g + l] * z;
            const float ab = a > b ? a : b;
            reaches->reach[g + l] = ab > c ? ab : c;
        }
    }
    memcpy(farthest, reaches->reach, sizeof farthest);
    for (size_t g = 8; g < faces->lanes; g += 8) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < 8; ++l)
            farthest[l] =
                farthest[l] > reaches->reach[g + l] ? farthest[l] : reaches->reach[g + l];
    }
    float most = farthest[0];
    for (size_t l = 1; l < 8; ++l)
        most = farthest[l] > most ? farthest[l] : most;
    reaches->lanes = faces->lanes;
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

/* What a step of the search for the nearest points of two triangles knows, in lanes. */
typedef struct search {
    float w[3][8];      /* the difference of a point on each */
    float clearance[8]; /* >= 0: the pair is far */
} search;

/* Projects both triangles on w, and moves w towards the difference of the corners that are
   nearest to each other along it: Gilbert's search for the least difference. The gap of the
   projections, less what the corners may be off, is at most |w| times the distance. */
MOTE_INLINE void step(const mote_cert_face_pairs *restrict p, float need, const float loose[3],
                      search *restrict g)
{
    const float enough = need * need * (1 + 0x1p-18F);
    MOTE_LANE_LOOP
    for (size_t l = 0; l < 8; ++l) {
        const float x = g->w[0][l];
        const float y = g->w[1][l];
        const float z = g->w[2][l];
        const float ax = p->t[0][0][l], ay = p->t[0][1][l], az = p->t[0][2][l];
        const float bx = p->t[1][0][l], by = p->t[1][1][l], bz = p->t[1][2][l];
        const float cx = p->t[2][0][l], cy = p->t[2][1][l], cz = p->t[2][2][l];
        const float s0 = p->s[0][0][l] * x + p->s[0][1][l] * y + p->s[0][2][l] * z;
        const float s1 = p->s[1][0][l] * x + p->s[1][1][l] * y + p->s[1][2][l] * z;
        const float s2 = p->s[2][0][l] * x + p->s[2][1][l] * y + p->s[2][2][l] * z;
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
        const float px = s1 > s0 ? p->s[1][0][l] : p->s[0][0][l];
        const float py = s1 > s0 ? p->s[1][1][l] : p->s[0][1][l];
        const float pz = s1 > s0 ? p->s[1][2][l] : p->s[0][2][l];
        const float qx = b < a ? bx : ax;
        const float qy = b < a ? by : ay;
        const float qz = b < a ? bz : az;
        const float dx = ((c < ab ? cx : qx) - (s2 > s01 ? p->s[2][0][l] : px)) - x;
        const float dy = ((c < ab ? cy : qy) - (s2 > s01 ? p->s[2][1][l] : py)) - y;
        const float dz = ((c < ab ? cz : qz) - (s2 > s01 ? p->s[2][2][l] : pz)) - z;
        const float along = -(x * dx + y * dy + z * dz);
        const float part = along / (dx * dx + dy * dy + dz * dz + 0x1p-100F);
        const float held = part < 1 ? part : 1;
        const float share = held > 0 ? held : 0;
        g->w[0][l] = x + share * dx;
        g->w[1][l] = y + share * dy;
        g->w[2][l] = z + share * dz;
    }
}

/* Steps of the search: most pairs that are far are shown to be by the first. */
#define STEPS 4

MOTE_CLONES
uint32_t mote_cert_near_pairs(const mote_cert_face_pairs *restrict p, float need,
                              const float loose[3])
{
    search g;
    for (size_t r = 0; r < 3; ++r) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < 8; ++l)
            g.w[r][l] = ((p->t[0][r][l] + p->t[1][r][l] + p->t[2][r][l]) -
                         (p->s[0][r][l] + p->s[1][r][l] + p->s[2][r][l])) *
                        (1.0F / 3);
    }
    uint32_t open = (1u << p->count) - 1;
    for (int i = 0; i < STEPS && open; ++i) {
        step(p, need, loose, &g);
        uint32_t far = 0;
        MOTE_LANE_LOOP
        for (size_t l = 0; l < 8; ++l)
            far |= g.clearance[l] >= 0 ? 1u << l : 0;
        open &= ~far;
    }
    return open;
}
