/* Wrong command lines, and the error expected of each. */
#ifndef MOTE_TESTS_COMMAND_LINES_H
#define MOTE_TESTS_COMMAND_LINES_H

#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <string.h>

typedef struct command_line {
    const char *arguments;
    int status; /* exit status */
    const char *says;
} command_line;

/* Each must end with its status and one line of the expected error, and leave no file
   behind. */
static inline void command_refuses(const command_line *lines, size_t count)
{
    const int files = folder_count(".", "");
    for (size_t i = 0; i < count; ++i) {
        const command_line *bad = &lines[i];
        const int status = mote("%s >/dev/null", bad->arguments);
        /* Progress lines may precede the error; nothing may follow it. */
        const char *error = strstr(said, "mote: ");
        const char *feed = error ? strchr(error, '\n') : NULL;
        const bool one_line = feed && feed[1] == '\0' && (error == said || error[-1] == '\n');
        if (status != bad->status || !strstr(said, bad->says) || !one_line)
            fail_msg("mote %s: exit %d, not %d, or not one line with \"%s\":\n%s",
                     bad->arguments, status, bad->status, bad->says, said);
        if (folder_count(".", "") != files)
            fail_msg("mote %s left something behind", bad->arguments);
    }
}

#endif
