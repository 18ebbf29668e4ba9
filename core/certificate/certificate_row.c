/* One box against the eight of a block: the innermost test of the traversal. */
#include "core/certificate/certificate_state.h"
#include "core/base/clones.h"

#define WIDTH MOTE_CERT_WIDTH

MOTE_INLINE uint32_t bits_below(const float x[WIDTH], float limit)
{
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        bits |= x[l] < limit ? 1u << l : 0;
    return bits;
}

/* A NaN is not at least anything: it never rules a pair out. */
MOTE_INLINE uint32_t bits_at_least(const float x[WIDTH], float limit)
{
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        bits |= x[l] >= limit ? 1u << l : 0;
    return bits;
}

/* The gap along the plane's normal. */
MOTE_INLINE void along_plane(float reach, const mote_cert_node *restrict e, float bound[WIDTH])
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        bound[l] = -(reach + e->reach[l]);
}

/* One box, by value. */
typedef struct one_box {
    float centre[3], axis[3][3], width[3];
} one_box;

MOTE_INLINE void load_box(const mote_cert_node *d, size_t lane, one_box *b)
{
    for (size_t r = 0; r < 3; ++r) {
        b->centre[r] = d->centre[r][lane];
        b->width[r] = d->width[r][lane];
        for (size_t k = 0; k < 3; ++k)
            b->axis[k][r] = d->axis[k][r][lane];
    }
}

/* The gap along the line of centres; returns the lanes that it does not show to be at least
   `need` apart. The line is not divided by its length, so that the decision need not wait for a
   square root and then a division. Testing the boxes' thin axes as well was measured: it saves
   3 % of the rows of small meshes and 20 % of those of a million triangles, but takes as much
   time as it saves there, and more elsewhere. */
MOTE_INLINE uint32_t along_centres(const one_box *restrict d, const mote_cert_node *restrict e,
                                   float need, float bound[WIDTH])
{
    float short_of[WIDTH];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        const float x = e->centre[0][l] - d->centre[0];
        const float y = e->centre[1][l] - d->centre[1];
        const float z = e->centre[2][l] - d->centre[2];
        const float squared = x * x + y * y + z * z;
        const float length = sqrtf(squared + 0x1p-100F);
        float half = fabsf(d->axis[0][0] * x + d->axis[0][1] * y + d->axis[0][2] * z) +
                     fabsf(d->axis[1][0] * x + d->axis[1][1] * y + d->axis[1][2] * z) +
                     fabsf(d->axis[2][0] * x + d->axis[2][1] * y + d->axis[2][2] * z);
        half += fabsf(e->axis[0][0][l] * x + e->axis[0][1][l] * y + e->axis[0][2][l] * z) +
                fabsf(e->axis[1][0][l] * x + e->axis[1][1][l] * y + e->axis[1][2][l] * z) +
                fabsf(e->axis[2][0][l] * x + e->axis[2][1][l] * y + e->axis[2][2][l] * z);
        half += (e->width[0][l] + d->width[0]) * fabsf(x) +
                (e->width[1][l] + d->width[1]) * fabsf(y) +
                (e->width[2][l] + d->width[2]) * fabsf(z);
        const float gap = (squared - half) * (1 - 0x1p-21F);
        const float along = gap / length;
        short_of[l] = need * length - gap;
        bound[l] = along > bound[l] ? along : bound[l];
    }
    return ~bits_below(short_of, 0); /* a NaN counts as not far enough */
}

MOTE_CLONES
uint32_t mote_cert_row_plane(const mote_cert_node *restrict d, size_t lane,
                             const mote_cert_node *restrict e, float need,
                             float bound[MOTE_CERT_WIDTH])
{
    uint32_t undecided = e->block->mask;
    if (d->clear >> lane & 1)
        undecided &= ~e->clear;
    along_plane(d->reach[lane], e, bound);
    return undecided & ~bits_at_least(bound, need);
}

MOTE_CLONES
uint32_t mote_cert_row_boxes(const mote_cert_node *restrict d, size_t lane,
                             const mote_cert_node *restrict e, float need, uint32_t undecided,
                             float bound[MOTE_CERT_WIDTH])
{
    one_box one;
    load_box(d, lane, &one);
    return undecided & along_centres(&one, e, need, bound);
}

/* The distance of boxes along the coordinates' axes is that of their gaps. A gap is rounded
   once, which the margins of both ends cover. */
MOTE_CLONES
uint32_t mote_cert_row_spans(const mote_cert_node *restrict d, size_t lane,
                             const mote_cert_node *restrict e, float need, uint32_t undecided,
                             float bound[MOTE_CERT_WIDTH])
{
    float low[3], high[3], apart[WIDTH];
    for (size_t r = 0; r < 3; ++r) {
        low[r] = d->low[r][lane];
        high[r] = d->high[r][lane];
    }
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        float squared = 0;
        for (size_t r = 0; r < 3; ++r) {
            const float above = e->low[r][l] - high[r];
            const float below = low[r] - e->high[r][l];
            const float gap = above > below ? above : below;
            squared += gap > 0 ? gap * gap : 0;
        }
        apart[l] = sqrtf(squared) * (1 - 0x1p-21F);
        bound[l] = apart[l] > bound[l] ? apart[l] : bound[l];
    }
    return undecided & ~bits_at_least(bound, need);
}
