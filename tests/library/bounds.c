/* A user's kind of field with bounds of its own: the whole body slides by one weight vector. A
   box slides with it, so the bounds are the boxes of the rest tree, rotated and moved. */
#include <mote/certificate_bounds.h>
#include <mote/certificate_project.h>
#include <mote/mote.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void basis(const mote_field *field, const mote_mesh *mesh, uint32_t vertex, double *phi)
{
    (void)mesh, (void)vertex;
    for (uint32_t j = 0; j < field->padded; ++j)
        phi[j] = j == 0 ? 1 : 0;
}

static void destroy(mote_field *field)
{
    free(field);
}

static mote_status start(mote_cert_tree *tree, bool linear_fits, void **fitter)
{
    (void)tree, (void)linear_fits;
    *fitter = NULL; /* nothing is fitted */
    return MOTE_OK;
}

static void fit(void *fitter, mote_cert_tree *tree, const mote_cert_part *part)
{
    (void)fitter, (void)tree, (void)part;
}

static mote_status store(void *fitter, mote_cert_tree *tree, mote_cert_block *block)
{
    (void)fitter;
    return mote_cert_tree_keep(tree, block, 0, 0);
}

static void stop(void *fitter)
{
    (void)fitter;
}

/* How far the body slides, in the tree's units. */
typedef struct moved {
    float by[3];
    float along;
} moved;

static size_t frame_bytes(const mote_cert_tree *tree)
{
    (void)tree;
    return sizeof(moved);
}

static mote_vec3 weight_of(const mote_cert_side *side)
{
    const mote_weights *w = &side->state->weights;
    return mote_scale(mote_vec3_make(w->x[0], w->y[0], w->z[0]), side->tree->scale);
}

/* Let B be the size of all coordinates. Each term is rounded three times, and a sum has five
   terms: 64 u B, u = 2^-24, exceeds that and the rounding in box tests. */
static void begin(mote_cert_side *side)
{
    const mote_vec3 w = weight_of(side), t = side->exact_translation;
    moved *m = (moved *)side->frame;
    m->by[0] = (float)w.x;
    m->by[1] = (float)w.y;
    m->by[2] = (float)w.z;
    side->bound = mote_length(w) + mote_length(t) + side->tree->radius;
    side->noise = 0x1p-48 * side->bound;
    side->exact = 0x1p-48 * (side->world + side->bound);
    side->margin_base =
        (float)((64 * 0x1p-24 * side->bound + side->tree->leak + side->exact) * 1.0001);
    side->margin_unit = 0;
    side->leaf_margin = side->margin_base;
    side->reach_margin = side->margin_base;
}

static void face(mote_cert_side *side)
{
    ((moved *)side->frame)->along = (float)mote_dot(weight_of(side), side->facing);
}

static void project(const mote_cert_side *side, const mote_cert_block *block,
                    mote_cert_node *node)
{
    const float *n = side->facing_f;
    for (size_t l = 0; l < MOTE_CERT_WIDTH; ++l) {
        float middle = side->shift + ((const moved *)side->frame)->along, axis[3] = {0, 0, 0};
        for (size_t c = 0; c < 3; ++c) {
            middle += n[c] * block->centre[c][l];
            for (size_t k = 0; k < 3; ++k)
                axis[k] += n[c] * block->half[k][c][l];
        }
        mote_cert_project_lane(block, node, l, middle, axis, side->margin_base);
    }
    node->leaf_margin = side->leaf_margin;
    mote_cert_finish_projection(side, block, node, true);
}

static void boxes(const mote_cert_side *side, const mote_cert_block *block,
                  mote_cert_node *node)
{
    for (size_t r = 0; r < 3; ++r) {
        const float *row = side->rotation[r];
        for (size_t l = 0; l < MOTE_CERT_WIDTH; ++l) {
            node->centre[r][l] = side->translation[r] + ((const moved *)side->frame)->by[r];
            node->width[r][l] = side->margin_base;
            for (size_t k = 0; k < 3; ++k)
                node->axis[k][r][l] = 0;
            for (size_t c = 0; c < 3; ++c) {
                node->centre[r][l] += row[c] * block->centre[c][l];
                for (size_t k = 0; k < 3; ++k)
                    node->axis[k][r][l] += row[c] * block->half[k][c][l];
            }
        }
    }
    mote_cert_finish_boxes(node);
}

static bool hull(const mote_cert_side *side, const mote_cert_node *node, size_t lane,
                 mote_cert_hull *points)
{
    (void)side, (void)node, (void)lane, (void)points;
    return false; /* the boxes are just as tight */
}

static const mote_cert_bounds bounds = {"slide", start, fit,     store, stop, frame_bytes,
                                        begin,   face,  project, boxes, hull};
static const mote_field_kind kinds[2] = {
    {.name = "slide", .basis = basis, .bounds = &bounds, .destroy = destroy},
    {.name = "slide by fits", .basis = basis, .destroy = destroy}};

/* A bumpy sphere: rings of `around` vertices between two poles. */
static mote_status make_mesh(uint32_t rings, uint32_t around, mote_mesh **mesh)
{
    static double at[3 * 1000];
    static uint32_t corners[3 * 2000];
    const uint32_t south = rings * around, north = south + 1;
    uint32_t count = 0;
    for (uint32_t i = 0; i < south; ++i) {
        const double a = 3.14159265 * (i / around + 1) / (rings + 1);
        const double b = 6.2831853 * (i % around) / around, r = 1 + 0.2 * sin(3 * b + 5 * a);
        at[3 * i] = r * sin(a) * cos(b);
        at[3 * i + 1] = r * sin(a) * sin(b);
        at[3 * i + 2] = -r * cos(a);
    }
    for (int c = 0; c < 3; ++c) {
        at[3 * south + c] = c == 2 ? -1 : 0;
        at[3 * north + c] = c == 2 ? 1 : 0;
    }
    for (uint32_t i = 0; i < south; ++i) {
        const uint32_t next = i % around == around - 1 ? i + 1 - around : i + 1;
        const uint32_t up = i + around, up_next = next + around;
        const bool last = i / around == rings - 1;
        const uint32_t f[3][3] = {
            {i, next, last ? north : up_next}, {i, up_next, up}, {next, i, south}};
        for (int k = 0; k < 3; ++k) {
            if ((k == 1 && last) || (k == 2 && i >= around))
                continue;
            for (int c = 0; c < 3; ++c)
                corners[3 * count + (uint32_t)c] = f[k][c];
            ++count;
        }
    }
    return mote_mesh_create(at, north + 1, corners, count, mesh);
}

/* Both kinds of field must give the same distance in 200 poses. */
int main(void)
{
    mote_mesh *mesh;
    mote_field *field[2];
    mote_certificate *certificate[2];
    double weight[2][3][MOTE_LANES] = {{{0}}};
    if (make_mesh(20, 30, &mesh))
        return puts(mote_error_text()), 1;
    for (int k = 0; k < 2; ++k) {
        if (mote_field_allocate(&kinds[k], 1, &field[k]))
            return puts(mote_error_text()), 1;
        const mote_body body = {.mesh = mesh, .field = field[k]};
        static mote_body kept[2];
        kept[k] = body;
        const mote_body *const pair[] = {&kept[k], &kept[k]};
        const mote_certificate_options options =
            mote_default_certificate_options(mesh->diagonal);
        if (mote_certificate_create(pair, &options, &certificate[k]))
            return puts(mote_error_text()), 1;
    }
    mote_frame frame = {0};
    double least = HUGE_VAL;
    for (frame.number = 1; frame.number <= 200; ++frame.number) {
        const double turn = 0.1 * (double)frame.number;
        for (int b = 0; b < 2; ++b) {
            mote_body_state *state = &frame.body[b];
            state->pose.rotation =
                (mote_mat3){{{cos(turn), -sin(turn), 0}, {sin(turn), cos(turn), 0}, {0, 0, 1}}};
            state->pose.translation.x = 2.7 * b;
            weight[b][0][0] = b * 0.3 * sin(3 * turn);
            weight[b][2][0] = 0.5 * cos(turn + b);
            state->weights =
                (mote_weights){weight[b][0], weight[b][1], weight[b][2], 1, MOTE_LANES};
            state->shape_changed = state->pose_changed = true;
        }
        mote_certificate_answer a, e;
        mote_certificate_query(certificate[0], &frame, NULL, -1, &a);
        mote_certificate_query(certificate[1], &frame, NULL, -1, &e);
        if (!(fabs(a.distance - e.distance) <= 1e-12) ||
            (a.distance > 0 && a.counters.blocks == 0))
            return printf("frame %d: %.17g, by fits %.17g\n", (int)frame.number, a.distance,
                          e.distance),
                   1;
        least = a.distance < least ? a.distance : least;
    }
    for (int k = 0; k < 2; ++k) {
        mote_certificate_destroy(certificate[k]);
        mote_field_destroy(field[k]);
    }
    mote_mesh_destroy(mesh);
    return printf("bounds: 200 distances as by fits, the least %.3f\n", least) < 0;
}
