/* Random rigid bodies in motion, for tests. */
#ifndef MOTE_TESTS_RIGID_BODIES_H
#define MOTE_TESTS_RIGID_BODIES_H

#include "core/motion/rigid_motion.h"

#include "tests/support/solids.h"

/* A solid of random mass, centre and main axes. Its main moments are those of some solid: each
   is at most the sum of the other two. */
static inline mote_mass random_mass(uint64_t *seed)
{
    mote_mass mass = {.volume = 1, .mass = exp(random_between(seed, -2, 2))};
    const double x = random_between(seed, 0.01, 1), y = random_between(seed, 0.01, 1);
    const double z = random_between(seed, 0.01, 1);
    mass.inertia = mote_scale(mote_vec3_make(y + z, z + x, x + y), mass.mass);
    mass.centre = random_vec3(seed, 1);
    mass.axes = random_rotation_matrix(seed);
    return mass;
}

static inline mote_rigid_state random_state(uint64_t *seed)
{
    mote_rigid_state state = {.centre = random_vec3(seed, 1), .velocity = random_vec3(seed, 1)};
    const mote_quaternion turn = {random_between(seed, 0.1, 1), random_between(seed, -1, 1),
                                  random_between(seed, -1, 1), random_between(seed, -1, 1)};
    state.turn = mote_quaternion_normalise(turn);
    state.angular_momentum = random_vec3(seed, 1);
    return state;
}

#endif
