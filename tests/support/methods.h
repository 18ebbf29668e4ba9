/* Methods by name, as tests ask them. */
#ifndef MOTE_TESTS_METHODS_H
#define MOTE_TESTS_METHODS_H

#include "core/method/method.h"
#include "tests/support/test.h"

/* The method of that name, and in values its parameters: "n=5,seed=1"; "" for the defaults. */
static inline const mote_method *method_with(const char *name, const char *keys,
                                             double values[MOTE_PARAMETERS_MAX])
{
    const mote_method *m = mote_method_find(name);
    if (!m)
        fail_msg("no method %s", name);
    mote_parameters_default(m->parameters, m->parameter_count, values);
    if (mote_parameters_parse(m->parameters, m->parameter_count, keys, values) != MOTE_OK)
        fail_msg("%s:%s: %s", name, keys, mote_error_text());
    return m;
}

/* Brings the method up to date with a frame where it has something to update, and asks it. */
static inline mote_answer method_answer(const mote_method *m, void *state,
                                        const mote_frame *frame)
{
    mote_answer answer = {0};
    if (m->update)
        assert_int_equal(m->update(state, frame), MOTE_OK);
    if (m->query(state, frame, &answer) != MOTE_OK)
        fail_msg("%s: %s", m->name, mote_error_text());
    return answer;
}

/* A method that was built for a setup, with its parameters. */
typedef struct method_run {
    const mote_method *method;
    double values[MOTE_PARAMETERS_MAX];
    mote_setup setup;
    void *state;
} method_run;

/* setup.values are set here. Free with method_run_free. */
static inline void method_run_init(method_run *r, const char *name, const char *keys,
                                   mote_setup setup)
{
    r->method = method_with(name, keys, r->values);
    r->setup = setup;
    r->setup.values = r->values;
    assert_int_equal(mote_method_create(r->method, &r->setup, &r->state), MOTE_OK);
}

/* Builds the method of a method_run, and frees it; a failure leaves nothing. For
   fail_each_allocation. */
static inline mote_status method_run_build(void *context)
{
    const method_run *r = context;
    void *state = NULL;
    const mote_status status = mote_method_create(r->method, &r->setup, &state);
    if (status != MOTE_OK)
        assert_null(state);
    mote_method_destroy(r->method, state);
    return status;
}

static inline void method_run_free(method_run *r)
{
    mote_method_destroy(r->method, r->state);
}

static inline mote_answer method_run_ask(method_run *r, const mote_frame *frame)
{
    return method_answer(r->method, r->state, frame);
}

#endif
