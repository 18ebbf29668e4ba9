/* The paper's claim for motion that depends on the answers: the closed loop. */
#include "harness/study/claims.h"

#include "harness/study/dynamics.h"

#include <stdlib.h>
#include <string.h>

/* The number of approaches: rows with 3 to 5 particles decide the verdict, other numbers are
   only reported. 0: left out. */
static uint32_t approaches_of(const mote_dynamics_row *row, bool quick)
{
    if (row->within != MOTE_STEPS_WHOLE)
        return 0; /* the claim is about particles */
    const bool decides = row->law && row->n >= 3 && row->n <= 5;
    if (row->law ? !decides && row->n != 8 : strncmp(row->method, "fcl", 3) == 0)
        return 0;
    return decides && !quick ? 400 : 100;
}

mote_status mote_claim_closed_loop(mote_study *study, mote_claim *claim)
{
    mote_dynamics_claim(claim);
    const mote_dynamics_size size = {.quick = true};
    mote_dynamics_row *rows;
    size_t count;
    mote_status status = mote_dynamics_plan(&size, &rows, &count);
    if (status != MOTE_OK)
        return status;
    for (size_t i = 0; i < count && status == MOTE_OK; ++i) {
        const mote_subject *subject;
        mote_dynamics_row *row = &rows[i];
        row->wanted = approaches_of(row, study->quick);
        if (row->wanted == 0)
            continue;
        status = mote_study_scene(study, row->scene, &subject);
        if (status == MOTE_OK)
            status = mote_approaches_simulate(
                subject->scenario,
                &(mote_approaches_plan){row->method, row->wanted, row->step, row->within},
                &row->sum);
        const char *failure = status == MOTE_OK ? mote_dynamics_failure(row) : NULL;
        if (failure)
            status = mote_fail(MOTE_ENUMERIC, "%s, %s: %s", row->scene, row->method, failure);
        if (status == MOTE_OK)
            mote_dynamics_claim_add(claim, row);
    }
    free(rows);
    return status;
}
