/* The potential of the forces on a particle at several candidate places at once (paper 3.3). */
#ifndef MOTE_CORE_POTENTIAL_H
#define MOTE_CORE_POTENTIAL_H

#include "core/base/clones.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Potential of one pair at distance r (in units of L); repulsion with this sign, attraction
   with the opposite one. As printed in the paper, F = f(r) r_vec with f = 1/r^2 is a force of
   size 1/r: the log law. */
typedef enum mote_law {
    MOTE_LAW_LOG,           /* -log r */
    MOTE_LAW_INVERSE,       /* 1 / r */
    MOTE_LAW_INVERSE_SQUARE /* 1 / r^2 */
} mote_law;

/* Candidate places by coordinate, one a lane. */
typedef struct mote_candidates {
    double x[MOTE_LANES], y[MOTE_LANES], z[MOTE_LANES];
} mote_candidates;

/* Particles of one type that exert a force: count places by coordinate. The one at index skip
   (the particle that is being moved, or count for none) does not act. */
typedef struct mote_sources {
    const double *x, *y, *z;
    uint32_t count, skip;
    mote_law law;
} mote_sources;

/* A potential that is compared first by major, then by minor. With the log law on both sides
   the potential is half the logarithm of (product of squared distances to the other type) over
   (the same to the same type), each divided by L^2; it is kept as exponent (major) and mantissa
   (minor) of that ratio, since products of hundreds of factors leave the range of a double.
   Otherwise major is the potential itself and minor is 0. */
typedef struct mote_potentials {
    double major[MOTE_LANES], minor[MOTE_LANES];
} mote_potentials;

/* Potentials of a particle at the candidates: repelled by same, attracted by other within the
   effective radius. inverse_square_length: 1 / L^2. effective_radius_squared: (R_eff / L)^2
   (paper 3.3), beyond which the attraction's potential is constant; 0: no attraction; INFINITY
   is allowed. A place on a
   particle of the same type has potential +infinity, whatever else is there. */
void mote_potential(const mote_candidates *candidates, const mote_sources *same,
                    const mote_sources *other, double inverse_square_length,
                    double effective_radius_squared, mote_potentials *potentials);

static inline bool mote_potential_below(const mote_potentials *p, int a, int b)
{
    return p->major[a] < p->major[b] ||
           (p->major[a] == p->major[b] && p->minor[a] < p->minor[b]);
}

#ifdef __cplusplus
}
#endif
#endif
