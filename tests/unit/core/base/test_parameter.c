/* The parser of parameters: values, defaults, every error text, and the way back to text. */
#include "core/base/parameter.h"

#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <float.h>
#include <stdio.h>

enum { N, RADIUS, LAW, STEPS, SHARE, COUNT };

static const mote_parameter table[COUNT] = {
    {"n", MOTE_PARAMETER_INTEGER, 1, 1000, NULL, "5", "particles"},
    {"reff", MOTE_PARAMETER_REAL, 0, HUGE_VAL, "auto", "auto", "radius"},
    {"law", MOTE_PARAMETER_CHOICE, 0, 0, "log|inverse|inverse-square", "inverse", "law"},
    {"nmax", MOTE_PARAMETER_INTEGER, 0, 1e9, "auto", "auto", "steps"},
    {"share", MOTE_PARAMETER_REAL, 0.25, 0.75, NULL, "0.5", "share"},
};

static void defaults(double values[COUNT])
{
    memset(values, 0xff, COUNT * sizeof *values);
    mote_parameters_default(table, COUNT, values);
}

static void parse(const char *text, double values[COUNT])
{
    defaults(values);
    if (mote_parameters_parse(table, COUNT, text, values) != MOTE_OK)
        fail_msg("%s", mote_error_text());
}

TEST(default_values_are_those_of_the_table)
{
    double values[COUNT];
    defaults(values);
    assert_true(values[N] == 5);
    assert_true(values[RADIUS] == MOTE_AUTO);
    assert_true(values[LAW] == 1);
    assert_true(values[STEPS] == MOTE_AUTO);
    assert_true(values[SHARE] == 0.5);
}

TEST(parse_of_empty_text_keeps_the_values)
{
    double values[COUNT] = {1, 2, 0, 3, 0.25};
    const double before[COUNT] = {1, 2, 0, 3, 0.25};
    assert_int_equal(mote_parameters_parse(table, COUNT, "", values), MOTE_OK);
    assert_memory_equal(values, before, sizeof values);
    assert_int_equal(mote_parameters_parse(NULL, 0, "", values), MOTE_OK);
}

TEST(parse_sets_what_is_named_and_nothing_else)
{
    double values[COUNT];
    parse("reff=2.5,law=inverse-square,n=17", values);
    assert_true(values[N] == 17 && values[RADIUS] == 2.5 && values[LAW] == 2);
    assert_true(values[STEPS] == MOTE_AUTO && values[SHARE] == 0.5);
    parse("n=1e3,nmax=12", values);
    assert_true(values[N] == 1000 && values[STEPS] == 12 && values[LAW] == 1);
}

TEST(parse_takes_both_ends_of_a_range)
{
    double values[COUNT];
    parse("n=1,share=0.25,reff=0,nmax=0", values);
    assert_true(values[N] == 1 && values[SHARE] == 0.25 && values[RADIUS] == 0 &&
                values[STEPS] == 0);
    parse("n=1000,share=0.75,reff=inf,nmax=1e9", values);
    assert_true(values[N] == 1000 && values[SHARE] == 0.75 && isinf(values[RADIUS]) &&
                values[STEPS] == 1e9);
    parse("reff=auto,nmax=auto", values);
    assert_true(values[RADIUS] == MOTE_AUTO && values[STEPS] == MOTE_AUTO);
}

TEST(parse_takes_every_choice)
{
    const char *text[] = {"law=log", "law=inverse", "law=inverse-square"};
    for (int k = 0; k < 3; ++k) {
        double values[COUNT];
        parse(text[k], values);
        assert_true(values[LAW] == k);
    }
}

/* Expects MOTE_EINVAL with this text and values as they were. */
static void expect_error(const char *text, const char *message)
{
    double values[COUNT] = {2, 3, 0, 4, 0.3};
    const double before[COUNT] = {2, 3, 0, 4, 0.3};
    assert_int_equal(mote_parameters_parse(table, COUNT, text, values), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), message);
    assert_memory_equal(values, before, sizeof values);
}

/* Expects the message "KEY=VALUE is not valid; KEY must be RANGE". */
static void expect_bad_value(const char *item, const char *range)
{
    char message[400];
    (void)snprintf(message, sizeof message, "%s is not valid; %.*s must be %s", item,
                   (int)strcspn(item, "="), item, range);
    expect_error(item, message);
}

TEST(parse_of_a_bad_whole_number_says_the_range)
{
    const char *bad[] = {"n=",    "n=0",   "n=1001",  "n=-1",  "n=2.5",
                         "n=abc", "n=5x",  "n= 5",    "n=5 ",  "n=auto",
                         "n=inf", "n=nan", "n=1e400", "n=5=6", "n=--5"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k)
        expect_bad_value(bad[k], "a whole number from 1 to 1000");
    expect_bad_value("nmax=1e10", "a whole number from 0 to 1000000000, or auto");
    expect_bad_value("nmax=-1", "a whole number from 0 to 1000000000, or auto");
    expect_bad_value("nmax=AUTO", "a whole number from 0 to 1000000000, or auto");
}

TEST(parse_of_a_bad_number_says_the_range)
{
    const char *bad[] = {"share=",     "share=0.2499999999999999",
                         "share=0.76", "share=nan",
                         "share=auto", "share=inf",
                         "share=half", "share=\t0.5"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k)
        expect_bad_value(bad[k], "a number from 0.25 to 0.75");
    const char *radius[] = {"reff=-0.1", "reff=-inf", "reff=nan", "reff=-1", "reff=1e400"};
    for (size_t k = 0; k < sizeof radius / sizeof *radius; ++k)
        expect_bad_value(radius[k], "a number from 0 to inf, or auto");
}

TEST(parse_of_a_whole_number_beyond_doubles_is_an_error)
{
    const mote_parameter open = {"seed", MOTE_PARAMETER_INTEGER, 0, HUGE_VAL, NULL,
                                 "1",    "any whole number"};
    double value = 7;
    assert_int_equal(mote_parameters_parse(&open, 1, "seed=9007199254740992", &value), MOTE_OK);
    assert_true(value == 0x1p53);
    assert_int_equal(mote_parameters_parse(&open, 1, "seed=1e16", &value), MOTE_EINVAL);
    assert_int_equal(mote_parameters_parse(&open, 1, "seed=inf", &value), MOTE_EINVAL);
    assert_true(value == 0x1p53);
}

TEST(parse_of_a_bad_choice_lists_the_choices)
{
    const char *bad[] = {"law=",           "law=lo", "law=logs", "law=log|inverse",
                         "law=inverse-sq", "law=0",  "law=LOG",  "law=auto"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k)
        expect_bad_value(bad[k], "one of log|inverse|inverse-square");
}

TEST(parse_of_a_very_long_value_is_an_error)
{
    char text[200] = "share=0.5";
    memset(text + strlen(text), '0', 100);
    expect_bad_value(text, "a number from 0.25 to 0.75");
}

TEST(parse_of_an_unknown_key_lists_the_keys)
{
    expect_error("m=3", "unknown key \"m\"; the keys are n, reff, law, nmax, share");
    expect_error("n=3,nn=4", "unknown key \"nn\"; the keys are n, reff, law, nmax, share");
    expect_error("=3", "unknown key \"\"; the keys are n, reff, law, nmax, share");
    expect_error(" n=3", "unknown key \" n\"; the keys are n, reff, law, nmax, share");
    double value = 1;
    assert_int_equal(mote_parameters_parse(NULL, 0, "n=1", &value), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "unknown key \"n\"; nothing can be set here");
}

/* The error text names as many keys as it has room for. */
TEST(parse_of_an_unknown_key_among_many_names_the_first)
{
    char keys[MOTE_PARAMETERS_MAX][40];
    mote_parameter many[MOTE_PARAMETERS_MAX];
    double values[MOTE_PARAMETERS_MAX];
    for (int k = 0; k < MOTE_PARAMETERS_MAX; ++k) {
        (void)snprintf(keys[k], sizeof keys[k], "a_key_that_is_thirty_bytes_long%02d", k);
        many[k] = table[N];
        many[k].key = keys[k];
        many[k].fallback = "1";
    }
    mote_parameters_default(many, MOTE_PARAMETERS_MAX, values);
    assert_int_equal(mote_parameters_parse(many, MOTE_PARAMETERS_MAX, "m=3", values),
                     MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "unknown key \"m\"; the keys are a_key"));
    assert_non_null(strstr(mote_error_text(), keys[20]));
    assert_null(strstr(mote_error_text(), keys[22]));
}

TEST(parse_of_a_key_given_twice_is_an_error)
{
    expect_error("n=3,law=log,n=3", "n is given twice; give it once");
}

TEST(parse_of_an_item_without_a_value_is_an_error)
{
    expect_error("n", "\"n\" is not of the form key=value");
    expect_error("n=3,", "\"\" is not of the form key=value");
    expect_error(",n=3", "\"\" is not of the form key=value");
    expect_error("n=3,,law=log", "\"\" is not of the form key=value");
    expect_error(",", "\"\" is not of the form key=value");
}

TEST(parse_failing_at_the_end_changes_nothing)
{
    expect_error("n=3,reff=4,law=log,nmax=5,share=0.8",
                 "share=0.8 is not valid; share must be a number from 0.25 to 0.75");
}

/* Writes a value as text and reads it back. */
static double round_trip(size_t parameter, double value)
{
    char buffer[64];
    char item[100];
    const char *text = mote_parameter_text(&table[parameter], value, buffer, sizeof buffer);
    assert_ptr_equal(text, buffer);
    (void)snprintf(item, sizeof item, "%s=%s", table[parameter].key, text);
    double values[COUNT];
    parse(item, values);
    return values[parameter];
}

TEST(text_of_random_doubles_reads_back_the_same)
{
    uint64_t seed = 1;
    int checked = 0;
    while (checked < 20000) {
        const uint64_t bits = random_bits(&seed) & ~(UINT64_C(1) << 63);
        double value = 0;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        assert_true(round_trip(RADIUS, value) == value);
        ++checked;
    }
    const double special[] = {0, DBL_TRUE_MIN, DBL_MIN, DBL_MAX, HUGE_VAL, MOTE_AUTO, 1, 0.1};
    for (size_t k = 0; k < sizeof special / sizeof *special; ++k)
        assert_true(round_trip(RADIUS, special[k]) == special[k]);
    for (int k = 1; k <= 1000; ++k)
        assert_true(round_trip(N, k) == k);
    for (int k = 0; k < 3; ++k)
        assert_true(round_trip(LAW, k) == k);
}

TEST(text_is_short_and_whole_numbers_are_plain)
{
    const double value[] = {0.1, 0.5, 1.0 / 3, 1e300, 12345, 10, 1e15, 0, HUGE_VAL, MOTE_AUTO};
    const char *text[] = {
        "0.1", "0.5", "0.3333333333333333", "1e+300", "12345", "10", "1e+15", "0",
        "inf", "auto"};
    for (size_t k = 0; k < sizeof value / sizeof *value; ++k) {
        char buffer[64];
        assert_string_equal(
            mote_parameter_text(&table[RADIUS], value[k], buffer, sizeof buffer), text[k]);
    }
    char buffer[64];
    assert_string_equal(mote_parameter_text(&table[LAW], 2, buffer, sizeof buffer),
                        "inverse-square");
    assert_string_equal(mote_parameter_text(&table[N], 1000, buffer, sizeof buffer), "1000");
    /* No text reads back as equal to NaN. */
    assert_string_equal(mote_parameter_text(&table[RADIUS], NAN, buffer, sizeof buffer), "nan");
}
