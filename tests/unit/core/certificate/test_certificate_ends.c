/* Certified mode where numbers come to the ends of what floats and doubles hold. */
#include "core/certificate/certificate_outline.h"
#include "core/certificate/certificate_state.h"

#include "tests/support/certificate_scene.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

/* Two meshes of two triangles each; static unless scene_init_meshes is told otherwise. */
static void init_pairs(scene *s, const double first[18], const double second[18])
{
    static const uint32_t faces[6] = {0, 1, 2, 3, 4, 5};
    const double *const xyz[2] = {first, second};
    mote_mesh *mesh[2];
    for (int b = 0; b < 2; ++b)
        need(mote_mesh_create(xyz[b], 6, faces, 2, &mesh[b]) == MOTE_OK);
    scene_init_meshes(s, mesh[0], mesh[1], false);
}

/* The poses of both bodies: no rotation, the same translation along each axis. */
static void place_both(scene *s, double along)
{
    ++s->frame.number;
    for (int b = 0; b < 2; ++b) {
        mote_body_state *state = &s->frame.body[b];
        state->pose = (mote_pose){.rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                  .translation = {along, along, along}};
        state->shape_changed = state->pose_changed = true;
        state->weights = (mote_weights){s->weights[b][0], s->weights[b][1], s->weights[b][2],
                                        s->field[b]->count, s->field[b]->padded};
        mote_deform_all(s->deform[b], state, s->world[b]);
    }
}

/* The faces that the query starts from are 2^-32 apart at the world's origin. Far from it they
   touch or seem to, by the rounding of their witnesses, and no direction leads from one to the
   other; two other faces intersect in any case. */
TEST(faces_that_intersect_elsewhere_are_found_however_witnesses_are_rounded)
{
    const double g = 0x1p-32;
    const double first[18] = {0, 0, 0, 1, 0, 0, 0, 1, g, 2, 0, 0, 3, 0, 0, 2, 1, 0};
    const double second[18] = {0.125, 0.75, g,    0,    0,    1,   1,   1,    1,
                               2.25,  0.25, -0.5, 2.25, 0.25, 0.5, 2.5, 0.25, 0.5};
    static const uint32_t start[2][3] = {{0, 1, 2}, {0, 1, 2}};
    scene s;
    init_pairs(&s, first, second);
    mote_certificate *c = certificate_of(&s, NULL);
    for (int power = 0; power < 32; ++power) {
        place_both(&s, ldexp(1, power));
        mote_certificate_answer a;
        mote_certificate_query(c, &s.frame, start, -1, &a);
        test_row("at 2^%d", power);
        assert_true(a.distance <= 0 && a.lower <= 0);
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* The largest coordinate of both bodies. */
static double size_of(const scene *s)
{
    double most = s->length;
    for (int b = 0; b < 2; ++b) {
        for (uint32_t v = 0; v < s->mesh[b]->vertex_count; ++v)
            most = fmax(most, mote_largest_coordinate(s->world[b][v]));
    }
    return most;
}

/* Weights from the usual size to beyond what floats can hold. The bracket always holds the
   truth, and what is not called stopped is exact as far as coordinates are. */
TEST(weights_of_any_size_end_in_a_bracket_of_the_truth)
{
    static const char *const seeds[] = {"none", "pair", "witness"};
    for (int seed = 0; seed < 3; ++seed) {
        scene s;
        scene_init(&s, 10, 6, 1, true);
        mote_certificate_options options = mote_default_certificate_options(s.length);
        options.seed = (mote_cert_seed)seed;
        mote_certificate *c = certificate_of(&s, &options);
        for (int power = 0; power <= 150; power += 3) {
            scene_next(&s, 1.3, false);
            for (int b = 0; b < 2; ++b) {
                for (uint32_t j = 0; j < 3 * (uint32_t)MOTE_FIELD_SUMMED; ++j)
                    s.weights[b][j / MOTE_FIELD_SUMMED][j % MOTE_FIELD_SUMMED] *=
                        ldexp(1, power);
            }
            place_both(&s, 0);
            s.frame.body[1].pose.translation.x = (power % 2 ? 1.2 : 1e3) * ldexp(1, power);
            mote_deform_all(s.deform[1], &s.frame.body[1], s.world[1]);
            const double truth = scene_distance(&s);
            for (int ask = 0; ask < 2; ++ask) {
                mote_certificate_answer a;
                mote_certificate_query(c, &s.frame, NULL, ask ? 0 : -1, &a);
                test_row("seed %s, weights times 2^%d, %d", seeds[seed], power, ask);
                assert_true(a.lower >= 0 && a.lower <= truth * (1 + 1e-12));
                assert_true(a.distance >= truth * (1 - 1e-12));
                if (!a.stopped && !ask)
                    assert_true(a.distance <= truth + 1e-12 * size_of(&s));
                if (power < 45)
                    assert_false(a.stopped);
            }
        }
        mote_certificate_destroy(c);
        scene_free(&s);
    }
}

/* Bodies that are far from the origin and deform: positions are rounded there by more than
   single precision rounds what is relative to the query's origin. */
TEST(bounds_of_deforming_bodies_hold_far_from_the_origin)
{
    scene s;
    scene_init(&s, 24, 12, 1, true);
    mote_certificate_options options = mote_default_certificate_options(s.length);
    options.seed = MOTE_CERT_SEED_NONE;
    mote_certificate *c = certificate_of(&s, &options);
    for (int k = 0; k < 400; ++k) {
        scene_next(&s, 0.9, false);
        for (int b = 0; b < 2; ++b) {
            const double far = pow(10, 8 + k % 6) * s.length;
            mote_vec3 *t = &s.frame.body[b].pose.translation;
            *t = mote_add(*t, mote_vec3_make(far, -0.7 * far, 0.3 * far));
            mote_deform_all(s.deform[b], &s.frame.body[b], s.world[b]);
        }
        const double truth = scene_truth(&s);
        mote_certificate_answer a;
        mote_certificate_query(c, &s.frame, NULL, -1, &a);
        test_row("frame %d", k);
        assert_true(a.lower >= 0 && a.lower <= truth);
        assert_true(a.distance <= truth + 1e-12 * s.length);
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* A mode whose functions are nowhere above 1e-310, with weights that make up for it. */
TEST(functions_that_are_hardly_numbers_bound_what_they_move)
{
    scene s;
    scene_init(&s, 18, 9, 1, false);
    for (int b = 0; b < 2; ++b) {
        const mote_mesh *mesh = s.mesh[b];
        mote_vec3 *modes = malloc(mesh->vertex_count * sizeof *modes);
        need(modes);
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
            const double bend = 1e-310 * sin(5 * mesh->positions[v].x);
            modes[v] = mote_vec3_make(bend, bend, -bend);
        }
        mote_field *field = NULL;
        need(mote_field_create_modes(modes, 1, mesh->vertex_count, &field) == MOTE_OK);
        free(modes);
        use_field(&s, b, field);
    }
    mote_certificate *c = certificate_of(&s, NULL);
    for (int k = 0; k < 20; ++k) {
        scene_next(&s, 1.2, true);
        for (int b = 0; b < 2; ++b) {
            memset(s.weights[b], 0, sizeof s.weights[b]);
            for (int r = 0; r < 3; ++r)
                s.weights[b][r][r] = 5e307 * scene_random(&s, -1, 1);
        }
        for (int b = 0; b < 2; ++b)
            mote_deform_all(s.deform[b], &s.frame.body[b], s.world[b]);
        test_row("frame %d", k);
        check_exact(&s, c, scene_truth(&s));
    }
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* A contact that the traversal finds ends the query: nothing is proven after it. */
TEST(contact_found_in_the_trees_is_not_proven_again)
{
    scene s;
    int found = 0;
    scene_init(&s, 24, 12, 1, true);
    mote_certificate_options options = mote_default_certificate_options(s.length);
    options.seed = MOTE_CERT_SEED_NONE;
    mote_certificate *c = certificate_of(&s, &options);
    for (int k = 0; k < 200; ++k) {
        scene_next(&s, 0.9, false);
        mote_certificate_answer a;
        mote_certificate_query(c, &s.frame, NULL, 1e-9 * s.length, &a);
        found += a.distance <= 1e-9 * s.length && a.counters.leaf_pairs > 0;
        if (a.distance <= 1e-9 * s.length)
            assert_false(c->proven);
    }
    assert_true(found > 0);
    mote_certificate_destroy(c);
    scene_free(&s);
}

/* An outline of one box from `low` to `high` along each axis. */
static mote_cert_outline box_outline(float low, float high, double bound)
{
    mote_cert_outline outline = {.bound = bound};
    outline.rows[0].children = 1;
    for (int r = 0; r < 3; ++r) {
        for (size_t l = 0; l < MOTE_CERT_WIDTH; ++l) {
            outline.rows[0].low[r][l] = low;
            outline.rows[0].high[r][l] = high;
        }
    }
    return outline;
}

/* Where rounding is worth more than the gap, and its square is no float, boxes are near. */
TEST(outlines_whose_squares_leave_floats_are_near)
{
    const mote_cert_outline a = box_outline(1e20F, 2e20F, 1e27);
    const mote_cert_outline b = box_outline(-2e20F, -1e20F, 1e27);
    assert_true(mote_cert_outlines_near(&a, &b, 1, 0));
    const mote_cert_outline c = box_outline(1, 2, 8);
    const mote_cert_outline d = box_outline(-2, -1, 8);
    assert_false(mote_cert_outlines_near(&c, &d, 1, 0));
    assert_true(mote_cert_outlines_near(&c, &d, 1, 4));
}
