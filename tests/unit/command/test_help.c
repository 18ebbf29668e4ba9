/* Help, manual and completion follow from one table, which lists every option. */
#include "harness/base/file.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

/* The program's output for a command line, which must end with 0. */
static void ask(const char *arguments, char *output, size_t size)
{
    mote_expect(0, "", "%s", arguments);
    assert_true(strlen(said) < size);
    memcpy(output, said, strlen(said) + 1);
}

/* Cuts a line at its tabs into at most four fields; returns how many there are. */
static int split(char *line, char *fields[4])
{
    int count = 0;
    for (char *at = line; at && count < 4; ++count) {
        fields[count] = at;
        at = strchr(at, '\t');
        if (at)
            *at++ = '\0';
    }
    return count;
}

/* Removes line breaks and indents: help is wrapped. */
static void unwrap(char *text)
{
    char *to = text;
    for (const char *from = text; *from; ++from) {
        const bool blank = *from == ' ' || *from == '\n';
        if (!blank || (to > text && to[-1] != ' '))
            *to++ = blank ? ' ' : *from;
    }
    *to = '\0';
}

TEST(help_of_each_command_explains_each_option_with_its_default)
{
    static char table[1 << 16];
    char help[1 << 14] = "", command[32] = "";
    int commands = 0, options = 0;
    ask("--help-table", table, sizeof table);
    for (char *line = strtok(table, "\n"); line; line = strtok(NULL, "\n")) {
        char *field[4], arguments[64], again[1 << 14];
        assert_int_equal(split(line, field), 4);
        if (strcmp(field[0], "command") == 0) {
            ++commands;
            (void)snprintf(command, sizeof command, "%s", field[1]);
            (void)snprintf(arguments, sizeof arguments, "%s --help", command);
            ask(arguments, help, sizeof help);
            (void)snprintf(arguments, sizeof arguments, "help %s", command);
            ask(arguments, again, sizeof again);
            assert_string_equal(help, again);
            unwrap(help);
            if (!strstr(help, field[3]))
                fail_msg("mote %s --help does not say \"%s\"", command, field[3]);
            continue;
        }
        ++options;
        char *told =
            mote_format("%s%s%s %s", field[1], field[2][0] ? " " : "", field[2], field[3]);
        if (!strstr(help, told))
            fail_msg("mote %s --help does not say \"%s\"", command, told);
        free(told);
        /* An option with a value has a default, or needs another option or none. */
        if (field[2][0] && !strstr(field[3], "default") && !strstr(field[3], "with --"))
            fail_msg("mote %s: no default of %s is told", command, field[1]);
        /* The program knows the option: without a value it complains about that alone. */
        if (field[2][0])
            mote_expect(2, "needs a value", "%s %s", command, field[1]);
    }
    assert_true(commands >= 20 && options >= 60);
}

TEST(help_fits_into_80_columns)
{
    char help[1 << 14];
    ask("--help", help, sizeof help);
    for (char *line = strtok(help, "\n"); line; line = strtok(NULL, "\n")) {
        if (strlen(line) > 80)
            fail_msg("%s", line);
    }
}

TEST(help_tells_of_pairs_and_anywhere_in_a_line)
{
    char help[1 << 14];
    ask("run --help", help, sizeof help);
    assert_non_null(strstr(help, "--pair A.obj B.obj"));
    assert_non_null(strstr(help, "--direction X,Y,Z"));
    ask("run nothing --method -h", help, sizeof help);
    assert_non_null(strstr(help, "--pair A.obj B.obj"));
    mote_expect(2, "unknown command nothing", "help nothing");
    mote_expect(2, "", "list -- --help");
}
