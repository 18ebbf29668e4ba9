/* mote figures DIR: the figures of a run, drawn again from its cells. */
#include "harness/command.h"
#include "harness/figures.h"

int mote_command_figures(int argc, char **argv)
{
    mote_option_reader reader = {NULL, 0, argc, argv, 0};
    const char *directory = NULL, *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (directory)
            return mote_command_usage(argv[0], "%s: one directory at a time", value);
        directory = value;
    }
    if (!directory)
        return mote_command_usage(argv[0], "no directory; write `mote figures results/paper`");
    mote_summary summary;
    if (mote_summary_make(directory, &summary) != MOTE_OK)
        return mote_command_fail();
    mote_status status = mote_figures_draw(&summary, directory);
    mote_summary_free(&summary);
    return status == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE) : mote_command_fail();
}
