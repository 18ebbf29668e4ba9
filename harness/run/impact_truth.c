#include "harness/run/impact_truth.h"

#include "core/certificate/certificate.h"
#include "core/impact/impact.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/engine/engine.h"
#include "harness/process/child.h"
#include "harness/run/truth.h"
#include "harness/scene/scenario_path.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAMPLES 1000  /* of a gap, after its first frame */
#define BISECTIONS 40 /* of the interval between two samples */
#define REFEREE "aabb-tree"
#define AGREEMENT 1e-12 /* of L */

#define COLUMNS "frame,first\n"
#define UNDECIDED "undecided"

/* What answers about one gap after the other. */
typedef struct sources {
    const mote_scenario *scenario;
    mote_scenario_path *path;      /* of one gap */
    mote_certificate *certificate; /* of samples */
    mote_impact_search *search;
    mote_engine *referee;
    double *weights[2];
    mote_frame frame;
} sources;

static mote_status open_sources(const mote_scenario *scenario, sources *s)
{
    const mote_body *const bodies[] = {&scenario->body[0], &scenario->body[1]};
    mote_impact_options impacts = mote_default_impact_options(scenario->length);
    const mote_certificate_options distances =
        mote_default_certificate_options(scenario->length);
    impacts.pieces = 1;
    *s = (sources){.scenario = scenario};
    for (int i = 0; i < 2; ++i)
        s->weights[i] =
            mote_allocate(3 * (size_t)scenario->body[i].field->padded + 1, sizeof(double));
    mote_status status = mote_scenario_path_create(scenario, 1, &s->path);
    if (status == MOTE_OK)
        status = mote_certificate_create(bodies, &distances, &s->certificate);
    if (status == MOTE_OK)
        status = mote_impact_create(bodies, &impacts, &s->search);
    if (status == MOTE_OK)
        status = mote_engine_open_distance(scenario->body, REFEREE, &s->referee);
    return status;
}

static void close_sources(sources *s)
{
    mote_scenario_path_destroy(s->path);
    mote_certificate_destroy(s->certificate);
    mote_impact_destroy(s->search);
    mote_engine_destroy(s->referee);
    free(s->weights[0]);
    free(s->weights[1]);
}

/* Moves the bodies to a time of the gap. */
static const mote_frame *move_to(sources *s, double time)
{
    for (int i = 0; i < 2; ++i)
        mote_path_state(mote_scenario_path_of(s->path, i), &s->scenario->body[i], time,
                        s->weights[i], &s->frame.body[i]);
    ++s->frame.number;
    return &s->frame;
}

static bool touch_at(sources *s, double time)
{
    mote_certificate_answer at;
    mote_certificate_query(s->certificate, move_to(s, time), NULL, s->scenario->tolerance, &at);
    return at.distance <= s->scenario->tolerance;
}

/* The first sample in contact, bisected; NaN: none is. */
static double sample(sources *s)
{
    if (touch_at(s, 0))
        return 0;
    for (int i = 1; i <= SAMPLES; ++i) {
        double high = (double)i / SAMPLES, low = (i - 1.0) / SAMPLES;
        if (!touch_at(s, high))
            continue;
        for (int k = 0; k < BISECTIONS; ++k) {
            const double middle = 0.5 * (low + high);
            *(touch_at(s, middle) ? &high : &low) = middle;
        }
        return high;
    }
    return (double)NAN;
}

/* The certified time of impact; NaN: none. Infinite where that is left open. */
static mote_status search_for_impact(sources *s, double *first)
{
    const mote_impact_question question = {
        .path = {mote_scenario_path_of(s->path, 0), mote_scenario_path_of(s->path, 1)},
        .end = 1,
        .tolerance = s->scenario->tolerance};
    mote_impact_found found;
    const mote_status status = mote_impact_query(s->search, &question, &found);
    const bool is_found = status == MOTE_OK && found.outcome == MOTE_IMPACT_FOUND;
    const bool is_none = status != MOTE_OK || found.outcome == MOTE_IMPACT_NONE;
    *first = is_found ? found.to : is_none ? (double)NAN : HUGE_VAL;
    return status;
}

/* Asks the referee whether the bodies are in contact at a time. */
static mote_status check(sources *s, uint32_t frame, double time, bool contact)
{
    mote_answer answer = {.has_distance = false};
    const mote_status status = mote_engine_answer(s->referee, move_to(s, time), &answer);
    if (status != MOTE_OK)
        return status;
    const double over = answer.distance - s->scenario->tolerance;
    const double most = AGREEMENT * s->scenario->length;
    if (contact ? over <= most : over >= -most)
        return MOTE_OK;
    return mote_fail(MOTE_ENUMERIC,
                     "%s: %.9g frames after frame %u the certified query says that the bodies "
                     "are %s, and " REFEREE " that their distance is %.17g",
                     s->scenario->name, time, frame, contact ? "in contact" : "apart",
                     answer.distance);
}

static mote_status answer_gap(sources *s, uint32_t frame, double *first, uint32_t *unsampled)
{
    double searched;
    mote_scenario_path_set(s->path, frame);
    const double sampled = sample(s);
    mote_status status = search_for_impact(s, &searched);
    /* A bracket is wider than what is bisected: a later time that follows from it is the same
       impact. What the search leaves open a sample in contact decides. */
    *first = searched < sampled || isnan(sampled) ? searched : sampled;
    *unsampled += isnan(sampled) && searched <= 1;
    if (status == MOTE_OK)
        status = check(s, frame, *first <= 1 ? *first : 0.5, *first <= 1);
    return status;
}

/* In the child: sends the first impacts of all gaps, and how many no sample has seen. */
static mote_status work(void *context, int output)
{
    const mote_scenario *scenario = context;
    const uint32_t gaps = scenario->frames - 1;
    double *first = mote_allocate(gaps, sizeof *first);
    uint32_t unsampled = 0;
    sources s;
    mote_status status = open_sources(scenario, &s);
    for (uint32_t k = 0; k < gaps && status == MOTE_OK; ++k)
        status = answer_gap(&s, k + 1, &first[k], &unsampled);
    close_sources(&s);
    if (status == MOTE_OK)
        status = mote_child_put(output, &unsampled, sizeof unsampled);
    if (status == MOTE_OK)
        status = mote_child_put(output, first, gaps * sizeof *first);
    free(first);
    return status;
}

static mote_impact_truth *new_truth(const mote_scenario *scenario, uint64_t fingerprint)
{
    mote_impact_truth *made = mote_allocate(1, sizeof *made);
    made->fingerprint = fingerprint;
    made->gaps = scenario->frames - 1;
    made->first = mote_allocate(made->gaps, sizeof *made->first);
    return made;
}

void mote_impact_truth_destroy(mote_impact_truth *truth)
{
    if (truth)
        free(truth->first);
    free(truth);
}

static mote_status compute(const mote_scenario *scenario, uint64_t fingerprint,
                           mote_impact_truth **truth)
{
    const size_t size = sizeof(uint32_t) + (scenario->frames - 1) * sizeof(double);
    const mote_child_limits limits = {.output_bytes = size};
    char *output = NULL;
    size_t got = 0;
    /* The context is not written to; the child has its own copy. */
    mote_status status = mote_child_run("truth of impacts", work, (void *)(uintptr_t)scenario,
                                        limits, &output, &got);
    if (status == MOTE_OK && got != size)
        status = mote_fail(MOTE_EIO, "%s: the truth's process ended early", scenario->name);
    if (status == MOTE_OK) {
        mote_impact_truth *made = new_truth(scenario, fingerprint);
        memcpy(&made->unsampled, output, sizeof made->unsampled);
        memcpy(made->first, output + sizeof(uint32_t), made->gaps * sizeof *made->first);
        *truth = made;
    }
    free(output);
    return status;
}

/* The first line of the file, but for the number of impacts at its end. */
static char *first_part(const mote_scenario *scenario, uint64_t fingerprint)
{
    return mote_format("# impacts of %s, fingerprint %016" PRIx64 ", faces %016" PRIx64
                       ", tolerance %.17g, %u frames, not in samples: ",
                       scenario->name, fingerprint, mote_scenario_faces(scenario),
                       scenario->tolerance, scenario->frames);
}

static mote_status write_file(const mote_scenario *scenario, const mote_impact_truth *truth,
                              const char *path)
{
    mote_text text = {0};
    char *first = first_part(scenario, truth->fingerprint);
    mote_text_add(&text, "%s%u\n" COLUMNS, first, truth->unsampled);
    for (uint32_t k = 0; k < truth->gaps; ++k) {
        if (isnan(truth->first[k]))
            mote_text_add(&text, "%u,\n", k + 1);
        else if (isinf(truth->first[k]))
            mote_text_add(&text, "%u,%s\n", k + 1, UNDECIDED);
        else
            mote_text_add(&text, "%u,%.17g\n", k + 1, truth->first[k]);
    }
    mote_truth_seal(&text);
    const mote_status status = mote_file_write(path, text.data, text.size);
    free(first);
    free(text.data);
    return status;
}

/* Reads "K,T\n", "K,\n" or "K,undecided\n"; NULL if the text differs. */
static const char *read_gap(const char *at, uint32_t k, double *first)
{
    char *end;
    if (strtoul(at, &end, 10) != k + 1 || *end != ',')
        return NULL;
    at = end + 1;
    *first = (double)NAN;
    if (*at == '\n')
        return at + 1;
    if (strncmp(at, UNDECIDED "\n", strlen(UNDECIDED "\n")) == 0) {
        *first = HUGE_VAL;
        return at + strlen(UNDECIDED "\n");
    }
    *first = strtod(at, &end);
    return end != at && *end == '\n' && *first >= 0 && *first <= 1 ? end + 1 : NULL;
}

static bool read_text(const mote_scenario *scenario, char *text, size_t size,
                      mote_impact_truth *truth)
{
    if (!mote_truth_unseal(text, size))
        return false;
    char *first = first_part(scenario, truth->fingerprint), *end = NULL;
    const size_t length = strlen(first);
    const bool good = strncmp(text, first, length) == 0;
    free(first);
    const unsigned long unsampled = good ? strtoul(text + length, &end, 10) : 0;
    if (!good || unsampled > truth->gaps ||
        strncmp(end, "\n" COLUMNS, strlen("\n" COLUMNS)) != 0)
        return false;
    truth->unsampled = (uint32_t)unsampled;
    const char *at = end + strlen("\n" COLUMNS);
    for (uint32_t k = 0; at && k < truth->gaps; ++k)
        at = read_gap(at, k, &truth->first[k]);
    return at && *at == '\0';
}

/* False where there is no whole file for this scenario. */
static bool read_file(const mote_scenario *scenario, uint64_t fingerprint, const char *path,
                      mote_impact_truth **truth)
{
    char *text;
    size_t size;
    if (mote_file_read(path, (size_t)1 << 30, &text, &size) != MOTE_OK)
        return false;
    mote_impact_truth *made = new_truth(scenario, fingerprint);
    const bool good = read_text(scenario, text, size, made);
    if (good)
        *truth = made;
    else
        mote_impact_truth_destroy(made);
    free(text);
    return good;
}

char *mote_impact_truth_path(const char *directory, const mote_scenario *scenario,
                             uint64_t fingerprint)
{
    return mote_format("%s/truth/%s-%016" PRIx64 "-%016" PRIx64 "-impacts.csv", directory,
                       scenario->name, fingerprint, mote_scenario_faces(scenario));
}

mote_status mote_impact_truth_load_or_compute(const mote_scenario *scenario,
                                              uint64_t fingerprint, const char *directory,
                                              mote_impact_truth **truth)
{
    char *folder = mote_format("%s/truth", directory);
    char *path = mote_impact_truth_path(directory, scenario, fingerprint);
    mote_status status = mote_directory_make(folder);
    if (status == MOTE_OK && !read_file(scenario, fingerprint, path, truth)) {
        mote_impact_truth *made = NULL;
        status = compute(scenario, fingerprint, &made);
        if (status == MOTE_OK)
            status = write_file(scenario, made, path);
        if (status == MOTE_OK)
            *truth = made;
        else
            mote_impact_truth_destroy(made);
    }
    free(folder);
    free(path);
    return status;
}

int mote_impact_truth_between(const mote_impact_truth *truth, uint32_t frame, uint32_t step,
                              double *to)
{
    for (uint32_t k = 0; k < step && frame - 1 + k < truth->gaps; ++k) {
        const double first = truth->first[frame - 1 + k];
        if (isinf(first))
            return -1;
        if (!isnan(first)) {
            *to = (k + first) / step;
            return 1;
        }
    }
    return 0;
}
