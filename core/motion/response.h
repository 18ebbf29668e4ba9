/* The response of two rigid bodies that collide at one point (paper section 4): effective mass,
   effective impulse, impulses after the collision, changes of velocity and angular velocity.
   "Impulse" is the paper's "pulse".

   The sign. The paper prints the effective impulse with a minus, p = -n m_e v with v = (V, n) +
   ([w x r], n), and the applied impulse as the change dp = p' - p. Together, these triple the
   relative velocity of the contact points, and the energy grows. With p = + n m_e v everything
   else as printed holds: dp_1 = -2 (v_1 - v_2) n / (1 / m_e1 + 1 / m_e2) = -dp_2 keeps
   momentum, angular momentum and energy, and the relative velocity along n is reversed. This
   reading is used (tests/unit/core/motion/test_response.c shows both). The change
   w' = w + L_c / I_c is right as printed. */
#ifndef MOTE_CORE_RESPONSE_H
#define MOTE_CORE_RESPONSE_H

#include "core/motion/rigid_motion.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* m / (1 + m l_x^2 / I_x + m l_y^2 / I_y + m l_z^2 / I_z), l = r x n in the principal axes: the
   mass with which the body resists an impulse along n (unit) at arm r (from its centre); world
   axes. In (0, m]. */
double mote_effective_mass(const mote_mass *mass, const mote_rigid_state *state, mote_vec3 arm,
                           mote_vec3 normal);

/* (V, n) + ([w x r], n): the velocity along n of the body's point at arm r; world axes. */
double mote_velocity_along(const mote_mass *mass, const mote_rigid_state *state, mote_vec3 arm,
                           mote_vec3 normal);

/* The impulses along one normal after the collision of effective masses m_e with impulses p, as
   printed: p_1' = ((m_e1 - m_e2) p_1 + 2 m_e1 p_2) / (m_e1 + m_e2), and p_2' likewise. */
void mote_pulses_after(const double effective_mass[2], const double pulse[2], double after[2]);

/* Applies an impulse at the body's point at arm: changes its velocity and angular momentum;
   world axes. */
void mote_apply_pulse(const mote_mass *mass, mote_vec3 arm, mote_vec3 pulse,
                      mote_rigid_state *state);

/* What a collision did. */
typedef struct mote_impact {
    bool approaching; /* false: the points move apart or not at all, and nothing changed */
    double closing;   /* v_1 - v_2 before: the speed at which the gap closes */
    double pulse;  /* the impulse that body 1 gained along the normal and body 0 lost, >= 0 */
    double energy; /* kinetic energy lost by restitution below 1, >= 0 */
} mote_impact;

/* Lets bodies 0 and 1 collide at a point (world) if they approach each other there. normal:
   from body 0 to body 1, of any length from 1e-150 on. restitution e: from 0 (none of the
   closing speed comes back) to 1 (all of it); the impulse is (1 + e) / 2 of the elastic one.
   MOTE_EINVAL: a normal or point whose squared length is no double, a shorter normal, a
   restitution out of range. The states are then unchanged. Masses and states are not checked.
   No allocation. */
mote_status mote_respond(const mote_mass *const mass[2], mote_vec3 point, mote_vec3 normal,
                         double restitution, mote_rigid_state *const state[2],
                         mote_impact *impact);

/* The same for surfaces that also move against their bodies: `own` is the speed at which they
   close the gap by their deformation, or by whatever else the states do not say. The points
   then approach if closing + own > 0, and the impulse is that for this speed. impact->energy is
   what the bodies lost in all; below 0 where the surfaces did work on them. MOTE_EINVAL also if
   own is not finite. */
mote_status mote_respond_deforming(const mote_mass *const mass[2], mote_vec3 point,
                                   mote_vec3 normal, double restitution, double own,
                                   mote_rigid_state *const state[2], mote_impact *impact);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
