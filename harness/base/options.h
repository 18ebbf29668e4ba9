/* Reading a command line: exit statuses, errors of use, options and their values. */
#ifndef MOTE_HARNESS_OPTIONS_H
#define MOTE_HARNESS_OPTIONS_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Exit status of the program. */
typedef enum mote_exit {
    MOTE_EXIT_DONE = 0,
    MOTE_EXIT_CHECK_FAILED = 1, /* a check failed */
    MOTE_EXIT_USAGE = 2,        /* the command line cannot be understood */
    MOTE_EXIT_UNDECIDED = 3,    /* a comparison that is undecided */
    MOTE_EXIT_BAD_INPUT = 4,    /* bad input, or output that cannot be written */
    MOTE_EXIT_CELL_FAILED = 5,  /* a cell failed */
    MOTE_EXIT_OUT_OF_MEMORY = 6 /* memory ran out; finished files are whole */
} mote_exit;

/* Prints "mote: TEXT" to stderr, TEXT being mote_error_text(); returns MOTE_EXIT_BAD_INPUT, or
   MOTE_EXIT_OUT_OF_MEMORY where the failure was MOTE_ENOMEM. */
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
    const char *help;  /* what it does, with its default; NULL: for the program's own use */
} mote_option;

/* Tables end with an option without a name. */
extern const mote_option mote_options_none[];
extern const mote_option mote_options_study[]; /* of mote_study_read */

/* Reads a command line from left to right. */
typedef struct mote_option_reader {
    const mote_option *options;
    size_t count;
    int argc;
    char **argv;
    int next;   /* argument to be read */
    bool ended; /* "--" was read: no options follow */
} mote_option_reader;

/* A reader for the arguments after argv[0], the command's name. */
mote_option_reader mote_option_begin(const mote_option *options, int argc, char **argv);

#define MOTE_OPTION_PLAIN (-1) /* an argument that is not an option */
#define MOTE_OPTION_END (-2)   /* nothing left */
#define MOTE_OPTION_ERROR (-3) /* reported on stderr: return MOTE_EXIT_USAGE */

/* The next option's index in reader->options, or one of the constants above. *value: the
   option's value or the plain argument, otherwise NULL. "--" ends the options. "--plugin FILE",
   which every command accepts, is skipped: its library was loaded before the command began. */
int mote_option_next(mote_option_reader *reader, const char **value);

/* The same for a command without arguments: one that is no option is an error. */
int mote_option_next_named(mote_option_reader *reader, const char **value);

/* Reads a whole decimal number in [minimum, maximum]. False for anything else. */
bool mote_read_unsigned(const char *text, uint64_t minimum, uint64_t maximum, uint64_t *value);

/* Reads a finite number in [minimum, maximum]. False for anything else. */
bool mote_read_real(const char *text, double minimum, double maximum, double *value);

/* Reads "2%" as 0.02, from 0.001% to 100%. False for anything else. */
bool mote_read_percent(const char *text, double *share);

/* Reads "x,y,z", finite numbers. False for anything else; value is then undefined. */
bool mote_read_triple(const char *text, double value[3]);

/* The same, but not all 0; scaled by a power of two so that squares neither overflow nor
   vanish. */
bool mote_read_direction(const char *text, double direction[3]);

/* Reads "A-B" or "A", A <= B, both at least 1 and at most maximum. MOTE_EINVAL with a text. */
mote_status mote_read_range(const char *text, uint64_t maximum, uint64_t *first,
                            uint64_t *last);

/* Reads the value of --NAME as a range of frames, which may have any number of 32 bits.
   MOTE_EXIT_DONE, or MOTE_EXIT_USAGE after a line on stderr. */
int mote_frames_argument(const char *command, const char *name, const char *text,
                         uint32_t *first, uint32_t *last);

/* Reads a study's options, "--out DIR" and "--quick"; argv[0] is its name, *directory starts
   as its default. MOTE_EXIT_DONE, or MOTE_EXIT_USAGE after a line on stderr. */
int mote_study_read(int argc, char **argv, const char **directory, bool *quick);

/* Reads a command line that is one directory; argv[0] is the command's name. MOTE_EXIT_DONE,
   or MOTE_EXIT_USAGE after a line on stderr. */
int mote_directory_argument(int argc, char **argv, const char **directory);

#endif
