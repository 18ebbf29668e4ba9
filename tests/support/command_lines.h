/* Command lines as a shell runs them in a folder, and what each is told that is wrong. */
#ifndef MOTE_TESTS_COMMAND_LINES_H
#define MOTE_TESTS_COMMAND_LINES_H

#include "harness/base/file.h"
#include "tests/support/test.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>

/* Runs `mote ARGUMENTS` in the folder; returns the exit status. streams: "2>&1" to get both,
   "2>&1 >/dev/null" to get the errors only. */
static inline int command_run(const char *folder, const char *arguments, const char *streams,
                              char *output, size_t size)
{
    char *line = mote_format("cd %s && %s %s %s", folder, MOTE_PROGRAM, arguments, streams);
    assert_non_null(line);
    FILE *pipe = popen(line, "r");
    assert_non_null(pipe);
    size_t got = fread(output, 1, size - 1, pipe);
    output[got] = '\0';
    int status = pclose(pipe);
    free(line);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static inline bool command_left(const char *folder, const char *name)
{
    struct stat info;
    char path[128];
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    return stat(path, &info) == 0;
}

typedef struct command_line {
    const char *arguments;
    int status; /* exit status */
    const char *says;
} command_line;

/* Each ends with its status and one line of an error that says what it must, and leaves none of
   the files x, W.obj and x.json. */
static inline void command_refuses(const char *folder, const command_line *lines, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        const command_line *bad = &lines[i];
        char output[4096];
        int status =
            command_run(folder, bad->arguments, "2>&1 >/dev/null", output, sizeof output);
        /* Before the error there may be lines of progress, after it nothing. */
        const char *error = strstr(output, "mote: ");
        const char *feed = error ? strchr(error, '\n') : NULL;
        bool one_line = feed && feed[1] == '\0' && (error == output || error[-1] == '\n');
        if (status != bad->status || !strstr(output, bad->says) || !one_line)
            fail_msg("mote %s: exit %d, not %d, or not one line with \"%s\":\n%s",
                     bad->arguments, status, bad->status, bad->says, output);
        if (command_left(folder, "x") || command_left(folder, "W.obj") ||
            command_left(folder, "x.json"))
            fail_msg("mote %s left something behind", bad->arguments);
    }
}

#endif
