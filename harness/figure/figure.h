/* The functions that write the data of each figure, and what they share; used by figures.c. */
#ifndef MOTE_HARNESS_FIGURE_H
#define MOTE_HARNESS_FIGURE_H

#include "harness/process/gnuplot.h"
#include "harness/summary/summary.h"

/* The run that the figures show. */
typedef struct mote_figure_run {
    const char *directory;
    const mote_summary *summary; /* without rows if the run has no cell */
    const json_t *claims;        /* claims.json, or NULL */
} mote_figure_run;

/* A writer's result. data is for gnuplot: columns separated by blanks, text in quotes, blocks
   separated by two empty lines, each with a title. It is empty if the run lacks what the figure
   needs; missing then says what that is. */
typedef struct mote_figure {
    mote_text data;
    mote_text caption; /* a paragraph: what is shown, and its uncertainty */
    mote_text missing; /* also set for an incomplete figure */
} mote_figure;

/* Fills a zeroed figure; the caller frees its texts. scenario is one of the run's, or NULL for
   a figure of the whole run. An error status is a failure of the program or the machine;
   missing data is not an error. */
typedef mote_status mote_figure_writer(const mote_figure_run *run, const char *scenario,
                                       mote_figure *figure);

mote_figure_writer mote_figure_particles;   /* 1: two letters T and their particles */
mote_figure_writer mote_figure_deformed;    /* 2: four frames of M and V */
mote_figure_writer mote_figure_queries;     /* 3: time of each query */
mote_figure_writer mote_figure_front;       /* 4: speed against error */
mote_figure_writer mote_figure_errors;      /* 5: error over the number of particles */
mote_figure_writer mote_figure_size_time;   /* 5: error over n */
mote_figure_writer mote_figure_size_bytes;  /* 7: memory over triangles */
mote_figure_writer mote_figure_shares;      /* 8: deform, update, query */
mote_figure_writer mote_figure_ratios;      /* 9: against the best engine */
mote_figure_writer mote_figure_extremes;    /* 10: methods on numerical extremes */
mote_figure_writer mote_figure_claims;      /* 11: the claims table */
mote_figure_writer mote_figure_history;     /* 12: distance and error over frames */
mote_figure_writer mote_figure_ingredients; /* 13: what each part of tracked particles adds */
mote_figure_writer mote_figure_tracked;     /* 14: tracked particles over their parameters */
mote_figure_writer mote_figure_bodies;      /* 15: several bodies: a step's time over N */

/* 15, animated: 100 letters in a box, like mote_figure_animation for two bodies. */
mote_figure_writer mote_figure_letters;

/* 2, animated: every few frames of the whole scenario. Writes the frames' geometry to
   DIRECTORY/figures/frames (20 MB, deleted after drawing by mote_figure_animation_clear); data
   has a line per frame with the geometry's hash. */
mote_figure_writer mote_figure_animation;
void mote_figure_animation_clear(const char *directory);

/* Make the folder of an animation's pictures; write a picture, numbered from 0, and return its
   hash. text is taken over. */
mote_status mote_figure_frames_begin(const mote_figure_run *run);
mote_status mote_figure_frame_write(const mote_figure_run *run, unsigned number,
                                    mote_text *text, uint64_t *hash);

/* Whether a row is shown in figures of its scenario: its cells ran alone and with hot caches,
   on the same frames, scene and machine as the scenario's row with the most frames requested
   (the first of several). */
bool mote_figure_shows(const mote_summary *summary, const mote_summary_row *row,
                       const char *scenario);

/* The shown row with this label, or NULL. */
const mote_summary_row *mote_figure_row(const mote_summary *summary, const char *scenario,
                                        const char *label);

/* Size of a family's name: a row's label without its n (mote_front_title). */
#define MOTE_FIGURE_FAMILY 256

/* The shown row of a family whose n is nearest to n, or that has no n; NULL if there is no such
   family. */
const mote_summary_row *mote_figure_near(const mote_summary *summary, const char *scenario,
                                         const char *family, double n);

/* Whether this is the first shown row of its family. */
bool mote_figure_first(const mote_summary *summary, const mote_summary_row *row,
                       const char *scenario);

/* The parts of a frame's time. */
typedef enum mote_figure_part {
    MOTE_FIGURE_TOTAL,
    MOTE_FIGURE_DEFORM,
    MOTE_FIGURE_UPDATE,
    MOTE_FIGURE_QUERY
} mote_figure_part;

/* Nanoseconds of each frame of row->first, the median over replicates, into values[frames of
   row->first]. */
void mote_figure_frames(const mote_summary_row *row, mote_figure_part part, double *values);

/* Appends "median low high", a time and its 95 % interval in units of `over` nanoseconds;
   without an interval, the median replaces its ends. */
void mote_figure_time(const mote_time *time, double over, mote_text *text);

/* Whether a row has distances, and therefore an error. */
bool mote_figure_has_error(const mote_summary_row *row);

/* Appends "value low high ": a quantile of the absolute error over all replicates, and its 95 %
   t interval over replicates, widened to contain the value and cut at 0; the value itself if
   there are too few replicates. */
void mote_figure_quantile(const mote_summary_row *row, double fraction, double value,
                          mote_text *text);

/* L of the pair of a stored cell; 1 if the file has none. */
double mote_figure_length(const mote_summary_row *row);

/* The number of triangles of the larger body. */
double mote_figure_triangles(const mote_summary_row *row);

#endif
