#include "harness/loop/cast.h"

#include "harness/base/memory.h"

#include <assert.h>
#include <stdlib.h>

typedef struct scene_cast {
    const mote_bodies *bodies;
    const mote_simulation_options *options;
    const mote_mass *masses;
    mote_bodies_frame frame;
} scene_cast;

static void *scene_create(const mote_subject *subject, const mote_simulation_options *options,
                          const mote_mass *masses)
{
    scene_cast *made = mote_allocate(1, sizeof *made);
    made->bodies = subject->bodies;
    made->options = options;
    made->masses = masses;
    made->frame = mote_bodies_frame_create(made->bodies);
    return made;
}

static void scene_destroy(void *cast)
{
    scene_cast *s = cast;
    mote_bodies_frame_free(&s->frame);
    free(s);
}

static void scene_restart(void *cast, const mote_simulation_start *start)
{
    (void)cast;
    (void)start;
}

static const mote_body_state *scene_show(void *cast, uint32_t k, const mote_rigid_state *states)
{
    scene_cast *s = cast;
    for (uint32_t i = 0; i < s->bodies->count; ++i) {
        const mote_pose pose = mote_rigid_pose(&s->masses[s->bodies->shape_of[i]], &states[i]);
        const mote_status status =
            mote_bodies_deform(s->bodies, i, 1 + k * s->options->time_step, &pose, &s->frame);
        assert(status == MOTE_OK); /* bodies without fields were refused */
        (void)status;
    }
    return s->frame.states;
}

static void scene_weigh(void *cast, double frames, double *const *weights)
{
    scene_cast *s = cast;
    const mote_pose still = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}};
    for (uint32_t i = 0; i < s->bodies->count; ++i) {
        mote_bodies_deform(s->bodies, i, 1 + frames, &still, &s->frame);
        mote_cast_weights(s->bodies->shapes[s->bodies->shape_of[i]].body.field,
                          &s->frame.states[i], weights[i]);
    }
}

const mote_cast_kind mote_cast_scene = {scene_create, scene_destroy, scene_restart,
                                        scene_show,   scene_weigh,   NULL};
