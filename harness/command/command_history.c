/* mote history: draws the accepted references and the races; --add makes a run a reference. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/base/file.h"
#include "harness/race/history_page.h"
#include "harness/summary/history.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const mote_option mote_options_history[] = {
    {"add", "DIR", "add this run; with --why (default: none is added)"},
    {"why", "TEXT", "why the reference changes; with --add"},
    {"races", "DIR", "where races are (default: perf-ab beside FILE)"},
    {NULL, NULL, NULL}};

/* Draws the page, which needs no other program, and then the figure. */
static mote_status draw(const char *file, const char *races)
{
    const size_t length = strlen(file) - (mote_name_ends(file, ".csv") ? 4 : 0);
    char *page = mote_format("%.*s.html", (int)length, file);
    char *beside = mote_path_beside(file, "perf-ab");
    mote_status status = mote_history_page(file, races ? races : beside, page);
    if (status == MOTE_OK)
        (void)printf("%s\n", page);
    if (status == MOTE_OK)
        status = mote_history_draw(file);
    free(page);
    free(beside);
    return status;
}

int mote_command_history(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_history, argc, argv);
    const char *file = "results/history.csv", *value, *directory = NULL, *why = NULL,
               *races = NULL;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN)
            file = value;
        else if (option == 0)
            directory = value;
        else if (option == 1)
            why = value;
        else
            races = value;
    }
    if ((directory == NULL) != (why == NULL))
        return mote_command_usage(argv[0], "--add DIR and --why TEXT go together");
    mote_status status = directory ? mote_history_add(file, directory, why) : draw(file, races);
    return status == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE) : mote_command_fail();
}
