/* The paper's claims about accuracy: a, b, c. */
#include "harness/study/claims.h"

#include "harness/base/memory.h"
#include "core/parts/parts.h"

#include <math.h>
#include <stdlib.h>

#define NEAR_CONTACT 0.1 /* in L: a collision point is meaningful up to this distance */

static mote_vec3 middle(mote_vec3 a, mote_vec3 b)
{
    return mote_scale(mote_add(a, b), 0.5);
}

/* Distances between the reported and the true contact point (the middle of the witnesses) in
   the frames just before and after a contact. During a contact there is no true point. */
static mote_status contact_points(const mote_subject *subject, const char *method,
                                  uint64_t seed, double quantile[2])
{
    mote_cell_result result;
    const mote_tour tour = {.seed = seed};
    mote_status status = mote_study_measure(subject, method, tour, &result);
    if (status != MOTE_OK)
        return status;
    const mote_truth *truth = subject->truth;
    const double length = subject->scenario->length;
    double *distances = mote_allocate(result.row_count, sizeof *distances);
    size_t count = 0;
    for (size_t i = 0; i < result.row_count; ++i) {
        const mote_cell_row *row = &result.rows[i];
        const uint32_t k = row->frame - 1;
        if (!(truth->distance[k] > 0 && truth->distance[k] <= NEAR_CONTACT * length))
            continue;
        const mote_vec3 found = middle(row->answer.witness[0], row->answer.witness[1]);
        const mote_vec3 right = middle(truth->witness_a[k], truth->witness_b[k]);
        distances[count++] = sqrt(mote_distance_squared(found, right)) / length;
    }
    if (count > 0) {
        mote_statistics_sort(distances, count);
        quantile[0] = mote_statistics_quantile(distances, count, 0.5);
        quantile[1] = mote_statistics_quantile(distances, count, 0.95);
    } else {
        status =
            mote_fail(MOTE_ENUMERIC, "%s: no frame near a contact", subject->scenario->name);
    }
    free(distances);
    mote_cell_result_free(&result);
    return status;
}

mote_status mote_claim_contact_point(mote_study *study, mote_claim *claim)
{
    claim->id = "a";
    claim->section = "5";
    claim->claim = "2-3 particles define a sufficiently correct collision point for T-T";
    claim->measured = "distance from the reported to the true contact point, T-T, frames with "
                      "a true distance above 0 and at most 0.1 L";
    static const struct {
        const char *method, *name;
        double median, p95; /* thresholds for "holds within limits", "holds" */
    } cases[] = {
        {"particle-paper:n=3", "n = 3", 0.1, 0.1},
        {"particle-paper:n=2", "n = 2", MOTE_NONE, 0.1},
        {"particle-paper:n=3,refine=always", "n = 3, exact check", MOTE_NONE, MOTE_NONE},
        {"particle-paper:n=8,refine=always", "n = 8, exact check", MOTE_NONE, MOTE_NONE},
    };
    const mote_subject *subject;
    mote_status status = mote_study_scene(study, "tt", &subject);
    for (size_t c = 0; c < sizeof cases / sizeof cases[0] && status == MOTE_OK; ++c) {
        double values[2][MOTE_STUDY_SEEDS];
        for (size_t s = 0; s < study->seeds && status == MOTE_OK; ++s) {
            double quantile[2] = {0, 0};
            status = contact_points(subject, cases[c].method, s + 1, quantile);
            values[0][s] = quantile[0];
            values[1][s] = quantile[1];
        }
        for (int q = 1; q >= 0 && status == MOTE_OK; --q) {
            mote_claim_add(claim, mote_estimate_make(values[q], study->seeds), "L", "%s, %s",
                           cases[c].name, q ? "95th percentile" : "median");
            if (q && cases[c].p95 == cases[c].p95)
                mote_claim_require(claim, MOTE_AT_MOST, cases[c].p95, MOTE_NONE);
            if (!q && cases[c].median == cases[c].median)
                mote_claim_require(claim, MOTE_AT_MOST, cases[c].median, cases[c].median);
        }
    }
    return status;
}

/* Runs of frames with contact, over all starts: how many a method never reported, and the delay
   in frames for the others. */
typedef struct episodes {
    size_t starts, count, unseen, delays;
    double *delay; /* [delays] */
} episodes;

static void watch_episodes(const mote_subject *subject, const mote_cell_result *result,
                           episodes *e)
{
    e->delay = mote_resize(e->delay, e->delays + result->row_count, sizeof *e->delay);
    size_t start = 0;
    ++e->starts;
    bool inside = false, seen = false;
    for (size_t i = 0; i <= result->row_count; ++i) {
        const bool contact =
            i < result->row_count && subject->truth->contact[result->rows[i].frame - 1];
        if (contact && !inside) {
            ++e->count;
            start = i;
            seen = false;
        }
        if (!contact && inside && !seen)
            ++e->unseen;
        if (contact && !seen && result->rows[i].answer.contact) {
            seen = true;
            e->delay[e->delays++] = (double)(i - start);
        }
        inside = contact;
    }
}

/* The contacts of one start depend on each other, since particles may stay where they do not
   see them. So a start is one trial, whose outcome is its share of contacts never seen. */
static void add_episodes(mote_claim *claim, const char *name, bool decides, episodes *e)
{
    const double starts = (double)e->starts, part = (double)e->unseen / (double)e->count;
    const mote_estimate share = {part, mote_statistics_share_interval(part * starts, starts)};
    mote_claim_add(claim, share, "", "%s: share of %zu contacts never seen, %zu starts", name,
                   e->count, e->starts);
    if (decides)
        mote_claim_require(claim, MOTE_AT_MOST, 0.05, 0.2);
    if (e->delays == 0)
        return;
    mote_statistics_sort(e->delay, e->delays);
    const double delay = mote_statistics_quantile(e->delay, e->delays, 0.95);
    mote_claim_add(claim, mote_estimate_alone(delay), "fr.",
                   "%s: delay of those seen, 95th percentile", name);
}

/* 72 starts that see every contact are the fewest whose interval ends below 0.05. */
#define STARTS 256
#define STARTS_QUICK 80

mote_status mote_claim_passing_through(mote_study *study, mote_claim *claim)
{
    claim->id = "b";
    claim->section = "1";
    claim->claim = "3-5 particles keep a body of over 10,000 polygons from moving through an "
                   "obstacle";
    claim->measured =
        "W-W of 11,920 triangles: runs of frames with contact in which the method "
        "saw none (its resolution: two mean edges); motion is given, not answered; the "
        "interval "
        "takes a start for one trial, as its contacts depend on each other";
    static const struct {
        const char *method, *name;
        bool decides;
    } cases[] = {
        {"particle-paper:n=5", "n = 5", true},
        {"particle-paper:n=4", "n = 4", true},
        {"particle-paper:n=3", "n = 3", true},
        {"particle-paper:n=5,refine=always", "n = 5, exact check, no tolerance", false},
    };
    const uint64_t starts = study->quick ? STARTS_QUICK : STARTS;
    const mote_subject *subject;
    mote_status status = mote_study_scene(study, "ww", &subject);
    for (size_t c = 0; c < sizeof cases / sizeof cases[0] && status == MOTE_OK; ++c) {
        episodes e = {0};
        for (uint64_t s = 0; s < starts && status == MOTE_OK; ++s) {
            mote_cell_result result;
            const mote_tour tour = {.seed = s + 1};
            status = mote_study_measure(subject, cases[c].method, tour, &result);
            if (status == MOTE_OK) {
                watch_episodes(subject, &result, &e);
                mote_cell_result_free(&result);
            }
        }
        if (status == MOTE_OK)
            add_episodes(claim, cases[c].name, cases[c].decides, &e);
        free(e.delay);
    }
    return status;
}

#define ENOUGH_TRACKED 0.95

/* One shape of claim c: the share of tracked frames at each n. */
typedef struct shape {
    const char *title, *base, *name;
    char letter;
    size_t triangles;
} shape;

static mote_status count_parts(const mote_subject *subject, uint32_t *parts)
{
    mote_parts *made = NULL;
    mote_status status = mote_parts_create(subject->scenario->body[0].mesh, NULL, &made);
    if (status == MOTE_OK)
        *parts = made->count;
    mote_parts_destroy(made);
    return status;
}

static mote_status tracked_at(const mote_study *study, const mote_subject *subject, uint32_t n,
                              mote_estimate *tracked, mote_estimate *p99)
{
    char method[64];
    (void)snprintf(method, sizeof method, "particle-paper:n=%u,refine=always", n);
    mote_sample samples[MOTE_STUDY_SEEDS];
    const mote_tour tour = {.seed = 1};
    mote_status status = mote_study_sample(subject, method, tour, study->seeds, samples);
    if (status != MOTE_OK)
        return status;
    *tracked = mote_sample_estimate(samples, study->seeds, MOTE_MEASURED_TRACKED);
    *p99 = mote_sample_estimate(samples, study->seeds, MOTE_MEASURED_ERROR_P99);
    return MOTE_OK;
}

/* The smallest n from which on the tracked share is high enough in the sweep; 0: none. */
static mote_status sweep_shape(const mote_study *study, const mote_subject *subject,
                               uint32_t parts, mote_text *curve, uint32_t *enough)
{
    static const uint32_t numbers[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
    mote_status status = MOTE_OK;
    *enough = 0;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0] && status == MOTE_OK; ++i) {
        mote_estimate tracked, p99;
        status = tracked_at(study, subject, numbers[i], &tracked, &p99);
        if (status != MOTE_OK)
            break;
        mote_text_add(curve, "%u\t%g\t%g\t%g\t%g\t%g\n", numbers[i], (double)numbers[i] / parts,
                      tracked.value, tracked.interval.low, tracked.interval.high, p99.value);
        if (tracked.value < ENOUGH_TRACKED)
            *enough = 0;
        else if (*enough == 0)
            *enough = numbers[i];
    }
    return status;
}

static mote_status measure_shape(mote_study *study, const shape *s, mote_text *curve,
                                 mote_claim *claim)
{
    const mote_subject *subject = NULL;
    uint32_t parts = 1, enough = 0;
    mote_estimate twice, p99;
    const mote_variant variant = {s->base, s->name, s->letter, s->triangles, true};
    mote_status status = s->letter ? mote_study_variant(study, &variant, &subject)
                                   : mote_study_scene(study, s->base, &subject);
    if (status == MOTE_OK)
        status = count_parts(subject, &parts);
    if (status == MOTE_OK)
        status = tracked_at(study, subject, 2 * parts, &twice, &p99);
    mote_text_add(curve, "%s\"%s, %u parts\"\n", curve->size ? "\n\n" : "", s->title, parts);
    if (status == MOTE_OK)
        status = sweep_shape(study, subject, parts, curve, &enough);
    if (status != MOTE_OK)
        return status;
    mote_claim_add(claim, twice, "", "%s: share tracked at n = %u, twice %u parts", s->title,
                   2 * parts, parts);
    mote_claim_require(claim, MOTE_AT_LEAST, ENOUGH_TRACKED, 0.8);
    mote_claim_add(claim, mote_estimate_alone(enough ? enough / (double)parts : MOTE_NONE), "",
                   "%s: least n / parts from which on the share is 0.95", s->title);
    return MOTE_OK;
}

mote_status mote_claim_convex_parts(mote_study *study, mote_claim *claim)
{
    claim->id = "c";
    claim->section = "3.5";
    claim->claim = "n should be twice the number of convex parts; separation is then tracked";
    claim->measured = "share of frames with an error of at most 0.01 L, exact check always, at "
                      "twice the parts that HACD finds, and the least n / parts that is enough";
    claim->curve = "figures/claim_c.dat";
    static const shape shapes[] = {
        {"W", "ww", "ww", '\0', 0},
        {"T", "tt", "tt", '\0', 0},
        {"V", "tt", "v-v", 'V', 1764},
        {"M", "tt", "m-m", 'M', 2968},
        {"20-tooth comb", "comb", "comb", '\0', 0},
    };
    mote_text curve = {0};
    mote_status status = MOTE_OK;
    for (size_t i = 0; i < sizeof shapes / sizeof shapes[0] && status == MOTE_OK; ++i)
        status = measure_shape(study, &shapes[i], &curve, claim);
    if (status == MOTE_OK)
        status = mote_study_plot(study, "claim_c", &curve);
    free(curve.data);
    return status;
}
