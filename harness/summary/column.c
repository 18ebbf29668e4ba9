#include "harness/summary/column.h"

#include <string.h>

/* Arguments are initialisers, members and parts of texts.
   NOLINTBEGIN(bugprone-macro-parentheses) */
/* For a count that is never 0. */
#define POSITIVE "{\"type\": \"integer\", \"minimum\": 1}"

#define AT(member)                                                                             \
    .offset = offsetof(mote_summary_row, member), .size = sizeof((mote_summary_row *)0)->member
/* Of a member whose size nobody asks for. */
#define POINTER(member) .offset = offsetof(mote_summary_row, member)
/* Positions in the views; engines are 0 where they are not given. */
#define PLACE(...)                                                                             \
    {                                                                                          \
        __VA_ARGS__                                                                            \
    }
#define NOWHERE PLACE(0)

/* A bound of a time's interval: no table shows it by itself. */
#define TIME_BOUND(time, name, member, kept)                                                   \
    {                                                                                          \
        .object = name, .key = kept, .csv = name "_" kept, .type = MOTE_COLUMN_REAL,           \
        .unit = "ns", AT(time.member)                                                          \
    }

/* A statistic of a time beside its median; last its positions, which hold commas. */
#define TIME_STATISTIC(time, name, above, member, kept, below, ...)                            \
    {                                                                                          \
        .object = name, .key = kept, .csv = name "_" kept, .type = MOTE_COLUMN_REAL,           \
        .unit = "ns", AT(time.member), .group = above, .head = below, .show = mote_show_time,  \
        .place = __VA_ARGS__                                                                   \
    }

/* A time: its description, and the positions of its median, mean, 95th percentile and worst
   frame in the tables. */
#define TIME(time, name, above, says, in_report, places, mean_places, p95_places, max_places)  \
    {.object = name,                                                                           \
     .key = "median",                                                                          \
     .csv = name "_median",                                                                    \
     .type = MOTE_COLUMN_REAL,                                                                 \
     .unit = "ns",                                                                             \
     .meaning = says,                                                                          \
     AT(time.median),                                                                          \
     .group = above,                                                                           \
     .head = "median",                                                                         \
     .brief = in_report,                                                                       \
     .show = mote_show_time,                                                                   \
     .interval = true,                                                                         \
     .place = places},                                                                         \
        TIME_BOUND(time, name, low, "ci_low"), TIME_BOUND(time, name, high, "ci_high"),        \
        TIME_STATISTIC(time, name, above, mean, "mean", "mean", mean_places),                  \
        TIME_STATISTIC(time, name, above, p95, "p95", "p95", p95_places),                      \
        TIME_STATISTIC(time, name, above, max, "max", "worst", max_places),                    \
    {                                                                                          \
        .object = name, .key = "sum", .type = MOTE_COLUMN_REAL, .unit = "ns", AT(time.sum)     \
    }

/* A ratio: csv_name is its CSV column and csv_low, csv_high those of its interval; NULL: not in
   the CSV. */
#define RATIO(ratio, name, csv_name, csv_low, csv_high, above, says, in_report, places)        \
    {.object = name,                                                                           \
     .key = "to",                                                                              \
     .type = MOTE_COLUMN_ROW,                                                                  \
     .optional = true,                                                                         \
     .unit = "",                                                                               \
     .meaning = says,                                                                          \
     POINTER(ratio.to)},                                                                       \
        {.object = name,                                                                       \
         .key = "value",                                                                       \
         .csv = csv_name,                                                                      \
         .type = MOTE_COLUMN_REAL,                                                             \
         .unit = "",                                                                           \
         AT(ratio.value),                                                                      \
         .group = above,                                                                       \
         .head = "/ this",                                                                     \
         .brief = in_report,                                                                   \
         .show = mote_show_ratio,                                                              \
         .interval = true,                                                                     \
         .place = places},                                                                     \
        {.object = name,                                                                       \
         .key = "ci_low",                                                                      \
         .csv = csv_low,                                                                       \
         .type = MOTE_COLUMN_REAL,                                                             \
         .unit = "",                                                                           \
         AT(ratio.low)},                                                                       \
    {                                                                                          \
        .object = name, .key = "ci_high", .csv = csv_high, .type = MOTE_COLUMN_REAL,           \
        .unit = "", AT(ratio.high)                                                             \
    }

/* Errors below this are rounding. */
#define ROUNDING 1e-12
/* Values that every run of one program reproduces differ by at most this share. */
#define SAME 1e-9
/* Heap may grow by this share: the allocator rounds. */
#define HEAP_SHARE 0.01

#define ERROR(member, name, says, below, in_report, compared, places)                          \
    {                                                                                          \
        .object = "error", .key = name, .csv = "error_" name, .type = MOTE_COLUMN_REAL,        \
        .unit = "L", .meaning = says, AT(error.member), .group = "error / L", .head = below,   \
        .brief = in_report, .show = mote_show_error, .place = places, .rule = {                \
            compared,                                                                          \
            SAME,                                                                              \
            ROUNDING,                                                                          \
            false,                                                                             \
            true                                                                               \
        }                                                                                      \
    }

#define CONTACTS(member, says, below, in_report, compared, places)                             \
    {                                                                                          \
        .key = #member, .csv = #member, .type = MOTE_COLUMN_REAL, .unit = "frames",            \
        .meaning = says, AT(member), .group = "contacts", .head = below, .brief = in_report,   \
        .show = mote_show_count, .place = places, .rule = {                                    \
            compared,                                                                          \
            SAME,                                                                              \
            0,                                                                                 \
            false,                                                                             \
            true                                                                               \
        }                                                                                      \
    }

#define BYTES(member, says, in_report, compared, places)                                       \
    {                                                                                          \
        .key = #member, .csv = #member, .type = MOTE_COLUMN_WHOLE, .unit = "bytes",            \
        .meaning = says, AT(member), .group = "heap", .head = "live", .brief = in_report,      \
        .show = mote_show_bytes, .place = places, .rule = {                                    \
            compared,                                                                          \
            HEAP_SHARE,                                                                        \
            0,                                                                                 \
            false,                                                                             \
            false                                                                              \
        }                                                                                      \
    }
/* A number of questions about impacts; `first` of its object: without it there is none. Last
   its position in their table; in the report they come behind all others. */
#define IMPACT(member, first, in, says, above, below, shown, at)                               \
    {                                                                                          \
        .object = "impact", .key = #member, .csv = "impact_" #member,                          \
        .type = MOTE_COLUMN_REAL, .optional = first, .unit = in, .meaning = says,              \
        AT(impact.member), .group = above, .head = below, .show = shown,                       \
        .place = PLACE(0, 100 + (at), 0, 0, at)                                                \
    }
/* NOLINTEND(bugprone-macro-parentheses) */

const mote_column mote_columns[] = {
    {.key = "scenario",
     .csv = "scenario",
     .quoted = true,
     .unit = "",
     .meaning = "The scenario's name",
     AT(scenario)},
    {.key = "cache",
     .csv = "cache",
     .unit = "",
     .meaning = "Caches: `hot`, or `evict`, where 32 MB are walked between two frames",
     AT(cache),
     .schema = "{\"enum\": [\"hot\", \"evict\"]}"},
    {.key = "method", .csv = "method", .unit = "", .meaning = "The method's name", AT(method)},
    {.key = "label",
     .csv = "label",
     .quoted = true,
     .unit = "",
     .meaning = "method:key=value,... with the parameters that are not at their default",
     AT(label)},
    {.key = "n",
     .csv = "n",
     .type = MOTE_COLUMN_REAL,
     .unit = "particles",
     .meaning = "The parameter n, of methods that have it",
     AT(n),
     .head = "n",
     .show = mote_show_count,
     .place = PLACE(1, 0, 0)},
    {.key = "stride",
     .csv = "stride",
     .type = MOTE_COLUMN_COUNT,
     .unit = "frames",
     .meaning = "Every k-th frame was measured",
     AT(stride),
     .schema = POSITIVE},
    {.key = "frames",
     .csv = "frames",
     .type = MOTE_COLUMN_COUNT,
     .unit = "frames",
     .meaning = "How many were measured in each replicate",
     AT(frames)},
    {.key = "replicates",
     .csv = "replicates",
     .type = MOTE_COLUMN_COUNT,
     .unit = "processes",
     .meaning = "How many ran to their end",
     AT(finished)},
    {.key = "status",
     .csv = "status",
     .unit = "",
     .meaning = "`ok` if any replicate ended well, otherwise how the worst ended",
     AT(ending),
     .schema = "{\"enum\": [\"ok\", \"crashed\", \"timeout\", \"unsupported\"]}"},
    TIME(total, "total_ns", "total", "Deform, update and query together", "total",
         PLACE(10, 10, 10, 10, 10), PLACE(11, 11, 0, 11, 11), PLACE(12, 12, 0, 12, 12),
         PLACE(13, 13, 0, 13, 13)),
    TIME(deform, "deform_ns", "deform", "Deforming all vertices, for methods that need them",
         NULL, PLACE(14, 93), NOWHERE, NOWHERE, NOWHERE),
    TIME(update, "update_ns", "update", "Updating the structures: the refit", NULL,
         PLACE(15, 94), NOWHERE, NOWHERE, NOWHERE),
    TIME(query, "query_ns", "query", "The query", NULL, PLACE(16, 95), NOWHERE, NOWHERE,
         NOWHERE),
    TIME(active_total, "active_total_ns", "active",
         "The total within the scenario's active interval: near contact", NULL, PLACE(0, 91),
         NOWHERE, NOWHERE, NOWHERE),
    TIME(given_total, "given_total_ns", "given",
         "The total where nobody is charged for deforming all vertices", NULL, PLACE(0, 92),
         NOWHERE, NOWHERE, NOWHERE),
    TIME(read_total, "read_total_ns", "reading",
         "The second accounting: as given_total_ns, and each method that is told the positions "
         "is charged for one pass that only reads those of all bodies, measured in its own "
         "process by the same loop (`read_ns` of its cell), whatever it reads of them itself; "
         "the field is told at no charge. Missing where an older cell has no such pass",
         NULL, PLACE(17, 96), NOWHERE, NOWHERE, NOWHERE),
    RATIO(ratio, "ratio", "ratio", "ratio_ci_low", "ratio_ci_high", "fcl-aabb",
          "How many times slower FCL's AABB tree is (the row `to`), paired frame by frame; for "
          "positions=given, without deformation on both sides",
          "FCL/this", PLACE(20, 20, 0)),
    RATIO(ratio_given, "ratio_given", NULL, NULL, NULL, "given",
          "The same where nobody is charged for deforming all vertices", NULL, PLACE(21, 0, 0)),
    RATIO(ratio_best, "ratio_best", "ratio_best", NULL, NULL, "best FCL",
          "How many times slower the fastest configuration of FCL is, in the same way",
          "best FCL/this", PLACE(22, 22, 20, 20)),
    RATIO(ratio_engine, "ratio_engine", "ratio_engine", NULL, NULL, "engine",
          "How many times slower the fastest engine of others is (FCL, Coal, ODE, Bullet or "
          "Embree; of those with no wrong answer), in the same way",
          "best engine/this", PLACE(23, 23, 21, 21)),
    ERROR(median, "median", "Absolute error: median over frames and replicates", "median", NULL,
          "median", PLACE(30, 30, 0)),
    ERROR(p95, "p95", "Its 95th percentile", "p95", NULL, NULL, PLACE(0, 0, 0)),
    ERROR(p99, "p99", "Its 99th percentile", "p99", "p99 error", "p99", PLACE(31, 31, 0)),
    ERROR(max, "max", "The largest", "max", NULL, "max", PLACE(32, 32, 30)),
    {.object = "error",
     .key = "min_signed",
     .type = MOTE_COLUMN_REAL,
     .unit = "L",
     .meaning = "How far the method's distance is below the truth, or the least above it",
     AT(error.min_signed)},
    {.object = "error",
     .key = "max_signed",
     .type = MOTE_COLUMN_REAL,
     .unit = "L",
     .meaning = "How far it is above the truth",
     AT(error.max_signed)},
    {.object = "error",
     .key = "exact_rate",
     .csv = "exact_rate",
     .type = MOTE_COLUMN_REAL,
     .unit = "share",
     .meaning = "Share of frames with an error of at most 1e-9 L",
     AT(error.exact_rate),
     .group = "exact",
     .head = "frames",
     .brief = "exact",
     .show = mote_show_percent,
     .place = PLACE(40, 40, 40),
     .rule = {"inexact rate", SAME, 0, true, true}},
    {.object = "error",
     .key = "exact_rate_separated",
     .type = MOTE_COLUMN_REAL,
     .unit = "share",
     .meaning = "The same of frames where the bodies are apart",
     AT(error.exact_rate_separated)},
    CONTACTS(contacts,
             "Frames in contact (of more than two bodies: pairs and frames); mean over "
             "replicates; of impacts: questions with one",
             "all", NULL, NULL, PLACE(0, 0, 0, 0, 49)),
    CONTACTS(
        missed,
        "Frames in contact that the method reports as not in contact; mean over replicates. Of "
        "impacts: questions with one, of which the method finds none, or a later one alone",
        "missed", "missed", "missed", PLACE(50, 50, 50, 50, 50)),
    CONTACTS(
        false_contacts,
        "Frames not in contact that the method reports as contacts; mean over replicates. Of "
        "impacts: questions without one",
        "false", "false", "false contacts", PLACE(51, 51, 51, 51, 51)),
    BYTES(heap_live_bytes, "Heap held by the method; the shared rest mesh and field left out",
          "heap", "heap", PLACE(60, 60, 60, 0, 60)),
    BYTES(heap_peak_bytes, "The largest heap that it held", NULL, "heap peak", PLACE(0, 0, 0)),
    BYTES(rss_peak_bytes, "Peak resident memory of the process", NULL, NULL, PLACE(0, 0, 0)),
    {.key = "machine",
     .csv = "machine",
     .quoted = true,
     .optional = true,
     .unit = "",
     .meaning = "The machine that measured; rows of different machines are never compared",
     AT(machine)},
    {.key = "replicates_failed",
     .csv = "replicates_failed",
     .type = MOTE_COLUMN_COUNT,
     .unit = "processes",
     .meaning = "How many did not run to their end; no value of the row includes them",
     AT(failed),
     .rule = {"failed replicates", 0, 0, false, false}},
    {.key = "jobs",
     .csv = "jobs",
     .type = MOTE_COLUMN_COUNT,
     .unit = "processes",
     .meaning = "How many cells ran at the same time",
     AT(jobs),
     .schema = POSITIVE},
    {.key = "fingerprint",
     .csv = "fingerprint",
     .unit = "",
     .meaning = "Hash of the deformed vertices of all frames: which scene was measured",
     AT(fingerprint)},
    {.key = "scene",
     .csv = "scene",
     .quoted = true,
     .unit = "",
     .meaning =
         "The scenario's name, and what distinguishes it from another scene of that name",
     AT(scene)},
    {.key = "accounting",
     .csv = "accounting",
     .unit = "",
     .meaning =
         "`charged` for deformation as far as the method needs it, or `given` all vertices "
         "at no charge (positions=given); only rows of one accounting are compared",
     AT(accounting),
     .schema = "{\"enum\": [\"charged\", \"given\"]}"},
    {.key = "told",
     .csv = "told",
     .optional = true,
     .unit = "",
     .meaning =
         "What the method was told of the deformation: the `field` and its weights, from "
         "which it computes what it looks at, or the `positions` of all vertices. Left out "
         "where an older cell does not say",
     AT(told),
     .schema = "{\"enum\": [\"field\", \"positions\"]}"},
    {.key = "on_front",
     .csv = "on_front",
     .type = MOTE_COLUMN_FLAG,
     .unit = "",
     .meaning =
         "No other row is surely faster and no worse in p99, in the largest error, in the "
         "share of exact frames, in missed and in false contacts",
     AT(on_front)},
    {.key = "dominated_by",
     .type = MOTE_COLUMN_ROW,
     .csv = "dominated_by",
     .quoted = true,
     .optional = true,
     .unit = "",
     .meaning = "Label of the fastest row that is faster and no worse",
     POINTER(dominated_by)},
    {.key = "stands_for_method",
     .type = MOTE_COLUMN_FLAG,
     .unit = "",
     .meaning = "Shown where there is room for one row a method: the fastest without a wrong "
                "contact and with p99 of at most 0.01 L, or else the most accurate",
     AT(stands_for_method)},
    {.key = "parameters",
     .type = MOTE_COLUMN_OBJECT,
     .unit = "",
     .meaning = "Every parameter with its value, defaults included",
     POINTER(parameters),
     .schema = "{\"type\": \"object\"}"},
    {.key = "triangles",
     .type = MOTE_COLUMN_COUNTS,
     .unit = "",
     .meaning = "Of each body; of more than two, of the smallest and of the largest shape",
     AT(triangles)},
    {.key = "vertices",
     .type = MOTE_COLUMN_COUNTS,
     .unit = "",
     .meaning = "Of each body; of more than two, of the smallest and of the largest shape",
     AT(vertices)},
    {.key = "bodies",
     .type = MOTE_COLUMN_COUNT,
     .optional = true,
     .unit = "",
     .meaning = "How many there are, where they are not two",
     AT(bodies),
     .schema = POSITIVE},
    {.key = "shapes",
     .type = MOTE_COLUMN_COUNT,
     .optional = true,
     .unit = "",
     .meaning = "How many shapes these have",
     AT(shapes),
     .schema = POSITIVE},
    {.key = "near_pairs_wanted",
     .type = MOTE_COLUMN_REAL,
     .of_scenes = true,
     .unit = "pairs",
     .meaning = "Near pairs a body that the scenario asks for; null: it gives a box",
     AT(near_pairs_wanted)},
    {.key = "near_pairs",
     .type = MOTE_COLUMN_REAL,
     .of_scenes = true,
     .unit = "pairs",
     .meaning = "Near pairs that were queried: mean over frames",
     AT(near_pairs)},
    {.key = "contacts_of",
     .type = MOTE_COLUMN_ROW,
     .optional = true,
     .unit = "",
     .meaning = "Label of the exact row whose contacts count as true, where there is no truth",
     POINTER(contacts_of)},
    {.key = "seed",
     .type = MOTE_COLUMN_COUNT,
     .unit = "",
     .meaning = "The run's seed",
     AT(seed)},
    {.key = "frame_range",
     .type = MOTE_COLUMN_COUNTS,
     .unit = "",
     .meaning = "First and last frame requested; 0 if the cells do not say",
     AT(frame_range)},
    {.key = "ask",
     .optional = true,
     .unit = "",
     .meaning = "What each frame is asked: `distance`, `contact` or `impact`",
     AT(ask),
     .schema = "{\"enum\": [\"distance\", \"contact\", \"impact\"]}"},
    {.key = "tolerance",
     .type = MOTE_COLUMN_REAL,
     .optional = true,
     .unit = "",
     .meaning = "How far apart bodies in contact may be",
     AT(tolerance),
     .schema = "{\"type\": \"number\"}"},
    {.key = "reason",
     .optional = true,
     .unit = "",
     .meaning = "Why there are no values, where the status is not `ok`",
     AT(reason)},
    {.key = "times_comparable",
     .type = MOTE_COLUMN_FLAG,
     .unit = "",
     .meaning =
         "False where cells ran at the same time (`--jobs`): no ratio is made of such times",
     AT(times_comparable)},
    {.key = "smallest_change",
     .type = MOTE_COLUMN_REAL,
     .unit = "share",
     .meaning = "The smallest change of its time that a comparison with a run like this one "
                "detects four times in five",
     AT(smallest_change)},
    {.key = "counters",
     .type = MOTE_COLUMN_COUNTERS,
     .unit = "",
     .meaning = "Mean and largest of each deterministic count over the frames",
     POINTER(counts)},
    {.key = "processes",
     .type = MOTE_COLUMN_PROCESSES,
     .unit = "",
     .meaning =
         "Each replicate: the median of its total, its paired ratio to fcl-aabb, the sums of "
         "its counts",
     POINTER(processes)},
    {.object = "quiet",
     .key = "total_ns",
     .type = MOTE_COLUMN_NUMBERS,
     .unit = "ns",
     .meaning = "Of each frame the fastest of a fifth of the replicates, then the median over "
                "frames; null below ten replicates",
     AT(quiet.total)},
    {.object = "quiet",
     .key = "ratio",
     .type = MOTE_COLUMN_NUMBERS,
     .unit = "",
     .meaning = "Likewise how many times slower fcl-aabb is; null below ten replicates",
     AT(quiet.ratio)},
    {.key = "step",
     .csv = "step",
     .type = MOTE_COLUMN_COUNT,
     .optional = true,
     .unit = "frames",
     .meaning = "Where impacts are asked for: the frames that each question spans",
     AT(step),
     .schema = POSITIVE},
    IMPACT(
        undecided, true, "questions",
        "Questions about impacts that the method leaves open: it grazes, has given up, or has "
        "failed; mean over replicates",
        "contacts", "open", mote_show_count, 52),
    IMPACT(
        bracket, false, "share",
        "The widest bracket of an impact: from the time before which the method knows none to "
        "that of the impact, as a part of the question's time",
        "impact", "bracket", mote_show_error, 40),
    IMPACT(delay, false, "frames",
           "How far a time of impact is from that of the first one at most, in frames",
           "impact", "delay", mote_show_error, 41),
    IMPACT(iterations_median, false, "moments",
           "Moments at which the method looked at the bodies: median over the questions",
           "iterations", "median", mote_show_count, 30),
    IMPACT(iterations_p95, false, "moments", "Their 95th percentile", "iterations", "p95",
           mote_show_count, 31),
    {.key = "faces",
     .csv = "faces",
     .optional = true,
     .unit = "",
     .meaning = "Hash of the triangles, which `fingerprint` does not cover. Left out where an "
                "older cell does not say",
     AT(faces)},
    {.key = "seeds",
     .csv = "seeds",
     .optional = true,
     .unit = "",
     .meaning =
         "`own` if each replicate draws random numbers of its own, `fixed` if all draw the "
         "same (`--fixed-seed`). Left out where an older cell does not say",
     AT(seeds),
     .schema = "{\"enum\": [\"own\", \"fixed\"]}"},
    {.key = "active",
     .type = MOTE_COLUMN_COUNTS,
     .optional = true,
     .unit = "",
     .meaning =
         "First and last frame of the active interval, of which `active_total_ns` is; 0 if "
         "there is none",
     AT(active)},
    {.key = "heap_bytes_per_vertex",
     .csv = "heap_bytes_per_vertex",
     .type = MOTE_COLUMN_REAL,
     .unit = "bytes",
     .meaning = "Heap held by the method over the vertices of all bodies",
     AT(heap_bytes_per_vertex)},
    {.object = "least_ns",
     .key = "median",
     .csv = "least_ns_median",
     .type = MOTE_COLUMN_REAL,
     .unit = "ns",
     .meaning =
         "Of each frame the fastest of all replicates, then the median over frames; for "
         "positions=given, without deformation. Compare only rows of equally many replicates",
     AT(least.median)},
    {.object = "least_ns",
     .key = "settled_sum",
     .csv = "least_ns_settled_sum",
     .type = MOTE_COLUMN_REAL,
     .unit = "ns",
     .meaning =
         "Their sum: from the 50th frame measured on, if there are 60 or more, since before, a "
         "method may still build what it needs; otherwise over all frames",
     AT(least.settled_sum)},
};
const size_t mote_column_count = sizeof mote_columns / sizeof mote_columns[0];

static bool same_name(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

const mote_column *mote_column_find(const char *object, const char *key)
{
    for (size_t i = 0; i < mote_column_count; ++i) {
        if (same_name(mote_columns[i].object, object) && strcmp(mote_columns[i].key, key) == 0)
            return &mote_columns[i];
    }
    return NULL;
}

size_t mote_column_view(mote_view view, const mote_column *columns[MOTE_VIEW_MAX])
{
    size_t count = 0;
    for (size_t i = 0; i < mote_column_count && count < MOTE_VIEW_MAX; ++i) {
        const mote_column *column = &mote_columns[i];
        if (column->place[view] == 0)
            continue;
        size_t k = count++;
        for (; k > 0 && columns[k - 1]->place[view] > column->place[view]; --k)
            columns[k] = columns[k - 1];
        columns[k] = column;
    }
    return count;
}
