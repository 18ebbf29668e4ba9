/* The rights that a process gives up before it reads files of unknown origin. */
#ifndef MOTE_HARNESS_CONFINE_H
#define MOTE_HARNESS_CONFINE_H

#include <stdbool.h>

/* From now on this process and its children gain no rights by running a program, and no file
   grows by what they write (RLIMIT_FSIZE 0: pipes still work). Where the kernel has Landlock
   they also open no file for writing, and make, rename and remove none; true where it has. */
bool mote_confine(void);

#endif
