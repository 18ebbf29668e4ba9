#include "baselines/float_positions.h"

#include "baselines/input.h"
#include "core/base/clones.h"

/* Positions farther from the origin than this times L get a new one. */
#define FAR_FROM_ORIGIN 8

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

/* Returns the largest absolute coordinate, or a value that is not finite if one of world is
   not, or no longer is as a float. */
MOTE_CLONES
static float convert(float (*to)[4], const mote_vec3 *world, uint32_t count, mote_vec3 origin,
                     double scale)
{
    float coordinate_max[4] = {0, 0, 0, 0}, bad[4] = {0, 0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        float p[4] = {(float)((world[i].x - origin.x) * scale),
                      (float)((world[i].y - origin.y) * scale),
                      (float)((world[i].z - origin.z) * scale), 0};
        for (int k = 0; k < 4; k++) {
            to[i][k] = p[k];
            coordinate_max[k] = larger(fabsf(p[k]), coordinate_max[k]);
            bad[k] += p[k] - p[k];
        }
    }
    return larger(larger(coordinate_max[0], coordinate_max[1]), coordinate_max[2]) +
           (bad[0] + bad[1] + bad[2]);
}

mote_status mote_float_positions(float (*to)[4], const mote_vec3 *world, uint32_t count,
                                 mote_vec3 origin, double scale, int body,
                                 float *coordinate_max)
{
    if (!world)
        return mote_input_check_vertices(world, count, body);
    *coordinate_max = convert(to, world, count, origin, scale);
    if (isfinite(*coordinate_max))
        return MOTE_OK;
    mote_status status = mote_input_check_vertices(world, count, body);
    if (status == MOTE_OK)
        status = mote_fail(MOTE_EINVAL,
                           "body %d is more than 1e38 L away; its distance must be below that",
                           body);
    return status;
}

/* Keeps the origin while body 0 is near it. Returns whether it did not. */
static bool renew_origin(mote_float_pair *pair, mote_vec3 first)
{
    const double away = mote_largest_coordinate(mote_sub(first, pair->origin)) * pair->scale;
    if (pair->placed && !(away > FAR_FROM_ORIGIN))
        return false;
    pair->origin = first;
    return true;
}

mote_status mote_float_pair_update(mote_float_pair *pair, const mote_frame *frame,
                                   bool moved[2])
{
    if (!frame->body[0].vertices)
        return mote_input_check_vertices(NULL, 0, 0);
    const bool both = renew_origin(pair, frame->body[0].vertices[0]);
    pair->placed = false;
    for (int b = 0; b < 2; ++b) {
        const mote_body_state *body = &frame->body[b];
        moved[b] = both || body->shape_changed || body->pose_changed || !body->vertices;
        if (!moved[b])
            continue;
        const mote_status status =
            mote_float_positions(pair->position[b], body->vertices, pair->count[b],
                                 pair->origin, pair->scale, b, &pair->coordinate_max[b]);
        if (status != MOTE_OK)
            return status;
    }
    pair->placed = true;
    return MOTE_OK;
}
