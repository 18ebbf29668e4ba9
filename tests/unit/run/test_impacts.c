/* Runs that ask for impacts: their truth against a proof by intervals, every method that
   answers against the truth, and what may be asked. */
#include "core/impact/impact.h"
#include "harness/base/file.h"
#include "harness/run/impact_truth.h"
#include "harness/run/subject.h"
#include "harness/run/truth.h"
#include "harness/scene/scenario_path.h"
#include "tests/support/folder.h"
#include "tests/support/interval_impact.h"
#include "tests/support/mote.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

#define TETRAHEDRON "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"

/* Two tetrahedra: one turns at the origin, the other crosses it in two jumps and comes back. A
   jump is as long as three of them: at no frame do they touch, but between two they do. */
#define PLACE(frame, place) "{\"frame\": " #frame ", \"position\": [" place "]}"
#define TURN(frame, degrees)                                                                   \
    "{\"frame\": " #frame ", \"axis\": [1, 2, 3], \"degrees\": " #degrees "}"
#define BODIES                                                                                 \
    "\"bodies\": [{\"file\": \"t.obj\", \"motion\": [" TURN(1, 0) ", " TURN(                   \
        12,                                                                                    \
        150) "]}, "                                                                            \
             "{\"file"                                                                         \
             "\": "                                                                            \
             "\"t."                                                                            \
             "obj\"%"                                                                          \
             "s, "                                                                             \
             "\"motio"                                                                         \
             "n\": "                                                                           \
             "[" PLACE(1, "-6, 0, 0") ", " PLACE(4, "-2.1, 0.1, 0") ", " PLACE(                \
                 5,                                                                            \
                 "2."                                                                          \
                 "1, "                                                                         \
                 "0, "                                                                         \
                 "0."                                                                          \
                 "1") ", " PLACE(9,                                                            \
                                 "2.2, 0, 0.2") ", " PLACE(10,                                 \
                                                           "-2.1, 0, 0.1") ", " PLACE(12,      \
                                                                                      "-5, "   \
                                                                                      "0.2, "  \
                                                                                      "0") "]" \
                                                                                           "}" \
                                                                                           "]"

#define DEFORMING                                                                              \
    ", \"field\": {\"count\": 3, \"support\": 1, \"displacement\": {\"random\": {\"seed\": "   \
    "3, "                                                                                      \
    "\"amplitude\": 0.1, \"periods\": [5, 9], \"terms\": 2}}}"

static void put_scenario(const char *name, const char *asks, const char *field)
{
    char text[2048], bodies[1600];
    (void)snprintf(bodies, sizeof bodies, BODIES, field);
    (void)snprintf(text, sizeof text, "{\"purpose\": \"p\", \"frames\": 12, %s, %s}", asks,
                   bodies);
    file_put("t.obj", TETRAHEDRON);
    file_put(name, text);
}

static mote_scenario *load(const char *name)
{
    mote_scenario *scenario = NULL;
    if (mote_scenario_load(name, &scenario) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return scenario;
}

/* Checks every gap of a scenario's truth by intervals, and the certified time of impact too. */
static void check_truth(const char *asks, const char *field)
{
    put_scenario("p.json", asks, field);
    mote_scenario *scenario = load("./p.json");
    mote_impact_truth *truth = NULL;
    mote_scenario_path *path = NULL;
    if (mote_impact_truth_load_or_compute(scenario, 7, ".", &truth) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(mote_scenario_path_create(scenario, 1, &path), MOTE_OK);
    int impacts = 0;
    for (uint32_t frame = 1; frame < scenario->frames; ++frame) {
        mote_scenario_path_set(path, frame);
        const interval_question q = {
            .body = {&scenario->body[0], &scenario->body[1]},
            .path = {mote_scenario_path_of(path, 0), mote_scenario_path_of(path, 1)},
            .tolerance = scenario->tolerance};
        const double until = interval_apart_until(&q), first = truth->first[frame - 1];
        if (isnan(first) ? until < 1 : !(until <= first + 1e-9 && until >= first - 1e-5))
            fail_msg("frame %u: apart until %.9g, the first impact at %.9g", frame, until,
                     first);
        impacts += !isnan(first);
    }
    assert_int_equal(impacts, 2);
    mote_scenario_path_destroy(path);
    mote_impact_truth_destroy(truth);
    mote_scenario_destroy(scenario);
}

TEST(impact_truth_agrees_with_intervals)
{
    check_truth("\"ask\": \"impact\", \"step\": 1, \"tolerance\": 0.01", "");
    check_truth("\"ask\": \"impact\", \"step\": 1, \"tolerance\": 0.02", DEFORMING);
}

TEST(impact_truth_is_read_from_its_file_unless_that_was_changed)
{
    put_scenario("p.json", "\"ask\": \"impact\", \"step\": 2", "");
    mote_scenario *scenario = load("./p.json");
    mote_impact_truth *made = NULL, *read = NULL, *again = NULL;
    assert_int_equal(mote_impact_truth_load_or_compute(scenario, 9, ".", &made), MOTE_OK);
    assert_int_equal(mote_impact_truth_load_or_compute(scenario, 9, ".", &read), MOTE_OK);
    assert_memory_equal(made->first, read->first, made->gaps * sizeof *made->first);
    char *path = mote_impact_truth_path(".", scenario, 9);
    char *text = NULL;
    size_t size = 0;
    assert_int_equal(mote_file_read(path, 1 << 20, &text, &size), MOTE_OK);
    char *digit = strstr(text, ",0.");
    assert_non_null(digit);
    digit[3] = digit[3] == '1' ? '2' : '1';
    assert_int_equal(mote_file_write(path, text, size), MOTE_OK);
    assert_int_equal(mote_impact_truth_load_or_compute(scenario, 9, ".", &again), MOTE_OK);
    assert_memory_equal(made->first, again->first, made->gaps * sizeof *made->first);
    free(text);
    free(path);
    mote_impact_truth_destroy(made);
    mote_impact_truth_destroy(read);
    mote_impact_truth_destroy(again);
    mote_scenario_destroy(scenario);
}

/* Two tetrahedra of which the second one flies past the first within one gap, or stands in it.
 */
static mote_scenario *load_two(const char *first, const char *last)
{
    char text[512];
    (void)snprintf(
        text, sizeof text,
        "{\"purpose\": \"p\", \"frames\": 2, \"ask\": \"impact\", \"step\": 1, "
        "\"bodies\": [{\"file\": \"t.obj\"}, {\"file\": \"t.obj\", \"motion\": "
        "[{\"frame\": 1, \"position\": [%s]}, {\"frame\": 2, \"position\": [%s]}]}]}",
        first, last);
    file_put("t.obj", TETRAHEDRON);
    file_put("two.json", text);
    return load("./two.json");
}

TEST(impact_truth_finds_what_no_sample_sees)
{
    /* The corner of the second one, 1 from its origin in x, comes within the tolerance of the
       face x = 0 of the first. Places are in units of L. Samples are a thousandth of the time
       apart. */
    static const struct {
        const char *first, *last;
        double from, way; /* of the second one's x */
        bool impact;
        uint32_t unsampled;
    } rows[] = {
        {"-3, 0.2, 0.2", "3, 0.2, 0.2", -3, 6, true, 0},
        {"-3003, 0.2, 0.2", "2997, 0.2, 0.2", -3003, 6000, true, 1},
        {"-3, 2, 0.2", "3, 2, 0.2", -3, 6, false, 0},
        {"-0.5, 0.2, 0.2", "9, 0, 0", -0.5, 9.5, true, 0}, /* in contact at the beginning */
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_impact_truth *truth = NULL;
        mote_scenario *scenario = load_two(rows[i].first, rows[i].last);
        if (mote_impact_truth_load_or_compute(scenario, i, ".", &truth) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        const double place = (-1 - scenario->tolerance) / scenario->length;
        const double expected = fmax(0, (place - rows[i].from) / rows[i].way);
        const double t = truth->first[0];
        const double done = 0.5 * t + 1.5 * t * t - t * t * t; /* by Catmull and Rom */
        test_row("%s: %.9g, expected %.9g of the way", rows[i].first, done, expected);
        assert_true(rows[i].impact ? fabs(done - expected) < 2e-6 : isnan(t));
        assert_int_equal(truth->unsampled, rows[i].unsampled);
        mote_impact_truth_destroy(truth);
        mote_scenario_destroy(scenario);
    }
}

/* The second one slides past the face x = 0, farther than the tolerance by 1e-10 of it, which
   is rounding to the search: no sample is in contact, and what a method says is not judged. */
TEST(impact_truth_of_bodies_that_graze_is_undecided)
{
    char text[600];
    const double place = (-1 - 0.01 * sqrt(3) * (1 + 1e-10)) / sqrt(3); /* L is sqrt(3) */
    (void)snprintf(text, sizeof text,
                   "{\"purpose\": \"p\", \"frames\": 2, \"ask\": \"impact\", \"step\": 1, "
                   "\"tolerance\": 0.01, \"bodies\": [{\"file\": \"t.obj\"}, {\"file\": "
                   "\"t.obj\", \"motion\": [{\"frame\": 1, \"position\": [%.17g, 0.1, 0.2]}, "
                   "{\"frame\": 2, \"position\": [%.17g, 0.2, 0.1]}]}]}",
                   place, place);
    file_put("t.obj", TETRAHEDRON);
    file_put("graze.json", text);
    mote_scenario *scenario = load("./graze.json");
    for (int read = 0; read < 2; ++read) { /* computed, then read from the file */
        mote_impact_truth *truth = NULL;
        double to = 0;
        if (mote_impact_truth_load_or_compute(scenario, 3, ".", &truth) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        assert_true(isinf(truth->first[0]) == 1);
        assert_int_equal(truth->unsampled, 0);
        assert_int_equal(mote_impact_truth_between(truth, 1, 1, &to), -1);
        mote_impact_truth_destroy(truth);
    }
    char *path = mote_impact_truth_path(".", scenario, 3);
    mote_scenario_destroy(scenario);
    char *file = file_text(path);
    free(path);
    assert_non_null(strstr(file, "\n1,undecided\n"));
    free(file);
    /* aabb-tree asks at single times and finds none. */
    mote_expect(0, "", "run graze.json --method aabb-tree --replicates 1 --out graze");
    json_t *summary = json_load_file("graze/summary.json", 0, NULL);
    const json_t *row = json_array_get(json_object_get(summary, "rows"), 0);
    assert_true(json_is_null(json_object_get(row, "missed")));
    assert_true(json_is_null(json_object_get(row, "false_contacts")));
    json_decref(summary);
}

TEST(impact_truth_of_a_step_is_that_of_its_first_gap_with_an_impact)
{
    double first[] = {NAN, 0.5, NAN, 0.25}, to = 0;
    const mote_impact_truth truth = {.gaps = 4, .first = first};
    assert_int_equal(mote_impact_truth_between(&truth, 1, 1, &to), 0);
    assert_int_equal(mote_impact_truth_between(&truth, 1, 2, &to), 1);
    assert_true(to == 0.75);
    assert_int_equal(mote_impact_truth_between(&truth, 3, 2, &to), 1);
    assert_true(to == 0.625);
    /* Beyond the last frame there is nothing. */
    assert_int_equal(mote_impact_truth_between(&truth, 5, 3, &to), 0);
    /* An impact before an undecided gap is the first, one behind it may not be. */
    first[2] = HUGE_VAL;
    assert_int_equal(mote_impact_truth_between(&truth, 1, 4, &to), 1);
    assert_true(to == 0.375);
    assert_int_equal(mote_impact_truth_between(&truth, 3, 1, &to), -1);
    assert_int_equal(mote_impact_truth_between(&truth, 3, 2, &to), -1);
    assert_int_equal(mote_impact_truth_between(&truth, 4, 1, &to), 1);
}

/* A file that is whole but says something else than the scenario's truth may. */
TEST(impact_truth_that_cannot_be_right_is_computed_anew)
{
    static const char first[] = "# impacts of two, fingerprint 0000000000000005, faces ",
                      columns[] = "frame,first\n";
    static const struct {
        const char *unsampled, *rest;
    } rows[] = {
        {"2\n", "frame,first\n1,0.5\n"}, /* more than there are gaps */
        {"x\n", "frame,first\n1,0.5\n"}, {"0\n", "frame,when\n1,0.5\n"},
        {"0\n", "frame,first\n2,0.5\n"}, {"0\n", "frame,first\n1;0.5\n"},
        {"0\n", "frame,first\n1,x\n"},   {"0\n", "frame,first\n1,0.5;\n"},
        {"0\n", "frame,first\n1,-1\n"},  {"0\n", "frame,first\n1,1.5\n"},
        {"0\n", "frame,first\n1,nan\n"}, {"0\n", "frame,first\n1,0.5\n2,0.5\n"},
        {"0\n", "frame,first\n1,inf\n"}, {"0\n", "frame,first\n1,undecided;\n"},
        {"0\n", "frame,first\n"},
    };
    mote_scenario *scenario = load_two("-3, 0.2, 0.2", "3, 0.2, 0.2");
    char *path = mote_impact_truth_path(".", scenario, 5);
    mote_impact_truth *truth = NULL;
    assert_int_equal(mote_impact_truth_load_or_compute(scenario, 5, ".", &truth), MOTE_OK);
    char *right = file_text(path);
    mote_impact_truth_destroy(truth);
    assert_int_equal(strncmp(right, first, strlen(first)), 0);
    const char *number = strstr(right, "samples: ") + strlen("samples: ");
    assert_int_equal(strncmp(number, "0\n", 2), 0);
    assert_int_equal(strncmp(number + 2, columns, strlen(columns)), 0);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_text text = {.data = NULL};
        test_row("%s%s", rows[i].unsampled, rows[i].rest);
        mote_text_add(&text, "%.*s%s%s", (int)(number - right), right, rows[i].unsampled,
                      rows[i].rest);
        mote_truth_seal(&text);
        file_write(path, text.data, text.size);
        free(text.data);
        assert_int_equal(mote_impact_truth_load_or_compute(scenario, 5, ".", &truth), MOTE_OK);
        mote_impact_truth_destroy(truth);
        char *again = file_text(path);
        assert_string_equal(again, right);
        free(again);
    }
    free(right);
    free(path);
    mote_scenario_destroy(scenario);
}

/* Runs the program, and returns what it prints; the caller frees it. */
static char *run(const char *line, int status)
{
    static const size_t room = 1 << 18;
    char *text = calloc(room, 1);
    need(text);
    const int got = program_wait(program_start(line, "printed"));
    program_read("printed", text, room);
    if (got != status)
        fail_msg("mote %s: status %d, not %d: %s", line, got, status, text);
    return text;
}

static void expect(const char *line, int status, const char *says)
{
    char *text = run(line, status);
    if (!strstr(text, says))
        fail_msg("mote %s: not \"%s\": %s", line, says, text);
    free(text);
}

/* A number of a row in r/summary.json. */
static double number(const json_t *rows, const char *label, int step, const char *key)
{
    size_t i;
    const json_t *row;
    json_array_foreach(rows, i, row)
    {
        if (strcmp(json_string_value(json_object_get(row, "label")), label) == 0 &&
            json_integer_value(json_object_get(row, "step")) == step) {
            const json_t *own = json_object_get(row, key);
            return json_number_value(
                own ? own : json_object_get(json_object_get(row, "impact"), key));
        }
    }
    fail_msg("no row %s of step %d", label, step);
    return -1;
}

TEST(run_of_impacts_counts_what_each_method_misses)
{
    put_scenario("p.json", "\"ask\": \"distance\"", "");
    free(run("run ./p.json --step 1,3,11 --method certified --method aabb-tree --method "
             "impact-sampled:samples=1 --method fcl-continuous:motion=screw --method stream "
             "--replicates 1 --out r",
             0));
    json_t *summary = json_load_file("r/summary.json", 0, NULL);
    const json_t *rows = json_object_get(summary, "rows");
    assert_int_equal(json_array_size(rows), 15);
    static const int steps[] = {1, 3, 11}, questions[] = {11, 3, 1}, impacts[] = {2, 2, 1};
    for (int k = 0; k < 3; ++k) {
        for (int m = 0; m < 2; ++m) {
            const char *method = m == 0 ? "certified" : "aabb-tree";
            assert_true(number(rows, method, steps[k], "frames") == questions[k]);
            assert_true(number(rows, method, steps[k], "contacts") == impacts[k]);
            assert_true(number(rows, method, steps[k], "missed") == 0);
            assert_true(number(rows, method, steps[k], "false_contacts") == 0);
            assert_true(number(rows, method, steps[k], "undecided") == 0);
            assert_true(number(rows, method, steps[k], "bracket") <= 1.0001e-6);
            assert_true(number(rows, method, steps[k], "delay") <= 1.0001e-6 * steps[k]);
        }
        /* Samples at the frames alone see nothing. */
        assert_true(number(rows, "impact-sampled:samples=1", steps[k], "missed") == impacts[k]);
    }
    json_decref(summary);
    expect("summarize r", 0, "1 question about impacts in steps of 11 frames");
    expect("summarize r --format csv", 0, "impact_iterations_p95");
    expect("summarize r", 0, "stream does not answer impacts");
    free(run("report r", 0));
    free(run("compare r r", 3)); /* one replicate: undecided */
    free(run("check ./p.json", 0));
    /* What is stored is not measured again. */
    expect("run ./p.json --step 3 --method certified --replicates 1 --out r", 0,
           "1 of them done");
}

TEST(instructions_of_impacts_are_counted_a_question)
{
    put_scenario("p.json", "\"ask\": \"impact\", \"step\": 3", "");
    free(run("instructions ./p.json --frames 1-12 --method certified --inside", 0));
    expect("instructions ./p.json --frames 1-12 --method stream --inside", 4,
           "stream does not answer impacts");
    static const char *const modes[] = {"--inside", "--out counted"};
    /* Without valgrind nothing is counted, whatever is asked. */
    for (size_t i = 0; i < ROWS_OF(modes) - !has_valgrind(); ++i) {
        char line[128];
        test_row("%s", modes[i]);
        (void)snprintf(line, sizeof line,
                       "instructions ./p.json --frames 1-3 --method certified %s", modes[i]);
        expect(line, 4, "frames 1-3: ./p.json asks for impacts within 3 frames");
        (void)snprintf(line, sizeof line,
                       "instructions ./p.json --frames 1-13 --method certified %s", modes[i]);
        expect(line, 4, "outside ./p.json; it has frames 1-12");
        (void)snprintf(line, sizeof line,
                       "instructions ./none.json --frames 1-3 --method "
                       "certified %s",
                       modes[i]);
        expect(line, 4, "none.json");
    }
    assert_false(file_exists("counted"));
}

TEST(run_of_impacts_refuses_what_cannot_be_asked)
{
    put_scenario("p.json", "\"ask\": \"distance\"", "");
    put_scenario("stepless.json", "\"ask\": \"impact\"", "");
    put_scenario("zero.json", "\"ask\": \"impact\", \"step\": 0", "");
    put_scenario("long.json", "\"ask\": \"impact\", \"step\": 12", "");
    put_scenario("idle.json", "\"ask\": \"contact\", \"step\": 2", "");
    file_put("many.json",
             "{\"purpose\": \"p\", \"frames\": 9, \"ask\": \"impact\", \"step\": 1, "
             "\"bodies\": {\"count\": 3, \"shapes\": [{\"file\": \"t.obj\"}], \"box\": 9}}");
    file_put("given.json",
             "{\"purpose\": \"p\", \"frames\": 2, \"ask\": \"impact\", \"step\": 1, "
             "\"bodies\": [{\"positions\": \"f1.obj\"}, {\"file\": \"t.obj\"}]}");
    file_put("f1.obj", TETRAHEDRON);
    file_put("f2.obj", TETRAHEDRON);
    expect("run ./p.json --step 0 --out x", 2, "ascending whole numbers");
    expect("run ./p.json --step 3,3 --out x", 2, "ascending whole numbers");
    expect("run ./p.json --step 12 --out x", 4, "a step is 1 to 11");
    expect("run ./p.json --step 5 --frames 1-5 --out x", 4, "no impact is asked for within");
    expect("run ./stepless.json --out x", 4, "stepless.json:1");
    expect("run ./zero.json --out x", 4, "zero.json:1");
    expect("run ./long.json --out x", 4, "long.json:1");
    expect("run ./idle.json --out x", 4, "a step is of scenarios that ask for impact");
    expect("run ./many.json --out x", 4, "impacts are asked of two bodies");
    expect("run ./given.json --out x", 4, "only positions are given");
}
