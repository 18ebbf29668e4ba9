#include "harness/base/file.h"

#include "harness/base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#define LINKS_MAX 40 /* links followed for one path; the same limit as the kernel's */

static mote_status read_descriptor(int descriptor, const char *path, size_t limit, char **text,
                                   size_t *size)
{
    struct stat info;
    if (fstat(descriptor, &info) != 0)
        return mote_fail(MOTE_EIO, "%s: %s", path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return mote_fail(MOTE_EINVAL, "%s: not a regular file; name a file", path);
    if ((uint64_t)info.st_size > limit)
        return mote_fail(MOTE_EINVAL, "%s: %lld bytes; at most %zu are read", path,
                         (long long)info.st_size, limit);
    size_t expected = (size_t)info.st_size;
    char *data = mote_resize(NULL, expected + 1, 1);
    size_t done = 0;
    while (done < expected) {
        ssize_t got = read(descriptor, data + done, expected - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            int error = errno;
            free(data);
            return mote_fail(MOTE_EIO, "%s: %s", path, strerror(error));
        }
        if (got == 0)
            break;
        done += (size_t)got;
    }
    data[done] = '\0';
    *text = data;
    *size = done;
    return MOTE_OK;
}

const char *mote_skip_mark(const char *text)
{
    return strncmp(text, "\xef\xbb\xbf", 3) == 0 ? text + 3 : text;
}

mote_status mote_file_read(const char *path, size_t limit, char **text, size_t *size)
{
    /* O_NONBLOCK: opening a FIFO must not wait for a writer. */
    int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
        return mote_fail(MOTE_EIO, "%s: %s; name a file that can be read", path,
                         strerror(errno));
    mote_status status = read_descriptor(descriptor, path, limit, text, size);
    (void)close(descriptor);
    return status;
}

static bool write_all(int descriptor, const char *data, size_t size)
{
    while (size > 0) {
        ssize_t put = write(descriptor, data, size);
        if (put < 0 && errno == EINTR)
            continue;
        if (put < 0)
            return false;
        data += put;
        size -= (size_t)put;
    }
    return true;
}

/* Syncs the directory of the path: without this, a power cut may undo a rename in it. */
static bool sync_directory(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *directory =
        slash ? mote_format("%.*s/", (int)(slash - path), path) : mote_format(".");
    int descriptor = open(directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    /* Some file systems cannot sync a directory and fail with EINVAL. */
    bool synced = descriptor >= 0 && (fsync(descriptor) == 0 || errno == EINVAL);
    if (descriptor >= 0)
        (void)close(descriptor);
    free(directory);
    return synced;
}

/* The descriptor of standard output or error if it is this file, otherwise -1. */
static int own_stream(const struct stat *file)
{
    for (int descriptor = STDOUT_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        struct stat own;
        if (fstat(descriptor, &own) == 0 && own.st_dev == file->st_dev &&
            own.st_ino == file->st_ino)
            return descriptor;
    }
    return -1;
}

static bool is_stream(const struct stat *file)
{
    return !S_ISDIR(file->st_mode) && (!S_ISREG(file->st_mode) || own_stream(file) >= 0);
}

bool mote_path_is_stream(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && is_stream(&info);
}

bool mote_path_is_output(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && own_stream(&info) == STDOUT_FILENO;
}

int mote_stream_open(const char *path)
{
    struct stat info;
    const int own = stat(path, &info) == 0 ? own_stream(&info) : -1;
    if (own < 0)
        return open(path, O_WRONLY | O_CLOEXEC);
    /* If the file were opened again, writing would start at its beginning. */
    (void)fflush(own == STDOUT_FILENO ? stdout : stderr);
    return fcntl(own, F_DUPFD_CLOEXEC, 0);
}

char *mote_path_follow(const char *path)
{
    char *at = mote_duplicate(path);
    for (int links = 0; at; ++links) {
        char target[4096];
        const ssize_t length = readlink(at, target, sizeof target - 1);
        if (length < 0)
            return at;
        target[length] = '\0';
        char *next = links < LINKS_MAX ? mote_path_beside(at, target) : NULL;
        free(at);
        at = next;
        errno = links < LINKS_MAX ? errno : ELOOP;
    }
    return NULL;
}

/* Closes a descriptor, unless it is negative, that was written to, or not. Whether all was
   well; errno tells what was not. */
static bool close_written(int descriptor, bool written)
{
    const int error = errno;
    const bool closed = descriptor < 0 || close(descriptor) == 0;
    if (!written)
        errno = error;
    return written && closed;
}

static mote_status write_stream(const char *path, const void *data, size_t size)
{
    const int descriptor = mote_stream_open(path);
    const bool written = descriptor >= 0 && write_all(descriptor, data, size);
    return close_written(descriptor, written)
               ? MOTE_OK
               : mote_fail(MOTE_EIO, "%s: cannot be written: %s", path, strerror(errno));
}

/* Writes the file beside `target`, which does not end in a link, and renames it. */
static bool replace_file(const char *target, const char *beside, const void *data, size_t size)
{
    int descriptor = open(beside, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    bool whole = descriptor >= 0 && write_all(descriptor, data, size) && fsync(descriptor) == 0;
    whole = close_written(descriptor, whole) && rename(beside, target) == 0 &&
            sync_directory(target);
    const int error = errno;
    if (!whole && descriptor >= 0)
        (void)unlink(beside);
    errno = error;
    return whole;
}

static const char *write_advice(int error)
{
    if (error == ENOSPC || error == EDQUOT || error == EFBIG)
        return "make room, or name a file elsewhere";
    return "name a file in a folder that exists and can be written to";
}

#define PART_ENDING ".part"

char *mote_part_name(const char *path)
{
    return mote_format("%s.%ld" PART_ENDING, path, (long)getpid());
}

size_t mote_part_length(const char *name)
{
    if (!mote_name_ends(name, PART_ENDING))
        return 0;
    const size_t end = strlen(name) - strlen(PART_ENDING);
    size_t dot = end;
    while (dot > 0 && name[dot - 1] >= '0' && name[dot - 1] <= '9')
        --dot;
    return dot < end && dot > 1 && name[dot - 1] == '.' ? dot - 1 : 0;
}

mote_status mote_file_write(const char *path, const void *data, size_t size)
{
    struct stat info;
    const bool exists = stat(path, &info) == 0;
    if (exists && is_stream(&info))
        return write_stream(path, data, size);
    /* What cannot be looked at may be a device, which must not be replaced. */
    char *target = exists || errno == ENOENT ? mote_path_follow(path) : NULL;
    if (!target)
        return mote_fail(MOTE_EIO, "%s: cannot be written: %s", path, strerror(errno));
    char *beside = mote_part_name(target);
    mote_status status = MOTE_OK;
    if (!replace_file(target, beside, data, size))
        status = mote_fail(MOTE_EIO, "%s: cannot be written: %s; %s", path, strerror(errno),
                           write_advice(errno));
    free(target);
    free(beside);
    return status;
}

static mote_status make_one(const char *path)
{
    if (mkdir(path, 0777) == 0)
        return MOTE_OK;
    int error = errno;
    struct stat info;
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
        return MOTE_OK;
    error = error == EEXIST ? ENOTDIR : error;
    mote_status status =
        mote_fail(MOTE_EIO, "%s: cannot be made: %s; name a directory that can be written to",
                  path, strerror(error));
    errno = error;
    return status;
}

mote_status mote_directory_make(const char *path)
{
    char *prefix = mote_duplicate(path);
    mote_status status = MOTE_OK;
    for (char *slash = path[0] ? strchr(prefix + 1, '/') : NULL; slash && status == MOTE_OK;
         slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        status = make_one(prefix);
        *slash = '/';
    }
    int error = errno;
    free(prefix);
    errno = error;
    if (status == MOTE_OK)
        status = make_one(path);
    if (status == MOTE_OK && access(path, W_OK | X_OK) != 0) {
        error = errno;
        status = mote_fail(MOTE_EIO, "%s: %s; name a directory that can be written to", path,
                           strerror(error));
        errno = error;
    }
    return status;
}

static void MOTE_PRINTF(2, 0) add_text(mote_text *text, const char *format, va_list arguments)
{
    va_list again;
    va_copy(again, arguments);
    const int size = vsnprintf(NULL, 0, format, arguments);
    if (size < 0)
        mote_out_of_memory(0); /* longer than INT_MAX */
    text->data = mote_reserve(text->data, text->size + (size_t)size + 1, &text->capacity, 1);
    (void)vsnprintf(text->data + text->size, (size_t)size + 1, format, again);
    text->size += (size_t)size;
    va_end(again);
}

char *mote_format(const char *format, ...)
{
    mote_text text = {0};
    va_list arguments;
    va_start(arguments, format);
    add_text(&text, format, arguments);
    va_end(arguments);
    return text.data;
}

char *mote_path_beside(const char *file, const char *name)
{
    const char *slash = name[0] == '/' ? NULL : strrchr(file, '/');
    return mote_format("%.*s%s", slash ? (int)(slash - file) + 1 : 0, file, name);
}

bool mote_path_goes_down(const char *path)
{
    if (path[0] == '/')
        return false;
    for (const char *part = path; *part; part += strspn(part, "/")) {
        const size_t length = strcspn(part, "/");
        if (length == 2 && strncmp(part, "..", 2) == 0)
            return false;
        part += length;
    }
    return true;
}

bool mote_name_ends(const char *name, const char *ending)
{
    const size_t length = strlen(name), size = strlen(ending);
    return length > size && strcasecmp(name + length - size, ending) == 0;
}

void mote_text_add(mote_text *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_text(text, format, arguments);
    va_end(arguments);
}
