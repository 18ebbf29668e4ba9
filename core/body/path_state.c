#include "core/body/path.h"

#include "core/base/turn.h"
#include "core/body/path_place.h"

#include <string.h>

void mote_path_line(mote_vec3 a, mote_vec3 b, mote_vec3 control[4])
{
    const mote_vec3 third = mote_scale(mote_sub(b, a), 1.0 / 3);
    control[0] = a;
    control[1] = mote_add(a, third);
    control[2] = mote_sub(b, third);
    control[3] = b;
}

void mote_path_hermite(mote_vec3 a, mote_vec3 da, mote_vec3 b, mote_vec3 db,
                       mote_vec3 control[4])
{
    control[0] = a;
    control[1] = mote_add_scaled(a, 1.0 / 3, da);
    control[2] = mote_add_scaled(b, -1.0 / 3, db);
    control[3] = b;
}

mote_place mote_path_place(const mote_path *path, double time)
{
    const double place = time * path->count;
    uint32_t k = place > 0 ? (uint32_t)place : 0;
    if (k >= path->count)
        k = path->count - 1;
    return (mote_place){k, place - k};
}

static mote_vec3 centre_at(const mote_path_piece *piece, double u)
{
    const double v = 1 - u;
    const double b[4] = {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
    mote_vec3 sum = mote_scale(piece->centre[0], b[0]);
    for (int i = 1; i < 4; ++i)
        sum = mote_add_scaled(sum, b[i], piece->centre[i]);
    return sum;
}

/* The rotation by u times the spin. */
static mote_quaternion spun(mote_vec3 spin, double u)
{
    const double pi = 3.14159265358979323846;
    const double angle = mote_length(spin);
    if (!(angle > 0))
        return (mote_quaternion){1, 0, 0, 0};
    double sine, cosine;
    mote_turn(u * angle / (4 * pi), &sine, &cosine); /* half of the angle */
    const double s = sine / angle;
    return (mote_quaternion){cosine, s * spin.x, s * spin.y, s * spin.z};
}

static mote_quaternion add_quaternion(mote_quaternion a, double s, mote_quaternion b)
{
    return (mote_quaternion){a.w + s * b.w, a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

/* The rotation in a piece that does not spin, as a quaternion of any length. */
static mote_quaternion quaternion_at(const mote_path_piece *piece, double u)
{
    const double v = 1 - u;
    const double b[4] = {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
    mote_quaternion sum = {0, 0, 0, 0};
    for (int i = 0; i < 4; ++i)
        sum = add_quaternion(sum, b[i], piece->turn[i]);
    return sum;
}

mote_mat3 mote_path_rotation(const mote_path_piece *piece, double u)
{
    if (piece->spins)
        return mote_quaternion_matrix(
            mote_quaternion_multiply(spun(piece->spin, u), piece->turn[0]));
    return mote_quaternion_matrix(quaternion_at(piece, u));
}

static double along(mote_quaternion a, mote_quaternion b)
{
    return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

double mote_path_least_turn(const mote_path_piece *piece)
{
    const mote_quaternion *q = piece->turn;
    const mote_quaternion sum = {
        q[0].w + q[1].w + q[2].w + q[3].w, q[0].x + q[1].x + q[2].x + q[3].x,
        q[0].y + q[1].y + q[2].y + q[3].y, q[0].z + q[1].z + q[2].z + q[3].z};
    const mote_quaternion mean = mote_quaternion_normalise(sum);
    double least = along(q[0], mean);
    for (int i = 1; i < 4; ++i)
        least = fmin(least, along(q[i], mean));
    return least * (1 - 0x1p-40);
}

/* turned: how many weights are vectors, which turn with the body. */
MOTE_CLONES
static void weights_at(const double *restrict control, double u, const mote_mat3 *rotation,
                       size_t turned, size_t padded, double *restrict out)
{
    const double v = 1 - u;
    const double b0 = v * v * v, b1 = 3 * u * v * v, b2 = 3 * u * u * v, b3 = u * u * u;
    const size_t step = 3 * padded;
    for (size_t j = 0; j < step; ++j)
        out[j] = (b0 * control[j] + b1 * control[step + j]) +
                 (b2 * control[2 * step + j] + b3 * control[3 * step + j]);
    double *x = out, *y = out + padded, *z = out + 2 * padded;
    for (size_t j = 0; j < turned; ++j) {
        const mote_vec3 w = mote_rotate(rotation, mote_vec3_make(x[j], y[j], z[j]));
        x[j] = w.x;
        y[j] = w.y;
        z[j] = w.z;
    }
}

/* Weights of 0, but for the columns of the rotation that morph targets need. */
static void no_weights(const mote_field *field, const mote_mat3 *rotation, double *weights)
{
    memset(weights, 0, 3 * (size_t)field->padded * sizeof *weights);
    for (size_t r = 0; field->numbers > 0 && r < 3; ++r)
        memcpy(weights + r * field->padded + mote_field_first_axis(field), rotation->m[r],
               sizeof rotation->m[r]);
}

void mote_path_state(const mote_path *path, const mote_body *body, double time, double *weights,
                     mote_body_state *state)
{
    const mote_place at = mote_path_place(path, time);
    const mote_path_piece *piece = &path->pieces[at.piece];
    const size_t padded = body->field->padded;
    *state = (mote_body_state){.shape_changed = true, .pose_changed = true};
    state->pose.rotation = mote_path_rotation(piece, at.u);
    state->pose.translation =
        mote_sub(centre_at(piece, at.u), mote_rotate(&state->pose.rotation, path->pivot));
    state->weights.count = body->field->count;
    state->weights.padded = body->field->padded;
    if (padded == 0)
        return;
    if (piece->weights)
        weights_at(piece->weights, at.u, &state->pose.rotation,
                   body->field->numbers > 0 ? mote_field_vectors(body->field) : padded, padded,
                   weights);
    else
        no_weights(body->field, &state->pose.rotation, weights);
    state->weights.x = weights;
    state->weights.y = weights + padded;
    state->weights.z = weights + 2 * padded;
}

/* The derivative of a cubic's factors by u. */
static void slopes_at(double u, double b[4])
{
    const double v = 1 - u;
    b[0] = -3 * v * v;
    b[1] = 3 * v * (v - 2 * u);
    b[2] = 3 * u * (2 * v - u);
    b[3] = 3 * u * u;
}

static mote_vec3 angular_velocity_at(const mote_path_piece *piece, double u)
{
    if (piece->spins)
        return piece->spin;
    const mote_quaternion q = quaternion_at(piece, u);
    double b[4];
    slopes_at(u, b);
    mote_quaternion d = {0, 0, 0, 0};
    for (int i = 0; i < 4; ++i)
        d = add_quaternion(d, b[i], piece->turn[i]);
    const double scale = 2 / along(q, q);
    const mote_quaternion back = {q.w, -q.x, -q.y, -q.z};
    const mote_quaternion w = mote_quaternion_multiply(d, back);
    return mote_scale(mote_vec3_make(w.x, w.y, w.z), scale);
}

/* omega x R w + R w', times factor. */
static void weight_velocities(const mote_path_piece *piece, double u, mote_vec3 spin,
                              double factor, size_t padded, double *out)
{
    const mote_mat3 rotation = mote_path_rotation(piece, u);
    const double v = 1 - u;
    const double a[4] = {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
    double b[4];
    slopes_at(u, b);
    for (size_t j = 0; j < padded; ++j) {
        double w[3] = {0, 0, 0}, dw[3] = {0, 0, 0};
        for (size_t i = 0; i < 4; ++i) {
            for (size_t c = 0; c < 3; ++c) {
                const double control = piece->weights[(3 * i + c) * padded + j];
                w[c] += a[i] * control;
                dw[c] += b[i] * control;
            }
        }
        const mote_vec3 turned = mote_rotate(&rotation, mote_vec3_make(w[0], w[1], w[2]));
        const mote_vec3 grown = mote_rotate(&rotation, mote_vec3_make(dw[0], dw[1], dw[2]));
        const mote_vec3 sum = mote_add(mote_cross(spin, turned), grown);
        out[j] = factor * sum.x;
        out[padded + j] = factor * sum.y;
        out[2 * padded + j] = factor * sum.z;
    }
}

void mote_path_velocity(const mote_path *path, const mote_body *body, mote_place at,
                        double factor, double *weights, mote_body_state *state)
{
    const mote_path_piece *piece = &path->pieces[at.piece];
    const size_t padded = body->field->padded;
    const mote_mat3 rotation = mote_path_rotation(piece, at.u);
    const mote_vec3 spin = angular_velocity_at(piece, at.u);
    *state = (mote_body_state){.shape_changed = true, .pose_changed = true};
    for (int c = 0; c < 3; ++c) {
        const mote_vec3 column = mote_cross(
            spin, mote_vec3_make(rotation.m[0][c], rotation.m[1][c], rotation.m[2][c]));
        state->pose.rotation.m[0][c] = factor * column.x;
        state->pose.rotation.m[1][c] = factor * column.y;
        state->pose.rotation.m[2][c] = factor * column.z;
    }
    double b[4];
    slopes_at(at.u, b);
    mote_vec3 moved = {0, 0, 0};
    for (int i = 0; i < 4; ++i)
        moved = mote_add_scaled(moved, b[i], piece->centre[i]);
    state->pose.translation =
        mote_sub(mote_scale(moved, factor), mote_rotate(&state->pose.rotation, path->pivot));
    state->weights.count = body->field->count;
    state->weights.padded = body->field->padded;
    if (padded == 0)
        return;
    if (piece->weights)
        weight_velocities(piece, at.u, spin, factor, padded, weights);
    else
        memset(weights, 0, 3 * padded * sizeof *weights);
    state->weights.x = weights;
    state->weights.y = weights + padded;
    state->weights.z = weights + 2 * padded;
}
