/* Bounds of any field: each basis function is fitted by
       phi_j(x) = f_j + sum_k g_jk z_k + r,   |r| <= m_j,
   over the vertices of a box, z_k being their coordinates in it (certificate_tree.h). With
   weights w_j the deformed vertices then lie in the sum of the centre R c + t + sum_j f_j w_j,
       three half axes R h_k + sum_j g_jk w_j, and
       an axis-aligned half width sum_j m_j |w_j|,
   whatever the field is. Basis functions are multiplied by a power of two that brings the
   largest value near 1. */
#ifndef MOTE_CORE_CERTIFICATE_FITTED_H
#define MOTE_CORE_CERTIFICATE_FITTED_H

#include "core/base/clones.h"
#include "core/certificate/certificate_bounds.h"

/* What one basis function does to the children of a block: offset f, slopes g by axis, and the
   largest residual m >= 0. A block has one for each function that is not 0 at all of its
   vertices. Rows are most of what a query reads, so slopes and residual are kept in half a word
   each. The float in the upper half is read with the lower half as its last bits, which costs
   nothing; the lower half is the upper half of a float whose last bits are 0. Offset and
   residual are measured with the slopes as they are read, so that the bounds hold as before:
   what 8 bits of a slope leave out is in the residual. */
typedef struct mote_cert_row {
    mote_cert_strip offset;
    uint32_t slopes[MOTE_CERT_WIDTH]; /* upper half: axis 0; lower: axis 1 */
    uint32_t rest[MOTE_CERT_WIDTH];   /* upper half: residual; lower: slope of axis 2 */
} mote_cert_row;

/* A float and its bits. */
typedef union mote_cert_word {
    uint32_t bits;
    float value;
} mote_cert_word;

/* The float in either half of a word. */
MOTE_INLINE float mote_cert_upper(uint32_t word)
{
    return (mote_cert_word){.bits = word}.value;
}

MOTE_INLINE float mote_cert_lower(uint32_t word)
{
    return mote_cert_upper(word << 16);
}

/* Of each basis function, as long as the field is padded. tree->fixed holds the three arrays
   side by side. */
typedef struct mote_cert_scales {
    double *scale; /* a power of two */
    double *unit;  /* of weights: the tree's scale divided by that, a power of two too */
    double *bound; /* of |f| + |g_1| + |g_2| + |g_3| + m in any row */
} mote_cert_scales;

static inline mote_cert_scales mote_cert_scales_of(const mote_cert_tree *tree)
{
    double *first = (double *)tree->fixed;
    const size_t padded = tree->body->field->padded;
    return (mote_cert_scales){first, first + padded, first + 2 * padded};
}

extern const mote_cert_bounds mote_cert_fitted;

/* mote_cert_bounds.start, fit, store and stop of mote_cert_fitted. */
mote_status mote_cert_fitted_start(mote_cert_tree *tree, bool linear_fits, void **fitter);
void mote_cert_fitted_fit(void *fitter, mote_cert_tree *tree, const mote_cert_part *part);
mote_status mote_cert_fitted_store(void *fitter, mote_cert_tree *tree, mote_cert_block *block);
void mote_cert_fitted_stop(void *fitter);

#endif
