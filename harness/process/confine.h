/* The rights a process gives up before it reads files of unknown origin. */
#ifndef MOTE_HARNESS_CONFINE_H
#define MOTE_HARNESS_CONFINE_H

#include <stdbool.h>

/* From now on this process and its children gain no rights by running a program, and their
   writes cannot make a file grow (RLIMIT_FSIZE 0; pipes still work). If the kernel has
   Landlock, they also cannot open a file for writing, nor make, rename or remove one; returns
   whether it has. */
bool mote_confine(void);

#endif
