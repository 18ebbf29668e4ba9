/* mote instructions SCENARIO: counts the instructions of methods with callgrind. */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/run/instructions.h"

const mote_option mote_options_instructions[] = {
    {"frames", "A-B", "the frames, counted from 1; no default"},
    {"method", "NAME[:key=a|b,...]", "a method; may be repeated; no default"},
    {"particles", "1,2,4-8",
     "the numbers of particles for methods with a key n (default: the key's own)"},
    {"out", "DIR", "where instructions.json goes; no default"},
    {"inside", NULL, NULL},
    {NULL, NULL, NULL}};
enum {
    OPTION_FRAMES,
    OPTION_METHOD,
    OPTION_PARTICLES,
    OPTION_OUT,
    OPTION_INSIDE, /* this is the process that runs under callgrind */
    OPTION_COUNT
};

typedef struct request {
    const char *scenario, *frames, *particles, *out;
    uint32_t first, last;
    bool inside, has_method;
    mote_choices choices;
} request;

/* MOTE_EXIT_DONE, or an exit status after a line on stderr. Methods are read in a second pass,
   when the particle numbers are known. */
static int read_arguments(int argc, char **argv, request *q)
{
    mote_option_reader reader = mote_option_begin(mote_options_instructions, argc, argv);
    const char *value;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == MOTE_OPTION_PLAIN && q->scenario)
            return mote_command_usage(argv[0], "%s: one scenario at a time", value);
        if (option == MOTE_OPTION_PLAIN)
            q->scenario = value;
        else if (option == OPTION_FRAMES)
            q->frames = value;
        else if (option == OPTION_PARTICLES)
            q->particles = value;
        else if (option == OPTION_OUT)
            q->out = value;
        else if (option == OPTION_INSIDE)
            q->inside = true;
        else
            q->has_method = true;
    }
    /* The default cannot be every method: some give no distance, and one failure ends the
       count. */
    if (!q->scenario || !q->frames || !q->has_method || (!q->out && !q->inside))
        return mote_command_usage(argv[0],
                                  "a scenario, --frames, --method and --out are needed");
    if (mote_particles_check(q->particles) != MOTE_OK)
        return mote_command_usage(argv[0], "--particles %s", mote_error_text());
    return mote_frames_argument(argv[0], "frames", q->frames, &q->first, &q->last);
}

static mote_status read_methods(int argc, char **argv, request *q)
{
    mote_option_reader reader = mote_option_begin(mote_options_instructions, argc, argv);
    const char *value;
    mote_status status = MOTE_OK;
    for (int option; status == MOTE_OK &&
                     (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == OPTION_METHOD)
            status = mote_choices_add(&q->choices, value, q->particles);
    }
    return status;
}

int mote_command_instructions(int argc, char **argv)
{
    request q = {0};
    int code = read_arguments(argc, argv, &q);
    if (code != MOTE_EXIT_DONE)
        return code;
    mote_status status = read_methods(argc, argv, &q);
    if (status == MOTE_OK && !q.inside && !mote_instructions_possible())
        status = mote_fail(MOTE_EIO, "valgrind: cannot be run; apt-get install valgrind");
    if (status == MOTE_OK && q.inside)
        status = mote_instructions_run(q.scenario, q.first, q.last, &q.choices.items[0]);
    else if (status == MOTE_OK)
        status = mote_instructions_count(q.scenario, q.first, q.last, &q.choices, q.out);
    mote_choices_free(&q.choices);
    return status == MOTE_OK ? mote_command_finish(MOTE_EXIT_DONE) : mote_command_fail();
}
