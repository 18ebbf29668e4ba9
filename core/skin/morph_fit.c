#include "core/skin/morph_fit.h"

#include "core/skin/range.h"
#include "core/skin/skin_data.h"
#include "core/skin/skin_frame.h"

#include <stdlib.h>
#include <string.h>

/* One target over the children of the block at hand. */
typedef struct target_fit {
    mote_skin_morph_row row;
    /* over the child at hand: */
    double right[3][4]; /* by coordinate: of the normal equations; then the solution */
    mote_range residual[3];
    uint32_t last; /* vertex of the part, plus 1, whose displacement is in `move` */
    double move[3];
} target_fit;

struct mote_morph_fitter {
    const mote_morph *morph;
    target_fit *fits;                    /* [targets] */
    uint32_t *block_stamp, *child_stamp; /* [targets] the last block and child that had it */
    uint32_t block, child;
    uint16_t *of_block, *of_child; /* [targets] */
    uint32_t block_count, child_count;
};

void mote_morph_fit_stop(mote_morph_fitter *f)
{
    if (!f)
        return;
    free(f->fits);
    free(f->block_stamp);
    free(f->child_stamp);
    free(f->of_block);
    free(f->of_child);
    free(f);
}

static bool allocate(mote_morph_fitter *f, size_t targets)
{
    f->fits = malloc(targets * sizeof *f->fits);
    f->block_stamp = calloc(targets, sizeof *f->block_stamp);
    f->child_stamp = calloc(targets, sizeof *f->child_stamp);
    f->of_block = malloc(targets * sizeof *f->of_block);
    f->of_child = malloc(targets * sizeof *f->of_child);
    return f->fits && f->block_stamp && f->child_stamp && f->of_block && f->of_child;
}

mote_status mote_morph_fit_start(mote_cert_tree *tree, mote_morph_fitter **fitter)
{
    const mote_morph *morph = &mote_skin_of(tree->body->field)->morph;
    if (morph->targets == 0)
        return MOTE_OK;
    mote_morph_fitter *f = calloc(1, sizeof *f);
    tree->fixed_bytes = morph->targets * sizeof(mote_skin_morph_bound);
    tree->fixed = calloc(morph->targets, sizeof(mote_skin_morph_bound));
    if (!f || !tree->fixed || !allocate(f, morph->targets)) {
        mote_morph_fit_stop(f);
        return mote_fail(MOTE_ENOMEM, "no memory to bound %u morph targets", morph->targets);
    }
    f->morph = morph;
    f->block = 1;
    *fitter = f;
    return MOTE_OK;
}

static int ascending(const void *a, const void *b)
{
    return (int)*(const uint16_t *)a - (int)*(const uint16_t *)b;
}

/* Lists the targets of the child's vertices, and zeroes the rows of those that are new to the
   block. */
static void list_targets(mote_morph_fitter *f, const mote_cert_part *part)
{
    const mote_morph *morph = f->morph;
    ++f->child;
    f->child_count = 0;
    for (size_t v = 0; v < part->count; ++v) {
        const uint32_t vertex = part->vertices[v];
        for (uint32_t i = morph->start[vertex]; i < morph->start[vertex + 1]; ++i) {
            const uint16_t k = morph->target[i];
            if (f->child_stamp[k] == f->child)
                continue;
            f->child_stamp[k] = f->child;
            f->of_child[f->child_count++] = k;
            memset(f->fits[k].right, 0, sizeof f->fits[k].right);
            f->fits[k].last = 0;
            for (int c = 0; c < 3; ++c)
                f->fits[k].residual[c] = (mote_range)MOTE_RANGE_EMPTY;
            if (f->block_stamp[k] == f->block)
                continue;
            f->block_stamp[k] = f->block;
            f->of_block[f->block_count++] = k;
            memset(&f->fits[k].row, 0, sizeof f->fits[k].row);
        }
    }
}

static void coordinates(const mote_cert_tree *tree, const mote_cert_part *part, size_t v,
                        double z[3])
{
    mote_cert_box_coordinates(part->box, mote_cert_tree_position(tree, part->vertices[v]), z);
}

/* Least squares over the child's vertices. Slopes only decide how wide the residuals are:
   beyond 4 times a target's size they would cost more in margins than they save. */
static void fit_slopes(mote_morph_fitter *f, const mote_cert_tree *tree,
                       const mote_cert_part *part)
{
    const mote_morph *morph = f->morph;
    double a[4][4] = {{0}};
    for (size_t v = 0; v < part->count; ++v) {
        const uint32_t vertex = part->vertices[v];
        double z[4] = {1};
        coordinates(tree, part, v, z + 1);
        for (int r = 0; r < 4; ++r) {
            for (int c = 0; c <= r; ++c)
                a[r][c] += z[r] * z[c];
        }
        for (uint32_t i = morph->start[vertex]; i < morph->start[vertex + 1]; ++i) {
            for (int c = 0; c < 3; ++c) {
                double *right = f->fits[morph->target[i]].right[c];
                for (int r = 0; r < 4; ++r)
                    right[r] += (double)morph->move[i][c] * z[r];
            }
        }
    }
    for (int r = 0; r < 4; ++r)
        a[r][r] += 1e-6 * (double)part->count; /* where the vertices do not spread */
    mote_cert_factor(a);
    for (uint32_t i = 0; i < f->child_count; ++i) {
        for (int c = 0; c < 3; ++c) {
            double *slope = f->fits[f->of_child[i]].right[c];
            mote_cert_solve((const double(*)[4])a, slope);
            for (int k = 1; k < 4; ++k)
                slope[k] = fabs(slope[k]) <= 4 ? mote_as_float(slope[k]) : 0;
        }
    }
}

/* The residuals of the displacements at all vertices. */
static void measure_residuals(mote_morph_fitter *f, const mote_cert_tree *tree,
                              const mote_cert_part *part)
{
    const mote_morph *morph = f->morph;
    for (size_t v = 0; v < part->count; ++v) {
        const uint32_t vertex = part->vertices[v];
        double z[3];
        coordinates(tree, part, v, z);
        for (uint32_t i = morph->start[vertex]; i < morph->start[vertex + 1]; ++i) {
            target_fit *own = &f->fits[morph->target[i]];
            own->last = (uint32_t)v + 1;
            for (int c = 0; c < 3; ++c)
                own->move[c] = (double)morph->move[i][c];
        }
        for (uint32_t i = 0; i < f->child_count; ++i) {
            target_fit *own = &f->fits[f->of_child[i]];
            const bool moved = own->last == v + 1;
            for (int c = 0; c < 3; ++c) {
                const double *g = own->right[c] + 1;
                mote_range_widen(&own->residual[c], (moved ? own->move[c] : 0) - g[0] * z[0] -
                                                        g[1] * z[1] - g[2] * z[2]);
            }
        }
    }
}

/* Writes one lane of a target's row, and raises the target's bound. */
static void write_lane(target_fit *own, size_t lane, mote_skin_morph_bound *bound)
{
    mote_skin_morph_row *row = &own->row;
    mote_vec3 f, m;
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
        (void)mote_range_settle(&own->residual[c], &row->offset[c][lane],
                                &row->residual[c][lane]);
        for (int k = 0; k < 3; ++k)
            row->slope[k][c][lane] = (float)own->right[c][k + 1];
    }
    f = mote_vec3_make((double)row->offset[0][lane], (double)row->offset[1][lane],
                       (double)row->offset[2][lane]);
    m = mote_vec3_make((double)row->residual[0][lane], (double)row->residual[1][lane],
                       (double)row->residual[2][lane]);
    sum = mote_length(f) + mote_length(m);
    for (int k = 0; k < 3; ++k)
        sum += mote_length(
            mote_vec3_make(own->right[0][k + 1], own->right[1][k + 1], own->right[2][k + 1]));
    *bound = sum > *bound ? sum : *bound;
}

void mote_morph_fit(mote_morph_fitter *f, mote_cert_tree *tree, const mote_cert_part *part,
                    bool linear)
{
    mote_skin_morph_bound *bounds = tree->fixed;
    list_targets(f, part);
    if (f->child_count == 0)
        return;
    if (linear)
        fit_slopes(f, tree, part);
    measure_residuals(f, tree, part);
    for (uint32_t i = 0; i < f->child_count; ++i) {
        const uint16_t k = f->of_child[i];
        write_lane(&f->fits[k], part->lane, &bounds[k]);
    }
}

uint32_t mote_morph_fit_count(const mote_morph_fitter *f)
{
    return f->block_count;
}

void mote_morph_fit_store(mote_morph_fitter *f, mote_cert_strip *strips, uint16_t *active)
{
    qsort(f->of_block, f->block_count, sizeof *f->of_block, ascending);
    for (uint32_t i = 0; i < f->block_count; ++i) {
        active[i] = f->of_block[i];
        memcpy(strips + MOTE_MORPH_STRIPS * i, &f->fits[f->of_block[i]].row,
               sizeof(mote_skin_morph_row));
    }
    f->block_count = 0;
    ++f->block;
}
