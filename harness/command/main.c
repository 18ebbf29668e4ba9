/* mote: accuracy, time and memory of particle-based collision queries. */
#include "harness/command/command.h"
#include "harness/process/child.h"
#include "harness/process/huge_pages.h"
#include "harness/base/options.h"
#include "harness/base/wrap.h"
#include "harness/base/json_memory.h"
#include "harness/mesh/mesh_import.h"
#include "harness/race/race_child.h"
#include "harness/process/plugin.h"
#include "harness/scene/fence.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

typedef struct command {
    const char *name;
    bool measures; /* times, so that its memory comes in huge pages */
    int (*run)(int argc, char **argv);
    const char *arguments, *summary;
    const mote_option *options;
} command;

#define COMMAND_ROW(name, measures, arguments, summary, options)                               \
    {#name, measures, mote_command_##name, arguments, summary, options},
static const command commands[] = {MOTE_COMMANDS(COMMAND_ROW)};
static const size_t command_count = sizeof commands / sizeof commands[0];

#define WIDTH 80 /* of a line of help */

static void print_wrapped(const char *words, int indent)
{
    mote_print_wrapped(words, indent, indent, WIDTH, stdout);
}

static const char *dashes(const mote_option *option)
{
    return option->name[0] == '-' ? "" : "--";
}

static void print_synopsis(const command *c)
{
    (void)printf("mote %s%s%s%s\n", c->name, c->arguments[0] ? " " : "", c->arguments,
                 c->options->name ? " [OPTION]..." : "");
}

static int print_help(void)
{
    (void)printf(
        "mote measures what a particle-based collision query gives up in accuracy, and\n"
        "saves in time and memory, against bounding volume hierarchies.\n\n");
    for (size_t i = 0; i < command_count; ++i) {
        (void)printf("  ");
        print_synopsis(&commands[i]);
        (void)printf("%8s", "");
        print_wrapped(commands[i].summary, 8);
    }
    (void)printf(
        "\nmote COMMAND --help explains the options of a command.\n\n"
        "Exit status: 0 done, 1 a check failed, 2 usage, 3 undecided, 4 bad input,\n"
        "5 a cell failed, 6 out of memory; 130 and 143 after Ctrl-C and SIGTERM.\n\n"
        "SCENARIO is a name of `mote list scenarios`, a scenario file (NAME.json), or\n"
        "two meshes that approach, touch and part: pair:A.obj:B.obj, with the direction\n"
        "in which B lies pair:A.obj:B.obj:X,Y,Z. Meshes are OBJ, PLY, STL, OFF or glTF.\n\n"
        "Before the command:\n"
        "  --allow DIR  scenario files may name files below DIR as well (default: those\n"
        "               of their own folder only); may be repeated\n"
        "  --strict     refuse edges of more than two faces (default: cut them apart)\n"
        "With any command:\n"
        "  --plugin FILE  methods and fields of a shared library (docs/extending.md); may\n"
        "               be repeated\n"
        "-- ends the options: what follows are names, even if they begin with a dash.\n");
    return mote_command_finish(MOTE_EXIT_DONE);
}

static int print_command_help(const command *c)
{
    print_synopsis(c);
    print_wrapped(c->summary, 0);
    for (const mote_option *option = c->options; option->name; ++option) {
        if (!option->help)
            continue;
        (void)printf("%s  %s%s%s%s\n%6s", option == c->options ? "\n" : "", dashes(option),
                     option->name, option->value ? " " : "", option->value ? option->value : "",
                     "");
        print_wrapped(option->help, 6);
    }
    return mote_command_finish(MOTE_EXIT_DONE);
}

/* For the manual and the completion: a line "command", name, arguments and summary; then a line
   per option: "option", name, value and help. Separated by tabs. */
static int print_table(void)
{
    for (size_t i = 0; i < command_count; ++i) {
        const command *c = &commands[i];
        (void)printf("command\t%s\t%s\t%s\n", c->name, c->arguments, c->summary);
        for (const mote_option *option = c->options; option->name; ++option) {
            if (option->help)
                (void)printf("option\t%s%s\t%s\t%s\n", dashes(option), option->name,
                             option->value ? option->value : "", option->help);
        }
    }
    return mote_command_finish(MOTE_EXIT_DONE);
}

static const command *find_command(const char *name)
{
    for (size_t i = 0; i < command_count; ++i) {
        if (strcmp(name, commands[i].name) == 0)
            return &commands[i];
    }
    return NULL;
}

static bool is_help(const char *word)
{
    return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0;
}

/* Whether --help is among the arguments, before any "--". */
static bool has_help(int argc, char **argv)
{
    for (int i = 0; i < argc && strcmp(argv[i], "--") != 0; ++i) {
        if (is_help(argv[i]))
            return true;
    }
    return false;
}

static int unknown_command(const char *name)
{
    (void)fprintf(stderr, "mote: unknown command %s; known are:", name);
    for (size_t i = 0; i < command_count; ++i)
        (void)fprintf(stderr, "%s %s", i ? "," : "", commands[i].name);
    (void)fputc('\n', stderr);
    return MOTE_EXIT_USAGE;
}

/* Loads the libraries of "--plugin FILE" and "--plugin=FILE" anywhere before "--": their
   methods must be known before names of methods are read. */
static int open_plugins(int argc, char **argv)
{
    const size_t length = strlen("--plugin");
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; ++i) {
        if (strncmp(argv[i], "--plugin", length) != 0 ||
            (argv[i][length] != '=' && argv[i][length] != '\0'))
            continue;
        const bool alone = argv[i][length] == '\0';
        if (alone && i + 1 == argc)
            return mote_command_usage("--plugin", "no file; write --plugin FILE");
        if (mote_plugin_open(alone ? argv[++i] : argv[i] + length + 1) != MOTE_OK)
            return mote_command_fail();
    }
    return MOTE_EXIT_DONE;
}

/* The exit status of a command stopped by a signal, by the shell's convention: 130 for Ctrl-C,
   143 for SIGTERM. */
static int stopped_code(int code)
{
    const int signal_number = mote_child_stop_signal();
    return signal_number != 0 && code != MOTE_EXIT_DONE ? 128 + signal_number : code;
}

int main(int argc, char **argv)
{
    char **const words = argv;
    /* If the reader of our output closes it, writing fails instead of ending the program. */
    (void)signal(SIGPIPE, SIG_IGN);
    /* The same if a file exceeds the size limit. */
    (void)signal(SIGXFSZ, SIG_IGN);
    /* A program that starts us may ignore its children, and how ours end would be lost. */
    (void)signal(SIGCHLD, SIG_DFL);
    mote_json_use_memory();
    while (argc > 1) {
        const int is_strict = strcmp(argv[1], "--strict") == 0;
        if (is_strict)
            mote_mesh_import_strictly();
        else if (strcmp(argv[1], "--allow") != 0)
            break;
        else if (argc == 2)
            return mote_command_usage("--allow", "no folder; write `mote --allow DIR COMMAND`");
        else if (mote_fence_allow(argv[2]) != MOTE_OK)
            return mote_command_fail();
        argc -= 2 - is_strict;
        argv += 2 - is_strict;
    }
    const command *first = argc > 1 ? find_command(argv[1]) : NULL;
    if (first && first->measures)
        mote_huge_pages_ask(words);
    const int opened = open_plugins(argc, argv);
    if (opened != MOTE_EXIT_DONE)
        return opened;
    if (argc < 2) {
        (void)fprintf(stderr, "mote: no command; `mote --help` lists them\n");
        return MOTE_EXIT_USAGE;
    }
    const bool asks_help = strcmp(argv[1], "help") == 0;
    if (is_help(argv[1]) || (asks_help && argc == 2))
        return print_help();
    if (strcmp(argv[1], "--help-table") == 0)
        return print_table();
    if (strcmp(argv[1], "race-child") == 0) /* for mote race, not for users */
        return mote_race_child(argc - 1, argv + 1);
    if (strcmp(argv[1], "--version") == 0) {
        (void)printf("mote %s\n", MOTE_VERSION);
        return mote_command_finish(MOTE_EXIT_DONE);
    }
    const command *wanted = asks_help ? find_command(argv[2]) : first;
    if (!wanted)
        return unknown_command(argv[asks_help ? 2 : 1]);
    if (asks_help || has_help(argc - 2, argv + 2))
        return print_command_help(wanted);
    return stopped_code(wanted->run(argc - 1, argv + 1));
}
