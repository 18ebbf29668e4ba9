/* Mesh files that must be refused. */
#ifndef MOTE_TESTS_REFUSED_H
#define MOTE_TESTS_REFUSED_H

#include "harness/mesh/mesh_import.h"
#include "tests/support/test.h"

/* Checks that a mesh file is refused with a message that begins so. */
static inline void refuse_mesh(const char *path, const char *says)
{
    mote_mesh *mesh = NULL;
    test_row("%s", says);
    assert_int_equal(mote_mesh_import(path, &mesh, NULL), MOTE_EINVAL);
    if (strncmp(mote_error_text(), says, strlen(says)) != 0)
        fail_msg("%s", mote_error_text());
}

#endif
