/* Reads the positions of a Wavefront OBJ quickly: a sequence has thousands of such files. The
   grammar is that of mesh_obj.c, which read the mesh of the first file. */
#include "harness/sequence/frame_file.h"

#include "harness/mesh/mesh_text.h"

#include <string.h>

static mote_status read_vertex(mote_mesh_reader *reader, const char *at, mote_frame_file *file)
{
    double xyz[3];
    for (int i = 0; i < 3; ++i) {
        at = mote_mesh_next_word(reader, at);
        const char *end = at;
        if (!mote_is_end(*at))
            xyz[i] = mote_mesh_number(at, &end);
        if (end == at || !mote_mesh_word_ends(reader, end))
            return mote_fail(MOTE_EINVAL,
                             "%s:%zu: a vertex without three numbers; write v x y z",
                             reader->path, reader->line);
        if (!mote_mesh_is_coordinate(xyz[i], end))
            return mote_mesh_refuse_coordinate(reader, end);
        at = end;
    }
    if (file->count < file->room)
        memcpy(file->xyz + 3 * file->count, xyz, sizeof xyz);
    ++file->count;
    return MOTE_OK;
}

/* Reads "7", "7/1", "7//2" or "-1/..." as a vertex from 0; for anything else, *index is a
   number that no file has. */
static const char *read_corner(mote_mesh_reader *reader, const char *at, size_t count,
                               uint64_t *index)
{
    const bool negative = *at == '-';
    const char *p = at + (negative || *at == '+');
    uint64_t number = 0;
    *index = UINT64_MAX;
    for (; mote_is_digit(*p) && number < UINT32_MAX; ++p)
        number = 10 * number + (uint64_t)(*p - '0');
    if (number >= 1 && number <= count && (mote_mesh_word_ends(reader, p) || *p == '/'))
        *index = negative ? count - number : number - 1;
    while (!mote_mesh_word_ends(reader, p))
        ++p;
    return mote_mesh_next_word(reader, p);
}

static mote_status read_face(mote_mesh_reader *reader, const char *at, mote_frame_file *file)
{
    uint64_t corners = 0, hash = file->topology;
    at = mote_mesh_next_word(reader, at);
    for (; !mote_is_end(*at); ++corners) {
        uint64_t index;
        at = read_corner(reader, at, file->count, &index);
        if (index == UINT64_MAX)
            return mote_fail(MOTE_EINVAL,
                             "%s:%zu: a face corner that is none of the vertices before it; "
                             "write f 1 2 3, with numbers from 1 to %zu",
                             reader->path, reader->line, file->count);
        hash = mote_frame_file_hash(hash, index);
    }
    file->topology = mote_frame_file_hash(hash, corners);
    return MOTE_OK;
}

/* The line after this one and the lines joined to it. A comment ends with its line, even after
   a backslash. */
static const char *next_line(const char *at, size_t *line)
{
    for (;;) {
        const char *end = strchr(at, '\n');
        ++*line;
        if (!end)
            return at + strlen(at);
        const bool returned = end > at && end[-1] == '\r';
        const char *last = end - returned;
        const bool joined =
            last > at && last[-1] == '\\' && !memchr(at, '#', (size_t)(last - at));
        at = end + 1;
        if (!joined)
            return at;
    }
}

mote_status mote_frame_file_read_obj(const char *path, const char *text, mote_frame_file *file)
{
    mote_mesh_reader reader = {.path = path, .continues = true};
    mote_status status = MOTE_OK;
    size_t line = 1;
    for (const char *at = mote_skip_mark(text); *at && status == MOTE_OK;
         at = next_line(at, &line)) {
        reader.line = line;
        const char *word = mote_mesh_next_word(&reader, at);
        if (word[0] == 'v' && mote_mesh_word_ends(&reader, word + 1))
            status = read_vertex(&reader, word + 1, file);
        else if (word[0] == 'f' && mote_mesh_word_ends(&reader, word + 1))
            status = read_face(&reader, word + 1, file);
    }
    return status;
}
