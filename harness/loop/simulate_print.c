#include "harness/loop/simulate_print.h"

#include "harness/base/file.h"
#include "harness/base/json_print.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static void put_count(json_t *root, const char *key, uint64_t value)
{
    (void)json_object_set_new(root, key, json_integer((json_int_t)value));
}

static void put_figure(json_t *root, const char *key, double value)
{
    (void)json_object_set_new(root, key, isnan(value) ? json_null() : json_real(value));
}

mote_status mote_simulation_json(const char *scenario, uint32_t bodies,
                                 const mote_method_choice *choice,
                                 const mote_simulation_result *result, FILE *out)
{
    json_t *root = json_pack("{s:s, s:s}", "scenario", scenario, "method", choice->text);
    put_count(root, "bodies", bodies);
    put_count(root, "steps", result->steps);
    put_count(root, "approaches", result->approaches);
    put_count(root, "passes_through", result->passes);
    put_count(root, "deep_passes_through", result->deep_passes);
    put_figure(root, "max_penetration", result->depth_max);
    put_figure(root, "max_penetration_passes", result->depth_passes);
    put_count(root, "contact_steps", result->contact_steps);
    put_count(root, "missed_steps", result->missed_steps);
    put_count(root, "false_steps", result->false_steps);
    put_count(root, "responses", result->responses);
    put_count(root, "bounces", result->bounces);
    put_count(root, "delay_sum", result->delay_sum);
    put_count(root, "delay_max", result->delay_max);
    put_count(root, "truth_asked", result->truth_asked);
    put_figure(root, "near_pairs", result->near_pairs);
    put_figure(root, "query_ns", result->query_ns);
    put_figure(root, "energy_drift", result->energy_drift);
    put_figure(root, "momentum_drift", result->momentum_drift);
    put_figure(root, "angular_momentum_drift", result->angular_drift);
    if (!root)
        return mote_fail(MOTE_EINVAL, "a name to be printed is not UTF-8; rename what has it");
    mote_text text = {0};
    mote_json_print(root, 17, &text);
    json_decref(root);
    (void)fputs(text.data, out);
    free(text.data);
    return MOTE_OK;
}

void mote_simulation_print(const char *scenario, uint32_t bodies,
                           const mote_method_choice *choice,
                           const mote_simulation_result *result, FILE *out)
{
    (void)fprintf(out, "%s, %s: %u bodies, %u steps, %.3g us each for the method\n", scenario,
                  choice->text, bodies, result->steps, result->query_ns / 1e3);
    (void)fprintf(out,
                  "approaches %" PRIu64 ", passes through %" PRIu64 " (%" PRIu64
                  " of them with a vertex inside)\n",
                  result->approaches, result->passes, result->deep_passes);
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
    (void)fprintf(out, "\ndrift: energy %.2g, momentum %.2g", result->energy_drift,
                  result->momentum_drift);
    if (!isnan(result->angular_drift))
        (void)fprintf(out, ", angular momentum %.2g", result->angular_drift);
    (void)fprintf(out, "\n");
}
