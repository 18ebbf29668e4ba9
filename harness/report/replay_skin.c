#include "harness/report/replay_skin.h"

#include "core/skin/skin.h"
#include "harness/base/memory.h"
#include "harness/report/replay_series.h"
#include "harness/scene/motion.h"

#include <math.h>
#include <stdlib.h>

/* The number of steps in which weights, displacements and amounts are stored. */
#define STEPS 65535
/* The same for columns of matrices: a bone far from the middle of the body multiplies their
   rounding. */
#define COLUMN_STEPS (1 << 20)

bool mote_replay_has_skin(const mote_body *body)
{
    return mote_field_skin(body->field) != NULL;
}

static int32_t in_steps(double value, double step)
{
    return (int32_t)floor(value / step + 0.5);
}

/* Adds the number of entries of each vertex. */
static void add_counts(mote_text *text, const char *key, const uint32_t *start, size_t vertices)
{
    int32_t *counts = mote_allocate(vertices, sizeof *counts);
    for (size_t v = 0; v < vertices; ++v)
        counts[v] = (int32_t)(start[v + 1] - start[v]);
    mote_replay_add_series(text, key, counts, vertices);
    free(counts);
}

static void add_weights(mote_text *text, const mote_skin *skin)
{
    const size_t count = skin->start[skin->vertex_count];
    int32_t *numbers = mote_allocate(count, sizeof *numbers);
    add_counts(text, "counts", skin->start, skin->vertex_count);
    for (size_t i = 0; i < count; ++i)
        numbers[i] = skin->bone[i];
    mote_text_add(text, ", ");
    mote_replay_difference(numbers, count, 1);
    mote_replay_add_series(text, "bones", numbers, count);
    for (size_t i = 0; i < count; ++i)
        numbers[i] = in_steps((double)skin->weight[i], 1.0 / STEPS);
    mote_text_add(text, ", \"weightStep\": %.17g, ", 1.0 / STEPS);
    mote_replay_add_series(text, "weights", numbers, count);
    free(numbers);
}

/* Adds displacements relative to the sizes of their targets, which the amounts contain. */
static void add_moves(mote_text *text, const mote_skin *skin)
{
    const mote_morph *morph = &skin->morph;
    const size_t count = morph->targets > 0 ? morph->start[skin->vertex_count] : 0;
    int32_t *numbers = mote_allocate(3 * count, sizeof *numbers);
    double most = 0;
    for (size_t i = 0; i < 3 * count; ++i)
        most = fmax(most, fabs((double)morph->move[i / 3][i % 3]));
    const double step = most > 0 ? most / STEPS : 1;
    if (count > 0)
        add_counts(text, "moveCounts", morph->start, skin->vertex_count);
    else
        mote_text_add(text, "\"moveCounts\": []");
    for (size_t i = 0; i < count; ++i)
        numbers[i] = morph->target[i];
    mote_text_add(text, ", \"targetCount\": %u, ", morph->targets);
    mote_replay_add_series(text, "targets", numbers, count);
    for (size_t i = 0; i < 3 * count; ++i)
        numbers[i] = in_steps((double)morph->move[i / 3][i % 3], step);
    mote_text_add(text, ", \"moveStep\": %.17g, ", step);
    mote_replay_add_series(text, "moves", numbers, 3 * count);
    free(numbers);
}

void mote_replay_add_skin(mote_text *text, const mote_body *body)
{
    const mote_skin *skin = mote_field_skin(body->field);
    mote_text_add(text, "\"skin\": {\"boneCount\": %u, \"origin\": [%.17g, %.17g, %.17g], ",
                  skin->bones, skin->origin.x, skin->origin.y, skin->origin.z);
    mote_text_add(text, "\"unit\": %.17g, ", skin->unit);
    add_weights(text, skin);
    mote_text_add(text, ", ");
    add_moves(text, skin);
    mote_text_add(text, "}");
}

/* Adds second differences of numbers in steps of the largest over `steps`. */
static void add_smooth(mote_text *text, const char *key, const char *step_key, int steps,
                       const double *values, size_t frames, size_t width)
{
    const size_t count = frames * width;
    int32_t *numbers = mote_allocate(count, sizeof *numbers);
    double most = 0;
    for (size_t i = 0; i < count; ++i)
        most = fmax(most, fabs(values[i]));
    const double step = most > 0 ? most / steps : 1;
    for (size_t i = 0; i < count; ++i)
        numbers[i] = in_steps(values[i], step);
    mote_text_add(text, "\"%s\": %.17g, ", step_key, step);
    mote_replay_difference(numbers, count, width);
    mote_replay_difference(numbers, count, width);
    mote_replay_add_series(text, key, numbers, count);
    free(numbers);
}

void mote_replay_add_skin_motion(mote_text *text, const mote_scenario *scenario, int i,
                                 uint32_t first, uint32_t last)
{
    const mote_motion *motion = scenario->motion;
    const mote_field *field = scenario->body[i].field;
    const mote_skin *skin = mote_field_skin(field);
    const size_t frames = (size_t)(last - first) + 1, width = (size_t)12 * skin->bones;
    const size_t targets = skin->morph.targets;
    double *columns = mote_allocate(frames * width, sizeof *columns);
    double *amounts = mote_allocate(frames * targets, sizeof *amounts);
    mote_vec3 *weights = mote_allocate(field->count, sizeof *weights);
    for (size_t k = 0; k < frames; ++k) {
        const double place = motion->start + (first + (double)k - 1) * motion->pace;
        mote_motion_displacements(&motion->body[i], place, weights);
        for (size_t c = 0; c < width; ++c) {
            const mote_vec3 *w = &weights[c / 3];
            columns[k * width + c] = c % 3 == 0 ? w->x : c % 3 == 1 ? w->y : w->z;
        }
        for (size_t t = 0; t < targets; ++t)
            amounts[k * targets + t] = weights[mote_morph_first(skin) + t].x;
    }
    add_smooth(text, "weights", "weightStep", COLUMN_STEPS, columns, frames, width);
    mote_text_add(text, ", ");
    add_smooth(text, "amounts", "amountStep", STEPS, amounts, frames, targets);
    free(columns);
    free(amounts);
    free(weights);
}
