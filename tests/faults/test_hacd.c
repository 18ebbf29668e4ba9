/* HACD in its child process, whatever it does there, and whatever becomes of what the child
   says. The linker replaces its main function and calls of libc by those below (--wrap). */
#include "core/parts/parts.h"
#include "datasets/letter.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"
#include "tests/faults/thrown.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

bool __real__ZN4HACD4HACD7ComputeEbb(void *hacd, bool full, bool exclude);
bool __wrap__ZN4HACD4HACD7ComputeEbb(void *hacd, bool full, bool exclude);

int __real_pipe(int ends[2]);
pid_t __real_fork(void);
int __wrap_pipe(int ends[2]);
pid_t __wrap_fork(void);

ssize_t __real_write(int file, const void *data, size_t size);
int __real_poll(struct pollfd *files, nfds_t count, int wait);
ssize_t __real_read(int file, void *data, size_t size);
pid_t __real_wait4(pid_t process, int *status, int options, struct rusage *used);
ssize_t __wrap_write(int file, const void *data, size_t size);
int __wrap_poll(struct pollfd *files, nfds_t count, int wait);
ssize_t __wrap_read(int file, void *data, size_t size);
pid_t __wrap_wait4(pid_t process, int *status, int options, struct rusage *used);

static bool is_without_pipe, is_without_fork, is_child;

int __wrap_pipe(int ends[2])
{
    errno = EMFILE;
    return is_without_pipe ? -1 : __real_pipe(ends);
}

pid_t __wrap_fork(void)
{
    errno = EAGAIN;
    const pid_t process = is_without_fork ? -1 : __real_fork();
    is_child = process == 0;
    return process;
}

/* How the child says what HACD made of a component: {count, part of each face}. */
static enum {
    SAYS_IT,
    SAYS_IT_IN_PIECES,
    SAYS_NOTHING,
    SAYS_NO_PART,
    SAYS_A_PART_TOO_HIGH,
} child_does;

/* Says it with one of the numbers changed. */
static ssize_t write_changed(int file, const uint32_t *said, size_t size, size_t place,
                             uint32_t number)
{
    uint32_t *changed = malloc(size);
    if (!changed)
        return -1;
    memcpy(changed, said, size);
    changed[place] = number;
    const ssize_t written = __real_write(file, changed, size);
    free(changed);
    return written;
}

#ifdef MOTE_COVERAGE
void __gcov_dump(void);
void __gcov_reset(void);
#endif

ssize_t __wrap_write(int file, const void *data, size_t size)
{
    if (!is_child)
        return __real_write(file, data, size);
#ifdef MOTE_COVERAGE
    __gcov_dump(); /* the parent may kill it as soon as it has heard this */
    __gcov_reset();
#endif
    const uint32_t *said = data;
    switch (child_does) {
    case SAYS_IT_IN_PIECES:
        return __real_write(file, data, size < 7 ? size : 7);
    case SAYS_NOTHING:
        errno = EPIPE;
        return -1;
    case SAYS_NO_PART:
        return write_changed(file, said, size, 0, 0);
    case SAYS_A_PART_TOO_HIGH:
        return write_changed(file, said, size, size / sizeof *said - 1, said[0]);
    case SAYS_IT:
        break;
    }
    return __real_write(file, data, size);
}

/* How often each of the parent's calls is interrupted, and how it fails in another way. */
static struct {
    int poll, read, wait4;
} interruptions;
static enum { HEARS, HEARS_LATE, HEARS_NOTHING, CANNOT_READ } parent_does;

static bool is_interrupted(int *left)
{
    if (*left == 0)
        return false;
    --*left;
    errno = EINTR;
    return true;
}

int __wrap_poll(struct pollfd *files, nfds_t count, int wait)
{
    if (is_interrupted(&interruptions.poll))
        return -1;
    errno = ENOMEM;
    return parent_does == HEARS_LATE      ? 0
           : parent_does == HEARS_NOTHING ? -1
                                          : __real_poll(files, count, wait);
}

ssize_t __wrap_read(int file, void *data, size_t size)
{
    if (is_interrupted(&interruptions.read))
        return -1;
    errno = EIO;
    return parent_does == CANNOT_READ ? -1 : __real_read(file, data, size);
}

pid_t __wrap_wait4(pid_t process, int *status, int options, struct rusage *used)
{
    return is_interrupted(&interruptions.wait4) ? -1
                                                : __real_wait4(process, status, options, used);
}

static enum {
    HACD_WORKS,
    HACD_FAILS,
    HACD_THROWS,
    HACD_THROWS_A_NUMBER,
    HACD_HAS_NO_MEMORY,
    HACD_ABORTS,
    HACD_SEGFAULTS,
    HACD_LOOPS,
    HACD_CASES
} hacd_does;

/* Where it loops, its time is up at once, if there is a limit as promised. */
static void loop_for_ever(void)
{
    struct itimerval limit;
    (void)getitimer(ITIMER_PROF, &limit);
    const bool is_limited = limit.it_value.tv_sec + limit.it_value.tv_usec > 0 &&
                            limit.it_value.tv_sec <= MOTE_PARTS_SECONDS;
    limit.it_value = (struct timeval){.tv_usec = 10000};
    if (is_limited)
        (void)setitimer(ITIMER_PROF, &limit, NULL);
    for (volatile bool ever = is_limited; ever;)
        continue;
}

bool __wrap__ZN4HACD4HACD7ComputeEbb(void *hacd, bool full, bool exclude)
{
    switch (hacd_does) {
    case HACD_FAILS:
        return false;
    case HACD_THROWS:
        _ZSt20__throw_length_errorPKc("planted");
    case HACD_THROWS_A_NUMBER:
        __cxa_throw(__cxa_allocate_exception(sizeof(int)), _ZTIi, NULL);
    case HACD_HAS_NO_MEMORY:
        _ZSt17__throw_bad_allocv();
    case HACD_ABORTS:
        abort();
    case HACD_SEGFAULTS:
        (void)raise(SIGSEGV);
        break;
    case HACD_LOOPS:
        loop_for_ever();
        break;
    case HACD_WORKS:
    case HACD_CASES:
        break;
    }
    return __real__ZN4HACD4HACD7ComputeEbb(hacd, full, exclude);
}

/* Whatever HACD does to its process, the parts are there: two of a letter V by the planes of
   its faces, at least, since its arms are in front of each other. */
TEST(parts_when_hacd_fails_are_those_of_the_planes)
{
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_letter_create('V', 400, &mesh), MOTE_OK);
    uint32_t left = 0, right = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const mote_vec3 p = mesh->positions[v], l = mesh->positions[left],
                        r = mesh->positions[right];
        if (p.y - p.x > l.y - l.x)
            left = v;
        if (p.y + p.x > r.y + r.x)
            right = v;
    }
    for (int does = HACD_WORKS; does < HACD_CASES; ++does) {
        if (does == HACD_HAS_NO_MEMORY)
            continue;
        mote_parts *parts = NULL;
        hacd_does = does;
        assert_int_equal(mote_parts_create(mesh, NULL, &parts), MOTE_OK);
        hacd_does = HACD_WORKS;
        assert_int_equal(parts->without_hacd, does != HACD_WORKS);
        assert_in_range(parts->count, 2, 20);
        assert_int_not_equal(parts->label[left], parts->label[right]);
        mote_parts_destroy(parts);
    }
    mote_mesh_destroy(mesh);
}

/* Three squares in the shape of an L, which are flat: the inner corner parts them. */
TEST(parts_by_planes_of_a_sheet_go_by_its_outline)
{
    static const double xyz[8][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0},
                                     {1, 1, 0}, {2, 1, 0}, {0, 2, 0}, {1, 2, 0}};
    static const uint32_t faces[6][3] = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5},
                                         {1, 5, 4}, {3, 4, 7}, {3, 7, 6}};
    for (uint32_t triangles = 4; triangles <= 6; triangles += 2) {
        mote_mesh *mesh = NULL;
        const uint32_t points = triangles == 4 ? 6 : 8;
        assert_int_equal(mote_mesh_create(xyz[0], points, faces[0], triangles, &mesh), MOTE_OK);
        mote_parts *parts = NULL;
        hacd_does = HACD_FAILS;
        assert_int_equal(mote_parts_create(mesh, NULL, &parts), MOTE_OK);
        hacd_does = HACD_WORKS;
        assert_int_equal(parts->without_hacd, triangles == 6);
        assert_int_equal(parts->count, triangles == 6 ? 2 : 1);
        assert_true(triangles == 4 || parts->label[2] != parts->label[6]);
        mote_parts_destroy(parts);
        mote_mesh_destroy(mesh);
    }
}

/* HACD's process needs no answer from a caller who reaps no children, and leaves his handlers.
 */
TEST(parts_where_children_are_ignored_are_the_same)
{
    mote_mesh *mesh = solid_to_mesh(solid_torus(9, 9));
    mote_parts *parts[2] = {NULL, NULL};
    assert_int_equal(mote_parts_create(mesh, NULL, &parts[0]), MOTE_OK);
    void (*before)(int) = signal(SIGCHLD, SIG_IGN);
    assert_int_equal(mote_parts_create(mesh, NULL, &parts[1]), MOTE_OK);
    assert_true(signal(SIGCHLD, before) == SIG_IGN);
    assert_int_equal(parts[1]->count, parts[0]->count);
    assert_int_equal(parts[1]->without_hacd, 0);
    assert_memory_equal(parts[1]->label, parts[0]->label,
                        mesh->vertex_count * sizeof *parts[0]->label);
    for (int k = 0; k < 2; ++k)
        mote_parts_destroy(parts[k]);
    mote_mesh_destroy(mesh);
}

TEST(parts_without_a_process_say_so)
{
    static const char *const texts[] = {"no pipe to a process for HACD: ",
                                        "no process for HACD: "};
    mote_mesh *mesh = solid_to_mesh(solid_torus(5, 4));
    for (int k = 0; k < 2; ++k) {
        mote_parts *parts = NULL;
        is_without_pipe = k == 0;
        is_without_fork = k == 1;
        assert_int_equal(mote_parts_create(mesh, NULL, &parts), MOTE_ENOMEM);
        is_without_pipe = is_without_fork = false;
        assert_null(parts);
        assert_non_null(strstr(mote_error_text(), texts[k]));
        assert_non_null(strstr(mote_error_text(), strerror(k == 0 ? EMFILE : EAGAIN)));
    }
    mote_mesh_destroy(mesh);
}

TEST(parts_when_hacd_has_no_memory_say_so)
{
    mote_mesh *mesh = solid_to_mesh(solid_torus(5, 4));
    mote_parts *parts = NULL;
    hacd_does = HACD_HAS_NO_MEMORY;
    assert_int_equal(mote_parts_create(mesh, NULL, &parts), MOTE_ENOMEM);
    hacd_does = HACD_WORKS;
    assert_null(parts);
    assert_string_equal(mote_error_text(), "no memory for the convex parts");
    mote_mesh_destroy(mesh);
}

static mote_parts *parts_of(const mote_mesh *mesh)
{
    mote_parts *parts = NULL;
    if (mote_parts_create(mesh, NULL, &parts) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    return parts;
}

static void expect_same_parts(const mote_parts *a, const mote_parts *b)
{
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->without_hacd, b->without_hacd);
    assert_memory_equal(a->label, b->label, a->vertex_count * sizeof *a->label);
}

/* Calls that are interrupted, and a message that comes in pieces, change nothing. There are two
   components, so that something is left to hear after the first. */
TEST(parts_are_heard_in_pieces_and_through_interruptions)
{
    mote_mesh *mesh = solid_to_mesh(solid_join(solid_torus(7, 5), solid_torus(5, 4), 5));
    mote_parts *expected = parts_of(mesh);
    assert_int_equal(expected->without_hacd, 0);
    child_does = SAYS_IT_IN_PIECES;
    mote_parts *parts = parts_of(mesh);
    child_does = SAYS_IT;
    expect_same_parts(parts, expected);
    mote_parts_destroy(parts);
    interruptions.poll = interruptions.read = interruptions.wait4 = 2;
    parts = parts_of(mesh);
    expect_same_parts(parts, expected);
    assert_int_equal(interruptions.poll + interruptions.read + interruptions.wait4, 0);
    mote_parts_destroy(parts);
    mote_parts_destroy(expected);
    mote_mesh_destroy(mesh);
}

/* Components of which nothing is heard, or what cannot be, are split by their planes. */
TEST(parts_that_are_not_heard_are_those_of_the_planes)
{
    mote_mesh *mesh = solid_to_mesh(solid_join(solid_torus(7, 5), solid_torus(5, 4), 5));
    hacd_does = HACD_FAILS;
    mote_parts *expected = parts_of(mesh);
    hacd_does = HACD_WORKS;
    assert_int_equal(expected->without_hacd, 2);
    for (int does = SAYS_NOTHING; does <= SAYS_A_PART_TOO_HIGH; ++does) {
        test_row("the child does %d", does);
        child_does = does;
        mote_parts *parts = parts_of(mesh);
        child_does = SAYS_IT;
        expect_same_parts(parts, expected);
        mote_parts_destroy(parts);
    }
    for (int does = HEARS_LATE; does <= CANNOT_READ; ++does) {
        test_row("the parent does %d", does);
        parent_does = does;
        mote_parts *parts = parts_of(mesh);
        parent_does = HEARS;
        expect_same_parts(parts, expected);
        mote_parts_destroy(parts);
    }
    /* Where the first takes all of the time, the second has none. */
    hacd_does = HACD_LOOPS;
    mote_parts *parts = parts_of(mesh);
    hacd_does = HACD_WORKS;
    expect_same_parts(parts, expected);
    mote_parts_destroy(parts);
    mote_parts_destroy(expected);
    mote_mesh_destroy(mesh);
}

/* A solid whose faces look inwards has the parts of the one that looks outwards. */
TEST(parts_by_planes_of_a_solid_inside_out_are_the_same)
{
    mote_mesh *mesh = solid_to_mesh(solid_torus(7, 5)), *turned = NULL;
    uint32_t(*faces)[3] = malloc(mesh->triangle_count * sizeof *faces);
    assert_non_null(faces);
    for (uint32_t f = 0; f < mesh->triangle_count; ++f) {
        for (int k = 0; k < 3; ++k)
            faces[f][k] = mesh->triangles[f][(3 - k) % 3];
    }
    assert_int_equal(mote_mesh_create(&mesh->positions[0].x, mesh->vertex_count, faces[0],
                                      mesh->triangle_count, &turned),
                     MOTE_OK);
    free(faces);
    hacd_does = HACD_FAILS;
    mote_parts *outwards = parts_of(mesh), *inwards = parts_of(turned);
    hacd_does = HACD_WORKS;
    assert_in_range(outwards->count, 2, 20);
    expect_same_parts(inwards, outwards);
    mote_parts_destroy(outwards);
    mote_parts_destroy(inwards);
    mote_mesh_destroy(mesh);
    mote_mesh_destroy(turned);
}

/* A square with a dent in one side, too deep for a convex sheet, but not for a part. */
TEST(parts_by_planes_of_a_dented_sheet_are_one)
{
    static const double xyz[5][3] = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 0.95, 0}, {0, 1, 0}};
    static const uint32_t faces[3][3] = {{0, 1, 3}, {1, 2, 3}, {0, 3, 4}};
    mote_mesh *mesh = NULL;
    assert_int_equal(mote_mesh_create(xyz[0], 5, faces[0], 3, &mesh), MOTE_OK);
    mote_parts *parts = NULL;
    hacd_does = HACD_FAILS;
    assert_int_equal(mote_parts_create(mesh, NULL, &parts), MOTE_OK);
    hacd_does = HACD_WORKS;
    assert_int_equal(parts->without_hacd, 1);
    assert_int_equal(parts->count, 1);
    mote_parts_destroy(parts);
    mote_mesh_destroy(mesh);
}
