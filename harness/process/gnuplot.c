#include "harness/process/gnuplot.h"

#include "harness/base/data.h"
#include "harness/base/file.h"
#include "harness/process/spawn.h"

#include <stdlib.h>

void mote_gnuplot_quote(mote_text *text, const char *string)
{
    mote_text_add(text, "\"");
    for (const char *p = string; *p; ++p) {
        if (*p == '"')
            mote_text_add(text, "\xe2\x80\x9d"); /* a typographic quote */
        else
            mote_text_add(text, "%c", (unsigned char)*p < ' ' ? ' ' : *p);
    }
    mote_text_add(text, "\"");
}

void mote_gnuplot_block(mote_text *text, const char *title)
{
    if (text->size)
        mote_text_add(text, "\n\n");
    mote_gnuplot_quote(text, title);
    mote_text_add(text, "\n");
}

mote_status mote_gnuplot_draw(const char *folder, const char *script, const char *base,
                              const char *heading, const char *footer, const char *formats)
{
    /* gnuplot takes a file name that begins with '<' or '|' for a command. */
    char *file = mote_format("%s%s", base[0] == '/' ? "" : "./", base);
    char *plots = mote_format("%s/plots", mote_data_directory());
    char *draw = mote_format("%s/plots/draw.gp", mote_data_directory());
    const char *const argv[] = {"gnuplot", "-c",    draw,   plots,   script,
                                file,      heading, footer, formats, NULL};
    const mote_status status = mote_spawn_quiet(argv, folder);
    free(file);
    free(plots);
    free(draw);
    return status;
}
