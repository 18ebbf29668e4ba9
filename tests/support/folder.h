/* The folder that a test program runs in, and files there.

   test_main.c makes a new folder, enters it, runs the tests there and removes it with all that
   they left in it. So tests name their files as they like, and paths are relative. */
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

/* Where it is: /tmp/mote-PROGRAM-XXXXXX */
const char *folder_path(void);

/* A fixture for TEST_EACH: each test gets an empty folder within. */
int folder_next(void);

/* How many files are in a folder; those whose names end so. */
int folder_count(const char *path, const char *ending);

/* Removes a file or a folder with what is in it; 0 when it was there and is gone. */
int folder_remove(const char *path);

bool file_exists(const char *path);

/* The test fails where one cannot be written or read. Without the sync of mote_file_write,
   which takes longer than a test may. */
void file_put(const char *path, const char *text);
void file_write(const char *path, const void *data, size_t size);

/* A file's text, of at most 64 MB; the caller frees it. The test fails where there is none. */
char *file_text(const char *path);

#endif
