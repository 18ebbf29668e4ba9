/* Files that are shorter than they say, or larger than a limit, and streams. */
#include "harness/base/file.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* A file of the kernel says that it has a page, and has less. */
TEST(file_that_is_shorter_than_it_says_is_read_as_it_is)
{
    static const char path[] = "/sys/kernel/mm/transparent_hugepage/enabled";
    struct stat info;
    char *text = NULL;
    size_t size = 0;
    if (stat(path, &info) != 0)
        skip();
    assert_int_equal(mote_file_read(path, 1 << 20, &text, &size), MOTE_OK);
    assert_int_equal(strlen(text), size);
    assert_true(size > 0 && size < (size_t)info.st_size);
    free(text);
}

TEST(file_beyond_the_limit_of_a_process_is_not_written)
{
    struct rlimit before, limit;
    static const char data[1000] = "x";
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    limit = (struct rlimit){100, before.rlim_max};
    void (*const was)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    const mote_status status = mote_file_write("large", data, sizeof data);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    (void)signal(SIGXFSZ, was);
    assert_int_equal(status, MOTE_EIO);
    assert_non_null(
        strstr(mote_error_text(), "large: cannot be written: File too large; make"));
    assert_false(file_exists("large"));
    assert_int_equal(folder_count(".", ".part"), 0);
}

TEST(folder_is_no_stream_and_no_file)
{
    assert_false(mote_path_is_stream("."));
    assert_false(mote_path_is_stream("none"));
    assert_true(mote_path_is_stream("/dev/null"));
    assert_int_equal(mote_stream_open("none"), -1);
    assert_int_equal(mote_file_write(".", "x", 1), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), ".: cannot be written: "));
    assert_false(mote_path_is_output("none"));
}

/* What goes to the file of standard error goes after what is there already. */
TEST(file_of_standard_error_is_a_stream)
{
    const int kept = dup(STDERR_FILENO), out = open("told", O_WRONLY | O_CREAT, 0600);
    (void)fflush(stderr);
    assert_true(kept >= 0 && out >= 0 && dup2(out, STDERR_FILENO) >= 0);
    (void)fprintf(stderr, "first\n");
    const bool is_stream = mote_path_is_stream("told"), is_output = mote_path_is_output("told");
    const mote_status status = mote_file_write("told", "second\n", 7);
    assert_true(dup2(kept, STDERR_FILENO) >= 0);
    assert_int_equal(close(kept) + close(out), 0);
    assert_true(is_stream && !is_output);
    assert_int_equal(status, MOTE_OK);
    char *text = file_text("told");
    assert_string_equal(text, "first\nsecond\n");
    free(text);
}
