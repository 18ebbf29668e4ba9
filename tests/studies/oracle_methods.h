/* Judges any method on frames of a scenario whose distances are known. */
#ifndef MOTE_TESTS_ORACLE_METHODS_H
#define MOTE_TESTS_ORACLE_METHODS_H

#include "harness/base/method_choice.h"
#include "harness/scene/scenario.h"

#include <jansson.h>
#include <stdbool.h>

#define ORACLE_METHODS_MAX 16

/* Methods to be judged. */
typedef struct oracle_methods {
    mote_method_choice choice[ORACLE_METHODS_MAX];
    size_t count;
    double seconds; /* that each may take for the frames of a scenario */
} oracle_methods;

/* What is known about frames 1, 1 + stride, ... of a scenario. */
typedef struct oracle_truth {
    mote_scenario *scenario;
    mote_frame_buffer *buffer;
    uint32_t stride, count;
    double *distance; /* [count]; 0 where the surfaces touch */
} oracle_truth;

/* An error that is not counted, over L. */
#define ORACLE_RIGHT 1e-12

/* Asks a method about all these frames, in a process of its own. *row: {"method", "frames",
   "distances_wrong" (off by more than ORACLE_RIGHT L, or not a number), "error_max" (over L;
   null without a distance), "contacts_missed", "contacts_invented", "failure" (why there are no
   answers, or null)}; the caller owns it. A method that gives no distance is asked for
   contacts. A contact is the one that the method tells, otherwise a distance of 0; frames of
   which the distance is above 0 and at most ORACLE_RIGHT L count as either. *right: it
   answered, and all that it said is right. An error means that no process could be created. */
mote_status oracle_method(const oracle_truth *truth, const mote_method_choice *choice,
                          double seconds, json_t **row, bool *right);

/* Prints a line for each of these rows. */
void oracle_methods_print(const char *scenario, const json_t *rows);

#endif
