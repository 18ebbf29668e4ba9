/* A method chosen by its name and parameters, as written on a command line. */
#ifndef MOTE_HARNESS_METHOD_CHOICE_H
#define MOTE_HARNESS_METHOD_CHOICE_H

#include "core/method/method.h"

/* A method and its parameters, as named on the command line. */
typedef struct mote_method_choice {
    const mote_method *method;
    double values[MOTE_PARAMETERS_MAX];
    char text[256]; /* as given: "particle:n=5" */
} mote_method_choice;

/* Reads "NAME" or "NAME:key=value,key=value". MOTE_EINVAL with a text that lists what would be
   right: an unknown method, or a parameter that mote_parameters_parse refuses. */
mote_status mote_method_choice_read(const char *text, mote_method_choice *choice);

#endif
