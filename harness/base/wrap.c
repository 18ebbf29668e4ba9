#include "harness/base/wrap.h"

#include <stdbool.h>
#include <string.h>

void mote_print_wrapped(const char *words, int column, int indent, int width, FILE *out)
{
    bool line_begins = true;
    while (*words) {
        const int length = (int)strcspn(words, " ");
        if (!line_begins && column + 1 + length > width) {
            (void)fprintf(out, "\n%*s", indent, "");
            column = indent;
        } else if (!line_begins) {
            (void)putc(' ', out);
            ++column;
        }
        (void)fprintf(out, "%.*s", length, words);
        line_begins = false;
        column += length;
        words += length;
        words += strspn(words, " ");
    }
    (void)putc('\n', out);
}
