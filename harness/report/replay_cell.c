/* The answers of a cell, read from its CSV file for pictures. */
#include "harness/report/replay.h"

#include "harness/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define FILE_LIMIT ((size_t)1 << 30)

enum { FIELD_DISTANCE, FIELD_PAIR, FIELD_COUNT = FIELD_PAIR + 6 };
static const char *const names[FIELD_COUNT] = {"distance", "ax", "ay", "az", "bx", "by", "bz"};

#define COLUMNS_MAX 64

/* Identifies each column of the file: an index into names, or -1. Returns how many there
   are. */
static size_t read_header(const char *line, int columns[COLUMNS_MAX])
{
    size_t count = 0;
    while (*line && *line != '\n' && count < COLUMNS_MAX) {
        size_t length = strcspn(line, ",\n");
        columns[count] = -1;
        for (int k = 0; k < FIELD_COUNT; ++k) {
            if (strlen(names[k]) == length && strncmp(names[k], line, length) == 0)
                columns[count] = k;
        }
        ++count;
        line += length + (line[length] == ',' ? 1 : 0);
    }
    return count;
}

/* Reads the fields of one line; returns where the next begins. */
static const char *read_line(const char *line, const int *columns, size_t count,
                             double fields[FIELD_COUNT])
{
    for (size_t k = 0; k < count; ++k) {
        size_t length = strcspn(line, ",\n");
        if (columns[k] >= 0)
            fields[columns[k]] = length > 0 ? strtod(line, NULL) : MOTE_NONE;
        line += length + (line[length] ? 1 : 0);
    }
    return line;
}

static void read_rows(const char *text, mote_replay_track *track)
{
    int columns[COLUMNS_MAX];
    size_t count = read_header(text, columns);
    const char *line = text + strcspn(text, "\n");
    line += *line ? 1 : 0;
    for (size_t k = 0; k < track->rows; ++k) { /* MOTE_NONE where the text has ended */
        double f[FIELD_COUNT];
        for (int i = 0; i < FIELD_COUNT; ++i)
            f[i] = MOTE_NONE;
        line = read_line(line, columns, count, f);
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
