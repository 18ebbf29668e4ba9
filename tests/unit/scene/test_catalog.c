/* The built-in scenarios: found in the folders of datasets/scenarios, and named without them.
 */
#include "harness/base/file.h"
#include "harness/scene/catalog.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <sys/stat.h>

#define SCENARIOS "share/mote/datasets/scenarios"

/* `mote list scenarios` of a copy of the program that has scenarios of its own. */
static int list_scenarios(char *output, size_t size)
{
    FILE *in = popen("bin/mote list scenarios 2>&1", "r");
    assert_non_null(in);
    output[fread(output, 1, size - 1, in)] = '\0';
    const int status = pclose(in);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

TEST(mote_catalog_path_of_a_scenario_in_a_folder)
{
    static const struct {
        const char *name, *file;
    } row[] = {
        {"ww", "/datasets/scenarios/ww.json"},
        {"ww-1k", "/datasets/scenarios/sizes/ww-1k.json"},
        {"crowd", "/datasets/scenarios/characters/crowd.json"},
        {"not-there", "/datasets/scenarios/not-there.json"},
    };
    for (size_t i = 0; i < ROWS_OF(row); ++i) {
        char *path = mote_catalog_path(row[i].name);
        assert_true(mote_name_ends(path, row[i].file));
        free(path);
    }
}

TEST(mote_catalog_read_folders_names_in_order_and_no_name_twice)
{
    char output[4096];
    assert_int_equal(mkdir("bin", 0700), 0);
    assert_int_equal(system("cp " MOTE_PROGRAM " bin/mote"), 0);
    assert_int_equal(mote_directory_make(SCENARIOS "/kind"), MOTE_OK);
    assert_int_equal(mote_directory_make(SCENARIOS "/kind/too-deep"), MOTE_OK);
    file_put(SCENARIOS "/b.json", "{\"purpose\": \"the second\"}");
    file_put(SCENARIOS "/kind/a.json", "{\"purpose\": \"the first\"}");
    file_put(SCENARIOS "/kind/c.json", "{\"purpose\": \"the third\"}");
    file_put(SCENARIOS "/kind/too-deep/d.json", "{\"purpose\": \"none\"}");
    file_put(SCENARIOS "/kind/notes.txt", "not a scenario");
    assert_int_equal(list_scenarios(output, sizeof output), 0);
    const char *a = strstr(output, "the first"), *b = strstr(output, "the second");
    const char *c = strstr(output, "the third");
    assert_true(a && b && c && a < b && b < c);
    assert_null(strstr(output, "none"));

    file_put(SCENARIOS "/b.json", "{\"frames\": 2}");
    assert_int_equal(list_scenarios(output, sizeof output), 4);
    assert_non_null(strstr(output, "scenarios/b.json: no purpose; add a sentence"));
    file_put(SCENARIOS "/kind/b.json", "{\"purpose\": \"another\"}");
    assert_int_equal(list_scenarios(output, sizeof output), 4);
    assert_non_null(strstr(output, "has the same name; rename one of the two"));
    assert_non_null(strstr(output, "scenarios/b.json"));
    assert_non_null(strstr(output, "scenarios/kind/b.json"));
}
