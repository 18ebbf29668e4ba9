#include "baselines/physics_engine.h"

#include "baselines/input.h"

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
        body->rigid = mote_body_is_rigid(setup->body[b]);
        body->rotation = identity();
        if (update == MOTE_PHYSICS_NONE && !body->rigid)
            return mote_fail(MOTE_EUNSUPPORTED,
                             "update=none needs rigid bodies; body %d deforms", b);
    }
    return MOTE_OK;
}

static mote_status follow(mote_physics_body *body, const mote_body_state *state, int b)
{
    mote_status status = mote_input_check_pose(&state->pose, b);
    if (status != MOTE_OK)
        return status;
    const mote_mat3 *rotation = &state->pose.rotation;
    body->moved_centre = mote_pose_apply(&state->pose, body->centre);
    body->refit = false;
    if (body->rigid) {
        body->rotation = *rotation;
        return MOTE_OK;
    }
    body->refit = !body->fitted || state->shape_changed ||
                  memcmp(rotation, &body->fitted_rotation, sizeof *rotation) != 0;
    if (body->refit) {
        status = mote_input_check_vertices(state->vertices, body->mesh->vertex_count, b);
        body->vertices = state->vertices;
        body->fitted_rotation = *rotation;
        body->fitted = true;
    }
    return status;
}

mote_status mote_physics_frame(mote_physics *engine, const mote_frame *frame)
{
    for (int b = 0; b < 2; ++b) {
        mote_status status = follow(&engine->body[b], &frame->body[b], b);
        if (status != MOTE_OK) { /* no body has been refitted for this frame */
            engine->body[0].fitted = engine->body[1].fitted = false;
            return status;
        }
    }
    for (int b = 0; b < 2; ++b)
        engine->body[b].translation =
            mote_scale(mote_sub(engine->body[b].moved_centre, engine->body[0].moved_centre),
                       engine->scale);
    return MOTE_OK;
}

mote_vec3 mote_physics_rest(const mote_physics *engine, int b, uint32_t i)
{
    const mote_physics_body *body = &engine->body[b];
    return mote_scale(mote_sub(body->mesh->positions[i], body->centre), engine->scale);
}

mote_vec3 mote_physics_vertex(const mote_physics *engine, int b, uint32_t i)
{
    const mote_physics_body *body = &engine->body[b];
    return mote_scale(mote_sub(body->vertices[i], body->moved_centre), engine->scale);
}
