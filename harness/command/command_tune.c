/* mote tune DIR: the best configuration of each method on each scenario of a run. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/base/record.h"
#include "harness/summary/tune.h"

#include <stdlib.h>

static int tune(const char *directory)
{
    mote_summary summary;
    if (mote_summary_make(directory, &summary) != MOTE_OK)
        return mote_command_fail();
    size_t count = 0;
    mote_tuned *tuned = mote_tune_make(&summary, &count);
    const mote_status status =
        mote_record_json(directory, "tune.json", mote_tune_json(tuned, count));
    if (status == MOTE_OK)
        mote_tune_print(tuned, count, stdout);
    free(tuned);
    mote_summary_free(&summary);
    return status == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE) : mote_command_fail();
}

static int print_best(const char *directory, const char *scenario, bool fcl)
{
    char *configuration = NULL;
    if (mote_tune_best(directory, scenario, fcl, &configuration) != MOTE_OK)
        return mote_command_fail();
    if (configuration[0])
        (void)printf("%s\n", configuration);
    else
        (void)fprintf(stderr, "mote: %s/tune.json lists no %s that is right on %s\n", directory,
                      fcl ? "FCL" : "engine of others", scenario);
    free(configuration);
    return mote_command_finish(MOTE_EXIT_DONE);
}

const mote_option mote_options_tune[] = {
    {"best", "SCENARIO",
     "print the best configuration of the engines of others on this scenario instead, as `mote "
     "run` takes it (default: not)"},
    {"best-fcl", "SCENARIO", "the same of FCL alone (default: not)"},
    {NULL, NULL, NULL}};
enum { OPTION_BEST, OPTION_BEST_FCL };

int mote_command_tune(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_tune, argc, argv);
    const char *directory = NULL, *scenario = NULL, *value;
    bool fcl = false;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option != MOTE_OPTION_PLAIN) {
            scenario = value;
            fcl = option == OPTION_BEST_FCL;
            continue;
        }
        if (directory)
            return mote_command_usage(argv[0], "%s: one directory at a time", value);
        directory = value;
    }
    if (!directory)
        return mote_command_usage(argv[0], "no directory; write `mote tune results/tune`");
    return scenario ? print_best(directory, scenario, fcl) : tune(directory);
}
