/* Scenes from plain arrays: near pairs against all pairs, answers against brute force. */
#include "core/batch/crowd.h"

#include "tests/support/crowd.h"
#include "tests/support/test.h"

enum { ROOM = 3 * MOTE_FIELD_SUMMED, MODES = 1 /* the shape that has them */ };

/* The states of a crowd as arrays: weights are turned back into the bodies' axes. */
typedef struct arrays {
    double pose[CROWD_MAX][3][4], weights[CROWD_MAX][ROOM];
    mote_controls controls[CROWD_MAX];
} arrays;

static crowd c;
static arrays a;

/* One number a mode: of a crowd's random weights only some are kept. */
static void take_modes(uint32_t i)
{
    const mote_mat3 *turn = &c.states[i].pose.rotation;
    const uint32_t count = c.states[i].weights.count;
    for (uint32_t m = 0; m < count / 3; ++m) {
        const double amount = a.weights[i][m] = c.weights[i][0][3 * m];
        for (uint32_t k = 0; k < 3; ++k) {
            const mote_vec3 axis = {k == 0, k == 1, k == 2};
            const mote_vec3 turned = mote_rotate(turn, mote_scale(axis, amount));
            c.weights[i][0][3 * m + k] = turned.x;
            c.weights[i][1][3 * m + k] = turned.y;
            c.weights[i][2][3 * m + k] = turned.z;
        }
    }
}

static void take_vectors(uint32_t i)
{
    const mote_weights *w = &c.states[i].weights;
    for (uint32_t j = 0; j < w->count; ++j) {
        const mote_vec3 back = mote_rotate_back(&c.states[i].pose.rotation,
                                                mote_vec3_make(w->x[j], w->y[j], w->z[j]));
        a.weights[i][3 * j] = back.x;
        a.weights[i][3 * j + 1] = back.y;
        a.weights[i][3 * j + 2] = back.z;
    }
}

static void take_states(void)
{
    for (uint32_t i = 0; i < c.count; ++i) {
        const mote_body_state *state = &c.states[i];
        for (int r = 0; r < 3; ++r)
            memcpy(a.pose[i][r], state->pose.rotation.m[r], 3 * sizeof(double));
        a.pose[i][0][3] = state->pose.translation.x;
        a.pose[i][1][3] = state->pose.translation.y;
        a.pose[i][2][3] = state->pose.translation.z;
        if (c.shape_of[i] == MODES)
            take_modes(i);
        else
            take_vectors(i);
        a.controls[i] =
            (mote_controls){.pose = a.pose[i][0], .weights = a.weights[i], .pose_rows = 3};
    }
}

static mote_crowd *crowd_of(const mote_crowd_options *options)
{
    const mote_mesh *meshes[CROWD_SHAPES];
    const mote_field *fields[CROWD_SHAPES];
    for (int k = 0; k < CROWD_SHAPES; ++k) {
        meshes[k] = c.shape[k]->mesh;
        fields[k] = c.shape[k]->field;
    }
    mote_crowd *made = NULL;
    if (mote_crowd_create(meshes, fields, CROWD_SHAPES, c.shape_of, c.count, options, &made) !=
        MOTE_OK)
        fail_msg("%s", mote_error_text());
    return made;
}

TEST(answers_equal_brute_force)
{
    crowd_init(&c, 6, 700, 1.3);
    const mote_crowd_options options = {.tolerance = 0.02, .threads = 2};
    mote_crowd *made = crowd_of(&options);
    assert_true(!(fabs(mote_crowd_length(made) - c.shape[0]->mesh->diagonal) >
                  c.shape[0]->mesh->diagonal));
    for (int step = 0; step < 3; ++step) {
        take_states();
        size_t count = 0;
        assert_int_equal(mote_crowd_step(made, a.controls, HUGE_VAL, &count), MOTE_OK);
        assert_int_equal(count, c.count * (c.count - 1) / 2);
        uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
        double distance[CROWD_MAX * CROWD_MAX], lower[CROWD_MAX * CROWD_MAX];
        double witness[CROWD_MAX * CROWD_MAX][2][3];
        int8_t contact[CROWD_MAX * CROWD_MAX];
        mote_crowd_pairs(made, pairs[0], distance, lower, witness[0][0], contact);
        for (size_t k = 0; k < count; ++k) {
            const double truth = crowd_distance(&c, pairs[k][0], pairs[k][1]);
            assert_true(fabs(distance[k] - truth) <= 1e-9 && lower[k] <= truth);
            assert_int_equal(contact[k], distance[k] <= 0.02);
            const mote_vec3 between = {witness[k][1][0] - witness[k][0][0],
                                       witness[k][1][1] - witness[k][0][1],
                                       witness[k][1][2] - witness[k][0][2]};
            assert_true(fabs(mote_length(between) - distance[k]) <= 1e-12);
        }
        crowd_move(&c, 0.05);
    }
    mote_crowd_destroy(made);
    mote_crowd_destroy(NULL);
    crowd_free(&c);
}

/* The distance of two bodies by a scene of its own. */
static double distance_of(mote_scene *scene, uint32_t i, uint32_t j)
{
    const uint32_t pair[1][2] = {{i, j}};
    size_t count;
    assert_int_equal(mote_scene_query(scene, c.states, pair, 1), MOTE_OK);
    return mote_scene_pairs(scene, &count)->distance;
}

/* Every pair whose bodies are near is found, those whose boxes are not are left out, and those
   that are left out though their boxes are near are farther apart. */
TEST(near_pairs_are_among_all_pairs_of_near_boxes)
{
    static const double sides[] = {1, 4, 12, 40};
    const mote_scene_options options = mote_default_scene_options();
    size_t left_out = 0;
    for (size_t s = 0; s < ROWS_OF(sides); ++s) {
        crowd_init(&c, 20, 400, sides[s]);
        mote_crowd *made = crowd_of(NULL);
        take_states();
        mote_scene *scene = crowd_scene(&c, &options);
        for (double within = 0; within < 3; within += 0.75) {
            size_t count = 0;
            assert_int_equal(mote_crowd_step(made, a.controls, within, &count), MOTE_OK);
            uint32_t pairs[CROWD_MAX * CROWD_MAX][2];
            mote_crowd_pairs(made, pairs[0], NULL, NULL, NULL, NULL);
            double box[CROWD_MAX][2][3];
            mote_crowd_bounds(made, box[0][0]);
            size_t expected = 0;
            for (uint32_t i = 0; i < c.count; ++i) {
                for (uint32_t j = i + 1; j < c.count; ++j) {
                    double squared = 0;
                    for (int k = 0; k < 3; ++k) {
                        const double d = fmax(
                            0, fmax(box[i][0][k] - box[j][1][k], box[j][0][k] - box[i][1][k]));
                        squared += d * d;
                    }
                    const bool listed =
                        expected < count && pairs[expected][0] == i && pairs[expected][1] == j;
                    expected += listed;
                    if (listed)
                        assert_true(sqrt(squared) <= within);
                    else if (sqrt(squared) <= within)
                        assert_true(++left_out && distance_of(scene, i, j) > within);
                }
            }
            assert_int_equal(expected, count);
        }
        mote_scene_destroy(scene);
        mote_crowd_destroy(made);
        crowd_free(&c);
    }
    assert_true(left_out > 0);
}

TEST(a_scene_that_asks_for_contacts_says_the_same)
{
    crowd_init(&c, 12, 400, 1.5);
    take_states();
    const mote_crowd_options ask[2] = {{.tolerance = 0.05, .threads = 1},
                                       {.tolerance = 0.05, .threads = 1, .contact = 1}};
    int8_t contact[2][CROWD_MAX * CROWD_MAX];
    size_t count[2];
    for (int k = 0; k < 2; ++k) {
        mote_crowd *made = crowd_of(&ask[k]);
        assert_int_equal(mote_crowd_step(made, a.controls, 1, &count[k]), MOTE_OK);
        mote_crowd_pairs(made, NULL, NULL, NULL, NULL, contact[k]);
        mote_crowd_destroy(made);
    }
    assert_int_equal(count[0], count[1]);
    assert_true(count[0] > 0);
    assert_memory_equal(contact[0], contact[1], count[0]);
    crowd_free(&c);
}

/* Bodies of one shape in one place: all pairs are found, each once, and touch. */
TEST(bodies_in_one_place_are_all_found)
{
    crowd_init(&c, 6, 400, 4);
    const mote_mesh *mesh = c.shape[0]->mesh;
    const mote_field *still = NULL;
    static const uint32_t shape_of[5];
    static const mote_controls controls[5];
    mote_crowd *made = NULL;
    size_t count = 0;
    assert_int_equal(mote_crowd_create(&mesh, &still, 1, shape_of, 5, NULL, &made), MOTE_OK);
    assert_int_equal(mote_crowd_step(made, controls, 0, &count), MOTE_OK);
    assert_int_equal(count, 10);
    uint32_t pairs[10][2];
    double distance[10];
    mote_crowd_pairs(made, pairs[0], distance, NULL, NULL, NULL);
    size_t k = 0;
    for (uint32_t i = 0; i < 5; ++i) {
        for (uint32_t j = i + 1; j < 5; ++j, ++k) {
            assert_true(pairs[k][0] == i && pairs[k][1] == j);
            assert_true(distance[k] <= 0);
        }
    }
    mote_crowd_destroy(made);
    crowd_free(&c);
}

TEST(bad_input_is_named)
{
    crowd_init(&c, 6, 400, 4);
    take_states();
    mote_crowd *made = crowd_of(NULL);
    size_t count;
    assert_int_equal(mote_crowd_step(made, a.controls, (double)NAN, &count), MOTE_EINVAL);
    assert_int_equal(mote_crowd_step(made, a.controls, -1, &count), MOTE_EINVAL);
    a.pose[4][1][3] = (double)NAN;
    assert_int_equal(mote_crowd_step(made, a.controls, 0, &count), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "body 4: pose: row 1, column 3"));
    mote_crowd_destroy(made);
    mote_field *given;
    assert_int_equal(mote_field_create_given(&given), MOTE_OK);
    const mote_mesh *mesh = c.shape[0]->mesh;
    const mote_field *still = NULL, *known = given;
    const mote_crowd_options threads = {.threads = 257}, none = {.threads = 0};
    const mote_crowd_options fine = {.threads = 1};
    const mote_crowd_options tolerance = {.threads = 1, .tolerance = -1};
    const struct {
        const mote_field **field;
        size_t shapes, bodies;
        uint32_t shape;
        const mote_crowd_options *options;
        const char *said;
    } bad[] = {{&still, 0, 1, 0, &fine, "1 to 2^31 - 1"},
               {&still, 1, 0, 0, &fine, "1 to 2^31 - 1"},
               {&still, UINT32_MAX / 2 + 1u, 1, 0, &fine, "1 to 2^31 - 1"},
               {&still, 1, UINT32_MAX / 2 + 1u, 0, &fine, "1 to 2^31 - 1"},
               {&still, 1, 1, 1, &fine, "body 0 has shape 1 of 1"},
               {&still, 1, 1, 0, &threads, "threads: 257"},
               {&still, 1, 1, 0, &none, "threads: 0"},
               {&still, 1, 1, 0, &tolerance, "tolerance"},
               {&known, 1, 1, 0, &fine, "shape 0 has no field"}};
    for (size_t k = 0; k < ROWS_OF(bad); ++k) {
        test_row("%s", bad[k].said);
        assert_int_equal(mote_crowd_create(&mesh, bad[k].field, bad[k].shapes, &bad[k].shape,
                                           bad[k].bodies, bad[k].options, &made),
                         MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), bad[k].said));
    }
    mote_field_destroy(given);
    crowd_free(&c);
}

/* A thousand weights of 1e15, each in range, take two bodies 1e18 L away, where no nearest pair
   is searched for: whether they touch stays open, unless the tolerance says more than the
   bracket. */
TEST(contact_beyond_the_range_of_floats_is_not_denied)
{
    enum { CENTRES = 1000 };
    static const double corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const uint32_t faces[12] = {0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3};
    static const struct {
        double apart, tolerance;
        int contact;
    } rows[] = {{1e3, 0, -1}, {1e3, 1e30, 1}, {1e15, 1, -1}};
    static double weights[3 * CENTRES], pose[2][12];
    static const mote_vec3 centres[CENTRES]; /* all at 0 */
    mote_mesh *mesh = NULL;
    mote_field *field = NULL;
    assert_int_equal(mote_mesh_create(corners, 4, faces, 4, &mesh), MOTE_OK);
    assert_int_equal(mote_field_create_csrbf(centres, CENTRES, 100, &field), MOTE_OK);
    for (size_t j = 0; j < CENTRES; ++j)
        weights[3 * j] = 1e15;
    for (size_t k = 0; k < 2 * ROWS_OF(rows); ++k) {
        const double apart = rows[k / 2].apart, tolerance = rows[k / 2].tolerance;
        test_row("row %zu, asking for %s", k / 2, k % 2 ? "contact" : "the distance");
        const mote_crowd_options options = {
            .tolerance = tolerance, .contact = k % 2, .threads = 1};
        mote_crowd *made = NULL;
        assert_int_equal(mote_crowd_create((const mote_mesh *const[]){mesh},
                                           (const mote_field *const[]){field}, 1,
                                           (const uint32_t[]){0, 0}, 2, &options, &made),
                         MOTE_OK);
        for (size_t i = 0; i < 2; ++i)
            memcpy(pose[i], (double[12]){1, 0, 0, 0, 0, 1, 0, i ? apart : 0, 0, 0, 1, 0},
                   sizeof pose[i]);
        const mote_controls controls[2] = {
            {.pose = pose[0], .weights = weights, .pose_rows = 3},
            {.pose = pose[1], .weights = weights, .pose_rows = 3}};
        size_t count = 0;
        assert_int_equal(mote_crowd_step(made, controls, HUGE_VAL, &count), MOTE_OK);
        assert_int_equal(count, 1);
        int8_t contact;
        double distance, lower;
        mote_crowd_pairs(made, NULL, &distance, &lower, NULL, &contact);
        assert_int_equal(contact, rows[k / 2].contact);
        assert_true(lower <= apart && lower <= distance);
        mote_crowd_destroy(made);
    }
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}
