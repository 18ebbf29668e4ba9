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
    size_t drawn = 0;
    if (mote_figures_draw(directory, &drawn) != MOTE_OK)
        return mote_command_fail();
    if (drawn == 0) {
        (void)mote_fail(MOTE_EINVAL, "%s: no figure can be drawn of this run", directory);
        return mote_command_fail();
    }
    return mote_command_finish(MOTE_EXIT_DONE);
}
