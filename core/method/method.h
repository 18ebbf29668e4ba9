/* The contract behind which every method answers, ours and the baselines alike.

   A method is one constant descriptor in one file, defined as
       MOTE_METHOD(particle_paper) = {.name = "particle-paper", ...};
   at the start of a line. In mote's own sources the build finds that line
   (cmake/MoteRegistry.cmake). Elsewhere the file is compiled into a shared library, which mote
   loads (--plugin); the macro lists the method in it (core/base/plugin.h). */
#ifndef MOTE_CORE_METHOD_H
#define MOTE_CORE_METHOD_H

#include "core/body/body.h"
#include "core/base/parameter.h"
#include "core/base/plugin.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef enum mote_ask {
    MOTE_ASK_DISTANCE, /* the distance of the surfaces, and the contact that follows from it */
    MOTE_ASK_CONTACT,  /* only whether distance <= tolerance: a method may stop when it knows */
    MOTE_ASK_IMPACT    /* when distance <= tolerance first holds between two moments: asked of
                          methods that have a mote_impact_method, and only through it */
} mote_ask;

/* What a method is built for. Everything is borrowed until destroy. */
typedef struct mote_setup {
    const mote_body *body[2];
    double length; /* L of the pair: the larger of the two rest L */
    mote_ask ask;
    double tolerance;     /* the scenario's, absolute, >= 0 */
    uint64_t seed;        /* for methods that draw random numbers */
    const double *values; /* one a parameter of the method, in its table's order */
} mote_setup;

/* Deterministic counts of one query, X(name), in their order in CSV and JSON. */
#define MOTE_COUNTERS(X)                                                                       \
    X(steps)          /* sweeps over all particles */                                          \
    X(moves)          /* particles that moved, over all steps */                               \
    X(positions)      /* vertex positions evaluated */                                         \
    X(box_tests)      /* pairs of bounding volumes tested */                                   \
    X(triangle_tests) /* pairs of triangles measured */

/* Counts that only some methods have; after the contract's columns. */
#define MOTE_COUNTERS_MORE(X)                                                                  \
    X(ended_nmin) /* 1: the query ended because fewer than N_min particles moved */            \
    X(ended_nmax) /* 1: it ended after N_max steps */                                          \
    X(launches)   /* descents started from seeds */                                            \
    X(refined)    /* exact checks made */                                                      \
    X(blocks)     /* certificate: blocks deformed */                                           \
    X(rows)       /* certificate: node against block tests */                                  \
    X(leaf_pairs) /* certificate: leaf pairs reached */

#define MOTE_COUNTER_FIELD(name) uint64_t name;
typedef struct mote_counters {
    MOTE_COUNTERS(MOTE_COUNTER_FIELD)
    MOTE_COUNTERS_MORE(MOTE_COUNTER_FIELD)
} mote_counters;
#undef MOTE_COUNTER_FIELD

/* An answer; zeroed by the caller before each query. What a method does not give stays
   absent (has_... is false). */
typedef struct mote_answer {
    bool has_distance, has_lower, has_witness, has_contact;
    bool contact;         /* distance <= tolerance (+ the method's declared resolution) */
    double distance;      /* >= 0; 0 where the surfaces touch or intersect */
    double lower;         /* a proven lower bound, <= distance */
    mote_vec3 witness[2]; /* world points on body 0 and body 1, distance apart */
    mote_counters counters;
    bool has_penetration; /* only of methods on convex parts, in contact, when asked to */
    double penetration;   /* shortest translation that separates the deepest pair of parts,
                             absolute */
} mote_answer;

/* What a parameterised method needs and keeps. */
typedef struct mote_traits {
    bool needs_field; /* computes with the field itself: refuses bodies of which only positions
                         are known */
    bool uses_field;  /* computes with the field where there is one, even if it wants vertices
                         too */
    bool needs_vertices; /* wants every vertex of the frame in mote_body_state.vertices */
    bool given_vertices; /* wants them too, but nobody is charged for them (positions=given) */
    bool keeps_state;    /* answers may depend on earlier queries (coherence): never strided */
    bool exact;          /* claims the exact distance (checked to 1e-12 L) */
    bool hulls;          /* answers for the hulls of convex parts, not for the surfaces */
    bool samples;        /* builds its trees from the bodies' sample poses too; see mote_body */
} mote_traits;

typedef struct mote_method {
    const char *name;    /* as on the command line: "fcl-aabb" */
    const char *summary; /* one line */
    const mote_parameter *parameters;
    size_t parameter_count;

    /* The traits with these parameter values (borrowed). Never fails. NULL: none is set. */
    mote_traits (*traits)(const double *values);

    /* Builds the state for a pair of bodies. MOTE_EUNSUPPORTED with a reason when the method
       cannot answer setup->ask with these values or on these bodies. NULL: the state is a copy
       of the setup, and destroy is NULL too. */
    mote_status (*create)(const mote_setup *setup, void **state);

    /* NULL state is allowed. */
    void (*destroy)(void *state);

    /* Brings structures up to date with the frame (refit); timed as update_ns. NULL: nothing to
     * do. */
    mote_status (*update)(void *state, const mote_frame *frame);

    /* Answers; timed as query_ns. frame is the one last given to update. No allocation in
       steady state for our own methods. */
    mote_status (*query)(void *state, const mote_frame *frame, mote_answer *answer);

    /* For pictures: the world positions of the particles of body 0 or 1 after the last query,
       whose frame must still be valid. Returns how many there are, and writes at most capacity
       of them. NULL: the method has no particles. */
    size_t (*particles)(const void *state, int body, mote_vec3 *positions, size_t capacity);
} mote_method;

/* The sizes of the structs that a method and its caller share, which plugin.h compares. */
#define MOTE_METHOD_SIZES                                                                      \
    (sizeof(mote_method) + sizeof(mote_setup) + sizeof(mote_frame) + sizeof(mote_answer) +     \
     sizeof(mote_body) + sizeof(mote_mesh) + sizeof(mote_field) + sizeof(mote_field_kind))

#define MOTE_METHOD(id)                                                                        \
    MOTE_PLUGIN_DECLARE const mote_method mote_method_##id;                                    \
    MOTE_PLUGIN_ITEM(MOTE_PLUGIN_METHOD, MOTE_METHOD_SIZES, mote_method_##id)                  \
    const mote_method mote_method_##id

/* The methods that are built in, ended by NULL; written by the build. */
extern const mote_method *const mote_methods[];

/* Call the method's own functions, or do the default where it has none: no traits, a state
   that is a copy of the setup. MOTE_EUNSUPPORTED for a method that needs a field and a body
   that has none. Other errors are the method's; MOTE_ENOMEM. A state is for one thread at a
   time; the caller destroys it. */
mote_traits mote_method_traits(const mote_method *method, const double *values);
mote_status mote_method_create(const mote_method *method, const mote_setup *setup,
                               void **state);
void mote_method_destroy(const mote_method *method, void *state);

/* Makes one more method known to the two functions below. It is borrowed until the program
   ends. To be called before another thread uses them. MOTE_EINVAL: its name is taken, or 64
   have been added. */
mote_status mote_method_add(const mote_method *method);

/* Method number index: first those built in, then those added. NULL past the last. */
const mote_method *mote_method_at(size_t index);

/* The method of that name, or NULL. */
const mote_method *mote_method_find(const char *name);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
