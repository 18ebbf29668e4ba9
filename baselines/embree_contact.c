/* embree-contact: Embree's collision of two scenes of user geometry, for contact only. Embree
   finds the pairs of triangles whose boxes meet; whether the triangles do is decided by our own
   kernel. Built only where Embree 3 is installed. One thread, as for every method. The scene of
   a body that changed is refitted (quality LOW: at a higher one Embree rebuilds it). rtcCollide
   cannot be stopped, so that finding a contact early saves only the remaining triangle tests.
 */
#include "baselines/float_positions.h"
#include "baselines/input.h"
#include "core/body/triangle.h"

#include <embree3/rtcore.h>
#include <float.h>
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
    float (*position)[4];      /* [vertex_count]: in the unit of the pair, for boxes */
    float margin;              /* boxes are larger by this on every side */
    RTCScene scene;
    RTCGeometry geometry;
} surface;

typedef struct embree_state {
    RTCDevice device;
    surface surface[2];
    mote_float_pair places;
    double tolerance_squared;
    float tolerance_margin; /* half the tolerance in the unit of the pair, rounded up */
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
        free(s->surface[b].position);
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

/* Called by Embree for each triangle of a refit. The margin makes the box enclose the triangle,
   grown by half the tolerance. */
static void box_of_triangle(const struct RTCBoundsFunctionArguments *arguments)
{
    const surface *body = arguments->geometryUserPtr;
    const uint32_t *t = body->mesh->triangles[arguments->primID];
    const float *p = body->position[t[0]], *q = body->position[t[1]], *r = body->position[t[2]];
    float low[4], high[4];
    for (int k = 0; k < 4; ++k) {
        low[k] = mote_float_smallest(p[k], q[k], r[k]) - body->margin;
        high[k] = mote_float_largest(p[k], q[k], r[k]) + body->margin;
    }
    struct RTCBounds *box = arguments->bounds_o;
    box->lower_x = low[0];
    box->lower_y = low[1];
    box->lower_z = low[2];
    box->upper_x = high[0];
    box->upper_y = high[1];
    box->upper_z = high[2];
}

/* The rounding of a position to float, and that of adding the margin to it, are each at most
   2^-23 of the sum's terms; mote_float_margin is eight times as large. FLT_MIN is for positions
   so near 0 that their rounding is not in proportion. */
static void set_margin(embree_state *s, int b)
{
    s->surface[b].margin =
        s->tolerance_margin + mote_float_margin(s->places.coordinate_max[b]) + FLT_MIN;
}

/* Those at rest, for which the tree is built. */
static mote_status make_positions(embree_state *s, int b)
{
    surface *body = &s->surface[b];
    const uint32_t count = body->mesh->vertex_count;
    body->vertices = body->mesh->positions;
    body->position = malloc(count * sizeof *body->position);
    if (!body->position)
        return mote_fail(MOTE_ENOMEM, "no memory for %u vertices", count);
    s->places.count[b] = count;
    s->places.position[b] = body->position;
    const mote_status status =
        mote_float_positions(body->position, body->vertices, count, body->vertices[0],
                             s->places.scale, b, &s->places.coordinate_max[b]);
    if (status == MOTE_OK)
        set_margin(s, b);
    return status;
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
    s->places.scale = ldexp(1, -ilogb(setup->length));
    s->tolerance_margin = (float)(setup->tolerance * s->places.scale / 2 * (1 + 0x1p-20));
    s->device = rtcNewDevice("threads=1,user_threads=1,set_affinity=0");
    if (!s->device)
        status = mote_fail(MOTE_ENUMERIC, "Embree could not create a device on this processor");
    for (int b = 0; b < 2 && status == MOTE_OK; ++b) {
        s->surface[b].mesh = setup->body[b]->mesh;
        status = make_positions(s, b);
        if (status == MOTE_OK)
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
    bool moved[2];
    const mote_status status = mote_float_pair_update(&s->places, frame, moved);
    if (status != MOTE_OK)
        return status;
    for (int b = 0; b < 2; ++b) {
        surface *body = &s->surface[b];
        body->vertices = frame->body[b].vertices;
        if (!moved[b])
            continue;
        set_margin(s, b);
        rtcUpdateGeometryBuffer(body->geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(body->geometry);
        rtcCommitScene(body->scene);
    }
    enum RTCError error = rtcGetDeviceError(s->device);
    if (error != RTC_ERROR_NONE)
        return mote_fail(MOTE_ENUMERIC, "Embree could not refit: error %d", (int)error);
    return MOTE_OK;
}

/* Only distances within the tolerance matter. DBL_MIN: while Embree calls this, numbers below
   it count as 0. */
static void test_pairs(void *state, struct RTCCollision *pairs, unsigned count)
{
    embree_state *s = state;
    const double bound = fmax(nextafter(s->tolerance_squared, HUGE_VAL), DBL_MIN);
    s->box_tests += count;
    for (unsigned k = 0; k < count && !s->contact; ++k) {
        mote_vec3 corner[2][3];
        triangle_corners(&s->surface[0], pairs[k].primID0, corner[0]);
        triangle_corners(&s->surface[1], pairs[k].primID1, corner[1]);
        s->triangle_tests++;
        s->contact = mote_triangle_triangle_below(corner[0], corner[1], bound, NULL, NULL) <=
                     s->tolerance_squared;
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
