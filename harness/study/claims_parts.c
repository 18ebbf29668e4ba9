/* Claim m: the number of convex parts while a body deforms. */
#include "harness/study/claims.h"

#include "harness/base/memory.h"
#include "core/body/csrbf_fit.h"
#include "core/body/deform.h"
#include "core/parts/parts.h"
#include "core/base/random.h"
#include "datasets/letter.h"
#include "harness/scene/spread.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CONTROLS 14
#define CONTROLS_PADDED 16
#define SUPPORT 0.5 /* of L, as in the scenarios */
#define TRIANGLES 1380

/* A letter with a field, ready to be deformed. */
typedef struct clay {
    mote_mesh *mesh;
    mote_field *field;
    mote_csrbf_fit *fit;
    mote_deform *deform;
    mote_body body;
    mote_vec3 *world;
} clay;

static void clay_free(clay *c)
{
    mote_deform_destroy(c->deform);
    mote_csrbf_fit_destroy(c->fit);
    mote_field_destroy(c->field);
    mote_mesh_destroy(c->mesh);
    free(c->world);
}

static mote_status clay_make(char letter, clay *c)
{
    memset(c, 0, sizeof *c);
    mote_vec3 centres[CONTROLS];
    mote_status status = mote_letter_create(letter, TRIANGLES, &c->mesh);
    if (status == MOTE_OK)
        status = mote_spread(c->mesh, CONTROLS, centres);
    if (status == MOTE_OK)
        status =
            mote_field_create_csrbf(centres, CONTROLS, SUPPORT * c->mesh->diagonal, &c->field);
    if (status == MOTE_OK)
        status = mote_csrbf_fit_create(c->field, &c->fit, NULL);
    c->body = (mote_body){.mesh = c->mesh, .field = c->field};
    if (status == MOTE_OK)
        status = mote_deform_create(&c->body, &c->deform);
    if (status == MOTE_OK)
        c->world = mote_allocate(c->mesh->vertex_count, sizeof *c->world);
    return status;
}

/* A displacement of the given length in a random direction. */
static mote_vec3 random_push(mote_random *random, double length)
{
    const double z = 2 * mote_random_unit(random) - 1;
    const double turn = 2 * 3.14159265358979323846 * mote_random_unit(random);
    const double r = sqrt(1 - z * z);
    return mote_scale(mote_vec3_make(r * cos(turn), r * sin(turn), z), length);
}

/* Counts the parts of the letter with every control point displaced by amplitude (in L). */
static mote_status deformed_parts(clay *c, double amplitude, uint64_t seed, double *count)
{
    mote_vec3 push[CONTROLS];
    double weights[3][CONTROLS_PADDED] = {{0}};
    mote_random random = {seed};
    for (int j = 0; j < CONTROLS; ++j)
        push[j] = random_push(&random, amplitude * c->mesh->diagonal);
    mote_status status = mote_csrbf_fit_solve(c->fit, push, push);
    if (status != MOTE_OK)
        return status;
    for (int j = 0; j < CONTROLS; ++j) {
        weights[0][j] = push[j].x;
        weights[1][j] = push[j].y;
        weights[2][j] = push[j].z;
    }
    const mote_body_state state = {
        .pose = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0}},
        .weights = {weights[0], weights[1], weights[2], c->field->count, c->field->padded}};
    mote_deform_all(c->deform, &state, c->world);
    mote_parts *parts = NULL;
    status = mote_parts_create(c->mesh, c->world, &parts);
    if (status == MOTE_OK)
        *count = parts->count;
    mote_parts_destroy(parts);
    return status;
}

#define LETTERS 4
#define PART_SEEDS 3
#define AMPLITUDES 5

/* Growth of the number of parts: parts deformed / parts at rest, [amplitude][letter, seed]. */
static mote_status measure_letter(char letter, size_t amplitudes, const double *amplitude,
                                  double growth[][LETTERS * PART_SEEDS], size_t at,
                                  double *rest)
{
    clay c;
    mote_status status = clay_make(letter, &c);
    if (status == MOTE_OK)
        status = deformed_parts(&c, 0, 1, rest);
    for (size_t a = 0; a < amplitudes; ++a) {
        for (uint64_t s = 0; s < PART_SEEDS && status == MOTE_OK; ++s) {
            double parts = 0;
            status = deformed_parts(&c, amplitude[a], s + 1, &parts);
            growth[a][at + s] = parts / *rest;
        }
    }
    clay_free(&c);
    return status;
}

/* "Does not increase much": n = auto remains adequate when the number grows by a quarter; with
   twice as many parts there is one particle for each, the minimum that the paper allows. */
mote_status mote_claim_deformed_parts(mote_study *study, mote_claim *claim)
{
    claim->id = "m";
    claim->section = "3.1";
    claim->claim = "the number of convex parts does not increase greatly during deformation";
    claim->measured =
        "parts (n = auto) of T, V, M, W deformed / at rest; 14 control points, each "
        "displaced in a random direction, support 0.5 L";
    claim->curve = "figures/claim_m.dat";
    static const char letters[] = "TVMW";
    static const double amplitude[AMPLITUDES] = {0.5, 0.2, 0.1, 0.05, 0.001};
    double growth[AMPLITUDES][LETTERS * PART_SEEDS];
    const size_t first = study->quick ? 2 : 0;
    mote_text curve = {0};
    mote_status status = MOTE_OK;
    double rest[LETTERS] = {0};
    for (size_t l = 0; l < LETTERS && status == MOTE_OK; ++l)
        status = measure_letter(letters[l], AMPLITUDES - first, amplitude + first,
                                growth + first, l * PART_SEEDS, &rest[l]);
    for (size_t a = first; a < AMPLITUDES && status == MOTE_OK; ++a) {
        const mote_estimate e = mote_estimate_make(growth[a], LETTERS * PART_SEEDS);
        mote_claim_add(claim, e, "", "growth at %g L, four letters, three deformations each",
                       amplitude[a]);
        /* The smallest deformation only shows how much the decomposition itself varies. */
        if (a + 1 < AMPLITUDES)
            mote_claim_require(claim, MOTE_AT_MOST, 1.25, 2);
        mote_text_add(&curve, "%g\t%g\t%g\t%g\n", amplitude[a], e.value, e.interval.low,
                      e.interval.high);
    }
    for (size_t l = 0; l < LETTERS && status == MOTE_OK; ++l)
        mote_claim_add(claim, mote_estimate_alone(rest[l]), "", "parts of %c at rest",
                       letters[l]);
    if (status == MOTE_OK)
        status = mote_study_plot(study, "claim_m", &curve);
    free(curve.data);
    return status;
}
