/* JSON files as users write them: errors name file, line and place. Also how mote prints
   JSON. */
#include "harness/base/file.h"
#include "harness/base/json_print.h"
#include "harness/base/json_read.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char path[] = "j.json";

static int make_file(void)
{
    file_put(path, "{\"number\": 2.5,\n\"far\": 1e300, \"whole\": 7,\n"
                   "\"text\": \"a \\\"b\\\"\", \"empty\": \"\",\n"
                   "\"list\": [1,\n2, \"three\"], \"none\": null,\n"
                   "\"inner\": {\"num\": 1, \"number\": 2,\n\"nu\": 3}}\n");
    return 0;
}

TEST_GROUP(make_file, NULL);

/* Reads a member of the file in some way. */
typedef mote_status (*reader)(const mote_json *node);

static mote_status as_object(const mote_json *node)
{
    return mote_json_object(node, "numbers|number|num");
}

static mote_status as_pair(const mote_json *node)
{
    size_t size;
    return mote_json_array(node, 2, 2, &size);
}

static mote_status as_few(const mote_json *node)
{
    size_t size;
    return mote_json_array(node, 4, 9, &size);
}

static mote_status as_one_or_two(const mote_json *node)
{
    size_t size;
    return mote_json_array(node, 1, 2, &size);
}

static mote_status as_real(const mote_json *node)
{
    double value;
    return mote_json_real(node, 3, 1e9, &value);
}

static mote_status as_integer(const mote_json *node)
{
    int64_t value;
    return mote_json_integer(node, 8, 9, &value);
}

static mote_status as_vector(const mote_json *node)
{
    mote_vec3 value;
    return mote_json_vec3(node, 0, 5, &value);
}

static mote_status as_either(const mote_json *node)
{
    mote_vec3 value;
    return mote_json_number_or_vec3(node, 0, 2, &value);
}

static mote_status as_boolean(const mote_json *node)
{
    bool value;
    return mote_json_boolean(node, &value);
}

static mote_status as_string(const mote_json *node)
{
    const char *value;
    return mote_json_string(node, &value);
}

TEST(json_of_another_kind_is_refused_by_line_and_place)
{
    static const struct {
        const char *key;
        reader read;
        const char *says; /* after the file's name */
    } cases[] = {
        {"inner", as_object, ":7: inner.nu: unknown key; known here are numbers|number|num"},
        {"list", as_object, ":4: list: is an array of 3; give an object {...} with keys of "},
        {"absent", as_object, ":1: absent: is missing; give an object"},
        {"list", as_pair, ":4: list: is an array of 3; give an array of 2"},
        {"absent", as_pair, ":1: absent: is missing; give an array of 2"},
        {"inner", as_pair, ":6: inner: is an object; give an array of 2"},
        {"list", as_few, ":4: list: is an array of 3; give an array of 4 to 9"},
        {"list", as_one_or_two, ":4: list: is an array of 3; give an array of 1 to 2"},
        {"absent", as_few, ":1: absent: is missing; give an array of 4 to 9"},
        {"number", as_real, ":1: number: 2.5 is out of range; give a number from 3"},
        {"far", as_real, " is out of range; give a number from 3 to 1e+09"},
        {"text", as_real, ":3: text: is a string; give a number from 3"},
        {"none", as_real, ":5: none: is null; give a number from 3"},
        {"absent", as_real, ":1: absent: is missing; give a number from 3"},
        {"number", as_integer, ":1: number: is 2.5; give a whole number from 8"},
        {"whole", as_integer, ":2: whole: 7 is out of range; give 8 to 9"},
        {"absent", as_integer, ":1: absent: is missing; give a whole number"},
        {"text", as_either, ":3: text: is a string; give a number or an array of 3"},
        {"none", as_either, ":5: none: is null; give a number or an array of 3"},
        {"number", as_either, ":1: number: 2.5 is out of range; give a number from 0 to 2"},
        {"list", as_either, ":5: list[2]: is a string; give a number from 0 to 2"},
        {"whole", as_boolean, ":2: whole: is 7; give true or false"},
        {"none", as_boolean, ":5: none: is null; give true or false"},
        {"list", as_vector, ":5: list[2]: is a string; give a number from 0"},
        {"number", as_vector, ":1: number: is 2.5; give an array of 3"},
        {"whole", as_string, ":2: whole: is 7; give a string"},
        {"empty", as_string, ":3: empty: is an empty string; give one that is not empty"},
        {"absent", as_string, ":1: absent: is missing; give a string"}};
    mote_json_file file;
    assert_int_equal(mote_json_open(path, &file), MOTE_OK);
    const mote_json root = mote_json_root(&file);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const mote_json node = mote_json_member(&root, cases[i].key);
        const mote_status status = cases[i].read(&node);
        const char *error = mote_error_text();
        if (status != MOTE_EINVAL || strncmp(error, path, strlen(path)) != 0 ||
            !strstr(error, cases[i].says))
            fail_msg("%s: not \"%s\" but \"%s\"", cases[i].key, cases[i].says, error);
    }
    const mote_json number = mote_json_member(&root, "number");
    const mote_json text = mote_json_member(&root, "text");
    double value;
    const char *string;
    assert_int_equal(mote_json_real(&number, 0, 5, &value), MOTE_OK);
    assert_true(value == 2.5);
    assert_int_equal(mote_json_string(&text, &string), MOTE_OK);
    assert_string_equal(string, "a \"b\"");
    mote_json_close(&file);
}

TEST(json_after_a_byte_order_mark_is_read_and_keeps_its_lines)
{
    static const char marked[] = "\xef\xbb\xbf{\"one\": 1,\n\"two\": \"text\"}\n";
    static const char cut[] = "\xef\xbb\xbf{\"one\"\n}";
    static const char marked_path[] = "j-marked";
    mote_json_file file;
    double value;
    file_put(marked_path, marked);
    if (mote_json_open(marked_path, &file) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    const mote_json root = mote_json_root(&file), one = mote_json_member(&root, "one"),
                    two = mote_json_member(&root, "two");
    assert_int_equal(mote_json_real(&one, 0, 5, &value), MOTE_OK);
    assert_int_equal(mote_json_real(&two, 0, 5, &value), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), ":2: two: is a string; give a number"));
    mote_json_close(&file);
    file_put(marked_path, cut);
    assert_int_equal(mote_json_open(marked_path, &file), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "-marked:2:1: "));
}

/* The line is meant for valid texts; in one that is cut off anywhere it must still be within
   the text. */
TEST(json_line_of_a_cut_text_is_within_it)
{
    static const char text[] =
        "{\"a\\\"\\\\\": [1, [2,\n{\"b\": 3}], 4],\n\"c\": {\"d\": \"]}\",\n"
        "\"e\": [[], {}, -5]}}\n";
    static const struct {
        const char *place;
        int line;
    } cases[] = {{"", 1},      {"c", 3},     {"c.d", 3},  {"c.e", 4},      {"c.e[2]", 4},
                 {"c.e[9", 4}, {"c.x.y", 3}, {"c[0]", 3}, {"c.e[1].z", 4}, {"c.d.e", 3}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const char *place = cases[i].place;
        if (mote_json_line(text, place) != cases[i].line)
            fail_msg("%s: in line %d, not %d", place, mote_json_line(text, place),
                     cases[i].line);
        for (size_t size = 0; size < strlen(text); ++size) {
            char *cut = malloc(size + 1);
            assert_non_null(cut);
            memcpy(cut, text, size);
            cut[size] = '\0';
            int lines = 1;
            for (const char *c = cut; *c; ++c)
                lines += *c == '\n';
            const int line = mote_json_line(cut, place);
            assert_true(line >= 1 && line <= lines);
            free(cut);
        }
    }
}

/* Printed JSON has the same value, in lines of at most 96 characters except for long
   strings. */
TEST(json_print_of_any_value_is_read_back)
{
#define TWENTY "12345678901234567890"
#define HUNDRED TWENTY TWENTY TWENTY TWENTY TWENTY
    static const char *const texts[] = {
        "[]", "{}", "[1, 2]",
        "{\"a\": {\"b\": [" TWENTY ".5, " TWENTY ".5, " TWENTY ".5, " TWENTY ".5, 1]}, \"c\": "
        "[]}",
        "[{\"key\": \"" HUNDRED "\"}, [\"" HUNDRED "\", true, false, null]]"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        json_t *value = json_loads(texts[i], JSON_DECODE_ANY, NULL);
        assert_non_null(value);
        mote_text printed = {0};
        mote_json_print(value, 17, &printed);
        for (const char *line = printed.data; *line; line = strchr(line, '\n') + 1)
            assert_true(strcspn(line, "\n") <= 96 || strstr(line, HUNDRED));
        json_t *again = json_loads(printed.data, JSON_DECODE_ANY, NULL);
        if (!json_equal(value, again))
            fail_msg("%s is printed as\n%s", texts[i], printed.data);
        json_decref(again);
        json_decref(value);
        free(printed.data);
    }
}

/* 2.0 and 2e3 are whole numbers, as in JSON Schema; up to 2^53, where doubles begin to leave
   some out. */
TEST(json_whole_number_may_be_written_with_a_point)
{
    static const struct {
        const char *text;
        int64_t value; /* 0: refused */
    } rows[] = {{"7", 7},
                {"7.0", 7},
                {"-2e3", -2000},
                {"9007199254740992.0", INT64_C(1) << 53},
                {"9007199254740994.0", 0},
                {"1e300", 0},
                {"7.5", 0},
                {"true", 0}};
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_json_file file;
        char text[64];
        int64_t value = 0;
        test_row("%s", rows[i].text);
        (void)snprintf(text, sizeof text, "{\"n\": %s}", rows[i].text);
        file_put("n.json", text);
        assert_int_equal(mote_json_open("n.json", &file), MOTE_OK);
        const mote_json root = mote_json_root(&file), node = mote_json_member(&root, "n");
        assert_int_equal(mote_json_integer(&node, INT64_MIN, INT64_MAX, &value),
                         rows[i].value ? MOTE_OK : MOTE_EINVAL);
        assert_true(value == rows[i].value);
        mote_json_close(&file);
    }
}
