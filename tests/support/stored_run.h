/* A run's directory for each test, whose files the test writes itself. */
#ifndef MOTE_TESTS_STORED_RUN_H
#define MOTE_TESTS_STORED_RUN_H

#include "harness/summary/stored.h"
#include "tests/support/plain_file.h"
#include "tests/support/program.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <stdint.h>

#include <math.h>
#include <unistd.h>

static char base[] = "/tmp/mote-test-stored-XXXXXX";
static char directory[64], said[64], text[1 << 16];
static int directories;

static inline int make_base(void)
{
    return mkdtemp(base) ? 0 : -1;
}

static inline int remove_base(void)
{
    return program_remove(base);
}

static inline int next_directory(void)
{
    (void)snprintf(directory, sizeof directory, "%s/%d", base, directories);
    (void)snprintf(said, sizeof said, "%s/said-%d", base, directories);
    ++directories;
    return 0;
}

static inline void write_plain(const char *name, const char *content)
{
    char path[256];
    (void)snprintf(path, sizeof path, "%s/%s", directory, name);
    assert_true(plain_file_put(path, content));
}

static inline void write_cell(stored_cell cell)
{
    assert_true(stored_cell_write(directory, &cell));
}

#define ROWS                                                                                   \
    "1,1,2,3,0.5,0,0,0,7\n2,1,2,3,0.25,1e-3,0,0,7\n3,1,2,3,0,0,1,1,7\n4,1,2,3,0,0,1,1,7\n"

/* mote COMMAND DIRECTORY */
static inline int mote(const char *command)
{
    char line[256];
    (void)snprintf(line, sizeof line, "%s %s", command, directory);
    const int status = program_wait(program_start(line, said));
    program_read(said, text, sizeof text);
    return status;
}

static inline void refused(const char *change, const char *says)
{
    mote_stored stored;
    if (mote_stored_read(directory, NULL, &stored) != MOTE_EINVAL ||
        !strstr(mote_error_text(), says))
        fail_msg("%s: not \"%s\" but \"%s\"", change, says, mote_error_text());
}

static inline void about(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fabs(expected)))
        fail_msg("%.17g, not %.17g", value, expected);
}

TEST_GROUP(make_base, remove_base);
TEST_EACH(next_directory, NULL);

#endif
