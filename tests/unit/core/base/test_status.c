/* Status codes and the remembered text. */
#include "core/base/status.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

TEST(status_text_every_code_is_its_own_phrase)
{
    const char *phrase[] = {"done",          "invalid input",
                            "out of memory", "input or output failed",
                            "not supported", "numerical failure"};
    for (int code = 0; code < 6; ++code)
        assert_string_equal(mote_status_text((mote_status)code), phrase[code]);
    assert_string_equal(mote_status_text((mote_status)6), "unknown status");
}

TEST(fail_formats_text_and_returns_its_status)
{
    const mote_status status = mote_fail(MOTE_EIO, "%s:%d: %c", "a.obj", 17, 'x');
    assert_int_equal(status, MOTE_EIO);
    assert_string_equal(mote_error_text(), "a.obj:17: x");
}

TEST(fail_with_its_own_text_as_argument_keeps_it)
{
    mote_fail(MOTE_EINVAL, "index 9 is out of range");
    assert_int_equal(mote_fail(MOTE_EINVAL, "a.obj: %s", mote_error_text()), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "a.obj: index 9 is out of range");
}

TEST(fail_text_longer_than_1023_bytes_is_cut)
{
    char text[3000];
    memset(text, 'a', sizeof text);
    text[sizeof text - 1] = '\0';
    for (size_t length = 1021; length <= 1026; ++length) {
        text[length] = '\0';
        mote_fail(MOTE_EINVAL, "%s", text);
        const size_t kept = length < 1023 ? length : 1023;
        assert_int_equal(strlen(mote_error_text()), kept);
        assert_memory_equal(mote_error_text(), text, kept);
        text[length] = 'a';
    }
}

static void *fail_elsewhere(void *argument)
{
    const int empty_at_first = mote_error_text()[0] == '\0';
    mote_fail(MOTE_ENUMERIC, "text of the other thread");
    return empty_at_first && strcmp(mote_error_text(), "text of the other thread") == 0
               ? argument
               : NULL;
}

TEST(error_text_of_each_thread_is_its_own)
{
    mote_fail(MOTE_EINVAL, "text of this thread");
    pthread_t thread;
    int mark = 0;
    void *result = NULL;
    assert_int_equal(pthread_create(&thread, NULL, fail_elsewhere, &mark), 0);
    assert_int_equal(pthread_join(thread, &result), 0);
    assert_ptr_equal(result, &mark);
    assert_string_equal(mote_error_text(), "text of this thread");
}
