/* mote site DIR... -o DIR: one page of the rows of several runs, and the same as CSV. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/report/site.h"

#include <stdio.h>

const mote_option mote_options_site[] = {
    {"-o", "DIR", "where index.html and results.csv go; no default"}, {NULL, NULL, NULL}};

/* Reads the command line, adding each run; MOTE_EXIT_DONE if it is complete. */
static int read_request(int argc, char **argv, mote_results_site *site, const char **directory)
{
    mote_option_reader reader = mote_option_begin(mote_options_site, argc, argv);
    const char *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == 0)
            *directory = value;
        else if (mote_results_site_add(site, value) != MOTE_OK)
            return mote_command_fail();
    }
    if (!*directory || site->count == 0)
        return mote_command_usage(argv[0],
                                  "something is missing; write `mote site DIR... -o DIR`");
    return MOTE_EXIT_DONE;
}

int mote_command_site(int argc, char **argv)
{
    mote_results_site site = {0};
    const char *directory = NULL;
    int code = read_request(argc, argv, &site, &directory);
    for (size_t i = 0; code == MOTE_EXIT_DONE && i < json_array_size(site.left_out); ++i)
        (void)fprintf(stderr, "mote: %s; it is shown once\n",
                      json_string_value(json_array_get(site.left_out, i)));
    if (code == MOTE_EXIT_DONE && mote_results_site_write(&site, directory) != MOTE_OK)
        code = mote_command_fail();
    if (code == MOTE_EXIT_DONE) {
        (void)printf("%s/index.html\n%s/results.csv\n", directory, directory);
        code = mote_command_finish(code);
    }
    mote_results_site_free(&site);
    return code;
}
