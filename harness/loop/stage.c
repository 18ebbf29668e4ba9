#include "harness/loop/stage.h"

#include "harness/base/clock.h"
#include "harness/base/memory.h"
#include "harness/loop/cast.h"

#include <stdlib.h>
#include <time.h>

struct mote_stage {
    mote_engine_setup setup; /* the scenario's bodies with the contact tolerance */
    mote_method_choice choice;
    const mote_cast_kind *kind;
    void *cast;
    mote_engine *method, *truth;
    const mote_body_state *shown;
    double lower; /* of the true distance between two bodies, proven */
};

/* Makes and builds an engine for the bodies. */
static mote_status open_engine(mote_stage *s, const mote_method_choice *choice, uint64_t seed,
                               mote_engine **engine)
{
    s->setup.seed = seed;
    const mote_status status = mote_engine_create(&s->setup, choice, engine);
    return status == MOTE_OK ? mote_engine_build(*engine) : status;
}

mote_status mote_stage_refuse_given(const mote_subject *subject)
{
    const mote_engine_setup setup = mote_subject_engine(subject);
    const char *path = subject->bodies ? subject->bodies->path : subject->scenario->path;
    for (uint32_t k = 0; k < setup.shape_count; ++k) {
        if (mote_body_is_given(setup.shapes[k]))
            return mote_fail(
                MOTE_EUNSUPPORTED,
                "%s: a closed loop moves each body as its contacts tell and deforms it there "
                "by a field, but of %s %u only positions are given, which are where it goes; "
                "measure it with `mote run`",
                path, subject->bodies ? "shape" : "body", k + 1);
    }
    return MOTE_OK;
}

mote_status mote_stage_create(const mote_subject *subject, const mote_method_choice *choice,
                              const mote_simulation_options *options, const mote_mass *masses,
                              mote_stage **stage)
{
    mote_engine_setup setup = mote_subject_engine(subject);
    const mote_status given = mote_stage_refuse_given(subject);
    if (given != MOTE_OK)
        return given;
    setup.ask = MOTE_ASK_DISTANCE;
    setup.tolerance = options->tolerance * setup.length;
    if (setup.tolerance > setup.near)
        return mote_fail(MOTE_EINVAL,
                         "contact tolerance %g L is above near, %g L; contacts would be missed",
                         options->tolerance, setup.near / setup.length);
    mote_stage *made = mote_allocate(1, sizeof *made);
    made->setup = setup;
    made->choice = *choice;
    made->kind = subject->bodies ? &mote_cast_scene : &mote_cast_pair;
    made->cast = made->kind->create(subject, options, masses);
    mote_method_choice exact;
    mote_status status = mote_scene_choice_read(mote_simulation_exact_method(choice), &exact);
    if (status == MOTE_OK)
        status = open_engine(made, &exact, 1, &made->truth);
    if (status == MOTE_OK)
        *stage = made;
    else
        mote_stage_destroy(made);
    return status;
}

void mote_stage_destroy(mote_stage *stage)
{
    if (!stage)
        return;
    mote_engine_destroy(stage->method);
    mote_engine_destroy(stage->truth);
    stage->kind->destroy(stage->cast);
    free(stage);
}

mote_status mote_stage_restart(mote_stage *stage, const mote_simulation_start *start)
{
    mote_engine_destroy(stage->method);
    stage->method = NULL;
    stage->lower = 0;
    stage->kind->restart(stage->cast, start);
    return open_engine(stage, &stage->choice, start->seed, &stage->method);
}

const mote_body_state *mote_stage_show(mote_stage *stage, uint32_t k,
                                       const mote_rigid_state *states)
{
    stage->shown = stage->kind->show(stage->cast, k, states);
    if (k > 0 && stage->kind->moved)
        stage->lower = fmax(0, stage->lower - stage->kind->moved(stage->cast));
    return stage->shown;
}

const mote_body_state *mote_stage_see(mote_stage *stage, const mote_body_state *states,
                                      double moved)
{
    stage->shown = states;
    stage->lower = fmax(0, stage->lower - moved);
    return states;
}

void mote_stage_weigh(mote_stage *stage, double frames, double *const *weights)
{
    stage->kind->weigh(stage->cast, frames, weights);
}

static mote_status ask(mote_engine *engine, const mote_body_state *shown,
                       mote_stage_pairs *answers)
{
    mote_engine_cost cost;
    mote_engine_show(engine, shown);
    const mote_status status = mote_engine_ask(engine, &cost);
    if (status == MOTE_OK)
        answers->pairs = mote_engine_pairs(engine, &answers->count);
    return status;
}

/* For two bodies, processor time of this thread, since simulations run in parallel; for many,
   wall time, since methods may use several threads. */
static double now_ns(const mote_stage *s)
{
    struct timespec t;
    if (s->kind == &mote_cast_scene)
        return (double)mote_clock_ns();
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

mote_status mote_stage_ask_method(mote_stage *stage, mote_stage_pairs *said, double *ns)
{
    const double from = now_ns(stage);
    const mote_status status = ask(stage->method, stage->shown, said);
    *ns += now_ns(stage) - from;
    for (size_t k = 0; status == MOTE_OK && k < said->count; ++k) {
        if (!said->pairs[k].answer.has_contact)
            return mote_fail(MOTE_EUNSUPPORTED, "%s gives neither distance nor contact",
                             stage->choice.text);
    }
    return status;
}

mote_status mote_stage_ask_truth(mote_stage *stage, mote_stage_pairs *truth, uint64_t *asked,
                                 double *lower)
{
    mote_status status = MOTE_OK;
    *truth = (mote_stage_pairs){NULL, 0};
    if (stage->lower <= MOTE_SIMULATION_NEAR * stage->setup.length) {
        ++*asked;
        status = ask(stage->truth, stage->shown, truth);
        if (status == MOTE_OK && stage->kind->moved)
            stage->lower = truth->pairs[0].answer.distance;
    }
    *lower = stage->lower;
    return status;
}

const mote_engine *mote_stage_method(const mote_stage *stage)
{
    return stage->method;
}
