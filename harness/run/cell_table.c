#include "harness/run/cell_table.h"

#include "harness/base/statistics.h"

#include <stdlib.h>
#include <string.h>

bool mote_cell_is_name(const char *text, const char *name, size_t length)
{
    return strlen(text) == length && memcmp(text, name, length) == 0;
}

bool mote_cell_read_header(const char *header, int (*find)(const char *name, size_t length),
                           mote_cell_columns *columns)
{
    columns->count = 0;
    for (const char *name = header;; ++name) {
        const size_t length = strcspn(name, ",\n");
        if (columns->count == MOTE_CELL_COLUMNS_MAX)
            return false;
        columns->index[columns->count++] = find(name, length);
        name += length;
        if (*name != ',')
            return true;
    }
}

const char *mote_cell_read_line(const char *line, const mote_cell_columns *columns,
                                void (*put)(void *context, int index, double value),
                                void *context)
{
    for (size_t k = 0; k < columns->count; ++k) {
        double value = MOTE_NONE;
        if (*line != ',' && *line != '\n') {
            char *end;
            value = strtod(line, &end);
            if (end == line || value - value != 0)
                return NULL;
            line = end;
        }
        if (columns->index[k] >= 0)
            put(context, columns->index[k], value);
        if (*line != (k + 1 < columns->count ? ',' : '\n'))
            return NULL;
        ++line;
    }
    return line;
}
