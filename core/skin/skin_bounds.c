/* Bounds of a skin, in a query.

   Margins, with u and S as in skin_frame.c, and with n the bones of a block at leaves and n_t
   its targets, of which each rounds what it adds to once more, and 4 more in all where there
   are any.
   - Matrices are rounded to floats once, or twice along a direction. Above the leaves each term
   of an end of an interval is rounded at most 9 times. Where the radius, less than 1.74,
   decides its size, the three terms under the root are wrong by 6 u of terms that add up to S,
   which the root makes 1.74 * 6 u S at most, and what follows rounds 5 times: less than 17 u S.
   2^-120 covers squares too small for a float. The end is rounded once more, the middle and
   half size of the union once more each: at most 38 u S. The union of intervals within -S .. S
   is within it, so that all terms of the box are at most 2 S; what tests of boxes round is at
   most 40 u of what these add up to (certificate_fitted.c): 38 sqrt(3) + 80 < 160 u S.
   - Numbers of rows at leaves are converted and scaled without rounding.
   - At leaves, with K (head.row_sum) the sum of the sizes of a child's entries, all terms add
   up to at most B = S (1 + 2 K): e and the d_k together are at most 2 S. Each is rounded at
   most 13 times, and n times more where n bones are added up: sqrt(3) (n + 13) + 40 < 2 n + 64
   u B.
   - Targets add at most sqrt(3) (n_t + 4) < 2 (n_t + 4) u of the same terms to either. */
#include "core/skin/skin_bounds.h"
#include "core/certificate/certificate_project.h"
#include "core/skin/skin_data.h"
#include "core/skin/skin_frame.h"

#include <float.h>
#include <string.h>

#define WIDTH MOTE_CERT_WIDTH

/* A leaf whose width is more than this part of its axes is worth measuring. */
#define WIDE 0.3F

static const mote_skin_head *head_of(const mote_cert_side *side, const mote_cert_block *block)
{
    return (const mote_skin_head *)(const void *)(side->tree->strips + block->first_strip);
}

/* The boxes of a block before the bones move them: as at rest, or moved by morph targets. */
typedef struct shape {
    const float (*centre)[WIDTH];
    const float (*half)[3][WIDTH];
    const float (*loose)[WIDTH]; /* half width to be added, or NULL */
} shape;

static inline shape rest_shape(const mote_cert_block *block)
{
    return (shape){block->centre, block->half, NULL};
}

typedef struct morphed {
    float centre[3][WIDTH], half[3][3][WIDTH], loose[3][WIDTH];
} morphed;

MOTE_INLINE void add_target(const mote_skin_morph_row *restrict row, float m,
                            morphed *restrict to)
{
    const float size = fabsf(m);
    for (size_t r = 0; r < 3; ++r) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            to->centre[r][l] += m * row->offset[r][l];
            to->half[0][r][l] += m * row->slope[0][r][l];
            to->half[1][r][l] += m * row->slope[1][r][l];
            to->half[2][r][l] += m * row->slope[2][r][l];
            to->loose[r][l] += size * row->residual[r][l];
        }
    }
}

/* Rows of the block's targets begin `first` strips after its head. Targets with the amount 0
   cost nothing. */
MOTE_INLINE shape morph_shape(const mote_cert_side *restrict side,
                              const mote_cert_block *restrict block, size_t first,
                              morphed *restrict to)
{
    const size_t count = (size_t)head_of(side, block)->morphs;
    const void *strips = side->tree->strips + block->first_strip + 1 + first;
    const mote_skin_morph_row *rows = strips;
    const uint16_t *target =
        side->tree->active + block->first_active + (block->active_count - count);
    const float *amount = mote_skin_frame_of(side)->amount;
    memcpy(to->centre, block->centre, sizeof to->centre);
    memcpy(to->half, block->half, sizeof to->half);
    memset(to->loose, 0, sizeof to->loose);
    for (size_t i = 0; i < count; ++i) {
        const float m = amount[target[i]];
        if (fabsf(m) > 0)
            add_target(&rows[i], m, to);
    }
    return (shape){(const float(*)[WIDTH])to->centre, (const float(*)[3][WIDTH])to->half,
                   (const float(*)[WIDTH])to->loose};
}

static float morph_roundings(float morphs)
{
    return morphs > 0 ? 2 * (morphs + 4) : 0;
}

/* The image of a block's boxes along a line, without translation, by one bone: of centre and
   axes. */
MOTE_INLINE void image(const shape *restrict box, const float x, const float y, const float z,
                       size_t l, float at[4])
{
    at[0] = x * box->centre[0][l] + y * box->centre[1][l] + z * box->centre[2][l];
    for (size_t k = 0; k < 3; ++k)
        at[1 + k] = x * box->half[k][0][l] + y * box->half[k][1][l] + z * box->half[k][2][l];
}

/* That of what is loose; box->loose is not NULL. */
MOTE_INLINE float loose_image(const shape *restrict box, const float x, const float y,
                              const float z, size_t l)
{
    return fabsf(x) * box->loose[0][l] + fabsf(y) * box->loose[1][l] +
           fabsf(z) * box->loose[2][l];
}

/* --- above the leaves -----------------------------------------------------------------------
 */

/* The intervals along a line that hold the children: a middle and a half size. line: rows of
   the bones. */
MOTE_INLINE void convex_along(const mote_cert_side *restrict side,
                              const mote_cert_block *restrict block, const shape *restrict box,
                              const float *restrict line, float middle[WIDTH],
                              float half[WIDTH])
{
    const void *strips = side->tree->strips + block->first_strip + 1;
    const mote_skin_convex_row *rows = strips;
    const uint16_t *active = side->tree->active + block->first_active;
    const size_t count = block->active_count - (size_t)head_of(side, block)->morphs;
    float low[WIDTH], high[WIDTH];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        low[l] = 0x1p120F;
        high[l] = -0x1p120F;
    }
    for (size_t i = 0; i < count; ++i) {
        const mote_skin_convex_row *row = &rows[i];
        const float *m = line + (size_t)4 * active[i];
        const float x = m[0], y = m[1], z = m[2], t = m[3];
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            float p[4];
            image(box, x, y, z, l, p);
            const float at = (t + p[0]) + (p[1] * row->middle[0][l] + p[2] * row->middle[1][l] +
                                           p[3] * row->middle[2][l]);
            /* of a child that the bone does not move, an interval that no other one ends beyond
             */
            const float a = fabsf(p[1]) * row->half[0][l];
            const float b = fabsf(p[2]) * row->half[1][l];
            const float c = fabsf(p[3]) * row->half[2][l];
            const float round = row->radius[l] * sqrtf((a * a + b * b) + (c * c + 0x1p-120F));
            const float flat = (a + b) + c;
            const float absent = row->radius[l] > 0 ? 0 : -0x1p110F;
            float size = (round < flat ? round : flat) + absent;
            if (box->loose)
                size += loose_image(box, x, y, z, l);
            low[l] = low[l] < at - size ? low[l] : at - size;
            high[l] = high[l] > at + size ? high[l] : at + size;
        }
    }
    for (size_t l = block->children; l < WIDTH; ++l)
        low[l] = high[l] = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        middle[l] = 0.5F * (low[l] + high[l]);
        half[l] = 0.5F * (high[l] - low[l]);
    }
}

static float convex_margin(const mote_cert_side *side, const mote_cert_block *block)
{
    const float more = morph_roundings(head_of(side, block)->morphs);
    return side->margin_base + (160 + more) * side->margin_unit * (1 + 0x1p-20F);
}

/* The ends of a node's boxes along the coordinates' axes. */
MOTE_INLINE void spans_of(mote_cert_node *restrict node)
{
    for (size_t r = 0; r < 3; ++r) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            const float half = (fabsf(node->axis[0][r][l]) + fabsf(node->axis[1][r][l]) +
                                fabsf(node->axis[2][r][l])) +
                               node->width[r][l];
            node->low[r][l] = node->centre[r][l] - half;
            node->high[r][l] = node->centre[r][l] + half;
        }
    }
    node->spans = true;
}

MOTE_INLINE void convex_boxes(const mote_cert_side *restrict side,
                              const mote_cert_block *restrict block, shape box,
                              mote_cert_node *restrict node)
{
    const float margin = convex_margin(side, block);
    memset(node->axis, 0, sizeof node->axis);
    for (size_t r = 0; r < 3; ++r) {
        convex_along(side, block, &box, mote_skin_frame_of(side)->row[r], node->centre[r],
                     node->axis[r][r]);
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l)
            node->width[r][l] = margin;
    }
    mote_cert_finish_boxes(node);
    spans_of(node);
    node->aligned = true;
}

MOTE_INLINE void convex_project(const mote_cert_side *restrict side,
                                const mote_cert_block *restrict block, shape box,
                                mote_cert_node *restrict node)
{
    const float margin = convex_margin(side, block);
    float middle[WIDTH], half[WIDTH];
    convex_along(side, block, &box, mote_skin_frame_of(side)->along, middle, half);
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        mote_cert_project_lane(block, node, l, middle[l], (const float[3]){half[l], 0, 0},
                               margin);
    node->leaf_margin = side->leaf_margin;
    mote_cert_finish_projection(side, block, node, false);
}

/* --- leaves ---------------------------------------------------------------------------------
 */

static float leaf_margin(const mote_cert_side *side, const mote_cert_block *block)
{
    const mote_skin_head *head = head_of(side, block);
    const float more = 1 + 2 * head->row_sum;
    const float bones = (float)(block->active_count - WIDTH) - head->morphs;
    return side->margin_base + side->margin_unit * more *
                                   (64 + 2 * bones + morph_roundings(head->morphs)) *
                                   (1 + 0x1p-20F);
}

/* Middle, three axes and half width along a line. */
typedef struct fitted {
    float middle[WIDTH], axis[3][WIDTH], width[WIDTH];
    float loose[WIDTH];  /* the most that a bone makes of what is loose */
    float own[4][WIDTH]; /* the reference bones' rows, times MOTE_SKIN_PACKED */
} fitted;

/* What the reference bone of each child makes of it. line: rows of the bones. */
MOTE_INLINE void begin_fitted(const uint16_t *restrict reference, const shape *restrict box,
                              const float *restrict line, float margin, fitted *restrict to)
{
    _Alignas(32) float own[4][WIDTH];
    for (size_t l = 0; l < WIDTH; ++l) {
        const float *m = line + (size_t)4 * reference[l];
        for (size_t k = 0; k < 4; ++k)
            own[k][l] = m[k];
    }
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        float p[4];
        image(box, own[0][l], own[1][l], own[2][l], l, p);
        to->middle[l] = own[3][l] + p[0];
        to->axis[0][l] = p[1];
        to->axis[1][l] = p[2];
        to->axis[2][l] = p[3];
        to->width[l] = margin;
        to->loose[l] = !box->loose ? 0 : loose_image(box, own[0][l], own[1][l], own[2][l], l);
    }
    for (size_t k = 0; k < 4; ++k) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l)
            to->own[k][l] = MOTE_SKIN_PACKED * own[k][l];
    }
}

/* A row's numbers, unpacked once for all lines. */
typedef struct leaf_numbers {
    float offset[WIDTH], residual[WIDTH];
    float slope[3][WIDTH], shift[3][WIDTH], spread[3][WIDTH];
} leaf_numbers;

MOTE_INLINE void unpack_leaf(const mote_skin_leaf_row *restrict row, leaf_numbers *restrict to)
{
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        to->offset[l] = mote_skin_first(row->offset[l]);
        to->residual[l] = mote_skin_second(row->offset[l]);
        for (size_t k = 0; k < 3; ++k) {
            to->slope[k][l] = mote_skin_first(row->slope[k][l]);
            to->shift[k][l] = mote_skin_second(row->slope[k][l]);
        }
        to->spread[0][l] = mote_skin_first(row->spread[0][l]);
        to->spread[1][l] = mote_skin_second(row->spread[0][l]);
        to->spread[2][l] = mote_skin_first(row->spread[1][l]);
    }
}

/* Adds what a bone moves otherwise than the reference bones do. m: the bone's row of the line.
 */
MOTE_INLINE void add_fitted(const leaf_numbers *restrict row, const shape *restrict box,
                            const float *restrict m, fitted *restrict to)
{
    const float x = m[0], y = m[1], z = m[2];
    const float ux = MOTE_SKIN_PACKED * x, uy = MOTE_SKIN_PACKED * y;
    const float uz = MOTE_SKIN_PACKED * z, ut = MOTE_SKIN_PACKED * m[3];
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        float d[4];
        image(box, ux - to->own[0][l], uy - to->own[1][l], uz - to->own[2][l], l, d);
        const float e = (ut - to->own[3][l]) + d[0];
        const float f = row->offset[l];
        const float residual = row->residual[l];
        to->middle[l] += f * e + (row->shift[0][l] * d[1] + row->shift[1][l] * d[2] +
                                  row->shift[2][l] * d[3]);
        to->axis[0][l] += row->slope[0][l] * e + f * d[1];
        to->axis[1][l] += row->slope[1][l] * e + f * d[2];
        to->axis[2][l] += row->slope[2][l] * e + f * d[3];
        to->width[l] += residual * fabsf(e) +
                        (row->spread[0][l] * fabsf(d[1]) + row->spread[1][l] * fabsf(d[2]) +
                         row->spread[2][l] * fabsf(d[3]));
        if (box->loose) {
            const float other = residual > 0 ? loose_image(box, x, y, z, l) : 0;
            to->loose[l] = other > to->loose[l] ? other : to->loose[l];
        }
    }
}

/* Along `lines` lines, in one pass over the block's rows. */
MOTE_INLINE void leaf_along(const mote_cert_side *restrict side,
                            const mote_cert_block *restrict block, const shape *restrict box,
                            float *const *restrict line, size_t lines, float margin,
                            fitted *restrict out)
{
    const void *strips = side->tree->strips + block->first_strip + 1;
    const mote_skin_leaf_row *rows = strips;
    const uint16_t *reference = side->tree->active + block->first_active;
    const uint16_t *active = reference + WIDTH;
    const size_t count = block->active_count - WIDTH - (size_t)head_of(side, block)->morphs;
    for (size_t r = 0; r < lines; ++r)
        begin_fitted(reference, box, line[r], margin, &out[r]);
    for (size_t i = 0; i < count; ++i) {
        leaf_numbers row;
        unpack_leaf(&rows[i], &row);
        for (size_t r = 0; r < lines; ++r)
            add_fitted(&row, box, line[r] + (size_t)4 * active[i], &out[r]);
    }
    for (size_t r = 0; r < lines && box->loose; ++r) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l)
            out[r].width[l] += out[r].loose[l];
    }
}

/* Bit l: leaf l is much wider than the margin and than its axes. */
MOTE_INLINE uint32_t wide_leaves(const mote_cert_node *restrict node, float margin)
{
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l) {
        float size = 0, loose = 0;
        for (size_t r = 0; r < 3; ++r) {
            loose += node->width[r][l] - margin;
            size += fabsf(node->axis[0][r][l]) + fabsf(node->axis[1][r][l]) +
                    fabsf(node->axis[2][r][l]);
        }
        bits |= loose > WIDE * size ? 1u << l : 0;
    }
    return bits;
}

MOTE_INLINE void leaf_boxes(const mote_cert_side *restrict side,
                            const mote_cert_block *restrict block, shape box,
                            mote_cert_node *restrict node)
{
    const float margin = leaf_margin(side, block);
    fitted f[3];
    leaf_along(side, block, &box, mote_skin_frame_of(side)->row, 3, margin, f);
    for (size_t r = 0; r < 3; ++r) {
        memcpy(node->centre[r], f[r].middle, sizeof f[r].middle);
        for (size_t k = 0; k < 3; ++k)
            memcpy(node->axis[k][r], f[r].axis[k], sizeof f[r].axis[k]);
        memcpy(node->width[r], f[r].width, sizeof f[r].width);
    }
    uint32_t leaves = 0;
    for (size_t l = 0; l < WIDTH; ++l)
        leaves |= block->child[l] < 0 ? 1u << l : 0;
    node->unmeasured = leaves & block->mask;
    node->wide = wide_leaves(node, margin) & node->unmeasured;
    mote_cert_finish_boxes(node);
    spans_of(node);
}

MOTE_INLINE void leaf_project(const mote_cert_side *restrict side,
                              const mote_cert_block *restrict block, shape box,
                              mote_cert_node *restrict node)
{
    fitted f;
    leaf_along(side, block, &box, &mote_skin_frame_of(side)->along, 1, leaf_margin(side, block),
               &f);
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        mote_cert_project_lane(block, node, l, f.middle[l],
                               (const float[3]){f.axis[0][l], f.axis[1][l], f.axis[2][l]},
                               f.width[l]);
    node->leaf_margin =
        side->leaf_margin * (1 + 2 * head_of(side, block)->row_sum) * (1 + 0x1p-20F);
    mote_cert_finish_projection(side, block, node, false);
}

/* --- both ----------------------------------------------------------------------------------
   Functions with and without targets: what targets add is left out of the latter by the
   compiler. */

#define ROW_STRIPS(row) (sizeof(row) / sizeof(mote_cert_strip))

/* Strips of the bones' rows of a block. */
static size_t bone_strips(const mote_cert_side *side, const mote_cert_block *block)
{
    const mote_skin_head *head = head_of(side, block);
    const size_t bones = block->active_count - (size_t)head->morphs;
    return head->convex > 0 ? bones * ROW_STRIPS(mote_skin_convex_row)
                            : (bones - WIDTH) * ROW_STRIPS(mote_skin_leaf_row);
}

#define BOTH(name)                                                                             \
    MOTE_CLONES                                                                                \
    static void skin_##name(const mote_cert_side *restrict side,                               \
                            const mote_cert_block *restrict block,                             \
                            mote_cert_node *restrict node)                                     \
    {                                                                                          \
        name(side, block, rest_shape(block), node);                                            \
    }                                                                                          \
    MOTE_CLONES                                                                                \
    static void morph_##name(const mote_cert_side *restrict side,                              \
                             const mote_cert_block *restrict block,                            \
                             mote_cert_node *restrict node)                                    \
    {                                                                                          \
        morphed m;                                                                             \
        name(side, block, morph_shape(side, block, bone_strips(side, block), &m), node);       \
    }

BOTH(convex_boxes)
BOTH(convex_project)
BOTH(leaf_boxes)
BOTH(leaf_project)

static void skin_boxes(const mote_cert_side *side, const mote_cert_block *block,
                       mote_cert_node *node)
{
    const mote_skin_head *head = head_of(side, block);
    if (head->morphs > 0)
        (head->convex > 0 ? morph_convex_boxes : morph_leaf_boxes)(side, block, node);
    else
        (head->convex > 0 ? skin_convex_boxes : skin_leaf_boxes)(side, block, node);
}

static void skin_project(const mote_cert_side *side, const mote_cert_block *block,
                         mote_cert_node *node)
{
    const mote_skin_head *head = head_of(side, block);
    if (head->morphs > 0)
        (head->convex > 0 ? morph_convex_project : morph_leaf_project)(side, block, node);
    else
        (head->convex > 0 ? skin_convex_project : skin_leaf_project)(side, block, node);
}

/* A vertex in floats before the bones move it. */
static void place_morphed(const mote_cert_side *side, const mote_skin *skin, uint32_t vertex,
                          float q[3])
{
    const mote_vec3 x = mote_cert_tree_position(side->tree, vertex);
    const mote_morph *morph = &skin->morph;
    const float *amount = mote_skin_frame_of(side)->amount;
    float d[3] = {0, 0, 0};
    for (uint32_t i = morph->start[vertex]; i < morph->start[vertex + 1]; ++i) {
        for (size_t r = 0; r < 3; ++r)
            d[r] += amount[morph->target[i]] * morph->move[i][r];
    }
    q[0] = (float)x.x + d[0];
    q[1] = (float)x.y + d[1];
    q[2] = (float)x.z + d[2];
}

/* A vertex in floats: its bones' matrices are blended, then the vertex is moved. */
MOTE_INLINE void place(const mote_cert_side *restrict side, const mote_skin *restrict skin,
                       const float *restrict columns, uint32_t vertex, float p[4])
{
    const mote_vec3 x = mote_cert_tree_position(side->tree, vertex);
    float q[3] = {(float)x.x, (float)x.y, (float)x.z};
    if (skin->morph.targets > 0)
        place_morphed(side, skin, vertex, q);
    float m[MOTE_SKIN_COLUMNS] = {0};
    for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
        const float *column = columns + (size_t)MOTE_SKIN_COLUMNS * skin->bone[i];
        const float w = skin->weight[i];
        MOTE_LANE_LOOP
        for (size_t k = 0; k < MOTE_SKIN_COLUMNS; ++k)
            m[k] += w * column[k];
    }
    MOTE_LANE_LOOP
    for (size_t r = 0; r < 4; ++r)
        p[r] = (m[r] * q[0] + m[4 + r] * q[1]) + (m[8 + r] * q[2] + m[12 + r]);
}

MOTE_CLONES
static bool skin_hull(const mote_cert_side *side, const mote_cert_node *node, size_t lane,
                      mote_cert_hull *hull)
{
    const mote_skin *skin = mote_skin_of(side->tree->body->field);
    const float *columns = mote_skin_frame_columns(side);
    const uint32_t count = hull->leaf->vertex_count;
    const uint32_t *vertices = side->tree->leaf_vertices + hull->leaf->first_vertex;
    (void)node, (void)lane;
    for (uint32_t i = 0; i < count; ++i) {
        float p[4];
        place(side, skin, columns, vertices[i], p);
        for (size_t r = 0; r < 3; ++r)
            hull->x[r][i] = p[r];
    }
    for (size_t r = 0; r < 3; ++r) {
        for (uint32_t i = count; i < hull->groups * WIDTH; ++i)
            hull->x[r][i] = hull->x[r][count - 1];
        hull->width[r] = mote_skin_frame_of(side)->hull_width;
    }
    return true;
}

const mote_cert_bounds mote_skin_bounds = {.name = "skin",
                                           .start = mote_skin_fit_start,
                                           .fit = mote_skin_fit,
                                           .store = mote_skin_fit_store,
                                           .stop = mote_skin_fit_stop,
                                           .frame_bytes = mote_skin_frame_bytes,
                                           .begin = mote_skin_begin,
                                           .face = mote_skin_face,
                                           .project = skin_project,
                                           .boxes = skin_boxes,
                                           .hull = skin_hull};
