#include "baselines/physics_engine.h"

#include "baselines/input.h"
#include "core/base/clones.h"

#include <math.h>
#include <string.h>

mote_traits mote_physics_traits(mote_physics_update update, bool given)
{
    const bool vertices = update != MOTE_PHYSICS_NONE;
    return (mote_traits){.needs_vertices = vertices && !given,
                         .given_vertices = vertices && given};
}

static mote_mat3 identity(void)
{
    return (mote_mat3){.m = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

mote_status mote_physics_begin(mote_physics *engine, const mote_setup *setup,
                               mote_physics_update update, const char *name)
{
    if (setup->ask != MOTE_ASK_CONTACT)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "%s has no distance between two meshes, only contact", name);
    if (setup->tolerance > 0)
        return mote_fail(MOTE_EUNSUPPORTED, "%s answers for contact at tolerance 0 only", name);
    mote_status status = mote_input_check(setup);
    if (status != MOTE_OK)
        return status;
    *engine =
        (mote_physics){.scale = ldexp(1, -(int)fmax(-1000, fmin(1000, ilogb(setup->length))))};
    for (int b = 0; b < 2; ++b) {
        mote_physics_body *body = &engine->body[b];
        body->mesh = setup->body[b]->mesh;
        body->centre =
            mote_add(mote_scale(body->mesh->low, 0.5), mote_scale(body->mesh->high, 0.5));
        body->moved_centre = body->centre;
        body->vertices = body->mesh->positions;
        body->rigid = mote_body_is_rigid(setup->body[b]);
        body->rotation = identity();
        if (update == MOTE_PHYSICS_NONE && !body->rigid)
            return mote_fail(MOTE_EUNSUPPORTED,
                             "update=none needs rigid bodies; body %d deforms", b);
    }
    return MOTE_OK;
}

/* What was written of this frame is not whole: each body needs a refit. */
static mote_status forget(mote_physics *engine, mote_status status)
{
    engine->body[0].fitted = engine->body[1].fitted = false;
    return status;
}

/* Whether the vertices are no longer those of the last refit, up to the motion of the centre.
 */
static bool needs_refit(const mote_physics_body *body, const mote_body_state *state)
{
    const mote_mat3 *rotation = &state->pose.rotation;
    return !body->rigid && (!body->fitted || state->shape_changed ||
                            memcmp(rotation, &body->fitted_rotation, sizeof *rotation) != 0);
}

mote_status mote_physics_follow(mote_physics *engine, const mote_frame *frame, int b)
{
    mote_physics_body *body = &engine->body[b];
    const mote_body_state *state = &frame->body[b];
    const mote_status status = mote_input_check_pose(&state->pose, b);
    if (status != MOTE_OK)
        return forget(engine, status);
    body->moved_centre = mote_pose_apply(&state->pose, body->centre);
    body->translation =
        mote_scale(mote_sub(body->moved_centre, engine->body[0].moved_centre), engine->scale);
    if (body->rigid)
        body->rotation = state->pose.rotation;
    body->refit = needs_refit(body, state);
    if (!body->refit)
        return MOTE_OK;
    if (!state->vertices)
        return forget(engine, mote_input_check_vertices(NULL, 0, b));
    body->vertices = state->vertices;
    body->fitted_rotation = state->pose.rotation;
    body->fitted = true;
    return MOTE_OK;
}

/* `zero` is the sum of mote_input_zero over the body's vertices. */
static mote_status checked(mote_physics *engine, int b, double zero)
{
    const mote_physics_body *body = &engine->body[b];
    if (!isnan(zero))
        return MOTE_OK;
    return forget(engine,
                  mote_input_check_vertices(body->vertices, body->mesh->vertex_count, b));
}

MOTE_CLONES
static double write_doubles(const mote_physics_body *body, double scale,
                            double *MOTE_RESTRICT to)
{
    const mote_vec3 *from = body->vertices, centre = body->moved_centre;
    double zero = 0;
    for (uint32_t i = 0; i < body->mesh->vertex_count; ++i, to += 3) {
        const mote_vec3 p = mote_scale(mote_sub(from[i], centre), scale);
        zero += mote_input_zero(from[i]);
        to[0] = p.x;
        to[1] = p.y;
        to[2] = p.z;
    }
    return zero;
}

MOTE_CLONES
static double write_floats(const mote_physics_body *body, double scale, float *MOTE_RESTRICT to)
{
    const mote_vec3 *from = body->vertices, centre = body->moved_centre;
    double zero = 0;
    for (uint32_t i = 0; i < body->mesh->vertex_count; ++i, to += 3) {
        const mote_vec3 p = mote_scale(mote_sub(from[i], centre), scale);
        zero += mote_input_zero(from[i]);
        to[0] = (float)p.x;
        to[1] = (float)p.y;
        to[2] = (float)p.z;
    }
    return zero;
}

mote_status mote_physics_write_doubles(mote_physics *engine, int b, double *to)
{
    return checked(engine, b, write_doubles(&engine->body[b], engine->scale, to));
}

mote_status mote_physics_write_floats(mote_physics *engine, int b, float *to)
{
    return checked(engine, b, write_floats(&engine->body[b], engine->scale, to));
}
