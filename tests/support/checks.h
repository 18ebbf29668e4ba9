/* Common parts of the studies of make reliability: their options, and the lines that they add
   to a file of checks, {what was tried, how often, what failed}, from which it makes its
   table. */
#ifndef MOTE_TESTS_CHECKS_H
#define MOTE_TESTS_CHECKS_H

#include "harness/base/options.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef struct checks_options {
    uint64_t queries;   /* to try; from 1 */
    uint64_t first;     /* number of the first random scene; others give other scenes */
    const char *out;    /* a JSON file of all figures; NULL: none */
    const char *checks; /* the file of checks; NULL: none */
} checks_options;

/* Reads [--queries N] [--first SCENE] [--out FILE] [--checks FILE]; for anything else returns
   false, after a line on stderr. options hold the defaults on entry and borrow from argv. */
static inline bool checks_read(int argc, char **argv, const char *program,
                               checks_options *options)
{
    for (int i = 1; i < argc; i += 2) {
        char *value = i + 1 < argc ? argv[i + 1] : NULL;
        bool known = value != NULL;
        if (known && strcmp(argv[i], "--queries") == 0)
            known = mote_read_unsigned(value, 1, UINT64_MAX, &options->queries);
        else if (known && strcmp(argv[i], "--first") == 0)
            known = mote_read_unsigned(value, 0, UINT32_MAX, &options->first);
        else if (known && strcmp(argv[i], "--out") == 0)
            options->out = value;
        else if (known && strcmp(argv[i], "--checks") == 0)
            options->checks = value;
        else
            known = false;
        if (!known) {
            fprintf(stderr,
                    "usage: %s [--queries N] [--first SCENE] [--out FILE] [--checks FILE]\n",
                    program);
            return false;
        }
    }
    return true;
}

/* Appends "CHECK<tab>TRIED<tab>FAILED"; NULL path: nothing to do. False, after a line on
   stderr, when the file cannot be written. */
static inline bool checks_add(const char *path, const char *check, uint64_t tried,
                              uint64_t failed)
{
    if (!path)
        return true;
    FILE *file = fopen(path, "a");
    bool good =
        file && fprintf(file, "%s\t%" PRIu64 "\t%" PRIu64 "\n", check, tried, failed) > 0;
    good = file && fclose(file) == 0 && good;
    if (!good)
        fprintf(stderr, "%s: cannot be written\n", path);
    return good;
}

#endif
