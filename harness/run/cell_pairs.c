#include "harness/run/cell_pairs.h"

#include "harness/base/file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static mote_status write_error(const char *name)
{
    return mote_fail(MOTE_EIO, "%s: cannot be written: %s", name, strerror(errno));
}

mote_status mote_cell_pairs_open(const mote_cell *cell, const char *directory,
                                 mote_cell_pairs *pairs)
{
    mote_cell_pairs made = {.contacts_only = cell->contacts_only};
    made.name = mote_format("%s/cells/%s.pairs.csv", directory, cell->id);
    made.part = mote_part_name(made.name);
    made.file = fopen(made.part, "w");
    if (!made.file) {
        const mote_status status = write_error(made.part);
        free(made.name);
        free(made.part);
        return status;
    }
    (void)fputs("frame,body_a,body_b,steps,distance,lower,contact,ax,ay,az,bx,by,bz,positions,"
                "box_tests,triangle_tests\n",
                made.file);
    *pairs = made;
    return MOTE_OK;
}

static void put_number(FILE *file, bool present, double value)
{
    if (present)
        (void)fprintf(file, ",%.17g", value);
    else
        (void)fputc(',', file);
}

static void put_pair(FILE *file, uint32_t frame, const mote_near_pair *pair)
{
    const mote_answer *a = &pair->answer;
    (void)fprintf(file, "%u,%u,%u,%u", frame, pair->body[0] + 1, pair->body[1] + 1,
                  pair->steps);
    put_number(file, a->has_distance, a->distance);
    put_number(file, a->has_lower, a->lower);
    if (a->has_contact)
        (void)fprintf(file, ",%d", a->contact);
    else
        (void)fputc(',', file);
    for (int k = 0; k < 2; ++k) {
        put_number(file, a->has_witness, a->witness[k].x);
        put_number(file, a->has_witness, a->witness[k].y);
        put_number(file, a->has_witness, a->witness[k].z);
    }
    (void)fprintf(file, ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 "\n", a->counters.positions,
                  a->counters.box_tests, a->counters.triangle_tests);
}

void mote_cell_pairs_add(const mote_cell_pairs *pairs, uint32_t frame,
                         const mote_near_pair *list, size_t count)
{
    for (size_t k = 0; pairs->file && k < count; ++k) {
        if (list[k].answer.contact || !pairs->contacts_only)
            put_pair(pairs->file, frame, &list[k]);
    }
}

mote_status mote_cell_pairs_close(mote_cell_pairs *pairs, bool whole)
{
    mote_status status = MOTE_OK;
    if (pairs->file) {
        const bool lost = ferror(pairs->file) != 0;
        bool good = fflush(pairs->file) == 0 && !lost && fsync(fileno(pairs->file)) == 0;
        good = fclose(pairs->file) == 0 && good;
        if (whole && (!good || rename(pairs->part, pairs->name) != 0))
            status = write_error(pairs->name);
        if (!whole || status != MOTE_OK)
            (void)remove(pairs->part);
    }
    free(pairs->name);
    free(pairs->part);
    *pairs = (mote_cell_pairs){.file = NULL};
    return status;
}
