/* The default scenario of two meshes, and the built-in ones by their fingerprints. */
#include "harness/scene/catalog.h"
#include "harness/base/file.h"
#include "harness/run/truth.h"
#include "tests/support/test.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MESHES MOTE_SOURCE_DIR "/datasets/meshes/"

/* First contact between frames 100 and 200, contact in 10 to 20 % of frames, apart at the end.
 */
static void check_pair(const char *name)
{
    mote_scenario *scenario;
    if (mote_scenario_load(name, &scenario) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    assert_int_equal(scenario->frames, 1000);
    assert_true(scenario->body[0].field->count > 0 && scenario->body[1].field->count > 0);
    mote_truth *truth;
    if (mote_truth_compute(scenario, &truth) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    uint32_t contacts = 0, first = 0;
    for (uint32_t k = 0; k < truth->frames; ++k) {
        contacts += truth->distance[k] == 0;
        if (first == 0 && truth->distance[k] == 0)
            first = k + 1;
    }
    assert_in_range(contacts, 100, 200);
    assert_in_range(first, 100, 200);
    assert_true(truth->distance[999] > 0.2 * scenario->length);
    mote_truth_destroy(truth);
    mote_scenario_destroy(scenario);
}

TEST(mote_scenario_load_pair_of_bunny_and_box_touches_as_promised)
{
    check_pair("pair:" MESHES "bunny.obj:" MESHES "box.obj");
}

TEST(mote_scenario_load_pair_of_spider_and_teapot_touches_as_promised)
{
    check_pair("pair:" MESHES "spider.obj:" MESHES "teapot.obj");
}

/* Computed in every build, the largest only where it is quick or with MOTE_FULL=1 in the
   environment: ww-10m takes two minutes and 9 GB. */
#ifdef NDEBUG
#define WORK_MAX 1.6e8
#else
#define WORK_MAX 6e6
#endif

/* The name's line in datasets/fingerprints.txt: "NAME FINGERPRINT". */
static const char *find_line(const char *text, const char *name)
{
    const size_t length = strlen(name);
    for (const char *line = text; *line; line += strcspn(line, "\n"), line += *line == '\n') {
        if (strncmp(line, name, length) == 0 && line[length] == ' ')
            return line + length + 1;
    }
    return NULL;
}

static bool is_large(const char *name)
{
    static const char *const large[] = {"ww-100k",     "ww-1m",           "ww-10m",
                                        "bison-60k",   "bison-240k",      "jumper-80k",
                                        "jumper-330k", "jumper-near-330k"};
    for (size_t i = 0; i < ROWS_OF(large); ++i) {
        if (strcmp(name, large[i]) == 0)
            return true;
    }
    return false;
}

TEST(mote_scenario_fingerprint_built_in_is_the_committed_one)
{
    const bool full = getenv("MOTE_FULL") != NULL;
    char *text;
    size_t size;
    uint32_t checked = 0;
    mote_catalog catalog;
    assert_int_equal(
        mote_file_read(MOTE_SOURCE_DIR "/datasets/fingerprints.txt", 1 << 20, &text, &size),
        MOTE_OK);
    assert_int_equal(mote_catalog_read(&catalog), MOTE_OK);
    for (size_t i = 0; i < catalog.count; ++i) {
        const char *name = catalog.entries[i].name;
        if (catalog.entries[i].several) /* tests/unit/run/test_bodies.c */
            continue;
        if (!find_line(text, name))
            fail_msg("%s is not in datasets/fingerprints.txt", name);
        if (is_large(name) && !full)
            continue;
        mote_scenario *scenario;
        if (mote_scenario_load(name, &scenario) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        const double work = (double)scenario->frames * (scenario->body[0].mesh->vertex_count +
                                                        scenario->body[1].mesh->vertex_count);
        const char *committed = find_line(text, name);
        if (work <= WORK_MAX || full) {
            uint64_t fingerprint;
            assert_int_equal(mote_scenario_fingerprint(scenario, &fingerprint), MOTE_OK);
            if (fingerprint != strtoull(committed, NULL, 16))
                fail_msg("%s: %016" PRIx64 " instead of %.16s", name, fingerprint, committed);
            ++checked;
        }
        mote_scenario_destroy(scenario);
    }
    assert_true(checked >= 10);
    mote_catalog_free(&catalog);
    free(text);
}
