#define _DEFAULT_SOURCE /* getloadavg */
#include "harness/process/load.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define WATCH_NS 100000000

double mote_load_average(void)
{
    double load = 0;
    return getloadavg(&load, 1) == 1 ? load : 0;
}

double mote_core_clock(int core)
{
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[512];
    double mhz = 0;
    for (int seen = -1; file && mhz <= 0 && fgets(line, sizeof line, file);) {
        seen += strncmp(line, "processor", 9) == 0 ? 1 : 0;
        if ((core < 0 || seen == core) && strncmp(line, "cpu MHz", 7) == 0)
            mhz = strtod(line + strcspn(line, "0123456789"), NULL);
    }
    if (file)
        (void)fclose(file);
    return mhz;
}

/* Clock ticks since boot, summed over all cores: idle (or waiting for disks), and all. */
static bool read_ticks(double *idle, double *all)
{
    /* user, nice, system, idle, iowait, irq, softirq, steal; guests are in user already. */
    enum { TIMES = 8, IDLE = 3, WAIT = 4 };
    char line[512] = "";
    FILE *file = fopen("/proc/stat", "r");
    const bool there = file && fgets(line, sizeof line, file);
    if (file)
        (void)fclose(file);
    char *next = line + strcspn(line, " ");
    *idle = *all = 0;
    for (int k = 0; k < TIMES; ++k) {
        const double ticks = strtod(next, &next); /* 0 where the kernel has fewer */
        *idle += k == IDLE || k == WAIT ? ticks : 0;
        *all += ticks;
    }
    return there && *all > 0;
}

double mote_busy_cores(void)
{
    const struct timespec pause = {0, WATCH_NS};
    double idle[2], all[2];
    bool known = read_ticks(&idle[0], &all[0]);
    (void)nanosleep(&pause, NULL);
    known = known && read_ticks(&idle[1], &all[1]) && all[1] > all[0];
    if (!known)
        return 0;
    double share = 1 - (idle[1] - idle[0]) / (all[1] - all[0]);
    return share > 0 ? share * (double)sysconf(_SC_NPROCESSORS_ONLN) : 0;
}
