#include "core/motion/rigid_motion.h"

#include <float.h>

/* The iteration gains a factor of |w| step / 2 each time. */
#define MOST_ITERATIONS 60

mote_pose mote_rigid_pose(const mote_mass *mass, const mote_rigid_state *state)
{
    mote_pose pose = {mote_quaternion_matrix(state->turn), {0, 0, 0}};
    pose.translation = mote_sub(state->centre, mote_rotate(&pose.rotation, mass->centre));
    return pose;
}

mote_mat3 mote_rigid_axes(const mote_mass *mass, const mote_rigid_state *state)
{
    const mote_mat3 turn = mote_quaternion_matrix(state->turn);
    mote_mat3 axes;
    for (int k = 0; k < 3; ++k) {
        const mote_vec3 column = mote_rotate(
            &turn, mote_vec3_make(mass->axes.m[0][k], mass->axes.m[1][k], mass->axes.m[2][k]));
        axes.m[0][k] = column.x;
        axes.m[1][k] = column.y;
        axes.m[2][k] = column.z;
    }
    return axes;
}

static mote_vec3 divide(mote_vec3 a, mote_vec3 b)
{
    return mote_vec3_make(a.x / b.x, a.y / b.y, a.z / b.z);
}

mote_vec3 mote_rigid_angular_velocity(const mote_mass *mass, const mote_rigid_state *state)
{
    const mote_mat3 axes = mote_rigid_axes(mass, state);
    const mote_vec3 main = mote_rotate_back(&axes, state->angular_momentum);
    return mote_rotate(&axes, divide(main, mass->inertia));
}

mote_vec3 mote_rigid_angular_momentum(const mote_mass *mass, const mote_rigid_state *state,
                                      mote_vec3 angular_velocity)
{
    const mote_mat3 axes = mote_rigid_axes(mass, state);
    const mote_vec3 w = mote_rotate_back(&axes, angular_velocity);
    return mote_rotate(&axes, mote_vec3_make(w.x * mass->inertia.x, w.y * mass->inertia.y,
                                             w.z * mass->inertia.z));
}

double mote_rigid_kinetic_energy(const mote_mass *mass, const mote_rigid_state *state)
{
    const mote_vec3 w = mote_rigid_angular_velocity(mass, state);
    return mass->mass * mote_length_squared(state->velocity) / 2 +
           mote_dot(state->angular_momentum, w) / 2;
}

/* The power of two that brings a size to 1 .. 2; 1 for a size of 0. */
static double unit_of(double size)
{
    return size > 0 ? ldexp(1, -ilogb(fmax(size, DBL_MIN))) : 1;
}

/* The rotation of a step in principal axes: Cayley's map of w step for the angular velocity at
   the midpoint, w = I^-1 (m + m') / 2, where m' is m in the rotated axes. Then m' - m = step
   (m + m') / 2 x w: the midpoint rule for Euler's equations, which preserves their two
   quadratic invariants and the angular momentum in the world. */
static mote_quaternion turn_of_step(const mote_mass *mass, mote_vec3 momentum, double step)
{
    /* Momentum and inertia times a power of two: squares of the momentum stay in range. */
    const double unit = unit_of(mote_largest_coordinate(momentum));
    const mote_vec3 m = mote_scale(momentum, unit), inertia = mote_scale(mass->inertia, unit);
    const double close = 4 * DBL_EPSILON * DBL_EPSILON * mote_length_squared(m);
    mote_quaternion turn = {1, 0, 0, 0};
    mote_vec3 after = m;
    for (int i = 0; i < MOST_ITERATIONS; ++i) {
        const mote_vec3 half = mote_scale(divide(mote_add(m, after), inertia), step / 4);
        const mote_quaternion cayley = {1, half.x, half.y, half.z};
        turn = mote_quaternion_normalise(cayley);
        const mote_mat3 matrix = mote_quaternion_matrix(turn);
        const mote_vec3 next = mote_rotate_back(&matrix, m);
        const bool settled = mote_distance_squared(next, after) <= close;
        after = next;
        if (settled)
            break;
    }
    return turn;
}

static bool is_finite(const mote_rigid_state *state)
{
    const mote_quaternion q = state->turn;
    return isfinite(q.w) && mote_is_finite(mote_vec3_make(q.x, q.y, q.z)) &&
           mote_is_finite(state->centre) && mote_is_finite(state->velocity);
}

mote_status mote_rigid_step(const mote_mass *mass, mote_vec3 gravity, double step,
                            mote_rigid_state *state)
{
    if (!(step > 0) || !isfinite(step))
        return mote_fail(MOTE_EINVAL, "a time step of %g; give a number above 0", step);
    const mote_mat3 axes = mote_rigid_axes(mass, state);
    const mote_quaternion main =
        turn_of_step(mass, mote_rotate_back(&axes, state->angular_momentum), step);
    /* The same rotation about world axes. */
    const mote_vec3 world = mote_rotate(&axes, mote_vec3_make(main.x, main.y, main.z));
    const mote_quaternion turn = {main.w, world.x, world.y, world.z};
    mote_rigid_state next = *state;
    next.turn = mote_quaternion_normalise(mote_quaternion_multiply(turn, state->turn));
    next.velocity = mote_add_scaled(state->velocity, step, gravity);
    next.centre =
        mote_add_scaled(state->centre, step / 2, mote_add(state->velocity, next.velocity));
    if (!is_finite(&next))
        return mote_fail(
            MOTE_EINVAL,
            "a time step of %g: after it the body's rotation, place or velocity is "
            "not finite; give a shorter one",
            step);
    *state = next;
    return MOTE_OK;
}
