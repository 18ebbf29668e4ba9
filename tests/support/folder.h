/* The folder that a test program runs in, and its files.

   test_main.c makes a new folder, enters it, runs the tests there and removes it with
   everything that they left behind. So tests name their files freely, and paths are
   relative. */
#ifndef MOTE_TESTS_FOLDER_H
#define MOTE_TESTS_FOLDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Makes the folder, named after the program, and enters it; false, after a line on stderr, on
   failure. */
bool folder_enter(const char *program);
bool folder_leave(void);

/* Its path: /tmp/mote-PROGRAM-XXXXXX */
const char *folder_path(void);

/* A fixture for TEST_EACH: each test gets an empty folder within. */
int folder_next(void);

/* Counts the files in a folder whose names have this ending. */
int folder_count(const char *path, const char *ending);

/* Removes a file, or a folder with its contents; 0 when it existed and is gone. */
int folder_remove(const char *path);

bool file_exists(const char *path);

/* The test fails if a file cannot be written or read. Does not sync as mote_file_write does,
   which takes too long for tests. */
void file_put(const char *path, const char *text);
void file_write(const char *path, const void *data, size_t size);

/* A file's text, at most 64 MB; the caller frees it. The test fails if the file does not
   exist. */
char *file_text(const char *path);

#endif
