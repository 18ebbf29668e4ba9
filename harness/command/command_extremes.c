/* mote extremes [--out DIR] [--quick]: every method on tiny, huge or degenerate numbers. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/study/study_extremes.h"

int mote_command_extremes(int argc, char **argv)
{
    const char *directory = "results/extremes";
    bool quick = false, met = false;
    const int understood = mote_study_read(argc, argv, &directory, &quick);
    if (understood != MOTE_EXIT_DONE)
        return understood;
    if (mote_study_extremes(directory, quick, &met) != MOTE_OK)
        return mote_command_fail();
    return mote_command_finish(met ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED);
}
