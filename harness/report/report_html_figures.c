/* The page's figures. Each is an image of its own within the page: names inside one drawing
   cannot meet those of another, and no drawing can run anything. */
#include "harness/base/escape.h"
#include "harness/report/report_html.h"

#include <stdlib.h>

#define FIGURE_LIMIT ((size_t)64 << 20)

static mote_status add_image(const mote_report *report, const mote_report_figure *figure,
                             mote_text *text)
{
    char *path = mote_format("%s/%s", report->directory, figure->file);
    char *svg = NULL;
    size_t size = 0;
    mote_status status = path ? mote_file_read(path, FIGURE_LIMIT, &svg, &size)
                              : mote_fail(MOTE_ENOMEM, "no memory for a figure's name");
    if (status == MOTE_OK) {
        mote_text_add(text, "<a href=\"");
        mote_escape_path(text, figure->file);
        mote_text_add(text, "\"><img alt=\"");
        mote_escape_html(text, figure->title);
        mote_text_add(text, "\" src=\"data:image/svg+xml;charset=utf-8,");
        mote_escape_drawing(text, svg);
        mote_text_add(text, "\"></a>\n");
    }
    free(svg);
    free(path);
    return status;
}

static void add_link(const mote_report_figure *figure, mote_text *text)
{
    mote_text_add(text, "<p><a href=\"");
    mote_escape_path(text, figure->file);
    mote_text_add(text, "\">Animation: ");
    mote_escape_html(text, figure->file);
    mote_text_add(text, "</a></p>\n");
}

mote_status mote_report_html_figures(const mote_report *report, mote_text *text)
{
    mote_status status = MOTE_OK;
    if (report->figure_count == 0)
        return MOTE_OK;
    mote_report_html_section(text, "figures", "Figures");
    for (size_t i = 0; i < report->figure_count && status == MOTE_OK; ++i) {
        const mote_report_figure *figure = &report->figures[i];
        mote_text_add(text, "<figure>");
        if (figure->animation)
            add_link(figure, text);
        else
            status = add_image(report, figure, text);
        mote_text_add(text, "<figcaption><strong>");
        mote_escape_html(text, figure->title);
        mote_text_add(text, ".</strong> ");
        mote_escape_html(text, figure->caption);
        mote_text_add(text, "</figcaption></figure>\n");
    }
    mote_text_add(text, "</section>\n");
    return status;
}
