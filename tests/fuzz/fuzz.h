/* What every fuzz target (tests/fuzz/fuzz_*.c) defines: libFuzzer's entry point. Built with
   clang's fuzzer by the preset fuzz; everywhere else linked with fuzz_replay.c, which runs the
   corpus (tests/corpus/TARGET) through it once, as a test. */
#ifndef MOTE_TESTS_FUZZ_H
#define MOTE_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* No bytes may cause a crash, a leak or undefined behaviour. Always returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Returns the path of an in-memory file that holds the bytes; the next call reuses the file. */
const char *fuzz_file(const uint8_t *data, size_t size);

/* Splits the data at a line of "====" and writes the two parts to two files in a folder of its
   own; without such a line the second is empty. names: relative to that folder, at most one
   level down, the same at every call. Returns the folder's path; the folder is removed at
   exit. */
const char *fuzz_two_files(const uint8_t *data, size_t size, const char *const names[2]);

#endif
