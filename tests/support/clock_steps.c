/* Preloaded (LD_PRELOAD) by test_clock: every reading of the wall clock is off by years,
   forwards or backwards. A program that uses a steady clock is not affected. */
#define _DEFAULT_SOURCE /* syscall */
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#define YEAR 31556952L

__attribute__((visibility("default"))) int clock_gettime(clockid_t clock, struct timespec *now);
__attribute__((visibility("default"))) time_t time(time_t *now);
__attribute__((visibility("default"))) int gettimeofday(struct timeval *restrict now,
                                                        void *restrict zone);

/* 20 years ahead, 30 behind, 1 ahead, in turn. */
static time_t step(void)
{
    static _Atomic unsigned readings;
    static const long years[] = {20, -30, 1};
    return years[readings++ % 3] * YEAR;
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    const int status = (int)syscall(SYS_clock_gettime, clock, now);
    if (status == 0 && clock == CLOCK_REALTIME)
        now->tv_sec += step();
    return status;
}

time_t time(time_t *now)
{
    struct timespec read = {0};
    (void)clock_gettime(CLOCK_REALTIME, &read);
    if (now)
        *now = read.tv_sec;
    return read.tv_sec;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone)
{
    (void)zone;
    struct timespec read;
    if (clock_gettime(CLOCK_REALTIME, &read) != 0)
        return -1;
    *now = (struct timeval){.tv_sec = read.tv_sec, .tv_usec = read.tv_nsec / 1000};
    return 0;
}
