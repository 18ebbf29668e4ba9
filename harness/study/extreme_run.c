/* Runs a method on an extreme scene in a child process, and judges it. */
#include "harness/study/extreme.h"

#include "harness/process/child.h"
#include "harness/run/measure.h"
#include "harness/engine/engine.h"
#include "harness/base/statistics.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

/* Limits of processor time and of wall time; the latter is longer since other programs may
   run. */
#define SECONDS 10
#define SECONDS_WAITED 100.0
#define MEMORY_BYTES ((size_t)1 << 30)

/* The largest error that counts as exact, relative to L. */
#define EXACT 1e-12

/* The error allowed for a method that claims to be exact, in units in the last place of the
   largest coordinate: no answer can be better than its input. */
#define ROUNDING 16

const char *const mote_extreme_verdicts[] = {"none",  "right", "inexact", "refused",
                                             "wrong", "nan",   "hung",    "crashed"};

/* The error allowed for answers for convex hulls, relative to L: the concavity of a part. */
#define CONCAVITY 0.1

/* The child's report. */
typedef struct message {
    mote_status status;
    char text[200];
    uint64_t build_ns;
    uint64_t ns[MOTE_EXTREME_FRAMES];
    mote_extreme_said said[MOTE_EXTREME_FRAMES];
} message;

typedef struct task {
    const mote_extreme *extreme;
    mote_method_choice choice;
} task;

static mote_status ask_all(const task *t, message *told)
{
    const mote_extreme *e = t->extreme;
    mote_engine *engine = NULL;
    uint64_t start = mote_clock_ns();
    mote_status status = mote_engine_open_two(&e->body[0], &e->body[1], &t->choice,
                                              MOTE_ASK_DISTANCE, 0, 1, &engine);
    const bool contact_only = status == MOTE_EUNSUPPORTED;
    if (contact_only)
        status = mote_engine_open_two(&e->body[0], &e->body[1], &t->choice, MOTE_ASK_CONTACT, 0,
                                      1, &engine);
    told->build_ns = mote_clock_ns() - start;
    const mote_traits traits = mote_method_traits(t->choice.method, t->choice.values);
    for (uint32_t f = 0; f < MOTE_EXTREME_FRAMES && status == MOTE_OK; ++f) {
        told->said[f].exact = traits.exact;
        told->said[f].hulls = traits.hulls;
        told->said[f].single = e->parameters && strcmp(e->parameters, "precision=single") == 0;
        told->said[f].contact_only = contact_only;
        start = mote_clock_ns();
        status = mote_engine_answer(engine, &e->frame[f], &told->said[f].answer);
        told->ns[f] = mote_clock_ns() - start;
    }
    mote_engine_destroy(engine);
    return status;
}

static mote_status work(void *context, int output)
{
    const struct rlimit limit = {SECONDS, SECONDS};
    message told;
    (void)setrlimit(RLIMIT_CPU, &limit);
    memset(&told, 0, sizeof told);
    told.status = ask_all(context, &told);
    if (told.status != MOTE_OK)
        (void)snprintf(told.text, sizeof told.text, "%s", mote_error_text());
    return mote_child_put(output, &told, sizeof told);
}

/* The error that rounding of the input explains, relative to L. */
static double excuse(const mote_extreme *e, const mote_extreme_said *said)
{
    const double unit = said->single ? (double)FLT_EPSILON : DBL_EPSILON;
    return ROUNDING * unit * e->coordinate_max / e->length;
}

static mote_extreme_verdict judge_witness(const mote_extreme *e, uint32_t frame,
                                          const mote_extreme_said *said, char *reason,
                                          size_t size)
{
    const mote_answer *answer = &said->answer;
    const double allowed = EXACT + excuse(e, said);
    const double apart = sqrt(mote_distance_squared(answer->witness[0], answer->witness[1]));
    const double off = fabs(apart - answer->distance) / e->length;
    if (off > allowed) {
        (void)snprintf(reason, size, "points %.3g L apart for a distance of %.3g L",
                       apart / e->length, answer->distance / e->length);
        return MOTE_EXTREME_WRONG;
    }
    for (int b = 0; b < 2 && !said->hulls; ++b) {
        const double away =
            sqrt(mote_extreme_surface(e, frame, b, answer->witness[b])) / e->length;
        if (away > allowed) {
            (void)snprintf(reason, size, "a closest point %.3g L off the surface", away);
            return MOTE_EXTREME_WRONG;
        }
    }
    return MOTE_EXTREME_RIGHT;
}

static mote_extreme_verdict judge_distance(const mote_extreme *e, uint32_t frame,
                                           const mote_extreme_said *said, double *error,
                                           char *reason, size_t size)
{
    const mote_answer *answer = &said->answer;
    const double truth = e->truth[frame] / e->length;
    *error = (answer->distance - e->truth[frame]) / e->length;
    if (answer->has_lower && answer->lower / e->length - truth > EXACT + excuse(e, said)) {
        (void)snprintf(reason, size, "a lower bound of %.3g L above a truth of %.3g L",
                       answer->lower / e->length - truth, truth);
        return MOTE_EXTREME_WRONG;
    }
    if (answer->has_witness && answer->distance > 0) {
        const mote_extreme_verdict points = judge_witness(e, frame, said, reason, size);
        if (points != MOTE_EXTREME_RIGHT)
            return points;
    }
    if (fabs(*error) <= EXACT)
        return MOTE_EXTREME_RIGHT;
    (void)snprintf(reason, size, "%.3g L for %.3g L", answer->distance / e->length, truth);
    /* An approximate method gives points on the surfaces, so its distance is never too
       small. */
    bool allowed = *error >= -excuse(e, said) - EXACT;
    if (said->exact)
        allowed = fabs(*error) <= excuse(e, said);
    else if (said->hulls)
        allowed = fabs(*error) <= CONCAVITY + excuse(e, said);
    return allowed ? MOTE_EXTREME_INEXACT : MOTE_EXTREME_WRONG;
}

static mote_extreme_verdict judge_contact(const mote_extreme *e, uint32_t frame,
                                          const mote_extreme_said *said, char *reason,
                                          size_t size)
{
    const double truth = e->truth[frame] / e->length;
    const bool touches = truth == 0;
    if (said->answer.contact == touches)
        return MOTE_EXTREME_RIGHT;
    (void)snprintf(reason, size, "%s for bodies %.3g L apart",
                   said->answer.contact ? "a contact" : "no contact", truth);
    if (said->hulls || (truth <= EXACT + excuse(e, said) && !touches))
        return MOTE_EXTREME_INEXACT;
    /* A distance that is too large explains a missed contact. */
    return !said->contact_only && touches && !said->exact && said->answer.distance > 0
               ? MOTE_EXTREME_INEXACT
               : MOTE_EXTREME_WRONG;
}

mote_extreme_verdict mote_extreme_judge(const mote_extreme *e, uint32_t frame,
                                        const mote_extreme_said *said, double *error,
                                        char *reason, size_t size)
{
    const mote_answer *answer = &said->answer;
    *error = 0;
    if ((answer->has_distance && !isfinite(answer->distance)) ||
        (answer->has_lower && !isfinite(answer->lower)) ||
        (answer->has_witness &&
         !(mote_is_finite(answer->witness[0]) && mote_is_finite(answer->witness[1])))) {
        (void)snprintf(reason, size, "not a finite number");
        return MOTE_EXTREME_NAN;
    }
    if (!answer->has_distance && !answer->has_contact) {
        (void)snprintf(reason, size, "neither a distance nor a contact");
        return MOTE_EXTREME_WRONG;
    }
    if (answer->has_distance && answer->distance < 0) {
        (void)snprintf(reason, size, "a negative distance");
        return MOTE_EXTREME_WRONG;
    }
    mote_extreme_verdict verdict = MOTE_EXTREME_RIGHT;
    if (answer->has_distance && !said->contact_only)
        verdict = judge_distance(e, frame, said, error, reason, size);
    if (verdict == MOTE_EXTREME_RIGHT && answer->has_contact)
        verdict = judge_contact(e, frame, said, reason, size);
    return verdict;
}

static void judge_all(const mote_extreme *e, const message *told, mote_extreme_cell *cell)
{
    double ns[MOTE_EXTREME_FRAMES];
    cell->verdict = MOTE_EXTREME_RIGHT;
    for (uint32_t f = 0; f < MOTE_EXTREME_FRAMES; ++f) {
        char reason[200] = "";
        double error;
        const mote_extreme_verdict verdict =
            mote_extreme_judge(e, f, &told->said[f], &error, reason, sizeof reason);
        ns[f] = (double)told->ns[f];
        if (fabs(error) > fabs(cell->error) || cell->frame == 0) {
            cell->error = error;
            cell->frame = f + 1;
        }
        if (verdict > cell->verdict) {
            cell->verdict = verdict;
            (void)snprintf(cell->reason, sizeof cell->reason, "frame %u: %s", f + 1, reason);
        }
    }
    cell->build_ns = told->build_ns;
    cell->query_ns = (uint64_t)mote_statistics_median(ns, MOTE_EXTREME_FRAMES);
}

/* Whether a method has the key of a parameter such as "n=1". */
static bool has_key(const mote_method *method, const char *parameter)
{
    for (size_t i = 0; method && i < method->parameter_count; ++i) {
        const char *key = method->parameters[i].key;
        const size_t length = strlen(key);
        if (strncmp(parameter, key, length) == 0 && parameter[length] == '=')
            return true;
    }
    return false;
}

/* Chooses the method with the scene's parameters; *has is false if it lacks one, or if its key
   of that name takes no such value (precision is a number where impacts are asked for). */
static mote_status choose(const mote_extreme *e, const char *method, mote_method_choice *choice,
                          bool *has)
{
    *has = !e->parameters;
    if (e->parameters && has_key(mote_method_find(method), e->parameters)) {
        char text[128];
        (void)snprintf(text, sizeof text, "%s:%s", method, e->parameters);
        *has = mote_method_choice_read(text, choice) == MOTE_OK;
        if (*has)
            return MOTE_OK;
    }
    return mote_method_choice_read(method, choice);
}

/* Processor time of all children so far. */
static double children_seconds(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_CHILDREN, &usage) != 0)
        return 0;
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static void conclude(const mote_extreme *e, const mote_child *child, double used,
                     mote_extreme_cell *cell)
{
    message told;
    if (child->end == MOTE_CHILD_DONE && child->size == sizeof told) {
        memcpy(&told, child->output, sizeof told);
        if (told.status == MOTE_OK) {
            judge_all(e, &told, cell);
            return;
        }
        cell->verdict = told.text[0] ? MOTE_EXTREME_REFUSED : MOTE_EXTREME_WRONG; /* silently */
        (void)snprintf(cell->reason, sizeof cell->reason, "%s", told.text);
        return;
    }
    const bool late = child->end == MOTE_CHILD_TIMEOUT || used >= SECONDS - 0.5;
    cell->verdict = late ? MOTE_EXTREME_HUNG : MOTE_EXTREME_CRASHED;
    (void)snprintf(cell->reason, sizeof cell->reason, "%.200s",
                   late ? "no answer in time" : child->text);
}

mote_status mote_extreme_run(const mote_extreme *e, const char *method, mote_extreme_cell *cell)
{
    *cell = (mote_extreme_cell){.verdict = MOTE_EXTREME_NONE};
    task t = {.extreme = e};
    bool has = false;
    mote_status status = choose(e, method, &t.choice, &has);
    if (status != MOTE_OK || !has)
        return status;
    if (e->refusal[0]) {
        cell->verdict = MOTE_EXTREME_REFUSED;
        (void)snprintf(cell->reason, sizeof cell->reason, "%s", e->refusal);
        return MOTE_OK;
    }
    const mote_child_limits limits = {.seconds = SECONDS_WAITED,
                                      .memory_bytes = MEMORY_BYTES,
                                      .output_bytes = sizeof(message)};
    const double used = children_seconds();
    mote_child child = {0};
    size_t index = 0;
    status = mote_child_start(work, &t, limits, &child);
    if (status == MOTE_OK)
        status = mote_child_wait(&child, 1, &index);
    if (status == MOTE_OK)
        conclude(e, &child, children_seconds() - used, cell);
    mote_child_release(&child);
    return status;
}
