/* The page: a frame, the report's data, and the scripts that make its tables and draw its
   replay. It is self-contained and loads nothing. */
#include "harness/base/data.h"
#include "harness/base/escape.h"

#include "harness/report/page.h"
#include "harness/report/replay.h"
#include "harness/report/report_data.h"
#include "harness/report/report_facts.h"

#include <stdlib.h>

#define PROGRAM_LIMIT ((size_t)8 << 20)

/* The bundled program of the replay: of an installed mote, or the one that `make page` left in
   the build. */
static mote_status read_replay_program(char **program, size_t *size)
{
    if (mote_data_read("page/replay.js", PROGRAM_LIMIT, program, size) == MOTE_OK)
        return MOTE_OK;
    return mote_file_read(MOTE_PAGE_PROGRAM, PROGRAM_LIMIT, program, size);
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

mote_status mote_report_html(const mote_report *report, mote_text *text)
{
    json_t *data = NULL, *replay = NULL;
    char *program = NULL;
    size_t size = 0;
    mote_status status = mote_page_begin(report->name, text);
    if (status == MOTE_OK) {
        add_frame(report, text);
        status = mote_report_data(report, &data);
    }
    if (status == MOTE_OK)
        mote_page_data("report-data", data, text);
    const bool bundled = status == MOTE_OK && report->has_cells &&
                         read_replay_program(&program, &size) == MOTE_OK;
    if (bundled)
        status = mote_replay_json(report, &replay);
    if (bundled && status == MOTE_OK)
        mote_page_data("replay-data", replay, text);
    if (status == MOTE_OK)
        status = mote_page_scripts("plots/page/report.js", text);
    if (bundled && status == MOTE_OK)
        status = mote_page_script("page/replay.js", program, size, text);
    free(program);
    mote_page_end(text);
    return status;
}
