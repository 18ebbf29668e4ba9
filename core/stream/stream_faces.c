/* The boxes of two leaves' faces, which pairs of them are near each other, and their normals.
 */
#include "core/stream/stream_state.h"

#include "core/base/clones.h"

#include <float.h>
#include <math.h>

#define LEAF MOTE_STREAM_LEAF

/* Faces that are tested side by side: as many floats as the widest vectors hold. */
#define HALF (LEAF / 2)

MOTE_CLONES
static void box_faces(const uint8_t (*restrict corners)[3], size_t faces,
                      mote_stream_slot *restrict slot)
{
    for (size_t k = 0; k < 3; ++k) {
        const float *x = slot->x[k];
        for (size_t i = 0; i < faces; ++i) {
            const float a = x[corners[i][0]];
            const float b = x[corners[i][1]];
            const float c = x[corners[i][2]];
            const float least = a < b ? a : b;
            const float most = a > b ? a : b;
            slot->face_low[k][i] = least < c ? least : c;
            slot->face_high[k][i] = most > c ? most : c;
        }
        for (size_t i = faces; i < LEAF; ++i) {
            slot->face_low[k][i] = HUGE_VALF;
            slot->face_high[k][i] = -HUGE_VALF;
        }
    }
}

MOTE_INLINE float squared_distance(const float low[3], const float high[3],
                                   const mote_stream_slot *restrict of, size_t i)
{
    const float x0 = of->face_low[0][i] - high[0], x1 = low[0] - of->face_high[0][i];
    const float y0 = of->face_low[1][i] - high[1], y1 = low[1] - of->face_high[1][i];
    const float z0 = of->face_low[2][i] - high[2], z1 = low[2] - of->face_high[2][i];
    const float x01 = x0 > x1 ? x0 : x1, x = x01 > 0 ? x01 : 0;
    const float y01 = y0 > y1 ? y0 : y1, y = y01 > 0 ? y01 : 0;
    const float z01 = z0 > z1 ? z0 : z1, z = z01 > 0 ? z01 : 0;
    return x * x + y * y + z * z;
}

/* Bit i: face i of a leaf is nearer to a box than the root of `squared`. */
MOTE_INLINE uint32_t faces_near(const float low[3], const float high[3],
                                const mote_stream_slot *restrict of, float squared)
{
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < HALF; ++l) {
        const uint32_t first = squared_distance(low, high, of, l) < squared ? 1u << l : 0;
        const uint32_t second =
            squared_distance(low, high, of, l + HALF) < squared ? 1u << l << HALF : 0;
        bits |= first | second;
    }
    return bits;
}

MOTE_CLONES
static uint32_t pairs_near(const mote_stream_slot *restrict a,
                           const mote_stream_slot *restrict b, float squared,
                           mote_cert_near *restrict near)
{
    uint32_t count = 0;
    near->used = 0;
    const uint32_t second = faces_near(a->low, a->high, b, squared);
    if (!second)
        return 0;
    for (uint32_t first = faces_near(b->low, b->high, a, squared); first; first &= first - 1) {
        const size_t i = mote_lowest_bit(first);
        float low[3], high[3];
        for (size_t k = 0; k < 3; ++k) {
            low[k] = a->face_low[k][i];
            high[k] = a->face_high[k][i];
        }
        near->undecided[i] = second & faces_near(low, high, b, squared);
        near->used |= near->undecided[i] ? 1u << i : 0;
        count += mote_bit_count(near->undecided[i]);
    }
    return count;
}

/* Twice the faces' area vectors, added up. Their products overflow where the positions are 10^9
   times as far apart as L. */
MOTE_CLONES
static void add_normals(const uint8_t (*restrict corners)[3], size_t faces,
                        mote_stream_slot *restrict slot)
{
    const float *x = slot->x[0], *y = slot->x[1], *z = slot->x[2];
    float normal[3] = {0, 0, 0};
    for (size_t i = 0; i < faces; ++i) {
        const size_t a = corners[i][0], b = corners[i][1], c = corners[i][2];
        const float bx = x[b] - x[a], by = y[b] - y[a], bz = z[b] - z[a];
        const float cx = x[c] - x[a], cy = y[c] - y[a], cz = z[c] - z[a];
        normal[0] += by * cz - bz * cy;
        normal[1] += bz * cx - bx * cz;
        normal[2] += bx * cy - by * cx;
    }
    /* of a length that neither overflows nor vanishes in sums along it; 0 where it may */
    const float x_size = fabsf(normal[0]), y_size = fabsf(normal[1]), z_size = fabsf(normal[2]);
    const float xy = x_size > y_size ? x_size : y_size, size = xy > z_size ? xy : z_size;
    const bool usable = x_size + y_size + z_size <= FLT_MAX && size >= FLT_MIN;
    for (size_t k = 0; k < 3; ++k)
        slot->normal[k] = usable ? normal[k] / size : 0;
}

const float *mote_stream_normal(const mote_stream_search *s, int side, mote_stream_slot *slot)
{
    const mote_stream_tree *tree = s->side[side].body->tree;
    if (!slot->averaged)
        add_normals((const uint8_t(*)[3])tree->corners + (size_t)slot->leaf * LEAF,
                    mote_stream_leaf_faces(tree, slot->leaf), slot);
    slot->averaged = true;
    return slot->normal;
}

uint32_t mote_stream_near_faces(const mote_stream_search *s, mote_stream_slot *const slot[2],
                                mote_cert_near *near)
{
    for (int k = 0; k < 2; ++k) {
        if (slot[k]->boxed)
            continue;
        const mote_stream_tree *tree = s->side[k].body->tree;
        box_faces((const uint8_t(*)[3])tree->corners + (size_t)slot[k]->leaf * LEAF,
                  mote_stream_leaf_faces(tree, slot[k]->leaf), slot[k]);
        slot[k]->boxed = true;
    }
    return pairs_near(slot[0], slot[1], s->squared, near);
}
