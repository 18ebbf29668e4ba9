/* The baselines that report contact only, as far as they were built, against brute force:
   Embree, ODE, Bullet and Coal. */
#include "tests/support/shapes.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

#include <stdio.h>
#include <string.h>

typedef struct engine {
    const char *method;
    const char *values; /* "" or "key=value" pairs as on the command line */
    bool tolerance;     /* supports tolerances above 0 */
    bool posed;         /* for rigid bodies only */
} engine;

static const engine engines[] = {
    {"embree-contact", "", true, false},
    {"ode", "", false, false},
    {"ode", "vertices=single", false, false},
    {"ode", "update=rebuild", false, false},
    {"ode", "update=none", false, true},
    {"bullet-gimpact", "", false, false},
    {"bullet-gimpact", "stop=yes", false, false},
    {"bullet-gimpact", "update=none", false, true},
    {"coal-obb", "", false, false},
    {"coal-obb", "call=api", false, false},
    {"coal-obb", "update=none", false, true},
};
#define ENGINES (sizeof engines / sizeof engines[0])

/* The method and its values, or NULL if its library was missing. */
static const mote_method *find(const engine *e, double values[MOTE_PARAMETERS_MAX])
{
    return mote_method_find(e->method) ? method_with(e->method, e->values, values) : NULL;
}

/* All engines that support a scene, side by side. */
typedef struct crowd {
    const mote_method *method[ENGINES]; /* NULL: not in use */
    void *state[ENGINES];
} crowd;

static void crowd_create(crowd *c, const scene *s, double tolerance, bool deforming)
{
    *c = (crowd){0};
    for (size_t i = 0; i < ENGINES; ++i) {
        double values[MOTE_PARAMETERS_MAX];
        if ((tolerance > 0 && !engines[i].tolerance) || (deforming && engines[i].posed))
            continue;
        c->method[i] = find(&engines[i], values);
        const mote_setup setup = scene_setup(s, MOTE_ASK_CONTACT, tolerance, values);
        if (c->method[i])
            assert_int_equal(c->method[i]->create(&setup, &c->state[i]), MOTE_OK);
    }
}

static void crowd_destroy(const crowd *c)
{
    for (size_t i = 0; i < ENGINES; ++i) {
        if (c->method[i])
            c->method[i]->destroy(c->state[i]);
    }
}

static void crowd_expect(const crowd *c, const mote_frame *frame, bool contact)
{
    for (size_t i = 0; i < ENGINES; ++i) {
        const mote_method *m = c->method[i];
        if (!m)
            continue;
        mote_answer a = {0};
        assert_int_equal(m->update(c->state[i], frame), MOTE_OK);
        assert_int_equal(m->query(c->state[i], frame, &a), MOTE_OK);
        assert_true(a.has_contact && !a.has_distance);
        if (a.contact != contact)
            fail_msg("%s:%s, frame %d: contact %d is wrong", engines[i].method,
                     engines[i].values, (int)frame->number, a.contact);
    }
}

/* Moves both bodies of the frame by the same vector. */
static void move_scene(scene *s, mote_vec3 by)
{
    for (int b = 0; b < 2; ++b) {
        mote_vec3 *at = &s->frame.body[b].pose.translation;
        *at = mote_add(*at, by);
        for (uint32_t i = 0; i < s->mesh[b]->vertex_count; ++i)
            s->world[b][i] = mote_add(s->world[b][i], by);
    }
}

/* Sixty frames. Within 1e-6 L of the tolerance floats decide, so such frames are not checked.
   In every second frame the bodies keep their shape and, in half of these, their rotation. */
static void expect_contacts(double size, double tolerance, bool deforming, mote_vec3 away)
{
    scene s;
    crowd c;
    scene_init(&s, 14, 9, size, deforming);
    tolerance *= s.length;
    crowd_create(&c, &s, tolerance, deforming);
    int contacts = 0, frames = 60;
    for (int f = 0; f < frames; ++f) {
        const mote_frame *frame = scene_next(&s, 1.3, f % 2 == 1);
        const double expected = scene_truth(&s);
        move_scene(&s, away);
        if (expected == 0 || fabs(expected - tolerance) > 1e-6 * s.length)
            crowd_expect(&c, frame, expected <= tolerance);
        contacts += expected <= tolerance;
    }
    assert_in_range(contacts, 10, frames - 10);
    crowd_destroy(&c);
    scene_free(&s);
}

TEST(query_agrees_with_brute_force)
{
    static const double sizes[] = {1, 100, 0x1p-40, 0x1p40};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        expect_contacts(sizes[i], 0, true, mote_vec3_make(0, 0, 0));
        expect_contacts(sizes[i], 0, false, mote_vec3_make(0, 0, 0));
    }
    expect_contacts(1, 0.05, true, mote_vec3_make(0, 0, 0));
    expect_contacts(0x1p40, 0.05, true, mote_vec3_make(0, 0, 0));
}

/* One body moves past the other, which rests; then they change places. */
static void expect_contacts_at_rest(bool deforming)
{
    scene s;
    crowd c;
    int contacts = 0;
    scene_init(&s, 14, 9, 1, deforming);
    crowd_create(&c, &s, 0, deforming);
    const mote_frame *frame = scene_next(&s, 0, false);
    crowd_expect(&c, frame, scene_truth(&s) <= 0);
    for (int f = 0; f < 40; ++f) {
        const int b = f < 20 ? 1 : 0;
        mote_body_state *moving = &s.frame.body[b], *still = &s.frame.body[1 - b];
        moving->pose.translation.x += 0.1 * s.length;
        moving->pose_changed = true;
        moving->shape_changed = still->shape_changed = still->pose_changed = false;
        mote_deform_all(s.deform[b], moving, s.world[b]);
        ++s.frame.number;
        const bool contact = scene_truth(&s) <= 0;
        crowd_expect(&c, frame, contact);
        contacts += contact;
    }
    assert_in_range(contacts, 8, 32);
    crowd_destroy(&c);
    scene_free(&s);
}

TEST(query_with_a_body_at_rest_agrees_with_brute_force)
{
    expect_contacts_at_rest(true);
    expect_contacts_at_rest(false);
}

TEST(query_far_from_the_origin_agrees_with_brute_force)
{
    const mote_vec3 away = mote_vec3_make(0x1p20, -0x1p20, 0x1p21);
    expect_contacts(1, 0, true, away);
    expect_contacts(1, 0, false, away);
}

static void expect_refused(const engine *e, scene *s, mote_ask ask, double tolerance,
                           mote_status expected)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *m = find(e, values);
    mote_setup setup = scene_setup(s, ask, tolerance, values);
    void *state = NULL;
    assert_int_equal(m->create(&setup, &state), expected);
    assert_null(state);
}

TEST(create_of_what_cannot_be_answered_is_refused)
{
    for (size_t i = 0; i < ENGINES; ++i) {
        const engine *e = &engines[i];
        if (!mote_method_find(e->method))
            continue;
        scene s;
        scene_init(&s, 6, 4, 1, !e->posed);
        expect_refused(e, &s, MOTE_ASK_DISTANCE, 0, MOTE_EUNSUPPORTED);
        if (!e->tolerance)
            expect_refused(e, &s, MOTE_ASK_CONTACT, 0.1, MOTE_EUNSUPPORTED);
        s.mesh[0]->positions[2].x = (double)NAN;
        expect_refused(e, &s, MOTE_ASK_CONTACT, 0, MOTE_EINVAL);
        scene_free(&s);
        if (e->posed) {
            scene_init(&s, 6, 4, 1, true);
            expect_refused(e, &s, MOTE_ASK_CONTACT, 0, MOTE_EUNSUPPORTED);
            scene_free(&s);
        }
    }
}

/* Where ODE would find nothing, or crash (datasets/defects.md, 21). */
TEST(ode_refuses_a_mesh_of_one_triangle)
{
    for (size_t i = 0; i < ENGINES; ++i) {
        const engine *e = &engines[i];
        if (strcmp(e->method, "ode") != 0 || !mote_method_find(e->method))
            continue;
        for (int b = 0; b < 2; ++b) {
            scene s;
            scene_init(&s, 6, 4, 1, !e->posed);
            s.mesh[b]->triangle_count = 1;
            expect_refused(e, &s, MOTE_ASK_CONTACT, 0, MOTE_EUNSUPPORTED);
            scene_free(&s);
        }
    }
}

TEST(update_with_a_bad_frame_is_refused)
{
    for (size_t i = 0; i < ENGINES; ++i) {
        const engine *e = &engines[i];
        double values[MOTE_PARAMETERS_MAX];
        const mote_method *m = find(e, values);
        if (!m)
            continue;
        scene s;
        scene_init(&s, 14, 9, 1, !e->posed);
        mote_setup setup = scene_setup(&s, MOTE_ASK_CONTACT, 0, values);
        void *state = NULL;
        assert_int_equal(m->create(&setup, &state), MOTE_OK);
        mote_frame frame = *scene_next(&s, 1, false);
        if (e->posed) {
            frame.body[1].pose.translation.y = HUGE_VAL;
            assert_int_equal(m->update(state, &frame), MOTE_EINVAL);
        } else {
            s.world[1][3].y = HUGE_VAL;
            assert_int_equal(m->update(state, &frame), MOTE_EINVAL);
            /* What was refused is no known shape: that it did not change helps nothing. */
            frame.body[1].shape_changed = frame.body[1].pose_changed = false;
            assert_int_equal(m->update(state, &frame), MOTE_EINVAL);
            frame.body[1].shape_changed = frame.body[1].pose_changed = true;
            frame.body[0].vertices = NULL;
            assert_int_equal(m->update(state, &frame), MOTE_EINVAL);
        }
        /* Good frames after it are answered again. */
        mote_answer a = {0};
        frame = *scene_next(&s, 1, false);
        assert_int_equal(m->update(state, &frame), MOTE_OK);
        assert_int_equal(m->query(state, &frame, &a), MOTE_OK);
        if (a.contact != (scene_truth(&s) == 0))
            fail_msg("%s:%s: contact %d at distance %g after a bad frame", e->method, e->values,
                     a.contact, scene_truth(&s));
        m->destroy(state);
        scene_free(&s);
    }
}
