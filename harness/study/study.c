#include "harness/study/study.h"

#include "harness/base/memory.h"
#include "harness/scene/catalog.h"
#include "harness/figure/figures.h"
#include "harness/base/json_read.h"
#include "harness/run/measure.h"
#include "harness/base/record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SEEDS 8
#define SEEDS_QUICK 3
#define WARM_FRAME 50

mote_status mote_study_open(const char *directory, bool quick, mote_study *study)
{
    memset(study, 0, sizeof *study);
    study->directory = directory;
    study->quick = quick;
    study->seeds = quick ? SEEDS_QUICK : SEEDS;
    study->run = mote_format("%s/claims-run", directory);
    char *scenarios = mote_format("%s/claims-run/scenarios", directory);
    char *figures = mote_format("%s/figures", directory);
    mote_status status = mote_directory_make(scenarios);
    if (status == MOTE_OK)
        status = mote_directory_make(figures);
    free(scenarios);
    free(figures);
    return status;
}

void mote_study_close(mote_study *study)
{
    for (size_t i = 0; i < study->scene_count; ++i) {
        mote_truth_destroy(study->scenes[i].truth);
        mote_scenario_destroy(study->scenes[i].scenario);
    }
    if (study->summarised)
        mote_summary_free(&study->summary);
    study->summarised = false;
    study->scene_count = 0;
    free(study->run);
    study->run = NULL;
}

static const mote_subject *find_scene(const mote_study *study, const char *name)
{
    for (size_t i = 0; i < study->scene_count; ++i) {
        if (strcmp(study->scenes[i].scenario->name, name) == 0)
            return &study->scenes[i];
    }
    return NULL;
}

static mote_status add_scene(mote_study *study, const char *path, bool with_truth,
                             const mote_subject **subject)
{
    if (study->scene_count == MOTE_STUDY_SCENES)
        return mote_fail(MOTE_EINVAL, "more than %d scenes", MOTE_STUDY_SCENES);
    mote_subject made = {0};
    mote_status status = mote_scenario_load(path, &made.scenario);
    if (status == MOTE_OK && with_truth)
        status = mote_truth_load_or_compute(made.scenario, study->run, &made.truth);
    if (status != MOTE_OK) {
        mote_scenario_destroy(made.scenario);
        return status;
    }
    study->scenes[study->scene_count] = made;
    *subject = &study->scenes[study->scene_count++];
    return MOTE_OK;
}

mote_status mote_study_scene(mote_study *study, const char *name, const mote_subject **subject)
{
    *subject = find_scene(study, name);
    return *subject ? MOTE_OK : add_scene(study, name, true, subject);
}

/* The scenario's file with its letters replaced. */
static mote_status change_letters(const char *path, const mote_variant *variant, json_t **root)
{
    mote_json_file read;
    const mote_status status = mote_json_open(path, &read);
    if (status != MOTE_OK)
        return status;
    json_t *made = json_incref(read.root);
    mote_json_close(&read);
    size_t index;
    json_t *body;
    const char letter[2] = {variant->letter, '\0'};
    MOTE_EACH(index, body, json_object_get(made, "bodies"))
    {
        if (variant->letter)
            (void)json_object_set_new(body, "letter", json_string(letter));
        if (variant->triangles)
            (void)json_object_set_new(body, "triangles",
                                      json_integer((json_int_t)variant->triangles));
    }
    *root = made;
    return MOTE_OK;
}

mote_status mote_study_variant(mote_study *study, const mote_variant *variant,
                               const mote_subject **subject)
{
    *subject = find_scene(study, variant->name);
    if (*subject)
        return MOTE_OK;
    char *base = mote_catalog_path(variant->base);
    char *name = mote_format("scenarios/%s.json", variant->name);
    char *path = mote_format("%s/%s", study->run, name);
    json_t *root = NULL;
    mote_status status = change_letters(base, variant, &root);
    if (status == MOTE_OK)
        status = mote_record_json(study->run, name, root);
    if (status == MOTE_OK)
        status = add_scene(study, path, variant->with_truth, subject);
    free(base);
    free(name);
    free(path);
    return status;
}

mote_status mote_study_measure(const mote_subject *subject, const char *method, mote_tour tour,
                               mote_cell_result *result)
{
    mote_method_choice choice;
    mote_status status = mote_method_choice_read(method, &choice);
    if (status != MOTE_OK)
        return status;
    const mote_cell cell = {.subject = subject,
                            .choice = &choice,
                            .replicate = 1,
                            .first = tour.last ? tour.first : 1,
                            .last = tour.last ? tour.last : subject->scenario->frames,
                            .stride = tour.stride ? tour.stride : 1,
                            .seed = tour.seed};
    return mote_measure_cell(&cell, 0, result);
}

/* Counts of one seed's frames. */
typedef struct tally {
    double frames, exact, tracked, contacts, missed, alone, wrong, allocations;
} tally;

static void count_frame(const mote_subject *subject, const mote_cell_row *row, double error,
                        tally *t)
{
    const bool contact = subject->truth->contact[row->frame - 1];
    t->frames += 1;
    t->exact += error <= MOTE_EXACT_ERROR ? 1 : 0;
    t->tracked += error <= MOTE_TRACKED_ERROR ? 1 : 0;
    t->contacts += contact ? 1 : 0;
    t->missed += contact && !row->answer.contact ? 1 : 0;
    t->alone += contact ? 0 : 1;
    t->wrong += !contact && row->answer.contact ? 1 : 0;
    t->allocations += row->frame >= WARM_FRAME ? (double)row->allocations : 0;
}

static void make_sample(const mote_subject *subject, const mote_cell_result *result,
                        mote_sample *sample)
{
    const size_t count = result->row_count;
    double *errors = mote_allocate(2 * count, sizeof *errors);
    double *times = errors + count, sum = 0;
    tally t = {0};
    for (size_t i = 0; i < count; ++i) {
        const mote_cell_row *row = &result->rows[i];
        const double truth = subject->truth->distance[row->frame - 1];
        errors[i] = fabs(row->answer.distance - truth) / subject->scenario->length;
        times[i] = (double)row->query_ns * 1e-3;
        sum += times[i];
        count_frame(subject, row, errors[i], &t);
    }
    mote_statistics_sort(errors, count);
    double *of = sample->of;
    of[MOTE_MEASURED_EXACT] = t.exact / t.frames;
    of[MOTE_MEASURED_TRACKED] = t.tracked / t.frames;
    of[MOTE_MEASURED_ERROR_MEDIAN] = mote_statistics_quantile(errors, count, 0.5);
    of[MOTE_MEASURED_ERROR_P95] = mote_statistics_quantile(errors, count, 0.95);
    of[MOTE_MEASURED_ERROR_P99] = mote_statistics_quantile(errors, count, 0.99);
    of[MOTE_MEASURED_CONTACTS] = t.contacts;
    of[MOTE_MEASURED_MISSED] = t.contacts > 0 ? t.missed / t.contacts : MOTE_NONE;
    of[MOTE_MEASURED_FALSE] = t.alone > 0 ? t.wrong / t.alone : MOTE_NONE;
    of[MOTE_MEASURED_QUERY_US] = mote_statistics_median(times, count);
    of[MOTE_MEASURED_SUM_US] = sum;
    of[MOTE_MEASURED_ALLOCATIONS] = t.allocations;
    free(errors);
}

mote_status mote_study_sample(const mote_subject *subject, const char *method, mote_tour tour,
                              size_t count, mote_sample *samples)
{
    mote_status status = MOTE_OK;
    for (size_t s = 0; s < count && status == MOTE_OK; ++s) {
        mote_cell_result result;
        mote_tour one = tour;
        one.seed += s;
        status = mote_study_measure(subject, method, one, &result);
        if (status == MOTE_OK) {
            make_sample(subject, &result, &samples[s]);
            mote_cell_result_free(&result);
        }
    }
    return status;
}

mote_estimate mote_estimate_make(const double *values, size_t count)
{
    const mote_estimate made = {mote_statistics_mean(values, count),
                                mote_statistics_t_interval(values, count)};
    return made;
}

mote_estimate mote_estimate_ratio(const double *values, size_t count)
{
    double logs[MOTE_STUDY_SEEDS];
    for (size_t i = 0; i < count; ++i)
        logs[i] = log(values[i]);
    mote_estimate made = mote_estimate_make(logs, count);
    made.value = exp(made.value);
    made.interval.low = exp(made.interval.low);
    made.interval.high = exp(made.interval.high);
    return made;
}

mote_status mote_estimate_exponent(const double *x, const double *y, size_t sizes, size_t seeds,
                                   mote_estimate *exponent)
{
    double *means = mote_allocate(sizes, sizeof *means);
    for (size_t i = 0; i < sizes; ++i)
        means[i] = mote_estimate_ratio(y + i * seeds, seeds).value;
    const mote_status status =
        mote_statistics_exponent(x, means, sizes, &exponent->value, &exponent->interval);
    free(means);
    return status;
}

static bool is_share(mote_measured which)
{
    return which == MOTE_MEASURED_EXACT || which == MOTE_MEASURED_TRACKED ||
           which == MOTE_MEASURED_MISSED || which == MOTE_MEASURED_FALSE;
}

mote_estimate mote_sample_estimate(const mote_sample *samples, size_t count,
                                   mote_measured which)
{
    double values[MOTE_STUDY_SEEDS];
    for (size_t s = 0; s < count; ++s)
        values[s] = samples[s].of[which];
    mote_estimate made = mote_estimate_make(values, count);
    if (made.interval.low == made.interval.low) {
        made.interval.low = fmax(made.interval.low, 0);
        if (is_share(which))
            made.interval.high = fmin(made.interval.high, 1);
    }
    return made;
}

mote_status mote_study_plot(const mote_study *study, const char *name, mote_text *text)
{
    char *file = mote_format("figures/%s.dat", name);
    mote_status status = mote_record_text(study->directory, file, text);
    if (status == MOTE_OK)
        status = mote_figures_plot(study->directory, name, name);
    free(file);
    return status;
}
