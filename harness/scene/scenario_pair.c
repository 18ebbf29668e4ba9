/* The default scenario of two meshes: approach, touches, parting, both turning and deforming.
 */
#include "harness/scene/scenario_read.h"

#include "harness/scene/approach.h"
#include "harness/base/file.h"
#include "harness/base/json_print.h"

#include <stdlib.h>
#include <string.h>

#define FRAMES 1000
#define EVERY 9 /* frames a key pose */
#define KEYS ((FRAMES - 1) / EVERY + 1)

/* The wished gaps, of L: some fifteen frames in a hundred are touches. */
static const struct {
    uint32_t frame;
    double gap;
} wished[] = {{1, 0.3},      {60, 0.15},    {120, 0.03},   {155, -0.012}, {205, 0.05},
              {255, 0.004},  {305, 0.07},   {355, -0.012}, {405, 0.05},   {455, -0.004},
              {505, 0.06},   {555, -0.015}, {605, 0.05},   {655, 0.001},  {705, 0.07},
              {755, -0.012}, {805, 0.04},   {845, -0.012}, {900, 0.1},    {1000, 0.4}};

#define WISHED (sizeof wished / sizeof wished[0])

/* A turn about an axis, a key every quarter of it. */
static json_t *turn_json(double x, double y, double z, double degrees)
{
    json_t *keys = json_array();
    for (int k = 0; k <= 4; ++k)
        (void)json_array_append_new(keys, json_pack("{s:i, s:[f,f,f], s:f}", "frame",
                                                    1 + k * (FRAMES - 1) / 4, "axis", x, y, z,
                                                    "degrees", degrees * k / 4));
    return keys;
}

static json_t *body_json(const char *path, int seed, json_t *motion)
{
    return json_pack("{s:s, s:{s:i, s:f, s:{s:{s:i, s:f, s:[i,i]}}}, s:o}", "file", path,
                     "field", "count", 12, "support", 0.5, "displacement", "random", "seed",
                     seed, "amplitude", 0.05, "periods", 250, 600, "motion", motion);
}

/* What stands between the last slash and the last dot of a path. */
static char *stem(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    return mote_format("%.*s", (int)(dot && dot > base ? dot - base : (long)strlen(base)),
                       base);
}

/* The scenario's file, as if it stood in the working directory. */
static mote_status make_file(const char *a, const char *b, mote_json_file *file)
{
    char *stems[2] = {stem(a), stem(b)};
    json_t *root = json_pack("{s:s, s:i, s:s, s:[o,o]}", "purpose",
                             "Two meshes that approach, touch and part, turning and deforming.",
                             "frames", FRAMES, "ask", "distance", "bodies",
                             body_json(a, 1, turn_json(0.3, 1, 0.2, 200)),
                             body_json(b, 2, turn_json(1, 0.4, 0.6, -200)));
    mote_status status = MOTE_OK;
    *file = (mote_json_file){NULL, NULL, root};
    if (stems[0] && stems[1] && root) {
        file->path = mote_format("%s-%s.json", stems[0], stems[1]);
        file->text = mote_json_text(root, JSON_COMPACT);
    }
    if (!root)
        status = mote_fail(MOTE_EINVAL, "%s, %s: names that are not UTF-8; rename them", a, b);
    else if (!file->path || !file->text)
        status = mote_fail(MOTE_ENOMEM, "no memory for a pair of meshes");
    free(stems[0]);
    free(stems[1]);
    return status;
}

static mote_status find_motion(mote_scenario *scenario)
{
    uint32_t frames[KEYS], wished_frames[WISHED];
    double gaps[KEYS], wished_gaps[WISHED];
    mote_vec3 positions[KEYS];
    mote_curve *curve = NULL;
    for (size_t i = 0; i < WISHED; ++i) {
        wished_frames[i] = wished[i].frame;
        wished_gaps[i] = wished[i].gap;
    }
    mote_status status = mote_curve_create(wished_frames, wished_gaps, WISHED, 1, &curve);
    if (status != MOTE_OK)
        return status;
    for (uint32_t k = 0; k < KEYS; ++k) {
        frames[k] = 1 + k * EVERY;
        mote_curve_evaluate(curve, frames[k], &gaps[k]);
    }
    mote_curve_destroy(curve);
    const mote_approach_plan plan = {{1, 0, 0}, frames, gaps, KEYS};
    status = mote_approach_solve(scenario, &plan, positions);
    if (status == MOTE_OK)
        status = mote_curve_create(frames, &positions->x, KEYS, 3,
                                   &scenario->motion->body[1].position);
    return status;
}

mote_status mote_scenario_make_pair(const char *name, mote_scenario **scenario)
{
    const char *a = name + strlen(MOTE_PAIR_PREFIX);
    const char *colon = strchr(a, ':');
    if (!colon || colon == a || colon[1] == '\0')
        return mote_fail(MOTE_EINVAL,
                         "%s: not two files; write " MOTE_PAIR_PREFIX "A.obj:B.obj", name);
    char *first = mote_format("%.*s", (int)(colon - a), a);
    if (!first)
        return mote_fail(MOTE_ENOMEM, "%s: no memory for its names", name);
    mote_json_file file = {0};
    mote_scenario *made = NULL;
    mote_status status = make_file(first, colon + 1, &file);
    if (status == MOTE_OK)
        status = mote_scenario_read(&file, &made);
    if (status == MOTE_OK)
        status = find_motion(made);
    if (status == MOTE_OK)
        *scenario = made;
    else
        mote_scenario_destroy(made);
    free(first);
    mote_json_close(&file);
    return status;
}
