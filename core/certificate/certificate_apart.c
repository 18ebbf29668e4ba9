/* A contact question about bodies that the last query showed to be apart: does a direction near
   the last one still part them? This looks at the boxes around rigid bodies, and at the roots
   of both trees. */
#include "core/certificate/certificate_state.h"

/* Directions tried in a query of rigid bodies. On tt, whose letters are apart in 505 of 600
   frames, 1 settles 217, 2 settle 258, 4 settle 267 and 9 settle 269: in the others the roots'
   boxes interlock. Where there is a field, each direction costs a projection of its weights,
   and a second one more than it saves (ww-contact, frames 1100-1300: 37,001 instructions a
   frame instead of 33,621). */
#define TRIES_RIGID 2

/* The boxes around rigid bodies at rest are asked first. If they settled the last query, the
   direction is turned at most this often; if they fail, so many queries go straight to the
   roots, since frames that need these come in long runs. */
#define TURNS_AT_REST 2
#define REST_PAUSE 8

/* Keeps a direction; false, and nothing is kept, where the vector is 0 or not a number. */
static bool keep(mote_cert_memory *memory, mote_vec3 vector)
{
    const double length = mote_length(vector);
    if (!(length > 0))
        return false;
    memory->parting[0] = (float)(vector.x / length);
    memory->parting[1] = (float)(vector.y / length);
    memory->parting[2] = (float)(vector.z / length);
    return true;
}

/* The direction kept, as a unit vector. */
static mote_vec3 kept(const mote_cert_memory *memory)
{
    const float *d = memory->parting;
    const mote_vec3 vector = mote_vec3_make((double)d[0], (double)d[1], (double)d[2]);
    return mote_scale(vector, 1 / mote_length(vector));
}

void mote_cert_remember_parting(mote_certificate *c, double lower)
{
    const bool apart = c->enough >= 0 && lower > c->enough;
    c->memory.parted =
        apart && keep(&c->memory, mote_sub(c->best.witness[1], c->best.witness[0]));
    c->memory.parted_at_rest = c->memory.parted && c->memory.rest_pause == 0;
}

static bool rigid(const mote_certificate *c)
{
    return c->side[0].tree->body->field->count == 0 && c->side[1].tree->body->field->count == 0;
}

/* The box around a rigid body at rest, where its pose places it. */
typedef struct rest_box {
    const mote_mat3 *rotation;
    mote_vec3 middle, half;
    double size; /* of the coordinates that its corners are made of */
} rest_box;

static rest_box rest_box_of(const mote_cert_tree *tree, const mote_pose *pose)
{
    const mote_mesh *mesh = tree->body->mesh;
    const mote_vec3 half = mote_scale(mote_sub(mesh->high, mesh->low), 0.5);
    return (rest_box){.rotation = &pose->rotation,
                      .middle = mote_pose_apply(pose, tree->origin),
                      .half = half,
                      .size = mote_largest_coordinate(pose->translation) +
                              2 * mote_largest_coordinate(tree->origin) +
                              2 * mote_largest_coordinate(half)};
}

static double reach_along(const rest_box *box, mote_vec3 local)
{
    return fabs(local.x) * box->half.x + fabs(local.y) * box->half.y +
           fabs(local.z) * box->half.z;
}

/* From the middle of a box to the corner that lies farthest along a local direction. */
static mote_vec3 corner_along(const rest_box *box, mote_vec3 local)
{
    return mote_rotate(box->rotation, mote_vec3_make(copysign(box->half.x, local.x),
                                                     copysign(box->half.y, local.y),
                                                     copysign(box->half.z, local.z)));
}

/* The mirror image of a direction at the plane across a line. */
static mote_vec3 mirrored(mote_vec3 direction, mote_vec3 line)
{
    return mote_add_scaled(direction,
                           -2 * mote_dot(direction, line) / mote_length_squared(line), line);
}

/* In double precision. A coordinate of a box is a sum of at most 12 terms, each below the size
   that is added up for it; 2^-46 of the sizes covers their rounding and that of positions. A
   direction that is kept has a length of 1 within 2^-22, and mirroring does not change it:
   giving up 2^-20 of the gap takes less time than dividing by the length. */
static bool part_at_rest(mote_certificate *c, const mote_frame *frame, int turns, double *lower)
{
    const rest_box box[2] = {rest_box_of(c->side[0].tree, &frame->body[0].pose),
                             rest_box_of(c->side[1].tree, &frame->body[1].pose)};
    const mote_vec3 between = mote_sub(box[1].middle, box[0].middle);
    const double margin = 0x1p-46 * (box[0].size + box[1].size);
    const float *d = c->memory.parting;
    mote_vec3 u = mote_vec3_make((double)d[0], (double)d[1], (double)d[2]);
    for (;; --turns) {
        const mote_vec3 local[2] = {mote_rotate_back(box[0].rotation, u),
                                    mote_rotate_back(box[1].rotation, u)};
        *lower = (mote_dot(u, between) - reach_along(&box[0], local[0]) -
                  reach_along(&box[1], local[1]) - margin) *
                 (1 - 0x1p-20);
        if (*lower > c->enough)
            return keep(&c->memory, u);
        if (turns == 0)
            return false;
        u = mirrored(u, mote_sub(between, mote_add(corner_along(&box[0], local[0]),
                                                   corner_along(&box[1], local[1]))));
    }
}

bool mote_cert_rest_apart(mote_certificate *c, const mote_frame *frame, double *lower)
{
    mote_cert_memory *memory = &c->memory;
    if (!rigid(c))
        return false;
    if (memory->rest_pause > 0) {
        --memory->rest_pause;
        return false;
    }
    const int turns = memory->parted_at_rest ? TURNS_AT_REST : 0;
    memory->parted_at_rest = part_at_rest(c, frame, turns, lower);
    memory->rest_pause = memory->parted_at_rest ? 0 : REST_PAUSE;
    return memory->parted_at_rest;
}

/* A proven lower bound of the distance: the gap between the roots' boxes along a direction. The
   two planes across it are the limit apart, as the traversal expects. */
static double gap_along(mote_certificate *c, mote_vec3 direction)
{
    const mote_vec3 facing[2] = {direction, mote_scale(direction, -1)};
    double gap = 0;
    ++c->generation;
    for (int s = 0; s < 2; ++s) {
        mote_cert_side_face(&c->side[s], facing[s], -0.5 * c->limit);
        gap -= (double)mote_cert_farthest_reach(mote_cert_root(c, s));
    }
    return (gap * (1 - 1e-13) - 4 * c->noise) / c->scale;
}

/* The corner of the root's boxes that reaches farthest towards the other body. */
static mote_vec3 farthest_corner(mote_certificate *c, int s)
{
    mote_cert_node *root = mote_cert_root(c, s);
    mote_cert_make_boxes(c, s, root);
    const size_t l = mote_cert_farthest_child(root);
    double corner[3];
    for (size_t r = 0; r < 3; ++r) {
        corner[r] = (double)root->centre[r][l];
        for (size_t k = 0; k < 3; ++k) {
            const double half = (double)root->axis[k][r][l];
            corner[r] += root->slant[k][l] > 0 ? half : -half;
        }
    }
    return mote_vec3_make(corner[0], corner[1], corner[2]);
}

/* Turns the direction kept, which does not part the bodies: mirrored at the plane across the
   line between the corners that overlap most (Chung and Wang 1996). It parts convex bodies
   after a few turns. False where the corners coincide or leave the range of floats. */
static bool turn(mote_certificate *c)
{
    const mote_vec3 line = mote_sub(farthest_corner(c, 1), farthest_corner(c, 0));
    return keep(&c->memory, mirrored(kept(&c->memory), line));
}

bool mote_cert_still_apart(mote_certificate *c, double *lower)
{
    const int tries = rigid(c) ? TRIES_RIGID : 1;
    *lower = gap_along(c, kept(&c->memory));
    for (int i = 1; i < tries && !(*lower > c->enough) && turn(c); ++i)
        *lower = gap_along(c, kept(&c->memory));
    return *lower > c->enough;
}
