/* The relative motion of two bodies: zero for what they do together, otherwise at least the
   farthest vertex's motion and not much more. */
#include "core/body/coherence.h"
#include "core/body/deform.h"

#include "tests/support/bodies.h"
#include "tests/support/test.h"

typedef struct moving {
    test_body b[2];
    mote_coherence coherence;
    mote_frame frame;
    mote_deform *deform[2];
    mote_vec3 *world[2];
    uint64_t seed;
} moving;

static void moving_init(moving *m, int field)
{
    *m = (moving){.seed = 3};
    const mote_body *bodies[2];
    const uint32_t probe[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    for (int k = 0; k < 2; ++k) {
        test_body_init(&m->b[k], solid_to_mesh(solid_icosphere(2)), field, &m->seed);
        bodies[k] = &m->b[k].body;
        m->frame.body[k] = test_body_state(&m->b[k], 0.1, &m->seed);
        assert_int_equal(mote_deform_create(bodies[k], &m->deform[k]), MOTE_OK);
        m->world[k] = malloc(m->b[k].mesh->vertex_count * sizeof(mote_vec3));
        assert_non_null(m->world[k]);
    }
    m->frame.body[1].pose.translation.x += 3;
    const uint32_t *const probes[2] = {probe, probe};
    const uint32_t counts[2] = {12, 12};
    assert_int_equal(
        mote_coherence_init(&m->coherence, bodies, m->b[0].mesh->diagonal, probes, counts),
        MOTE_OK);
}

static double motion(moving *m, bool given)
{
    for (int k = 0; k < 2; ++k) {
        mote_deform_all(m->deform[k], &m->frame.body[k], m->world[k]);
        m->frame.body[k].vertices = m->world[k];
    }
    return mote_coherence_motion(&m->coherence, &m->frame, given);
}

static void moving_free(moving *m)
{
    mote_coherence_free(&m->coherence);
    for (int k = 0; k < 2; ++k) {
        test_body_free(&m->b[k]);
        mote_deform_destroy(m->deform[k]);
        free(m->world[k]);
    }
}

/* Turns and shifts the whole frame. */
static void move_together(mote_frame *frame, const mote_mat3 *turn, mote_vec3 shift)
{
    for (int k = 0; k < 2; ++k) {
        mote_body_state *state = &frame->body[k];
        mote_mat3 made;
        for (int j = 0; j < 3; ++j) {
            const mote_mat3 *r = &state->pose.rotation;
            const mote_vec3 column =
                mote_rotate(turn, mote_vec3_make(r->m[0][j], r->m[1][j], r->m[2][j]));
            made.m[0][j] = column.x;
            made.m[1][j] = column.y;
            made.m[2][j] = column.z;
        }
        state->pose.rotation = made;
        state->pose.translation = mote_add(mote_rotate(turn, state->pose.translation), shift);
    }
}

TEST(motion_first_is_all_of_the_length)
{
    for (int given = 0; given < 2; ++given) {
        moving m;
        moving_init(&m, 9);
        assert_true(motion(&m, given) == m.b[0].mesh->diagonal);
        assert_true(motion(&m, given) == 0);
        moving_free(&m);
    }
}

TEST(motion_of_both_together_none)
{
    for (int given = 0; given < 2; ++given) {
        moving m;
        moving_init(&m, 0);
        (void)motion(&m, given);
        for (int i = 0; i < 20; ++i) {
            const mote_mat3 turn = random_rotation_matrix(&m.seed);
            move_together(&m.frame, &turn, random_vec3(&m.seed, 5));
            assert_true(motion(&m, given) < 1e-12);
        }
        moving_free(&m);
    }
}

TEST(motion_of_a_shift_its_length)
{
    for (int given = 0; given < 2; ++given) {
        moving m;
        moving_init(&m, 14);
        (void)motion(&m, given);
        for (int i = 0; i < 20; ++i) {
            const mote_vec3 shift = random_vec3(&m.seed, 0.3);
            mote_body_state *state = &m.frame.body[i % 2];
            state->pose.translation = mote_add(state->pose.translation, shift);
            assert_true(fabs(motion(&m, given) - mote_length(shift)) < 1e-12);
        }
        moving_free(&m);
    }
}

/* A turn of body 1 about its middle by a small angle moves its farthest points by the angle
   times their radius of 1; the estimate uses half of L instead. */
TEST(motion_of_a_turn_angle_times_half_length)
{
    moving m;
    moving_init(&m, 0);
    (void)motion(&m, false);
    double angle = 0;
    m.frame.body[1].pose.rotation = (mote_mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    (void)motion(&m, false);
    for (int i = 1; i < 10; ++i) {
        const double step = 0.001 * i;
        angle += step;
        m.frame.body[1].pose.rotation =
            (mote_mat3){{{cos(angle), -sin(angle), 0}, {sin(angle), cos(angle), 0}, {0, 0, 1}}};
        const double moved = motion(&m, false);
        assert_true(moved >= 0.999 * step);
        assert_true(moved <= 1.001 * step * 0.5 * m.b[0].mesh->diagonal);
    }
    moving_free(&m);
}

/* A change of shape is detected without any motion of the pose: by the weights, and by the
   positions of the probes. */
TEST(motion_of_a_shape_seen)
{
    for (int given = 0; given < 2; ++given) {
        moving m;
        moving_init(&m, 14);
        (void)motion(&m, given);
        for (int i = 0; i < 20; ++i) {
            double *weight = &m.b[1].weights[i % 3][i % 14];
            *weight += 0.1;
            const double moved = motion(&m, given);
            if (given)
                assert_true(moved <= 0.1 + 1e-12);
            else
                assert_true(fabs(moved - 0.1) < 1e-12);
        }
        for (uint32_t j = 0; j < 14; ++j)
            m.b[1].weights[0][j] += 0.1;
        assert_true(motion(&m, given) > 0.02);
        moving_free(&m);
    }
}
