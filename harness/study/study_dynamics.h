/* The study of the closed loop: how often do n particles let a body pass through another one?
 */
#ifndef MOTE_HARNESS_STUDY_DYNAMICS_H
#define MOTE_HARNESS_STUDY_DYNAMICS_H

#include "harness/study/dynamics.h"

/* Simulates random approaches, the same for every method of a scene
   (harness/study/dynamics.h: which rows there are), prints a table and the verdict on the
   paper's claim, and writes DIRECTORY/dynamics.json, dynamics.csv and figures/. Each row is
   kept in DIRECTORY/rows when it is done: the study goes on where it stopped, rows of
   another number of approaches, and without `keep` those of another build of the program,
   being measured again. It runs `jobs` processes, 1 .. 64, and other studies that write the
   same directory share the rows. *met: no exact method let a body pass or was wrong about a
   contact, and momentum and energy were conserved in every simulation; failures are printed
   to stderr. The directory has its manifest. */
mote_status mote_study_dynamics(const char *directory, const mote_dynamics_size *size,
                                uint32_t jobs, uint64_t program, bool keep, bool *met);

#endif
