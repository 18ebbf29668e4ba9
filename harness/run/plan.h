/* The plan of a run: which cells, in which order. */
#ifndef MOTE_HARNESS_PLAN_H
#define MOTE_HARNESS_PLAN_H

#include "harness/run/cell.h"

/* A growing list of configurations. Zero-initialise; free with mote_choices_free. */
typedef struct mote_choices {
    mote_method_choice *items;
    size_t count, capacity;
} mote_choices;

/* The largest number of configurations and of cells in one run. */
#define MOTE_CHOICES_MAX 10000

/* Adds every configuration that text describes: "NAME:key=a|b,key=c" gives one for each value
   of a list; keys of mote_scene_parameters are allowed. With particles ("1,2,4-8", or NULL), a
   method that has a parameter n not set in its text is added once for each number.
   Configurations already in the list are not added again. MOTE_EINVAL with a text for an
   unknown method or key, a bad value, a bad list. */
mote_status mote_choices_add(mote_choices *choices, const char *text, const char *particles);

/* Checks a list of numbers of particles, or NULL, whether or not a method takes it. MOTE_EINVAL
   with the text. */
mote_status mote_particles_check(const char *particles);
void mote_choices_free(mote_choices *choices);

#define MOTE_REPLICATES_MAX 1000

/* The largest number of steps of questions about impacts in one run. */
#define MOTE_STEPS_MAX 32

typedef struct mote_plan_options {
    uint32_t replicates;  /* 1 .. MOTE_REPLICATES_MAX */
    uint32_t first, last; /* frames; 0, 0: all of each scenario */
    uint32_t stride;      /* MOTE_STRIDE_AUTO or >= 1; methods with state run every frame */
    uint32_t steps[MOTE_STEPS_MAX];     /* [step_count], ascending: scenarios of two bodies are
                                           asked for impacts, once with each step */
    const mote_choices *impact_choices; /* for scenarios that ask for impacts; NULL: those of
                                           all of two bodies */
    uint32_t step_count;                /* 0: what the scenarios ask, with their own step */
    uint64_t seed;
    bool fixed_seed; /* all replicates have the same seed, so they differ only through the
                        machine */
    mote_cache cache;
    uint32_t jobs;      /* cells at a time, at most MOTE_CHILDREN_MAX; 0 means 1 */
    double budget;      /* for cells of more than two bodies: see mote_cell */
    bool contacts_only; /* the same */
    uint64_t program;   /* mote_program_hash */
} mote_plan_options;

typedef struct mote_plan {
    mote_cell *cells;
    size_t count;
} mote_plan;

/* Replicates are outermost, then scenarios, then configurations in an order rotated by the
   replicate, so no method always runs first or after the same one. choices are for scenarios of
   two bodies, scene_choices for those of more. MOTE_EINVAL if the frames lie outside a
   scenario, or do not hold a step. The cells borrow subjects and choices. cell->stride is 1
   until it is known. The caller frees plan->cells. */
mote_status mote_plan_make(const mote_plan_options *options, const mote_subject *subjects,
                           size_t subject_count, const mote_choices *choices,
                           const mote_choices *scene_choices, mote_plan *plan);

/* Whether a cell is measured in every frame whatever stride is asked for: its method, or the
   pairs of its many bodies, keep state from frame to frame. Questions about impacts begin where
   they are told to. */
bool mote_cell_needs_every_frame(const mote_cell *cell);

/* Adds the names of what a stride that was asked for does not hold for, "certified, all methods
   on crowd"; nothing if there is nothing, or none was asked for. */
void mote_plan_unstrided(const mote_plan *plan, mote_text *names);

#endif
