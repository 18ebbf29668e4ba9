/* Free motion against closed forms, conservation laws and a finer independent integration. */
#include "core/motion/rigid_motion.h"

#include "tests/support/rigid_bodies.h"
#include "tests/support/test.h"

static const mote_vec3 nothing = {0, 0, 0};

static mote_mass top_of(double x, double y, double z)
{
    return (mote_mass){.volume = 1,
                       .mass = 2,
                       .inertia = {x, y, z},
                       .axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
}

static void steps(const mote_mass *mass, mote_vec3 gravity, double step, int count,
                  mote_rigid_state *state)
{
    for (int i = 0; i < count; ++i)
        assert_int_equal(mote_rigid_step(mass, gravity, step, state), MOTE_OK);
}

TEST(rigid_step_free_body_conserves_energy_and_length)
{
    uint64_t seed = 3;
    double worst = 0;
    for (int body = 0; body < 20; ++body) {
        const mote_mass mass = random_mass(&seed);
        mote_rigid_state s = random_state(&seed);
        const double speed = mote_length(mote_rigid_angular_velocity(&mass, &s));
        const double energy = mote_rigid_kinetic_energy(&mass, &s);
        const mote_vec3 momentum = s.angular_momentum;
        steps(&mass, nothing, 0.1 / speed, 10000, &s);
        worst = fmax(worst, fabs(mote_rigid_kinetic_energy(&mass, &s) / energy - 1));
        assert_memory_equal(&momentum, &s.angular_momentum, sizeof momentum);
        const mote_quaternion q = s.turn;
        assert_close(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-15);
    }
    print_message("energy after 10,000 free steps: within %.2g\n", worst);
    assert_true(worst < 1e-11);
}

/* Momentum and inertia of bodies so small or so large that the square of the momentum is no
   number: the same turns, to the last bit. */
TEST(rigid_step_at_every_size_turns_the_same)
{
    static const int powers[] = {-1000, -600, -520, 500, 600, 1000};
    const mote_mass usual = top_of(1, 2, 2.5);
    for (size_t i = 0; i < ROWS_OF(powers); ++i) {
        mote_mass mass = usual;
        mote_rigid_state s = {.turn = {1, 0, 0, 0}, .angular_momentum = {1, 0.4, 0.25}};
        mote_rigid_state scaled = s;
        test_row("times 2^%d", powers[i]);
        mass.inertia = mote_scale(usual.inertia, ldexp(1, powers[i]));
        scaled.angular_momentum = mote_scale(s.angular_momentum, ldexp(1, powers[i]));
        steps(&usual, nothing, 0.05, 200, &s);
        steps(&mass, nothing, 0.05, 200, &scaled);
        assert_memory_equal(&s.turn, &scaled.turn, sizeof s.turn);
    }
}

/* About a main axis the rotation is uniform: Cayley's map turns by 2 atan(w step / 2) a
   step. */
TEST(rigid_step_main_axis_turns_evenly)
{
    const mote_mass mass = top_of(1, 2, 2.5);
    mote_rigid_state s = {.turn = {1, 0, 0, 0}, .angular_momentum = {0, 0, 2.5 * 0.4}};
    steps(&mass, nothing, 0.05, 1000, &s);
    const double half = 1000 * atan(0.4 * 0.05 / 2);
    assert_close(s.turn.w, cos(half), 1e-12);
    assert_close(s.turn.z, sin(half), 1e-12);
    assert_true(s.turn.x == 0 && s.turn.y == 0);
}

/* A symmetric top precesses about its angular momentum at |L| / I_1. */
TEST(rigid_step_symmetric_top_precesses_as_known)
{
    const mote_mass mass = top_of(2, 2, 3);
    mote_rigid_state s = {.turn = {1, 0, 0, 0}, .angular_momentum = {0.6, 0, 0.8}};
    const double time = 10;
    double before = HUGE_VAL;
    for (int count = 400; count <= 1600; count *= 2) {
        mote_rigid_state at = s;
        steps(&mass, nothing, time / count, count, &at);
        const mote_mat3 axes = mote_rigid_axes(&mass, &at);
        /* After `time` the figure axis has turned from z about L by |L| time / I_1. */
        const double angle = 1.0 * time / 2, c = cos(angle), d = sin(angle);
        const mote_vec3 l = s.angular_momentum, z = {0, 0, 1};
        const mote_vec3 wanted =
            mote_add(mote_add(mote_scale(z, c), mote_scale(mote_cross(l, z), d)),
                     mote_scale(l, mote_dot(l, z) * (1 - c)));
        const mote_vec3 found = mote_vec3_make(axes.m[0][2], axes.m[1][2], axes.m[2][2]);
        const double error = mote_length(mote_sub(found, wanted));
        assert_true(error < before / 3.9); /* of second order */
        before = error;
    }
    assert_true(before < 1e-5);
}

/* A throw: x0 + V t + g t^2 / 2, whatever the steps. */
TEST(rigid_step_gravity_exact_parabola)
{
    uint64_t seed = 8;
    const mote_mass mass = random_mass(&seed);
    mote_rigid_state s = random_state(&seed);
    const mote_rigid_state start = s;
    const mote_vec3 gravity = {0.1, -0.3, 0.2};
    const double step = 0.03, t = step * 1000;
    steps(&mass, gravity, step, 1000, &s);
    const mote_vec3 wanted =
        mote_add_scaled(mote_add_scaled(start.centre, t, start.velocity), t * t / 2, gravity);
    assert_true(mote_length(mote_sub(s.centre, wanted)) < 1e-10);
    assert_true(mote_length(mote_sub(s.velocity, mote_add_scaled(start.velocity, t, gravity))) <
                1e-12);
}

TEST(rigid_step_at_rest_stays_at_rest)
{
    uint64_t seed = 9;
    const mote_mass mass = random_mass(&seed);
    mote_rigid_state s = random_state(&seed);
    s.velocity = s.angular_momentum = nothing;
    const mote_rigid_state start = s;
    const mote_pose pose = mote_rigid_pose(&mass, &s);
    steps(&mass, nothing, 0.7, 10000, &s);
    const mote_pose after = mote_rigid_pose(&mass, &s);
    assert_memory_equal(&start.centre, &s.centre, sizeof s.centre);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
            assert_close(pose.rotation.m[i][k], after.rotation.m[i][k], 1e-15);
    }
}

/* A million steps, including the unstable middle axis and steps that are far too long. */
TEST(rigid_step_million_steps_no_nan)
{
    const mote_mass mass = top_of(1, 2, 2.9);
    static const double sizes[] = {1e-3, 0.3, 50};
    for (int i = 0; i < 3; ++i) {
        mote_rigid_state s = {.turn = {1, 0, 0, 0}, .angular_momentum = {1e-7, 2, 0}};
        const double energy = mote_rigid_kinetic_energy(&mass, &s);
        steps(&mass, nothing, sizes[i], i == 1 ? 1000000 : 10000, &s);
        const mote_pose pose = mote_rigid_pose(&mass, &s);
        assert_true(isfinite(pose.rotation.m[0][0] + pose.rotation.m[1][2]));
        if (i < 2)
            assert_close(mote_rigid_kinetic_energy(&mass, &s), energy, 1e-9);
    }
}

TEST(rigid_pose_centre_of_mass_stands_where_it_should)
{
    uint64_t seed = 11;
    for (int i = 0; i < 100; ++i) {
        const mote_mass mass = random_mass(&seed);
        const mote_rigid_state s = random_state(&seed);
        const mote_pose pose = mote_rigid_pose(&mass, &s);
        const mote_vec3 at = mote_pose_apply(&pose, mass.centre);
        assert_true(mote_length(mote_sub(at, s.centre)) < 1e-14);
        /* Angular velocity and angular momentum convert into each other. */
        const mote_vec3 w = mote_rigid_angular_velocity(&mass, &s);
        const mote_vec3 l = mote_rigid_angular_momentum(&mass, &s, w);
        assert_true(mote_length(mote_sub(l, s.angular_momentum)) < 1e-14);
    }
}

TEST(rigid_step_bad_step_refused)
{
    const mote_mass mass = top_of(1, 1, 1);
    static const double bad[] = {0, -1, NAN, HUGE_VAL};
    for (int i = 0; i < 4; ++i) {
        mote_rigid_state s = {.turn = {1, 0, 0, 0}, .velocity = {1, 0, 0}};
        assert_int_equal(mote_rigid_step(&mass, nothing, bad[i], &s), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "time step"));
        assert_true(s.centre.x == 0);
    }
}

TEST(rigid_step_coordinates_whose_sum_is_not_finite_are_kept)
{
    const mote_mass mass = top_of(1, 2, 2.5);
    mote_rigid_state s = {.turn = {1, 0, 0, 0},
                          .centre = {1e308, 1e308, 1e308},
                          .velocity = {8e307, 8e307, 8e307}};
    assert_int_equal(mote_rigid_step(&mass, nothing, 0.01, &s), MOTE_OK);
    assert_close(s.centre.z / 1e308, 1.008, 1e-12);
}

/* Any finite step is answered with finite numbers, or refused with the state as it was. */
TEST(rigid_step_enormous_steps_leave_the_state_finite)
{
    static const struct {
        double step, speed;
        bool fine;
    } rows[] = {{1e100, 1, true},  {1e150, 1, true},    {1e153, 1, true},
                {1e160, 1, false}, {1e200, 1, false},   {1e300, 1, false},
                {1e308, 0, false}, {1e10, 1e290, true}, {1e20, 1e290, false}};
    const mote_mass mass = top_of(1, 2, 2.5);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("step %g, speed %g", rows[i].step, rows[i].speed);
        mote_rigid_state s = {.turn = {1, 0, 0, 0},
                              .velocity = {rows[i].speed, 0, 0},
                              .angular_momentum = {0.1, 0.2, 0.3}};
        const mote_rigid_state before = s;
        const mote_status status = mote_rigid_step(&mass, nothing, rows[i].step, &s);
        assert_int_equal(status, rows[i].fine ? MOTE_OK : MOTE_EINVAL);
        if (!rows[i].fine) {
            assert_non_null(strstr(mote_error_text(), "give a shorter one"));
            assert_memory_equal(&s, &before, sizeof s);
            continue;
        }
        const mote_quaternion q = s.turn;
        assert_close(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-12);
        assert_true(fabs(s.centre.x) < HUGE_VAL);
    }
}
