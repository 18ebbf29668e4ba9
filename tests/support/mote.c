#define _POSIX_C_SOURCE 200809L /* popen */
#include "tests/support/mote.h"

#include "tests/support/test.h"

#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

char said[1 << 20];
static char line[1 << 14]; /* of the shell */

static void set_line(const char *format, va_list arguments)
{
    const int start = snprintf(line, sizeof line, "%s 2>&1 ", MOTE_PROGRAM);
    const size_t room = sizeof line - (size_t)start;
    const int length = vsnprintf(line + start, room, format, arguments);
    assert_true(length >= 0 && (size_t)length < room);
}

static int run(void)
{
    FILE *pipe = popen(line, "r");
    assert_non_null(pipe);
    said[fread(said, 1, sizeof said - 1, pipe)] = '\0';
    const int status = pclose(pipe);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

int mote(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    set_line(format, arguments);
    va_end(arguments);
    return run();
}

void mote_expect(int status, const char *says, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    set_line(format, arguments);
    va_end(arguments);
    const int ended = run();
    if (ended != status || !strstr(said, says))
        fail_msg("%s: exit %d, not %d, or not \"%s\":\n%s", line, ended, status, says, said);
}

bool has_valgrind(void)
{
    return system("valgrind --version >/dev/null 2>&1") == 0;
}
