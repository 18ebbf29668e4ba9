/* The files that assimp opens, in a C program's streams. Those of a glTF file are in memory:
   what was checked is what assimp reads. */
#include "harness/mesh/mesh_assimp.h"

#include "harness/base/memory.h"
#include "harness/gltf/gltf_uri.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

static FILE *open_memory(const char *data, size_t size)
{
    return fmemopen((void *)(uintptr_t)data, size, "rb");
}

/* A stream of a part of a glTF file by its name in mote_gltf_text. */
static FILE *open_part(mote_assimp_files *files, const char *name)
{
    const size_t length = strlen(MOTE_GLTF_BUFFER);
    mote_gltf_bytes bytes;
    if (strcmp(name, MOTE_ASSIMP_TEXT) == 0)
        return open_memory(files->text, files->size);
    if (strncmp(name, MOTE_GLTF_BUFFER, length) != 0)
        return NULL;
    const mote_status status =
        mote_gltf_load(files->gltf, strtoul(name + length, NULL, 10), &bytes);
    if (status != MOTE_OK)
        files->status = status;
    return status == MOTE_OK ? open_memory(bytes.data, bytes.size) : NULL;
}

/* A stream of a regular file; opening a FIFO must not wait for a writer. */
static FILE *open_path(const char *path)
{
    struct stat info;
    const int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    FILE *opened = NULL;
    if (descriptor >= 0 && fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode))
        opened = fdopen(descriptor, "rb");
    if (descriptor >= 0 && !opened)
        (void)close(descriptor);
    return opened;
}

/* A stream of the mesh file, or of one whose name assimp composes of the mesh's folder and what
   the mesh file says. */
static FILE *open_beside(const char *mesh, const char *composed)
{
    const char *slash = strrchr(mesh, '/');
    const size_t folder = slash ? (size_t)(slash - mesh) + 1 : 0;
    char *path = NULL;
    if (strcmp(mesh, composed) == 0)
        return open_path(mesh);
    if (strncmp(composed, mesh, folder) != 0 ||
        mote_gltf_path(mesh, composed + folder, &path) != MOTE_OK)
        return NULL;
    FILE *opened = open_path(path);
    free(path);
    return opened;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *name, const char *mode)
{
    mote_assimp_files *files = (mote_assimp_files *)(void *)io->UserData;
    FILE *opened = strchr(mode, 'w') ? NULL
                   : files->gltf     ? open_part(files, name)
                                     : open_beside(files->path, name);
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

struct aiFileIO mote_assimp_file_io(mote_assimp_files *files)
{
    return (struct aiFileIO){
        .OpenProc = open_file, .CloseProc = close_file, .UserData = (aiUserData)(void *)files};
}
