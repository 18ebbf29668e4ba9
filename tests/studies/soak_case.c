#include "tests/studies/soak_case.h"

#include "core/base/random.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

enum { FRAMES = 200, KEYS_MAX = 51 };

static double uniform(mote_random *dice, double low, double high)
{
    return low + (high - low) * mote_random_unit(dice);
}

/* Uniform in the logarithm. */
static double spread(mote_random *dice, double low, double high)
{
    return low * pow(high / low, mote_random_unit(dice));
}

static bool chance(mote_random *dice, double share)
{
    return mote_random_unit(dice) < share;
}

static json_t *vector(double x, double y, double z)
{
    return json_pack("[f,f,f]", x, y, z);
}

/* A letter, or a mesh of the folder, some of them squashed. */
static json_t *make_body(mote_random *dice, const char *meshes)
{
    static const char *const files[] = {"comb", "bunny",  "spider", "islands",
                                        "bowl", "flat-t", "box",    "teapot"};
    json_t *body;
    if (chance(dice, 0.75)) {
        const char letter[2] = {(char)('A' + mote_random_below(dice, 26)), '\0'};
        const int half = (int)spread(dice, 200, 1500);
        body = json_pack("{s:s, s:i}", "letter", letter, "triangles", 2 * half);
    } else {
        const char *name = files[mote_random_below(dice, sizeof files / sizeof *files)];
        body = json_pack("{s:o}", "file", json_sprintf("%s/%s.obj", meshes, name));
    }
    const double size = chance(dice, 0.3) ? spread(dice, 0.2, 5) : 1;
    const double squash = chance(dice, 0.15) ? spread(dice, 1e-6, 1) : 1;
    json_object_set_new(body, "scale", vector(size, size, squash * size));
    return body;
}

static json_t *make_field(mote_random *dice)
{
    const int count = 1 + (int)mote_random_below(dice, 24);
    const double period = spread(dice, 4, 400);
    return json_pack("{s:i, s:f, s:{s:{s:I, s:f, s:[f,f]}}}", "count", count, "support",
                     spread(dice, 0.05, 2), "displacement", "random", "seed",
                     (json_int_t)mote_random_below(dice, 1000000), "amplitude",
                     spread(dice, 1e-4, 0.3), "periods", period, 2 * period);
}

/* Poses on a grid, turned by multiples of 90 degrees: parallel faces and exact ties. */
static json_t *grid_key(mote_random *dice, int frame, bool moving)
{
    double axis[3] = {0};
    axis[mote_random_below(dice, 3)] = 1;
    double place[3];
    for (int k = 0; k < 3; ++k)
        place[k] = moving ? ((double)mote_random_below(dice, 9) - 4) / 4 : 0;
    return json_pack("{s:i, s:o, s:f, s:o}", "frame", frame, "axis",
                     vector(axis[0], axis[1], axis[2]), "degrees",
                     90.0 * (double)mote_random_below(dice, 4), "position",
                     vector(place[0], place[1], place[2]));
}

/* Any rotation, at a distance of up to reach in any direction. */
static json_t *free_key(mote_random *dice, int frame, double reach)
{
    double q[4], d[3], turn = 0, way = 0;
    for (int k = 0; k < 4; ++k) {
        q[k] = uniform(dice, -1, 1) + (k == 0);
        turn += q[k] * q[k];
    }
    for (int k = 0; k < 3; ++k) {
        d[k] = uniform(dice, -1, 1);
        way += d[k] * d[k];
    }
    turn = sqrt(turn);
    const double far = reach * mote_random_unit(dice) / fmax(sqrt(way), 1e-3);
    return json_pack("{s:i, s:[f,f,f,f], s:o}", "frame", frame, "quaternion", q[0] / turn,
                     q[1] / turn, q[2] / turn, q[3] / turn, "position",
                     vector(far * d[0], far * d[1], far * d[2]));
}

/* spacing: frames between keys; at 1 every frame is a leap. */
static json_t *make_motion(mote_random *dice, int spacing, bool grid, bool moving)
{
    json_t *keys = json_array();
    for (int k = 0; k < KEYS_MAX && k * spacing <= FRAMES; ++k) {
        const int frame = 1 + k * spacing;
        json_array_append_new(keys, grid ? grid_key(dice, frame, moving)
                                         : free_key(dice, frame, moving ? 1.1 : 0.1));
    }
    return keys;
}

json_t *soak_case_make(uint64_t seed, const char *meshes)
{
    static const int spacings[] = {1, 4, 20, 100};
    mote_random dice = {seed};
    json_t *bodies = json_array();
    const bool grid = chance(&dice, 0.1), deforming = !grid && chance(&dice, 0.85);
    const int spacing = spacings[mote_random_below(&dice, 4)];
    for (int b = 0; b < 2; ++b) {
        json_t *body = make_body(&dice, meshes);
        if (deforming && chance(&dice, 0.9))
            json_object_set_new(body, "field", make_field(&dice));
        json_object_set_new(body, "motion", make_motion(&dice, spacing, grid, b == 1));
        json_array_append_new(bodies, body);
    }
    const int frames = spacing == 1 ? KEYS_MAX : FRAMES;
    return json_pack("{s:o, s:i, s:i, s:f, s:s, s:o}", "purpose",
                     json_sprintf("Soak case %llu.", (unsigned long long)seed), "frames",
                     frames, "start", 1, "pace", 1.0, "ask", "distance", "bodies", bodies);
}

mote_status soak_case_write(const json_t *scenario, const char *path)
{
    if (json_dump_file(scenario, path, JSON_INDENT(2)) != 0)
        return mote_fail(MOTE_EIO, "cannot write %s", path);
    return MOTE_OK;
}
