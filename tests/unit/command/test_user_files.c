/* A user's own files: scenarios written to other folders, pairs of meshes from anywhere, and
   output through links and into devices. */
#define _DEFAULT_SOURCE /* realpath, symlink */
#include "harness/run/active.h"
#include "tests/support/command_lines.h"
#include "tests/support/diamond.h"
#include "tests/support/program.h"
#include "tests/support/test.h"

#include <math.h>
#include <unistd.h>

#define FOLDER "test_user_files_folder"

/* Twice as large as the diamond: not to be taken for it. */
#define DECOY "v 2 0 0\nv -2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 4\nf 3 2 4\nf 1 2 3\nf 2 1 4\n"
#define SCENE                                                                                  \
    "{\"purpose\": \"x\", \"frames\": 40, \"ask\": \"distance\", \"active\": [2, 9], "         \
    "\"bodies\": [{\"file\": \"diamond.obj\"}, {\"file\": \"diamond.obj\", \"motion\": ["      \
    "{\"frame\": 1, \"position\": [0.6, 0.03, 0], \"axis\": [0, 1, 0], \"degrees\": 30}, "     \
    "{\"frame\": 9, \"position\": [0.65, 0.03, 0]}]}]}\n"

static int run(const char *arguments)
{
    char output[4096];
    const int status = command_run(FOLDER, arguments, "2>&1", output, sizeof output);
    if (status != 0)
        (void)fprintf(stderr, "mote %s: exit %d: %s", arguments, status, output);
    return status;
}

static void put(const char *name, const char *text)
{
    char path[128];
    (void)snprintf(path, sizeof path, FOLDER "/%s", name);
    assert_int_equal(mote_file_write(path, text, strlen(text)), MOTE_OK);
}

static int set_up(void)
{
    if (mote_directory_make(FOLDER "/own/below") != MOTE_OK ||
        mote_directory_make(FOLDER "/other") != MOTE_OK)
        return -1;
    put("own/diamond.obj", DIAMOND);
    put("own/s.json", SCENE);
    put("own/flat.obj", "v 0 -1 -1\nv 0 1 -1\nv 0 0 1\nf 1 2 3\n");
    put("own/flat.json", "{\"purpose\": \"z\", \"like\": \"s.json\", \"bodies\": ["
                         "{\"file\": \"flat.obj\"}, {}]}\n");
    put("own/like.json", "{\"purpose\": \"y\", \"like\": \"s.json\"}\n");
    put("other/diamond.obj", DECOY);
    return 0;
}

static int tear_down(void)
{
    return program_remove(FOLDER);
}

static mote_scenario *load(const char *name)
{
    char path[128];
    mote_scenario *scenario;
    (void)snprintf(path, sizeof path, FOLDER "/%s", name);
    if (mote_scenario_load(path, &scenario) != MOTE_OK)
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
    for (size_t i = 0; i < sizeof outputs / sizeof outputs[0]; ++i) {
        char line[256];
        (void)snprintf(line, sizeof line, "approach own/s.json" GAPS "%s", outputs[i]);
        assert_int_equal(run(line), 0);
        check_gaps(outputs[i]);
    }
    /* What may be named where it is, is not copied. */
    assert_false(command_left(FOLDER "/own", "a-body0.obj"));
    assert_false(command_left(FOLDER, "d-body0.obj"));
    assert_true(command_left(FOLDER "/other", "c-body0.obj"));
    assert_false(command_left(FOLDER "/other", "c-body1.obj")); /* both are one mesh */
    assert_int_equal(run("approach own/like.json" GAPS "other/like.json"), 0);
    check_gaps("other/like.json");
}

/* The diamond is pushed through the flat triangle. */
TEST(approach_whose_gap_is_not_met_fails_and_leaves_nothing)
{
    char output[1024];
    assert_int_equal(command_run(FOLDER,
                                 "approach own/flat.json --gaps 1:0.5,7:-0.99 -o other/e.json",
                                 "2>&1", output, sizeof output),
                     1);
    assert_non_null(strstr(output, "frame 7: the distance is "));
    assert_false(command_left(FOLDER "/other", "e.json"));
    assert_false(command_left(FOLDER "/other", "e-body0.obj"));
}

TEST(trace_written_to_another_folder_can_be_read)
{
    assert_int_equal(
        run("simulate own/s.json --method certified --steps 5 --trace other/t.json"), 0);
    mote_scenario *scenario = load("other/t.json");
    assert_int_equal(scenario->frames, 6);
    assert_int_equal(scenario->body[0].mesh->vertex_count, 6);
    mote_scenario_destroy(scenario);
    assert_int_equal(run("simulate pair:own/diamond.obj:other/diamond.obj --method certified "
                         "--steps 5 --trace other/p.json"),
                     0);
    mote_scenario_destroy(load("other/p.json"));
}

TEST(output_goes_through_links)
{
    struct stat info;
    char *text;
    size_t size;
    put("kept.obj", "old");
    assert_int_equal(symlink("../kept.obj", FOLDER "/own/link.obj"), 0);
    assert_int_equal(symlink("link.obj", FOLDER "/own/second.obj"), 0);
    assert_int_equal(symlink("../new.obj", FOLDER "/own/ahead.obj"), 0);
    assert_int_equal(symlink("round.obj", FOLDER "/own/round.obj"), 0);
    assert_int_equal(run("letter T --triangles 500 -o own/second.obj"), 0);
    assert_int_equal(run("letter T --triangles 500 -o own/ahead.obj"), 0);
    assert_int_equal(lstat(FOLDER "/own/link.obj", &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(lstat(FOLDER "/own/ahead.obj", &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(mote_file_read(FOLDER "/kept.obj", 1 << 20, &text, &size), MOTE_OK);
    assert_true(size > 10000);
    free(text);
    assert_int_equal(mote_file_read(FOLDER "/new.obj", 1 << 20, &text, &size), MOTE_OK);
    free(text);
    assert_int_equal(mote_file_write(FOLDER "/own/link.obj", "again", 5), MOTE_OK);
    assert_int_equal(mote_file_read(FOLDER "/kept.obj", 1 << 20, &text, &size), MOTE_OK);
    assert_string_equal(text, "again");
    free(text);
    assert_int_equal(mote_file_write(FOLDER "/own/round.obj", "x", 1), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "Too many levels"));
}

/* A FIFO stands for any device: a reader gets what is written, and the node stays. */
TEST(output_into_a_stream_is_written_and_never_replaces_it)
{
    struct stat info;
    char *text;
    size_t size;
    assert_int_equal(mkfifo(FOLDER "/fifo", 0600), 0);
    static const char *const lines[] = {"letter T --triangles 500 -o fifo",
                                        "approach own/s.json --gaps 1:0.1 -o fifo"};
    static const char *const begins[] = {"v ", "{"};
    for (int i = 0; i < 2; ++i) {
        char *line = mote_format("cd %s && cat fifo > read & cd %s && " MOTE_PROGRAM
                                 " %s > said 2>&1; status=$?; wait; exit $status",
                                 FOLDER, FOLDER, lines[i]);
        assert_int_equal(system(line), 0);
        free(line);
        assert_int_equal(lstat(FOLDER "/fifo", &info), 0);
        assert_true(S_ISFIFO(info.st_mode));
        assert_int_equal(mote_file_read(FOLDER "/read", 1 << 20, &text, &size), MOTE_OK);
        assert_int_equal(strncmp(text, begins[i], strlen(begins[i])), 0);
        free(text);
    }
    assert_int_equal(lstat("/dev/null", &info), 0);
    assert_int_equal(run("letter T --triangles 500 -o /dev/null"), 0);
    assert_int_equal(lstat("/dev/null", &info), 0);
    assert_true(S_ISCHR(info.st_mode));
}

/* What is said of a mesh does not stand in it, also where standard output is a file that has
   something in it. */
TEST(output_to_standard_output_is_appended_to_it)
{
    char *text;
    size_t size;
    assert_int_equal(system("cd " FOLDER " && echo '# mine' > mesh.obj && " MOTE_PROGRAM
                            " letter T --triangles 500 -o /dev/stdout >> mesh.obj 2> said"),
                     0);
    assert_int_equal(mote_file_read(FOLDER "/mesh.obj", 1 << 20, &text, &size), MOTE_OK);
    assert_int_equal(strncmp(text, "# mine\nv ", 9), 0);
    free(text);
    assert_int_equal(run("mesh mesh.obj"), 0);
}

TEST(pair_is_read_from_wherever_its_user_names_it)
{
    put("own/a:b.obj", DIAMOND);
    assert_int_equal(symlink("../diamond.obj", FOLDER "/own/below/link.obj"), 0);
    char *here = realpath(FOLDER, NULL);
    assert_non_null(here);
    static const char *const folders[] = {FOLDER, FOLDER "/own", FOLDER "/own/below"};
    static const char *const first[] = {"own/diamond.obj", "./diamond.obj", "../diamond.obj"};
    for (int i = 0; i < 3; ++i) {
        char output[1024];
        char *line = mote_format("run --pair %s %s/own/below/link.obj --method certified "
                                 "--replicates 1 --frames 1-4 --out %s/run",
                                 first[i], here, here);
        if (command_run(folders[i], line, "2>&1", output, sizeof output) != 0)
            fail_msg("mote %s: %s", line, output);
        free(line);
    }
    free(here);
    assert_int_equal(run("run --direction=0,1,0 --pair own/diamond.obj own/diamond.obj --method "
                         "certified --replicates 1 --frames 1-4 --out run"),
                     0);
    assert_int_equal(run("run pair:own/a:b.obj:own/diamond.obj --method certified --frames 1-2 "
                         "--replicates 1 --out run"),
                     0);
    static const char *const lines[] = {
        "export pair:own/diamond.obj:own/diamond.obj --frame 3 --out e",
        "simulate pair:own/diamond.obj:own/diamond.obj --method certified --steps 2",
        "approach pair:own/diamond.obj:own/diamond.obj --gaps 1:0.1 --every 500 -o p.json",
        "check pair:own/diamond.obj:own/diamond.obj:0,1,0", "check p.json"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i)
        assert_int_equal(run(lines[i]), 0);
}

/* JSON has no other names. */
TEST(pair_with_a_name_that_is_not_utf_8_is_refused)
{
    char output[1024];
    put("own/\377.obj", DIAMOND);
    assert_int_equal(command_run(FOLDER,
                                 "check \"$(printf 'pair:own/\\377.obj:own/diamond.obj')\"",
                                 "2>&1", output, sizeof output),
                     4);
    assert_non_null(strstr(output, "names that are not UTF-8"));
}

TEST_GROUP(set_up, tear_down);
