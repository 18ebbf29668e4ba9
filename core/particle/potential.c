#include "core/particle/potential.h"

#include <math.h>
#include <string.h>

/* A product of many factors in each lane: mantissa in [1, 2) times 2^exponent after
 * normalising. */
typedef struct product {
    double mantissa[MOTE_LANES];
    int64_t exponent[MOTE_LANES];
} product;

/* Exponent of a product that contains a zero: below every other. */
#define ZERO_EXPONENT (-((int64_t)1 << 40))
/* Factors between two normalisations: eight of 1e-38 are still a normal number. */
#define FACTORS 8

/* Squared distances of the candidates to one particle, in units of L, not above the cut. */
MOTE_INLINE void squared_distances(const mote_candidates *c, const mote_sources *sources,
                                   uint32_t j, double inverse, double cut,
                                   double out[MOTE_LANES])
{
    const double x = sources->x[j];
    const double y = sources->y[j];
    const double z = sources->z[j];
    MOTE_LANE_LOOP
    for (int l = 0; l < MOTE_LANES; ++l) {
        const double dx = c->x[l] - x;
        const double dy = c->y[l] - y;
        const double dz = c->z[l] - z;
        const double squared = (dx * dx + dy * dy + dz * dz) * inverse;
        out[l] = squared < cut ? squared : cut;
    }
}

/* A zero or subnormal mantissa (a coincident pair) marks the lane's product as zero. */
MOTE_INLINE void normalise(product *p)
{
    uint64_t bits[MOTE_LANES];
    memcpy(bits, p->mantissa, sizeof bits);
    MOTE_LANE_LOOP
    for (int l = 0; l < MOTE_LANES; ++l) {
        const int64_t field = (int64_t)(bits[l] >> 52);
        p->exponent[l] += field > 0 ? field - 1023 : ZERO_EXPONENT;
        bits[l] = (bits[l] & 0x000fffffffffffffu) | 0x3ff0000000000000u;
    }
    memcpy(p->mantissa, bits, sizeof bits);
}

MOTE_INLINE void multiply(const mote_candidates *c, const mote_sources *sources, uint32_t first,
                          uint32_t end, double inverse, double cut, product *p)
{
    for (uint32_t j = first; j < end; j += FACTORS) {
        const uint32_t stop = end - j < FACTORS ? end : j + FACTORS;
        for (uint32_t k = j; k < stop; ++k) {
            double factor[MOTE_LANES];
            squared_distances(c, sources, k, inverse, cut, factor);
            MOTE_LANE_LOOP
            for (int l = 0; l < MOTE_LANES; ++l)
                p->mantissa[l] *= factor[l];
        }
        normalise(p);
    }
}

MOTE_INLINE void product_over(const mote_candidates *c, const mote_sources *sources,
                              double inverse, double cut, product *p)
{
    MOTE_LANE_LOOP
    for (int l = 0; l < MOTE_LANES; ++l) {
        p->mantissa[l] = 1;
        p->exponent[l] = 0;
    }
    if (sources->skip < sources->count) {
        multiply(c, sources, 0, sources->skip, inverse, cut, p);
        multiply(c, sources, sources->skip + 1, sources->count, inverse, cut, p);
    } else {
        multiply(c, sources, 0, sources->count, inverse, cut, p);
    }
}

/* other / same as exponent and mantissa in [1, 2). */
MOTE_INLINE void ratio_of(const product *other, const product *same, mote_potentials *out)
{
    MOTE_LANE_LOOP
    for (int l = 0; l < MOTE_LANES; ++l) {
        const double ratio = other->mantissa[l] / same->mantissa[l];
        const bool low = ratio < 1;
        const double exponent = (double)(other->exponent[l] - same->exponent[l]);
        out->major[l] = low ? exponent - 1 : exponent;
        out->minor[l] = low ? ratio * 2 : ratio;
    }
    for (int l = 0; l < MOTE_LANES; ++l) {
        if (same->exponent[l] < ZERO_EXPONENT / 2) {
            out->major[l] = HUGE_VAL;
            out->minor[l] = 1; /* no occupied place is better than another */
        }
    }
}

MOTE_INLINE void log_sum(const product *p, double out[MOTE_LANES])
{
    for (int l = 0; l < MOTE_LANES; ++l)
        out[l] =
            p->exponent[l] < ZERO_EXPONENT / 2
                ? HUGE_VAL
                : -0.5 * (log(p->mantissa[l]) + 0.6931471805599453 * (double)p->exponent[l]);
}

MOTE_INLINE void add_inverse(const mote_candidates *c, const mote_sources *sources,
                             uint32_t first, uint32_t end, double inverse, double cut,
                             double out[MOTE_LANES])
{
    const bool square = sources->law == MOTE_LAW_INVERSE_SQUARE;
    for (uint32_t j = first; j < end; ++j) {
        double squared[MOTE_LANES];
        squared_distances(c, sources, j, inverse, cut, squared);
        MOTE_LANE_LOOP
        for (int l = 0; l < MOTE_LANES; ++l)
            out[l] += 1 / (square ? squared[l] : sqrt(squared[l]));
    }
}

/* The sum of one law's pair potentials (with the sign of repulsion). */
MOTE_INLINE void sum_over(const mote_candidates *c, const mote_sources *sources, double inverse,
                          double cut, double out[MOTE_LANES])
{
    if (sources->law == MOTE_LAW_LOG) {
        product p;
        product_over(c, sources, inverse, cut, &p);
        log_sum(&p, out);
        return;
    }
    memset(out, 0, MOTE_LANES * sizeof *out);
    if (sources->skip < sources->count) {
        add_inverse(c, sources, 0, sources->skip, inverse, cut, out);
        add_inverse(c, sources, sources->skip + 1, sources->count, inverse, cut, out);
    } else {
        add_inverse(c, sources, 0, sources->count, inverse, cut, out);
    }
}

MOTE_CLONES
void mote_potential(const mote_candidates *candidates, const mote_sources *same,
                    const mote_sources *other, double inverse_square_length,
                    double effective_radius_squared, mote_potentials *potentials)
{
    const mote_sources none = {.law = other->law};
    const mote_sources *attracting = effective_radius_squared > 0 ? other : &none;
    if (same->law == MOTE_LAW_LOG && other->law == MOTE_LAW_LOG) {
        product repulsion;
        product attraction;
        product_over(candidates, same, inverse_square_length, HUGE_VAL, &repulsion);
        product_over(candidates, attracting, inverse_square_length, effective_radius_squared,
                     &attraction);
        ratio_of(&attraction, &repulsion, potentials);
        return;
    }
    double attraction[MOTE_LANES];
    sum_over(candidates, same, inverse_square_length, HUGE_VAL, potentials->major);
    sum_over(candidates, attracting, inverse_square_length, effective_radius_squared,
             attraction);
    for (int l = 0; l < MOTE_LANES; ++l) {
        if (potentials->major[l] < HUGE_VAL) /* else both may be infinite */
            potentials->major[l] -= attraction[l];
        potentials->minor[l] = 0;
    }
}
