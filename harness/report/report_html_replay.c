/* The page's replay: its data, and the program that `make page` bundles for it. */
#include "harness/base/data.h"
#include "harness/base/escape.h"
#include "harness/base/json_memory.h"
#include "harness/base/record.h"
#include "harness/report/replay.h"
#include "harness/report/report_html.h"

#include <stdlib.h>
#include <string.h>

#define PROGRAM_LIMIT ((size_t)8 << 20)

/* The bundle: that of an installed program, or what `make page` left in the build. */
static mote_status read_program(char **program, size_t *size)
{
    if (mote_data_read("page/replay.js", PROGRAM_LIMIT, program, size) == MOTE_OK)
        return MOTE_OK;
    return mote_file_read(MOTE_PAGE_PROGRAM, PROGRAM_LIMIT, program, size);
}

static void add_absent(mote_text *text)
{
    mote_text_add(text, "<p>This page has no replay: it was written without the program that "
                        "draws it, which <code>make page</code> bundles where Node and npm "
                        "are. After that, <code>make report</code> adds it.</p>\n");
}

/* The texts of notes[] that say what is not shown. */
static void add_notes(const char *json, mote_text *text)
{
    size_t i;
    const json_t *note;
    json_error_t error;
    json_t *root = mote_json_load(json, strlen(json), 0, &error);
    text->failed = text->failed || mote_json_memory_short();
    const json_t *notes = json_object_get(root, "notes");
    if (json_array_size(notes) > 0) {
        mote_text_add(text, "<details><summary>Scenarios without a replay</summary><ul>\n");
        MOTE_EACH(i, note, notes)
        {
            mote_text_add(text, "<li>");
            mote_escape_html(text, json_string_value(note));
            mote_text_add(text, "</li>\n");
        }
        mote_text_add(text, "</ul></details>\n");
    }
    json_decref(root);
}

static mote_status add_program(const mote_report *report, const char *program, mote_text *text)
{
    mote_text data = {0};
    size_t shown = 0;
    mote_status status = mote_replay_json(report, &data, &shown);
    if (status == MOTE_OK && shown > 0) {
        mote_text_add(text, "<div id=\"replay-app\"><noscript><p>The replay needs "
                            "JavaScript.</p></noscript></div>\n");
        add_notes(data.data, text);
        mote_text_add(text,
                      "<script type=\"application/json\" id=\"replay-data\">\n%s"
                      "</script>\n<script>\n%s</script>\n",
                      data.data, program);
    } else if (status == MOTE_OK) {
        mote_text_add(text, "<p>No scenario of this run can be replayed.</p>\n");
        add_notes(data.data, text);
    }
    free(data.data);
    return status;
}

mote_status mote_report_html_replay(const mote_report *report, mote_text *text)
{
    char *program = NULL;
    size_t size;
    mote_status status = MOTE_OK;
    if (!report->has_cells)
        return MOTE_OK;
    mote_report_html_section(text, "replay", "Replay");
    if (read_program(&program, &size) != MOTE_OK)
        add_absent(text);
    else if (strstr(program, "</script") || strlen(program) != size)
        status = mote_fail(MOTE_EINVAL, "%s: not what `make page` writes; run it again",
                           "page/replay.js");
    else
        status = add_program(report, program, text);
    free(program);
    mote_text_add(text, "</section>\n");
    return status;
}
