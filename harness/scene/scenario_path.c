#include "harness/scene/scenario_path.h"

#include "harness/base/hash.h"
#include "harness/base/memory.h"
#include "harness/scene/motion.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* A body at a frame. */
typedef struct key {
    mote_vec3 centre;
    mote_quaternion turn;
    double *weights; /* [3][padded], in the body's axes */
} key;

struct mote_scenario_path {
    const mote_scenario *scenario;
    uint32_t step;
    struct {
        key *keys;               /* [step + 3], from the frame before the first on */
        mote_path_piece *pieces; /* [step] */
        double *weights;         /* [step][4][3][padded] */
        mote_vec3 *displacement; /* [count] */
        mote_path path;
    } body[2];
};

mote_status mote_scenario_path_create(const mote_scenario *scenario, uint32_t step,
                                      mote_scenario_path **path)
{
    for (int i = 0; i < 2; ++i) {
        const mote_field *field = scenario->body[i].field;
        if (mote_body_is_given(&scenario->body[i]))
            return mote_fail(MOTE_EUNSUPPORTED,
                             "the paths of body %d's vertices between frames are not known: "
                             "only positions are given",
                             i);
        if (field->count > 0 && !field->kind->basis)
            return mote_fail(MOTE_EUNSUPPORTED,
                             "body %d deforms by %s, which is not linear in its weights: paths "
                             "between frames are of bodies that are",
                             i, field->kind->name);
    }
    mote_scenario_path *made = mote_allocate(1, sizeof *made);
    made->scenario = scenario;
    made->step = step;
    for (int i = 0; i < 2; ++i) {
        const mote_field *field = scenario->body[i].field;
        const size_t padded = field->padded;
        made->body[i].keys = mote_allocate(step + 3, sizeof *made->body[i].keys);
        made->body[i].pieces = mote_allocate(step, sizeof *made->body[i].pieces);
        made->body[i].weights = mote_allocate(12 * padded * step + 1, sizeof(double));
        made->body[i].displacement = mote_allocate(field->count + 1, sizeof(mote_vec3));
        for (uint32_t k = 0; k < step + 3; ++k)
            made->body[i].keys[k].weights = mote_allocate(3 * padded + 1, sizeof(double));
        for (uint32_t k = 0; k < step; ++k)
            made->body[i].pieces[k].weights =
                padded > 0 ? made->body[i].weights + 12 * padded * k : NULL;
        made->body[i].path = (mote_path){.pivot = scenario->motion->body[i].centre,
                                         .pieces = made->body[i].pieces,
                                         .count = step};
    }
    *path = made;
    return MOTE_OK;
}

void mote_scenario_path_destroy(mote_scenario_path *path)
{
    if (!path)
        return;
    for (int i = 0; i < 2; ++i) {
        for (uint32_t k = 0; k < path->step + 3; ++k)
            free(path->body[i].keys[k].weights);
        free(path->body[i].keys);
        free(path->body[i].pieces);
        free(path->body[i].weights);
        free(path->body[i].displacement);
    }
    free(path);
}

static mote_quaternion turn_at(const mote_body_motion *motion, double place)
{
    double q[4] = {1, 0, 0, 0};
    if (motion->rotation)
        mote_curve_evaluate(motion->rotation, place, q);
    return mote_quaternion_normalise((mote_quaternion){q[0], q[1], q[2], q[3]});
}

static void set_key(mote_scenario_path *path, int i, double place, key *at)
{
    const mote_body_motion *motion = &path->scenario->motion->body[i];
    const mote_field *field = path->scenario->body[i].field;
    const mote_pose pose = mote_motion_pose(motion, place);
    at->centre = mote_pose_apply(&pose, motion->centre);
    at->turn = turn_at(motion, place);
    if (field->count == 0)
        return;
    mote_vec3 *w = path->body[i].displacement;
    mote_motion_displacements(motion, place, w);
    if (motion->fit) {
        const mote_status status = mote_csrbf_fit_solve(motion->fit, w, w);
        assert(status == MOTE_OK); /* every number of a scenario was range-checked */
        (void)status;
    }
    for (uint32_t j = 0; j < field->count; ++j) {
        at->weights[j] = w[j].x;
        at->weights[field->padded + j] = w[j].y;
        at->weights[2 * (size_t)field->padded + j] = w[j].z;
    }
}

/* The two inner control points between b and c, a being before and d behind them. */
static double second_of(double a, double b, double c)
{
    return b + (c - a) / 6;
}

static mote_quaternion turn_between(mote_quaternion a, mote_quaternion b, mote_quaternion c)
{
    return (mote_quaternion){second_of(a.w, b.w, c.w), second_of(a.x, b.x, c.x),
                             second_of(a.y, b.y, c.y), second_of(a.z, b.z, c.z)};
}

static mote_vec3 half_apart(mote_vec3 a, mote_vec3 b)
{
    return mote_scale(mote_sub(b, a), 0.5);
}

/* keys[0 .. 3]: the frame before the piece, its two ends, and the frame behind it. */
static void set_piece(const key *keys, size_t padded, mote_path_piece *piece, double *weights)
{
    mote_path_hermite(keys[1].centre, half_apart(keys[0].centre, keys[2].centre),
                      keys[2].centre, half_apart(keys[1].centre, keys[3].centre),
                      piece->centre);
    piece->spins = false;
    piece->turn[0] = keys[1].turn;
    piece->turn[1] = turn_between(keys[0].turn, keys[1].turn, keys[2].turn);
    piece->turn[2] = turn_between(keys[3].turn, keys[2].turn, keys[1].turn);
    piece->turn[3] = keys[2].turn;
    for (size_t j = 0; j < 3 * padded; ++j) {
        const double a = keys[0].weights[j], b = keys[1].weights[j];
        const double c = keys[2].weights[j], d = keys[3].weights[j];
        weights[j] = b;
        weights[3 * padded + j] = second_of(a, b, c);
        weights[6 * padded + j] = second_of(d, c, b);
        weights[9 * padded + j] = c;
    }
}

void mote_scenario_path_set(mote_scenario_path *path, uint32_t frame)
{
    const mote_motion *motion = path->scenario->motion;
    for (int i = 0; i < 2; ++i) {
        const size_t padded = path->scenario->body[i].field->padded;
        key *keys = path->body[i].keys;
        for (uint32_t k = 0; k < path->step + 3; ++k) {
            const double number = (double)frame + k - 1;
            set_key(path, i, motion->start + (number - 1) * motion->pace, &keys[k]);
            const mote_quaternion a = keys[k > 0 ? k - 1 : 0].turn, b = keys[k].turn;
            if (a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0)
                keys[k].turn = (mote_quaternion){-b.w, -b.x, -b.y, -b.z};
        }
        for (uint32_t k = 0; k < path->step; ++k)
            set_piece(&keys[k], padded, &path->body[i].pieces[k],
                      path->body[i].weights + 12 * padded * k);
    }
}

const mote_path *mote_scenario_path_of(const mote_scenario_path *path, int i)
{
    return &path->body[i].path;
}

static uint64_t hash_piece(uint64_t hash, const mote_path_piece *piece, size_t padded)
{
    hash = mote_hash_bytes(hash, piece->centre, sizeof piece->centre);
    hash = mote_hash_bytes(hash, piece->turn, sizeof piece->turn);
    return piece->weights
               ? mote_hash_bytes(hash, piece->weights, 12 * padded * sizeof *piece->weights)
               : hash;
}

mote_status mote_scenario_path_fingerprint(const mote_scenario *scenario, uint64_t *fingerprint)
{
    mote_scenario_path *path = NULL;
    const mote_status status = mote_scenario_path_create(scenario, 1, &path);
    if (status != MOTE_OK)
        return status;
    for (int i = 0; i < 2; ++i)
        *fingerprint = mote_hash_bytes(*fingerprint, &path->body[i].path.pivot,
                                       sizeof path->body[i].path.pivot);
    for (uint32_t frame = 1; frame < scenario->frames; ++frame) {
        mote_scenario_path_set(path, frame);
        for (int i = 0; i < 2; ++i)
            *fingerprint = hash_piece(*fingerprint, path->body[i].path.pieces,
                                      scenario->body[i].field->padded);
    }
    mote_scenario_path_destroy(path);
    return MOTE_OK;
}
