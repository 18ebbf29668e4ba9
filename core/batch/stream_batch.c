#include "core/batch/stream_batch.h"

#include "core/batch/stretches.h"
#include "core/stream/stream_beside.h"

#include <stdlib.h>

struct mote_stream_batch {
    mote_stream **streams; /* [count], of stretches; they share the trees of steady */
    mote_stream *steady;   /* of queries that go on from the last one */
    size_t count;
    double slack;
    const mote_batch_positions *positions; /* of the call in progress */
    bool one_stretch;                      /* of the call in progress, too */
};

static mote_status ensure_streams(mote_stream_batch *batch, size_t count)
{
    if (count <= batch->count)
        return MOTE_OK;
    mote_stream **grown = realloc(batch->streams, count * sizeof(mote_stream *));
    if (!grown)
        return mote_fail(MOTE_ENOMEM, "no memory for %zu threads", count);
    batch->streams = grown;
    mote_status status = MOTE_OK;
    while (batch->count < count && status == MOTE_OK) {
        status = mote_stream_create_beside(batch->steady, &grown[batch->count]);
        batch->count += status == MOTE_OK;
    }
    return status;
}

mote_status mote_stream_batch_create(const mote_mesh *const meshes[2],
                                     const mote_batch_options *options,
                                     mote_stream_batch **batch)
{
    if (!(options->slack >= 0) || isinf(options->slack))
        return mote_fail(MOTE_EINVAL, "slack: %g; it must be finite and not negative",
                         options->slack);
    mote_stream_batch *made = calloc(1, sizeof *made);
    if (!made)
        return mote_fail(MOTE_ENOMEM, "no memory for a batch");
    mote_stream_options plan =
        mote_default_stream_options(fmax(meshes[0]->diagonal, meshes[1]->diagonal));
    plan.slack = made->slack = options->slack;
    plan.budget = options->budget;
    const mote_body body[2] = {{.mesh = meshes[0]}, {.mesh = meshes[1]}};
    mote_status status = mote_stream_create((const mote_body *const[2]){&body[0], &body[1]},
                                            &plan, &made->steady);
    if (status == MOTE_OK)
        *batch = made;
    else
        mote_stream_batch_destroy(made);
    return status;
}

void mote_stream_batch_destroy(mote_stream_batch *batch)
{
    if (!batch)
        return;
    for (size_t i = 0; i < batch->count; ++i)
        mote_stream_destroy(batch->streams[i]);
    mote_stream_destroy(batch->steady);
    free(batch->streams);
    free(batch);
}

size_t mote_stream_batch_bytes(const mote_stream_batch *batch)
{
    size_t bytes = sizeof *batch + mote_stream_bytes(batch->steady);
    for (size_t i = 0; i < batch->count; ++i)
        bytes += sizeof(mote_stream *) + mote_stream_bytes(batch->streams[i]);
    return bytes;
}

static mote_status answer_frame(void *context, uint32_t number, size_t frame, bool fresh,
                                double tolerance, mote_certificate_answer *answer)
{
    mote_stream_batch *batch = context;
    mote_stream *stream = batch->one_stretch ? batch->steady : batch->streams[number];
    mote_stream_frame now;
    for (int b = 0; b < 2; ++b) {
        const mote_batch_positions *positions = &batch->positions[b];
        now.positions[b] =
            (mote_positions){(const char *)positions->data + frame * positions->frame_step,
                             positions->stride, positions->single != 0};
        /* Whether the first frame of a call is the same as the last frame of the call before is
           not known. */
        now.unchanged[b] = positions->frame_step == 0 && !fresh && frame > 0;
    }
    if (fresh)
        mote_stream_forget(stream);
    return mote_stream_query(stream, &now, tolerance, answer);
}

mote_status mote_stream_batch_query(mote_stream_batch *batch,
                                    const mote_batch_positions positions[2],
                                    const mote_batch_run *run)
{
    batch->one_stretch = run->stretch == 0;
    mote_status status = mote_stretches_check(run);
    if (status == MOTE_OK && !batch->one_stretch)
        status = ensure_streams(batch, mote_stretches_threads(run));
    if (status != MOTE_OK)
        return status;
    batch->positions = positions;
    return mote_stretches_run(run, !(batch->slack > 0), answer_frame, batch);
}
