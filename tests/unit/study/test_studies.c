/* The studies with planted measurements: verdicts, tables and files follow from the
   measurements, and any failure of a call is passed on with its text. */
#include "harness/study/claims.h"
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/base/record.h"
#include "harness/study/study_bodies.h"
#include "harness/study/study_dynamics.h"
#include "harness/study/study_extremes.h"
#include "tests/support/planted.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static char base[] = "out";

typedef mote_status (*experiment)(mote_study *study, mote_claim *claim);
#define EXPERIMENT(name) {#name, mote_claim_##name},
static const struct {
    const char *name;
    experiment measure;
} experiments[] = {MOTE_CLAIMS(EXPERIMENT) MOTE_REQUIREMENTS(EXPERIMENT)};
enum { EXPERIMENTS = sizeof experiments / sizeof experiments[0] };

static mote_status measure_claim(size_t k, mote_claim *claim)
{
    mote_study study;
    mote_status status = mote_study_open(base, true, &study);
    planted.calls = 0;
    if (status == MOTE_OK)
        status = experiments[k].measure(&study, claim);
    mote_study_close(&study);
    return status;
}

static mote_status measure(size_t k, mote_claim_verdict *verdict)
{
    mote_claim claim = {0};
    const mote_status status = measure_claim(k, &claim);
    *verdict = mote_claim_judge(&claim);
    mote_claim_free(&claim);
    return status;
}

/* The caller frees it. */
static mote_claim claim_of(const char *name)
{
    mote_claim claim = {0};
    size_t k = 0;
    while (k < EXPERIMENTS && strcmp(experiments[k].name, name) != 0)
        ++k;
    if (k == EXPERIMENTS)
        fail_msg("no experiment %s", name);
    if (measure_claim(k, &claim) != MOTE_OK)
        fail_msg("%s: %s", name, mote_error_text());
    return claim;
}

static mote_claim_verdict verdict_of(const char *name)
{
    mote_claim claim = claim_of(name);
    const mote_claim_verdict verdict = mote_claim_judge(&claim);
    mote_claim_free(&claim);
    return verdict;
}

TEST(claims_on_accuracy_follow_the_error)
{
    static const char *const names[] = {"contact_point", "convex_parts", "few_particles",
                                        "exact_shares"};
    plant_good();
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i)
        assert_int_equal(verdict_of(names[i]), MOTE_CLAIM_HOLDS);
    planted.error = 0.3;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i)
        assert_int_equal(verdict_of(names[i]), MOTE_CLAIM_DOES_NOT_HOLD);
    planted.error = 0.07; /* between a twentieth and a tenth */
    assert_int_equal(verdict_of("few_particles"), MOTE_CLAIM_LIMITS);
}

TEST(claims_on_contacts_follow_what_was_seen)
{
    static const char *const names[] = {"passing_through", "no_missed_contact"};
    plant_good();
    for (size_t i = 0; i < 2; ++i)
        assert_int_equal(verdict_of(names[i]), MOTE_CLAIM_HOLDS);
    planted.contact_seen = false;
    for (size_t i = 0; i < 2; ++i)
        assert_int_equal(verdict_of(names[i]), MOTE_CLAIM_DOES_NOT_HOLD);
    plant_good();
    planted.passes = 60;
    assert_int_equal(verdict_of("closed_loop"), MOTE_CLAIM_DOES_NOT_HOLD);
}

/* Two starts of 80 never see a contact, so their contacts are not twice twenty trials. */
TEST(claim_on_contacts_counts_each_start_once)
{
    plant_good();
    planted.blind = 2;
    mote_claim claim = claim_of("passing_through");
    const mote_confidence right = mote_statistics_share_interval(2, 80);
    const mote_estimate *share = &claim.values[0].estimate;
    assert_true(fabs(share->value - 2. / 80) < 1e-12);
    assert_true(fabs(share->interval.low - right.low) < 1e-12);
    assert_true(fabs(share->interval.high - right.high) < 1e-12);
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_LIMITS);
    mote_claim_free(&claim);
}

/* Whether a cell is one without the cache of distant particles. */
static bool is_without_cache(const mote_cell *cell)
{
    static const char none[] = "far_cache=0";
    const char *at = strstr(cell->choice->text, none);
    return at && at[sizeof none - 1] != '.';
}

/* The cache gains in the ten starts on which settings are compared, by luck. */
static double gain_by_luck(const mote_cell *cell)
{
    return cell->seed <= 10 && is_without_cache(cell) ? 2 : 1;
}

/* The first of each two measurements takes longer. */
static double fall_in_pairs(const mote_cell *cell)
{
    static bool second;
    (void)cell;
    second = !second;
    return second ? 1.5 : 1;
}

static double gain(const mote_cell *cell)
{
    return is_without_cache(cell) ? 2 : 1;
}

TEST(claim_on_the_cache_is_judged_on_other_starts_in_either_order)
{
    static double (*const none[])(const mote_cell *) = {gain_by_luck, fall_in_pairs};
    plant_good();
    planted.slowdown = gain;
    assert_int_equal(verdict_of("distant_cache"), MOTE_CLAIM_HOLDS);
    for (size_t i = 0; i < ROWS_OF(none); ++i) {
        planted.slowdown = none[i];
        mote_claim claim = claim_of("distant_cache");
        assert_true(fabs(claim.values[0].estimate.value - 1) < 0.06);
        assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_DOES_NOT_HOLD);
        mote_claim_free(&claim);
    }
}

TEST(claims_on_times_follow_the_times)
{
    plant_good();
    assert_int_equal(verdict_of("times"), MOTE_CLAIM_HOLDS);
    assert_int_equal(verdict_of("hierarchy_memory"), MOTE_CLAIM_HOLDS);
    assert_int_equal(verdict_of("faster_than_fcl"), MOTE_CLAIM_HOLDS);
    planted.ours_ns = 5e5; /* 0.5 ms: below the paper's, not below a twentieth of it */
    assert_int_equal(verdict_of("times"), MOTE_CLAIM_LIMITS);
    planted.ours_ns = 1e8;
    assert_int_equal(verdict_of("times"), MOTE_CLAIM_DOES_NOT_HOLD);
}

/* Where the engines take five times as long, certified is the faster one on the rigid scene
   asked for contacts, and not by enough on the others. */
TEST(claims_on_the_best_engine_follow_the_ratio)
{
    plant_good();
    assert_int_equal(verdict_of("best_engine_distance"), MOTE_CLAIM_HOLDS);
    assert_int_equal(verdict_of("best_engine_contact"), MOTE_CLAIM_HOLDS);
    planted.trees_ratio = 5;
    assert_int_equal(verdict_of("best_engine_distance"), MOTE_CLAIM_DOES_NOT_HOLD);
    assert_int_equal(verdict_of("best_engine_contact"), MOTE_CLAIM_DOES_NOT_HOLD);
}

TEST(claim_on_complexity_follows_the_exponent)
{
    plant_good();
    assert_int_equal(verdict_of("complexity"), MOTE_CLAIM_HOLDS);
    planted.exponent = 0.5;
    assert_int_equal(verdict_of("complexity"), MOTE_CLAIM_DOES_NOT_HOLD);
}

TEST(claim_on_rest_follows_the_share_that_moves)
{
    plant_good();
    assert_int_equal(verdict_of("almost_at_rest"), MOTE_CLAIM_HOLDS);
    planted.moving = 0.4; /* off 10 % by more than a factor of 2, but all come to rest */
    assert_int_equal(verdict_of("almost_at_rest"), MOTE_CLAIM_LIMITS);
}

TEST(claims_of_a_run_that_lacks_a_row_say_which)
{
    static const char *const names[] = {
        "times",           "hierarchy_memory",     "hierarchy_update",
        "faster_than_fcl", "best_engine_distance", "best_engine_contact"};
    mote_claim_verdict verdict;
    for (size_t i = 0; i < ROWS_OF(names); ++i) {
        for (size_t k = 0; k < EXPERIMENTS; ++k) {
            if (strcmp(experiments[k].name, names[i]) != 0)
                continue;
            plant_good();
            for (planted.rows = 0; measure(k, &verdict) != MOTE_OK; ++planted.rows) {
                assert_non_null(strstr(mote_error_text(), "no result of "));
                assert_true(planted.rows < PLANTED_ROWS);
            }
            assert_true(planted.rows > 0);
            plant_good();
            planted.body_failed = true;
            assert_int_equal(measure(k, &verdict), MOTE_EIO);
            assert_non_null(strstr(mote_error_text(), "1 cells of ww failed"));
        }
    }
}

static void hand_up(size_t k, long n, long all)
{
    mote_claim_verdict verdict;
    planted.failing = n;
    const mote_status status = measure(k, &verdict);
    planted.failing = 0;
    if (status == MOTE_OK || !strstr(mote_error_text(), "planted in "))
        fail_msg("%s: call %ld of %ld failed: %s: %s", experiments[k].name, n, all,
                 mote_status_text(status), mote_error_text());
}

/* The n-th call made by an experiment fails: the first ones, the last ones, and some in between
   (there are thousands of the same kind). */
TEST(claims_hand_up_what_fails_beneath)
{
    for (size_t k = 0; k < EXPERIMENTS; ++k) {
        mote_claim_verdict verdict;
        plant_good();
        if (measure(k, &verdict) != MOTE_OK)
            fail_msg("%s: %s", experiments[k].name, mote_error_text());
        const long all = planted.calls;
        assert_true(all > 1);
        const long near = mote_heap_read().counted ? 6 : 1; /* fewer with sanitizers */
        for (long n = 1; n <= all; n += n <= near || n > all - near ? 1 : (all + 2) / 3)
            hand_up(k, n, all);
    }
}

static size_t size_of(const char *name, const char *key)
{
    json_t *object = NULL;
    assert_int_equal(mote_record_read_json(base, name, &object), MOTE_OK);
    const size_t size = json_array_size(key ? json_object_get(object, key) : object);
    json_decref(object);
    return size;
}

TEST(claims_measure_writes_all_and_tells_whether_requirements_are_met)
{
    for (int good = 1; good >= 0; --good) {
        mote_study study;
        bool met = !good;
        plant_good();
        planted.error = good ? 0 : 0.3;
        assert_int_equal(mote_study_open(base, true, &study), MOTE_OK);
        if (mote_claims_measure(&study, &met) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        mote_study_close(&study);
        assert_true(met == good);
        assert_int_equal(size_of("claims.json", NULL), 14);
        assert_int_equal(size_of("requirements.json", NULL), 7);
    }
}

/* As `mote run` does: 5 where a cell failed, 1 where a requirement is not met, 4 where a file
   cannot be written. */
TEST(claims_end_with_the_status_of_what_failed)
{
    static const struct {
        bool cell, file, wrong;
        int code;
    } rows[] = {{false, false, false, MOTE_EXIT_DONE},
                {false, false, true, MOTE_EXIT_CHECK_FAILED},
                {false, true, false, MOTE_EXIT_BAD_INPUT},
                {true, false, false, MOTE_EXIT_CELL_FAILED}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char words[][16] = {"claims", "--out", "out", "--quick"};
        char *argv[] = {words[0], words[1], words[2], words[3], NULL};
        test_row("%zu", i);
        plant_good();
        planted.body_failed = rows[i].cell;
        planted.failing = rows[i].file;
        planted.error = rows[i].wrong ? 0.3 : 0;
        assert_int_equal(mote_command_claims(4, argv), rows[i].code);
    }
}

static bool text_has(const char *name, const char *part)
{
    char path[256], *text = NULL;
    size_t size;
    (void)snprintf(path, sizeof path, "%s/%s", base, name);
    assert_int_equal(mote_file_read(path, 1 << 26, &text, &size), MOTE_OK);
    const bool has = strstr(text, part) != NULL;
    free(text);
    return has;
}

static const mote_extremes_wish quick_wish = {.quick = true};

static bool extremes_met(void)
{
    bool met = false;
    if (mote_study_extremes(base, &quick_wish, &met) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return met;
}

TEST(extremes_are_met_unless_ours_is_wrong_or_any_gives_no_number)
{
    plant_good();
    assert_true(extremes_met());
    assert_true(text_has("extremes.md", "## Wrong: 0"));
    planted.others_verdict = MOTE_EXTREME_REFUSED;
    assert_true(extremes_met());
    assert_true(text_has("extremes.csv", "planted, as refused"));
    assert_true(text_has("extremes.csv", ",stream,"));
    assert_false(text_has("extremes.csv", ",impact-sampled,")); /* would refuse every scene */
    planted.ours_verdict = MOTE_EXTREME_WRONG;
    assert_false(extremes_met());
    assert_true(text_has("extremes.md", "| certified | "));
    plant_good();
    planted.others_verdict = MOTE_EXTREME_CRASHED;
    assert_false(extremes_met());
    planted.ours_verdict = MOTE_EXTREME_NONE; /* a method without the parameter has no cell */
    assert_false(extremes_met());
    assert_false(text_has("extremes.csv", ",certified,"));
    assert_true(size_of("extremes.json", "scenes") > 20);
}

static bool dynamics_met(bool keep)
{
    bool met = false;
    const mote_dynamics_size size = {.quick = true};
    if (mote_study_dynamics(base, &size, 1, 0x1234, keep, &met) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return met;
}

TEST(dynamics_are_measured_once_and_met_where_exact_methods_let_nothing_pass)
{
    plant_good();
    assert_true(dynamics_met(false));
    const long simulated = planted.simulated;
    assert_true(simulated > 10);
    assert_true(dynamics_met(false));
    assert_int_equal(planted.simulated, simulated); /* not simulated again */
    planted.others_pass = true;
    assert_true(dynamics_met(true)); /* from the existing rows */
    char rows[96];
    (void)snprintf(rows, sizeof rows, "%s/rows", base);
    assert_int_equal(folder_remove(rows), 0);
    assert_false(dynamics_met(false));
    assert_true(size_of("dynamics.json", "failures") > 0);
}

static mote_status study_bodies(bool *met)
{
    char name[] = "bodies";
    char *words[] = {name, NULL};
    return mote_study_bodies(base, true, 1, words, met);
}

static bool bodies_met(void)
{
    bool met = false;
    if (study_bodies(&met) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return met;
}

TEST(bodies_are_met_where_every_requirement_is)
{
    plant_good();
    assert_true(bodies_met());
    assert_int_equal(size_of("bodies.json", "requirements"), 4);
    assert_int_equal(size_of("bodies.json", "gains"), 27);
    assert_true(text_has("characters/crowd-200-4.json", "\"near_pairs\": 4}"));
    planted.ratio = 19;
    assert_false(bodies_met());
    plant_good();
    planted.ratio = (double)NAN;
    assert_false(bodies_met());
    plant_good();
    planted.body_missed = true;
    assert_false(bodies_met());
    plant_good();
    planted.body_failed = true;
    assert_false(bodies_met());
    assert_true(text_has("bodies.csv", ",crashed\n"));
}

static const char *profile_of(const char *name)
{
    json_t *object = NULL;
    assert_int_equal(mote_record_read_json(base, name, &object), MOTE_OK);
    const char *profile = json_string_value(json_object_get(object, "profile"));
    const bool full = profile && strcmp(profile, "full") == 0;
    json_decref(object);
    return full ? "full" : "quick";
}

/* The output distinguishes all unmet requirements. */
TEST(bodies_say_which_requirement_is_not_met)
{
    plant_good();
    planted.bodies_failed = true; /* and there is no gain to report */
    assert_false(bodies_met());
    assert_int_equal(size_of("bodies.json", "gains"), 0);
    assert_true(text_has("bodies.csv", ",,,,,,,,,,,,,,,,,,,crashed\n"));
    plant_good();
    planted.replicate_failed = true;
    assert_false(bodies_met());
    plant_good();
    planted.body_alone = true;
    assert_false(bodies_met());
    static const int64_t bytes[] = {0, (int64_t)1 << 30};
    for (int k = 0; k < 2; ++k) {
        plant_good();
        planted.body_bytes = bytes[k];
        assert_false(bodies_met());
    }
    assert_string_equal(profile_of("bodies.json"), "quick");
}

/* The exit code tells whether the requirements are met; the profile contains the
   measurements. */
TEST(commands_of_studies_exit_as_the_requirements_are_met)
{
    char name[] = "study", out[] = "--out", quick[] = "--quick";
    char *whole[] = {name, out, base, NULL}, *part[] = {name, quick, out, base, NULL};
    plant_good();
    assert_int_equal(mote_command_bodies(3, whole), MOTE_EXIT_DONE);
    assert_string_equal(profile_of("bodies.json"), "full");
    assert_int_equal(mote_command_extremes(4, part), MOTE_EXIT_DONE);
    assert_string_equal(profile_of("extremes.json"), "quick");
    planted.body_missed = true;
    planted.ours_verdict = MOTE_EXTREME_WRONG;
    assert_int_equal(mote_command_bodies(4, part), MOTE_EXIT_CHECK_FAILED);
    assert_int_equal(mote_command_extremes(4, part), MOTE_EXIT_CHECK_FAILED);
    plant_good();
    for (int k = 0; k < 2; ++k) {
        planted.failing = planted.calls + 1;
        assert_int_equal(k ? mote_command_bodies(4, part) : mote_command_extremes(4, part),
                         MOTE_EXIT_BAD_INPUT);
        assert_non_null(strstr(mote_error_text(), "planted in "));
    }
}

TEST(studies_hand_up_what_fails_beneath)
{
    for (int bodies = 0; bodies < 2; ++bodies) {
        bool met;
        plant_good();
        assert_int_equal(bodies ? study_bodies(&met)
                                : mote_study_extremes(base, &quick_wish, &met),
                         MOTE_OK);
        const long all = planted.calls;
        for (long n = 1; n <= all; n += n < 10 || n > all - 8 ? 1 : (all + 7) / 8) {
            planted.calls = 0;
            planted.failing = n;
            const mote_status status =
                bodies ? study_bodies(&met) : mote_study_extremes(base, &quick_wish, &met);
            planted.failing = 0;
            if (status != MOTE_EIO || !strstr(mote_error_text(), "planted in "))
                fail_msg("call %ld of %ld failed: %s", n, all, mote_error_text());
        }
    }
}

static int make_base(void)
{
    planted.folder = base;
    return mkdir(base, 0777);
}

TEST_GROUP(make_base, NULL);
