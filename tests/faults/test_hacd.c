/* HACD in its child process, whatever it does there. The linker replaces its main function by
   the one below (--wrap). */
#include "core/parts/parts.h"
#include "datasets/letter.h"
#include "tests/support/solids.h"
#include "tests/support/test.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

/* The C++ ABI names of std::length_error and the type info of int, on systems whose size_t is
   an unsigned long. */
extern const char _ZTIi[];
_Noreturn void _ZSt20__throw_length_errorPKc(const char *what);
void *__cxa_allocate_exception(size_t size);
_Noreturn void __cxa_throw(void *thrown, const void *type, void (*destroy)(void *));
bool __real__ZN4HACD4HACD7ComputeEbb(void *hacd, bool full, bool exclude);
bool __wrap__ZN4HACD4HACD7ComputeEbb(void *hacd, bool full, bool exclude);

int __real_pipe(int ends[2]);
pid_t __real_fork(void);
int __wrap_pipe(int ends[2]);
pid_t __wrap_fork(void);

static bool is_without_pipe, is_without_fork;

int __wrap_pipe(int ends[2])
{
    errno = EMFILE;
    return is_without_pipe ? -1 : __real_pipe(ends);
}

pid_t __wrap_fork(void)
{
    errno = EAGAIN;
    return is_without_fork ? -1 : __real_fork();
}

static enum {
    HACD_WORKS,
    HACD_FAILS,
    HACD_THROWS,
    HACD_THROWS_A_NUMBER,
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
