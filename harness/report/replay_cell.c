/* Reads the answers of a cell from its CSV file for pictures. */
#include "harness/report/replay.h"

#include "harness/base/memory.h"
#include "harness/run/cell_table.h"

#include <stdlib.h>
#include <string.h>

#define FILE_LIMIT ((size_t)1 << 30)

enum { FIELD_DISTANCE, FIELD_PAIR, FIELD_COUNT = FIELD_PAIR + 6 };
static const char *const names[FIELD_COUNT] = {"distance", "ax", "ay", "az", "bx", "by", "bz"};

static int find_field(const char *name, size_t length)
{
    for (int k = 0; k < FIELD_COUNT; ++k) {
        if (mote_cell_is_name(names[k], name, length))
            return k;
    }
    return -1;
}

/* context: double[FIELD_COUNT] */
static void put_field(void *context, int field, double value)
{
    ((double *)context)[field] = value;
}

/* Rows stay MOTE_NONE after the end of the text, or after a line that is not a cell's. */
static void read_rows(const char *text, mote_replay_track *track)
{
    mote_cell_columns columns;
    const char *line = strchr(text, '\n');
    if (line && !mote_cell_read_header(text, find_field, &columns))
        line = NULL;
    line = line ? line + 1 : NULL;
    for (size_t k = 0; k < track->rows; ++k) {
        double f[FIELD_COUNT];
        for (int i = 0; i < FIELD_COUNT; ++i)
            f[i] = MOTE_NONE;
        if (line)
            line = mote_cell_read_line(line, &columns, put_field, f);
        track->distance[k] = f[FIELD_DISTANCE];
        track->pair[2 * k] =
            mote_vec3_make(f[FIELD_PAIR], f[FIELD_PAIR + 1], f[FIELD_PAIR + 2]);
        track->pair[2 * k + 1] =
            mote_vec3_make(f[FIELD_PAIR + 3], f[FIELD_PAIR + 4], f[FIELD_PAIR + 5]);
    }
}

mote_status mote_replay_read_cell(const char *directory, mote_replay_track *track)
{
    char *path = mote_format("%s/cells/%s.csv", directory, track->cell->id);
    char *text = NULL;
    size_t size;
    const mote_status status = mote_file_read(path, FILE_LIMIT, &text, &size);
    track->rows = track->cell->frames;
    track->distance = mote_allocate(track->rows, sizeof *track->distance);
    track->pair = mote_allocate(2 * track->rows, sizeof *track->pair);
    if (status == MOTE_OK)
        read_rows(text, track);
    free(text);
    free(path);
    return status;
}
