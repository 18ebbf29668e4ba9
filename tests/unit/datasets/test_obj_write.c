#include "datasets/letter.h"
#include "datasets/obj_write.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Created for each test. */
static const char path[] = "v.obj";
static char partial[32];
static mote_mesh *mesh;

static int set_up(void)
{
    (void)snprintf(partial, sizeof partial, "%s.%ld.partial", path, (long)getpid());
    return folder_next() || mote_letter_create('V', 400, &mesh) != MOTE_OK;
}

static int tear_down(void)
{
    mote_mesh_destroy(mesh);
    return folder_count(".", "") > 1; /* fails if a partial file is left behind */
}

TEST_EACH(set_up, tear_down);

/* Reads the file with the C library and compares every number. */
static void assert_file_holds(const mote_vec3 *positions)
{
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        mote_vec3 p;
        assert_int_equal(fscanf(file, " v %lf %lf %lf", &p.x, &p.y, &p.z), 3);
        assert_memory_equal(&p, &positions[v], sizeof p);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        unsigned corner[3];
        assert_int_equal(fscanf(file, " f %u %u %u", &corner[0], &corner[1], &corner[2]), 3);
        for (size_t k = 0; k < 3; k++)
            assert_int_equal(corner[k] - 1, mesh->triangles[t][k]);
    }
    char rest;
    assert_int_equal(fscanf(file, " %c", &rest), EOF);
    (void)fclose(file);
}

TEST(write_rest_positions_same_doubles)
{
    assert_int_equal(mote_obj_write(path, NULL, mesh), MOTE_OK);
    assert_file_holds(mesh->positions);
    assert_int_not_equal(access(partial, F_OK), 0);
}

TEST(write_given_positions_same_doubles)
{
    mote_vec3 *moved = malloc(mesh->vertex_count * sizeof *moved);
    assert_non_null(moved);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        moved[v] = mote_scale(mesh->positions[v], 1e-300 / 3);
    assert_int_equal(mote_obj_write(path, moved, mesh), MOTE_OK);
    assert_file_holds(moved);
    free(moved);
}

TEST(write_not_finite_refused_and_old_file_kept)
{
    assert_int_equal(mote_obj_write(path, NULL, mesh), MOTE_OK);
    const size_t bytes = mesh->vertex_count * sizeof(mote_vec3);
    mote_vec3 *broken = malloc(bytes);
    assert_non_null(broken);
    memcpy(broken, mesh->positions, bytes);
    broken[7].y = (double)NAN;
    assert_int_equal(mote_obj_write(path, broken, mesh), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "vertex 7"));
    assert_file_holds(mesh->positions);
    free(broken);
}

TEST(write_missing_folder_named)
{
    assert_int_equal(mote_obj_write("/nowhere/at/all.obj", NULL, mesh), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), "/nowhere/at/all.obj"));
    assert_non_null(strstr(mote_error_text(), "folder"));
}

TEST(write_onto_folder_leaves_nothing)
{
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(mote_obj_write(path, NULL, mesh), MOTE_EIO);
    assert_non_null(strstr(mote_error_text(), path));
    assert_int_not_equal(access(partial, F_OK), 0);
}

TEST(write_full_disk_fails)
{
    assert_int_equal(symlink("/dev/full", partial), 0);
    assert_int_equal(mote_obj_write(path, NULL, mesh), MOTE_EIO);
    assert_int_not_equal(access(path, F_OK), 0);
    assert_int_not_equal(access(partial, F_OK), 0);
}
