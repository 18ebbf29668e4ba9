/* mote bodies [--out DIR] [--quick]: several bodies by every method. */
#include "harness/command.h"
#include "harness/file.h"
#include "harness/manifest.h"
#include "harness/study_bodies.h"

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
    static const mote_option options[] = {{"out", "DIR"}, {"quick", NULL}};
    mote_option_reader reader = {options, 2, argc, argv, 0};
    const char *directory = "results/bodies", *value;
    bool quick = false;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN)
            return mote_command_usage(
                argv[0], "%s: takes no argument; write `mote bodies --out DIR`", value);
        if (option == 0)
            directory = value;
        quick = quick || option == 1;
    }
    bool met = false;
    if (study(directory, quick, argc, argv, &met) != MOTE_OK)
        return mote_command_fail();
    return mote_command_finish(met ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED);
}
