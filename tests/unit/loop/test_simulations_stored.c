/* Simulations that a directory keeps, as files that the test writes itself: whole, damaged,
   failed, of other machines. */
#include "harness/base/record.h"
#include "harness/loop/simulate_print.h"
#include "harness/loop/simulations.h"
#include "tests/support/diamond.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <math.h>

/* A simulation in a file; NULL and 0 stand for the usual. */
typedef struct stored {
    const char *file, *method, *machine, *program, *status, *reason;
    int replicate, seed;
    bool beside;     /* others ran beside it */
    double query_ns; /* 100 */
    uint64_t delay_max;
} stored;

/* What it stores. The caller decrefs. */
static json_t *json_of(const stored *s)
{
    const int replicate = s->replicate ? s->replicate : 1;
    const mote_simulation_result result = {.steps = 10,
                                           .delay_max = s->delay_max,
                                           .depth_max = MOTE_NONE,
                                           .query_ns = s->query_ns > 0 ? s->query_ns : 100};
    json_t *object =
        mote_simulation_json("two", 2, s->method ? s->method : "certified", &result);
    json_t *rest = json_pack(
        "{s:i, s:s, s:s, s:s, s:s, s:i, s:i, s:b}", "schema", 1, "status",
        s->status ? s->status : "ok", "machine", s->machine ? s->machine : "m1", "program",
        s->program ? s->program : "p1", "reason", s->reason ? s->reason : "", "replicate",
        replicate, "seed", s->seed + replicate, "alone", !s->beside);
    assert_int_equal(json_object_update(object, rest), 0);
    json_decref(rest);
    return object;
}

static void put(const char *directory, stored s)
{
    char *name = mote_format("simulations/%s.json", s.file);
    json_t *object = json_of(&s);
    if (s.status) /* a failure has no figures */
        (void)json_object_del(object, "steps");
    assert_int_equal(mote_simulations_make(directory), MOTE_OK);
    assert_int_equal(mote_record_json(directory, name, object), MOTE_OK);
    free(name);
}

TEST_EACH(folder_next, NULL);

TEST(rows_join_replicates_of_one_question_and_origin)
{
    mote_simulations list = {0};
    put("a", (stored){.file = "2", .replicate = 2, .query_ns = 300, .delay_max = 5});
    put("a", (stored){.file = "9", .replicate = 1, .query_ns = 100, .delay_max = 3});
    put("a", (stored){.file = "3", .replicate = 3, .query_ns = 200, .delay_max = 9});
    put("a", (stored){.file = "m", .replicate = 3, .machine = "m2"});
    put("a", (stored){.file = "p", .replicate = 3, .program = "p2"});
    put("a", (stored){.file = "s", .replicate = 3, .seed = 1});
    put("a", (stored){.file = "b", .replicate = 3, .beside = true});
    put("a", (stored){.file = "t", .method = "aabb-tree"});
    file_put("a/simulations/notes.txt", "no simulation");
    assert_int_equal(mote_simulations_read("a", &list), MOTE_OK);
    assert_int_equal(list.count, 6);
    assert_string_equal(list.rows[0].method, "aabb-tree"); /* by names */
    size_t joined = 0, beside = 0;
    for (size_t i = 0; i < list.count; ++i) {
        const mote_simulations_row *row = &list.rows[i];
        beside += !row->alone;
        joined += row->done == 3;
        if (row->done != 3)
            continue;
        for (uint32_t r = 0; r < 3; ++r)
            assert_int_equal(row->replicates[r].number, r + 1);
        assert_true(row->query_ns == 200 && row->sum.query_ns == 200);
        assert_int_equal(row->sum.steps, 30);
        assert_int_equal(row->sum.delay_max, 9);
        assert_true(isnan(row->sum.depth_max));
    }
    assert_int_equal(joined, 1);
    assert_int_equal(beside, 1);
    mote_simulations_free(&list);
}

/* As cells are: what an earlier build of the program simulated is no row of this one. */
TEST(simulations_of_other_programs_are_left_out)
{
    static const struct {
        const char *manifest;
        size_t count, left_out;
    } cases[] = {{"{\"program\": \"p2\"}", 1, 2},
                 {"{\"program\": \"p3\"}", 0, 3},
                 {"{\"program\": 5}", 2, 0}};
    put("a", (stored){.file = "1", .status = "crashed"});
    put("a", (stored){.file = "2", .replicate = 2});
    put("a", (stored){.file = "3", .program = "p2"});
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        mote_simulations list = {0};
        test_row("%s", cases[i].manifest);
        file_put("a/manifest.json", cases[i].manifest);
        assert_int_equal(mote_simulations_read("a", &list), MOTE_OK);
        assert_int_equal(list.count, cases[i].count);
        assert_int_equal(list.left_out, cases[i].left_out);
        mote_simulations_free(&list);
    }
    file_put("a/manifest.json", cases[0].manifest);
    mote_expect(0, "2 simulations are of another build and are left out\n", "summarize a");
    assert_null(strstr(said, "failed 1"));
    mote_expect(0, "\"simulations_left_out\": 2", "summarize a --format json");
    mote_expect(0, "a/report.html", "report a");
    char *text = file_text("a/report.md");
    assert_non_null(strstr(text, "2 simulations, which are of another build"));
    free(text);
    /* The first row by name is of the other program. */
    put("b", (stored){.file = "1", .program = "p0", .replicate = 3});
    put("b", (stored){.file = "2", .program = "p2"});
    file_put("b/manifest.json", cases[0].manifest);
    mote_expect(0, "two/certified/simulated", "compare a b");
    assert_null(strstr(said, "no replicate in common"));
}

TEST(damaged_files_are_left_out)
{
    static const char *const damaged[] = {
        "",
        "{",
        "[]\n",
        "7\n",
        "{}\n",
        "{\"status\": \"\"}\n",
        "{\"status\": 7}\n",
        "{\"status\": \"ok\"}\n",
    };
    static const struct {
        const char *key, *value; /* of a whole one, then not any more */
    } changes[] = {
        {"steps", "-1"},          {"steps", "1.5"},      {"steps", "9007199254740993"},
        {"query_ns", "\"fast\""}, {"query_ns", "[100]"}, {"impacts", "\"many\""},
    };
    mote_simulations list = {0};
    put("a", (stored){.file = "good"});
    for (size_t i = 0; i < ROWS_OF(damaged); ++i) {
        test_row("%s", damaged[i]);
        file_put("a/simulations/bad.json", damaged[i]);
        assert_int_equal(mote_simulations_read("a", &list), MOTE_OK);
        assert_int_equal(list.count, 1);
        assert_int_equal(list.rows[0].done, 1);
        mote_simulations_free(&list);
    }
    for (size_t i = 0; i < ROWS_OF(changes); ++i) {
        const stored whole = {.replicate = 2};
        json_t *object = json_of(&whole);
        test_row("%s %s", changes[i].key, changes[i].value);
        assert_int_equal(
            json_object_set_new(object, changes[i].key,
                                json_loads(changes[i].value, JSON_DECODE_ANY, NULL)),
            0);
        assert_int_equal(mote_record_json("a", "simulations/bad.json", object), MOTE_OK);
        assert_int_equal(mote_simulations_read("a", &list), MOTE_OK);
        assert_int_equal(list.rows[0].done, 1);
        mote_simulations_free(&list);
    }
    assert_int_equal(mote_simulations_read("nowhere", &list), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "nowhere/simulations: No such file"));
    mote_simulations_free(&list);
}

TEST(failures_are_shown_in_place_of_figures)
{
    put("a", (stored){.file = "1", .method = "ode", .status = "unsupported", .reason = "why"});
    put("a", (stored){.file = "2",
                      .method = "ode",
                      .status = "unsupported",
                      .replicate = 2,
                      .reason = "why not"});
    put("a", (stored){.file = "3", .method = "fcl-obb", .status = "crashed"});
    put("a", (stored){.file = "4"});
    put("a", (stored){.file = "5", .replicate = 2, .status = "crashed"});
    mote_expect(0, "two, ode: unsupported: why not\n", "summarize a");
    assert_non_null(strstr(said, "two, fcl-obb: every replicate failed\n"));
    assert_non_null(strstr(said, "replicates 1, failed 1; median time"));
    mote_expect(0, "\"unsupported\": \"why not\"", "summarize a --format json");
}

TEST(compared_simulations_say_what_cannot_be_compared)
{
    static const struct {
        stored base, fresh;
        const char *says;
        int status;
    } rows[] = {
        {{.file = "1", .replicate = 1},
         {.file = "1", .replicate = 2},
         "no replicate in common",
         3},
        {{.file = "1", .beside = true},
         {.file = "1", .beside = true},
         "times not comparable: simulated with --jobs",
         0},
        {{.file = "1", .beside = true, .status = "crashed"},
         {.file = "1", .beside = true},
         "times not comparable: simulated with --jobs",
         0},
        {{.file = "1", .machine = "m2"}, {.file = "1"}, "two/certified/simulated", 3},
        {{.file = "1"}, {.file = "1", .delay_max = 7}, "two/certified/simulated", 3},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char *base = mote_format("base%zu", i), *fresh = mote_format("fresh%zu", i);
        test_row("%zu: %s", i, rows[i].says);
        put(base, rows[i].base);
        put(fresh, rows[i].fresh);
        mote_expect(rows[i].status, rows[i].says, "compare %s %s", base, fresh);
        free(base);
        free(fresh);
    }
    /* Of several machines the same is preferred, in whatever order the rows are. */
    put("many", (stored){.file = "1", .machine = "m0", .query_ns = 1000});
    put("many", (stored){.file = "2", .machine = "m9", .query_ns = 1000});
    put("many", (stored){.file = "3", .machine = "m1"});
    put("one", (stored){.file = "1"});
    mote_expect(3, "two/certified/simulated", "compare one many");
    assert_non_null(strstr(said, "1.000"));
    put("others", (stored){.file = "1", .machine = "m0"});
    put("others", (stored){.file = "2", .machine = "m9"});
    mote_expect(3, "two/certified/simulated", "compare one others");
}

/* Two diamonds, the second flying at the first. */
static void put_two(void)
{
    file_put("a.obj", DIAMOND);
    file_put("two.json",
             "{\"purpose\": \"x\", \"frames\": 40, \"ask\": \"distance\", \"tolerance\": 0.01, "
             "\"bodies\": [{\"file\": \"a.obj\"}, {\"file\": \"a.obj\", \"motion\": "
             "[{\"frame\": 1, \"position\": [2.1, 0.1, 0]}, {\"frame\": 40, \"position\": "
             "[0.5, 0.1, 0]}]}]}\n");
}

/* What a directory keeps is not simulated again, unless it is damaged. */
TEST(kept_simulations_are_recalled_if_they_are_whole)
{
    static const char line[] = "simulate two.json --method certified --method fcl-obb --seed 3 "
                               "--steps 5 --replicates 2 --out kept";
    put_two();
    mote_expect(0, "plan: 4 simulations, 0 of them done", line);
    mote_expect(0, "plan: 4 simulations, 4 of them done", line);
    assert_int_equal(system("cd kept/simulations && echo '{' > \"$(ls *certified-r1-*)\" && "
                            "echo '{\"status\": \"ok\"}' > \"$(ls *certified-r2-*)\""),
                     0);
    mote_expect(0, "plan: 4 simulations, 2 of them done", line);
    mote_expect(0, "plan: 4 simulations, 4 of them done", line);
}

/* A failed simulation fails the commands that ask for it, until the program is another. */
TEST(only_failures_that_were_asked_for_fail_a_command)
{
    static const char again[] = "simulate two.json --method certified --steps 5 --out kept";
    put_two();
    mote_expect(0, "two certified r1: ok", again);
    assert_int_equal(system("sed -i 's/\"status\": \"ok\"/\"status\": \"crashed\"/; "
                            "/\"steps\":/d' kept/simulations/*"),
                     0);
    mote_expect(5, "1 of 1 simulations failed", again);
    mote_expect(0, "two fcl-obb r1: ok",
                "simulate two.json --method fcl-obb --steps 5 --out kept");
    mote_expect(5, "1 of 1 simulations failed", again);
    /* As an earlier build would have named them. */
    assert_int_equal(system("cd kept/simulations && mv *certified* earlier.json && "
                            "sed -i 's/\"program\": \"/&0/' earlier.json"),
                     0);
    mote_expect(0, "two certified r1: ok", again);
    assert_non_null(strstr(said, "1 simulations are of another build and are left out"));
    assert_null(strstr(said, "every replicate failed"));
}
