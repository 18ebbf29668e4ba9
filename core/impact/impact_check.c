/* What is wrong with a question about an impact. */
#include "core/impact/impact_state.h"

/* Quaternions of a piece that come nearer to 0 than this part of the longest are refused. */
#define LEAST_TURN 1e-3

/* Pieces may miss each other by this part of the body's size, by what their centres, rotations
   and weights do together: rounding, nothing else. The noise (impact_rate.c) holds it. */
#define JUMP 0x1p-42

_Static_assert(sizeof(mote_vec3) == 3 * sizeof(double), "three numbers, no gaps");

static const double *numbers_of(const mote_vec3 *v)
{
    return (const double *)(const void *)v;
}

/* 0 times a number that is not finite is NaN. */
MOTE_CLONES
static bool all_finite(const double *restrict x, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; ++i)
        sum += 0 * x[i];
    return sum >= 0;
}

static double largest(const double *x, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; ++i)
        most = fmax(most, fabs(x[i]));
    return most;
}

static mote_status check_turn(const mote_path_piece *piece, int body, uint32_t k)
{
    if (piece->spins) {
        const mote_quaternion q = piece->turn[0];
        const double length = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
        if (!(mote_length(piece->spin) <= MOTE_PATH_SPIN_MAX))
            return mote_fail(MOTE_EINVAL,
                             "piece %u of body %d's path turns by %g radians; give a finite "
                             "spin of at most %g",
                             k, body, mote_length(piece->spin), MOTE_PATH_SPIN_MAX);
        if (!(fabs(length - 1) <= 1e-6))
            return mote_fail(MOTE_EINVAL,
                             "piece %u of body %d's path begins with a quaternion of squared "
                             "length %g; give one of length 1",
                             k, body, length);
        return MOTE_OK;
    }
    double most = 0;
    for (int i = 0; i < 4; ++i) {
        const mote_quaternion q = piece->turn[i];
        most = fmax(most, sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z));
    }
    if (!(mote_path_least_turn(piece) >= LEAST_TURN * most && most > 1e-100 && most < 1e100))
        return mote_fail(MOTE_EINVAL,
                         "the quaternions of piece %u of body %d's path may pass near 0; give "
                         "finite ones that turn by less than half a turn, or a spin",
                         k, body);
    return MOTE_OK;
}

/* Whether the columns of the rotation among the weights are the body's own axes, and numbers
   are in x alone. */
static bool has_axes(const mote_field *field, const double *weights)
{
    const size_t padded = field->padded;
    for (size_t i = 0; i < 12 && field->numbers > 0; ++i) {
        const double *row = weights + i * padded;
        for (size_t k = 0; k < 3; ++k) {
            if (fabs(row[mote_field_first_axis(field) + k] - (k == i % 3 ? 1 : 0)) > 0x1p-50)
                return false;
        }
        for (size_t j = mote_field_vectors(field); i % 3 > 0 && j < field->count; ++j) {
            if (fabs(row[j]) > 0)
                return false;
        }
    }
    return true;
}

static mote_status check_piece(const mote_impact_search *s, const mote_path *path, int body,
                               uint32_t k)
{
    const mote_path_piece *piece = &path->pieces[k];
    const size_t padded = s->body[body].field->padded;
    if (!all_finite(numbers_of(piece->centre), 12))
        return mote_fail(MOTE_EINVAL, "the centre in piece %u of body %d's path is not finite",
                         k, body);
    if (piece->weights && !all_finite(piece->weights, 12 * padded))
        return mote_fail(MOTE_EINVAL, "a weight in piece %u of body %d's path is not finite", k,
                         body);
    if (piece->weights && !has_axes(s->body[body].field, piece->weights))
        return mote_fail(MOTE_EINVAL,
                         "the weights in piece %u of body %d's path are not those of morph "
                         "targets in the body's axes; make them with mote_morph_weights for an "
                         "identity rotation",
                         k, body);
    return check_turn(piece, body, k);
}

/* By how much the weights at the end of piece k - 1 differ from those at the start of piece k,
   as a bound for any vertex. */
static double weights_apart(const mote_impact_search *s, int body, const mote_path_piece *a,
                            const mote_path_piece *b)
{
    const mote_field *field = s->body[body].field;
    const size_t padded = field->padded;
    if (field->numbers > 0)
        return mote_impact_bones_apart(s->groups[body].bones, field,
                                       a->weights ? a->weights + 9 * padded : NULL, b->weights);
    double sum = 0;
    for (uint32_t j = 0; j < field->count; ++j) {
        double size = 0;
        for (size_t c = 0; c < 3; ++c) {
            const double end = a->weights ? a->weights[9 * padded + c * padded + j] : 0;
            const double start = b->weights ? b->weights[c * padded + j] : 0;
            size += fabs(end - start);
        }
        sum += size * s->groups[body].most_of_all[j];
    }
    return sum;
}

static mote_status check_join(const mote_impact_search *s, const mote_path *path, int body,
                              uint32_t k)
{
    const mote_path_piece *a = &path->pieces[k - 1], *b = &path->pieces[k];
    const mote_mat3 end = mote_path_rotation(a, 1), start = mote_path_rotation(b, 0);
    const double size =
        largest(numbers_of(b->centre), 12) + mote_length(path->pivot) + s->groups[body].size;
    const double spin = a->spins ? mote_length(a->spin) : 0;
    double turned = 0;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            turned += fabs(end.m[r][c] - start.m[r][c]);
    }
    const double apart = mote_length(mote_sub(a->centre[3], b->centre[0])) + turned * size +
                         weights_apart(s, body, a, b);
    if (!(apart <= (JUMP + 0x1p-49 * spin) * size))
        return mote_fail(MOTE_EINVAL,
                         "piece %u of body %d's path does not begin where piece %u ends", k,
                         body, k - 1);
    return MOTE_OK;
}

static mote_status check_lines(const mote_impact_search *s,
                               const mote_impact_question *question, int body)
{
    const mote_path *path = question->path[body];
    if (!path->positions)
        return mote_fail(MOTE_EINVAL,
                         "of body %d only positions are known; give those at both ends of each "
                         "piece of its path",
                         body);
    const uint32_t first = mote_path_place(path, question->begin).piece;
    const uint32_t last = mote_path_place(path, question->end).piece;
    mote_status status = MOTE_OK;
    for (uint32_t k = first; k <= last + 1 && status == MOTE_OK; ++k)
        status = mote_lines_check(s->lines[body], &path->positions[k], body, k);
    return status;
}

static mote_status check_path(const mote_impact_search *s, const mote_impact_question *question,
                              int body)
{
    const mote_path *path = question->path[body];
    if (path->count < 1 || path->count > s->options.pieces)
        return mote_fail(MOTE_EINVAL, "body %d's path has %u pieces; this search takes 1 to %u",
                         body, path->count, s->options.pieces);
    if (s->lines[body])
        return check_lines(s, question, body);
    if (path->positions)
        return mote_fail(MOTE_EINVAL,
                         "body %d has a field, but its path is one of positions; give pieces",
                         body);
    if (!all_finite(numbers_of(&path->pivot), 3))
        return mote_fail(MOTE_EINVAL, "the pivot of body %d's path is not finite", body);
    const uint32_t first = mote_path_place(path, question->begin).piece;
    const uint32_t last = mote_path_place(path, question->end).piece;
    mote_status status = MOTE_OK;
    for (uint32_t k = first; k <= last && status == MOTE_OK; ++k) {
        status = check_piece(s, path, body, k);
        if (status == MOTE_OK && k > first)
            status = check_join(s, path, body, k);
    }
    return status;
}

mote_status mote_impact_check(const mote_impact_search *s, const mote_impact_question *question)
{
    if (!(question->begin >= 0 && question->begin <= question->end && question->end <= 1))
        return mote_fail(
            MOTE_EINVAL,
            "an impact is looked for from %g to %g; give two times within 0 and 1, "
            "the earlier first",
            question->begin, question->end);
    if (!(question->tolerance >= 0 && question->tolerance < HUGE_VAL))
        return mote_fail(MOTE_EINVAL, "a tolerance of %g; give a finite number of at least 0",
                         question->tolerance);
    mote_status status = check_path(s, question, 0);
    if (status == MOTE_OK)
        status = check_path(s, question, 1);
    if (status == MOTE_OK && question->path[0]->count != question->path[1]->count)
        return mote_fail(MOTE_EINVAL, "the paths have %u and %u pieces; give both as many",
                         question->path[0]->count, question->path[1]->count);
    return status;
}
