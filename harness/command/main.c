/* mote: accuracy, time and memory of particle-based collision queries. */
#include "harness/command/command.h"
#include "harness/process/child.h"
#include "harness/base/options.h"
#include "harness/base/json_memory.h"
#include "harness/mesh/mesh_import.h"
#include "harness/scene/fence.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

typedef struct command {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *usage, *summary;
} command;

#define COMMAND_ROW(name, usage, summary) {#name, mote_command_##name, usage, summary},
static const command commands[] = {MOTE_COMMANDS(COMMAND_ROW)};
static const size_t command_count = sizeof commands / sizeof commands[0];

static int print_help(void)
{
    (void)printf(
        "mote measures what a particle-based collision query gives up in accuracy, and\n"
        "saves in time and memory, against bounding volume hierarchies.\n\n");
    for (size_t i = 0; i < command_count; ++i)
        (void)printf("  mote %s\n        %s\n", commands[i].usage, commands[i].summary);
    (void)printf(
        "\nExit status: 0 done, 1 a check failed, 2 usage, 3 undecided, 4 bad input,\n"
        "5 a cell failed, 6 out of memory.\n\n"
        "Scenario files name only files of their own folder, unless others are allowed:\n"
        "mote --allow DIR COMMAND ... (before the command, as often as needed).\n"
        "Edges of more than two faces in mesh files are cut apart, unless they are refused:\n"
        "mote --strict COMMAND ...\n");
    return mote_command_finish(MOTE_EXIT_DONE);
}

static int is_help(const char *word)
{
    return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0;
}

static int unknown_command(const char *name)
{
    (void)fprintf(stderr, "mote: unknown command %s; known are:", name);
    for (size_t i = 0; i < command_count; ++i)
        (void)fprintf(stderr, "%s %s", i ? "," : "", commands[i].name);
    (void)fputc('\n', stderr);
    return MOTE_EXIT_USAGE;
}

/* A command that a signal stopped ends as a shell tells it: 130 for Ctrl-C, 143 for SIGTERM. */
static int stopped_code(int code)
{
    const int signal_number = mote_child_stop_signal();
    return signal_number != 0 && code != MOTE_EXIT_DONE ? 128 + signal_number : code;
}

int main(int argc, char **argv)
{
    /* When whoever reads our output goes away, writing fails; the program is not ended. */
    (void)signal(SIGPIPE, SIG_IGN);
    mote_json_use_memory();
    while (argc > 1) {
        const int is_strict = strcmp(argv[1], "--strict") == 0;
        if (is_strict)
            mote_mesh_import_strictly();
        else if (argc == 2 || strcmp(argv[1], "--allow") != 0)
            break;
        else if (mote_fence_allow(argv[2]) != MOTE_OK)
            return mote_command_fail();
        argc -= 2 - is_strict;
        argv += 2 - is_strict;
    }
    if (argc < 2) {
        (void)fprintf(stderr, "mote: no command; `mote --help` lists them\n");
        return MOTE_EXIT_USAGE;
    }
    if (is_help(argv[1]) || strcmp(argv[1], "help") == 0)
        return print_help();
    if (strcmp(argv[1], "--version") == 0) {
        (void)printf("mote %s\n", MOTE_VERSION);
        return mote_command_finish(MOTE_EXIT_DONE);
    }
    for (size_t i = 0; i < command_count; ++i) {
        if (strcmp(argv[1], commands[i].name) != 0)
            continue;
        if (argc > 2 && is_help(argv[2])) {
            (void)printf("mote %s\n%s\n", commands[i].usage, commands[i].summary);
            return mote_command_finish(MOTE_EXIT_DONE);
        }
        return stopped_code(commands[i].run(argc - 1, argv + 1));
    }
    return unknown_command(argv[1]);
}
