/* mote dynamics [--out DIR] [--quick] ...: bodies passing through each other, over n, in the
   closed loop. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/base/file.h"
#include "harness/process/manifest.h"
#include "harness/study/study_dynamics.h"

typedef struct request {
    const char *directory;
    mote_dynamics_size size;
    uint64_t jobs;
    bool keep;
} request;

const mote_option mote_options_dynamics[] = {
    {"out", "DIR", "where the results go (default: results/dynamics)"},
    {"quick", NULL, "fewer approaches, and the paper's scenes only"},
    {"jobs", "K", "rows at once, 1 to 64 (default: 1)"},
    {"approaches", "K", "for every row (default: 1000, for FCL 200; with --quick 100 and 20)"},
    {"scene", "NAME", "this scene only (default: all)"},
    {"step", "K",
     "only sampled and continuous steps of K frames: 1, 3, 10 or 30 (default: all rows)"},
    {"keep", NULL,
     "keep rows that another build of the program measured (default: measure them again)"},
    {NULL, NULL, NULL}};

/* False, after a line on stderr, if the value is invalid for the option. */
static bool read_option(request *wish, int option, const char *value)
{
    uint64_t number = 0;
    switch (option) {
    case 0:
        wish->directory = value;
        return true;
    case 1:
        wish->size.quick = true;
        return true;
    case 2:
        if (mote_read_unsigned(value, 1, 64, &wish->jobs))
            return true;
        break;
    case 3:
        if (mote_read_unsigned(value, 1, 1000000, &number)) {
            wish->size.approaches = (uint32_t)number;
            return true;
        }
        break;
    case 4:
        wish->size.scene = value;
        return true;
    case 5:
        if (mote_read_unsigned(value, 1, 1000, &number) &&
            mote_dynamics_has_step((double)number)) {
            wish->size.step = (double)number;
            return true;
        }
        break;
    default:
        wish->keep = true;
        return true;
    }
    (void)mote_command_usage("dynamics", "--%s %s: give %s", mote_options_dynamics[option].name,
                             value,
                             option == 2   ? "a whole number from 1 to 64"
                             : option == 5 ? "1, 3, 10 or 30"
                                           : "a whole number from 1 to 1000000");
    return false;
}

static mote_status study(const request *wish, int argc, char **argv, bool *met)
{
    uint64_t program = 0;
    mote_status status = mote_dynamics_check(&wish->size); /* before anything is written */
    if (status == MOTE_OK)
        status = mote_directory_make(wish->directory);
    if (status == MOTE_OK)
        status = mote_program_hash(&program);
    if (status == MOTE_OK)
        status = mote_manifest_write(wish->directory, program, MOTE_APPROACH_SEED, argc, argv);
    if (status != MOTE_OK)
        return status;
    return mote_study_dynamics(wish->directory, &wish->size, (uint32_t)wish->jobs, program,
                               wish->keep, met);
}

int mote_command_dynamics(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_dynamics, argc, argv);
    request wish = {.directory = "results/dynamics", .jobs = 1};
    const char *value;
    for (int option; (option = mote_option_next_named(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (!read_option(&wish, option, value))
            return MOTE_EXIT_USAGE;
    }
    bool met = false;
    if (study(&wish, argc, argv, &met) != MOTE_OK)
        return mote_command_fail();
    return mote_command_finish(met ? MOTE_EXIT_DONE : MOTE_EXIT_CHECK_FAILED);
}
