#include "harness/race/race_print.h"

#include "harness/base/clock.h"
#include "harness/base/record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *verdict_of(const mote_race *race)
{
    return race->worse ? "worse" : race->undecided ? "undecided" : "same-or-better";
}

static void print_row(const mote_race_options *options, const mote_race_row *row, int width,
                      FILE *out)
{
    const char *separator = row->what && row->what[0] ? ": " : "";
    const char *units = mote_race_build_pairs(options) > 1 ? "builds" : "pairs";
    (void)fprintf(out, "%-*s ", width, row->name);
    if (row->state != MOTE_RACE_MEASURED)
        (void)fprintf(out, "%-45s ", mote_race_state_names[row->state]);
    else if (isfinite(row->interval.low))
        (void)fprintf(out, "%6.3f [%5.3f, %5.3f] %-9s %2zu %s %5.2f %% ", row->ratio,
                      row->interval.low, row->interval.high, mote_verdict_names[row->verdict],
                      row->units, units, 100 * row->spread);
    else
        (void)fprintf(out, "%6.3f %-24s %2zu %s %9s", row->ratio, "no interval undecided",
                      row->units, units, "");
    (void)fprintf(out, " %s%s%s\n", mote_race_is_worse(options, row) ? "WORSE" : "", separator,
                  row->what ? row->what : "");
}

static void print_header(const mote_race_options *options, FILE *out)
{
    const size_t builds = mote_race_build_pairs(options);
    if (builds > 1)
        (void)fprintf(out, "time B / A over %zu pairs of builds", builds);
    else
        (void)fprintf(out, "time B / A of these programs, with the layouts that they have");
    (void)fprintf(
        out,
        "; all intervals hold together with %.3g %%; a change counts from %.3g %% on; "
        "then pairs of %s, and how far these differ\n",
        100 * (1 - MOTE_RACE_ALPHA), 100 * options->real, builds > 1 ? "builds" : "processes");
}

/* What may decide a race that is undecided: where an interval is too wide, and nowhere else. */
static const char *advice(const mote_race *race)
{
    const char *says = "";
    for (size_t i = 0; i < race->count; ++i) {
        const mote_race_row *row = &race->rows[i];
        if (row->state != MOTE_RACE_MEASURED || row->verdict != MOTE_VERDICT_UNDECIDED)
            continue;
        if (row->looks < MOTE_RACE_LOOKS)
            return ": more time (--budget) may decide";
        says = ": a quieter machine, or more builds of both sides, may decide";
    }
    return says;
}

void mote_race_print(const mote_race_options *options, const mote_race *race, FILE *out)
{
    int width = 4;
    for (size_t i = 0; i < race->count; ++i) {
        const int length = (int)strlen(race->rows[i].name);
        width = length > width ? length : width;
    }
    print_header(options, out);
    for (size_t i = 0; i < race->count; ++i)
        print_row(options, &race->rows[i], width, out);
    (void)fprintf(out, "%s%s after %zu pairs of processes and %.0f s\n",
                  race->worse       ? "worse"
                  : race->undecided ? "undecided"
                                    : "same or better",
                  !race->worse && race->undecided ? advice(race) : "", race->pairs,
                  race->seconds);
}

static json_t *counts_json(const mote_race_row *row)
{
    json_t *counts = json_object();
    for (size_t k = 0; k < row->count_count; ++k)
        (void)json_object_set_new(
            counts, row->counts[k].name,
            json_pack("[f, f]", row->counts[k].sum[0], row->counts[k].sum[1]));
    return counts;
}

static json_t *row_json(const mote_race_options *options, const mote_race_row *row)
{
    char *asked = mote_race_asked(row);
    json_t *object = json_pack(
        "{s:s, s:s, s:s, s:s, s:s, s:i, s:s, s:o, s:o, s:o, s:s, s:b, s:i, s:i, s:i, s:I, s:f, "
        "s:o, "
        "s:[o, o], s:o, s:[o, o], s:o, s:s}",
        "name", row->name, "asked", asked, "scenario", row->cell->scenario, "method",
        row->cell->method, "cache", mote_cache_names[row->cell->cache], "frames",
        (int)row->frames, "status", mote_race_state_names[row->state], "ratio",
        mote_json_number(row->ratio), "ci_low", mote_json_number(row->interval.low), "ci_high",
        mote_json_number(row->interval.high), "verdict", mote_verdict_names[row->verdict],
        "worse", mote_race_is_worse(options, row), "pairs", (int)row->pairs, "units",
        (int)row->units, "looks", (int)row->looks, "blocks", (json_int_t)row->blocks, "seconds",
        row->seconds, "spread", mote_json_number(row->spread), "total_ns",
        mote_json_number(row->total_ns[0]), mote_json_number(row->total_ns[1]), "counts",
        counts_json(row), "instructions", mote_json_number(row->instructions[0]),
        mote_json_number(row->instructions[1]), "answers_apart", mote_json_number(row->worst),
        "what", row->what ? row->what : "");
    free(asked);
    return object;
}

json_t *mote_race_json(const mote_race_options *options, const mote_race *race,
                       const char *const labels[2])
{
    char date[MOTE_CLOCK_DATE];
    mote_clock_date(date);
    json_t *rows = json_array();
    for (size_t i = 0; i < race->count; ++i)
        (void)json_array_append_new(rows, row_json(options, &race->rows[i]));
    return json_pack(
        "{s:i, s:s, s:s, s:s, s:[i, i], s:s, s:f, s:f, s:f, s:i, s:f, s:o}", "schema", 1,
        "date", date, "a", labels[0] ? labels[0] : options->builds[0]->path[0], "b",
        labels[1] ? labels[1] : options->builds[1]->path[0], "builds",
        (int)options->builds[0]->count, (int)options->builds[1]->count, "verdict",
        verdict_of(race), "alpha", MOTE_RACE_ALPHA, "until", options->until, "real",
        options->real, "pairs", (int)race->pairs, "seconds", race->seconds, "rows", rows);
}
