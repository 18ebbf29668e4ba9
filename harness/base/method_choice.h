/* A method chosen by its name and parameters, as written on a command line. */
#ifndef MOTE_HARNESS_METHOD_CHOICE_H
#define MOTE_HARNESS_METHOD_CHOICE_H

#include "core/method/method.h"

/* The keys that every method has when it is asked about more than two bodies, beside its own.
 */
enum {
    MOTE_SCENE_REFIT,   /* of hierarchies: MOTE_REFIT_NEAR or MOTE_REFIT_EVERY */
    MOTE_SCENE_THREADS, /* that pairs are shared out to */
    MOTE_SCENE_AHEAD,   /* frames that a thread of its own moves and deforms ahead; 0: none */
    MOTE_SCENE_KEYS
};

extern const mote_parameter mote_scene_parameters[MOTE_SCENE_KEYS];

/* Which bodies a hierarchy is refitted for. */
enum {
    MOTE_REFIT_NEAR, /* those in a near pair, by the bounds of deformed roots */
    MOTE_REFIT_EVERY /* every body in every frame: near pairs by the roots of the trees */
};

/* A method and its parameters, as named on the command line. */
typedef struct mote_method_choice {
    const mote_method *method;
    double values[MOTE_PARAMETERS_MAX];
    double scene[MOTE_SCENE_KEYS]; /* by mote_scene_parameters */
    bool gives[MOTE_SCENE_KEYS];   /* whether the text gives the key */
    char text[256];                /* as given: "particle:n=5" */
} mote_method_choice;

/* Reads "NAME" or "NAME:key=value,key=value". MOTE_EINVAL with a text that lists what would be
   right: an unknown method, or a parameter that mote_parameters_parse refuses. */
mote_status mote_method_choice_read(const char *text, mote_method_choice *choice);

/* The same, the keys of mote_scene_parameters being allowed as well. */
mote_status mote_scene_choice_read(const char *text, mote_method_choice *choice);

/* Whether a choice gives any key of mote_scene_parameters: it is then for more than two bodies
   only. */
bool mote_method_choice_is_of_scenes(const mote_method_choice *choice);

#endif
