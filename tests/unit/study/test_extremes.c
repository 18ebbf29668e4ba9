/* The study of numerical extremes: its truth against formulas, its verdicts against answers
   that are right or wrong by construction, and our methods in cases that they once got
   wrong. */
#include "harness/study/extreme.h"
#include "tests/support/test.h"

#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

static mote_extreme_recipe plain, changed;

static int make_plain(void)
{
    return mote_extreme_plain(&plain) == MOTE_OK ? 0 : -1;
}

TEST_GROUP(make_plain, NULL);

static const mote_extreme_family *find_family(const char *name)
{
    for (size_t i = 0; i < mote_extreme_family_count; ++i) {
        if (strcmp(mote_extreme_families[i].name, name) == 0)
            return &mote_extreme_families[i];
    }
    fail_msg("no family %s", name);
    return NULL;
}

static void make(const char *name, int k, bool measured, mote_extreme *e)
{
    const mote_extreme_family *family = find_family(name);
    *e = (mote_extreme){.family = family->name};
    if (family->parameters)
        e->parameters = family->parameters[k - family->first];
    assert_int_equal(family->change(&plain, k, &changed), MOTE_OK);
    assert_int_equal(mote_extreme_make(&changed, e), MOTE_OK);
    if (measured)
        mote_extreme_measure(e);
}

/* Cubes of side 1 in line, at gaps that doubles hold exactly. */
TEST(mote_extreme_measure_of_cubes_is_their_gap)
{
    static const double gaps[MOTE_EXTREME_FRAMES] = {0.5, 0x1p-20, 0x1p-52, 0};
    const mote_extreme_family *family = find_family("touch");
    assert_int_equal(family->change(&plain, 2, &changed), MOTE_OK);
    for (int f = 0; f < MOTE_EXTREME_FRAMES; ++f)
        changed.place[1][f] = mote_vec3_make(1 + gaps[f], 0.25, -0.5);
    mote_extreme e = {0};
    assert_int_equal(mote_extreme_make(&changed, &e), MOTE_OK);
    mote_extreme_measure(&e);
    for (int f = 0; f < MOTE_EXTREME_FRAMES; ++f) {
        assert_true(e.truth[f] == gaps[f]);
        assert_true(e.unrounded[f] == gaps[f]);
    }
    assert_true(mote_extreme_surface(&e, 0, 1, mote_vec3_make(1, 0.5, 0)) == 0.25);
    mote_extreme_free(&e);
}

/* The gaps that the plain scene asks for, also in another unit of length. */
TEST(mote_extreme_measure_of_plain_scene_is_its_gaps_at_any_scale)
{
    static const double gaps[] = {0.2, 0.02, 5e-4};
    mote_extreme e;
    for (int k = -12; k <= 12; k += 12) {
        make("scale", k, true, &e);
        for (int f = 0; f < 3; ++f) {
            const double ratio = e.truth[f] / (gaps[f] * pow(10, k));
            assert_true(fabs(ratio - 1) < 2e-3);
            assert_true(fabs(e.truth[f] - e.unrounded[f]) < 1e-14 * e.length);
        }
        assert_true(e.truth[3] == 0);
        mote_extreme_free(&e);
    }
}

TEST(mote_extreme_make_of_bad_input_says_why)
{
    mote_extreme e;
    make("duplicate", 0, false, &e);
    assert_non_null(strstr(e.refusal, "singular"));
    mote_extreme_free(&e);
    make("condition", 15, false, &e);
    assert_non_null(strstr(e.refusal, "singular"));
    mote_extreme_free(&e);
    make("condition", 6, false, &e);
    assert_int_equal(e.refusal[0], 0);
    assert_true(e.condition > 2e5 && e.condition < 5e6);
    mote_extreme_free(&e);
}

TEST(mote_extreme_families_have_labels_of_their_own)
{
    for (size_t i = 0; i < mote_extreme_family_count; ++i) {
        const mote_extreme_family *family = &mote_extreme_families[i];
        char before[24] = "";
        assert_true(family->last >= family->first && family->quick > 0);
        for (int k = family->first; k <= family->last; ++k) {
            char label[24];
            mote_extreme_label(family, k, label, sizeof label);
            assert_true(label[0] && strcmp(label, before) != 0);
            memcpy(before, label, sizeof label);
        }
    }
}

typedef struct judged {
    double factor, add; /* the answer is truth times factor plus add * L */
    bool exact, hulls;
    mote_extreme_verdict verdict;
} judged;

TEST(mote_extreme_judge_of_distances_follows_the_promise)
{
    static const judged cases[] = {
        {1, 0, true, false, MOTE_EXTREME_RIGHT},
        {1, 1e-13, true, false, MOTE_EXTREME_RIGHT},
        {1, 1e-11, true, false, MOTE_EXTREME_WRONG},
        {1, -1e-11, true, false, MOTE_EXTREME_WRONG},
        {0, 0, true, false, MOTE_EXTREME_WRONG},
        {1, 0.3, false, false, MOTE_EXTREME_INEXACT},
        {1, -0.01, false, false, MOTE_EXTREME_WRONG},
        {1, -0.01, false, true, MOTE_EXTREME_INEXACT},
        {1, 0.3, false, true, MOTE_EXTREME_WRONG},
        {-1, 0, false, false, MOTE_EXTREME_WRONG},
        {(double)NAN, 0, false, false, MOTE_EXTREME_NAN},
        {HUGE_VAL, 0, true, false, MOTE_EXTREME_NAN},
    };
    mote_extreme e;
    make("plain", 0, true, &e);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        mote_extreme_said said = {.exact = cases[i].exact, .hulls = cases[i].hulls};
        said.answer.has_distance = true;
        said.answer.distance = e.truth[0] * cases[i].factor + cases[i].add * e.length;
        double error;
        char reason[200] = "";
        const mote_extreme_verdict verdict =
            mote_extreme_judge(&e, 0, &said, &error, reason, sizeof reason);
        if (verdict != cases[i].verdict)
            fail_msg("case %zu: %s (%s)", i, mote_extreme_verdicts[verdict], reason);
        assert_true((verdict == MOTE_EXTREME_RIGHT) == (reason[0] == '\0'));
    }
    mote_extreme_free(&e);
}

static void expect(const mote_extreme *e, uint32_t frame, const mote_extreme_said *said,
                   mote_extreme_verdict verdict)
{
    double error;
    char reason[200] = "";
    assert_int_equal(mote_extreme_judge(e, frame, said, &error, reason, sizeof reason),
                     verdict);
}

TEST(mote_extreme_judge_of_bounds_points_and_contacts)
{
    mote_extreme e;
    make("plain", 0, true, &e);
    mote_extreme_said said = {.exact = true, .answer = {.has_distance = true}};
    said.answer.distance = e.truth[0];
    said.answer.has_lower = true;
    said.answer.lower = e.truth[0] * (1 + 1e-9);
    expect(&e, 0, &said, MOTE_EXTREME_WRONG);
    said.answer.lower = e.truth[0] * (1 - 1e-9);
    expect(&e, 0, &said, MOTE_EXTREME_RIGHT);
    said.answer.has_contact = said.answer.contact = true;
    expect(&e, 0, &said, MOTE_EXTREME_WRONG);
    said.answer.has_contact = false;
    said.answer.has_witness = true; /* both points at the origin */
    expect(&e, 0, &said, MOTE_EXTREME_WRONG);
    /* As far apart as they should be, but off the surfaces. */
    said.answer.witness[0] = mote_vec3_make(9, 9, 9);
    said.answer.witness[1] = mote_vec3_make(9 + e.truth[0], 9, 9);
    expect(&e, 0, &said, MOTE_EXTREME_WRONG);
    said.answer.witness[1].x = (double)NAN;
    expect(&e, 0, &said, MOTE_EXTREME_NAN);

    const mote_extreme_said nothing = {0};
    expect(&e, 0, &nothing, MOTE_EXTREME_WRONG);
    mote_extreme_said contact = {.contact_only = true, .answer = {.has_contact = true}};
    expect(&e, 0, &contact, MOTE_EXTREME_RIGHT);
    expect(&e, 3, &contact, MOTE_EXTREME_WRONG);
    contact.answer.contact = true;
    expect(&e, 0, &contact, MOTE_EXTREME_WRONG);
    expect(&e, 3, &contact, MOTE_EXTREME_RIGHT);
    mote_extreme_free(&e);
}

/* Every number of an answer is checked separately. */
TEST(mote_extreme_judge_of_what_is_not_finite_says_so)
{
    mote_extreme e;
    make("plain", 0, true, &e);
    for (int k = 0; k < 7; ++k) {
        mote_extreme_said said = {.answer = {.has_distance = true, .distance = e.truth[0]}};
        double *const numbers[] = {&said.answer.lower,        &said.answer.witness[0].x,
                                   &said.answer.witness[0].y, &said.answer.witness[0].z,
                                   &said.answer.witness[1].x, &said.answer.witness[1].y,
                                   &said.answer.witness[1].z};
        *numbers[k] = k % 2 ? (double)NAN : -HUGE_VAL;
        expect(&e, 0, &said, MOTE_EXTREME_RIGHT); /* not part of the answer */
        said.answer.has_lower = k == 0;
        said.answer.has_witness = k > 0;
        expect(&e, 0, &said, MOTE_EXTREME_NAN);
    }
    mote_extreme_free(&e);
}

/* Excused are hulls off the surface, the rounding of 32 bits, contacts nearer than that, and a
   missing contact where the distance is too large anyway. */
TEST(mote_extreme_judge_excuses_what_a_method_declares)
{
    mote_extreme e;
    make("plain", 0, true, &e);
    mote_extreme_said said = {.answer = {.has_distance = true, .has_witness = true}};
    said.answer.distance = e.truth[0];
    said.answer.witness[1] = mote_vec3_make(e.truth[0], 0, 0);
    expect(&e, 0, &said, MOTE_EXTREME_WRONG);
    said.hulls = true;
    expect(&e, 0, &said, MOTE_EXTREME_RIGHT);
    said.answer.has_contact = said.answer.contact = true;
    expect(&e, 0, &said, MOTE_EXTREME_INEXACT);

    mote_extreme_said rounded = {.exact = true, .answer = {.has_distance = true}};
    rounded.answer.distance = e.truth[0] + 1e-7 * e.length;
    expect(&e, 0, &rounded, MOTE_EXTREME_WRONG);
    rounded.single = true;
    expect(&e, 0, &rounded, MOTE_EXTREME_INEXACT);

    mote_extreme_said near = {.contact_only = true,
                              .answer = {.has_contact = true, .contact = true}};
    const double truth = e.truth[0];
    e.truth[0] = 1e-13 * e.length;
    expect(&e, 0, &near, MOTE_EXTREME_INEXACT);
    e.truth[0] = truth;
    /* If only a contact was asked for, the distance is not judged. */
    near.answer.contact = false;
    near.answer.has_distance = true;
    near.answer.distance = 7 * truth;
    expect(&e, 0, &near, MOTE_EXTREME_RIGHT);

    mote_extreme_said far = {.answer = {.has_distance = true, .has_contact = true}};
    expect(&e, 3, &far, MOTE_EXTREME_WRONG); /* a distance of 0 is a contact */
    far.answer.distance = 1e-13 * e.length;
    expect(&e, 3, &far, MOTE_EXTREME_INEXACT);
    far.exact = true;
    expect(&e, 3, &far, MOTE_EXTREME_WRONG);
    mote_extreme_free(&e);
}

TEST(mote_extreme_run_of_what_cannot_be_asked_says_why)
{
    mote_extreme e;
    mote_extreme_cell cell;
    make("plain", 0, false, &e);
    assert_int_equal(mote_extreme_run(&e, "magic", &cell), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "unknown method magic"));
    mote_extreme_free(&e);
    make("duplicate", 0, false, &e);
    assert_int_equal(mote_extreme_run(&e, "certified", &cell), MOTE_OK);
    assert_int_equal(cell.verdict, MOTE_EXTREME_REFUSED);
    assert_string_equal(cell.reason, e.refusal);
    assert_int_equal(cell.frame, 0);
    mote_extreme_free(&e);
}

/* The method's process crashes on missing weights; the study continues. */
TEST(mote_extreme_run_of_a_method_that_dies_is_crashed)
{
    mote_extreme e;
    mote_extreme_cell cell;
    make("plain", 0, false, &e);
    for (int b = 0; b < 2; ++b)
        e.frame[1].body[b].weights.x = NULL;
    void (*const caught)(int) = signal(SIGSEGV, SIG_DFL);
    assert_int_equal(mote_extreme_run(&e, "brute-force", &cell), MOTE_OK);
    (void)signal(SIGSEGV, caught);
    assert_int_equal(cell.verdict, MOTE_EXTREME_CRASHED);
    assert_non_null(strstr(cell.reason, "ended "));
    mote_extreme_free(&e);
}

static void expect_verdict(const mote_extreme *e, const char *method,
                           mote_extreme_verdict verdict)
{
    mote_extreme_cell cell;
    assert_int_equal(mote_extreme_run(e, method, &cell), MOTE_OK);
    if (cell.verdict != verdict)
        fail_msg("%s: %s: %s", method, mote_extreme_verdicts[cell.verdict], cell.reason);
}

/* Closest points rounded to a millionth of L must not determine the distance. */
TEST(methods_of_ours_far_from_the_origin_are_right)
{
    static const char *const methods[] = {"certified", "aabb-tree", "brute-force",
                                          "particle:n=8"};
    static const int powers[] = {4, 8, 10, 12};
    for (size_t i = 0; i < sizeof powers / sizeof powers[0]; ++i) {
        mote_extreme e;
        make("offset", powers[i], true, &e);
        for (size_t m = 0; m < sizeof methods / sizeof methods[0]; ++m)
            expect_verdict(&e, methods[m], MOTE_EXTREME_RIGHT);
        if (mote_method_find("embree-contact")) /* skipped if its library is missing */
            expect_verdict(&e, "embree-contact", MOTE_EXTREME_RIGHT);
        mote_extreme_free(&e);
    }
}

TEST(methods_with_too_many_particles_refuse)
{
    static const char *const methods[] = {"particle", "particle-paper", "hybrid-fcl"};
    mote_extreme e;
    make("particles", 2, true, &e);
    for (size_t m = 0; m < sizeof methods / sizeof methods[0]; ++m)
        expect_verdict(&e, methods[m], MOTE_EXTREME_REFUSED);
    expect_verdict(&e, "certified", MOTE_EXTREME_NONE);
    mote_extreme_free(&e);
    make("triangles", 2, true, &e);
    expect_verdict(&e, "hybrid-fcl", MOTE_EXTREME_RIGHT);
    mote_extreme_free(&e);
}

TEST(methods_in_32_bits_are_inexact_as_they_say)
{
    mote_extreme e;
    make("float method", 0, true, &e);
    assert_string_equal(e.parameters, "precision=single");
    expect_verdict(&e, "certified", MOTE_EXTREME_NONE);
    expect_verdict(&e, "fcl-continuous", MOTE_EXTREME_NONE); /* its precision is a number */
    expect_verdict(&e, "particle-paper", MOTE_EXTREME_INEXACT);
    mote_extreme_free(&e);
}
