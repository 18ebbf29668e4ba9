/* The page's claims: a line a claim, which opens to its figures. */
#include "harness/base/escape.h"
#include "harness/base/record.h"
#include "harness/report/report_html.h"
#include "harness/report/report_rows.h"

#include <string.h>

/* "0.0635 L", "12 us", "41". */
static void add_value(const json_t *value, mote_text *text)
{
    const double number = mote_report_number(value, NULL, "value");
    double interval[2];
    const char *unit = mote_report_text(value, "unit");
    if (number != number) {
        mote_text_add(text, "–");
        return;
    }
    mote_text_add(text, "%.4g", number);
    if (unit[0])
        mote_text_add(text, "\u202f");
    mote_escape_html(text, strcmp(unit, "us") == 0 ? "µs" : unit);
    if (mote_report_interval(value, interval))
        mote_text_add(text, " <small>%.4g – %.4g</small>", interval[0], interval[1]);
}

static void add_threshold(const json_t *threshold, mote_text *text)
{
    const double holds = mote_report_number(threshold, NULL, "holds");
    const double limits = mote_report_number(threshold, NULL, "limits");
    if (!json_is_object(threshold))
        return;
    mote_escape_html(text, mote_report_text(threshold, "bound"));
    if (holds == holds)
        mote_text_add(text, " %g", holds);
    if (limits == limits)
        mote_text_add(text, "%s %g within limits", holds == holds ? "," : "", limits);
}

static void add_values(const mote_report *report, const json_t *claim, const char *file,
                       mote_text *text)
{
    size_t i;
    const json_t *value;
    mote_text_add(text, "<div class=\"wide\"><table class=\"values\"><thead><tr>"
                        "<th scope=\"col\">figure</th><th scope=\"col\">value</th>"
                        "<th scope=\"col\">threshold</th></tr></thead><tbody>\n");
    MOTE_EACH(i, value, json_object_get(claim, "values"))
    {
        mote_text_add(text, "<tr><th scope=\"row\">");
        mote_escape_html(text, mote_report_text(value, "name"));
        mote_text_add(text, "</th><td><a href=\"%s%s\">", report->claims_folder, file);
        add_value(value, text);
        mote_text_add(text, "</a></td><td>");
        add_threshold(json_object_get(value, "threshold"), text);
        mote_text_add(text, "</td></tr>\n");
    }
    mote_text_add(text, "</tbody></table></div>\n");
}

static void add_curve(const mote_report *report, const char *curve, mote_text *text)
{
    if (!curve[0])
        return;
    mote_text_add(text, "<p>Curve: <a href=\"%s", report->claims_folder);
    mote_escape_path(text, curve);
    mote_text_add(text, "\">");
    mote_escape_html(text, curve);
    mote_text_add(text, "</a>.</p>\n");
}

/* The class of a verdict: its colour, beside its words. */
static const char *verdict_class(const char *verdict)
{
    if (strcmp(verdict, "holds") == 0)
        return "good";
    return strcmp(verdict, "holds within limits") == 0 ? "fair" : "poor";
}

static void add_claim(const mote_report *report, const json_t *claim, const char *file,
                      mote_text *text)
{
    const char *verdict = mote_report_text(claim, "verdict");
    const char *section = mote_report_text(claim, "section");
    mote_text_add(text, "<details class=\"claim\"><summary><span class=\"id\">");
    mote_escape_html(text, mote_report_text(claim, "id"));
    mote_text_add(text, "</span><span class=\"what\">");
    mote_escape_html(text, mote_report_text(claim, "claim"));
    mote_text_add(text, "</span><span class=\"verdict %s\">", verdict_class(verdict));
    mote_escape_html(text, verdict);
    mote_text_add(text, "</span><span class=\"headline\">");
    add_value(claim, text);
    mote_text_add(text, "</span></summary>\n<p>");
    if (section[0]) {
        mote_text_add(text, "Section ");
        mote_escape_html(text, section);
        mote_text_add(text, ". ");
    }
    mote_text_add(text, "Measured: ");
    mote_escape_html(text, mote_report_text(claim, "measured"));
    mote_text_add(text, ".</p>\n");
    add_values(report, claim, file, text);
    add_curve(report, mote_report_text(claim, "curve"), text);
    mote_text_add(text, "</details>\n");
}

static void add_list(const mote_report *report, const json_t *list, const char *file,
                     mote_text *text)
{
    size_t i;
    const json_t *claim;
    MOTE_EACH(i, claim, list)
    {
        add_claim(report, claim, file, text);
    }
}

void mote_report_html_claims(const mote_report *report, mote_text *text)
{
    if (!report->claims && !report->requirements)
        return;
    mote_report_html_section(text, "claims", "Claims");
    if (report->claims) {
        mote_text_add(text, "<p>What the paper claims, and what was measured of it. A verdict "
                            "follows from the figures and their thresholds alone.</p>\n");
        add_list(report, report->claims, "claims.json", text);
    }
    if (report->requirements) {
        mote_text_add(text, "<h3>Requirements</h3>\n<p>What this implementation must show "
                            "whatever the paper says.</p>\n");
        add_list(report, report->requirements, "requirements.json", text);
    }
    mote_text_add(text, "</section>\n");
}
