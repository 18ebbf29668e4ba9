/* The data of the page's replay of a run: its scenarios with meshes, poses and weights, from
   which the page computes the deformed surfaces itself, and the stored answers of each
   method. */
#ifndef MOTE_HARNESS_REPLAY_H
#define MOTE_HARNESS_REPLAY_H

#include "harness/base/file.h"
#include "harness/report/replay_keys.h"
#include "harness/report/report.h"

/* Packed bytes that all scenarios of a page may take, and that one may take. Each gets an
   equal share of what those before it have left; what does not fit is left out and named. */
#define MOTE_REPLAY_PAGE_BYTES 3100000u
#define MOTE_REPLAY_SCENARIO_BYTES 1500000u

/* Meshes above this are not replayed: indices have 16 bits. */
#define MOTE_REPLAY_VERTICES 65535u

/* Fields of other kinds than CSRBFs are written function by function and vertex by vertex; a
   body with more of these numbers is not replayed: they would not fit into a page. */
#define MOTE_REPLAY_BASIS 4000000u

/* The stored answers of one configuration: those of the replicate with the largest error, so
   that the worst frame shown is that of all replicates. */
typedef struct mote_replay_track {
    const mote_summary_row *row;  /* borrowed */
    const mote_stored_cell *cell; /* borrowed */
    size_t rows;                  /* answered frames: first + k * stride */
    double *distance;             /* [rows], MOTE_NONE without one */
    mote_vec3 *pair;              /* [2 * rows], the points of distance; x MOTE_NONE: none */
    size_t particles;             /* the most on a body; 0: not shown */
    mote_vec3 *place;             /* [rows * 2 * particles], by frame, then body; x MOTE_NONE:
                                     none */
} mote_replay_track;

/* A scenario with what is known of its frames. */
typedef struct mote_replay_scene {
    mote_scenario *scenario;
    uint32_t first, last; /* the frames that any track has */
    double *truth;        /* [last - first + 1] */
    mote_vec3 *pair;      /* [2 * (last - first + 1)] */
    mote_replay_track *tracks;
    size_t count;
    json_t *notes;            /* texts: what is not shown, and why */
    mote_replay_keys keys[2]; /* of bodies whose positions are given */
} mote_replay_scene;

/* Loads the scenario of rows first .. end - 1 of a report, all of one scenario with hot
   caches, and reads the answers of each. MOTE_EUNSUPPORTED, the text saying why, where it
   cannot be shown: the scenario's file is missing or has changed, a mesh or a field is too
   large, or a cell has a frame that the scenario does not have. The caller frees *scene. */
mote_status mote_replay_load(const mote_report *report, size_t first, size_t end,
                             mote_replay_scene *scene);
void mote_replay_free(mote_replay_scene *scene);

/* Reads the answers of a track from its CSV file: distance and pair. */
mote_status mote_replay_read_cell(const char *directory, mote_replay_track *track);

/* Runs the method of a track once more, untimed, to find where its particles are. Keeps them
   when its distances are the stored ones to the bit; else adds a note to scene->notes.
   Nothing for a method that has none to show. */
mote_status mote_replay_particles(mote_replay_scene *scene, mote_replay_track *track);

/* The scene as JSON: see plots/page/data.js, which reads it. What would exceed `budget`
   packed bytes is left out with a note; *used is how many it takes. MOTE_EUNSUPPORTED where
   not even the bodies fit. The caller decrefs *data. */
mote_status mote_replay_write(const mote_replay_scene *scene, size_t budget, json_t **data,
                              size_t *used);

/* Every scenario of the report that can be shown, {"scenes": [...], "notes": [...]}. The caller
   decrefs *data. */
mote_status mote_replay_json(const mote_report *report, json_t **data);

#endif
