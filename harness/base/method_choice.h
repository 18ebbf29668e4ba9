/* A method chosen by its name and parameters, as written on a command line. */
#ifndef MOTE_HARNESS_METHOD_CHOICE_H
#define MOTE_HARNESS_METHOD_CHOICE_H

#include "core/method/method.h"

/* The keys that every method accepts, beside its own, for scenes of more than two bodies. */
enum {
    MOTE_SCENE_REFIT,   /* for hierarchies: MOTE_REFIT_NEAR or MOTE_REFIT_EVERY */
    MOTE_SCENE_THREADS, /* threads that share the pairs */
    MOTE_SCENE_AHEAD,   /* frames that a separate thread moves and deforms ahead; 0: none */
    MOTE_SCENE_KEYS
};

extern const mote_parameter mote_scene_parameters[MOTE_SCENE_KEYS];

/* Which bodies a hierarchy is refitted for. */
enum {
    MOTE_REFIT_NEAR, /* the bodies of near pairs, found by the bounds of deformed roots */
    MOTE_REFIT_EVERY /* every body in every frame; near pairs are found by the roots of the
                        trees */
};

/* A method and its parameters, as named on the command line. */
typedef struct mote_method_choice {
    const mote_method *method;
    double values[MOTE_PARAMETERS_MAX];
    double scene[MOTE_SCENE_KEYS]; /* in the order of mote_scene_parameters */
    bool gives[MOTE_SCENE_KEYS];   /* whether the text gives the key */
    char text[256];                /* as given: "particle:n=5" */
} mote_method_choice;

/* Reads "NAME" or "NAME:key=value,key=value". MOTE_EINVAL for an unknown method or a parameter
   that mote_parameters_parse refuses, with a text that lists the valid ones. */
mote_status mote_method_choice_read(const char *text, mote_method_choice *choice);

/* The same, but also accepts the keys of mote_scene_parameters. */
mote_status mote_scene_choice_read(const char *text, mote_method_choice *choice);

/* Whether a choice gives any key of mote_scene_parameters: it is then valid only for more than
   two bodies. */
bool mote_method_choice_is_of_scenes(const mote_method_choice *choice);

#endif
