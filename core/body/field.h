/* How a body deforms: a displacement that is linear in per-frame weights,

       d(x_i) = sum over j of phi_j(x_i) * w_j,

   with J scalar basis functions phi_j that are known at rest, and one weight vector w_j each.
   The kinds that are built in:

   - static: J = 0, nothing is evaluated;
   - given: J = 0 and no field is known: every frame brings the positions of all vertices;
   - csrbf: phi_j is Wendland's C2 function of |x - c_j| / support (paper section 4);
   - modes: displacement vectors of all vertices with one scalar weight s for each mode. A mode
     is three basis functions, its x, y and z column, with the weights (s, 0, 0), (0, s, 0) and
     (0, 0, s).

   Two more are in core/skin/skin.h: skins, and skins with morph targets.

   A field is immutable once made. A new kind is a new source file that fills the struct below;
   field_maker.h gives it a name in scenarios. */
#ifndef MOTE_CORE_FIELD_H
#define MOTE_CORE_FIELD_H

#include "core/base/clones.h"
#include "core/body/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Weight vectors by coordinate, in world axes (already rotated with the body), padded with
   zeros to a multiple of MOTE_LANES. Unit: the mesh's unit of length. NULL arrays when padded
   is 0. */
typedef struct mote_weights {
    const double *x, *y, *z; /* [padded] */
    uint32_t count, padded;
} mote_weights;

/* The same in single precision. */
typedef struct mote_weights_single {
    const float *x, *y, *z; /* [padded] */
    uint32_t padded;
} mote_weights_single;

/* At most this many basis functions: with the padding, their numbers fit in 16 bits. A kind
   with bounds of its own may have up to MOTE_FIELD_MAX_BOUNDED if it is sparse, or has both
   displacement functions. */
#define MOTE_FIELD_MAX 65528
#define MOTE_FIELD_MAX_BOUNDED (1u << 20)

/* A kind that leaves its displacements to the sum over basis() or sparse() has at most this
   many functions at a vertex, since their values are kept on the stack. */
#define MOTE_FIELD_SUMMED 256

typedef struct mote_field mote_field;
struct mote_cert_bounds;

typedef struct mote_field_kind {
    const char *name; /* "static", "csrbf", "modes" */

    /* phi[0 .. padded - 1] at a rest vertex; zeros in the padding. Deterministic: the same bits
       on every instruction set. NULL: the displacement is not linear in all weights; such a
       kind has displacement, displacement_single and bounds of its own. */
    void (*basis)(const mote_field *field, const mote_mesh *mesh, uint32_t vertex, double *phi);

    /* Of a kind whose functions are 0 at most vertices: the functions that may not be 0 at a
       vertex. Writes their numbers, ascending, and their values, both as long as field->most;
       returns how many there are. The values equal those of basis() bit for bit. NULL: each
       function may differ from 0 at every vertex. */
    uint32_t (*sparse)(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                       uint32_t *functions, double *phi);

    /* sum_j phi_j w_j at a rest vertex. Function j is added to lane j % MOTE_LANES, in
       ascending order; the lanes are added up in the fixed order of mote_lane_sum. Equals the
       same sum over basis() bit for bit. NULL: the sum over sparse() or basis(). */
    mote_vec3 (*displacement)(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                              const mote_weights *weights);

    /* The same in single precision throughout, for the weights rounded to it. NULL: the sum
       over sparse() or basis(), rounded to it. */
    void (*displacement_single)(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                                const mote_weights_single *weights, float displacement[3]);

    /* Displacements of MOTE_LANES rest vertices at once, by coordinate, each equal bit for bit
       to displacement(). NULL: they are evaluated one by one. */
    void (*group)(const mote_field *field, const mote_mesh *mesh,
                  const uint32_t vertices[MOTE_LANES], const mote_weights *weights,
                  double displacement[3][MOTE_LANES]);

    /* The same in single precision.
       functions[count] lists every basis function that is not 0 at all of them; weights[c][j]
       is coordinate c of weight j, in any unit. Returns a factor: coordinate c is wrong by at
       most this factor times sum_j |weights[c][j]|. NULL: not offered. */
    float (*estimate)(const mote_field *field, const mote_mesh *mesh,
                      const uint32_t vertices[MOTE_LANES], const uint16_t *functions,
                      size_t count, const float *const weights[3],
                      float displacement[3][MOTE_LANES]);

    /* Gradient of phi_j with respect to the rest position, at a rest vertex: gradient[j], 0 in
       the padding. For modes: the least-squares gradient over the one-ring. NULL: not offered.
     */
    void (*gradient)(const mote_field *field, const mote_mesh *mesh, uint32_t vertex,
                     mote_vec3 *gradient);

    /* How the certified query bounds the field (core/certificate/certificate_bounds.h). NULL:
       by linear fits of the basis functions, which serve any field. */
    const struct mote_cert_bounds *bounds;

    /* Nothing is known but the positions that each frame brings (mote_body_state.vertices). */
    bool given;

    void (*destroy)(mote_field *field);
} mote_field_kind;

struct mote_field {
    const mote_field_kind *kind;
    uint32_t count;  /* J; 0 when nothing deforms */
    uint32_t padded; /* J rounded up to a multiple of MOTE_LANES */
    uint32_t most;   /* functions that may not be 0 at a vertex, at most; J unless sparse */
    /* How many of the weights, the last ones, are numbers, in x, which do not turn with the
       body. The three before them are then the columns of the pose's rotation. 0 but for morph
       targets. */
    uint32_t numbers;
    double support; /* CSRBF: support radius, > 0 */
    /* CSRBF: centres by coordinate [padded]; the padding repeats the first, with weight 0 */
    double *centre_x, *centre_y, *centre_z;
    float *centre_single; /* CSRBF: x, y, z of the centres rounded, [3][padded] */
    const void *data;     /* of other kinds */
    size_t bytes;         /* heap held, this struct included */
};

/* How many weights are vectors, which turn with the body; the numbers, which come after them,
   do not. */
static inline uint32_t mote_field_vectors(const mote_field *field)
{
    return field->count - field->numbers;
}

/* Of a field with numbers: the first of the three weights before them, which are the columns of
   the pose's rotation, and so the axes themselves to one who turns with the body. */
static inline uint32_t mote_field_first_axis(const mote_field *field)
{
    return mote_field_vectors(field) - 3;
}

/* A field that never deforms. MOTE_ENOMEM. The caller destroys *field, as of all fields below.
 */
mote_status mote_field_create_static(mote_field **field);

/* The field of a body whose deformation is not known: cloth, finite elements, captured
   sequences. mote_body_state.vertices then holds its world positions in every frame, and is
   never NULL. MOTE_ENOMEM. */
mote_status mote_field_create_given(mote_field **field);

/* Compactly supported radial basis functions, Wendland C2: (1-r)^4 (4r+1) for r < 1, else 0.
   centres: count (1 .. MOTE_FIELD_MAX) positions in rest space, copied; support > 2^-1024
   (5.6e-309), so that 1 / support is finite. MOTE_EINVAL for anything else or not finite;
   MOTE_ENOMEM. Source: paper section 4. */
mote_status mote_field_create_csrbf(const mote_vec3 *centres, uint32_t count, double support,
                                    mote_field **field);

/* Linear modes: modes[m * vertex_count + i] is the displacement of vertex i per unit of weight
   m, copied. vertex_count is that of the mesh of each body that has the field, which is not
   checked. MOTE_EINVAL where count is 0, count * 3 is above MOTE_FIELD_MAX, or a number is
   not finite; MOTE_ENOMEM. */
mote_status mote_field_create_modes(const mote_vec3 *modes, uint32_t count,
                                    uint32_t vertex_count, mote_field **field);

/* For a new kind: a zeroed field with kind, count, padded, most (= count) and bytes
   set; kind->destroy frees it with free(). A sparse kind lowers most. MOTE_EINVAL: count is
   above MOTE_FIELD_MAX, or MOTE_FIELD_MAX_BOUNDED where that holds, or above MOTE_FIELD_SUMMED
   for a kind that is not sparse and leaves displacement or displacement_single to the sum over
   basis(). MOTE_ENOMEM. */
mote_status mote_field_allocate(const mote_field_kind *kind, uint32_t count,
                                mote_field **field);

/* NULL is allowed. */
void mote_field_destroy(mote_field *field);

/* sum_j phi_j w_j at a rest vertex, in world axes; zero for a static field. No allocation; any
   thread. Cost O(J); of a sparse field, O(functions at the vertex). */
mote_vec3 mote_field_displacement(const mote_field *field, const mote_mesh *mesh,
                                  uint32_t vertex, const mote_weights *weights);

/* The same in single precision. */
void mote_field_displacement_single(const mote_field *field, const mote_mesh *mesh,
                                    uint32_t vertex, const mote_weights_single *weights,
                                    float displacement[3]);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
