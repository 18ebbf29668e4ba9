#include "harness/scene/motion.h"

#include "core/base/random.h"
#include "harness/base/memory.h"
#include "core/base/turn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

mote_quaternion mote_quaternion_about(mote_vec3 axis, double degrees)
{
    double sine, cosine;
    mote_turn(degrees / 720, &sine, &cosine); /* half the angle */
    const double scale = sine / mote_length(axis);
    mote_quaternion q = {cosine, axis.x * scale, axis.y * scale, axis.z * scale};
    return q;
}

void mote_quaternions_align(mote_quaternion *keys, uint32_t count)
{
    for (uint32_t k = 1; k < count; ++k) {
        const mote_quaternion *a = &keys[k - 1];
        mote_quaternion *b = &keys[k];
        if (a->w * b->w + a->x * b->x + a->y * b->y + a->z * b->z < 0) {
            mote_quaternion negative = {-b->w, -b->x, -b->y, -b->z};
            *b = negative;
        }
    }
}

/* low (high / low)^part, computed by bisection of the exponent: pow may differ between
   machines. */
static double between(double low, double high, double part)
{
    double from = 0, to = 1;
    for (int i = 0; i < 20; ++i) {
        const double middle = sqrt(low * high);
        if (part < (from + to) / 2) {
            to = (from + to) / 2;
            high = middle;
        } else {
            from = (from + to) / 2;
            low = middle;
        }
    }
    return low;
}

void mote_waves_draw(uint64_t seed, uint32_t control_count, uint32_t terms, double amplitude,
                     double low, double high, mote_wave *waves)
{
    mote_random random = {seed};
    for (uint32_t j = 0; j < control_count; ++j) {
        for (uint32_t t = 0; t < terms; ++t) {
            mote_wave *wave = &waves[(size_t)j * terms + t];
            wave->control = j;
            wave->amplitude = mote_scale(mote_random_direction(&random), amplitude / terms);
            wave->period = between(low, high, mote_random_unit(&random));
            wave->phase = mote_random_unit(&random);
        }
    }
}

mote_pose mote_motion_pose(const mote_body_motion *motion, double frame)
{
    mote_pose pose = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}};
    if (motion->rotation) {
        double q[4];
        mote_curve_evaluate(motion->rotation, frame, q);
        mote_quaternion quaternion = {q[0], q[1], q[2], q[3]};
        pose.rotation = mote_quaternion_matrix(quaternion);
    }
    double p[3] = {0, 0, 0};
    if (motion->position)
        mote_curve_evaluate(motion->position, frame, p);
    pose.translation =
        mote_sub(mote_vec3_make(p[0], p[1], p[2]), mote_rotate(&pose.rotation, motion->centre));
    return pose;
}

static void displace_character(const mote_player *player, double frame, mote_vec3 *weights)
{
    static const mote_mat3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const size_t padded = player->field->padded;
    double *x = mote_allocate(3 * padded, sizeof *x), *y = x + padded, *z = y + padded;
    mote_player_weights(player, frame, &identity, x, y, z);
    for (uint32_t j = 0; j < player->field->count; ++j)
        weights[j] = mote_vec3_make(x[j], y[j], z[j]);
    free(x);
}

void mote_motion_displacements(const mote_body_motion *motion, double frame,
                               mote_vec3 *displacement)
{
    _Static_assert(sizeof(mote_vec3) == 3 * sizeof(double), "three numbers, no gaps");
    if (motion->player)
        displace_character(motion->player, frame, displacement);
    else if (motion->keyed)
        mote_curve_evaluate(motion->keyed, frame, &displacement[0].x);
    else
        memset(displacement, 0, motion->control_count * sizeof *displacement);
    for (uint32_t i = 0; i < motion->wave_count; ++i) {
        const mote_wave *wave = &motion->waves[i];
        double sine, cosine;
        mote_turn(frame / wave->period + wave->phase, &sine, &cosine);
        displacement[wave->control] =
            mote_add_scaled(displacement[wave->control], sine, wave->amplitude);
    }
}

void mote_body_motion_free(mote_body_motion *motion)
{
    mote_curve_destroy(motion->position);
    mote_curve_destroy(motion->rotation);
    mote_curve_destroy(motion->keyed);
    mote_csrbf_fit_destroy(motion->fit);
    mote_player_destroy(motion->player);
    mote_sequence_destroy(motion->sequence);
    free(motion->waves);
    *motion = (mote_body_motion){0};
}
