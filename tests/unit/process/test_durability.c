/* The state of a run that was stopped, whose parent was killed, or whose disk was removed. */
#define _GNU_SOURCE /* unshare */
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/plain_file.h"
#include "tests/support/program.h"
#include "tests/support/run_files.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>

#define SWEEP                                                                                  \
    "run tt --frames 1-200 --method particle-paper:n=2 --method aabb-tree --replicates 10"
#define SWEEP_CELLS 20
#define SLOW "run tt --frames 1-600 --stride 1 --method brute-force --replicates 5"

static int directories;
static char directory[64], said[64], line[512], text[1 << 14];

static void pause_ms(long ms)
{
    const struct timespec pause = {ms / 1000, ms % 1000 * 1000000};
    (void)nanosleep(&pause, NULL);
}

/* Uses a directory of its own; all share the truth. */
static int use_directory(const char *name)
{
    char truth[160], link[96];
    (void)snprintf(directory, sizeof directory, "%s", name);
    (void)snprintf(truth, sizeof truth, "%s/truth", folder_path());
    (void)snprintf(link, sizeof link, "%s/truth", directory);
    (void)mkdir(truth, 0777);
    (void)mkdir(directory, 0777);
    return symlink(truth, link);
}

static int next_directory(void)
{
    char name[16];
    (void)snprintf(name, sizeof name, "%d", directories);
    (void)snprintf(said, sizeof said, "said-%d", directories++);
    return use_directory(name);
}

static int unmount(void)
{
    (void)umount("disk"); /* if it was mounted */
    return 0;
}

static pid_t start(const char *what)
{
    (void)snprintf(line, sizeof line, "%s --out %s", what, directory);
    return program_start(line, said);
}

static int run(const char *what)
{
    int status = program_wait(start(what));
    program_read(said, text, sizeof text);
    return status;
}

/* Computes the truth, so that from now on a run measures at once. */
static int make_truth(void)
{
    if (next_directory() != 0)
        return -1;
    return run("run tt --frames 1-2 --replicates 1 --method aabb-tree");
}

TEST_GROUP(make_truth, unmount);
TEST_EACH(next_directory, NULL);

/* Waits until some cells are finished. */
static void wait_for_cells(int count)
{
    for (int tries = 0; run_files_count(directory, ".json") < count; ++tries) {
        assert_true(tries < 3000);
        pause_ms(10);
    }
}

/* Waits until a file of the directory exists. */
static void wait_for_file(const char *name)
{
    char path[96];
    (void)snprintf(path, sizeof path, "%s/%s", directory, name);
    for (int tries = 0; !file_exists(path); ++tries) {
        assert_true(tries < 3000);
        pause_ms(10);
    }
}

static void check(run_files *finished)
{
    const char *wrong = run_files_check(directory, 200, finished);
    if (wrong)
        fail_msg("%s: %s", directory, wrong);
}

/* Gets a process's state ('Z': dead, not yet reaped) and parent; false if it is gone. */
static bool look_at(long pid, char *process_state, long *parent)
{
    char path[64], stat[512];
    (void)snprintf(path, sizeof path, "/proc/%ld/stat", pid);
    program_read(path, stat, sizeof stat);
    const char *rest = strrchr(stat, ')');
    if (!rest)
        return false;
    *process_state = rest[2];
    *parent = strtol(rest + 3, NULL, 10);
    return true;
}

/* The measuring process, a child of pid; 0 if there is none. */
static pid_t child_of(pid_t pid)
{
    DIR *folder = opendir("/proc");
    long found = 0, parent;
    char process_state;
    for (const struct dirent *entry = folder ? readdir(folder) : NULL; entry && !found;
         entry = readdir(folder)) {
        long number = strtol(entry->d_name, NULL, 10);
        if (number > 0 && look_at(number, &process_state, &parent) && parent == pid)
            found = number;
    }
    if (folder)
        (void)closedir(folder);
    return (pid_t)found;
}

/* Gone, or a zombie that nobody has reaped. */
static bool is_dead(pid_t pid)
{
    char process_state;
    long parent;
    return !look_at(pid, &process_state, &parent) || process_state == 'Z' ||
           process_state == 'X';
}

/* Stops a sweep in its middle; it must say so, keep what is finished and be resumable. */
static void stopped_by(int signal_number)
{
    pid_t pid = start(SWEEP);
    wait_for_cells(3);
    const pid_t child = child_of(pid);
    assert_int_equal(kill(pid, signal_number), 0);
    assert_int_equal(program_wait(pid), 128 + signal_number);
    assert_true(child == 0 || is_dead(child));
    program_read(said, text, sizeof text);
    assert_non_null(strstr(text, "mote: stopped by a signal; run the same command again"));
    run_files finished = {0};
    check(&finished);
    assert_in_range(finished.count, 3, SWEEP_CELLS - 1);
    assert_int_equal(run_files_count(directory, ".part"), 0);
    assert_int_equal(run(SWEEP), 0);
    check(&finished);
    assert_int_equal(finished.count, SWEEP_CELLS);
    run_files_free(&finished);
}

TEST(run_after_sigterm_keeps_its_cells_and_goes_on)
{
    stopped_by(SIGTERM);
}

TEST(run_after_sigint_keeps_its_cells_and_goes_on)
{
    stopped_by(SIGINT);
}

/* Stops a command once a file of its directory exists: it must say so, and leave no file with
   this ending. */
static void stop_without(pid_t pid, const char *file, int signal_number, const char *ending)
{
    wait_for_file(file);
    assert_int_equal(kill(pid, signal_number), 0);
    assert_int_equal(program_wait(pid), 128 + signal_number);
    program_read(said, text, sizeof text);
    assert_non_null(strstr(text, "stopped by a signal; run the same command again"));
    assert_int_equal(folder_count(directory, ending), 0);
}

/* This and the next would take hours. */
TEST(sequence_after_a_signal_leaves_no_part_of_its_positions)
{
    static const int signals[] = {SIGTERM, SIGINT};
    for (size_t i = 0; i < ROWS_OF(signals); ++i) {
        char part[64];
        const pid_t pid = start("sequence cloth --triangles 800 --frames 100000");
        (void)snprintf(part, sizeof part, "cloth.pc2.%ld.part", (long)pid);
        stop_without(pid, part, signals[i], ".part");
        assert_int_equal(folder_count(directory, ".pc2"), 0);
    }
}

TEST(film_after_a_signal_leaves_no_pictures)
{
    static const int signals[] = {SIGTERM, SIGINT};
    for (size_t i = 0; i < ROWS_OF(signals); ++i) {
        (void)snprintf(line, sizeof line,
                       "simulate tt --method brute-force --steps 1000000 --film %s/g.gif",
                       directory);
        stop_without(program_start(line, said), "g.gif.frames/000.dat", signals[i], ".frames");
    }
}

static pid_t wait_for_child(pid_t pid)
{
    pid_t child = 0;
    for (int tries = 0; tries < 3000 && child == 0; ++tries) {
        pause_ms(10);
        child = child_of(pid);
    }
    return child;
}

TEST(child_of_a_killed_run_dies_with_it)
{
    pid_t pid = start(SLOW);
    wait_for_file("manifest.json"); /* git has answered: children are measuring now */
    pid_t child = wait_for_child(pid);
    assert_true(child > 0);
    assert_false(is_dead(child));
    assert_int_equal(kill(pid, SIGKILL), 0);
    (void)waitpid(pid, NULL, 0);
    for (int tries = 0; tries < 3000 && !is_dead(child); ++tries)
        pause_ms(10); /* a busy disk can delay the end of a process by seconds */
    assert_true(is_dead(child));
}

TEST(run_beside_another_in_one_directory_is_refused)
{
    static const char other[] = "said-other";
    pid_t pid = start(SLOW);
    wait_for_file("manifest.json");
    assert_int_equal(program_wait(program_start(line, other)), 4);
    program_read(other, text, sizeof text);
    assert_non_null(strstr(text, "another run is measuring into it"));
    assert_int_equal(kill(pid, SIGTERM), 0);
    assert_int_equal(program_wait(pid), 128 + SIGTERM);
}

/* Started at the same moment: one measures, and the other says why it does not. */
TEST(runs_started_together_in_one_directory_are_as_one)
{
    static const char other[] = "said-together";
    const pid_t first = start(SWEEP), second = program_start(line, other);
    const int status[2] = {program_wait(first), program_wait(second)};
    assert_true(status[0] == 0 || status[1] == 0);
    for (int k = 0; k < 2; ++k) {
        program_read(k ? other : said, text, sizeof text);
        if (status[k] != 0) {
            assert_int_equal(status[k], 4);
            assert_non_null(strstr(text, "another run is measuring into it"));
        }
    }
    run_files finished = {0};
    check(&finished);
    assert_int_equal(finished.count, SWEEP_CELLS);
    assert_int_equal(run_files_count(directory, ".csv"), SWEEP_CELLS);
    assert_int_equal(run_files_count(directory, ".part"), 0);
    run_files_free(&finished);
}

TEST(run_beyond_the_largest_file_allowed_fails_with_a_message)
{
    const struct rlimit small = {20000, RLIM_INFINITY}, none = {RLIM_INFINITY, RLIM_INFINITY};
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    int status = run(SWEEP);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &none), 0);
    assert_int_equal(status, 5);
    assert_non_null(strstr(text, "cannot be written: File too large"));
    assert_int_equal(run_files_count(directory, ".part"), 0);
}

/* Whether this process may mount: as root, or as root of a user namespace of its own. */
static bool may_mount(void)
{
    char map[64];
    const uid_t uid = getuid();
    const gid_t gid = getgid();
    if (unshare(CLONE_NEWNS) != 0) {
        if (unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0)
            return false;
        (void)snprintf(map, sizeof map, "0 %u 1\n", (unsigned)uid);
        (void)plain_file_put("/proc/self/setgroups", "deny\n");
        if (!plain_file_put("/proc/self/uid_map", map))
            return false;
        (void)snprintf(map, sizeof map, "0 %u 1\n", (unsigned)gid);
        (void)plain_file_put("/proc/self/gid_map", map);
    }
    return mount("none", "/", NULL, MS_REC | MS_PRIVATE, NULL) == 0;
}

/* A file system of 256 kB; false where that is not permitted. */
static bool mount_small_disk(void)
{
    (void)mkdir("disk", 0777);
    return may_mount() && mount("none", "disk", "tmpfs", 0, "size=256k") == 0 &&
           use_directory("disk/run") == 0;
}

static void remount(unsigned long flags, const char *options)
{
    assert_int_equal(mount("none", "disk", "tmpfs", MS_REMOUNT | flags, options), 0);
}

TEST(run_on_a_full_then_read_only_disk_keeps_its_cells)
{
    if (!mount_small_disk())
        skip();
    run_files finished = {0};
    assert_int_equal(run(SWEEP), 5);
    assert_non_null(strstr(text, "No space left on device"));
    check(&finished);
    assert_in_range(finished.count, 1, SWEEP_CELLS - 1);
    assert_int_equal(run_files_count(directory, ".part"), 0);
    remount(MS_RDONLY, "size=256k");
    assert_int_equal(run(SWEEP), 5);
    assert_non_null(strstr(text, "Read-only file system"));
    size_t before = finished.count;
    check(&finished);
    assert_int_equal(finished.count, before);
    remount(0, "size=16m");
    assert_int_equal(run(SWEEP), 0);
    check(&finished);
    assert_int_equal(finished.count, SWEEP_CELLS);
    run_files_free(&finished);
}
