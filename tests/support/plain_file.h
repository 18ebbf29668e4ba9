/* Writes a file without the sync of mote_file_write, which takes too long for tests. */
#ifndef MOTE_TESTS_PLAIN_FILE_H
#define MOTE_TESTS_PLAIN_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

static inline bool plain_file_write(const char *path, const void *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    const bool put = file && fwrite(data, 1, size, file) == size;
    return file && fclose(file) == 0 && put;
}

static inline bool plain_file_put(const char *path, const char *text)
{
    return plain_file_write(path, text, strlen(text));
}

#endif
