#include "harness/loop/bodies_simulate_print.h"

#include "harness/base/file.h"
#include "harness/base/json_print.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static void put_count(json_t *root, const char *key, uint64_t value)
{
    (void)json_object_set_new(root, key, json_integer((json_int_t)value));
}

mote_status mote_bodies_simulation_json(const mote_bodies *bodies,
                                        const mote_method_choice *choice,
                                        const mote_bodies_simulation *result)
{
    const mote_bodies_book *b = &result->book;
    const double length = bodies->length;
    json_t *root = json_pack("{s:s, s:s}", "scenario", bodies->name, "method", choice->text);
    put_count(root, "bodies", bodies->count);
    put_count(root, "steps", result->steps);
    put_count(root, "approaches", b->approaches);
    put_count(root, "passes_through", b->passes);
    put_count(root, "deep_passes_through", b->deep_passes);
    (void)json_object_set_new(root, "max_penetration", json_real(b->depth_max / length));
    (void)json_object_set_new(root, "max_penetration_passes",
                              json_real(b->depth_passes / length));
    put_count(root, "contact_steps", b->contact_steps);
    put_count(root, "missed_steps", b->missed_steps);
    put_count(root, "false_steps", b->false_steps);
    put_count(root, "responses", result->responses);
    put_count(root, "bounces", result->bounces);
    put_count(root, "delay_sum", b->delay_sum);
    put_count(root, "delay_max", b->delay_max);
    (void)json_object_set_new(root, "near_pairs", json_real(result->near_pairs));
    (void)json_object_set_new(root, "query_ns", json_real(result->query_ns));
    (void)json_object_set_new(root, "energy_drift", json_real(result->energy_drift));
    (void)json_object_set_new(root, "momentum_drift", json_real(result->momentum_drift));
    /* Walls turn bodies back off centre: it is not kept. */
    (void)json_object_set_new(root, "angular_momentum_drift", json_null());
    mote_text text = {0};
    mote_json_print(root, 17, &text);
    json_decref(root);
    mote_status status =
        text.failed ? mote_fail(MOTE_ENOMEM, "no memory for a simulation's figures") : MOTE_OK;
    if (status == MOTE_OK)
        (void)fputs(text.data, stdout);
    free(text.data);
    return status;
}

void mote_bodies_simulation_print(const mote_bodies *bodies, const mote_method_choice *choice,
                                  const mote_bodies_simulation *result)
{
    const mote_bodies_book *b = &result->book;
    (void)printf("%s, %s: %u bodies, %u steps, %.3g near pairs and %.3g us each for the "
                 "method\n",
                 bodies->name, choice->text, bodies->count, result->steps, result->near_pairs,
                 result->query_ns / 1e3);
    (void)printf("approaches %" PRIu64 ", passes through %" PRIu64 " (%" PRIu64
                 " of them with a vertex inside)\n",
                 b->approaches, b->passes, b->deep_passes);
    (void)printf("contact at %" PRIu64 " pairs and steps, missed at %" PRIu64
                 ", false at %" PRIu64 ", delay %" PRIu64 " at most\n",
                 b->contact_steps, b->missed_steps, b->false_steps, b->delay_max);
    (void)printf("responses %" PRIu64 ", off the walls %" PRIu64
                 ", penetration at most %.3g L\n",
                 result->responses, result->bounces, b->depth_max / bodies->length);
    (void)printf("drift: energy %.2g, momentum %.2g\n", result->energy_drift,
                 result->momentum_drift);
}
