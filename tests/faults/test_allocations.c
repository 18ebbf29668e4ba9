/* The library when memory or threads run out, or when a library that it uses fails: it must
   return a status with a text, leak nothing (under AddressSanitizer) and leave outputs
   untouched. Where a query needs memory only for speed, it must give the same answer. The
   linker replaces functions of GSL and libstdc++ by those below (--wrap). */
#include "core/body/csrbf_fit.h"
#include "core/base/frame_queue.h"
#include "core/body/lazy.h"
#include "core/body/leaf_order.h"
#include "core/particle/levels.h"
#include "core/base/linear_algebra.h"
#include "core/body/mass.h"
#include "core/method/method.h"
#include "core/certificate/certificate_tree.h"
#include "core/skin/skin.h"
#include "core/parts/parts.h"
#include "core/base/pool.h"
#include "core/particle/start.h"
#include "tests/support/crowd.h"
#include "tests/faults/failing_threads.h"
#include "tests/support/methods.h"
#include "tests/support/test.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <stdio.h>

/* Calls of the other kinds left before one fails. */
static long others_left = -1;

gsl_matrix *__real_gsl_matrix_alloc(size_t rows, size_t columns);
gsl_vector *__real_gsl_vector_alloc(size_t size);
gsl_eigen_symmv_workspace *__real_gsl_eigen_symmv_alloc(size_t size);
int __real_gsl_linalg_cholesky_rcond(const gsl_matrix *factor, double *rcond, gsl_vector *work);
int __real_gsl_eigen_symmv(gsl_matrix *a, gsl_vector *values, gsl_matrix *vectors,
                           gsl_eigen_symmv_workspace *work);
gsl_matrix *__wrap_gsl_matrix_alloc(size_t rows, size_t columns);
gsl_vector *__wrap_gsl_vector_alloc(size_t size);
gsl_eigen_symmv_workspace *__wrap_gsl_eigen_symmv_alloc(size_t size);
int __wrap_gsl_linalg_cholesky_rcond(const gsl_matrix *factor, double *rcond, gsl_vector *work);
int __wrap_gsl_eigen_symmv(gsl_matrix *a, gsl_vector *values, gsl_matrix *vectors,
                           gsl_eigen_symmv_workspace *work);

gsl_matrix *__wrap_gsl_matrix_alloc(size_t rows, size_t columns)
{
    return is_due(&allocations_left) ? NULL : __real_gsl_matrix_alloc(rows, columns);
}

gsl_vector *__wrap_gsl_vector_alloc(size_t size)
{
    return is_due(&allocations_left) ? NULL : __real_gsl_vector_alloc(size);
}

gsl_eigen_symmv_workspace *__wrap_gsl_eigen_symmv_alloc(size_t size)
{
    return is_due(&allocations_left) ? NULL : __real_gsl_eigen_symmv_alloc(size);
}

int __wrap_gsl_linalg_cholesky_rcond(const gsl_matrix *factor, double *rcond, gsl_vector *work)
{
    return is_due(&others_left) ? GSL_EFAILED
                                : __real_gsl_linalg_cholesky_rcond(factor, rcond, work);
}

int __wrap_gsl_eigen_symmv(gsl_matrix *a, gsl_vector *values, gsl_matrix *vectors,
                           gsl_eigen_symmv_workspace *work)
{
    return is_due(&others_left) ? GSL_EMAXITER
                                : __real_gsl_eigen_symmv(a, values, vectors, work);
}

/* The C++ ABI names of operator new, new[], new (nothrow)[] and std::bad_alloc, on systems
   whose size_t is an unsigned long. */
_Noreturn void _ZSt17__throw_bad_allocv(void);
void *__real__Znwm(size_t size);
void *__wrap__Znwm(size_t size);
void *__real__Znam(size_t size);
void *__wrap__Znam(size_t size);
void *__real__ZnamRKSt9nothrow_t(size_t size, const void *nothrow);
void *__wrap__ZnamRKSt9nothrow_t(size_t size, const void *nothrow);

void *__wrap__Znwm(size_t size)
{
    if (is_due(&allocations_left))
        _ZSt17__throw_bad_allocv();
    return __real__Znwm(size);
}

void *__wrap__Znam(size_t size)
{
    if (is_due(&allocations_left))
        _ZSt17__throw_bad_allocv();
    return __real__Znam(size);
}

void *__wrap__ZnamRKSt9nothrow_t(size_t size, const void *nothrow)
{
    return is_due(&allocations_left) ? NULL : __real__ZnamRKSt9nothrow_t(size, nothrow);
}

static mote_status make_fields(void *context)
{
    const mote_mesh *mesh = context;
    mote_field *field = NULL;
    mote_status status = mote_field_create_csrbf(mesh->positions, 5, mesh->diagonal, &field);
    mote_csrbf_fit *fit = NULL;
    if (status == MOTE_OK)
        status = mote_csrbf_fit_create(field, &fit, NULL);
    mote_csrbf_fit_destroy(fit);
    mote_field_destroy(field);
    field = NULL;
    /* Any vectors will do: the rest positions serve as two modes of half as many vertices. */
    if (status == MOTE_OK)
        status = mote_field_create_modes(mesh->positions, 2, mesh->vertex_count / 2, &field);
    mote_field_destroy(field);
    return status;
}

TEST(fields_when_an_allocation_fails_say_so)
{
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(1));
    fail_each_allocation(make_fields, mesh, "fields");
    mote_mesh_destroy(mesh);
}

static mote_status make_places(void *context)
{
    const mote_mesh *mesh = context;
    uint32_t random[9], farthest[9];
    mote_status status = mote_start_vertices(mesh, 9, MOTE_START_RANDOM, 3, random);
    if (status == MOTE_OK)
        status = mote_start_vertices(mesh, 9, MOTE_START_FARTHEST, 3, farthest);
    return status;
}

/* Makes the tree of a field if status, the result of making the field, is MOTE_OK; frees the
   field. */
static mote_status make_tree(const mote_mesh *mesh, mote_field *field, mote_status status)
{
    const mote_body body = {.mesh = mesh, .field = field};
    const mote_cert_tree_options options = {
        .length = mesh->diagonal, .width = 8, .linear_fits = true};
    mote_cert_tree *tree = NULL;
    if (status == MOTE_OK)
        status = mote_cert_tree_create(&body, &options, &tree);
    mote_cert_tree_destroy(tree);
    mote_field_destroy(field);
    return status;
}

/* A skin of three bones, and the tree of its bounds. */
static mote_status make_skin(void *context)
{
    const mote_mesh *mesh = context;
    const uint32_t n = mesh->vertex_count;
    static uint32_t start[1000];
    static uint16_t bone[2000];
    static double weight[2000];
    for (uint32_t v = 0; v < n; ++v) {
        start[v + 1] = 2 * v + 2;
        bone[2 * v] = (uint16_t)(v % 3);
        bone[2 * v + 1] = (uint16_t)((v + 1) % 3);
        weight[2 * v] = 0.25;
        weight[2 * v + 1] = 0.75;
    }
    mote_field *field = NULL;
    mote_status status = mote_field_create_skin(mesh, 3, start, bone, weight, &field);
    return make_tree(mesh, field, status);
}

/* Two morph targets, with these bones and without. */
static mote_status make_morphs(void *context)
{
    const mote_mesh *mesh = context;
    static const uint32_t start[3] = {0, 3, 5}, vertex[5] = {4, 2, 0, 1, 2};
    static uint32_t weights_start[1000];
    static uint16_t bone[1000];
    static double weight[1000];
    const mote_morph_targets targets = {2, start, vertex, mesh->positions};
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        weights_start[v + 1] = v + 1;
        weight[v] = 1;
    }
    mote_field *field = NULL;
    mote_status status =
        mote_field_create_morphs(mesh, 1, weights_start, bone, weight, &targets, &field);
    status = make_tree(mesh, field, status);
    field = NULL;
    if (status == MOTE_OK)
        status = mote_field_create_morphs(mesh, 0, NULL, NULL, NULL, &targets, &field);
    return make_tree(mesh, field, status);
}

TEST(skin_when_an_allocation_fails_says_so)
{
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(2));
    assert_true(mesh->vertex_count < 1000);
    fail_each_allocation(make_skin, mesh, "skin");
    fail_each_allocation(make_morphs, mesh, "morphs");
    mote_mesh_destroy(mesh);
}

TEST(start_when_an_allocation_fails_says_so)
{
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(1));
    fail_each_allocation(make_places, mesh, "mote_start_vertices");
    mote_mesh_destroy(mesh);
}

static mote_status weigh(void *context)
{
    mote_mass mass;
    return mote_mass_of_mesh(context, 1, &mass);
}

TEST(mass_when_an_allocation_fails_says_so)
{
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(1));
    fail_each_allocation(weigh, mesh, "mote_mass_of_mesh");
    mote_mesh_destroy(mesh);
}

static mote_status make_levels(void *context)
{
    const mote_mesh *mesh = context;
    mote_levels *levels = NULL;
    mote_status status = mote_levels_create(mesh, &levels);
    uint32_t nodes[4], *home = NULL;
    if (status == MOTE_OK)
        status = mote_levels_spread(levels, mesh, 0, 4, true, 1, nodes);
    if (status == MOTE_OK)
        status = mote_levels_home(levels, mesh, 0, &home);
    free(home);
    mote_levels_destroy(levels);
    return status;
}

TEST(levels_when_an_allocation_fails_say_so)
{
    mote_mesh *mesh = solid_to_mesh(solid_icosphere(2));
    fail_each_allocation(make_levels, mesh, "levels");
    mote_mesh_destroy(mesh);
}

/* The order of a mesh's triangles, of a body with a sample pose. */
static mote_status make_order(void *context)
{
    uint32_t order[400];
    return mote_leaf_order(context, 4, order);
}

TEST(leaf_order_when_an_allocation_fails_says_so)
{
    uint64_t seed = 4;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(2)), 5, &seed);
    assert_true(b.mesh->triangle_count <= 400);
    const mote_weights sample = test_body_state(&b, 1, &seed).weights;
    b.body.samples = &sample;
    b.body.sample_count = 1;
    fail_each_allocation(make_order, &b.body, "mote_leaf_order");
    test_body_free(&b);
}

static mote_status make_queue_and_pool(void *context)
{
    (void)context;
    mote_frame_queue *queue = NULL;
    mote_pool *pool = NULL;
    mote_status status = mote_frame_queue_create(2, &queue);
    if (status == MOTE_OK)
        status = mote_pool_create(3, &pool);
    mote_frame_queue_destroy(queue);
    mote_pool_destroy(pool);
    return status;
}

TEST(queue_and_pool_when_an_allocation_fails_say_so)
{
    fail_each_allocation(make_queue_and_pool, NULL, "queue and pool");
}

TEST(pool_when_a_thread_cannot_be_started_says_which)
{
    for (long n = 0; n < 3; ++n) {
        mote_pool *pool = NULL;
        char expected[80];
        (void)snprintf(expected, sizeof expected, "only %ld of 4 threads could be started",
                       n + 1);
        threads_left = n;
        assert_int_equal(mote_pool_create(4, &pool), MOTE_ENOMEM);
        assert_string_equal(mote_error_text(), expected);
        assert_null(pool);
        assert_int_equal(threads_left, never);
    }
}

static mote_status make_scene(void *context)
{
    static const uint32_t pairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    crowd *c = context;
    mote_scene_options options = mote_default_scene_options();
    options.threads = 2;
    mote_scene *s = NULL;
    mote_status status =
        mote_scene_create(c->shape, CROWD_SHAPES, c->shape_of, c->count, &options, &s);
    for (size_t near = 1; status == MOTE_OK && near <= 3; near += 2) {
        const uint32_t(*kept)[2];
        size_t count;
        status = mote_scene_sift(s, c->states, 1, pairs, near, &kept, &count);
        if (status == MOTE_OK)
            status = mote_scene_query(s, c->states, pairs, near);
    }
    mote_scene_destroy(s);
    return status;
}

TEST(scene_when_an_allocation_fails_says_so)
{
    static crowd c;
    crowd_init(&c, 3, 400, 2);
    fail_each_allocation(make_scene, &c, "scene");
    crowd_free(&c);
}

/* A query without memory for more pairs keeps the states of the query before, and the next one
   continues from them. */
TEST(scene_query_out_of_memory_keeps_all_states)
{
    static const uint32_t one[1][2] = {{0, 1}};
    static uint32_t many[CROWD_MAX * (CROWD_MAX - 1) / 2][2];
    static crowd c;
    size_t count = 0;
    crowd_init(&c, 12, 400, 4);
    for (uint32_t i = 0; i < c.count; ++i) {
        for (uint32_t j = i + 1; j < c.count; ++j, ++count)
            many[count][0] = i, many[count][1] = j;
    }
    const mote_scene_options options = mote_default_scene_options();
    mote_scene *s = NULL;
    assert_int_equal(
        mote_scene_create(c.shape, CROWD_SHAPES, c.shape_of, c.count, &options, &s), MOTE_OK);
    assert_int_equal(mote_scene_query(s, c.states, one, 1), MOTE_OK);
    for (long n = 0; n < 2; ++n) {
        allocations_left = n;
        assert_int_equal(mote_scene_query(s, c.states, (const uint32_t(*)[2])many, count),
                         MOTE_ENOMEM);
        assert_string_equal(mote_error_text(), "no memory for 66 near pairs");
        assert_int_equal(allocations_left, never);
    }
    assert_int_equal(mote_scene_query(s, c.states, (const uint32_t(*)[2])many, count), MOTE_OK);
    const mote_scene_pair *pairs = mote_scene_pairs(s, &count);
    assert_int_equal(count, 66);
    assert_int_equal(pairs[0].steps, 2);
    assert_int_equal(pairs[1].steps, 1);
    mote_scene_destroy(s);
    crowd_free(&c);
}

/* Methods choose their own number of particles, which needs the convex parts of two meshes. FCL
   returns codes where its own allocations fail. */
TEST(methods_when_an_allocation_fails_say_so)
{
    static const struct {
        const char *name, *keys;
    } cases[] = {{"particle", ""},
                 {"particle", "n=4,forces=on"},
                 {"particle-paper", ""},
                 {"particle-paper", "n=4,far_cache=0.2,precision=single"},
                 {"certified", "seed=tracked"},
                 {"brute-force", ""},
                 {"fcl-aabb", ""},
                 {"fcl-obbrss", "build=samples"},
                 {"hybrid-fcl", "n=4"}};
    uint64_t seed = 5;
    test_body b[2];
    test_body_init(&b[0], solid_to_mesh(solid_icosahedron()), 4, &seed);
    test_body_init(&b[1], solid_to_mesh(solid_torus(4, 4)), -2, &seed);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        method_run w;
        w.method = method_with(cases[k].name, cases[k].keys, w.values);
        w.setup = (mote_setup){.body = {&b[0].body, &b[1].body},
                               .length = fmax(b[0].mesh->diagonal, b[1].mesh->diagonal),
                               .seed = 1,
                               .values = w.values};
        fail_each_allocation(method_run_build, &w, cases[k].name);
    }
    static const mote_method least = {.name = "least"}; /* its state is a copy of the setup */
    method_run w = {.method = &least, .setup = {.length = 1}};
    fail_each_allocation(method_run_build, &w, "least");
    test_body_free(&b[0]);
    test_body_free(&b[1]);
}

static mote_status make_parts(void *context)
{
    mote_parts *parts = NULL;
    const mote_status status = mote_parts_create(context, NULL, &parts);
    if (status != MOTE_OK)
        assert_null(parts);
    mote_parts_destroy(parts);
    return status;
}

TEST(parts_when_an_allocation_fails_say_so)
{
    mote_mesh *mesh = solid_to_mesh(solid_join(solid_torus(5, 4), solid_tetrahedron(), 5));
    fail_each_allocation(make_parts, mesh, "mote_parts_create");
    mote_mesh_destroy(mesh);
}

TEST(linear_algebra_when_gsl_fails_says_so)
{
    const double matrix[4] = {2, 0, 0, 1};
    mote_cholesky *factor = NULL;
    double condition = -1;
    others_left = 0;
    assert_int_equal(mote_cholesky_create(2, matrix, &factor, &condition), MOTE_ENUMERIC);
    assert_string_equal(mote_error_text(), "a matrix of 2 rows is not positive definite");
    assert_null(factor);
    assert_true(condition == -1);
    const mote_mat3 diagonal = {{{3, 0, 0}, {0, 1, 0}, {0, 0, 2}}};
    mote_vec3 values = {0, 0, 0};
    mote_mat3 vectors;
    others_left = 0;
    assert_int_equal(mote_eigen_symmetric(&diagonal, &values, &vectors), MOTE_ENUMERIC);
    assert_string_equal(mote_error_text(), "the eigenvectors of a matrix did not converge");
    assert_true(values.x == 0);
    assert_int_equal(mote_eigen_symmetric(&diagonal, &values, &vectors), MOTE_OK);
    assert_true(values.x == 1 && values.y == 2 && values.z == 3);
}

/* Tables of positions that cannot grow: each position is still right, and the table remembers
   as many as it has room for. */
TEST(lazy_without_memory_answers_the_same)
{
    uint64_t seed = 4;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(3)), 14, &seed);
    const mote_body_state s = test_body_state(&b, 1, &seed);
    mote_lazy lazy, single, single_ample;
    assert_int_equal(mote_lazy_init(&lazy, &b.body, 0), MOTE_OK);
    assert_int_equal(mote_lazy_init_single(&single, &b.body, 0), MOTE_OK);
    assert_int_equal(mote_lazy_init_single(&single_ample, &b.body, UINT32_MAX), MOTE_OK);
    mote_lazy_begin(&lazy, &s, false);
    mote_lazy_begin(&single, &s, false);
    mote_lazy_begin(&single_ample, &s, false);
    for (uint32_t v = 0; v < b.mesh->vertex_count; ++v) {
        allocations_left = 0;
        const mote_vec3 got = mote_lazy_position(&lazy, v);
        allocations_left = 0;
        const mote_vec3 rounded = mote_lazy_position(&single, v);
        allocations_left = never;
        const mote_vec3 right = mote_body_position(&b.body, &s, v);
        const mote_vec3 right_rounded = mote_lazy_position(&single_ample, v);
        assert_memory_equal(&got, &right, sizeof got);
        assert_memory_equal(&rounded, &right_rounded, sizeof got);
    }
    assert_int_equal(lazy.filled, lazy.limit);
    assert_int_equal(single.filled, single.limit);
    mote_lazy_free(&lazy);
    mote_lazy_free(&single);
    mote_lazy_free(&single_ample);
    test_body_free(&b);
}

/* A fetch of more than fits fetches as much as fits. */
TEST(lazy_fetch_without_memory_answers_the_same)
{
    uint64_t seed = 4;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(3)), 14, &seed);
    uint32_t vertices[100];
    for (uint32_t i = 0; i < 100; ++i)
        vertices[i] = 3 * i;
    for (int rings = 0; rings <= 1; ++rings) {
        const mote_body_state s = test_body_state(&b, 1, &seed);
        mote_lazy lazy;
        assert_int_equal(mote_lazy_init(&lazy, &b.body, 0), MOTE_OK);
        mote_lazy_begin(&lazy, &s, false);
        allocations_left = 0;
        if (rings)
            mote_lazy_fetch_rings(&lazy, vertices, 100);
        else
            mote_lazy_fetch(&lazy, vertices, 100);
        assert_int_equal(allocations_left, never);
        assert_int_equal(lazy.filled, lazy.limit);
        assert_int_equal(lazy.evaluated, lazy.limit);
        for (uint32_t i = 0; i < 100; ++i) {
            const mote_vec3 got = mote_lazy_position(&lazy, vertices[i]);
            const mote_vec3 right = mote_body_position(&b.body, &s, vertices[i]);
            assert_memory_equal(&got, &right, sizeof got);
        }
        mote_lazy_free(&lazy);
    }
    test_body_free(&b);
}

static mote_status make_lazy(void *context)
{
    mote_lazy lazy;
    mote_status status = mote_lazy_init(&lazy, context, 100);
    if (status != MOTE_OK)
        return status;
    mote_lazy_free(&lazy);
    status = mote_lazy_init_single(&lazy, context, 100);
    if (status == MOTE_OK)
        mote_lazy_free(&lazy);
    return status;
}

TEST(lazy_init_when_an_allocation_fails_says_so)
{
    uint64_t seed = 4;
    test_body b;
    test_body_init(&b, solid_to_mesh(solid_icosphere(1)), 2, &seed);
    fail_each_allocation(make_lazy, &b.body, "mote_lazy_init");
    test_body_free(&b);
}

/* The largest table is requested even if fewer positions are expected, and the allocation
   fails. */
TEST(lazy_init_of_the_largest_mesh_asks_for_two_to_the_31)
{
    const mote_mesh mesh = {.vertex_count = UINT32_MAX / 2};
    const mote_body body = {.mesh = &mesh};
    mote_lazy lazy;
    allocations_left = 0;
    assert_int_equal(mote_lazy_init(&lazy, &body, UINT32_MAX), MOTE_ENOMEM);
    assert_string_equal(mote_error_text(), "no memory for 2147483648 positions");
    assert_int_equal(allocations_left, never);
}

static int say_count(void)
{
    (void)printf("%ld calls failed\n", calls_failed);
    (void)fflush(stdout); /* LeakSanitizer ends the process without flushing */
    return 0;
}

TEST_GROUP(NULL, say_count);
