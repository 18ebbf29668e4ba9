/* mote figures DIR: redraws the figures of a run from its cells. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/figure/figures.h"

#include <stdio.h>

/* Prints the files to stdout and the missing figures to stderr, those that need another command
   in one line. */
static void print(const char *directory, const mote_figures *figures)
{
    if (figures->files.data)
        (void)fputs(figures->files.data, stdout);
    if (figures->notices.data)
        (void)fputs(figures->notices.data, stderr);
    if (figures->elsewhere.data)
        (void)fprintf(stderr, "mote: %s: %s\n", directory, figures->elsewhere.data);
}

int mote_command_figures(int argc, char **argv)
{
    const char *directory = NULL;
    const int understood = mote_directory_argument(argc, argv, &directory);
    if (understood != MOTE_EXIT_DONE)
        return understood;
    mote_figures figures;
    const mote_status status = mote_figures_draw(directory, &figures);
    print(directory, &figures);
    const size_t drawn = figures.drawn;
    mote_figures_free(&figures);
    if (status != MOTE_OK)
        return mote_command_fail();
    if (drawn == 0) {
        (void)mote_fail(MOTE_EINVAL, "%s: no figure can be drawn of this run", directory);
        return mote_command_fail();
    }
    return mote_command_finish(MOTE_EXIT_DONE);
}
