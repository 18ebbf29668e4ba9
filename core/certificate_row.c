/* One box against the eight of a block: the innermost test of the traversal. */
#include "core/certificate_state.h"
#include "core/clones.h"

#define WIDTH MOTE_CERT_WIDTH

MOTE_INLINE uint32_t bits_below(const float x[WIDTH], float limit)
{
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        bits |= x[l] < limit ? 1u << l : 0;
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
typedef struct single {
    float centre[3], axis[3][3], width[3], normal[3], thickness;
} single;

MOTE_INLINE void take(const mote_cert_node *d, size_t lane, single *b)
{
    for (size_t r = 0; r < 3; ++r) {
        b->centre[r] = d->centre[r][lane];
        b->width[r] = d->width[r][lane];
        b->normal[r] = d->normal[r][lane];
        for (size_t k = 0; k < 3; ++k)
            b->axis[k][r] = d->axis[k][r][lane];
    }
    b->thickness = d->thickness[lane];
}

/* The gap along the line of centres. */
MOTE_INLINE void along_centres(const single *restrict d, const mote_cert_node *restrict e,
                               float bound[WIDTH])
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        const float wx = e->centre[0][l] - d->centre[0];
        const float wy = e->centre[1][l] - d->centre[1];
        const float wz = e->centre[2][l] - d->centre[2];
        const float inverse = 1 / sqrtf(wx * wx + wy * wy + wz * wz + 0x1p-100F);
        const float x = wx * inverse;
        const float y = wy * inverse;
        const float z = wz * inverse;
        float half = fabsf(d->axis[0][0] * x + d->axis[0][1] * y + d->axis[0][2] * z) +
                     fabsf(d->axis[1][0] * x + d->axis[1][1] * y + d->axis[1][2] * z) +
                     fabsf(d->axis[2][0] * x + d->axis[2][1] * y + d->axis[2][2] * z);
        half += fabsf(e->axis[0][0][l] * x + e->axis[0][1][l] * y + e->axis[0][2][l] * z) +
                fabsf(e->axis[1][0][l] * x + e->axis[1][1][l] * y + e->axis[1][2][l] * z) +
                fabsf(e->axis[2][0][l] * x + e->axis[2][1][l] * y + e->axis[2][2][l] * z);
        half += (e->width[0][l] + d->width[0]) * fabsf(x) +
                (e->width[1][l] + d->width[1]) * fabsf(y) +
                (e->width[2][l] + d->width[2]) * fabsf(z);
        const float gap = (wx * x + wy * y + wz * z) - half;
        bound[l] = gap > bound[l] ? gap : bound[l];
    }
}

/* The gap along the thin direction of the one box. */
MOTE_INLINE void along_its_normal(const single *restrict d, const mote_cert_node *restrict e,
                                  float bound[WIDTH])
{
    const float x = d->normal[0];
    const float y = d->normal[1];
    const float z = d->normal[2];
    const float ax = fabsf(x);
    const float ay = fabsf(y);
    const float az = fabsf(z);
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        const float apart =
            fabsf((e->centre[0][l] - d->centre[0]) * x + (e->centre[1][l] - d->centre[1]) * y +
                  (e->centre[2][l] - d->centre[2]) * z);
        const float half =
            fabsf(e->axis[0][0][l] * x + e->axis[0][1][l] * y + e->axis[0][2][l] * z) +
            fabsf(e->axis[1][0][l] * x + e->axis[1][1][l] * y + e->axis[1][2][l] * z) +
            fabsf(e->axis[2][0][l] * x + e->axis[2][1][l] * y + e->axis[2][2][l] * z) +
            (e->width[0][l] * ax + e->width[1][l] * ay + e->width[2][l] * az);
        const float gap = apart - half - d->thickness;
        bound[l] = gap > bound[l] ? gap : bound[l];
    }
}

/* The gaps along the thin directions of the eight. */
MOTE_INLINE void along_their_normals(const single *restrict d, const mote_cert_node *restrict e,
                                     float bound[WIDTH])
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        const float x = e->normal[0][l];
        const float y = e->normal[1][l];
        const float z = e->normal[2][l];
        const float apart =
            fabsf((e->centre[0][l] - d->centre[0]) * x + (e->centre[1][l] - d->centre[1]) * y +
                  (e->centre[2][l] - d->centre[2]) * z);
        const float half =
            fabsf(d->axis[0][0] * x + d->axis[0][1] * y + d->axis[0][2] * z) +
            fabsf(d->axis[1][0] * x + d->axis[1][1] * y + d->axis[1][2] * z) +
            fabsf(d->axis[2][0] * x + d->axis[2][1] * y + d->axis[2][2] * z) +
            (d->width[0] * fabsf(x) + d->width[1] * fabsf(y) + d->width[2] * fabsf(z));
        const float gap = apart - half - e->thickness[l];
        bound[l] = gap > bound[l] ? gap : bound[l];
    }
}

MOTE_CLONES
uint32_t mote_cert_row_plane(const mote_cert_node *restrict d, size_t lane,
                             const mote_cert_node *restrict e, float need,
                             float bound[MOTE_CERT_WIDTH])
{
    uint32_t open = e->block->mask;
    if (d->clear >> lane & 1)
        open &= ~e->clear;
    along_plane(d->reach[lane], e, bound);
    return open & bits_below(bound, need);
}

MOTE_CLONES
uint32_t mote_cert_row_boxes(const mote_cert_node *restrict d, size_t lane,
                             const mote_cert_node *restrict e, float need, uint32_t open,
                             float bound[MOTE_CERT_WIDTH])
{
    single one;
    take(d, lane, &one);
    along_centres(&one, e, bound);
    along_its_normal(&one, e, bound);
    open &= bits_below(bound, need);
    if (open == 0)
        return 0;
    along_their_normals(&one, e, bound);
    return open & bits_below(bound, need);
}
