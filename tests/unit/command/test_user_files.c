/* A user's own files: scenarios written to other folders, pairs of meshes from anywhere, and
   output through links and into devices. */
#define _DEFAULT_SOURCE /* symlink */
#include "harness/run/active.h"
#include "harness/base/file.h"
#include "tests/support/diamond.h"
#include "tests/support/folder.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

/* Twice as large as the diamond, and must not be mistaken for it. */
#define DECOY "v 2 0 0\nv -2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 4\nf 3 2 4\nf 1 2 3\nf 2 1 4\n"
#define SCENE                                                                                  \
    "{\"purpose\": \"x\", \"frames\": 40, \"ask\": \"distance\", \"active\": [2, 9], "         \
    "\"bodies\": [{\"file\": \"diamond.obj\"}, {\"file\": \"diamond.obj\", \"motion\": ["      \
    "{\"frame\": 1, \"position\": [0.6, 0.03, 0], \"axis\": [0, 1, 0], \"degrees\": 30}, "     \
    "{\"frame\": 9, \"position\": [0.65, 0.03, 0]}]}]}\n"

static int put_files(void)
{
    if (mote_directory_make("own/below") != MOTE_OK || mote_directory_make("other") != MOTE_OK)
        return -1;
    file_put("own/diamond.obj", DIAMOND);
    file_put("own/s.json", SCENE);
    file_put("own/flat.obj", "v 0 -1 -1\nv 0 1 -1\nv 0 0 1\nf 1 2 3\n");
    file_put("own/flat.json", "{\"purpose\": \"z\", \"like\": \"s.json\", \"bodies\": ["
                              "{\"file\": \"flat.obj\"}, {}]}\n");
    file_put("own/like.json", "{\"purpose\": \"y\", \"like\": \"s.json\"}\n");
    file_put("other/diamond.obj", DECOY);
    return 0;
}

static mote_scenario *load(const char *name)
{
    mote_scenario *scenario;
    if (mote_scenario_load(name, &scenario) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return scenario;
}

/* The scenario's meshes are the diamond, and frames 1, 7 and 20 are 0.5, 0.03 and 0 apart. */
static void check_gaps(const char *name)
{
    static const struct {
        uint32_t frame;
        double gap;
    } wished[] = {{1, 0.5}, {7, 0.03}, {20, 0}};
    mote_scenario *scenario = load(name);
    mote_truth *truth;
    for (int i = 0; i < 2; ++i)
        assert_int_equal(scenario->body[i].mesh->vertex_count, 6);
    assert_int_equal(mote_truth_compute(scenario, &truth), MOTE_OK);
    for (int k = 0; k < 3; ++k) {
        const double found = truth->distance[wished[k].frame - 1] / scenario->length;
        if (fabs(found - wished[k].gap) > 1e-3)
            fail_msg("%s: frame %u: %g L, not %g", name, wished[k].frame, found, wished[k].gap);
    }
    assert_true(scenario->active.first > 0);
    assert_true(mote_active_holds(scenario, truth, scenario->active));
    mote_truth_destroy(truth);
    mote_scenario_destroy(scenario);
}

#define GAPS " --gaps 1:0.5,7:0.03,20:-0.01 -o "

TEST(approach_written_to_any_folder_can_be_read_and_has_the_wished_gaps)
{
    static const char *const outputs[] = {"own/a.json", "own/below/b.json", "other/c.json",
                                          "d.json"};
    for (size_t i = 0; i < ROWS_OF(outputs); ++i) {
        mote_expect(0, "", "approach own/s.json" GAPS "%s", outputs[i]);
        check_gaps(outputs[i]);
    }
    /* A file that may be named where it is, is not copied. */
    assert_false(file_exists("own/a-body0.obj"));
    assert_false(file_exists("d-body0.obj"));
    assert_true(file_exists("other/c-body0.obj"));
    assert_false(file_exists("other/c-body1.obj")); /* both are one mesh */
    mote_expect(0, "", "approach own/like.json" GAPS "other/like.json");
    check_gaps("other/like.json");
}

/* The diamond is pushed through the flat triangle. */
TEST(approach_whose_gap_is_not_met_fails_and_leaves_nothing)
{
    mote_expect(1, "frame 7: the distance is ",
                "approach own/flat.json --gaps 1:0.5,7:-0.99 -o other/e.json");
    assert_false(file_exists("other/e.json"));
    assert_false(file_exists("other/e-body0.obj"));
}

TEST(trace_written_to_another_folder_can_be_read)
{
    mote_expect(0, "", "simulate own/s.json --method certified --steps 5 --trace other/t.json");
    mote_scenario *scenario = load("other/t.json");
    assert_int_equal(scenario->frames, 6);
    assert_int_equal(scenario->body[0].mesh->vertex_count, 6);
    mote_scenario_destroy(scenario);
    mote_expect(0, "",
                "simulate pair:own/diamond.obj:other/diamond.obj --method certified "
                "--steps 5 --trace other/p.json");
    mote_scenario_destroy(load("other/p.json"));
}

TEST(output_goes_through_links)
{
    struct stat info;
    char *text;
    file_put("kept.obj", "old");
    assert_int_equal(symlink("../kept.obj", "own/link.obj"), 0);
    assert_int_equal(symlink("link.obj", "own/second.obj"), 0);
    assert_int_equal(symlink("../new.obj", "own/ahead.obj"), 0);
    assert_int_equal(symlink("round.obj", "own/round.obj"), 0);
    mote_expect(0, "", "letter T --triangles 500 -o own/second.obj");
    mote_expect(0, "", "letter T --triangles 500 -o own/ahead.obj");
    assert_int_equal(lstat("own/link.obj", &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(lstat("own/ahead.obj", &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    text = file_text("kept.obj");
    assert_true(strlen(text) > 10000);
    free(text);
    assert_true(file_exists("new.obj"));
    assert_int_equal(mote_file_write("own/link.obj", "again", 5), MOTE_OK);
    text = file_text("kept.obj");
    assert_string_equal(text, "again");
    free(text);
    assert_int_equal(mote_file_write("own/round.obj", "x", 1), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "Too many levels"));
}

/* A FIFO stands for any device: a reader gets the output, and the node stays. */
TEST(output_into_a_stream_is_written_and_never_replaces_it)
{
    struct stat info;
    char *text;
    assert_int_equal(mkfifo("fifo", 0600), 0);
    static const char *const lines[] = {"letter T --triangles 500 -o fifo",
                                        "approach own/s.json --gaps 1:0.1 -o fifo"};
    static const char *const begins[] = {"v ", "{"};
    for (int i = 0; i < 2; ++i) {
        char *line = mote_format("cat fifo > read & " MOTE_PROGRAM
                                 " %s > said 2>&1; status=$?; wait; exit $status",
                                 lines[i]);
        assert_int_equal(system(line), 0);
        free(line);
        assert_int_equal(lstat("fifo", &info), 0);
        assert_true(S_ISFIFO(info.st_mode));
        text = file_text("read");
        assert_int_equal(strncmp(text, begins[i], strlen(begins[i])), 0);
        free(text);
    }
    assert_int_equal(lstat("/dev/null", &info), 0);
    mote_expect(0, "", "letter T --triangles 500 -o /dev/null");
    assert_int_equal(lstat("/dev/null", &info), 0);
    assert_true(S_ISCHR(info.st_mode));
}

/* Messages about a mesh do not get into it, and output is appended to a file that standard
   output already points to. */
TEST(output_to_standard_output_is_appended_to_it)
{
    char *text;
    assert_int_equal(system("echo '# mine' > mesh.obj && " MOTE_PROGRAM
                            " letter T --triangles 500 -o /dev/stdout >> mesh.obj 2> said"),
                     0);
    text = file_text("mesh.obj");
    assert_int_equal(strncmp(text, "# mine\nv ", 9), 0);
    free(text);
    mote_expect(0, "", "mesh mesh.obj");
}

TEST(pair_is_read_from_wherever_its_user_names_it)
{
    file_put("own/a:b.obj", DIAMOND);
    assert_int_equal(symlink("../diamond.obj", "own/below/link.obj"), 0);
    static const char *const folders[] = {".", "own", "own/below"};
    static const char *const first[] = {"own/diamond.obj", "./diamond.obj", "../diamond.obj"};
    const char *here = folder_path();
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(chdir(folders[i]), 0);
        mote_expect(0, "",
                    "run --pair %s %s/own/below/link.obj --method certified --replicates 1 "
                    "--frames 1-4 --out %s/run",
                    first[i], here, here);
        assert_int_equal(chdir(here), 0);
    }
    mote_expect(0, "",
                "run --direction=0,1,0 --pair own/diamond.obj own/diamond.obj --method "
                "certified --replicates 1 --frames 1-4 --out run");
    mote_expect(0, "",
                "run pair:own/a:b.obj:own/diamond.obj --method certified --frames 1-2 "
                "--replicates 1 --out run");
    static const char *const lines[] = {
        "export pair:own/diamond.obj:own/diamond.obj --frame 3 --out e",
        "simulate pair:own/diamond.obj:own/diamond.obj --method certified --steps 2",
        "approach pair:own/diamond.obj:own/diamond.obj --gaps 1:0.1 --every 500 -o p.json",
        "check pair:own/diamond.obj:own/diamond.obj:0,1,0", "check p.json"};
    for (size_t i = 0; i < ROWS_OF(lines); ++i)
        mote_expect(0, "", "%s", lines[i]);
}

/* JSON cannot hold other names. */
TEST(pair_with_a_name_that_is_not_utf_8_is_refused)
{
    file_put("own/\377.obj", DIAMOND);
    mote_expect(4, "names that are not UTF-8",
                "check \"$(printf 'pair:own/\\377.obj:own/diamond.obj')\"");
}

TEST(simulation_of_a_name_that_is_not_utf_8_is_told_in_lines_and_not_in_json)
{
    file_put("own/\377.json", SCENE);
    mote_expect(0, "2 steps",
                "simulate \"$(printf 'own/\\377.json')\" --method certified --steps 2");
    mote_expect(4, "is not UTF-8",
                "simulate \"$(printf 'own/\\377.json')\" --method certified --steps 2 --json");
}

TEST_GROUP(put_files, NULL);
