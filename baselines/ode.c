/* ode: the Open Dynamics Engine's collision of two triangle meshes (OPCODE), for contact only.
   Built only where ODE is installed. Its trees are built over the rest pose and refitted in
   place (dGeomTriMeshDataUpdate); one contact is asked for, without details. OPCODE's boxes are
   floats; triangles are tested in double precision. A mesh of one triangle gets no tree, and
   its contacts are never found (datasets/defects.md, 21): it is refused. */
#include "baselines/physics_engine.h"

#include <ode/ode.h>

#include <pthread.h>
#include <stdlib.h>

enum { UPDATE, VERTICES, POSITIONS, PARAMETER_COUNT };

static const mote_parameter parameters[PARAMETER_COUNT] = {
    [UPDATE] = {"update", MOTE_PARAMETER_CHOICE, 0, 0, "refit|none|rebuild", "refit",
                "how a tree follows a changed shape; none: rigid bodies, by their poses"},
    [VERTICES] = {"vertices", MOTE_PARAMETER_CHOICE, 0, 0, "double|single", "double",
                  "precision of the vertices that ODE reads"},
    [POSITIONS] = {"positions", MOTE_PARAMETER_CHOICE, 0, 0, "deform|given", "deform",
                   "deform: pay for deforming all vertices; given: they come free of charge"},
};

/* One body in ODE, which reads vertices and triangles where they lie here. */
typedef struct ode_body {
    double (*doubles)[3]; /* [vertex_count], or NULL and */
    float (*floats)[3];   /* these */
    dTriIndex (*triangles)[3];
    dTriMeshDataID data;
    dGeomID mesh;
} ode_body;

typedef struct ode_state {
    mote_physics engine;
    ode_body body[2];
    bool rebuild;
} ode_state;

static pthread_once_t begun = PTHREAD_ONCE_INIT;

static void begin_ode(void)
{
    (void)dInitODE2(0);
}

static mote_traits traits(const double *values)
{
    return mote_physics_traits((mote_physics_update)values[UPDATE], values[POSITIONS] > 0);
}

static void destroy(void *state)
{
    ode_state *s = state;
    if (!s)
        return;
    for (int b = 0; b < 2; ++b) {
        ode_body *body = &s->body[b];
        if (body->mesh)
            dGeomDestroy(body->mesh);
        if (body->data)
            dGeomTriMeshDataDestroy(body->data);
        free(body->doubles);
        free(body->floats);
        free(body->triangles);
    }
    free(s);
}

static mote_status write_vertices(ode_state *s, int b)
{
    const ode_body *body = &s->body[b];
    return body->doubles ? mote_physics_write_doubles(&s->engine, b, body->doubles[0])
                         : mote_physics_write_floats(&s->engine, b, body->floats[0]);
}

static void build_tree(const mote_mesh *mesh, ode_body *body)
{
    const int vertices = (int)mesh->vertex_count, indices = (int)(3 * mesh->triangle_count);
    if (body->doubles)
        dGeomTriMeshDataBuildDouble(body->data, body->doubles, sizeof body->doubles[0],
                                    vertices, body->triangles, indices,
                                    sizeof body->triangles[0]);
    else
        dGeomTriMeshDataBuildSingle(body->data, body->floats, sizeof body->floats[0], vertices,
                                    body->triangles, indices, sizeof body->triangles[0]);
}

static mote_status create_body(ode_state *s, int b, bool single)
{
    const mote_mesh *mesh = s->engine.body[b].mesh;
    ode_body *body = &s->body[b];
    if (mesh->triangle_count < 2)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "ODE finds no contact of a mesh of one triangle, as body %d is", b);
    if (single)
        body->floats = calloc(mesh->vertex_count, sizeof body->floats[0]);
    else
        body->doubles = calloc(mesh->vertex_count, sizeof body->doubles[0]);
    body->triangles = calloc(mesh->triangle_count, sizeof body->triangles[0]);
    if ((!body->floats && !body->doubles) || !body->triangles)
        return mote_fail(MOTE_ENOMEM, "no memory for body %d in ODE", b);
    const mote_status status = write_vertices(s, b);
    if (status != MOTE_OK)
        return status;
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        for (int k = 0; k < 3; ++k)
            body->triangles[i][k] = mesh->triangles[i][k];
    }
    body->data = dGeomTriMeshDataCreate();
    build_tree(mesh, body);
    body->mesh = dCreateTriMesh(NULL, body->data, NULL, NULL, NULL);
    return MOTE_OK;
}

static mote_status create(const mote_setup *setup, void **state)
{
    ode_state *s = calloc(1, sizeof *s);
    if (!s)
        return mote_fail(MOTE_ENOMEM, "no memory for ode");
    const mote_physics_update mode = (mote_physics_update)setup->values[UPDATE];
    s->rebuild = mode == MOTE_PHYSICS_REBUILD;
    mote_status status = mote_physics_begin(&s->engine, setup, mode, "ODE");
    if (status == MOTE_OK) {
        (void)pthread_once(&begun, begin_ode);
        if (!dAllocateODEDataForThread(dAllocateFlagCollisionData))
            status = mote_fail(MOTE_ENOMEM, "ODE has no memory for this thread");
    }
    for (int b = 0; b < 2 && status == MOTE_OK; ++b)
        status = create_body(s, b, setup->values[VERTICES] > 0);
    if (status == MOTE_OK)
        *state = s;
    else
        destroy(s);
    return status;
}

static mote_status refit(ode_state *s, int b)
{
    ode_body *body = &s->body[b];
    const mote_status status = write_vertices(s, b);
    if (status != MOTE_OK)
        return status;
    if (s->rebuild)
        build_tree(s->engine.body[b].mesh, body);
    else
        dGeomTriMeshDataUpdate(body->data);
    dGeomTriMeshSetData(body->mesh, body->data); /* else the mesh keeps its old box */
    return MOTE_OK;
}

static void place(const mote_physics_body *body, dGeomID mesh)
{
    dMatrix3 rotation = {0};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            rotation[4 * i + j] = body->rotation.m[i][j];
    }
    dGeomSetRotation(mesh, rotation);
    dGeomSetPosition(mesh, body->translation.x, body->translation.y, body->translation.z);
}

static mote_status update(void *state, const mote_frame *frame)
{
    ode_state *s = state;
    for (int b = 0; b < 2; ++b) {
        mote_status status = mote_physics_follow(&s->engine, frame, b);
        if (status == MOTE_OK && s->engine.body[b].refit)
            status = refit(s, b);
        if (status != MOTE_OK)
            return status;
        place(&s->engine.body[b], s->body[b].mesh);
    }
    return MOTE_OK;
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)frame;
    ode_state *s = state;
    dContactGeom contact;
    const int flags = 1 | (int)CONTACTS_UNIMPORTANT; /* one contact, whichever it is */
    answer->has_contact = true;
    answer->contact =
        dCollide(s->body[0].mesh, s->body[1].mesh, flags, &contact, sizeof contact) > 0;
    return MOTE_OK;
}

MOTE_METHOD(ode) = {
    .name = "ode",
    .summary = "ODE (OPCODE): box trees, refitted; contact only",
    .parameters = parameters,
    .parameter_count = PARAMETER_COUNT,
    .traits = traits,
    .create = create,
    .destroy = destroy,
    .update = update,
    .query = query,
};
