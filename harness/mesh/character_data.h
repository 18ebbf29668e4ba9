/* The data of a character (character.h). */
#ifndef MOTE_HARNESS_CHARACTER_DATA_H
#define MOTE_HARNESS_CHARACTER_DATA_H

#include "harness/mesh/mesh_import.h"
#include "harness/mesh/rig.h"

/* What happened on the way from a file to a character. */
typedef struct mote_character_import {
    mote_import mesh;
    size_t meshes;     /* in the file; they became one body */
    size_t apart;      /* vertices not welded to another one at the same place because it moves
                          differently */
    double apart_most; /* largest difference of a bone's weight between two such vertices */
    double off;        /* largest abs(sum - 1) of a vertex's weights, as given */
    size_t given;      /* vertices in the file; many formats have one for each corner */
    size_t off_count;  /* vertices whose sums are off by more than 1e-4 */
    size_t unweighted; /* vertices without weights in meshes with bones: they follow the mesh's
                          node */
} mote_character_import;

/* X(type, name): arrays. Vertex i follows bones bone[start[i]] .. bone[start[i + 1] - 1] with
   these weights, which add up to 1; bones ascend. Its displacements by morph targets, before
   the bones, are shift[shift_start[i]] .. shift[shift_start[i + 1] - 1]; targets ascend. */
#define MOTE_CHARACTER_ARRAYS(X)                                                               \
    X(uint32_t, start)                                                                         \
    X(uint16_t, bone)                                                                          \
    X(double, weight)                                                                          \
    X(uint32_t, shift_start)                                                                   \
    X(uint32_t, target)                                                                        \
    X(mote_vec3, shift)

/* At rest, vertices are where the file's nodes, as stored, place them. */
typedef struct mote_character {
    mote_mesh *mesh;
    mote_rig rig;
    MOTE_CHARACTER_ARRAYS(MOTE_RIG_ARRAY)
    mote_vec3 scale; /* factors applied to mesh and shifts; 1, 1, 1 after the import */
} mote_character;

#endif
