/* The paper's response against the conservation laws, in both readings of its sign. */
#include "core/motion/response.h"

#include "tests/support/rigid_bodies.h"
#include "tests/support/test.h"

typedef struct collision {
    mote_mass mass[2];
    mote_rigid_state state[2];
    mote_vec3 point, normal;
} collision;

/* Bodies that approach each other in a random point along a random normal. */
static collision random_collision(uint64_t *seed)
{
    collision c;
    for (;;) {
        for (int i = 0; i < 2; ++i) {
            c.mass[i] = random_mass(seed);
            c.state[i] = random_state(seed);
        }
        c.point = random_vec3(seed, 1);
        c.normal = random_vec3(seed, 1);
        c.normal = mote_scale(c.normal, 1 / mote_length(c.normal));
        double v[2];
        for (int i = 0; i < 2; ++i)
            v[i] = mote_velocity_along(&c.mass[i], &c.state[i],
                                       mote_sub(c.point, c.state[i].centre), c.normal);
        if (v[0] - v[1] > 0.01)
            return c;
    }
}

static mote_vec3 momentum_of(const collision *c)
{
    return mote_add(mote_scale(c->state[0].velocity, c->mass[0].mass),
                    mote_scale(c->state[1].velocity, c->mass[1].mass));
}

/* The angular momentum about the origin. */
static mote_vec3 angular_of(const collision *c)
{
    mote_vec3 sum = {0, 0, 0};
    for (int i = 0; i < 2; ++i) {
        const mote_vec3 p = mote_scale(c->state[i].velocity, c->mass[i].mass);
        sum = mote_add(
            sum, mote_add(mote_cross(c->state[i].centre, p), c->state[i].angular_momentum));
    }
    return sum;
}

static double energy_of(const collision *c)
{
    return mote_rigid_kinetic_energy(&c->mass[0], &c->state[0]) +
           mote_rigid_kinetic_energy(&c->mass[1], &c->state[1]);
}

static double closing_of(const collision *c)
{
    double v[2];
    for (int i = 0; i < 2; ++i)
        v[i] = mote_velocity_along(&c->mass[i], &c->state[i],
                                   mote_sub(c->point, c->state[i].centre), c->normal);
    return v[0] - v[1];
}

static mote_impact respond(collision *c, double restitution)
{
    const mote_mass *mass[2] = {&c->mass[0], &c->mass[1]};
    mote_rigid_state *states[2] = {&c->state[0], &c->state[1]};
    mote_impact impact;
    if (mote_respond(mass, c->point, c->normal, restitution, states, &impact) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return impact;
}

TEST(respond_elastic_conserves_and_reverses)
{
    uint64_t seed = 1;
    double momentum = 0, angular = 0, energy = 0, closing = 0;
    for (int i = 0; i < 2000; ++i) {
        collision c = random_collision(&seed);
        const collision before = c;
        assert_true(respond(&c, 1).approaching);
        const mote_vec3 p = momentum_of(&before), l = angular_of(&before);
        double sizes = 0;
        for (int k = 0; k < 2; ++k)
            sizes += c.mass[k].mass * mote_length(before.state[k].velocity);
        momentum = fmax(momentum, mote_length(mote_sub(momentum_of(&c), p)) / sizes);
        angular = fmax(angular, mote_length(mote_sub(angular_of(&c), l)) / sizes);
        energy = fmax(energy, fabs(energy_of(&c) / energy_of(&before) - 1));
        closing = fmax(closing, fabs(closing_of(&c) + closing_of(&before)));
    }
    print_message("2,000 impacts: momentum %.1g, angular momentum %.1g, energy %.1g\n",
                  momentum, angular, energy);
    assert_true(momentum < 1e-13 && angular < 1e-12 && energy < 1e-12 && closing < 1e-11);
}

/* Surfaces that close the gap by `own` besides: afterwards it opens by what restitution gives
   back of both, and what the bodies lost or gained is the energy that is told. */
TEST(respond_deforming_reverses_the_gap_and_books_the_work)
{
    uint64_t seed = 5;
    int gained = 0;
    for (int i = 0; i < 2000; ++i) {
        collision c = random_collision(&seed);
        const collision before = c;
        const double e = (i % 5) / 4.0, own = 0.3 * (i % 7) - 0.6;
        const mote_mass *mass[2] = {&c.mass[0], &c.mass[1]};
        mote_rigid_state *states[2] = {&c.state[0], &c.state[1]};
        const double closing = closing_of(&before);
        mote_impact impact;
        assert_int_equal(
            mote_respond_deforming(mass, c.point, c.normal, e, own, states, &impact), MOTE_OK);
        assert_int_equal(impact.approaching, closing + own > 0);
        if (!impact.approaching) {
            assert_memory_equal(&c, &before, sizeof c);
            continue;
        }
        assert_close(closing_of(&c) + own, -e * (closing + own), 1e-11);
        assert_close(energy_of(&before) - energy_of(&c), impact.energy,
                     1e-12 * (energy_of(&before) + energy_of(&c)));
        gained += impact.energy < 0;
    }
    assert_true(gained > 100);
}

TEST(respond_deforming_refuses_a_speed_that_is_not_finite)
{
    uint64_t seed = 6;
    collision c = random_collision(&seed);
    const mote_mass *mass[2] = {&c.mass[0], &c.mass[1]};
    mote_rigid_state *states[2] = {&c.state[0], &c.state[1]};
    mote_impact impact;
    assert_int_equal(mote_respond_deforming(mass, c.point, c.normal, 1, NAN, states, &impact),
                     MOTE_EINVAL);
}

/* The impulse as printed in the paper, p = sign * m_e v n, and dp = p' - p. */
static void apply_printed(collision *c, double sign)
{
    double effective[2], pulse[2], after[2];
    mote_vec3 arm[2];
    for (int i = 0; i < 2; ++i) {
        arm[i] = mote_sub(c->point, c->state[i].centre);
        effective[i] = mote_effective_mass(&c->mass[i], &c->state[i], arm[i], c->normal);
        pulse[i] = sign * effective[i] *
                   mote_velocity_along(&c->mass[i], &c->state[i], arm[i], c->normal);
    }
    mote_pulses_after(effective, pulse, after);
    for (int i = 0; i < 2; ++i)
        mote_apply_pulse(&c->mass[i], arm[i], mote_scale(c->normal, after[i] - pulse[i]),
                         &c->state[i]);
}

TEST(printed_sign_minus_triples_speed_and_gains_energy)
{
    uint64_t seed = 2;
    for (int i = 0; i < 2000; ++i) {
        const collision before = random_collision(&seed);
        collision minus = before, plus = before, ours = before;
        apply_printed(&minus, -1);
        assert_close(closing_of(&minus) / closing_of(&before), 3, 1e-9);
        assert_true(energy_of(&minus) > energy_of(&before));
        apply_printed(&plus, 1);
        assert_close(closing_of(&plus) / closing_of(&before), -1, 1e-9);
        assert_close(energy_of(&plus) / energy_of(&before), 1, 1e-12);
        /* The plus sign is the one in use. */
        (void)respond(&ours, 1);
        for (int k = 0; k < 2; ++k)
            assert_true(mote_length(mote_sub(ours.state[k].velocity, plus.state[k].velocity)) <
                        1e-12);
    }
}

/* w' = w + L_c / I_c in the main axes. */
TEST(apply_pulse_angular_velocity_as_printed)
{
    uint64_t seed = 3;
    for (int i = 0; i < 500; ++i) {
        const mote_mass mass = random_mass(&seed);
        mote_rigid_state s = random_state(&seed);
        const mote_mat3 axes = mote_rigid_axes(&mass, &s);
        const mote_vec3 arm = random_vec3(&seed, 1), pulse = random_vec3(&seed, 1);
        const mote_vec3 w = mote_rotate_back(&axes, mote_rigid_angular_velocity(&mass, &s));
        const mote_vec3 l =
            mote_cross(mote_rotate_back(&axes, arm), mote_rotate_back(&axes, pulse));
        mote_apply_pulse(&mass, arm, pulse, &s);
        const mote_vec3 after = mote_rotate_back(&axes, mote_rigid_angular_velocity(&mass, &s));
        const double size = mote_length(after) + 1;
        assert_close(after.x, w.x + l.x / mass.inertia.x, 1e-13 * size);
        assert_close(after.y, w.y + l.y / mass.inertia.y, 1e-13 * size);
        assert_close(after.z, w.z + l.z / mass.inertia.z, 1e-13 * size);
    }
}

/* An impulse of 1 along n changes the velocity of its point along n by 1 / m_e. */
TEST(effective_mass_is_pulse_over_velocity)
{
    uint64_t seed = 4;
    for (int i = 0; i < 500; ++i) {
        const mote_mass mass = random_mass(&seed);
        mote_rigid_state s = random_state(&seed);
        const mote_vec3 arm = random_vec3(&seed, 1);
        mote_vec3 n = random_vec3(&seed, 1);
        n = mote_scale(n, 1 / mote_length(n));
        const double effective = mote_effective_mass(&mass, &s, arm, n);
        const double before = mote_velocity_along(&mass, &s, arm, n);
        mote_apply_pulse(&mass, arm, n, &s);
        const double gain = mote_velocity_along(&mass, &s, arm, n) - before;
        assert_close(gain * effective, 1, 1e-12);
        assert_true(effective > 0 && effective <= mass.mass);
        /* Along a line through the centre the whole mass of the body resists. */
        assert_close(mote_effective_mass(&mass, &s, mote_scale(n, 0.7), n), mass.mass, 1e-13);
    }
}

TEST(respond_restitution_scales_and_loses_energy)
{
    uint64_t seed = 5;
    for (int i = 0; i < 500; ++i) {
        const collision before = random_collision(&seed);
        const double e = (i % 11) / 10.0;
        collision c = before;
        const mote_impact impact = respond(&c, e);
        assert_close(closing_of(&c), -e * closing_of(&before), 1e-11);
        assert_close(energy_of(&before) - energy_of(&c), impact.energy,
                     1e-12 * energy_of(&before));
        assert_close(mote_length(mote_sub(momentum_of(&c), momentum_of(&before))), 0, 1e-12);
    }
}

TEST(respond_moving_apart_changes_nothing)
{
    uint64_t seed = 6;
    for (int i = 0; i < 100; ++i) {
        collision c = random_collision(&seed);
        (void)respond(&c, 1);
        const collision apart = c;
        const mote_impact impact = respond(&c, 1);
        assert_true(!impact.approaching && impact.pulse == 0);
        assert_memory_equal(&c.state, &apart.state, sizeof c.state);
    }
}

/* In a head-on collision equal balls exchange their velocities. */
TEST(respond_equal_balls_exchange_velocities)
{
    const mote_mass ball = {.volume = 1,
                            .mass = 3,
                            .inertia = {1, 1, 1},
                            .axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    collision c = {.mass = {ball, ball}, .point = {0, 0, 0}, .normal = {2, 0, 0}};
    c.state[0] = (mote_rigid_state){{-1, 0, 0}, {0.5, 0.25, 0}, {1, 0, 0, 0}, {0, 0, 0}};
    c.state[1] = (mote_rigid_state){{1, 0, 0}, {-2, 0, 0}, {1, 0, 0, 0}, {0, 0, 0}};
    (void)respond(&c, 1);
    assert_close(c.state[0].velocity.x, -2, 1e-15);
    assert_close(c.state[0].velocity.y, 0.25, 0);
    assert_close(c.state[1].velocity.x, 0.5, 1e-15);
    assert_close(mote_length(c.state[0].angular_momentum), 0, 0);
}

/* Masses of which the product is no number: the same velocities, and impulses and energies
   times the masses' factor. */
TEST(respond_at_every_mass_changes_velocities_the_same)
{
    static const int powers[] = {-900, -540, -500, 510, 540, 900};
    uint64_t seed = 9;
    for (size_t i = 0; i < 20 * ROWS_OF(powers); ++i) {
        const int power = powers[i % ROWS_OF(powers)];
        const double factor = ldexp(1, power);
        collision usual = random_collision(&seed);
        collision heavy = usual;
        test_row("collision %zu, masses times 2^%d", i, power);
        for (int b = 0; b < 2; ++b) {
            heavy.mass[b].mass *= factor;
            heavy.mass[b].inertia = mote_scale(usual.mass[b].inertia, factor);
            heavy.state[b].angular_momentum =
                mote_scale(usual.state[b].angular_momentum, factor);
        }
        const mote_impact a = respond(&usual, 0.5), b = respond(&heavy, 0.5);
        assert_true(a.approaching && b.pulse == a.pulse * factor);
        assert_true(b.energy == a.energy * factor);
        for (int k = 0; k < 2; ++k)
            assert_memory_equal(&usual.state[k].velocity, &heavy.state[k].velocity,
                                sizeof usual.state[k].velocity);
    }
}

TEST(respond_bad_input_refused)
{
    uint64_t seed = 7;
    collision c = random_collision(&seed);
    const collision before = c;
    const mote_mass *mass[2] = {&c.mass[0], &c.mass[1]};
    mote_rigid_state *states[2] = {&c.state[0], &c.state[1]};
    mote_impact impact = {.closing = -7};
    const mote_vec3 none = {0, 0, 0}, bad = {NAN, 0, 0}, endless = {0, HUGE_VAL, 0};
    const mote_vec3 tiny = {0, 2e-162, 0}; /* its square is below the smallest normal double */
    assert_int_equal(mote_respond(mass, c.point, none, 1, states, &impact), MOTE_EINVAL);
    assert_int_equal(mote_respond(mass, c.point, bad, 1, states, &impact), MOTE_EINVAL);
    assert_int_equal(mote_respond(mass, c.point, tiny, 1, states, &impact), MOTE_EINVAL);
    assert_int_equal(mote_respond(mass, c.point, endless, 1, states, &impact), MOTE_EINVAL);
    assert_int_equal(mote_respond(mass, bad, c.normal, 1, states, &impact), MOTE_EINVAL);
    assert_int_equal(mote_respond(mass, c.point, c.normal, 1.1, states, &impact), MOTE_EINVAL);
    assert_int_equal(mote_respond(mass, c.point, c.normal, -0.1, states, &impact), MOTE_EINVAL);
    assert_int_equal(mote_respond(mass, c.point, c.normal, NAN, states, &impact), MOTE_EINVAL);
    assert_memory_equal(&c.state, &before.state, sizeof c.state);
    assert_true(impact.closing == -7);
}
