/* The steps from a file to a character; used only by the importer and its tests. */
#ifndef MOTE_HARNESS_CHARACTER_PARTS_H
#define MOTE_HARNESS_CHARACTER_PARTS_H

#include "harness/gltf/gltf_file.h"
#include "harness/mesh/character_data.h"
#include "harness/mesh/mesh_soup.h"

/* A character under construction: its triangles are in soup, and start, bone, weight,
   shift_start, target and shift refer to the soup's vertices. made.mesh is NULL.
   Zero-initialise. */
typedef struct mote_character_draft {
    mote_soup soup;
    mote_character made;
    mote_character_import import;
} mote_character_draft;

void mote_character_draft_free(mote_character_draft *draft);

/* Frees start, bone, weight, shift_start, target and shift. */
void mote_character_free_arrays(mote_character *character);

/* Replaces these arrays with those of another character, which loses them. */
void mote_character_set_arrays(mote_character *character, mote_character *from);

/* Reads meshes, nodes, bones, weights, morph targets and clips with assimp. Vertices are as
   many as in the file, weights as given. Call it in a child process with limits. */
mote_status mote_character_read_assimp(const char *path, mote_character_draft *draft);

/* A node, by its name as assimp gives it: for glTF 2, the node's number in the file. */
typedef struct mote_node_name {
    const char *name;
    uint32_t node;
} mote_node_name;

/* The first node with a name, or MOTE_RIG_NONE. names[count] are sorted. */
uint32_t mote_node_find(const mote_node_name *names, size_t count, const char *name);

/* Adds the clips of a file's animations to a rig whose nodes (as many as names) and targets are
   known. A step of mote_character_read_assimp. */
struct aiScene;
void mote_character_read_clips(const struct aiScene *scene, const mote_node_name *names,
                               mote_rig *rig);

/* Makes tracks of a rig step or cubic where a glTF file says so; assimp reads all of them as
   linear. Reads the weights of morph targets, of which assimp makes 0 where they are negative.
   nodes: the rig's number of each node of the file, or MOTE_RIG_NONE. MOTE_EINVAL: cubic keys
   or weights that cannot be read. */
mote_status mote_character_set_gltf_keys(mote_gltf *gltf, const uint32_t *nodes, mote_rig *rig);

/* Normalises weights to a sum of 1, welds vertices at one place that move alike, cuts edges of
   more than two faces apart, and records what was done. MOTE_EINVAL: a weight that is negative
   or not finite. */
mote_status mote_character_weld(const char *path, mote_character_draft *draft);

/* Sends a draft to the parent process, and reads it there. Received data is not trusted:
   MOTE_EIO if it is not a valid draft. No index in a draft that was read points outside its
   arrays. */
mote_status mote_character_send(int output, const mote_character_draft *draft);
mote_status mote_character_receive(const char *path, const char *data, size_t size,
                                   mote_character_draft *draft);

/* Checks a draft's rig and makes its mesh. *character takes over everything but the soup, which
   the caller frees. Errors of mote_character_check_rig and mote_mesh_create. */
mote_status mote_character_make(const char *path, const mote_character_draft *draft,
                                mote_character **character);

/* Checks for numbers that are not finite, decreasing times and rotations of zero length.
   MOTE_EINVAL, naming node, clip and key. */
mote_status mote_character_check_rig(const char *path, const mote_rig *rig);

#endif
