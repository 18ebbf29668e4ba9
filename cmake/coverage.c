/* Where branches are counted (MoteCoverage.cmake): a process that becomes another program keeps
   its counts as one that ends by exit does (see coverage_exit.c). */
#define _GNU_SOURCE /* program_invocation_short_name */
#include "harness/process/confine.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

void __gcov_dump(void);
int __real_execvp(const char *file, char *const argv[]);
bool __real_mote_confine(void);
int __wrap_execvp(const char *file, char *const argv[]);
bool __wrap_mote_confine(void);

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
