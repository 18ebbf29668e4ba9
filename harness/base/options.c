#include "harness/base/options.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int mote_command_fail(void)
{
    (void)fprintf(stderr, "mote: %s\n", mote_error_text());
    return mote_error_status() == MOTE_ENOMEM ? MOTE_EXIT_OUT_OF_MEMORY : MOTE_EXIT_BAD_INPUT;
}

int mote_command_usage(const char *command, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)fprintf(stderr, "mote: %s: ", command);
    (void)vfprintf(stderr, format, arguments);
    (void)fputc('\n', stderr);
    va_end(arguments);
    return MOTE_EXIT_USAGE;
}

int mote_command_finish(int code)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return code;
    (void)fprintf(stderr, "mote: standard output: cannot be written: %s\n", strerror(errno));
    return MOTE_EXIT_BAD_INPUT;
}

/* The option that an argument names, or -1; *inline_value: the text after its '=', or NULL. */
static int find_option(const mote_option_reader *reader, const char *argument,
                       const char **inline_value)
{
    *inline_value = NULL;
    for (size_t i = 0; i < reader->count; ++i) {
        const char *name = reader->options[i].name;
        if (name[0] == '-') {
            if (strcmp(argument, name) == 0)
                return (int)i;
            continue;
        }
        size_t length = strlen(name);
        if (strncmp(argument, "--", 2) != 0 || strncmp(argument + 2, name, length) != 0)
            continue;
        const char *rest = argument + 2 + length;
        if (*rest == '=')
            *inline_value = rest + 1;
        if (*rest == '=' || *rest == '\0')
            return (int)i;
    }
    return -1;
}

static void list_options(const mote_option_reader *reader, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; i < reader->count && used < size; ++i) {
        const mote_option *option = &reader->options[i];
        if (!option->help)
            continue;
        int put = snprintf(text + used, size - used, "%s%s%s%s%s", i ? ", " : "",
                           option->name[0] == '-' ? "" : "--", option->name,
                           option->value ? " " : "", option->value ? option->value : "");
        used += put > 0 ? (size_t)put : 0;
    }
}

mote_option_reader mote_option_begin(const mote_option *options, int argc, char **argv)
{
    size_t count = 0;
    while (options[count].name)
        ++count;
    const mote_option_reader reader = {options, count, argc, argv, 1, false};
    return reader;
}

/* Skips an option that has already taken effect; its value is known to be there. */
static bool skip_plugin(mote_option_reader *reader)
{
    const char *argument = reader->argv[reader->next];
    const bool alone = strcmp(argument, "--plugin") == 0;
    if (!alone && strncmp(argument, "--plugin=", 9) != 0)
        return false;
    reader->next += 1 + alone;
    return true;
}

int mote_option_next(mote_option_reader *reader, const char **value)
{
    *value = NULL;
    if (!reader->ended && reader->next < reader->argc &&
        strcmp(reader->argv[reader->next], "--") == 0) {
        reader->ended = true;
        reader->next += 1;
    }
    if (reader->next >= reader->argc)
        return MOTE_OPTION_END;
    if (!reader->ended && skip_plugin(reader))
        return mote_option_next(reader, value);
    const char *command = reader->argv[0];
    const char *argument = reader->argv[reader->next++];
    if (reader->ended || argument[0] != '-' || argument[1] == '\0') {
        *value = argument;
        return MOTE_OPTION_PLAIN;
    }
    const char *given;
    int index = find_option(reader, argument, &given);
    if (index < 0) {
        char known[512];
        list_options(reader, known, sizeof known);
        (void)mote_command_usage(command, "unknown option %s; known are: %s", argument,
                                 reader->count ? known : "none");
        return MOTE_OPTION_ERROR;
    }
    const mote_option *option = &reader->options[index];
    if (!option->value && given) {
        (void)mote_command_usage(command, "--%s takes no value", option->name);
        return MOTE_OPTION_ERROR;
    }
    if (option->value && !given) {
        if (reader->next >= reader->argc) {
            (void)mote_command_usage(command, "%s needs a value: %s %s", argument, argument,
                                     option->value);
            return MOTE_OPTION_ERROR;
        }
        given = reader->argv[reader->next++];
    }
    *value = given;
    return index;
}

int mote_option_next_named(mote_option_reader *reader, const char **value)
{
    const int option = mote_option_next(reader, value);
    if (option != MOTE_OPTION_PLAIN)
        return option;
    const char *command = reader->argv[0];
    (void)mote_command_usage(command,
                             "%s: mote %s takes no argument; write `mote %s --out DIR`", *value,
                             command, command);
    return MOTE_OPTION_ERROR;
}

const mote_option mote_options_none[] = {{NULL, NULL, NULL}};

const mote_option mote_options_study[] = {
    {"out", "DIR", "where the results go (default: results/ followed by the command's name)"},
    {"quick", NULL, "a smaller study (default: the whole one)"},
    {NULL, NULL, NULL}};

int mote_study_read(int argc, char **argv, const char **directory, bool *quick)
{
    mote_option_reader reader = mote_option_begin(mote_options_study, argc, argv);
    const char *value;
    for (int option; (option = mote_option_next_named(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == 0)
            *directory = value;
        *quick = *quick || option == 1;
    }
    return MOTE_EXIT_DONE;
}

int mote_directory_argument(int argc, char **argv, const char **directory)
{
    mote_option_reader reader = mote_option_begin(mote_options_none, argc, argv);
    const char *value, *given = NULL;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (given)
            return mote_command_usage(argv[0], "%s: one directory at a time", value);
        given = value;
    }
    if (!given)
        return mote_command_usage(argv[0], "no directory; write `mote %s results/paper`",
                                  argv[0]);
    *directory = given;
    return MOTE_EXIT_DONE;
}

bool mote_read_unsigned(const char *text, uint64_t minimum, uint64_t maximum, uint64_t *value)
{
    if (text[0] < '0' || text[0] > '9')
        return false;
    char *end;
    errno = 0;
    unsigned long long number = strtoull(text, &end, 10);
    if (errno != 0 || *end != '\0' || number < minimum || number > maximum)
        return false;
    *value = number;
    return true;
}

bool mote_read_real(const char *text, double minimum, double maximum, double *value)
{
    char *end;
    double number = strtod(text, &end);
    /* A NaN fails this test. */
    if (end == text || *end != '\0' || !(number >= minimum && number <= maximum))
        return false;
    *value = number;
    return true;
}

bool mote_read_percent(const char *text, double *share)
{
    char number[32];
    size_t length = strlen(text);
    if (length < 2 || length > sizeof number || text[length - 1] != '%')
        return false;
    memcpy(number, text, length - 1);
    number[length - 1] = '\0';
    if (!mote_read_real(number, 1e-3, 100, share))
        return false;
    *share /= 100;
    return true;
}

bool mote_read_triple(const char *text, double value[3])
{
    for (int axis = 0; axis < 3; ++axis) {
        char *end;
        value[axis] = strtod(text, &end);
        bool finite = value[axis] - value[axis] == 0;
        if (end == text || *end != (axis < 2 ? ',' : '\0') || !finite)
            return false;
        text = end + 1;
    }
    return true;
}

bool mote_read_direction(const char *text, double direction[3])
{
    double largest = 0;
    if (!mote_read_triple(text, direction))
        return false;
    for (int i = 0; i < 3; ++i)
        largest = fmax(largest, fabs(direction[i]));
    int exponent;
    (void)frexp(largest, &exponent);
    for (int i = 0; i < 3; ++i)
        direction[i] = ldexp(direction[i], -exponent);
    return largest > 0;
}

mote_status mote_read_range(const char *text, uint64_t maximum, uint64_t *first, uint64_t *last)
{
    char copy[64];
    if (strlen(text) >= sizeof copy)
        return mote_fail(MOTE_EINVAL, "%.60s...: not a range; write A-B", text);
    memcpy(copy, text, strlen(text) + 1);
    char *dash = strchr(copy, '-');
    const char *end = copy;
    if (dash) {
        *dash = '\0';
        end = dash + 1;
    }
    uint64_t a, b;
    if (!mote_read_unsigned(copy, 0, UINT64_MAX, &a) ||
        !mote_read_unsigned(end, 0, UINT64_MAX, &b))
        return mote_fail(MOTE_EINVAL, "%s: not a range; write A-B, whole numbers", text);
    if (a > b)
        return mote_fail(MOTE_EINVAL, "%s: an empty range; write A-B with A <= B", text);
    if (a < 1 || b > maximum)
        return mote_fail(MOTE_EINVAL, "%s: outside 1-%" PRIu64 "; write A-B within it", text,
                         maximum);
    *first = a;
    *last = b;
    return MOTE_OK;
}

int mote_frames_argument(const char *command, const char *name, const char *text,
                         uint32_t *first, uint32_t *last)
{
    uint64_t from = 0, to = 0;
    if (mote_read_range(text, UINT32_MAX, &from, &to) != MOTE_OK)
        return mote_command_usage(command, "--%s %s", name, mote_error_text());
    *first = (uint32_t)from;
    *last = (uint32_t)to;
    return MOTE_EXIT_DONE;
}
