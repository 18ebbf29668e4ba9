/* mote summarize DIR: computes the rows of a run from its cells again. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/summary/front.h"
#include "harness/base/record.h"
#include "harness/command/kept.h"
#include "harness/summary/screen.h"
#include "harness/summary/summary_json.h"
#include "harness/summary/table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const formats[] = {"table", "json", "csv", "gbench", "gha", "bencher"};
enum { FORMAT_TABLE, FORMAT_JSON, FORMAT_CSV, FORMAT_GBENCH, FORMAT_GHA, FORMAT_BENCHER };
#define FORMAT_COUNT (sizeof formats / sizeof formats[0])

static int print_json(json_t *object)
{
    if (mote_json_put(object, MOTE_JSON_FLAGS, stdout) != MOTE_OK)
        return mote_command_fail();
    return mote_command_finish(MOTE_EXIT_DONE);
}

static void print_fronts(const mote_summary *summary)
{
    mote_fronts fronts = mote_fronts_make(summary);
    mote_fronts_print(&fronts, stdout);
    mote_fronts_free(&fronts);
}

static int print_gbench(const mote_summary *summary, const char *directory)
{
    json_t *manifest = NULL;
    (void)mote_record_read_json(directory, "manifest.json", &manifest);
    int code = print_json(mote_gbench_json(summary, manifest));
    json_decref(manifest);
    return code;
}

static int print_csv(const mote_summary *summary)
{
    mote_text text = {0};
    mote_table_csv(summary, &text);
    (void)fputs(text.data, stdout);
    free(text.data);
    return mote_command_finish(MOTE_EXIT_DONE);
}

/* The simulations of a directory without cells. */
static int print_simulations(const mote_simulations *simulations, size_t format)
{
    if (format == FORMAT_JSON)
        return print_json(mote_simulations_json(simulations));
    if (format != FORMAT_TABLE)
        return mote_command_usage("summarize",
                                  "--format %s is for runs; of simulations there are table and "
                                  "json",
                                  formats[format]);
    mote_simulations_print(simulations, stdout);
    return mote_command_finish(MOTE_EXIT_DONE);
}

static int print(const mote_kept *kept, const char *directory, size_t format)
{
    const mote_summary *summary = &kept->summary;
    if (!kept->has_summary)
        return print_simulations(&kept->simulations, format);
    switch (format) {
    case FORMAT_JSON:
        return print_json(mote_summary_json(summary));
    case FORMAT_GBENCH:
        return print_gbench(summary, directory);
    case FORMAT_GHA:
        return print_json(mote_gha_json(summary));
    case FORMAT_BENCHER:
        return print_json(mote_bencher_json(summary));
    case FORMAT_CSV:
        return print_csv(summary);
    default:
        mote_kept_print(kept, stdout);
        print_fronts(summary);
        break;
    }
    return mote_command_finish(MOTE_EXIT_DONE);
}

static size_t find_format(const char *name)
{
    size_t format = 0;
    while (format < FORMAT_COUNT && strcmp(formats[format], name) != 0)
        ++format;
    return format;
}

const mote_option mote_options_summarize[] = {
    {"format", "table|json|csv|gbench|gha|bencher", "how to print the rows (default: table)"},
    {"best", NULL,
     "only the best rows, sorted by time, in at most 100 columns (default: all, in a wide "
     "table)"},
    {"engines", NULL,
     "every row with its mean, 95th percentile and worst frame, and which engine of other "
     "projects is best by each (default: all columns, in a wide table)"},
    {NULL, NULL, NULL}};
enum { OPTION_FORMAT, OPTION_BEST, OPTION_ENGINES };

typedef struct request {
    const char *directory;
    size_t format;
    const char *screen; /* "--best" or "--engines"; NULL: a format */
} request;

/* MOTE_EXIT_DONE, or MOTE_EXIT_USAGE after a line on stderr. */
static int read_arguments(int argc, char **argv, request *q)
{
    mote_option_reader reader = mote_option_begin(mote_options_summarize, argc, argv);
    const char *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN && q->directory)
            return mote_command_usage(argv[0], "%s: one directory at a time", value);
        if (option == MOTE_OPTION_PLAIN)
            q->directory = value;
        else if (option == OPTION_BEST || option == OPTION_ENGINES)
            q->screen = option == OPTION_BEST ? "--best" : "--engines";
        else if ((q->format = find_format(value)) == FORMAT_COUNT)
            return mote_command_usage(argv[0], "--format %s: choose %s", value,
                                      mote_options_summarize[OPTION_FORMAT].value);
    }
    if (!q->directory)
        return mote_command_usage(argv[0],
                                  "no directory; write `mote summarize results/paper`");
    if (q->screen && q->format != FORMAT_TABLE)
        return mote_command_usage(argv[0], "%s is for --format table; leave out one of them",
                                  q->screen);
    return MOTE_EXIT_DONE;
}

int mote_command_summarize(int argc, char **argv)
{
    request q = {.format = FORMAT_TABLE};
    const int understood = read_arguments(argc, argv, &q);
    if (understood != MOTE_EXIT_DONE)
        return understood;
    mote_kept kept;
    if (mote_kept_read(q.directory, &kept) != MOTE_OK)
        return mote_command_fail();
    /* Rows are printed even if the directory cannot be written to. */
    int code;
    if (q.screen && kept.has_summary) {
        const bool best = strcmp(q.screen, "--best") == 0;
        (best ? mote_screen_print : mote_screen_engines)(&kept.summary, stdout);
        code = mote_command_finish(MOTE_EXIT_DONE);
    } else {
        code = print(&kept, q.directory, q.format);
    }
    if (code == MOTE_EXIT_DONE && kept.has_summary &&
        mote_summary_write(&kept.summary, q.directory) != MOTE_OK)
        code = mote_command_fail();
    mote_kept_free(&kept);
    return code;
}
