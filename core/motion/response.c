#include "core/motion/response.h"

#include <float.h>

/* The square of a shorter normal would lose its digits. */
#define LEAST_NORMAL 1e-150

double mote_effective_mass(const mote_mass *mass, const mote_rigid_state *state, mote_vec3 arm,
                           mote_vec3 normal)
{
    const mote_mat3 axes = mote_rigid_axes(mass, state);
    const mote_vec3 l = mote_rotate_back(&axes, mote_cross(arm, normal));
    return mass->mass /
           (1 + mass->mass * (l.x * l.x / mass->inertia.x + l.y * l.y / mass->inertia.y +
                              l.z * l.z / mass->inertia.z));
}

double mote_velocity_along(const mote_mass *mass, const mote_rigid_state *state, mote_vec3 arm,
                           mote_vec3 normal)
{
    const mote_vec3 w = mote_rigid_angular_velocity(mass, state);
    return mote_dot(state->velocity, normal) + mote_dot(mote_cross(w, arm), normal);
}

/* Effective masses times the power of two that brings the larger to 1 .. 2, which this returns:
   products stay in range. */
static double scale_masses(const double effective_mass[2], double scaled[2])
{
    const double larger = fmax(effective_mass[0], effective_mass[1]);
    const double unit = ldexp(1, -ilogb(fmax(larger, DBL_MIN)));
    scaled[0] = effective_mass[0] * unit;
    scaled[1] = effective_mass[1] * unit;
    return unit;
}

/* The mass that resists a change of the relative velocity. */
static double reduced_mass(const double effective_mass[2])
{
    double m[2];
    const double unit = scale_masses(effective_mass, m);
    return m[0] * m[1] / (m[0] + m[1]) / unit;
}

void mote_pulses_after(const double effective_mass[2], const double pulse[2], double after[2])
{
    double m[2];
    (void)scale_masses(effective_mass, m);
    const double sum = m[0] + m[1];
    after[0] = ((m[0] - m[1]) * pulse[0] + 2 * m[0] * pulse[1]) / sum;
    after[1] = ((m[1] - m[0]) * pulse[1] + 2 * m[1] * pulse[0]) / sum;
}

void mote_apply_pulse(const mote_mass *mass, mote_vec3 arm, mote_vec3 pulse,
                      mote_rigid_state *state)
{
    state->velocity = mote_add_scaled(state->velocity, 1 / mass->mass, pulse);
    state->angular_momentum = mote_add(state->angular_momentum, mote_cross(arm, pulse));
}

mote_status mote_respond(const mote_mass *const mass[2], mote_vec3 point, mote_vec3 normal,
                         double restitution, mote_rigid_state *const state[2],
                         mote_impact *impact)
{
    return mote_respond_deforming(mass, point, normal, restitution, 0, state, impact);
}

mote_status mote_respond_deforming(const mote_mass *const mass[2], mote_vec3 point,
                                   mote_vec3 normal, double restitution, double own,
                                   mote_rigid_state *const state[2], mote_impact *impact)
{
    const double length = mote_length(normal);
    if (!(length >= LEAST_NORMAL) || !isfinite(length))
        return mote_fail(MOTE_EINVAL, "the normal of a collision has no direction");
    if (!(restitution >= 0 && restitution <= 1))
        return mote_fail(MOTE_EINVAL, "restitution %g; give a number from 0 to 1", restitution);
    if (!isfinite(mote_length(point)))
        return mote_fail(MOTE_EINVAL, "the point of a collision is not finite");
    if (!isfinite(own))
        return mote_fail(MOTE_EINVAL, "surfaces that close by %g; give a finite speed", own);
    const mote_vec3 n = mote_scale(normal, 1 / length);
    mote_vec3 arm[2];
    double effective[2], velocity[2], pulse[2], after[2];
    for (int i = 0; i < 2; ++i) {
        arm[i] = mote_sub(point, state[i]->centre);
        effective[i] = mote_effective_mass(mass[i], state[i], arm[i], n);
        velocity[i] = mote_velocity_along(mass[i], state[i], arm[i], n);
        pulse[i] = effective[i] * velocity[i];
    }
    mote_impact made = {.closing = velocity[0] - velocity[1]};
    made.approaching = made.closing + own > 0;
    if (made.approaching) {
        mote_pulses_after(effective, pulse, after);
        /* The two changes are opposite except for rounding; one is used for both bodies. */
        made.pulse = (1 + restitution) / 2 * (after[1] - pulse[1]);
        const double reduced = reduced_mass(effective);
        made.energy =
            (1 - restitution * restitution) / 2 * reduced * made.closing * made.closing;
        /* the impulse p = (1 + e) m (closing + own) takes p closing - p^2 / (2 m) in all */
        const double more = (1 + restitution) * reduced * own;
        made.pulse += more;
        made.energy += more * (made.closing - (1 + restitution) * (made.closing + own / 2));
        mote_apply_pulse(mass[0], arm[0], mote_scale(n, -made.pulse), state[0]);
        mote_apply_pulse(mass[1], arm[1], mote_scale(n, made.pulse), state[1]);
    }
    *impact = made;
    return MOTE_OK;
}
