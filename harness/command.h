/* The frame of the command line: the table of sub-commands, exit codes, options. */
#ifndef MOTE_HARNESS_COMMAND_H
#define MOTE_HARNESS_COMMAND_H

#include "core/method.h"

/* Exit status of the program. */
typedef enum mote_exit {
    MOTE_EXIT_DONE = 0,
    MOTE_EXIT_CHECK_FAILED = 1, /* a check failed */
    MOTE_EXIT_USAGE = 2,        /* the command line cannot be understood */
    MOTE_EXIT_UNDECIDED = 3,    /* a comparison that is neither */
    MOTE_EXIT_BAD_INPUT = 4,    /* bad input, or output that cannot be written */
    MOTE_EXIT_CELL_FAILED = 5   /* a cell failed */
} mote_exit;

/* Every sub-command, X(name, usage, summary): a line here, and mote_command_NAME(argc, argv) in
   harness/command_NAME.c. argv[0] is the sub-command's name; the result is a mote_exit. */
#define MOTE_COMMANDS(X)                                                                       \
    X(list, "list methods|scenarios|fields [--json]",                                          \
      "the methods, scenarios and kinds of fields that there are")                             \
    X(letter, "letter W --triangles 11920 -o W.obj", "makes a letter's mesh")                  \
    X(check, "check SCENARIO [--json] [--out DIR]",                                            \
      "fingerprint; whether the active interval is what it says")                              \
    X(export, "export SCENARIO --frame K --out DIR [--method NAME[:key=value,...]]...",        \
      "writes a frame's deformed meshes and what methods say of them")                         \
    X(mesh, "mesh FILE [--json]", "what a mesh is: counts, edges, parts, L")                   \
    X(distance, "distance A.obj B.obj [--method NAME[:key=value,...]]... [--json]",            \
      "one query on two files")                                                                \
    X(approach,                                                                                \
      "approach SCENARIO --gaps FRAME:GAP,... [--every FRAMES] [--direction X,Y,Z] -o FILE",   \
      "writes the scenario with body 1 placed so that the gaps are as wished")                 \
    X(run,                                                                                     \
      "run SCENARIO... [--method NAME[:key=a|b,...]]... [--particles 1,2,4-8]\n"               \
      "           [--replicates K] [--frames A-B] [--out DIR] [--shard I/N] [--seed S]\n"      \
      "           [--timeout SECONDS] [--cache hot|evict] [--stride auto|K] [--jobs N]\n"      \
      "           [--until-ci 2%] [--budget SECONDS] [--fixed-seed] [--dry-run] [--force]",    \
      "measures cells, goes on where it stopped, writes DIR/summary.json")                     \
    X(simulate,                                                                                \
      "simulate SCENARIO --method NAME[:key=value,...] [--json] [--steps K] [--seed S]\n"      \
      "           [--density D] [--restitution E] [--tolerance T] [--gravity X,Y,Z]\n"         \
      "           [--time-step H] [--trace FILE.json] [--film FILE.gif]",                      \
      "closed loop: bodies move freely and collide where the method says so")                  \
    X(extremes, "extremes [--out DIR] [--quick]",                                              \
      "every method where numbers are tiny, huge, equal or degenerate")                        \
    X(dynamics,                                                                                \
      "dynamics [--out DIR] [--quick] [--jobs K] [--scene NAME] [--approaches K] [--keep]",    \
      "how often n particles let a body pass through, in the closed loop")                     \
    X(bodies, "bodies [--out DIR] [--quick]",                                                  \
      "several bodies by every method, over their number and density")                         \
    X(summarize, "summarize DIR [--format table|json|csv|gbench|gha|bencher]",                 \
      "the rows of a run, computed from its cells")                                            \
    X(compare, "compare BASE NEW [--format table|json] [--floor SHARE]",                       \
      "whether a run is worse than another: exit 0 no, 1 yes, 3 undecided")                    \
    X(instructions,                                                                            \
      "instructions SCENARIO --frames A-B --out DIR [--method NAME[:key=a|b,...]]...\n"        \
      "           [--particles 1,2,4-8]",                                                      \
      "what each method's frames execute, by callgrind; writes DIR/instructions.json")         \
    X(tune, "tune DIR [--best-fcl SCENARIO]",                                                  \
      "the best configuration of each method on each scenario of a run, or what was found")    \
    X(merge, "merge OUT DIR...", "puts the cells of several runs into one directory")          \
    X(history, "history [FILE] [--add DIR --why TEXT]",                                        \
      "draws the accepted references, or adds one")                                            \
    X(figures, "figures DIR", "draws the figures of a run again, measuring nothing")           \
    X(report, "report DIR", "a run as a page and as plain text, from what is stored")          \
    X(claims, "claims [--out DIR] [--quick]",                                                  \
      "measures every claim of the paper, writes DIR/claims.json")

#define MOTE_COMMAND_DECLARE(name, usage, summary)                                             \
    int mote_command_##name(int argc, char **argv);
MOTE_COMMANDS(MOTE_COMMAND_DECLARE)
#undef MOTE_COMMAND_DECLARE

/* Prints "mote: TEXT" to stderr, TEXT being mote_error_text(); returns MOTE_EXIT_BAD_INPUT. */
int mote_command_fail(void);

/* Prints "mote: COMMAND: TEXT" to stderr and returns MOTE_EXIT_USAGE. */
int mote_command_usage(const char *command, const char *format, ...) MOTE_PRINTF(2, 3);

/* Flushes stdout; MOTE_EXIT_BAD_INPUT with a line on stderr if anything printed was lost (a
   full disk, a closed pipe), else code. The last call of a command that prints results. */
int mote_command_finish(int code);

/* An option of a sub-command: "--name VALUE", "--name=VALUE" or, with value NULL, "--name". */
typedef struct mote_option {
    const char *name;  /* without the dashes, or "-o" for a short one */
    const char *value; /* what stands for the value in a message: "DIR"; NULL: takes none */
} mote_option;

/* Reads a command line from left to right. Zero-initialise `next`. */
typedef struct mote_option_reader {
    const mote_option *options;
    size_t count;
    int argc;
    char **argv;
    int next;
} mote_option_reader;

#define MOTE_OPTION_PLAIN (-1) /* an argument that is no option */
#define MOTE_OPTION_END (-2)   /* nothing left */
#define MOTE_OPTION_ERROR (-3) /* told on stderr: return MOTE_EXIT_USAGE */

/* The next option's index in reader->options, or one of the above. *value: the option's value
   or the plain argument, else NULL. "--" ends the options. */
int mote_option_next(mote_option_reader *reader, const char **value);

/* Reads a whole decimal number in [minimum, maximum]. False for anything else. */
bool mote_read_unsigned(const char *text, uint64_t minimum, uint64_t maximum, uint64_t *value);

/* Reads a finite number in [minimum, maximum]. False for anything else. */
bool mote_read_real(const char *text, double minimum, double maximum, double *value);

/* Reads "x,y,z", finite numbers. False for anything else; value is then undefined. */
bool mote_read_triple(const char *text, double value[3]);

/* Reads "A-B" or "A", A <= B, both at least 1 and at most maximum. MOTE_EINVAL with a text. */
mote_status mote_read_range(const char *text, uint64_t maximum, uint64_t *first,
                            uint64_t *last);

/* Reads a study's options, "--out DIR" and "--quick"; argv[0] is its name, *directory where it
   writes unless told. MOTE_EXIT_DONE, or MOTE_EXIT_USAGE, told on stderr. */
int mote_study_options(int argc, char **argv, const char **directory, bool *quick);

/* Reads a command line that is one directory; argv[0] is the command's name. MOTE_EXIT_DONE, or
   MOTE_EXIT_USAGE, told on stderr. */
int mote_directory_argument(int argc, char **argv, const char **directory);

/* A method and its parameters, as named on the command line. */
typedef struct mote_method_choice {
    const mote_method *method;
    double values[MOTE_PARAMETERS_MAX];
    char text[256]; /* as given: "particle:n=5" */
} mote_method_choice;

/* Reads "NAME" or "NAME:key=value,key=value". MOTE_EINVAL with a text that lists what would be
   right: an unknown method, or a parameter that mote_parameters_parse refuses. */
mote_status mote_method_choice_read(const char *text, mote_method_choice *choice);

#endif
