#include "harness/study/dynamics.h"

#include "harness/base/memory.h"
#include "harness/figure/figures.h"
#include "harness/base/record.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Largest relative drift allowed; a simulation has some hundred steps. */
#define MOST_DRIFT 1e-10

/* The same for energy where motions stop at impacts, between two steps of the rigid motion:
   there the rotation is that of a cubic between both, which keeps energy to about 1e-8 only. */
#define MOST_DRIFT_BETWEEN 1e-6

/* Thresholds of the claim for the upper end of the share of passes. */
#define HOLDS 0.01
#define LIMITS 0.05

static const uint32_t numbers[] = {1, 2, 3, 4, 5, 6, 7, 8, 16};
#define NUMBERS (sizeof numbers / sizeof numbers[0])

static const char *const paper_scenes[] = {"tt", "mv", "ww"};
static const char *const other_scenes[] = {"vv",    "tw",    "comb",   "bunny",
                                           "twist", "ww-1k", "ww-100k"};
#define PAPER_SCENES (sizeof paper_scenes / sizeof paper_scenes[0])
#define OTHER_SCENES (sizeof other_scenes / sizeof other_scenes[0])

/* Frames a step of the rows that compare sampled and continuous steps. */
static const double steps[] = {1, 3, 10, 30};
#define STEPS (sizeof steps / sizeof steps[0])
#define ROWS_MAX ((PAPER_SCENES + OTHER_SCENES) * (3 * NUMBERS + 3 + 2 * STEPS))

/* "" where steps are whole, as everywhere before there were others. */
static const char *const within_names[] = {"", "sampled", "continuous"};

typedef struct plan {
    const mote_dynamics_size *size;
    mote_dynamics_row *rows;
    size_t count;
} plan;

static mote_dynamics_row *add_row(plan *p, const char *scene, const char *method, uint32_t n,
                                  uint32_t wanted)
{
    mote_dynamics_row *row = &p->rows[p->count++];
    *row = (mote_dynamics_row){.scene = scene, .n = n, .wanted = wanted, .step = 1};
    if (p->size->approaches > 0)
        row->wanted = p->size->approaches;
    (void)snprintf(row->method, sizeof row->method, "%s", method);
    return row;
}

static void add_law(plan *p, const char *scene, const char *law, uint32_t wanted, bool paper)
{
    for (size_t k = 0; k < NUMBERS; ++k) {
        char method[64];
        (void)snprintf(method, sizeof method, "particle-paper:n=%u,law=%s", numbers[k], law);
        mote_dynamics_row *row = add_row(p, scene, method, numbers[k], wanted);
        row->law = law;
        row->paper = paper;
    }
}

/* Steps of several frames. The longest continuous ones have as many approaches as any row: they
   must let nothing pass. */
static void add_steps(plan *p, const char *scene, uint32_t few, uint32_t many)
{
    for (size_t k = 0; k < STEPS; ++k) {
        if (p->size->step > 0 && fabs(steps[k] - p->size->step) > 0)
            continue;
        for (int w = MOTE_STEPS_SAMPLED; w <= MOTE_STEPS_CONTINUOUS; ++w) {
            const bool most = w == MOTE_STEPS_CONTINUOUS && k + 1 == STEPS;
            mote_dynamics_row *row = add_row(p, scene, "certified", 0, most ? many : few);
            row->step = steps[k];
            row->within = (mote_simulation_steps)w;
        }
    }
}

static void add_scene(plan *p, const char *scene, bool paper)
{
    const bool quick = p->size->quick;
    const uint32_t few = quick ? 20 : 200;
    uint32_t many = few;
    if (paper)
        many = quick ? 100 : 1000;
    if (p->size->scene && strcmp(p->size->scene, scene) != 0)
        return;
    if (p->size->step > 0) {
        add_steps(p, scene, few, many);
        return;
    }
    add_law(p, scene, "log", many, paper);
    (void)add_row(p, scene, "particle:n=8", 8, many);
    add_row(p, scene, "certified", 0, many)->exact = true;
    if (paper)
        add_row(p, scene, "fcl-aabb:seed=previous,queue=64", 0, few)->exact = true;
    add_steps(p, scene, few, many);
    if (paper && !quick) {
        add_law(p, scene, "inverse", few, true);
        add_law(p, scene, "inverse-square", few, true);
    }
}

bool mote_dynamics_has_step(double frames)
{
    for (size_t k = 0; k < STEPS; ++k) {
        if (!(fabs(steps[k] - frames) > 0))
            return true;
    }
    return false;
}

mote_status mote_dynamics_plan(const mote_dynamics_size *size, mote_dynamics_row **rows,
                               size_t *count)
{
    plan p = {size, mote_allocate(ROWS_MAX, sizeof *p.rows), 0};
    for (size_t i = 0; i < PAPER_SCENES; ++i)
        add_scene(&p, paper_scenes[i], true);
    for (size_t i = 0; i < OTHER_SCENES && !size->quick; ++i)
        add_scene(&p, other_scenes[i], false);
    if (p.count == 0) {
        free(p.rows);
        return mote_fail(MOTE_EINVAL, "scene '%s' is not in the study; choose %s", size->scene,
                         size->quick
                             ? "tt, mv or ww"
                             : "tt, mv, ww, vv, tw, comb, bunny, twist, ww-1k or ww-100k");
    }
    *rows = p.rows;
    *count = p.count;
    return MOTE_OK;
}

mote_status mote_dynamics_check(const mote_dynamics_size *size)
{
    mote_dynamics_row *rows = NULL;
    size_t count;
    const mote_status status = mote_dynamics_plan(size, &rows, &count);
    free(rows);
    return status;
}

void mote_dynamics_claim(mote_claim *claim)
{
    claim->id = "dynamics";
    claim->section = "1, 4, 5";
    claim->claim = "3-5 particles prevent an object from moving through an obstacle when their "
                   "answer decides its motion";
    claim->measured = "closed loop: share of random approaches with a run of contacts that the "
                      "method never reports; exact binomial intervals (Clopper and Pearson)";
}

static bool is_paper_row(const mote_dynamics_row *row)
{
    return row->paper && row->law && strcmp(row->law, "log") == 0;
}

void mote_dynamics_claim_add(mote_claim *claim, const mote_dynamics_row *row)
{
    const mote_estimate share = {mote_approaches_share(&row->sum),
                                 mote_approaches_interval(&row->sum)};
    if (!is_paper_row(row)) {
        mote_claim_add(claim, share, "", "%s, %s", row->scene, row->method);
        return;
    }
    mote_claim_add(claim, share, "", "%s, n = %u", row->scene, row->n);
    if (row->n >= 3 && row->n <= 5)
        mote_claim_require(claim, MOTE_AT_MOST, HOLDS, LIMITS);
}

const char *mote_dynamics_failure(const mote_dynamics_row *row)
{
    const mote_approaches *sum = &row->sum;
    if (sum->approaches != row->wanted)
        return "too few approaches came to a contact";
    if (row->exact && sum->passes_through > 0)
        return "an exact method let a body pass through";
    if (row->exact && sum->missed_steps + sum->false_steps > 0)
        return "an exact method was wrong about a contact";
    if (row->within == MOTE_STEPS_CONTINUOUS && sum->passes_through > 0)
        return "continuous steps let a body pass through";
    if (row->within == MOTE_STEPS_CONTINUOUS && sum->intersecting > 0)
        return "continuous steps let surfaces intersect";
    const bool between = row->within == MOTE_STEPS_CONTINUOUS;
    if (!(sum->energy_drift <= (between ? MOST_DRIFT_BETWEEN : MOST_DRIFT)))
        return "energy was not kept";
    if (!(sum->momentum_drift <= MOST_DRIFT))
        return "momentum was not kept";
    if (!(sum->angular_momentum_drift <= MOST_DRIFT))
        return "angular momentum was not kept";
    return NULL;
}

void mote_dynamics_label(const mote_dynamics_row *row, char label[MOTE_DYNAMICS_LABEL])
{
    if (row->within == MOTE_STEPS_WHOLE)
        (void)snprintf(label, MOTE_DYNAMICS_LABEL, "%s", row->method);
    else
        (void)snprintf(label, MOTE_DYNAMICS_LABEL, "%s, %s %g", row->method,
                       within_names[row->within], row->step);
}

void mote_dynamics_print(const mote_dynamics_row *rows, size_t count)
{
    (void)printf("%-8s %-36s %6s %6s %5s %7s  %-15s %7s %6s %5s %8s\n", "scene", "method",
                 "appr.", "passes", "deep", "%", "95 %", "depth/L", "delay", "most",
                 "us/frame");
    for (size_t i = 0; i < count; ++i) {
        const mote_approaches *sum = &rows[i].sum;
        const mote_confidence interval = mote_approaches_interval(sum);
        char label[MOTE_DYNAMICS_LABEL];
        mote_dynamics_label(&rows[i], label);
        (void)printf("%-8s %-36s %6u %6u %5u %7.2f  [%5.2f, %6.2f] %7.4f %6.2f %5u %8.1f\n",
                     rows[i].scene, label, (unsigned)sum->approaches,
                     (unsigned)sum->passes_through, (unsigned)sum->deep_passes_through,
                     100 * mote_approaches_share(sum), 100 * interval.low, 100 * interval.high,
                     sum->max_penetration_passes, mote_approaches_delay(sum),
                     (unsigned)sum->delay_max, sum->query_ns / rows[i].step / 1e3);
    }
}

json_t *mote_dynamics_row_json(const mote_dynamics_row *row)
{
    json_t *object = mote_approaches_json(&row->sum);
    const mote_confidence interval = mote_approaches_interval(&row->sum);
    (void)json_object_set_new(object, "scenario", json_string(row->scene));
    (void)json_object_set_new(object, "method", json_string(row->method));
    (void)json_object_set_new(object, "n", row->n > 0 ? json_integer(row->n) : json_null());
    (void)json_object_set_new(object, "law", row->law ? json_string(row->law) : json_null());
    (void)json_object_set_new(object, "step", json_real(row->step));
    (void)json_object_set_new(
        object, "within",
        row->within == MOTE_STEPS_WHOLE ? json_null() : json_string(within_names[row->within]));
    (void)json_object_set_new(object, "measured", json_string(row->measured));
    (void)json_object_set_new(object, "share",
                              mote_json_number(mote_approaches_share(&row->sum)));
    (void)json_object_set_new(object, "interval",
                              row->sum.approaches > 0
                                  ? json_pack("[f,f]", interval.low, interval.high)
                                  : json_null());
    return object;
}

static void add_line(mote_text *text, const mote_dynamics_row *row)
{
    const mote_approaches *sum = &row->sum;
    const mote_confidence interval = mote_approaches_interval(sum);
    mote_text_add(text, "%s,\"%s\",%g,%s,", row->scene, row->method, row->step,
                  within_names[row->within]);
    if (row->n > 0)
        mote_text_add(text, "%u", row->n);
    mote_text_add(text, ",%s", row->law ? row->law : "");
    if (sum->approaches > 0)
        mote_text_add(text, ",%.6g,%.6g,%.6g", mote_approaches_share(sum), interval.low,
                      interval.high);
    else
        mote_text_add(text, ",,,");
#define PUT_COUNT(name) mote_text_add(text, ",%llu", (unsigned long long)sum->name);
#define PUT_FIGURE(name) mote_text_add(text, ",%.6g", sum->name);
    MOTE_APPROACHES_COUNTS(PUT_COUNT)
    MOTE_APPROACHES_FIGURES(PUT_FIGURE)
#undef PUT_COUNT
#undef PUT_FIGURE
    mote_text_add(text, ",%llu,%s,%s\n", (unsigned long long)MOTE_APPROACH_SEED, row->commit,
                  row->measured);
}

mote_status mote_dynamics_csv(const mote_dynamics_row *rows, size_t count,
                              const char *directory)
{
    mote_text text = {0};
#define PUT_NAME(name) "," #name
    mote_text_add(&text,
                  "scenario,method,step,within,n,law,share,low,high%s,seed,commit,measured\n",
                  MOTE_APPROACHES_COUNTS(PUT_NAME) MOTE_APPROACHES_FIGURES(PUT_NAME));
#undef PUT_NAME
    for (size_t i = 0; i < count; ++i)
        add_line(&text, &rows[i]);
    return mote_record_text(directory, "dynamics.csv", &text);
}

/* Blocks "n share low high approaches" for the particles with the printed law, one per scene,
   the paper's scenes first. */
mote_status mote_dynamics_figure(const mote_dynamics_row *rows, size_t count,
                                 const char *directory)
{
    mote_text text = {0};
    const char *scene = "";
    for (size_t i = 0; i < count; ++i) {
        const mote_dynamics_row *row = &rows[i];
        if (!row->law || strcmp(row->law, "log") != 0 || row->sum.approaches == 0)
            continue;
        if (strcmp(scene, row->scene) != 0)
            mote_text_add(&text, "%s\"%s\"\n", text.size ? "\n\n" : "", row->scene);
        scene = row->scene;
        const mote_confidence interval = mote_approaches_interval(&row->sum);
        mote_text_add(&text, "%u %.6g %.6g %.6g %llu\n", row->n,
                      mote_approaches_share(&row->sum), interval.low, interval.high,
                      (unsigned long long)row->sum.approaches);
    }
    if (text.size == 0) /* no particles were measured */
        return MOTE_OK;
    char *figures = mote_format("%s/figures", directory);
    mote_status status = mote_directory_make(figures);
    free(figures);
    if (status != MOTE_OK) {
        free(text.data);
        return status;
    }
    status = mote_record_text(directory, "figures/dynamics.dat", &text);
    return status == MOTE_OK ? mote_figures_plot(directory, "dynamics", "dynamics") : status;
}
