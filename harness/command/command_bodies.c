/* mote bodies [--out DIR] [--quick]: several bodies by every method. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/study/study_bodies.h"

int mote_command_bodies(int argc, char **argv)
{
    const char *directory = "results/bodies";
    bool quick = false, met = false;
    const int understood = mote_study_read(argc, argv, &directory, &quick);
    if (understood != MOTE_EXIT_DONE)
        return understood;
    if (mote_study_bodies(directory, quick, argc, argv, &met) != MOTE_OK)
        return mote_command_fail();
    return mote_command_finish(met ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED);
}
