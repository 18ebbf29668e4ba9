/* The page's skin, evaluated from the page's numbers as plots/page/surface.js does. */
#include "harness/report/replay_skin.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <jansson.h>
#include <math.h>

#define FIRST 20u
#define LAST 25u

/* Sums a series of differences `times` times and converts steps to numbers; the caller frees
   them. */
static double *series(const json_t *object, const char *key, size_t columns, int times,
                      double step)
{
    const json_t *array = json_object_get(object, key);
    const size_t count = json_array_size(array);
    double *values = malloc((count + 1) * sizeof *values);
    assert_non_null(values);
    for (size_t i = 0; i < count; ++i)
        values[i] = json_number_value(json_array_get(array, i));
    for (int t = 0; t < times; ++t) {
        for (size_t i = columns; i < count; ++i)
            values[i] += values[i - columns];
    }
    for (size_t i = 0; i < count; ++i)
        values[i] *= step;
    return values;
}

static double number(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

typedef struct page_skin {
    double *counts, *bones, *weights, *move_counts, *targets, *moves, *columns, *amounts;
    double origin[3], unit;
    size_t bone_count, target_count;
} page_skin;

static page_skin read_page(const json_t *root)
{
    const json_t *skin = json_object_get(root, "skin");
    page_skin p = {.unit = number(skin, "unit"),
                   .bone_count = (size_t)number(skin, "boneCount"),
                   .target_count = (size_t)number(skin, "targetCount")};
    for (size_t c = 0; c < 3; ++c)
        p.origin[c] = json_number_value(json_array_get(json_object_get(skin, "origin"), c));
    p.counts = series(skin, "counts", 1, 0, 1);
    p.bones = series(skin, "bones", 1, 1, 1);
    p.weights = series(skin, "weights", 1, 0, number(skin, "weightStep"));
    p.move_counts = series(skin, "moveCounts", 1, 0, 1);
    p.targets = series(skin, "targets", 1, 0, 1);
    p.moves = series(skin, "moves", 1, 0, number(skin, "moveStep"));
    p.columns = series(root, "weights", 12 * p.bone_count, 2, number(root, "weightStep"));
    p.amounts = series(root, "amounts", p.target_count, 2, number(root, "amountStep"));
    return p;
}

static void free_page(page_skin *p)
{
    double *all[] = {p->counts,  p->bones, p->weights, p->move_counts,
                     p->targets, p->moves, p->columns, p->amounts};
    for (size_t i = 0; i < ROWS_OF(all); ++i)
        free(all[i]);
}

/* The largest distance between the page's vertices and the program's, in rest axes. */
static double largest_off(const page_skin *p, const mote_scenario *s, uint32_t frame)
{
    const size_t k = frame - FIRST;
    size_t w = 0, m = 0;
    double most = 0;
    mote_frame_buffer *buffer = mote_frame_buffer_create(s);
    const mote_body_state *state = &mote_scenario_frame(s, buffer, frame, 0)->body[0];
    for (uint32_t v = 0; v < s->body[0].mesh->vertex_count; ++v) {
        const mote_vec3 rest = s->body[0].mesh->positions[v];
        double at[3] = {rest.x, rest.y, rest.z}, q[4] = {0, 0, 0, 1}, shown[3];
        const size_t moves = p->target_count > 0 ? (size_t)p->move_counts[v] : 0;
        for (size_t i = 0; i < moves; ++i, ++m) {
            for (size_t c = 0; c < 3; ++c)
                at[c] += p->amounts[k * p->target_count + (size_t)p->targets[m]] *
                         p->moves[3 * m + c];
        }
        for (size_t c = 0; c < 3; ++c) {
            q[c] = (at[c] - p->origin[c]) / p->unit;
            shown[c] = at[c];
        }
        for (size_t i = 0; i < (size_t)p->counts[v]; ++i, ++w) {
            for (size_t j = 0; j < 12; ++j)
                shown[j % 3] += p->weights[w] * q[j / 3] *
                                p->columns[12 * (k * p->bone_count + (size_t)p->bones[w]) + j];
        }
        const mote_vec3 exact = mote_rotate_back(
            &state->pose.rotation,
            mote_sub(mote_body_position(&s->body[0], state, v), state->pose.translation));
        most = fmax(most, sqrt(mote_distance_squared(
                              exact, mote_vec3_make(shown[0], shown[1], shown[2]))));
    }
    mote_frame_buffer_destroy(buffer);
    return most;
}

static void check(const char *name)
{
    mote_scenario *s = NULL;
    if (mote_scenario_load(name, &s) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_true(mote_replay_has_skin(&s->body[0]));
    mote_text text = {0};
    mote_text_add(&text, "{");
    mote_replay_add_skin(&text, &s->body[0]);
    mote_text_add(&text, ", ");
    mote_replay_add_skin_motion(&text, s, 0, FIRST, LAST);
    mote_text_add(&text, "}");
    json_t *root = json_loads(text.data, 0, NULL);
    assert_non_null(root);
    page_skin page = read_page(root);
    for (uint32_t frame = FIRST; frame <= LAST; ++frame) {
        const double off = largest_off(&page, s, frame) / s->length;
        if (!(off < 3e-5))
            fail_msg("%s, frame %u: %g L off", name, frame, off);
    }
    free_page(&page);
    json_decref(root);
    free(text.data);
    mote_scenario_destroy(s);
}

TEST(mote_replay_skin_of_bones_is_the_program_s)
{
    check("bison-15k");
}

TEST(mote_replay_skin_of_morph_targets_is_the_program_s)
{
    check("morph");
}

TEST(mote_replay_skin_is_not_of_other_fields)
{
    mote_scenario *s = NULL;
    assert_int_equal(mote_scenario_load("vv", &s), MOTE_OK);
    assert_false(mote_replay_has_skin(&s->body[0]));
    mote_scenario_destroy(s);
}
