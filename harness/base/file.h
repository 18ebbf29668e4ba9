/* Files: read whole up to a size limit, written whole or not at all. */
#ifndef MOTE_HARNESS_FILE_H
#define MOTE_HARNESS_FILE_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads a regular file of at most limit bytes; *text ends with a 0 byte that *size does not
   count. MOTE_EIO when it cannot be opened or read, MOTE_EINVAL when it is not a regular file
   (a directory, FIFO or device is never opened for reading) or is larger than limit. The caller
   frees *text. */
mote_status mote_file_read(const char *path, size_t limit, char **text, size_t *size);

/* The text after its UTF-8 byte-order mark, which some editors write, or all of it if it has
   none. */
const char *mote_skip_mark(const char *text);

/* Writes a file under a temporary name beside path, syncs it and renames it, so a file at path
   is always complete. Links at the end of path are followed and kept. A stream is written to
   and never replaced. MOTE_EIO with a text. */
mote_status mote_file_write(const char *path, const void *data, size_t size);

/* The temporary name, "PATH.PID.part", under which this process writes the file at path. The
   caller frees it. */
char *mote_part_name(const char *path);

/* The length of NAME if a file's name is NAME.PID.part, as left by an interrupted write; 0 if
   it is not. */
size_t mote_part_length(const char *name);

/* Whether path names a stream: a device, a FIFO, a socket, or the file that this program's
   standard output or error goes to. A stream cannot be replaced by a rename. */
bool mote_path_is_stream(const char *path);

/* Whether path names the file that this program's standard output goes to. */
bool mote_path_is_output(const char *path);

/* A descriptor for writing to a stream, which the caller closes; -1 with errno. */
int mote_stream_open(const char *path);

/* path with the links at its end followed, even if the target does not exist yet. NULL with
   errno ELOOP if the links form a circle. The caller frees it. */
char *mote_path_follow(const char *path);

/* Makes a directory and its missing parents. MOTE_EIO if one cannot be made, is not a
   directory, or cannot be written to; errno then holds the reason. */
mote_status mote_directory_make(const char *path);

/* printf into new memory. The caller frees it. */
char *mote_format(const char *format, ...) MOTE_PRINTF(1, 2);

/* The path of the file that the file at `file` calls `name`: relative to that file's folder
   unless absolute. The caller frees it. */
char *mote_path_beside(const char *file, const char *name);

/* Whether a path is relative and none of its parts is "..": it then stays in the folder that it
   starts from. */
bool mote_path_goes_down(const char *path);

/* Whether a name is longer than this ending and ends with it, in capitals or not:
   mote_name_ends(name, ".json"). */
bool mote_name_ends(const char *name, const char *ending);

/* A growing text with a final 0 byte. Zero-initialise: data is NULL until something is added.
   Free data. */
typedef struct mote_text {
    char *data;
    size_t size, capacity;
} mote_text;

void mote_text_add(mote_text *text, const char *format, ...) MOTE_PRINTF(2, 3);

#endif
