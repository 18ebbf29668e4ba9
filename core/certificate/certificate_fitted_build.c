/* Bounds of any field, while a tree is built: least-squares fits of the basis functions over a
   box, and their residuals. Work and memory follow the functions that are not 0 at a vertex,
   where the field says which these are. */
#include "core/certificate/certificate_fitted.h"
#include "core/certificate/certificate_box.h"
#include "core/base/clones.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH MOTE_CERT_WIDTH

/* Functions are scaled up by at most 2 to this, so that the factor is a number. */
#define MOST_SCALE 1000

/* Values of functions that there is room for at once: those of MOTE_CERT_FIT_CHUNK vertices
   with 64 functions, of fewer vertices with more functions. */
#define VALUES ((size_t)64 * MOTE_CERT_FIT_CHUNK)

/* The functions over the child at hand, in rows by place. */
typedef struct fits {
    double *right[4]; /* of the normal equations; then the solution */
    double *slope[3]; /* as they are read in a query */
    double *low, *high;
    double *most; /* the largest size; 0: the function is 0 at every vertex */
    double *rows; /* [ROWS][rounded up functions]: all of these */
} fits;

enum { ROWS = 4 + 3 + 3 };

typedef struct fitter {
    bool linear;
    uint32_t functions; /* of the field */
    /* The functions that are looked at in the child at hand: all, or of a sparse field those of
       its vertices. */
    uint32_t *function; /* [functions] ascending */
    uint32_t count;
    uint32_t *place; /* [functions] sparse: the place of a function in that list */
    uint32_t *stamp; /* [functions] sparse: the last child that had the function */
    uint32_t child;  /* number of the child at hand */
    fits fits;
    double *phi; /* values by place at vertices of the child, in rows */
    size_t phi_room;
    size_t length;       /* of such a row: count rounded up to whole lanes */
    size_t at_once;      /* vertices whose rows phi has room for, at most MOTE_CERT_FIT_CHUNK */
    bool filled;         /* phi has the rows of all of the child's vertices */
    uint32_t *at_vertex; /* [most] sparse: functions at one vertex, and their values */
    double *value;       /* [most] */
    mote_cert_row *row;  /* [functions] of the block at hand */
    uint16_t *active;    /* [functions] which of them it has */
    uint32_t active_count;
    bool *is_active; /* [functions] */
} fitter;

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

void mote_cert_fitted_stop(void *state)
{
    fitter *f = state;
    free(f->function);
    free(f->place);
    free(f->stamp);
    free(f->fits.rows);
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
        const int size = scales.scale[j] > 0 ? ilogb(scales.scale[j]) : 0;
        scales.scale[j] = ldexp(1, size < -MOST_SCALE ? MOST_SCALE : -size);
        scales.unit[j] = tree->scale / scales.scale[j];
    }
}

static void point_rows(fits *t, size_t length)
{
    double **const row[ROWS] = {&t->right[0], &t->right[1], &t->right[2], &t->right[3],
                                &t->slope[0], &t->slope[1], &t->slope[2], &t->low,
                                &t->high,     &t->most};
    for (size_t i = 0; i < ROWS; ++i)
        *row[i] = t->rows + i * length;
}

static bool allocate(fitter *f, const mote_field *field)
{
    const size_t n = f->functions;
    f->phi_room = field->padded > VALUES ? field->padded : VALUES;
    f->function = malloc(n * sizeof *f->function);
    f->place = malloc(n * sizeof *f->place);
    f->stamp = calloc(n, sizeof *f->stamp);
    f->fits.rows = calloc(ROWS * (size_t)field->padded, sizeof *f->fits.rows);
    f->phi = malloc(f->phi_room * sizeof *f->phi);
    f->at_vertex = calloc(field->most, sizeof *f->at_vertex);
    f->value = calloc(field->most, sizeof *f->value);
    f->row = malloc(n * sizeof *f->row);
    f->active = malloc(n * sizeof *f->active);
    f->is_active = calloc(n, sizeof *f->is_active);
    return f->function && f->place && f->stamp && f->fits.rows && f->phi && f->at_vertex &&
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

/* The listed functions at a vertex in the tree's scale, by place, and zeros. */
static void scaled_basis(const fitter *f, const mote_cert_tree *tree, uint32_t vertex,
                         double *phi)
{
    const mote_field *field = tree->body->field;
    const double *scale = mote_cert_scales_of(tree).scale;
    if (!field->kind->sparse) {
        field->kind->basis(field, tree->body->mesh, vertex, phi);
        for (uint32_t j = 0; j < f->functions; ++j)
            phi[j] *= scale[j];
        return;
    }
    memset(phi, 0, f->length * sizeof *phi);
    const uint32_t count =
        field->kind->sparse(field, tree->body->mesh, vertex, f->at_vertex, f->value);
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t j = f->at_vertex[k];
        phi[f->place[j]] = f->value[k] * scale[j];
    }
}

/* Writes the rows of count vertices, every stride-th. */
static void fill_rows(const fitter *f, const mote_cert_tree *tree, const uint32_t *vertices,
                      size_t stride, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        scaled_basis(f, tree, vertices[i * stride], f->phi + i * f->length);
}

/* Adds the vertices of some rows to the right sides. */
MOTE_CLONES
static void add_rows(const double z[3][MOTE_CERT_FIT_CHUNK], size_t count,
                     const double *restrict phi, size_t length, double *const right[4])
{
    for (size_t j = 0; j < length; j += MOTE_LANES) {
        double sum[4][MOTE_LANES];
        for (size_t r = 0; r < 4; ++r)
            memcpy(sum[r], right[r] + j, sizeof sum[r]);
        for (size_t i = 0; i < count; ++i) {
            const double *restrict own = phi + i * length + j;
            const double x = z[0][i];
            const double y = z[1][i];
            const double w = z[2][i];
            MOTE_LANE_LOOP
            for (size_t l = 0; l < MOTE_LANES; ++l) {
                sum[0][l] += own[l];
                sum[1][l] += x * own[l];
                sum[2][l] += y * own[l];
                sum[3][l] += w * own[l];
            }
        }
        for (size_t r = 0; r < 4; ++r)
            memcpy(right[r] + j, sum[r], sizeof sum[r]);
    }
}

/* Adds to the normal equations' matrix. */
static void add_coordinates(const double at[3][MOTE_CERT_FIT_CHUNK], size_t count,
                            double a[4][4])
{
    for (size_t i = 0; i < count; ++i) {
        const double z[4] = {1, at[0][i], at[1][i], at[2][i]};
        for (int r = 0; r < 4; ++r) {
            for (int c = 0; c <= r; ++c)
                a[r][c] += z[r] * z[c];
        }
    }
}

/* Slopes that are smaller than this are as good as 0; and a float in an upper half that has
   something below it is no smaller, since without an exponent it would be denormal, with which
   some processors are slow. */
#define TINY 0x1p-60F

static uint32_t bits_of(float x)
{
    return (mote_cert_word){.value = x}.bits;
}

/* The float nearest to x of which only the upper half is not 0, in a lower half. */
static uint32_t lower_half(float x)
{
    return fabsf(x) < TINY ? 0 : (bits_of(x) + 0x8000u) >> 16;
}

/* A word with a given lower half that is nearest to x as a float. */
static uint32_t word_nearest(float x, uint32_t lower)
{
    if (fabsf(x) < TINY && lower == 0)
        return 0;
    const uint32_t size = bits_of(fabsf(x) < TINY ? TINY : fabsf(x));
    const uint32_t upper = (size + 0x8000u - lower) >> 16;
    return (x < 0 ? 0x80000000u : 0) | upper << 16 | lower;
}

/* The least float with a given lower half that is at least x > 0, as a word. */
static uint32_t word_from(float x, uint32_t lower)
{
    const uint32_t word = (bits_of(x) & 0xffff0000u) | lower;
    return word < bits_of(x) ? word + 0x10000u : word;
}

/* Rounds the slopes of function j to what its row can hold. */
static void store_slopes(const fits *t, uint32_t j, const double right[4])
{
    const uint32_t second = lower_half((float)right[2]);
    t->slope[0][j] = (double)mote_cert_upper(word_nearest((float)right[1], second));
    t->slope[1][j] = (double)mote_cert_lower(second);
    t->slope[2][j] = (double)mote_cert_lower(lower_half((float)right[3]));
}

static void solve_all(const fitter *f, double a[4][4])
{
    mote_cert_factor(a);
    for (uint32_t j = 0; j < f->count; ++j) {
        double right[4];
        for (int k = 0; k < 4; ++k)
            right[k] = f->fits.right[k][j];
        mote_cert_solve((const double(*)[4])a, right);
        store_slopes(&f->fits, j, right);
    }
}

/* The slopes of the listed functions. They only decide how tight the boxes are, since residuals
   are measured at all vertices: where there are many, a sample of them is fitted. */
static void fit_slopes(fitter *f, const mote_cert_tree *tree, const mote_cert_part *part)
{
    const size_t stride = mote_cert_sample_stride(part->count);
    double a[4][4] = {{0}};
    size_t used = 0;
    for (size_t first = 0; first < part->count; first += f->at_once * stride) {
        const uint32_t *vertices = part->vertices + first;
        const size_t chunk = smaller(part->count - first, f->at_once * stride);
        double at[3][MOTE_CERT_FIT_CHUNK];
        const size_t count = mote_cert_box_sample(tree, vertices, chunk, part->box, stride, at);
        fill_rows(f, tree, vertices, stride, count);
        add_coordinates((const double(*)[MOTE_CERT_FIT_CHUNK])at, count, a);
        add_rows((const double(*)[MOTE_CERT_FIT_CHUNK])at, count, f->phi, f->length,
                 f->fits.right);
        used += count;
    }
    f->filled = part->count <= f->at_once;
    for (int i = 0; i < 4; ++i)
        a[i][i] += 1e-6 * (double)used; /* directions in which the vertices do not spread */
    solve_all(f, a);
}

/* Widens low, high and most by the vertices of some rows. */
MOTE_CLONES
static void widen_rows(const double z[3][MOTE_CERT_FIT_CHUNK], size_t count,
                       const double *restrict phi, size_t length, const fits *t)
{
    for (size_t j = 0; j < length; j += MOTE_LANES) {
        double g[3][MOTE_LANES], low[MOTE_LANES], high[MOTE_LANES], most[MOTE_LANES];
        for (size_t k = 0; k < 3; ++k)
            memcpy(g[k], t->slope[k] + j, sizeof g[k]);
        memcpy(low, t->low + j, sizeof low);
        memcpy(high, t->high + j, sizeof high);
        memcpy(most, t->most + j, sizeof most);
        for (size_t i = 0; i < count; ++i) {
            const double *restrict own = phi + i * length + j;
            const double x = z[0][i];
            const double y = z[1][i];
            const double w = z[2][i];
            MOTE_LANE_LOOP
            for (size_t l = 0; l < MOTE_LANES; ++l) {
                const double value = own[l] - g[0][l] * x - g[1][l] * y - g[2][l] * w;
                const double size = fabs(own[l]);
                low[l] = value < low[l] ? value : low[l];
                high[l] = value > high[l] ? value : high[l];
                most[l] = size > most[l] ? size : most[l];
            }
        }
        memcpy(t->low + j, low, sizeof low);
        memcpy(t->high + j, high, sizeof high);
        memcpy(t->most + j, most, sizeof most);
    }
}

/* The least and the largest of phi - sum_k g_k z_k over all vertices, for the slopes as they
   are read. */
static void measure_residuals(fitter *f, const mote_cert_tree *tree, const mote_cert_part *part)
{
    for (size_t first = 0; first < part->count; first += f->at_once) {
        const uint32_t *vertices = part->vertices + first;
        const size_t count = smaller(part->count - first, f->at_once);
        double at[3][MOTE_CERT_FIT_CHUNK];
        (void)mote_cert_box_sample(tree, vertices, count, part->box, 1, at);
        if (!f->filled)
            fill_rows(f, tree, vertices, 1, count);
        widen_rows((const double(*)[MOTE_CERT_FIT_CHUNK])at, count, f->phi, f->length,
                   &f->fits);
    }
}

/* Forgets the last child. The listed functions of the one at hand are known. */
static void begin_child(fitter *f)
{
    f->length = (f->count + MOTE_LANES - 1) / MOTE_LANES * MOTE_LANES;
    f->at_once = smaller(MOTE_CERT_FIT_CHUNK, f->phi_room / (f->length + !f->length));
    f->filled = false;
    point_rows(&f->fits, f->length);
    memset(f->fits.rows, 0, ROWS * f->length * sizeof *f->fits.rows);
    for (size_t j = 0; j < f->length; ++j) {
        f->fits.low[j] = DBL_MAX;
        f->fits.high[j] = -DBL_MAX;
    }
}

static float rounded_up(double x)
{
    return (float)x * (1 + 0x1p-22F) + 0x1p-40F;
}

/* Writes the child's lane of the row of a listed function. */
static void write_lane(fitter *f, uint32_t place, size_t lane, double *bounds)
{
    const uint32_t function = f->function[place];
    double *largest = &bounds[function];
    mote_cert_row *row = &f->row[function];
    if (!f->is_active[function]) {
        memset(row, 0, sizeof *row);
        f->is_active[function] = true;
        f->active[f->active_count++] = (uint16_t)function;
    }
    const double low = f->fits.low[place];
    const double high = f->fits.high[place];
    const double middle = mote_as_float(0.5 * (low + high));
    const double above = high - middle;
    const double below = middle - low;
    row->offset[lane] = (float)middle;
    const double slope[3] = {f->fits.slope[0][place], f->fits.slope[1][place],
                             f->fits.slope[2][place]};
    row->slopes[lane] = bits_of((float)slope[0]);
    row->rest[lane] =
        word_from(rounded_up(above > below ? above : below), bits_of((float)slope[2]) >> 16);
    const double bound = fabs(middle) + fabs(slope[0]) + fabs(slope[1]) + fabs(slope[2]) +
                         (double)mote_cert_upper(row->rest[lane]);
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
    begin_child(f);
    if (f->linear)
        fit_slopes(f, tree, part);
    measure_residuals(f, tree, part);
    for (uint32_t j = 0; j < f->count; ++j) {
        if (f->fits.most[j] > 0)
            write_lane(f, j, part->lane, bounds);
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
