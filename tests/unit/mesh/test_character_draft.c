/* A draft of a character, made by hand: what its parent process refuses to take, and what its
   rig is refused for. */
#include "harness/base/file.h"
#include "harness/mesh/character.h"
#include "harness/mesh/character_parts.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

#include <fcntl.h>
#include <math.h>
#include <unistd.h>

static mote_rig_track add_track(mote_rig *rig, uint32_t mode, uint32_t width)
{
    const uint32_t numbers = mode == MOTE_TRACK_CUBIC ? 3 * width : width;
    const mote_rig_track track = {mode, 2, (uint32_t)rig->times_count,
                                  (uint32_t)rig->values_count};
    MOTE_RIG_GROW(rig, times, 2);
    MOTE_RIG_GROW(rig, values, (size_t)2 * numbers);
    rig->times[track.time + 1] = 1;
    for (uint32_t i = 0; i < 2 * numbers; ++i)
        rig->values[track.value + i] = 0.5;
    return track;
}

/* A triangle on two bones, its first corner also on a morph target; one clip moves all. */
static mote_character_draft make_draft(void)
{
    static const uint32_t start[] = {0, 1, 2, 4}, shift_start[] = {0, 1, 1, 1};
    static const uint16_t bone[] = {0, 1, 0, 1};
    static const double weight[] = {1, 1, 0.25, 0.75};
    mote_character_draft draft = {.import = {.meshes = 1}};
    mote_character *c = &draft.made;
    mote_rig *rig = &c->rig;
    for (int v = 0; v < 3; ++v)
        assert_int_equal(mote_soup_add_vertex(&draft.soup, v == 1, v == 2, 0), MOTE_OK);
    mote_soup_add_triangle(&draft.soup, 0, 1, 2);
    MOTE_RIG_GROW(rig, nodes, 2);
    MOTE_RIG_GROW(rig, bones, 2);
    MOTE_RIG_GROW(rig, targets, 1);
    MOTE_RIG_GROW(rig, clips, 1);
    MOTE_RIG_GROW(rig, channels, 1);
    MOTE_RIG_GROW(rig, morphs, 1);
    rig->nodes[0] =
        (mote_rig_node){MOTE_RIG_NONE, mote_rig_add_name(rig, "Root"), mote_affine_identity()};
    rig->nodes[1] = (mote_rig_node){0, mote_rig_add_name(rig, "Joint"), mote_affine_identity()};
    for (uint32_t b = 0; b < 2; ++b)
        rig->bones[b] = (mote_rig_bone){b, mote_affine_identity()};
    rig->targets[0].name = mote_rig_add_name(rig, "Smile");
    rig->clips[0].name = mote_rig_add_name(rig, "");
    rig->clips[0].channel_count = rig->clips[0].morph_count = 1;
    rig->clips[0].seconds = 1;
    rig->channels[0].node = 1;
    rig->channels[0].position = add_track(rig, MOTE_TRACK_STEP, 3);
    rig->channels[0].rotation = add_track(rig, MOTE_TRACK_LINEAR, 4);
    rig->channels[0].scale = add_track(rig, MOTE_TRACK_LINEAR, 3);
    rig->morphs[0].weight = add_track(rig, MOTE_TRACK_CUBIC, 1);
    MOTE_RIG_GROW(c, start, 4);
    MOTE_RIG_GROW(c, shift_start, 4);
    MOTE_RIG_GROW(c, bone, 4);
    MOTE_RIG_GROW(c, weight, 4);
    MOTE_RIG_GROW(c, target, 1);
    MOTE_RIG_GROW(c, shift, 1);
    memcpy(c->start, start, sizeof start);
    memcpy(c->shift_start, shift_start, sizeof shift_start);
    memcpy(c->bone, bone, sizeof bone);
    memcpy(c->weight, weight, sizeof weight);
    return draft;
}

/* Through a file, `more` bytes longer or shorter. */
static mote_status send(const mote_character_draft *draft, long more,
                        mote_character_draft *taken)
{
    char *data = NULL;
    size_t size = 0;
    const int out = open("sent", O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    assert_true(out >= 0);
    assert_int_equal(mote_character_send(out, draft), MOTE_OK);
    assert_int_equal(ftruncate(out, lseek(out, 0, SEEK_CUR) + more), 0);
    assert_int_equal(close(out), 0);
    assert_int_equal(mote_file_read("sent", (size_t)1 << 26, &data, &size), MOTE_OK);
    const mote_status status = mote_character_receive("k.x", data, size, taken);
    free(data);
    return status;
}

static void refuse(const mote_character_draft *draft, long more, const char *says)
{
    mote_character_draft taken;
    assert_int_equal(send(draft, more, &taken), MOTE_EIO);
    assert_string_equal(mote_error_text(), says);
}

#define EARLY "k.x: reading it ended early"

TEST(character_draft_arrives_as_it_was_sent)
{
    mote_character_draft draft = make_draft(), taken;
    assert_int_equal(send(&draft, 0, &taken), MOTE_OK);
    assert_int_equal(taken.import.meshes, 1);
    assert_memory_equal(taken.soup.xyz, draft.soup.xyz, 9 * sizeof(double));
    assert_memory_equal(taken.soup.indices, draft.soup.indices, 3 * sizeof(uint32_t));
#define SAME_OF(own, type, name)                                                               \
    assert_int_equal(taken.own.name##_count, draft.own.name##_count);                          \
    assert_memory_equal(taken.own.name, draft.own.name, draft.own.name##_count * sizeof(type));
#define SAME_CHARACTER(type, name) SAME_OF(made, type, name)
#define SAME_RIG(type, name) SAME_OF(made.rig, type, name)
    MOTE_CHARACTER_ARRAYS(SAME_CHARACTER)
    MOTE_RIG_ARRAYS(SAME_RIG)
    mote_character_draft_free(&taken);
    refuse(&draft, 1, EARLY);
    refuse(&draft, -1, EARLY);
    refuse(&draft, -(long)sizeof(mote_vec3) - 4, EARLY);
    assert_int_equal(mote_character_receive("k.x", "short", 5, &taken), MOTE_EIO);
    assert_string_equal(mote_error_text(), "k.x: reading it gave no result");
    mote_character_draft_free(&draft);
}

/* A number of a draft, and a wrong one for it. */
typedef struct wrong {
    const char *name;
    void *at;
    size_t size;
    union {
        size_t count;
        uint32_t word;
        uint16_t half;
        double real;
        char letter;
    } value;
} wrong;

#define COUNT(of, n)                                                                           \
    {                                                                                          \
#of " is " #n, &of, sizeof of,                                                         \
        {                                                                                      \
            .count = n                                                                         \
        }                                                                                      \
    }
#define WORD(of, n)                                                                            \
    {                                                                                          \
#of " is " #n, &of, sizeof of,                                                         \
        {                                                                                      \
            .word = n                                                                          \
        }                                                                                      \
    }
#define HALF(of, n)                                                                            \
    {                                                                                          \
#of " is " #n, &of, sizeof of,                                                         \
        {                                                                                      \
            .half = n                                                                          \
        }                                                                                      \
    }
#define REAL(of, n)                                                                            \
    {                                                                                          \
#of " is " #n, &of, sizeof of,                                                         \
        {                                                                                      \
            .real = n                                                                          \
        }                                                                                      \
    }
#define LETTER(of, n)                                                                          \
    {                                                                                          \
#of " is " #n, &of, sizeof of,                                                         \
        {                                                                                      \
            .letter = n                                                                        \
        }                                                                                      \
    }

TEST(character_draft_with_a_number_out_of_range_is_refused)
{
    mote_character_draft draft = make_draft(), taken;
    mote_character *c = &draft.made;
    mote_rig *rig = &c->rig;
    mote_rig_channel *channel = rig->channels;
    mote_rig_track *weight = &rig->morphs[0].weight;
    const wrong rows[] = {
        COUNT(c->weight_count, 3),
        COUNT(c->shift_count, 0),
        COUNT(c->start_count, 3),
        COUNT(c->shift_start_count, 3),
        WORD(c->start[0], 1),
        WORD(c->start[1], 3),
        WORD(c->start[3], 3),
        WORD(c->shift_start[0], 1),
        WORD(c->shift_start[2], 2),
        WORD(c->shift_start[3], 2),
        HALF(c->bone[1], 2),
        REAL(c->weight[2], 0),
        REAL(c->weight[2], -0.5),
        REAL(c->weight[2], 1.5),
        REAL(c->weight[2], NAN),
        WORD(c->target[0], 1),
        COUNT(rig->nodes_count, 0),
        COUNT(rig->bones_count, 0),
        COUNT(rig->names_count, 0),
        LETTER(rig->names[rig->names_count - 1], 'x'),
        WORD(rig->nodes[0].parent, 0),
        WORD(rig->nodes[1].parent, 1),
        WORD(rig->nodes[1].name, 1000),
        WORD(rig->bones[1].node, 2),
        WORD(rig->targets[0].node, 2),
        WORD(rig->targets[0].name, 1000),
        WORD(rig->clips[0].channel, 1),
        WORD(rig->clips[0].morph_count, 2),
        WORD(rig->clips[0].name, 1000),
        REAL(rig->clips[0].seconds, -1),
        REAL(rig->clips[0].seconds, INFINITY),
        REAL(rig->clips[0].seconds, NAN),
        WORD(channel->node, 2),
        WORD(channel->position.mode, 3),
        WORD(channel->position.count, 0),
        WORD(channel->position.time, 7),
        WORD(channel->position.value, 1000),
        WORD(channel->rotation.value, UINT32_MAX),
        WORD(channel->scale.time, UINT32_MAX),
        WORD(channel->scale.mode, MOTE_TRACK_CUBIC), /* without room for tangents */
        WORD(rig->morphs[0].target, 1),
        WORD(weight->count, 3),
        WORD(weight->value, weight->value + 1),
    };
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        char was[sizeof rows[i].value];
        test_row("%s", rows[i].name);
        memcpy(was, rows[i].at, rows[i].size);
        memcpy(rows[i].at, &rows[i].value, rows[i].size);
        refuse(&draft, 0, EARLY);
        memcpy(rows[i].at, was, rows[i].size);
    }
    assert_int_equal(send(&draft, 0, &taken), MOTE_OK);
    mote_character_draft_free(&taken);
    mote_character_draft_free(&draft);
}

TEST(character_draft_with_as_many_bones_as_numbers_is_refused)
{
    mote_character_draft draft = make_draft(), taken;
    MOTE_RIG_GROW(&draft.made.rig, bones, UINT16_MAX - draft.made.rig.bones_count);
    assert_int_equal(send(&draft, 0, &taken), MOTE_OK);
    mote_character_draft_free(&taken);
    MOTE_RIG_GROW(&draft.made.rig, bones, 1);
    refuse(&draft, 0, EARLY);
    mote_character_draft_free(&draft);
}

/* Each wrong number is named by its place; a track of step, linear or cubic keys. */
TEST(character_rig_with_a_wrong_number_is_refused_with_its_place)
{
    mote_character_draft draft = make_draft();
    mote_rig *rig = &draft.made.rig;
    const mote_rig_channel *channel = rig->channels;
    double *const position = rig->values + channel->position.value,
                  *const rotation = rig->values + channel->rotation.value,
                  *const scale = rig->values + channel->scale.value,
                  *const amount = rig->values + rig->morphs[0].weight.value,
                  *const times = rig->times;
    const struct {
        wrong number;
        const char *says;
    } rows[] = {
        {REAL(rig->nodes[1].rest.m[2][3], NAN),
         "k.x: the matrix of node Joint is not finite; give finite numbers"},
        {REAL(rig->bones[0].bind.m[0][0], INFINITY), "k.x: the matrix of bone Root is not fin"},
        {REAL(rig->targets[0].weight, NAN),
         "k.x: the weight of morph target Smile is not finite; give a number"},
        {REAL(position[5], INFINITY), "k.x: clip 1: key 2 of the position of Joint is not fin"},
        {REAL(rotation[3], NAN), "k.x: clip 1: key 1 of the rotation of Joint is not finite"},
        {REAL(rotation[4], 2e6), "k.x: clip 1: key 2 of the rotation of Joint is not a rot"},
        {REAL(scale[0], -INFINITY), "k.x: clip 1: key 1 of the scale of Joint is not finite"},
        {REAL(amount[0], NAN), "k.x: clip 1: key 1 of the weight of Smile is not finite"},
        {REAL(amount[5], INFINITY), "k.x: clip 1: key 2 of the weight of Smile is not finite"},
        {REAL(times[channel->scale.time + 1], -1),
         "k.x: clip 1: key 2 of the scale of Joint is before the one before it; give times"},
        {REAL(times[rig->morphs[0].weight.time], NAN), "key 1 of the weight of Smile is not"},
    };
    assert_int_equal(mote_character_check_rig("k.x", rig), MOTE_OK);
    for (size_t i = 0; i < ROWS_OF(rows); ++i) {
        const wrong *number = &rows[i].number;
        mote_character *made = NULL;
        double was;
        test_row("%s", number->name);
        memcpy(&was, number->at, sizeof was);
        memcpy(number->at, &number->value, sizeof was);
        assert_int_equal(mote_character_make("k.x", &draft, &made), MOTE_EINVAL);
        if (!strstr(mote_error_text(), rows[i].says))
            fail_msg("%s", mote_error_text());
        assert_null(made);
        memcpy(number->at, &was, sizeof was);
    }
    /* A cubic tangent's length does not matter. */
    amount[0] = 1e9;
    assert_int_equal(mote_character_check_rig("k.x", rig), MOTE_OK);
    mote_character_draft_free(&draft);
}

TEST(character_without_an_area_is_refused_with_its_file)
{
    mote_character_draft draft = make_draft();
    mote_character *made = NULL;
    memset(draft.soup.xyz, 0, 9 * sizeof(double));
    assert_int_equal(mote_character_make("k.x", &draft, &made), MOTE_EINVAL);
    assert_int_equal(strncmp(mote_error_text(), "k.x: ", 5), 0);
    assert_null(made);
    mote_character_draft_free(&draft);
}

static mote_character *make_character(void)
{
    mote_character_draft draft = make_draft();
    mote_character *made = NULL;
    assert_int_equal(mote_character_make("k.x", &draft, &made), MOTE_OK);
    mote_soup_free(&draft.soup);
    return made;
}

/* The midpoint of two corners has the means of their weights and shifts. */
TEST(character_subdivided_has_means_of_weights_and_shifts)
{
    static const struct {
        mote_vec3 place;
        double weight[2], shift;
    } wanted[] = {{{0, 0, 0}, {1, 0}, 2},           {{1, 0, 0}, {0, 1}, 0},
                  {{0, 1, 0}, {0.25, 0.75}, 0},     {{0.5, 0, 0}, {0.5, 0.5}, 1},
                  {{0, 0.5, 0}, {0.625, 0.375}, 1}, {{0.5, 0.5, 0}, {0.125, 0.875}, 0}};
    mote_character *c = make_character();
    c->shift[0] = mote_vec3_make(0, 0, 2);
    assert_int_equal(mote_character_subdivide(c, 1), MOTE_OK);
    assert_int_equal(c->mesh->triangle_count, 4);
    assert_int_equal(c->mesh->vertex_count, ROWS_OF(wanted));
    for (size_t i = 0; i < ROWS_OF(wanted); ++i) {
        uint32_t v = 0;
        while (v < 6 && mote_distance_squared(c->mesh->positions[v], wanted[i].place) > 0)
            ++v;
        test_row("%zu", i);
        assert_true(v < 6);
        double weight[2] = {0, 0}, shift = 0;
        for (uint32_t k = c->start[v]; k < c->start[v + 1]; ++k)
            weight[c->bone[k]] += c->weight[k];
        for (uint32_t k = c->shift_start[v]; k < c->shift_start[v + 1]; ++k)
            shift += c->shift[k].z;
        assert_true(weight[0] == wanted[i].weight[0] && weight[1] == wanted[i].weight[1]);
        assert_true(shift == wanted[i].shift);
    }
    mote_character_destroy(c);
}

/* Two targets, of which each corner has one, both or none. */
TEST(character_subdivided_keeps_targets_apart)
{
    static const double wanted[3][2] = {{1, 0}, {0, 2}, {3, 4}}; /* shifts of each corner */
    mote_character *c = make_character();
    MOTE_RIG_GROW(&c->rig, targets, 1);
    MOTE_RIG_GROW(c, target, 3);
    MOTE_RIG_GROW(c, shift, 3);
    memcpy(c->shift_start, (uint32_t[]){0, 1, 2, 4}, 4 * sizeof(uint32_t));
    memcpy(c->target, (uint32_t[]){0, 1, 0, 1}, 4 * sizeof(uint32_t));
    for (int k = 0; k < 4; ++k)
        c->shift[k] = mote_vec3_make(k + 1, 0, 0);
    assert_int_equal(mote_character_subdivide(c, 1), MOTE_OK);
    for (uint32_t v = 0; v < c->mesh->vertex_count; ++v) {
        /* At (x, y, 0) the corners' parts are 1 - x - y, x and y. */
        const mote_vec3 at = c->mesh->positions[v];
        const double part[3] = {1 - at.x - at.y, at.x, at.y};
        double sum[2] = {0, 0};
        for (uint32_t k = c->shift_start[v]; k < c->shift_start[v + 1]; ++k) {
            assert_true(k == c->shift_start[v] || c->target[k] > c->target[k - 1]);
            sum[c->target[k]] += c->shift[k].x;
        }
        for (int t = 0; t < 2; ++t)
            assert_true(sum[t] == part[0] * wanted[0][t] + part[1] * wanted[1][t] +
                                      part[2] * wanted[2][t]);
    }
    mote_character_destroy(c);
}

TEST(character_without_clips_plays_none)
{
    uint32_t clip = 9;
    mote_character *c = make_character();
    assert_int_equal(mote_character_find_clip(c, "", &clip), MOTE_OK); /* it has no name */
    assert_int_equal(clip, 0);
    assert_int_equal(mote_character_find_clip(c, "0", &clip), MOTE_EINVAL);
    assert_string_equal(mote_error_text(), "no clip 0; it has 1 (1 s)");
    assert_int_equal(mote_character_find_clip(c, "1x", &clip), MOTE_EINVAL);
    c->rig.clips_count = 0;
    assert_int_equal(mote_character_find_clip(c, "1", &clip), MOTE_EINVAL);
    assert_non_null(strstr(mote_error_text(), "no clips in it, so that nothing moves; give"));
    mote_character_destroy(c);
    mote_character_destroy(NULL);
}

TEST(character_scaled_to_nothing_is_refused_and_stays)
{
    mote_character *c = make_character();
    const mote_mesh *mesh = c->mesh;
    assert_int_equal(mote_character_scale(c, mote_vec3_make(0, 0, 0)), MOTE_EINVAL);
    assert_ptr_equal(c->mesh, mesh);
    assert_true(c->scale.x == 1);
    assert_int_equal(mote_character_scale(c, mote_vec3_make(2, 3, 4)), MOTE_OK);
    assert_true(c->mesh->high.x == 2 && c->mesh->high.y == 3 && c->scale.z == 4);
    mote_character_destroy(c);
}
