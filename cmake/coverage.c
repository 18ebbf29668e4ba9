/* Where branches are counted (MoteCoverage.cmake): a process that ends by _exit, or becomes
   another program, keeps its counts as one that ends by exit does. The linker puts the
   functions below in the place of those that they are named after (--wrap). */
#define _GNU_SOURCE /* program_invocation_short_name */
#include "harness/process/confine.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

void __gcov_dump(void);
_Noreturn void __real__exit(int status);
int __real_execvp(const char *file, char *const argv[]);
bool __real_mote_confine(void);
_Noreturn void __wrap__exit(int status);
int __wrap_execvp(const char *file, char *const argv[]);
bool __wrap_mote_confine(void);

_Noreturn void __wrap__exit(int status)
{
    (void)close(
        STDERR_FILENO); /* gcov's words, where it may not write, are not the program's */
    __gcov_dump();
    __real__exit(status);
}

int __wrap_execvp(const char *file, char *const argv[])
{
    __gcov_dump();
    return __real_execvp(file, argv);
}

/* A confined process cannot keep counts: only the test of confinement is confined. */
bool __wrap_mote_confine(void)
{
    return strcmp(program_invocation_short_name, "test_child") == 0 && __real_mote_confine();
}
