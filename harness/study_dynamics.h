/* The study of the closed loop: how often do n particles let a body pass through another one?
 */
#ifndef MOTE_HARNESS_STUDY_DYNAMICS_H
#define MOTE_HARNESS_STUDY_DYNAMICS_H

#include "core/status.h"

#include <stdbool.h>

/* Simulates random approaches for n = 1 .. 8 and 16 of the paper's particles, for the tracked
   ones, and for exact methods as control; prints a table and writes DIRECTORY/dynamics.json,
   the verdict on the paper's claim included. quick: 100 approaches instead of 1,000 (200 for
   other laws and scenes, which quick leaves out, and for FCL; quick: 20). The same approaches
   for every method of a scene. *met: no exact method let a body pass or missed a contact, and
   momentum and energy were kept in every simulation; failures are told on stderr. */
mote_status mote_study_dynamics(const char *directory, bool quick, bool *met);

#endif
