#include "core/body/body.h"

mote_vec3 mote_body_position(const mote_body *body, const mote_body_state *state,
                             uint32_t vertex)
{
    if (mote_body_is_given(body))
        return state->vertices[vertex];
    const mote_vec3 rigid = mote_pose_apply(&state->pose, body->mesh->positions[vertex]);
    if (body->field->count == 0)
        return rigid;
    return mote_add(rigid,
                    mote_field_displacement(body->field, body->mesh, vertex, &state->weights));
}

mote_vec3 mote_body_sample(const mote_body *body, uint32_t pose, uint32_t vertex)
{
    const mote_vec3 rest = body->mesh->positions[vertex];
    if (pose == 0)
        return rest;
    return mote_add(rest, mote_field_displacement(body->field, body->mesh, vertex,
                                                  &body->samples[pose - 1]));
}
