#include "harness/loop/drift.h"

#include <math.h>

/* The conserved quantities, and the magnitudes that changes are relative to. */
typedef struct invariants {
    double energy, energy_size;
    mote_vec3 momentum, angular;
    double momentum_size, angular_size;
} invariants;

static invariants invariants_of(const mote_drift_bodies *bodies, const mote_drift_lost *lost,
                                double time)
{
    invariants sum = {.energy = lost->energy, .momentum = lost->momentum};
    for (uint32_t i = 0; i < bodies->count; ++i) {
        const mote_rigid_state *state = &bodies->states[i];
        const mote_mass *mass = &bodies->masses[bodies->shape_of[i]];
        const double m = mass->mass;
        const double kinetic = mote_rigid_kinetic_energy(mass, state);
        const mote_vec3 fallen = mote_sub(state->centre, bodies->start[i].centre);
        sum.energy_size += kinetic;
        sum.energy += kinetic - m * mote_dot(bodies->gravity, fallen);
        sum.momentum = mote_add_scaled(
            sum.momentum, m, mote_add_scaled(state->velocity, -time, bodies->gravity));
        sum.angular = mote_add(
            sum.angular, mote_add(mote_scale(mote_cross(state->centre, state->velocity), m),
                                  state->angular_momentum));
        sum.momentum_size += m * mote_length(state->velocity);
        sum.angular_size += m * mote_length(state->centre) * mote_length(state->velocity) +
                            mote_length(state->angular_momentum);
    }
    return sum;
}

static void note_change(double change, double size_now, double *size, double *largest)
{
    *size = fmax(*size, size_now);
    if (*size > 0)
        *largest = fmax(*largest, change / *size);
}

void mote_drift_note(mote_drift *drift, const mote_drift_bodies *bodies,
                     const mote_drift_lost *lost, double time)
{
    const invariants now = invariants_of(bodies, lost, time);
    if (!drift->begun) {
        drift->begun = true;
        drift->energy_first = now.energy;
        drift->momentum_first = now.momentum;
        drift->angular_first = now.angular;
    }
    note_change(fabs(now.energy - drift->energy_first), now.energy_size, &drift->energy_size,
                &drift->energy);
    note_change(mote_length(mote_sub(now.momentum, drift->momentum_first)), now.momentum_size,
                &drift->momentum_size, &drift->momentum);
    note_change(mote_length(mote_sub(now.angular, drift->angular_first)), now.angular_size,
                &drift->angular_size, &drift->angular);
}
