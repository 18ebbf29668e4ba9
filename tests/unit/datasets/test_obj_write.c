#include "datasets/letter.h"
#include "datasets/obj_write.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

typedef struct fixture {
    char folder[64];
    char path[96];
    char partial[128];
    mote_mesh *mesh;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    if (!f)
        return -1;
    (void)snprintf(f->folder, sizeof f->folder, "/tmp/mote-obj-XXXXXX");
    if (!mkdtemp(f->folder) || mote_letter_create('V', 400, &f->mesh) != MOTE_OK)
        return -1;
    (void)snprintf(f->path, sizeof f->path, "%s/v.obj", f->folder);
    (void)snprintf(f->partial, sizeof f->partial, "%s.%ld.partial", f->path, (long)getpid());
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    mote_mesh_destroy(f->mesh);
    (void)remove(f->path);
    const int status = rmdir(f->folder); /* fails when a partial file is left behind */
    free(f);
    return status;
}

/* Reads the file back with the C library and compares every number. */
static void assert_file_holds(const fixture *f, const mote_vec3 *positions)
{
    FILE *file = fopen(f->path, "r");
    assert_non_null(file);
    for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
        mote_vec3 p;
        assert_int_equal(fscanf(file, " v %lf %lf %lf", &p.x, &p.y, &p.z), 3);
        assert_memory_equal(&p, &positions[v], sizeof p);
    }
    for (uint32_t t = 0; t < f->mesh->triangle_count; t++) {
        unsigned corner[3];
        assert_int_equal(fscanf(file, " f %u %u %u", &corner[0], &corner[1], &corner[2]), 3);
        for (size_t k = 0; k < 3; k++)
            assert_int_equal(corner[k] - 1, f->mesh->triangles[t][k]);
    }
    char rest;
    assert_int_equal(fscanf(file, " %c", &rest), EOF);
    (void)fclose(file);
}

static void write_rest_positions_same_doubles(void **state)
{
    const fixture *f = *state;
    assert_int_equal(mote_obj_write(f->path, NULL, f->mesh), MOTE_OK);
    assert_file_holds(f, f->mesh->positions);
    assert_int_not_equal(access(f->partial, F_OK), 0);
}

static void write_given_positions_same_doubles(void **state)
{
    const fixture *f = *state;
    mote_vec3 *moved = malloc(f->mesh->vertex_count * sizeof *moved);
    assert_non_null(moved);
    for (uint32_t v = 0; v < f->mesh->vertex_count; v++)
        moved[v] = mote_scale(f->mesh->positions[v], 1e-300 / 3);
    assert_int_equal(mote_obj_write(f->path, moved, f->mesh), MOTE_OK);
    assert_file_holds(f, moved);
    free(moved);
}

static void write_not_finite_refused_and_old_file_kept(void **state)
{
    const fixture *f = *state;
    assert_int_equal(mote_obj_write(f->path, NULL, f->mesh), MOTE_OK);
    const size_t bytes = f->mesh->vertex_count * sizeof(mote_vec3);
    mote_vec3 *broken = malloc(bytes);
    assert_non_null(broken);
    memcpy(broken, f->mesh->positions, bytes);
    broken[7].y = (double)NAN;
    assert_int_equal(mote_obj_write(f->path, broken, f->mesh), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "vertex 7"));
    assert_file_holds(f, f->mesh->positions);
    free(broken);
}

static void write_missing_folder_named(void **state)
{
    const fixture *f = *state;
    assert_int_equal(mote_obj_write("/nowhere/at/all.obj", NULL, f->mesh), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "/nowhere/at/all.obj"));
    assert_non_null(strstr(mote_error_text(), "folder"));
}

static void write_onto_folder_leaves_nothing(void **state)
{
    const fixture *f = *state;
    assert_int_equal(mkdir(f->path, 0777), 0);
    assert_int_equal(mote_obj_write(f->path, NULL, f->mesh), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), f->path));
    assert_int_not_equal(access(f->partial, F_OK), 0);
}

static void write_full_disk_fails(void **state)
{
    const fixture *f = *state;
    assert_int_equal(symlink("/dev/full", f->partial), 0);
    assert_int_equal(mote_obj_write(f->path, NULL, f->mesh), MOTE_EIO);
    assert_int_not_equal(access(f->path, F_OK), 0);
    assert_int_not_equal(access(f->partial, F_OK), 0);
}

#define WITH_FOLDER(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_FOLDER(write_rest_positions_same_doubles),
        WITH_FOLDER(write_given_positions_same_doubles),
        WITH_FOLDER(write_not_finite_refused_and_old_file_kept),
        WITH_FOLDER(write_missing_folder_named),
        WITH_FOLDER(write_onto_folder_leaves_nothing),
        WITH_FOLDER(write_full_disk_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
