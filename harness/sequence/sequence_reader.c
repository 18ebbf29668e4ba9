#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "harness/sequence/sequence_reader.h"

#include "harness/base/clock.h"
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/sequence/frame_file.h"
#include "harness/sequence/point_cache.h"
#include "harness/process/child.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#define FILE_LIMIT ((size_t)4 << 30)
#define MEMORY_BYTES ((size_t)128 << 20) /* plus 1,024 per vertex, for a text file */
#define VERTEX_BYTES 1024
#define SECONDS 10.0 /* per frame, plus one per 100,000 vertices */
#define VERTICES_A_SECOND 1e5
#define POLL_MS 200 /* interval of the checks for a signal */

/* The child's reply about a frame. */
typedef struct reply {
    uint64_t topology, count;
    uint32_t status;
    char text[1024];
} reply;

struct mote_sequence_reader {
    const mote_sequence *sequence;
    pid_t owner; /* the process that reads frames */
    mote_child child;
    int socket;     /* sends frame numbers, receives replies; -1: no process */
    double *shared; /* [3 * file_vertices], written by the child */
    size_t shared_bytes;
};

mote_sequence_reader *mote_sequence_reader_create(const mote_sequence *sequence)
{
    mote_sequence_reader *made = mote_allocate(1, sizeof *made);
    made->sequence = sequence;
    made->socket = -1;
    made->shared_bytes = 3 * sizeof(double) * (size_t)sequence->file_vertices;
    return made;
}

/* Drops the child; ends it if it belongs to this process. */
static void let_go(mote_sequence_reader *r)
{
    if (r->socket >= 0)
        (void)close(r->socket);
    if (r->owner == getpid())
        mote_child_stop(&r->child, 1);
    else if (r->child.pid > 0)
        (void)close(r->child.input);
    if (r->shared)
        (void)munmap(r->shared, r->shared_bytes);
    mote_child_release(&r->child);
    r->child = (mote_child){.input = -1};
    r->socket = -1;
    r->shared = NULL;
}

void mote_sequence_reader_destroy(mote_sequence_reader *reader)
{
    if (!reader)
        return;
    let_go(reader);
    free(reader);
}

/* The child's state. */
typedef struct server {
    const mote_sequence *sequence;
    int socket, other_end;
    double *xyz;
    int cache;            /* an open file, or -1 */
    unsigned char *bytes; /* buffer for a frame of the cache */
} server;

static mote_status read_file(const server *s, uint32_t frame, reply *said)
{
    mote_frame_file file = {.xyz = s->xyz, .room = s->sequence->file_vertices};
    char *path = mote_sequence_path(s->sequence, frame), *data = NULL;
    size_t size;
    mote_status status = mote_file_read(path, FILE_LIMIT, &data, &size);
    if (status == MOTE_OK)
        status = mote_name_ends(path, ".ply")
                     ? mote_frame_file_read_ply(path, data, size, &file, NULL)
                     : mote_frame_file_read_obj(path, data, &file);
    said->count = file.count;
    said->topology = file.topology;
    free(path);
    free(data);
    return status;
}

static mote_status read_cache(server *s, uint32_t frame, reply *said)
{
    const mote_sequence *q = s->sequence;
    const mote_point_cache cache = {.frames = q->frames,
                                    .points = q->file_vertices,
                                    .start = q->start,
                                    .big_endian = q->big_endian};
    if (s->cache < 0) {
        s->cache = open(q->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
        s->bytes = mote_allocate(12, q->file_vertices);
    }
    said->count = q->file_vertices;
    if (s->cache < 0)
        return mote_fail(MOTE_EIO, "%s: %s", q->path, strerror(errno));
    mote_status status = mote_point_cache_read(s->cache, &cache, frame, s->bytes, s->xyz);
    return status == MOTE_OK ? status : mote_fail(status, "%s: %s", q->path, mote_error_text());
}

/* In the child: answers frame by frame until the parent closes its end. */
static mote_status serve(void *context, int output)
{
    (void)output;
    server s = *(const server *)context;
    (void)close(s.other_end);
    for (;;) {
        uint32_t frame;
        reply said;
        memset(&said, 0, sizeof said);
        const ssize_t got = recv(s.socket, &frame, sizeof frame, 0);
        if (got < 0 && errno == EINTR)
            continue;
        if (got != sizeof frame)
            return MOTE_OK;
        const mote_status status = s.sequence->kind == MOTE_SEQUENCE_CACHE
                                       ? read_cache(&s, frame, &said)
                                       : read_file(&s, frame, &said);
        said.status = (uint32_t)status;
        if (status != MOTE_OK)
            (void)snprintf(said.text, sizeof said.text, "%s", mote_error_text());
        if (send(s.socket, &said, sizeof said, MSG_NOSIGNAL) != (ssize_t)sizeof said)
            return MOTE_OK;
    }
}

static mote_status start(mote_sequence_reader *r)
{
    int ends[2];
    let_go(r);
    void *shared =
        mmap(NULL, r->shared_bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED)
        mote_out_of_memory(r->shared_bytes);
    r->shared = shared;
    r->owner = getpid();
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        return mote_fail(MOTE_EIO, "%s: no socket: %s", r->sequence->path, strerror(errno));
    server s = {.sequence = r->sequence,
                .socket = ends[1],
                .other_end = ends[0],
                .xyz = r->shared,
                .cache = -1};
    const mote_child_limits limits = {
        .memory_bytes = MEMORY_BYTES + (size_t)VERTEX_BYTES * r->sequence->file_vertices,
        .confined = true};
    const mote_status status = mote_child_start(serve, &s, limits, &r->child);
    (void)close(ends[1]);
    if (status == MOTE_OK)
        r->socket = ends[0];
    else
        (void)close(ends[0]);
    return status;
}

/* Waits for the child's reply; distinguishes it from the child's end, including a crash. */
static mote_status wait_for(mote_sequence_reader *r, reply *said)
{
    const double deadline =
        mote_clock_seconds() + SECONDS + r->sequence->file_vertices / VERTICES_A_SECOND;
    while (mote_clock_seconds() < deadline) {
        struct pollfd watch = {.fd = r->socket, .events = POLLIN};
        const int ready = poll(&watch, 1, POLL_MS);
        if (mote_child_stop_asked())
            return mote_child_stopped(NULL);
        if (ready <= 0)
            continue;
        const ssize_t got = recv(r->socket, said, sizeof *said, 0);
        if (got < 0 && errno == EINTR)
            continue;
        /* A child that ends before it has read the question resets the connection. */
        if (got < 0 && errno != ECONNRESET)
            return mote_fail(MOTE_EIO, "reading it: %s", strerror(errno));
        if (got == (ssize_t)sizeof *said)
            return MOTE_OK;
        size_t index;
        const mote_status status = mote_child_wait(&r->child, 1, &index);
        return status != MOTE_OK ? status
                                 : mote_fail(MOTE_EIO, "reading it: %s", r->child.text);
    }
    return mote_fail(MOTE_EIO, "reading it took too long");
}

static mote_status ask(mote_sequence_reader *r, uint32_t frame, reply *said)
{
    mote_status status = MOTE_OK;
    if (r->socket < 0 || r->owner != getpid())
        status = start(r);
    if (status == MOTE_OK && send(r->socket, &frame, sizeof frame, MSG_NOSIGNAL) < 0)
        status = mote_fail(MOTE_EIO, "reading it ended: %s", strerror(errno));
    if (status == MOTE_OK)
        status = wait_for(r, said);
    if (status != MOTE_OK)
        return status;
    said->text[sizeof said->text - 1] = '\0';
    if (said->status != MOTE_OK)
        return mote_fail(said->status <= MOTE_ENUMERIC ? (mote_status)said->status : MOTE_EIO,
                         "%s", said->text);
    return MOTE_OK;
}

/* Prefixes the error text with the frame, and with the file unless the text begins with it. */
static mote_status blame(const mote_sequence *s, uint32_t frame, mote_status status)
{
    char text[1024];
    char *path = mote_sequence_path(s, frame);
    (void)snprintf(text, sizeof text, "%s", mote_error_text());
    const bool named = strncmp(text, path, strlen(path)) == 0;
    status = mote_fail(status, "frame %u: %s%s%s", frame, named ? "" : path, named ? "" : ": ",
                       text);
    free(path);
    return status;
}

static mote_status check(const mote_sequence *s, const reply *said)
{
    if (said->count != s->file_vertices)
        return mote_fail(MOTE_EINVAL,
                         "%llu vertices, where %s has %u; give files of one topology",
                         (unsigned long long)said->count, s->path, s->file_vertices);
    if (s->kind == MOTE_SEQUENCE_FILES && said->topology != s->topology)
        return mote_fail(MOTE_EINVAL,
                         "other faces than %s has; give files of one topology, with faces and "
                         "vertices in the same order",
                         s->path);
    return MOTE_OK;
}

static mote_status copy(const mote_sequence *s, const double *xyz, mote_vec3 *positions)
{
    for (uint32_t v = 0; v < s->vertex_count; ++v) {
        const double *p = xyz + (size_t)3 * (s->file_vertex ? s->file_vertex[v] : v);
        const mote_vec3 at = {p[0], p[1], p[2]};
        if (!(fabs(at.x) <= s->limit && fabs(at.y) <= s->limit && fabs(at.z) <= s->limit))
            return mote_fail(MOTE_EINVAL,
                             "vertex %u is at (%g, %g, %g); give finite coordinates of at most "
                             "%g, a billion times the mesh",
                             (s->file_vertex ? s->file_vertex[v] : v) + 1, at.x, at.y, at.z,
                             s->limit);
        positions[v] = mote_vec3_make(at.x * s->scale.x, at.y * s->scale.y, at.z * s->scale.z);
    }
    return MOTE_OK;
}

mote_status mote_sequence_read(mote_sequence_reader *reader, uint32_t frame,
                               mote_vec3 *positions)
{
    const mote_sequence *s = reader->sequence;
    reply said = {0};
    mote_status status = ask(reader, frame, &said);
    if (status == MOTE_OK)
        status = check(s, &said);
    if (status == MOTE_OK)
        status = copy(s, reader->shared, positions);
    if (status == MOTE_OK)
        return status;
    let_go(reader); /* the next frame starts a new child */
    return blame(s, frame, status);
}
