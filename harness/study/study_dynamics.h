/* The closed-loop study: how often do n particles let a body pass through another one? */
#ifndef MOTE_HARNESS_STUDY_DYNAMICS_H
#define MOTE_HARNESS_STUDY_DYNAMICS_H

#include "harness/study/dynamics.h"

/* Simulates random approaches, the same for every method of a scene (rows:
   harness/study/dynamics.h), and prints a table and the verdict on the paper's claim. Each row
   is stored in DIRECTORY/rows when it is done, so the study can be resumed; rows with another
   number of approaches and, without `keep`, rows of another build of the program are measured
   again. Writes DIRECTORY/dynamics.json, dynamics.csv and figures/. It runs `jobs` processes, 1
   .. 64, and shares the rows with other studies that write to the same directory. *met: no
   exact method let a body pass or was wrong about a contact, and momentum and energy were
   conserved in every simulation; failures are printed to stderr. The directory has a
   manifest. */
mote_status mote_study_dynamics(const char *directory, const mote_dynamics_size *size,
                                uint32_t jobs, uint64_t program, bool keep, bool *met);

#endif
