#include "core/body/field_kinds.h"
#include "core/certificate/certificate_state.h"
#include "core/impact/impact_state.h"
#include "core/skin/skin.h"

#include <stdlib.h>

/* Bounds of speeds square the weights of modes, which are pure numbers, before they multiply
   them by how far a mode moves vertices: at most so many times L, and at least L over that. */
#define MODE_MOST 1e100

mote_impact_options mote_default_impact_options(double length)
{
    return (mote_impact_options){.length = length,
                                 .resolution = 1e-6,
                                 .pieces = 128,
                                 .iterations = 10000,
                                 .patience = 10};
}

static mote_status check_options(const mote_impact_options *options)
{
    if (!(options->length > 0 && options->length < HUGE_VAL))
        return mote_fail(MOTE_EINVAL, "a length of %g; give a finite number above 0",
                         options->length);
    if (!(options->resolution >= 1e-12 && options->resolution <= 1))
        return mote_fail(MOTE_EINVAL, "a resolution of %g; give a number from 1e-12 to 1",
                         options->resolution);
    if (options->pieces < 1 || options->pieces > 1u << 20 || options->iterations < 1)
        return mote_fail(MOTE_EINVAL,
                         "%u pieces and %u iterations; give at least 1 of both, and at most "
                         "1,048,576 pieces",
                         options->pieces, options->iterations);
    return MOTE_OK;
}

static void *counted(mote_impact_search *s, size_t count, size_t size)
{
    s->bytes += (count + 1) * size;
    return calloc(count + 1, size);
}

static mote_status allocate(mote_impact_search *s)
{
    size_t functions = 0, groups = 0;
    for (int i = 0; i < 2; ++i) {
        const mote_field *field = s->body[i].field;
        if (field->count > functions)
            functions = field->count;
        if (s->groups[i].padded > groups)
            groups = s->groups[i].padded;
        s->weights[i] = counted(s, 3 * (size_t)field->padded, sizeof(double));
        s->speeds[i] = counted(s, 3 * (size_t)field->padded, sizeof(double));
        if (!s->weights[i] || !s->speeds[i])
            return mote_fail(MOTE_ENOMEM, "no memory for a search for impacts");
    }
    s->amounts = counted(s, 3 * functions, sizeof(double));
    s->sums = counted(s, 3 * groups, sizeof(double));
    s->rates = counted(s, s->options.pieces, sizeof *s->rates);
    if (!s->amounts || !s->sums || !s->rates)
        return mote_fail(MOTE_ENOMEM, "no memory for a search for impacts");
    return MOTE_OK;
}

static mote_status check_modes(const mote_field *field, int body, double length)
{
    const double *largest = mote_modes_largest(field);
    for (size_t m = 0; largest && m < field->count / 3; ++m) {
        if (largest[m] > 0 &&
            !(largest[m] >= length / MODE_MOST && largest[m] / MODE_MOST <= length))
            return mote_fail(
                MOTE_EINVAL,
                "mode %zu of body %d moves a vertex by %g, where L is %g; scale the "
                "mode and its weights",
                m, body, largest[m], length);
    }
    return MOTE_OK;
}

/* The body that the certificate is to know: of a body of which only positions are given, one
   with a field of them. */
static mote_status take_body(mote_impact_search *s, int i, const mote_body *body)
{
    const mote_field *field = body->field;
    s->body[i] = *body;
    if (field->count > 0 && !field->kind->basis && !mote_field_skin(field))
        return mote_fail(MOTE_EUNSUPPORTED,
                         "a field of kind %s is not linear in its weights, so that the speed "
                         "of its vertices is not known",
                         field->kind->name);
    if (!mote_body_is_given(body))
        return check_modes(field, i, s->options.length);
    const mote_status status = mote_lines_create(&s->own_field[i]);
    if (status != MOTE_OK)
        return status;
    s->lines[i] = mote_lines_of(s->own_field[i]);
    s->body[i] = (mote_body){.mesh = body->mesh, .field = s->own_field[i]};
    s->bytes += s->own_field[i]->bytes + sizeof *s->lines[i];
    return MOTE_OK;
}

static mote_status prepare_body(mote_impact_search *s, int i)
{
    const mote_cert_tree *tree = s->certificate->side[i].tree;
    return s->lines[i] ? mote_lines_use(s->lines[i], tree, &s->bytes)
                       : mote_impact_groups_create(&s->body[i], tree, &s->groups[i], &s->bytes);
}

void mote_impact_state(mote_impact_search *s, int i, double time, double *weights,
                       mote_body_state *state)
{
    const mote_path *path = s->question->path[i];
    if (s->lines[i])
        mote_lines_state(s->lines[i], path, time, weights, state);
    else
        mote_path_state(path, &s->body[i], time, weights, state);
}

void mote_impact_velocity(mote_impact_search *s, int i, mote_place at, double factor,
                          double *weights, mote_body_state *state)
{
    const mote_path *path = s->question->path[i];
    if (s->lines[i])
        mote_lines_velocity(s->lines[i], path, at.piece, factor, weights, state);
    else
        mote_path_velocity(path, &s->body[i], at, factor, weights, state);
}

mote_status mote_impact_create(const mote_body *const body[2],
                               const mote_impact_options *options, mote_impact_search **search)
{
    mote_status status = check_options(options);
    if (status != MOTE_OK)
        return status;
    mote_impact_search *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a search for impacts");
    made->bytes = sizeof *made;
    made->options = *options;
    for (int i = 0; i < 2 && status == MOTE_OK; ++i)
        status = take_body(made, i, body[i]);
    const mote_body *const own[2] = {&made->body[0], &made->body[1]};
    const mote_certificate_options certified =
        mote_default_certificate_options(options->length);
    if (status == MOTE_OK)
        status = mote_certificate_create(own, &certified, &made->certificate);
    for (int i = 0; i < 2 && status == MOTE_OK; ++i)
        status = prepare_body(made, i);
    if (status == MOTE_OK)
        status = allocate(made);
    if (status == MOTE_OK)
        status = mote_sweep_create(made->certificate, &made->sweep, &made->bytes);
    if (status != MOTE_OK) {
        mote_impact_destroy(made);
        return status;
    }
    *search = made;
    return MOTE_OK;
}

void mote_impact_destroy(mote_impact_search *search)
{
    if (!search)
        return;
    mote_sweep_destroy(&search->sweep);
    mote_certificate_destroy(search->certificate);
    for (int i = 0; i < 2; ++i) {
        mote_impact_groups_destroy(&search->groups[i]);
        free(search->weights[i]);
        free(search->speeds[i]);
        mote_field_destroy(search->own_field[i]);
    }
    free(search->amounts);
    free(search->sums);
    free(search->rates);
    free(search);
}

size_t mote_impact_bytes(const mote_impact_search *search)
{
    return search->bytes + mote_certificate_bytes(search->certificate);
}
