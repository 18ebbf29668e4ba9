#include "harness/study/claims.h"

#include "harness/run/measure.h"
#include "harness/base/record.h"

#include <stdio.h>

typedef struct experiment {
    const char *name;
    mote_status (*measure)(mote_study *study, mote_claim *claim);
} experiment;

#define EXPERIMENT(name) {#name, mote_claim_##name},
static const experiment claims[] = {MOTE_CLAIMS(EXPERIMENT)};
static const experiment requirements[] = {MOTE_REQUIREMENTS(EXPERIMENT)};
#undef EXPERIMENT

/* Measures one experiment, prints it, and appends it to list. */
static mote_status run_one(mote_study *study, const experiment *e, json_t *list,
                           mote_claim_verdict *verdict)
{
    mote_claim claim = {0};
    const uint64_t start = mote_clock_ns();
    mote_status status = e->measure(study, &claim);
    if (status == MOTE_OK) {
        (void)json_array_append_new(list, mote_claim_json(&claim));
        mote_claim_print(&claim);
        (void)fflush(stdout);
        (void)fprintf(stderr, "claims: %s took %.1f s\n", e->name,
                      (double)(mote_clock_ns() - start) * 1e-9);
        *verdict = mote_claim_judge(&claim);
    }
    mote_claim_free(&claim);
    return status;
}

static mote_status run_list(mote_study *study, const experiment *list, size_t count,
                            const char *file, bool *all_hold)
{
    json_t *results = json_array();
    mote_status status = MOTE_OK;
    *all_hold = true;
    for (size_t i = 0; i < count && status == MOTE_OK; ++i) {
        mote_claim_verdict verdict = MOTE_CLAIM_DOES_NOT_HOLD;
        status = run_one(study, &list[i], results, &verdict);
        *all_hold = *all_hold && verdict == MOTE_CLAIM_HOLDS;
    }
    if (status == MOTE_OK)
        return mote_record_json(study->directory, file, results);
    json_decref(results);
    return status;
}

mote_status mote_claims_measure(mote_study *study, bool *met)
{
    bool unused;
    mote_status status =
        run_list(study, claims, sizeof claims / sizeof claims[0], "claims.json", &unused);
    if (status == MOTE_OK)
        status = run_list(study, requirements, sizeof requirements / sizeof requirements[0],
                          "requirements.json", met);
    return status;
}
