/* mote extremes [--out DIR] [--quick]: every method where numbers are tiny, huge or degenerate.
 */
#include "harness/command.h"
#include "harness/study_extremes.h"

int mote_command_extremes(int argc, char **argv)
{
    static const mote_option options[] = {{"out", "DIR"}, {"quick", NULL}};
    mote_option_reader reader = {options, 2, argc, argv, 0};
    const char *directory = "results/extremes", *value;
    bool quick = false;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN)
            return mote_command_usage(
                argv[0], "%s: takes no argument; write `mote extremes --out DIR`", value);
        if (option == 0)
            directory = value;
        quick = quick || option == 1;
    }
    bool met = false;
    if (mote_study_extremes(directory, quick, &met) != MOTE_OK)
        return mote_command_fail();
    return mote_command_finish(met ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED);
}
