/* Makes text from elsewhere (names of scenarios, files, commands) harmless in a page or a
   table. */
#ifndef MOTE_HARNESS_ESCAPE_H
#define MOTE_HARNESS_ESCAPE_H

#include "harness/base/file.h"

/* Appends value as the text of an HTML element or of a quoted attribute: & < > " ' become
   entities, control characters other than line feeds and tabs become blanks. NULL adds
   nothing. */
void mote_escape_html(mote_text *text, const char *value);

/* Appends value as plain text in a line of Markdown, inside a table or not: characters with a
   meaning there are escaped, & < > become entities, control characters blanks. NULL adds
   nothing. */
void mote_escape_markdown(mote_text *text, const char *value);

/* Appends a relative path for a link: everything but A-Z a-z 0-9 - _ . / becomes %XX, colons
   too, or a path could be read as a scheme. */
void mote_escape_path(mote_text *text, const char *path);

/* Appends JSON text that cannot end the script element around it: < becomes \u003c. In valid
   JSON, < occurs only in strings, where both mean the same. */
void mote_escape_script(mote_text *text, const char *json);

/* Appends a field of a CSV file, quoted where necessary or where `quoted` is set; quotes inside
   are doubled. NULL is an empty field. */
void mote_escape_csv(mote_text *text, const char *value, bool quoted);

/* Appends a number as a field that reads back as the same value; NaN becomes an empty field. */
void mote_csv_number(mote_text *text, double value);

/* Appends size bytes in base 64, padded. */
void mote_base64(mote_text *text, const void *data, size_t size);

#endif
