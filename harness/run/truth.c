#include "harness/run/truth.h"

#include "harness/process/child.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/engine/engine.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ORACLE "fcl-aabb"
#define SECOND "aabb-tree"
#define JUDGE "aabb-tree:arithmetic=wide,seed=none" /* decides if the two sources disagree */
#define REFEREE "brute-force"
#define AGREEMENT 1e-12 /* of L */

/* Frames that brute force checks (all, if there are fewer): a quarter in contact, a third near,
   the rest evenly spread; fewer if the meshes are so large that this would exceed CHECKED_PAIRS
   pairs of triangles in total. */
#define CHECKED 24
#define CHECKED_PAIRS 3e10

/* What a child returns for each frame. */
typedef struct truth_row {
    double distance;
    mote_vec3 a, b;
    double overruled;
} truth_row;

/* A missing witness. */
static const mote_vec3 nowhere = {(double)NAN, (double)NAN, (double)NAN};

mote_truth *mote_truth_allocate(uint32_t frames)
{
    mote_truth *made = mote_allocate(1, sizeof *made);
    made->frames = frames;
    made->distance = mote_allocate(frames, sizeof *made->distance);
    made->contact = mote_allocate(frames, sizeof *made->contact);
    made->witness_a = mote_allocate(frames, sizeof *made->witness_a);
    made->witness_b = mote_allocate(frames, sizeof *made->witness_b);
    made->overruled = mote_allocate(frames, sizeof *made->overruled);
    for (uint32_t i = 0; i < frames; ++i) {
        made->distance[i] = made->overruled[i] = nowhere.x;
        made->witness_a[i] = made->witness_b[i] = nowhere;
    }
    return made;
}

void mote_truth_destroy(mote_truth *truth)
{
    if (!truth)
        return;
    free(truth->distance);
    free(truth->contact);
    free(truth->witness_a);
    free(truth->witness_b);
    free(truth->overruled);
    free(truth);
}

void mote_truth_set_contacts(const mote_scenario *scenario, mote_truth *truth)
{
    for (uint32_t i = 0; i < truth->frames; ++i)
        truth->contact[i] = truth->distance[i] <= scenario->tolerance;
}

/* The sources of a scenario's truth. The judge's trees are hardly ever needed, and of a million
   triangles a tenth of the memory of all: they are built when it is first asked. */
typedef struct sources {
    const mote_scenario *scenario;
    mote_engine *oracle, *second;
    mote_engine *judge; /* NULL until then */
} sources;

static mote_status ask(const sources *s, const char *method, mote_engine *engine,
                       const mote_frame *frame, mote_answer *answer)
{
    mote_status status = mote_engine_answer(engine, frame, answer);
    if (status == MOTE_OK && (!answer->has_distance || !(answer->distance >= 0)))
        status = mote_fail(MOTE_ENUMERIC, "%s: frame %" PRIu64 ": %s gave no distance",
                           s->scenario->name, frame->number, method);
    return status;
}

/* Settles a frame on which the two sources disagree: the answer of the tree in 113 bits
   counts. */
static mote_status settle(sources *s, const mote_frame *frame, double second,
                          mote_answer *answer)
{
    const double overruled = answer->distance;
    mote_status status = MOTE_OK;
    if (!s->judge)
        status = mote_engine_open_distance(s->scenario->body, JUDGE, &s->judge);
    if (status == MOTE_OK)
        status = ask(s, JUDGE, s->judge, frame, answer);
    if (status == MOTE_OK)
        (void)fprintf(stderr,
                      "mote: %s: frame %" PRIu64 ": " ORACLE " says %.17g, " SECOND
                      " %.17g; settled in 113 bits: %.17g\n",
                      s->scenario->name, frame->number, overruled, second, answer->distance);
    return status;
}

static mote_status answer_frame(sources *s, const mote_frame *frame, truth_row *row)
{
    mote_answer answer, second;
    mote_status status = ask(s, ORACLE, s->oracle, frame, &answer);
    if (status == MOTE_OK)
        status = ask(s, SECOND, s->second, frame, &second);
    if (status != MOTE_OK)
        return status;
    row->overruled = nowhere.x;
    if (!(fabs(answer.distance - second.distance) <= AGREEMENT * s->scenario->length)) {
        row->overruled = answer.distance;
        status = settle(s, frame, second.distance, &answer);
    }
    row->distance = answer.distance;
    row->a = answer.has_witness ? answer.witness[0] : nowhere;
    row->b = answer.has_witness ? answer.witness[1] : nowhere;
    return status;
}

static mote_status answer_all(const mote_scenario *scenario, mote_frame_buffer *buffer,
                              truth_row *rows)
{
    sources s = {.scenario = scenario};
    mote_status status = mote_engine_open_distance(scenario->body, ORACLE, &s.oracle);
    if (status == MOTE_OK)
        status = mote_engine_open_distance(scenario->body, SECOND, &s.second);
    for (uint32_t k = 0; k < scenario->frames && status == MOTE_OK; ++k)
        status = answer_frame(&s, mote_scenario_frame(scenario, buffer, k + 1, k), &rows[k]);
    mote_engine_destroy(s.oracle);
    mote_engine_destroy(s.second);
    mote_engine_destroy(s.judge);
    return status;
}

/* Marks at most count of the frames with wanted[k], evenly spread, including the first and the
   last. */
static void mark_evenly(const bool *wanted, uint32_t frames, uint32_t count, bool *marked)
{
    uint32_t total = 0;
    for (uint32_t k = 0; k < frames; ++k)
        total += wanted[k];
    const uint32_t pick = total < count ? total : count;
    uint32_t seen = 0, picked = 0;
    for (uint32_t k = 0; k < frames; ++k) {
        if (!wanted[k])
            continue;
        const uint64_t at = pick > 1 ? (uint64_t)picked * (total - 1) / (pick - 1) : 0;
        if (picked < pick && seen == at) {
            marked[k] = true;
            ++picked;
        }
        ++seen;
    }
}

static void mark_nearest(const truth_row *rows, uint32_t frames, uint32_t count, bool *marked)
{
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t best = frames;
        for (uint32_t k = 0; k < frames; ++k) {
            if (!marked[k] && rows[k].distance > 0 &&
                (best == frames || rows[k].distance < rows[best].distance))
                best = k;
        }
        if (best < frames)
            marked[best] = true;
    }
}

static uint32_t affordable_checks(const mote_scenario *scenario)
{
    const double pairs =
        (double)scenario->body[0].mesh->triangle_count * scenario->body[1].mesh->triangle_count;
    return pairs * CHECKED <= CHECKED_PAIRS ? CHECKED : (uint32_t)(CHECKED_PAIRS / pairs);
}

static void choose_frames(const mote_scenario *scenario, const truth_row *rows, bool *marked)
{
    const uint32_t frames = scenario->frames;
    const uint32_t checks = affordable_checks(scenario);
    bool *wanted = mote_allocate(frames, sizeof *wanted);
    for (uint32_t k = 0; k < frames; ++k)
        wanted[k] = rows[k].distance == 0;
    mark_evenly(wanted, frames, checks / 4, marked);
    mark_nearest(rows, frames, checks / 3, marked);
    /* Frames not yet chosen, so the groups add up. */
    uint32_t chosen = 0;
    for (uint32_t k = 0; k < frames; ++k) {
        wanted[k] = !marked[k];
        chosen += marked[k];
    }
    mark_evenly(wanted, frames, checks - chosen, marked);
    free(wanted);
}

static mote_status check_frames(const mote_scenario *scenario, mote_frame_buffer *buffer,
                                const truth_row *rows, const bool *marked, uint32_t *checked)
{
    mote_engine *engine;
    mote_status status = mote_engine_open_distance(scenario->body, REFEREE, &engine);
    if (status != MOTE_OK)
        return status;
    *checked = 0;
    for (uint32_t k = 0; k < scenario->frames && status == MOTE_OK; ++k) {
        if (!marked[k])
            continue;
        mote_answer answer;
        const mote_frame *frame = mote_scenario_frame(scenario, buffer, k + 1, 0);
        status = mote_engine_answer(engine, frame, &answer);
        if (status == MOTE_OK &&
            !(fabs(answer.distance - rows[k].distance) <= AGREEMENT * scenario->length))
            status = mote_fail(
                MOTE_ENUMERIC,
                "%s: frame %u: the trees say %.17g, %s %.17g; they may differ by %g L",
                scenario->name, k + 1, rows[k].distance, REFEREE, answer.distance, AGREEMENT);
        ++*checked;
    }
    mote_engine_destroy(engine);
    return status;
}

/* In the child: computes and checks the answers, and sends the number checked and all rows. */
static mote_status work(void *context, int output)
{
    const mote_scenario *scenario = context;
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    uint32_t checked = 0;
    truth_row *rows = mote_allocate(scenario->frames, sizeof *rows);
    bool *marked = mote_allocate(scenario->frames, sizeof *marked);
    mote_status status = answer_all(scenario, buffer, rows);
    if (status == MOTE_OK) {
        choose_frames(scenario, rows, marked);
        status = check_frames(scenario, buffer, rows, marked, &checked);
    }
    if (status == MOTE_OK)
        status = mote_child_put(output, &checked, sizeof checked);
    if (status == MOTE_OK)
        status = mote_child_put(output, rows, scenario->frames * sizeof *rows);
    mote_frame_buffer_destroy(buffer);
    free(rows);
    free(marked);
    return status;
}

mote_status mote_truth_compute(const mote_scenario *scenario, mote_truth **truth)
{
    const size_t size = sizeof(uint32_t) + scenario->frames * sizeof(truth_row);
    const mote_child_limits limits = {.output_bytes = size};
    char *output = NULL;
    size_t got = 0;
    /* The context is not written to; the child has its own copy. */
    mote_status status =
        mote_child_run("truth", work, (void *)(uintptr_t)scenario, limits, &output, &got);
    if (status == MOTE_OK && got != size)
        status = mote_fail(MOTE_EIO, "%s: the truth's process ended early", scenario->name);
    if (status == MOTE_OK) {
        mote_truth *made = mote_truth_allocate(scenario->frames);
        memcpy(&made->checked, output, sizeof made->checked);
        for (uint32_t k = 0; k < scenario->frames; ++k) {
            truth_row row;
            memcpy(&row, output + sizeof(uint32_t) + k * sizeof row, sizeof row);
            made->distance[k] = row.distance;
            made->witness_a[k] = row.a;
            made->witness_b[k] = row.b;
            made->overruled[k] = row.overruled;
        }
        mote_truth_set_contacts(scenario, made);
        *truth = made;
    }
    free(output);
    return status;
}

mote_status mote_truth_load_or_compute_known(const mote_scenario *scenario,
                                             uint64_t fingerprint, const char *directory,
                                             mote_truth **truth)
{
    char *folder = mote_format("%s/truth", directory);
    char *path = mote_truth_path(directory, scenario, fingerprint);
    mote_status status = mote_directory_make(folder);
    /* A missing or damaged file is computed again. */
    if (status == MOTE_OK && mote_truth_read(scenario, fingerprint, path, truth) != MOTE_OK) {
        mote_truth *made = NULL;
        status = mote_truth_compute(scenario, &made);
        if (status == MOTE_OK) {
            made->fingerprint = fingerprint;
            status = mote_truth_write(scenario, made, path);
        }
        if (status == MOTE_OK)
            *truth = made;
        else
            mote_truth_destroy(made);
    }
    free(folder);
    free(path);
    return status;
}

mote_status mote_truth_load_or_compute(const mote_scenario *scenario, const char *directory,
                                       mote_truth **truth)
{
    uint64_t fingerprint;
    mote_status status = mote_scenario_fingerprint(scenario, &fingerprint);
    if (status == MOTE_OK)
        status = mote_truth_load_or_compute_known(scenario, fingerprint, directory, truth);
    return status;
}
