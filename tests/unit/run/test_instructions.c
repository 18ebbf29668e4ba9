/* What `mote instructions` keeps, with a valgrind that counts as much as its file says. */
#include "harness/base/record.h"
#include "tests/support/diamond.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <signal.h>
#include <sys/stat.h>
#include <time.h>

/* Fails where the words hold what the file "fails" says. */
#define VALGRIND                                                                               \
    "#!/bin/sh\ncase $* in *$(cat fails)*) exit 1 ;; esac\nfor a; do case $a in "              \
    "--callgrind-out-file=*)\nprintf \"x\\ntotals: $(cat counts)\\n\" > \"${a#*=}\" ;; esac; " \
    "done\n"
#define SCENARIO(place)                                                                        \
    "{\"purpose\": \"two\", \"frames\": 4, \"ask\": \"distance\", \"bodies\": [{\"file\": "    \
    "\"d.obj\"}, {\"file\": \"d.obj\", \"motion\": [{\"frame\": 1, \"position\": [" place      \
    ", 0, 0]}]}]}\n"

static int put_files(void)
{
    char path[512];
    if (folder_next() != 0 || mkdir("in", 0755) != 0)
        return -1;
    (void)snprintf(path, sizeof path, ".:%s", getenv("PATH"));
    file_put("valgrind", VALGRIND);
    file_put("fails", "nothing");
    file_put("counts", "40");
    file_put("d.obj", DIAMOND);
    file_put("in/d.obj", DIAMOND);
    file_put("s.json", SCENARIO("3"));
    file_put("in/s.json", SCENARIO("4"));
    return chmod("valgrind", 0755) || setenv("PATH", path, 1);
}

TEST_EACH(put_files, NULL);

#define COUNT "instructions %s --frames 1-2 --out . --method "

/* The file; the caller decrefs. */
static json_t *kept(void)
{
    json_t *object = NULL;
    assert_int_equal(mote_record_read_json(".", "instructions.json", &object), MOTE_OK);
    return object;
}

/* The instructions per frame of a method in a scene; 0: not counted. */
static double count_of(const char *scenario, const char *method, size_t *found)
{
    json_t *object = kept();
    const json_t *row;
    size_t i;
    double count = 0;
    *found = 0;
    MOTE_EACH(i, row, json_object_get(object, "rows"))
    {
        if (strcmp(mote_text_at(row, "scenario"), scenario) != 0 ||
            strcmp(mote_text_at(row, "method"), method) != 0)
            continue;
        count = mote_number_at(row, "per_frame");
        ++*found;
    }
    json_decref(object);
    return count;
}

/* Counts of the distance and of impacts of one scene are two rows, which say what was asked. */
TEST(instructions_say_what_was_asked)
{
    static const struct {
        const char *scenario, *ask;
        int step;
    } cases[] = {{"s.json", "distance", 0}, {"impact.json", "impact", 2}};
    file_put("impact.json",
             "{\"purpose\": \"two\", \"frames\": 4, \"ask\": \"impact\", \"step\": 2, "
             "\"bodies\": [{\"file\": \"d.obj\"}, {\"file\": \"d.obj\", \"motion\": "
             "[{\"frame\": 1, \"position\": [3, 0, 0]}]}]}\n");
    for (size_t i = 0; i < ROWS_OF(cases); ++i) {
        test_row("%s", cases[i].scenario);
        mote_expect(0, "instructions a frame",
                    "instructions %s --frames 1-3 --out . --method certified",
                    cases[i].scenario);
        json_t *object = kept();
        const json_t *row = json_array_get(json_object_get(object, "rows"), i);
        assert_string_equal(mote_text_at(row, "ask"), cases[i].ask);
        assert_true(mote_number_at(row, "step") == cases[i].step);
        json_decref(object);
    }
}

/* Rows of a run have the scenario's name, wherever its file lies. */
TEST(instructions_are_kept_under_the_name_of_the_scenario)
{
    size_t found;
    mote_expect(0, "20 instructions a frame", COUNT "certified", "./s.json");
    assert_true(count_of("s", "certified", &found) == 20 && found == 1);
    /* The same scenario by another word. */
    file_put("counts", "60");
    mote_expect(0, "30 instructions a frame", COUNT "certified", "s.json");
    assert_true(count_of("s", "certified", &found) == 30 && found == 1);
    /* Another one of the same name. */
    mote_expect(0, "30 instructions a frame", COUNT "certified", "in/s.json");
    (void)count_of("s", "certified", &found);
    assert_int_equal(found, 2);
}

TEST(instructions_that_were_counted_before_a_failure_are_kept)
{
    size_t found;
    file_put("fails", "aabb-tree");
    mote_expect(4, "valgrind: ended with status 1",
                COUNT "certified --method aabb-tree --method fcl-aabb", "s.json");
    assert_true(count_of("s", "certified", &found) == 20 && found == 1);
    (void)count_of("s", "aabb-tree", &found);
    assert_int_equal(found, 0);
    file_put("fails", "nothing");
    mote_expect(0, "20 instructions a frame", COUNT "aabb-tree", "s.json");
    (void)count_of("s", "certified", &found);
    assert_int_equal(found, 1);
}

/* A valgrind that writes its file and then never ends. */
#define ENDLESS                                                                                \
    "#!/bin/sh\n[ \"$1\" != --version ] || exit 0\nfor a; do case $a in "                      \
    "--callgrind-out-file=*) echo x > \"${a#*=}\" ;; esac; done\n: > started\nexec sleep "     \
    "100000\n"

TEST(instructions_after_a_signal_leave_no_file_of_callgrind)
{
    static const int signals[] = {SIGTERM, SIGINT};
    file_put("valgrind", ENDLESS);
    for (size_t i = 0; i < ROWS_OF(signals); ++i) {
        const pid_t pid = program_start(
            "instructions s.json --frames 1-2 --out . --method certified", "said");
        for (int tries = 0; !file_exists("started"); ++tries) {
            const struct timespec pause = {0, 10000000};
            assert_true(tries < 6000);
            (void)nanosleep(&pause, NULL);
        }
        assert_int_equal(folder_count(".", ".out"), 1);
        assert_int_equal(kill(pid, signals[i]), 0);
        assert_int_equal(program_wait(pid), 128 + signals[i]);
        assert_int_equal(folder_count(".", ".out"), 0);
        char *text = file_text("said");
        assert_non_null(strstr(text, "stopped by a signal; run the same command again"));
        free(text);
        assert_int_equal(folder_remove("started"), 0);
    }
}

/* Counts of two builds are never in one file. */
TEST(instructions_of_another_build_are_dropped)
{
    static const char *const programs[] = {"0123456789abcdef", NULL};
    for (size_t i = 0; i < ROWS_OF(programs); ++i) {
        size_t found;
        test_row("%s", programs[i] ? programs[i] : "an older file");
        mote_expect(0, "20 instructions a frame", COUNT "certified", "s.json");
        json_t *object = kept();
        if (programs[i])
            assert_int_equal(json_object_set_new(object, "program", json_string(programs[i])),
                             0);
        else
            assert_int_equal(json_object_del(object, "program"), 0);
        assert_int_equal(mote_record_json(".", "instructions.json", object), MOTE_OK);
        mote_expect(0, "20 instructions a frame", COUNT "aabb-tree", "s.json");
        (void)count_of("s", "certified", &found);
        assert_int_equal(found, 0);
        (void)count_of("s", "aabb-tree", &found);
        assert_int_equal(found, 1);
    }
}
