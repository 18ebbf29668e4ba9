/* Searches for impacts and streamed queries when memory runs out (test_allocations.c has the
   rest of the library): a status with a text, nothing leaked, outputs untouched. */
#include "core/impact/impact_scene.h"
#include "core/method/impact_method.h"
#include "core/stream/stream_beside.h"
#include "core/stream/stream_scene.h"
#include "tests/faults/failing.h"
#include "tests/support/impact_scene.h"
#include "tests/support/methods.h"

/* Two bodies, the paths of which lead them into each other. */
typedef struct pair {
    impact_body of[2];
    double length;
} pair;

static void pair_init(pair *p, impact_kind first, impact_kind second)
{
    mote_random random = {3};
    impact_body_init(&p->of[0], make_torus(5, 4, 1), first, &random);
    impact_body_init(&p->of[1], make_torus(6, 4, 0.7), second, &random);
    p->length = fmax(p->of[0].mesh->diagonal, p->of[1].mesh->diagonal);
    if (p->of[1].path.positions)
        return;
    mote_path_line(mote_vec3_make(4, 0, 0), mote_vec3_make(0, 0, 0), p->of[1].piece[0].centre);
}

static void pair_free(pair *p)
{
    impact_body_free(&p->of[0]);
    impact_body_free(&p->of[1]);
}

static mote_status make_search(void *context)
{
    const pair *p = context;
    const mote_body *const bodies[2] = {&p->of[0].body, &p->of[1].body};
    const mote_impact_options options = mote_default_impact_options(p->length);
    mote_impact_search *search = NULL;
    const mote_status status = mote_impact_create(bodies, &options, &search);
    if (status != MOTE_OK)
        assert_null(search);
    mote_impact_destroy(search);
    return status;
}

TEST(searches_for_impacts_when_an_allocation_fails_say_so)
{
    static const impact_kind kinds[][2] = {{IMPACT_RIGID, IMPACT_CSRBF},
                                           {IMPACT_MODES, IMPACT_SKIN},
                                           {IMPACT_MORPHED_SKIN, IMPACT_ARRAYS},
                                           {IMPACT_ARRAYS, IMPACT_MORPHS}};
    for (size_t k = 0; k < ROWS_OF(kinds); ++k) {
        pair p;
        test_row("kinds %d and %d", (int)kinds[k][0], (int)kinds[k][1]);
        pair_init(&p, kinds[k][0], kinds[k][1]);
        fail_each_allocation(make_search, &p, "mote_impact_create");
        pair_free(&p);
    }
}

/* A scene of both bodies and of one that is where the first is, asked about their impact. Where
   the list of near pairs cannot grow, the scene lives on. */
static mote_status ask_impact_scene(void *context)
{
    const pair *p = context;
    const mote_body *const shapes[2] = {&p->of[0].body, &p->of[1].body};
    const mote_path paths[3] = {p->of[0].path, p->of[1].path, p->of[0].path};
    const mote_impact_options options = mote_default_impact_options(p->length);
    const mote_impact_scene_question question = {.paths = paths, .end = 1};
    mote_impact_scene *made = NULL;
    mote_impact_scene_found found = {.iterations = 77};
    mote_status status =
        mote_impact_scene_create(shapes, 2, (const uint32_t[]){0, 1, 0}, 3, &options, &made);
    if (status != MOTE_OK) {
        assert_null(made);
        return status;
    }
    status = mote_impact_scene_query(made, &question, &found);
    if (status != MOTE_OK) {
        assert_int_equal(found.iterations, 77);
        assert_string_equal(mote_error_text(), "no memory for 64 near pairs");
        assert_int_equal(mote_impact_scene_query(made, &question, &found), MOTE_OK);
    }
    assert_int_equal(found.impact.outcome, MOTE_IMPACT_FOUND);
    assert_int_equal(found.near_pairs, 3);
    assert_int_equal(found.body[1], 2);
    mote_impact_scene_destroy(made);
    return status;
}

TEST(scenes_of_impacts_when_an_allocation_fails_say_so)
{
    pair p;
    pair_init(&p, IMPACT_RIGID, IMPACT_CSRBF);
    fail_each_allocation(ask_impact_scene, &p, "mote_impact_scene_create");
    pair_free(&p);
}

static mote_status make_streams(void *context)
{
    const pair *p = context;
    const mote_body *const bodies[2] = {&p->of[0].body, &p->of[1].body};
    const mote_stream_options options = mote_default_stream_options(p->length);
    mote_stream *stream = NULL, *beside = NULL;
    uint32_t order[30] = {77};
    mote_status status = mote_stream_create(bodies, &options, &stream);
    if (status != MOTE_OK)
        assert_null(stream);
    else
        status = mote_stream_create_beside(stream, &beside);
    if (status != MOTE_OK)
        assert_null(beside);
    mote_stream_destroy(beside);
    mote_stream_destroy(stream);
    if (status != MOTE_OK)
        return status;
    status = mote_stream_order(bodies[0], order);
    assert_true(status == MOTE_OK ? order[0] < 20 : order[0] == 77);
    return status;
}

TEST(streams_when_an_allocation_fails_say_so)
{
    pair p;
    pair_init(&p, IMPACT_RIGID, IMPACT_RIGID);
    assert_int_equal(p.of[0].mesh->vertex_count, 20);
    fail_each_allocation(make_streams, &p, "streams");
    pair_free(&p);
}

/* Three bodies of two shapes, bounded and asked about: first one pair, then more than there was
   room for. */
static mote_status ask_stream_scene(void *context)
{
    static const uint32_t pairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    const pair *p = context;
    const mote_body *const shapes[2] = {&p->of[0].body, &p->of[1].body};
    const mote_positions rest[3] = {mote_positions_of(p->of[0].mesh->positions),
                                    mote_positions_of(p->of[1].mesh->positions),
                                    mote_positions_of(p->of[1].mesh->positions)};
    mote_scene_options options = mote_default_scene_options();
    options.threads = 2;
    mote_stream_scene *made = NULL;
    mote_scene_box boxes[3];
    mote_status status =
        mote_stream_scene_create(shapes, 2, (const uint32_t[]){0, 1, 1}, 3, &options, &made);
    if (status != MOTE_OK) {
        assert_null(made);
        return status;
    }
    assert_int_equal(mote_stream_scene_bounds(made, rest, NULL, boxes), MOTE_OK);
    status = mote_stream_scene_query(made, pairs, 3);
    size_t count = 77;
    (void)mote_stream_scene_pairs(made, &count);
    assert_int_equal(count, status == MOTE_OK ? 3 : 0);
    mote_stream_scene_destroy(made);
    return status;
}

TEST(scenes_of_streams_when_an_allocation_fails_say_so)
{
    pair p;
    pair_init(&p, IMPACT_RIGID, IMPACT_RIGID);
    fail_each_allocation(ask_stream_scene, &p, "mote_stream_scene_create");
    pair_free(&p);
}

/* A method of impacts, with the setup of a pair. */
typedef struct impact_work {
    const mote_impact_method *method;
    mote_setup setup;
} impact_work;

static mote_status make_impact_method(void *context)
{
    const impact_work *w = context;
    void *state = NULL;
    const mote_status status = w->method->create(&w->setup, 3, &state);
    if (status != MOTE_OK)
        assert_null(state);
    w->method->destroy(state);
    return status;
}

TEST(methods_of_streams_when_an_allocation_fails_say_so)
{
    static const struct {
        const char *name, *keys;
    } cases[] = {{"stream", ""}, {"auto", ""}, {"auto", "positions=given"}};
    pair p;
    pair_init(&p, IMPACT_CSRBF, IMPACT_RIGID);
    for (size_t k = 0; k < ROWS_OF(cases); ++k) {
        method_run w;
        test_row("%s:%s", cases[k].name, cases[k].keys);
        w.method = method_with(cases[k].name, cases[k].keys, w.values);
        w.setup = (mote_setup){.body = {&p.of[0].body, &p.of[1].body},
                               .length = p.length,
                               .ask = MOTE_ASK_DISTANCE,
                               .seed = 1,
                               .values = w.values};
        fail_each_allocation(method_run_build, &w, cases[k].name);
    }
    pair_free(&p);
}

TEST(methods_of_impacts_when_an_allocation_fails_say_so)
{
    static const char *const names[] = {"certified", "impact-sampled"};
    pair p;
    pair_init(&p, IMPACT_CSRBF, IMPACT_RIGID);
    for (size_t k = 0; k < ROWS_OF(names); ++k) {
        double values[MOTE_PARAMETERS_MAX];
        test_row("%s", names[k]);
        (void)method_with(names[k], "", values);
        impact_work w = {.method = mote_impact_method_find(names[k]),
                         .setup = {.body = {&p.of[0].body, &p.of[1].body},
                                   .length = p.length,
                                   .ask = MOTE_ASK_IMPACT,
                                   .seed = 1,
                                   .values = values}};
        fail_each_allocation(make_impact_method, &w, names[k]);
    }
    pair_free(&p);
}
