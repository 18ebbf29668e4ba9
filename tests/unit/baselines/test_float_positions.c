/* Positions as floats: what is written, what is refused, and which bodies are converted when.
 */
#include "baselines/float_positions.h"

#include "tests/support/shapes.h"
#include "tests/support/test.h"

enum { MOST = 200 };

typedef struct floats {
    float position[2][MOST][4];
    mote_float_pair pair;
} floats;

static void floats_init(floats *f, const scene *s)
{
    *f = (floats){.pair = {.scale = ldexp(1, -ilogb(s->length))}};
    for (int b = 0; b < 2; ++b) {
        need(s->mesh[b]->vertex_count <= MOST);
        f->pair.count[b] = s->mesh[b]->vertex_count;
        f->pair.position[b] = f->position[b];
    }
}

/* Every position, taken back to the world, is within the margin, which has room for seven more
   roundings of this size. */
static void check_positions(const floats *f, const scene *s)
{
    const mote_float_pair *p = &f->pair;
    for (int b = 0; b < 2; ++b) {
        const double limit = (double)mote_float_margin(p->coordinate_max[b]) / 8;
        double most = 0;
        for (uint32_t i = 0; i < p->count[b]; ++i) {
            const float *at = p->position[b][i];
            const mote_vec3 v = mote_scale(mote_sub(s->world[b][i], p->origin), p->scale);
            const double exact[3] = {v.x, v.y, v.z};
            for (int k = 0; k < 3; ++k) {
                assert_true(fabs((double)at[k] - exact[k]) <= limit);
                most = fmax(most, fabs((double)at[k]));
            }
            assert_true(!(fabsf(at[3]) > 0));
        }
        assert_true(most <= (double)p->coordinate_max[b]);
        assert_true(most >= (double)p->coordinate_max[b]);
    }
}

/* Moves body b without changing its shape. */
static void shift(scene *s, int b, mote_vec3 by)
{
    for (int k = 0; k < 2; ++k)
        s->frame.body[k].shape_changed = s->frame.body[k].pose_changed = false;
    s->frame.body[b].pose_changed = true;
    for (uint32_t i = 0; i < s->mesh[b]->vertex_count; ++i)
        s->world[b][i] = mote_add(s->world[b][i], by);
}

static void expect_moved(floats *f, const scene *s, bool first, bool second)
{
    bool moved[2];
    assert_int_equal(mote_float_pair_update(&f->pair, &s->frame, moved), MOTE_OK);
    assert_int_equal(moved[0], first);
    assert_int_equal(moved[1], second);
    check_positions(f, s);
}

TEST(only_bodies_that_changed_are_converted)
{
    scene s;
    static floats f;
    scene_init(&s, 12, 8, 3, true);
    floats_init(&f, &s);
    (void)scene_next(&s, 1, false);
    expect_moved(&f, &s, true, true);
    shift(&s, 1, mote_vec3_make(0.5 * s.length, 0, 0));
    expect_moved(&f, &s, false, true);
    shift(&s, 0, mote_vec3_make(0, s.length, 0));
    expect_moved(&f, &s, true, false);
    s.frame.body[0].pose_changed = false;
    expect_moved(&f, &s, false, false);
    scene_free(&s);
}

/* The distance between the bodies does not matter: only body 0's from the origin does. */
TEST(the_origin_is_renewed_only_where_body_0_leaves_it)
{
    scene s;
    static floats f;
    scene_init(&s, 12, 8, 3, true);
    floats_init(&f, &s);
    (void)scene_next(&s, 1, false);
    expect_moved(&f, &s, true, true);
    shift(&s, 1, mote_vec3_make(1000 * s.length, 0, 0));
    expect_moved(&f, &s, false, true);
    shift(&s, 0, mote_vec3_make(0, 0, -3 * s.length));
    expect_moved(&f, &s, true, false);
    shift(&s, 0, mote_vec3_make(0, 0, -13 * s.length));
    expect_moved(&f, &s, true, true);
    assert_true(mote_distance_squared(f.pair.origin, s.world[0][0]) <= 0);
    shift(&s, 1, mote_vec3_make(-1000 * s.length, 0, 0));
    expect_moved(&f, &s, false, true);
    assert_true((double)f.pair.coordinate_max[1] < 100); /* not the largest ever */
    scene_free(&s);
}

TEST(what_is_refused_is_said_and_converted_again)
{
    static const struct {
        double x;
        const char *text;
    } cases[] = {{(double)NAN, "body 1: vertex 5 is"},
                 {(double)INFINITY, "body 1: vertex 5 is"},
                 {1e39, "body 1 is more than 1e38 L away"}};
    scene s;
    static floats f;
    bool moved[2];
    scene_init(&s, 12, 8, 3, true);
    floats_init(&f, &s);
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        (void)scene_next(&s, 1, false);
        expect_moved(&f, &s, true, true);
        const double kept = s.world[1][5].x;
        s.world[1][5].x = cases[i].x * s.length;
        assert_int_equal(mote_float_pair_update(&f.pair, &s.frame, moved), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), cases[i].text));
        s.world[1][5].x = kept;
        shift(&s, 0, mote_vec3_make(0, 0, 0)); /* of body 1 nothing is new */
        expect_moved(&f, &s, true, true);
    }
    for (int b = 0; b < 2; ++b) {
        mote_frame frame = s.frame;
        frame.body[b].vertices = NULL;
        assert_int_equal(mote_float_pair_update(&f.pair, &frame, moved), MOTE_EINVAL);
        assert_non_null(strstr(mote_error_text(), "the frame has no vertices"));
    }
    scene_free(&s);
}
