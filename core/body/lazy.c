#include "core/body/lazy.h"

#include <assert.h>
#include <stdlib.h>

/* At least twice as many slots as positions are expected, so that probe sequences stay short.
 */
static uint32_t table_bits(const mote_body *body, uint32_t expected)
{
    if (expected > body->mesh->vertex_count)
        expected = body->mesh->vertex_count;
    uint32_t bits = 4;
    while (bits < 31 && (1u << bits) < 2 * expected)
        ++bits;
    return bits;
}

static void set_size(mote_lazy *lazy, uint32_t bits)
{
    lazy->mask = (1u << bits) - 1;
    lazy->shift = 32 - bits;
    lazy->limit = 1u << (bits - 1);
}

mote_status mote_lazy_init(mote_lazy *lazy, const mote_body *body, uint32_t expected)
{
    const uint32_t bits = table_bits(body, expected);
    mote_lazy_slot *slots = calloc((size_t)1 << bits, sizeof *slots);
    if (!slots)
        return mote_fail(MOTE_ENOMEM, "no memory for %u positions", 1u << bits);
    *lazy = (mote_lazy){.body = body, .slots = slots};
    set_size(lazy, bits);
    return MOTE_OK;
}

mote_status mote_lazy_init_single(mote_lazy *lazy, const mote_body *body, uint32_t expected)
{
    const uint32_t bits = table_bits(body, expected);
    mote_lazy_slot_single *slots = calloc((size_t)1 << bits, sizeof *slots);
    /* One float more, so that a field without weights does not ask for 0 bytes. */
    float *weights = malloc((3 * (size_t)body->field->padded + 1) * sizeof *weights);
    if (!slots || !weights) {
        free(slots);
        free(weights);
        return mote_fail(MOTE_ENOMEM, "no memory for %u positions", 1u << bits);
    }
    *lazy = (mote_lazy){.body = body, .singles = slots, .weights_single = weights};
    set_size(lazy, bits);
    return MOTE_OK;
}

void mote_lazy_free(mote_lazy *lazy)
{
    free(lazy->slots);
    free(lazy->singles);
    free(lazy->weights_single);
    lazy->slots = NULL;
    lazy->singles = NULL;
    lazy->weights_single = NULL;
}

static void round_weights(mote_lazy *lazy)
{
    assert(lazy->state);
    const mote_weights *w = &lazy->state->weights;
    const uint32_t padded = lazy->body->field->padded;
    assert(padded == 0 || (w->x && w->y && w->z));
    for (uint32_t j = 0; j < padded; ++j) {
        lazy->weights_single[j] = (float)w->x[j];
        lazy->weights_single[padded + j] = (float)w->y[j];
        lazy->weights_single[2 * padded + j] = (float)w->z[j];
    }
}

/* After 2^32 frames old stamps could be mistaken for new ones. */
static void clear_stamps(mote_lazy *lazy)
{
    for (uint32_t i = 0; i <= lazy->mask; ++i) {
        if (lazy->singles)
            lazy->singles[i].stamp = 0;
        else
            lazy->slots[i].stamp = 0;
    }
}

void mote_lazy_begin(mote_lazy *lazy, const mote_body_state *state, bool use_given)
{
    lazy->state = state;
    const bool reads = state && (use_given || mote_body_is_given(lazy->body));
    lazy->given = reads ? state->vertices : NULL;
    lazy->points = NULL;
    lazy->filled = 0;
    if (++lazy->stamp == 0) {
        clear_stamps(lazy);
        lazy->stamp = 1;
    }
    if (lazy->singles && !lazy->given)
        round_weights(lazy);
}

void mote_lazy_begin_points(mote_lazy *lazy, const mote_positions *points)
{
    mote_lazy_begin(lazy, NULL, false);
    if (!points->single && points->stride == sizeof(mote_vec3))
        lazy->given = points->data;
    else
        lazy->points = points;
}

static uint32_t first_index(const mote_lazy *lazy, uint32_t vertex)
{
    return (vertex * 2654435769u) >> lazy->shift;
}

static uint32_t free_index(const mote_lazy *lazy, uint32_t vertex)
{
    uint32_t index = first_index(lazy, vertex);
    while (lazy->slots[index].stamp == lazy->stamp)
        index = (index + 1) & lazy->mask;
    return index;
}

static uint32_t free_index_single(const mote_lazy *lazy, uint32_t vertex)
{
    uint32_t index = first_index(lazy, vertex);
    while (lazy->singles[index].stamp == lazy->stamp)
        index = (index + 1) & lazy->mask;
    return index;
}

static bool grow(mote_lazy *lazy)
{
    const uint32_t bits = 32 - lazy->shift + 1;
    mote_lazy_slot *slots = bits < 32 ? calloc((size_t)1 << bits, sizeof *slots) : NULL;
    if (!slots)
        return false;
    mote_lazy_slot *old = lazy->slots;
    const uint32_t old_mask = lazy->mask;
    lazy->slots = slots;
    set_size(lazy, bits);
    for (uint32_t i = 0; i <= old_mask; ++i) {
        if (old[i].stamp == lazy->stamp)
            slots[free_index(lazy, old[i].vertex)] = old[i];
    }
    free(old);
    return true;
}

static bool grow_single(mote_lazy *lazy)
{
    const uint32_t bits = 32 - lazy->shift + 1;
    mote_lazy_slot_single *slots = bits < 32 ? calloc((size_t)1 << bits, sizeof *slots) : NULL;
    if (!slots)
        return false;
    mote_lazy_slot_single *old = lazy->singles;
    const uint32_t old_mask = lazy->mask;
    lazy->singles = slots;
    set_size(lazy, bits);
    for (uint32_t i = 0; i <= old_mask; ++i) {
        if (old[i].stamp == lazy->stamp)
            slots[free_index_single(lazy, old[i].vertex)] = old[i];
    }
    free(old);
    return true;
}

mote_vec3 mote_lazy_fill(mote_lazy *lazy, uint32_t vertex, uint32_t index)
{
    const mote_vec3 position = lazy->points
                                   ? mote_position_at(lazy->points, vertex)
                                   : mote_body_position(lazy->body, lazy->state, vertex);
    ++lazy->evaluated;
    if (lazy->filled >= lazy->limit) {
        if (lazy->fixed || !grow(lazy))
            return position;
        index = free_index(lazy, vertex);
    }
    lazy->slots[index] = (mote_lazy_slot){vertex, lazy->stamp, position};
    ++lazy->filled;
    return position;
}

/* Fewer positions than this are evaluated faster one by one. */
#define WORTH_A_GROUP 4

/* Vertices with a slot but no position yet. */
typedef struct pending {
    uint32_t vertex[MOTE_LANES], index[MOTE_LANES];
    uint32_t count;
} pending;

/* The positions of MOTE_LANES vertices by coordinate, with the bits of mote_body_position. */
MOTE_CLONES
static void evaluate_group(const mote_lazy *lazy, const uint32_t vertices[MOTE_LANES],
                           double world[3][MOTE_LANES])
{
    const mote_field *field = lazy->body->field;
    const mote_mesh *mesh = lazy->body->mesh;
    const mote_pose *pose = &lazy->state->pose;
    const double translation[3] = {pose->translation.x, pose->translation.y,
                                   pose->translation.z};
    double rest[3][MOTE_LANES];
    for (size_t v = 0; v < MOTE_LANES; ++v) {
        const mote_vec3 p = mesh->positions[vertices[v]];
        rest[0][v] = p.x;
        rest[1][v] = p.y;
        rest[2][v] = p.z;
    }
    for (size_t c = 0; c < 3; ++c) {
        const double *row = pose->rotation.m[c];
        MOTE_LANE_LOOP
        for (size_t v = 0; v < MOTE_LANES; ++v)
            world[c][v] = row[0] * rest[0][v] + row[1] * rest[1][v] + row[2] * rest[2][v] +
                          translation[c];
    }
    if (field->count == 0)
        return;
    double displacement[3][MOTE_LANES];
    field->kind->group(field, mesh, vertices, &lazy->state->weights, displacement);
    for (size_t c = 0; c < 3; ++c) {
        MOTE_LANE_LOOP
        for (size_t v = 0; v < MOTE_LANES; ++v)
            world[c][v] += displacement[c][v];
    }
}

static void evaluate_pending(mote_lazy *lazy, pending *p)
{
    const mote_field *field = lazy->body->field;
    const bool group = field->count == 0 || field->kind->group;
    lazy->evaluated += p->count;
    if (p->count < WORTH_A_GROUP || !group) {
        for (uint32_t i = 0; i < p->count; ++i)
            lazy->slots[p->index[i]].position =
                mote_body_position(lazy->body, lazy->state, p->vertex[i]);
    } else {
        double world[3][MOTE_LANES];
        for (uint32_t i = p->count; i < MOTE_LANES; ++i)
            p->vertex[i] = p->vertex[0];
        evaluate_group(lazy, p->vertex, world);
        for (uint32_t i = 0; i < p->count; ++i)
            lazy->slots[p->index[i]].position =
                mote_vec3_make(world[0][i], world[1][i], world[2][i]);
    }
    p->count = 0;
}

/* Gives the vertex a slot if it has none; false when the table is full and cannot grow. */
static bool reserve(mote_lazy *lazy, uint32_t vertex, pending *p)
{
    uint32_t index = first_index(lazy, vertex);
    for (; lazy->slots[index].stamp == lazy->stamp; index = (index + 1) & lazy->mask) {
        if (lazy->slots[index].vertex == vertex)
            return true;
    }
    if (lazy->filled >= lazy->limit) {
        evaluate_pending(lazy, p); /* growth moves slots */
        if (lazy->fixed || !grow(lazy))
            return false;
        index = free_index(lazy, vertex);
    }
    lazy->slots[index].vertex = vertex;
    lazy->slots[index].stamp = lazy->stamp;
    ++lazy->filled;
    p->vertex[p->count] = vertex;
    p->index[p->count++] = index;
    if (p->count == MOTE_LANES)
        evaluate_pending(lazy, p);
    return true;
}

void mote_lazy_fetch(mote_lazy *lazy, const uint32_t *vertices, size_t count)
{
    if (lazy->given || lazy->points || lazy->singles)
        return;
    pending p = {.count = 0};
    for (size_t i = 0; i < count && reserve(lazy, vertices[i], &p); ++i)
        continue;
    evaluate_pending(lazy, &p);
}

void mote_lazy_fetch_rings(mote_lazy *lazy, const uint32_t *centres, size_t count)
{
    if (lazy->given || lazy->points || lazy->singles)
        return;
    const mote_mesh *mesh = lazy->body->mesh;
    pending p = {.count = 0};
    bool room = true;
    for (size_t i = 0; i < count && room; ++i) {
        const uint32_t end = mesh->ring_start[centres[i] + 1];
        room = reserve(lazy, centres[i], &p);
        for (uint32_t k = mesh->ring_start[centres[i]]; k < end && room; ++k)
            room = reserve(lazy, MOTE_RING_VERTEX(mesh->ring[k]), &p);
    }
    evaluate_pending(lazy, &p);
}

static mote_lazy_slot_single evaluate_single(const mote_lazy *lazy, uint32_t vertex)
{
    const mote_field *field = lazy->body->field;
    const mote_pose *pose = &lazy->state->pose;
    const mote_vec3 rest = lazy->body->mesh->positions[vertex];
    const float x[3] = {(float)rest.x, (float)rest.y, (float)rest.z};
    const float t[3] = {(float)pose->translation.x, (float)pose->translation.y,
                        (float)pose->translation.z};
    float d[3] = {0, 0, 0};
    if (field->count > 0) {
        const float *w = lazy->weights_single;
        const mote_weights_single weights = {w, w + field->padded,
                                             w + 2 * (size_t)field->padded, field->padded};
        mote_field_displacement_single(field, lazy->body->mesh, vertex, &weights, d);
    }
    mote_lazy_slot_single slot = {vertex, lazy->stamp, {0, 0, 0}};
    for (int c = 0; c < 3; ++c) {
        const double *row = pose->rotation.m[c];
        slot.position[c] =
            (float)row[0] * x[0] + (float)row[1] * x[1] + (float)row[2] * x[2] + t[c] + d[c];
    }
    return slot;
}

static mote_vec3 widened(const float position[3])
{
    return mote_vec3_make((double)position[0], (double)position[1], (double)position[2]);
}

mote_vec3 mote_lazy_position_single(mote_lazy *lazy, uint32_t vertex)
{
    uint32_t index = first_index(lazy, vertex);
    for (; lazy->singles[index].stamp == lazy->stamp; index = (index + 1) & lazy->mask) {
        if (lazy->singles[index].vertex == vertex)
            return widened(lazy->singles[index].position);
    }
    const mote_lazy_slot_single slot = evaluate_single(lazy, vertex);
    ++lazy->evaluated;
    if (lazy->filled >= lazy->limit) {
        if (lazy->fixed || !grow_single(lazy))
            return widened(slot.position);
        index = free_index_single(lazy, vertex);
    }
    lazy->singles[index] = slot;
    ++lazy->filled;
    return widened(slot.position);
}
