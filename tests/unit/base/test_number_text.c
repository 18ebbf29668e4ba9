/* Numbers formatted for people, and foreign text that does no harm in a page. */
#include "harness/base/number_text.h"

#include "harness/base/escape.h"
#include "tests/support/test.h"

#include <stddef.h>

#include <math.h>
#include <stdlib.h>

TEST(shown_numbers_have_their_digits_and_unit)
{
    static const struct {
        mote_number_show show;
        double value;
        const char *text;
    } cases[] = {
        {mote_show_time, 7420, "7.42 us"},   {mote_show_time, 74200, "74.2 us"},
        {mote_show_time, 742e6, "742 ms"},   {mote_show_time, 1e9, "1.00 s"},
        {mote_show_time, 999.6, "1.00 us"},  {mote_show_time, 0, "0 ns"},
        {mote_show_time, 12, "12.0 ns"},     {mote_show_time, -12, "-12 ns"},
        {mote_show_time, NAN, "-"},          {mote_show_ratio, 41.33, "41.3"},
        {mote_show_ratio, 4.133, "4.13"},    {mote_show_ratio, 413.3, "413"},
        {mote_show_ratio, NAN, "-"},         {mote_show_percent, 0.991, "99.1 %"},
        {mote_show_percent, NAN, "-"},       {mote_show_error, 0.00123, "1.2e-03"},
        {mote_show_error, NAN, "-"},         {mote_show_count, 12.5, "12.5"},
        {mote_show_count, NAN, "-"},         {mote_show_bytes, 9999, "9999 B"},
        {mote_show_bytes, 61200, "61.2 kB"}, {mote_show_bytes, 61.2e6, "61.2 MB"},
        {mote_show_bytes, NAN, "-"},         {mote_show_whole, 11920, "11,920"},
        {mote_show_whole, 920, "920"},       {mote_show_whole, 1234567, "1,234,567"},
        {mote_show_whole, 1e17, "1e+17"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        char text[MOTE_NUMBER_TEXT] = "untouched";
        assert_string_equal(cases[k].show(cases[k].value, text), cases[k].text);
    }
}

typedef void (*writing)(mote_text *text, const char *value);

static void expect(writing write, const char *value, const char *wanted)
{
    mote_text text = {0};
    write(&text, value);
    assert_string_equal(text.data ? text.data : "", wanted);
    free(text.data);
}

TEST(escaped_text_ends_nothing_that_it_stands_in)
{
    expect(mote_escape_html, NULL, "");
    expect(mote_escape_html, "a<b> & \"c'\n\t\x01", "a&lt;b&gt; &amp; &quot;c&#39;\n\t ");
    expect(mote_escape_markdown, NULL, "");
    expect(mote_escape_markdown, "a|b\n<#1>", "a\\|b &lt;\\#1&gt;");
    expect(mote_escape_path, "a b/c:d.svg", "a%20b/c%3Ad.svg");
    expect(mote_escape_script, "[\"</script>\"]", "[\"\\u003c/script>\"]");
}
