/* character_glb FILE OUT.glb: writes a character as mote reads it, as a binary glTF of one
   mesh: without materials, textures and mesh names, with linear keys and at most four weights a
   vertex. The characters in datasets/characters were made by it to be small. */
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/mesh/character.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { UNSIGNED_BYTE = 5121, UNSIGNED_INT = 5125, FLOAT = 5126 };

typedef struct writer {
    const mote_character *c;
    unsigned char *bytes; /* of the buffer */
    size_t size, capacity;
    json_t *views, *accessors;
} writer;

static void add_bytes(writer *w, const void *data, size_t size)
{
    w->bytes = mote_reserve(w->bytes, w->size + size + 4, &w->capacity, 1);
    memcpy(w->bytes + w->size, data, size);
    w->size += size;
    for (; w->size % 4 != 0; ++w->size)
        w->bytes[w->size] = 0;
}

/* The number of a new accessor of count elements. */
static int add_accessor(writer *w, const void *data, size_t size, int component, size_t count,
                        const char *type)
{
    const int number = (int)json_array_size(w->accessors);
    (void)json_array_append_new(w->views,
                                json_pack("{s:i, s:I, s:I}", "buffer", 0, "byteOffset",
                                          (json_int_t)w->size, "byteLength", (json_int_t)size));
    (void)json_array_append_new(
        w->accessors, json_pack("{s:i, s:i, s:I, s:s}", "bufferView", number, "componentType",
                                component, "count", (json_int_t)count, "type", type));
    add_bytes(w, data, size);
    return number;
}

static int add_floats(writer *w, const double *values, size_t count, size_t width,
                      const char *type)
{
    float *floats = mote_allocate(count * width, sizeof *floats);
    for (size_t i = 0; i < count * width; ++i)
        floats[i] = (float)values[i];
    const int number =
        add_accessor(w, floats, count * width * sizeof *floats, FLOAT, count, type);
    free(floats);
    return number;
}

static json_t *primitive(writer *w)
{
    const mote_character *c = w->c;
    const mote_mesh *mesh = c->mesh;
    unsigned char *joints = mote_allocate(4 * (size_t)mesh->vertex_count, 1);
    double *weights = mote_allocate(4 * (size_t)mesh->vertex_count, sizeof *weights);
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        for (uint32_t i = c->start[v], k = 4 * v; i < c->start[v + 1]; ++i, ++k) {
            joints[k] = (unsigned char)c->bone[i];
            weights[k] = c->weight[i];
        }
    }
    const int place = add_floats(w, &mesh->positions[0].x, mesh->vertex_count, 3, "VEC3");
    json_t *box = json_array_get(w->accessors, (size_t)place);
    (void)json_object_set_new(box, "min",
                              json_pack("[f,f,f]", mesh->low.x, mesh->low.y, mesh->low.z));
    (void)json_object_set_new(box, "max",
                              json_pack("[f,f,f]", mesh->high.x, mesh->high.y, mesh->high.z));
    const int joint = add_accessor(w, joints, 4 * (size_t)mesh->vertex_count, UNSIGNED_BYTE,
                                   mesh->vertex_count, "VEC4");
    const int weight = add_floats(w, weights, mesh->vertex_count, 4, "VEC4");
    const size_t corners = 3 * (size_t)mesh->triangle_count;
    const int faces = add_accessor(w, mesh->triangles, corners * sizeof(uint32_t), UNSIGNED_INT,
                                   corners, "SCALAR");
    free(joints);
    free(weights);
    return json_pack("{s:{s:i, s:i, s:i}, s:i}", "attributes", "POSITION", place, "JOINTS_0",
                     joint, "WEIGHTS_0", weight, "indices", faces);
}

static json_t *skin(writer *w)
{
    const mote_rig *rig = &w->c->rig;
    double *binds = mote_allocate(16 * rig->bones_count, sizeof *binds);
    json_t *joints = json_array();
    for (size_t b = 0; b < rig->bones_count; ++b) {
        (void)json_array_append_new(joints, json_integer(rig->bones[b].node));
        for (size_t k = 0; k < 16; ++k) /* columns */
            binds[16 * b + k] = k % 4 < 3 ? rig->bones[b].bind.m[k % 4][k / 4] : k == 15;
    }
    const int number = add_floats(w, binds, rig->bones_count, 16, "MAT4");
    free(binds);
    return json_pack("{s:i, s:o}", "inverseBindMatrices", number, "joints", joints);
}

/* Splits a map without shear into translation, rotation and scale. */
static void split(const mote_affine *a, double t[3], double q[4], double s[3])
{
    double m[3][3];
    for (int c = 0; c < 3; ++c) {
        t[c] = a->m[c][3];
        s[c] =
            sqrt(a->m[0][c] * a->m[0][c] + a->m[1][c] * a->m[1][c] + a->m[2][c] * a->m[2][c]);
        for (int r = 0; r < 3; ++r)
            m[r][c] = a->m[r][c] / s[c];
    }
    const double squares[4] = {1 + m[0][0] - m[1][1] - m[2][2], 1 - m[0][0] + m[1][1] - m[2][2],
                               1 - m[0][0] - m[1][1] + m[2][2],
                               1 + m[0][0] + m[1][1] + m[2][2]};
    int most = 3;
    for (int k = 0; k < 3; ++k)
        most = squares[k] > squares[most] ? k : most;
    const double f = 1 / (2 * sqrt(squares[most]));
    const int i = most, j = (i + 1) % 3, k = (i + 2) % 3;
    if (most == 3) {
        const double x[4] = {m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1],
                             squares[3]};
        for (int e = 0; e < 4; ++e)
            q[e] = x[e] * f;
        return;
    }
    q[i] = squares[i] * f;
    q[j] = (m[i][j] + m[j][i]) * f;
    q[k] = (m[i][k] + m[k][i]) * f;
    q[3] = (m[k][j] - m[j][k]) * f;
}

static json_t *nodes(const mote_rig *rig)
{
    json_t *all = json_array();
    for (size_t n = 0; n < rig->nodes_count; ++n) {
        double t[3], q[4], s[3];
        split(&rig->nodes[n].rest, t, q, s);
        (void)json_array_append_new(
            all, json_pack("{s:s, s:[f,f,f], s:[f,f,f,f], s:[f,f,f]}", "name",
                           rig->names + rig->nodes[n].name, "translation", t[0], t[1], t[2],
                           "rotation", q[0], q[1], q[2], q[3], "scale", s[0], s[1], s[2]));
        if (rig->nodes[n].parent == MOTE_RIG_NONE)
            continue;
        json_t *parent = json_array_get(all, rig->nodes[n].parent);
        if (!json_object_get(parent, "children"))
            (void)json_object_set_new(parent, "children", json_array());
        (void)json_array_append_new(json_object_get(parent, "children"),
                                    json_integer((json_int_t)n));
    }
    return all;
}

/* A track that does not move needs one key. */
static uint32_t needed_keys(const mote_rig *rig, const mote_rig_track *track, size_t width)
{
    const double *values = rig->values + track->value;
    for (uint32_t k = 1; k < track->count; ++k) {
        if (memcmp(values, values + k * width, width * sizeof *values) != 0)
            return track->count;
    }
    return 1;
}

static void add_track(writer *w, uint32_t node, const char *path, const mote_rig_track *track,
                      size_t width, json_t *samplers, json_t *channels)
{
    const mote_rig *rig = &w->c->rig;
    const uint32_t count = needed_keys(rig, track, width);
    double *values = mote_copy(rig->values + track->value, count * width * sizeof *values);
    for (uint32_t k = 0; width == 4 && k < count; ++k) { /* w last */
        const double first = values[4 * (size_t)k];
        memmove(values + 4 * (size_t)k, values + 4 * (size_t)k + 1, 3 * sizeof *values);
        values[4 * (size_t)k + 3] = first;
    }
    const int input = add_floats(w, rig->times + track->time, count, 1, "SCALAR");
    const int output = add_floats(w, values, count, width, width == 4 ? "VEC4" : "VEC3");
    free(values);
    (void)json_array_append_new(channels, json_pack("{s:I, s:{s:i, s:s}}", "sampler",
                                                    (json_int_t)json_array_size(samplers),
                                                    "target", "node", (int)node, "path", path));
    (void)json_array_append_new(samplers,
                                json_pack("{s:i, s:i}", "input", input, "output", output));
}

static json_t *clip(writer *w, const mote_rig_clip *from)
{
    const mote_rig *rig = &w->c->rig;
    json_t *samplers = json_array(), *channels = json_array();
    for (uint32_t k = 0; k < from->channel_count; ++k) {
        const mote_rig_channel *channel = &rig->channels[from->channel + k];
        add_track(w, channel->node, "translation", &channel->position, 3, samplers, channels);
        add_track(w, channel->node, "rotation", &channel->rotation, 4, samplers, channels);
        add_track(w, channel->node, "scale", &channel->scale, 3, samplers, channels);
    }
    return json_pack("{s:s, s:o, s:o}", "name", rig->names + from->name, "samplers", samplers,
                     "channels", channels);
}

static json_t *document(writer *w)
{
    const mote_rig *rig = &w->c->rig;
    json_t *meshes = json_pack("[{s:[o]}]", "primitives", primitive(w));
    json_t *skins = json_pack("[o]", skin(w));
    json_t *all = nodes(rig), *clips = json_array();
    const int body = (int)json_array_size(all);
    (void)json_array_append_new(
        all, json_pack("{s:s, s:i, s:i}", "name", "body", "mesh", 0, "skin", 0));
    for (size_t k = 0; k < rig->clips_count; ++k) {
        if (rig->clips[k].seconds > 0)
            (void)json_array_append_new(clips, clip(w, &rig->clips[k]));
    }
    return json_pack("{s:{s:s}, s:i, s:[{s:[i,i]}], s:o, s:o, s:o, s:o, s:[{s:I}], s:o, s:o}",
                     "asset", "version", "2.0", "scene", 0, "scenes", "nodes", 0, body, "nodes",
                     all, "meshes", meshes, "skins", skins, "animations", clips, "buffers",
                     "byteLength", (json_int_t)w->size, "bufferViews", w->views, "accessors",
                     w->accessors);
}

static void add_word(mote_text *text, size_t word)
{
    for (int k = 0; k < 4; ++k)
        mote_text_add(text, "%c", 0);
    for (size_t k = 0; k < 4; ++k)
        text->data[text->size - 4 + k] = (char)(word >> (8 * k) & 0xff);
}

static mote_status write_glb(const mote_character *c, const char *path)
{
    writer w = {.c = c, .views = json_array(), .accessors = json_array()};
    json_t *root = document(&w);
    char *text = json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(9));
    const size_t length = strlen(text), padded = (length + 3) / 4 * 4;
    FILE *out = fopen(path, "wb");
    mote_text head = {0};
    const size_t words[] = {0x46546c67, 2, 28 + padded + w.size, padded, 0x4e4f534a};
    for (size_t k = 0; k < sizeof words / sizeof words[0]; ++k)
        add_word(&head, words[k]);
    mote_text_add(&head, "%s%.*s", text, (int)(padded - length), "   ");
    add_word(&head, w.size);
    add_word(&head, 0x004e4942);
    bool good = out && fwrite(head.data, 1, head.size, out) == head.size &&
                fwrite(w.bytes, 1, w.size, out) == w.size;
    good = out && fclose(out) == 0 && good;
    json_decref(root);
    free(text);
    free(head.data);
    free(w.bytes);
    return good ? MOTE_OK : mote_fail(MOTE_EIO, "%s: cannot be written", path);
}

static mote_status check(const mote_character *c, const char *path)
{
    uint32_t most = 0;
    for (uint32_t v = 0; v < c->mesh->vertex_count; ++v)
        most = c->start[v + 1] - c->start[v] > most ? c->start[v + 1] - c->start[v] : most;
    if (most > 4 || c->rig.bones_count > 256 || c->rig.targets_count > 0)
        return mote_fail(
            MOTE_EINVAL,
            "%s: %u weights a vertex, %zu bones and %zu morph targets; give at most "
            "4, 256 and 0",
            path, most, c->rig.bones_count, c->rig.targets_count);
    return MOTE_OK;
}

int main(int argc, char **argv)
{
    mote_character *c = NULL;
    if (argc != 3) {
        fprintf(stderr, "usage: character_glb FILE OUT.glb\n");
        return 2;
    }
    mote_status status = mote_character_import_file(argv[1], &c, NULL);
    if (status == MOTE_OK)
        status = check(c, argv[1]);
    if (status == MOTE_OK)
        status = write_glb(c, argv[2]);
    mote_character_destroy(c);
    if (status != MOTE_OK)
        fprintf(stderr, "character_glb: %s\n", mote_error_text());
    return status == MOTE_OK ? 0 : 1;
}
