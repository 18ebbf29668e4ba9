/* Readers of the parts of a scenario file; used by the loader only. */
#ifndef MOTE_HARNESS_SCENARIO_READ_H
#define MOTE_HARNESS_SCENARIO_READ_H

#include "harness/base/json_read.h"
#include "harness/scene/motion.h"
#include "harness/scene/scenario.h"

/* The largest number of frames in a scenario. */
#define MOTE_FRAMES_MAX 1000000

/* The largest number of controls of a body. */
#define MOTE_CONTROLS_MAX 256

/* Merges the file's root into the scenario that its "like" names, if it has that key. */
mote_status mote_scenario_merge_like(mote_json_file *file);

/* Opens a built-in scenario by name or a file by path, merged with the scenario it is "like",
   or makes a pair's. mote_scenario.path opens the same scenario again. MOTE_EIO, with the names
   that exist, for an unknown name. Close with mote_json_close. */
mote_status mote_scenario_open(const char *name_or_path, mote_json_file *file);

/* Whether a file's root describes several bodies (harness/scene/bodies.h). */
bool mote_scenario_of_bodies(const mote_json_file *file);

/* Reads "frames", "warmup", "active", "ask", "step", "tolerance", "start", "pace" and "purpose"
   into a scenario with a motion; tolerance is in L. */
mote_status mote_scenario_read_facts(const mote_json *root, mote_scenario *scenario);

/* The scenario name from a file's path: without folder, ".json" and control characters. */
char *mote_scenario_name_of(const char *path);

/* Replaces control characters, which would break a line of a table or of a message. */
void mote_scenario_clean_name(char *name);

/* Makes a scenario from a file's root; its name comes from the file's path. */
mote_status mote_scenario_read(const mote_json_file *file, mote_scenario **scenario);

/* Whether a name is "pair:FILE:FILE", a scenario made from two mesh files. */
bool mote_scenario_is_pair(const char *name);

/* Makes the default scenario of two mesh files from a name with MOTE_PAIR_PREFIX. *file (unless
   NULL) is the same as a scenario file, with the motion; close it with mote_json_close. If a
   file's name contains ':', the names are split where both files exist. */
mote_status mote_scenario_make_pair(const char *name, mote_json_file *file,
                                    mote_scenario **scenario);

/* Reads a body's mesh: {"letter", "triangles"}, {"file"} or {"character"}, and "scale".
   *character: of the last kind, without its mesh, otherwise NULL; pass it to
   mote_scenario_read_field or destroy it. */
mote_status mote_scenario_read_mesh(const mote_json *body, mote_mesh **mesh,
                                    mote_character **character);

/* The keys for a character. */
#define MOTE_CHARACTER_KEYS "character|clip|start|speed|loop|subdivide"

/* Checks that a body is an object with keys from known, and that what it says beside letter,
   file, character or positions goes with that. To be called before anything of it is read. */
mote_status mote_scenario_check_body(const mote_json *body, const char *known);

/* Reads "triangles" of a letter, which must be there; a body with a mesh of its own ignores it,
   since it may come from the scenario that this one is like. */
mote_status mote_scenario_read_triangles(const mote_json *body, int64_t *triangles);

/* Reads "character" and "subdivide"; *character is NULL without "character". */
mote_status mote_scenario_read_character(const mote_json *body, mote_character **character);

/* Reads "clip", "start", "speed" and "loop": sets *field to a character's field, and motion's
   player, which takes over the character. On failure the caller still owns the character unless
   motion has a player. */
mote_status mote_scenario_read_clip(const mote_json *body, const mote_mesh *mesh,
                                    mote_character *character, mote_field **field,
                                    mote_body_motion *motion);

/* Makes a player's poses between two frames the sample poses of its body. */
void mote_scenario_set_samples(mote_player *player, double first, double last, mote_body *body);

/* The path of a file that a scenario names: relative to the scenario's folder unless absolute;
   relative to the working directory if no file named it. MOTE_EINVAL if the scenario may not
   name it. The caller frees *path. */
mote_status mote_scenario_file_path(const mote_json *file, char **path);

/* The same for a mesh that is not a character's, without "scale". */
mote_status mote_scenario_read_plain(const mote_json *body, mote_mesh **mesh);

/* Replaces *mesh with a copy scaled by *factor, which is read from "scale". */
mote_status mote_scenario_scale(const mote_json *scale, mote_mesh **mesh, mote_vec3 *factor);

/* Reads a body that has "positions": its mesh and its sequence. last: the last frame shown. On
   failure, the caller frees what is in *mesh and *sequence. */
mote_status mote_scenario_read_positions(const mote_json *body, uint32_t last, mote_mesh **mesh,
                                         mote_sequence **sequence);

/* Reads "field" (absent: static) of a body whose mesh is known: the field, and the displacement
   of its control points into motion. For a character (may be NULL), which it takes over: its
   skin and its clip. On failure, the caller frees what is in *field and *motion. */
mote_status mote_scenario_read_field(const mote_json *body, const mote_mesh *mesh,
                                     mote_character *character, mote_field **field,
                                     mote_body_motion *motion);

/* Reads "motion" (absent: at rest at the origin, or at the given positions). length: L of the
   pair; frames: the last frame of the path that is shown. */
mote_status mote_scenario_read_motion(const mote_json *body, const mote_mesh *mesh,
                                      double length, uint32_t frames, mote_body_motion *motion);

#endif
