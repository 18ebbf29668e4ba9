/* Trees split by sample poses (build=samples): two sheets that coincide at rest and separate in
   the sample pose. */
#include "core/body/sample_split.h"
#include "tests/support/shapes.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"

enum { SIDE = 24, SHEET = SIDE * SIDE, SQUARES = (SIDE - 1) * (SIDE - 1) };

/* Vertices of one sheet, then of the other, in the same places; triangles of the two
   alternate. */
static mote_mesh *make_sheets(void)
{
    static double xyz[2 * SHEET][3];
    static uint32_t faces[4 * SQUARES][3];
    for (uint32_t i = 0; i < 2 * SHEET; ++i) {
        xyz[i][0] = i % SIDE;
        xyz[i][1] = i % SHEET / SIDE;
    }
    uint32_t(*face)[3] = faces;
    for (uint32_t k = 0; k < SIDE - 1; ++k) {
        for (uint32_t j = 0; j < SIDE - 1; ++j) {
            for (uint32_t sheet = 0; sheet < 2; ++sheet) {
                const uint32_t a = sheet * SHEET + k * SIDE + j;
                const uint32_t two[2][3] = {{a, a + 1, a + SIDE},
                                            {a + 1, a + SIDE + 1, a + SIDE}};
                memcpy(face, two, sizeof two);
                face += 2;
            }
        }
    }
    mote_mesh *mesh = NULL;
    need(mote_mesh_create(&xyz[0][0], 2 * SHEET, &faces[0][0], 4 * SQUARES, &mesh) == MOTE_OK);
    return mesh;
}

/* One mode, which lifts the second sheet. */
static mote_field *make_lift(void)
{
    static mote_vec3 mode[2 * SHEET];
    for (uint32_t i = 0; i < 2 * SHEET; ++i)
        mode[i] = mote_vec3_make(0, 0, i < SHEET ? 0 : 1);
    mote_field *field = NULL;
    need(mote_field_create_modes(mode, 1, 2 * SHEET, &field) == MOTE_OK);
    return field;
}

/* Two bodies of sheets in their sample pose, the second one turned. */
typedef struct sheets {
    mote_mesh *mesh;
    mote_field *field;
    double lift[2][3][MOTE_LANES]; /* weights; those of body 0 are the sample's */
    mote_weights sample;
    mote_body body;
    mote_vec3 world[2][2 * SHEET];
    mote_frame frame;
} sheets;

static void sheets_init(sheets *s, double height)
{
    static const mote_mat3 turns[2] = {
        {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
        {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}}};
    *s = (sheets){.mesh = make_sheets(), .field = make_lift()};
    const uint32_t count = s->field->count, padded = s->field->padded;
    s->sample = (mote_weights){s->lift[0][0], s->lift[0][1], s->lift[0][2], count, padded};
    s->body = (mote_body){s->mesh, s->field, &s->sample, 1};
    s->frame.number = 1;
    for (int b = 0; b < 2; ++b) {
        /* A mode has three functions, one an axis; their weights are the rotated axes times the
           height. */
        for (int c = 0; c < 3; ++c) {
            for (int k = 0; k < 3; ++k)
                s->lift[b][c][k] = turns[b].m[c][k] * height;
        }
        mote_body_state *state = &s->frame.body[b];
        state->pose.rotation = turns[b];
        state->pose.translation = mote_vec3_make(30 * b, 2 * b, 5.25 * b);
        state->weights =
            (mote_weights){s->lift[b][0], s->lift[b][1], s->lift[b][2], count, padded};
        state->shape_changed = state->pose_changed = true;
        state->vertices = s->world[b];
        for (uint32_t i = 0; i < s->mesh->vertex_count; ++i)
            s->world[b][i] = mote_body_position(&s->body, state, i);
    }
}

static void sheets_free(sheets *s)
{
    mote_field_destroy(s->field);
    mote_mesh_destroy(s->mesh);
}

static mote_answer ask(sheets *s, const char *name, const char *options)
{
    double values[MOTE_PARAMETERS_MAX];
    const mote_method *m = method_with(name, options, values);
    const mote_setup setup = {.body = {&s->body, &s->body},
                              .length = s->mesh->diagonal,
                              .ask = MOTE_ASK_DISTANCE,
                              .values = values};
    void *state = NULL;
    assert_int_equal(mote_method_create(m, &setup, &state), MOTE_OK);
    const mote_answer answer = method_answer(m, state, &s->frame);
    mote_method_destroy(m, state);
    return answer;
}

TEST(trees_by_sample_poses_need_fewer_boxes_and_answer_alike)
{
    static const char *const methods[] = {"aabb-tree", "fcl-aabb", "fcl-obbrss"};
    static sheets s;
    sheets_init(&s, 100);
    const double truth = ask(&s, "brute-force", "").distance;
    for (size_t i = 0; i < sizeof methods / sizeof *methods; ++i) {
        const mote_answer rest = ask(&s, methods[i], "build=rest");
        const mote_answer samples = ask(&s, methods[i], "build=samples");
        assert_true(fabs(rest.distance - truth) < 1e-12 * s.mesh->diagonal);
        assert_true(fabs(samples.distance - truth) < 1e-12 * s.mesh->diagonal);
        if (samples.counters.box_tests * 2 > rest.counters.box_tests)
            fail_msg("%s: %llu box tests, %llu without samples", methods[i],
                     (unsigned long long)samples.counters.box_tests,
                     (unsigned long long)rest.counters.box_tests);
    }
    sheets_free(&s);
}

TEST(split_parts_what_is_apart_in_a_sample)
{
    static sheets s;
    static uint32_t all[4 * SQUARES];
    mote_sample_boxes boxes;
    sheets_init(&s, 100);
    for (uint32_t i = 0; i < 4 * SQUARES; ++i)
        all[i] = i;
    assert_int_equal(mote_sample_boxes_init(&boxes, &s.body), MOTE_OK);
    assert_int_equal(boxes.poses, 2);
    const mote_sample_split split = mote_sample_split_best(&boxes, all, boxes.triangles, 0);
    assert_int_equal(split.pose, 1);
    assert_int_equal(split.axis, 2);
    for (uint32_t i = 0; i < boxes.triangles; ++i)
        assert_int_equal(mote_sample_key(&boxes, 1, 2, i) < split.at, i / 2 % 2 == 0);
    /* A part of a given size is split along the same direction. */
    const mote_sample_split half =
        mote_sample_split_best(&boxes, all, boxes.triangles, boxes.triangles / 2);
    assert_true(half.pose == 1 && half.axis == 2);
    /* No direction separates equal triangles. */
    const uint32_t same[5] = {7, 7, 7, 7, 7};
    assert_true(isinf(mote_sample_split_best(&boxes, same, 5, 0).at));
    mote_sample_boxes_free(&boxes);
    sheets_free(&s);
}

TEST(boxes_without_samples_are_those_at_rest)
{
    static sheets s;
    mote_sample_boxes boxes;
    sheets_init(&s, 100);
    s.body.sample_count = 0;
    assert_int_equal(mote_sample_boxes_init(&boxes, &s.body), MOTE_OK);
    assert_int_equal(boxes.poses, 1);
    mote_vec3 corner = s.mesh->positions[s.mesh->triangles[5][0]];
    const mote_vec3 middle =
        mote_scale(mote_add(s.mesh->low, s.mesh->high), 0.5 / s.mesh->diagonal);
    corner = mote_sub(mote_scale(corner, 1 / s.mesh->diagonal), middle);
    assert_true(boxes.box[5].low[0] <= (float)corner.x + 1e-6f &&
                (float)corner.x <= boxes.box[5].high[0] + 1e-6f);
    mote_sample_boxes_free(&boxes);
    /* Of many samples, nine poses are used, including the last sample. */
    mote_weights many[20];
    for (int i = 0; i < 20; ++i)
        many[i] = s.sample;
    double zero[MOTE_LANES] = {0};
    many[19] = (mote_weights){zero, zero, zero, s.field->count, s.field->padded};
    s.body.samples = many;
    s.body.sample_count = 20;
    assert_int_equal(mote_sample_boxes_init(&boxes, &s.body), MOTE_OK);
    assert_int_equal(boxes.poses, MOTE_SAMPLE_POSES_MAX);
    const mote_sample_box *last = boxes.box + (size_t)8 * boxes.triangles;
    assert_memory_equal(last, boxes.box, boxes.triangles * sizeof *last);
    mote_sample_boxes_free(&boxes);
    sheets_free(&s);
}

/* Triangles that are points in a row: no box has an area, and the row is parted all the same.
 */
TEST(split_of_points_in_a_row_parts_the_row)
{
    enum { POINTS = 40 };
    mote_sample_box box[POINTS];
    uint32_t all[POINTS];
    for (uint32_t i = 0; i < POINTS; ++i) {
        all[i] = i;
        box[i] = (mote_sample_box){{0, (float)i, 0}, {0, (float)i, 0}};
    }
    const mote_sample_boxes boxes = {.poses = 1, .triangles = POINTS, .box = box};
    const mote_sample_split split = mote_sample_split_best(&boxes, all, POINTS, 0);
    assert_int_equal(split.axis, 1);
    uint32_t left = 0;
    for (uint32_t i = 0; i < POINTS; ++i)
        left += mote_sample_key(&boxes, 0, 1, i) < split.at;
    assert_in_range(left, POINTS / 8, POINTS - POINTS / 8);
}

/* Fewer triangles go left than one of those by which many are judged stands for. */
TEST(split_of_few_from_many_is_along_the_row)
{
    enum { CUBES = 4000 };
    static mote_sample_box box[CUBES];
    static uint32_t all[CUBES];
    for (uint32_t i = 0; i < CUBES; ++i) {
        const float at = (float)i;
        all[i] = i;
        box[i] = (mote_sample_box){{0, 0, at}, {1, 1, at + 1}};
    }
    const mote_sample_boxes boxes = {.poses = 1, .triangles = CUBES, .box = box};
    for (uint32_t left = 1; left < 200; left *= 3) {
        const mote_sample_split split = mote_sample_split_best(&boxes, all, CUBES, left);
        assert_int_equal(split.axis, 2);
        assert_true(split.at > 0 && split.at < 2 * CUBES);
    }
}
