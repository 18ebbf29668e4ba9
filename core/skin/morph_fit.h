/* Bounds of morph targets, while a tree is built (skin_bounds.h). */
#ifndef MOTE_CORE_SKIN_MORPH_FIT_H
#define MOTE_CORE_SKIN_MORPH_FIT_H

#include "core/skin/skin_bounds.h"

typedef struct mote_morph_fitter mote_morph_fitter;

/* Sets *fitter to NULL for a skin without targets. Allocates tree->fixed. MOTE_ENOMEM. */
mote_status mote_morph_fit_start(mote_cert_tree *tree, mote_morph_fitter **fitter);

/* NULL is allowed. */
void mote_morph_fit_stop(mote_morph_fitter *fitter);

/* Fits the targets of one child of the block at hand. linear: false for slopes of 0. */
void mote_morph_fit(mote_morph_fitter *fitter, mote_cert_tree *tree, const mote_cert_part *part,
                    bool linear);

/* How many targets move the block at hand. */
uint32_t mote_morph_fit_count(const mote_morph_fitter *fitter);

/* Writes their rows and numbers, in ascending order, and forgets them for the next block. */
void mote_morph_fit_store(mote_morph_fitter *fitter, mote_cert_strip *strips, uint16_t *active);

#endif
