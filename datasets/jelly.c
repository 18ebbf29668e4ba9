/* A letter of jelly that falls onto a letter, bounces and wobbles.

   Finite elements: a lattice of cubes that covers the letter, trilinear, with two Gauss points
   an edge, of a stable neo-Hookean material (Smith, de Goes and Kim, 2018), integrated
   explicitly in time. The letter's surface is embedded in the cubes. It collides with the other
   letter, an implicit surface, at the vertices of a coarse mesh of its own, which springs push
   out. So the size of the mesh that is shown does not change the motion. */
#include "datasets/glyph.h"
#include "datasets/letter.h"
#include "datasets/simulated.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LETTER 'T'
#define CELL 0.05      /* edge of a cube, in L */
#define CELLS_MAX 32   /* along an edge of the lattice */
#define SHEAR 8e-4     /* the Lame parameters; density 1, time in frames */
#define BULK 3e-3      /* waves go 0.07 L a frame */
#define GRAVITY 3e-4   /* L a frame, a frame */
#define SUBSTEPS 12    /* a frame: a wave crosses a cube in 9 */
#define KEPT 0.999     /* of the velocity, a substep */
#define CONTACTS 1200  /* triangles of the coarse mesh */
#define STIFFNESS 2e-3 /* of its springs */
#define ROUGHNESS 1e-4 /* force for a speed along the surface */
#define MARGIN 0.009   /* distance at which the springs begin */
#define FLOOR (-0.25)  /* height */

typedef struct cube {
    uint32_t node[8]; /* corner 4 x + 2 y + z */
} cube;

/* A point in a cube. */
typedef struct embedded {
    uint32_t cube;
    float place[3]; /* 0 .. 1 along its edges */
} embedded;

typedef struct jelly {
    mote_glyph own, other;
    mote_vec3 low;                                    /* corner of the lattice */
    int32_t cube_at[CELLS_MAX][CELLS_MAX][CELLS_MAX]; /* -1: none */
    cube *cubes;
    uint32_t cube_count, node_count;
    mote_vec3 *rest, *position, *velocity, *force; /* [node_count] */
    double *mass;                                  /* [node_count] */
    embedded *contacts, *vertices;
    uint32_t contact_count, vertex_count;
    double slope[8][8][3]; /* of corner c's function at Gauss point g, over CELL */
} jelly;

/* A cube is kept if the letter's field is below FIELD_MAX at one of its SAMPLES^3 samples. That
 * keeps all cubes that the surface passes: each of its points has a sample in the same cube at
 * most sqrt(3) / 8 of an edge away. */
#define SAMPLES 4
#define FIELD_MAX (0.22 * CELL)

static bool touches_letter(const jelly *s, int x, int y, int z)
{
    for (int k = 0; k < SAMPLES * SAMPLES * SAMPLES; ++k) {
        const int i = k % SAMPLES, j = k / SAMPLES % SAMPLES, l = k / (SAMPLES * SAMPLES);
        const double at[3] = {x + (i + 0.5) / SAMPLES, y + (j + 0.5) / SAMPLES,
                              z + (l + 0.5) / SAMPLES};
        const mote_vec3 p = mote_add_scaled(s->low, CELL, mote_vec3_make(at[0], at[1], at[2]));
        mote_vec3 gradient;
        if (mote_glyph_field(&s->own, p, &gradient) < FIELD_MAX)
            return true;
    }
    return false;
}

/* The node at a corner of the lattice: the one that is there, or a new one. */
static uint32_t node_at(jelly *s, int32_t *nodes, int x, int y, int z)
{
    int32_t *there = &nodes[(x * (CELLS_MAX + 1) + y) * (CELLS_MAX + 1) + z];
    if (*there < 0) {
        *there = (int32_t)s->node_count;
        s->rest[s->node_count++] = mote_add_scaled(s->low, CELL, mote_vec3_make(x, y, z));
    }
    return (uint32_t)*there;
}

static void add_cube(jelly *s, int32_t *nodes, int x, int y, int z)
{
    s->cube_at[x][y][z] = (int32_t)s->cube_count;
    cube *made = &s->cubes[s->cube_count++];
    for (int c = 0; c < 8; ++c) {
        made->node[c] = node_at(s, nodes, x + (c >> 2), y + (c >> 1 & 1), z + (c & 1));
        s->mass[made->node[c]] += CELL * CELL * CELL / 8;
    }
}

#define NODES_MAX ((CELLS_MAX + 1) * (CELLS_MAX + 1) * (CELLS_MAX + 1))

static mote_status make_lattice(jelly *s)
{
    const mote_vec3 size = mote_sub(s->own.high, s->own.low);
    const int cells[3] = {(int)(size.x / CELL) + 3, (int)(size.y / CELL) + 3,
                          (int)(size.z / CELL) + 3};
    int32_t *nodes = malloc(NODES_MAX * sizeof *nodes);
    s->cubes = malloc((size_t)CELLS_MAX * CELLS_MAX * CELLS_MAX * sizeof *s->cubes);
    s->rest = malloc(NODES_MAX * sizeof *s->rest);
    s->mass = calloc(NODES_MAX, sizeof *s->mass);
    if (!nodes || !s->cubes || !s->rest || !s->mass) {
        free(nodes);
        return mote_fail(MOTE_ENOMEM, "jelly: no memory");
    }
    memset(nodes, 0xff, NODES_MAX * sizeof *nodes);
    memset(s->cube_at, 0xff, sizeof s->cube_at);
    s->low = mote_add_scaled(s->own.low, -CELL, mote_vec3_make(1, 1, 1));
    for (int x = 0; x < cells[0]; ++x) {
        for (int y = 0; y < cells[1]; ++y) {
            for (int z = 0; z < cells[2]; ++z) {
                if (touches_letter(s, x, y, z))
                    add_cube(s, nodes, x, y, z);
            }
        }
    }
    free(nodes);
    return MOTE_OK;
}

/* Where a rest point is: MOTE_ENUMERIC where no cube is there. */
static mote_status embed(const jelly *s, mote_vec3 p, embedded *made)
{
    const double at[3] = {(p.x - s->low.x) / CELL, (p.y - s->low.y) / CELL,
                          (p.z - s->low.z) / CELL};
    int cell[3];
    for (int c = 0; c < 3; ++c) {
        cell[c] = at[c] > 0 && at[c] < CELLS_MAX ? (int)at[c] : 0;
        made->place[c] = (float)(at[c] - cell[c]);
    }
    const int32_t there = s->cube_at[cell[0]][cell[1]][cell[2]];
    if (there < 0)
        return mote_fail(MOTE_ENUMERIC, "jelly: (%g, %g, %g) is in no cube", p.x, p.y, p.z);
    made->cube = (uint32_t)there;
    return MOTE_OK;
}

static mote_status embed_all(const jelly *s, const mote_mesh *mesh, embedded **made,
                             uint32_t *count)
{
    *made = malloc(mesh->vertex_count * sizeof **made);
    *count = mesh->vertex_count;
    mote_status status = MOTE_OK;
    if (!*made)
        return mote_fail(MOTE_ENOMEM, "jelly: no memory for %u vertices", *count);
    for (uint32_t v = 0; v < *count && status == MOTE_OK; ++v)
        status = embed(s, mesh->positions[v], &(*made)[v]);
    return status;
}

static double weight_of(const embedded *e, int corner)
{
    const double x = (double)e->place[0], y = (double)e->place[1], z = (double)e->place[2];
    return (corner >> 2 ? x : 1 - x) * (corner >> 1 & 1 ? y : 1 - y) * (corner & 1 ? z : 1 - z);
}

static mote_vec3 value_at(const jelly *s, const embedded *e, const mote_vec3 *nodes)
{
    mote_vec3 sum = {0, 0, 0};
    for (int c = 0; c < 8; ++c)
        sum = mote_add_scaled(sum, weight_of(e, c), nodes[s->cubes[e->cube].node[c]]);
    return sum;
}

static void set_slopes(jelly *s)
{
    const double half = 0.5 / sqrt(3);
    for (int g = 0; g < 8; ++g) {
        const double at[3] = {g >> 2 ? 0.5 + half : 0.5 - half,
                              g >> 1 & 1 ? 0.5 + half : 0.5 - half,
                              g & 1 ? 0.5 + half : 0.5 - half};
        for (int c = 0; c < 8; ++c) {
            const int far[3] = {c >> 2, c >> 1 & 1, c & 1};
            for (int axis = 0; axis < 3; ++axis) {
                double product = (far[axis] ? 1 : -1) / CELL;
                for (int other = 0; other < 3; ++other)
                    product *= other == axis ? 1 : far[other] ? at[other] : 1 - at[other];
                s->slope[g][c][axis] = product;
            }
        }
    }
}

/* The stress (first Piola-Kirchhoff) of a deformation gradient, both [row][column]. */
static void stress_of(double f[3][3], double p[3][3])
{
    double squares = 0, cofactor[3][3];
    for (int i = 0; i < 3; ++i) {
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        for (int j = 0; j < 3; ++j) {
            const int c = (j + 1) % 3, d = (j + 2) % 3;
            cofactor[i][j] = f[a][c] * f[b][d] - f[a][d] * f[b][c];
            squares += f[i][j] * f[i][j];
        }
    }
    const double volume =
        f[0][0] * cofactor[0][0] + f[0][1] * cofactor[0][1] + f[0][2] * cofactor[0][2];
    const double rest = 1 + 0.75 * SHEAR / BULK; /* no stress where f is the identity */
    const double shear = SHEAR * (1 - 1 / (squares + 1)), bulk = BULK * (volume - rest);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            p[i][j] = shear * f[i][j] + bulk * cofactor[i][j];
    }
}

static void add_elastic_forces(jelly *s, const cube *e)
{
    const double volume = CELL * CELL * CELL / 8; /* of a Gauss point */
    for (int g = 0; g < 8; ++g) {
        double f[3][3] = {{0}}, p[3][3];
        for (int c = 0; c < 8; ++c) {
            const mote_vec3 x = s->position[e->node[c]];
            const double *slope = s->slope[g][c], at[3] = {x.x, x.y, x.z};
            for (int i = 0; i < 3; ++i) {
                for (int j = 0; j < 3; ++j)
                    f[i][j] += at[i] * slope[j];
            }
        }
        stress_of(f, p);
        for (int c = 0; c < 8; ++c) {
            const double *d = s->slope[g][c];
            const mote_vec3 pull = {p[0][0] * d[0] + p[0][1] * d[1] + p[0][2] * d[2],
                                    p[1][0] * d[0] + p[1][1] * d[1] + p[1][2] * d[2],
                                    p[2][0] * d[0] + p[2][1] * d[1] + p[2][2] * d[2]};
            s->force[e->node[c]] = mote_add_scaled(s->force[e->node[c]], -volume, pull);
        }
    }
}

/* Adds the force of a spring and of friction where the point is within the margin. */
static void add_contact(jelly *s, const embedded *e, double depth, mote_vec3 normal)
{
    const mote_vec3 speed = value_at(s, e, s->velocity);
    const mote_vec3 along = mote_add_scaled(speed, -mote_dot(speed, normal), normal);
    const mote_vec3 push =
        mote_add_scaled(mote_scale(normal, STIFFNESS * depth), -ROUGHNESS, along);
    for (int c = 0; c < 8; ++c) {
        mote_vec3 *force = &s->force[s->cubes[e->cube].node[c]];
        *force = mote_add_scaled(*force, weight_of(e, c), push);
    }
}

static void add_contact_forces(jelly *s, const embedded *e)
{
    const mote_vec3 p = value_at(s, e, s->position);
    if (p.z < FLOOR + MARGIN)
        add_contact(s, e, FLOOR + MARGIN - p.z, mote_vec3_make(0, 0, 1));
    if (p.z > s->other.high.z + MARGIN || p.z < s->other.low.z - MARGIN)
        return;
    mote_vec3 gradient;
    const double depth = MARGIN - mote_glyph_field(&s->other, p, &gradient);
    const double slope = sqrt(mote_length_squared(gradient));
    if (depth > 0 && slope > 0)
        add_contact(s, e, depth, mote_scale(gradient, 1 / slope));
}

static void substep(jelly *s)
{
    const double time = 1.0 / SUBSTEPS;
    for (uint32_t k = 0; k < s->node_count; ++k)
        s->force[k] = mote_vec3_make(0, 0, -GRAVITY * s->mass[k]);
    for (uint32_t k = 0; k < s->cube_count; ++k)
        add_elastic_forces(s, &s->cubes[k]);
    for (uint32_t k = 0; k < s->contact_count; ++k)
        add_contact_forces(s, &s->contacts[k]);
    for (uint32_t k = 0; k < s->node_count; ++k) {
        s->velocity[k] =
            mote_scale(mote_add_scaled(s->velocity[k], time / s->mass[k], s->force[k]), KEPT);
        s->position[k] = mote_add_scaled(s->position[k], time, s->velocity[k]);
    }
}

static void step(void *state, mote_vec3 *positions)
{
    jelly *s = state;
    for (int i = 0; i < SUBSTEPS; ++i)
        substep(s);
    for (uint32_t v = 0; v < s->vertex_count; ++v)
        positions[v] = value_at(s, &s->vertices[v], s->position);
}

static void destroy(void *state)
{
    jelly *s = state;
    if (!s)
        return;
    free(s->cubes);
    free(s->rest);
    free(s->position);
    free(s->velocity);
    free(s->force);
    free(s->mass);
    free(s->contacts);
    free(s->vertices);
    free(s);
}

/* Lifts the letter above the other one, turned so that a corner lands first, and a little
 * aside. */
static mote_vec3 lifted(mote_vec3 p)
{
    const mote_vec3 turned = {p.x, 0.28 * p.y - 0.96 * p.z, 0.96 * p.y + 0.28 * p.z};
    const mote_vec3 tilted = {0.8 * turned.x - 0.6 * turned.z, turned.y,
                              0.6 * turned.x + 0.8 * turned.z};
    return mote_add(tilted, mote_vec3_make(0.06, 0.03, 0.62));
}

static mote_status lift(jelly *s)
{
    s->position = malloc(s->node_count * sizeof *s->position);
    s->velocity = calloc(s->node_count, sizeof *s->velocity);
    s->force = malloc(s->node_count * sizeof *s->force);
    if (!s->position || !s->velocity || !s->force)
        return mote_fail(MOTE_ENOMEM, "jelly: no memory");
    for (uint32_t k = 0; k < s->node_count; ++k)
        s->position[k] = lifted(s->rest[k]);
    return MOTE_OK;
}

/* The mesh as it is at frame 1. */
static mote_status lift_mesh(const mote_mesh *from, mote_mesh **mesh)
{
    mote_vec3 *positions = malloc(from->vertex_count * sizeof *positions);
    if (!positions)
        return mote_fail(MOTE_ENOMEM, "jelly: no memory for %u vertices", from->vertex_count);
    for (uint32_t v = 0; v < from->vertex_count; ++v)
        positions[v] = lifted(from->positions[v]);
    const mote_status status =
        mote_mesh_create(&positions[0].x, from->vertex_count, &from->triangles[0][0],
                         from->triangle_count, mesh);
    free(positions);
    return status;
}

static mote_status embed_meshes(jelly *s, const mote_mesh *shown)
{
    mote_mesh *coarse = NULL;
    mote_status status = mote_letter_create(LETTER, CONTACTS, &coarse);
    if (status == MOTE_OK)
        status = embed_all(s, coarse, &s->contacts, &s->contact_count);
    if (status == MOTE_OK)
        status = embed_all(s, shown, &s->vertices, &s->vertex_count);
    mote_mesh_destroy(coarse);
    return status;
}

static mote_status create(size_t triangle_count, mote_mesh **mesh, void **state)
{
    mote_mesh *letter = NULL;
    mote_status status = mote_simulated_check(&mote_simulated_jelly, triangle_count);
    if (status == MOTE_OK)
        status = mote_letter_create(LETTER, triangle_count / 2 * 2, &letter);
    jelly *s = status == MOTE_OK ? calloc(1, sizeof *s) : NULL;
    if (status == MOTE_OK && !s)
        status = mote_fail(MOTE_ENOMEM, "jelly: no memory");
    if (status == MOTE_OK)
        status = mote_glyph_make(LETTER, &s->own);
    if (status == MOTE_OK)
        status = mote_glyph_make(MOTE_SIMULATED_LETTER, &s->other);
    if (status == MOTE_OK)
        status = make_lattice(s);
    if (status == MOTE_OK)
        status = lift(s);
    if (status == MOTE_OK)
        status = embed_meshes(s, letter);
    if (status == MOTE_OK)
        status = lift_mesh(letter, mesh);
    mote_mesh_destroy(letter);
    if (status != MOTE_OK) {
        destroy(s);
        return status;
    }
    set_slopes(s);
    *state = s;
    return MOTE_OK;
}

const mote_simulated_body mote_simulated_jelly = {
    "jelly", "a letter of jelly that falls onto a letter and bounces (finite elements)", create,
    destroy, step};
