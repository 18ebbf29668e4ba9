/* Children that crash, hang, or write rubbish or too much; confined children; and files that a
   scenario may not name. */
#define _DEFAULT_SOURCE /* symlink */
#include "harness/process/child.h"
#include "harness/process/confine.h"
#include "harness/base/file.h"
#include "harness/process/spawn.h"
#include "harness/scene/fence.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <fcntl.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

static const mote_child_limits limits = {.seconds = 20, .output_bytes = 1 << 16};

static mote_status crash(void *context, int output)
{
    (void)context, (void)output;
    (void)raise(SIGKILL);
    return MOTE_OK;
}

static mote_status leave(void *context, int output)
{
    (void)context, (void)output;
    _exit(7);
}

static mote_status hang(void *context, int output)
{
    (void)context, (void)output;
    while (pause() != 0) {
    }
    return MOTE_OK;
}

static mote_status close_and_hang(void *context, int output)
{
    (void)close(output);
    return hang(context, output);
}

/* Writes as many bytes as the context says, none of them zero, and no answer after them. */
static mote_status say_rubbish(void *context, int output)
{
    char block[4096];
    size_t left = *(const size_t *)context;
    memset(block, 'x', sizeof block);
    while (left > 0) {
        const size_t part = left < sizeof block ? left : sizeof block;
        if (mote_child_put(output, block, part) != MOTE_OK)
            break;
        left -= part;
    }
    _exit(0);
}

TEST(a_process_of_another_parent_is_not_waited_for)
{
    assert_int_equal(mote_spawn_wait(getppid()), -1);
    assert_int_equal(mote_spawn_wait(1 << 30), -1);
}

TEST(run_of_children_that_die_says_how)
{
    char *text = NULL;
    size_t size;
    assert_int_equal(mote_child_run("it", crash, NULL, limits, &text, &size), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "it: crashed: ended by signal 9"));
    assert_int_equal(mote_child_run("it", leave, NULL, limits, &text, &size), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "ended with status 7 and no answer"));
    const mote_child_limits brief = {.seconds = 0.05, .output_bytes = 16};
    assert_int_equal(mote_child_run("it", hang, NULL, brief, &text, &size), MOTE_EIO);
    assert_string_equal(mote_error_text(), "it: took too long");
    assert_null(text);
}

/* As where a plugin closes all files. There was no limit to its time then. */
TEST(run_of_a_child_that_closes_its_output_ends)
{
    const mote_child_limits unlimited = {.output_bytes = 16};
    char *text = NULL;
    size_t size;
    assert_int_equal(mote_child_run("it", close_and_hang, NULL, unlimited, &text, &size),
                     MOTE_EIO);
    assert_string_equal(mote_error_text(), "it: crashed: closed its output and went on");
    assert_null(text);
}

TEST(run_of_children_that_say_rubbish_is_an_error)
{
    const size_t sizes[] = {1, 1027, 1028, 1029, 5000, 1 << 16};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k) {
        size_t wanted = sizes[k], size;
        char *text = NULL;
        assert_int_equal(mote_child_run("it", say_rubbish, &wanted, limits, &text, &size),
                         MOTE_EIO);
        assert_non_null(strstr(mote_error_text(), "no answer"));
        assert_null(text);
    }
    size_t wanted = 1 << 20, size;
    char *text = NULL;
    assert_int_equal(mote_child_run("it", say_rubbish, &wanted, limits, &text, &size),
                     MOTE_EIO);
    assert_string_equal(mote_error_text(), "it: returned more than is allowed");
    mote_child child = {0};
    size_t index;
    assert_int_equal(mote_child_start(say_rubbish, &wanted, limits, &child), MOTE_OK);
    assert_int_equal(mote_child_wait(&child, 1, &index), MOTE_OK);
    assert_int_equal(child.end, MOTE_CHILD_TOO_MUCH);
    assert_string_equal(child.text, "returned more than is allowed");
    mote_child_release(&child);
}

/* The bytes of a successful end, as in child.c: 4 of a status, 1024 of a text. */
enum { LAST_WORDS = 4 + 1024 };

static mote_status say_endless_text(void *context, int output)
{
    (void)context;
    char last[LAST_WORDS] = {0};
    memset(last + 4, 'x', sizeof last - 4);
    (void)mote_child_put(output, last, sizeof last);
    _exit(0);
}

static mote_status say_well_and_fail(void *context, int output)
{
    (void)context;
    static const char last[LAST_WORDS];
    (void)mote_child_put(output, last, sizeof last);
    _exit(3);
}

static mote_status say_nothing(void *context, int output)
{
    (void)context, (void)output;
    return MOTE_OK;
}

TEST(run_of_children_whose_last_words_make_no_sense_is_an_error)
{
    char *text = NULL;
    size_t size;
    static const mote_child_work works[] = {say_endless_text, say_well_and_fail};
    for (int k = 0; k < 2; ++k) {
        assert_int_equal(mote_child_run("it", works[k], NULL, limits, &text, &size), MOTE_EIO);
        assert_string_equal(mote_error_text(),
                            "it: crashed: ended with no answer that can be read");
        assert_null(text);
    }
    assert_int_equal(mote_child_run("it", say_nothing, NULL, limits, NULL, NULL), MOTE_OK);
}

/* When asked to stop, a parent ends its child and says how to resume. Runs in a process of its
   own, because the request is remembered. */
static mote_status wait_and_be_stopped(void *context, int output)
{
    (void)context;
    char *text = NULL;
    size_t size = 0;
    mote_child_heed_signals();
    (void)raise(SIGTERM);
    const mote_status status = mote_child_run("it", hang, NULL, limits, &text, &size);
    const char *said = mote_child_stop_asked() && !text ? mote_error_text() : "not asked";
    (void)mote_child_put(output, said, strlen(said));
    return status == MOTE_EIO ? MOTE_OK : MOTE_EINVAL;
}

TEST(run_of_a_child_when_asked_to_stop_ends_it)
{
    char *text = NULL;
    size_t size = 0;
    assert_int_equal(mote_child_run("it", wait_and_be_stopped, NULL, limits, &text, &size),
                     MOTE_OK);
    static const char says[] = "stopped by a signal; run the same command again to go on";
    assert_int_equal(size, strlen(says));
    assert_memory_equal(text, says, size);
    free(text);
}

TEST(spawn_of_programs_that_fail_says_how)
{
    static const struct {
        const char *argv[4], *directory, *says;
    } cases[] = {
        {{"sh", "-c", "exit 3", NULL}, NULL, "sh: ended with status 3"},
        {{"sh", "-c", "kill -9 $$", NULL}, NULL, "sh: ended with status 137"},
        {{"sh", "-c", "true", NULL}, "/no/such/folder", "sh: cannot be run; is it installed?"},
        {{"no-such-program", NULL}, NULL, "no-such-program: cannot be run; is it installed?"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char said[16] = "?";
        assert_int_equal(mote_spawn(cases[k].argv, cases[k].directory, said, sizeof said),
                         MOTE_EIO);
        assert_string_equal(mote_error_text(), cases[k].says);
        assert_string_equal(said, "");
    }
    const char *const many[] = {"printf", "a line of more than fits\n\n", NULL};
    char said[16];
    assert_int_equal(mote_spawn(many, NULL, said, sizeof said), MOTE_OK);
    assert_string_equal(said, "a line of more ");
    assert_int_equal(mote_spawn((const char *const[]){"sh", "-c", "echo; pwd", NULL}, "/", said,
                                sizeof said),
                     MOTE_OK);
    assert_string_equal(said, "\n/");
}

TEST(spawn_quiet_tells_what_a_program_said_only_where_it_fails)
{
    int ends[2], kept = dup(STDERR_FILENO);
    char shown[64];
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(dup2(ends[1], STDERR_FILENO), STDERR_FILENO);
    const char *const well[] = {"sh", "-c", "echo a warning; echo another >&2", NULL};
    const mote_status status = mote_spawn_quiet(well, NULL);
    assert_int_equal(dup2(kept, STDERR_FILENO), STDERR_FILENO);
    (void)close(kept);
    (void)close(ends[1]);
    assert_int_equal(status, MOTE_OK);
    assert_int_equal(read(ends[0], shown, sizeof shown), 0);
    (void)close(ends[0]);
    const char *const badly[] = {"sh", "-c", "echo line 3:; echo no such column >&2; exit 2",
                                 NULL};
    assert_int_equal(mote_spawn_quiet(badly, NULL), MOTE_EIO);
    assert_string_equal(mote_error_text(), "sh: ended with status 2: line 3: no such column");
}

/* In the C locale gnuplot would warn about every figure. */
TEST(spawn_in_any_locale_is_in_utf_8)
{
    const char *user = getenv("LC_ALL");
    char *kept = user ? mote_format("%s", user) : NULL;
    assert_int_equal(setenv("LC_ALL", "C", 1), 0);
    char said[256];
    assert_int_equal(mote_spawn((const char *const[]){"sh", "-c",
                                                      "gnuplot -e 'set encoding utf8' 2>&1 && "
                                                      "locale charmap",
                                                      NULL},
                                NULL, said, sizeof said),
                     MOTE_OK);
    assert_string_equal(said, "UTF-8");
    assert_string_equal(getenv("LC_ALL"), "C");
    assert_int_equal(kept ? setenv("LC_ALL", kept, 1) : unsetenv("LC_ALL"), 0);
    free(kept);
}

typedef struct attempts {
    bool landlock, privileges, wrote, opened, made, removed, renamed;
} attempts;

static mote_status attempt(void *context, int output)
{
    const char *kept = context;
    char other[128];
    (void)snprintf(other, sizeof other, "%s-other", kept);
    attempts a;
    memset(&a, 0, sizeof a);
    a.landlock = mote_confine(); /* again: reports whether there is Landlock */
    a.privileges = prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) != 1;
    const int made = open(other, O_CREAT | O_WRONLY, 0600);
    a.made = made >= 0;
    a.wrote = made >= 0 && write(made, "x", 1) == 1;
    const int file = open(kept, O_WRONLY);
    a.opened = file >= 0;
    a.wrote =
        a.wrote || (file >= 0 && lseek(file, 0, SEEK_END) >= 0 && write(file, "x", 1) == 1);
    if (a.landlock) {
        a.renamed = rename(kept, other) == 0;
        a.removed = remove(kept) == 0;
    }
    char byte;
    const int read_only = open(kept, O_RDONLY);
    if (read_only < 0 || read(read_only, &byte, 1) != 1)
        return mote_fail(MOTE_EIO, "%s cannot be read any more", kept);
    return mote_child_put(output, &a, sizeof a);
}

TEST(run_of_a_confined_child_changes_no_file)
{
    char path[160];
    (void)snprintf(path, sizeof path, "%s/kept", folder_path());
    file_put(path, "kept");
    mote_child_limits confined = limits;
    confined.confined = true;
    char *output = NULL;
    size_t size;
    if (mote_child_run("it", attempt, path, confined, &output, &size) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    attempts a;
    assert_int_equal(size, sizeof a);
    memcpy(&a, output, sizeof a);
    free(output);
    assert_false(a.privileges);
    assert_false(a.wrote);
    if (a.landlock)
        assert_false(a.made || a.opened || a.removed || a.renamed);
    char *text = file_text(path);
    assert_string_equal(text, "kept");
    free(text);
}

static mote_status check(const char *scenario, const char *file)
{
    char from[256], to[256];
    (void)snprintf(from, sizeof from, "%s/%s", folder_path(), scenario);
    (void)snprintf(to, sizeof to, "%s/%s", folder_path(), file);
    return mote_fence_check(from, to);
}

TEST(reach_check_of_files_outside_is_an_error_until_allowed)
{
    char inner[160], outside[160], link[160];
    (void)snprintf(inner, sizeof inner, "%s/inner", folder_path());
    (void)snprintf(outside, sizeof outside, "%s/outside.obj", folder_path());
    (void)snprintf(link, sizeof link, "%s/inner/link.obj", folder_path());
    file_put("inner/a.json", "v 0 0 0\n");
    file_put("inner/mesh.obj", "v 0 0 0\n");
    file_put("outside.obj", "v 0 0 0\n");
    assert_int_equal(symlink(outside, link), 0);
    assert_int_equal(check("inner/a.json", "inner/mesh.obj"), MOTE_OK);
    assert_int_equal(check("inner/a.json", "inner/../inner/mesh.obj"), MOTE_OK);
    assert_int_equal(check("a.json", "inner/mesh.obj"), MOTE_OK);
    assert_int_equal(check("inner/a.json", "inner/none.obj"), MOTE_OK);
    assert_int_equal(check("inner/a.json", "inner/../outside.obj"), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "--allow DIR"));
    /* The owner of the folder made the link, so it is allowed; a path that leads up counts by
       its target. */
    assert_int_equal(check("inner/a.json", "inner/link.obj"), MOTE_OK);
    assert_int_equal(check("inner/a.json", "inner/../inner/link.obj"), MOTE_EINVAL);
    assert_int_equal(mote_fence_check(inner, "/etc/passwd"), MOTE_EINVAL);
    assert_int_equal(mote_fence_check(inner, MOTE_SOURCE_DIR "/datasets/meshes/box.obj"),
                     MOTE_OK);
    assert_int_equal(mote_fence_allow("/nowhere/at/all"), MOTE_EIO);
    assert_int_equal(mote_fence_allow(folder_path()), MOTE_OK);
    assert_int_equal(check("inner/a.json", "inner/../outside.obj"), MOTE_OK);
    assert_int_equal(check("inner/a.json", "inner/link.obj"), MOTE_OK);
    assert_int_equal(mote_fence_check(inner, "/etc/passwd"), MOTE_EINVAL);
    assert_int_equal(mote_fence_check("/nowhere/at/all/a.json", "/etc/passwd"), MOTE_EINVAL);
    /* At most sixteen, and folder was one of them. */
    for (int k = 1; k < 16; ++k)
        assert_int_equal(mote_fence_allow(inner), MOTE_OK);
    assert_int_equal(mote_fence_allow(inner), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "16 folders are allowed at most"));
    assert_int_equal(mote_fence_check("/a.json", "/etc/passwd"), MOTE_OK);
}
