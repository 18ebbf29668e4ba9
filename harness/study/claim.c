#include "harness/study/claim.h"

#include "harness/base/memory.h"
#include "harness/base/record.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const verdict_names[] = {"holds", "holds within limits", "does not hold"};

static const char *const bound_names[] = {NULL, "at most", "at least"};

void mote_claim_add(mote_claim *claim, mote_estimate estimate, const char *unit,
                    const char *format, ...)
{
    claim->values =
        mote_reserve(claim->values, claim->count + 1, &claim->capacity, sizeof *claim->values);
    mote_claim_value *made = &claim->values[claim->count++];
    *made = (mote_claim_value){
        .estimate = estimate, .unit = unit, .holds = MOTE_NONE, .limits = MOTE_NONE};
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(made->name, sizeof made->name, format, arguments);
    va_end(arguments);
}

void mote_claim_require(mote_claim *claim, mote_bound bound, double holds, double limits)
{
    mote_claim_value *last = &claim->values[claim->count - 1];
    last->bound = bound;
    last->holds = holds;
    last->limits = limits;
}

bool mote_claim_met(const mote_claim_value *value, double threshold)
{
    const bool most = value->bound == MOTE_AT_MOST;
    const double end = most ? value->estimate.interval.high : value->estimate.interval.low;
    const double decides = end == end ? end : value->estimate.value;
    return most ? decides <= threshold : decides >= threshold;
}

static bool all_met(const mote_claim *claim, bool limits)
{
    size_t needed = 0, met = 0;
    for (size_t i = 0; i < claim->count; ++i) {
        const mote_claim_value *value = &claim->values[i];
        const double threshold = limits ? value->limits : value->holds;
        if (value->bound == MOTE_BOUND_NONE || threshold != threshold)
            continue;
        ++needed;
        met += mote_claim_met(value, threshold) ? 1 : 0;
    }
    return needed > 0 && met == needed;
}

mote_claim_verdict mote_claim_judge(const mote_claim *claim)
{
    if (all_met(claim, false))
        return MOTE_CLAIM_HOLDS;
    return all_met(claim, true) ? MOTE_CLAIM_LIMITS : MOTE_CLAIM_DOES_NOT_HOLD;
}

static json_t *interval_json(mote_confidence interval)
{
    if (interval.low != interval.low)
        return json_null();
    return json_pack("[o,o]", mote_json_number(interval.low), mote_json_number(interval.high));
}

static json_t *threshold_json(const mote_claim_value *value)
{
    if (value->bound == MOTE_BOUND_NONE)
        return json_null();
    return json_pack("{s:s, s:o, s:o}", "bound", bound_names[value->bound], "holds",
                     mote_json_number(value->holds), "limits", mote_json_number(value->limits));
}

static json_t *value_json(const mote_claim_value *value)
{
    return json_pack("{s:s, s:o, s:o, s:s, s:o}", "name", value->name, "value",
                     mote_json_number(value->estimate.value), "interval",
                     interval_json(value->estimate.interval), "unit", value->unit, "threshold",
                     threshold_json(value));
}

json_t *mote_claim_json(const mote_claim *claim)
{
    json_t *object =
        json_pack("{s:s, s:s, s:s, s:s, s:s, s:s?}", "id", claim->id, "section", claim->section,
                  "claim", claim->claim, "measured", claim->measured, "verdict",
                  verdict_names[mote_claim_judge(claim)], "curve", claim->curve);
    json_t *values = json_array();
    for (size_t i = 0; i < claim->count; ++i)
        (void)json_array_append_new(values, value_json(&claim->values[i]));
    if (claim->count > 0) {
        json_t *headline = value_json(&claim->values[0]);
        (void)json_object_del(headline, "name");
        (void)json_object_update(object, headline);
        json_decref(headline);
    }
    if (json_array_size(values) != claim->count ||
        json_object_set_new(object, "values", values) != 0) {
        json_decref(object);
        return NULL;
    }
    return object;
}

static void print_value(const mote_claim_value *value)
{
    (void)printf("     %-62s %10.4g %-3s", value->name, value->estimate.value, value->unit);
    if (value->estimate.interval.low == value->estimate.interval.low)
        (void)printf(" [%.4g, %.4g]", value->estimate.interval.low,
                     value->estimate.interval.high);
    if (value->bound != MOTE_BOUND_NONE) {
        (void)printf("  %s", bound_names[value->bound]);
        if (value->holds == value->holds)
            (void)printf(" %g%s", value->holds,
                         mote_claim_met(value, value->holds) ? "" : " (missed)");
        if (value->limits == value->limits)
            (void)printf("%s %g within limits%s", value->holds == value->holds ? "," : "",
                         value->limits,
                         mote_claim_met(value, value->limits) ? "" : " (missed)");
    }
    (void)printf("\n");
}

void mote_claim_print(const mote_claim *claim)
{
    (void)printf("%-3s  paper %-8s %s: %s\n     measured: %s\n", claim->id, claim->section,
                 verdict_names[mote_claim_judge(claim)], claim->claim, claim->measured);
    for (size_t i = 0; i < claim->count; ++i)
        print_value(&claim->values[i]);
    if (claim->curve)
        (void)printf("     curve: %s, drawn beside it\n", claim->curve);
}

void mote_claim_free(mote_claim *claim)
{
    free(claim->values);
    claim->values = NULL;
    claim->count = claim->capacity = 0;
}
