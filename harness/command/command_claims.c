/* mote claims: every claim of the paper with a measured value, an interval and a verdict. */
#include "harness/study/claims.h"
#include "harness/command/command.h"
#include "harness/base/options.h"

int mote_command_claims(int argc, char **argv)
{
    const char *directory = "results/claims";
    bool quick = false, met = false;
    const int understood = mote_study_read(argc, argv, &directory, &quick);
    if (understood != MOTE_EXIT_DONE)
        return understood;
    mote_study study;
    mote_status status = mote_study_open(directory, quick, &study);
    if (status == MOTE_OK)
        status = mote_claims_measure(&study, &met);
    mote_study_close(&study);
    if (status != MOTE_OK) {
        const int code = mote_command_fail();
        return study.cell_failed && code == MOTE_EXIT_BAD_INPUT ? MOTE_EXIT_CELL_FAILED : code;
    }
    return mote_command_finish(met ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED);
}
