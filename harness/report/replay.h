/* The data of the page's replay of a run: its scenarios with meshes, poses and weights, from
   which the page computes the deformed surfaces, and the stored answers of each method. */
#ifndef MOTE_HARNESS_REPLAY_H
#define MOTE_HARNESS_REPLAY_H

#include "harness/base/file.h"
#include "harness/report/replay_keys.h"
#include "harness/report/report.h"

/* The largest packed size of all scenarios of a page, and of one scenario. Each gets an equal
   share of what earlier ones have left; what does not fit is left out and reported. */
#define MOTE_REPLAY_PAGE_BYTES 3100000u
#define MOTE_REPLAY_SCENARIO_BYTES 1500000u

/* Larger meshes are not replayed: indices have 16 bits. */
#define MOTE_REPLAY_VERTICES 65535u

/* Fields that are not CSRBFs are written function by function and vertex by vertex; a body with
   more numbers than this is not replayed, because they would not fit into a page. */
#define MOTE_REPLAY_BASIS 4000000u

/* The stored answers of one configuration: those of the replicate with the largest error, so
   the worst frame shown is the worst of all replicates. */
typedef struct mote_replay_track {
    const mote_summary_row *row;  /* borrowed */
    const mote_stored_cell *cell; /* borrowed */
    size_t rows;                  /* answered frames: first + k * stride */
    double *distance;             /* [rows]; MOTE_NONE: none */
    mote_vec3 *pair;              /* [2 * rows], the closest points; x MOTE_NONE: none */
    size_t particles;             /* largest number on a body; 0: not shown */
    mote_vec3 *place;             /* [rows * 2 * particles], by frame, then body; x MOTE_NONE:
                                     none */
} mote_replay_track;

/* A scenario with the data of its frames. */
typedef struct mote_replay_scene {
    mote_scenario *scenario;
    uint32_t first, last; /* the frames that any track has */
    double *truth;        /* [last - first + 1] */
    mote_vec3 *pair;      /* [2 * (last - first + 1)] */
    mote_replay_track *tracks;
    size_t count;
    json_t *notes;            /* texts: what is not shown, and why */
    mote_replay_keys keys[2]; /* for bodies with given positions */
} mote_replay_scene;

/* Loads the scenario of rows first .. end - 1 of a report, all of one scenario with hot caches,
   and reads the answers of each. MOTE_EUNSUPPORTED with the reason if it cannot be shown: it
   asks for impacts, the scenario's file is missing or has changed, a mesh or a field is too
   large, or a cell has a frame that the scenario lacks. The caller frees *scene. */
mote_status mote_replay_load(const mote_report *report, size_t first, size_t end,
                             mote_replay_scene *scene);
void mote_replay_free(mote_replay_scene *scene);

/* Reads the answers of a track from its CSV file: distance and pair. */
mote_status mote_replay_read_cell(const char *directory, mote_replay_track *track);

/* Runs the method of a track again, untimed, to find the positions of its particles. Stores
   them if its distances equal the stored ones bit for bit; otherwise adds a note to
   scene->notes. Does nothing for a method without particles. */
mote_status mote_replay_particles(mote_replay_scene *scene, mote_replay_track *track);

/* The scene as JSON, read by plots/page/data.js. Data beyond `budget` packed bytes are left out
   with a note; *used is the number of bytes. MOTE_EUNSUPPORTED if not even the bodies fit. The
   caller decrefs *data. */
mote_status mote_replay_write(const mote_replay_scene *scene, size_t budget, json_t **data,
                              size_t *used);

/* Every scenario of the report that can be shown, {"scenes": [...], "notes": [...]}. The caller
   decrefs *data. */
mote_status mote_replay_json(const mote_report *report, json_t **data);

#endif
