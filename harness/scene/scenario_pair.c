/* The default scenario of two meshes: approach, contacts, separation, both rotating and
   deforming. */
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/scene/scenario_read.h"

#include "harness/base/options.h"
#include "harness/mesh/character.h"
#include "harness/scene/pair_motion.h"
#include "harness/scene/spread.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FRAMES 1000
#define CONTROLS 12         /* per body, if its mesh has room for that many */
#define CONTROLS_APART 0.02 /* of the mesh's diagonal: a smaller distance makes a poor fit */

/* The two files and the direction in "pair:A:B" or "pair:A:B:X,Y,Z". */
typedef struct pair_name {
    char *file[2];
    mote_vec3 direction; /* 0, 0, 0: not given */
} pair_name;

static void free_name(pair_name *pair)
{
    free(pair->file[0]);
    free(pair->file[1]);
}

bool mote_scenario_is_pair(const char *name)
{
    return strncmp(name, MOTE_PAIR_PREFIX, strlen(MOTE_PAIR_PREFIX)) == 0;
}

char *mote_scenario_pair_name(const char *a, const char *b, const char *direction)
{
    return mote_format(MOTE_PAIR_PREFIX "%s:%s%s%s", a, b, direction ? ":" : "",
                       direction ? direction : "");
}

/* Removes ":X,Y,Z" from the end of a name. */
static mote_status split_direction(const char *name, char *files, mote_vec3 *direction)
{
    double xyz[3];
    char *colon = strrchr(files, ':');
    if (!colon || !mote_read_triple(colon + 1, xyz) || access(colon + 1, F_OK) == 0)
        return MOTE_OK;
    if (!mote_read_direction(colon + 1, xyz))
        return mote_fail(MOTE_EINVAL, "%s: a direction of no length; give X,Y,Z, not all 0",
                         name);
    *direction = mote_vec3_make(xyz[0], xyz[1], xyz[2]);
    *colon = '\0';
    return MOTE_OK;
}

/* Splits "A:B" at the first ':' with an existing file on either side, otherwise at the first
   ':'. */
static mote_status split_files(const char *name, const char *files, pair_name *pair)
{
    const char *first = strchr(files, ':');
    if (!first || first == files || first[1] == '\0')
        return mote_fail(MOTE_EINVAL,
                         "%s: not two files; write " MOTE_PAIR_PREFIX "A.obj:B.obj", name);
    for (const char *colon = first;; colon = strchr(colon + 1, ':')) {
        const bool none = !colon;
        const char *at = none ? first : colon;
        pair->file[0] = mote_format("%.*s", (int)(at - files), files);
        pair->file[1] = mote_duplicate(at + 1);
        if (none || (access(pair->file[0], F_OK) == 0 && access(pair->file[1], F_OK) == 0))
            return MOTE_OK;
        free_name(pair);
        pair->file[0] = pair->file[1] = NULL;
    }
}

static mote_status read_name(const char *name, pair_name *pair)
{
    char *files = mote_duplicate(name + strlen(MOTE_PAIR_PREFIX));
    mote_status status = split_direction(name, files, &pair->direction);
    if (status == MOTE_OK)
        status = split_files(name, files, pair);
    free(files);
    return status;
}

/* A rotation about an axis, with a key at every quarter of it. */
static json_t *turn_json(double x, double y, double z, double degrees)
{
    json_t *keys = json_array();
    for (int k = 0; k <= 4; ++k)
        (void)json_array_append_new(keys, json_pack("{s:i, s:[f,f,f], s:f}", "frame",
                                                    1 + k * (FRAMES - 1) / 4, "axis", x, y, z,
                                                    "degrees", degrees * k / 4));
    return keys;
}

/* A deforming body: a character with a clip plays it; a mesh gets control points. */
typedef struct pair_body {
    uint32_t clip;     /* from 1; 0: no character */
    uint32_t controls; /* of a mesh */
} pair_body;

static json_t *body_json(const char *path, pair_body body, int seed, json_t *motion)
{
    if (body.clip > 0)
        return json_pack("{s:s, s:i, s:o}", "character", path, "clip", (int)body.clip, "motion",
                         motion);
    return json_pack("{s:s, s:{s:i, s:f, s:{s:{s:i, s:f, s:[i,i]}}}, s:o}", "file", path,
                     "field", "count", (int)body.controls, "support", 0.5, "displacement",
                     "random", "seed", seed, "amplitude", 0.05, "periods", 250, 600, "motion",
                     motion);
}

/* The number of control points that fit on a mesh: a cube of eight vertices has eight. */
static mote_status count_controls(const char *path, uint32_t *count)
{
    mote_mesh *mesh;
    mote_vec3 places[CONTROLS];
    mote_status status = mote_mesh_import(path, &mesh, NULL);
    if (status != MOTE_OK)
        return status;
    status = mote_spread_apart(mesh, CONTROLS, CONTROLS_APART * mesh->diagonal, places, count);
    mote_mesh_destroy(mesh);
    return status;
}

/* Finds a character's first clip of nonzero length, or a mesh's control points. */
static mote_status look_at(const char *path, pair_body *body)
{
    mote_character *character = NULL;
    const mote_status status = mote_character_import_file(path, &character, NULL);
    *body = (pair_body){0, 0};
    if (status != MOTE_OK && status != MOTE_EUNSUPPORTED)
        return status;
    for (size_t k = 0; character && k < character->rig.clips_count && body->clip == 0; ++k) {
        if (character->rig.clips[k].seconds > 0)
            body->clip = (uint32_t)k + 1;
    }
    mote_character_destroy(character);
    return body->clip > 0 ? MOTE_OK : count_controls(path, &body->controls);
}

/* Makes the scenario without the positions of body 1. */
static mote_status make_file(const char *name, const pair_name *pair, mote_json_file *file)
{
    pair_body body[2];
    for (int i = 0; i < 2; ++i) {
        mote_status status = look_at(pair->file[i], &body[i]);
        if (status != MOTE_OK)
            return status;
    }
    file->own = true;
    file->root = json_pack("{s:s, s:i, s:s, s:[o,o]}", "purpose",
                           "Two meshes that approach, touch and part, turning and deforming.",
                           "frames", FRAMES, "ask", "distance", "bodies",
                           body_json(pair->file[0], body[0], 1, turn_json(0.3, 1, 0.2, 200)),
                           body_json(pair->file[1], body[1], 2, turn_json(1, 0.4, 0.6, -200)));
    if (!file->root)
        return mote_fail(MOTE_EINVAL, "%s, %s: names that are not UTF-8; rename them",
                         pair->file[0], pair->file[1]);
    file->path = mote_duplicate(name);
    file->text = json_dumps(file->root, JSON_COMPACT);
    return MOTE_OK;
}

/* The part of a path between its last slash and its last dot. */
static char *stem(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    return mote_format("%.*s", (int)(dot && dot > base ? dot - base : (long)strlen(base)),
                       base);
}

/* "a-b" of "x/a.obj" and "y/b.obj". */
static void rename_scenario(const pair_name *pair, mote_scenario *scenario)
{
    char *stems[2] = {stem(pair->file[0]), stem(pair->file[1])};
    char *name = mote_format("%s-%s", stems[0], stems[1]);
    free(stems[0]);
    free(stems[1]);
    mote_scenario_clean_name(name);
    free(scenario->name);
    scenario->name = name;
}

/* Finds the motion of body 1, and stores it in the scenario and in its file. */
static mote_status set_motion(const pair_name *pair, mote_json_file *file,
                              mote_scenario *scenario)
{
    mote_vec3 positions[FRAMES];
    mote_status status = mote_pair_motion_find(scenario, pair->direction, positions);
    if (status != MOTE_OK)
        return mote_fail(status, "%s: %s", scenario->path, mote_error_text());
    uint32_t frames[FRAMES];
    json_t *body = json_array_get(json_object_get(file->root, "bodies"), 1);
    json_t *keys = json_object_get(body, "motion");
    for (uint32_t k = 0; k < FRAMES; ++k) {
        const mote_vec3 p = mote_scale(positions[k], 1 / scenario->length);
        frames[k] = k + 1;
        (void)json_array_append_new(keys, json_pack("{s:i, s:[f,f,f]}", "frame", (int)k + 1,
                                                    "position", p.x, p.y, p.z));
        /* Computed as when reading the file. */
        positions[k] = mote_scale(p, scenario->length);
    }
    return mote_curve_create(frames, &positions->x, FRAMES, 3,
                             &scenario->motion->body[1].position);
}

mote_status mote_scenario_make_pair(const char *name, mote_json_file *file,
                                    mote_scenario **scenario)
{
    pair_name pair = {0};
    mote_json_file made_file = {0};
    mote_scenario *made = NULL;
    mote_status status = read_name(name, &pair);
    if (status == MOTE_OK)
        status = make_file(name, &pair, &made_file);
    if (status == MOTE_OK)
        status = mote_scenario_read(&made_file, &made);
    if (status == MOTE_OK)
        status = set_motion(&pair, &made_file, made);
    if (status == MOTE_OK) {
        rename_scenario(&pair, made);
        *scenario = made;
    } else {
        mote_scenario_destroy(made);
    }
    if (status == MOTE_OK && file)
        *file = made_file;
    else
        mote_json_close(&made_file);
    free_name(&pair);
    return status;
}
