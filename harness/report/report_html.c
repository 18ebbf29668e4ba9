/* The page: its frame, what was asked, the machine, the defects. */
#include "harness/report/report_html.h"

#include "harness/base/data.h"
#include "harness/base/escape.h"
#include "harness/report/markdown_html.h"
#include "harness/base/record.h"
#include "harness/report/report_facts.h"

#include <stdlib.h>

#define STYLE_FILE "plots/page/report.css"
#define STYLE_LIMIT ((size_t)1 << 20)

void mote_report_html_section(mote_text *text, const char *id, const char *title)
{
    mote_text_add(text, "<section aria-labelledby=\"%s\"><h2 id=\"%s\">%s</h2>\n", id, id,
                  title);
}

/* The page may load nothing: what it needs is in it. */
static mote_status add_head(const mote_report *report, mote_text *text)
{
    char *style = NULL;
    size_t size;
    mote_status status = mote_data_read(STYLE_FILE, STYLE_LIMIT, &style, &size);
    if (status != MOTE_OK)
        return status;
    mote_text_add(text,
                  "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                  "<meta name=\"viewport\" content=\"width=device-width, "
                  "initial-scale=1\">\n"
                  "<meta name=\"color-scheme\" content=\"light dark\">\n"
                  "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src "
                  "'none'; img-src data:; style-src 'unsafe-inline'; script-src "
                  "'unsafe-inline'\">\n<link rel=\"icon\" href=\"data:,\">\n<title>");
    mote_escape_html(text, report->name);
    mote_text_add(text, " – mote</title>\n<style>\n%s</style>\n</head>\n<body>\n", style);
    free(style);
    return MOTE_OK;
}

static void add_link(mote_text *text, bool wanted, const char *id, const char *title)
{
    if (wanted)
        mote_text_add(text, "<a href=\"#%s\">%s</a>\n", id, title);
}

static mote_status add_top(const mote_report *report, mote_text *text)
{
    char *subtitle = mote_report_subtitle(report);
    if (!subtitle)
        return mote_fail(MOTE_ENOMEM, "no memory for a report");
    mote_text_add(text, "<header>\n<p>mote, report of a run</p>\n<h1>");
    mote_escape_html(text, report->name);
    mote_text_add(text, "</h1>\n<p>");
    mote_escape_html(text, subtitle);
    mote_text_add(text, "</p>\n</header>\n<nav aria-label=\"Sections\">\n");
    free(subtitle);
    add_link(text, true, "asked", "Asked");
    add_link(text, json_array_size(report->missing) > 0, "missing", "Missing");
    add_link(text, report->has_cells, "replay", "Replay");
    add_link(text, report->summary != NULL, "results", "Results");
    add_link(text, report->figure_count > 0, "figures", "Figures");
    add_link(text, report->claims || report->requirements, "claims", "Claims");
    add_link(text, report->manifest != NULL, "machine", "Machine");
    add_link(text, report->defects != NULL, "defects", "Known defects");
    add_link(text, report->has_cells, "cells", "Raw cells");
    mote_text_add(text, "</nav>\n<main>\n");
    return MOTE_OK;
}

static const char *pair_text(const json_t *pair, size_t index)
{
    return json_string_value(json_array_get(pair, index));
}

static void add_scenarios(const json_t *scenarios, mote_text *text)
{
    size_t i;
    const json_t *pair;
    mote_text_add(text, "<dl>\n");
    MOTE_EACH(i, pair, scenarios)
    {
        mote_text_add(text, "<dt>");
        mote_escape_html(text, pair_text(pair, 0));
        mote_text_add(text, "</dt><dd>");
        mote_escape_html(text, pair_text(pair, 1));
        mote_text_add(text, "</dd>\n");
    }
    mote_text_add(text, "</dl>\n");
}

static void add_commands(const json_t *commands, mote_text *text)
{
    size_t i;
    const json_t *pair;
    if (json_array_size(commands) == 0)
        return;
    mote_text_add(text, "<details><summary>Commands that measured it</summary>\n<pre><code>");
    MOTE_EACH(i, pair, commands)
    {
        mote_text_add(text, "# ");
        mote_escape_html(text, pair_text(pair, 0));
        mote_text_add(text, "\n");
        mote_escape_html(text, pair_text(pair, 1));
        mote_text_add(text, "\n");
    }
    mote_text_add(text, "</code></pre></details>\n");
}

static mote_status add_asked(const mote_report *report, mote_text *text)
{
    json_t *scenarios = mote_report_scenarios(report);
    json_t *commands = mote_report_commands(report);
    mote_status status = MOTE_OK;
    if (scenarios && commands) {
        mote_report_html_section(text, "asked", "What was asked");
        mote_text_add(text, "<p>How much accuracy does a collision query by a few particles "
                            "give up, and how much time and memory does it save, against "
                            "bounding volume hierarchies, on deforming triangle meshes? Every "
                            "method gets the same frames; its answers are compared with the "
                            "exact distance.</p>\n");
        add_scenarios(scenarios, text);
        add_commands(commands, text);
        mote_text_add(text, "</section>\n");
    } else {
        status = mote_fail(MOTE_ENOMEM, "no memory for a report");
    }
    json_decref(scenarios);
    json_decref(commands);
    return status;
}

static void add_missing(const mote_report *report, mote_text *text)
{
    size_t i;
    const json_t *what;
    if (json_array_size(report->missing) == 0)
        return;
    mote_report_html_section(text, "missing", "What this run does not have");
    mote_text_add(text, "<ul>\n");
    MOTE_EACH(i, what, report->missing)
    {
        mote_text_add(text, "<li>");
        mote_markdown_inline(text, json_string_value(what));
        mote_text_add(text, "</li>\n");
    }
    mote_text_add(text, "</ul>\n</section>\n");
}

static mote_status add_machine(const mote_report *report, mote_text *text)
{
    size_t i;
    const json_t *pair;
    if (!report->manifest)
        return MOTE_OK;
    json_t *facts = mote_report_machine(report);
    if (!facts)
        return mote_fail(MOTE_ENOMEM, "no memory for a report");
    mote_report_html_section(text, "machine", "The machine and the program");
    mote_text_add(text, "<dl>\n");
    MOTE_EACH(i, pair, facts)
    {
        mote_text_add(text, "<dt>");
        mote_escape_html(text, pair_text(pair, 0));
        mote_text_add(text, "</dt><dd>");
        mote_escape_html(text, pair_text(pair, 1));
        mote_text_add(text, "</dd>\n");
    }
    mote_text_add(text, "</dl>\n<p>From <a href=\"manifest.json\">manifest.json</a>.</p>\n"
                        "</section>\n");
    json_decref(facts);
    return MOTE_OK;
}

static void add_defects(const mote_report *report, mote_text *text)
{
    if (!report->defects)
        return;
    mote_report_html_section(text, "defects", "Known defects of the baselines");
    mote_text_add(text, "<div class=\"prose\">\n");
    mote_markdown_html(text, report->defects);
    mote_text_add(text, "</div>\n</section>\n");
}

mote_status mote_report_html(const mote_report *report, mote_text *text)
{
    mote_status status = add_head(report, text);
    if (status == MOTE_OK)
        status = add_top(report, text);
    if (status == MOTE_OK)
        status = add_asked(report, text);
    if (status == MOTE_OK) {
        add_missing(report, text);
        status = mote_report_html_replay(report, text);
    }
    if (status == MOTE_OK) {
        mote_report_html_results(report, text);
        status = mote_report_html_figures(report, text);
    }
    if (status == MOTE_OK) {
        mote_report_html_claims(report, text);
        status = add_machine(report, text);
    }
    if (status == MOTE_OK) {
        add_defects(report, text);
        mote_report_html_cells(report, text);
        mote_text_add(text, "</main>\n</body>\n</html>\n");
    }
    return status;
}
