#include "harness/scene/approach.h"

#include "harness/scene/motion.h"
#include "harness/scene/probe.h"

#include <math.h>
#include <stdlib.h>

#define ORACLE "fcl-aabb"
#define STEPS_MAX 2000
#define PRECISION 1e-4 /* of L */

typedef struct approach {
    const mote_scenario *scenario;
    mote_probe *probe;
    mote_frame frame;
    mote_vec3 direction, base; /* body 1's centre is at base + offset * direction */
    mote_vec3 still;           /* its translation with the centre at the origin */
} approach;

static mote_status distance_at(approach *a, double offset, double *distance)
{
    mote_answer answer;
    const mote_vec3 centre = mote_add_scaled(a->base, offset, a->direction);
    a->frame.body[1].pose.translation = mote_add(a->still, centre);
    mote_status status = mote_probe_answer(a->probe, &a->frame, &answer);
    if (status == MOTE_OK)
        *distance = answer.distance;
    return status;
}

/* An offset at which the deformed bodies cannot be closer than the gap. */
static double far_offset(approach *a, double gap)
{
    const mote_frame *frame = &a->frame;
    const mote_body_motion *motion = a->scenario->motion->body;
    double radius = gap;
    for (int i = 0; i < 2; ++i) {
        const mote_vec3 *world = mote_probe_vertices(a->probe, frame, i);
        const mote_vec3 centre = mote_pose_apply(&frame->body[i].pose, motion[i].centre);
        double square = 0;
        for (uint32_t v = 0; v < a->scenario->body[i].mesh->vertex_count; ++v)
            square = fmax(square, mote_distance_squared(world[v], centre));
        radius += sqrt(square);
    }
    return radius;
}

/* A body moved by x comes closer by x at most, so that each step is safe, and the steps end at
   the first place with the wished distance. */
static mote_status solve_frame(approach *a, double gap, double *offset)
{
    const double length = a->scenario->length;
    const double wished = fmax(gap, 0) * length;
    double at = far_offset(a, wished);
    for (int step = 0; step < STEPS_MAX; ++step) {
        double distance;
        mote_status status = distance_at(a, at, &distance);
        if (status != MOTE_OK)
            return status;
        const double left = distance - wished;
        /* A touch of zero is met only in the limit: stop just short of it. */
        if (left <= PRECISION * length) {
            *offset = at + fmin(gap, 0) * length;
            return MOTE_OK;
        }
        at -= left;
        if (at < -4 * length)
            return mote_fail(MOTE_EINVAL,
                             "the bodies pass each other without coming as close as "
                             "%g L; aim body 1 at body 0",
                             gap);
    }
    return mote_fail(MOTE_EINVAL,
                     "the bodies slide along each other at hardly more than %g L; wish another "
                     "gap there, or aim body 1 at body 0",
                     gap);
}

mote_status mote_approach_solve(const mote_scenario *scenario, const mote_approach_plan *plan,
                                mote_vec3 *positions)
{
    approach a = {.scenario = scenario};
    mote_method_choice choice;
    mote_frame_buffer *buffer = NULL;
    const double norm = mote_length(plan->direction);
    a.direction = mote_scale(plan->direction, 1 / norm);
    mote_status status = mote_method_choice_read(ORACLE, &choice);
    if (status == MOTE_OK)
        status = mote_probe_create(&scenario->body[0], &scenario->body[1], &choice,
                                   MOTE_ASK_DISTANCE, 0, 0, &a.probe);
    if (status == MOTE_OK)
        status = mote_frame_buffer_create(scenario, &buffer);
    const mote_body_motion *motion = scenario->motion->body;
    for (uint32_t k = 0; k < plan->count && status == MOTE_OK; ++k) {
        a.frame = *mote_scenario_frame(scenario, buffer, plan->frames[k], 0);
        a.frame.number = k + 1;
        a.base = mote_pose_apply(&a.frame.body[0].pose, motion[0].centre);
        a.still = mote_scale(mote_rotate(&a.frame.body[1].pose.rotation, motion[1].centre), -1);
        double offset = 0;
        status = solve_frame(&a, plan->gaps[k], &offset);
        if (status == MOTE_OK)
            positions[k] = mote_add_scaled(a.base, offset, a.direction);
        else
            status = mote_fail(status, "frame %u: %s", plan->frames[k], mote_error_text());
    }
    mote_frame_buffer_destroy(buffer);
    mote_probe_destroy(a.probe);
    return status;
}
