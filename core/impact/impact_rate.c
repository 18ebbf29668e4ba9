/* Bounds on how fast two bodies can come nearer to each other in a piece of their paths.

   With p = x - pivot + sum_j phi_j w_j, a vertex is at c + R p, and with R' = [omega] R

       its velocity is       c' + omega x R p + R p',
       its acceleration      c'' + omega' x R p + omega x (omega x R p) + 2 omega x R p' + R
   p'',

   so that without the pivot's part, with W, W' bounds of |omega| and |omega'|, r of |p| and f,
   g of |p'| and |p''| over a group, they are at most W r + f and (W' + W^2) r + 2 W f + g.
   Points of a triangle move with speeds and accelerations within the hull of those of its
   vertices.

   - p: the middle of a group's ball at rest, its radius, and sum_j most_j |w_j|, where |w_j| is
     at most the largest of its control points' lengths. Of a piece that spins only what is
     perpendicular to its axis counts: |omega x R p| = W |R p x axis|.
   - p' and p'': sums over most_j times the largest length of 3 (b_{i+1} - b_i), and of
     6 (b_{i+2} - 2 b_{i+1} + b_i), which are the control points of the derivatives.
   - Cubic quaternions q: R is that of q / |q|, with omega = 2 Im(q' q*) / |q|^2.
   Differentiated: omega' = 2 Im(q'' q*) / |q|^2 - 2 (q . q') omega / |q|^2, as Im(q' q'*) = 0.
   With m the least length of q, and d, e the largest of q' and q'': |omega| <= 2 d / m = W and
   |omega'| <= 2 e / m + W^2. |q| is at least q . a for any unit vector a, and this at least the
   least b_i . a of the control points.

   Every sum is raised by 1e-9 of itself, which is more than the rounding of any of them: they
   add up at most 2^20 terms >= 0, each rounded a few times.

   Noise. What mote_path_state and mote_body_position give differs from the path by rounding:
   control points are added up by factors that add up to 1, in 8 operations; a rotation's
   entries are wrong by less than 2^-48, and by 2^-50 of the angle of a spin more, since the
   angle is rounded; products and sums with J functions, in 8 lanes, by (J / 8 + 12) 2^-53. All
   are multiples of `size`, the sum of the sizes of all parts. 2^-41 (1 + J / 1024) size is more
   than that, and holds what pieces may miss each other by (impact_check.c), 2^-42 size in all,
   too. Bounds of speeds contain the noise, so that each piece that is passed counts a miss. */
#include "core/impact/impact_state.h"

#include <string.h>

/* Largest lengths of a cubic's control points and of those of its two derivatives. */
typedef struct cubic_bounds {
    double size, rate, change;
} cubic_bounds;

static cubic_bounds bounds_of(const mote_vec3 b[4])
{
    cubic_bounds most = {0, 0, 0};
    for (int i = 0; i < 4; ++i)
        most.size = fmax(most.size, mote_length(b[i]));
    mote_vec3 d[3];
    for (int i = 0; i < 3; ++i) {
        d[i] = mote_scale(mote_sub(b[i + 1], b[i]), 3);
        most.rate = fmax(most.rate, mote_length(d[i]));
    }
    for (int i = 0; i < 2; ++i)
        most.change = fmax(most.change, 2 * mote_length(mote_sub(d[i + 1], d[i])));
    return most;
}

/* The same of each weight: amounts[0][j], [1][j], [2][j]. */
MOTE_CLONES
static void bound_weights(const double *restrict control, size_t count, size_t padded,
                          double *restrict amounts)
{
    const double *b0 = control, *b1 = b0 + 3 * padded, *b2 = b1 + 3 * padded,
                 *b3 = b2 + 3 * padded;
    for (size_t j = 0; j < count; ++j) {
        double size[4] = {0}, rate[3] = {0}, change[2] = {0};
        for (size_t c = 0; c < 3; ++c) {
            const size_t i = c * padded + j;
            const double d0 = b1[i] - b0[i], d1 = b2[i] - b1[i], d2 = b3[i] - b2[i];
            size[0] += b0[i] * b0[i];
            size[1] += b1[i] * b1[i];
            size[2] += b2[i] * b2[i];
            size[3] += b3[i] * b3[i];
            rate[0] += d0 * d0;
            rate[1] += d1 * d1;
            rate[2] += d2 * d2;
            change[0] += (d1 - d0) * (d1 - d0);
            change[1] += (d2 - d1) * (d2 - d1);
        }
        const double s = fmax(fmax(size[0], size[1]), fmax(size[2], size[3]));
        const double r = fmax(rate[0], fmax(rate[1], rate[2]));
        amounts[j] = sqrt(s);
        amounts[count + j] = 3 * sqrt(r);
        amounts[2 * count + j] = 6 * sqrt(fmax(change[0], change[1]));
    }
}

/* sums[0 .. 2][g] = sum_j most[j][g] amounts[0 .. 2][j] */
MOTE_CLONES
static void add_up(const double *restrict most, const double *restrict amounts, size_t count,
                   size_t groups, double *restrict sums)
{
    memset(sums, 0, 3 * groups * sizeof *sums);
    for (size_t j = 0; j < count; ++j) {
        const double *row = most + j * groups;
        const double a = amounts[j], b = amounts[count + j], c = amounts[2 * count + j];
        for (size_t g = 0; g < groups; ++g) {
            sums[g] += row[g] * a;
            sums[groups + g] += row[g] * b;
            sums[2 * groups + g] += row[g] * c;
        }
    }
}

static mote_quaternion difference(mote_quaternion a, mote_quaternion b)
{
    return (mote_quaternion){a.w - b.w, a.x - b.x, a.y - b.y, a.z - b.z};
}

static double norm(mote_quaternion q)
{
    return sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
}

/* Bounds of the angular velocity and of its derivative; axis: in the body's axes, or 0. */
typedef struct turning {
    double rate, change;
    mote_vec3 axis;
} turning;

static turning turning_of(const mote_path_piece *piece)
{
    if (piece->spins) {
        turning t = {.rate = mote_length(piece->spin)};
        const mote_mat3 start = mote_quaternion_matrix(piece->turn[0]);
        if (t.rate > 0)
            t.axis = mote_rotate_back(&start, mote_scale(piece->spin, 1 / t.rate));
        return t;
    }
    double rate = 0, change = 0;
    mote_quaternion before = {0, 0, 0, 0};
    for (int i = 0; i < 3; ++i) {
        const mote_quaternion d = difference(piece->turn[i + 1], piece->turn[i]);
        rate = fmax(rate, 3 * norm(d));
        if (i > 0)
            change = fmax(change, 6 * norm(difference(d, before)));
        before = d;
    }
    const double least = mote_path_least_turn(piece);
    const double w = 2 * rate / least;
    return (turning){.rate = w, .change = 2 * change / least + w * w};
}

/* The distance of a group's ball from the axis, or from the pivot where there is no axis. */
static double arm_of(const turning *turn, mote_vec3 from_pivot)
{
    if (!(mote_dot(turn->axis, turn->axis) > 0))
        return mote_length(from_pivot);
    return mote_length(mote_cross(from_pivot, turn->axis)) + 0x1p-48 * mote_length(from_pivot);
}

/* Bounds of each group by its functions: s->sums as mote_impact_bones_bound. */
static double bound_functions(mote_impact_search *s, int i, const mote_path_piece *piece,
                              mote_vec3 pivot, const turning *turn)
{
    const mote_impact_groups *groups = &s->groups[i];
    const mote_field *field = s->body[i].field;
    const size_t n = groups->padded;
    memset(s->sums, 0, 3 * n * sizeof *s->sums);
    if (field->count > 0 && piece->weights) {
        bound_weights(piece->weights, field->count, field->padded, s->amounts);
        add_up(groups->most, s->amounts, field->count, n, s->sums);
    }
    double grown = 0;
    for (uint32_t g = 0; g < groups->count; ++g) {
        grown = fmax(grown, s->sums[g]);
        s->sums[g] += arm_of(turn, mote_sub(groups->middle[g], pivot)) + groups->radius[g];
    }
    return grown;
}

static mote_impact_motion motion_of(mote_impact_search *s, int i, uint32_t k)
{
    const mote_path *path = s->question->path[i];
    const mote_path_piece *piece = &path->pieces[k];
    const mote_impact_groups *groups = &s->groups[i];
    const mote_field *field = s->body[i].field;
    const size_t n = groups->padded;
    const turning turn = turning_of(piece);
    const mote_impact_balls balls = {groups->count, groups->padded, groups->middle,
                                     groups->radius};
    const double grown =
        groups->bones ? mote_impact_bones_bound(groups->bones, &balls, field, piece->weights,
                                                path->pivot, turn.axis, s->sums)
                      : bound_functions(s, i, piece, path->pivot, &turn);
    mote_impact_motion m = {.turn = turn.rate};
    for (uint32_t g = 0; g < groups->count; ++g) {
        const double r = s->sums[g], f = s->sums[n + g], e = s->sums[2 * n + g];
        const double w = turn.rate;
        m.speed = fmax(m.speed, w * r + f);
        m.acceleration = fmax(m.acceleration, (turn.change + w * w) * r + 2 * w * f + e);
    }
    const double size =
        bounds_of(piece->centre).size + mote_length(path->pivot) + groups->size + grown;
    const double spin = piece->spins ? turn.rate : 0;
    m.noise = size * (0x1p-41 * (1 + field->most / 1024.0) + 0x1p-49 * spin);
    return m;
}

/* The same of a path of positions; centre: of its mean motion. What vertices do beyond that is
   their speed; positions are rounded by a few 2^-53 of their sizes. */
static mote_impact_motion motion_of_lines(const mote_impact_search *s, int i, uint32_t k,
                                          mote_vec3 centre[4])
{
    const mote_lines_motion lines = mote_lines_motion_of(s->lines[i], s->question->path[i], k);
    mote_path_line(mote_vec3_make(0, 0, 0), lines.mean, centre);
    return (mote_impact_motion){.speed = lines.stray, .noise = lines.size * 0x1p-45};
}

static double weights_kink(const mote_impact_search *s, int i, const mote_path_piece *before,
                           const mote_path_piece *after)
{
    const mote_field *field = s->body[i].field;
    const size_t padded = field->padded;
    double sum = 0;
    for (uint32_t j = 0; j < field->count; ++j) {
        double change = 0;
        for (size_t c = 0; c < 3; ++c) {
            const size_t at = c * padded + j;
            const double *a = before->weights, *b = after->weights;
            const double end = a ? a[9 * padded + at] - a[6 * padded + at] : 0;
            const double start = b ? b[3 * padded + at] - b[at] : 0;
            change += fabs(end - start);
        }
        sum += 3 * change * s->groups[i].most_of_all[j];
    }
    return sum;
}

/* By how much the angular velocity changes at most where piece b follows a. Infinite between
   two kinds of rotation, and between cubics that begin and end with other quaternions, as q and
   -q, of the same rotation: their derivatives cannot be compared. */
static double turn_kink(const mote_path_piece *a, const mote_path_piece *b)
{
    if (a->spins != b->spins)
        return HUGE_VAL;
    if (a->spins)
        return mote_length(mote_sub(a->spin, b->spin));
    if (norm(difference(a->turn[3], b->turn[0])) > 0x1p-40 * norm(b->turn[0]))
        return HUGE_VAL;
    return 6 *
           norm(difference(difference(a->turn[3], a->turn[2]),
                           difference(b->turn[1], b->turn[0]))) /
           fmin(mote_path_least_turn(a), mote_path_least_turn(b));
}

/* A bound on how much the velocity of any vertex changes at once where piece k of body i's path
   begins. Infinite where that of the angular velocity is, and of a path of positions. */
static double kink_of(const mote_impact_search *s, int i, uint32_t k)
{
    if (s->lines[i] || s->body[i].field->numbers > 0)
        return HUGE_VAL;
    const mote_path *path = s->question->path[i];
    const mote_path_piece *a = &path->pieces[k - 1], *b = &path->pieces[k];
    const double turn = turn_kink(a, b);
    if (!(turn < HUGE_VAL))
        return HUGE_VAL;
    const mote_vec3 end = mote_sub(a->centre[3], a->centre[2]);
    const mote_vec3 start = mote_sub(b->centre[1], b->centre[0]);
    double size = 0; /* of what turns */
    if (turn > 0) {
        size = s->groups[i].size + mote_length(path->pivot);
        for (uint32_t j = 0; j < s->body[i].field->count && b->weights; ++j) {
            const size_t padded = s->body[i].field->padded;
            const mote_vec3 w = {b->weights[j], b->weights[padded + j],
                                 b->weights[2 * padded + j]};
            size += s->groups[i].most_of_all[j] * mote_length(w);
        }
    }
    return (3 * mote_length(mote_sub(start, end)) + turn * size + weights_kink(s, i, a, b)) *
           (1 + 1e-9);
}

const mote_impact_rate *mote_impact_rate_of(mote_impact_search *s, uint32_t k)
{
    mote_impact_rate *rate = &s->rates[k];
    if (rate->known)
        return rate;
    mote_impact_motion own[2];
    mote_vec3 centre[2][4], between[4];
    for (int i = 0; i < 2; ++i) {
        if (s->lines[i]) {
            own[i] = motion_of_lines(s, i, k, centre[i]);
            continue;
        }
        own[i] = motion_of(s, i, k);
        memcpy(centre[i], s->question->path[i]->pieces[k].centre, sizeof centre[i]);
    }
    const mote_impact_motion a = own[0], b = own[1];
    for (int i = 0; i < 4; ++i)
        between[i] = mote_sub(centre[1][i], centre[0][i]);
    const cubic_bounds pivots = bounds_of(between);
    /* Control points far from the origin lose digits in the difference: the noise has more. */
    rate->noise = a.noise + b.noise;
    rate->speed = (a.speed + b.speed + pivots.rate) * (1 + 1e-9) + rate->noise;
    rate->acceleration =
        (a.acceleration + b.acceleration + pivots.change) * (1 + 1e-9) + rate->noise;
    rate->turn = fmax(a.turn, b.turn);
    const mote_impact_question *q = s->question;
    const bool first = k <= mote_path_place(q->path[0], q->begin).piece;
    rate->kink = first ? 0 : kink_of(s, 0, k) + kink_of(s, 1, k);
    rate->known = true;
    return rate;
}
