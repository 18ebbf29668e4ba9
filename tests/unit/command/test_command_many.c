/* Commands that take scenarios of many bodies as they take those of two. */
#include "harness/base/heap_count.h"
#include "harness/base/record.h"
#include "tests/support/diamond.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#define SEVERAL                                                                                \
    "{\"purpose\": \"x\", \"frames\": 4, \"ask\": \"distance\", \"tolerance\": 0.01, "         \
    "\"bodies\": {\"count\": 5, \"seed\": 2, \"near_pairs\": 1, \"near\": 0.2, "               \
    "\"speed\": 0.01, \"spin\": 1, \"shapes\": [{\"file\": \"a.obj\"}]}}\n"

static int put_files(void)
{
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

/* The distance of two meshes by a program run that knows nothing of the scenario. */
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

/* Under a sanitizer there is nothing that valgrind could count. */
TEST(command_instructions_counts_scenes_in_one_thread)
{
    static const char line[] = "instructions b.json --frames 1-2 --out i --method";
    if (!mote_heap_read().counted || system("valgrind --version >/dev/null 2>&1") != 0)
        skip();
    mote_expect(4, "leave out threads= and ahead=", "%s certified:threads=2", line);
    mote_expect(4, "it has frames 1-4",
                "instructions b.json --frames 1-5 --out i --method "
                "certified");
    mote_expect(0, "instructions a frame",
                "%s certified --method fcl-aabb:refit=every --method particle:n=2", line);
    json_t *root = read_json("i", "instructions.json");
    const json_t *rows = json_object_get(root, "rows");
    assert_int_equal(json_array_size(rows), 3);
    for (size_t k = 0; k < 3; ++k) {
        const json_t *row = json_array_get(rows, k);
        assert_true(json_integer_value(json_object_get(row, "instructions")) > 1000);
        assert_non_null(json_object_get(json_object_get(row, "parameters"), "refit"));
    }
    json_decref(root);
}

/* What tune calls the best is a configuration as `mote run` takes it. */
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
