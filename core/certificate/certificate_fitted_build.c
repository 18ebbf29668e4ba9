/* Bounds of any field, while a tree is built: least-squares fits of the basis functions over a
   box, and their residuals. Work and memory follow the functions that are not 0 at a vertex,
   where the field says which these are. */
#include "core/certificate/certificate_fitted.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH MOTE_CERT_WIDTH

/* One function over the child at hand. */
typedef struct fit {
    double right[4]; /* of the normal equations; then the solution */
    double slope[3]; /* as stored */
    double low, high;
    bool active; /* not 0 at every vertex */
} fit;

typedef struct fitter {
    bool linear;
    uint32_t functions; /* of the field */
    /* The functions that are looked at in the child at hand: all, or of a sparse field those of
       its vertices. */
    uint32_t *function; /* [functions] ascending */
    uint32_t count;
    uint32_t *place;     /* [functions] sparse: the place of a function in that list */
    uint32_t *stamp;     /* [functions] sparse: the last child that had the function */
    uint32_t child;      /* number of the child at hand */
    fit *fits;           /* [functions] by place in that list */
    double *phi;         /* [functions, padded] at one vertex, by place */
    uint32_t *at_vertex; /* [most] sparse: functions at one vertex, and their values */
    double *value;       /* [most] */
    mote_cert_row *row;  /* [functions] of the block at hand */
    uint16_t *active;    /* [functions] which of them it has */
    uint32_t active_count;
    bool *is_active; /* [functions] */
} fitter;

void mote_cert_fitted_stop(void *state)
{
    fitter *f = state;
    free(f->function);
    free(f->place);
    free(f->stamp);
    free(f->fits);
    free(f->phi);
    free(f->at_vertex);
    free(f->value);
    free(f->row);
    free(f->active);
    free(f->is_active);
    free(f);
}

/* Powers of two that bring the largest value of every basis function near 1. */
static void scale_basis(const fitter *f, const mote_cert_tree *tree)
{
    const mote_cert_scales scales = mote_cert_scales_of(tree);
    const mote_body *body = tree->body;
    const mote_field *field = body->field;
    for (uint32_t v = 0; v < body->mesh->vertex_count; ++v) {
        uint32_t count = f->functions;
        double *value = f->phi;
        if (field->kind->sparse) {
            value = f->value;
            count = field->kind->sparse(field, body->mesh, v, f->at_vertex, f->value);
        } else {
            field->kind->basis(field, body->mesh, v, value);
        }
        for (uint32_t i = 0; i < count; ++i) {
            double *most = &scales.scale[field->kind->sparse ? f->at_vertex[i] : i];
            *most = fabs(value[i]) > *most ? fabs(value[i]) : *most;
        }
    }
    for (uint32_t j = 0; j < f->functions; ++j) {
        scales.scale[j] = scales.scale[j] > 0 ? ldexp(1, -ilogb(scales.scale[j])) : 1;
        scales.unit[j] = tree->scale / scales.scale[j];
    }
}

static bool allocate(fitter *f, const mote_field *field)
{
    const size_t n = f->functions;
    f->function = malloc(n * sizeof *f->function);
    f->place = malloc(n * sizeof *f->place);
    f->stamp = calloc(n, sizeof *f->stamp);
    f->fits = malloc(n * sizeof *f->fits);
    f->phi = malloc(field->padded * sizeof *f->phi);
    f->at_vertex = calloc(field->most, sizeof *f->at_vertex);
    f->value = calloc(field->most, sizeof *f->value);
    f->row = malloc(n * sizeof *f->row);
    f->active = malloc(n * sizeof *f->active);
    f->is_active = calloc(n, sizeof *f->is_active);
    return f->function && f->place && f->stamp && f->fits && f->phi && f->at_vertex &&
           f->value && f->row && f->active && f->is_active;
}

mote_status mote_cert_fitted_start(mote_cert_tree *tree, bool linear_fits, void **made)
{
    const mote_field *field = tree->body->field;
    fitter *f = calloc(1, sizeof *f);
    if (!f)
        return mote_fail(MOTE_ENOMEM, "no memory to fit a field");
    f->linear = linear_fits;
    f->functions = field->count;
    if (f->functions > 0) {
        tree->fixed_bytes = 3 * (size_t)field->padded * sizeof(double);
        tree->fixed = calloc(field->padded, 3 * sizeof(double));
        if (!tree->fixed || !allocate(f, field)) {
            mote_cert_fitted_stop(f);
            return mote_fail(MOTE_ENOMEM, "no memory to fit %u basis functions", field->count);
        }
        scale_basis(f, tree);
        for (uint32_t j = 0; j < f->functions; ++j)
            f->function[j] = j;
        f->count = f->functions;
    }
    *made = f;
    return MOTE_OK;
}

static int ascending(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a;
    const uint32_t y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Lists the functions of the child's vertices. */
static void list_functions(fitter *f, const mote_cert_tree *tree, const mote_cert_part *part)
{
    const mote_field *field = tree->body->field;
    ++f->child;
    f->count = 0;
    for (size_t i = 0; i < part->count; ++i) {
        const uint32_t count = field->kind->sparse(field, tree->body->mesh, part->vertices[i],
                                                   f->at_vertex, f->value);
        for (uint32_t k = 0; k < count; ++k) {
            const uint32_t j = f->at_vertex[k];
            if (f->stamp[j] != f->child)
                f->function[f->count++] = j;
            f->stamp[j] = f->child;
        }
    }
    qsort(f->function, f->count, sizeof *f->function, ascending);
    for (uint32_t i = 0; i < f->count; ++i)
        f->place[f->function[i]] = i;
}

/* The listed functions at a vertex in the tree's scale, by place. */
static void scaled_basis(const fitter *f, const mote_cert_tree *tree, uint32_t vertex)
{
    const mote_field *field = tree->body->field;
    const double *scale = mote_cert_scales_of(tree).scale;
    if (!field->kind->sparse) {
        field->kind->basis(field, tree->body->mesh, vertex, f->phi);
        for (uint32_t j = 0; j < f->functions; ++j)
            f->phi[j] *= scale[j];
        return;
    }
    memset(f->phi, 0, f->count * sizeof *f->phi);
    const uint32_t count =
        field->kind->sparse(field, tree->body->mesh, vertex, f->at_vertex, f->value);
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t j = f->at_vertex[k];
        f->phi[f->place[j]] = f->value[k] * scale[j];
    }
}

/* The slopes of the listed functions. They only decide how tight the boxes are, since residuals
   are measured at all vertices: where there are many, a sample of them is fitted. */
static void fit_slopes(fitter *f, const mote_cert_tree *tree, const mote_cert_part *part)
{
    const size_t stride = (part->count + MOTE_CERT_FIT_CHUNK - 1) / MOTE_CERT_FIT_CHUNK;
    double a[4][4] = {{0}};
    size_t used = 0;
    for (size_t i = 0; i < part->count; i += stride, ++used) {
        double z[4] = {1};
        mote_cert_box_coordinates(part->box, mote_cert_tree_position(tree, part->vertices[i]),
                                  z + 1);
        scaled_basis(f, tree, part->vertices[i]);
        for (int r = 0; r < 4; ++r) {
            for (int c = 0; c <= r; ++c)
                a[r][c] += z[r] * z[c];
        }
        for (uint32_t j = 0; j < f->count; ++j) {
            for (int r = 0; r < 4; ++r)
                f->fits[j].right[r] += z[r] * f->phi[j];
        }
    }
    for (int i = 0; i < 4; ++i)
        a[i][i] += 1e-6 * (double)used; /* directions in which the vertices do not spread */
    mote_cert_factor(a);
    for (uint32_t j = 0; j < f->count; ++j) {
        mote_cert_solve((const double(*)[4])a, f->fits[j].right);
        for (int k = 0; k < 3; ++k)
            f->fits[j].slope[k] = mote_as_float(f->fits[j].right[k + 1]);
    }
}

/* The least and the largest of phi - sum_k g_k z_k over all vertices, for the slopes as they
   are stored. */
static void measure_residuals(fitter *f, const mote_cert_tree *tree, const mote_cert_part *part)
{
    for (size_t i = 0; i < part->count; ++i) {
        double z[3];
        mote_cert_box_coordinates(part->box, mote_cert_tree_position(tree, part->vertices[i]),
                                  z);
        scaled_basis(f, tree, part->vertices[i]);
        for (uint32_t j = 0; j < f->count; ++j) {
            fit *own = &f->fits[j];
            const double value =
                f->phi[j] - own->slope[0] * z[0] - own->slope[1] * z[1] - own->slope[2] * z[2];
            own->low = value < own->low ? value : own->low;
            own->high = value > own->high ? value : own->high;
            own->active = own->active || fabs(f->phi[j]) > 0;
        }
    }
}

static float rounded_up(double x)
{
    return (float)x * (1 + 0x1p-22F) + 0x1p-40F;
}

/* Writes the child's lane of a function's row. */
static void write_lane(fitter *f, uint32_t function, const fit *own, size_t lane,
                       double *largest)
{
    mote_cert_row *row = &f->row[function];
    if (!f->is_active[function]) {
        memset(row, 0, sizeof *row);
        f->is_active[function] = true;
        f->active[f->active_count++] = (uint16_t)function;
    }
    const double middle = mote_as_float(0.5 * (own->low + own->high));
    const double above = own->high - middle;
    const double below = middle - own->low;
    row->offset[lane] = (float)middle;
    row->residual[lane] = rounded_up(above > below ? above : below);
    double bound = fabs(middle);
    for (int k = 0; k < 3; ++k) {
        row->slope[k][lane] = (float)own->slope[k];
        bound += fabs(own->slope[k]);
    }
    bound += (double)row->residual[lane];
    *largest = bound > *largest ? bound : *largest;
}

void mote_cert_fitted_fit(void *state, mote_cert_tree *tree, const mote_cert_part *part)
{
    fitter *f = state;
    if (f->functions == 0)
        return;
    double *bounds = mote_cert_scales_of(tree).bound;
    if (tree->body->field->kind->sparse)
        list_functions(f, tree, part);
    for (uint32_t j = 0; j < f->count; ++j)
        f->fits[j] = (fit){.low = DBL_MAX, .high = -DBL_MAX};
    if (f->linear)
        fit_slopes(f, tree, part);
    measure_residuals(f, tree, part);
    for (uint32_t j = 0; j < f->count; ++j) {
        const uint32_t function = f->function[j];
        if (f->fits[j].active)
            write_lane(f, function, &f->fits[j], part->lane, &bounds[function]);
    }
}

static int ascending_short(const void *a, const void *b)
{
    return (int)*(const uint16_t *)a - (int)*(const uint16_t *)b;
}

mote_status mote_cert_fitted_store(void *state, mote_cert_tree *tree, mote_cert_block *block)
{
    fitter *f = state;
    const size_t strips = sizeof(mote_cert_row) / sizeof(mote_cert_strip);
    mote_status status =
        mote_cert_tree_keep(tree, block, strips * f->active_count, f->active_count);
    if (status != MOTE_OK)
        return status;
    if (f->active_count > 0)
        qsort(f->active, f->active_count, sizeof *f->active, ascending_short);
    for (uint32_t i = 0; i < f->active_count; ++i) {
        const uint16_t function = f->active[i];
        tree->active[block->first_active + i] = function;
        memcpy(tree->strips + block->first_strip + strips * i, &f->row[function],
               sizeof *f->row);
        f->is_active[function] = false;
    }
    f->active_count = 0;
    return MOTE_OK;
}
