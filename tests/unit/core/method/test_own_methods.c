/* Our methods through the interface: what "auto" stands for, and the answers to contact
   questions. */
#include "core/method/method.h"
#include "core/parts/parts.h"
#include "datasets/letter.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"
#include "tests/support/truth.h"

#include <stdio.h>

static mote_mesh *letter(char name, size_t triangles)
{
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_letter_create(name, triangles, &mesh), MOTE_OK);
    return mesh;
}

static uint32_t parts_of(const mote_mesh *mesh)
{
    mote_parts *parts = NULL;
    assert_int_equal(mote_parts_create(mesh, NULL, &parts), MOTE_OK);
    const uint32_t count = parts->count;
    mote_parts_destroy(parts);
    return count;
}

/* Checks that answers and counts are equal with the parameters left to the method and spelled
   out. */
static void check_same(scene *s, const char *name, const char *keys, const char *spelled_out)
{
    mote_setup setup = scene_setup(s, MOTE_ASK_DISTANCE, 0, NULL);
    method_run by_itself, told;
    method_run_init(&by_itself, name, keys, setup);
    setup.seed = 99; /* no method uses it here */
    method_run_init(&told, name, spelled_out, setup);
    for (int k = 0; k < 6; ++k) {
        const mote_frame *frame = scene_next(s, 1.2, false);
        const mote_answer a = method_run_ask(&by_itself, frame);
        const mote_answer b = method_run_ask(&told, frame);
        assert_memory_equal(&a, &b, sizeof a);
    }
    method_run_free(&by_itself);
    method_run_free(&told);
}

typedef struct pair {
    mote_mesh *first, *second;
} pair;

/* n is twice the convex parts of the body that has more (paper 3.5), but at most the number of
   vertices of a body, and at least 8 when tracked; N_min = n / 10, N_max is the square root of
   the vertices of the larger body. */
TEST(automatic_numbers_are_those_of_the_paper)
{
    const pair pairs[] = {{letter('W', 400), letter('T', 400)},
                          {letter('T', 400), letter('W', 400)},
                          {letter('W', 400), solid_to_mesh(solid_icosahedron())},
                          {solid_to_mesh(solid_tetrahedron()), letter('M', 400)}};
    bool above_8 = false;
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; ++k) {
        const uint32_t a = parts_of(pairs[k].first), b = parts_of(pairs[k].second);
        const uint32_t v = pairs[k].first->vertex_count, w = pairs[k].second->vertex_count;
        const uint32_t limit = v < w ? v : w;
        uint32_t n = 2 * (a > b ? a : b);
        above_8 |= n > 8;
        uint32_t tracked = n < 8 ? 8 : n;
        n = n < limit ? n : limit;
        tracked = tracked < limit ? tracked : limit;
        char keys[96];
        scene s;
        scene_init_meshes(&s, pairs[k].first, pairs[k].second, true);
        (void)snprintf(keys, sizeof keys, "n=%u,nmin=%u,nmax=%.0f,seed=1", n, n / 10,
                       ceil(sqrt(v > w ? v : w)));
        check_same(&s, "particle-paper", "", keys);
        (void)snprintf(keys, sizeof keys, "n=%u,launch=0,seed=1", tracked);
        check_same(&s, "particle", "", keys);
        scene_free(&s);
    }
    assert_true(above_8);
}

/* Two bodies of one mesh share its parts. */
TEST(automatic_number_of_one_mesh_twice_is_that_of_one)
{
    scene s;
    scene_init_meshes(&s, letter('W', 400), letter('W', 400), false);
    mote_mesh *second = s.mesh[1];
    char keys[32];
    (void)snprintf(keys, sizeof keys, "n=%u,seed=1", 2 * parts_of(s.mesh[0]));
    s.body[1].mesh = s.mesh[0];
    check_same(&s, "particle-paper", "", keys);
    check_same(&s, "particle", "", keys);
    s.body[1].mesh = second;
    scene_free(&s);
}

/* Bodies as small and as large as a mesh may be, times a power of two: the same bits, in
   contact too. */
TEST(answers_at_the_ends_of_lengths_are_those_of_usual_lengths)
{
    static const char *const names[] = {"certified", "stream", "auto", "particle",
                                        "particle-paper"};
    static const int powers[] = {-430, -330, -260, 260, 330, 429};
    int contacts = 0;
    for (size_t i = 0; i < ROWS_OF(powers); ++i) {
        scene usual, extreme;
        method_run of_usual[ROWS_OF(names)], of_extreme[ROWS_OF(names)];
        scene_init(&usual, 16, 9, 1, true);
        scene_init(&extreme, 16, 9, ldexp(1, powers[i]), true);
        for (size_t m = 0; m < ROWS_OF(names); ++m) {
            method_run_init(&of_usual[m], names[m], "",
                            scene_setup(&usual, MOTE_ASK_DISTANCE, 0, NULL));
            method_run_init(&of_extreme[m], names[m], "",
                            scene_setup(&extreme, MOTE_ASK_DISTANCE, 0, NULL));
        }
        for (int k = 0; k < 12; ++k) {
            const mote_frame *frame = scene_next(&usual, 1.2, false);
            const mote_frame *scaled = scene_next(&extreme, 1.2, false);
            for (size_t m = 0; m < ROWS_OF(names); ++m) {
                test_row("%s, 2^%d, frame %d", names[m], powers[i], k);
                const mote_answer a = method_run_ask(&of_usual[m], frame);
                const mote_answer b = method_run_ask(&of_extreme[m], scaled);
                assert_true(b.distance == ldexp(a.distance, powers[i]));
                assert_true(b.lower == ldexp(a.lower, powers[i]));
                assert_int_equal(b.contact, a.contact);
                contacts += a.contact;
            }
        }
        for (size_t m = 0; m < ROWS_OF(names); ++m) {
            method_run_free(&of_usual[m]);
            method_run_free(&of_extreme[m]);
        }
        scene_free(&usual);
        scene_free(&extreme);
    }
    assert_true(contacts > 60);
}

/* A cached influence does not outlive a query without coherence. */
TEST(far_cache_without_coherence_answers_the_same_again)
{
    scene s;
    scene_init(&s, 20, 10, 1, true);
    const mote_setup setup = scene_setup(&s, MOTE_ASK_DISTANCE, 0, NULL);
    method_run u;
    method_run_init(&u, "particle-paper", "n=20,far_cache=0.5,coherent=no", setup);
    const mote_frame first = *scene_next(&s, 1.2, true);
    const mote_answer a = method_run_ask(&u, &first);
    const mote_frame second = *scene_next(&s, 1.2, true);
    const mote_answer b = method_run_ask(&u, &second);
    const mote_answer again = method_run_ask(&u, &first);
    assert_memory_equal(&a, &again, sizeof a);
    assert_true(a.distance != b.distance);
    assert_true(a.counters.moves > 0);
    method_run_free(&u);
    scene_free(&s);
}

/* Whatever certified reports about a contact is true, and it always reports unless it was told
   to stop early. */
TEST(certified_contact_question_says_what_it_knows)
{
    static const struct {
        const char *keys;
        bool always;
    } cases[] = {{"", true}, {"seed=tracked", true}, {"slack=0.3", false}, {"budget=8", false}};
    scene s;
    scene_init(&s, 20, 10, 1, true);
    const double tolerance = 0.05 * s.length;
    const mote_setup setup = scene_setup(&s, MOTE_ASK_CONTACT, tolerance, NULL);
    method_run u[4];
    int open[4] = {0}, contacts = 0, apart = 0;
    for (int i = 0; i < 4; ++i)
        method_run_init(&u[i], "certified", cases[i].keys, setup);
    for (int k = 0; k < 60; ++k) {
        const mote_frame *frame = scene_next(&s, 1.5, false);
        const bool truth = scene_truth(&s) <= tolerance;
        contacts += truth;
        apart += !truth;
        for (int i = 0; i < 4; ++i) {
            const mote_answer a = method_run_ask(&u[i], frame);
            open[i] += !a.has_contact;
            assert_false(a.has_distance);
            assert_true(a.has_lower && a.lower <= a.distance);
            assert_true(!a.has_contact || a.contact == truth);
            assert_true(a.has_contact || a.lower <= tolerance);
            assert_true(a.has_witness == a.contact);
            assert_true(a.has_contact || !cases[i].always);
        }
    }
    assert_true(contacts > 5 && apart > 5);
    assert_int_equal(open[0] + open[1], 0);
    assert_true(open[2] > 0 && open[3] > 0);
    for (int i = 0; i < 4; ++i)
        method_run_free(&u[i]);
    scene_free(&s);
}

/* A method claims to be exact only if neither slack nor a budget ends it early. */
TEST(certified_claims_to_be_exact_where_nothing_ends_it)
{
    static const struct {
        const char *keys;
        bool exact;
    } cases[] = {{"", true}, {"slack=1e-6", false}, {"budget=100", false}, {"seed=none", true}};
    for (int k = 0; k < 4; ++k) {
        double values[MOTE_PARAMETERS_MAX];
        const mote_traits t =
            mote_method_traits(method_with("certified", cases[k].keys, values), values);
        assert_int_equal(t.exact, cases[k].exact);
        assert_int_equal(t.keeps_state, k != 3);
    }
}
