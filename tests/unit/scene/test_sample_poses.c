/* Sample poses of a scenario's bodies have the shapes of its frames. */
#include "harness/scene/sample_poses.h"
#include "tests/support/folder.h"
#include "tests/support/sheet.h"
#include "tests/support/test.h"

/* The largest distance of a vertex of the sample from its place in the frame, after undoing the
   pose. */
static double apart(const mote_body *body, uint32_t sample, const mote_body_state *state)
{
    double most = 0;
    for (uint32_t i = 0; i < body->mesh->vertex_count; i += 7) {
        const mote_vec3 world = mote_body_position(body, state, i);
        const mote_vec3 back =
            mote_rotate_back(&state->pose.rotation, mote_sub(world, state->pose.translation));
        const double off = mote_length(mote_sub(back, mote_body_sample(body, sample, i)));
        most = off > most ? off : most;
    }
    return most;
}

TEST(samples_are_shapes_of_frames_evenly_over_the_scenario)
{
    mote_scenario *scenario = NULL;
    assert_int_equal(mote_scenario_load("mv", &scenario), MOTE_OK);
    mote_sample_poses *poses = NULL;
    assert_int_equal(mote_sample_poses_create(scenario, &poses), MOTE_OK);
    mote_frame_buffer *buffer = mote_frame_buffer_create(scenario);
    mote_body body[2];
    mote_sample_poses_bodies(poses, scenario, body);
    for (int b = 0; b < 2; ++b) {
        assert_int_equal(body[b].sample_count, MOTE_SAMPLE_FRAMES);
        double moved = 0;
        for (uint32_t k = 0; k < MOTE_SAMPLE_FRAMES; ++k) {
            /* 600 frames: the middles of eight parts of 75. */
            const mote_frame *frame =
                mote_scenario_frame(scenario, buffer, 1 + (2 * k + 1) * 75 / 2, 0);
            assert_true(apart(&body[b], 1 + k, &frame->body[b]) < 1e-13 * scenario->length);
            moved += apart(&body[b], 0, &frame->body[b]);
        }
        assert_true(moved > 0.01 * scenario->length); /* the rest shape differs */
    }
    /* A body that has samples keeps them. */
    const mote_weights own = body[1].samples[0];
    scenario->body[0].samples = &own;
    scenario->body[0].sample_count = 1;
    mote_sample_poses_bodies(poses, scenario, body);
    assert_ptr_equal(body[0].samples, &own);
    assert_int_equal(body[0].sample_count, 1);
    mote_sample_poses_destroy(poses);
    mote_sample_poses_destroy(NULL);
    mote_frame_buffer_destroy(buffer);
    mote_scenario_destroy(scenario);
}

TEST(rigid_bodies_have_no_samples)
{
    mote_scenario *scenario = NULL;
    assert_int_equal(mote_scenario_load("tt", &scenario), MOTE_OK);
    mote_sample_poses *poses = NULL;
    assert_int_equal(mote_sample_poses_create(scenario, &poses), MOTE_OK);
    mote_body body[2];
    mote_sample_poses_bodies(poses, scenario, body);
    assert_true(body[0].sample_count == 0 && body[1].sample_count == 0);
    assert_ptr_equal(body[0].mesh, scenario->body[0].mesh);
    mote_sample_poses_destroy(poses);
    mote_scenario_destroy(scenario);
}

/* Beside a body with a field, the positions of the other one are read frame by frame. */
TEST(samples_say_which_frame_cannot_be_read)
{
    mote_scenario *scenario = NULL;
    mote_sample_poses *poses = NULL;
    for (int k = 1; k <= 16; ++k) {
        char name[16];
        (void)snprintf(name, sizeof name, "f%02d.obj", k);
        sheet_write_obj(name, k);
    }
    file_put("s.json",
             "{\"purpose\": \"p\", \"frames\": 16, \"ask\": \"distance\", \"bodies\": ["
             "{\"positions\": \"f01.obj\"}, {\"letter\": \"T\", \"triangles\": 400}]}");
    assert_int_equal(mote_scenario_load("./s.json", &scenario), MOTE_OK);
    file_put("f10.obj", "v 0 0 0\n");
    assert_int_equal(mote_sample_poses_create(scenario, &poses), MOTE_EINVAL);
    if (!strstr(mote_error_text(), "f10.obj"))
        fail_msg("%s", mote_error_text());
    assert_null(poses);
    mote_scenario_destroy(scenario);
}
