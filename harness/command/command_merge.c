/* mote merge OUT DIR...: puts the cells of several runs into one directory and summarises
   them. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/summary/merge.h"
#include "harness/summary/summary_json.h"
#include "harness/summary/table.h"

#include <stdio.h>
#include <stdlib.h>

static int report(const char *directory, const mote_merged *merged)
{
    mote_summary summary;
    (void)fprintf(stderr, "%s: %zu cells copied, %zu were there\n", directory, merged->copied,
                  merged->present);
    if (mote_summary_make(directory, &summary) != MOTE_OK)
        return mote_command_fail();
    int code = MOTE_EXIT_DONE;
    if (mote_summary_write(&summary, directory) == MOTE_OK)
        mote_table_print(&summary, stdout);
    else
        code = mote_command_fail();
    mote_summary_free(&summary);
    return mote_command_finish(code);
}

int mote_command_merge(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_none, argc, argv);
    const char *directory = NULL, *value;
    mote_merged merged = {0};
    size_t runs = 0;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (!directory) {
            directory = value;
            continue;
        }
        ++runs;
        if (mote_merge(directory, value, &merged) != MOTE_OK)
            return mote_command_fail();
    }
    if (runs == 0)
        return mote_command_usage(argv[0], "runs are missing; write `mote merge OUT DIR...`");
    return report(directory, &merged);
}
