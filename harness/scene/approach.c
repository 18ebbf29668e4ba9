#include "harness/scene/approach.h"

#include "harness/scene/motion.h"
#include "core/body/deform.h"
#include "harness/base/memory.h"
#include "harness/engine/engine.h"

#include <math.h>
#include <stdlib.h>

#define SEARCH "certified" /* exact, and the fastest where only the position changes */
#define ORACLE "fcl-aabb"  /* another exact method, for verification */
#define STEPS_MAX 2000     /* queries per frame */
#define PRECISION 1e-4     /* of the smaller body's L */
#define ROUNDING 1e-13     /* of the pair's L: the accuracy of distances */
#define VERIFIED 1e-3      /* of the pair's L */

typedef struct approach {
    const mote_scenario *scenario;
    const mote_approach_plan *plan;
    mote_engine *engine;
    mote_frame frame;
    mote_deform *deform[2];
    mote_vec3 *world[2];       /* vertices */
    mote_vec3 direction, base; /* body 1's centre is at base + offset * direction */
    mote_vec3 still;           /* its translation with the centre at the origin */
    double precision;          /* absolute */
} approach;

static mote_status distance_at(approach *a, double offset, double *distance)
{
    mote_answer answer;
    const mote_vec3 centre = mote_add_scaled(a->base, offset, a->direction);
    a->frame.body[1].pose.translation = mote_add(a->still, centre);
    mote_status status = mote_engine_answer(a->engine, &a->frame, &answer);
    if (status == MOTE_OK)
        *distance = answer.distance;
    return status;
}

/* Sets base, and an offset at which the deformed bodies are at least the gap apart. */
static double start_far(approach *a, double gap)
{
    const mote_frame *frame = &a->frame;
    const mote_body_motion *motion = a->scenario->motion->body;
    mote_vec3 centres[2], tips[2];
    double radius = gap;
    for (int i = 0; i < 2; ++i) {
        mote_vec3 *world = a->world[i];
        double square = 0;
        mote_deform_all(a->deform[i], &frame->body[i], world);
        centres[i] = mote_pose_apply(&frame->body[i].pose, motion[i].centre);
        tips[i] = a->plan->tips ? world[a->plan->tips[i]] : centres[i];
        for (uint32_t v = 0; v < a->scenario->body[i].mesh->vertex_count; ++v)
            square = fmax(square, mote_distance_squared(world[v], centres[i]));
        radius += sqrt(square);
    }
    a->base = mote_add(tips[0], mote_sub(centres[1], tips[1]));
    return radius + mote_length(mote_sub(a->base, centres[0]));
}

/* Pushes body 1 on from first contact; by less and less if the surfaces must cross. */
static mote_status push(approach *a, double first, double depth, double *offset)
{
    /* A push hardly larger than the gap left before contact might not make the surfaces
       cross. */
    double pushed = a->plan->must_touch ? fmax(depth, 16 * a->precision) : depth;
    double distance = 0;
    mote_status status = MOTE_OK;
    do {
        *offset = first - pushed;
        if (a->plan->must_touch)
            status = distance_at(a, *offset, &distance);
        pushed = pushed / 2;
    } while (status == MOTE_OK && distance > 0 && pushed > a->precision / 16);
    if (status == MOTE_OK && distance > 0)
        status = mote_fail(MOTE_EINVAL, "the bodies touch without crossing");
    return status;
}

/* When a body moves by x, the distance shrinks by at most x. So no step goes too far, and the
   steps end at the first place with the requested distance. */
static mote_status solve_frame(approach *a, double gap, double *offset)
{
    const double length = a->scenario->length;
    const double wished = fmax(gap, 0) * length;
    double at = start_far(a, wished);
    const double end = -at - 4 * length;
    for (int step = 0; step < STEPS_MAX; ++step) {
        double distance;
        mote_status status = distance_at(a, at, &distance);
        if (status != MOTE_OK)
            return status;
        const double left = distance - wished;
        *offset = at;
        /* The steps reach contact only in the limit, so stop just before it. */
        if (left <= a->precision)
            return gap < 0 ? push(a, at, -gap * length, offset) : MOTE_OK;
        at -= left;
        if (at < end)
            return mote_fail(MOTE_EINVAL,
                             "the bodies pass each other without coming as close as "
                             "%g L; aim body 1 at body 0",
                             gap);
    }
    return mote_fail(MOTE_EINVAL,
                     "the bodies slide along each other at hardly more than %g L; ask for "
                     "another gap there, or aim body 1 at body 0",
                     gap);
}

/* The position of body 1's centre at frame k of the plan. */
static mote_status solve(approach *a, mote_frame_buffer *buffer, uint32_t k,
                         mote_vec3 *position)
{
    const mote_body_motion *motion = a->scenario->motion->body;
    double offset = 0;
    const mote_frame *frame = mote_scenario_frame(a->scenario, buffer, a->plan->frames[k], 0);
    if (!frame)
        return mote_error_status();
    a->frame = *frame;
    a->frame.number = k + 1;
    a->still = mote_scale(mote_rotate(&a->frame.body[1].pose.rotation, motion[1].centre), -1);
    mote_status status = solve_frame(a, a->plan->gaps[k], &offset);
    if (status == MOTE_OK)
        *position = mote_add_scaled(a->base, offset, a->direction);
    else
        status = mote_fail(status, "frame %u: %s", a->plan->frames[k], mote_error_text());
    return status;
}

mote_status mote_approach_solve(const mote_scenario *scenario, const mote_approach_plan *plan,
                                mote_vec3 *positions)
{
    for (int i = 0; i < 2; ++i) {
        if (mote_body_is_given(&scenario->body[i]))
            return mote_fail(MOTE_EUNSUPPORTED,
                             "%s: of body %d positions are given, and a motion is found for "
                             "bodies with a field and rigid ones only; name one mesh as its "
                             "\"file\", without \"positions\"",
                             scenario->path, i);
    }
    const double smaller =
        fmin(scenario->body[0].mesh->diagonal, scenario->body[1].mesh->diagonal);
    approach a = {.scenario = scenario,
                  .plan = plan,
                  .precision = fmax(PRECISION * smaller, ROUNDING * scenario->length)};
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    a.direction = mote_scale(plan->direction, 1 / mote_length(plan->direction));
    mote_status status = mote_engine_open_distance(scenario->body, SEARCH, &a.engine);
    for (int i = 0; i < 2; ++i) {
        a.world[i] = mote_allocate(scenario->body[i].mesh->vertex_count, sizeof *a.world[i]);
        if (status == MOTE_OK)
            status = mote_deform_create(&scenario->body[i], &a.deform[i]);
    }
    for (uint32_t k = 0; k < plan->count && status == MOTE_OK; ++k)
        status = solve(&a, buffer, k, &positions[k]);
    mote_frame_buffer_destroy(buffer);
    mote_engine_destroy(a.engine);
    for (int i = 0; i < 2; ++i) {
        mote_deform_destroy(a.deform[i]);
        free(a.world[i]);
    }
    return status;
}

static mote_status verify_frame(const mote_scenario *scenario, mote_engine *engine,
                                const mote_frame *frame, double gap)
{
    mote_answer answer;
    mote_status status = mote_engine_answer(engine, frame, &answer);
    if (status != MOTE_OK)
        return status;
    const double found = answer.distance / scenario->length;
    const bool met =
        gap > -VERIFIED ? fabs(found - fmax(gap, 0)) <= VERIFIED : answer.distance == 0;
    return met ? MOTE_OK
               : mote_fail(MOTE_ENUMERIC,
                           "frame %u: the distance is %g L where a gap of %g was asked for; "
                           "ask for another gap there, or another --direction",
                           (unsigned)frame->number, found, gap);
}

mote_status mote_approach_verify(const mote_scenario *scenario, const uint32_t *frames,
                                 const double *gaps, uint32_t count)
{
    mote_engine *engine = NULL;
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    mote_status status = mote_engine_open_distance(scenario->body, ORACLE, &engine);
    for (uint32_t k = 0; k < count && status == MOTE_OK; ++k)
        status = verify_frame(scenario, engine,
                              mote_scenario_frame(scenario, buffer, frames[k], 0), gaps[k]);
    mote_frame_buffer_destroy(buffer);
    mote_engine_destroy(engine);
    return status;
}
