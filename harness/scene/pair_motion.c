#include "harness/scene/pair_motion.h"

#include "harness/base/curve.h"
#include "harness/scene/approach.h"
#include "harness/scene/spread.h"

#include <math.h>
#include <stdlib.h>

#define FRAMES 1000

/* The requested gaps: in the pair's L if the bodies are apart, in the smaller body's L if they
   touch, which they do in 15 % of the frames. */
static const struct {
    uint32_t frame;
    double gap;
} wished[] = {{1, 0.3},      {60, 0.15},    {120, 0.03},   {155, -0.012}, {205, 0.05},
              {255, 0.004},  {305, 0.07},   {355, -0.012}, {405, 0.05},   {455, -0.004},
              {505, 0.06},   {555, -0.015}, {605, 0.05},   {655, 0.001},  {705, 0.07},
              {755, -0.012}, {805, 0.04},   {845, -0.012}, {900, 0.1},    {1000, 0.4}};
#define WISHED (sizeof wished / sizeof wished[0])

static const mote_vec3 directions[] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                       {-1, 1, 1}, {1, -1, 1}, {1, 1, -1}};
#define DIRECTIONS (sizeof directions / sizeof directions[0])

/* The range of sizes in which contacts can be told from rounding, determined on cubes: the
   triangle tests multiply four lengths. */
#define SMALLEST 1e-70
#define LARGEST 1e70
#define RATIO 1e13 /* between the two sizes */

static mote_status check_sizes(const mote_scenario *scenario)
{
    const double a = scenario->body[0].mesh->diagonal, b = scenario->body[1].mesh->diagonal;
    const double smaller = fmin(a, b), larger = fmax(a, b);
    if (smaller < SMALLEST || larger > LARGEST)
        return mote_fail(MOTE_EINVAL,
                         "the bounding boxes' diagonals are %.3g and %.3g; contacts can be "
                         "computed from %g to %g only: scale the meshes",
                         a, b, SMALLEST, LARGEST);
    if (larger / smaller > RATIO)
        return mote_fail(MOTE_EINVAL,
                         "the bounding boxes' diagonals are %.3g and %.3g; the smaller body is "
                         "lost in the rounding of the larger one beyond a ratio of %g: scale "
                         "one of them",
                         a, b, RATIO);
    return MOTE_OK;
}

/* Interpolates a gap for each frame, in L. */
static mote_status spread_gaps(const mote_scenario *scenario, double *gaps)
{
    uint32_t frames[WISHED];
    double wished_gaps[WISHED];
    mote_curve *curve = NULL;
    const double smaller =
        fmin(scenario->body[0].mesh->diagonal, scenario->body[1].mesh->diagonal);
    for (size_t i = 0; i < WISHED; ++i) {
        frames[i] = wished[i].frame;
        wished_gaps[i] = wished[i].gap;
    }
    mote_status status = mote_curve_create(frames, wished_gaps, WISHED, 1, &curve);
    if (status != MOTE_OK)
        return status;
    for (uint32_t k = 0; k < FRAMES; ++k) {
        mote_curve_evaluate(curve, k + 1, &gaps[k]);
        if (gaps[k] < 0)
            gaps[k] *= smaller / scenario->length;
    }
    mote_curve_destroy(curve);
    return MOTE_OK;
}

/* The vertex farthest from the middle of its mesh. */
static uint32_t tip(const mote_mesh *mesh)
{
    const mote_vec3 centre = mote_mesh_centre(mesh);
    uint32_t farthest = 0;
    double largest = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const double square = mote_distance_squared(mesh->positions[v], centre);
        if (square > largest) {
            largest = square;
            farthest = v;
        }
    }
    return farthest;
}

mote_status mote_pair_motion_find(const mote_scenario *scenario, mote_vec3 direction,
                                  mote_vec3 *positions)
{
    uint32_t frames[FRAMES];
    double gaps[FRAMES];
    const uint32_t tips[2] = {tip(scenario->body[0].mesh), tip(scenario->body[1].mesh)};
    const bool given = mote_length(direction) > 0;
    mote_status status = check_sizes(scenario);
    if (status == MOTE_OK)
        status = spread_gaps(scenario, gaps);
    if (status != MOTE_OK)
        return status;
    for (uint32_t k = 0; k < FRAMES; ++k)
        frames[k] = k + 1;
    for (int aimed = 0; aimed < 2; ++aimed) {
        for (size_t d = 0; d < (given ? 1 : DIRECTIONS); ++d) {
            const mote_approach_plan plan = {.direction = given ? direction : directions[d],
                                             .frames = frames,
                                             .gaps = gaps,
                                             .count = FRAMES,
                                             .tips = aimed ? tips : NULL,
                                             .must_touch = true};
            status = mote_approach_solve(scenario, &plan, positions);
            if (status != MOTE_EINVAL)
                return status;
        }
    }
    return mote_fail(
        status,
        "no motion with contacts was found: %s; give another direction (--pair A B "
        "--direction X,Y,Z), or write a scenario with a motion of its own",
        mote_error_text());
}
