#include "harness/mesh/character_parts.h"

#include <math.h>

static const char *node_name(const mote_rig *rig, uint32_t node)
{
    return rig->names + rig->nodes[node].name;
}

static mote_status check_nodes(const char *path, const mote_rig *rig)
{
    for (size_t n = 0; n < rig->nodes_count; ++n) {
        if (!mote_affine_is_finite(&rig->nodes[n].rest))
            return mote_fail(MOTE_EINVAL,
                             "%s: the matrix of node %s is not finite; give finite numbers",
                             path, node_name(rig, (uint32_t)n));
    }
    for (size_t b = 0; b < rig->bones_count; ++b) {
        if (!mote_affine_is_finite(&rig->bones[b].bind))
            return mote_fail(MOTE_EINVAL,
                             "%s: the matrix of bone %s is not finite; give finite numbers",
                             path, node_name(rig, rig->bones[b].node));
    }
    return MOTE_OK;
}

/* What the messages refer to. */
typedef struct subject {
    const char *path;
    const mote_rig *rig;
    const mote_rig_clip *clip;
    const char *quantity; /* "position" */
    const char *of;       /* the name of a node or a target */
} subject;

static mote_status blame(const subject *s, uint32_t key, const char *what)
{
    const char *name = s->rig->names + s->clip->name;
    return mote_fail(MOTE_EINVAL, "%s: clip %u%s%s%s: key %u of the %s of %s %s", s->path,
                     (unsigned)(s->clip - s->rig->clips) + 1, *name ? " (" : "", name,
                     *name ? ")" : "", key + 1, s->quantity, s->of, what);
}

static mote_status check_track(const subject *s, const mote_rig_track *track, uint32_t width)
{
    const double *times = s->rig->times + track->time;
    const double *values = s->rig->values + track->value;
    const uint32_t numbers = track->mode == MOTE_TRACK_CUBIC ? 3 * width : width;
    for (uint32_t k = 0; k < track->count; ++k) {
        bool finite = isfinite(times[k]);
        double squares = 0;
        for (uint32_t i = 0; i < numbers; ++i)
            finite = finite && isfinite(values[(size_t)k * numbers + i]);
        const double *value = values + (size_t)k * numbers + (numbers > width ? width : 0);
        for (uint32_t i = 0; i < width; ++i)
            squares += value[i] * value[i];
        if (!finite)
            return blame(s, k, "is not finite; give finite numbers");
        if (k > 0 && times[k] < times[k - 1])
            return blame(s, k, "is before the one before it; give times that ascend");
        if (width == 4 && !(squares > 1e-12 && squares < 1e12))
            return blame(s, k, "is not a rotation; give a quaternion of length 1");
    }
    return MOTE_OK;
}

static mote_status check_clip(const char *path, const mote_rig *rig, const mote_rig_clip *clip)
{
    mote_status status = MOTE_OK;
    for (uint32_t c = 0; c < clip->channel_count && status == MOTE_OK; ++c) {
        const mote_rig_channel *channel = &rig->channels[clip->channel + c];
        subject s = {path, rig, clip, "position", node_name(rig, channel->node)};
        status = check_track(&s, &channel->position, 3);
        s.quantity = "rotation";
        if (status == MOTE_OK)
            status = check_track(&s, &channel->rotation, 4);
        s.quantity = "scale";
        if (status == MOTE_OK)
            status = check_track(&s, &channel->scale, 3);
    }
    for (uint32_t m = 0; m < clip->morph_count && status == MOTE_OK; ++m) {
        const mote_rig_morph *morph = &rig->morphs[clip->morph + m];
        const subject s = {path, rig, clip, "weight",
                           rig->names + rig->targets[morph->target].name};
        status = check_track(&s, &morph->weight, 1);
    }
    return status;
}

mote_status mote_character_check_rig(const char *path, const mote_rig *rig)
{
    mote_status status = check_nodes(path, rig);
    for (size_t t = 0; t < rig->targets_count && status == MOTE_OK; ++t) {
        if (!isfinite(rig->targets[t].weight))
            status = mote_fail(MOTE_EINVAL,
                               "%s: the weight of morph target %s is not finite; give a number",
                               path, rig->names + rig->targets[t].name);
    }
    for (size_t k = 0; k < rig->clips_count && status == MOTE_OK; ++k)
        status = check_clip(path, rig, &rig->clips[k]);
    return status;
}
