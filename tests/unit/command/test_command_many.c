/* Commands accept scenarios of many bodies as they accept those of two. */
#include "harness/base/heap_count.h"
#include "harness/base/record.h"
#include "tests/support/diamond.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <unistd.h>

#define SEVERAL                                                                                \
    "{\"purpose\": \"x\", \"frames\": 4, \"ask\": \"distance\", \"tolerance\": 0.01, "         \
    "\"bodies\": {\"count\": 5, \"seed\": 2, \"near_pairs\": 1, \"near\": 0.2, "               \
    "\"speed\": 0.01, \"spin\": 1, \"shapes\": [{\"file\": \"a.obj\"}]}}\n"

/* Two diamonds, the second flying at the first, or touching it from the start. */
#define TWO(x)                                                                                 \
    "{\"purpose\": \"x\", \"frames\": 40, \"ask\": \"distance\", \"tolerance\": 0.01, "        \
    "\"bodies\": [{\"file\": \"a.obj\"}, {\"file\": \"a.obj\", \"motion\": [{\"frame\": 1, "   \
    "\"position\": [" x ", 0.1, 0]}, {\"frame\": 40, \"position\": [0.5, 0.1, 0]}]}]}\n"

static int put_files(void)
{
    file_put("s.json", TWO("2.1"));
    file_put("touching.json", TWO("0.1"));
    file_put("a.obj", DIAMOND);
    file_put("b.json", SEVERAL);
    return 0;
}

TEST_GROUP(put_files, NULL);

static json_t *read_json(const char *folder, const char *name)
{
    json_t *root = NULL;
    if (mote_record_read_json(folder, name, &root) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return root;
}

/* The distance of two meshes, by a run of the program that does not know the scenario. */
static double distance_of(int a, int b)
{
    mote_expect(0, "", "distance e/body-%d.obj e/body-%d.obj --method brute-force --json", a,
                b);
    const char *at = strstr(said, "\"distance\": ");
    assert_non_null(at);
    return strtod(at + strlen("\"distance\": "), NULL);
}

TEST(command_export_writes_every_body_and_the_distances_of_near_pairs)
{
    mote_expect(0, "e/body-1.obj to body-5.obj, answers.json",
                "export b.json --frame 3 --out e --method certified --method aabb-tree "
                "--method fcl-obb");
    assert_int_equal(folder_count("e", ".obj"), 5);
    json_t *answers = read_json("e", "answers.json");
    static const char *const methods[] = {"certified", "aabb-tree"};
    for (size_t m = 0; m < 2; ++m) {
        const json_t *pairs =
            json_object_get(json_object_get(answers, methods[m]), "near_pairs");
        assert_true(json_array_size(pairs) > 0);
        for (size_t k = 0; k < json_array_size(pairs); ++k) {
            int a = 0, b = 0;
            double distance = -1;
            assert_int_equal(json_unpack(json_array_get(pairs, k), "{s:[i,i], s:F}", "bodies",
                                         &a, &b, "distance", &distance),
                             0);
            assert_true(a < b && a >= 1 && b <= 5);
            assert_close(distance, distance_of(a, b), 1e-12);
        }
    }
    const json_t *other = json_object_get(answers, "fcl-obb");
    assert_non_null(strstr(json_string_value(json_object_get(other, "unsupported")),
                           "no form for several bodies"));
    json_decref(answers);
    mote_expect(4, "b has frames 1-4", "export b.json --frame 5 --out f");
}

/* Under a sanitizer valgrind cannot count anything. */
TEST(command_instructions_counts_scenes_in_one_thread)
{
    static const char line[] = "instructions b.json --frames 1-2 --out i --method";
    if (!mote_heap_read().counted || !has_valgrind())
        skip();
    mote_expect(4, "leave out threads= and ahead=", "%s certified:threads=2", line);
    mote_expect(4, "it has frames 1-4",
                "instructions b.json --frames 1-5 --out none --method certified");
    assert_false(file_exists("none")); /* refused before anything is written */
    mote_expect(0, "instructions a frame", "%s certified --method particle:n=2", line);
    json_t *root = read_json("i", "instructions.json");
    const json_t *rows = json_object_get(root, "rows");
    assert_int_equal(json_array_size(rows), 2);
    for (size_t k = 0; k < 2; ++k) {
        const json_t *row = json_array_get(rows, k);
        assert_true(json_integer_value(json_object_get(row, "instructions")) > 1000);
        assert_non_null(json_object_get(json_object_get(row, "parameters"), "refit"));
    }
    json_decref(root);
}

/* The best configuration that tune reports is one that `mote run` accepts. */
TEST(command_tune_finds_the_best_configuration_of_a_scene)
{
    static const char run[] = "run b.json --out t --replicates 2 --method";
    mote_expect(0, "", "%s 'fcl-aabb:refit=near|every' --method certified", run);
    mote_expect(0, "of 2", "tune t");
    json_t *root = read_json("t", "tune.json");
    assert_int_equal(json_array_size(json_object_get(root, "rows")), 2);
    json_decref(root);
    mote_expect(0, "fcl-aabb", "tune t --best-fcl b >best.txt; cat best.txt");
    mote_expect(0, "", "run b.json --out u --method \"$(cat best.txt)\"");
}

static json_int_t count_of(const json_t *row, const char *key)
{
    const json_t *value = json_object_get(row, key);
    assert_true(json_is_integer(value));
    return json_integer_value(value);
}

/* The statistics of replicates are those of single simulations with the same seeds. */
static void check_sums(const char *scenario, const char *method, const json_t *row)
{
    static const char *const keys[] = {"steps", "approaches", "contact_steps", "responses",
                                       "bounces"};
    json_int_t sums[ROWS_OF(keys)] = {0};
    for (int seed = 7; seed <= 8; ++seed) {
        mote_expect(0, "", "simulate %s --method %s --seed %d --json >one.json", scenario,
                    method, seed);
        json_t *one = read_json(".", "one.json");
        for (size_t k = 0; k < ROWS_OF(keys); ++k)
            sums[k] += count_of(one, keys[k]);
        json_decref(one);
    }
    for (size_t k = 0; k < ROWS_OF(keys); ++k) {
        test_row("%s of %s", keys[k], method);
        assert_int_equal(count_of(row, keys[k]), sums[k]);
    }
}

TEST(command_simulate_keeps_replicates_and_goes_on)
{
    static const char *const methods[] = {"aabb-tree", "particle:n=2"};
    for (int many = 0; many < 2; ++many) {
        const char *scenario = many ? "b.json" : "s.json";
        char *line = mote_format("simulate %s --method particle:n=2 --method aabb-tree --seed "
                                 "7 --out m%d --replicates",
                                 scenario, many);
        mote_expect(0, "plan: 2 simulations, 0 of them done", "%s 1", line);
        mote_expect(0, "plan: 4 simulations, 2 of them done", "%s 2 --json", line);
        mote_expect(0, "replicates 2, failed 0", "%s 2", line);
        char *folder = mote_format("m%d", many);
        json_t *root = read_json(folder, "simulations.json");
        const json_t *rows = json_object_get(root, "rows");
        assert_int_equal(count_of(root, "bodies"), many ? 5 : 2);
        assert_int_equal(json_array_size(rows), 2);
        for (size_t m = 0; m < 2; ++m)
            check_sums(scenario, methods[m], json_array_get(rows, m));
        json_decref(root);
        free(folder);
        free(line);
    }
    assert_int_equal(folder_count("m1/simulations", ".json"), 4);
}

/* A damaged file is simulated again; a method that cannot answer is reported; a folder in which
   nothing was stored is removed. */
TEST(command_simulate_tells_what_replicates_did_not_give)
{
    mote_expect(0, "fcl-kdop18: unsupported: FCL has no distance",
                "simulate s.json --method fcl-kdop18 --method certified --out k");
    assert_int_equal(system("grep -l '\"scenario\": \"s\"' k/simulations/*fcl-kdop18*"), 0);
    assert_int_equal(system("for f in k/simulations/*certified*; do echo x >$f; done"), 0);
    mote_expect(0, "plan: 2 simulations, 1 of them done",
                "simulate s.json --method fcl-kdop18 --method certified --out k");
    mote_expect(4, "start in contact", "simulate touching.json --method certified --out n");
    assert_int_not_equal(access("n", F_OK), 0);
    mote_expect(2, "name a directory", "simulate s.json --method certified --replicates 2");
    mote_expect(2, "one method at a time",
                "simulate s.json --method certified --method aabb-tree");
    mote_expect(2, "leave out --out",
                "simulate s.json --method certified --out n --trace x.json");
    mote_expect(2, "from 1 to 1000",
                "simulate s.json --method certified --out n --replicates 0");
}
