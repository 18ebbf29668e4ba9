#include "core/certificate/certificate_outline.h"

#include "core/base/clones.h"
#include "core/certificate/certificate_bounds.h"
#include "core/certificate/certificate_state.h"

#include <float.h>
#include <math.h>

#define WIDTH MOTE_CERT_WIDTH

/* Where the ends of a box that is not there lie: squares of this are finite. */
#define NOWHERE 0x1p60F

/* The ends of a node's boxes along the coordinates' axes. These are projections on directions
   of length 1, whose rounding and that of a difference of two of them the width covers
   (certificate_fitted.c). */
static void write_ends(const mote_cert_node *node, mote_cert_outline_row *row)
{
    for (size_t l = 0; l < WIDTH; ++l) {
        for (size_t r = 0; r < 3; ++r) {
            const float half = (fabsf(node->axis[0][r][l]) + fabsf(node->axis[1][r][l]) +
                                fabsf(node->axis[2][r][l])) +
                               node->width[r][l];
            const bool there = l < row->children;
            row->low[r][l] = there ? node->centre[r][l] - half : NOWHERE;
            row->high[r][l] = there ? node->centre[r][l] + half : -NOWHERE;
        }
    }
}

static float least_of(const float x[WIDTH])
{
    float least = x[0];
    for (size_t l = 1; l < WIDTH; ++l)
        least = x[l] < least ? x[l] : least;
    return least;
}

/* Gives the children of block i rows of their own, as far as there is room. Returns whether all
   have one. */
static bool open_children(const mote_cert_tree *tree, const mote_cert_block **blocks,
                          uint32_t *count, uint32_t i, mote_cert_outline_row *row)
{
    const mote_cert_block *block = blocks[i];
    bool all = true;
    row->children = block->children;
    for (size_t l = 0; l < WIDTH; ++l) {
        const bool opens =
            l < block->children && block->child[l] >= 0 && *count < MOTE_CERT_OUTLINE_BLOCKS;
        row->below[l] = opens ? (uint8_t)*count : 0;
        if (opens)
            blocks[(*count)++] = &tree->blocks[block->child[l]];
        else
            all = all && l >= block->children;
    }
    return all;
}

/* The boxes of a row whose children all have rows: around the boxes in these. */
static void surround(mote_cert_outline *outline, mote_cert_outline_row *row)
{
    for (size_t l = 0; l < WIDTH; ++l) {
        const bool there = l < row->children;
        const mote_cert_outline_row *below = &outline->rows[row->below[l]];
        for (size_t r = 0; r < 3; ++r) {
            row->low[r][l] = there ? least_of(below->low[r]) : NOWHERE;
            row->high[r][l] = there ? mote_cert_largest(below->high[r]) : -NOWHERE;
        }
    }
}

void mote_cert_workspace_outline(mote_certificate *workspace, mote_cert_tree *tree,
                                 const mote_body_state *state, mote_cert_outline *outline)
{
    mote_cert_side *side = &workspace->side[0];
    const mote_cert_block *blocks[MOTE_CERT_OUTLINE_BLOCKS] = {tree->blocks};
    bool surrounds[MOTE_CERT_OUTLINE_BLOCKS];
    mote_cert_node node = {.boxes = true};
    uint32_t count = 1;
    /* Relative to the middle of the body, where single precision loses least. */
    outline->origin = mote_pose_apply(&state->pose, tree->origin);
    side->tree = tree;
    mote_cert_side_begin(side, state, outline->origin);
    outline->bound = side->bound;
    for (uint32_t i = 0; i < count; ++i)
        surrounds[i] = open_children(tree, blocks, &count, i, &outline->rows[i]);
    while (count-- > 0) { /* children are behind their parents */
        mote_cert_outline_row *row = &outline->rows[count];
        if (surrounds[count]) {
            surround(outline, row);
            continue;
        }
        node.block = blocks[count];
        tree->bounds->boxes(side, node.block, &node);
        write_ends(&node, row);
    }
}

/* Two outlines: what is added to coordinates of each to make them coordinates of the other, and
   the square of how far apart two boxes have to be. */
typedef struct facing {
    const mote_cert_outline *outline[2];
    float shift[2][3];
    float enough;
} facing;

/* Bit l: box `lane` of a row, shifted, may be less than the distance from box l of another. */
MOTE_CLONES
static uint32_t undecided_boxes(const mote_cert_outline_row *restrict one, size_t lane,
                                const float shift[3],
                                const mote_cert_outline_row *restrict other, float enough)
{
    float squared[WIDTH] = {0};
    for (size_t r = 0; r < 3; ++r) {
        const float low = one->low[r][lane] + shift[r];
        const float high = one->high[r][lane] + shift[r];
        MOTE_LANE_LOOP
        for (size_t l = 0; l < WIDTH; ++l) {
            const float above = other->low[r][l] - high;
            const float below = low - other->high[r][l];
            const float gap = above > below ? above : below;
            squared[l] += gap > 0 ? gap * gap : 0;
        }
    }
    uint32_t bits = 0;
    MOTE_LANE_LOOP
    for (size_t l = 0; l < WIDTH; ++l)
        bits |= squared[l] < enough ? 1u << l : 0;
    return bits;
}

/* Whether box `lane` of a row of outline s may be near any box of a row of the other. The box
   that is higher up in its outline is opened first. */
static bool visit(const facing *f, int s, uint32_t row, size_t lane, uint32_t other)
{
    const mote_cert_outline_row *own = &f->outline[s]->rows[row];
    const mote_cert_outline_row *opposite = &f->outline[1 - s]->rows[other];
    uint32_t left = undecided_boxes(own, lane, f->shift[s], opposite, f->enough);
    for (; left; left &= left - 1) {
        const size_t k = mote_lowest_bit(left);
        const uint32_t below = own->below[lane], opposite_below = opposite->below[k];
        if (!below && !opposite_below)
            return true;
        const bool open_own = below && (!opposite_below || row < other);
        if (open_own ? visit(f, 1 - s, other, k, below)
                     : visit(f, s, row, lane, opposite_below))
            return true;
    }
    return false;
}

/* Let u = 2^-24, D the distance of the origins along an axis and B both bounds. A shift is
   rounded twice, by 2 u D at most, what it is added to once more, by u (D + B), and a gap and
   its square are rounded by 1 part in 2^22: together less than 2^-21 (D + B) along each axis,
   and less than 2^-20 times their sum along all of them. */
bool mote_cert_outlines_near(const mote_cert_outline *a, const mote_cert_outline *b,
                             double scale, double near)
{
    const mote_vec3 apart = mote_scale(mote_sub(a->origin, b->origin), scale);
    const double size =
        fabs(apart.x) + fabs(apart.y) + fabs(apart.z) + 3 * (a->bound + b->bound);
    const double need = (near * scale + 0x1p-20 * size) * (1 + 0x1p-20);
    if (!(need * need <= (double)FLT_MAX))
        return true;
    const float shift[3] = {(float)apart.x, (float)apart.y, (float)apart.z};
    const facing f = {
        .outline = {a, b},
        .shift = {{shift[0], shift[1], shift[2]}, {-shift[0], -shift[1], -shift[2]}},
        .enough = (float)(need * need)};
    for (size_t l = 0; l < a->rows[0].children; ++l) {
        if (visit(&f, 0, 0, l, 0))
            return true;
    }
    return false;
}
