#include "core/batch/controls.h"

#include "core/body/field_kinds.h"
#include "core/skin/skin.h"

#include <string.h>

/* Beyond this many L a double no longer resolves a shape of size L. */
#define FARTHEST 0x1p50

/* A rotation made from single precision passes. */
#define ROTATION_ERROR 1e-6

size_t mote_controls_weights(const mote_field *field)
{
    const mote_skin *skin = mote_field_skin(field);
    if (skin)
        return (size_t)12 * skin->bones;
    return mote_modes_largest(field) ? field->count / 3 : (size_t)3 * field->count;
}

size_t mote_controls_amounts(const mote_field *field)
{
    const mote_skin *skin = mote_field_skin(field);
    return skin ? skin->morph.targets : 0;
}

/* By how much the dot product of two rows differs from that of an orthonormal matrix. */
static double product_error(const mote_mat3 *rotation, int i, int j)
{
    const double *a = rotation->m[i], *b = rotation->m[j];
    return fabs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] - (i == j));
}

static mote_status check_rotation(const mote_mat3 *rotation)
{
    for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
            const double off = product_error(rotation, i, j);
            if (!(off <= ROTATION_ERROR))
                return mote_fail(MOTE_EINVAL,
                                 "pose: not a rotation: products of its rows differ by %g "
                                 "from those of an orthonormal matrix; at most %g is allowed",
                                 off, ROTATION_ERROR);
        }
    }
    const double(*m)[3] = rotation->m;
    const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
                               m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
                               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    if (!(determinant > 0))
        return mote_fail(MOTE_EINVAL, "pose: a reflection, not a rotation");
    return MOTE_OK;
}

static mote_status read_pose(const mote_controls *controls, size_t frame, double length,
                             mote_pose *pose)
{
    *pose = (mote_pose){.rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    if (!controls->pose)
        return MOTE_OK;
    double row[4][4] = {{0}, {0}, {0}, {0, 0, 0, 1}};
    const size_t rows = controls->pose_rows;
    if (rows != 3 && rows != 4)
        return mote_fail(MOTE_EINVAL,
                         "pose: %zu rows; give 3, or 4 of which the last is 0 0 0 1", rows);
    memcpy(row, controls->pose + frame * controls->pose_step, rows * sizeof row[0]);
    for (size_t i = 0; i < rows; ++i) {
        for (size_t j = 0; j < 4; ++j) {
            if (!isfinite(row[i][j]))
                return mote_fail(MOTE_EINVAL,
                                 "pose: row %zu, column %zu is %g; it must be finite", i, j,
                                 row[i][j]);
        }
        if (i < 3 && !(fabs(row[i][3]) <= FARTHEST * length))
            return mote_fail(MOTE_EINVAL,
                             "pose: the translation %g is above 2^50 L, where L is %g",
                             row[i][3], length);
    }
    if (fabs(row[3][0]) + fabs(row[3][1]) + fabs(row[3][2]) + fabs(row[3][3] - 1) > 0)
        return mote_fail(MOTE_EINVAL, "pose: the last row is %g %g %g %g; it must be 0 0 0 1",
                         row[3][0], row[3][1], row[3][2], row[3][3]);
    for (int i = 0; i < 3; ++i)
        memcpy(pose->rotation.m[i], row[i], sizeof pose->rotation.m[i]);
    pose->translation = mote_vec3_make(row[0][3], row[1][3], row[2][3]);
    return check_rotation(&pose->rotation);
}

/* Another thread of the caller may write to arrays that are borrowed. */
static mote_status fail_changed(const char *name)
{
    return mote_fail(MOTE_EINVAL, "%s: they changed while they were read", name);
}

/* Numbers at most `most`, which the message calls `limit`. */
static mote_status check_numbers(const char *name, const double *numbers, size_t count,
                                 double most, const char *limit)
{
    bool fine = true;
    for (size_t i = 0; i < count; ++i)
        fine = fine & (fabs(numbers[i]) <= most);
    if (fine)
        return MOTE_OK;
    for (size_t i = 0; i < count; ++i) {
        if (!(fabs(numbers[i]) <= most))
            return mote_fail(MOTE_EINVAL,
                             "%s: number %zu is %g; it must be finite and at most %s, %g", name,
                             i, numbers[i], limit, most);
    }
    return fail_changed(name);
}

/* Numbers that move vertices along any axis by at most their product with largest[i]: by no
   more than 2^50 L. 0 times infinity is no number, so that all are finite, too. */
static mote_status check_moves(const char *name, const double *numbers, const double *largest,
                               size_t count, double length)
{
    const double most = FARTHEST * length;
    bool fine = true;
    for (size_t i = 0; i < count; ++i)
        fine = fine & (fabs(numbers[i]) * largest[i] <= most);
    if (fine)
        return MOTE_OK;
    for (size_t i = 0; i < count; ++i) {
        if (!(fabs(numbers[i]) * largest[i] <= most))
            return mote_fail(MOTE_EINVAL,
                             "%s: number %zu is %g, times displacements of size %g; it must be "
                             "finite, and the product at most 2^50 L, %g",
                             name, i, numbers[i], largest[i], most);
    }
    return fail_changed(name);
}

static mote_status check_weights(const mote_field *field, const double *weights, double length)
{
    const size_t count = mote_controls_weights(field);
    const double *largest = mote_modes_largest(field);
    if (largest)
        return check_moves("weights", weights, largest, count, length);
    const bool skin = mote_field_skin(field) != NULL;
    return check_numbers("weights", weights, count,
                         FARTHEST * (skin ? fmax(1, length) : length),
                         skin ? "2^50, or 2^50 L" : "2^50 L");
}

static mote_status check_amounts(const mote_field *field, const double *amounts, double length)
{
    const size_t count = mote_controls_amounts(field);
    const mote_status status = check_numbers("amounts", amounts, count, FARTHEST, "2^50");
    return status == MOTE_OK && count > 0
               ? check_moves("amounts", amounts, mote_field_skin(field)->morph.size, count,
                             length)
               : status;
}

/* Weight vectors in world axes from those of the body's axes. */
static void turn_vectors(const mote_body *body, const double *weights,
                         const mote_mat3 *rotation, double *x, double *y, double *z)
{
    const bool modes = mote_modes_largest(body->field) != NULL;
    for (uint32_t j = 0; j < body->field->count; ++j) {
        double w[3] = {0, 0, 0};
        if (modes)
            w[j % 3] = weights[j / 3];
        else
            memcpy(w, weights + (size_t)3 * j, sizeof w);
        const mote_vec3 turned = mote_rotate(rotation, mote_vec3_make(w[0], w[1], w[2]));
        x[j] = turned.x;
        y[j] = turned.y;
        z[j] = turned.z;
    }
}

/* count is a multiple of MOTE_LANES. */
static bool all_finite(const double *numbers, size_t count)
{
    double zero[MOTE_LANES] = {0};
    for (size_t i = 0; i < count; i += MOTE_LANES) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < MOTE_LANES; ++l)
            zero[l] += 0 * numbers[i + l];
    }
    return !isnan(mote_lane_sum(zero));
}

mote_status mote_controls_read(const mote_body *body, const mote_controls *controls,
                               size_t frame, double length, double *room,
                               mote_body_state *state)
{
    const mote_field *field = body->field;
    const bool skin = mote_field_skin(field) != NULL;
    const size_t padded = field->padded;
    const double *weights =
        controls->weights ? controls->weights + frame * controls->weights_step : NULL;
    const double *amounts =
        controls->amounts ? controls->amounts + frame * controls->amounts_step : NULL;
    mote_pose pose;
    mote_status status = read_pose(controls, frame, length, &pose);
    if (status == MOTE_OK && weights)
        status = check_weights(field, weights, length);
    if (status == MOTE_OK && amounts)
        status = check_amounts(field, amounts, length);
    if (status != MOTE_OK)
        return status;
    double *x = room, *y = room + padded, *z = y + padded;
    if (padded > 0)
        memset(room, 0, 3 * padded * sizeof *room);
    const double(*matrices)[3][4];
    memcpy(&matrices, &weights, sizeof weights); /* a cast is said to discard the const */
    if (skin)
        mote_morph_weights(field, matrices, amounts, &pose.rotation, x, y, z);
    else if (weights)
        turn_vectors(body, weights, &pose.rotation, x, y, z);
    if (!all_finite(room, 3 * padded))
        return mote_fail(MOTE_EINVAL,
                         "weights or amounts: times what they move, they leave the range of "
                         "doubles, or they changed while they were read; give smaller ones");
    *state = (mote_body_state){.pose = pose,
                               .weights = {x, y, z, field->count, field->padded},
                               .shape_changed = true,
                               .pose_changed = true};
    return MOTE_OK;
}
