/* Numerical extremes: scenes of two small bodies over a few frames in which numbers become
   tiny, huge, equal or degenerate, their distance in 113 bits, and the verdict on each method's
   answers. */
#ifndef MOTE_HARNESS_EXTREME_H
#define MOTE_HARNESS_EXTREME_H

#include "core/method/method.h"
#include "core/base/quaternion.h"

#define MOTE_EXTREME_FRAMES 4
#define MOTE_EXTREME_CONTROLS 16
#define MOTE_EXTREME_VERTICES 256
#define MOTE_EXTREME_TRIANGLES 512

/* A scene as numbers, which a family of extremes modifies before bodies are made. Two bodies,
   MOTE_EXTREME_FRAMES frames. */
typedef struct mote_extreme_recipe {
    uint32_t vertex_count[2], triangle_count[2];
    mote_vec3 position[2][MOTE_EXTREME_VERTICES];
    uint32_t triangle[2][MOTE_EXTREME_TRIANGLES][3];
    mote_vec3 middle[2]; /* in the rest mesh: the point that place positions and that rotations
                            keep fixed */
    uint32_t controls;   /* per body; 0: no deformation */
    mote_vec3 centre[2][MOTE_EXTREME_CONTROLS];
    double support; /* absolute */
    bool direct;    /* move holds weights, not displacements to be fitted */
    mote_vec3 move[2][MOTE_EXTREME_FRAMES][MOTE_EXTREME_CONTROLS]; /* in the body's axes */
    mote_quaternion turn[2][MOTE_EXTREME_FRAMES];
    mote_vec3 place[2][MOTE_EXTREME_FRAMES];
} mote_extreme_recipe;

/* A scene with bodies. */
typedef struct mote_extreme {
    const char *family;     /* "scale"; static */
    char label[24];         /* "10^-12": unique within its family */
    const char *parameters; /* "n=1", for methods that have the key; NULL: none */
    char refusal[256];      /* why the input was refused; there are then no bodies */
    mote_mesh *mesh[2];
    mote_field *field[2];
    mote_body body[2];
    mote_frame frame[MOTE_EXTREME_FRAMES];
    double *weights[2][MOTE_EXTREME_FRAMES]; /* memory of the weights in the frames */
    double length;                           /* L of the pair */
    double condition;                        /* of the worse of the two fields' fits; 0: no
                                                fit */
    /* For each frame: the distance between the vertices as doubles, computed in 113 bits, and
       the distance with unrounded vertices. The difference is what 64 bits cost every
       method. */
    double truth[MOTE_EXTREME_FRAMES], unrounded[MOTE_EXTREME_FRAMES];
    double coordinate_max; /* largest coordinate of a vertex in any frame */
} mote_extreme;

/* Makes bodies from a recipe. If the mesh, the field or its fit is refused, e->refusal is set;
   that is not an error. family and label are not changed. Free e even after an error. */
mote_status mote_extreme_make(const mote_extreme_recipe *recipe, mote_extreme *e);
void mote_extreme_free(mote_extreme *e);

/* The scene that all families modify: letters T and V of 400 triangles, L about 1, eight
   control points each; apart, near, nearer and intersecting. */
mote_status mote_extreme_plain(mote_extreme_recipe *recipe);

/* Moves body 1 of a frame along the line of closest points until the bodies are a gap apart
   (absolute, to a thousandth where double precision allows). gap < 0: on from there, by -gap.
   Does nothing if bodies that should be apart intersect. */
mote_status mote_extreme_set_gap(mote_extreme_recipe *recipe, uint32_t frame, double gap);

/* Fills truth, unrounded and coordinate_max: brute force over all pairs of triangles, skipping
   only those whose boxes are too far apart. */
void mote_extreme_measure(mote_extreme *e);

/* The squared distance of a point from body b's surface at a frame, in 113 bits. */
double mote_extreme_surface(const mote_extreme *e, uint32_t frame, int b, mote_vec3 point);

/* A family: it makes recipes for k = first .. last. */
typedef struct mote_extreme_family {
    const char *name, *what; /* what is extreme, in one line */
    int first, last;
    int quick;                /* step of k in the quick profile */
    const char *const *names; /* labels by k - first; NULL: "10^k" */
    mote_status (*change)(const mote_extreme_recipe *plain, int k, mote_extreme_recipe *made);
    const char *const *parameters; /* by k - first, or NULL */
} mote_extreme_family;

extern const mote_extreme_family mote_extreme_families[];
extern const size_t mote_extreme_family_count;

/* The label of one extreme of a family. */
void mote_extreme_label(const mote_extreme_family *family, int k, char *label, size_t size);

typedef enum mote_extreme_verdict {
    MOTE_EXTREME_NONE,    /* the method has no such parameter: not run */
    MOTE_EXTREME_RIGHT,   /* within 1e-12 L */
    MOTE_EXTREME_INEXACT, /* to the extent that the method allows */
    MOTE_EXTREME_REFUSED, /* an error with a text instead of an answer */
    MOTE_EXTREME_WRONG,   /* contrary to what the method promises */
    MOTE_EXTREME_NAN,     /* an answer that is not finite */
    MOTE_EXTREME_HUNG,    /* no answer within the time limit */
    MOTE_EXTREME_CRASHED,
    MOTE_EXTREME_VERDICTS
} mote_extreme_verdict;

extern const char *const mote_extreme_verdicts[];

/* The result of a method on a scene. */
typedef struct mote_extreme_cell {
    mote_extreme_verdict verdict; /* the worst over all frames */
    double error;      /* (answer - truth) / L, the largest in magnitude over the frames; 0: no
                          distance */
    uint32_t frame;    /* frame of that error, from 1; 0: there is no answer */
    char reason[256];  /* for all verdicts except none and right */
    uint64_t build_ns; /* until the first frame */
    uint64_t query_ns; /* per frame, including deformation and refit: the median */
} mote_extreme_cell;

/* Runs a method (by name) over all frames in its own process with 10 seconds of processor time
   and 1 GiB, and judges its answers. A method that answers only contacts is asked for those. An
   error means that no process could be created. */
mote_status mote_extreme_run(const mote_extreme *e, const char *method,
                             mote_extreme_cell *cell);

/* A method's answer for one frame. */
typedef struct mote_extreme_said {
    bool exact;        /* it claims an exact distance */
    bool hulls;        /* it answers for convex hulls of the parts */
    bool single;       /* it computes positions in 32 bits */
    bool contact_only; /* it was asked for the contact */
    mote_answer answer;
} mote_extreme_said;

/* Judges one answer; *error is (answer - truth) / L, 0 for a contact. reason: size bytes. */
mote_extreme_verdict mote_extreme_judge(const mote_extreme *e, uint32_t frame,
                                        const mote_extreme_said *said, double *error,
                                        char *reason, size_t size);

#endif
