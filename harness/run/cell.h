/* A cell: one (scenario, method, parameters, replicate), measured in its own process and stored
   as cells/ID.json and, if it ran to its end, cells/ID.csv; for more than two bodies also
   cells/ID.pairs.csv. */
#ifndef MOTE_HARNESS_CELL_H
#define MOTE_HARNESS_CELL_H

#include "harness/base/method_choice.h"
#include "harness/base/heap_count.h"
#include "harness/run/subject.h"

#include <jansson.h>

typedef enum mote_cache {
    MOTE_CACHE_HOT,  /* each frame directly after the previous one */
    MOTE_CACHE_EVICT /* 32 MB are read between frames, outside the timing */
} mote_cache;

extern const char *const mote_cache_names[]; /* "hot", "evict" */

typedef enum mote_cell_status {
    MOTE_CELL_OK,
    MOTE_CELL_CRASHED,     /* its process crashed, or the method failed in a frame */
    MOTE_CELL_TIMEOUT,     /* it was ended at the time limit */
    MOTE_CELL_UNSUPPORTED, /* the method cannot answer what the scenario asks */
    MOTE_CELL_STATUSES
} mote_cell_status;

extern const char *const mote_cell_status_names[]; /* "ok", "crashed", ... */

/* The stride asked for. MOTE_STRIDE_AUTO is every frame for a method that keeps state or is
   fast; otherwise every 16th. */
#define MOTE_STRIDE_AUTO 0u
#define MOTE_STRIDE_SLOW 16u
#define MOTE_STRIDE_SLOW_NS 10e6

#define MOTE_CELL_ID_SIZE 96

/* The number of frames that a cell measures at least, however small its budget. */
#define MOTE_CELL_LEAST_FRAMES 3

#define MOTE_SEED_MAX (((uint64_t)1 << 62) - 1)

/* The seed of a replicate (from 1) in a run with this seed. */
static inline uint64_t mote_replicate_seed(uint64_t seed, bool fixed, uint32_t replicate)
{
    return seed + (fixed ? 0 : replicate - 1);
}

typedef struct mote_cell {
    const mote_subject *subject;      /* borrowed */
    const mote_method_choice *choice; /* borrowed */
    uint32_t replicate;               /* from 1 */
    uint32_t first, last;             /* frames, inclusive */
    uint32_t step;         /* of a subject that asks for impacts: the frames that each
                              question spans; else 0 */
    uint32_t stride_asked; /* MOTE_STRIDE_AUTO or the stride */
    uint32_t stride;       /* the one used, >= 1 */
    uint64_t seed;         /* the run's, at most MOTE_SEED_MAX */
    bool fixed_seed;       /* every replicate uses it */
    mote_cache cache;
    uint32_t
        jobs; /* cells measured at the same time; with 2 or more, times are not comparable */
    double budget;      /* for more than two bodies: seconds after which no further frame begins
                           once MOTE_CELL_LEAST_FRAMES are done; 0: none */
    bool contacts_only; /* for more than two bodies: ID.pairs.csv lists only contacts */
    char id[MOTE_CELL_ID_SIZE];
} mote_cell;

/* How many frames a cell measures, each the first of a question's; 0 where its frames do not
   hold a step. */
uint32_t mote_cell_rows(const mote_cell *cell);

/* Sets cell->id: a readable beginning, then a hash of everything that determines the
   measurement: both hashes of the scenario, the question, method, every parameter, replicate,
   frames, the active interval, step, stride asked, seed, cache, whether other cells ran at the
   same time, and program (mote_program_hash). */
void mote_cell_name(mote_cell *cell, uint64_t program);

/* X(name): further columns of cells/ID.csv for more than two bodies. The time of motion (poses
   and weights) is charged to no method; bounds_ns and broad_ns are part of query_ns. */
#define MOTE_SCENE_COLUMNS(X)                                                                  \
    X(motion_ns)                                                                               \
    X(bounds_ns)  /* boxes of all bodies */                                                    \
    X(broad_ns)   /* near pairs by the boxes, and by those of parts */                         \
    X(near_pairs) /* not shown by them to be more than the scenario's `near` apart */          \
    X(new_pairs)  /* those that were not near in the previous frame */                         \
    X(pair_contacts)

typedef struct mote_scene_row {
#define MOTE_SCENE_FIELD(name) uint64_t name;
    MOTE_SCENE_COLUMNS(MOTE_SCENE_FIELD)
#undef MOTE_SCENE_FIELD
} mote_scene_row;

/* Their indices: MOTE_SCENE_COLUMN_near_pairs. */
enum {
#define MOTE_SCENE_PLACE(name) MOTE_SCENE_COLUMN_##name,
    MOTE_SCENE_COLUMNS(MOTE_SCENE_PLACE)
#undef MOTE_SCENE_PLACE
        MOTE_SCENE_COLUMN_COUNT
};

extern const char *const mote_scene_column_names[MOTE_SCENE_COLUMN_COUNT];

/* X(name): further columns of cells/ID.csv where impacts are asked for. Times are parts of the
   time from the row's frame to that of the question's end, 0 .. 1; empty where there is no
   impact. */
#define MOTE_IMPACT_COLUMNS(X)                                                                 \
    X(from)       /* no impact before, as far as the method knows */                           \
    X(to)         /* the impact */                                                             \
    X(to_truth)   /* when the first impact is */                                               \
    X(iterations) /* moments at which the method looked at the bodies */

/* Their indices: MOTE_IMPACT_COLUMN_from. */
enum {
#define MOTE_IMPACT_PLACE(name) MOTE_IMPACT_COLUMN_##name,
    MOTE_IMPACT_COLUMNS(MOTE_IMPACT_PLACE)
#undef MOTE_IMPACT_PLACE
        MOTE_IMPACT_COLUMN_COUNT
};

extern const char *const mote_impact_column_names[MOTE_IMPACT_COLUMN_COUNT];

/* The result of one frame. For more than two bodies the answer is that of the closest near
   pair; contact says whether any pair is in contact, and counters are sums over the pairs. */
typedef struct mote_cell_row {
    uint32_t frame;
    uint64_t deform_ns, update_ns, query_ns; /* 0 for what the method does not need */
    uint64_t allocations;                    /* during update and query */
    mote_answer answer; /* of an impact: contact says whether there is one */
    mote_scene_row scene;
    mote_impact_answer impact;
} mote_cell_row;

/* The result of a whole cell. */
typedef struct mote_cell_result {
    mote_cell_row *rows;
    size_t row_count;
    uint64_t build_ns;  /* create, and the tables of full deformation if charged */
    uint64_t clock_ns;  /* reading the clock, subtracted from every time */
    double overhead_ns; /* the overhead of clock and bookkeeping that remains in every time */
    bool heap_counted;
    int64_t heap_live_bytes,
        heap_peak_bytes;  /* of the method, without the shared mesh and field */
    int64_t deform_bytes; /* of these: tables and vertices of full deformation */
    int64_t rss_peak_bytes;
    int core;            /* that the process is pinned to, or -1 */
    double load[2];      /* load average before and after */
    double clock_mhz[2]; /* of the core, before and after; 0: unknown */
    double wall_seconds; /* of the process */
    double read_ns; /* reading the positions of all bodies once, after the last frame; 0 for a
                       method that is told the field */
    uint64_t
        frames_wall_ns; /* more than two bodies: all frames, including motion and recording */
} mote_cell_result;

/* Whether the method is told where the vertices are, and not the field. For more than two
   bodies, trees are given positions, but fields decide which bodies need them, unless all are
   refitted. */
bool mote_cell_told_positions(const mote_cell *cell);

/* Writes both files of a completed cell, the CSV first. */
mote_status mote_cell_record(const mote_cell *cell, const mote_cell_result *result,
                             uint64_t program, const char *directory);

/* How a cell failed. */
typedef struct mote_cell_failure {
    mote_cell_status status;
    const char *reason;     /* one line */
    double timeout_seconds; /* the limit that it exceeded; 0: none */
} mote_cell_failure;

/* Writes the JSON of a cell that failed. */
mote_status mote_cell_record_failure(const mote_cell *cell, const mote_cell_failure *failure,
                                     uint64_t program, const char *directory);

/* Every parameter with its value, including defaults: numbers as numbers; choices, "auto" and
   "inf" as text. of_scene: also those of mote_scene_parameters. The caller decrefs. */
json_t *mote_choice_json(const mote_method_choice *choice, bool of_scene);

#endif
