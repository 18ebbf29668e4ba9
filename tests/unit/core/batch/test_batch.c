/* Batches from plain arrays: against single queries bit for bit, against a common rigid motion,
   which changes no distance, and wherever they must refuse. */
#include "core/batch/batch.h"
#include "core/certificate/certificate.h"

#include "tests/support/bodies.h"
#include "tests/support/test.h"

enum { FRAMES = 70, STRETCH = 16, ROOM = 12 * SKIN_BONES_MOST };

/* Random controls of a body that goes round smoothly, so that frames follow one another. */
typedef struct motion {
    double pose[FRAMES][3][4], weights[FRAMES][ROOM], amounts[FRAMES][SKIN_TARGETS_MOST];
} motion;

typedef struct two {
    test_body body[2];
    motion motion[2];
    mote_controls controls[2];
    double distance[FRAMES], lower[FRAMES], witness[FRAMES][2][3];
    int8_t contact[FRAMES];
} two;

static two t;

static void body_init(test_body *body, const char *kind, uint64_t *seed)
{
    mote_mesh *mesh = solid_to_mesh(solid_torus(10, 16));
    if (strcmp(kind, "skin") == 0)
        skin_body_init(body, mesh, 4, 0, seed);
    else if (strcmp(kind, "skin and morph") == 0)
        skin_body_init(body, mesh, 3, 2, seed);
    else if (strcmp(kind, "morph") == 0)
        skin_body_init(body, mesh, 0, 3, seed);
    else
        test_body_init(body, mesh,
                       strcmp(kind, "csrbf") == 0   ? 5
                       : strcmp(kind, "modes") == 0 ? -2
                                                    : 0,
                       seed);
}

static void move_body(motion *m, const test_body *body, int side, uint64_t *seed)
{
    const double length = body->mesh->diagonal;
    const mote_mat3 turn = random_rotation_matrix(seed);
    const bool bones = mote_field_skin(body->field) != NULL;
    double phase[ROOM];
    for (int i = 0; i < ROOM; ++i)
        phase[i] = random_between(seed, 0, 6);
    for (int f = 0; f < FRAMES; ++f) {
        for (int r = 0; r < 3; ++r) {
            memcpy(m->pose[f][r], turn.m[r], sizeof turn.m[r]);
            m->pose[f][r][3] = r == 0 ? side * (1 + 0.2 * cos(0.05 * f)) * length : 0.01 * f;
        }
        for (int i = 0; i < ROOM; ++i) {
            const int r = i / 4 % 3, c = i % 4;
            m->weights[f][i] = (bones && r == c) + 0.05 * length * sin(0.1 * f + phase[i]);
        }
        for (int k = 0; k < SKIN_TARGETS_MOST; ++k)
            m->amounts[f][k] = sin(0.1 * f + phase[k]);
    }
}

static void two_init(const char *const kind[2], uint64_t seed)
{
    for (int b = 0; b < 2; ++b) {
        body_init(&t.body[b], kind[b], &seed);
        move_body(&t.motion[b], &t.body[b], b, &seed);
        t.controls[b] = (mote_controls){.pose = t.motion[b].pose[0][0],
                                        .weights = t.motion[b].weights[0],
                                        .amounts = t.motion[b].amounts[0],
                                        .pose_step = 12,
                                        .weights_step = ROOM,
                                        .amounts_step = SKIN_TARGETS_MOST,
                                        .pose_rows = 3};
    }
}

static void two_free(void)
{
    for (int b = 0; b < 2; ++b)
        test_body_free(&t.body[b]);
}

static mote_batch *batch_of(const mote_batch_options *options)
{
    const mote_batch_options defaults = mote_default_batch_options();
    mote_batch *batch = NULL;
    if (mote_batch_create((const mote_mesh *const[2]){t.body[0].mesh, t.body[1].mesh},
                          (const mote_field *const[2]){t.body[0].field, t.body[1].field},
                          options ? options : &defaults, &batch) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return batch;
}

static mote_batch_run run_of(size_t stretch, size_t threads)
{
    return (mote_batch_run){.frames = FRAMES,
                            .stretch = stretch,
                            .threads = threads,
                            .tolerance = -1,
                            .distance = t.distance,
                            .lower = t.lower,
                            .witness = t.witness[0][0],
                            .contact = t.contact};
}

static void run_batch(mote_batch *batch, size_t stretch, size_t threads)
{
    const mote_batch_run run = run_of(stretch, threads);
    if (mote_batch_query(batch, t.controls, &run) != MOTE_OK)
        fail_msg("%s", mote_error_text());
}

static const char *const kinds[][2] = {{"csrbf", "csrbf"},
                                       {"modes", "static"},
                                       {"skin", "csrbf"},
                                       {"skin and morph", "morph"},
                                       {"modes", "skin"}};

/* The same frames, one by one, by the structs. Linear fields are turned here by themselves. */
static void expect_single_queries(void)
{
    const mote_body *const body[2] = {&t.body[0].body, &t.body[1].body};
    const mote_certificate_options options = mote_default_certificate_options(
        fmax(t.body[0].mesh->diagonal, t.body[1].mesh->diagonal));
    mote_certificate *certificate;
    assert_int_equal(mote_certificate_create(body, &options, &certificate), MOTE_OK);
    static double room[2][3][4 * SKIN_BONES_MOST + 64];
    for (int f = 0; f < FRAMES; ++f) {
        mote_frame frame = {.number = 1};
        for (int b = 0; b < 2; ++b) {
            const motion *m = &t.motion[b];
            mote_body_state *state = &frame.body[b];
            for (int r = 0; r < 3; ++r)
                memcpy(state->pose.rotation.m[r], m->pose[f][r], 3 * sizeof(double));
            state->pose.translation =
                mote_vec3_make(m->pose[f][0][3], m->pose[f][1][3], m->pose[f][2][3]);
            const mote_field *field = body[b]->field;
            memset(room[b], 0, sizeof room[b]);
            if (mote_field_skin(field)) {
                double matrices[SKIN_BONES_MOST][3][4];
                memcpy(matrices, m->weights[f], sizeof matrices);
                mote_morph_weights(field, (const double(*)[3][4])matrices, m->amounts[f],
                                   &state->pose.rotation, room[b][0], room[b][1], room[b][2]);
            }
            for (uint32_t j = 0; !mote_field_skin(field) && j < field->count; ++j) {
                const bool modes = strcmp(field->kind->name, "modes") == 0;
                const double *w = &m->weights[f][modes ? j / 3 : 3 * j];
                const mote_vec3 v =
                    modes ? mote_vec3_make(j % 3 == 0 ? w[0] : 0, j % 3 == 1 ? w[0] : 0,
                                           j % 3 == 2 ? w[0] : 0)
                          : mote_vec3_make(w[0], w[1], w[2]);
                const mote_vec3 turned = mote_rotate(&state->pose.rotation, v);
                room[b][0][j] = turned.x, room[b][1][j] = turned.y, room[b][2][j] = turned.z;
            }
            state->weights =
                (mote_weights){room[b][0], room[b][1], room[b][2], field->count, field->padded};
            state->shape_changed = state->pose_changed = true;
        }
        mote_certificate_answer answer;
        mote_certificate_query(certificate, &frame, NULL, -1, &answer);
        assert_memory_equal(&answer.distance, &t.distance[f], sizeof(double));
        assert_memory_equal(&answer.lower, &t.lower[f], sizeof(double));
        assert_memory_equal(answer.witness, t.witness[f], sizeof t.witness[f]);
        assert_int_equal(t.contact[f], !(answer.distance > 0));
    }
    mote_certificate_destroy(certificate);
}

TEST(one_stretch_is_single_queries_one_after_the_other)
{
    for (size_t k = 0; k < ROWS_OF(kinds); ++k) {
        test_row("%s, %s", kinds[k][0], kinds[k][1]);
        two_init(kinds[k], 7 + k);
        mote_batch *batch = batch_of(NULL);
        run_batch(batch, 0, 3);
        expect_single_queries();
        mote_batch_destroy(batch);
        two_free();
    }
}

TEST(answers_are_the_same_bits_for_any_number_of_threads_and_whatever_was_asked_before)
{
    for (size_t k = 0; k < ROWS_OF(kinds); ++k) {
        two_init(kinds[k], 17 + k);
        mote_batch *batch = batch_of(NULL);
        run_batch(batch, STRETCH, 1);
        static two expected;
        expected = t;
        for (size_t threads = 1; threads <= 4; ++threads) {
            run_batch(batch, 0, 1);
            run_batch(batch, STRETCH, threads);
            test_row("%s, %s: %zu threads", kinds[k][0], kinds[k][1], threads);
            assert_memory_equal(t.distance, expected.distance, sizeof t.distance);
            assert_memory_equal(t.lower, expected.lower, sizeof t.lower);
            assert_memory_equal(t.witness, expected.witness, sizeof t.witness);
        }
        mote_batch_destroy(batch);
        two_free();
    }
}

/* Weights turn with their bodies, so a motion of the whole world changes no distance. */
TEST(a_motion_of_the_world_changes_no_distance)
{
    uint64_t seed = 5;
    for (size_t k = 0; k < ROWS_OF(kinds); ++k) {
        test_row("%s, %s", kinds[k][0], kinds[k][1]);
        two_init(kinds[k], 27 + k);
        mote_batch *batch = batch_of(NULL);
        run_batch(batch, STRETCH, 1);
        static two before;
        before = t;
        const mote_mat3 turn = random_rotation_matrix(&seed);
        for (int b = 0; b < 2; ++b) {
            for (int f = 0; f < FRAMES; ++f) {
                const motion *from = &before.motion[b];
                for (int c = 0; c < 4; ++c) {
                    const mote_vec3 column = {from->pose[f][0][c], from->pose[f][1][c],
                                              from->pose[f][2][c]};
                    const mote_vec3 turned = mote_rotate(&turn, column);
                    t.motion[b].pose[f][0][c] = turned.x;
                    t.motion[b].pose[f][1][c] = turned.y;
                    t.motion[b].pose[f][2][c] = turned.z;
                }
            }
        }
        run_batch(batch, STRETCH, 1);
        for (int f = 0; f < FRAMES; ++f)
            assert_true(fabs(t.distance[f] - before.distance[f]) <=
                        1e-12 * t.body[0].mesh->diagonal);
        mote_batch_destroy(batch);
        two_free();
    }
}

TEST(steps_of_0_and_null_and_four_rows_mean_what_they_say)
{
    two_init(kinds[0], 37);
    static double square[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    static const double identity[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    static const double nothing[ROOM];
    mote_batch *batch = batch_of(NULL);
    t.controls[0] = (mote_controls){.pose = identity[0], .weights = nothing, .pose_rows = 3};
    run_batch(batch, STRETCH, 1);
    static two expected;
    expected = t;
    t.controls[0] = (mote_controls){.pose = NULL};
    run_batch(batch, STRETCH, 1);
    assert_memory_equal(t.distance, expected.distance, sizeof t.distance);
    t.controls[0] = (mote_controls){.pose = square[0], .pose_rows = 4};
    run_batch(batch, STRETCH, 1);
    assert_memory_equal(t.distance, expected.distance, sizeof t.distance);
    /* Answers may be left out; no frame is no work. */
    mote_batch_run run = {.frames = FRAMES, .stretch = 1, .threads = 256, .tolerance = 0};
    assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_OK);
    run.frames = 0;
    assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_OK);
    assert_true(mote_batch_bytes(batch) > 10000);
    mote_batch_destroy(batch);
    two_free();
}

TEST(contact_is_decided_unless_slack_leaves_it_open)
{
    two_init(kinds[0], 47);
    mote_batch *batch = batch_of(NULL);
    run_batch(batch, STRETCH, 1);
    static two exact;
    exact = t;
    const double middle = exact.distance[FRAMES / 2];
    mote_batch_run run = run_of(STRETCH, 2);
    run.tolerance = middle;
    assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_OK);
    int contacts = 0;
    for (int f = 0; f < FRAMES; ++f) {
        if (fabs(exact.distance[f] - middle) > 1e-12)
            assert_int_equal(t.contact[f], exact.distance[f] < middle);
        contacts += t.contact[f];
    }
    assert_true(contacts > 0 && contacts < FRAMES);
    mote_batch_destroy(batch);
    mote_batch_options options = mote_default_batch_options();
    options.slack = 0.5;
    batch = batch_of(&options);
    assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_OK);
    int open = 0;
    for (int f = 0; f < FRAMES; ++f) {
        assert_true(t.lower[f] <= exact.distance[f] &&
                    t.distance[f] >= exact.distance[f] - 1e-12);
        open += t.contact[f] < 0;
    }
    assert_true(open > 0);
    mote_batch_destroy(batch);
    two_free();
}

/* Samples of likely poses: other trees, the same distances. */
TEST(samples_change_no_distance)
{
    two_init(kinds[2], 57);
    mote_batch *batch = batch_of(NULL);
    run_batch(batch, STRETCH, 1);
    static two expected;
    expected = t;
    mote_batch_destroy(batch);
    mote_batch_options options = mote_default_batch_options();
    for (int b = 0; b < 2; ++b) {
        options.sample_count[b] = 5;
        options.samples[b] = t.controls[b];
    }
    batch = batch_of(&options);
    run_batch(batch, STRETCH, 1);
    for (int f = 0; f < FRAMES; ++f)
        assert_true(fabs(t.distance[f] - expected.distance[f]) <= 1e-12);
    mote_batch_destroy(batch);
    t.motion[0].weights[3][1] = (double)NAN;
    const mote_mesh *const meshes[2] = {t.body[0].mesh, t.body[1].mesh};
    const mote_field *const fields[2] = {t.body[0].field, t.body[1].field};
    assert_int_equal(mote_batch_create(meshes, fields, &options, &batch), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "sample 3 of body 0: weights: number 1 is"));
    options.sample_count[0] = 65;
    assert_int_equal(mote_batch_create(meshes, fields, &options, &batch), MOTE_EINVAL);
    options.sample_count[0] = 0;
    static const double slacks[3] = {HUGE_VAL, -1, NAN};
    for (size_t k = 0; k < ROWS_OF(slacks); ++k) {
        options.slack = slacks[k];
        assert_int_equal(mote_batch_create(meshes, fields, &options, &batch), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "it must be finite and not negative"));
    }
    two_free();
}

TEST(the_first_bad_frame_and_its_body_are_named)
{
    static const struct {
        size_t row, column;
        double value;
        const char *said;
    } bad[] = {{0, 0, NAN, "body 1: pose: row 0, column 0 is"},
               {2, 3, -INFINITY, "body 1: pose: row 2, column 3 is -inf; it must be finite"},
               {1, 3, 1e300, "body 1: pose: the translation 1e+300 is above 2^50 L"},
               {1, 1, 9, "body 1: pose: not a rotation"},
               {3, 2, 1, "body 1: weights: number 2 is nan"},
               {3, 3, 1e290, "body 1: weights: number 3 is 1e+290"}};
    for (size_t k = 0; k < ROWS_OF(bad); ++k) {
        test_row("%s", bad[k].said);
        two_init(kinds[0], 67);
        mote_batch *batch = batch_of(NULL);
        for (int f = 41; f < FRAMES; f += 13) {
            if (bad[k].row < 3)
                t.motion[1].pose[f][bad[k].row][bad[k].column] = bad[k].value;
            else
                t.motion[1].weights[f][bad[k].column] =
                    bad[k].value > 1 ? bad[k].value : (double)NAN;
        }
        for (size_t threads = 1; threads < 4; ++threads) {
            const mote_batch_run run = run_of(threads == 1 ? 0 : 8, threads);
            assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_EINVAL);
            assert_non_null(strstr(mote_error_text(), "frame 41, "));
            assert_non_null(strstr(mote_error_text(), bad[k].said));
        }
        mote_batch_destroy(batch);
        two_free();
    }
}

TEST(reflections_last_rows_threads_and_tolerances_are_checked)
{
    two_init(kinds[0], 77);
    mote_batch *batch = batch_of(NULL);
    mote_batch_run run = run_of(0, 1);
    static double square[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}, {0, 0, 0, 1}};
    t.controls[1] = (mote_controls){.pose = square[0], .pose_rows = 4};
    assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "reflection"));
    square[2][2] = 1;
    square[3][1] = 0.5;
    assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "the last row is 0 0.5 0 1"));
    static const size_t rows[] = {0, 2, 5, SIZE_MAX};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        t.controls[1].pose_rows = rows[i];
        assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "rows; give 3, or 4"));
    }
    t.controls[1] = (mote_controls){.pose = NULL};
    run.threads = 257;
    assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_EINVAL);
    run.threads = 0;
    assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_EINVAL);
    run.threads = 1;
    run.tolerance = (double)NAN;
    assert_int_equal(mote_batch_query(batch, t.controls, &run), MOTE_EINVAL);
    mote_batch_destroy(batch);
    two_free();
}

/* Bodies of one shape, without fields; the meshes go before the batch. */
TEST(a_batch_may_outlive_its_meshes_until_it_is_destroyed)
{
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(2));
    const double length = mesh->diagonal;
    mote_batch *batch;
    const mote_batch_options options = mote_default_batch_options();
    assert_int_equal(mote_batch_create((const mote_mesh *const[2]){mesh, mesh},
                                       (const mote_field *const[2]){NULL, NULL}, &options,
                                       &batch),
                     MOTE_OK);
    static double pose[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    pose[0][3] = 3 * length;
    double distance, witness[2][3];
    const mote_controls controls[2] = {{.pose = NULL}, {.pose = pose[0], .pose_rows = 3}};
    const mote_batch_run run = {.frames = 1,
                                .threads = 1,
                                .tolerance = -1,
                                .distance = &distance,
                                .witness = witness[0]};
    assert_int_equal(mote_batch_query(batch, controls, &run), MOTE_OK);
    assert_true(distance > length && distance < 3 * length);
    mote_mesh_destroy(mesh);
    mote_batch_destroy(batch);
    mote_batch_destroy(NULL);
}

TEST(a_body_whose_positions_are_given_is_refused)
{
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(1));
    mote_field *given;
    assert_int_equal(mote_field_create_given(&given), MOTE_OK);
    mote_batch *batch;
    const mote_batch_options options = mote_default_batch_options();
    assert_int_equal(mote_batch_create((const mote_mesh *const[2]){mesh, mesh},
                                       (const mote_field *const[2]){NULL, given}, &options,
                                       &batch),
                     MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "body 1 has no field"));
    mote_field_destroy(given);
    mote_mesh_destroy(mesh);
}

/* Two bodies of one mesh and field have one tree, unless samples make two of it. */
TEST(bodies_of_one_shape_share_their_tree)
{
    two_init(kinds[0], 87);
    const mote_mesh *const meshes[2] = {t.body[0].mesh, t.body[0].mesh};
    const mote_field *const fields[2] = {t.body[0].field, t.body[0].field};
    mote_batch_options options = mote_default_batch_options();
    static double distance[2][FRAMES];
    size_t bytes[2];
    for (int sampled = 0; sampled < 2; ++sampled) {
        options.sample_count[1] = sampled ? 1 : 0;
        options.samples[1] = t.controls[1];
        mote_batch *batch = NULL;
        assert_int_equal(mote_batch_create(meshes, fields, &options, &batch), MOTE_OK);
        run_batch(batch, STRETCH, 1);
        memcpy(distance[sampled], t.distance, sizeof t.distance);
        bytes[sampled] = mote_batch_bytes(batch);
        mote_batch_destroy(batch);
    }
    for (int f = 0; f < FRAMES; ++f)
        assert_true(fabs(distance[0][f] - distance[1][f]) <= 1e-12);
    assert_true(bytes[1] > bytes[0] + 4000);
    two_free();
}

/* Of a body that never deforms, too. */
TEST(more_than_64_samples_are_refused)
{
    two_init(kinds[0], 87);
    const mote_mesh *const meshes[2] = {t.body[0].mesh, t.body[0].mesh};
    const mote_field *const fields[2] = {t.body[0].field, NULL};
    for (int b = 0; b < 2; ++b) {
        mote_batch_options options = mote_default_batch_options();
        options.sample_count[b] = 65;
        mote_batch *batch = NULL;
        assert_int_equal(mote_batch_create(meshes, fields, &options, &batch), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "has 65; at most 64 are useful"));
    }
    two_free();
}

/* Reads one frame's controls of a field; returns whether they are accepted. */
static bool accepts(const mote_mesh *mesh, const mote_field *field, const double *weights,
                    const double *amounts)
{
    const mote_body body = {.mesh = mesh, .field = field};
    double room[3 * 8];
    assert_true(field->padded <= 8);
    const mote_controls controls = {.weights = weights, .amounts = amounts};
    mote_body_state state;
    const mote_status status =
        mote_controls_read(&body, &controls, 0, mesh->diagonal, room, &state);
    assert_true(status == MOTE_OK || status == MOTE_EINVAL);
    return status == MOTE_OK;
}

/* Amounts are pure numbers: what counts is by how much they move. */
TEST(amounts_of_enormous_targets_are_refused)
{
    static const uint32_t start[2] = {0, 1}, vertex[1] = {3};
    static const mote_vec3 move[1] = {{0, 1e300, 0}};
    const mote_morph_targets targets = {1, start, vertex, move};
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(1));
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_morphs(mesh, 0, NULL, NULL, NULL, &targets, &field),
                     MOTE_OK);
    double amount = 1e-286;
    assert_true(accepts(mesh, field, NULL, &amount));
    amount = 1e-284;
    assert_false(accepts(mesh, field, NULL, &amount));
    assert_non_null(
        strstr(mote_error_text(), "amounts: number 0 is 1e-284, times displacements of size"));
    assert_non_null(strstr(mote_error_text(), "the product at most 2^50 L"));
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

/* A target that moves nothing takes any amount. */
TEST(amounts_of_targets_that_move_nothing_are_accepted)
{
    static const uint32_t start[2] = {0, 1}, vertex[1] = {3};
    static const mote_vec3 move[1] = {{0, 0, 0}};
    const mote_morph_targets targets = {1, start, vertex, move};
    solid tiny = solid_icosphere(1);
    for (size_t i = 0; i < 3 * tiny.vertex_count; ++i)
        tiny.xyz[i] *= 1e-12;
    mote_mesh *mesh = solid_to_mesh(tiny);
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_morphs(mesh, 0, NULL, NULL, NULL, &targets, &field),
                     MOTE_OK);
    const double amount = 1e6;
    assert_true(accepts(mesh, field, NULL, &amount));
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
}

/* So are weights of linear modes. A tetrahedron whose edges are `scale`, with a mode that moves
   a vertex by `scale` times `mode`. */
TEST(weights_of_modes_are_measured_by_what_they_move)
{
    static const struct {
        double scale, mode, weight;
        bool fine;
    } rows[] = {{1, 1, 0.1, true},        {1, 1, 1e15, true},       {1, 1, 1e16, false},
                {1e-30, 1, 0.1, true},    {1e-30, 1, 1e15, true},   {1e-30, 1, 1e16, false},
                {1e20, 1, 0.1, true},     {1e20, 1, 1e30, false},   {1e100, 1, 1e15, true},
                {1e100, 1, 1e60, false},  {1, 1e300, 1e14, false},  {1, 1e300, 1, false},
                {1, 1e300, 1e-286, true}, {1, 1e-290, 1e300, true}, {1, 1e-300, 1e308, true},
                {1, 0, 1e300, true},      {1, 0, HUGE_VAL, false},  {1, 1, (double)NAN, false}};
    static const double unit[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const uint32_t faces[12] = {0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3};
    for (size_t k = 0; k < ROWS_OF(rows); ++k) {
        test_row("scale %g, mode %g, weight %g", rows[k].scale, rows[k].mode, rows[k].weight);
        double x[12];
        for (int i = 0; i < 12; ++i)
            x[i] = unit[i] * rows[k].scale;
        const mote_vec3 modes[4] = {{0, 0, 0}, {0, -rows[k].scale * rows[k].mode, 0}};
        mote_mesh *mesh = NULL;
        mote_field *field = NULL;
        assert_int_equal(mote_mesh_create(x, 4, faces, 4, &mesh), MOTE_OK);
        assert_int_equal(mote_field_create_modes(modes, 1, 4, &field), MOTE_OK);
        assert_int_equal(accepts(mesh, field, &rows[k].weight, NULL), rows[k].fine);
        if (!rows[k].fine)
            assert_non_null(strstr(mote_error_text(), "weights: number 0 is "));
        mote_field_destroy(field);
        mote_mesh_destroy(mesh);
    }
}

/* What is accepted is answered: far away, and with a mode that is next to nothing. */
TEST(weights_of_modes_that_are_accepted_are_answered)
{
    static const double sizes[] = {1e-290, 1e-30, 1, 1e30, 1e290};
    static const double unit[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const uint32_t faces[12] = {0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3};
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_create(unit, 4, faces, 4, &mesh), MOTE_OK);
    for (size_t k = 0; k < ROWS_OF(sizes); ++k) {
        test_row("mode %g", sizes[k]);
        mote_vec3 modes[4];
        for (int i = 0; i < 4; ++i)
            modes[i] = mote_vec3_make(0, 0, sizes[k]);
        mote_field *field = NULL;
        assert_int_equal(mote_field_create_modes(modes, 1, 4, &field), MOTE_OK);
        const mote_batch_options options = mote_default_batch_options();
        mote_batch *batch = NULL;
        assert_int_equal(mote_batch_create((const mote_mesh *const[]){mesh, mesh},
                                           (const mote_field *const[]){field, NULL}, &options,
                                           &batch),
                         MOTE_OK);
        const double weight = 4 / sizes[k]; /* from z = 0 .. 1 to 4 .. 5 */
        const mote_controls controls[2] = {{.weights = &weight}, {.pose = NULL}};
        double distance = 0, lower = 0;
        const mote_batch_run run = {.frames = 1,
                                    .stretch = 1,
                                    .threads = 1,
                                    .tolerance = -1,
                                    .distance = &distance,
                                    .lower = &lower};
        assert_int_equal(mote_batch_query(batch, controls, &run), MOTE_OK);
        assert_true(fabs(distance - 3) < 1e-12 && lower <= distance && lower > 3 - 1e-9);
        mote_batch_destroy(batch);
        mote_field_destroy(field);
    }
    mote_mesh_destroy(mesh);
}
