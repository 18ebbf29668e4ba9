/* mote figures DIR: the figures of a run, drawn again from its cells. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/figure/figures.h"

int mote_command_figures(int argc, char **argv)
{
    const char *directory = NULL;
    const int understood = mote_directory_argument(argc, argv, &directory);
    if (understood != MOTE_EXIT_DONE)
        return understood;
    size_t drawn = 0;
    if (mote_figures_draw(directory, &drawn) != MOTE_OK)
        return mote_command_fail();
    if (drawn == 0) {
        (void)mote_fail(MOTE_EINVAL, "%s: no figure can be drawn of this run", directory);
        return mote_command_fail();
    }
    return mote_command_finish(MOTE_EXIT_DONE);
}
