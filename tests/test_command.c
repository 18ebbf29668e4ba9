/* The program itself, run as a user runs it. */
#include "harness/file.h"

#include <setjmp.h>
#include <stdbool.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmocka.h>

#define FOLDER "test_command_files"

/* Runs `mote ARGUMENTS` by the shell; returns the exit status. streams: "2>&1" to get both,
   "2>&1 >/dev/null" to get the errors only. */
static int run_streams(const char *arguments, const char *streams, char *output, size_t size)
{
    char *line = mote_format("cd %s && %s %s %s", FOLDER, MOTE_PROGRAM, arguments, streams);
    assert_non_null(line);
    FILE *pipe = popen(line, "r");
    assert_non_null(pipe);
    size_t got = fread(output, 1, size - 1, pipe);
    output[got] = '\0';
    int status = pclose(pipe);
    free(line);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static int run(const char *arguments, char *output, size_t size)
{
    return run_streams(arguments, "2>&1", output, size);
}

static bool exists(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0;
}

static int set_up(void **state)
{
    (void)state;
    static const char broken[] = "{\"purpose\": \"x\",\n \"frames\": }\n";
    static const char unknown[] = "{\"purpose\": \"x\",\n \"speed\": 1}\n";
    return mote_directory_make(FOLDER) == MOTE_OK &&
                   mote_file_write(FOLDER "/broken.json", broken, strlen(broken)) == MOTE_OK &&
                   mote_file_write(FOLDER "/unknown.json", unknown, strlen(unknown)) == MOTE_OK
               ? 0
               : -1;
}

static int tear_down(void **state)
{
    (void)state;
    (void)unlink(FOLDER "/broken.json");
    (void)unlink(FOLDER "/unknown.json");
    return rmdir(FOLDER); /* fails if a command left anything behind */
}

typedef struct bad_line {
    const char *arguments;
    int status;
    const char *says;
} bad_line;

static const bad_line bad_lines[] = {
    {"", 2, "no command"},
    {"fly", 2, "unknown command fly; known are"},
    {"list", 2, "methods or scenarios"},
    {"list planets", 2, "planets"},
    {"list methods --yaml", 2, "unknown option --yaml"},
    {"letter W", 2, "missing"},
    {"letter W --triangles", 2, "needs a value"},
    {"letter W --triangles many -o W.obj", 2, "whole number"},
    {"letter W --triangles 401 -o W.obj", 4, "odd"},
    {"letter WW --triangles 400 -o W.obj", 4, "not one letter"},
    {"letter W --triangles 400 -o no/W.obj", 4, "no/W.obj"},
    {"check", 2, "no scenario"},
    {"check nothing", 4, "nothing: no such scenario; known are"},
    {"check missing.json", 4, "missing.json: No such file"},
    {"check broken.json", 4, "broken.json:2:"},
    {"check unknown.json", 4, "unknown.json:2: speed: unknown key"},
    {"check ./", 4, "not a regular file"},
    {"check /dev/zero/", 4, "/dev/zero/"},
    {"export tt --frame 1", 2, "missing"},
    {"export tt --frame 0 --out x", 2, "--frame 0"},
    {"export tt --frame 601 --out x", 4, "frames 1-600"},
    {"export tt --frame 1 --out x --method magic", 4, "unknown method magic; known are"},
    {"export tt --frame 1 --out x --method fcl-aabb:speed=9", 4, "speed"},
    {"export tt --frame 1 --out x --method particle-paper:n=0", 4, "n"},
    {"export tt --frame 1 --out x --method particle-paper:n=100000", 4, "n"},
    {"export tt --frame 1 --out /proc/x", 4, "/proc/x"},
    {"export tt --frame 1 --out broken.json/x", 4, "broken.json"},
    {"approach tt -o x.json", 2, "missing"},
    {"approach tt --gaps 1:0.1,700:1 -o x.json", 4, "700:1"},
    {"approach tt --gaps 1:0.1,zwei -o x.json", 4, "zwei"},
    {"run missing.json --method fcl-aabb --out x", 4, "missing.json"},
    {"run broken.json --method fcl-aabb --out x", 4, "broken.json:2:"},
    {"run tt --method magic --out x", 4, "magic"},
    {"run tt --method particle-paper:n=0 --out x", 4, "n"},
    {"run tt --method fcl-aabb --frames 9-3 --out x", 4, "9-3"},
    {"run tt --method fcl-aabb --out /proc/x", 4, "/proc/x"},
    {"run --pair a.obj", 2, "two mesh files"},
    {"run --pair a.obj b.obj --method fcl-aabb --out x", 4, "a.obj"},
    {"check pair:a.obj", 4, "not two files"},
    {"mesh", 2, "no file"},
    {"mesh nothing.obj", 4, "nothing.obj"},
    {"mesh broken.json", 4, "broken.json"},
    {"mesh .", 4, "not a regular file"},
    {"distance a.obj", 2, "two files"},
    {"distance a.obj b.obj", 4, "a.obj"},
    {"distance a.obj b.obj --method magic", 4, "magic"},
};

static void main_bad_line_one_line_and_its_exit_status(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bad_lines / sizeof bad_lines[0]; ++i) {
        const bad_line *bad = &bad_lines[i];
        char output[4096];
        int status = run_streams(bad->arguments, "2>&1 >/dev/null", output, sizeof output);
        /* Before the error there may be lines of progress, after it nothing. */
        const char *error = strstr(output, "mote: ");
        const char *feed = error ? strchr(error, '\n') : NULL;
        bool one_line = feed && feed[1] == '\0' && (error == output || error[-1] == '\n');
        if (status != bad->status || !strstr(output, bad->says) || !one_line)
            fail_msg("mote %s: exit %d, not %d, or not one line with \"%s\":\n%s",
                     bad->arguments, status, bad->status, bad->says, output);
        if (exists(FOLDER "/x") || exists(FOLDER "/W.obj") || exists(FOLDER "/x.json"))
            fail_msg("mote %s left something behind", bad->arguments);
    }
}

static void command_list_names_what_there_is(void **state)
{
    (void)state;
    char output[1 << 16];
    assert_int_equal(run("list methods", output, sizeof output), 0);
    assert_non_null(strstr(output, "fcl-aabb"));
    assert_non_null(strstr(output, "particle-paper"));
    assert_int_equal(run("list scenarios --json", output, sizeof output), 0);
    assert_non_null(strstr(output, "\"ww\""));
    assert_int_equal(run("--help", output, sizeof output), 0);
    assert_non_null(strstr(output, "mote check SCENARIO"));
}

static void command_letter_writes_that_many_triangles(void **state)
{
    (void)state;
    char output[1024];
    assert_int_equal(run("letter V --triangles 500 -o V.obj", output, sizeof output), 0);
    char *text;
    size_t size;
    assert_int_equal(mote_file_read(FOLDER "/V.obj", 1 << 20, &text, &size), MOTE_OK);
    int faces = 0;
    for (const char *at = text; (at = strstr(at, "\nf ")); ++at)
        ++faces;
    assert_int_equal(faces, 500);
    free(text);
    assert_int_equal(unlink(FOLDER "/V.obj"), 0);
}

static void command_export_answers_match_between_exact_methods(void **state)
{
    (void)state;
    char output[1024];
    assert_int_equal(run("export tt --frame 120 --out e --method brute-force "
                         "--method fcl-aabb:seed=previous,queue=64",
                         output, sizeof output),
                     0);
    char *text;
    size_t size;
    assert_int_equal(mote_file_read(FOLDER "/e/answers.json", 1 << 20, &text, &size), MOTE_OK);
    double distance[2] = {-1, -2};
    const char *at = text;
    for (int i = 0; i < 2; ++i) {
        at = strstr(at, "\"distance\": ");
        assert_non_null(at);
        at += strlen("\"distance\": ");
        distance[i] = strtod(at, NULL);
    }
    assert_true(distance[0] > 0);
    assert_true(distance[0] - distance[1] < 1e-12 && distance[1] - distance[0] < 1e-12);
    free(text);
    assert_int_equal(unlink(FOLDER "/e/answers.json"), 0);
    assert_int_equal(unlink(FOLDER "/e/A.obj"), 0);
    assert_int_equal(unlink(FOLDER "/e/B.obj"), 0);
    assert_int_equal(rmdir(FOLDER "/e"), 0);
}

static void command_list_full_disk_is_an_error(void **state)
{
    (void)state;
    char output[1024];
    if (!exists("/dev/full"))
        skip();
    assert_int_equal(run_streams("list methods", "2>&1 >/dev/full", output, sizeof output), 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(main_bad_line_one_line_and_its_exit_status),
        cmocka_unit_test(command_list_names_what_there_is),
        cmocka_unit_test(command_letter_writes_that_many_triangles),
        cmocka_unit_test(command_export_answers_match_between_exact_methods),
        cmocka_unit_test(command_list_full_disk_is_an_error),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
