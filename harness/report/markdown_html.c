#include "harness/report/markdown_html.h"

#include "harness/base/escape.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef enum block { BLOCK_NONE, BLOCK_PARAGRAPH, BLOCK_CODE } block;

typedef struct writer {
    mote_text *text;
    block open;
    size_t blanks; /* empty lines seen within code, which may go on behind them */
} writer;

static void escape(mote_text *text, const char *from, size_t length)
{
    char *copy = mote_format("%.*s", (int)length, from);
    if (copy)
        mote_escape_html(text, copy);
    else
        text->failed = 1;
    free(copy);
}

/* Text with `code` in it. */
static void add_inline(mote_text *text, const char *line, size_t length)
{
    bool code = false;
    while (length > 0) {
        const char *tick = memchr(line, '`', length);
        size_t plain = tick ? (size_t)(tick - line) : length;
        escape(text, line, plain);
        if (!tick)
            break;
        code = !code;
        mote_text_add(text, code ? "<code>" : "</code>");
        line += plain + 1;
        length -= plain + 1;
    }
    if (code)
        mote_text_add(text, "</code>");
}

void mote_markdown_inline(mote_text *text, const char *line)
{
    add_inline(text, line, strlen(line));
}

static void close_block(writer *w)
{
    if (w->open == BLOCK_PARAGRAPH)
        mote_text_add(w->text, "</p>\n");
    if (w->open == BLOCK_CODE)
        mote_text_add(w->text, "</code></pre></details>\n");
    w->open = BLOCK_NONE;
    w->blanks = 0;
}

static void add_code(writer *w, const char *line, size_t length)
{
    if (w->open != BLOCK_CODE) {
        close_block(w);
        mote_text_add(w->text, "<details><summary>Reproduction</summary><pre><code>");
        w->open = BLOCK_CODE;
    }
    for (; w->blanks > 0; --w->blanks)
        mote_text_add(w->text, "\n");
    escape(w->text, line + 4, length - 4);
    mote_text_add(w->text, "\n");
}

static void add_heading(writer *w, const char *line, size_t length)
{
    size_t level = strspn(line, "#");
    close_block(w);
    if (level == 1)
        return;
    size_t skipped = level + strspn(line + level, " ");
    int shown = level < 5 ? (int)level + 1 : 6;
    mote_text_add(w->text, "<h%d>", shown);
    add_inline(w->text, line + skipped, length - skipped);
    mote_text_add(w->text, "</h%d>\n", shown);
}

static void add_line(writer *w, const char *line, size_t length)
{
    if (length == 0) {
        if (w->open == BLOCK_CODE)
            ++w->blanks;
        else
            close_block(w);
    } else if (length > 4 && strncmp(line, "    ", 4) == 0) {
        add_code(w, line, length);
    } else if (line[0] == '#') {
        add_heading(w, line, length);
    } else {
        if (w->open != BLOCK_PARAGRAPH) {
            close_block(w);
            mote_text_add(w->text, "<p>");
        } else {
            mote_text_add(w->text, "\n");
        }
        w->open = BLOCK_PARAGRAPH;
        add_inline(w->text, line, length);
    }
}

void mote_markdown_html(mote_text *text, const char *markdown)
{
    writer w = {text, BLOCK_NONE, 0};
    while (*markdown) {
        size_t length = strcspn(markdown, "\n");
        add_line(&w, markdown, length);
        markdown += length + (markdown[length] ? 1 : 0);
    }
    close_block(&w);
}

void mote_markdown_nested(mote_text *text, const char *markdown)
{
    bool first = true;
    while (*markdown) {
        size_t length = strcspn(markdown, "\n");
        bool title = markdown[0] == '#' && markdown[1] != '#';
        if (!title && (length > 0 || !first)) {
            mote_text_add(text, "%s%.*s\n", markdown[0] == '#' ? "#" : "", (int)length,
                          markdown);
            first = false;
        }
        markdown += length + (markdown[length] ? 1 : 0);
    }
}
