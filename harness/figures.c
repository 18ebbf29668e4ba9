#include "harness/figures.h"

#include "harness/data.h"
#include "harness/front.h"
#include "harness/record.h"
#include "harness/spawn.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Writes what a figure is drawn from; nothing when the run has no such rows. */
typedef mote_status (*figure_data)(const mote_summary *summary, const char *scenario,
                                   mote_text *text);

/* Drawn by plots/NAME.gp from figures/NAME.dat, or, with scenario NULL, from
   figures/NAME-SCENARIO.dat for every scenario of the run. */
typedef struct figure {
    const char *name, *scenario;
    figure_data write;
} figure;

static const mote_summary_row *find_row(const mote_summary *summary, const char *scenario,
                                        const char *label)
{
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        if (row->status == MOTE_CELL_OK && row->jobs == 1 &&
            strcmp(row->first->scenario, scenario) == 0 &&
            strcmp(row->first->cache, mote_cache_names[MOTE_CACHE_HOT]) == 0 &&
            strcmp(row->label, label) == 0)
            return row;
    }
    return NULL;
}

/* The median over replicates of each frame's total: a block of "frame milliseconds" below a
   title. */
static mote_status add_frames(const mote_summary_row *row, const char *title, mote_text *text)
{
    double *work = malloc((row->replicates + 1) * sizeof *work);
    if (!work)
        return mote_fail(MOTE_ENOMEM, "no memory for a figure");
    mote_text_add(text, "%s\"%s\"\n", text->size ? "\n\n" : "", title);
    for (size_t k = 0; k < row->first->frames; ++k) {
        size_t count = 0;
        for (size_t r = 0; r < row->replicates; ++r) {
            const mote_stored_cell *cell = &row->cells[r];
            if (k < cell->frames && cell->frame[k] == row->first->frame[k])
                work[count++] = cell->total_ns[k];
        }
        mote_text_add(text, "%u %.17g\n", row->first->frame[k],
                      mote_statistics_median(work, count) * 1e-6);
    }
    free(work);
    return MOTE_OK;
}

/* Figure 3 of the paper: query time against query number. */
static mote_status write_fig3(const mote_summary *summary, const char *scenario,
                              mote_text *text)
{
    static const struct {
        const char *label, *title;
    } series[] = {
        {"particle-paper:n=5", "particles, n = 5"},
        {"fcl-aabb", "FCL AABB"},
        {"fcl-aabb:queue=64,seed=previous", "FCL AABB, queue 64, seeded"},
        {"fcl-obbrss", "FCL OBBRSS, every 16th query"},
    };
    mote_status status = MOTE_OK;
    if (!find_row(summary, scenario, series[0].label))
        return MOTE_OK;
    for (size_t i = 0; i < sizeof series / sizeof series[0] && status == MOTE_OK; ++i) {
        const mote_summary_row *row = find_row(summary, scenario, series[i].label);
        if (row)
            status = add_frames(row, series[i].title, text);
    }
    return status;
}

static bool first_of_scenario(const mote_summary *summary, size_t index)
{
    for (size_t i = 0; i < index; ++i) {
        if (strcmp(summary->rows[i].first->scenario, summary->rows[index].first->scenario) == 0)
            return false;
    }
    return true;
}

/* Whether a row is a point of the scenario's front: hot caches, comparable times, answers with
   a distance. */
static bool on_front(const mote_summary_row *row, const char *scenario)
{
    return row->status == MOTE_CELL_OK && row->jobs == 1 && row->error.p99 == row->error.p99 &&
           strcmp(row->first->scenario, scenario) == 0 &&
           strcmp(row->first->cache, mote_cache_names[MOTE_CACHE_HOT]) == 0;
}

static void add_point(const mote_summary_row *row, mote_text *text)
{
    const mote_time *time = &row->total;
    bool interval = time->low == time->low;
    if (row->n == row->n)
        mote_text_add(text, "%.0f ", row->n);
    else
        mote_text_add(text, "\"\" ");
    mote_text_add(text, "%.17g %.17g %.17g %.17g %.17g %.17g\n", time->median * 1e-3,
                  (interval ? time->low : time->median) * 1e-3,
                  (interval ? time->high : time->median) * 1e-3, row->error.p99,
                  row->error.median, row->missed);
}

/* The rows from first on that have this title, which is in no row before. */
static void add_block(const mote_summary *summary, const char *scenario, size_t first,
                      const char *title, mote_text *text)
{
    mote_text_add(text, "%s\"%s\"\n", text->size ? "\n\n" : "", title);
    for (size_t i = first; i < summary->count; ++i) {
        char other[256];
        mote_front_title(&summary->rows[i], other, sizeof other);
        if (on_front(&summary->rows[i], scenario) && strcmp(title, other) == 0)
            add_point(&summary->rows[i], text);
    }
}

/* Whether a row before this one has the same title. */
static bool in_earlier_block(const mote_summary *summary, const char *scenario, size_t index,
                             const char *title)
{
    for (size_t i = 0; i < index; ++i) {
        char other[256];
        mote_front_title(&summary->rows[i], other, sizeof other);
        if (on_front(&summary->rows[i], scenario) && strcmp(title, other) == 0)
            return true;
    }
    return false;
}

/* Time against error, every configuration a point: what a particle more costs and gives. A
   block of "n median low high error-p99 error-median missed", times in microseconds, below a
   title, for the configurations that differ in n only. */
static mote_status write_front(const mote_summary *summary, const char *scenario,
                               mote_text *text)
{
    for (size_t i = 0; i < summary->count; ++i) {
        char title[256];
        mote_front_title(&summary->rows[i], title, sizeof title);
        if (on_front(&summary->rows[i], scenario) &&
            !in_earlier_block(summary, scenario, i, title))
            add_block(summary, scenario, i, title, text);
    }
    return MOTE_OK;
}

static const figure figures[] = {
    {"fig3", "ww", write_fig3},
    {"front", NULL, write_front},
};

mote_status mote_figures_plot(const char *directory, const char *name, const char *script_name)
{
    char *plots = mote_format("%s/plots", mote_data_directory());
    char *script = mote_format("%s/plots/%s.gp", mote_data_directory(), script_name);
    char *base = mote_format("%s/figures/%s", directory, name);
    mote_status status = MOTE_OK;
    if (plots && script && base) {
        const char *const argv[] = {"gnuplot", "-c", script, plots, base, NULL};
        status = mote_spawn(argv, NULL, NULL, 0);
    } else {
        status = mote_fail(MOTE_ENOMEM, "no memory for a figure's name");
    }
    free(plots);
    free(script);
    free(base);
    return status;
}

static mote_status draw(const figure *f, const mote_summary *summary, const char *scenario,
                        const char *directory)
{
    mote_text text = {0};
    mote_status status = f->write(summary, scenario, &text);
    char *name =
        f->scenario ? mote_format("%s", f->name) : mote_format("%s-%s", f->name, scenario);
    char *file = name ? mote_format("figures/%s.dat", name) : NULL;
    if (status == MOTE_OK && !file)
        status = mote_fail(MOTE_ENOMEM, "no memory for a figure's name");
    if (status == MOTE_OK && text.size > 0) {
        status = mote_record_text(directory, file, &text);
        if (status == MOTE_OK)
            status = mote_figures_plot(directory, name, f->name);
        if (status == MOTE_OK)
            (void)printf("%s/figures/%s.svg\n%s/figures/%s.png\n", directory, name, directory,
                         name);
    }
    free(text.data);
    free(file);
    free(name);
    return status;
}

mote_status mote_figures_draw(const mote_summary *summary, const char *directory)
{
    char *folder = mote_format("%s/figures", directory);
    mote_status status =
        folder ? mote_directory_make(folder) : mote_fail(MOTE_ENOMEM, "no memory for a name");
    free(folder);
    for (size_t k = 0; k < sizeof figures / sizeof figures[0]; ++k) {
        for (size_t i = 0; i < summary->count && status == MOTE_OK; ++i) {
            const char *scenario = summary->rows[i].first->scenario;
            bool wanted = !figures[k].scenario || strcmp(figures[k].scenario, scenario) == 0;
            if (wanted && first_of_scenario(summary, i))
                status = draw(&figures[k], summary, scenario, directory);
        }
    }
    return status;
}
