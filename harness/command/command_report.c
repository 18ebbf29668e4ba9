/* mote report DIR: shows a run as a page and as plain text, from its stored results. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/report/report.h"

#include <stdio.h>

int mote_command_report(int argc, char **argv)
{
    const char *directory = NULL;
    const int understood = mote_directory_argument(argc, argv, &directory);
    if (understood != MOTE_EXIT_DONE)
        return understood;
    if (mote_report_write(directory) != MOTE_OK)
        return mote_command_fail();
    (void)printf("%s/report.md\n%s/report.html\n", directory, directory);
    return mote_command_finish(MOTE_EXIT_DONE);
}
