#include "harness/report/page.h"

#include "harness/base/data.h"
#include "harness/base/escape.h"

#include <stdlib.h>
#include <string.h>

#define STYLE_FILE "plots/page/report.css"
#define SOURCE_LIMIT ((size_t)1 << 20)

/* Digits of the numbers in the page; tables show three and sort by all of them. */
#define DIGITS 10

/* Plain scripts that need no bundling, in this order; then the page's own. */
static const char *const shared[] = {"plots/page/packed.js", "plots/page/numbers.js",
                                     "plots/page/sections.js", "plots/page/front.js",
                                     "plots/page/table.js"};

mote_status mote_page_begin(const char *title, mote_text *text)
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
    mote_escape_html(text, title);
    mote_text_add(text, " – mote</title>\n<style>\n%s</style>\n</head>\n<body>\n", style);
    free(style);
    return MOTE_OK;
}

void mote_page_data(const char *id, json_t *data, mote_text *text)
{
    char *json = json_dumps(data, JSON_COMPACT | JSON_REAL_PRECISION(DIGITS));
    json_decref(data);
    mote_text_add(text, "<script type=\"application/json\" id=\"%s\">", id);
    mote_escape_script(text, json);
    mote_text_add(text, "</script>\n");
    free(json);
}

mote_status mote_page_script(const char *name, const char *source, size_t size, mote_text *text)
{
    if (strstr(source, "</script") || strlen(source) != size)
        return mote_fail(MOTE_EINVAL,
                         "%s: not a script that can stand in a page; `make page` "
                         "writes it again",
                         name);
    mote_text_add(text, "<script>\n%s</script>\n", source);
    return MOTE_OK;
}

static mote_status add_script(const char *name, mote_text *text)
{
    char *source = NULL;
    size_t size;
    mote_status status = mote_data_read(name, SOURCE_LIMIT, &source, &size);
    if (status == MOTE_OK)
        status = mote_page_script(name, source, size, text);
    free(source);
    return status;
}

mote_status mote_page_scripts(const char *last, mote_text *text)
{
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < sizeof shared / sizeof shared[0] && status == MOTE_OK; ++i)
        status = add_script(shared[i], text);
    return status == MOTE_OK ? add_script(last, text) : status;
}

void mote_page_end(mote_text *text)
{
    mote_text_add(text, "</body>\n</html>\n");
}
