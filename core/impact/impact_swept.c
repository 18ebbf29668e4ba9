/* A box around a body over a whole piece of its path.

   In a piece, a vertex of a group is at c + R (m - pivot + d), where c lies in the hull of its
   control points, m is the middle of the group's ball at rest, and |d| is at most the ball's
   radius plus sum_j most_j |w_j|, with the largest of w_j's control points. With W a bound of
   the angle by which R has turned since the start of the piece, R (m - pivot) is within min(W,
   2) |m - pivot| of R_0 (m - pivot), since a chord is no longer than its arc, and within |m -
   pivot| of 0. Either box holds the group, so that their intersection does; a body that turns
   far is held by the second, one that hardly turns by the first.

   Of a skin, of which impact_bones.h bounds how far each group gets from the pivot, only the
   second box is known, with that bound. */
#include "core/impact/impact_swept.h"

#include "core/body/path_place.h"

/* How far the weights of a piece move the vertices of group g, at most. */
static double displaced(const mote_impact_groups *groups, const mote_body *body,
                        const mote_path_piece *piece, uint32_t g)
{
    const size_t count = body->field->count, padded = body->field->padded;
    double sum = 0, all = 0;
    for (size_t j = 0; piece->weights && j < count; ++j) {
        double most = 0;
        for (size_t i = 0; i < 4; ++i) {
            const double *w = piece->weights + 3 * padded * i + j;
            const double x = w[0], y = w[padded], z = w[2 * padded];
            most = fmax(most, x * x + y * y + z * z);
            all += x + y + z;
        }
        sum += groups->most[j * groups->padded + g] * sqrt(most);
    }
    return sum + 0 * all; /* NaN if one is not finite, which fmax would leave out */
}

/* A bound of the angle by which a piece turns. */
static double turned(const mote_path_piece *piece)
{
    if (piece->spins)
        return mote_length(piece->spin);
    double rate = 0;
    for (int i = 0; i < 3; ++i) {
        const mote_quaternion a = piece->turn[i], b = piece->turn[i + 1];
        const double w = b.w - a.w, x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
        rate = fmax(rate, 3 * sqrt(w * w + x * x + y * y + z * z));
    }
    const double least = mote_path_least_turn(piece);
    return least > 0 ? 2 * rate / least : HUGE_VAL;
}

static void widen(double low, double high, double *box_low, double *box_high)
{
    *box_low = fmin(*box_low, low);
    *box_high = fmax(*box_high, high);
}

static bool has_numbers(const mote_path_piece *piece, size_t padded)
{
    double all = 0;
    for (size_t j = 0; piece->weights && j < 12 * padded; ++j)
        all += 0 * piece->weights[j];
    return all >= 0;
}

/* Bounds of a group in a piece: within `reach` of `at` and within `far` of 0, as seen from the
   pivot. */
typedef struct ball {
    mote_vec3 at;
    double reach, far;
} ball;

/* Sets the balls of all groups; returns a bound of the sizes of what weights add, infinite
   where a number is not finite. */
static double find_balls(const mote_impact_groups *groups, const mote_body *body,
                         const mote_path *path, const mote_path_piece *piece,
                         ball balls[MOTE_IMPACT_GROUPS])
{
    const mote_impact_balls at_rest = {groups->count, groups->padded, groups->middle,
                                       groups->radius};
    const mote_mat3 start = mote_path_rotation(piece, 0);
    const double angle = fmin(turned(piece), 2);
    double sums[3 * MOTE_IMPACT_GROUPS], grown = 0;
    if (groups->bones) {
        grown = mote_impact_bones_bound(groups->bones, &at_rest, body->field, piece->weights,
                                        path->pivot, mote_vec3_make(0, 0, 0), sums);
        for (uint32_t g = 0; g < groups->count; ++g)
            balls[g] = (ball){{0, 0, 0}, sums[g], sums[g]};
        return has_numbers(piece, body->field->padded) ? grown : HUGE_VAL;
    }
    for (uint32_t g = 0; g < groups->count; ++g) {
        const mote_vec3 arm = mote_sub(groups->middle[g], path->pivot);
        const double moved = displaced(groups, body, piece, g), length = mote_length(arm);
        const double radius = groups->radius[g] + moved;
        if (!(moved < HUGE_VAL))
            return HUGE_VAL;
        balls[g] = (ball){mote_rotate(&start, arm), angle * length + radius, length + radius};
        grown = fmax(grown, moved);
    }
    return grown;
}

/* Adds a ball's range along an axis: of middle `at`, within `reach` of it, and within `far` of
   0, around the control points' range. */
static void add_range(double at, double reach, double far, const double centre[2], double *low,
                      double *high)
{
    widen(centre[0] + fmax(at - reach, -far), centre[1] + fmin(at + reach, far), low, high);
}

/* A vertex that goes straight is between its ends, but for the rounding of positions between.
 */
void mote_impact_swept_lines(const mote_path *path, uint32_t count, uint32_t k,
                             mote_scene_box *box)
{
    mote_vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    mote_vec3 high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    double all = 0;
    for (uint32_t end = k; end <= k + 1; ++end) {
        for (uint32_t v = 0; v < count; ++v) {
            const mote_vec3 p = mote_position_at(&path->positions[end], v);
            widen(p.x, p.x, &low.x, &high.x);
            widen(p.y, p.y, &low.y, &high.y);
            widen(p.z, p.z, &low.z, &high.z);
            all += p.x + p.y + p.z;
        }
    }
    const double size = fmax(mote_length(low), mote_length(high));
    const double margin = 0x1p-40 * size + 0 * all; /* NaN as above */
    box->low = mote_vec3_make(low.x - margin, low.y - margin, low.z - margin);
    box->high = mote_vec3_make(high.x + margin, high.y + margin, high.z + margin);
}

void mote_impact_swept_box(const mote_impact_groups *groups, const mote_body *body,
                           const mote_path *path, uint32_t k, mote_scene_box *box)
{
    const mote_path_piece *piece = &path->pieces[k];
    ball balls[MOTE_IMPACT_GROUPS] = {{.far = 0}};
    double x[2] = {HUGE_VAL, -HUGE_VAL}, y[2] = {HUGE_VAL, -HUGE_VAL},
           z[2] = {HUGE_VAL, -HUGE_VAL}, size = mote_length(path->pivot) + groups->size;
    for (int i = 0; i < 4; ++i) {
        const mote_vec3 c = piece->centre[i];
        widen(c.x, c.x, &x[0], &x[1]);
        widen(c.y, c.y, &y[0], &y[1]);
        widen(c.z, c.z, &z[0], &z[1]);
        const mote_quaternion q = piece->turn[piece->spins ? 0 : i];
        size += mote_length(c) + 0 * (q.w + q.x + q.y + q.z); /* NaN as above */
    }
    mote_vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    mote_vec3 high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    const double grown = find_balls(groups, body, path, piece, balls);
    for (uint32_t g = 0; g < groups->count; ++g) {
        const ball *b = &balls[g];
        add_range(b->at.x, b->reach, b->far, x, &low.x, &high.x);
        add_range(b->at.y, b->reach, b->far, y, &low.y, &high.y);
        add_range(b->at.z, b->reach, b->far, z, &low.z, &high.z);
    }
    /* more than the rounding of positions (impact_rate.c) and of these sums */
    const double spin = piece->spins ? mote_length(piece->spin) : 0;
    const double margin =
        (size + grown) * (0x1p-40 * (1 + body->field->most / 1024.0) + 0x1p-48 * spin);
    box->low = mote_vec3_make(low.x - margin, low.y - margin, low.z - margin);
    box->high = mote_vec3_make(high.x + margin, high.y + margin, high.z + margin);
}
