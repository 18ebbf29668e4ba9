/* Text from elsewhere (names of scenarios, files, commands) made harmless in a page or a
   table. */
#ifndef MOTE_HARNESS_ESCAPE_H
#define MOTE_HARNESS_ESCAPE_H

#include "harness/base/file.h"

/* Appends value as the text of an HTML element or of a quoted attribute: & < > " ' become
   entities, control characters other than line feeds and tabs blanks. NULL adds nothing. */
void mote_escape_html(mote_text *text, const char *value);

/* Appends value as plain text of a line of Markdown, within a table or not: what has a meaning
   there is escaped, & < > become entities, control characters blanks. NULL adds nothing. */
void mote_escape_markdown(mote_text *text, const char *value);

/* Appends a relative path for a link: all but A-Z a-z 0-9 - _ . / becomes %XX. A colon too, so
   that no path is read as a scheme. */
void mote_escape_path(mote_text *text, const char *path);

/* Appends JSON text so that it cannot end the script element that it stands in: < becomes
   \u003c, which within JSON strings, the only place where it stands, is the same. */
void mote_escape_script(mote_text *text, const char *json);

/* Appends a field of a CSV file, quoted where it has to be or where `quoted` says so; quotes
   inside are doubled. NULL is an empty field. */
void mote_escape_csv(mote_text *text, const char *value, bool quoted);

/* Appends a number as a field that is read back the same; an empty one for a NaN. */
void mote_csv_number(mote_text *text, double value);

/* Appends size bytes in base 64, padded. */
void mote_base64(mote_text *text, const void *data, size_t size);

#endif
