#include "harness/command/character_facts.h"

#include "harness/mesh/character.h"

#include <math.h>
#include <stdio.h>

/* At most this many names of bones and targets are shown. */
#define NAMED 12

typedef struct weight_facts {
    uint32_t most;
    double mean;
} weight_facts;

static weight_facts count_weights(const mote_character *c)
{
    weight_facts facts = {0, (double)c->weight_count / c->mesh->vertex_count};
    for (uint32_t v = 0; v < c->mesh->vertex_count; ++v) {
        const uint32_t own = c->start[v + 1] - c->start[v];
        facts.most = own > facts.most ? own : facts.most;
    }
    return facts;
}

/* The number of keys in a clip, over all of its tracks. */
static size_t count_keys(const mote_rig *rig, const mote_rig_clip *clip)
{
    size_t keys = 0;
    for (uint32_t c = 0; c < clip->channel_count; ++c) {
        const mote_rig_channel *channel = &rig->channels[clip->channel + c];
        keys +=
            (size_t)channel->position.count + channel->rotation.count + channel->scale.count;
    }
    for (uint32_t m = 0; m < clip->morph_count; ++m)
        keys += rig->morphs[clip->morph + m].weight.count;
    return keys;
}

static void print_names(const mote_character *c)
{
    const mote_rig *rig = &c->rig;
    for (size_t b = 0; b < rig->bones_count && b < NAMED; ++b)
        (void)printf("%s%s", b ? ", " : ": ", rig->names + rig->nodes[rig->bones[b].node].name);
    (void)printf("%s\n", rig->bones_count > NAMED ? ", ..." : "");
}

static void print_targets(const mote_rig *rig)
{
    if (rig->targets_count == 0)
        return;
    (void)printf("morph targets       %zu", rig->targets_count);
    for (size_t t = 0; t < rig->targets_count && t < NAMED; ++t)
        (void)printf("%s%s", t ? ", " : ": ", rig->names + rig->targets[t].name);
    (void)printf("%s\n", rig->targets_count > NAMED ? ", ..." : "");
}

static void print_clips(const mote_rig *rig)
{
    (void)printf("clips               %zu\n", rig->clips_count);
    for (size_t k = 0; k < rig->clips_count; ++k) {
        const mote_rig_clip *clip = &rig->clips[k];
        const char *name = rig->names + clip->name;
        (void)printf("  clip %-4zu         %.4g s, %zu keys of %u nodes and %u targets%s%s\n",
                     k + 1, clip->seconds, count_keys(rig, clip), clip->channel_count,
                     clip->morph_count, *name ? ": " : "", name);
    }
}

void mote_character_facts_print(const char *path)
{
    mote_character *c;
    mote_character_import import;
    const mote_status status = mote_character_import_file(path, &c, &import);
    if (status != MOTE_OK) {
        if (status != MOTE_EUNSUPPORTED)
            (void)printf("character           none: %s\n", mote_error_text());
        return;
    }
    const weight_facts weights = count_weights(c);
    (void)printf("character           %u vertices, %u triangles of %zu mesh%s\n",
                 c->mesh->vertex_count, c->mesh->triangle_count, import.meshes,
                 import.meshes == 1 ? "" : "es");
    (void)printf("bones               %zu", c->rig.bones_count);
    print_names(c);
    (void)printf("weights a vertex    %.3g on average, %u at most; sums off by %.2g at most",
                 weights.mean, weights.most, import.off);
    if (import.off_count > 0)
        (void)printf(", in %.3g %% of the file's by more than 1e-4: normalised",
                     100.0 * (double)import.off_count / (double)import.given);
    (void)printf("\n");
    if (import.unweighted > 0)
        (void)printf("                    %.3g %% of the file's vertices have none and follow "
                     "their mesh\n",
                     100.0 * (double)import.unweighted / (double)import.given);
    if (import.apart > 0)
        (void)printf("kept apart          %zu vertices at the place of another that moves "
                     "differently: weights differ by %.2g at most\n",
                     import.apart, import.apart_most);
    print_targets(&c->rig);
    print_clips(&c->rig);
    mote_character_destroy(c);
}

/* A name as JSON, which must be UTF-8, as the name may not be. */
static json_t *name_json(const char *name)
{
    json_t *text = json_string(name);
    return text ? text : json_string("?");
}

static json_t *clips_json(const mote_rig *rig)
{
    json_t *clips = json_array();
    for (size_t k = 0; k < rig->clips_count; ++k) {
        const mote_rig_clip *clip = &rig->clips[k];
        (void)json_array_append_new(
            clips,
            json_pack("{s:o, s:f, s:I, s:i, s:i}", "name", name_json(rig->names + clip->name),
                      "seconds", clip->seconds, "keys", (json_int_t)count_keys(rig, clip),
                      "nodes", (int)clip->channel_count, "targets", (int)clip->morph_count));
    }
    return clips;
}

static json_t *made_json(const mote_character *c, const mote_character_import *import)
{
    const weight_facts weights = count_weights(c);
    json_t *bones = json_array(), *targets = json_array();
    for (size_t b = 0; b < c->rig.bones_count; ++b)
        (void)json_array_append_new(
            bones, name_json(c->rig.names + c->rig.nodes[c->rig.bones[b].node].name));
    for (size_t t = 0; t < c->rig.targets_count; ++t)
        (void)json_array_append_new(targets, name_json(c->rig.names + c->rig.targets[t].name));
    return json_pack(
        "{s:i, s:i, s:I, s:o, s:f, s:i, s:f, s:I, s:I, s:I, s:f, s:o, s:o}", "vertices",
        (int)c->mesh->vertex_count, "triangles", (int)c->mesh->triangle_count, "meshes",
        (json_int_t)import->meshes, "bones", bones, "weights_mean", weights.mean,
        "weights_most", (int)weights.most, "weights_off", import->off, "weights_off_vertices",
        (json_int_t)import->off_count, "unweighted", (json_int_t)import->unweighted,
        "kept_apart", (json_int_t)import->apart, "kept_apart_difference", import->apart_most,
        "morph_targets", targets, "clips", clips_json(&c->rig));
}

json_t *mote_character_facts_json(const char *path)
{
    mote_character *c;
    mote_character_import import;
    const mote_status status = mote_character_import_file(path, &c, &import);
    if (status == MOTE_EUNSUPPORTED)
        return json_null();
    if (status != MOTE_OK)
        return json_pack("{s:o}", "error", name_json(mote_error_text()));
    json_t *made = made_json(c, &import);
    mote_character_destroy(c);
    return made;
}
