/* mote report DIR: a run as a page and as plain text, from what is stored. */
#include "harness/command.h"
#include "harness/report.h"

#include <stdio.h>

int mote_command_report(int argc, char **argv)
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
        return mote_command_usage(argv[0], "no directory; write `mote report results/paper`");
    if (mote_report_write(directory) != MOTE_OK)
        return mote_command_fail();
    (void)printf("%s/report.md\n%s/report.html\n", directory, directory);
    return mote_command_finish(MOTE_EXIT_DONE);
}
