/* Figures of time: queries (3); deform, update and query (8); ratio to the best engine (9). */
#include "harness/base/number_text.h"
#include "harness/figure/figure.h"

#include "harness/base/memory.h"
#include "harness/summary/front.h"

#include <stdlib.h>
#include <string.h>

/* Mean and maximum over the measured frames between two frames. */
typedef struct span {
    double mean, max;
    uint32_t first, last; /* the first and last frame measured; 0, 0: none */
} span;

static span over_frames(const mote_summary_row *row, const double *values, uint32_t first,
                        uint32_t last)
{
    span found = {.mean = 0};
    double count = 0;
    for (size_t k = 0; k < row->first->frames; ++k) {
        const uint32_t frame = row->first->frame[k];
        if (frame < first || frame > last)
            continue;
        found.mean += values[k];
        found.max = values[k] > found.max ? values[k] : found.max;
        found.first = found.first ? found.first : frame;
        found.last = frame;
        ++count;
    }
    found.mean = count > 0 ? found.mean / count : MOTE_NONE;
    return found;
}

/* Appends "active interval 1.2 ms on average, 3 ms at most", and the range of queries if it is
   not all from first to last; nothing if none was measured. */
static void add_span(const span *s, const char *name, uint32_t first, uint32_t last,
                     const char *separator, mote_text *caption)
{
    if (s->last == 0)
        return;
    mote_text_add(caption, "%s %s", separator, name);
    if (s->first > first || s->last < last)
        mote_text_add(caption, " (%u-%u only)", s->first, s->last);
    mote_text_add(caption, " %.3g ms on average, %.3g ms at most", s->mean * 1e-6,
                  s->max * 1e-6);
}

/* The frames averaged in the paper's Figure 3. */
#define WARM_LAST 49u
#define ACTIVE_FIRST 950u
#define ACTIVE_LAST 1984u

static void add_queries(const mote_summary_row *row, mote_figure *figure)
{
    const mote_stored_cell *first = row->first;
    double *values = mote_allocate(first->frames, sizeof *values);
    mote_figure_frames(row, MOTE_FIGURE_TOTAL, values);
    mote_gnuplot_block(&figure->data, row->label);
    for (size_t k = 0; k < first->frames; ++k)
        mote_text_add(&figure->data, "%u %.17g\n", first->frame[k], values[k] * 1e-6);
    const span active = over_frames(row, values, ACTIVE_FIRST, ACTIVE_LAST);
    const span warm = over_frames(row, values, 1, WARM_LAST);
    free(values);
    if (active.last == 0 && warm.last == 0)
        return;
    mote_text_add(&figure->caption, " %s:", row->label);
    add_span(&active, "active interval", ACTIVE_FIRST, ACTIVE_LAST, "", &figure->caption);
    add_span(&warm, "warm-up", 1, WARM_LAST, active.last > 0 ? ";" : "", &figure->caption);
    mote_text_add(&figure->caption, ".");
}

/* The engine of others that is fastest over all frames of a row, if it is none of the rows
   shown already. */
static const mote_summary_row *further_engine(const mote_summary_row *const *shown,
                                              size_t count)
{
    const mote_summary_row *engine = shown[0]->ratio_engine.to;
    for (size_t i = 0; i < count; ++i)
        engine = engine == shown[i] ? NULL : engine;
    return engine;
}

/* Adds "10 processes" or, if rows differ, "10 to 20 processes"; rows may be NULL. */
static void add_processes(const mote_summary_row *const *rows, size_t count, mote_text *caption)
{
    size_t least = SIZE_MAX, most = 0;
    for (size_t i = 0; i < count; ++i) {
        if (!rows[i])
            continue;
        least = rows[i]->finished < least ? rows[i]->finished : least;
        most = rows[i]->finished > most ? rows[i]->finished : most;
    }
    if (least < most)
        mote_text_add(caption, "%zu to ", least);
    mote_text_add(caption, "%zu process%s", most, most == 1 ? "" : "es");
}

mote_status mote_figure_queries(const mote_figure_run *run, const char *scenario,
                                mote_figure *figure)
{
    static const char *const labels[] = {"particle-paper:n=5", "fcl-aabb",
                                         "fcl-aabb:queue=64,seed=previous", "fcl-obbrss"};
    enum { FIXED = sizeof labels / sizeof labels[0], SERIES };
    const mote_summary_row *rows[SERIES] = {NULL};
    for (int i = 0; i < FIXED; ++i) {
        rows[i] = mote_figure_row(run->summary, scenario, labels[i]);
        if (!rows[i])
            mote_text_add(&figure->missing, "%s%s", figure->missing.size ? ", " : "",
                          labels[i]);
    }
    if (figure->missing.size)
        mote_text_add(&figure->missing, " on %s", scenario);
    if (!rows[0])
        return MOTE_OK;
    rows[FIXED] = further_engine(rows, FIXED);
    mote_text_add(
        &figure->caption,
        "The paper's Figure 3: collision detection between two letters W of 11,920 "
        "triangles with 5 particles on each. Time of each query, deformation and refitting "
        "included; the median of ");
    add_processes(rows, SERIES, &figure->caption);
    mote_text_add(
        &figure->caption,
        ". Shaded: the warm-up (queries 1-49) and the active interval (950-1984). The paper "
        "(Pentium 4, 2.53 GHz): active interval 12.67 ms on average, 47 ms at most; warm-up "
        "12.06 ms on average, 47 ms at most.");
    for (int i = 0; i < SERIES; ++i) {
        if (rows[i])
            add_queries(rows[i], figure);
    }
    if (rows[FIXED])
        mote_text_add(&figure->caption, " %s is the fastest engine of others in this run.",
                      rows[FIXED]->label);
    return MOTE_OK;
}

/* One configuration's mean times; each frame's time is the median over replicates. */
typedef struct share {
    const mote_summary_row *row;
    double part[3], total; /* deform, update, query; nanoseconds */
    bool always;           /* shown even if it is slow */
} share;

#define SHARES_MAX 16

static void measure_share(const mote_summary_row *row, share *made)
{
    static const mote_figure_part parts[3] = {MOTE_FIGURE_DEFORM, MOTE_FIGURE_UPDATE,
                                              MOTE_FIGURE_QUERY};
    const size_t frames = row->first->frames;
    double *values = mote_allocate(frames, sizeof *values);
    made->row = row;
    made->total = 0;
    for (int p = 0; p < 3; ++p) {
        mote_figure_frames(row, parts[p], values);
        made->part[p] = mote_statistics_mean(values, frames);
        made->total += made->part[p];
    }
    free(values);
}

static int by_total(const void *a, const void *b)
{
    const share *first = a, *second = b;
    if (first->total < second->total || first->total > second->total)
        return first->total < second->total ? -1 : 1;
    return strcmp(first->row->label, second->row->label);
}

/* The n that represents a method: for the paper's method, the paper's own. */
static double usual_n(const mote_summary_row *row)
{
    return strcmp(row->method, "particle-paper") == 0 ? 5 : 8;
}

/* Ours without further parameters: what the others are compared with. */
static bool is_ours(const char *family)
{
    return strcmp(family, "certified") == 0 || strcmp(family, "particle") == 0 ||
           strcmp(family, "particle-paper") == 0;
}

/* All families, the fastest first; shares has room for every row of the summary. */
static size_t collect_shares(const mote_summary *summary, const char *scenario, share *shares)
{
    size_t count = 0;
    for (size_t i = 0; i < summary->count; ++i) {
        const mote_summary_row *row = &summary->rows[i];
        char family[MOTE_FIGURE_FAMILY];
        mote_front_title(row, family, sizeof family);
        if (!mote_figure_shows(summary, row, scenario) || row->first->frames == 0 ||
            !mote_figure_first(summary, row, scenario))
            continue;
        row = mote_figure_near(summary, scenario, family, usual_n(row));
        measure_share(row, &shares[count]);
        shares[count].always = is_ours(family);
        count += shares[count].total > 0 ? 1 : 0;
    }
    qsort(shares, count, sizeof *shares, by_total);
    size_t fcl = 0;
    while (fcl < count && !mote_summary_is_fcl(shares[fcl].row))
        ++fcl;
    if (fcl < count)
        shares[fcl].always = true;
    return count;
}

/* Keeps those that are always shown and the fastest of the others; returns how many. */
static size_t keep_fastest(share *shares, size_t count)
{
    size_t places = SHARES_MAX, kept = 0;
    for (size_t i = 0; i < count; ++i)
        places -= shares[i].always ? 1 : 0;
    for (size_t i = 0; i < count; ++i) {
        if (!shares[i].always && places == 0)
            continue;
        places -= shares[i].always ? 0 : 1;
        shares[kept++] = shares[i];
    }
    return kept;
}

static void add_share(const share *s, size_t place, mote_text *text)
{
    const double d = s->part[0] / s->total, u = s->part[1] / s->total;
    mote_text_add(text, "%zu %.17g %.17g 1 ", place, d, d + u);
    mote_gnuplot_quote(text, s->row->label);
    char number[MOTE_NUMBER_TEXT];
    if (s->total < 1e6)
        mote_text_add(text, " \"%.3g\"\n", s->total * 1e-3);
    else
        mote_text_add(text, " \"%s\"\n", mote_show_whole(s->total * 1e-3, number));
}

mote_status mote_figure_shares(const mote_figure_run *run, const char *scenario,
                               mote_figure *figure)
{
    share *shares = mote_allocate(run->summary->count, sizeof *shares);
    const size_t count = collect_shares(run->summary, scenario, shares);
    const size_t kept = keep_fastest(shares, count);
    for (size_t i = 0; i < kept; ++i)
        add_share(&shares[i], i + 1, &figure->data);
    free(shares);
    if (count == 0)
        mote_text_add(&figure->missing, "a method that ran on %s", scenario);
    mote_text_add(
        &figure->caption,
        "How the mean time of a frame, given at the right, divides into deforming all "
        "vertices, refitting the bounding volumes, and the query. The time of each frame is "
        "the median over processes. Of configurations that differ only in n, the one nearest "
        "to n = 5 (the paper's method) or n = 8 is shown.");
    if (kept < count)
        mote_text_add(&figure->caption,
                      " Of these %zu, the fastest are shown, and always certified, particle, "
                      "particle-paper and the fastest of FCL; the other %zu are not.",
                      count, count - kept);
    return MOTE_OK;
}

/* The frames are divided into this many parts, each with a ratio and its interval. */
#define PARTS 48

/* The median over frames first .. last of ln(other's total / ours), within one replicate;
   MOTE_NONE without a common frame. */
static double log_ratio(const mote_stored_cell *ours, const mote_stored_cell *other,
                        double first, double last, double *work)
{
    size_t count = 0;
    for (size_t i = 0, k = 0; mote_stored_common(ours, &i, other, &k); ++i, ++k) {
        if (ours->frame[i] >= first && ours->frame[i] < last && ours->total_ns[i] > 0 &&
            other->total_ns[k] > 0)
            work[count++] = log(other->total_ns[k] / ours->total_ns[i]);
    }
    return count ? mote_statistics_median(work, count) : MOTE_NONE;
}

/* Adds one part's line, middle frame, ratio and its interval over replicates, which one pair of
   processes does not have. Returns the number of pairs. values holds a number per replicate. */
static size_t add_ratio(const mote_summary_row *row, const mote_summary_row *other,
                        double first, double last, double *values, double *work,
                        mote_text *text)
{
    size_t count = 0;
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *ours = &row->cells[r];
        const mote_stored_cell *theirs = mote_summary_replicate(other, ours->replicate);
        const double value = theirs ? log_ratio(ours, theirs, first, last, work) : MOTE_NONE;
        if (value == value)
            values[count++] = value;
    }
    if (count == 0)
        return 0;
    const mote_confidence interval = mote_statistics_t_interval(values, count);
    mote_text_add(text, "%.17g %.17g ", (first + last - 1) / 2,
                  exp(mote_statistics_mean(values, count)));
    if (count < 2)
        mote_text_add(text, "nan nan\n");
    else
        mote_text_add(text, "%.17g %.17g\n", exp(interval.low), exp(interval.high));
    return count;
}

/* Adds a block of parts; none if no process has a frame in common with its partner. Returns the
   least number of pairs of processes that a part has; SIZE_MAX without a part. */
static size_t add_ratios(const mote_summary_row *row, const mote_summary_row *other,
                         mote_text *text)
{
    const mote_stored_cell *cell = row->first;
    size_t longest = 0, least = SIZE_MAX;
    for (size_t r = 0; r < row->replicates; ++r)
        longest = row->cells[r].frames > longest ? row->cells[r].frames : longest;
    double *values = mote_allocate(row->replicates + longest, sizeof *values);
    double *work = values + row->replicates;
    mote_text lines = {0};
    const double from = cell->frame[0];
    const double width = (cell->frame[cell->frames - 1] + 1 - from) / PARTS;
    for (int p = 0; p < PARTS; ++p) {
        const size_t pairs = add_ratio(row, other, from + p * width, from + (p + 1) * width,
                                       values, work, &lines);
        least = pairs > 0 && pairs < least ? pairs : least;
    }
    if (lines.size > 0) {
        mote_gnuplot_block(text, row->label);
        mote_text_add(text, "%s", lines.data);
    }
    free(lines.data);
    free(values);
    return least;
}

/* What a row is compared with: the fastest engine of others without a wrong answer, else the
   fastest FCL. */
static const mote_summary_row *rival_of(const mote_summary_row *row)
{
    return row->ratio_engine.to ? row->ratio_engine.to : row->ratio_best.to;
}

/* Adds the caption, and the best FCL as a series if it is not the best engine; returns the
   least number of pairs, as above. */
static size_t add_rivals(const mote_summary_row *row, const char *scenario, mote_figure *figure)
{
    const mote_summary_row *rival = rival_of(row), *fcl = row->ratio_best.to;
    mote_text_add(
        &figure->caption,
        "How many times as fast as %s, the fastest %s in this run on %s%s: medians "
        "over at most %d parts of consecutive frames, of ratios paired frame by frame "
        "within each process, with 95 %% intervals over processes. Below the dashed "
        "line that engine is faster.",
        rival->label,
        rival == row->ratio_engine.to ? "engine of others" : "configuration of FCL", scenario,
        strcmp(row->ask, "contact") == 0 ? ", asked for contacts" : "", PARTS);
    if (!fcl || fcl == rival)
        return SIZE_MAX;
    mote_text_add(&figure->caption, " The fastest configuration of FCL, %s, is shown too.",
                  fcl->label);
    return add_ratios(fcl, rival, &figure->data);
}

mote_status mote_figure_ratios(const mote_figure_run *run, const char *scenario,
                               mote_figure *figure)
{
    static const struct {
        const char *family;
        double n;
    } series[] = {{"particle-paper:refine=no", 5}, {"particle", 8}, {"certified", 0}};
    size_t least = SIZE_MAX;
    const mote_summary_row *first = NULL;
    for (size_t i = 0; i < sizeof series / sizeof series[0]; ++i) {
        const mote_summary_row *row =
            mote_figure_near(run->summary, scenario, series[i].family, series[i].n);
        if (!row || !rival_of(row) || row->first->frames == 0)
            continue;
        if (!first)
            first = row;
        const size_t pairs = add_ratios(row, rival_of(row), &figure->data);
        least = pairs < least ? pairs : least;
    }
    if (first) {
        const size_t pairs = add_rivals(first, scenario, figure);
        least = pairs < least ? pairs : least;
    }
    if (figure->data.size == 0)
        mote_text_add(&figure->missing,
                      "a method of ours and one of others on the same frames of %s", scenario);
    else if (least < 2)
        mote_text_add(&figure->missing,
                      "intervals on %s, for which two replicates of both methods are needed",
                      scenario);
    return MOTE_OK;
}
