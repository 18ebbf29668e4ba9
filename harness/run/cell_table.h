/* Reads the CSV file of a cell: a header and lines of numbers, some of which may be empty. */
#ifndef MOTE_HARNESS_CELL_TABLE_H
#define MOTE_HARNESS_CELL_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#define MOTE_CELL_COLUMNS_MAX 64

/* Whether a name of this length equals the text. */
bool mote_cell_is_name(const char *text, const char *name, size_t length);

/* The reader's index of each column of a file; -1: not read. */
typedef struct mote_cell_columns {
    int index[MOTE_CELL_COLUMNS_MAX];
    size_t count;
} mote_cell_columns;

/* Maps a header: find returns the index of a name, or -1. False for too many columns. */
bool mote_cell_read_header(const char *header, int (*find)(const char *name, size_t length),
                           mote_cell_columns *columns);

/* Reads a line: put is called with context for each column that is read, from left to right;
   value is MOTE_NONE if the field is empty. Returns the next line, or NULL if this line does
   not have these columns. */
const char *mote_cell_read_line(const char *line, const mote_cell_columns *columns,
                                void (*put)(void *context, int index, double value),
                                void *context);

#endif
