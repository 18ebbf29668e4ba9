/* The parts of a glTF file's animations that assimp leaves out: step interpolation, the
   tangents of cubic keys (glTF 2.0, section 3.11), and negative weights of morph targets. */
#include "harness/mesh/character_parts.h"

#include "harness/base/memory.h"

#include <stdlib.h>
#include <string.h>

static const char cubic_keys[] = "cubic keys";

typedef struct reader {
    mote_gltf *gltf;
    const uint32_t *nodes; /* of the rig, by number in the file */
    mote_rig *rig;
} reader;

/* Makes a track cubic. keys[3 k + j] is the arriving tangent, the value or the leaving tangent
   (j) of key k; each is `width` numbers from position `first` of an element of `stride`
   numbers. */
static void set_cubic(mote_rig *rig, mote_rig_track *track, const mote_gltf_numbers *times,
                      const double *keys, size_t first, size_t stride, size_t width)
{
    const size_t rows = 3 * times->count;
    *track = (mote_rig_track){MOTE_TRACK_CUBIC, (uint32_t)times->count,
                              (uint32_t)rig->times_count, (uint32_t)rig->values_count};
    MOTE_RIG_GROW(rig, times, times->count);
    MOTE_RIG_GROW(rig, values, rows * width);
    for (size_t k = 0; k < times->count; ++k)
        rig->times[track->time + k] = times->values[k];
    for (size_t r = 0; r < rows; ++r) {
        for (size_t c = 0; c < width; ++c) /* w first */
            rig->values[track->value + r * width + c] =
                keys[r * stride + first + (width == 4 ? (c + 3) % 4 : c)];
    }
}

/* The tracks of a channel: one, or one for each morph target of a node. */
typedef struct tracks {
    mote_rig_track **list;
    size_t count, width;
} tracks;

static void find_tracks(reader *r, const mote_rig_clip *clip, uint32_t node, const char *path,
                        tracks *found)
{
    const size_t most = (size_t)clip->morph_count + 1;
    *found = (tracks){mote_allocate(most, sizeof(mote_rig_track *)), 0, 1};
    for (uint32_t m = 0; strcmp(path, "weights") == 0 && m < clip->morph_count; ++m) {
        mote_rig_morph *morph = &r->rig->morphs[clip->morph + m];
        if (r->rig->targets[morph->target].node == node)
            found->list[found->count++] = &morph->weight;
    }
    for (uint32_t c = 0; c < clip->channel_count; ++c) {
        mote_rig_channel *channel = &r->rig->channels[clip->channel + c];
        mote_rig_track *track = strcmp(path, "translation") == 0 ? &channel->position
                                : strcmp(path, "rotation") == 0  ? &channel->rotation
                                : strcmp(path, "scale") == 0     ? &channel->scale
                                                                 : NULL;
        if (channel->node != node || !track || found->count > 0)
            continue;
        found->list[found->count++] = track;
        found->width = track == &channel->rotation ? 4 : 3;
    }
}

/* The targets of a primitive are in order; further primitives of a node repeat them. */
static mote_status set_cubics(reader *r, const json_t *sampler, const tracks *found,
                              const char *path)
{
    mote_gltf_numbers times = {0}, keys = {0};
    const bool is_morph = strcmp(path, "weights") == 0;
    mote_status status =
        mote_gltf_read(r->gltf, cubic_keys, mote_gltf_whole(sampler, "input"), 1, true, &times);
    if (status == MOTE_OK)
        status = mote_gltf_read(r->gltf, cubic_keys, mote_gltf_whole(sampler, "output"),
                                found->width, true, &keys);
    const size_t stride = times.count > 0 ? keys.count / (3 * times.count) : 0;
    if (status == MOTE_OK &&
        (stride == 0 || stride * 3 * times.count != keys.count || (!is_morph && stride != 1)))
        status = mote_fail(MOTE_EINVAL,
                           "%s: cubic keys that are not three for each time; give a value and "
                           "two tangents for each",
                           r->gltf->path);
    for (size_t t = 0; stride > 0 && t < found->count && status == MOTE_OK; ++t)
        set_cubic(r->rig, found->list[t], &times, keys.values, is_morph ? t % stride : 0,
                  is_morph ? stride : found->width, found->width);
    free(times.values);
    free(keys.values);
    return status;
}

/* assimp takes negative weights for 0. The times of its keys stay: they are those of the file,
   rounded. */
static mote_status set_weights(reader *r, const json_t *sampler, const tracks *found)
{
    static const char what[] = "keys of weights";
    mote_gltf_numbers weights = {0};
    mote_status status =
        mote_gltf_read(r->gltf, what, mote_gltf_whole(sampler, "output"), 1, true, &weights);
    for (size_t t = 0; t < found->count && status == MOTE_OK; ++t) {
        const mote_rig_track *track = found->list[t];
        const size_t stride = weights.count / track->count;
        if (stride == 0 || stride * track->count != weights.count)
            status = mote_fail(MOTE_EINVAL,
                               "%s: %s that are not equally many for each time; give one for "
                               "each target",
                               r->gltf->path, what);
        for (size_t k = 0; k < track->count && status == MOTE_OK; ++k)
            r->rig->values[track->value + k] = weights.values[k * stride + t % stride];
    }
    free(weights.values);
    return status;
}

static mote_status set_channel(reader *r, const json_t *animation, const json_t *channel,
                               const mote_rig_clip *clip)
{
    const json_t *target = json_object_get(channel, "target");
    const json_t *sampler = mote_gltf_sampler(animation, channel);
    const char *path = json_string_value(json_object_get(target, "path"));
    const char *mode = json_string_value(json_object_get(sampler, "interpolation"));
    if (!sampler || !mote_gltf_moves(r->gltf, channel))
        return MOTE_OK;
    const uint32_t node = r->nodes[mote_gltf_whole(target, "node")];
    if (node == MOTE_RIG_NONE)
        return MOTE_OK; /* it is not in the scene */
    tracks found;
    mote_status status = MOTE_OK;
    find_tracks(r, clip, node, path, &found);
    for (size_t t = 0; t < found.count && mode && strcmp(mode, "STEP") == 0; ++t)
        found.list[t]->mode = MOTE_TRACK_STEP;
    if (found.count > 0 && mode && strcmp(mode, "CUBICSPLINE") == 0)
        status = set_cubics(r, sampler, &found, path);
    else if (found.count > 0 && strcmp(path, "weights") == 0)
        status = set_weights(r, sampler, &found);
    free(found.list);
    return status;
}

mote_status mote_character_set_gltf_keys(mote_gltf *gltf, const uint32_t *nodes, mote_rig *rig)
{
    reader r = {.gltf = gltf, .nodes = nodes, .rig = rig};
    const json_t *animations = json_object_get(gltf->root, "animations");
    const size_t count = json_array_size(animations);
    mote_status status = MOTE_OK;
    if (count != rig->clips_count)
        return mote_fail(MOTE_EINVAL,
                         "%s: %zu animations, of which assimp reads %zu; give each "
                         "a channel that moves something",
                         gltf->path, count, rig->clips_count);
    for (size_t k = 0; k < count && status == MOTE_OK; ++k) {
        const json_t *animation = json_array_get(animations, k);
        const json_t *channels = json_object_get(animation, "channels");
        for (size_t c = 0; c < json_array_size(channels) && status == MOTE_OK; ++c)
            status = set_channel(&r, animation, json_array_get(channels, c), &rig->clips[k]);
    }
    return status;
}
