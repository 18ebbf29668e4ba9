#include "harness/run/scene_referee.h"

#include <float.h>
#include <math.h>

#define FRAMES 24
#define AGREEMENT 1e-12 /* of L */
#define VERTICES 2e6    /* of the bodies that one is compared with */

typedef struct box {
    mote_vec3 low, high;
} box;

bool mote_scene_referee_wants(const mote_subject *subject, uint32_t frame)
{
    const uint64_t frames = subject->bodies->frames, k = frame - 1;
    return frames <= FRAMES || k * FRAMES / frames != (k + 1) * FRAMES / frames;
}

static const mote_body *body_of(const mote_bodies *bodies, uint32_t i)
{
    return &bodies->shapes[bodies->shape_of[i]].body;
}

static mote_status measure(const mote_bodies *bodies, const mote_body_state *states,
                           uint32_t first, uint32_t second, double *distance)
{
    const mote_body pair[2] = {*body_of(bodies, first), *body_of(bodies, second)};
    mote_frame frame = {.number = 1, .body = {states[first], states[second]}};
    mote_answer answer;
    mote_engine *engine = NULL;
    for (int b = 0; b < 2; ++b)
        frame.body[b].shape_changed = frame.body[b].pose_changed = true;
    mote_status status = mote_engine_open_distance(pair, "brute-force", &engine);
    if (status == MOTE_OK)
        status = mote_engine_answer(engine, &frame, &answer);
    if (status == MOTE_OK)
        *distance = answer.distance;
    mote_engine_destroy(engine);
    return status;
}

static mote_status judge_pair(const mote_bodies *bodies, uint32_t frame,
                              const mote_body_state *states, const mote_near_pair *pair)
{
    const mote_answer *said = &pair->answer;
    const double agreement = AGREEMENT * bodies->length;
    const uint32_t a = pair->body[0], b = pair->body[1];
    double distance = 0;
    const mote_status status = measure(bodies, states, a, b, &distance);
    if (status != MOTE_OK)
        return status;
    if (said->has_distance && !(fabs(said->distance - distance) <= agreement))
        return mote_fail(MOTE_ENUMERIC,
                         "%s: frame %u: bodies %u and %u are %.17g apart, not %.17g: brute "
                         "force",
                         bodies->path, frame, a + 1, b + 1, distance, said->distance);
    if (said->has_contact && said->contact != (distance <= bodies->tolerance) &&
        !(fabs(distance - bodies->tolerance) <= agreement))
        return mote_fail(MOTE_ENUMERIC,
                         "%s: frame %u: bodies %u and %u are %.17g apart, which is %scontact: "
                         "brute force",
                         bodies->path, frame, a + 1, b + 1, distance,
                         said->contact ? "no " : "");
    return MOTE_OK;
}

/* The first pair from `from` on, cyclically, that is in contact or not. */
static const mote_near_pair *choose(const mote_near_pair *pairs, size_t count, size_t from,
                                    bool contact)
{
    for (size_t k = 0; k < count; ++k) {
        const mote_near_pair *pair = &pairs[(from + k) % count];
        if (pair->answer.contact == contact)
            return pair;
    }
    return NULL;
}

static box box_of(const mote_bodies *bodies, const mote_body_state *states, uint32_t i)
{
    const mote_body *body = body_of(bodies, i);
    box b = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
    for (uint32_t v = 0; v < body->mesh->vertex_count; ++v) {
        const mote_vec3 p = mote_body_position(body, &states[i], v);
        b.low = mote_vec3_make(fmin(b.low.x, p.x), fmin(b.low.y, p.y), fmin(b.low.z, p.z));
        b.high = mote_vec3_make(fmax(b.high.x, p.x), fmax(b.high.y, p.y), fmax(b.high.z, p.z));
    }
    return b;
}

static double gap_of(const box *a, const box *b)
{
    const mote_vec3 p = mote_sub(a->low, b->high), q = mote_sub(b->low, a->high);
    return mote_length(mote_vec3_make(fmax(0, fmax(p.x, q.x)), fmax(0, fmax(p.y, q.y)),
                                      fmax(0, fmax(p.z, q.z))));
}

static bool is_listed(const mote_near_pair *pairs, size_t count, uint32_t a, uint32_t b)
{
    for (size_t k = 0; k < count; ++k) {
        if (pairs[k].body[0] == (a < b ? a : b) && pairs[k].body[1] == (a < b ? b : a))
            return true;
    }
    return false;
}

static mote_status judge_neighbours(const mote_bodies *bodies, uint32_t frame,
                                    const mote_body_state *states, const mote_near_pair *pairs,
                                    size_t count, uint32_t own)
{
    const box own_box = box_of(bodies, states, own);
    double vertices = 0;
    for (uint32_t k = 1; k < bodies->count && vertices < VERTICES; ++k) {
        const uint32_t other = (own + k) % bodies->count;
        vertices += body_of(bodies, other)->mesh->vertex_count;
        if (is_listed(pairs, count, own, other))
            continue;
        const box other_box = box_of(bodies, states, other);
        if (gap_of(&own_box, &other_box) > bodies->near)
            continue;
        double distance = 0;
        const mote_status status = measure(bodies, states, own, other, &distance);
        if (status != MOTE_OK)
            return status;
        if (distance <= bodies->near - AGREEMENT * bodies->length)
            return mote_fail(MOTE_ENUMERIC,
                             "%s: frame %u: bodies %u and %u are %.17g apart and not among the "
                             "near pairs, which are those up to %.17g: brute force",
                             bodies->path, frame, own + 1, other + 1, distance, bodies->near);
    }
    return MOTE_OK;
}

mote_status mote_scene_referee_judge(const mote_subject *subject, uint32_t frame,
                                     const mote_body_state *states, const mote_near_pair *pairs,
                                     size_t count, uint32_t *checked)
{
    const mote_bodies *bodies = subject->bodies;
    const uint64_t drawn = (uint64_t)frame * 0x9e3779b97f4a7c15u >> 32;
    mote_status status = MOTE_OK;
    for (int contact = 0; contact < 2 && count > 0 && status == MOTE_OK; ++contact) {
        const mote_near_pair *pair = choose(pairs, count, drawn % count, contact);
        if (!pair)
            continue;
        status = judge_pair(bodies, frame, states, pair);
        ++*checked;
    }
    return status == MOTE_OK ? judge_neighbours(bodies, frame, states, pairs, count,
                                                (uint32_t)(drawn % bodies->count))
                             : status;
}
