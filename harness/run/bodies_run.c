#include "harness/run/bodies_run.h"

#include "harness/process/manifest.h"
#include "harness/base/record.h"

#include <stdlib.h>
#include <string.h>

/* How good a choice is as a reference; the lowest is the best, UINT32_MAX: none. */
static uint32_t reference_rank(const mote_bodies_choice *choice)
{
    static const char *const names[] = {"fcl-aabb", "aabb-tree", "certified"};
    for (uint32_t i = 0; i < 3; ++i) {
        if (strcmp(choice->method.method->name, names[i]) == 0)
            return 2 * i + (choice->refit == MOTE_REFIT_EVERY ? 0 : 1);
    }
    return UINT32_MAX;
}

static size_t best_reference(const mote_bodies_choice *choices, size_t choice_count,
                             const mote_bodies_row *rows, size_t count)
{
    size_t best = count;
    uint32_t rank = UINT32_MAX;
    for (size_t k = 0; k < count; ++k) {
        const uint32_t here = reference_rank(&choices[k % choice_count]);
        if (rows[k].ok && here < rank) {
            rank = here;
            best = k;
        }
    }
    return best;
}

static void tell(const mote_bodies_row *row)
{
    if (row->ok)
        (void)fprintf(stderr, "%s %s r%u: %zu steps, %.6g us each\n", row->scenario,
                      row->method, row->replicate, row->steps, row->step_mean_ns / 1e3);
    else
        (void)fprintf(stderr, "%s %s r%u: %s: %s\n", row->scenario, row->method, row->replicate,
                      mote_cell_status_names[row->status], row->reason);
}

mote_status mote_bodies_run_scenario(const mote_bodies *bodies,
                                     const mote_bodies_choice *choices, size_t choice_count,
                                     uint32_t replicates, const mote_bodies_options *options,
                                     mote_bodies_row *rows)
{
    const size_t count = choice_count * replicates;
    mote_bodies_result *results = calloc(count, sizeof *results);
    if (!results)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu cells", count);
    mote_status status = MOTE_OK;
    for (size_t k = 0; k < count; ++k) {
        mote_bodies_options own = *options;
        own.replicate = (uint32_t)(k / choice_count) + 1;
        status = mote_bodies_measure(bodies, &choices[k % choice_count], &own, &results[k]);
        if (status != MOTE_OK)
            break;
        mote_bodies_row_make(bodies, &choices[k % choice_count], own.replicate, &results[k],
                             &rows[k]);
        tell(&rows[k]);
    }
    if (status == MOTE_OK) {
        const size_t best = best_reference(choices, choice_count, rows, count);
        for (size_t k = 0; k < count && best < count; ++k)
            mote_bodies_row_compare(&rows[k], &results[k], &rows[best], &results[best]);
    }
    for (size_t k = 0; k < count; ++k)
        mote_bodies_result_free(&results[k]);
    free(results);
    return status;
}

static mote_status read_choices(const mote_bodies_run_options *options,
                                mote_bodies_choice *choices, size_t *count)
{
    static const char *const forms[] = {"certified",    "fcl-aabb:refit=every",
                                        "fcl-aabb",     "aabb-tree",
                                        "particle:n=8", "particle-paper:n=5"};
    const bool all = options->method_count == 0;
    const char *const *texts = all ? forms : options->methods;
    *count = all ? sizeof forms / sizeof forms[0] : options->method_count;
    for (size_t i = 0; i < *count; ++i) {
        mote_status status = mote_bodies_choice_read(texts[i], &choices[i]);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

static mote_status begin(const mote_bodies_run_options *options)
{
    uint64_t program = 0;
    mote_status status = mote_directory_make(options->directory);
    if (status == MOTE_OK)
        status = mote_program_hash(&program);
    if (status == MOTE_OK)
        status =
            mote_manifest_write(options->directory, program, 1, options->argc, options->argv);
    return status;
}

/* Scenario i by all choices, or only the plan. */
static mote_status run_one(const mote_bodies_run_options *options, size_t i,
                           const mote_bodies_choice *choices, size_t count,
                           mote_bodies_row *rows)
{
    mote_bodies *bodies;
    mote_status status = mote_bodies_load(options->scenarios[i], &bodies);
    if (status != MOTE_OK)
        return status;
    if (options->measure.last > bodies->frames)
        status = mote_fail(MOTE_EINVAL, "--frames %u-%u: outside %s, which has 1-%u",
                           options->measure.first, options->measure.last, bodies->name,
                           bodies->frames);
    for (size_t k = 0; status == MOTE_OK && options->dry_run && k < count; ++k)
        (void)fprintf(stderr, "%s: %u bodies of %u shapes, %s, %u times\n", bodies->name,
                      bodies->count, bodies->shape_count, choices[k].text, options->replicates);
    if (status == MOTE_OK && !options->dry_run) {
        mote_bodies_options measure = options->measure;
        measure.directory = options->directory;
        status = mote_bodies_run_scenario(bodies, choices, count, options->replicates, &measure,
                                          rows);
    }
    mote_bodies_destroy(bodies);
    return status;
}

mote_status mote_bodies_run(const mote_bodies_run_options *options, size_t *failed)
{
    size_t count = 0;
    const size_t most = options->method_count > 8 ? options->method_count : 8;
    mote_bodies_choice *choices = calloc(most, sizeof *choices);
    mote_bodies_row *rows =
        calloc(most * options->replicates * options->scenario_count, sizeof *rows);
    mote_status status = choices && rows ? read_choices(options, choices, &count)
                                         : mote_fail(MOTE_ENOMEM, "no memory for a run");
    if (status == MOTE_OK && !options->dry_run)
        status = begin(options);
    const size_t each = count * options->replicates;
    for (size_t i = 0; i < options->scenario_count && status == MOTE_OK; ++i)
        status = run_one(options, i, choices, count, rows + i * each);
    *failed = 0;
    if (status == MOTE_OK && !options->dry_run) {
        const size_t all = each * options->scenario_count;
        for (size_t k = 0; k < all; ++k)
            *failed += !rows[k].ok && rows[k].status != MOTE_CELL_UNSUPPORTED;
        mote_bodies_rows_print(rows, all, stdout);
        status = mote_record_json(options->directory, "bodies.json",
                                  mote_bodies_rows_json(rows, all));
    }
    free(choices);
    free(rows);
    return status;
}
