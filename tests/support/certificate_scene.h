/* Certified queries of small scenes, and what every answer promises. */
#ifndef MOTE_TESTS_CERTIFICATE_SCENE_H
#define MOTE_TESTS_CERTIFICATE_SCENE_H

#include "core/certificate/certificate.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"

static inline mote_certificate *certificate_of(const scene *s,
                                               const mote_certificate_options *options)
{
    const mote_body *const bodies[2] = {&s->body[0], &s->body[1]};
    const mote_certificate_options plain = mote_default_certificate_options(s->length);
    mote_certificate *c = NULL;
    assert_int_equal(mote_certificate_create(bodies, options ? options : &plain, &c), MOTE_OK);
    return c;
}

/* Checks what every answer promises, exact or not. */
static inline void check_bracket(const scene *s, const mote_certificate_answer *a, double truth)
{
    assert_true(a->lower >= 0);
    assert_true(a->lower <= truth);
    assert_true(a->distance >= truth - 1e-15 * s->length);
    const double apart = sqrt(mote_distance_squared(a->witness[0], a->witness[1]));
    assert_true(fabs(apart - a->distance) <= 1e-14 * s->length);
    for (int b = 0; b < 2; ++b)
        assert_true(scene_point_distance(s, b, a->witness[b]) <= 1e-14 * s->length);
}

static inline void check_exact(const scene *s, mote_certificate *c, double truth)
{
    mote_certificate_answer a;
    mote_certificate_query(c, &s->frame, NULL, -1, &a);
    check_bracket(s, &a, truth);
    assert_true(a.distance <= truth + 1e-12 * s->length);
    assert_true(a.lower >= truth - 1e-12 * s->length);
    assert_true(truth > 0 || a.distance <= 0);
}

/* Takes a field in the place of a body's own. */
static inline void use_field(scene *s, int b, mote_field *field)
{
    mote_deform_destroy(s->deform[b]);
    mote_field_destroy(s->field[b]);
    s->field[b] = field;
    s->body[b].field = field;
    need(mote_deform_create(&s->body[b], &s->deform[b]) == MOTE_OK);
}

/* Replaces both fields by linear modes: a bend and a bulge. */
static inline void use_modes(scene *s)
{
    for (int b = 0; b < 2; ++b) {
        const mote_mesh *mesh = s->mesh[b];
        mote_vec3 *modes = malloc(2 * mesh->vertex_count * sizeof *modes);
        need(modes);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            const mote_vec3 x = mote_scale(mesh->positions[v], 1 / s->length);
            modes[v] = mote_vec3_make(0, 40 * sin(9 * x.x), 25 * x.x * x.x);
            modes[mesh->vertex_count + v] = mote_scale(x, 1e3 * x.z);
        }
        mote_field *field = NULL;
        need(mote_field_create_modes(modes, 2, mesh->vertex_count, &field) == MOTE_OK);
        free(modes);
        use_field(s, b, field);
    }
}

/* The next frame of linear modes: weights (s,0,0), (0,s,0), (0,0,s) for each mode. */
static inline void next_of_modes(scene *s, double reach)
{
    scene_next(s, reach, true);
    for (int b = 0; b < 2; ++b) {
        memset(s->weights[b], 0, sizeof s->weights[b]);
        for (int m = 0; m < 2; ++m) {
            const double amount = scene_random(s, -0.002, 0.002) * s->length;
            for (int k = 0; k < 3; ++k)
                s->weights[b][k][3 * m + k] = amount;
        }
        mote_deform_all(s->deform[b], &s->frame.body[b], s->world[b]);
    }
}

#endif
