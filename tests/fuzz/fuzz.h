/* What every fuzz target (tests/fuzz/fuzz_*.c) defines: libFuzzer's entry point. Built with
   clang's fuzzer by the preset fuzz; everywhere else linked with fuzz_replay.c, which runs the
   corpus (tests/corpus/TARGET) through it once, as a test. */
#ifndef MOTE_TESTS_FUZZ_H
#define MOTE_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* Any bytes must come through without a crash, a leak or undefined behaviour; always 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The path of an in-memory file that holds the bytes; the file is reused by the next call. */
const char *fuzz_file(const uint8_t *data, size_t size);

/* Writes what stands before and behind a line of "====" to two files of a folder of its own;
   the second is empty without such a line. names: in that folder or in one below it, the same
   at every call. The folder's path; it is removed at the end. */
const char *fuzz_two_files(const uint8_t *data, size_t size, const char *const names[2]);

#endif
