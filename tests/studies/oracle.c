/* The oracle study: the distance of two triangles by our kernel, by FCL and by libccd, on
   random pairs that are mostly hard. Contact is judged by exact arithmetic, distance by 113
   bits.

       oracle [--pairs N] [--seed S] [--stride K] [--agreement A] [--out FILE.json]
              [--method NAME[:key=value,...]]... [--plugin FILE]... [--timeout SECONDS]
              [--scenario NAME]...

   With a stride, it also checks whether two methods agree to A L (1e-12) on every K-th frame of
   scenarios of two bodies (ww, tt and mv). Any other method, also one of a shared library, is
   compared with these distances, in a process of its own; with --method, the stride is 1 and no
   pairs are judged unless they are asked for.

   Prints tables; exit status 1 when a requirement is not met: our kernel has no wrong contact
   in the strict band and no error above 1e-15 of the pair's extent, and aabb-tree is right in
   every frame. Verdicts are counted in three bands: strict (apart, or overlapping, by more than
   1e-15 of the extent), touching (overlapping by less), near (apart by less). The pairs do not
   depend on the number of threads. A method that was asked for is right in every frame, too. */
#include "tests/support/peers/ccd_triangle.h"
#include "tests/support/peers/fcl_triangle.h"
#include "core/body/triangle.h"
#include "harness/base/json_print.h"
#include "harness/process/plugin.h"
#include "tests/studies/oracle_exact.h"
#include "tests/studies/oracle_frames.h"
#include "tests/support/triangle_pairs.h"
#include "baselines/wide_triangle.h"

#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* Half the width of the band that is not strict, and the largest error allowed, over the
   extent. */
#define BAND 1e-15

typedef enum band { BAND_STRICT, BAND_TOUCHING, BAND_NEAR, BANDS } band;

static const char *const band_names[BANDS] = {"strict", "touching", "near"};

/* One way to measure a pair: returns its distance, or 0 or 1 if it reports contact only. */
typedef struct engine {
    const char *name, *what;
    bool has_distance;
    double (*measure)(const mote_vec3 s[3], const mote_vec3 t[3]);
} engine;

static double by_mote(const mote_vec3 s[3], const mote_vec3 t[3])
{
    return sqrt(mote_triangle_triangle(s, t, NULL, NULL));
}

/* As in our FCL baselines: scaled to a size of about 2^20, far above FCL's absolute
   threshold. */
static double by_fcl_scaled(const mote_vec3 s[3], const mote_vec3 t[3])
{
    mote_vec3 a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = mote_scale(s[k], 0x1p20);
        b[k] = mote_scale(t[k], 0x1p20);
    }
    return mote_fcl_triangle_distance(a, b) * 0x1p-20;
}

static double by_ccd(const mote_vec3 s[3], const mote_vec3 t[3])
{
    return mote_ccd_triangles_touch(s, t) ? 0 : 1;
}

static const engine engines[] = {
    {"mote", "core/body/triangle.h", true, by_mote},
    {"fcl", "FCL's triangle distance, size about 2", true, mote_fcl_triangle_distance},
    {"fcl-scaled", "the same, brought to size 2^20 as our FCL methods do", true, by_fcl_scaled},
    {"libccd", "libccd's GJK, contact only", false, by_ccd},
};

enum { ENGINES = sizeof engines / sizeof *engines, MOTE = 0 };

static const char *const sort_names[PAIR_SORTS] = {
    [PAIR_GENERAL] = "general",
    [PAIR_BESIDE] = "beside",
    [PAIR_APART] = "apart",
    [PAIR_FLAT] = "one sliver",
    [PAIR_NEEDLE] = "one needle",
    [PAIR_BOTH_FLAT] = "two slivers",
    [PAIR_PARALLEL_EDGES] = "parallel edges",
    [PAIR_COPLANAR] = "nearly coplanar",
    [PAIR_VERTEX_FACE] = "vertex near face",
    [PAIR_EDGE_EDGE] = "edge near edge",
    [PAIR_SIZES] = "very different sizes",
    [PAIR_PARALLEL_FACES] = "parallel faces",
    [PAIR_SHARED_VERTEX] = "vertex nearly shared",
    [PAIR_SHARED_EDGE] = "edge nearly shared",
    [PAIR_DEGENERATE] = "segments and points",
    [PAIR_LATTICE] = "whole coordinates",
    [PAIR_PIERCED_FLAT] = "sliver pierced in its plane",
    [PAIR_VERTEX_FLAT] = "vertex near sliver",
    [PAIR_ULPS] = "touching to a few ulp",
};

/* Sorts that are neither degenerate, touching, coplanar nor within a few units in the last
   place. */
static bool is_easy(pair_sort sort)
{
    return sort == PAIR_GENERAL || sort == PAIR_BESIDE || sort == PAIR_APART ||
           sort == PAIR_SIZES;
}

/* Results of one engine in one band. */
typedef struct score {
    uint64_t missed, false_contacts;
    uint64_t off; /* errors above 1e-12 of the extent */
    double worst; /* error of the distance over the extent */
} score;

typedef struct tally {
    uint64_t pairs[BANDS];
    uint64_t sort_pairs[PAIR_SORTS], sort_contacts[PAIR_SORTS];
    double sort_worst[PAIR_SORTS]; /* ours */
    score scores[ENGINES][BANDS];
} tally;

/* A share of the pairs for one thread. */
typedef struct job {
    uint64_t first, end, seed;
    tally tally;
    bool failed;
} job;

/* The penetration depth of two touching triangles: the shortest move that parts them, from the
   overlaps along all normals. */
static double overlap_depth(const mote_vec3 s[3], const mote_vec3 t[3])
{
    double depth = HUGE_VAL;
    for (int i = 0; i < 11; i++) {
        const mote_vec3 *own = i == 9 ? s : t;
        mote_vec3 a = mote_sub(s[(i / 3 + 1) % 3], s[i / 3 % 3]);
        mote_vec3 b = mote_sub(t[(i % 3 + 1) % 3], t[i % 3]);
        if (i >= 9) {
            a = mote_sub(own[1], own[0]);
            b = mote_sub(own[2], own[0]);
        }
        wide3 axis = wide_cross(wide_from(a), wide_from(b));
        wide low[2], high[2];
        for (int k = 0; k < 6; k++) {
            wide h = wide_dot(axis, wide_from(k < 3 ? s[k] : t[k - 3]));
            low[k / 3] = k % 3 == 0 || h < low[k / 3] ? h : low[k / 3];
            high[k / 3] = k % 3 == 0 || h > high[k / 3] ? h : high[k / 3];
        }
        double overlap = (double)wide_min(high[0] - low[1], high[1] - low[0]);
        double length = wide_sqrt(wide_dot(axis, axis));
        if (length > 0)
            depth = fmin(depth, overlap / length);
    }
    return depth;
}

/* Asks one engine about a pair whose truth is known. */
static double judge(const engine *e, const mote_vec3 s[3], const mote_vec3 t[3], bool touch,
                    double truth, double extent, score *to)
{
    double distance = e->measure(s, t);
    bool says = distance == 0;
    to->missed += touch && !says;
    to->false_contacts += !touch && says;
    if (!e->has_distance)
        return 0;
    double error = isfinite(distance) ? fabs(distance - truth) / extent : HUGE_VAL;
    if (extent == 0)
        error = distance == 0 ? 0 : HUGE_VAL;
    to->off += error > 1e-12;
    to->worst = fmax(to->worst, error);
    return error;
}

static void judge_pair(exact *e, pair_sort sort, const mote_vec3 s[3], const mote_vec3 t[3],
                       tally *to)
{
    exact_verdict verdict = exact_triangles(e, s, t);
    wide3 a[3] = {wide_from(s[0]), wide_from(s[1]), wide_from(s[2])};
    wide3 b[3] = {wide_from(t[0]), wide_from(t[1]), wide_from(t[2])};
    double truth = verdict.touch ? 0 : wide_sqrt(reference_apart(a, b));
    double extent = pair_extent(s, t, truth);
    double depth = verdict.touch && verdict.solid ? overlap_depth(s, t) : 0;
    band in = verdict.touch           ? depth > BAND * extent ? BAND_STRICT : BAND_TOUCHING
              : truth > BAND * extent ? BAND_STRICT
                                      : BAND_NEAR;
    to->pairs[in]++;
    to->sort_pairs[sort]++;
    to->sort_contacts[sort] += verdict.touch;
    for (int i = 0; i < ENGINES; i++) {
        double error =
            judge(&engines[i], s, t, verdict.touch, truth, extent, &to->scores[i][in]);
        if (i == MOTE)
            to->sort_worst[sort] = fmax(to->sort_worst[sort], error);
    }
}

/* A seed for pair number i that does not depend on the order (splitmix64). */
static uint64_t pair_seed(uint64_t seed, uint64_t i)
{
    uint64_t z = seed + i * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static void *run_job(void *argument)
{
    job *j = argument;
    exact *e = exact_create();
    j->failed = !e;
    for (uint64_t i = j->first; i < j->end && e; i++) {
        uint64_t state = pair_seed(j->seed, i);
        pair_sort sort = (pair_sort)(i % PAIR_SORTS);
        mote_vec3 s[3], t[3];
        pair_make(sort, s, t, &state);
        judge_pair(e, sort, s, t, &j->tally);
    }
    exact_destroy(e);
    return NULL;
}

static void add_score(score *to, const score *from)
{
    to->missed += from->missed;
    to->false_contacts += from->false_contacts;
    to->off += from->off;
    to->worst = fmax(to->worst, from->worst);
}

static void add_tally(tally *to, const tally *from)
{
    for (int b = 0; b < BANDS; b++) {
        to->pairs[b] += from->pairs[b];
        for (int e = 0; e < ENGINES; e++)
            add_score(&to->scores[e][b], &from->scores[e][b]);
    }
    for (int k = 0; k < PAIR_SORTS; k++) {
        to->sort_pairs[k] += from->sort_pairs[k];
        to->sort_contacts[k] += from->sort_contacts[k];
        to->sort_worst[k] = fmax(to->sort_worst[k], from->sort_worst[k]);
    }
}

#define THREADS_MAX 64

/* Judges all pairs, on as many threads as there are processors; false when memory ran out. */
static bool run(uint64_t pairs, uint64_t seed, tally *total)
{
    static job jobs[THREADS_MAX];
    pthread_t threads[THREADS_MAX];
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    uint64_t count = processors < 1             ? 1
                     : processors > THREADS_MAX ? THREADS_MAX
                                                : (uint64_t)processors;
    bool started[THREADS_MAX] = {false};
    for (uint64_t i = 0; i < count; i++) {
        jobs[i] =
            (job){.first = pairs * i / count, .end = pairs * (i + 1) / count, .seed = seed};
        started[i] = pthread_create(&threads[i], NULL, run_job, &jobs[i]) == 0;
        if (!started[i])
            run_job(&jobs[i]);
    }
    bool ok = true;
    for (uint64_t i = 0; i < count; i++) {
        if (started[i])
            pthread_join(threads[i], NULL);
        ok = ok && !jobs[i].failed;
        add_tally(total, &jobs[i].tally);
    }
    return ok;
}

enum { TIMED = 4096 };

static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

/* Nanoseconds that an engine takes for a pair of a sort, the least of 20 rounds. */
static double time_engine(const engine *e, pair_sort sort)
{
    static mote_vec3 s[TIMED][3], t[TIMED][3];
    double best = HUGE_VAL;
    volatile double sink = 0;
    for (uint64_t i = 0; i < TIMED; i++) {
        uint64_t state = pair_seed(1, i);
        pair_make(sort, s[i], t[i], &state);
    }
    for (int round = 0; round < 20; round++) {
        double start = now_ns(), sum = 0;
        for (int i = 0; i < TIMED; i++)
            sum += e->measure(s[i], t[i]);
        sink = sink + sum;
        best = fmin(best, (now_ns() - start) / TIMED);
    }
    return best;
}

/* The requirements; printed with the table and stored. */
typedef struct requirement {
    const char *text;
    bool met;
} requirement;

enum { REQUIREMENTS = 3 };

static void check(const tally *total, requirement list[REQUIREMENTS])
{
    const score *ours = total->scores[MOTE];
    uint64_t hard = 0, all = 0;
    double worst =
        fmax(ours[BAND_STRICT].worst, fmax(ours[BAND_TOUCHING].worst, ours[BAND_NEAR].worst));
    for (int k = 0; k < PAIR_SORTS; k++) {
        all += total->sort_pairs[k];
        hard += is_easy((pair_sort)k) ? 0 : total->sort_pairs[k];
    }
    list[0] = (requirement){"mote: no wrong contact in the strict band",
                            ours[BAND_STRICT].missed + ours[BAND_STRICT].false_contacts == 0};
    list[1] = (requirement){"mote: no error above 1e-15 of the extent", worst <= BAND};
    list[2] = (requirement){"at least a tenth of the pairs are hard", 10 * hard >= all};
}

static json_t *engine_json(const tally *total, int e)
{
    json_t *bands = json_object();
    for (int b = 0; b < BANDS; b++) {
        const score *s = &total->scores[e][b];
        json_t *row =
            json_pack("{s:I, s:I, s:I}", "pairs", (json_int_t)total->pairs[b], "missed",
                      (json_int_t)s->missed, "false_contacts", (json_int_t)s->false_contacts);
        if (engines[e].has_distance) {
            json_object_set_new(row, "errors_above_1e-12", json_integer((json_int_t)s->off));
            if (isfinite(s->worst))
                json_object_set_new(row, "error_max", json_real(s->worst));
        }
        json_object_set_new(bands, band_names[b], row);
    }
    return json_pack("{s:s, s:s, s:f, s:f, s:o}", "engine", engines[e].name, "what",
                     engines[e].what, "apart_ns", time_engine(&engines[e], PAIR_BESIDE),
                     "general_ns", time_engine(&engines[e], PAIR_GENERAL), "bands", bands);
}

static json_t *to_json(const tally *total, uint64_t pairs, uint64_t seed)
{
    json_t *rows = json_array(), *sorts = json_array();
    for (int e = 0; e < ENGINES; e++)
        json_array_append_new(rows, engine_json(total, e));
    for (int k = 0; k < PAIR_SORTS; k++)
        json_array_append_new(sorts, json_pack("{s:s, s:I, s:I, s:f}", "sort", sort_names[k],
                                               "pairs", (json_int_t)total->sort_pairs[k],
                                               "contacts", (json_int_t)total->sort_contacts[k],
                                               "error_max", total->sort_worst[k]));
    return json_pack("{s:i, s:I, s:I, s:f, s:o, s:o}", "schema", 1, "pairs", (json_int_t)pairs,
                     "seed", (json_int_t)seed, "band", BAND, "engines", rows, "sorts", sorts);
}

static void print_table(const json_t *study)
{
    printf("%-11s %8s %8s  %-9s %10s %8s %8s %10s %9s\n", "engine", "apart ns", "gen. ns",
           "band", "pairs", "missed", "false", "max error", "> 1e-12");
    size_t i;
    json_t *row;
    json_array_foreach(json_object_get(study, "engines"), i, row)
    {
        const char *name;
        json_t *b;
        json_object_foreach(json_object_get(row, "bands"), name, b)
        {
            printf("%-11s %8.0f %8.0f  %-9s %10" JSON_INTEGER_FORMAT " %8" JSON_INTEGER_FORMAT
                   " %8" JSON_INTEGER_FORMAT,
                   json_string_value(json_object_get(row, "engine")),
                   json_real_value(json_object_get(row, "apart_ns")),
                   json_real_value(json_object_get(row, "general_ns")), name,
                   json_integer_value(json_object_get(b, "pairs")),
                   json_integer_value(json_object_get(b, "missed")),
                   json_integer_value(json_object_get(b, "false_contacts")));
            if (engines[i].has_distance)
                printf(" %10.2e %9" JSON_INTEGER_FORMAT,
                       json_number_value(json_object_get(b, "error_max")),
                       json_integer_value(json_object_get(b, "errors_above_1e-12")));
            putchar('\n');
        }
    }
}

static int store(const json_t *study, const char *path)
{
    mote_text text = {0};
    mote_json_print(study, 16, &text);
    const mote_status status = mote_file_write(path, text.data, text.size);
    free(text.data);
    if (status != MOTE_OK)
        fprintf(stderr, "oracle: %s\n", mote_error_text());
    return status == MOTE_OK ? 0 : 4;
}

#define SCENARIOS_MAX 16

typedef struct options {
    uint64_t pairs, seed, stride; /* stride 0: no frames */
    double agreement;             /* over L */
    const char *out;              /* NULL: not stored */
    oracle_methods methods;
    const char *names[ORACLE_METHODS_MAX]; /* of the methods, as given */
    const char *scenarios[SCENARIOS_MAX];
    size_t scenario_count;
} options;

static bool read_real(const char *text, double *value)
{
    char *end = NULL;
    *value = strtod(text, &end);
    return end != text && *end == 0 && *value >= 0 && isfinite(*value);
}

static bool read_number(const char *option, const char *text, options *o)
{
    char *end = NULL;
    errno = 0;
    const uint64_t number = strtoull(text, &end, 10);
    if (end == text || *end != 0 || errno != 0 || text[0] == '-')
        return false;
    if (strcmp(option, "--pairs") == 0 && number > 0 && number >> 40 == 0)
        o->pairs = number;
    else if (strcmp(option, "--stride") == 0 && number > 0 && number >> 30 == 0)
        o->stride = number;
    else if (strcmp(option, "--seed") == 0)
        o->seed = number;
    else
        return false;
    return true;
}

/* Reads an option with its value, except --plugin. */
static bool read_option(const char *option, const char *value, options *o)
{
    oracle_methods *methods = &o->methods;
    if (strcmp(option, "--out") == 0) {
        o->out = value;
        return true;
    }
    if (strcmp(option, "--method") == 0 && methods->count < ORACLE_METHODS_MAX) {
        o->names[methods->count++] = value;
        return true;
    }
    if (strcmp(option, "--scenario") == 0 && o->scenario_count < SCENARIOS_MAX) {
        o->scenarios[o->scenario_count++] = value;
        return true;
    }
    if (strcmp(option, "--agreement") == 0)
        return read_real(value, &o->agreement);
    if (strcmp(option, "--timeout") == 0)
        return read_real(value, &methods->seconds) && methods->seconds > 0;
    return read_number(option, value, o);
}

static int fail(void)
{
    fprintf(stderr, "oracle: %s\n", mote_error_text());
    return 4;
}

/* Reads the options; an exit status after a line on stderr, 0 if all are good. */
static int read_options(int argc, char **argv, options *o)
{
    for (int i = 1; i < argc; i += 2) {
        const char *value = argv[i + 1]; /* NULL after the last */
        if (value && strcmp(argv[i], "--plugin") == 0) {
            if (mote_plugin_open(value) != MOTE_OK)
                return fail();
        } else if (!value || !read_option(argv[i], value, o)) {
            fprintf(stderr,
                    "oracle: bad option %s; usage: oracle [--pairs N] [--seed S] [--stride K] "
                    "[--agreement A] [--out FILE.json] [--method NAME]... [--plugin FILE]... "
                    "[--timeout SECONDS] [--scenario NAME]...\n",
                    argv[i]);
            return 2;
        }
    }
    for (size_t m = 0; m < o->methods.count; m++)
        if (mote_method_choice_read(o->names[m], &o->methods.choice[m]) != MOTE_OK)
            return fail();
    const bool about_frames = o->methods.count + o->scenario_count > 0;
    if (about_frames && o->stride == 0)
        o->stride = 1;
    if (!about_frames && o->pairs == 0)
        o->pairs = 100000;
    return 0;
}

/* Adds the frames of the scenarios to the study and prints a line for each. */
static mote_status add_frames(json_t *study, const options *o, bool *right, bool *method_right)
{
    static const char *const usual[] = {"ww", "tt", "mv"};
    const char *const *scenarios = o->scenario_count > 0 ? o->scenarios : usual;
    const size_t count = o->scenario_count > 0 ? o->scenario_count : 3;
    json_t *list = json_array();
    json_object_set_new(study, "frames", list);
    *right = true;
    for (size_t i = 0; i < count; i++) {
        json_t *row;
        bool here;
        mote_status status = oracle_frames(scenarios[i], (uint32_t)o->stride, o->agreement,
                                           &o->methods, &row, &here, method_right);
        if (status != MOTE_OK)
            return status;
        printf("%s: %" JSON_INTEGER_FORMAT
               " frames, aabb-tree and fcl-aabb differ by %.1e L at "
               "most, %zu disputed\n",
               scenarios[i], json_integer_value(json_object_get(row, "frames")),
               json_number_value(json_object_get(row, "difference_max")),
               json_array_size(json_object_get(row, "disputed")));
        oracle_methods_print(scenarios[i], json_object_get(row, "methods"));
        json_array_append_new(list, row);
        *right = *right && here;
    }
    return MOTE_OK;
}

/* Prints whether each requirement is met and adds them to the study; true if all are. */
static bool report(json_t *study, const requirement *list, int count)
{
    json_t *rows = json_array();
    bool all = true;
    for (int k = 0; k < count; k++) {
        printf("%-8s %s\n", list[k].met ? "met" : "NOT MET", list[k].text);
        json_array_append_new(rows, json_pack("{s:s, s:b}", "requirement", list[k].text, "met",
                                              (int)list[k].met));
        all = all && list[k].met;
    }
    json_object_set_new(study, "requirements", rows);
    return all;
}

/* Judges the pairs and prints their table; list: the requirements. NULL: no memory. */
static json_t *judge_pairs(const options *o, requirement list[REQUIREMENTS])
{
    static tally total;
    if (!run(o->pairs, o->seed, &total))
        return NULL;
    json_t *study = to_json(&total, o->pairs, o->seed);
    print_table(study);
    check(&total, list);
    return study;
}

int main(int argc, char **argv)
{
    static options o = {.seed = 1, .agreement = 1e-12, .methods.seconds = 3600};
    static char method_texts[ORACLE_METHODS_MAX][300];
    requirement list[REQUIREMENTS + 1 + ORACLE_METHODS_MAX];
    bool right, method_right[ORACLE_METHODS_MAX];
    int code = read_options(argc, argv, &o);
    if (code != 0)
        return code;
    int count = o.pairs > 0 ? REQUIREMENTS : 0;
    json_t *study = o.pairs > 0 ? judge_pairs(&o, list) : json_pack("{s:i}", "schema", 1);
    if (!study) {
        fprintf(stderr, "oracle: no memory\n");
        return 5;
    }
    memset(method_right, true, sizeof method_right);
    if (o.stride > 0 && add_frames(study, &o, &right, method_right) != MOTE_OK) {
        fprintf(stderr, "oracle: %s\n", mote_error_text());
        json_decref(study);
        return 5;
    }
    if (o.stride > 0)
        list[count++] = (requirement){"aabb-tree: right in every frame", right};
    for (size_t m = 0; m < o.methods.count; m++) {
        (void)snprintf(method_texts[m], sizeof method_texts[m], "%s: right in every frame",
                       o.methods.choice[m].text);
        list[count++] = (requirement){method_texts[m], method_right[m]};
    }
    code = report(study, list, count) ? 0 : 1;
    if (o.out && store(study, o.out) != 0)
        code = 4;
    json_decref(study);
    return code;
}
