/* The manifest of a directory that existed before, whatever its file contains. */
#include "harness/process/manifest.h"

#include "harness/base/file.h"
#include "harness/base/record.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <stddef.h>
#include <string.h>
#include <unistd.h>

#define FILE_NAME "manifest.json"

static json_t *write_again(const char *before)
{
    char first[] = "run", second[] = "ww";
    char *argv[] = {first, second, NULL};
    json_t *object = NULL;
    (void)unlink(FILE_NAME);
    if (before)
        file_put(FILE_NAME, before);
    assert_int_equal(mote_manifest_write(".", 0x1234, 7, 2, argv), MOTE_OK);
    assert_int_equal(mote_record_read_json(".", "manifest.json", &object), MOTE_OK);
    return object;
}

TEST(mote_manifest_write_adds_its_session_to_those_before)
{
    static const struct {
        const char *before;
        size_t sessions;
    } cases[] = {{NULL, 1},
                 {"{\"sessions\": [{\"seed\": 3}, {\"seed\": 4}]}\n", 3},
                 {"{\"sessions\": {\"seed\": 3}}\n", 1}, /* not a list: a new one begins */
                 {"{\"sessions\": \"two\"}\n", 1},
                 {"[1, 2]\n", 1},
                 {"{\"sessions\": [", 1}};
    for (size_t k = 0; k < ROWS_OF(cases); ++k) {
        json_t *object = write_again(cases[k].before);
        const json_t *sessions = json_object_get(object, "sessions");
        const size_t count = json_array_size(sessions);
        if (count != cases[k].sessions)
            fail_msg("case %zu: %zu sessions", k, count);
        const json_t *last = json_array_get(sessions, count - 1);
        assert_int_equal(json_integer_value(json_object_get(last, "seed")), 7);
        assert_string_equal(json_string_value(json_object_get(last, "program")),
                            "0000000000001234");
        assert_string_equal(
            json_string_value(json_array_get(json_object_get(last, "command"), 1)), "ww");
        json_decref(object);
    }
}
