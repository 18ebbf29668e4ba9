/* Claims: verdicts follow from figures and thresholds; the foundations of the experiments. */
#include "harness/study/claims.h"

#include "harness/figure/figure.h"
#include "harness/study/claims_run.h"
#include "tests/support/mote.h"
#include "tests/support/stored_cells.h"
#include "tests/support/test.h"

#include <sys/stat.h>
#include <unistd.h>

#include <stddef.h>

#include <math.h>

static mote_confidence interval(double low, double high)
{
    const mote_confidence made = {low, high};
    return made;
}

static void add(mote_claim *claim, double value, mote_confidence range, mote_bound bound,
                double holds, double limits)
{
    const mote_estimate estimate = {value, range};
    mote_claim_add(claim, estimate, "L", "figure %d", 1);
    mote_claim_require(claim, bound, holds, limits);
}

TEST(judge_by_the_worse_end_of_the_interval)
{
    mote_claim claim = {.id = "x"};
    add(&claim, 0.08, interval(0.07, 0.09), MOTE_AT_MOST, 0.1, 0.2);
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_HOLDS);
    claim.values[0].estimate.interval.high = 0.11;
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_LIMITS);
    claim.values[0].estimate.interval.high = 0.21;
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_DOES_NOT_HOLD);
    mote_claim_require(&claim, MOTE_AT_LEAST, 0.07, MOTE_NONE);
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_HOLDS);
    mote_claim_require(&claim, MOTE_AT_LEAST, 0.075, MOTE_NONE);
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_DOES_NOT_HOLD);
    mote_claim_free(&claim);
}

TEST(judge_needs_every_threshold_of_a_level)
{
    mote_claim claim = {.id = "x"};
    const mote_confidence none = interval(MOTE_NONE, MOTE_NONE);
    add(&claim, 1, none, MOTE_AT_MOST, 2, 2);
    add(&claim, 3, none, MOTE_AT_MOST, 2, MOTE_NONE);
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_LIMITS);
    add(&claim, 3, none, MOTE_AT_MOST, MOTE_NONE, 2);
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_DOES_NOT_HOLD);
    mote_claim_free(&claim);
}

TEST(judge_without_a_figure_or_a_threshold_does_not_hold)
{
    mote_claim claim = {.id = "x"};
    const mote_confidence none = interval(MOTE_NONE, MOTE_NONE);
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_DOES_NOT_HOLD);
    add(&claim, 1, none, MOTE_BOUND_NONE, MOTE_NONE, MOTE_NONE);
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_DOES_NOT_HOLD);
    add(&claim, MOTE_NONE, none, MOTE_AT_LEAST, 0, 0);
    assert_int_equal(mote_claim_judge(&claim), MOTE_CLAIM_DOES_NOT_HOLD);
    mote_claim_free(&claim);
}

TEST(json_holds_the_headline_and_every_figure)
{
    mote_claim claim = {
        .id = "x", .section = "3", .claim = "c", .measured = "m", .curve = NULL};
    add(&claim, 0.5, interval(0.25, 0.75), MOTE_AT_MOST, 1, MOTE_NONE);
    add(&claim, 7, interval(MOTE_NONE, MOTE_NONE), MOTE_BOUND_NONE, MOTE_NONE, MOTE_NONE);
    json_t *json = mote_claim_json(&claim);
    assert_non_null(json);
    assert_string_equal(json_string_value(json_object_get(json, "verdict")), "holds");
    assert_true(json_real_value(json_object_get(json, "value")) == 0.5);
    assert_true(json_real_value(json_array_get(json_object_get(json, "interval"), 1)) == 0.75);
    assert_int_equal(json_array_size(json_object_get(json, "values")), 2);
    const json_t *threshold = json_object_get(json, "threshold");
    assert_true(json_real_value(json_object_get(threshold, "holds")) == 1);
    assert_true(json_is_null(json_object_get(threshold, "limits")));
    json_decref(json);
    mote_claim_free(&claim);
}

/* Values from published tables of Clopper and Pearson's intervals. */
TEST(share_interval_matches_tables)
{
    const mote_confidence none = mote_statistics_share_interval(0, 10);
    const mote_confidence half = mote_statistics_share_interval(5, 10);
    const mote_confidence all = mote_statistics_share_interval(10, 10);
    assert_true(none.low == 0 && fabs(none.high - 0.3085) < 1e-4);
    assert_true(fabs(half.low - 0.1871) < 1e-4 && fabs(half.high - 0.8129) < 1e-4);
    assert_true(fabs(all.low - 0.6915) < 1e-4 && all.high == 1);
    const mote_confidence nothing = mote_statistics_share_interval(0, 0);
    assert_true(nothing.low != nothing.low);
}

TEST(estimate_of_ratios_is_their_geometric_mean)
{
    const double values[] = {1, 4, 16};
    const mote_estimate e = mote_estimate_ratio(values, 3);
    assert_true(fabs(e.value - 4) < 1e-12);
    assert_true(fabs(e.interval.low * e.interval.high - 16) < 1e-9 && e.interval.low > 0);
}

/* Sizes that deviate from the power by up to a fifth: more seeds, which share it, tell nothing
   more about the exponent. */
TEST(estimate_of_exponent_counts_each_size_once)
{
    enum { SIZES = 6, SEEDS = 5 };
    static const double off[SIZES] = {1, 1.2, 0.9, 1.1, 0.85, 1};
    double x[SIZES], y[SIZES], repeated[SIZES * SEEDS];
    mote_estimate one, many, few;
    for (size_t i = 0; i < SIZES; ++i) {
        x[i] = pow(2, (double)i);
        y[i] = x[i] * x[i] * off[i];
        for (size_t s = 0; s < SEEDS; ++s)
            repeated[i * SEEDS + s] = y[i] * (1 + 0.01 * ((double)s - 2));
    }
    assert_int_equal(mote_estimate_exponent(x, y, SIZES, 1, &one), MOTE_OK);
    assert_int_equal(mote_estimate_exponent(x, repeated, SIZES, SEEDS, &many), MOTE_OK);
    assert_true(fabs(many.value - one.value) < 1e-9);
    assert_true(fabs(many.interval.low - one.interval.low) < 1e-9);
    assert_true(many.interval.high - many.interval.low > 0.1);
    assert_int_equal(mote_estimate_exponent(x, repeated, 3, SEEDS, &few), MOTE_OK);
    assert_true(isnan(few.value) && isnan(few.interval.low));
}

/* Replicate 2 of one row and 1 of the other crashed: what is left in common is replicate 3. */
TEST(ratio_of_rows_pairs_replicates_by_number)
{
    double times[] = {10, 20, 40};
    mote_stored_cell cells[2][3];
    mote_summary_row rows[2];
    for (size_t k = 0; k < 2; ++k) {
        for (uint32_t r = 0; r < 3; ++r) {
            const bool ran = r != 1 - k;
            cells[k][r] = (mote_stored_cell){.status = ran ? MOTE_CELL_OK : MOTE_CELL_CRASHED,
                                             .replicate = r + 1,
                                             .frames = ran ? 1 : 0,
                                             .total_ns = &times[r]};
        }
        rows[k] = (mote_summary_row){.cells = cells[k], .replicates = 3};
    }
    mote_cell_pair pairs[MOTE_STUDY_SEEDS];
    assert_int_equal(mote_row_pairs(&rows[0], &rows[1], pairs), 1);
    assert_true(pairs[0].over == &cells[0][2] && pairs[0].under == &cells[1][2]);
    const mote_estimate ratio = mote_row_ratio(&rows[0], &rows[1], mote_cell_median);
    assert_true(fabs(ratio.value - 1) < 1e-12);
}

/* A small variant of a scene; its queries allocate nothing once warm. */
TEST(queries_from_frame_50_on_allocate_nothing)
{
    mote_study study;
    assert_int_equal(mote_study_open("study", true, &study), MOTE_OK);
    const mote_variant variant = {"ww", "small", 'V', 2000, false};
    const mote_subject *subject = NULL;
    if (mote_study_variant(&study, &variant, &subject) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(subject->scenario->body[0].mesh->triangle_count, 2000);
    static const char *const methods[] = {
        "particle-paper:n=5", "particle-paper:n=8,refine=always,move=surface",
        "particle-paper:n=40,far_cache=0.5", "particle-paper:n=5,precision=single"};
    for (size_t m = 0; m < sizeof methods / sizeof methods[0]; ++m) {
        mote_cell_result result;
        const mote_tour tour = {.first = 900, .last = 1300, .seed = m + 1};
        assert_int_equal(mote_study_measure(subject, methods[m], tour, &result), MOTE_OK);
        assert_int_equal(result.row_count, 401);
        for (size_t i = 50; i < result.row_count; ++i)
            assert_int_equal(result.rows[i].allocations, 0);
        mote_cell_result_free(&result);
    }
    mote_study_close(&study);
}

/* The claims table of a file that mote would not write: nothing is invented. */
TEST(figure_of_odd_claims_shows_what_is_there)
{
    static const struct {
        const char *claims;
        const char *shows[2]; /* parts of the data */
    } cases[] = {
        {"[{}]", {"0 0 \"\"\n", "2 0 \": not measured\"\n"}},
        {"[5, {\"id\": \"b\", \"verdict\": \"holds\"}]", {"0 2 \"b\"\n", "2 1 2 \"holds\"\n"}},
        {"[{\"id\": \"dynamics\", \"claim\": \"x\"}]",
         {"1 0 \"dynamics: x\"\n", "2 1 \": not measured\"\n"}},
        {"[{\"value\": 2, \"unit\": \"L\"}]", {"\": 2 L\"", "0 1 0 \"\""}},
        {"[{\"value\": 2.5, \"interval\": [1, 3.5]}]", {"\": 2.5 [1, 3.5] \""}},
        {"[{\"value\": 2.5, \"interval\": [1.5, 3]}]", {"\": 2.5 [1.5, 3] \""}},
        {"[{\"value\": 2.5, \"interval\": [1]}]", {"\": 2.5 \""}},
        {"[{\"value\": 2.5, \"interval\": [null, 3]}]", {"\": 2.5 \""}},
        {"[{\"value\": 2.5, \"interval\": [1, \"3\"]}]", {"\": 2.5 \""}},
        {"[{\"value\": \"2.5\"}]", {"\": not measured\""}},
        {"[{\"verdict\": \"holds within limits\"}]", {"0 1 1 \"within limits\""}},
        {"[{\"verdict\": \"does not hold\"}]", {"0 1 0 \"does not hold\""}},
        {"[{\"claim\": "
         "\"of_one_word_that_is_longer_than_a_line_of_the_table_can_be,_is_cut\"}]",
         {"1 0 \"of_one_word_that_is_longer_than_a_line_of_the_table_\"\n",
          "1 1 \"can_be,_is_cut\"\n"}},
        {"[{\"claim\": \"a b c d e f g h i j k l m n o p q r s t u v w x y z a b c d e f g h i "
         "j "
         "k l m n o p q r s t u v w x y z a b c d e f g h i j k l m n o p q r s t u v w x y z "
         "a "
         "b c d e f g h i j k l m n o p q r s t u v w x y z a b c d e f g h i j k l m n o p q "
         "r "
         "s t u v w x y z a b c d e f g h i j k l m n o p q r s t u v w x y z THE END\"}]",
         {"1 5 \"", "2 6 \": not measured\""}}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        json_t *claims = json_loads(cases[i].claims, 0, NULL);
        assert_non_null(claims);
        const mote_figure_run run = {"out", NULL, claims};
        mote_figure figure = {{0}, {0}, {0}};
        assert_int_equal(mote_figure_claims(&run, NULL, &figure), MOTE_OK);
        for (int k = 0; k < 2 && cases[i].shows[k]; ++k) {
            if (!strstr(figure.data.data, cases[i].shows[k]))
                fail_msg("%s shows no %s but\n%s", cases[i].claims, cases[i].shows[k],
                         figure.data.data);
        }
        assert_null(strstr(figure.data.data, "THE END")); /* six lines at most */
        free(figure.data.data);
        free(figure.caption.data);
        json_decref(claims);
    }
}

/* Figures of missing studies name the command that makes them. */
TEST(figures_without_a_study_name_what_measures_it)
{
    const mote_figure_run run = {"/tmp/no/such/run", NULL, NULL};
    static const struct {
        mote_figure_writer *write;
        const char *missing;
    } cases[] = {{mote_figure_claims, "claims.json; `make claims OUT=/tmp/no/such/run`"},
                 {mote_figure_extremes, "figures/extremes.dat; `make extremes OUT=/tmp/no/"}};
    for (size_t i = 0; i < 2; ++i) {
        mote_figure figure = {{0}, {0}, {0}};
        assert_int_equal(cases[i].write(&run, NULL, &figure), MOTE_OK);
        assert_non_null(strstr(figure.missing.data, cases[i].missing));
        assert_int_equal(figure.data.size, 0);
        free(figure.missing.data);
    }
}

TEST(figure_of_extremes_is_their_data)
{
    static const char path[] = "figures/extremes.dat";
    file_put(path, "1 2\n");
    const mote_figure_run run = {".", NULL, NULL};
    mote_figure figure = {{0}, {0}, {0}};
    assert_int_equal(mote_figure_extremes(&run, NULL, &figure), MOTE_OK);
    assert_string_equal(figure.data.data, "1 2\n");
    free(figure.data.data);
    free(figure.caption.data);
    /* A file that exists and cannot be read is an error. */
    assert_int_equal(unlink(path) || mkdir(path, 0777), 0);
    figure = (mote_figure){{0}, {0}, {0}};
    assert_int_equal(mote_figure_extremes(&run, NULL, &figure), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "extremes.dat"));
    free(figure.caption.data);
}

/* Cells are files: one may have fewer frames than the others, or none that count. */
TEST(slowest_frame_of_cut_cells_is_of_what_is_there)
{
    const stored_cell cells[] = {
        {.scenario = "ww",
         .rows = "1,0,0,9e6,1,0,0,0,7\n2,0,0,3e6,1,0,0,0,7\n"
                 "3,0,0,4e6,1,0,0,0,7\n4,0,0,9e6,1,0,0,0,7\n"},
        {.scenario = "ww",
         .replicate = 2,
         .rows = "1,0,0,9e6,1,0,0,0,7\n2,0,0,7e6,1,0,0,0,7\n"},
        {.scenario = "tt", .id = "tt", .rows = "1,0,0,1,1,0,0,0,7\n4,0,0,1,1,0,0,0,7\n"}};
    mote_study study = {.summarised = true};
    mote_claim claim = {0};
    for (size_t i = 0; i < 3; ++i) {
        stored_cell cell = cells[i];
        cell.method = "particle-paper";
        cell.parameters = i < 2 ? "{\"n\": 5}" : "{\"n\": 3}";
        stored_cell_put("cut", cell);
    }
    assert_int_equal(mote_summary_make("cut", &study.summary), MOTE_OK);
    assert_int_equal(mote_claim_times(&study, &claim), MOTE_OK);
    assert_int_equal(claim.count, 4);
    assert_true(claim.values[1].estimate.value == 5); /* of 3 and 7; then 4 alone */
    assert_true(isnan(claim.values[3].estimate.value));
    assert_false(mote_claim_met(&claim.values[3], claim.values[3].limits));
    mote_claim_free(&claim);
    mote_summary_free(&study.summary);
}

/* In the slowest frame a third of the processes is fast, as their particles started elsewhere.
 */
TEST(slowest_frame_has_no_interval_below_the_mean)
{
    mote_study study = {.summarised = true};
    mote_claim claim = {0};
    for (int r = 1; r <= 6; ++r) {
        stored_cell_put("six", (stored_cell){.scenario = "ww",
                                             .method = "particle-paper",
                                             .parameters = "{\"n\": 5}",
                                             .replicate = r,
                                             .rows = r % 3 ? "2,0,0,9e6,1,0,0,0,7\n"
                                                             "3,0,0,3e6,1,0,0,0,7\n"
                                                           : "2,0,0,1e6,1,0,0,0,7\n"
                                                             "3,0,0,3e6,1,0,0,0,7\n"});
    }
    stored_cell_put("six", (stored_cell){.scenario = "tt",
                                         .method = "particle-paper",
                                         .id = "tt",
                                         .parameters = "{\"n\": 3}",
                                         .rows = "2,0,0,1e6,1,0,0,0,7\n"});
    assert_int_equal(mote_summary_make("six", &study.summary), MOTE_OK);
    assert_int_equal(mote_claim_times(&study, &claim), MOTE_OK);
    assert_non_null(strstr(claim.values[0].name, "mean of the active interval"));
    assert_non_null(strstr(claim.values[1].name, "slowest frame of it, median over processes"));
    assert_true(claim.values[1].estimate.value == 9);
    assert_true(isnan(claim.values[1].estimate.interval.low));
    mote_claim_free(&claim);
    mote_summary_free(&study.summary);
}

/* One engine is fastest by the frames' medians over processes, but slow in one process; the
   figure shown is the mean over processes of their medians, by which the other is. */
TEST(best_engine_is_that_of_the_ratio_shown)
{
    static const struct {
        const char *method, *usual, *last; /* the row of two processes, and of the third */
    } rows[] = {{"certified", "1,0,0,1,1,0,0,0,7\n", "1,0,0,1,1,0,0,0,7\n"},
                {"fcl-aabb", "1,0,0,10,1,0,0,0,7\n", "1,0,0,1000,1,0,0,0,7\n"},
                {"fcl-obbrss", "1,0,0,20,1,0,0,0,7\n", "1,0,0,20,1,0,0,0,7\n"}};
    mote_study study = {.summarised = true};
    mote_claim claim = {0};
    for (size_t m = 0; m < ROWS_OF(rows); ++m) {
        for (int r = 1; r <= 3; ++r)
            stored_cell_put("best",
                            (stored_cell){.scenario = "ww",
                                          .method = rows[m].method,
                                          .replicate = r,
                                          .frames = "[1, 1]",
                                          .rows = r < 3 ? rows[m].usual : rows[m].last});
    }
    assert_int_equal(mote_summary_make("best", &study.summary), MOTE_OK);
    /* Only one of the three scenes is there. */
    assert_int_equal(mote_claim_best_engine_distance(&study, &claim), MOTE_ENUMERIC);
    assert_non_null(strstr(claim.values[0].name, "ww, median: fcl-obbrss"));
    assert_true(fabs(claim.values[0].estimate.value - 20) < 1e-9);
    assert_non_null(strstr(claim.values[1].name, "ww, mean: fcl-aabb"));
    assert_true(fabs(claim.values[1].estimate.value - 10) < 1e-9);
    mote_claim_free(&claim);
    mote_summary_free(&study.summary);
}

TEST(command_with_an_unknown_word_is_a_usage_error)
{
    mote_expect(2, "", "claims something");
    mote_expect(2, "", "claims --fast");
    mote_expect(4, "", "claims --out /dev/null/x");
}
