#include "harness/loop/simulation.h"

#include <string.h>

mote_simulation_options mote_default_simulation_options(const mote_subject *subject)
{
    const mote_subject_facts facts = mote_subject_facts_of(subject);
    const double own = facts.tolerance / facts.length;
    return (mote_simulation_options){
        .density = 1, .restitution = 1, .tolerance = own > 0 ? own : 0.005, .time_step = 1};
}

mote_status mote_simulation_options_check(const mote_simulation_options *options)
{
    if (!(options->tolerance > 0 && options->tolerance <= MOTE_SIMULATION_NEAR))
        return mote_fail(MOTE_EINVAL,
                         "contact tolerance %g L; give a number above 0 and at most %g",
                         options->tolerance, MOTE_SIMULATION_NEAR);
    if (!(options->restitution >= 0 && options->restitution <= 1))
        return mote_fail(MOTE_EINVAL, "restitution %g; give a number from 0 to 1",
                         options->restitution);
    if (!isfinite(mote_length(options->gravity)))
        return mote_fail(MOTE_EINVAL, "gravity is not finite");
    if (!(options->time_step > 0 && options->time_step <= MOTE_SIMULATION_STEP_MAX))
        return mote_fail(MOTE_EINVAL,
                         "time step %g frames; give a number above 0 and at most %g",
                         options->time_step, MOTE_SIMULATION_STEP_MAX);
    return MOTE_OK;
}

const char *mote_simulation_exact_method(const mote_method_choice *choice)
{
    return strcmp(choice->method->name, "certified") == 0 ? "aabb-tree" : "certified";
}
