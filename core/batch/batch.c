#include "core/batch/batch.h"

#include "core/batch/stretches.h"
#include "core/certificate/certificate_shared.h"

#include <stdlib.h>
#include <string.h>

/* What a thread needs for its queries. */
typedef struct worker {
    mote_certificate *workspace;
    double *room[2];         /* weights of a frame */
    mote_cert_memory memory; /* of the stretch that it works on */
} worker;

struct mote_batch {
    mote_body body[2];
    mote_field *still[2]; /* of bodies without a field; or NULL */
    mote_weights *samples[2];
    double *sample_numbers[2];
    mote_certificate_options options;
    mote_cert_tree *trees[2]; /* both the same where the bodies have one shape */
    worker *workers;          /* [worker_count]; the first one's memory is the batch's own */
    size_t worker_count;
    mote_cert_memory memory;       /* of queries that go on from the last one */
    const mote_controls *controls; /* of the call in progress */
};

static double *allocate_room(const mote_field *field, size_t frames)
{
    return malloc((3 * frames * field->padded + 1) * sizeof(double));
}

static mote_status copy_samples(mote_batch *batch, int b, const mote_batch_options *options)
{
    const size_t count = options->sample_count[b];
    mote_body *body = &batch->body[b];
    if (count > 64)
        return mote_fail(MOTE_EINVAL, "samples: body %d has %zu; at most 64 are useful", b,
                         count);
    if (count == 0 || body->field->padded == 0)
        return MOTE_OK;
    batch->samples[b] = calloc(count, sizeof *batch->samples[b]);
    batch->sample_numbers[b] = allocate_room(body->field, count);
    if (!batch->samples[b] || !batch->sample_numbers[b])
        return mote_fail(MOTE_ENOMEM, "no memory for %zu samples", count);
    mote_controls samples = options->samples[b];
    samples.pose = NULL;
    for (size_t k = 0; k < count; ++k) {
        mote_body_state state;
        mote_status status =
            mote_controls_read(body, &samples, k, batch->options.length,
                               batch->sample_numbers[b] + 3 * k * body->field->padded, &state);
        if (status != MOTE_OK)
            return mote_fail(status, "sample %zu of body %d: %s", k, b, mote_error_text());
        batch->samples[b][k] = state.weights;
    }
    body->samples = batch->samples[b];
    body->sample_count = (uint32_t)count;
    return MOTE_OK;
}

static mote_status set_bodies(mote_batch *batch, const mote_mesh *const meshes[2],
                              const mote_field *const fields[2],
                              const mote_batch_options *options)
{
    mote_status status = MOTE_OK;
    for (int b = 0; b < 2 && status == MOTE_OK; ++b) {
        batch->body[b] = (mote_body){.mesh = meshes[b], .field = fields[b]};
        if (!fields[b])
            status = mote_field_create_static(&batch->still[b]);
        if (!fields[b] && status == MOTE_OK)
            batch->body[b].field = batch->still[b];
        if (status == MOTE_OK && mote_body_is_given(&batch->body[b]))
            status = mote_fail(MOTE_EINVAL,
                               "body %d has no field; mote_stream_batch_create "
                               "takes bodies whose positions are given",
                               b);
        if (status == MOTE_OK)
            status = copy_samples(batch, b, options);
    }
    return status;
}

static mote_status build_trees(mote_batch *batch, bool one_shape)
{
    const mote_cert_tree_options plan = {.length = batch->options.length,
                                         .width = batch->options.width,
                                         .linear_fits = batch->options.linear_fits};
    mote_status status = mote_cert_tree_create(&batch->body[0], &plan, &batch->trees[0]);
    if (status != MOTE_OK)
        return status;
    if (!one_shape)
        return mote_cert_tree_create(&batch->body[1], &plan, &batch->trees[1]);
    batch->trees[1] = batch->trees[0];
    return MOTE_OK;
}

static void worker_free(worker *w)
{
    mote_cert_workspace_destroy(w->workspace);
    free(w->room[0]);
    free(w->room[1]);
}

static mote_status worker_init(const mote_batch *batch, worker *w)
{
    *w = (worker){.workspace = NULL};
    for (int b = 0; b < 2; ++b)
        w->room[b] = allocate_room(batch->body[b].field, 1);
    if (!w->room[0] || !w->room[1])
        return mote_fail(MOTE_ENOMEM, "no memory for the weights of a frame");
    return mote_cert_workspace_create((mote_cert_tree *const *)batch->trees, 2, &batch->options,
                                      &w->workspace);
}

static mote_status ensure_workers(mote_batch *batch, size_t count)
{
    if (count <= batch->worker_count)
        return MOTE_OK;
    worker *grown = realloc(batch->workers, count * sizeof *grown);
    if (!grown)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu threads", count);
    batch->workers = grown;
    while (batch->worker_count < count) {
        worker *w = &grown[batch->worker_count];
        mote_status status = worker_init(batch, w);
        if (status != MOTE_OK) {
            worker_free(w);
            return status;
        }
        ++batch->worker_count;
    }
    return MOTE_OK;
}

mote_status mote_batch_create(const mote_mesh *const meshes[2],
                              const mote_field *const fields[2],
                              const mote_batch_options *options, mote_batch **batch)
{
    if (!(options->slack >= 0) || isinf(options->slack))
        return mote_fail(MOTE_EINVAL, "slack: %g; it must be finite and not negative",
                         options->slack);
    mote_batch *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a batch");
    made->options =
        mote_default_certificate_options(fmax(meshes[0]->diagonal, meshes[1]->diagonal));
    made->options.slack = options->slack;
    made->options.budget = options->budget;
    const bool one_shape = meshes[0] == meshes[1] && fields[0] == fields[1] &&
                           options->sample_count[0] + options->sample_count[1] == 0;
    mote_status status = set_bodies(made, meshes, fields, options);
    if (status == MOTE_OK)
        status = build_trees(made, one_shape);
    if (status == MOTE_OK)
        status = ensure_workers(made, 1);
    if (status == MOTE_OK)
        *batch = made;
    else
        mote_batch_destroy(made);
    return status;
}

void mote_batch_destroy(mote_batch *batch)
{
    if (!batch)
        return;
    for (size_t i = 0; i < batch->worker_count; ++i)
        worker_free(&batch->workers[i]);
    free(batch->workers);
    mote_cert_tree_destroy(batch->trees[0]);
    if (batch->trees[1] != batch->trees[0])
        mote_cert_tree_destroy(batch->trees[1]);
    for (int b = 0; b < 2; ++b) {
        free(batch->samples[b]);
        free(batch->sample_numbers[b]);
        mote_field_destroy(batch->still[b]);
    }
    free(batch);
}

size_t mote_batch_bytes(const mote_batch *batch)
{
    size_t bytes = sizeof *batch + mote_cert_tree_bytes(batch->trees[0]);
    if (batch->trees[1] != batch->trees[0])
        bytes += mote_cert_tree_bytes(batch->trees[1]);
    for (size_t i = 0; i < batch->worker_count; ++i)
        bytes +=
            sizeof *batch->workers + mote_cert_workspace_bytes(batch->workers[i].workspace);
    for (int b = 0; b < 2; ++b) {
        const size_t weights = 3 * batch->body[b].field->padded * sizeof(double);
        bytes += batch->worker_count * weights;
        bytes += batch->body[b].sample_count * (weights + sizeof(mote_weights));
    }
    return bytes;
}

static mote_status answer_frame(void *context, uint32_t number, size_t frame, bool fresh,
                                double tolerance, mote_certificate_answer *answer)
{
    mote_batch *batch = context;
    worker *w = &batch->workers[number];
    mote_frame now = {.number = 1};
    for (int b = 0; b < 2; ++b) {
        mote_status status =
            mote_controls_read(&batch->body[b], &batch->controls[b], frame,
                               batch->options.length, w->room[b], &now.body[b]);
        if (status != MOTE_OK)
            return mote_fail(status, "body %d: %s", b, mote_error_text());
    }
    if (fresh)
        memset(&w->memory, 0, sizeof w->memory);
    mote_cert_workspace_query(w->workspace, batch->trees, &now, tolerance, &w->memory, answer);
    return MOTE_OK;
}

mote_status mote_batch_query(mote_batch *batch, const mote_controls controls[2],
                             const mote_batch_run *run)
{
    mote_status status = mote_stretches_check(run);
    if (status == MOTE_OK)
        status = ensure_workers(batch, mote_stretches_threads(run));
    if (status != MOTE_OK)
        return status;
    batch->controls = controls;
    batch->workers[0].memory = batch->memory;
    status = mote_stretches_run(run, !(batch->options.slack > 0), answer_frame, batch);
    if (run->stretch == 0)
        batch->memory = batch->workers[0].memory;
    return status;
}
