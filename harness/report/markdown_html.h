/* The part of Markdown that our own notes use, as HTML. */
#ifndef MOTE_HARNESS_MARKDOWN_HTML_H
#define MOTE_HARNESS_MARKDOWN_HTML_H

#include "harness/base/file.h"

/* Appends Markdown as HTML: headings (## becomes h3, one level lower than written), paragraphs,
   code indented by four blanks (folded behind "Reproduction") and `code` within a line. The
   title, # at its beginning, is left out. Everything else is text, and escaped. */
void mote_markdown_html(mote_text *text, const char *markdown);

/* Appends one line of text with `code` in it as HTML. */
void mote_markdown_inline(mote_text *text, const char *line);

/* Appends Markdown as Markdown below a heading of level 2: every heading one level
   lower, the title left out. */
void mote_markdown_nested(mote_text *text, const char *markdown);

#endif
