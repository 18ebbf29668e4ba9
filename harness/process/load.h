/* How busy and how fast the machine is. */
#ifndef MOTE_HARNESS_LOAD_H
#define MOTE_HARNESS_LOAD_H

/* The load average of the last minute; 0 when unknown. */
double mote_load_average(void);

/* The clock of a core (-1: any) in MHz; 0 where the kernel does not say. */
double mote_core_clock(int core);

/* How many cores other processes keep busy during the next tenth of a second, while this
   process sleeps; 0 when unknown. */
double mote_busy_cores(void);

#endif
