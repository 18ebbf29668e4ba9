/* The same vertices with other faces are another scenario: nothing that was stored of the one
   is taken for the other. */
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <dirent.h>
#include <stddef.h>

/* A box of which two opposite corners of the top are higher: split along these it has a ridge,
   along the others a valley. */
#define BOX                                                                                    \
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1.2\nv 1 0 1\nv 1 1 1.2\nv 0 1 1\n"             \
    "f 1 4 3\nf 1 3 2\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\n"        \
    "f 4 5 8\n"
#define RIDGE BOX "f 5 6 7\nf 5 7 8\n"
#define VALLEY BOX "f 5 6 8\nf 6 7 8\n"

#define REST                                                                                   \
    "\"frames\": 4, \"ask\": \"distance\", \"bodies\": [{\"file\": \"box.obj\"}, "             \
    "{\"file\": \"box.obj\", \"motion\": [{\"frame\": 1, \"position\": [0.1, 0, 2]}, "         \
    "{\"frame\": 4, \"position\": [0, 0.1, 1.6]}]}]}\n"
#define PAIR "{\"purpose\": \"two boxes\", " REST
#define MANY                                                                                   \
    "{\"purpose\": \"boxes\", \"frames\": 4, \"ask\": \"distance\", \"bodies\": {\"count\": "  \
    "3, \"seed\": 2, \"near_pairs\": 1, \"near\": 0.2, \"speed\": 0.01, \"spin\": 1, "         \
    "\"shapes\": [{\"file\": \"box.obj\"}]}}\n"

static int put_files(void)
{
    if (folder_next() != 0)
        return -1;
    file_put("pair.json", PAIR);
    file_put("many.json", MANY);
    file_put("box.obj", RIDGE);
    return 0;
}

TEST_EACH(put_files, NULL);

#define RUN "run %s --method certified --replicates 1 --out "

/* The hash after a word that `mote check` prints. */
static void read_hash(const char *scenario, const char *word, char hash[17])
{
    assert_int_equal(mote("check %s", scenario), 0);
    const char *at = strstr(said, word);
    assert_non_null(at);
    (void)snprintf(hash, 17, "%s", at + strlen(word));
}

TEST(check_tells_faces_apart_and_vertices_not)
{
    static const char *const scenarios[] = {"pair.json", "many.json"};
    for (size_t i = 0; i < ROWS_OF(scenarios); ++i) {
        char before[2][17], after[2][17];
        test_row("%s", scenarios[i]);
        file_put("box.obj", RIDGE);
        read_hash(scenarios[i], "fingerprint ", before[0]);
        read_hash(scenarios[i], "faces ", before[1]);
        file_put("box.obj", VALLEY);
        read_hash(scenarios[i], "fingerprint ", after[0]);
        read_hash(scenarios[i], "faces ", after[1]);
        assert_string_equal(before[0], after[0]);
        assert_string_not_equal(before[1], after[1]);
        mote_expect(0, after[1], "check %s --json", scenarios[i]);
    }
}

TEST(cells_are_measured_again_after_a_change_of_faces)
{
    static const char *const scenarios[] = {"pair.json", "many.json"};
    for (size_t i = 0; i < ROWS_OF(scenarios); ++i) {
        test_row("%s", scenarios[i]);
        file_put("box.obj", RIDGE);
        mote_expect(0, "plan: 1 cells, 0 of them done", RUN "run-%s", scenarios[i],
                    scenarios[i]);
        mote_expect(0, "plan: 1 cells, 1 of them done", RUN "run-%s", scenarios[i],
                    scenarios[i]);
        file_put("box.obj", VALLEY);
        mote_expect(0, "plan: 1 cells, 0 of them done", RUN "run-%s", scenarios[i],
                    scenarios[i]);
        mote_expect(0, "(faces ", "summarize run-%s", scenarios[i]);
        assert_int_equal(mote("summarize run-%s --format csv", scenarios[i]), 0);
        assert_int_equal(test_count(said, ",certified,"), 2);
    }
    assert_int_equal(folder_count("run-pair.json/truth", ".csv"), 2);
    assert_int_equal(folder_count("run-pair.json/cells", ".csv"), 2);
}

TEST(simulations_are_repeated_after_a_change_of_faces)
{
    static const char simulate[] =
        "simulate many.json --method certified --steps 2 --replicates 1 --out simulated";
    mote_expect(0, "plan: 1 simulations, 0 of them done", "%s", simulate);
    mote_expect(0, "plan: 1 simulations, 1 of them done", "%s", simulate);
    file_put("box.obj", VALLEY);
    mote_expect(0, "plan: 1 simulations, 0 of them done", "%s", simulate);
}

/* Removes what older versions did not store. */
static void forget_faces(const char *directory, const char *folder)
{
    char path[300];
    (void)snprintf(path, sizeof path, "%s/%s", directory, folder);
    DIR *entries = opendir(path);
    assert_non_null(entries);
    for (const struct dirent *entry; (entry = readdir(entries));) {
        json_t *object = NULL;
        const size_t length = strlen(entry->d_name);
        if (length < 5 || strcmp(entry->d_name + length - 5, ".json") != 0)
            continue;
        (void)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        assert_int_equal(mote_record_read_json(directory, path, &object), MOTE_OK);
        assert_int_equal(json_object_del(object, "faces"), 0);
        assert_int_equal(mote_record_json(directory, path, object), MOTE_OK);
    }
    (void)closedir(entries);
}

TEST(runs_of_other_faces_are_not_compared_and_of_unknown_ones_are)
{
    assert_int_equal(mote(RUN "ridge", "pair.json"), 0);
    file_put("box.obj", VALLEY);
    assert_int_equal(mote(RUN "valley", "pair.json"), 0);
    mote_expect(4, "no configuration in common", "compare ridge valley");
    forget_faces("ridge", "cells");
    assert_true(mote("compare ridge valley") != 4);
    assert_non_null(strstr(said, "pair/certified/hot"));
}

TEST(simulations_of_other_faces_are_not_compared_and_of_unknown_ones_are)
{
    static const char simulate[] = "simulate many.json --method certified --steps 2 --out ";
    assert_int_equal(mote("%s ridge", simulate), 0);
    file_put("box.obj", VALLEY);
    assert_int_equal(mote("%s valley", simulate), 0);
    mote_expect(4, "no configuration in common", "compare ridge valley");
    forget_faces("ridge", "simulations");
    assert_true(mote("compare ridge valley") != 4);
    assert_non_null(strstr(said, "many/certified/simulated"));
}
