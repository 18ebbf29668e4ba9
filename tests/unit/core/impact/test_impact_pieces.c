/* The time of impact on paths of several pieces: what joins them, what they may leave out, and
   the ends of what sweeps and speeds can show. */
#include "core/impact/impact_state.h"

#include "tests/unit/core/impact/impact_ask.h"

static void two_boxes(impact_scene *s, double a, double b, uint32_t patience)
{
    impact_scene_init_patient(s, impact_box(a, a, a), impact_box(b, b, b), IMPACT_RIGID, 1,
                              patience);
}

/* No sample before the bracket is in contact; at its end all pairs of triangles are. */
static void check_samples(impact_scene *s, const mote_impact_found *found, double tolerance)
{
    for (int i = 0; i < 40; ++i)
        assert_true(impact_distance(s, i / 40.0 * found->from) > tolerance);
    if (found->outcome == MOTE_IMPACT_FOUND)
        assert_true(impact_distance(s, found->to) <= tolerance);
}

/* Weights of 0, and the body's axes where they are among them, at control point i. */
static void rest_at(impact_body *b, int k, size_t i)
{
    const size_t padded = b->field->padded, numbers = b->field->numbers;
    double *at = b->control[k] + 3 * padded * i;
    memset(at, 0, 3 * padded * sizeof *at);
    for (size_t c = 0; c < 3 && numbers > 0; ++c)
        at[c * padded + b->field->count - numbers - 3 + c] = 1;
}

/* A piece without weights is one of weights that are 0: the same answer, bit for bit. */
TEST(mote_impact_query_pieces_without_weights_are_at_rest)
{
    int impacts = 0;
    for (int kind = IMPACT_CSRBF; kind < IMPACT_ARRAYS; ++kind) {
        for (int k = 0; k < 4; ++k) {
            impact_scene s;
            test_row("kind %d, path %d", kind, k);
            impact_scene_init_patient(&s, make_torus(9, 5, 1), make_torus(7, 5, 0.7),
                                      (impact_kind)kind, (uint64_t)k, 0);
            for (int b = 0; b < 2; ++b) {
                const impact_wild w = {.pieces = 3,
                                       .from = mote_vec3_make(b ? 3 : 0, 0.4 * k - 1, 0),
                                       .to = mote_vec3_make(b ? (k == 3 ? 5 : -1) : 1, 1, 0.5),
                                       .turn = 0.2,
                                       .spins = k % 2 == 0,
                                       .weights = 0.1};
                impact_path_random(&s.of[b], &w, &s.random);
                for (size_t i = 0; i < 4; ++i) {
                    rest_at(&s.of[b], 0, i);
                    rest_at(&s.of[b], 2, i);
                }
                rest_at(&s.of[b], 1, 0);
                rest_at(&s.of[b], 1, 3);
            }
            const mote_impact_found zeros = impact_ask(&s, impact_question(&s, 0.01));
            for (int b = 0; b < 2; ++b)
                s.of[b].piece[0].weights = s.of[b].piece[2].weights = NULL;
            const mote_impact_found none = impact_ask(&s, impact_question(&s, 0.01));
            assert_memory_equal(&zeros.outcome, &none.outcome, sizeof none.outcome);
            assert_memory_equal(&zeros.from, &none.from, sizeof none.from);
            assert_memory_equal(&zeros.to, &none.to, sizeof none.to);
            assert_memory_equal(zeros.witness, none.witness, sizeof none.witness);
            assert_int_equal(zeros.iterations, none.iterations);
            impacts += none.outcome == MOTE_IMPACT_FOUND;
            check_samples(&s, &none, 0.01);
            impact_scene_free(&s);
        }
    }
    assert_in_range(impacts, 5, 19);
}

/* What centre, rotation and weights miss counts together: 0.6 of what is let pass by one of
   them is let pass, by two of them it is not. */
TEST(mote_impact_query_pieces_that_miss_each_other_a_little_by_everything)
{
    const double size = 3.5 + 1.35; /* of the centre's largest number and the torus, at least */
    const double little = 0.6 * 0x1p-42;
    for (int missed = 0; missed < 8; ++missed) {
        impact_scene s;
        test_row("missed: %d", missed);
        impact_scene_init(&s, make_torus(9, 5, 1), make_torus(7, 5, 1), IMPACT_CSRBF, 2);
        const impact_wild still = {.pieces = 2, .from = {3.5, 0, 0}, .to = {3.5, 0, 0}};
        impact_path_random(&s.of[0], &still, &s.random);
        impact_path_random(&s.of[1], &still, &s.random);
        impact_body *b = &s.of[1];
        assert_in_range(b->field->padded, 1, 64);
        double sum = 0; /* of the first function: the most that a vertex moves by a weight */
        for (uint32_t v = 0; v < b->mesh->vertex_count; ++v) {
            double phi[64];
            b->field->kind->basis(b->field, b->mesh, v, phi);
            sum = fmax(sum, phi[0]);
        }
        if (missed & 1)
            b->piece[1].centre[0].z += little * size;
        if (missed & 2) /* two entries of the rotation change by twice this */
            b->piece[1].turn[0].x += little / 4;
        if (missed & 4)
            b->control[1][0] += little * size / sum;
        const mote_impact_question q = impact_question(&s, 0);
        mote_impact_found found;
        const int parts = (missed & 1) + (missed >> 1 & 1) + (missed >> 2);
        assert_int_equal(mote_impact_query(s.search, &q, &found),
                         parts < 2 ? MOTE_OK : MOTE_EINVAL);
        impact_scene_free(&s);
    }
}

/* A spin goes over into cubic quaternions, and back. */
TEST(mote_impact_query_between_kinds_of_rotation)
{
    for (int k = 0; k < 8; ++k) {
        impact_scene s;
        impact_scene_init_patient(&s, make_torus(9, 5, 1), make_torus(7, 5, 0.7), IMPACT_RIGID,
                                  (uint64_t)k, 0);
        const impact_wild still = {.pieces = 2};
        const impact_wild w = {.pieces = 2,
                               .from = {3, 0.3 * k - 1, 0},
                               .to = {-1, 1, 0.5},
                               .spins = true,
                               .turn = 1};
        impact_path_random(&s.of[0], &still, &s.random);
        impact_path_random(&s.of[1], &w, &s.random);
        mote_path_piece *cubic = &s.of[1].piece[k % 2];
        const mote_quaternion start = cubic->turn[0];
        const mote_quaternion end = impact_spun(cubic->spin, start);
        cubic->spins = false;
        cubic->turn[1] = impact_spun(mote_scale(cubic->spin, 1.0 / 3), start);
        cubic->turn[2] = impact_spun(mote_scale(cubic->spin, 2.0 / 3), start);
        cubic->turn[3] = end;
        const mote_impact_found found = impact_ask(&s, impact_question(&s, 0.01));
        assert_true(found.outcome == MOTE_IMPACT_FOUND || found.outcome == MOTE_IMPACT_NONE);
        check_samples(&s, &found, 0.01);
        impact_scene_free(&s);
    }
}

/* Pieces that miss each other, by each thing that a piece ends with. */
TEST(mote_impact_query_pieces_that_do_not_join_are_refused)
{
    static const impact_kind kinds[] = {IMPACT_RIGID,       IMPACT_RIGID, IMPACT_CSRBF,
                                        IMPACT_CSRBF,       IMPACT_SKIN,  IMPACT_MORPHED_SKIN,
                                        IMPACT_MORPHED_SKIN};
    for (size_t k = 0; k < ROWS_OF(kinds); ++k) {
        impact_scene s;
        test_row("row %zu", k);
        impact_scene_init(&s, make_torus(9, 5, 1), make_torus(7, 5, 0.7), kinds[k], 2);
        const impact_wild w = {.pieces = 3, .from = {3, 0, 0}, .turn = 0.1, .weights = 0.05};
        impact_path_random(&s.of[0], &w, &s.random);
        impact_path_random(&s.of[1], &w, &s.random);
        const mote_impact_question q = impact_question(&s, 0);
        (void)impact_ask(&s, q);
        impact_body *b = &s.of[1];
        double *control = b->control[1];
        if (k == 0)
            b->piece[1].centre[0].z += 1e-9;
        else if (k == 1)
            b->piece[1].turn[0].x += 1e-9;
        else if (k == 3 || k == 6)
            b->piece[1].weights = NULL; /* from what piece 0 ends with to rest */
        else if (k == 5)
            control[b->field->count - 1] += 1e-6; /* an amount */
        else
            control[3] += 1e-6;
        mote_impact_found found;
        assert_int_equal(mote_impact_query(s.search, &q, &found), MOTE_EINVAL);
        assert_string_equal(mote_error_text(),
                            "piece 1 of body 1's path does not begin where piece 0 ends");
        b->piece[0].centre[1].x = NAN; /* the first thing that is wrong is told */
        assert_int_equal(mote_impact_query(s.search, &q, &found), MOTE_EINVAL);
        assert_string_equal(mote_error_text(),
                            "the centre in piece 0 of body 1's path is not finite");
        impact_scene_free(&s);
    }
}

/* From just above the tolerance away: the first step is shorter than the bracket, and what is
   seen ahead proves all of the time since, also that before the piece began. */
TEST(mote_impact_query_body_that_leaves_from_the_tolerance)
{
    for (int pieces = 1; pieces <= 2; ++pieces) {
        impact_scene s;
        two_boxes(&s, 1, 1, UINT32_MAX);
        s.of[0].path.count = s.of[1].path.count = (uint32_t)pieces;
        for (int k = 0; k < pieces; ++k)
            mote_path_line(mote_vec3_make(2 + 5 * (k - pieces + 1), 0, 0),
                           mote_vec3_make(7 + 5 * (k - pieces + 1), 0, 0),
                           s.of[1].piece[k].centre);
        mote_impact_question question = impact_question(&s, 1 - 1e-9);
        question.begin = pieces == 1 ? 0 : 0.5;
        const mote_impact_found found = impact_ask(&s, question);
        assert_int_equal(found.outcome, MOTE_IMPACT_NONE);
        assert_true(found.from >= 1);
        assert_in_range(found.iterations, 3, 30);
        impact_scene_free(&s);
    }
}

/* A body comes to within what rounding hides of the tolerance, and stays there. */
TEST(mote_impact_query_body_that_stops_at_the_tolerance_is_grazing)
{
    impact_scene s;
    two_boxes(&s, 1, 1, UINT32_MAX);
    s.of[0].path.count = s.of[1].path.count = 2;
    mote_path_line(mote_vec3_make(4, 0, 0), mote_vec3_make(2, 0, 0), s.of[1].piece[0].centre);
    mote_path_line(mote_vec3_make(2, 0, 0), mote_vec3_make(2, 0, 0), s.of[1].piece[1].centre);
    const mote_impact_found found = impact_ask(&s, impact_question(&s, 1 - 1e-12));
    assert_int_equal(found.outcome, MOTE_IMPACT_GRAZING);
    assert_true(found.from > 0.5 - 1e-9 && found.from < 0.5 + 2e-6);
    assert_true(found.distance > 1 - 1e-12 && found.distance < 1 + 1e-9);
    impact_scene_free(&s);
}

/* It slows down towards the tolerance: x = 2 + 2 (1 - t)^3. The steps end before it is there.
 */
TEST(mote_impact_query_slow_approach_is_proven_as_far_as_the_iterations_go)
{
    impact_scene s;
    two_boxes(&s, 1, 1, UINT32_MAX);
    s.search->options.iterations = 300;
    mote_path_piece *p = s.of[1].piece;
    p->centre[0] = mote_vec3_make(4, 0, 0);
    p->centre[1] = p->centre[2] = p->centre[3] = mote_vec3_make(2, 0, 0);
    const mote_impact_found found = impact_ask(&s, impact_question(&s, 1 - 1e-12));
    assert_int_equal(found.outcome, MOTE_IMPACT_UNDECIDED);
    assert_true(found.from > 0.8 && found.from < 1);
    assert_true(fabs(found.distance - 1 - 2 * pow(1 - found.to, 3)) < 1e-12);
    assert_true(found.distance > 1 - 1e-12);
    impact_scene_free(&s);
}

/* Piece 1 leads a thousand million away, and its rounding is more than the gap with which piece
   0 ends: no sweep over both of them shows anything, but speeds do. */
TEST(mote_impact_query_gap_below_the_noise_of_the_piece_that_follows)
{
    impact_scene s;
    two_boxes(&s, 1, 1, 0);
    const double gap = 1e-4;
    s.of[0].path.count = s.of[1].path.count = 2;
    mote_path_line(mote_vec3_make(1 + gap, -0.1, 0), mote_vec3_make(1 + gap, 0, 0),
                   s.of[1].piece[0].centre);
    mote_vec3 *far = s.of[1].piece[1].centre;
    mote_path_line(mote_vec3_make(1 + gap, 0, 0), mote_vec3_make(1e9, 0, 0), far);
    far[1] = far[0];
    mote_impact_question question = impact_question(&s, 0);
    question.begin = 0.5 - 5e-8;
    question.end = 0.5;
    const mote_impact_found before = impact_ask(&s, question);
    assert_int_equal(before.outcome, MOTE_IMPACT_NONE);
    question.end = 1;
    const mote_impact_found found = impact_ask(&s, question);
    /* nothing is proven in piece 1, where rounding hides the gap */
    assert_int_equal(found.outcome, MOTE_IMPACT_GRAZING);
    assert_true(found.from >= 0.5 && found.from < 0.5 + 1e-6);
    assert_true(fabs(found.distance - gap) < 1e-3);
    impact_scene_free(&s);
}

/* Of a path so long that its acceleration is no number any more: no sweeps, and the same impact
   at a distance against which the bodies are small. */
TEST(mote_impact_query_acceleration_that_overflows)
{
    static const double control[] = {4, 7, 3, 0}; /* x, in units of 1e153 */
    impact_scene s;
    two_boxes(&s, 1e129, 1e129, 0);
    for (int i = 0; i < 4; ++i)
        s.of[1].piece[0].centre[i] = mote_vec3_make(control[i] * 1e153, 0, 0);
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
        const double t = 0.5 * (low + high), u = 1 - t;
        const double x = 4 * u * u * u + 21 * t * u * u + 9 * t * t * u;
        *(x > 0.5 ? &low : &high) = t;
    }
    const mote_impact_found found = impact_ask(&s, impact_question(&s, 0.5e153));
    assert_true(isinf(s.search->rates[0].acceleration));
    impact_check_found(&found, low);
    impact_scene_free(&s);
}

/* Points of a sphere, and triangles such that any two points are corners of one of them (Bose's
   triple system): many boxes for so few vertices. */
enum { BOSE = 67, POINTS = 3 * BOSE, TRIPLES = POINTS * (POINTS - 1) / 6 };

static mote_mesh *bose_mesh(void)
{
    static double xyz[POINTS][3];
    static uint32_t faces[TRIPLES][3];
    size_t count = 0;
    for (uint32_t i = 0; i < POINTS; ++i) {
        const double z = 1 - (2.0 * i + 1) / POINTS, r = sqrt(1 - z * z);
        xyz[i][0] = r * cos(2.399963 * i);
        xyz[i][1] = r * sin(2.399963 * i);
        xyz[i][2] = z;
    }
    for (uint32_t x = 0; x < BOSE; ++x) {
        const uint32_t own[3] = {x, BOSE + x, 2 * BOSE + x};
        memcpy(faces[count++], own, sizeof own);
        for (uint32_t y = 0; y < x; ++y) {
            const uint32_t middle = (x + y) * ((BOSE + 1) / 2) % BOSE;
            for (uint32_t k = 0; k < 3; ++k) {
                const uint32_t face[3] = {k * BOSE + x, k * BOSE + y,
                                          (k + 1) % 3 * BOSE + middle};
                memcpy(faces[count++], face, sizeof face);
            }
        }
    }
    assert_int_equal(count, TRIPLES);
    mote_mesh *mesh = NULL;
    if (mote_mesh_create(&xyz[0][0], POINTS, &faces[0][0], TRIPLES, &mesh) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return mesh;
}

/* A sweep that needs more boxes than a query keeps shows nothing, and speeds alone do. */
TEST(mote_impact_query_more_boxes_than_are_kept)
{
    mote_impact_found found[2];
    for (int k = 0; k < 2; ++k) {
        impact_scene s;
        impact_scene_init_patient(&s, bose_mesh(), impact_box(1, 8, 8), IMPACT_RIGID, 1,
                                  k ? UINT32_MAX : 0);
        /* its face, 0.5 + 2e-3 in front of the point that is farthest in x, slides along it */
        const double face = s.of[0].mesh->high.x + 0.5 + 2e-3;
        mote_path_line(mote_vec3_make(face, -0.05, 0), mote_vec3_make(face, 0.05, 0),
                       s.of[1].piece[0].centre);
        s.of[0].piece[0].spins = true;
        s.of[0].piece[0].spin = mote_vec3_make(0.05, 0, 0);
        found[k] = impact_ask(&s, impact_question(&s, 1e-3));
        assert_int_equal(found[k].outcome, MOTE_IMPACT_NONE);
        assert_int_equal(s.search->sweep.failed, k == 0);
        impact_scene_free(&s);
    }
}

/* Hats along x: three functions that are 1 at one of three places and fall to 0 at the next. */
static uint32_t hats_sparse(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                            uint32_t *functions, double *phi)
{
    const double at =
        2 * (mesh->positions[vertex].x - mesh->low.x) / (mesh->high.x - mesh->low.x);
    uint32_t count = 0;
    for (uint32_t j = 0; j < field->count; ++j) {
        const double hat = 1 - fabs(at - j);
        if (hat > 0) {
            functions[count] = j;
            phi[count++] = hat;
        }
    }
    return count;
}

static void hats_basis(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                       double *phi)
{
    uint32_t functions[3];
    double values[3];
    const uint32_t count = hats_sparse(field, mesh, vertex, functions, values);
    memset(phi, 0, field->padded * sizeof *phi);
    for (uint32_t i = 0; i < count; ++i)
        phi[functions[i]] = values[i];
}

static void hats_destroy(mote_field *field)
{
    free(field);
}

/* A sparse kind of field that is no skin gives the same answer as the same kind that says
   nothing of its zeros. The last hat's end is pulled out by 2 t, to a box 3 beyond. */
TEST(mote_impact_query_sparse_field_that_is_no_skin)
{
    static const mote_field_kind kinds[2] = {
        {.name = "full hats", .basis = hats_basis, .destroy = hats_destroy},
        {.name = "hats", .basis = hats_basis, .sparse = hats_sparse, .destroy = hats_destroy}};
    mote_impact_found found[2];
    for (int k = 0; k < 2; ++k) {
        impact_scene s;
        two_boxes(&s, 2, 1, 0);
        mote_field *field = NULL;
        assert_int_equal(mote_field_allocate(&kinds[k], 3, &field), MOTE_OK);
        const mote_body body = {.mesh = s.of[0].mesh, .field = field};
        const mote_body *const bodies[2] = {&body, &s.of[1].body};
        const mote_impact_options options = mote_default_impact_options(s.length);
        mote_impact_destroy(s.search);
        s.search = NULL;
        assert_int_equal(mote_impact_create(bodies, &options, &s.search), MOTE_OK);
        double control[4 * 3 * MOTE_LANES] = {0};
        assert_int_equal(field->padded, MOTE_LANES);
        for (int i = 0; i < 4; ++i)
            control[3 * MOTE_LANES * i + 2] = 2 * i / 3.0;
        s.of[0].piece[0].weights = control;
        for (int i = 0; i < 4; ++i)
            s.of[1].piece[0].centre[i] = mote_vec3_make(3, 0.1, 0);
        found[k] = impact_ask(&s, impact_question(&s, 0)); /* 1 + 2 t = 2.5 */
        impact_check_found(&found[k], 0.75);
        const mote_impact_groups *groups = &s.search->groups[0];
        assert_true(groups->most_of_all[2] >= 1 && groups->most_of_all[2] < 1 + 1e-9);
        s.of[0].piece[0].weights = NULL;
        impact_scene_free(&s);
        mote_field_destroy(field);
    }
    assert_true(found[0].from == found[1].from && found[0].to == found[1].to);
    assert_int_equal(found[0].iterations, found[1].iterations);
}

/* 20,000 bones, more than a table of groups has room for: one group, and the same impact. */
TEST(mote_impact_query_skin_of_very_many_bones)
{
    enum { BONES = 20000 };
    impact_scene s;
    two_boxes(&s, 2, 1, 10);
    static const uint32_t start[9] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    uint16_t bone[8];
    const double weight[8] = {1, 1, 1, 1, 1, 1, 1, 1};
    for (int v = 0; v < 8; ++v)
        bone[v] = (uint16_t)(v * 2500);
    mote_field *field = NULL;
    assert_int_equal(mote_field_create_skin(s.of[0].mesh, BONES, start, bone, weight, &field),
                     MOTE_OK);
    const mote_body body = {.mesh = s.of[0].mesh, .field = field};
    const mote_body *const bodies[2] = {&body, &s.of[1].body};
    const mote_impact_options options = mote_default_impact_options(s.length);
    mote_impact_destroy(s.search);
    s.search = NULL;
    assert_int_equal(mote_impact_create(bodies, &options, &s.search), MOTE_OK);
    assert_int_equal(s.search->groups[0].count, 1);
    mote_path_line(mote_vec3_make(5, 0.1, 0), mote_vec3_make(-5, 0.1, 0),
                   s.of[1].piece[0].centre);
    const mote_impact_found found = impact_ask(&s, impact_question(&s, 0)); /* 4.5 - 10 t = 1 */
    impact_check_found(&found, 0.35);
    impact_scene_free(&s);
    mote_field_destroy(field);
}
