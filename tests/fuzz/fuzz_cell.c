/* Any text as the two files of a cell: the JSON before a line of "====", the CSV after it. The
   cell's run is summarised in all formats. */
#include "harness/summary/front.h"
#include "harness/summary/summary_json.h"
#include "harness/summary/table.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>

static void print(const mote_summary *summary)
{
    static FILE *nowhere;
    if (!nowhere && !(nowhere = fopen("/dev/null", "w")))
        abort();
    mote_table_print(summary, nowhere);
    mote_text csv = {0};
    mote_table_csv(summary, &csv);
    free(csv.data);
    json_decref(mote_summary_json(summary));
    json_decref(mote_gha_json(summary));
    json_decref(mote_bencher_json(summary));
    json_decref(mote_gbench_json(summary, NULL));
    mote_fronts fronts = mote_fronts_make(summary);
    mote_fronts_print(&fronts, nowhere);
    mote_fronts_free(&fronts);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[2] = {"cells/fuzz.json", "cells/fuzz.csv"};
    mote_summary summary;
    if (mote_summary_make(fuzz_two_files(data, size, names), &summary) == MOTE_OK) {
        print(&summary);
        mote_summary_free(&summary);
    }
    return 0;
}
