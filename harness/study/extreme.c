#include "harness/study/extreme.h"

#include "harness/base/memory.h"
#include "core/body/csrbf_fit.h"
#include "datasets/letter.h"
#include "harness/scene/motion.h"
#include "harness/engine/engine.h"
#include "harness/scene/spread.h"
#include "core/base/turn.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CONTROLS 8
#define SUPPORT 0.6    /* of L */
#define AMPLITUDE 0.05 /* of L */
#define STEPS 60       /* iterations towards a gap */

static mote_status refuse(mote_extreme *e)
{
    (void)snprintf(e->refusal, sizeof e->refusal, "%s", mote_error_text());
    return MOTE_OK;
}

/* Whether an error comes from the input; a failure of the machine stays an error. */
static bool is_refusal(mote_status status)
{
    return status == MOTE_EINVAL || status == MOTE_ENUMERIC;
}

/* Sets the weights of all frames, rotated with the body. */
static mote_status set_weights(const mote_extreme_recipe *r, mote_extreme *e, int b)
{
    const mote_field *field = e->field[b];
    mote_csrbf_fit *fit = NULL;
    mote_status status = MOTE_OK;
    double reciprocal = 1;
    if (!r->direct && r->controls > 0)
        status = mote_csrbf_fit_create(field, &fit, &reciprocal);
    if (fit)
        e->condition = fmax(e->condition, 1 / reciprocal);
    for (uint32_t f = 0; f < MOTE_EXTREME_FRAMES && status == MOTE_OK; ++f) {
        mote_body_state *state = &e->frame[f].body[b];
        mote_vec3 solved[MOTE_EXTREME_CONTROLS] = {{0}};
        memcpy(solved, r->move[b][f], sizeof solved);
        if (fit)
            status = mote_csrbf_fit_solve(fit, solved, solved);
        double *x = e->weights[b][f] = mote_allocate((size_t)3 * field->padded, sizeof *x);
        if (status != MOTE_OK)
            break;
        for (uint32_t j = 0; j < field->count; ++j) {
            const mote_vec3 w = mote_rotate(&state->pose.rotation, solved[j]);
            x[j] = w.x;
            x[field->padded + j] = w.y;
            x[2 * field->padded + j] = w.z;
        }
        state->weights = (mote_weights){x, x + field->padded, x + 2 * (size_t)field->padded,
                                        field->count, field->padded};
    }
    mote_csrbf_fit_destroy(fit);
    return status;
}

static mote_status make_body(const mote_extreme_recipe *r, mote_extreme *e, int b)
{
    mote_status status =
        mote_mesh_create(&r->position[b][0].x, r->vertex_count[b], &r->triangle[b][0][0],
                         r->triangle_count[b], &e->mesh[b]);
    if (status == MOTE_OK)
        status = r->controls > 0 ? mote_field_create_csrbf(r->centre[b], r->controls,
                                                           r->support, &e->field[b])
                                 : mote_field_create_static(&e->field[b]);
    if (status != MOTE_OK)
        return status;
    e->body[b] = (mote_body){.mesh = e->mesh[b], .field = e->field[b]};
    for (uint32_t f = 0; f < MOTE_EXTREME_FRAMES; ++f) {
        mote_body_state *state = &e->frame[f].body[b];
        *state = (mote_body_state){.shape_changed = true, .pose_changed = true};
        state->pose.rotation = mote_quaternion_matrix(r->turn[b][f]);
        state->pose.translation =
            mote_sub(r->place[b][f], mote_rotate(&state->pose.rotation, r->middle[b]));
        e->frame[f].number = f + 1;
    }
    return set_weights(r, e, b);
}

mote_status mote_extreme_make(const mote_extreme_recipe *recipe, mote_extreme *e)
{
    mote_status status = MOTE_OK;
    e->refusal[0] = '\0';
    for (int b = 0; b < 2 && status == MOTE_OK; ++b)
        status = make_body(recipe, e, b);
    if (is_refusal(status))
        return refuse(e);
    if (status == MOTE_OK)
        e->length = fmax(e->mesh[0]->diagonal, e->mesh[1]->diagonal);
    return status;
}

void mote_extreme_free(mote_extreme *e)
{
    for (int b = 0; b < 2; ++b) {
        for (uint32_t f = 0; f < MOTE_EXTREME_FRAMES; ++f)
            free(e->weights[b][f]);
        mote_field_destroy(e->field[b]);
        mote_mesh_destroy(e->mesh[b]);
    }
    *e = (mote_extreme){0};
}

/* The distance at a frame in double precision, with the closest points. */
static mote_status ask_distance(const mote_extreme *e, uint32_t frame, mote_answer *answer)
{
    mote_method_choice choice;
    mote_engine *engine = NULL;
    mote_status status = mote_method_choice_read("aabb-tree", &choice);
    if (status == MOTE_OK)
        status = mote_engine_open_two(&e->body[0], &e->body[1], &choice, MOTE_ASK_DISTANCE, 0,
                                      1, &engine);
    if (status == MOTE_OK)
        status = mote_engine_answer(engine, &e->frame[frame], answer);
    mote_engine_destroy(engine);
    return status;
}

/* One step. Moving by d - gap along the closest points cannot make the distance smaller than
   the gap. */
static mote_status step(mote_extreme_recipe *recipe, uint32_t frame, double gap, double push,
                        bool *there)
{
    mote_extreme e = {0};
    mote_answer answer = {0};
    mote_status status = mote_extreme_make(recipe, &e);
    *there = true;
    if (status == MOTE_OK && !e.refusal[0])
        status = ask_distance(&e, frame, &answer);
    const double d = answer.distance, left = d - gap;
    if (status == MOTE_OK && answer.has_distance && d > 0) {
        *there = fabs(left) <= 1e-3 * gap;
        const mote_vec3 line = mote_sub(answer.witness[0], answer.witness[1]);
        const double by = *there ? push : left;
        recipe->place[1][frame] = mote_add_scaled(recipe->place[1][frame], by / d, line);
    }
    mote_extreme_free(&e);
    return status;
}

mote_status mote_extreme_set_gap(mote_extreme_recipe *recipe, uint32_t frame, double gap)
{
    const double push = gap < 0 ? -2 * gap : 0;
    bool there = false;
    mote_status status = MOTE_OK;
    for (int i = 0; i < STEPS && status == MOTE_OK && !there; ++i)
        status = step(recipe, frame, fabs(gap), push, &there);
    return status;
}

static mote_status use_letter(char letter, mote_extreme_recipe *r, int b)
{
    mote_mesh *mesh = NULL;
    mote_status status = mote_letter_create(letter, MOTE_LETTER_MIN_TRIANGLES, &mesh);
    if (status == MOTE_OK)
        status = mote_spread(mesh, CONTROLS, r->centre[b]);
    if (status == MOTE_OK && (mesh->vertex_count > MOTE_EXTREME_VERTICES ||
                              mesh->triangle_count > MOTE_EXTREME_TRIANGLES))
        status = mote_fail(MOTE_EINVAL, "letter %c: more than fits", letter);
    if (status == MOTE_OK) {
        r->vertex_count[b] = mesh->vertex_count;
        r->triangle_count[b] = mesh->triangle_count;
        memcpy(r->position[b], mesh->positions, mesh->vertex_count * sizeof(mote_vec3));
        memcpy(r->triangle[b], mesh->triangles,
               mesh->triangle_count * sizeof r->triangle[b][0]);
        r->middle[b] = mote_mesh_centre(mesh);
    }
    mote_mesh_destroy(mesh);
    return status;
}

mote_status mote_extreme_plain(mote_extreme_recipe *recipe)
{
    static const double gaps[MOTE_EXTREME_FRAMES] = {0.2, 0.02, 5e-4, -0.04};
    mote_extreme_recipe *r = recipe;
    *r = (mote_extreme_recipe){.controls = CONTROLS, .support = SUPPORT};
    mote_status status = use_letter('T', r, 0);
    if (status == MOTE_OK)
        status = use_letter('V', r, 1);
    for (uint32_t f = 0; f < MOTE_EXTREME_FRAMES; ++f) {
        r->turn[0][f] = mote_quaternion_about(mote_vec3_make(0.3, 1, 0.2), 40 + 3.0 * f);
        r->turn[1][f] = mote_quaternion_about(mote_vec3_make(1, 0.4, 0.6), -70 - 4.0 * f);
        r->place[1][f] = mote_vec3_make(1.5, 0.3, 0.2);
        for (int b = 0; b < 2; ++b) {
            mote_wave waves[CONTROLS];
            mote_waves_draw((uint64_t)b + 1, CONTROLS, 1, AMPLITUDE, 20, 60, waves);
            for (uint32_t j = 0; j < CONTROLS; ++j) {
                double sine, cosine;
                mote_turn(waves[j].phase + 0.05 * f, &sine, &cosine);
                r->move[b][f][j] = mote_scale(waves[j].amplitude, cosine);
            }
        }
    }
    for (uint32_t f = 0; f < MOTE_EXTREME_FRAMES && status == MOTE_OK; ++f)
        status = mote_extreme_set_gap(r, f, gaps[f]);
    return status;
}
