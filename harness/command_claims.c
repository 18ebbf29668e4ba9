/* mote claims: every claim of the paper with a figure, an interval and a verdict. */
#include "harness/claims.h"
#include "harness/command.h"

#include <stdio.h>

int mote_command_claims(int argc, char **argv)
{
    static const mote_option options[] = {{"out", "DIR"}, {"quick", NULL}};
    mote_option_reader reader = {options, 2, argc, argv, 0};
    const char *directory = "results/claims", *value;
    bool quick = false;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN)
            return mote_command_usage(argv[0],
                                      "%s: takes no argument; write `mote claims "
                                      "--out DIR`",
                                      value);
        if (option == 0)
            directory = value;
        quick = quick || option == 1;
    }
    mote_study study;
    bool met = false;
    mote_status status = mote_study_open(directory, quick, &study);
    if (status == MOTE_OK)
        status = mote_claims_measure(&study, &met);
    mote_study_close(&study);
    if (status != MOTE_OK)
        return mote_command_fail();
    return mote_command_finish(met ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED);
}
