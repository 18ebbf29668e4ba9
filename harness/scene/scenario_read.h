/* The parts of a scenario file, one reader each; used by the loader only. */
#ifndef MOTE_HARNESS_SCENARIO_READ_H
#define MOTE_HARNESS_SCENARIO_READ_H

#include "harness/base/json_read.h"
#include "harness/scene/motion.h"
#include "harness/scene/scenario.h"

/* A scenario's frames at most. */
#define MOTE_FRAMES_MAX 1000000

/* A body's controls at most. */
#define MOTE_CONTROLS_MAX 256

/* Merges the file's root into the scenario that its "like" names; does nothing without that
   key. */
mote_status mote_scenario_merge_like(mote_json_file *file);

/* Opens the file of a built-in scenario's name or of a path, merged with the one that it is
   like, or makes that of a pair. mote_scenario.path opens the same scenario again. MOTE_EIO,
   with the names that exist, for an unknown name. Close with mote_json_close. */
mote_status mote_scenario_open(const char *name_or_path, mote_json_file *file);

/* Whether a file's root is of several bodies (harness/scene/bodies.h). */
bool mote_scenario_of_bodies(const mote_json_file *file);

/* Reads "frames", "warmup", "active", "ask", "tolerance", "start", "pace" and "purpose" into a
   scenario with a motion; tolerance is of L. */
mote_status mote_scenario_read_facts(const mote_json *root, mote_scenario *scenario);

/* The name that a file's path gives: without folder, ".json" and control characters. */
char *mote_scenario_name_of(const char *path);

/* Replaces what would break a line of a table or of a message: control characters. */
void mote_scenario_clean_name(char *name);

/* Makes a scenario of a file's root; its name comes from the file's path. */
mote_status mote_scenario_read(const mote_json_file *file, mote_scenario **scenario);

/* Whether a name is "pair:FILE:FILE", a scenario that is made of two mesh files. */
bool mote_scenario_is_pair(const char *name);

/* Makes the default scenario of two mesh files: a name of MOTE_PAIR_PREFIX. *file (unless
   NULL) is the same as a scenario file, motion and all; close it with mote_json_close. Where
   a file's name contains a ':', which files exist decides where the first name ends. */
mote_status mote_scenario_make_pair(const char *name, mote_json_file *file,
                                    mote_scenario **scenario);

/* Reads a body's mesh: {"letter", "triangles"}, {"file"} or {"character"}, and "scale".
   *character: that of the last kind, without its mesh, or NULL; for mote_scenario_read_field,
   or to be destroyed. */
mote_status mote_scenario_read_mesh(const mote_json *body, mote_mesh **mesh,
                                    mote_character **character);

/* The keys of a character. */
#define MOTE_CHARACTER_KEYS "character|clip|start|speed|loop|subdivide"

/* Reads "character" and "subdivide"; *character is NULL without the former. */
mote_status mote_scenario_read_character(const mote_json *body, mote_character **character);

/* Reads "clip", "start", "speed" and "loop": the field of a character, and the player, which
   takes the character over, into motion. On failure the character is still the caller's unless
   motion has a player. */
mote_status mote_scenario_read_clip(const mote_json *body, const mote_mesh *mesh,
                                    mote_character *character, mote_field **field,
                                    mote_body_motion *motion);

/* Makes a player's poses between two frames the sample poses of its body. */
void mote_scenario_set_samples(mote_player *player, double first, double last, mote_body *body);

/* The path of a file that a scenario names: from the scenario's folder unless it is absolute,
   or from the working directory where no file named it. MOTE_EINVAL where the scenario may not
   name it. The caller frees *path. */
mote_status mote_scenario_file_path(const mote_json *file, char **path);

/* The same of a mesh that is no character, without "scale". */
mote_status mote_scenario_read_plain(const mote_json *body, mote_mesh **mesh);

/* Replaces *mesh by itself with each coordinate times *factor, which "scale" says. */
mote_status mote_scenario_scale(const mote_json *scale, mote_mesh **mesh, mote_vec3 *factor);

/* Reads a body that has "positions": its mesh and its sequence. last: the last frame that is
   shown. On failure, what was made stays in *mesh and *sequence for the caller to free. */
mote_status mote_scenario_read_positions(const mote_json *body, uint32_t last, mote_mesh **mesh,
                                         mote_sequence **sequence);

/* Reads "field" (absent: static) of a body whose mesh is known: the field, and the displacement
   of its control points into motion. Of a character (or NULL), which it takes over: its skin
   and its clip. On failure, what was made stays in *field and *motion for the caller to free.
 */
mote_status mote_scenario_read_field(const mote_json *body, const mote_mesh *mesh,
                                     mote_character *character, mote_field **field,
                                     mote_body_motion *motion);

/* Reads "motion" (absent: at rest at the origin, or where given positions are). length: L of
   the pair; frames: the last point of the path that is shown. */
mote_status mote_scenario_read_motion(const mote_json *body, const mote_mesh *mesh,
                                      double length, uint32_t frames, mote_body_motion *motion);

#endif
