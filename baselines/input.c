#include "baselines/input.h"

static bool is_finite(mote_vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static mote_status check_face(const mote_mesh *mesh, uint32_t face, int body)
{
    const uint32_t *t = mesh->triangles[face];
    for (int k = 0; k < 3; ++k) {
        if (t[k] >= mesh->vertex_count)
            return mote_fail(
                MOTE_EINVAL,
                "body %d: face %u uses vertex %u, which does not exist; there are %u vertices",
                body, face, t[k], mesh->vertex_count);
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
        return mote_fail(
            MOTE_EINVAL,
            "body %d: face %u has two equal vertices; three different ones are needed", body,
            face);
    return MOTE_OK;
}

static mote_status check_mesh(const mote_mesh *mesh, int body)
{
    if (mesh->triangle_count == 0)
        return mote_fail(MOTE_EINVAL, "body %d: no triangles; at least one is needed", body);
    if (mesh->vertex_count < 3)
        return mote_fail(MOTE_EINVAL, "body %d: %u vertices; at least three are needed", body,
                         mesh->vertex_count);
    for (uint32_t face = 0; face < mesh->triangle_count; ++face) {
        mote_status status = check_face(mesh, face, body);
        if (status != MOTE_OK)
            return status;
    }
    return mote_input_check_vertices(mesh->positions, mesh->vertex_count, body);
}

mote_status mote_input_check(const mote_setup *setup)
{
    if (!(setup->length > 0) || !isfinite(setup->length))
        return mote_fail(MOTE_EINVAL, "length %g is not valid; it must be finite and above 0",
                         setup->length);
    if (!(setup->tolerance >= 0) || !isfinite(setup->tolerance))
        return mote_fail(MOTE_EINVAL,
                         "tolerance %g is not valid; it must be finite and at least 0",
                         setup->tolerance);
    for (int body = 0; body < 2; ++body) {
        mote_status status = check_mesh(setup->body[body]->mesh, body);
        if (status != MOTE_OK)
            return status;
    }
    return MOTE_OK;
}

mote_status mote_input_check_vertices(const mote_vec3 *vertices, uint32_t count, int body)
{
    if (!vertices)
        return mote_fail(MOTE_EINVAL,
                         "body %d: the frame has no vertices; this method needs them", body);
    double zero = 0;
    for (uint32_t i = 0; i < count; ++i)
        zero += mote_input_zero(vertices[i]);
    if (!isnan(zero))
        return MOTE_OK;
    uint32_t i = 0;
    while (is_finite(vertices[i]))
        ++i;
    return mote_fail(MOTE_EINVAL, "body %d: vertex %u is (%g, %g, %g); it must be finite", body,
                     i, vertices[i].x, vertices[i].y, vertices[i].z);
}

mote_status mote_input_check_pose(const mote_pose *pose, int body)
{
    bool finite = is_finite(pose->translation);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            finite = finite && isfinite(pose->rotation.m[row][column]);
    }
    if (!finite)
        return mote_fail(MOTE_EINVAL, "body %d: the pose is not finite", body);
    return MOTE_OK;
}
