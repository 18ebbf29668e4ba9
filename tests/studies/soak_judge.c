#include "tests/studies/soak_judge.h"

#include "harness/process/child.h"
#include "harness/engine/engine.h"
#include "harness/scene/scenario.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RIGHT 1e-12 /* of L */
#define CONTACT 0.0

const char *const soak_methods[SOAK_METHODS] = {
    "certified",           "certified:seed=none", "certified:seed=tracked",
    "certified:seed=pair", "certified:budget=60", "aabb-tree",
    "particle:n=8",        "particle-paper:n=5",  "particle-paper:n=8,refine=always"};

static const char *const settler = "aabb-tree:arithmetic=wide,seed=none";

typedef struct bench {
    const char *path;
    const soak_plant *plant;
    bool stop;
    mote_scenario *scenario;
    mote_frame_buffer *buffer;
    mote_engine *probe[SOAK_METHODS + 1]; /* the last one settles; opened when needed */
    soak_verdict verdict;
} bench;

static mote_status open_probe(bench *b, int m)
{
    mote_method_choice choice;
    mote_status status =
        mote_method_choice_read(m < SOAK_METHODS ? soak_methods[m] : settler, &choice);
    if (status == MOTE_OK)
        status = mote_engine_open_two(&b->scenario->body[0], &b->scenario->body[1], &choice,
                                      MOTE_ASK_DISTANCE, CONTACT, 1, &b->probe[m]);
    return status;
}

static mote_status open_bench(bench *b)
{
    mote_status status = mote_scenario_load(b->path, &b->scenario);
    if (status == MOTE_OK)
        b->buffer = mote_frame_buffer_create(b->scenario);
    for (int m = 0; m < SOAK_METHODS && status == MOTE_OK; ++m) {
        status = open_probe(b, m);
        /* Few particles are refused on meshes of many components. */
        if (status == MOTE_EUNSUPPORTED || (status == MOTE_EINVAL && m >= SOAK_EXACT))
            status = MOTE_OK;
    }
    return status;
}

static void close_bench(bench *b)
{
    for (int m = 0; m <= SOAK_METHODS; ++m)
        mote_engine_destroy(b->probe[m]);
    mote_frame_buffer_destroy(b->buffer);
    mote_scenario_destroy(b->scenario);
}

static bool is_right(double distance, double truth, double length)
{
    return fabs(distance - truth) <= RIGHT * length;
}

/* The distance that all exact methods agree on, or else the one in 113 bits. */
static mote_status find_truth(bench *b, const mote_frame *frame, const mote_answer *answers,
                              double *truth)
{
    const double length = b->scenario->length;
    *truth = answers[SOAK_EXACT - 1].distance;
    bool agreed = true;
    for (int m = 0; m < SOAK_EXACT && agreed; ++m)
        agreed = m == SOAK_BOUNDED || is_right(answers[m].distance, *truth, length);
    if (agreed)
        return MOTE_OK;
    ++b->verdict.settled;
    mote_status status = b->probe[SOAK_METHODS] ? MOTE_OK : open_probe(b, SOAK_METHODS);
    mote_answer settled;
    if (status == MOTE_OK)
        status = mote_engine_answer(b->probe[SOAK_METHODS], frame, &settled);
    if (status == MOTE_OK)
        *truth = settled.distance;
    return status;
}

/* What the rounding of a lower bound is proportional to: L, and what a field adds up to before
   its parts cancel. The weights of a thin body whose two sides are displaced differently are
   thousands of times as large as what it is displaced by. */
static double terms(const mote_frame *frame, double length)
{
    double sum = length;
    for (int b = 0; b < 2; ++b) {
        const mote_weights *weights = &frame->body[b].weights;
        for (uint32_t j = 0; j < weights->count; ++j)
            sum += fabs(weights->x[j]) + fabs(weights->y[j]) + fabs(weights->z[j]);
    }
    return sum;
}

/* Counts one answer; true when it is a failure. */
static bool count(soak_tally *tally, const mote_answer *answer, int m, double truth,
                  double length, double rounding)
{
    const double error = fabs(answer->distance - truth) / length;
    const bool violated = answer->has_lower && !(answer->lower <= truth + 1e-15 * length);
    bool wrong = !(answer->distance >= 0) || !(error < HUGE_VAL);
    if (m < SOAK_EXACT && m != SOAK_BOUNDED)
        wrong = wrong || !(error <= RIGHT);
    if (m < SOAK_BOUNDED)
        wrong = wrong || !answer->has_lower || !is_right(answer->lower, truth, rounding);
    /* Witnesses lie on the surfaces, so no method's distance may be below the truth. */
    wrong = wrong || answer->distance < truth - RIGHT * length;
    if (answer->has_witness && answer->distance > 0)
        wrong = wrong ||
                !is_right(sqrt(mote_distance_squared(answer->witness[0], answer->witness[1])),
                          answer->distance, length);
    int decade = 0;
    while (decade < SOAK_DECADES - 1 && !(error < pow(10, decade - 16)))
        ++decade;
    ++tally->queries;
    ++tally->decades[decade];
    tally->wrong += wrong;
    tally->violated += violated;
    tally->missed += truth <= CONTACT && answer->distance > RIGHT * length;
    tally->false_contacts += truth > RIGHT * length && answer->distance <= CONTACT;
    if (!(error <= tally->largest))
        tally->largest = error;
    if (m < SOAK_BOUNDED && !((truth - answer->lower) / length <= tally->loosest))
        tally->loosest = (truth - answer->lower) / length;
    return wrong || violated;
}

static mote_status judge_frame(bench *b, uint32_t number, uint32_t previous)
{
    const mote_frame *frame = mote_scenario_frame(b->scenario, b->buffer, number, previous);
    mote_answer answers[SOAK_METHODS];
    for (int m = 0; m < SOAK_METHODS; ++m) {
        mote_status status =
            b->probe[m] ? mote_engine_answer(b->probe[m], frame, &answers[m]) : MOTE_OK;
        if (status != MOTE_OK)
            return status;
    }
    const double length = b->scenario->length, rounding = terms(frame, length);
    if (b->plant && b->plant->frame == number) {
        answers[0].distance = answers[0].distance * (1 + 1e-9) + 1e-9 * length;
        answers[1].lower = 0;
    }
    double truth;
    mote_status status = find_truth(b, frame, answers, &truth);
    for (int m = 0; m < SOAK_METHODS && status == MOTE_OK; ++m) {
        if (b->probe[m] &&
            count(&b->verdict.tally[m], &answers[m], m, truth, length, rounding) &&
            b->verdict.failed_frame == 0)
            b->verdict.failed_frame = number;
    }
    ++b->verdict.frames;
    return status;
}

static mote_status judge_frames(bench *b)
{
    mote_status status = MOTE_OK;
    for (uint32_t number = 1; number <= b->scenario->frames && status == MOTE_OK; ++number) {
        status = judge_frame(b, number, number - 1);
        if (b->stop && b->verdict.failed_frame > 0)
            break;
    }
    return status;
}

static mote_status work(void *context, int output)
{
    bench *b = context;
    mote_status status = open_bench(b);
    /* A refused scenario is not a failure; a refused query is. */
    if (status == MOTE_OK)
        status = judge_frames(b) == MOTE_OK ? MOTE_OK : MOTE_EIO;
    if (status == MOTE_OK)
        status = mote_child_put(output, &b->verdict, sizeof b->verdict);
    close_bench(b);
    return status;
}

mote_status soak_judge(const char *path, const soak_plant *plant, bool stop,
                       soak_verdict *verdict)
{
    bench b = {.path = path, .plant = plant, .stop = stop};
    const mote_child_limits limits = {.seconds = 300, .output_bytes = sizeof b.verdict};
    char *output = NULL;
    size_t size = 0;
    *verdict = (soak_verdict){0};
    mote_status status = mote_child_run(path, work, &b, limits, &output, &size);
    if (status == MOTE_OK && size != sizeof *verdict)
        status = mote_fail(MOTE_EIO, "%s: its judge said %zu bytes, not %zu", path, size,
                           sizeof *verdict);
    if (status == MOTE_OK)
        memcpy(verdict, output, sizeof *verdict);
    free(output);
    return status;
}
