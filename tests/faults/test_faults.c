/* Makes the n-th allocation, write, sync or rename fail, for every n: there must be an error
   with a text, nothing leaked (under AddressSanitizer), nothing half-written (--wrap, as in
   tests/faults/failing.h). */
#include "core/method/method.h"
#include "harness/base/file.h"
#include "harness/base/method_choice.h"
#include "tests/faults/failing.h"
#include "tests/support/folder.h"
#include "tests/support/shapes.h"
#include "tests/support/test.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

/* Calls left before one fails; negative: none fails. */
static long writes_left = -1;
static int sync_error = EIO;

ssize_t __real_write(int file, const void *data, size_t size);
int __real_fsync(int file);
int __real_rename(const char *from, const char *to);
int __real_close(int file);
ssize_t __wrap_write(int file, const void *data, size_t size);
int __wrap_fsync(int file);
int __wrap_rename(const char *from, const char *to);
int __wrap_close(int file);

ssize_t __wrap_write(int file, const void *data, size_t size)
{
    if (is_due(&writes_left)) {
        errno = ENOSPC;
        return -1;
    }
    return __real_write(file, data, size);
}

int __wrap_fsync(int file)
{
    if (is_due(&writes_left)) {
        errno = sync_error;
        return -1;
    }
    return __real_fsync(file);
}

int __wrap_rename(const char *from, const char *to)
{
    if (is_due(&writes_left)) {
        errno = EIO;
        return -1;
    }
    return __real_rename(from, to);
}

/* Of a file that was written to; the file is closed all the same. */
int __wrap_close(int file)
{
    const bool written = (fcntl(file, F_GETFL) & O_ACCMODE) != O_RDONLY;
    const int closed = __real_close(file);
    if (!written || !is_due(&writes_left))
        return closed;
    errno = EDQUOT;
    return -1;
}

typedef struct method_work {
    scene *scene;
    mote_method_choice choice;
    mote_answer answer; /* when nothing fails */
} method_work;

static mote_status answer_twice(const method_work *w, mote_answer *answer)
{
    const mote_method *method = w->choice.method;
    const mote_setup setup = scene_setup(w->scene, MOTE_ASK_DISTANCE, 0, w->choice.values);
    void *state = NULL;
    mote_status status = mote_method_create(method, &setup, &state);
    if (status != MOTE_OK)
        return status;
    for (int k = 0; k < 2 && status == MOTE_OK; ++k) {
        status = method->update ? method->update(state, &w->scene->frame) : MOTE_OK;
        if (status == MOTE_OK)
            status = method->query(state, &w->scene->frame, answer);
    }
    mote_method_destroy(method, state);
    return status;
}

/* Succeeds only with the same answer as when nothing fails. */
static mote_status answer_again(void *context)
{
    const method_work *w = context;
    mote_answer answer;
    const mote_status status = answer_twice(w, &answer);
    if (status == MOTE_OK)
        assert_true(answer.distance == w->answer.distance);
    return status;
}

TEST(method_when_an_allocation_fails_says_so)
{
    static const char *const names[] = {
        "certified",          "certified:seed=tracked",           "particle:n=8",
        "particle-paper:n=5", "particle-paper:n=8,far_cache=0.1", "aabb-tree",
        "brute-force"};
    scene s;
    scene_init(&s, 8, 6, 1.1, true);
    scene_next(&s, 1.2, false);
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        method_work work = {.scene = &s};
        assert_int_equal(mote_method_choice_read(names[k], &work.choice), MOTE_OK);
        assert_int_equal(answer_twice(&work, &work.answer), MOTE_OK);
        fail_each_allocation(answer_again, &work, names[k]);
    }
    scene_free(&s);
}

static mote_status make_mesh(void *context)
{
    const mote_mesh *like = context;
    mote_mesh *mesh = NULL;
    const mote_status status =
        mote_mesh_create(&like->positions[0].x, like->vertex_count, &like->triangles[0][0],
                         like->triangle_count, &mesh);
    mote_mesh_destroy(mesh);
    return status;
}

TEST(mesh_create_when_an_allocation_fails_says_so)
{
    mote_mesh *like = make_torus(5, 4, 1);
    fail_each_allocation(make_mesh, like, "mote_mesh_create");
    mote_mesh_destroy(like);
}

TEST(file_read_of_more_than_the_limit_says_both)
{
    static const char path[] = "./file";
    char *text = NULL;
    size_t size = 77;
    assert_int_equal(mote_file_write(path, "12345", 5), MOTE_OK);
    assert_int_equal(mote_file_read(path, 4, &text, &size), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), path));
    assert_non_null(strstr(mote_error_text(), "5"));
    assert_non_null(strstr(mote_error_text(), "4"));
    assert_null(text);
    assert_int_equal(size, 77);
    assert_int_equal(mote_file_read(path, 5, &text, &size), MOTE_OK);
    assert_string_equal(text, "12345");
    free(text);
    assert_int_equal(remove(path), 0);
}

TEST(directory_make_of_what_cannot_be_one_says_so)
{
    assert_int_equal(mote_directory_make(""), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "name a directory that can be written to"));
    assert_int_equal(mote_file_write("file", "12345", 5), MOTE_OK);
    assert_int_equal(mote_directory_make("./file/a/b/c"), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "/file: cannot be made: Not a directory"));
    assert_int_equal(remove("file"), 0);
}

TEST(file_write_when_a_step_fails_leaves_the_file_whole)
{
    static const char path[] = "file";
    char beside[32];
    (void)snprintf(beside, sizeof beside, "%s.%ld.part", path, (long)getpid());
    assert_int_equal(mote_file_write(path, "old", 3), MOTE_OK);
    for (long n = 0;; ++n) {
        writes_left = n;
        const mote_status status = mote_file_write(path, "new!", 4);
        const bool failed = writes_left < 0;
        writes_left = never;
        assert_false(file_exists(beside));
        char *text = NULL;
        size_t size;
        assert_int_equal(mote_file_read(path, 100, &text, &size), MOTE_OK);
        assert_true(strcmp(text, "old") == 0 || strcmp(text, "new!") == 0);
        if (!failed)
            assert_string_equal(text, "new!");
        free(text);
        assert_int_equal(status, failed ? MOTE_EIO : MOTE_OK);
        if (!failed) {
            assert_int_equal(n, 5); /* write, fsync, close, rename, fsync of the directory */
            break;
        }
    }
    assert_int_equal(remove(path), 0);
}

TEST(file_write_tells_to_make_room_where_that_would_help)
{
    static const struct {
        long call;
        const char *says;
    } rows[] = {
        {0, "No space left on device; make room, or name a file elsewhere"},
        {1, "Input/output error; name a file in a folder that exists and can be written to"},
        {2, "Disk quota exceeded; make room, or name a file elsewhere"}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        writes_left = rows[i].call;
        assert_int_equal(mote_file_write("file", "new", 3), MOTE_EIO);
        writes_left = never;
        assert_non_null(strstr(mote_error_text(), rows[i].says));
        assert_false(file_exists("file"));
    }
}

/* Some file systems cannot sync a directory. */
TEST(file_write_where_directories_cannot_be_synced_is_done)
{
    sync_error = EINVAL;
    writes_left = 4;
    assert_int_equal(mote_file_write("file", "new", 3), MOTE_OK);
    assert_true(writes_left < 0);
    sync_error = EIO;
    assert_int_equal(remove("file"), 0);
}

TEST(file_write_to_a_stream_tells_what_failed)
{
    static const char *const says[] = {"fifo: cannot be written: No space left on device",
                                       "fifo: cannot be written: Disk quota exceeded"};
    assert_int_equal(mkfifo("fifo", 0600), 0);
    const int reader = open("fifo", O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    assert_true(reader >= 0);
    for (long n = 0; n < 3; ++n) {
        writes_left = n;
        assert_int_equal(mote_file_write("fifo", "x", 1), n < 2 ? MOTE_EIO : MOTE_OK);
        assert_int_equal(writes_left < 0, n < 2);
        writes_left = never;
        if (n < 2)
            assert_non_null(strstr(mote_error_text(), says[n]));
    }
    assert_int_equal(close(reader), 0);
    assert_int_equal(remove("fifo"), 0);
}

/* make reliability PLANT=1 plants this leak, which AddressSanitizer must find. */
static void plant_leak(void)
{
    volatile char *lost = __real_malloc(16);
    if (lost)
        lost[0] = 1;
}

static int plant(void)
{
    if (getenv("MOTE_PLANT_LEAK"))
        plant_leak();
    return 0;
}

static int tell_calls(void)
{
    printf("%ld calls failed\n", calls_failed);
    (void)fflush(stdout); /* LeakSanitizer ends the process without flushing */
    return 0;
}

TEST_GROUP(plant, tell_calls);
