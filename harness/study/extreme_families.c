/* What is taken to extremes, and how. Each extreme modifies the plain scene, whose L is about
   1. */
#include "harness/study/extreme.h"

#include "harness/base/curve.h"
#include "harness/scene/motion.h"

#include <stdio.h>
#include <string.h>

static double power_of_ten(int k)
{
    double power = 1;
    for (int i = 0; i < (k < 0 ? -k : k); ++i)
        power *= 10;
    return k < 0 ? 1 / power : power;
}

static mote_status as_it_is(const mote_extreme_recipe *plain, int k, mote_extreme_recipe *made)
{
    (void)k;
    *made = *plain;
    return MOTE_OK;
}

static void scale_all(mote_vec3 *v, size_t count, double by)
{
    for (size_t i = 0; i < count; ++i)
        v[i] = mote_scale(v[i], by);
}

static mote_status change_scale(const mote_extreme_recipe *plain, int k,
                                mote_extreme_recipe *made)
{
    const double by = power_of_ten(k);
    *made = *plain;
    scale_all(made->position[0], 2 * (size_t)MOTE_EXTREME_VERTICES, by);
    scale_all(made->middle, 2, by);
    scale_all(made->centre[0], 2 * (size_t)MOTE_EXTREME_CONTROLS, by);
    scale_all(made->move[0][0], 2 * (size_t)MOTE_EXTREME_FRAMES * MOTE_EXTREME_CONTROLS, by);
    scale_all(made->place[0], 2 * (size_t)MOTE_EXTREME_FRAMES, by);
    made->support *= by;
    return MOTE_OK;
}

/* A direction along no axis or symmetry, which would make the problem easier. */
static const mote_vec3 askew = {0.6123724356957945, 0.35355339059327373, -0.7071067811865476};

static mote_status change_offset(const mote_extreme_recipe *plain, int k,
                                 mote_extreme_recipe *made)
{
    *made = *plain;
    for (int b = 0; b < 2; ++b) {
        for (int f = 0; f < MOTE_EXTREME_FRAMES; ++f)
            made->place[b][f] = mote_add_scaled(made->place[b][f], power_of_ten(k), askew);
    }
    return MOTE_OK;
}

/* Moves the meshes far from their origin; the poses undo it. */
static mote_status change_mesh_offset(const mote_extreme_recipe *plain, int k,
                                      mote_extreme_recipe *made)
{
    const double far = power_of_ten(k);
    *made = *plain;
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < made->vertex_count[b]; ++i)
            made->position[b][i] = mote_add_scaled(made->position[b][i], far, askew);
        for (uint32_t j = 0; j < made->controls; ++j)
            made->centre[b][j] = mote_add_scaled(made->centre[b][j], far, askew);
        made->middle[b] = mote_add_scaled(made->middle[b], far, askew);
    }
    return MOTE_OK;
}

/* Rounds mesh, centres and poses to 32 bits; from k = 0 on, with the mesh 10^k off its
   origin. */
static mote_status change_to_float(const mote_extreme_recipe *plain, int k,
                                   mote_extreme_recipe *made)
{
    mote_status status = k < 0 ? as_it_is(plain, k, made) : change_mesh_offset(plain, k, made);
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < made->vertex_count[b]; ++i)
            made->position[b][i] = mote_as_floats(made->position[b][i]);
        for (uint32_t j = 0; j < made->controls; ++j)
            made->centre[b][j] = mote_as_floats(made->centre[b][j]);
        made->middle[b] = mote_as_floats(made->middle[b]);
        for (int f = 0; f < MOTE_EXTREME_FRAMES; ++f)
            made->place[b][f] = mote_as_floats(made->place[b][f]);
    }
    return status;
}

static mote_status set_gaps(mote_extreme_recipe *made, const double gaps[MOTE_EXTREME_FRAMES])
{
    mote_status status = MOTE_OK;
    for (uint32_t f = 0; f < MOTE_EXTREME_FRAMES && status == MOTE_OK; ++f) {
        made->place[1][f] = mote_vec3_make(1.5, 0.3, 0.2);
        status = mote_extreme_set_gap(made, f, gaps[f]);
    }
    return status;
}

static const double usual_gaps[MOTE_EXTREME_FRAMES] = {0.2, 0.02, 5e-4, -0.04};

/* Squashes both bodies along y, in the letters' plane: all triangles become slivers. */
static mote_status change_sliver(const mote_extreme_recipe *plain, int k,
                                 mote_extreme_recipe *made)
{
    *made = *plain;
    for (int b = 0; b < 2; ++b) {
        for (uint32_t i = 0; i < made->vertex_count[b]; ++i)
            made->position[b][i].y *= power_of_ten(-k);
        for (uint32_t j = 0; j < made->controls; ++j)
            made->centre[b][j].y *= power_of_ten(-k);
        made->middle[b].y *= power_of_ten(-k);
    }
    made->controls = 0; /* a field would restore the slivers' height */
    return set_gaps(made, usual_gaps);
}

static mote_status change_gap(const mote_extreme_recipe *plain, int k,
                              mote_extreme_recipe *made)
{
    const double gap = power_of_ten(-k);
    const double gaps[MOTE_EXTREME_FRAMES] = {3 * gap, gap, gap, -gap};
    *made = *plain;
    return set_gaps(made, gaps);
}

/* A cube of twelve triangles, corners at 0 and 1. */
static void use_cube(mote_extreme_recipe *r, int b)
{
    static const uint32_t faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                          {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                          {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    r->vertex_count[b] = 8;
    r->triangle_count[b] = 12;
    memcpy(r->triangle[b], faces, sizeof faces);
    for (int i = 0; i < 8; ++i)
        r->position[b][i] = mote_vec3_make(i & 1 ? 1 : 0, i & 2 ? 1 : 0, i & 4 ? 1 : 0);
    r->middle[b] = mote_vec3_make(0, 0, 0);
}

static void stand_still(mote_extreme_recipe *r, mote_vec3 second)
{
    r->controls = 0;
    for (int f = 0; f < MOTE_EXTREME_FRAMES; ++f) {
        for (int b = 0; b < 2; ++b) {
            r->turn[b][f] = (mote_quaternion){1, 0, 0, 0};
            r->place[b][f] = mote_vec3_make(0, 0, 0);
        }
        r->place[1][f] = second;
    }
}

static void use_triangle(mote_extreme_recipe *r, int b)
{
    static const mote_vec3 corner[3] = {{-0.3, -0.2, 0}, {0.4, -0.1, 0}, {0, 0.3, 0}};
    r->vertex_count[b] = 3;
    r->triangle_count[b] = 1;
    memcpy(r->position[b], corner, sizeof corner);
    for (uint32_t i = 0; i < 3; ++i)
        r->triangle[b][0][i] = i;
    r->middle[b] = mote_vec3_make(0, 0, 0);
}

/* Triangles with integer coordinates: a corner of one lies in the other
   (datasets/defects.md). */
static void use_touching_triangles(mote_extreme_recipe *r, int which)
{
    static const mote_vec3 corner[2][2][3] = {
        {{{3, 3, 1}, {0, 1, 2}, {3, 2, 0}}, {{1, 2, 3}, {1, 1, 2}, {2, 2, 1}}},
        {{{1, 1, 2}, {2, 0, 0}, {2, 2, 2}}, {{1, 3, 3}, {2, 2, 1}, {3, 1, 2}}}};
    for (int b = 0; b < 2; ++b) {
        use_triangle(r, b);
        memcpy(r->position[b], corner[which][b], sizeof corner[which][b]);
    }
}

static const char *const touch_names[] = {
    "corner", "edge", "face", "part of a face", "one place", "triangles 1", "triangles 2"};

/* Cubes with integer coordinates that touch at a corner, along an edge or a face; or
   coincide. */
static mote_status change_touch(const mote_extreme_recipe *plain, int k,
                                mote_extreme_recipe *made)
{
    static const mote_vec3 places[] = {{1, 1, 1}, {1, 1, 0}, {1, 0, 0}, {1, 0.5, 0.25},
                                       {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    *made = *plain;
    use_cube(made, 0);
    use_cube(made, 1);
    if (k >= 5)
        use_touching_triangles(made, k - 5);
    stand_still(made, places[k]);
    return MOTE_OK;
}

static mote_status change_support(const mote_extreme_recipe *plain, int k,
                                  mote_extreme_recipe *made)
{
    *made = *plain;
    made->support = power_of_ten((k - (k & 1)) / 2) * (k & 1 ? 3.1622776601683795 : 1);
    return set_gaps(made, usual_gaps);
}

static const char *const support_names[] = {"0.01 L", "0.03 L", "0.1 L", "0.3 L", "1 L",
                                            "3 L",    "10 L",   "30 L",  "100 L"};

/* Adds a ninth control point so near the first that the condition number is about 10^k: that of
   two points at a distance r (in supports) is 2 / (10 r^2). Its displacement differs
   slightly. */
static mote_status change_condition(const mote_extreme_recipe *plain, int k,
                                    mote_extreme_recipe *made)
{
    const double apart = sqrt(0.2 / power_of_ten(k));
    *made = *plain;
    const uint32_t j = made->controls++;
    for (int b = 0; b < 2; ++b) {
        made->centre[b][j] = mote_add_scaled(made->centre[b][0], apart * made->support, askew);
        for (int f = 0; f < MOTE_EXTREME_FRAMES; ++f)
            made->move[b][f][j] =
                mote_add_scaled(made->move[b][f][0], 0.1 * apart * made->support, askew);
    }
    return set_gaps(made, usual_gaps);
}

static const char *const duplicate_names[] = {"fitted", "weights", "weights that cancel"};

/* Puts two control points at one place: fitted, or with given weights. */
static mote_status change_duplicate(const mote_extreme_recipe *plain, int k,
                                    mote_extreme_recipe *made)
{
    *made = *plain;
    const uint32_t j = made->controls++;
    made->direct = k > 0;
    for (int b = 0; b < 2; ++b) {
        made->centre[b][j] = made->centre[b][0];
        for (int f = 0; f < MOTE_EXTREME_FRAMES && k > 0; ++f)
            made->move[b][f][j] = made->move[b][f][0];
        for (int f = 0; f < MOTE_EXTREME_FRAMES && k == 2; ++f) {
            made->move[b][f][j] = mote_scale(askew, 1e9);
            made->move[b][f][0] = mote_add_scaled(made->move[b][f][0], -1e9, askew);
        }
    }
    return set_gaps(made, usual_gaps);
}

static const char *const inside_out_names[] = {"into a point", "inside out",
                                               "and twice as large"};

/* Control points move through the middle of the body to k times their distance on the other
   side. */
static mote_status change_inside_out(const mote_extreme_recipe *plain, int k,
                                     mote_extreme_recipe *made)
{
    *made = *plain;
    made->support = 5;
    for (int b = 0; b < 2; ++b) {
        for (int f = 0; f < MOTE_EXTREME_FRAMES; ++f) {
            for (uint32_t j = 0; j < made->controls; ++j)
                made->move[b][f][j] =
                    mote_scale(mote_sub(made->middle[b], made->centre[b][j]), k + 1.0);
        }
    }
    return set_gaps(made, usual_gaps);
}

/* The second body is rotated by 180 degrees minus 10^-k, by 180 plus 10^-k, by the first angle
   in the opposite direction, and halfway to it as motions are interpolated. */
static mote_status change_turn(const mote_extreme_recipe *plain, int k,
                               mote_extreme_recipe *made)
{
    static const uint32_t frames[2] = {1, 3};
    const double less = k > 15 ? 0 : power_of_ten(-k);
    const mote_vec3 axis = mote_vec3_make(1, 0.4, 0.6);
    *made = *plain;
    made->turn[0][0] = mote_quaternion_about(mote_vec3_make(0, 0, 1), 180 - less);
    made->turn[1][0] = mote_quaternion_about(axis, 180 - less);
    made->turn[1][1] = mote_quaternion_about(axis, 180 + less);
    made->turn[1][2] = mote_quaternion_about(axis, -180 + less);
    mote_quaternion keys[2] = {{1, 0, 0, 0}, made->turn[1][0]};
    mote_quaternions_align(keys, 2);
    mote_curve *curve = NULL;
    double q[4];
    mote_status status = mote_curve_create(frames, &keys[0].w, 2, 4, &curve);
    if (status != MOTE_OK)
        return status;
    mote_curve_evaluate(curve, 2, q);
    mote_curve_destroy(curve);
    made->turn[1][3] = (mote_quaternion){q[0], q[1], q[2], q[3]};
    return set_gaps(made, usual_gaps);
}

static const char *const triangle_names[] = {"one, letter", "letter, one", "one, one"};

static mote_status change_to_triangle(const mote_extreme_recipe *plain, int k,
                                      mote_extreme_recipe *made)
{
    *made = *plain;
    if (k != 1)
        use_triangle(made, 0);
    if (k != 0)
        use_triangle(made, 1);
    return set_gaps(made, usual_gaps);
}

static const char *const particle_names[] = {"1", "all vertices", "one more"};
static const char *const attraction_names[] = {"0", "infinite"};
static const char *const float_names[] = {"mesh",       "and 10^0 L", "and 10^1 L",
                                          "and 10^2 L", "and 10^3 L", "and 10^4 L",
                                          "and 10^5 L", "and 10^6 L", "and 10^7 L"};
static const char *const particle_parameters[] = {"n=1", "n=202", "n=203"};
static const char *const attraction_parameters[] = {"reff=0", "reff=inf"};
static const char *const single_parameters[] = {"precision=single"};
static const char *const single_names[] = {"32 bits"};
static const char *const plain_names[] = {"nothing extreme"};

const mote_extreme_family mote_extreme_families[] = {
    {"plain", "letters T and V of 400 triangles, apart, near and intersecting", 0, 0, 1,
     plain_names, as_it_is, NULL},
    {"scale", "everything times 10^k", -12, 12, 6, NULL, change_scale, NULL},
    {"offset", "both bodies placed 10^k L from the origin", 0, 12, 4, NULL, change_offset,
     NULL},
    {"mesh offset", "meshes 10^k L from their own origin, undone by the poses", 0, 12, 4, NULL,
     change_mesh_offset, NULL},
    {"float input", "mesh and poses rounded to 32 bits; the mesh 10^k L from its origin", -1, 7,
     3, float_names, change_to_float, NULL},
    {"float method", "positions evaluated in 32 bits, by methods that can", 0, 0, 1,
     single_names, as_it_is, single_parameters},
    {"sliver", "bodies squashed by 10^k", 1, 12, 4, NULL, change_sliver, NULL},
    {"gap", "bodies 10^k L apart, or in each other", 1, 15, 5, NULL, change_gap, NULL},
    {"touch", "cubes and triangles of whole numbers that share something", 0, 6, 1, touch_names,
     change_touch, NULL},
    {"particles", "n", 0, 2, 1, particle_names, as_it_is, particle_parameters},
    {"R_eff", "effective radius of attraction", 0, 1, 1, attraction_names, as_it_is,
     attraction_parameters},
    {"support", "support radius of the field", -4, 4, 4, support_names, change_support, NULL},
    {"condition", "of the field's fit, by a control point near another", 1, 15, 7, NULL,
     change_condition, NULL},
    {"duplicate", "two control points at one place", 0, 2, 1, duplicate_names, change_duplicate,
     NULL},
    {"inside out", "deformation through the body's middle", 0, 2, 1, inside_out_names,
     change_inside_out, NULL},
    {"turn", "poses 10^k degrees from 180, on both sides; 10^-16: exactly 180", 0, 16, 8, NULL,
     change_turn, NULL},
    {"triangles", "one triangle", 0, 2, 1, triangle_names, change_to_triangle, NULL},
};
const size_t mote_extreme_family_count =
    sizeof mote_extreme_families / sizeof mote_extreme_families[0];

/* Whether a family's k counts digits below 1. */
static bool is_negative(const mote_extreme_family *family)
{
    return strcmp(family->name, "sliver") == 0 || strcmp(family->name, "gap") == 0 ||
           strcmp(family->name, "turn") == 0;
}

void mote_extreme_label(const mote_extreme_family *family, int k, char *label, size_t size)
{
    if (family->names)
        (void)snprintf(label, size, "%s", family->names[k - family->first]);
    else
        (void)snprintf(label, size, "10^%d", is_negative(family) ? -k : k);
}
