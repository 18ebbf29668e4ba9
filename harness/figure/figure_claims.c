/* Figures of studies: the numerical extremes (10), the claims table (11). */
#include "harness/figure/figure.h"

#include "harness/base/record.h"

#include <stdlib.h>
#include <string.h>

/* Characters per line of a claim's text, which has its verdict beside it, and per line of the
   measured values. */
#define CLAIM_WIDTH 52
#define FIGURE_WIDTH 84
#define LINES_MAX 6

/* Breaks text at blanks into lines of at most width bytes; returns how many. */
static size_t wrap(const char *text, size_t width, char lines[LINES_MAX][128])
{
    size_t count = 0;
    while (*text && count < LINES_MAX) {
        size_t length = strlen(text), end = length;
        if (length > width) {
            for (end = width; end > 0 && text[end] != ' '; --end) {
            }
            end = end > 0 ? end : width;
        }
        (void)snprintf(lines[count++], 128, "%.*s", (int)end, text);
        text += end + strspn(text + end, " ");
    }
    return count;
}

/* "0.063 [0.062, 0.065] L" */
static void measured_text(const json_t *claim, char *text, size_t size)
{
    const json_t *value = json_object_get(claim, "value");
    const json_t *low = json_array_get(json_object_get(claim, "interval"), 0);
    const json_t *high = json_array_get(json_object_get(claim, "interval"), 1);
    const char *unit = mote_text_at(claim, "unit");
    if (!json_is_number(value))
        (void)snprintf(text, size, "not measured");
    else if (json_is_number(low) && json_is_number(high))
        (void)snprintf(text, size, "%.3g [%.3g, %.3g] %s", json_number_value(value),
                       json_number_value(low), json_number_value(high), unit);
    else
        (void)snprintf(text, size, "%.3g %s", json_number_value(value), unit);
}

/* 2 holds, 1 within limits, 0 does not hold. */
static int verdict_rank(const char *verdict)
{
    if (strcmp(verdict, "holds") == 0)
        return 2;
    return strcmp(verdict, "holds within limits") == 0 ? 1 : 0;
}

static void add_lines(mote_text *data, int column, size_t top, char lines[LINES_MAX][128],
                      size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        mote_text_add(data, "%d %zu ", column, top + i);
        mote_gnuplot_quote(data, lines[i]);
        mote_text_add(data, "\n");
    }
}

/* Adds one claim from line top on, as "column line text" rows; returns its number of lines. A
   one-letter id fits before it; a longer one is in its text. */
static size_t add_claim(const json_t *claim, size_t top, mote_text *data)
{
    char lines[LINES_MAX][128], text[512], value[128], measured[256];
    const json_t *first = json_array_get(json_object_get(claim, "values"), 0);
    const char *id = mote_text_at(claim, "id");
    const bool letter = strlen(id) <= 1;
    (void)snprintf(lines[0], sizeof lines[0], "%s", id);
    add_lines(data, 0, top, lines, letter ? 1 : 0);
    (void)snprintf(text, sizeof text, "%s%s%s", letter ? "" : id, letter ? "" : ": ",
                   mote_text_at(claim, "claim"));
    const size_t claimed = wrap(text, CLAIM_WIDTH, lines);
    add_lines(data, 1, top, lines, claimed);
    measured_text(claim, value, sizeof value);
    (void)snprintf(measured, sizeof measured, "%s: %s", mote_text_at(first, "name"), value);
    const size_t told = wrap(measured, FIGURE_WIDTH, lines);
    add_lines(data, 2, top + claimed, lines, told);
    return claimed + told;
}

/* The short form for the table, which has little room. */
static const char *short_verdict(const char *verdict)
{
    return strcmp(verdict, "holds within limits") == 0 ? "within limits" : verdict;
}

mote_status mote_figure_claims(const mote_figure_run *run, const char *scenario,
                               mote_figure *figure)
{
    (void)scenario;
    const size_t count = json_array_size(run->claims);
    if (count == 0) {
        mote_text_add(&figure->missing, "claims.json; `make claims OUT=%s` measures it",
                      run->directory);
        return MOTE_OK;
    }
    mote_text verdicts = {0};
    mote_gnuplot_block(&figure->data, "text");
    mote_gnuplot_block(&verdicts, "verdicts");
    size_t top = 0;
    for (size_t i = 0; i < count; ++i) {
        const json_t *claim = json_array_get(run->claims, i);
        const char *verdict = mote_text_at(claim, "verdict");
        const size_t lines = add_claim(claim, top, &figure->data);
        mote_text_add(&verdicts, "%zu %zu %d ", top, lines, verdict_rank(verdict));
        mote_gnuplot_quote(&verdicts, short_verdict(verdict));
        mote_text_add(&verdicts, "\n");
        top += lines + 1;
    }
    mote_text_add(&figure->data, "\n\n%s", verdicts.data ? verdicts.data : "");
    free(verdicts.data);
    mote_text_add(&figure->caption,
                  "For each claim its first value with its 95 %% interval, and the verdict, "
                  "which follows from all of its values and their thresholds (claims.json).");
    return MOTE_OK;
}

mote_status mote_figure_extremes(const mote_figure_run *run, const char *scenario,
                                 mote_figure *figure)
{
    (void)scenario;
    char *path = mote_format("%s/figures/extremes.dat", run->directory);
    char *text = NULL;
    size_t size = 0;
    mote_status status = MOTE_OK;
    if (!mote_record_exists(run->directory, "figures/extremes.dat")) {
        mote_text_add(&figure->missing,
                      "figures/extremes.dat; `make extremes OUT=%s` measures it",
                      run->directory);
    } else {
        status = mote_file_read(path, (size_t)1 << 26, &text, &size);
        if (status == MOTE_OK)
            mote_text_add(&figure->data, "%s", text);
        mote_text_add(&figure->caption,
                      "Each row is a method and each column a case, coloured by the verdict. "
                      "Cases of one family are side by side.");
    }
    free(text);
    free(path);
    return status;
}
