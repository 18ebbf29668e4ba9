/* Shared by the sources that make and evaluate skins. */
#ifndef MOTE_CORE_SKIN_KINDS_H
#define MOTE_CORE_SKIN_KINDS_H

#include "core/skin/skin_data.h"

extern const mote_field_kind mote_skin_kind;  /* without morph targets */
extern const mote_field_kind mote_morph_kind; /* with them */

/* Frees a skin and its arrays, of which some may not have been made. NULL is allowed. */
void mote_skin_free(mote_skin *skin);

/* morph.c: MOTE_EINVAL, naming the target, for targets that cannot be used. */
mote_status mote_morph_check(const mote_mesh *mesh, const mote_morph_targets *targets);

/* Orders checked targets by vertex. MOTE_EINVAL where one names a vertex twice; MOTE_ENOMEM.
   What has been allocated by then is the caller's to free. */
mote_status mote_morph_fill(const mote_mesh *mesh, const mote_morph_targets *targets,
                            mote_morph *morph);

#endif
