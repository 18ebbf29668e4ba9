/* Free motion of a rigid body: where it is, how it moves, and a step in time.

   The state keeps the angular momentum in world axes, which only an impact changes. The angular
   velocity follows from it: w = R I^-1 R^T L, where R rotates principal axes to world axes. */
#ifndef MOTE_CORE_RIGID_MOTION_H
#define MOTE_CORE_RIGID_MOTION_H

#include "core/body/mass.h"
#include "core/base/quaternion.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* All in world axes. Units: the mesh's unit of length, the density's unit of mass, any unit of
   time. */
typedef struct mote_rigid_state {
    mote_vec3 centre;           /* of mass */
    mote_vec3 velocity;         /* of the centre */
    mote_quaternion turn;       /* rotates rest axes to world axes; of length 1 */
    mote_vec3 angular_momentum; /* about the centre */
} mote_rigid_state;

/* The pose that moves rest points: rotation x + translation. */
mote_pose mote_rigid_pose(const mote_mass *mass, const mote_rigid_state *state);

/* The principal axes in the world: the columns of a rotation. */
mote_mat3 mote_rigid_axes(const mote_mass *mass, const mote_rigid_state *state);

/* Angular velocity in world axes, from the angular momentum, and the reverse. */
mote_vec3 mote_rigid_angular_velocity(const mote_mass *mass, const mote_rigid_state *state);
mote_vec3 mote_rigid_angular_momentum(const mote_mass *mass, const mote_rigid_state *state,
                                      mote_vec3 angular_velocity);

/* m V^2 / 2 + (L, w) / 2. */
double mote_rigid_kinetic_energy(const mote_mass *mass, const mote_rigid_state *state);

/* Advances the state by a time step > 0 under a constant acceleration of gravity (zero: none).
   The rotation is the implicit midpoint rule of Euler's equations with the Cayley map, which
   keeps angular momentum and energy to rounding at any step for which its fixed-point iteration
   converges: |w| step below about 1; beyond that the energy drifts. The error of the
   orientation is of second order. The path of the centre is exact. MOTE_EINVAL for a step that
   is not above 0 and finite, or after which a number of the state would not be finite: where
   the place or velocity leaves the range of doubles, or |w| step is above some 1e153, whose
   square does. The state then stays as it is. No allocation. */
mote_status mote_rigid_step(const mote_mass *mass, mote_vec3 gravity, double step,
                            mote_rigid_state *state);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
