/* mote history: the accepted references, drawn; --add makes a run one of them. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/summary/history.h"

const mote_option mote_options_history[] = {
    {"add", "DIR", "add this run; with --why (default: none is added)"},
    {"why", "TEXT", "why the reference changes; with --add"},
    {NULL, NULL, NULL}};

int mote_command_history(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_history, argc, argv);
    const char *file = "results/history.csv", *value, *directory = NULL, *why = NULL;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN)
            file = value;
        else if (option == 0)
            directory = value;
        else
            why = value;
    }
    if ((directory == NULL) != (why == NULL))
        return mote_command_usage(argv[0], "--add DIR and --why TEXT go together");
    mote_status status =
        directory ? mote_history_add(file, directory, why) : mote_history_draw(file);
    return status == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE) : mote_command_fail();
}
