#include "harness/base/file.h"
#include "harness/base/hash.h"
#include "harness/run/truth.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char small_text[] =
    "{\"purpose\": \"a small one\", \"frames\": 30, \"ask\": \"distance\", \"bodies\": [\n"
    "{\"letter\": \"T\", \"triangles\": 400},\n"
    "{\"letter\": \"V\", \"triangles\": 400, \"field\": {\"count\": 5, \"support\": 0.5,\n"
    "\"displacement\": {\"random\": {\"seed\": 1, \"amplitude\": 0.03, \"periods\": [9, "
    "20]}}},\n"
    "\"motion\": [{\"frame\": 1, \"position\": [1.5, 0, 0]},\n"
    "{\"frame\": 30, \"position\": [0, 0, 0]}]}]}\n";

static char *truth_path(const mote_scenario *scenario)
{
    uint64_t fingerprint;
    assert_int_equal(mote_scenario_fingerprint(scenario, &fingerprint), MOTE_OK);
    char *path = mote_truth_path(".", scenario, fingerprint);
    assert_non_null(path);
    return path;
}

static mote_scenario *small;

static int set_up(void)
{
    file_put("small.json", small_text);
    return mote_scenario_load("small.json", &small) == MOTE_OK ? 0 : -1;
}

static int tear_down(void)
{
    mote_scenario_destroy(small);
    return 0;
}

TEST_GROUP(set_up, tear_down);

TEST(mote_truth_compute_small_scenario_is_exact_where_known)
{
    const mote_scenario *scenario = small;
    mote_truth *truth;
    assert_int_equal(mote_truth_compute(scenario, &truth), MOTE_OK);
    assert_int_equal(truth->frames, 30);
    assert_true(truth->checked >= 20);
    /* Bodies in the same place intersect; distant ones have witnesses that far apart. */
    assert_true(truth->distance[29] == 0 && truth->contact[29]);
    assert_true(truth->distance[0] > 0.3 && !truth->contact[0]);
    const double apart = sqrt(mote_distance_squared(truth->witness_a[0], truth->witness_b[0]));
    assert_true(fabs(apart - truth->distance[0]) < 1e-12);
    mote_truth_destroy(truth);
}

TEST(mote_truth_load_or_compute_twice_gives_the_same_bits)
{
    const mote_scenario *scenario = small;
    mote_truth *first, *second;
    assert_int_equal(mote_truth_load_or_compute(scenario, ".", &first), MOTE_OK);
    char *path = truth_path(scenario);
    assert_int_equal(access(path, R_OK), 0);
    /* The file is really read: without permission to write, nothing is computed again. */
    assert_int_equal(mote_truth_read(scenario, first->fingerprint, path, &second), MOTE_OK);
    assert_int_equal(second->checked, first->checked);
    for (uint32_t k = 0; k < 30; ++k) {
        assert_true(first->distance[k] == second->distance[k]);
        assert_true(first->contact[k] == second->contact[k]);
        if (isnan(first->witness_b[k].z))
            assert_true(isnan(second->witness_b[k].z));
        else
            assert_true(first->witness_b[k].z == second->witness_b[k].z);
    }
    free(path);
    mote_truth_destroy(first);
    mote_truth_destroy(second);
}

/* Triangles around the middle of the box, and two far ones that put it there. */
#define FACES "f 1 2 3\nf 4 5 6\nf 7 8 9\n"
#define CORNERS(out, in)                                                                       \
    "v " out " " out " " out "\nv " in " " out " " out "\nv " out " " in " " out "\n"          \
    "v -" out " -" out " -" out "\nv -" in " -" out " -" out "\nv -" out " -" in " -" out "\n"

/* datasets/defects.md 11: corners that lie in a triangle of the other body, for which FCL
   reports a distance above 0. */
TEST(mote_truth_compute_frame_that_fcl_gets_wrong_is_settled)
{
    static const struct {
        const char *a, *b;
        mote_vec3 touch;
        double overruled;
    } cases[] = {{"v 3 3 1\nv 0 1 2\nv 3 2 0\n" CORNERS("10", "9") FACES,
                  "v 1 2 3\nv 1 1 2\nv 2 2 1\n" CORNERS("20", "19") FACES,
                  {2, 2, 1},
                  0.149},
                 {"v 1 1 2\nv 2 0 0\nv 2 2 2\n" CORNERS("10", "9") FACES,
                  "v 1 3 3\nv 2 2 1\nv 3 1 2\n" CORNERS("20", "19") FACES,
                  {2, 2, 2},
                  0.408}};
    static const char scene[] =
        "{\"purpose\": \"a test\", \"frames\": 2, \"ask\": \"distance\", "
        "\"bodies\": [{\"file\": \"a.obj\"}, {\"file\": \"b.obj\"}]}\n";
    file_put("touch.json", scene);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        mote_scenario *scenario;
        mote_truth *truth;
        file_put("a.obj", cases[i].a);
        file_put("b.obj", cases[i].b);
        assert_int_equal(mote_scenario_load("touch.json", &scenario), MOTE_OK);
        assert_int_equal(mote_truth_compute(scenario, &truth), MOTE_OK);
        for (int k = 0; k < 2; ++k) {
            assert_true(truth->distance[k] == 0 && truth->contact[k]);
            assert_true(fabs(truth->overruled[k] - cases[i].overruled) < 5e-4);
            assert_memory_equal(&truth->witness_a[k], &cases[i].touch, sizeof(mote_vec3));
            assert_memory_equal(&truth->witness_b[k], &cases[i].touch, sizeof(mote_vec3));
        }
        assert_int_equal(truth->checked, 2);
        mote_truth_destroy(truth);
        mote_scenario_destroy(scenario);
    }
}

TEST(mote_truth_read_settled_frame_keeps_what_was_overruled)
{
    const mote_scenario *scenario = small;
    mote_truth *truth, *again;
    assert_int_equal(mote_truth_load_or_compute(scenario, ".", &truth), MOTE_OK);
    truth->overruled[4] = 0.1; /* with and without witness points */
    truth->overruled[29] = 1.0 / 3;
    char *path = truth_path(scenario);
    assert_int_equal(mote_truth_write(scenario, truth, path), MOTE_OK);
    assert_int_equal(mote_truth_read(scenario, truth->fingerprint, path, &again), MOTE_OK);
    for (uint32_t k = 0; k < 30; ++k) {
        assert_true(again->distance[k] == truth->distance[k]);
        assert_int_equal(isnan(again->overruled[k]), isnan(truth->overruled[k]));
        assert_true(isnan(again->overruled[k]) || again->overruled[k] == truth->overruled[k]);
    }
    free(path);
    mote_truth_destroy(truth);
    mote_truth_destroy(again);
}

TEST(mote_truth_read_changed_or_cut_file_is_refused)
{
    const mote_scenario *scenario = small;
    mote_truth *truth, *read = NULL;
    assert_int_equal(mote_truth_load_or_compute(scenario, ".", &truth), MOTE_OK);
    char *path = truth_path(scenario);
    char *text;
    size_t size;
    assert_int_equal(mote_file_read(path, 1 << 20, &text, &size), MOTE_OK);
    assert_int_equal(mote_truth_read(scenario, truth->fingerprint + 1, path, &read),
                     MOTE_EINVAL);
    for (size_t i = 0; i < size; i += 7) {
        char kept = text[i];
        text[i] = kept == '1' ? '2' : '1';
        file_write(path, text, size);
        text[i] = kept;
        assert_int_equal(mote_truth_read(scenario, truth->fingerprint, path, &read),
                         MOTE_EINVAL);
        file_write(path, text, i);
        assert_int_equal(mote_truth_read(scenario, truth->fingerprint, path, &read),
                         MOTE_EINVAL);
    }
    assert_null(read);
    /* A damaged file is replaced. */
    assert_int_equal(mote_truth_load_or_compute(scenario, ".", &read), MOTE_OK);
    assert_true(read->distance[7] == truth->distance[7]);
    mote_truth_destroy(read);
    mote_truth_destroy(truth);
    free(text);
    free(path);
}

/* Writes a truth file of the scenario with these rows and a valid hash. */
static void write_rows(const char *path, const char *first, const char *columns,
                       const char *rows)
{
    char text[4096];
    int size = snprintf(text, sizeof text, "%s%s%s", first, columns, rows);
    assert_true(size > 0 && (size_t)size < sizeof text);
    const uint64_t hash = mote_hash_bytes(MOTE_HASH_START, text, (size_t)size);
    size += snprintf(text + size, sizeof text - (size_t)size, "# hash %016" PRIx64 "\n", hash);
    file_write(path, text, (size_t)size);
}

#define COLUMNS "frame,distance,ax,ay,az,bx,by,bz,overruled\n"
#define REST                                                                                   \
    "3,1,,,,,,,\n4,1,,,,,,,\n5,1,,,,,,,\n6,1,,,,,,,\n7,1,,,,,,,\n8,1,,,,,,,\n9,1,,,,,,,\n10,"  \
    "1,,"                                                                                      \
    ",,,,,\n11,1,,,,,,,\n12,1,,,,,,,\n13,1,,,,,,,\n14,1,,,,,,,\n15,1,,,,,,,\n16,1,,,,,,,\n17," \
    "1,,,,,,,\n18,1,,,,,,,\n19,1,,,,,,,\n20,1,,,,,,,\n21,1,,,,,,,\n22,1,,,,,,,\n23,1,,,,,,,"   \
    "\n24"                                                                                     \
    ",1,,,,,,,\n25,1,,,,,,,\n26,1,,,,,,,\n27,1,,,,,,,\n28,1,,,,,,,\n29,1,,,,,,,\n30,1,,,,,,,"  \
    "\n"

/* The first line of the small scenario's file. */
static void put_head(char *first, size_t size, uint64_t fingerprint, uint64_t faces)
{
    (void)snprintf(first, size,
                   "# truth of small, fingerprint %016" PRIx64 ", faces %016" PRIx64
                   ", 30 frames, 24 checked\n",
                   fingerprint, faces);
}

/* The hash does not stop forgers: the rows must be a valid truth, too. */
TEST(mote_truth_read_wrong_rows_with_a_right_hash_are_refused)
{
    const mote_scenario *scenario = small;
    static const struct {
        const char *first, *columns, *rows; /* NULL: valid */
        bool good;
    } cases[] = {
        {NULL, NULL, "1,0.5,1,2,3,4,5,6,0.25\n2,0,,,,,,,7\n" REST, true},
        {NULL, NULL, "1,0.5,1,2,3,4,5,6,\n2,0,,,,,,,\n" REST, true},
        {"no truth\n", NULL, "", false},
        {"# truth\n", NULL, "", false},
        {"# truth of t, fingerprint 1, 30 frames, 3 checked\n", NULL, "", false},
        {NULL, "frame,distance\n", "1,0.5,1,2,3,4,5,6,\n2,0,,,,,,,\n" REST, false},
        {NULL, NULL, "1,0.5,1,2,3,4,5,6,\n# 2,0,,,,,,,\n" REST, false},
        {NULL, NULL, "1,1,,,,,,,\n2,0,,,,,,,\n", false},                      /* rows missing */
        {NULL, NULL, "1,1,,,,,,,\n2,0,,,,,,,\n" REST "31,1,,,,,,,\n", false}, /* one more */
        {NULL, NULL, "2,1,,,,,,,\n2,0,,,,,,,\n" REST, false}, /* another frame */
        {NULL, NULL, "1;1,,,,,,,\n2,0,,,,,,,\n" REST, false},
        {NULL, NULL, "1,one,,,,,,,\n2,0,,,,,,,\n" REST, false},
        {NULL, NULL, "1,1;,,,,,,,\n2,0,,,,,,,\n" REST, false},
        {NULL, NULL, "1,-1,,,,,,,\n2,0,,,,,,,\n" REST, false},
        {NULL, NULL, "1,nan,,,,,,,\n2,0,,,,,,,\n" REST, false},
        {NULL, NULL, "1,1,1,2,3,4,5,x,\n2,0,,,,,,,\n" REST, false},
        {NULL, NULL, "1,1,1,2,3,4,5;6,\n2,0,,,,,,,\n" REST, false},
        {NULL, NULL, "1,1,1,2,3,4,5,6,x\n2,0,,,,,,,\n" REST, false},
        {NULL, NULL, "1,1,1,2,3,4,5,6,7,8\n2,0,,,,,,,\n" REST, false}};
    char *path = truth_path(scenario), first[128];
    uint64_t fingerprint;
    assert_int_equal(mote_scenario_fingerprint(scenario, &fingerprint), MOTE_OK);
    put_head(first, sizeof first, fingerprint, mote_scenario_faces(scenario));
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        mote_truth *read = NULL;
        write_rows(path, cases[i].first ? cases[i].first : first,
                   cases[i].columns ? cases[i].columns : COLUMNS, cases[i].rows);
        const mote_status status = mote_truth_read(scenario, fingerprint, path, &read);
        if (status != (cases[i].good ? MOTE_OK : MOTE_EINVAL))
            fail_msg("case %zu: %s", i, mote_status_text(status));
        if (cases[i].good)
            assert_true(read->checked == 24 && read->distance[0] == 0.5 &&
                        read->witness_b[0].z == 6 && read->contact[1]);
        else
            assert_non_null(strstr(mote_error_text(), "not the whole truth of small; remove"));
        mote_truth_destroy(read);
    }
    assert_int_equal(unlink(path), 0);
    free(path);
}

/* The truth of the same vertices with other faces is another one; a file of an older version
   does not name its faces. */
TEST(mote_truth_read_of_other_faces_is_refused_and_of_unknown_ones_is_not)
{
    static const char rows[] = "1,0.5,1,2,3,4,5,6,\n2,0,,,,,,,\n" REST;
    const uint64_t faces = mote_scenario_faces(small);
    uint64_t fingerprint;
    mote_truth *read = NULL;
    char *path = truth_path(small), first[128];
    assert_int_equal(mote_scenario_fingerprint(small, &fingerprint), MOTE_OK);
    put_head(first, sizeof first, fingerprint, faces ^ 1);
    write_rows(path, first, COLUMNS, rows);
    assert_int_equal(mote_truth_read(small, fingerprint, path, &read), MOTE_EINVAL);
    (void)snprintf(first, sizeof first,
                   "# truth of small, fingerprint %016" PRIx64 ", 30 frames, 24 checked\n",
                   fingerprint);
    write_rows(path, first, COLUMNS, rows);
    assert_int_equal(mote_truth_read(small, fingerprint, path, &read), MOTE_OK);
    assert_true(read->checked == 24 && read->distance[0] == 0.5);
    mote_truth_destroy(read);
    assert_int_equal(unlink(path), 0);
    free(path);
}

/* A name may contain the separators of the first line: its truth is still computed once
   only. */
TEST(mote_truth_read_of_an_odd_name_reads_what_was_written)
{
    static const char *const names[] = {"a#b", "a frames, 7", "a 100% checked,%s"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        char path[96];
        mote_scenario *scenario;
        mote_truth *made, *read = NULL;
        (void)snprintf(path, sizeof path, "%s.json", names[i]);
        file_put(path, small_text);
        assert_int_equal(mote_scenario_load(path, &scenario), MOTE_OK);
        assert_int_equal(unlink(path), 0);
        assert_int_equal(mote_truth_load_or_compute(scenario, ".", &made), MOTE_OK);
        char *file = truth_path(scenario);
        assert_int_equal(mote_truth_read(scenario, made->fingerprint, file, &read), MOTE_OK);
        assert_int_equal(read->checked, made->checked);
        assert_int_equal(unlink(file), 0);
        free(file);
        mote_truth_destroy(made);
        mote_truth_destroy(read);
        mote_scenario_destroy(scenario);
    }
}

TEST(mote_truth_load_or_compute_unwritable_folder_is_an_error)
{
    mote_truth *truth = NULL;
    assert_int_equal(mote_truth_load_or_compute(small, "/proc/nothing", &truth), MOTE_EIO);
    assert_null(truth);
}
