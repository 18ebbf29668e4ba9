/* Bounds of a skin, while a tree is built. */
#include "core/skin/range.h"
#include "core/skin/morph_fit.h"
#include "core/skin/skin_bounds.h"
#include "core/skin/skin_data.h"

#include <assert.h>
#include <float.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH MOTE_CERT_WIDTH

#define UNIT MOTE_SKIN_UNIT

/* The numbers of a mote_skin_leaf_row, in units, in its order. */
typedef int16_t number[WIDTH];
enum { OFFSET, RESIDUAL, SLOPE, SHIFT, SPREAD = SLOPE + 6, NUMBERS = SPREAD + 4 };

/* One bone over the children of the block at hand. */
typedef struct bone_rows {
    union {
        number leaf[NUMBERS]; /* slope and shift of an axis are followed by those of the next */
        mote_skin_convex_row convex;
    } row;
    /* over the child at hand: */
    double total;    /* of its weights */
    double right[4]; /* of the normal equations; then the solution */
    float least[3], most[3];
} bone_rows;

typedef struct fitter {
    const mote_skin *skin;
    bool linear;
    bone_rows *rows; /* [bones] */
    uint32_t *block_stamp,
        *child_stamp; /* [bones] the last block and child that had the bone */
    uint32_t block, child;
    uint16_t *of_block, *of_child; /* [bones] */
    uint32_t block_count, child_count;
    uint16_t reference[WIDTH];
    bool convex;
    float row_sum;
    mote_morph_fitter *morphs; /* NULL without targets */
} fitter;

void mote_skin_fit_stop(void *state)
{
    fitter *f = state;
    free(f->rows);
    free(f->block_stamp);
    free(f->child_stamp);
    free(f->of_block);
    free(f->of_child);
    mote_morph_fit_stop(f->morphs);
    free(f);
}

/* The weight vectors are relative to the middle of the mesh, as the tree is. */
static mote_status check_mesh(const mote_skin *skin, const mote_cert_tree *tree)
{
    const uint32_t n = tree->body->mesh->vertex_count;
    if (skin->vertex_count != n)
        return mote_fail(MOTE_EINVAL,
                         "the skin was made for a mesh of %u vertices, the body's has %u",
                         skin->vertex_count, n);
    if (mote_distance_squared(skin->origin, tree->origin) > 0)
        return mote_fail(MOTE_EINVAL, "the skin was made for another mesh than the body's");
    return MOTE_OK;
}

mote_status mote_skin_fit_start(mote_cert_tree *tree, bool linear_fits, void **made)
{
    const mote_skin *skin = mote_skin_of(tree->body->field);
    const size_t bones = skin->bones;
    mote_status status = check_mesh(skin, tree);
    if (status != MOTE_OK)
        return status;
    fitter *f = calloc(1, sizeof *f);
    if (f) {
        f->skin = skin;
        f->linear = linear_fits;
        f->block = 1;
        f->rows = malloc(bones * sizeof *f->rows);
        f->block_stamp = calloc(bones, sizeof *f->block_stamp);
        f->child_stamp = calloc(bones, sizeof *f->child_stamp);
        f->of_block = malloc(bones * sizeof *f->of_block);
        f->of_child = malloc(bones * sizeof *f->of_child);
        if (f->rows && f->block_stamp && f->child_stamp && f->of_block && f->of_child &&
            mote_morph_fit_start(tree, &f->morphs) == MOTE_OK) {
            *made = f;
            return MOTE_OK;
        }
        mote_skin_fit_stop(f);
    }
    return mote_fail(MOTE_ENOMEM, "no memory to bound a skin of %u bones", skin->bones);
}

static int ascending(const void *a, const void *b)
{
    return (int)*(const uint16_t *)a - (int)*(const uint16_t *)b;
}

/* Lists the bones of the child's vertices, in ascending order, and zeroes the rows of those
   that are new to the block. */
static void list_bones(fitter *f, const mote_cert_part *part)
{
    const mote_skin *skin = f->skin;
    ++f->child;
    f->child_count = 0;
    for (size_t v = 0; v < part->count; ++v) {
        const uint32_t vertex = part->vertices[v];
        for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
            const uint16_t b = skin->bone[i];
            if (f->child_stamp[b] == f->child)
                continue;
            f->child_stamp[b] = f->child;
            f->of_child[f->child_count++] = b;
            if (f->block_stamp[b] == f->block)
                continue;
            f->block_stamp[b] = f->block;
            f->of_block[f->block_count++] = b;
            memset(&f->rows[b], 0, sizeof f->rows[b]);
        }
    }
    qsort(f->of_child, f->child_count, sizeof *f->of_child, ascending);
}

/* --- above the leaves -----------------------------------------------------------------------
 */

/* The largest distance of a bone's vertices from the middle of their box, whose half sizes
   count as 1. */
static void fit_radii(fitter *f, const mote_cert_tree *tree, const mote_cert_part *part)
{
    const mote_skin *skin = f->skin;
    for (size_t v = 0; v < part->count; ++v) {
        const uint32_t vertex = part->vertices[v];
        double z[3];
        mote_cert_box_coordinates(part->box, mote_cert_tree_position(tree, vertex), z);
        for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
            mote_skin_convex_row *row = &f->rows[skin->bone[i]].row.convex;
            double squared = 0;
            for (int k = 0; k < 3; ++k) {
                const double y = (z[k] - (double)row->middle[k][part->lane]) /
                                 (double)row->half[k][part->lane];
                squared += y * y;
            }
            const float radius = mote_rounded_up(sqrt(squared));
            float *most = &row->radius[part->lane];
            *most = radius > *most ? radius : *most;
        }
    }
}

static void fit_convex(fitter *f, const mote_cert_tree *tree, const mote_cert_part *part)
{
    const mote_skin *skin = f->skin;
    for (uint32_t i = 0; i < f->child_count; ++i) {
        bone_rows *own = &f->rows[f->of_child[i]];
        for (int k = 0; k < 3; ++k) {
            own->least[k] = FLT_MAX;
            own->most[k] = -FLT_MAX;
        }
    }
    for (size_t v = 0; v < part->count; ++v) {
        const uint32_t vertex = part->vertices[v];
        double z[3];
        mote_cert_box_coordinates(part->box, mote_cert_tree_position(tree, vertex), z);
        for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
            bone_rows *own = &f->rows[skin->bone[i]];
            for (int k = 0; k < 3; ++k) {
                const float at = (float)z[k];
                own->least[k] = at < own->least[k] ? at : own->least[k];
                own->most[k] = at > own->most[k] ? at : own->most[k];
            }
        }
    }
    /* z is at most 1: rounded by 2^-25, and so are the sum and the difference, twice that. */
    for (uint32_t i = 0; i < f->child_count; ++i) {
        bone_rows *own = &f->rows[f->of_child[i]];
        mote_skin_convex_row *row = &own->row.convex;
        row->radius[part->lane] = 0x1p-20F; /* a bone that moves one point has one too */
        for (int k = 0; k < 3; ++k) {
            row->middle[k][part->lane] = 0.5F * (own->least[k] + own->most[k]);
            row->half[k][part->lane] = 0.5F * (own->most[k] - own->least[k]) + 0x1p-22F;
        }
    }
    fit_radii(f, tree, part);
}

/* --- leaves ---------------------------------------------------------------------------------
 */

static double weight_of(const mote_skin *skin, uint32_t vertex, uint32_t bone)
{
    for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
        if (skin->bone[i] == bone)
            return (double)skin->weight[i];
    }
    return 0;
}

/* Sums of the normal equations over the child's vertices, and the total weight of each bone. */
static void add_up(fitter *f, const mote_cert_tree *tree, const mote_cert_part *part,
                   double a[4][4])
{
    const mote_skin *skin = f->skin;
    for (size_t v = 0; v < part->count; ++v) {
        const uint32_t vertex = part->vertices[v];
        double z[4] = {1};
        mote_cert_box_coordinates(part->box, mote_cert_tree_position(tree, vertex), z + 1);
        for (int r = 0; r < 4; ++r) {
            for (int c = 0; c <= r; ++c)
                a[r][c] += z[r] * z[c];
        }
        for (uint32_t i = skin->start[vertex]; i < skin->start[vertex + 1]; ++i) {
            bone_rows *own = &f->rows[skin->bone[i]];
            const double w = (double)skin->weight[i];
            own->total += w;
            for (int r = 0; r < 4; ++r)
                own->right[r] += w * z[r];
        }
    }
    for (int r = 0; r < 4; ++r)
        a[r][r] += 1e-6 * (double)part->count; /* where the vertices do not spread */
}

/* A middle and a half size in units that hold a range of numbers, of which the rounding of the
   sums that they are is less than 2^-26 units. */
static void settle(const mote_range *range, int16_t *middle, int16_t *half)
{
    *middle = (int16_t)lround(0.5 * (range->low + range->high) / UNIT);
    const double m = UNIT * *middle;
    const double most = range->high - m > m - range->low ? range->high - m : m - range->low;
    *half = (int16_t)ceil(most / UNIT + 0x1p-26);
}

/* The slopes of a bone's weight over a child, as they are stored. They only decide how wide the
   residuals are. */
static void choose_slopes(const fitter *f, uint32_t bone, int16_t slope[3])
{
    const double *wanted = f->rows[bone].right + 1;
    const double sum = fabs(wanted[0]) + fabs(wanted[1]) + fabs(wanted[2]);
    const double part = sum > MOTE_SKIN_SLOPES ? MOTE_SKIN_SLOPES / sum : 1;
    assert(sum < DBL_MAX); /* weights are at most 1, and the equations are never singular */
    for (int k = 0; k < 3; ++k)
        slope[k] = f->linear ? (int16_t)(wanted[k] * part / UNIT) : 0;
}

/* Writes one lane of a bone's row, and returns the sum of the sizes of its entries. */
static double write_lane(const fitter *f, const mote_cert_tree *tree,
                         const mote_cert_part *part, uint32_t bone)
{
    number *row = f->rows[bone].row.leaf;
    const size_t lane = part->lane;
    int16_t slope[3];
    choose_slopes(f, bone, slope);
    double g[3];
    for (int k = 0; k < 3; ++k) {
        row[SLOPE + 2 * k][lane] = slope[k];
        g[k] = UNIT * slope[k];
    }
    mote_range residual = MOTE_RANGE_EMPTY;
    for (size_t v = 0; v < part->count; ++v) {
        const uint32_t vertex = part->vertices[v];
        double z[3];
        mote_cert_box_coordinates(part->box, mote_cert_tree_position(tree, vertex), z);
        mote_range_widen(&residual, weight_of(f->skin, vertex, bone) - g[0] * z[0] -
                                        g[1] * z[1] - g[2] * z[2]);
    }
    settle(&residual, &row[OFFSET][lane], &row[RESIDUAL][lane]);
    const double offset = UNIT * row[OFFSET][lane];
    mote_range product[3] = {MOTE_RANGE_EMPTY, MOTE_RANGE_EMPTY, MOTE_RANGE_EMPTY};
    for (size_t v = 0; v < part->count; ++v) {
        const uint32_t vertex = part->vertices[v];
        double z[3];
        mote_cert_box_coordinates(part->box, mote_cert_tree_position(tree, vertex), z);
        for (int k = 0; k < 3; ++k)
            mote_range_widen(&product[k], (weight_of(f->skin, vertex, bone) - offset) * z[k]);
    }
    for (int k = 0; k < 3; ++k)
        settle(&product[k], &row[SHIFT + 2 * k][lane], &row[SPREAD + k][lane]);
    int32_t sum = 0;
    for (size_t i = 0; i < NUMBERS; ++i)
        sum += abs(row[i][lane]);
    return UNIT * sum;
}

static void fit_leaf(fitter *f, const mote_cert_tree *tree, const mote_cert_part *part)
{
    double a[4][4] = {{0}};
    for (uint32_t i = 0; i < f->child_count; ++i) {
        bone_rows *own = &f->rows[f->of_child[i]];
        own->total = 0;
        memset(own->right, 0, sizeof own->right);
    }
    add_up(f, tree, part, a);
    mote_cert_factor(a);
    uint16_t reference = f->of_child[0];
    for (uint32_t i = 0; i < f->child_count; ++i) {
        const uint16_t b = f->of_child[i];
        mote_cert_solve((const double(*)[4])a, f->rows[b].right);
        reference = f->rows[b].total > f->rows[reference].total ? b : reference;
    }
    f->reference[part->lane] = reference;
    double sum = 0;
    for (uint32_t i = 0; i < f->child_count; ++i) {
        if (f->of_child[i] != reference)
            sum += write_lane(f, tree, part, f->of_child[i]);
    }
    f->row_sum = mote_rounded_up(sum) > f->row_sum ? mote_rounded_up(sum) : f->row_sum;
}

/* --- blocks ---------------------------------------------------------------------------------
 */

void mote_skin_fit(void *state, mote_cert_tree *tree, const mote_cert_part *part)
{
    fitter *f = state;
    f->convex = part->leaves == 0;
    list_bones(f, part);
    if (f->convex)
        fit_convex(f, tree, part);
    else
        fit_leaf(f, tree, part);
    if (f->morphs)
        mote_morph_fit(f->morphs, tree, part, f->linear);
}

/* A bone that is the reference of all of its children needs no row. */
static bool has_row(const fitter *f, uint16_t bone)
{
    if (f->convex)
        return true;
    const int16_t *residual = f->rows[bone].row.leaf[RESIDUAL];
    int16_t most = 0; /* a residual is more than 0 wherever it is written */
    for (size_t l = 0; l < WIDTH; ++l)
        most = residual[l] > most ? residual[l] : most;
    return most > 0;
}

/* The bones with rows, in ascending order; returns how many there are. */
static uint32_t list_rows(fitter *f)
{
    uint32_t count = 0;
    qsort(f->of_block, f->block_count, sizeof *f->of_block, ascending);
    for (uint32_t i = 0; i < f->block_count; ++i) {
        if (has_row(f, f->of_block[i]))
            f->of_block[count++] = f->of_block[i];
    }
    return count;
}

static void pack(const number numbers[NUMBERS], mote_cert_strip *to)
{
    for (size_t i = 0; i < NUMBERS / 2; ++i) {
        mote_skin_pairs pairs;
        for (size_t l = 0; l < WIDTH; ++l)
            pairs[l] =
                (uint32_t)(uint16_t)numbers[2 * i][l] << 16 | (uint16_t)numbers[2 * i + 1][l];
        memcpy(to[i], pairs, sizeof pairs);
    }
}

mote_status mote_skin_fit_store(void *state, mote_cert_tree *tree, mote_cert_block *block)
{
    fitter *f = state;
    const size_t bytes = f->convex ? sizeof(mote_skin_convex_row) : sizeof(mote_skin_leaf_row);
    const size_t strips = bytes / sizeof(mote_cert_strip);
    const size_t first = f->convex ? 0 : WIDTH;
    const uint32_t count = list_rows(f);
    const uint32_t morphs = f->morphs ? mote_morph_fit_count(f->morphs) : 0;
    mote_status status = mote_cert_tree_keep(
        tree, block, 1 + strips * count + MOTE_MORPH_STRIPS * morphs, first + count + morphs);
    if (status != MOTE_OK)
        return status;
    mote_cert_strip *strip = tree->strips + block->first_strip;
    uint16_t *active = tree->active + block->first_active;
    const mote_skin_head head = {
        .convex = f->convex ? 1 : 0, .row_sum = f->row_sum, .morphs = (float)morphs};
    memcpy(strip, &head, sizeof head);
    for (size_t l = 0; l < first; ++l)
        active[l] = l < block->children ? f->reference[l] : f->reference[0];
    for (uint32_t i = 0; i < count; ++i) {
        active[first + i] = f->of_block[i];
        const bone_rows *own = &f->rows[f->of_block[i]];
        if (f->convex)
            memcpy(strip + 1 + strips * i, &own->row.convex, bytes);
        else
            pack(own->row.leaf, strip + 1 + strips * i);
    }
    if (f->morphs)
        mote_morph_fit_store(f->morphs, strip + 1 + strips * count, active + first + count);
    f->block_count = 0;
    f->row_sum = 0;
    ++f->block;
    return MOTE_OK;
}
