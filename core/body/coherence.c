#include "core/body/coherence.h"

#include <stdlib.h>

mote_status mote_coherence_init(mote_coherence *coherence, const mote_body *const bodies[2],
                                double length, const uint32_t *const probes[2],
                                const uint32_t counts[2])
{
    *coherence = (mote_coherence){.body = {bodies[0], bodies[1]}, .length = length};
    for (int b = 0; b < 2; ++b) {
        mote_stance *stance = &coherence->stance[b];
        const uint32_t padded = bodies[b]->field->padded;
        stance->weights = calloc((size_t)padded + 1, sizeof *stance->weights);
        if (!stance->weights)
            return mote_fail(MOTE_ENOMEM, "no memory for %u weights", padded);
        while (stance->probe_count < counts[b] && stance->probe_count < MOTE_PROBES_MAX) {
            stance->probe[stance->probe_count] = probes[b][stance->probe_count];
            ++stance->probe_count;
        }
    }
    return MOTE_OK;
}

void mote_coherence_free(mote_coherence *coherence)
{
    for (int b = 0; b < 2; ++b) {
        free(coherence->stance[b].weights);
        coherence->stance[b].weights = NULL;
    }
}

/* The largest change of a weight, in the body's axes. */
static double weights_motion(mote_stance *stance, const mote_body_state *state)
{
    const mote_weights *w = &state->weights;
    double most = 0;
    for (uint32_t j = 0; j < w->count; ++j) {
        const mote_vec3 now =
            mote_rotate_back(&state->pose.rotation, mote_vec3_make(w->x[j], w->y[j], w->z[j]));
        const double squared = mote_distance_squared(now, stance->weights[j]);
        most = squared > most ? squared : most;
        stance->weights[j] = now;
    }
    return sqrt(most);
}

/* The farthest that any probe has moved, in the body's axes. */
static double probes_motion(mote_stance *stance, const mote_body_state *state)
{
    double most = 0;
    for (uint32_t i = 0; i < stance->probe_count; ++i) {
        const mote_vec3 world = state->vertices[stance->probe[i]];
        const mote_vec3 now =
            mote_rotate_back(&state->pose.rotation, mote_sub(world, state->pose.translation));
        const double squared = mote_distance_squared(now, stance->probe_local[i]);
        most = squared > most ? squared : most;
        stance->probe_local[i] = now;
    }
    return sqrt(most);
}

/* The middle of a body's box at rest, in the world. */
static mote_vec3 centre_of(const mote_body *body, const mote_pose *pose)
{
    const mote_mesh *mesh = body->mesh;
    return mote_pose_apply(pose, mote_add_scaled(mote_scale(mesh->low, 0.5), 0.5, mesh->high));
}

static double pose_motion(mote_coherence *c, const mote_frame *frame)
{
    const mote_mat3 *r0 = &frame->body[0].pose.rotation;
    const mote_mat3 *r1 = &frame->body[1].pose.rotation;
    double turned = 0;
    for (int j = 0; j < 3; ++j) {
        const mote_vec3 column =
            mote_rotate_back(r0, mote_vec3_make(r1->m[0][j], r1->m[1][j], r1->m[2][j]));
        const double now[3] = {column.x, column.y, column.z};
        for (int i = 0; i < 3; ++i) {
            const double d = now[i] - c->rotation.m[i][j];
            turned += d * d;
            c->rotation.m[i][j] = now[i];
        }
    }
    const mote_vec3 centre =
        mote_rotate_back(r0, mote_sub(centre_of(c->body[1], &frame->body[1].pose),
                                      centre_of(c->body[0], &frame->body[0].pose)));
    const double shifted = mote_length(mote_sub(centre, c->centre));
    c->centre = centre;
    /* A rotation by a small angle a changes the matrix by sqrt(2) a, and moves points at half
       of L by a L / 2. */
    return sqrt(turned / 8) * c->length + shifted;
}

double mote_coherence_motion(mote_coherence *coherence, const mote_frame *frame, bool use_given)
{
    double motion = pose_motion(coherence, frame);
    for (int b = 0; b < 2; ++b) {
        mote_stance *stance = &coherence->stance[b];
        motion += use_given || mote_body_is_given(coherence->body[b])
                      ? probes_motion(stance, &frame->body[b])
                      : weights_motion(stance, &frame->body[b]);
    }
    const bool known = coherence->known;
    coherence->known = true;
    return known ? motion : coherence->length;
}
