/* Contacts of more than two bodies. Their truth is not computed, so a method's contacts are
   compared with those of the best exact method measured in the same run. */
#ifndef MOTE_HARNESS_SCENE_CONTACTS_H
#define MOTE_HARNESS_SCENE_CONTACTS_H

#include "harness/summary/summary_row.h"

/* Two bodies in contact in a frame. */
typedef struct mote_scene_contact {
    uint32_t frame, body[2];
} mote_scene_contact;

/* The contacts of a cell, ascending. */
typedef struct mote_scene_contacts {
    mote_scene_contact *list; /* [count] */
    size_t count;
} mote_scene_contacts;

/* Reads the contacts of a cell, directory/cells/ID.pairs.csv. MOTE_EINVAL with file and line if
   mote did not write it. The caller frees contacts->list, even after an error. */
mote_status mote_scene_contacts_read(const char *directory, const mote_stored_cell *cell,
                                     mote_scene_contacts *contacts);

/* How many contacts of `of`, in frames up to `last`, are missing from `in`. */
size_t mote_scene_contacts_lacking(const mote_scene_contacts *of, const mote_scene_contacts *in,
                                   uint32_t last);

/* Sets near_pairs, contacts, contacts_of, missed and false_contacts of the rows of more than
   two bodies. The first of these on the same frames is the reference: fcl-aabb with every body
   refitted, fcl-aabb, aabb-tree, certified; only frames that both measured count. MOTE_EINVAL
   with file and line for a cells/ID.pairs.csv that mote did not write. Part of
   mote_summary_make. */
mote_status mote_scene_contacts_count(const char *directory, mote_summary_row *rows,
                                      size_t count);

#endif
