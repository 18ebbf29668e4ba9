/* The files that assimp opens, in a C program's streams: it opens a buffer named a%20b.bin,
   which its own way takes for the name of a file (assimp 5.2), as "a b.bin". */
#include "harness/mesh/mesh_assimp.h"

#include "harness/base/memory.h"
#include "harness/mesh/uri.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static FILE *stream(const struct aiFile *file)
{
    return (FILE *)(void *)file->UserData;
}

static size_t read_bytes(struct aiFile *file, char *to, size_t size, size_t count)
{
    return fread(to, size, count, stream(file));
}

static size_t write_nothing(struct aiFile *file, const char *from, size_t size, size_t count)
{
    (void)file;
    (void)from;
    (void)size;
    (void)count;
    return 0;
}

static size_t position(struct aiFile *file)
{
    const long at = ftell(stream(file));
    return at < 0 ? 0 : (size_t)at;
}

static enum aiReturn seek(struct aiFile *file, size_t offset, enum aiOrigin from)
{
    static const int whence[] = {
        [aiOrigin_SET] = SEEK_SET, [aiOrigin_CUR] = SEEK_CUR, [aiOrigin_END] = SEEK_END};
    return fseek(stream(file), (long)offset, whence[from]) == 0 ? aiReturn_SUCCESS
                                                                : aiReturn_FAILURE;
}

static size_t size_of(struct aiFile *file)
{
    const size_t at = position(file);
    (void)seek(file, 0, aiOrigin_END);
    const size_t size = position(file);
    (void)seek(file, at, aiOrigin_SET);
    return size;
}

static void flush(struct aiFile *file)
{
    (void)file;
}

/* The path to open for one that assimp composes of the mesh's folder and a URI. */
static char *path_to_open(const char *mesh, const char *composed)
{
    const char *slash = strrchr(mesh, '/');
    const size_t folder = slash ? (size_t)(slash - mesh) + 1 : 0;
    return strncmp(composed, mesh, folder) == 0 ? mote_uri_path(mesh, composed + folder)
                                                : mote_uri_path("", composed);
}

static struct aiFile *open_file(struct aiFileIO *files, const char *composed, const char *mode)
{
    char *path = path_to_open(files->UserData, composed);
    FILE *opened = strchr(mode, 'w') ? NULL : fopen(path, mode);
    free(path);
    if (!opened)
        return NULL;
    struct aiFile *file = mote_allocate(1, sizeof *file);
    *file = (struct aiFile){.ReadProc = read_bytes,
                            .WriteProc = write_nothing,
                            .TellProc = position,
                            .FileSizeProc = size_of,
                            .SeekProc = seek,
                            .FlushProc = flush,
                            .UserData = (aiUserData)(void *)opened};
    return file;
}

static void close_file(struct aiFileIO *files, struct aiFile *file)
{
    (void)files;
    (void)fclose(stream(file));
    free(file);
}

struct aiFileIO mote_assimp_files(char *path)
{
    return (struct aiFileIO){.OpenProc = open_file, .CloseProc = close_file, .UserData = path};
}
