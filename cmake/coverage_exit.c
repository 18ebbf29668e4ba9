/* Where branches are counted (MoteCoverage.cmake): a process that ends by _exit keeps its
   counts as one that ends by exit does. The linker puts __wrap__exit in the place of _exit
   (--wrap). */
#include <sys/resource.h>
#include <unistd.h>

void __gcov_dump(void);
_Noreturn void __real__exit(int status);
_Noreturn void __wrap__exit(int status);

/* A test may limit the size of files; counts cut short would spoil those of all others. */
__attribute__((destructor)) static void lift_limit(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0) {
        limit.rlim_cur = limit.rlim_max;
        (void)setrlimit(RLIMIT_FSIZE, &limit);
    }
}

_Noreturn void __wrap__exit(int status)
{
    lift_limit();
    (void)close(
        STDERR_FILENO); /* gcov's words, where it may not write, are not the program's */
    __gcov_dump();
    __real__exit(status);
}
