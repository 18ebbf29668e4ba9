/* The lines that studies add to a file of checks: what was tried, how often, what failed. make
   reliability makes its table of them. */
#ifndef MOTE_TESTS_CHECKS_H
#define MOTE_TESTS_CHECKS_H

#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Appends "CHECK<tab>TRIED<tab>FAILED"; NULL path: nothing to do. False, told on stderr, when
   the file cannot be written. */
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
