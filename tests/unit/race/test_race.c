/* mote race from outside: programs that are slower, wrong, of another format, or not racers. */
#include "tests/support/command_lines.h"
#include "tests/support/folder.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Two small letters that pass each other. */
#define SCENARIO "letters.json"
#define QUICK SCENARIO " --method certified --frames 1-40 --budget 60 --until 20%% --real 10%%"

static void put_program(const char *name, const char *text)
{
    file_put(name, text);
    assert_int_equal(chmod(name, 0755), 0);
}

/* Writes a racer with something planted: tests/studies/race_planted.c. */
static void put_planted(const char *name, const char *plant)
{
    char text[1024];
    (void)snprintf(text, sizeof text, "#!/bin/sh\nMOTE_PLANT=%s exec %s \"$@\"\n", plant,
                   MOTE_RACE_PLANTED);
    put_program(name, text);
}

static int put_files(void)
{
    if (folder_next() != 0)
        return -1;
    file_put(SCENARIO,
             "{\"purpose\": \"two letters that pass\", \"frames\": 60, \"ask\": \"distance\",\n"
             "\"bodies\": [{\"letter\": \"T\", \"triangles\": 400},\n"
             "{\"letter\": \"T\", \"triangles\": 400, \"motion\": [{\"frame\": 1, "
             "\"position\": [1.5, 0, 0]}, {\"frame\": 60, \"position\": [0.9, 0.5, 0]}]}]}\n");
    return 0;
}

TEST_EACH(put_files, NULL);

/* Whether a process is a racer running in this folder. */
static bool is_racer(const char *pid)
{
    char path[300], words[512] = "", place[512] = "";
    (void)snprintf(path, sizeof path, "/proc/%s/cmdline", pid);
    FILE *file = fopen(path, "r");
    const size_t size = file ? fread(words, 1, sizeof words - 1, file) : 0;
    if (file)
        (void)fclose(file);
    (void)snprintf(path, sizeof path, "/proc/%s/cwd", pid);
    if (readlink(path, place, sizeof place - 1) < 0)
        return false;
    const char *second = words + strlen(words) + 1;
    return second < words + size && strcmp(second, "race-child") == 0 &&
           strncmp(place, folder_path(), strlen(folder_path())) == 0;
}

static int racers(void)
{
    int count = 0;
    DIR *processes = opendir("/proc");
    assert_non_null(processes);
    for (const struct dirent *entry; (entry = readdir(processes));)
        count += is_racer(entry->d_name);
    (void)closedir(processes);
    return count;
}

static void sleep_ms(long ms)
{
    const struct timespec moment = {.tv_nsec = ms * 1000000};
    (void)nanosleep(&moment, NULL);
}

/* Waits for that many running racers, 10 s at most. */
static bool racers_become(int count)
{
    for (int i = 0; i < 500 && racers() != count; ++i)
        sleep_ms(20);
    return racers() == count;
}

TEST(a_build_against_itself_is_the_same)
{
    mote_expect(0, "same or better", "race %s %s " QUICK, MOTE_PROGRAM, MOTE_PROGRAM);
    assert_non_null(strstr(said, "certified/hot"));
}

TEST(a_slower_method_is_named_alone)
{
    put_planted("base", "slow:particle:0");
    put_planted("slow", "slow:particle:0.6");
    mote_expect(1, "worse after", "race base slow " QUICK " --method particle:n=5");
    const char *particle = strstr(said, "/particle:n=5/hot"),
               *line = strstr(said, "/certified");
    assert_non_null(particle);
    assert_non_null(line);
    assert_non_null(strstr(particle, "slower"));
    assert_null(strstr(line, particle < line ? "slower" : "certified slower"));
    mote_expect(0, "faster", "race slow base " QUICK " --method particle:n=5");
}

TEST(other_answers_fail_a_race_unless_they_are_allowed)
{
    put_planted("base", "answer:certified:0");
    put_planted("wrong", "answer:certified:0.001");
    put_planted("rounded", "answer:certified:1e-13");
    mote_expect(1, "answers differ by up to", "race base wrong " QUICK);
    mote_expect(0, "answers differ by up to", "race base wrong " QUICK " --allow-changes");
    mote_expect(0, "answers differ by rounding", "race base rounded " QUICK);
}

TEST(changed_counts_are_told)
{
    put_planted("base", "count:certified:0");
    put_planted("more", "count:certified:5");
    mote_expect(0, "box_tests", "race base more " QUICK);
}

TEST(a_side_that_crashes_is_named)
{
    put_planted("base", "slow:certified:0");
    put_planted("crash", "crash:certified:7");
    mote_expect(1, "B: ./crash: ended by signal 6", "race base crash " QUICK);
    mote_expect(0, "A: ./crash: ended by signal 6", "race crash base " QUICK);
    assert_int_equal(racers(), 0);
}

TEST(what_a_side_does_not_have_is_left_out)
{
    put_planted("lacks", "lack:certified:0");
    put_planted("has", "slow:particle:0");
    /* The method is new in B, so there is nothing to compare. */
    mote_expect(0, "left out", "race lacks has " QUICK " --method particle:n=5");
    assert_non_null(strstr(said, "A: unknown method certified"));
    /* B lost the method, so nothing is known about it any more. */
    mote_expect(3, "B: unknown method certified",
                "race has lacks " QUICK " --method particle:n=5");
}

TEST(builds_in_a_folder_take_turns)
{
    assert_int_equal(mkdir("builds", 0755), 0);
    put_planted("builds/one", "slow:certified:0");
    put_planted("builds/two", "slow:certified:0.9");
    file_put("builds/notes.txt", "no program");
    /* A mixture of builds of equal and of nearly half the speed varies from pair to pair. */
    (void)mote("race builds/one builds " QUICK " --budget 3 --out race.json >/dev/null");
    char *json = file_text("race.json");
    const char *spread = strstr(json, "\"spread\":");
    assert_non_null(spread);
    assert_true(strtod(spread + 9, NULL) > 0.2);
    assert_non_null(strstr(json, "\"builds\": [\n  1,\n  2\n ]"));
    free(json);
}

TEST(a_side_has_64_builds_at_most)
{
    assert_int_equal(mkdir("builds", 0755), 0);
    for (int i = 0; i < 65; ++i) {
        char name[32];
        (void)snprintf(name, sizeof name, "builds/b%02d", i);
        put_program(name, "#!/bin/sh\n");
    }
    assert_int_equal(mkdir("builds/folder", 0755), 0);
    mote_expect(4, "builds: more than 64 programs; keep fewer", "race builds builds " QUICK);
}

TEST(programs_that_cannot_race_are_refused)
{
    put_program("other", "#!/bin/sh\nprintf 'mote-race\\t2\\n'; cat >/dev/null\n");
    put_program("old", "#!/bin/sh\necho 'mote: unknown command race-child' >&2; exit 2\n");
    put_program("mute", "#!/bin/sh\nexec sleep 60\n");
    put_program("odd", "#!/bin/sh\necho hello; exec cat\n");
    put_program("binary", "#!/bin/sh\nprintf 'a\\000b\\n'; exec cat\n");
    put_program("liar",
                "#!/bin/sh\nprintf 'mote-race\\t1\\n'; while read x; do echo 'ok'; done\n");
    put_program("short", "#!/bin/sh\nprintf 'mote-race\\t1\\n'; while read x; do "
                         "printf 'ok\\t0\\t1\\t40\\n'; done\n");
    static const struct {
        const char *program, *says;
        int status;
    } rows[] = {
        {"other", "speaks format 2 of races, and this program format 1", 4},
        {"old", "a build from before `mote race` cannot be raced", 4},
        {"mute", "took too long to answer", 4},
        {"odd", "does not speak as a racer does", 4},
        {"binary", "before its greeting", 4},
        {"liar", "an answer that cannot be read", 1},
        {"short", "the scenario is not the same in both programs", 4},
        {"missing", "No such file", 4},
        {SCENARIO, "not a program that can be run", 4},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s", rows[i].program);
        mote_expect(rows[i].status, rows[i].says, "race %s %s " QUICK " --timeout 1",
                    MOTE_PROGRAM, rows[i].program);
        assert_int_equal(racers(), 0);
    }
}

/* Starts a race that would last a minute and ends it by a signal while both racers run; returns
   its wait status. */
static int killed_race(int signal_number)
{
    const pid_t pid = fork();
    assert_true(pid >= 0);
    if (pid == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        (void)dup2(nowhere, STDOUT_FILENO);
        (void)dup2(nowhere, STDERR_FILENO);
        (void)execl(MOTE_PROGRAM, "mote", "race", "./one", "./two", SCENARIO, "--method",
                    "certified", "--until", "0.0001%", "--budget", "60", "--out", "race.json",
                    (char *)NULL);
        _exit(127);
    }
    int status = 0;
    const bool both = racers_become(2);
    sleep_ms(100);
    (void)kill(pid, signal_number);
    assert_int_equal(waitpid(pid, &status, 0), pid);
    assert_true(both);
    return status;
}

TEST(a_killed_race_leaves_nothing)
{
    static const int signals[] = {SIGKILL, SIGTERM, SIGINT};
    put_planted("one", "slow:certified:0");
    put_planted("two", "slow:certified:0");
    for (size_t i = 0; i < ROWS_OF(signals); ++i) {
        test_row("%s", strsignal(signals[i]));
        const int status = killed_race(signals[i]);
        if (signals[i] == SIGKILL)
            assert_true(WIFSIGNALED(status));
        else
            assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 128 + signals[i]);
        assert_true(racers_become(0));
        assert_int_equal(folder_count(".", ""), 3); /* one, two, the scenario */
    }
}

TEST(command_lines_that_are_wrong)
{
    static const command_line lines[] = {
        {"race", 2, "two programs, a scenario and --method are needed"},
        {"race a b ww", 2, "two programs, a scenario and --method are needed"},
        {"race /bin/true /bin/true ww --method certified --until x", 2, "--until x"},
        {"race /bin/true /bin/true ww --method certified --until 0%", 2, "--until 0%"},
        {"race /bin/true /bin/true ww --method certified --real 200%", 2, "--real 200%"},
        {"race /bin/true /bin/true ww --method certified --budget -1", 2, "--budget -1"},
        {"race /bin/true /bin/true ww --method certified --timeout 0", 2, "--timeout 0"},
        {"race /bin/true /bin/true ww --method certified --seed x", 2, "--seed x"},
        {"race /bin/true /bin/true ww --method certified --cache warm", 2, "--cache warm"},
        {"race /bin/true /bin/true ww --method certified --format xml", 2, "--format xml"},
        {"race /bin/true /bin/true ww --method certified --labels one", 2, "--labels one"},
        {"race /bin/true /bin/true ww --method nothing", 4, "unknown method nothing"},
        {"race /bin/true /bin/true ww --method certified --frames 9-1", 2, "9-1"},
        {"race /nowhere /bin/true ww --method certified", 4, "/nowhere: No such file"},
        {"race . . ww --method certified", 4, "no program in this folder"},
    };
    command_refuses(lines, ROWS_OF(lines));
}

TEST(what_cannot_be_measured_is_told)
{
    mote_expect(4, "it has frames 1-60", "race %s %s " SCENARIO "@50-90 --method certified",
                MOTE_PROGRAM, MOTE_PROGRAM);
    mote_expect(4, "nothing.json", "race %s %s nothing.json --method certified", MOTE_PROGRAM,
                MOTE_PROGRAM);
}

TEST(scenes_of_many_bodies_race_and_threads_do_not)
{
    file_put("many.json",
             "{\"purpose\": \"letters in a box\", \"frames\": 10, \"ask\": \"distance\",\n"
             "\"bodies\": {\"count\": 6, \"seed\": 1, \"near_pairs\": 1, \"near\": 0.2,\n"
             "\"speed\": 0.006, \"spin\": 0.8,\n"
             "\"shapes\": [{\"letter\": \"T\", \"triangles\": 400}]}}\n");
    mote_expect(0, "many.json/certified/hot",
                "race %s %s many.json --method certified "
                "--budget 60 --until 20%% --real 10%%",
                MOTE_PROGRAM, MOTE_PROGRAM);
    mote_expect(4, "leave threads and ahead out",
                "race %s %s " SCENARIO " --method certified:threads=2", MOTE_PROGRAM,
                MOTE_PROGRAM);
}

/* Three triangles on one edge, which --strict refuses; scenarios that name the file, one of
   them from a folder beside it. */
static void put_books(void)
{
    static const char scenario[] =
        "{\"purpose\": \"two books\", \"frames\": 4, \"ask\": \"distance\", \"bodies\": "
        "[{\"file\": \"%sbook.obj\"}, {\"file\": \"%sbook.obj\", \"motion\": [{\"frame\": 1, "
        "\"position\": [3, 0, 0]}]}]}\n";
    static const char *const places[][2] = {{"books.json", ""}, {"in/books.json", "../"}};
    assert_int_equal(mkdir("in", 0755), 0);
    file_put("book.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\n"
                         "f 1 2 3\nf 2 1 4\nf 1 2 5\n");
    for (size_t i = 0; i < ROWS_OF(places); ++i) {
        char text[512];
        (void)snprintf(text, sizeof text, scenario, places[i][1], places[i][1]);
        file_put(places[i][0], text);
    }
}

/* What the user says of all commands holds for the programs that race as well. */
TEST(racers_are_told_what_may_be_read)
{
    static const struct {
        const char *before, *scenario, *says;
        int status;
    } rows[] = {
        {"", "books.json", "books.json/aabb-tree/hot", 0},
        {"--strict", "books.json", "non-manifold", 4},
        {"", "in/books.json", "lies outside of the scenario's folder", 4},
        {"--allow .", "in/books.json", "books.json/aabb-tree/hot", 0},
        {"--allow . --strict", "in/books.json", "non-manifold", 4},
    };
    put_books();
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        test_row("%s %s", rows[i].before, rows[i].scenario);
        mote_expect(rows[i].status, rows[i].says,
                    "%s race %s %s %s --method aabb-tree --budget 60 --until 50%% --real 50%%",
                    rows[i].before, MOTE_PROGRAM, MOTE_PROGRAM, rows[i].scenario);
    }
}

/* `instructions` starts this program under valgrind, of which this one keeps the words. */
TEST(programs_whose_instructions_are_counted_are_told_what_may_be_read)
{
    static const char counts[] = "instructions in/books.json --frames 1-2 --method aabb-tree";
    char path[512], words[2048], here[1024];
    put_books();
    put_program("valgrind", "#!/bin/sh\nfor a; do case $a in --callgrind-out-file=*)\n"
                            "printf 'x\\ntotals: 40\\n' > \"${a#*=}\" ;; esac; done\n"
                            "echo \"$@\" > words\n");
    assert_non_null(getcwd(here, sizeof here));
    (void)snprintf(path, sizeof path, ".:%s", getenv("PATH"));
    (void)snprintf(words, sizeof words, "mote --allow %s %s --inside", here, counts);
    assert_int_equal(setenv("PATH", path, 1), 0);
    mote_expect(0, "20 instructions a frame", "--allow . %s --out .", counts);
    char *told = file_text("words");
    if (!strstr(told, words))
        fail_msg("not \"%s\" but:\n%s", words, told);
    free(told);
    mote_expect(0, "20 instructions a frame",
                "--strict instructions " SCENARIO " --frames 1-2 --method aabb-tree --out .");
    told = file_text("words");
    assert_non_null(strstr(told, "mote --strict instructions"));
    free(told);
}

/* Methods of a library are raced if both programs load it. Beside other work the verdict may be
   undecided (3). */
TEST(racers_load_libraries)
{
    const int status =
        mote("race %s %s " SCENARIO " --frames 1-9 --plugin %s --method plugin-points "
             "--budget 60 --until 50%% --real 50%%",
             MOTE_PROGRAM, MOTE_PROGRAM, MOTE_RACE_PLUGIN);
    assert_true(status == 0 || status == 3);
    assert_non_null(strstr(said, "/plugin-points/hot"));
    assert_null(strstr(said, "unknown method"));
}

/* A row says which frames it is about where another one has the same name, and its JSON what it
   was asked. */
TEST(rows_of_other_frames_have_names_of_their_own)
{
    mote_expect(0, SCENARIO "@1-9/aabb-tree/hot",
                "race %s %s " SCENARIO "@1-9 " SCENARIO "@11-20 " SCENARIO
                " --method aabb-tree "
                "--budget 60 --until 50%% --real 50%% --out race.json",
                MOTE_PROGRAM, MOTE_PROGRAM);
    assert_non_null(strstr(said, SCENARIO "@11-20/aabb-tree/hot"));
    assert_non_null(strstr(said, SCENARIO "/aabb-tree/hot"));
    char *json = file_text("race.json");
    static const char *const wanted[] = {"\"asked\": \"1-9 distance\"",
                                         "\"asked\": \"11-20 distance\"",
                                         "\"asked\": \"1-60 distance\""};
    for (size_t i = 0; i < ROWS_OF(wanted); ++i)
        assert_int_equal(test_count(json, wanted[i]), 1);
    free(json);
    mote_expect(0, SCENARIO "/aabb-tree/hot",
                "race %s %s " SCENARIO "@1-9 --method aabb-tree "
                "--budget 60 --until 50%% --real 50%%",
                MOTE_PROGRAM, MOTE_PROGRAM);
}
