/* mote bodies [--out DIR] [--quick]: several bodies by every method. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/base/file.h"
#include "harness/process/manifest.h"
#include "harness/study/study_bodies.h"

static mote_status study(const char *directory, bool quick, int argc, char **argv, bool *met)
{
    uint64_t program = 0;
    mote_status status = mote_directory_make(directory);
    if (status == MOTE_OK)
        status = mote_program_hash(&program);
    if (status == MOTE_OK)
        status = mote_manifest_write(directory, program, 1, argc, argv);
    return status == MOTE_OK ? mote_study_bodies(directory, quick, met) : status;
}

int mote_command_bodies(int argc, char **argv)
{
    const char *directory = "results/bodies";
    bool quick = false, met = false;
    const int understood = mote_study_options(argc, argv, &directory, &quick);
    if (understood != MOTE_EXIT_DONE)
        return understood;
    if (study(directory, quick, argc, argv, &met) != MOTE_OK)
        return mote_command_fail();
    return mote_command_finish(met ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED);
}
