/* Certified queries over trees that many bodies share: one workspace for all pairs, what a pair
   keeps between its queries, and the bounds of a deformed body from the root of its tree.

   A workspace holds what a single query needs, and nothing that must survive it: between
   queries a pair keeps a mote_cert_memory (64 bytes), a body nothing. Answers do not depend on
   which workspace gave them, nor on what it was used for before. */
#ifndef MOTE_CORE_CERTIFICATE_SHARED_H
#define MOTE_CORE_CERTIFICATE_SHARED_H

#include "core/certificate/certificate.h"
#include "core/certificate/certificate_memory.h"
#include "core/certificate/certificate_tree.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Makes a workspace for queries of any two of count >= 1 trees, which are borrowed, were made
   with options->length, and have one scale. MOTE_ENOMEM. About 0.4 MB for meshes of 12,000
   triangles, at most 9 MB for any. */
mote_status mote_cert_workspace_create(mote_cert_tree *const *trees, uint32_t count,
                                       const mote_certificate_options *options,
                                       mote_certificate **workspace);

/* NULL is allowed. */
void mote_cert_workspace_destroy(mote_certificate *workspace);

/* Bytes of heap held, without the trees. */
size_t mote_cert_workspace_bytes(const mote_certificate *workspace);

/* Pairs of leaves of the last query whose faces were compared one by one: a great part of its
   time where there are any. */
uint64_t mote_certificate_compared(const mote_certificate *certificate);

/* Answers for two bodies whose trees are two of the workspace's (the same one twice is
   allowed), as mote_certificate_query does. No allocation. */
void mote_cert_workspace_query(mote_certificate *workspace, mote_cert_tree *const trees[2],
                               const mote_frame *frame, double enough, mote_cert_memory *memory,
                               mote_certificate_answer *answer);

/* A box in world axes that contains every vertex of a body as it is deformed and placed by
   state: around the boxes of the tree's root, so that no vertex is touched. Contains them as
   mote_body_position rounds them. No allocation; 0.2 us with 14 basis functions. */
void mote_cert_workspace_bounds(mote_certificate *workspace, mote_cert_tree *tree,
                                const mote_body_state *state, mote_vec3 *low, mote_vec3 *high);

#ifdef __cplusplus
}
#endif
#endif
