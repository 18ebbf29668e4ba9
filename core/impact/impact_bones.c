#include "core/impact/impact_bones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LANES MOTE_BONE_LANES
#define RATES MOTE_BONE_RATES
#define CHANGES MOTE_BONE_CHANGES

mote_status mote_impact_bones_create(const mote_skin *skin, uint32_t groups, uint32_t padded,
                                     mote_impact_bones **bones, size_t *bytes)
{
    const size_t targets = skin->morph.targets;
    mote_impact_bones *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for the bones of groups of vertices");
    *bones = made;
    made->skin = skin;
    made->start = calloc((size_t)groups + 1, sizeof *made->start);
    made->bone = malloc((size_t)groups * skin->bones * sizeof *made->bone);
    made->moved = calloc(targets * padded + 1, sizeof *made->moved);
    made->moved_most = calloc(targets + 1, sizeof *made->moved_most);
    made->at = calloc(skin->bones, sizeof *made->at);
    made->morphed = calloc((size_t)3 * padded, sizeof *made->morphed);
    if (!made->start || !made->bone || !made->moved || !made->moved_most || !made->at ||
        !made->morphed)
        return mote_fail(MOTE_ENOMEM, "no memory for the bones of groups of vertices");
    *bytes += sizeof *made + groups * (sizeof *made->start + skin->bones * sizeof *made->bone) +
              (targets * (padded + (size_t)1) + 3 * (size_t)padded) * sizeof(double) +
              skin->bones * sizeof *made->at;
    return MOTE_OK;
}

void mote_impact_bones_destroy(mote_impact_bones *bones)
{
    if (!bones)
        return;
    free(bones->start);
    free(bones->bone);
    free(bones->moved);
    free(bones->moved_most);
    free(bones->at);
    free(bones->morphed);
    free(bones);
}

static void raise_to(double *most, double value)
{
    *most = value > *most ? value : *most;
}

/* Enters a bone into the list of the last group, in ascending order. */
static void enter_bone(mote_impact_bones *bones, uint32_t g, uint16_t bone)
{
    const uint32_t first = bones->start[g];
    uint32_t i = bones->start[g + 1];
    while (i > first && bones->bone[i - 1] > bone)
        --i;
    if (i > first && bones->bone[i - 1] == bone)
        return;
    const uint32_t behind = bones->start[g + 1] - i;
    memmove(&bones->bone[i + 1], &bones->bone[i], behind * sizeof *bones->bone);
    bones->bone[i] = bone;
    ++bones->start[g + 1];
}

void mote_impact_bones_add(mote_impact_bones *bones, uint32_t g, uint32_t padded,
                           const uint32_t *vertices, uint32_t count)
{
    const mote_skin *skin = bones->skin;
    const mote_morph *morph = &skin->morph;
    bones->start[g + 1] = bones->start[g];
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t v = vertices[i];
        for (uint32_t k = skin->start[v]; k < skin->start[v + 1]; ++k)
            enter_bone(bones, g, skin->bone[k]);
        for (uint32_t k = morph->targets ? morph->start[v] : 0;
             morph->targets && k < morph->start[v + 1]; ++k) {
            const double x = (double)morph->move[k][0], y = (double)morph->move[k][1],
                         z = (double)morph->move[k][2];
            const double length = sqrt(x * x + y * y + z * z) * (1 + 0x1p-48);
            raise_to(&bones->moved[(size_t)morph->target[k] * padded + g], length);
            raise_to(&bones->moved_most[morph->target[k]], length);
        }
    }
}

/* Control points of a number's cubic and of its derivatives. */
MOTE_INLINE void derive(const double b[4], double out[LANES])
{
    const double d[3] = {b[1] - b[0], b[2] - b[1], b[3] - b[2]};
    for (size_t i = 0; i < 4; ++i)
        out[i] = b[i];
    for (size_t i = 0; i < 3; ++i)
        out[RATES + i] = 3 * d[i];
    out[CHANGES] = 6 * (d[1] - d[0]);
    out[CHANGES + 1] = 6 * (d[2] - d[1]);
}

/* A bound of |A| with the columns a, b, c. */
static double stretch_of(mote_vec3 a, mote_vec3 b, mote_vec3 c)
{
    const double ab = fabs(mote_dot(a, b)), ac = fabs(mote_dot(a, c)),
                 bc = fabs(mote_dot(b, c));
    const double rows[3] = {mote_dot(a, a) + ab + ac, mote_dot(b, b) + ab + bc,
                            mote_dot(c, c) + ac + bc};
    return sqrt(fmax(rows[0], fmax(rows[1], rows[2])));
}

/* A column of A at a control point: that of the weights, and of the rest where there is one. */
static mote_vec3 column(const mote_impact_bone *bone, size_t k, size_t lane, double unit,
                        double rest)
{
    return mote_vec3_make(bone->control[0][k][lane] / unit + (k == 0 ? rest : 0),
                          bone->control[1][k][lane] / unit + (k == 1 ? rest : 0),
                          bone->control[2][k][lane] / unit + (k == 2 ? rest : 0));
}

static void load_bone(const double *weights, size_t padded, size_t first, double unit,
                      mote_impact_bone *bone)
{
    memset(bone, 0, sizeof *bone);
    for (size_t c = 0; weights && c < 3; ++c) {
        for (size_t k = 0; k < 4; ++k) {
            double b[4];
            for (size_t i = 0; i < 4; ++i)
                b[i] = weights[(3 * i + c) * padded + first + k];
            derive(b, bone->control[c][k]);
        }
    }
    static const size_t ends[4] = {0, RATES, CHANGES, CHANGES + 2};
    for (size_t order = 0; order < 3; ++order) {
        const size_t last = order == 1 ? RATES + 3 : ends[order + 1];
        const double rest = order == 0 ? 1 : 0;
        for (size_t lane = ends[order]; lane < last; ++lane)
            raise_to(&bone->stretch[order], stretch_of(column(bone, 0, lane, unit, rest),
                                                       column(bone, 1, lane, unit, rest),
                                                       column(bone, 2, lane, unit, rest)));
    }
    for (size_t k = 0; k < 4; ++k) {
        double most = 0;
        for (size_t i = 0; i < 4; ++i)
            raise_to(&most, fabs(bone->control[0][k][i]) + fabs(bone->control[1][k][i]) +
                                fabs(bone->control[2][k][i]));
        bone->size += most;
    }
}

/* Largest lengths of the image of a point, at q in the skin's units and `at` from the pivot,
   and of its derivatives. */
MOTE_CLONES
static void image_of(const mote_impact_bone *restrict bone, const double q[3], mote_vec3 at,
                     mote_vec3 axis, double most[3])
{
    double length[LANES];
    const double rest[3] = {at.x, at.y, at.z};
    double p[3][LANES];
    for (size_t c = 0; c < 3; ++c) {
        MOTE_LANE_LOOP
        for (size_t l = 0; l < LANES; ++l)
            p[c][l] = q[0] * bone->control[c][0][l] + q[1] * bone->control[c][1][l] +
                      q[2] * bone->control[c][2][l] + bone->control[c][3][l];
        for (size_t l = 0; l < 4; ++l)
            p[c][l] += rest[c];
    }
    MOTE_LANE_LOOP
    for (size_t l = 0; l < LANES; ++l)
        length[l] = p[0][l] * p[0][l] + p[1][l] * p[1][l] + p[2][l] * p[2][l];
    for (size_t l = 0; l < 4; ++l) { /* the rounding of what is subtracted is put back */
        const double along = p[0][l] * axis.x + p[1][l] * axis.y + p[2][l] * axis.z;
        const double across = length[l] - along * along * (1 - 0x1p-48);
        length[l] = (across > 0 ? across : 0) + 0x1p-44 * length[l];
    }
    most[0] = sqrt(fmax(fmax(length[0], length[1]), fmax(length[2], length[3])));
    most[1] = sqrt(fmax(length[RATES], fmax(length[RATES + 1], length[RATES + 2])));
    most[2] = sqrt(fmax(length[CHANGES], length[CHANGES + 1]));
}

/* Bounds of |m|, |m'| and |m''| of each group; returns the largest of |m| over all. */
static double bound_targets(mote_impact_bones *bones, const mote_field *field, size_t groups,
                            const double *weights)
{
    const mote_skin *skin = bones->skin;
    memset(bones->morphed, 0, 3 * groups * sizeof *bones->morphed);
    double all = 0;
    for (uint32_t k = 0; weights && k < skin->morph.targets; ++k) {
        const double *x = weights + mote_morph_first(skin) + k;
        const size_t step = (size_t)3 * field->padded;
        const double b[4] = {x[0], x[step], x[2 * step], x[3 * step]};
        double c[LANES], most[3] = {0, 0, 0};
        derive(b, c);
        for (size_t i = 0; i < 4; ++i)
            raise_to(&most[0], fabs(c[i]));
        for (size_t i = 0; i < 3; ++i)
            raise_to(&most[1], fabs(c[RATES + i]));
        for (size_t i = 0; i < 2; ++i)
            raise_to(&most[2], fabs(c[CHANGES + i]));
        all += most[0] * bones->moved_most[k];
        const double *row = bones->moved + k * groups;
        for (size_t g = 0; g < groups; ++g) {
            for (size_t order = 0; order < 3; ++order)
                bones->morphed[order * groups + g] += most[order] * row[g];
        }
    }
    return all;
}

double mote_impact_bones_bound(mote_impact_bones *bones, const mote_impact_balls *groups,
                               const mote_field *field, const double *weights, mote_vec3 pivot,
                               mote_vec3 axis, double *sums)
{
    const mote_skin *skin = bones->skin;
    const size_t n = groups->padded;
    double size = 0;
    for (uint32_t b = 0; b < skin->bones; ++b) {
        load_bone(weights, field->padded, (size_t)4 * b, skin->unit, &bones->at[b]);
        size = fmax(size, bones->at[b].size);
    }
    const double morphed = bound_targets(bones, field, n, weights);
    const double *const m[3] = {bones->morphed, bones->morphed + n, bones->morphed + 2 * n};
    for (uint32_t g = 0; g < groups->count; ++g) {
        const mote_vec3 c = groups->middle[g];
        const mote_vec3 local = mote_scale(mote_sub(c, skin->origin), 1 / skin->unit);
        const double q[3] = {local.x, local.y, local.z};
        const double radius = groups->radius[g] + m[0][g];
        double most[3] = {0, 0, 0};
        for (uint32_t i = bones->start[g]; i < bones->start[g + 1]; ++i) {
            const mote_impact_bone *bone = &bones->at[bones->bone[i]];
            const double *s = bone->stretch;
            double own[3];
            image_of(bone, q, mote_sub(c, pivot), axis, own);
            raise_to(&most[0], own[0] + s[0] * radius);
            raise_to(&most[1], own[1] + s[1] * radius + s[0] * m[1][g]);
            raise_to(&most[2], own[2] + s[2] * radius + 2 * s[1] * m[1][g] + s[0] * m[2][g]);
        }
        for (size_t order = 0; order < 3; ++order)
            sums[order * n + g] = most[order];
    }
    return size * (1 + morphed / skin->unit) + morphed;
}

double mote_impact_bones_apart(const mote_impact_bones *bones, const mote_field *field,
                               const double *a, const double *b)
{
    const mote_skin *skin = bones->skin;
    const size_t padded = field->padded;
    double moved = 0, most = 0, apart = 0, stretch = 0;
    for (uint32_t k = 0; k < skin->morph.targets; ++k) {
        const size_t j = (size_t)mote_morph_first(skin) + k;
        const double x = a ? a[j] : 0, y = b ? b[j] : 0;
        apart += fabs(x - y) * bones->moved_most[k];
        moved += fmax(fabs(x), fabs(y)) * bones->moved_most[k];
    }
    for (size_t i = 0; i < skin->bones; ++i) {
        double sum = 0, size = 0;
        for (size_t k = 0; k < 4; ++k) {
            for (size_t c = 0; c < 3; ++c) {
                const size_t j = c * padded + 4 * i + k;
                const double x = a ? a[j] : 0, y = b ? b[j] : 0;
                sum += fabs(x - y);
                size += fabs(x);
            }
        }
        most = fmax(most, sum);
        stretch = fmax(stretch, size);
    }
    return most * (1 + moved / skin->unit) + apart * (1 + stretch / skin->unit);
}
