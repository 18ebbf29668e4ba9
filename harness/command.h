/* The commands of the mote program: one function a command, called with the arguments after the
   program's name (argv[0] is the command), returning the exit status. */
#ifndef MOTE_HARNESS_COMMAND_H
#define MOTE_HARNESS_COMMAND_H

typedef enum mote_exit {
    MOTE_EXIT_DONE = 0,
    MOTE_EXIT_CHECK_FAILED = 1,
    MOTE_EXIT_USAGE = 2,
    MOTE_EXIT_UNDECIDED = 3,
    MOTE_EXIT_BAD_INPUT = 4,
    MOTE_EXIT_CELL_FAILED = 5
} mote_exit;

int mote_command_run(int argc, char **argv);
int mote_command_summarize(int argc, char **argv);
int mote_command_figures(int argc, char **argv);

#endif
