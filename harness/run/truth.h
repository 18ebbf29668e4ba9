/* The truth: the exact distance of every frame of a scenario, from two independent sources,
   FCL's AABB trees and ours, checked by brute force, stored in a file and verified when
   read. */
#ifndef MOTE_HARNESS_TRUTH_H
#define MOTE_HARNESS_TRUTH_H

#include "harness/base/file.h"
#include "harness/scene/scenario.h"

typedef struct mote_truth {
    uint64_t fingerprint; /* of the scenario it belongs to */
    uint32_t frames;
    /* All [frames]; frame number k is at k - 1. */
    double *distance;     /* exact, >= 0; 0 where the surfaces touch or intersect */
    bool *contact;        /* distance <= scenario->tolerance */
    mote_vec3 *witness_a; /* points on body 0 and body 1 that realise the distance; NaN if FCL
                             gives */
    mote_vec3 *witness_b; /* none, as for intersecting surfaces */
    double *overruled;    /* FCL's distance, if our tree disagreed by more than 1e-12 L and the
                             tree with triangle distances in 113 bits decided; otherwise NaN */
    uint32_t checked; /* frames that brute force confirmed, to 1e-12 L: 24, or fewer for meshes
                         so large (above 35,000 triangles) that it takes too long */
} mote_truth;

/* Computes the exact distances of all frames in a child process (the caller's memory does not
   change), without any file. Each frame that had to be decided is named on stderr.
   MOTE_ENUMERIC, the text naming the frame, if brute force disagrees by more than 1e-12 L. The
   caller destroys *truth. */
mote_status mote_truth_compute(const mote_scenario *scenario, mote_truth **truth);

/* The file of a scenario's truth, DIR/truth/NAME-FINGERPRINT-FACES.csv. The caller frees it. */
char *mote_truth_path(const char *directory, const mote_scenario *scenario,
                      uint64_t fingerprint);

/* Reads this file if it exists, is complete and belongs to the scenario; otherwise computes and
 *writes it. MOTE_EIO if the file cannot be written. The caller destroys truth. */
mote_status mote_truth_load_or_compute(const mote_scenario *scenario, const char *directory,
                                       mote_truth **truth);

/* The same with a known fingerprint. */
mote_status mote_truth_load_or_compute_known(const mote_scenario *scenario,
                                             uint64_t fingerprint, const char *directory,
                                             mote_truth **truth);
void mote_truth_destroy(mote_truth *truth); /* NULL is allowed */

/* For truth_file.c: a truth of that many frames, all distances and witnesses NaN. */
mote_truth *mote_truth_allocate(uint32_t frames);
/* Sets contact from distance. */
void mote_truth_set_contacts(const mote_scenario *scenario, mote_truth *truth);

/* Reads or writes the file of a truth; reading gives MOTE_EINVAL for a file that is incomplete
   or belongs to another scenario or fingerprint, or to other faces. A file of an older version
   does not name its faces and is read as well. */
mote_status mote_truth_read(const mote_scenario *scenario, uint64_t fingerprint,
                            const char *path, mote_truth **truth);
mote_status mote_truth_write(const mote_scenario *scenario, const mote_truth *truth,
                             const char *path);

/* Adds a last line with a hash of the text, so that a truncated or edited file is rejected; and
   checks that line and cuts it off, false if the text is incomplete. */
void mote_truth_seal(mote_text *text);
bool mote_truth_unseal(char *text, size_t size);

#endif
