/* embree-contact: Embree's collision of two scenes of user geometry, for contact only. Embree
   finds the pairs of triangles whose boxes meet; whether the triangles do is decided by our own
   kernel. Built only where Embree 3 is installed. One thread, as for every method. Scenes are
   refitted in each frame (quality LOW: at a higher one Embree rebuilds them). rtcCollide cannot
   be stopped, so that finding a contact early saves only the remaining triangle tests. */
#include "baselines/input.h"
#include "core/body/triangle.h"

#include <embree3/rtcore.h>
#include <stdlib.h>

enum { POSITIONS, PARAMETER_COUNT };

static const mote_parameter parameters[PARAMETER_COUNT] = {
    [POSITIONS] = {"positions", MOTE_PARAMETER_CHOICE, 0, 0, "deform|given", "deform",
                   "deform: pay for deforming all vertices; given: they come free of charge"},
};

/* One body in Embree. */
typedef struct surface {
    const mote_mesh *mesh;
    const mote_vec3 *vertices; /* of the frame */
    mote_vec3 origin;          /* boxes are relative to it, in the unit of the pair */
    double scale, margin;
    RTCScene scene;
    RTCGeometry geometry;
} surface;

typedef struct embree_state {
    RTCDevice device;
    surface surface[2];
    double tolerance_squared;
    uint64_t box_tests, triangle_tests;
    bool contact;
} embree_state;

static mote_traits traits(const double *values)
{
    bool given = values[POSITIONS] > 0;
    return (mote_traits){.needs_vertices = !given, .given_vertices = given};
}

static void destroy(void *state)
{
    embree_state *s = state;
    if (!s)
        return;
    for (int b = 0; b < 2; ++b) {
        if (s->surface[b].geometry)
            rtcReleaseGeometry(s->surface[b].geometry);
        if (s->surface[b].scene)
            rtcReleaseScene(s->surface[b].scene);
    }
    if (s->device)
        rtcReleaseDevice(s->device);
    free(s);
}

static void triangle_corners(const surface *body, uint32_t triangle, mote_vec3 corner[3])
{
    for (int k = 0; k < 3; ++k)
        corner[k] = body->vertices[body->mesh->triangles[triangle][k]];
}

/* Rounds outward, beyond what rounding to float or the subtraction of the origin can lose. */
static float below(double x)
{
    return nextafterf((float)(x - fabs(x) * 1e-7), -HUGE_VALF);
}

static float above(double x)
{
    return nextafterf((float)(x + fabs(x) * 1e-7), HUGE_VALF);
}

static void box_of_triangle(const struct RTCBoundsFunctionArguments *arguments)
{
    const surface *body = arguments->geometryUserPtr;
    mote_vec3 corner[3], low, high;
    triangle_corners(body, arguments->primID, corner);
    for (int k = 0; k < 3; ++k) {
        mote_vec3 p = mote_scale(mote_sub(corner[k], body->origin), body->scale);
        low = k ? mote_vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)) : p;
        high = k ? mote_vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)) : p;
    }
    struct RTCBounds *box = arguments->bounds_o;
    box->lower_x = below(low.x - body->margin);
    box->lower_y = below(low.y - body->margin);
    box->lower_z = below(low.z - body->margin);
    box->upper_x = above(high.x + body->margin);
    box->upper_y = above(high.y + body->margin);
    box->upper_z = above(high.z + body->margin);
}

static mote_status create_surface(embree_state *s, int b)
{
    surface *body = &s->surface[b];
    body->scene = rtcNewScene(s->device);
    body->geometry = rtcNewGeometry(s->device, RTC_GEOMETRY_TYPE_USER);
    if (!body->scene || !body->geometry)
        return mote_fail(MOTE_ENOMEM, "Embree: no scene for body %d", b);
    rtcSetSceneFlags(body->scene, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(body->scene, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryBuildQuality(body->geometry, RTC_BUILD_QUALITY_REFIT);
    rtcSetGeometryUserPrimitiveCount(body->geometry, body->mesh->triangle_count);
    rtcSetGeometryUserData(body->geometry, body);
    rtcSetGeometryBoundsFunction(body->geometry, box_of_triangle, NULL);
    body->vertices = body->mesh->positions;
    body->origin = body->vertices[0];
    rtcCommitGeometry(body->geometry);
    rtcAttachGeometry(body->scene, body->geometry);
    rtcCommitScene(body->scene);
    enum RTCError error = rtcGetDeviceError(s->device);
    if (error != RTC_ERROR_NONE)
        return mote_fail(error == RTC_ERROR_OUT_OF_MEMORY ? MOTE_ENOMEM : MOTE_ENUMERIC,
                         "Embree could not build body %d: error %d", b, (int)error);
    return MOTE_OK;
}

static mote_status create(const mote_setup *setup, void **state)
{
    if (setup->ask != MOTE_ASK_CONTACT)
        return mote_fail(MOTE_EUNSUPPORTED,
                         "Embree has no distance between two scenes, only contact");
    mote_status status = mote_input_check(setup);
    if (status != MOTE_OK)
        return status;
    embree_state *s = calloc(1, sizeof *s);
    if (!s)
        return mote_fail(MOTE_ENOMEM, "no memory for embree-contact");
    s->tolerance_squared = setup->tolerance * setup->tolerance;
    s->device = rtcNewDevice("threads=1,user_threads=1,set_affinity=0");
    if (!s->device)
        status = mote_fail(MOTE_ENUMERIC, "Embree could not create a device on this processor");
    for (int b = 0; b < 2 && status == MOTE_OK; ++b) {
        surface *body = &s->surface[b];
        body->mesh = setup->body[b]->mesh;
        body->scale = ldexp(1, -ilogb(setup->length));
        body->margin = setup->tolerance * body->scale / 2;
        status = create_surface(s, b);
    }
    if (status == MOTE_OK)
        *state = s;
    else
        destroy(s);
    return status;
}

static mote_status update(void *state, const mote_frame *frame)
{
    embree_state *s = state;
    for (int b = 0; b < 2; ++b) {
        mote_status status = mote_input_check_vertices(frame->body[b].vertices,
                                                       s->surface[b].mesh->vertex_count, b);
        if (status != MOTE_OK)
            return status;
    }
    /* All boxes are relative to the origin, so that both bodies follow when it moves. */
    for (int b = 0; b < 2; ++b) {
        surface *body = &s->surface[b];
        body->vertices = frame->body[b].vertices;
        body->origin = frame->body[0].vertices[0];
        rtcUpdateGeometryBuffer(body->geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(body->geometry);
        rtcCommitScene(body->scene);
    }
    enum RTCError error = rtcGetDeviceError(s->device);
    if (error != RTC_ERROR_NONE)
        return mote_fail(MOTE_ENUMERIC, "Embree could not refit: error %d", (int)error);
    return MOTE_OK;
}

static void test_pairs(void *state, struct RTCCollision *pairs, unsigned count)
{
    embree_state *s = state;
    s->box_tests += count;
    for (unsigned k = 0; k < count && !s->contact; ++k) {
        mote_vec3 corner[2][3];
        triangle_corners(&s->surface[0], pairs[k].primID0, corner[0]);
        triangle_corners(&s->surface[1], pairs[k].primID1, corner[1]);
        s->triangle_tests++;
        s->contact =
            mote_triangle_triangle(corner[0], corner[1], NULL, NULL) <= s->tolerance_squared;
    }
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    (void)frame;
    embree_state *s = state;
    s->contact = false;
    s->box_tests = s->triangle_tests = 0;
    rtcCollide(s->surface[0].scene, s->surface[1].scene, test_pairs, s);
    enum RTCError error = rtcGetDeviceError(s->device);
    if (error != RTC_ERROR_NONE)
        return mote_fail(MOTE_ENUMERIC, "Embree could not collide: error %d", (int)error);
    answer->has_contact = true;
    answer->contact = s->contact;
    answer->counters.box_tests = s->box_tests;
    answer->counters.triangle_tests = s->triangle_tests;
    return MOTE_OK;
}

MOTE_METHOD(embree_contact) = {
    .name = "embree-contact",
    .summary = "Embree 3: boxes of all touching pairs, refitted; contact only",
    .parameters = parameters,
    .parameter_count = PARAMETER_COUNT,
    .traits = traits,
    .create = create,
    .destroy = destroy,
    .update = update,
    .query = query,
};
