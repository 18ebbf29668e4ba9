#include "harness/loop/stage.h"

#include "harness/base/memory.h"
#include "harness/run/subject.h"
#include "harness/base/clock.h"

#include <stdlib.h>

typedef struct scene_stage {
    mote_bodies bodies; /* the scenario with the tolerance of contact; borrows all of it */
    mote_method_choice choice;
    const mote_simulation_options *options;
    const mote_mass *masses;
    mote_engine *method, *truth;
    mote_bodies_frame frame;
} scene_stage;

static void scene_destroy(void *state)
{
    scene_stage *s = state;
    if (!s)
        return;
    mote_engine_destroy(s->method);
    mote_engine_destroy(s->truth);
    mote_bodies_frame_free(&s->frame);
    free(s);
}

/* An engine for the bodies, built. */
static mote_status open_engine(scene_stage *s, const mote_method_choice *choice, uint64_t seed,
                               mote_engine **engine)
{
    mote_engine_setup setup = mote_subject_engine(&(mote_subject){.bodies = &s->bodies});
    setup.seed = seed;
    const mote_status status = mote_engine_create(&setup, choice, engine);
    return status == MOTE_OK ? mote_engine_build(*engine) : status;
}

static mote_status create_truth(scene_stage *s)
{
    mote_method_choice exact;
    const mote_status status =
        mote_scene_choice_read(mote_simulation_exact_method(&s->choice), &exact);
    return status == MOTE_OK ? open_engine(s, &exact, 1, &s->truth) : status;
}

mote_status mote_stage_scene_create(const mote_bodies *bodies, const mote_method_choice *choice,
                                    const mote_simulation_options *options,
                                    const mote_mass *masses, void **state)
{
    if (options->tolerance * bodies->length > bodies->near)
        return mote_fail(MOTE_EINVAL,
                         "contact tolerance %g L is above near, %g L; contacts would be missed",
                         options->tolerance, bodies->near / bodies->length);
    scene_stage *made = mote_allocate(1, sizeof *made);
    made->bodies = *bodies;
    made->bodies.ask = MOTE_ASK_DISTANCE;
    made->bodies.tolerance = options->tolerance * bodies->length;
    made->choice = *choice;
    made->options = options;
    made->masses = masses;
    made->frame = mote_bodies_frame_create(&made->bodies);
    const mote_status status = create_truth(made);
    if (status == MOTE_OK)
        *state = made;
    else
        scene_destroy(made);
    return status;
}

static mote_status scene_restart(void *state, const mote_simulation_start *start)
{
    scene_stage *s = state;
    mote_engine_destroy(s->method);
    s->method = NULL;
    return open_engine(s, &s->choice, start->seed, &s->method);
}

static const mote_body_state *scene_show(void *state, uint32_t k,
                                         const mote_rigid_state *states)
{
    scene_stage *s = state;
    for (uint32_t i = 0; i < s->bodies.count; ++i) {
        const mote_pose pose = mote_rigid_pose(&s->masses[s->bodies.shape_of[i]], &states[i]);
        mote_bodies_deform(&s->bodies, i, 1 + k * s->options->time_step, &pose, &s->frame);
    }
    return s->frame.states;
}

static mote_status ask(mote_engine *engine, const mote_body_state *states,
                       mote_stage_pairs *answers)
{
    mote_engine_cost cost;
    mote_engine_show(engine, states);
    const mote_status status = mote_engine_ask(engine, &cost);
    if (status == MOTE_OK)
        answers->pairs = mote_engine_pairs(engine, &answers->count);
    return status;
}

/* Methods may use several threads, so real time is measured. */
static mote_status scene_ask_method(void *state, mote_stage_pairs *said, double *ns)
{
    scene_stage *s = state;
    const uint64_t from = mote_clock_ns();
    const mote_status status = ask(s->method, s->frame.states, said);
    *ns += (double)(mote_clock_ns() - from);
    return status;
}

static mote_status scene_ask_truth(void *state, mote_stage_pairs *truth, uint64_t *asked,
                                   double *lower)
{
    scene_stage *s = state;
    ++*asked;
    *lower = 0;
    return ask(s->truth, s->frame.states, truth);
}

static const mote_engine *scene_probe(const void *state)
{
    (void)state;
    return NULL;
}

const mote_stage_kind mote_stage_scene = {scene_destroy,    scene_restart,   scene_show,
                                          scene_ask_method, scene_ask_truth, scene_probe};
