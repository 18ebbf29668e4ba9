/* Requirements for this implementation, whatever the paper says: accuracy, allocations,
   symmetry. */
#include "harness/study/claims.h"

#include "harness/scene/motion.h"

#include <math.h>
#include <string.h>

static mote_status sample_ww(mote_study *study, const char *method, mote_sample *samples)
{
    const mote_subject *subject;
    const mote_tour tour = {.seed = 1};
    mote_status status = mote_study_scene(study, "ww", &subject);
    if (status == MOTE_OK)
        status = mote_study_sample(subject, method, tour, study->seeds, samples);
    return status;
}

mote_status mote_claim_exact_shares(mote_study *study, mote_claim *claim)
{
    claim->id = "r1";
    claim->section = "3.4";
    claim->claim =
        "W-W, exact check, log law: exact in 85 % of frames at n = 8, 94 % at n = 64";
    claim->measured = "share of frames with an error of at most 1e-9 L, refine=always";
    static const struct {
        const char *method, *name;
        double least;
    } cases[] = {{"particle-paper:n=8,refine=always", "n = 8", 0.85},
                 {"particle-paper:n=64,refine=always", "n = 64", 0.94}};
    mote_status status = MOTE_OK;
    for (int c = 0; c < 2 && status == MOTE_OK; ++c) {
        mote_sample samples[MOTE_STUDY_SEEDS];
        status = sample_ww(study, cases[c].method, samples);
        if (status != MOTE_OK)
            break;
        mote_claim_add(claim, mote_sample_estimate(samples, study->seeds, MOTE_MEASURED_EXACT),
                       "", "%s: share exact", cases[c].name);
        mote_claim_require(claim, MOTE_AT_LEAST, cases[c].least, cases[c].least);
    }
    return status;
}

mote_status mote_claim_no_missed_contact(mote_study *study, mote_claim *claim)
{
    claim->id = "r2";
    claim->section = "3.5";
    claim->claim =
        "W-W, n = 8, vertices only, a tolerance of two mean edges: no missed contact";
    claim->measured = "contacts missed, all frames and starts";
    mote_sample samples[MOTE_STUDY_SEEDS];
    mote_status status = sample_ww(study, "particle-paper:n=8", samples);
    if (status != MOTE_OK)
        return status;
    double contacts = 0, missed = 0;
    for (size_t s = 0; s < study->seeds; ++s) {
        contacts += samples[s].of[MOTE_MEASURED_CONTACTS];
        missed += samples[s].of[MOTE_MEASURED_MISSED] * samples[s].of[MOTE_MEASURED_CONTACTS];
    }
    /* The contacts of a start depend on each other, so it counts as one trial. */
    const double starts = (double)study->seeds, part = missed / contacts;
    const mote_estimate share = {part, mote_statistics_share_interval(part * starts, starts)};
    mote_claim_add(claim, mote_estimate_alone(round(missed)), "", "missed, of %.0f", contacts);
    mote_claim_require(claim, MOTE_AT_MOST, 0, 0);
    mote_claim_add(claim, share, "", "share missed, interval over %zu starts", study->seeds);
    return MOTE_OK;
}

mote_status mote_claim_no_allocation(mote_study *study, mote_claim *claim)
{
    claim->id = "r4";
    claim->section = "4";
    claim->claim = "from frame 50 on, no query allocates";
    claim->measured = "blocks handed out by the heap during queries, W-W";
    static const char *const methods[] = {
        "particle-paper:n=5", "particle-paper:n=8,refine=always",
        "particle-paper:n=16,move=surface", "particle-paper:n=16,far_cache=0.5",
        "particle-paper:n=5,precision=single"};
    mote_status status = MOTE_OK;
    for (size_t m = 0; m < sizeof methods / sizeof methods[0] && status == MOTE_OK; ++m) {
        mote_sample samples[MOTE_STUDY_SEEDS];
        double sum = 0;
        status = sample_ww(study, methods[m], samples);
        if (status != MOTE_OK)
            break;
        for (size_t s = 0; s < study->seeds; ++s)
            sum += samples[s].of[MOTE_MEASURED_ALLOCATIONS];
        mote_claim_add(claim, mote_estimate_alone(sum), "", "%s: allocations", methods[m]);
        mote_claim_require(claim, MOTE_AT_MOST, 0, 0);
    }
    return status;
}

/* The same scene with the bodies swapped. */
static void swap_bodies(const mote_subject *subject, mote_scenario *scenario,
                        mote_motion *motion, mote_subject *swapped)
{
    *scenario = *subject->scenario;
    scenario->body[0] = subject->scenario->body[1];
    scenario->body[1] = subject->scenario->body[0];
    *motion = *subject->scenario->motion;
    motion->body[0] = subject->scenario->motion->body[1];
    motion->body[1] = subject->scenario->motion->body[0];
    scenario->motion = motion;
    *swapped = *subject;
    swapped->scenario = scenario;
}

static void gather(const mote_sample *samples, size_t count, mote_measured which,
                   double *values)
{
    for (size_t s = 0; s < count; ++s)
        values[s] = samples[s].of[which];
}

/* Adds the difference and its p by Welch's test, which must not be significant. */
static void add_swap(const mote_sample *samples, const mote_sample *swapped, size_t seeds,
                     mote_measured which, const char *name, mote_claim *claim)
{
    double a[MOTE_STUDY_SEEDS], b[MOTE_STUDY_SEEDS];
    gather(samples, seeds, which, a);
    gather(swapped, seeds, which, b);
    const mote_difference d = mote_statistics_welch(a, seeds, b, seeds);
    const mote_estimate difference = {d.value, d.interval};
    mote_claim_add(claim, difference, "L", "%s: swapped - not swapped", name);
    mote_claim_add(claim, mote_estimate_alone(d.p), "", "%s: p of no difference", name);
    /* Two quantiles are tested, so 0.05 is halved (Bonferroni). */
    mote_claim_require(claim, MOTE_AT_LEAST, 0.025, 0.025);
}

mote_status mote_claim_bodies_swapped(mote_study *study, mote_claim *claim)
{
    claim->id = "r5";
    claim->section = "3.5";
    claim->claim =
        "swapping the bodies leaves the quantiles of the error within their intervals";
    claim->measured = "Welch's test over starts, W-W, n = 8, exact check";
    static const char method[] = "particle-paper:n=8,refine=always";
    const mote_subject *subject;
    mote_subject swapped;
    mote_scenario scenario;
    mote_motion motion;
    mote_sample samples[MOTE_STUDY_SEEDS], other[MOTE_STUDY_SEEDS];
    const mote_tour tour = {.seed = 101}; /* separate starts */
    mote_status status = mote_study_scene(study, "ww", &subject);
    if (status == MOTE_OK)
        status = sample_ww(study, method, samples);
    if (status == MOTE_OK) {
        swap_bodies(subject, &scenario, &motion, &swapped);
        status = mote_study_sample(&swapped, method, tour, study->seeds, other);
    }
    if (status != MOTE_OK)
        return status;
    add_swap(samples, other, study->seeds, MOTE_MEASURED_ERROR_P95, "95th percentile", claim);
    add_swap(samples, other, study->seeds, MOTE_MEASURED_ERROR_P99, "99th percentile", claim);
    return MOTE_OK;
}
