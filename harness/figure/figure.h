/* The functions that write the data of each figure, and what they share; used by figures.c. */
#ifndef MOTE_HARNESS_FIGURE_H
#define MOTE_HARNESS_FIGURE_H

#include "harness/process/gnuplot.h"
#include "harness/summary/summary.h"

/* The run that figures are made from. */
typedef struct mote_figure_run {
    const char *directory;
    const mote_summary *summary; /* without rows where the run has no cell */
    const json_t *claims;        /* claims.json, or NULL */
} mote_figure_run;

/* The result of such a function. data is for gnuplot: columns separated by blanks, text in
   quotes, blocks two empty lines apart, each below its title. It stays empty where the run
   lacks what the figure needs; missing then says what that is. */
typedef struct mote_figure {
    mote_text data;
    mote_text caption; /* a paragraph: what is shown, and how certain it is */
    mote_text missing; /* also set for a figure that is drawn in part */
} mote_figure;

/* Fills a zeroed figure; the caller frees its texts. scenario is one of the run's, or NULL
   for a figure of the whole run. An error status means a failure of the program or the
   machine, not that the run lacks something. */
typedef mote_status mote_figure_writer(const mote_figure_run *run, const char *scenario,
                                       mote_figure *figure);

mote_figure_writer mote_figure_particles;   /* 1: two letters T and their particles */
mote_figure_writer mote_figure_deformed;    /* 2: four frames of M and V */
mote_figure_writer mote_figure_queries;     /* 3: time of each query */
mote_figure_writer mote_figure_front;       /* 4: speed against error */
mote_figure_writer mote_figure_errors;      /* 5: error over the number of particles */
mote_figure_writer mote_figure_size_time;   /* 6: time over triangles */
mote_figure_writer mote_figure_size_bytes;  /* 7: memory over triangles */
mote_figure_writer mote_figure_shares;      /* 8: deform, update, query */
mote_figure_writer mote_figure_ratios;      /* 9: against the best FCL */
mote_figure_writer mote_figure_extremes;    /* 10: methods on numerical extremes */
mote_figure_writer mote_figure_claims;      /* 11: the claims table */
mote_figure_writer mote_figure_history;     /* 12: distance and error over frames */
mote_figure_writer mote_figure_ingredients; /* 13: what each part of tracked particles adds */
mote_figure_writer mote_figure_tracked;     /* 14: tracked particles over their parameters */
mote_figure_writer mote_figure_bodies;      /* 15: several bodies: a step's time over N */

/* 15, moving: 100 letters in a box, as mote_figure_animation is of two. */
mote_figure_writer mote_figure_letters;

/* 2, moving: every few frames of the whole scenario. Writes the frames' geometry to
   DIRECTORY/figures/frames, 20 MB that mote_figure_animation_clear deletes after drawing; the
   data is a line a frame with the geometry's hash. */
mote_figure_writer mote_figure_animation;
void mote_figure_animation_clear(const char *directory);

/* The folder of an animation's pictures; a picture, numbered from 0, with its hash. text is
   taken over. */
mote_status mote_figure_frames_begin(const mote_figure_run *run);
mote_status mote_figure_frame_write(const mote_figure_run *run, unsigned number,
                                    mote_text *text, uint64_t *hash);

/* Whether a row is shown in figures of its scenario: its cells ran alone and with hot caches,
   on the same frames, scene and machine as that row of the scenario which was asked for the
   most frames (of several, the first). */
bool mote_figure_shows(const mote_summary *summary, const mote_summary_row *row,
                       const char *scenario);

/* The shown row with this label; NULL when there is none. */
const mote_summary_row *mote_figure_row(const mote_summary *summary, const char *scenario,
                                        const char *label);

/* Room for a family: a row's label without its n (mote_front_title). */
#define MOTE_FIGURE_FAMILY 256

/* The shown row of a family whose n is nearest to n, or that has no n; NULL: no such family. */
const mote_summary_row *mote_figure_near(const mote_summary *summary, const char *scenario,
                                         const char *family, double n);

/* Whether this is the first shown row of its family. */
bool mote_figure_first(const mote_summary *summary, const mote_summary_row *row,
                       const char *scenario);

/* A frame's times. */
typedef enum mote_figure_part {
    MOTE_FIGURE_TOTAL,
    MOTE_FIGURE_DEFORM,
    MOTE_FIGURE_UPDATE,
    MOTE_FIGURE_QUERY
} mote_figure_part;

/* Nanoseconds of each frame of row->first, the median over replicates, into values[frames of
   row->first]. */
void mote_figure_frames(const mote_summary_row *row, mote_figure_part part, double *values);

/* Appends "median low high", a time and its 95 % interval over nanoseconds; without an
   interval the median stands for its ends. */
void mote_figure_time(const mote_time *time, double over, mote_text *text);

/* Whether a row has distances, and so an error. */
bool mote_figure_has_error(const mote_summary_row *row);

/* Appends "value low high ": a quantile of the absolute error over all replicates, and its
   95 % t interval over replicates, widened to contain the value and cut off at 0; the value
   itself where there are too few replicates. */
void mote_figure_quantile(const mote_summary_row *row, double fraction, double value,
                          mote_text *text);

/* L of the pair of a stored cell; 1 where the file has none. */
double mote_figure_length(const mote_summary_row *row);

/* The triangles of the larger body. */
double mote_figure_triangles(const mote_summary_row *row);

#endif
