/* The animations of a glTF text, read into a rig whose tracks are linear: what each entry
   changes, and what is wrong with entries that are refused. */
#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/mesh/character_parts.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

/* The floats 0 and 2 (times), then 1 to 24. */
#define DATA                                                                                   \
    "AAAAAAAAAEAAAIA/AAAAQAAAQEAAAIBAAACgQAAAwEAAAOBAAAAAQQAAEEEAACBBAAAwQQAAQEEAAFBBAABgQQAA" \
    "cEEAAIBBAACIQQAAkEEAAJhBAACgQQAAqEEAALBBAAC4QQAAwEE="
#define URI "\"uri\":\"data:application/octet-stream;base64," DATA "\""
#define PATH "\"path\":\"translation\""
#define MODE "\"interpolation\":\"CUBICSPLINE\""
#define NODE "\"node\":0"
#define TIMES "{\"bufferView\":0,\"componentType\":5126,\"count\":2}"
#define KEYS "{\"bufferView\":1,\"componentType\":5126,\"count\":6}"
#define VIEW "{\"buffer\":0,\"byteOffset\":8}"
#define CLIP                                                                                   \
    "{\"channels\":[{\"sampler\":0,\"target\":{" NODE "," PATH                                 \
    "}}],\"samplers\":[{\"input\":0,\"output\":1," MODE "}]}"
#define WHOLE                                                                                  \
    "{\"nodes\":[{\"name\":\"Part\"},{},{\"name\":\"\"}],\"animations\":[" CLIP                \
    "],\"accessors\":[" TIMES "," KEYS "],\"bufferViews\":[{\"buffer\":0}," VIEW               \
    "],\"buffers\":[{" URI "}]}"

/* The text with `from` replaced by `to`; both may be NULL. */
static char *whole_but(const char *from, const char *to)
{
    static const char whole[] = WHOLE;
    const char *at = from ? strstr(whole, from) : whole;
    assert_non_null(at);
    return mote_format("%.*s%s%s", (int)(at - whole), whole, to ? to : "",
                       at + (from ? strlen(from) : 0));
}

static mote_rig_track add_track(mote_rig *rig, uint32_t width)
{
    const mote_rig_track track = {MOTE_TRACK_LINEAR, 1, (uint32_t)rig->times_count,
                                  (uint32_t)rig->values_count};
    MOTE_RIG_GROW(rig, times, 1);
    MOTE_RIG_GROW(rig, values, width);
    return track;
}

/* Nodes "Part", "nodes[1]" and "nodes[2]"; the clip moves all, and two morph targets of the
   first. */
static mote_rig make_rig(void)
{
    static const char *const names[] = {"Part", "nodes[1]", "nodes[2]"};
    mote_rig rig = {0};
    MOTE_RIG_GROW(&rig, nodes, 3);
    MOTE_RIG_GROW(&rig, channels, 3);
    MOTE_RIG_GROW(&rig, targets, 3);
    MOTE_RIG_GROW(&rig, morphs, 3);
    MOTE_RIG_GROW(&rig, clips, 1);
    for (uint32_t n = 0; n < 3; ++n) {
        rig.nodes[n].parent = MOTE_RIG_NONE;
        rig.nodes[n].name = mote_rig_add_name(&rig, names[n]);
        rig.channels[n].node = n;
        rig.channels[n].position = add_track(&rig, 3);
        rig.channels[n].rotation = add_track(&rig, 4);
        rig.channels[n].scale = add_track(&rig, 3);
        rig.targets[n].node = n / 2;
        rig.morphs[n].target = n;
        rig.morphs[n].weight = add_track(&rig, 1);
    }
    rig.clips[0].channel_count = rig.clips[0].morph_count = 3;
    return rig;
}

/* Which tracks are not linear: p, r and s of a channel's node, w of a morph target, with c for
   cubic after those that are not step. */
static char *changed(const mote_rig *rig)
{
    mote_text text = {0};
    mote_text_add(&text, "%s", "");
    for (uint32_t n = 0; n < 3; ++n) {
        const mote_rig_track *const all[] = {&rig->channels[n].position,
                                             &rig->channels[n].rotation,
                                             &rig->channels[n].scale, &rig->morphs[n].weight};
        for (int k = 0; k < 4; ++k) {
            if (all[k]->mode != MOTE_TRACK_LINEAR)
                mote_text_add(&text, "%c%u%s", "prsw"[k], n,
                              all[k] -> mode == MOTE_TRACK_CUBIC ? "c" : "");
        }
    }
    return text.data;
}

/* The rig's nodes are in the file's order. */
static mote_status set_keys_of(const char *path, const char *data, size_t size, mote_rig *rig)
{
    static const uint32_t nodes[] = {0, 1, 2, MOTE_RIG_NONE};
    mote_gltf gltf;
    *rig = make_rig();
    mote_status status = mote_gltf_open(path, data, size, &gltf);
    if (status != MOTE_OK)
        return status;
    status = mote_character_set_gltf_keys(&gltf, nodes, rig);
    mote_gltf_close(&gltf);
    return status;
}

static mote_status set_keys(const char *text, mote_rig *rig)
{
    return set_keys_of("k.gltf", text, strlen(text), rig);
}

TEST(gltf_keys_change_the_tracks_that_their_channels_name)
{
    static const struct {
        const char *from, *to, *changes;
    } rows[] = {
        {NULL, NULL, "p0c"},
        {PATH, "\"path\":\"scale\"", "s0c"},
        {PATH, "\"path\":\"colour\"", ""},
        {PATH "}", "\"paths\":\"scale\"}", ""},
        {NODE, "\"node\":1", "p1c"},
        {NODE, "\"node\":2", "p2c"},
        {NODE, "\"node\":7", ""},
        {NODE, "\"node\":\"Part\"", ""},
        {"{\"name\":\"Part\"},{}", "{},{\"name\":\"Part\"}", "p0c"},
        {"{\"name\":\"\"}],\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{" NODE,
         "{},{}],\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":3", ""},
        {MODE, "\"interpolation\":\"LINEAR\"", ""},
        {MODE, "\"interpolation\":\"STEP\"", "p0"},
        {MODE, "\"interpolation\":\"ODD\"", ""},
        {"," MODE, "", ""},
        {"\"sampler\":0", "\"sampler\":3", ""},
        {"\"sampler\":0", "\"sampler\":-1", ""},
        {"\"sampler\":0,", "", ""},
        {PATH "}}],\"samplers\":[{\"input\":0,\"output\":1," MODE,
         "\"path\":\"weights\"}}],\"samplers\":[{\"output\":1,\"interpolation\":\"STEP\"",
         "w0w1"},
        {NODE "," PATH "}}],\"samplers\":[{\"input\":0,\"output\":1," MODE,
         "\"node\":1,\"path\":\"weights\"}}],\"samplers\":[{\"output\":1,\"interpolation\":"
         "\"STEP\"",
         "w2"},
        {PATH, "\"path\":\"weights\"", "w0cw1c"},
        {"],"
         "\"accessors\"",
         "],\"more\":[],\"accessors\"", "p0c"},
        {VIEW, "{\"buffer\":0,\"byteOffset\":8,\"byteStride\":12}", "p0c"},
        {VIEW, "{\"buffer\":0,\"byteOffset\":8.0,\"byteStride\":12.0}", "p0c"},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_rig rig;
        char *text = whole_but(rows[i].from, rows[i].to);
        test_row("%s", text);
        if (set_keys(text, &rig) != MOTE_OK)
            fail_msg("%s", mote_error_text());
        char *changes = changed(&rig);
        assert_string_equal(changes, rows[i].changes);
        free(changes);
        free(text);
        mote_rig_free(&rig);
    }
}

static void check_values(const mote_rig *rig, const mote_rig_track *track, const double *wanted,
                         uint32_t count)
{
    assert_int_equal(track->mode, MOTE_TRACK_CUBIC);
    assert_int_equal(track->count, 2);
    assert_true(rig->times[track->time] == 0 && rig->times[track->time + 1] == 2);
    for (uint32_t k = 0; k < count; ++k) {
        if (rig->values[track->value + k] != wanted[k])
            fail_msg("number %u is %g, not %g", k, rig->values[track->value + k], wanted[k]);
    }
}

/* Of each key the arriving tangent, the value and the leaving tangent. */
TEST(gltf_keys_are_the_numbers_of_their_accessors)
{
    mote_rig rig;
    char *text = whole_but(NULL, NULL);
    double wanted[24];
    for (int k = 0; k < 24; ++k)
        wanted[k] = k + 1;
    assert_int_equal(set_keys(text, &rig), MOTE_OK);
    check_values(&rig, &rig.channels[0].position, wanted, 18);
    mote_rig_free(&rig);
    free(text);
    /* A quaternion's w comes last in glTF and first in a rig. */
    text = whole_but(PATH, "\"path\":\"rotation\"");
    assert_int_equal(set_keys(text, &rig), MOTE_OK);
    for (int k = 0; k < 24; ++k)
        wanted[k] = k % 4 == 0 ? k + 4 : k;
    check_values(&rig, &rig.channels[0].rotation, wanted, 24);
    mote_rig_free(&rig);
    free(text);
    /* Every fourth number begins an element. */
    text = whole_but(VIEW, "{\"buffer\":0,\"byteOffset\":8,\"byteStride\":16}");
    assert_int_equal(set_keys(text, &rig), MOTE_OK);
    for (int k = 0; k < 18; ++k)
        wanted[k] = k / 3 * 4 + k % 3 + 1;
    check_values(&rig, &rig.channels[0].position, wanted, 18);
    mote_rig_free(&rig);
    free(text);
    /* The offset of the accessor counts, too. */
    text = whole_but(KEYS, "{\"bufferView\":1,\"componentType\":5126,\"count\":6,"
                           "\"byteOffset\":4}");
    assert_int_equal(set_keys(text, &rig), MOTE_OK);
    for (int k = 0; k < 18; ++k)
        wanted[k] = k + 2;
    check_values(&rig, &rig.channels[0].position, wanted, 18);
    mote_rig_free(&rig);
    free(text);
}

/* Two targets take turns in the keys of one channel. */
TEST(gltf_keys_of_several_targets_take_turns)
{
    static const double first[] = {1, 3, 5, 7, 9, 11}, second[] = {2, 4, 6, 8, 10, 12};
    mote_rig rig;
    char *path = whole_but(PATH, "\"path\":\"weights\""), *at = strstr(path, KEYS);
    char *text = mote_format("%.*s{\"bufferView\":1,\"componentType\":5126,\"count\":12}%s",
                             (int)(at - path), path, at + strlen(KEYS));
    if (set_keys(text, &rig) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    check_values(&rig, &rig.morphs[0].weight, first, 6);
    check_values(&rig, &rig.morphs[1].weight, second, 6);
    assert_int_equal(rig.morphs[2].weight.mode, MOTE_TRACK_LINEAR);
    mote_rig_free(&rig);
    free(path);
    free(text);
}

TEST(gltf_keys_that_cannot_be_read_are_refused)
{
    static const char floats[] = "k.gltf: cubic keys that are no floats; give floats in a",
                      beyond[] = "k.gltf: cubic keys beyond the end of their buffer",
                      three[] = "k.gltf: cubic keys that are not three for each time",
                      folder[] =
                          "which is not in its folder; put that file beside it, or below",
                      offset[] = "k.gltf: cubic keys whose byteOffset or byteStride is not a "
                                 "whole number";
    static const struct {
        const char *from, *to, *says;
        mote_status status;
    } rows[] = {
        {"\"input\":0,", "", floats, MOTE_EINVAL},
        {"\"output\":1", "\"output\":5", floats, MOTE_EINVAL},
        {KEYS, "{\"componentType\":5126,\"count\":6}", floats, MOTE_EINVAL},
        {KEYS, "{\"bufferView\":1,\"componentType\":5126,\"count\":0}", floats, MOTE_EINVAL},
        {KEYS, "{\"bufferView\":1,\"componentType\":5123,\"count\":6}", floats, MOTE_EINVAL},
        {KEYS, "{\"bufferView\":1,\"componentType\":5126,\"count\":6,\"sparse\":{}}",
         "k.gltf: cubic keys that are sparse; give floats in a buffer of the file",
         MOTE_EINVAL},
        {VIEW, "{}", "k.gltf: cubic keys in no buffer", MOTE_EINVAL},
        {URI, "", "k.gltf: buffers[0] has no bytes; give it a uri", MOTE_EINVAL},
        {VIEW, "{\"buffer\":1}", "k.gltf: buffers[1] has no bytes; give it a uri", MOTE_EINVAL},
        {URI, URI ",\"byteLength\":105",
         "k.gltf: buffers[0] has 104 bytes, and byteLength says 105; give all of", MOTE_EINVAL},
        {URI, "\"uri\":\"/k.bin\"", folder, MOTE_EINVAL},
        {URI, "\"uri\":\"..\"", folder, MOTE_EINVAL},
        {URI, "\"uri\":\"..a/b../...//k..bin\"", "buffer ..a/b../...//k..bin: ", MOTE_EIO},
        {URI, "\"uri\":\".\"", "k.gltf: buffer .: not a regular file", MOTE_EINVAL},
        {URI, "\"uri\":\"a/../../k.bin\"", folder, MOTE_EINVAL},
        {URI, "\"uri\":\"a/%2E%2e/k.bin\"", folder, MOTE_EINVAL},
        {URI, "\"uri\":\"%2fk.bin\"", folder, MOTE_EINVAL},
        {URI, "\"uri\":\"none.bin\"", "k.gltf: buffer none.bin: ", MOTE_EIO},
        {URI, "\"uri\":\"no%20k%00.bin\"", "no k%00.bin: ", MOTE_EIO},
        {URI, "\"uri\":\"data:,AAAA\"", beyond, MOTE_EINVAL},
        {VIEW, "{\"buffer\":0,\"byteOffset\":8,\"byteStride\":4100}", beyond, MOTE_EINVAL},
        {VIEW, "{\"buffer\":0,\"byteOffset\":8,\"byteStride\":24}", beyond, MOTE_EINVAL},
        {VIEW, "{\"buffer\":0,\"byteOffset\":-8}", offset, MOTE_EINVAL},
        {VIEW, "{\"buffer\":0,\"byteOffset\":\"8\"}", offset, MOTE_EINVAL},
        {VIEW, "{\"buffer\":0,\"byteOffset\":8.5}", offset, MOTE_EINVAL},
        {VIEW, "{\"buffer\":0,\"byteOffset\":8,\"byteStride\":null}", offset, MOTE_EINVAL},
        {KEYS, "{\"bufferView\":1,\"componentType\":5126,\"count\":6,\"byteOffset\":true}",
         offset, MOTE_EINVAL},
        {VIEW, "{\"buffer\":0,\"byteOffset\":96}", beyond, MOTE_EINVAL},
        {VIEW, "{\"buffer\":0,\"byteOffset\":105}", beyond, MOTE_EINVAL},
        {VIEW, "{\"buffer\":0,\"byteOffset\":9223372036854775807}", beyond, MOTE_EINVAL},
        {DATA, "AAAAAAAAAEAA!", beyond, MOTE_EINVAL},
        {KEYS, "{\"bufferView\":1,\"componentType\":5126,\"count\":5}", three, MOTE_EINVAL},
        {KEYS, "{\"bufferView\":1,\"componentType\":5126,\"count\":7}", three, MOTE_EINVAL},
        {TIMES, "{\"bufferView\":0,\"componentType\":5126,\"count\":1}", three, MOTE_EINVAL},
        {PATH "}}],\"samplers\":[{\"input\":0,\"output\":1," MODE,
         "\"path\":\"weights\"}}],\"samplers\":[{\"input\":0",
         "k.gltf: keys of weights that are no floats; give floats in a buffer", MOTE_EINVAL},
        {"\"animations\":[", "\"animations\":[{},",
         "k.gltf: 2 animations, of which assimp reads 1; give each a channel", MOTE_EINVAL},
        {"\"animations\"", "\"animation\"", "k.gltf: 0 animations, of which assimp reads 1",
         MOTE_EINVAL},
        {"{\"nodes\"", "\n{nodes", "k.gltf:2: ", MOTE_EINVAL},
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_rig rig;
        char *text = whole_but(rows[i].from, rows[i].to);
        test_row("%s to %s", rows[i].from, rows[i].to);
        assert_int_equal(set_keys(text, &rig), rows[i].status);
        if (!strstr(mote_error_text(), rows[i].says))
            fail_msg("%s", mote_error_text());
        char *changes = changed(&rig);
        assert_string_equal(changes, "");
        free(changes);
        free(text);
        mote_rig_free(&rig);
    }
}

/* A buffer in a file beside the text, and one more for the times. */
TEST(gltf_keys_are_read_from_buffers_in_files)
{
    static const float times[] = {0, 2};
    float keys[24];
    mote_rig rig;
    double wanted[18];
    for (int k = 0; k < 24; ++k)
        keys[k] = (float)(k + 1) / 2;
    for (int k = 0; k < 18; ++k)
        wanted[k] = (k + 1) / 2.0;
    file_write("times.bin", times, sizeof times);
    file_write("my keys.bin", keys, sizeof keys);
    char *first = whole_but(URI, "\"uri\":\"times.bin\"},{\"uri\":\"my%20keys.bin\"");
    char *at = strstr(first, VIEW);
    char *text =
        mote_format("%.*s{\"buffer\":1}%s", (int)(at - first), first, at + strlen(VIEW));
    if (set_keys(text, &rig) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    check_values(&rig, &rig.channels[0].position, wanted, 18);
    mote_rig_free(&rig);
    free(first);
    free(text);
}

typedef struct chunks {
    char data[4096];
    size_t size;
} chunks;

static void put(chunks *file, const void *data, size_t size)
{
    memcpy(file->data + file->size, data, size);
    file->size += size;
}

static void put_word(chunks *file, uint32_t word)
{
    for (int k = 0; k < 4; ++k)
        file->data[file->size++] = (char)(word >> (8 * k) & 0xff);
}

/* A binary file: a header of 12 bytes and two chunks, with lengths that may be wrong. */
static chunks binary(size_t spaces, size_t text_more, size_t bytes_more)
{
    chunks file = {.size = 0};
    char *plain = whole_but(URI, "");
    char *text = mote_format("%s%*s", plain, (int)(4 - strlen(plain) % 4 + spaces), "");
    const size_t length = strlen(text);
    put(&file, "glTF\2\0\0\0\0\0\0\0", 12);
    put_word(&file, (uint32_t)(length + text_more));
    put(&file, "JSON", 4);
    put(&file, text, length);
    put_word(&file, (uint32_t)(104 + bytes_more));
    put(&file, "BIN", 4);
    put(&file, (float[]){0, 2}, 8);
    for (int k = 1; k <= 24; ++k)
        put(&file, &(float){(float)k}, 4);
    free(plain);
    free(text);
    return file;
}

TEST(gltf_keys_of_a_binary_file_are_in_its_second_chunk)
{
    static const char early[] = "k.glb: ends early; give the whole file",
                      none[] = "k.glb: buffers[0] has no bytes; give it a uri";
    const chunks whole = binary(0, 0, 0), far_text = binary(0, 1000, 0),
                 far_bytes = binary(0, 0, 1), odd = binary(2, 0, 0);
    const size_t text = whole.size - 104 - 8;
    const struct {
        const chunks *file;
        size_t size;
        const char *says; /* "": it is read */
    } rows[] = {
        {&whole, whole.size, ""},
        {&whole, 3, "k.glb:1: "},
        {&whole, 4, "k.glb: ends after 4 of 12 bytes; give the whole"},
        {&whole, 19, early},
        {&whole, 20, early},
        {&whole, text - 1, early},
        {&whole, text, none},
        {&whole, text + 7, none},
        {&whole, whole.size - 1, none},
        {&far_text, far_text.size, early},
        {&far_bytes, far_bytes.size, none},
        {&odd, odd.size, "which is no multiple of 4; add spaces"},
    };
    double wanted[18];
    for (int k = 0; k < 18; ++k)
        wanted[k] = k + 1;
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        mote_rig rig;
        test_row("%zu: %zu bytes", i, rows[i].size);
        const mote_status status = set_keys_of("k.glb", rows[i].file->data, rows[i].size, &rig);
        if (rows[i].says[0] ? status != MOTE_EINVAL || !strstr(mote_error_text(), rows[i].says)
                            : status != MOTE_OK)
            fail_msg("status %d: %s", (int)status, mote_error_text());
        if (status == MOTE_OK)
            check_values(&rig, &rig.channels[0].position, wanted, 18);
        mote_rig_free(&rig);
    }
}
