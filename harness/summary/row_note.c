#include "harness/summary/row_note.h"

#include <stdio.h>

bool mote_row_note(const mote_row_facts *facts, int i, char text[MOTE_ROW_NOTE])
{
    const bool applies[MOTE_ROW_NOTES] = {facts->stride > 1, facts->jobs > 1,
                                          facts->replicates_failed > 0 &&
                                              facts->replicates > 0};
    if (applies[i] && i == 0)
        (void)snprintf(text, MOTE_ROW_NOTE, "every %.0fth frame", facts->stride);
    else if (applies[i] && i == 1)
        (void)snprintf(text, MOTE_ROW_NOTE, "times not comparable: %.0f cells at once",
                       facts->jobs);
    else if (applies[i])
        (void)snprintf(text, MOTE_ROW_NOTE, "%.0f of %.0f replicates ended badly",
                       facts->replicates_failed, facts->replicates + facts->replicates_failed);
    return applies[i];
}
