/* What a character is made of (character.h). */
#ifndef MOTE_HARNESS_CHARACTER_DATA_H
#define MOTE_HARNESS_CHARACTER_DATA_H

#include "harness/mesh/mesh_import.h"
#include "harness/mesh/rig.h"

/* What happened on the way from a file to a character. */
typedef struct mote_character_import {
    mote_import mesh;
    size_t meshes;     /* of the file, which became one body */
    size_t apart;      /* vertices kept apart from another one at their place, which moves
                          differently */
    double apart_most; /* the largest difference of a bone's weight between two such vertices */
    double off;        /* the largest abs(sum - 1) of the weights of a vertex, as given */
    size_t given;      /* vertices of the file, where many formats name one for each corner */
    size_t off_count;  /* of these, those with sums off by more than 1e-4 */
    size_t unweighted; /* of these, those of meshes with bones that have none: they follow the
                          mesh's node */
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

/* At rest vertices are where the file's nodes place them as they are stored. */
typedef struct mote_character {
    mote_mesh *mesh;
    mote_rig rig;
    MOTE_CHARACTER_ARRAYS(MOTE_RIG_ARRAY)
    mote_vec3 scale; /* that mesh and shifts were multiplied by; 1, 1, 1 after the import */
} mote_character;

#endif
