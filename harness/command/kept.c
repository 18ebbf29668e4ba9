#include "harness/command/kept.h"

#include "harness/base/record.h"
#include "harness/summary/table.h"

mote_status mote_kept_read(const char *directory, mote_kept *kept)
{
    const bool simulated = mote_simulations_exist(directory);
    mote_kept made = {.has_summary = !simulated || mote_record_exists(directory, "cells")};
    mote_status status = MOTE_OK;
    if (made.has_summary)
        status = mote_summary_make(directory, &made.summary);
    if (status == MOTE_OK && simulated)
        status = mote_simulations_read(directory, &made.simulations);
    if (status == MOTE_OK)
        *kept = made;
    else
        mote_kept_free(&made);
    return status;
}

void mote_kept_free(mote_kept *kept)
{
    mote_summary_free(&kept->summary);
    mote_simulations_free(&kept->simulations);
}

void mote_kept_print(const mote_kept *kept, FILE *out)
{
    if (kept->has_summary)
        mote_table_print(&kept->summary, out);
    mote_simulations_print(&kept->simulations, out);
}
