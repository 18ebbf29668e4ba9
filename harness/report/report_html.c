/* The page: a frame, the report's data, and the scripts that make its tables and draw its
   replay. It is self-contained and loads nothing. */
#include "harness/base/data.h"
#include "harness/base/escape.h"

#include "harness/base/record.h"
#include "harness/report/replay.h"
#include "harness/report/report_data.h"
#include "harness/report/report_facts.h"

#include <stdlib.h>
#include <string.h>

#define STYLE_FILE "plots/page/report.css"
#define SOURCE_LIMIT ((size_t)1 << 20)
#define PROGRAM_LIMIT ((size_t)8 << 20)

/* Digits of the numbers in the page; tables show three and sort by all of them. */
#define DIGITS 10

/* The page's own program, in this order; plain scripts that need no bundling. */
static const char *const scripts[] = {"plots/page/packed.js", "plots/page/numbers.js",
                                      "plots/page/front.js", "plots/page/table.js",
                                      "plots/page/report.js"};

/* The bundled program of the replay: of an installed mote, or the one that `make page` left in
   the build. */
static mote_status read_replay_program(char **program, size_t *size)
{
    if (mote_data_read("page/replay.js", PROGRAM_LIMIT, program, size) == MOTE_OK)
        return MOTE_OK;
    return mote_file_read(MOTE_PAGE_PROGRAM, PROGRAM_LIMIT, program, size);
}

static mote_status add_head(const mote_report *report, mote_text *text)
{
    char *style = NULL;
    size_t size;
    mote_status status = mote_data_read(STYLE_FILE, SOURCE_LIMIT, &style, &size);
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

static void add_frame(const mote_report *report, mote_text *text)
{
    char *subtitle = mote_report_subtitle(report);
    mote_text_add(text, "<header>\n<p>mote, report of a run</p>\n<h1>");
    mote_escape_html(text, report->name);
    mote_text_add(text, "</h1>\n<p>");
    mote_escape_html(text, subtitle);
    mote_text_add(text, "</p>\n</header>\n<noscript><p class=\"notice\">The tables and figures "
                        "of this page are made by JavaScript, which is off. <a "
                        "href=\"report.md\">report.md</a> has them as plain text.</p>"
                        "</noscript>\n<nav aria-label=\"Sections\"></nav>\n<main></main>\n");
    free(subtitle);
}

/* Adds a script element; `name` is its source in messages. */
static mote_status add_script(const char *name, const char *source, size_t size,
                              mote_text *text)
{
    if (strstr(source, "</script") || strlen(source) != size)
        return mote_fail(MOTE_EINVAL,
                         "%s: not a script that can stand in a page; `make page` "
                         "writes it again",
                         name);
    mote_text_add(text, "<script>\n%s</script>\n", source);
    return MOTE_OK;
}

static mote_status add_scripts(mote_text *text)
{
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < sizeof scripts / sizeof scripts[0] && status == MOTE_OK; ++i) {
        char *source = NULL;
        size_t size;
        status = mote_data_read(scripts[i], SOURCE_LIMIT, &source, &size);
        if (status == MOTE_OK)
            status = add_script(scripts[i], source, size, text);
        free(source);
    }
    return status;
}

/* Adds an element with data; no text in it can end the element. Takes ownership of data. */
static void add_data(const char *id, json_t *data, mote_text *text)
{
    char *json = json_dumps(data, JSON_COMPACT | JSON_REAL_PRECISION(DIGITS));
    json_decref(data);
    mote_text_add(text, "<script type=\"application/json\" id=\"%s\">", id);
    mote_escape_script(text, json);
    mote_text_add(text, "</script>\n");
    free(json);
}

mote_status mote_report_html(const mote_report *report, mote_text *text)
{
    json_t *data = NULL, *replay = NULL;
    char *program = NULL;
    size_t size = 0;
    mote_status status = add_head(report, text);
    if (status == MOTE_OK) {
        add_frame(report, text);
        status = mote_report_data(report, &data);
    }
    if (status == MOTE_OK)
        add_data("report-data", data, text);
    const bool bundled = status == MOTE_OK && report->has_cells &&
                         read_replay_program(&program, &size) == MOTE_OK;
    if (bundled)
        status = mote_replay_json(report, &replay);
    if (bundled && status == MOTE_OK)
        add_data("replay-data", replay, text);
    if (status == MOTE_OK)
        status = add_scripts(text);
    if (bundled && status == MOTE_OK)
        status = add_script("page/replay.js", program, size, text);
    free(program);
    mote_text_add(text, "</body>\n</html>\n");
    return status;
}
