#include "tests/studies/oracle_frames.h"

#include "harness/base/memory.h"
#include "harness/engine/engine.h"

#include <math.h>
#include <stdlib.h>

#define BRUTE_FRAMES 20

enum { TREE, FCL, WIDE, BRUTE, JUDGES };

static const char *const judges[JUDGES] = {
    [TREE] = "aabb-tree",
    [FCL] = "fcl-aabb:seed=previous",
    [WIDE] = "aabb-tree:arithmetic=wide,seed=none",
    [BRUTE] = "brute-force",
};

/* A scenario being judged. */
typedef struct court {
    mote_scenario *scenario;
    mote_frame_buffer *buffer;
    mote_engine *probe[JUDGES];
    json_t *disputed;
    double agreement, difference; /* over L: the largest difference that is not disputed, and
                                     the largest found */
    uint32_t frames, wrong[2];
    double *settled; /* [frames] */
} court;

static mote_status open_court(const char *scenario, court *c)
{
    *c = (court){.disputed = json_array()};
    mote_status status = mote_scenario_load(scenario, &c->scenario);
    if (status == MOTE_OK)
        c->buffer = mote_frame_buffer_create(c->scenario);
    for (int j = 0; j < JUDGES && status == MOTE_OK; j++) {
        mote_method_choice choice;
        status = mote_method_choice_read(judges[j], &choice);
        if (status == MOTE_OK)
            status = mote_engine_open_two(&c->scenario->body[0], &c->scenario->body[1], &choice,
                                          MOTE_ASK_DISTANCE, 0, 0, &c->probe[j]);
    }
    return status;
}

static void close_court(court *c)
{
    for (int j = 0; j < JUDGES; j++)
        mote_engine_destroy(c->probe[j]);
    mote_frame_buffer_destroy(c->buffer);
    mote_scenario_destroy(c->scenario);
    json_decref(c->disputed);
    free(c->settled);
}

/* previous: the frame that this judge saw last, 0 for none. */
static mote_status hear(court *c, int judge, uint32_t number, uint32_t previous,
                        double *distance)
{
    const mote_frame *frame = mote_scenario_frame(c->scenario, c->buffer, number, previous);
    mote_answer answer;
    mote_status status = mote_engine_answer(c->probe[judge], frame, &answer);
    if (status == MOTE_OK && !answer.has_distance)
        status = mote_fail(MOTE_ENUMERIC, "%s: frame %u: %s gave no distance",
                           c->scenario->name, number, judges[judge]);
    *distance = answer.distance;
    return status;
}

static mote_status settle(court *c, uint32_t number, const double said[2], double *truth)
{
    double settled, brute = 0;
    bool with_brute = json_array_size(c->disputed) < BRUTE_FRAMES;
    mote_status status = hear(c, WIDE, number, 0, &settled);
    if (status == MOTE_OK && with_brute)
        status = hear(c, BRUTE, number, 0, &brute);
    if (status != MOTE_OK)
        return status;
    *truth = settled;
    for (int j = TREE; j <= FCL; j++)
        if (!(fabs(said[j] - settled) <= ORACLE_RIGHT * c->scenario->length))
            c->wrong[j]++;
    json_t *row = json_pack("{s:i, s:f, s:f, s:f}", "frame", (int)number, "aabb_tree",
                            said[TREE], "fcl_aabb", said[FCL], "settled", settled);
    if (with_brute)
        json_object_set_new(row, "brute_force", json_real(brute));
    json_array_append_new(c->disputed, row);
    return MOTE_OK;
}

static mote_status judge_frames(court *c, uint32_t stride)
{
    uint32_t previous = 0;
    c->settled = mote_allocate(c->scenario->frames / stride + 1, sizeof *c->settled);
    for (uint32_t number = 1; number <= c->scenario->frames; number += stride) {
        double said[2];
        for (int j = TREE; j <= FCL; j++) {
            mote_status status = hear(c, j, number, previous, &said[j]);
            if (status != MOTE_OK)
                return status;
        }
        double difference = fabs(said[TREE] - said[FCL]) / c->scenario->length;
        c->difference = fmax(c->difference, difference);
        double *truth = &c->settled[c->frames++];
        *truth = said[TREE];
        mote_status status =
            difference <= c->agreement ? MOTE_OK : settle(c, number, said, truth);
        if (status != MOTE_OK)
            return status;
        previous = number;
    }
    return MOTE_OK;
}

/* A row of each method. */
static mote_status judge_methods(const court *c, uint32_t stride, const oracle_methods *methods,
                                 json_t *rows, bool *method_right)
{
    const oracle_truth truth = {c->scenario, c->buffer, stride, c->frames, c->settled};
    mote_status status = MOTE_OK;
    for (size_t m = 0; m < methods->count && status == MOTE_OK; m++) {
        json_t *row = NULL;
        bool right = false;
        status = oracle_method(&truth, &methods->choice[m], methods->seconds, &row, &right);
        method_right[m] = method_right[m] && right;
        json_array_append_new(rows, row);
    }
    return status;
}

mote_status oracle_frames(const char *scenario, uint32_t stride, double agreement,
                          const oracle_methods *methods, json_t **study, bool *right,
                          bool *method_right)
{
    court c;
    json_t *rows = json_array();
    mote_status status = open_court(scenario, &c);
    c.agreement = agreement;
    if (status == MOTE_OK)
        status = judge_frames(&c, stride);
    if (status == MOTE_OK)
        status = judge_methods(&c, stride, methods, rows, method_right);
    if (status == MOTE_OK) {
        *study =
            json_pack("{s:s, s:i, s:i, s:f, s:i, s:i, s:O, s:O}", "scenario", scenario,
                      "frames", (int)c.frames, "stride", (int)stride, "difference_max",
                      c.difference, "aabb_tree_wrong", (int)c.wrong[TREE], "fcl_aabb_wrong",
                      (int)c.wrong[FCL], "disputed", c.disputed, "methods", rows);
        *right = c.wrong[TREE] == 0;
    }
    json_decref(rows);
    close_court(&c);
    return status;
}
