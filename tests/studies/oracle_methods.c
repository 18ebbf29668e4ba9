#include "tests/studies/oracle_methods.h"

#include "harness/base/record.h"
#include "harness/engine/engine.h"
#include "harness/process/child.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* What the child tells about a frame. */
typedef struct said {
    bool has_distance, contact;
    double distance;
} said;

typedef struct task {
    const oracle_truth *truth;
    const mote_method_choice *choice;
} task;

static mote_status open_method(const task *t, mote_engine **engine)
{
    const mote_body *body = t->truth->scenario->body;
    const mote_status status =
        mote_engine_open_two(&body[0], &body[1], t->choice, MOTE_ASK_DISTANCE, 0, 0, engine);
    if (status != MOTE_EUNSUPPORTED)
        return status;
    return mote_engine_open_two(&body[0], &body[1], t->choice, MOTE_ASK_CONTACT, 0, 0, engine);
}

static mote_status ask_frame(const task *t, mote_engine *engine, uint32_t k, int output)
{
    const oracle_truth *truth = t->truth;
    const uint32_t number = 1 + k * truth->stride;
    const mote_frame *frame = mote_scenario_frame(truth->scenario, truth->buffer, number,
                                                  k ? number - truth->stride : 0);
    mote_answer answer;
    const mote_status status = mote_engine_answer(engine, frame, &answer);
    if (status != MOTE_OK)
        return status;
    if (!answer.has_distance && !answer.has_contact)
        return mote_fail(MOTE_ENUMERIC, "frame %u: neither a distance nor a contact", number);
    said s;
    memset(&s, 0, sizeof s);
    s.has_distance = answer.has_distance;
    s.distance = answer.has_distance ? answer.distance : 0;
    s.contact = answer.has_contact ? answer.contact : answer.distance == 0;
    return mote_child_put(output, &s, sizeof s);
}

static mote_status ask_frames(void *context, int output)
{
    const task *t = context;
    mote_engine *engine = NULL;
    mote_status status = open_method(t, &engine);
    for (uint32_t k = 0; k < t->truth->count && status == MOTE_OK; k++)
        status = ask_frame(t, engine, k, output);
    mote_engine_destroy(engine);
    return status;
}

typedef struct tally {
    uint32_t distances, wrong, missed, invented;
    double worst; /* over L */
} tally;

static void judge(const said *s, double truth, double length, tally *to)
{
    to->missed += truth == 0 && !s->contact;
    to->invented += truth > ORACLE_RIGHT * length && s->contact;
    if (!s->has_distance)
        return;
    const double error = fabs(s->distance - truth) / length;
    to->distances++;
    to->wrong += isnan(error) || error > ORACLE_RIGHT;
    to->worst = error > to->worst || isnan(error) ? error : to->worst;
}

mote_status oracle_method(const oracle_truth *truth, const mote_method_choice *choice,
                          double seconds, json_t **row, bool *right)
{
    const size_t bytes = truth->count * sizeof(said);
    const mote_child_limits limits = {.seconds = seconds, .output_bytes = bytes};
    task t = {truth, choice};
    mote_child child = {0};
    size_t index;
    mote_status status = mote_child_start(ask_frames, &t, limits, &child);
    if (status == MOTE_OK)
        status = mote_child_wait(&child, 1, &index);
    if (status != MOTE_OK)
        return status;
    const bool answered =
        child.end == MOTE_CHILD_DONE && child.status == MOTE_OK && child.size == bytes;
    tally sum = {0};
    for (uint32_t k = 0; k < truth->count && answered; k++) {
        said s;
        memcpy(&s, child.output + k * sizeof s, sizeof s);
        judge(&s, truth->distance[k], truth->scenario->length, &sum);
    }
    json_t *failure = answered        ? json_null()
                      : child.text[0] ? json_string(child.text)
                                      : json_string("it ended without a word");
    *row =
        json_pack("{s:s, s:i, s:i, s:o, s:i, s:i, s:o}", "method", choice->text, "frames",
                  (int)truth->count, "distances_wrong", (int)sum.wrong, "error_max",
                  sum.distances ? mote_json_number(sum.worst) : json_null(), "contacts_missed",
                  (int)sum.missed, "contacts_invented", (int)sum.invented, "failure", failure);
    *right = answered && sum.wrong + sum.missed + sum.invented == 0;
    mote_child_release(&child);
    return *row ? MOTE_OK : mote_fail(MOTE_ENOMEM, "no memory");
}

void oracle_methods_print(const char *scenario, const json_t *rows)
{
    size_t i;
    json_t *row;
    json_array_foreach(rows, i, row)
    {
        const char *failure = json_string_value(json_object_get(row, "failure"));
        const char *method = json_string_value(json_object_get(row, "method"));
        if (failure) {
            printf("%s: %s: %s\n", scenario, method, failure);
            continue;
        }
        printf("%s: %s: %" JSON_INTEGER_FORMAT " frames, ", scenario, method,
               json_integer_value(json_object_get(row, "frames")));
        if (json_is_number(json_object_get(row, "error_max")))
            printf("%" JSON_INTEGER_FORMAT " distances wrong, by %.1e L at most, ",
                   json_integer_value(json_object_get(row, "distances_wrong")),
                   json_number_value(json_object_get(row, "error_max")));
        printf("%" JSON_INTEGER_FORMAT " contacts missed, %" JSON_INTEGER_FORMAT " invented\n",
               json_integer_value(json_object_get(row, "contacts_missed")),
               json_integer_value(json_object_get(row, "contacts_invented")));
    }
}
