/* The state of a streamed query: what core/stream's files share.

   Coordinates of a query are scale * (position - origin), origin being the middle of the first
   witnesses. Boxes of groups are in world axes, relative to their own body's origin; leaves and
   their points in the gap's axes, the first of which points from witness 0 to witness 1.

   Margins, with u = 2^-24 and B a bound on the length of any vertex's coordinate vector:
   - A box of a group has numbers that are wrong by u B each, and u B in all three together
     (stream_boxes.c); moved to the other body's origin, by 2 u B more in each: the vector from
     one box to another is wrong by at most 2 u B + 4 sqrt(3) u B < 9 u B.
   - A leaf's points are exact differences rounded to floats, which moves each by at most u B,
     and turned in single precision: three products and two sums a coordinate, wrong by at most
     3 u B each (Cauchy-Schwarz on the absolute values). The vector between two leaves' boxes,
   or points, is wrong by at most 2 (1 + 3 sqrt(3)) u B < 13 u B. The axes are rounded too,
   which changes the length of a turned vector by at most 2 u of itself.
   - Sums over the points along a direction w: 3 u B |w| for each leaf, and 2 u B |w| for their
     sum: with the points' own, 21 u B |w|.
   margin is 32 u B: boxes are tested against the limit plus margin, points with loose = margin
   in each coordinate, since sum |w_k| >= |w|. Rounding of the axes and of the last operations
   of each test is relative, and covered by factors of 1 + 2^-20 (of certificate_hulls.h: 1 +
   2^-18). B is taken to be at least 2^-6, so that no square that decides is subnormal, and a
   query with B of 2^60 or more is refused, so that none overflows. */
#ifndef MOTE_CORE_STREAM_STATE_H
#define MOTE_CORE_STREAM_STATE_H

#include "core/body/lazy.h"
#include "core/particle/refine.h"
#include "core/stream/stream.h"
#include "core/stream/stream_boxes.h"

/* What a pair keeps from one query to the next. Zeroed before the first. */
typedef struct mote_stream_memory {
    uint32_t last[2][3]; /* faces of the last query's witnesses */
    double distance;     /* between them */
    bool has_last;
} mote_stream_memory;

/* Leaves whose points are kept during a query, each at its number modulo this: eight groups. */
#define MOTE_STREAM_SLOTS 64

/* Points of a leaf in the gap's axes. */
typedef struct mote_stream_slot {
    float x[3][MOTE_CERT_POINTS];
    float low[3], high[3];
    float face_low[3][MOTE_STREAM_LEAF]; /* boxes of the faces; infinite where there is none */
    float face_high[3][MOTE_STREAM_LEAF];
    uint32_t leaf, stamp; /* the query; another: empty */
    uint32_t groups;      /* of WIDTH points */
    bool boxed;           /* the faces' boxes are made */
    bool averaged;        /* normal is */
    float normal[3];      /* the mean of the faces: its largest number is 1, or all are 0 */
    uint32_t reach_stamp; /* the direction that reach belongs to; 0: none */
    double reach;         /* the largest coordinate towards the other body, exact to noise */
} mote_stream_slot;

/* One body of a query. */
typedef struct mote_stream_side {
    mote_stream_body *body;
    mote_lazy lazy;
    uint64_t evaluated;        /* by lazy before the query */
    float offset[3];           /* of the body's origin from the query's */
    mote_stream_block *leaves; /* [groups]: boxes of the leaves of groups that were opened */
    mote_stream_box *groups;   /* [groups]: around them, in the gap's axes */
    uint32_t *opened;          /* [groups]: the query in which they were */
    mote_stream_slot *slots;   /* [MOTE_STREAM_SLOTS] */
    uint32_t room;             /* groups that there is memory for */
} mote_stream_side;

/* A pair of nodes, one of each tree, and the squared distance of their boxes. */
typedef struct mote_stream_pair {
    uint32_t node[2];
    uint8_t level[2]; /* height + 1: leaves */
    float squared;
} mote_stream_pair;

/* Opening a node replaces a pair by at most 8, opening two groups by at most 64. */
#define MOTE_STREAM_STACK (2 * MOTE_STREAM_LEVELS * 7 + 64)

/* What one query needs, of any two bodies whose trees are no larger than it was made for. */
typedef struct mote_stream_search {
    mote_stream_options options;
    mote_stream_side side[2];
    uint32_t stamp; /* of the query; never 0 */
    mote_refined best;
    double upper;  /* distance of best, absolute */
    double enough; /* a contact question's tolerance, or negative; absolute */
    double slack;  /* absolute */
    double scale;
    mote_vec3 origin;
    float turn[3][3]; /* the gap's axes, by row: unit vectors, rounded */
    mote_vec3 toward; /* a unit vector from witness 0 to witness 1, about the first axis */
    double margin;
    double noise;  /* rounding error of coordinates in double precision */
    double limit;  /* to be proven, in the query's coordinates: no pair is nearer */
    float need;    /* the same, rounded up: of points */
    float squared; /* of boxes: (limit + margin)^2, rounded up */
    float loose[3];
    uint32_t aim; /* stamp of toward; never 0 */
    bool has_direction;
    float direction[3]; /* the last that separated two leaves, in the gap's axes */
    uint32_t searches;  /* for such a direction, before the faces were boxed */
    uint32_t separated; /* ... with success */
    bool done;          /* the answer is known: contact, or near enough */
    bool stopped;       /* the budget is spent */
    double unvisited;   /* smallest bound of the pairs left then */
    uint32_t pending;
    mote_stream_pair stack[MOTE_STREAM_STACK];
    mote_counters counters;
} mote_stream_search;

/* stream_search.c */

/* room: groups of the largest tree. MOTE_ENOMEM. Free with mote_stream_search_free, also after
   a failure. */
mote_status mote_stream_search_init(mote_stream_search *s, const mote_stream_options *options,
                                    const mote_body *const largest[2], const uint32_t room[2]);
void mote_stream_search_free(mote_stream_search *s);
size_t mote_stream_search_bytes(const mote_stream_search *s);

/* Finds the first upper bound: from the last faces, slid downhill. False where the two have
   leapt apart, or there are none. */
bool mote_stream_seed(mote_stream_search *s, mote_stream_body *const body[2],
                      const mote_stream_memory *memory, double enough);

/* The middle of the witnesses and the scale that boxes made now should have. */
void mote_stream_choose(mote_stream_search *s);

/* Proves the seed's distance, or finds a smaller one. The boxes of both bodies are placed.
   leapt: looks for a nearer pair by the boxes first. MOTE_EINVAL: 10^18 times too far apart. */
mote_status mote_stream_prove(mote_stream_search *s, bool leapt);

/* Writes the answer, and what the next query starts from. */
void mote_stream_write(const mote_stream_search *s, mote_stream_memory *memory,
                       mote_certificate_answer *answer);

/* Sets the upper bound and what follows from it. */
void mote_stream_set_best(mote_stream_search *s, double squared);

/* stream_descend.c */

/* Looks for a nearer pair of faces from the boxes alone. */
void mote_stream_find_anew(mote_stream_search *s);

/* stream_traverse.c */

/* Traverses both trees for pairs nearer than the limit. */
void mote_stream_traverse(mote_stream_search *s);

/* Squared distances of a box to those of a block; infinite for a lane without a child. */
void mote_stream_distances(const mote_stream_box *box, const mote_stream_block *block,
                           float squared[MOTE_STREAM_WIDTH]);

/* The box of a node of side `from`, relative to the origin of the other side's body. */
mote_stream_box mote_stream_moved_box(const mote_stream_search *s, int from, uint32_t level,
                                      uint32_t node);

/* The longest edge of a box. */
float mote_stream_size(const mote_stream_box *box);

/* stream_leaf.c */

/* The points of a leaf; valid until another leaf of that side is asked for. */
mote_stream_slot *mote_stream_leaf(mote_stream_search *s, int side, uint32_t leaf);

/* The boxes of a group's leaves, made when first asked for in a query. */
const mote_stream_block *mote_stream_open_group(mote_stream_search *s, int side,
                                                uint32_t group);

/* How far a leaf reaches towards the other body along the gap. */
double mote_stream_reach(mote_stream_search *s, int side, mote_stream_slot *slot);

/* stream_faces.c */

/* The pairs of faces of two leaves whose boxes are nearer than the limit; returns how many. */
uint32_t mote_stream_near_faces(const mote_stream_search *s, mote_stream_slot *const slot[2],
                                mote_cert_near *near);

/* The mean normal of a leaf's faces, in the gap's axes. */
const float *mote_stream_normal(const mote_stream_search *s, int side, mote_stream_slot *slot);

/* stream_pair.c */

/* Decides about two leaves: shows that they are far enough apart, or measures their faces. */
void mote_stream_leaf_pair(mote_stream_search *s, const uint32_t leaf[2]);

#endif
