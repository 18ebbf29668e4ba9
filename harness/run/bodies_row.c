#include "harness/run/bodies_row.h"

#include "harness/base/record.h"
#include "harness/base/statistics.h"

#include <stdlib.h>
#include <string.h>

static uint64_t total_of(const mote_bodies_timed *t)
{
    return t->total_ns;
}

static uint64_t motion_of(const mote_bodies_timed *t)
{
    return t->motion_ns;
}

#define PART(name)                                                                             \
    static uint64_t name##_of(const mote_bodies_timed *t)                                      \
    {                                                                                          \
        return t->step.name##_ns;                                                              \
    }
PART(bounds)
PART(deform)
PART(update)
PART(broad)
PART(query)
#undef PART

static double p95_of(const mote_bodies_result *result)
{
    const size_t from = result->step_count > 1 ? 1 : 0, count = result->step_count - from;
    double *values = malloc((result->step_count + 1) * sizeof *values);
    double p95 = MOTE_NONE;
    for (size_t k = 0; values && k < count; ++k)
        values[k] = (double)result->steps[k + from].total_ns;
    if (values && result->step_count > 0) {
        mote_statistics_sort(values, count);
        p95 = mote_statistics_quantile(values, count, 0.95);
    }
    free(values);
    return p95;
}

/* Time of the first `count` steps without the very first, which finds all pairs anew (unless it
   is the only one). */
static double time_of(const mote_bodies_result *result, size_t count)
{
    double sum = 0;
    for (size_t k = count > 1 ? 1 : 0; k < count; ++k)
        sum += (double)result->steps[k].total_ns;
    return sum;
}

static void describe(const mote_bodies *bodies, const mote_bodies_choice *choice,
                     mote_bodies_row *row)
{
    (void)snprintf(row->scenario, sizeof row->scenario, "%s", bodies->name);
    (void)snprintf(row->method, sizeof row->method, "%s", choice->text);
    row->bodies = bodies->count;
    row->shapes = bodies->shape_count;
    row->density = bodies->near_pairs_wanted;
    for (uint32_t i = 0; i < bodies->count; ++i)
        row->triangles += bodies->shapes[bodies->shape_of[i]].body.mesh->triangle_count;
    row->exact = mote_method_traits(choice->method.method, choice->method.values).exact;
    row->threads = choice->threads;
    row->ahead = choice->ahead;
}

void mote_bodies_row_make(const mote_bodies *bodies, const mote_bodies_choice *choice,
                          uint32_t replicate, const mote_bodies_result *result,
                          mote_bodies_row *row)
{
    mote_bodies_row made = {.replicate = replicate,
                            .status = result->status,
                            .ok = result->status == MOTE_CELL_OK,
                            .steps = result->step_count,
                            .contacts = result->contact_count,
                            .step_ns = mote_bodies_median(result, total_of),
                            .step_p95_ns = p95_of(result),
                            .motion_ns = mote_bodies_median(result, motion_of),
                            .bounds_ns = mote_bodies_median(result, bounds_of),
                            .deform_ns = mote_bodies_median(result, deform_of),
                            .update_ns = mote_bodies_median(result, update_of),
                            .broad_ns = mote_bodies_median(result, broad_of),
                            .query_ns = mote_bodies_median(result, query_of),
                            .build_ns = (double)result->build_ns,
                            .heap_live_bytes = result->heap_live_bytes,
                            .heap_peak_bytes = result->heap_peak_bytes,
                            .rss_peak_bytes = result->rss_peak_bytes,
                            .ratio = MOTE_NONE};
    describe(bodies, choice, &made);
    (void)snprintf(made.reason, sizeof made.reason, "%s", result->reason);
    if (!result->heap_counted)
        made.heap_live_bytes = made.heap_peak_bytes = -1;
    double pairs = 0;
    for (size_t k = 0; k < result->step_count; ++k)
        pairs += (double)result->steps[k].step.pairs;
    const size_t timed = result->step_count > 1 ? result->step_count - 1 : result->step_count;
    made.step_mean_ns = time_of(result, result->step_count) / (double)timed;
    made.near_total = pairs / (double)result->step_count;
    made.near_pairs = made.near_total / bodies->count;
    made.wall_ns = (double)result->wall_ns / (double)result->step_count;
    *row = made;
}

static int compare(const mote_bodies_contact *a, const mote_bodies_contact *b)
{
    if (a->frame != b->frame)
        return a->frame < b->frame ? -1 : 1;
    if (a->a != b->a)
        return a->a < b->a ? -1 : 1;
    return a->b < b->b ? -1 : a->b > b->b;
}

/* Contacts of a, in frames up to last, that b has not. */
static size_t lacking(const mote_bodies_result *a, const mote_bodies_result *b, uint32_t last)
{
    size_t at = 0, count = 0;
    for (size_t k = 0; k < a->contact_count && a->contacts[k].frame <= last; ++k) {
        while (at < b->contact_count && compare(&b->contacts[at], &a->contacts[k]) < 0)
            ++at;
        count += at == b->contact_count || compare(&b->contacts[at], &a->contacts[k]) != 0;
    }
    return count;
}

void mote_bodies_row_compare(mote_bodies_row *row, const mote_bodies_result *result,
                             const mote_bodies_row *reference,
                             const mote_bodies_result *reference_result)
{
    if (!row->ok || !reference->ok || row->steps == 0 || reference->steps == 0)
        return;
    row->common = row->steps < reference->steps ? row->steps : reference->steps;
    const uint32_t last = result->steps[row->common - 1].frame;
    (void)snprintf(row->reference, sizeof row->reference, "%s", reference->method);
    row->missed = lacking(reference_result, result, last);
    row->false_contacts = lacking(result, reference_result, last);
    row->ratio = time_of(reference_result, row->common) / time_of(result, row->common);
}

static json_t *bytes(int64_t value)
{
    return value >= 0 ? json_integer(value) : json_null();
}

static void put_times(json_t *object, const mote_bodies_row *row)
{
    (void)json_object_set_new(object, "step_ns", mote_json_number(row->step_ns));
    (void)json_object_set_new(object, "step_mean_ns", mote_json_number(row->step_mean_ns));
    (void)json_object_set_new(object, "step_p95_ns", mote_json_number(row->step_p95_ns));
    (void)json_object_set_new(object, "bounds_ns", mote_json_number(row->bounds_ns));
    (void)json_object_set_new(object, "deform_ns", mote_json_number(row->deform_ns));
    (void)json_object_set_new(object, "update_ns", mote_json_number(row->update_ns));
    (void)json_object_set_new(object, "broad_ns", mote_json_number(row->broad_ns));
    (void)json_object_set_new(object, "query_ns", mote_json_number(row->query_ns));
    (void)json_object_set_new(object, "motion_ns", mote_json_number(row->motion_ns));
    (void)json_object_set_new(object, "wall_ns", mote_json_number(row->wall_ns));
    (void)json_object_set_new(object, "build_ns", mote_json_number(row->build_ns));
    (void)json_object_set_new(object, "heap_live_bytes", bytes(row->heap_live_bytes));
    (void)json_object_set_new(object, "heap_peak_bytes", bytes(row->heap_peak_bytes));
    (void)json_object_set_new(object, "rss_peak_bytes", bytes(row->rss_peak_bytes));
}

static void put_contacts(json_t *object, const mote_bodies_row *row)
{
    const bool known = row->reference[0] != '\0';
    (void)json_object_set_new(object, "contacts", json_integer((json_int_t)row->contacts));
    (void)json_object_set_new(object, "reference",
                              known ? json_string(row->reference) : json_null());
    (void)json_object_set_new(object, "common_steps",
                              known ? json_integer((json_int_t)row->common) : json_null());
    (void)json_object_set_new(object, "missed",
                              known ? json_integer((json_int_t)row->missed) : json_null());
    (void)json_object_set_new(object, "false_contacts",
                              known ? json_integer((json_int_t)row->false_contacts)
                                    : json_null());
    (void)json_object_set_new(object, "ratio", mote_json_number(row->ratio));
}

static json_t *row_json(const mote_bodies_row *row)
{
    json_t *object = json_object();
    (void)json_object_set_new(object, "scenario", json_string(row->scenario));
    (void)json_object_set_new(object, "method", json_string(row->method));
    (void)json_object_set_new(object, "exact", json_boolean(row->exact));
    (void)json_object_set_new(object, "replicate", json_integer(row->replicate));
    (void)json_object_set_new(object, "threads", json_integer(row->threads));
    (void)json_object_set_new(object, "ahead", json_integer(row->ahead));
    (void)json_object_set_new(object, "bodies", json_integer(row->bodies));
    (void)json_object_set_new(object, "shapes", json_integer(row->shapes));
    (void)json_object_set_new(object, "triangles", json_integer((json_int_t)row->triangles));
    (void)json_object_set_new(object, "near_pairs_wanted",
                              row->density > 0 ? json_real(row->density) : json_null());
    (void)json_object_set_new(object, "near_pairs_a_body", mote_json_number(row->near_pairs));
    (void)json_object_set_new(object, "near_pairs", mote_json_number(row->near_total));
    (void)json_object_set_new(object, "steps", json_integer((json_int_t)row->steps));
    put_times(object, row);
    put_contacts(object, row);
    (void)json_object_set_new(object, "status",
                              json_string(mote_cell_status_names[row->status]));
    (void)json_object_set_new(object, "reason",
                              row->reason[0] ? json_string(row->reason) : json_null());
    return object;
}

json_t *mote_bodies_rows_json(const mote_bodies_row *rows, size_t count)
{
    json_t *list = json_array();
    for (size_t k = 0; k < count; ++k)
        (void)json_array_append_new(list, row_json(&rows[k]));
    return json_pack("{s:i, s:o}", "schema", 1, "rows", list);
}

/* "0", or "-" without a reference. */
static const char *count_text(const mote_bodies_row *row, size_t count, char buffer[32])
{
    (void)snprintf(buffer, 32, row->reference[0] ? "%zu" : "-", count);
    return buffer;
}

void mote_bodies_rows_print(const mote_bodies_row *rows, size_t count, FILE *out)
{
    char missed[32], wrong[32], ratio[32];
    (void)fprintf(out, "%-16s %-34s %7s %9s %11s %11s %8s %8s %7s %7s %8s\n", "scenario",
                  "method", "bodies", "pairs", "mean us", "p95 us", "ratio", "MB", "contact",
                  "missed", "false");
    for (size_t k = 0; k < count; ++k) {
        const mote_bodies_row *row = &rows[k];
        (void)fprintf(out, "%-16s %-34s %7u ", row->scenario, row->method, row->bodies);
        if (!row->ok) {
            (void)fprintf(out, "%s: %s\n", mote_cell_status_names[row->status], row->reason);
            continue;
        }
        (void)snprintf(ratio, sizeof ratio, isnan(row->ratio) ? "-" : "%.3g", row->ratio);
        (void)fprintf(out, "%9.1f %11.1f %11.1f %8s %8.1f %7zu %7s %8s\n", row->near_total,
                      row->step_mean_ns / 1e3, row->step_p95_ns / 1e3, ratio,
                      (double)row->rss_peak_bytes / 1e6, row->contacts,
                      count_text(row, row->missed, missed),
                      count_text(row, row->false_contacts, wrong));
    }
}
