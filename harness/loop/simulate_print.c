#include "harness/loop/simulate_print.h"

#include "harness/base/file.h"
#include "harness/base/json_print.h"
#include "harness/base/statistics.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdlib.h>

/* How the figures of replicates are combined. */
typedef enum joining {
    SUM,     /* of counts */
    LARGEST, /* of counts */
    DEEPEST, /* largest real; some may be missing */
    MEAN     /* per step */
} joining;

typedef struct figure {
    const char *key;
    size_t offset; /* in mote_simulation_result: of a uint64_t for counts, otherwise a double */
    joining joining;
    bool later; /* 0 in files from before there were steps with paths */
} figure;

#define FIGURE(key, name, joining)                                                             \
    {                                                                                          \
        key, offsetof(mote_simulation_result, name), joining, false                            \
    }
#define LATER(key, name)                                                                       \
    {                                                                                          \
        key, offsetof(mote_simulation_result, name), SUM, true                                 \
    }

static const figure figures[] = {
    FIGURE("steps", steps, SUM),
    FIGURE("approaches", approaches, SUM),
    FIGURE("passes_through", passes, SUM),
    FIGURE("deep_passes_through", deep_passes, SUM),
    LATER("intersections", intersections),
    FIGURE("max_penetration", depth_max, DEEPEST),
    FIGURE("max_penetration_passes", depth_passes, DEEPEST),
    FIGURE("contact_steps", contact_steps, SUM),
    FIGURE("missed_steps", missed_steps, SUM),
    FIGURE("false_steps", false_steps, SUM),
    FIGURE("responses", responses, SUM),
    LATER("impacts", impacts),
    LATER("floor_pushes", pushes),
    LATER("floor_unproven", unproven),
    FIGURE("bounces", bounces, SUM),
    FIGURE("delay_sum", delay_sum, SUM),
    FIGURE("delay_max", delay_max, LARGEST),
    FIGURE("truth_asked", truth_asked, SUM),
    FIGURE("near_pairs", near_pairs, MEAN),
    FIGURE("query_ns", query_ns, MEAN),
    FIGURE("energy_drift", energy_drift, DEEPEST),
    FIGURE("momentum_drift", momentum_drift, DEEPEST),
    FIGURE("angular_momentum_drift", angular_drift, DEEPEST),
};
#define FIGURES (sizeof figures / sizeof figures[0])

/* A stored count above this is invalid. */
#define COUNT_MAX ((json_int_t)1 << 53)

static bool is_count(const figure *f)
{
    return f->joining == SUM || f->joining == LARGEST;
}

static uint64_t *count_of(mote_simulation_result *result, const figure *f)
{
    return (uint64_t *)(void *)((char *)result + f->offset);
}

static double *real_of(mote_simulation_result *result, const figure *f)
{
    return (double *)(void *)((char *)result + f->offset);
}

json_t *mote_simulation_json(const char *scenario, uint32_t bodies, const char *method,
                             const mote_simulation_result *result)
{
    mote_simulation_result values = *result;
    json_t *root = json_pack("{s:s, s:s, s:I}", "scenario", scenario, "method", method,
                             "bodies", (json_int_t)bodies);
    for (size_t k = 0; k < FIGURES; ++k) {
        const figure *f = &figures[k];
        if (is_count(f)) {
            const json_int_t count = (json_int_t)*count_of(&values, f);
            (void)json_object_set_new(root, f->key, json_integer(count));
            continue;
        }
        const double value = *real_of(&values, f);
        (void)json_object_set_new(root, f->key, isnan(value) ? json_null() : json_real(value));
    }
    return root;
}

bool mote_simulation_read(const json_t *object, mote_simulation_result *result)
{
    mote_simulation_result read = {0};
    bool whole = true;
    for (size_t k = 0; k < FIGURES && whole; ++k) {
        const figure *f = &figures[k];
        const json_t *value = json_object_get(object, f->key);
        const json_int_t count = json_integer_value(value);
        if (!value && f->later)
            continue;
        if (is_count(f)) {
            whole = json_is_integer(value) && count >= 0 && count <= COUNT_MAX;
            *count_of(&read, f) = (uint64_t)count;
        } else {
            whole = json_is_number(value) || json_is_null(value);
            *real_of(&read, f) = json_is_null(value) ? MOTE_NONE : json_number_value(value);
        }
    }
    if (whole)
        *result = read;
    return whole;
}

void mote_simulation_add(mote_simulation_result *sum, const mote_simulation_result *replicate)
{
    mote_simulation_result one = *replicate;
    const double before = (double)sum->steps, weight = (double)one.steps;
    if (sum->steps == 0) {
        *sum = one;
        return;
    }
    for (size_t k = 0; k < FIGURES; ++k) {
        const figure *f = &figures[k];
        if (f->joining == SUM)
            *count_of(sum, f) += *count_of(&one, f);
        else if (f->joining == LARGEST && *count_of(&one, f) > *count_of(sum, f))
            *count_of(sum, f) = *count_of(&one, f);
        else if (f->joining == DEEPEST)
            *real_of(sum, f) = fmax(*real_of(sum, f), *real_of(&one, f));
        else if (f->joining == MEAN)
            *real_of(sum, f) =
                (*real_of(sum, f) * before + *real_of(&one, f) * weight) / (before + weight);
    }
}

mote_status mote_simulation_put(json_t *object, FILE *out)
{
    if (!object)
        return mote_fail(MOTE_EINVAL, "a name to be printed is not UTF-8; rename what has it");
    mote_text text = {0};
    mote_json_print(object, 17, &text);
    json_decref(object);
    (void)fputs(text.data, out);
    free(text.data);
    return MOTE_OK;
}

void mote_simulation_print(const char *scenario, uint32_t bodies, const char *method,
                           const mote_simulation_result *result, FILE *out)
{
    (void)fprintf(out, "%s, %s: %u bodies, %" PRIu64 " steps, %.3g us each for the method\n",
                  scenario, method, bodies, result->steps, result->query_ns / 1e3);
    (void)fprintf(out,
                  "approaches %" PRIu64 ", passes through %" PRIu64 " (%" PRIu64
                  " of them with a vertex inside), intersecting %" PRIu64 "\n",
                  result->approaches, result->passes, result->deep_passes,
                  result->intersections);
    (void)fprintf(out,
                  "contact in %" PRIu64 " steps, missed in %" PRIu64 ", false in %" PRIu64
                  ", delay %" PRIu64 " at most\n",
                  result->contact_steps, result->missed_steps, result->false_steps,
                  result->delay_max);
    (void)fprintf(out, "responses %" PRIu64 ", penetration at most %.3g L", result->responses,
                  result->depth_max);
    if (bodies > 2)
        (void)fprintf(out, ", bounces off the walls %" PRIu64 ", near pairs %.3g a step",
                      result->bounces, result->near_pairs);
    if (result->impacts > 0)
        (void)fprintf(out,
                      "\nimpacts between steps %" PRIu64
                      ", pushed apart within the floor %" PRIu64
                      ", left unproven for a floor %" PRIu64,
                      result->impacts, result->pushes, result->unproven);
    (void)fprintf(out, "\ndrift: energy %.2g, momentum %.2g", result->energy_drift,
                  result->momentum_drift);
    if (!isnan(result->angular_drift))
        (void)fprintf(out, ", angular momentum %.2g", result->angular_drift);
    (void)fprintf(out, "\n");
}
