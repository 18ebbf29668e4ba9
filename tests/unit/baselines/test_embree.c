/* embree-contact, where it was built, against brute force. */
#include "tests/support/shapes.h"
#include "tests/support/test.h"

static const mote_method *embree(void)
{
    const mote_method *m = mote_method_find("embree-contact");
    if (!m)
        skip();
    return m;
}

static void run_contact(double tolerance, double size)
{
    const mote_method *m = embree();
    scene s;
    scene_init(&s, 14, 9, size, true);
    tolerance *= s.length;
    const double values[] = {0};
    mote_setup setup = scene_setup(&s, MOTE_ASK_CONTACT, tolerance, values);
    void *state = NULL;
    assert_int_equal(m->create(&setup, &state), MOTE_OK);
    int contacts = 0, frames = 60;
    for (int f = 0; f < frames; ++f) {
        const mote_frame *frame = scene_next(&s, 1.3, false);
        double expected = scene_distance(&s);
        mote_answer a = {0};
        assert_int_equal(m->update(state, frame), MOTE_OK);
        assert_int_equal(m->query(state, frame, &a), MOTE_OK);
        assert_true(a.has_contact && !a.has_distance);
        if (expected == 0 || fabs(expected - tolerance) > 1e-9 * s.length)
            assert_int_equal(a.contact, expected <= tolerance);
        contacts += expected <= tolerance;
    }
    assert_in_range(contacts, 10, frames - 10);
    m->destroy(state);
    scene_free(&s);
}

TEST(query_agrees_with_brute_force)
{
    run_contact(0, 1);
    run_contact(0.05, 1);
    run_contact(0, 0x1p-40);
    run_contact(0.05, 0x1p40);
}

TEST(create_asked_for_distance_is_unsupported)
{
    const mote_method *m = embree();
    scene s;
    scene_init(&s, 6, 4, 1, true);
    const double values[] = {0};
    mote_setup setup = scene_setup(&s, MOTE_ASK_DISTANCE, 0, values);
    void *state = NULL;
    assert_int_equal(m->create(&setup, &state), MOTE_EUNSUPPORTED);
    setup.ask = MOTE_ASK_CONTACT;
    s.mesh[0]->positions[2].x = (double)NAN;
    assert_int_equal(m->create(&setup, &state), MOTE_EINVAL);
    assert_null(state);
    scene_free(&s);
}

TEST(update_with_a_bad_frame_is_refused)
{
    const mote_method *m = embree();
    scene s;
    scene_init(&s, 6, 4, 1, true);
    const double values[] = {0};
    mote_setup setup = scene_setup(&s, MOTE_ASK_CONTACT, 0, values);
    void *state = NULL;
    assert_int_equal(m->create(&setup, &state), MOTE_OK);
    mote_frame frame = *scene_next(&s, 1, false);
    s.world[1][3].y = HUGE_VAL;
    assert_int_equal(m->update(state, &frame), MOTE_EINVAL);
    frame.body[0].vertices = NULL;
    assert_int_equal(m->update(state, &frame), MOTE_EINVAL);
    m->destroy(state);
    scene_free(&s);
}
