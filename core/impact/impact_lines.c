/* Positions on straight lines as a field, and its boxes for each frame.

   Margins, as in certificate_fitted.c, with u = 2^-24 and B (side->bound) a bound of |t| + |a|
   r + |b| r', t being where the frames' middles come to, relative to the query's origin, and r,
   r' the frames' radii: the terms of any box's end. Ends of boxes, a, b and t are rounded once,
   products and sums 4 times, middle and half width 2 times more: less than 10 u B in a
   coordinate, and less than 18 u B along a direction. What tests of boxes round is at most 40 u
   B; 64 u B is more than both. Positions in double precision are wrong by at most 3 * 2^-53 of
   the frames' sizes, and as much again relative to the origin: 2^-48 of them is more. */
#include "core/impact/impact_lines.h"

#include "core/body/path_place.h"
#include "core/certificate/certificate_bounds.h"
#include "core/certificate/certificate_project.h"
#include "core/stream/stream_boxes.h"

#include <stdlib.h>
#include <string.h>

#define WIDTH MOTE_CERT_WIDTH
#define FLOAT_ROUNDING 0x1p-24

/* Positions this many L from the origin or more are refused: their boxes' squares would not be
   floats. */
#define FAR 1e18

/* --- the field -----------------------------------------------------------------------------
 */

mote_lines *mote_lines_of(const mote_field *field)
{
    return (mote_lines *)(uintptr_t)field->data;
}

MOTE_INLINE mote_vec3 at_amounts(const mote_lines *lines, uint32_t vertex,
                                 const mote_weights *weights)
{
    return mote_add_scaled(
        mote_scale(mote_position_at(&lines->frame[0].positions, vertex), weights->x[0]),
        weights->y[0], mote_position_at(&lines->frame[1].positions, vertex));
}

static mote_vec3 lines_displacement(const mote_field *field, const mote_mesh *mesh,
                                    uint32_t vertex, const mote_weights *weights)
{
    (void)mesh;
    return at_amounts(mote_lines_of(field), vertex, weights);
}

static void lines_displacement_single(const mote_field *field, const mote_mesh *mesh,
                                      uint32_t vertex, const mote_weights_single *weights,
                                      float displacement[3])
{
    const double a = (double)weights->x[0], b = (double)weights->y[0];
    const mote_weights own = {.x = &a, .y = &b};
    const mote_vec3 p = lines_displacement(field, mesh, vertex, &own);
    displacement[0] = (float)p.x;
    displacement[1] = (float)p.y;
    displacement[2] = (float)p.z;
}

static void lines_group(const mote_field *field, const mote_mesh *mesh,
                        const uint32_t vertices[MOTE_LANES], const mote_weights *weights,
                        double displacement[3][MOTE_LANES])
{
    (void)mesh;
    for (size_t v = 0; v < MOTE_LANES; ++v) {
        const mote_vec3 p = at_amounts(mote_lines_of(field), vertices[v], weights);
        displacement[0][v] = p.x;
        displacement[1][v] = p.y;
        displacement[2][v] = p.z;
    }
}

static void lines_destroy(mote_field *field)
{
    mote_lines *lines = mote_lines_of(field);
    free(lines->frame[0].blocks);
    free(lines->frame[1].blocks);
    free(lines);
    free(field);
}

/* --- its bounds ----------------------------------------------------------------------------
 */

static mote_status no_start(mote_cert_tree *tree, bool linear_fits, void **fitter)
{
    (void)tree, (void)linear_fits, (void)fitter;
    return MOTE_OK;
}

static void no_fit(void *fitter, mote_cert_tree *tree, const mote_cert_part *part)
{
    (void)fitter, (void)tree, (void)part;
}

static mote_status no_store(void *fitter, mote_cert_tree *tree, mote_cert_block *block)
{
    (void)fitter, (void)tree, (void)block;
    return MOTE_OK;
}

static void no_stop(void *fitter)
{
    (void)fitter;
}

/* The amounts of a frame of the certificate. */
typedef struct amounts {
    float first, second;
} amounts;

static size_t amounts_bytes(const mote_cert_tree *tree)
{
    (void)tree;
    return sizeof(amounts);
}

static float rounded_up(double x)
{
    return (float)(x * (1 + 0x1p-22));
}

static void lines_begin(mote_cert_side *side)
{
    const mote_lines *lines = mote_lines_of(side->tree->body->field);
    const mote_lines_frame *p = &lines->frame[0], *q = &lines->frame[1];
    const double a = side->state->weights.x[0], b = side->state->weights.y[0];
    const double scale = side->tree->scale;
    const mote_vec3 origin = side->exact_translation; /* the pose is 0 */
    const mote_vec3 middle = mote_add_scaled(mote_scale(p->middle, a), b, q->middle);
    const mote_vec3 t = mote_add_scaled(origin, scale, middle);
    *(amounts *)side->frame = (amounts){(float)a, (float)b};
    side->exact_translation = t;
    side->translation[0] = (float)t.x;
    side->translation[1] = (float)t.y;
    side->translation[2] = (float)t.z;
    side->world =
        mote_largest_coordinate(origin) + (fabs(a) * p->size + fabs(b) * q->size) * scale;
    side->bound = mote_largest_coordinate(t) + fabs(a) * p->radius + fabs(b) * q->radius;
    side->noise = 0x1p-48 * side->bound;
    side->exact = 0x1p-48 * (side->world + side->bound);
    side->margin_unit = 0;
    side->margin_base = rounded_up(64 * FLOAT_ROUNDING * side->bound + side->exact);
    side->reach_margin = rounded_up(4 * FLOAT_ROUNDING * side->bound);
    side->leaf_margin = rounded_up(32 * FLOAT_ROUNDING * side->bound);
}

static void no_face(mote_cert_side *side)
{
    (void)side;
}

/* The boxes of a block's children, without margin; half widths of a displacement may be less
   than 0. */
typedef struct boxes {
    float middle[3][WIDTH], half[3][WIDTH];
} boxes;

MOTE_INLINE void boxes_of(const mote_cert_side *restrict side,
                          const mote_cert_block *restrict block, boxes *restrict out)
{
    const mote_lines *lines = mote_lines_of(side->tree->body->field);
    const size_t number = (size_t)(block - side->tree->blocks);
    const mote_lines_block *restrict p = &lines->frame[0].blocks[number];
    const mote_lines_block *restrict q = &lines->frame[1].blocks[number];
    const amounts *at = side->frame;
    const float a = at->first, b = at->second;
    for (size_t r = 0; r < 3; ++r) {
        const float t = side->translation[r];
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            const float low = a * p->low[r][l] + b * q->low[r][l];
            const float high = a * p->high[r][l] + b * q->high[r][l];
            out->middle[r][l] = t + 0.5F * (low + high);
            out->half[r][l] = 0.5F * (high - low);
        }
    }
}

MOTE_CLONES
static void lines_project(const mote_cert_side *restrict side,
                          const mote_cert_block *restrict block, mote_cert_node *restrict node)
{
    boxes own;
    boxes_of(side, block, &own);
    const float *n = side->facing_world;
    const float margin = side->margin_base;
    const float none[3] = {0, 0, 0};
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        const float middle =
            own.middle[0][l] * n[0] + own.middle[1][l] * n[1] + own.middle[2][l] * n[2];
        const float half = own.half[0][l] * fabsf(n[0]) + own.half[1][l] * fabsf(n[1]) +
                           own.half[2][l] * fabsf(n[2]);
        mote_cert_project_lane(block, node, l, middle, none, half + 2 * margin);
    }
    node->leaf_margin = side->leaf_margin;
    mote_cert_finish_projection(side, block, node, true);
}

MOTE_CLONES
static void lines_boxes(const mote_cert_side *restrict side,
                        const mote_cert_block *restrict block, mote_cert_node *restrict node)
{
    boxes own;
    boxes_of(side, block, &own);
    memset(node->axis, 0, sizeof node->axis);
    const float margin = side->margin_base;
    for (size_t r = 0; r < 3; ++r) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            const float half = own.half[r][l] + margin;
            node->centre[r][l] = own.middle[r][l];
            node->width[r][l] = half;
            node->low[r][l] = own.middle[r][l] - half;
            node->high[r][l] = own.middle[r][l] + half;
        }
    }
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        node->size[l] = (own.half[0][l] * own.half[0][l] + own.half[1][l] * own.half[1][l]) +
                        own.half[2][l] * own.half[2][l];
    node->spans = node->aligned = true;
    node->leaf_margin = side->leaf_margin;
}

static bool lines_hull(const mote_cert_side *side, const mote_cert_node *node, size_t lane,
                       mote_cert_hull *hull)
{
    const mote_cert_tree *tree = side->tree;
    const mote_lines *lines = mote_lines_of(tree->body->field);
    const mote_weights *w = &side->state->weights;
    const uint32_t *vertices = tree->leaf_vertices + hull->leaf->first_vertex;
    const mote_vec3 middle = mote_add_scaled(mote_scale(lines->frame[0].middle, w->x[0]),
                                             w->y[0], lines->frame[1].middle);
    (void)node, (void)lane;
    for (uint32_t i = 0; i < hull->groups * WIDTH; ++i) {
        const uint32_t count = hull->leaf->vertex_count;
        const uint32_t v = vertices[i < count ? i : count - 1];
        const mote_vec3 p = mote_add_scaled(side->exact_translation, tree->scale,
                                            mote_sub(at_amounts(lines, v, w), middle));
        hull->x[0][i] = (float)p.x;
        hull->x[1][i] = (float)p.y;
        hull->x[2][i] = (float)p.z;
    }
    for (size_t r = 0; r < 3; ++r)
        hull->width[r] = side->margin_base;
    return true;
}

static const mote_cert_bounds lines_bounds = {.name = "lines",
                                              .start = no_start,
                                              .fit = no_fit,
                                              .store = no_store,
                                              .stop = no_stop,
                                              .frame_bytes = amounts_bytes,
                                              .begin = lines_begin,
                                              .face = no_face,
                                              .project = lines_project,
                                              .boxes = lines_boxes,
                                              .hull = lines_hull};

static const mote_field_kind lines_kind = {.name = "lines",
                                           .displacement = lines_displacement,
                                           .displacement_single = lines_displacement_single,
                                           .group = lines_group,
                                           .bounds = &lines_bounds,
                                           .destroy = lines_destroy};

mote_status mote_lines_create(mote_field **field)
{
    mote_field *made = NULL;
    mote_lines *lines = calloc(1, sizeof *lines);
    mote_status status = MOTE_OK;
    if (!lines)
        status = mote_fail(MOTE_ENOMEM, "no memory for a body of which positions are given");
    else
        status = mote_field_allocate(&lines_kind, 1, &made);
    if (status != MOTE_OK) {
        free(lines);
        return status;
    }
    made->data = lines;
    *field = made;
    return MOTE_OK;
}

mote_status mote_lines_use(mote_lines *lines, const mote_cert_tree *tree, size_t *bytes)
{
    lines->tree = tree;
    for (int k = 0; k < 2; ++k) {
        const size_t size = tree->block_count * sizeof(mote_lines_block);
        lines->frame[k].blocks = malloc(size);
        if (!lines->frame[k].blocks)
            return mote_fail(MOTE_ENOMEM, "no memory for the boxes of %u blocks",
                             tree->block_count);
        *bytes += size;
    }
    return MOTE_OK;
}

/* --- a frame -------------------------------------------------------------------------------
 */

typedef struct extent {
    double low[3], high[3];
} extent;

static const extent nothing = {{HUGE_VAL, HUGE_VAL, HUGE_VAL},
                               {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};

MOTE_INLINE void include(extent *e, mote_vec3 p)
{
    const double at[3] = {p.x, p.y, p.z};
    for (size_t r = 0; r < 3; ++r) {
        e->low[r] = at[r] < e->low[r] ? at[r] : e->low[r];
        e->high[r] = at[r] > e->high[r] ? at[r] : e->high[r];
    }
}

static mote_vec3 middle_of(const extent *e)
{
    return mote_vec3_make(0.5 * e->low[0] + 0.5 * e->high[0],
                          0.5 * e->low[1] + 0.5 * e->high[1],
                          0.5 * e->low[2] + 0.5 * e->high[2]);
}

/* The largest coordinate in an extent. */
static double size_of(const extent *e)
{
    double most = 0;
    for (size_t r = 0; r < 3; ++r)
        most = fmax(most, fmax(fabs(e->low[r]), fabs(e->high[r])));
    return most;
}

MOTE_CLONES
static extent extent_of(const mote_positions *positions, uint32_t count)
{
    extent e = nothing;
    if (positions->single) {
        for (uint32_t v = 0; v < count; ++v)
            include(&e, mote_position_at(positions, v));
        return e;
    }
    for (uint32_t v = 0; v < count; ++v) {
        const char *at = (const char *)positions->data + v * positions->stride;
        const double *p = (const double *)(const void *)at;
        include(&e, mote_vec3_make(p[0], p[1], p[2]));
    }
    return e;
}

static void box_leaf(const mote_lines *lines, const mote_lines_frame *frame,
                     const mote_cert_leaf *leaf, mote_lines_block *block, size_t lane)
{
    const mote_cert_tree *tree = lines->tree;
    const uint32_t *vertices = tree->leaf_vertices + leaf->first_vertex;
    extent e = nothing;
    for (uint32_t i = 0; i < leaf->vertex_count; ++i)
        include(&e, mote_position_at(&frame->positions, vertices[i]));
    const double middle[3] = {frame->middle.x, frame->middle.y, frame->middle.z};
    for (size_t r = 0; r < 3; ++r) {
        block->low[r][lane] = (float)((e.low[r] - middle[r]) * tree->scale);
        block->high[r][lane] = (float)((e.high[r] - middle[r]) * tree->scale);
    }
}

static void box_child(const mote_lines_block *child, uint32_t children, mote_lines_block *block,
                      size_t lane)
{
    for (size_t r = 0; r < 3; ++r) {
        float low = child->low[r][0], high = child->high[r][0];
        for (size_t l = 1; l < children; ++l) {
            low = child->low[r][l] < low ? child->low[r][l] : low;
            high = child->high[r][l] > high ? child->high[r][l] : high;
        }
        block->low[r][lane] = low;
        block->high[r][lane] = high;
    }
}

/* Makes the boxes of a frame. Blocks stand behind those that they are children of. */
static void fill_frame(mote_lines *lines, mote_lines_frame *frame, const mote_positions *from)
{
    const mote_cert_tree *tree = lines->tree;
    const extent all = extent_of(from, tree->body->mesh->vertex_count);
    frame->from = from;
    frame->positions = *from;
    frame->middle = middle_of(&all);
    frame->size = size_of(&all);
    frame->radius = 0;
    for (size_t r = 0; r < 3; ++r)
        frame->radius = fmax(frame->radius, (all.high[r] - all.low[r]) * 0.51 * tree->scale);
    for (uint32_t i = tree->block_count; i-- > 0;) {
        const mote_cert_block *block = &tree->blocks[i];
        mote_lines_block *own = &frame->blocks[i];
        memset(own, 0, sizeof *own);
        for (uint32_t l = 0; l < block->children; ++l) {
            const int32_t child = block->child[l];
            if (child < 0)
                box_leaf(lines, frame, &tree->leaves[~child], own, l);
            else
                box_child(&frame->blocks[child], tree->blocks[child].children, own, l);
        }
    }
}

/* Has the boxes of both ends of a piece; those of a piece beside it share one. */
static void use_piece(mote_lines *lines, const mote_path *path, uint32_t piece)
{
    const mote_positions *start = &path->positions[piece], *end = start + 1;
    if (lines->frame[0].from == start) /* then the other end is there too */
        return;
    if (lines->frame[1].from == start || lines->frame[0].from == end) {
        const mote_lines_frame kept = lines->frame[0];
        lines->frame[0] = lines->frame[1];
        lines->frame[1] = kept;
    }
    if (lines->frame[0].from != start)
        fill_frame(lines, &lines->frame[0], start);
    if (lines->frame[1].from != end)
        fill_frame(lines, &lines->frame[1], end);
}

void mote_lines_begin(mote_lines *lines)
{
    lines->frame[0].from = lines->frame[1].from = NULL;
}

mote_status mote_lines_check(const mote_lines *lines, const mote_positions *positions,
                             int number, uint32_t frame)
{
    const mote_status status = mote_stream_check(positions, number);
    if (status != MOTE_OK)
        return status;
    const uint32_t count = lines->tree->body->mesh->vertex_count;
    const double most = FAR / lines->tree->scale;
    for (uint32_t v = 0; v < count; ++v) {
        const mote_vec3 p = mote_position_at(positions, v);
        if (!(fabs(p.x) < most && fabs(p.y) < most && fabs(p.z) < most))
            return mote_fail(MOTE_EINVAL,
                             "body %d: in frame %u of its path vertex %u is at %g, %g, %g; "
                             "positions must be finite and at most %g",
                             number, frame, v, p.x, p.y, p.z, most);
    }
    return MOTE_OK;
}

/* A state with amounts of both frames. Its pose is 0: nothing of the rest mesh is left. */
static void set_state(double first, double second, double *weights, mote_body_state *state)
{
    const size_t padded = MOTE_LANES;
    memset(weights, 0, 3 * padded * sizeof *weights);
    weights[0] = first;
    weights[padded] = second;
    *state = (mote_body_state){.shape_changed = true, .pose_changed = true};
    state->weights = (mote_weights){.x = weights,
                                    .y = weights + padded,
                                    .z = weights + 2 * padded,
                                    .count = 1,
                                    .padded = MOTE_LANES};
}

void mote_lines_state(mote_lines *lines, const mote_path *path, double time, double *weights,
                      mote_body_state *state)
{
    const mote_place at = mote_path_place(path, time);
    use_piece(lines, path, at.piece);
    set_state(1 - at.u, at.u, weights, state);
}

void mote_lines_velocity(mote_lines *lines, const mote_path *path, uint32_t piece,
                         double factor, double *weights, mote_body_state *state)
{
    use_piece(lines, path, piece);
    set_state(-factor, factor, weights, state);
}

MOTE_CLONES
mote_lines_motion mote_lines_motion_of(const mote_lines *lines, const mote_path *path,
                                       uint32_t piece)
{
    const mote_positions *start = &path->positions[piece], *end = start + 1;
    extent moved = nothing, all = nothing;
    const uint32_t count = lines->tree->body->mesh->vertex_count;
    for (uint32_t v = 0; v < count; ++v) {
        const mote_vec3 p = mote_position_at(start, v), q = mote_position_at(end, v);
        include(&all, p);
        include(&all, q);
        include(&moved, mote_sub(q, p));
    }
    mote_lines_motion m = {.mean = middle_of(&moved), .size = size_of(&all)};
    double squared = 0;
    for (size_t r = 0; r < 3; ++r)
        squared += (moved.high[r] - moved.low[r]) * (moved.high[r] - moved.low[r]);
    m.stray = 0.5 * sqrt(squared) * (1 + 0x1p-40) + 0x1p-50 * m.size;
    return m;
}
