/* mote merge OUT DIR...: puts the cells of several runs into one directory and summarises
   them. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/command/kept.h"
#include "harness/summary/merge.h"
#include "harness/summary/summary_json.h"

#include <stdio.h>
#include <stdlib.h>

static int report(const char *directory, const mote_merged *merged)
{
    if (merged->simulations)
        (void)fprintf(stderr, "%s: %zu cells and %zu simulations copied, %zu were there\n",
                      directory, merged->copied, merged->simulations, merged->present);
    else
        (void)fprintf(stderr, "%s: %zu cells copied, %zu were there\n", directory,
                      merged->copied, merged->present);
    mote_kept kept;
    if (mote_kept_read(directory, &kept) != MOTE_OK)
        return mote_command_fail();
    int code = MOTE_EXIT_DONE;
    if (kept.has_summary && mote_summary_write(&kept.summary, directory) != MOTE_OK)
        code = mote_command_fail();
    else
        mote_kept_print(&kept, stdout);
    mote_kept_free(&kept);
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
