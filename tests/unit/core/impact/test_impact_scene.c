/* The earliest impact among several bodies, against all pairs without a broad phase, against
   fine samples, and the swept boxes against the vertices at many times. */
#include "core/impact/impact_scene.h"

#include "tests/support/impact_scene.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <time.h>

enum { BODIES = 9, SHAPES = 5 };

typedef struct crowd {
    impact_body of[BODIES]; /* those of one shape are equal but for their paths */
    uint32_t shape_of[BODIES];
    mote_path paths[BODIES];
    mote_impact_scene *scene;
    mote_impact_options options;
    mote_random random;
} crowd;

static const impact_kind kinds[SHAPES] = {IMPACT_RIGID, IMPACT_CSRBF, IMPACT_SKIN,
                                          IMPACT_MORPHED_SKIN, IMPACT_ARRAYS};

static mote_mesh *mesh_of(uint32_t shape)
{
    return shape == 0 ? impact_box(1, 0.5, 0.3) : make_torus(7, 4, 0.5 + 0.2 * shape);
}

/* Shapes are told apart by their numbers only, so that pairs come in both orders. */
static void crowd_init(crowd *c, uint64_t seed, uint32_t pieces)
{
    const mote_body *shapes[SHAPES];
    *c = (crowd){.random = {seed}};
    for (uint32_t i = 0; i < BODIES; ++i) {
        const uint32_t shape = (SHAPES - i % SHAPES) % SHAPES;
        mote_random same = {100 + shape};
        c->shape_of[i] = shape;
        impact_body_init(&c->of[i], mesh_of(shape), kinds[shape], &same);
        shapes[shape] = &c->of[i].body;
    }
    c->options = mote_default_impact_options(2);
    c->options.pieces = pieces;
    need(mote_impact_scene_create(shapes, SHAPES, c->shape_of, BODIES, &c->options,
                                  &c->scene) == MOTE_OK);
}

static void crowd_free(crowd *c)
{
    mote_impact_scene_destroy(c->scene);
    for (int i = 0; i < BODIES; ++i)
        impact_body_free(&c->of[i]);
}

/* Bodies begin spread over a square and move as far as this. */
static void move_at_random(crowd *c, double room, uint32_t pieces, double turn, bool spins)
{
    for (int i = 0; i < BODIES; ++i) {
        const mote_vec3 from = mote_vec3_make(4.0 * (i % 3), 4.0 * (i / 3), 0);
        const impact_wild w = {.pieces = pieces,
                               .from = from,
                               .to = mote_add(from, impact_vector(&c->random, room)),
                               .stray = 0.2,
                               .turn = turn,
                               .spins = spins,
                               .weights = c->shape_of[i] >= 2 ? 0.02 : 0.1};
        impact_path_random(&c->of[i], &w, &c->random);
        c->paths[i] = c->of[i].path;
    }
}

static mote_impact_scene_found ask_scene(crowd *c, const mote_impact_scene_question *q)
{
    mote_impact_scene_found found;
    if (mote_impact_scene_query(c->scene, q, &found) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return found;
}

static mote_impact_scene_question question_of(const crowd *c, double tolerance)
{
    return (mote_impact_scene_question){.paths = c->paths, .end = 1, .tolerance = tolerance};
}

/* All pairs, each by a search of its own over the whole time. Returns the earliest. */
static double earliest_of_all(const crowd *c, double tolerance, uint32_t body[2])
{
    double first = 2;
    for (uint32_t j = 1; j < BODIES; ++j) {
        for (uint32_t i = 0; i < j; ++i) {
            const mote_body *const pair[2] = {&c->of[i].body, &c->of[j].body};
            mote_impact_search *search;
            mote_impact_found found;
            need(mote_impact_create(pair, &c->options, &search) == MOTE_OK);
            const mote_impact_question q = {
                .path = {&c->paths[i], &c->paths[j]}, .end = 1, .tolerance = tolerance};
            need(mote_impact_query(search, &q, &found) == MOTE_OK);
            mote_impact_destroy(search);
            if (found.outcome != MOTE_IMPACT_NONE && found.from < first) {
                first = found.from;
                body[0] = i;
                body[1] = j;
            }
        }
    }
    return first;
}

TEST(mote_impact_scene_query_agrees_with_all_pairs)
{
    crowd c;
    int hits = 0, misses = 0;
    size_t near = 0;
    crowd_init(&c, 3, 2);
    for (int k = 0; k < 12; ++k) {
        move_at_random(&c, k % 2 ? 6 : 0.2, 1 + (uint32_t)k % 2, 0.3 * (k % 5), k % 3 == 0);
        const double tolerance = k % 4 ? 0.01 : 0;
        const mote_impact_scene_question q = question_of(&c, tolerance);
        const mote_impact_scene_found found = ask_scene(&c, &q);
        uint32_t body[2] = {0, 0};
        const double first = earliest_of_all(&c, tolerance, body);
        near += found.near_pairs;
        if (found.impact.outcome == MOTE_IMPACT_NONE) {
            assert_true(first > 1 && found.impact.from >= 1);
            ++misses;
            continue;
        }
        ++hits;
        assert_close(found.impact.from, first, 2e-6);
        assert_int_equal(found.body[0], body[0]);
        assert_int_equal(found.body[1], body[1]);
    }
    crowd_free(&c);
    assert_true(hits > 2 && misses > 0);
    assert_true(near < (size_t)12 * BODIES * (BODIES - 1) / 2 * 9 / 10);
}

/* The distance of two bodies at a time, by all pairs of triangles. */
static double distance_at(crowd *c, const uint32_t body[2], double time)
{
    impact_scene pair = {.length = 1};
    pair.of[0] = c->of[body[0]];
    pair.of[1] = c->of[body[1]];
    return impact_distance(&pair, time);
}

/* Nothing comes within the tolerance before the impact; then the two that are said do, and the
   normal points from the first to the second. */
TEST(mote_impact_scene_query_agrees_with_fine_samples)
{
    crowd c;
    int hits = 0;
    crowd_init(&c, 8, 2);
    for (int k = 0; k < 6; ++k) {
        move_at_random(&c, 6, 2, 0.5, k % 2 == 0);
        const mote_impact_scene_question q = question_of(&c, 0.02);
        const mote_impact_scene_found found = ask_scene(&c, &q);
        for (int t = 0; t <= 25 && found.impact.from > 0; ++t) {
            for (uint32_t j = 1; j < BODIES; ++j) {
                for (uint32_t i = 0; i < j; ++i)
                    assert_true(distance_at(&c, (const uint32_t[]){i, j},
                                            found.impact.from * t / 25) > 0.02 - 1e-12);
            }
        }
        if (found.impact.outcome != MOTE_IMPACT_FOUND)
            continue;
        hits += found.impact.from > 0;
        assert_true(distance_at(&c, found.body, found.impact.to) <= 0.02 + 1e-12);
        const mote_vec3 gap = mote_sub(found.impact.witness[1], found.impact.witness[0]);
        assert_close(mote_dot(gap, found.impact.normal), found.impact.distance, 1e-9);
    }
    crowd_free(&c);
    assert_true(hits > 1);
}

static void check_inside(const mote_scene_box *box, mote_vec3 p)
{
    assert_true(box->low.x <= p.x && p.x <= box->high.x);
    assert_true(box->low.y <= p.y && p.y <= box->high.y);
    assert_true(box->low.z <= p.z && p.z <= box->high.z);
}

TEST(mote_impact_scene_boxes_hold_all_vertices_at_all_times)
{
    static const double turns[] = {0, 0.1, 1, 3, 40};
    crowd c;
    crowd_init(&c, 11, IMPACT_PIECES);
    for (int k = 0; k < 20; ++k) {
        const double begin = k % 3 ? 0 : 0.31, end = k % 4 ? 1 : 0.62;
        mote_scene_box boxes[BODIES];
        move_at_random(&c, 4, 1 + (uint32_t)k % IMPACT_PIECES, turns[k % 5], k % 2 == 0);
        need(mote_impact_scene_boxes(c.scene, c.paths, begin, end, boxes) == MOTE_OK);
        for (int i = 0; i < BODIES; ++i) {
            impact_body *b = &c.of[i];
            for (int t = 0; t <= 40; ++t) {
                impact_place(b, begin + (end - begin) * t / 40);
                for (uint32_t v = 0; v < b->mesh->vertex_count; ++v)
                    check_inside(&boxes[i], b->world[v]);
            }
        }
    }
    crowd_free(&c);
}

/* A box that hardly moves has hardly a larger box; one that spins has that of its sphere. */
TEST(mote_impact_scene_boxes_are_no_larger_than_they_must)
{
    crowd c;
    mote_scene_box boxes[BODIES];
    crowd_init(&c, 1, 1);
    for (int i = 0; i < BODIES; ++i)
        c.paths[i] = c.of[i].path; /* all stand still at the origin */
    mote_path_piece *spinning = &c.of[5].piece[0];
    spinning->spins = true;
    spinning->spin = mote_vec3_make(0, 0, 100);
    need(mote_impact_scene_boxes(c.scene, c.paths, 0, 1, boxes) == MOTE_OK);
    const double radius = sqrt(0.5 * 0.5 + 0.25 * 0.25 + 0.15 * 0.15);
    assert_int_equal(c.shape_of[0], 0);
    assert_int_equal(c.shape_of[5], 0);
    assert_true(boxes[0].high.x <= radius + 1e-9); /* the ball of its only group */
    assert_true(boxes[5].high.x <= radius + 1e-9 && boxes[5].high.y >= 0.5);
    const mote_scene_box skin = boxes[3]; /* without weights as with weights of 0 */
    assert_int_equal(kinds[c.shape_of[3]], IMPACT_SKIN);
    c.of[3].piece[0].weights = NULL;
    need(mote_impact_scene_boxes(c.scene, c.paths, 0, 1, boxes) == MOTE_OK);
    assert_memory_equal(&boxes[3], &skin, sizeof skin);
    crowd_free(&c);
}

TEST(mote_impact_scene_query_exceptions)
{
    crowd c;
    crowd_init(&c, 5, 1);
    for (int i = 0; i < BODIES; ++i) {
        for (int k = 0; k < 4; ++k)
            c.of[i].piece[0].centre[k] = mote_vec3_make(5 * i, 0, 0);
        for (uint32_t v = 0; v < c.of[i].mesh->vertex_count && c.of[i].path.positions; ++v) {
            c.of[i].frame[0][v].x += 5 * i;
            c.of[i].frame[1][v].x += 5 * i;
        }
        c.paths[i] = c.of[i].path;
    }
    /* Body 5, as body 0 a box of length 1, flies at it from above: the gap ends at 0.2. */
    mote_path_line(mote_vec3_make(1.2, 15, 0), mote_vec3_make(1.2, 0, 0),
                   c.of[5].piece[0].centre);
    mote_impact_exception e = {{0, 5}, 0.1};
    mote_impact_scene_question q = question_of(&c, 0.5);
    q.exceptions = &e;
    assert_int_equal(ask_scene(&c, &q).impact.outcome, MOTE_IMPACT_FOUND);
    q.exception_count = 1;
    assert_int_equal(ask_scene(&c, &q).impact.outcome, MOTE_IMPACT_NONE);
    e.tolerance = 0.3;
    const mote_impact_scene_found near = ask_scene(&c, &q);
    assert_int_equal(near.impact.outcome, MOTE_IMPACT_FOUND);
    assert_int_equal(near.body[1], 5);
    assert_close(near.impact.distance, 0.3, 1e-4);
    e.tolerance = -1; /* left out, however near */
    for (int k = 0; k < 4; ++k)
        c.of[5].piece[0].centre[k] = mote_vec3_make(0.1, 0, 0);
    assert_int_equal(ask_scene(&c, &q).impact.outcome, MOTE_IMPACT_NONE);
    crowd_free(&c);
}

static void check_refused(crowd *c, const mote_impact_scene_question *q, const char *words)
{
    mote_impact_scene_found found;
    assert_int_equal(mote_impact_scene_query(c->scene, q, &found), MOTE_EINVAL);
    if (!strstr(mote_error_text(), words))
        fail_msg("%s", mote_error_text());
}

/* A crowd that a good question can be asked of. */
static mote_impact_scene_question good_question(crowd *c)
{
    crowd_init(c, 5, 2);
    move_at_random(c, 3, 1, 0.1, false);
    return question_of(c, 0.01);
}

TEST(mote_impact_scene_refuses_times_and_tolerances)
{
    static const double times[][2] = {{0.7, 0.2}, {-0.1, 1}, {0, 1.1}, {NAN, 1}, {0, NAN}};
    static const double tolerances[] = {NAN, -1, INFINITY};
    crowd c;
    const mote_impact_scene_question good = good_question(&c);
    mote_impact_scene_question q = good;
    for (size_t i = 0; i < ROWS_OF(times); ++i) {
        q.begin = times[i][0], q.end = times[i][1];
        check_refused(&c, &q, "impacts are looked for from");
    }
    q = good;
    for (size_t i = 0; i < ROWS_OF(tolerances); ++i) {
        q.tolerance = tolerances[i];
        check_refused(&c, &q, "a tolerance of");
    }
    crowd_free(&c);
}

TEST(mote_impact_scene_refuses_paths_of_pieces)
{
    crowd c;
    const mote_impact_scene_question good = good_question(&c);
    for (int i = 0; i < BODIES; ++i)
        c.paths[i].count = 3;
    check_refused(&c, &good, "body 0: its path has 3 pieces");
    for (int i = 0; i < BODIES; ++i)
        c.paths[i].count = 1;
    c.paths[4].count = 2;
    check_refused(&c, &good, "body 4: its path has 2 pieces");
    c.paths[4].count = 0;
    check_refused(&c, &good, "body 4: its path has 0 pieces");
    c.paths[4].count = 1;
    c.of[2].piece[0].centre[1].y = NAN;
    check_refused(&c, &good, "body 2");
    c.of[2].piece[0].centre[1].y = 0;
    /* weights: of a skin (body 3) and of functions (body 4) */
    for (int i = 3; i <= 4; ++i) {
        char says[40];
        assert_int_equal(kinds[c.shape_of[i]], i == 3 ? IMPACT_SKIN : IMPACT_CSRBF);
        c.of[i].control[0][4] = NAN;
        (void)snprintf(says, sizeof says, "body %d: a number in piece 0", i);
        check_refused(&c, &good, says);
        c.of[i].control[0][4] = 0;
    }
    crowd_free(&c);
}

TEST(mote_impact_scene_refuses_paths_of_positions)
{
    crowd c;
    const mote_impact_scene_question good = good_question(&c);
    c.of[1].frame[1][3].z = NAN;
    check_refused(&c, &good, "body 1");
    c.of[1].frame[1][3].z = 0;
    const mote_positions kept = c.of[1].positions[1];
    c.of[1].positions[1].data = NULL;
    check_refused(&c, &good, "body 1 has no positions");
    c.of[1].positions[1] = kept;
    c.of[1].positions[1].stride = 20;
    check_refused(&c, &good, "body 1 has a stride of 20 bytes");
    c.of[1].positions[1] = kept;
    c.paths[1].positions = NULL;
    check_refused(&c, &good, "body 1: its path is to be one of positions");
    c.paths[1].positions = c.of[1].positions;
    c.paths[2].positions = c.of[1].positions;
    check_refused(&c, &good, "body 2: its path is to be one of pieces");
    crowd_free(&c);
}

/* What only the pairs' searches see: the first pair that does says so. */
TEST(mote_impact_scene_refuses_turns_that_are_opposite)
{
    crowd c;
    mote_impact_scene_question q = good_question(&c);
    q.tolerance = 100; /* all are near */
    for (int i = 0; i < 4; ++i)
        c.of[8].piece[0].turn[i] = (mote_quaternion){i % 2 ? -1 : 1, 0, 0, 0};
    check_refused(&c, &q, "8: the quaternions of piece 0 of body");
    crowd_free(&c);
}

TEST(mote_impact_scene_refuses_bodies_and_shapes_that_are_not_there)
{
    static const uint32_t bodies[][2] = {{3, 3}, {3, BODIES}};
    crowd c;
    mote_impact_found found;
    mote_impact_scene *none = NULL;
    (void)good_question(&c);
    for (size_t i = 0; i < ROWS_OF(bodies); ++i)
        assert_int_equal(mote_impact_scene_pair(c.scene, c.paths, bodies[i], 0, 1, 0, &found),
                         MOTE_EINVAL);
    const mote_body *const shapes[1] = {&c.of[0].body};
    assert_int_equal(
        mote_impact_scene_create(shapes, 1, (const uint32_t[]){0, 1}, 2, &c.options, &none),
        MOTE_EINVAL);
    assert_null(none);
    crowd_free(&c);
}

TEST(mote_impact_scene_bytes_count_its_memory)
{
    crowd c;
    crowd_init(&c, 5, 2);
    assert_true(mote_impact_scene_bytes(c.scene) > 1000);
    crowd_free(&c);
}

/* The boxes of one shape, along x at these places; each moves by `step`. */
static void put_boxes(impact_body *of, mote_path *paths, uint32_t count, const double (*at)[3],
                      mote_vec3 step)
{
    for (uint32_t i = 0; i < count; ++i) {
        const mote_vec3 from = mote_vec3_make(at[i][0], at[i][1], at[i][2]);
        mote_path_line(from, mote_add(from, step), of[i].piece[0].centre);
        paths[i] = of[i].path;
    }
}

enum { MANY = 12 };

typedef struct boxes {
    impact_body of[MANY];
    mote_path paths[MANY];
    mote_impact_scene *scene;
} boxes;

static void boxes_init(boxes *b)
{
    static const uint32_t shape_of[MANY] = {0};
    mote_random random = {1};
    for (int i = 0; i < MANY; ++i)
        impact_body_init(&b->of[i], impact_box(1, 1, 1), IMPACT_RIGID, &random);
    const mote_body *const shapes[1] = {&b->of[0].body};
    const mote_impact_options options = mote_default_impact_options(1);
    need(mote_impact_scene_create(shapes, 1, shape_of, MANY, &options, &b->scene) == MOTE_OK);
}

static void boxes_free(boxes *b)
{
    mote_impact_scene_destroy(b->scene);
    for (int i = 0; i < MANY; ++i)
        impact_body_free(&b->of[i]);
}

static mote_impact_scene_found ask_boxes(boxes *b)
{
    const mote_impact_scene_question q = {.paths = b->paths, .end = 1};
    mote_impact_scene_found found;
    if (mote_impact_scene_query(b->scene, &q, &found) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return found;
}

/* Of impacts that begin at once the lowest bodies are told, in whatever order the pairs are
   come to, and whatever was asked before; more pairs are near than there was room for. */
TEST(mote_impact_scene_query_of_impacts_at_once_tells_the_lowest)
{
    boxes b;
    double at[MANY][3];
    boxes_init(&b);
    for (int k = 0; k < 4; ++k) {
        test_row("order %d", k);
        for (int i = 0; i < MANY; ++i) { /* pairs of boxes that touch, all pairs apart */
            const int pair = k % 2 ? MANY / 2 - 1 - i / 2 : i / 2;
            at[i][0] = 3 * pair + i % 2;
            at[i][1] = at[i][2] = 0;
        }
        put_boxes(b.of, b.paths, MANY, (const double(*)[3])at, mote_vec3_make(0.5, 0, 0));
        const mote_impact_scene_found found = ask_boxes(&b);
        assert_int_equal(found.impact.outcome, MOTE_IMPACT_FOUND);
        assert_true(!(found.impact.to > 0));
        assert_int_equal(found.body[0], 0);
        assert_int_equal(found.body[1], 1);
        assert_in_range(found.near_pairs, MANY / 2, MANY);
        for (int i = 0; i < MANY; ++i) /* one beside the other in y, at the same x, apart */
            at[i][0] = 0, at[i][1] = 1.1 * (k % 2 ? i : MANY - i);
        put_boxes(b.of, b.paths, MANY, (const double(*)[3])at, mote_vec3_make(0, 50, 0));
        const mote_impact_scene_found none = ask_boxes(&b);
        assert_int_equal(none.impact.outcome, MOTE_IMPACT_NONE);
        assert_int_equal(none.near_pairs, MANY * (MANY - 1) / 2);
        for (int i = 0; i < MANY; ++i) /* the same in z; nothing comes near */
            at[i][1] = 0, at[i][2] = 3.0 * (k % 2 ? i : MANY - i);
        put_boxes(b.of, b.paths, MANY, (const double(*)[3])at, mote_vec3_make(0, 0, 0));
        assert_int_equal(ask_boxes(&b).near_pairs, 0);
        memset(at, 0, sizeof at); /* all in one place */
        put_boxes(b.of, b.paths, MANY, (const double(*)[3])at, mote_vec3_make(0, 0, 0));
        const mote_impact_scene_found all = ask_boxes(&b);
        assert_int_equal(all.near_pairs, MANY * (MANY - 1) / 2);
        assert_int_equal(all.impact.outcome, MOTE_IMPACT_FOUND);
        assert_int_equal(all.body[0], 0);
        assert_int_equal(all.body[1], 1);
    }
    boxes_free(&b);
}

/* A scene of one body has a box and no impact. */
TEST(mote_impact_scene_of_one_body)
{
    mote_random random = {1};
    impact_body b;
    mote_impact_scene *only;
    impact_body_init(&b, impact_box(1, 1, 1), IMPACT_RIGID, &random);
    const mote_body *const shapes[1] = {&b.body};
    const mote_impact_options options = mote_default_impact_options(1);
    need(mote_impact_scene_create(shapes, 1, (const uint32_t[]){0}, 1, &options, &only) ==
         MOTE_OK);
    const mote_impact_scene_question q = {.paths = &b.path, .end = 1, .tolerance = 1};
    mote_impact_scene_found found;
    assert_int_equal(mote_impact_scene_query(only, &q, &found), MOTE_OK);
    assert_int_equal(found.impact.outcome, MOTE_IMPACT_NONE);
    assert_int_equal(found.near_pairs, 0);
    mote_impact_scene_destroy(only);
    impact_body_free(&b);
}

enum { ROW = 60000 };

/* Boxes in a row along x, in the order of their numbers times `factor`, 4 from middle to
   middle. factor: prime to ROW. */
static void put_in_a_row(mote_path *paths, mote_path_piece *pieces, uint64_t factor)
{
    for (uint32_t i = 0; i < ROW; ++i) {
        const double x = 4 * (double)(i * factor % ROW);
        const mote_vec3 at = mote_vec3_make(x, 0, 0);
        pieces[i] = (mote_path_piece){.turn = {{1, 0, 0, 0}}, .spins = true};
        mote_path_line(at, at, pieces[i].centre);
        paths[i] = (mote_path){.pieces = &pieces[i], .count = 1};
    }
}

static double seconds_of_query(mote_impact_scene *row, const mote_path *paths, double tolerance,
                               size_t near)
{
    const mote_impact_scene_question q = {.paths = paths, .end = 1, .tolerance = tolerance};
    mote_impact_scene_found found;
    const clock_t from = clock();
    if (mote_impact_scene_query(row, &q, &found) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(found.near_pairs, near);
    return (double)(clock() - from) / CLOCKS_PER_SEC;
}

/* The first query, and one after a leap, take about as long as one of bodies that stay: where
   bodies were always sorted by insertion they took 30 times as long. */
TEST(mote_impact_scene_query_sorts_many_bodies_that_leap)
{
    mote_mesh *mesh = impact_box(1, 1, 1);
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_static(&field), MOTE_OK);
    const mote_body body = {.mesh = mesh, .field = field};
    const mote_body *const shapes[1] = {&body};
    const mote_impact_options options = mote_default_impact_options(2);
    uint32_t *shape_of = calloc(ROW, sizeof *shape_of);
    mote_path *paths = calloc(ROW, sizeof *paths);
    mote_path_piece *pieces = calloc(ROW, sizeof *pieces);
    mote_impact_scene *row = NULL;
    assert_true(shape_of && paths && pieces);
    assert_int_equal(mote_impact_scene_create(shapes, 1, shape_of, ROW, &options, &row),
                     MOTE_OK);
    put_in_a_row(paths, pieces, 24007);
    const double first = seconds_of_query(row, paths, 0, 0);
    double same = 1e9;
    for (int k = 0; k < 3; ++k)
        same = fmin(same, seconds_of_query(row, paths, 0, 0));
    put_in_a_row(paths, pieces, 7919);
    const double leap = seconds_of_query(row, paths, 0, 0);
    if (!(first < 8 * same && leap < 8 * same))
        fail_msg("%g s at first, %g s of bodies that stay, %g s after a leap", first, same,
                 leap);
    /* in order, each is near the next one alone */
    (void)seconds_of_query(row, paths, 3.5, ROW - 1);
    mote_impact_scene_destroy(row);
    mote_field_destroy(field);
    mote_mesh_destroy(mesh);
    free(shape_of);
    free(paths);
    free(pieces);
}
