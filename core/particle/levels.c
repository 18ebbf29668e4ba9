#include "core/particle/levels.h"

#include "core/base/random.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#define NONE UINT32_MAX

/* One level under construction: a graph, and the cell of each of its nodes. */
typedef struct stage {
    uint32_t count;
    const uint32_t *start,
        *neighbour;             /* entries as in a ring: the top bit is no part of them */
    const mote_vec3 *positions; /* of the mesh */
    const uint32_t *vertex;     /* mesh vertex of each node; NULL: the mesh itself */
    uint32_t *cell;             /* [count], the chosen node whose cell it is in */
} stage;

static mote_vec3 stage_position(const stage *s, uint32_t node)
{
    return s->positions[s->vertex ? s->vertex[node] : node];
}

/* A number near the golden section of count that has no common factor with it. Stepping by it
   visits every node, and neighbours at very different times, so that few chosen nodes end up
   only two edges apart. */
static uint32_t scattered_step(uint32_t count)
{
    uint32_t step = (uint32_t)(0.6180339887 * count) | 1u;
    for (;; ++step) {
        uint32_t a = step, b = count;
        while (b > 0) {
            const uint32_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1)
            return step;
    }
}

/* A maximal independent set: cell[i] becomes i for the chosen nodes, NONE for others. Returns
   how many are chosen. */
static uint32_t choose_independent(stage *s)
{
    const uint32_t step = scattered_step(s->count);
    uint32_t chosen = 0;
    memset(s->cell, 0xff, s->count * sizeof *s->cell);
    uint64_t i = 0;
    for (uint32_t n = 0; n < s->count; ++n) {
        bool free_of_chosen = true;
        for (uint32_t k = s->start[i]; k < s->start[i + 1] && free_of_chosen; ++k)
            free_of_chosen = s->cell[MOTE_RING_VERTEX(s->neighbour[k])] == NONE;
        if (free_of_chosen) {
            s->cell[i] = (uint32_t)i;
            ++chosen;
        }
        i = (i + step) % s->count;
    }
    return chosen;
}

/* Every other node joins the cell of its nearest chosen neighbour. */
static void join_cells(stage *s)
{
    for (uint32_t i = 0; i < s->count; ++i) {
        if (s->cell[i] == i)
            continue;
        const mote_vec3 p = stage_position(s, i);
        double least = HUGE_VAL;
        for (uint32_t k = s->start[i]; k < s->start[i + 1]; ++k) {
            const uint32_t u = MOTE_RING_VERTEX(s->neighbour[k]);
            if (s->cell[u] != u)
                continue;
            const double squared = mote_distance_squared(p, stage_position(s, u));
            if (squared < least || s->cell[i] == NONE) {
                least = squared;
                s->cell[i] = u;
            }
        }
    }
}

/* The coarse graph under construction. */
typedef struct cells {
    const stage *fine;
    uint32_t *number; /* [fine->count], the coarse node of each chosen node */
    uint32_t *first;  /* [coarse + 1], members of each cell */
    uint32_t *member; /* [fine->count] */
    uint32_t *seen;   /* [coarse], the last cell that listed it */
} cells;

/* Lists a cell's neighbours, each once, into list (NULL: only counts them). */
static uint32_t neighbours_of_cell(cells *c, uint32_t coarse, uint32_t mark, uint32_t *list)
{
    const stage *s = c->fine;
    uint32_t count = 0;
    c->seen[coarse] = mark;
    for (uint32_t m = c->first[coarse]; m < c->first[coarse + 1]; ++m) {
        const uint32_t i = c->member[m];
        for (uint32_t k = s->start[i]; k < s->start[i + 1]; ++k) {
            const uint32_t other = c->number[s->cell[MOTE_RING_VERTEX(s->neighbour[k])]];
            if (c->seen[other] == mark)
                continue;
            c->seen[other] = mark;
            if (list)
                list[count] = other;
            ++count;
        }
    }
    return count;
}

/* Sorts the members by cell. */
static void group_members(cells *c, uint32_t coarse_count)
{
    const stage *s = c->fine;
    memset(c->first, 0, ((size_t)coarse_count + 1) * sizeof *c->first);
    for (uint32_t i = 0; i < s->count; ++i)
        ++c->first[c->number[s->cell[i]] + 1];
    for (uint32_t i = 0; i < coarse_count; ++i)
        c->first[i + 1] += c->first[i];
    for (uint32_t i = s->count; i-- > 0;)
        c->member[--c->first[c->number[s->cell[i]] + 1]] = i;
    /* Each entry i + 1 has gone down to the start of cell i. */
    memmove(c->first, c->first + 1, coarse_count * sizeof *c->first);
    c->first[coarse_count] = s->count;
}

static mote_status no_memory(void)
{
    return mote_fail(MOTE_ENOMEM, "no memory for the levels of a mesh");
}

static mote_status link_cells(cells *c, mote_level *coarse)
{
    coarse->start = malloc(((size_t)coarse->count + 1) * sizeof *coarse->start);
    if (!coarse->start)
        return no_memory();
    memset(c->seen, 0xff, coarse->count * sizeof *c->seen);
    coarse->start[0] = 0;
    for (uint32_t i = 0; i < coarse->count; ++i)
        coarse->start[i + 1] = coarse->start[i] + neighbours_of_cell(c, i, i, NULL);
    const size_t links = coarse->start[coarse->count];
    coarse->neighbour = calloc(links ? links : 1, sizeof *coarse->neighbour);
    if (!coarse->neighbour)
        return no_memory();
    memset(c->seen, 0xff, coarse->count * sizeof *c->seen);
    for (uint32_t i = 0; i < coarse->count; ++i)
        neighbours_of_cell(c, i, i, coarse->neighbour + coarse->start[i]);
    return MOTE_OK;
}

/* Makes the level above a stage whose cells are known; chosen[i] is the fine node of coarse
   node i. */
static mote_status coarsen(const stage *fine, mote_level *coarse, uint32_t *chosen)
{
    assert(fine->count > 0 && coarse->count > 0); /* a mesh has a vertex */
    cells c = {.fine = fine};
    c.number = malloc(fine->count * sizeof *c.number);
    c.member = malloc(fine->count * sizeof *c.member);
    c.first = malloc(((size_t)coarse->count + 1) * sizeof *c.first);
    c.seen = malloc(coarse->count * sizeof *c.seen);
    mote_status status = MOTE_OK;
    if (!c.number || !c.member || !c.first || !c.seen)
        status = no_memory();
    if (status == MOTE_OK) {
        uint32_t next = 0;
        for (uint32_t i = 0; i < fine->count; ++i) {
            if (fine->cell[i] == i) {
                chosen[next] = i;
                c.number[i] = next++;
            }
        }
        group_members(&c, coarse->count);
        status = link_cells(&c, coarse);
    }
    free(c.number);
    free(c.member);
    free(c.first);
    free(c.seen);
    return status;
}

/* Renumbers a level: node i becomes number[i]. */
static mote_status renumber(mote_level *level, const uint32_t *number)
{
    const uint32_t links = level->start[level->count];
    uint32_t *start = malloc(((size_t)level->count + 1) * sizeof *start);
    uint32_t *neighbour = malloc((links ? links : 1) * sizeof *neighbour);
    if (!start || !neighbour) {
        free(start);
        free(neighbour);
        return no_memory();
    }
    start[0] = 0;
    for (uint32_t i = 0; i < level->count; ++i)
        start[number[i] + 1] = level->start[i + 1] - level->start[i];
    for (uint32_t i = 0; i < level->count; ++i)
        start[i + 1] += start[i];
    for (uint32_t i = 0; i < level->count; ++i) {
        uint32_t *to = neighbour + start[number[i]];
        for (uint32_t k = level->start[i]; k < level->start[i + 1]; ++k)
            *to++ = number[level->neighbour[k]];
    }
    free(level->start);
    free(level->neighbour);
    level->start = start;
    level->neighbour = neighbour;
    return MOTE_OK;
}

/* Numbers a level's nodes so that a node has the same number on every level: first those of the
   level above, with their numbers there. Takes ownership of above. */
static uint32_t *numbers_of(uint32_t count, const uint32_t *chosen, uint32_t *above,
                            uint32_t above_count)
{
    uint32_t *number = malloc(count * sizeof *number);
    if (number) {
        memset(number, 0xff, count * sizeof *number);
        for (uint32_t i = 0; i < above_count; ++i)
            number[chosen[i]] = above[i];
        uint32_t next = above_count;
        for (uint32_t i = 0; i < count; ++i) {
            if (number[i] == NONE)
                number[i] = next++;
        }
    }
    free(above);
    return number;
}

/* chosen[l][i]: node i of level l in the level below it (a mesh vertex for l = 0). */
static mote_status number_alike(mote_levels *levels, uint32_t *const *chosen)
{
    uint32_t *number = NULL;
    uint32_t above = 0;
    for (uint32_t l = levels->depth; l-- > 0;) {
        mote_level *level = &levels->level[l];
        number = numbers_of(level->count, l + 1 < levels->depth ? chosen[l + 1] : NULL, number,
                            above);
        if (!number)
            return no_memory();
        const mote_status status = renumber(level, number);
        if (status != MOTE_OK) {
            free(number);
            return status;
        }
        above = level->count;
    }
    for (uint32_t i = 0; i < levels->level[0].count; ++i)
        levels->vertex[number[i]] = chosen[0][i];
    free(number);
    return MOTE_OK;
}

/* Makes one level; *vertex is the mesh vertex of each node below (NULL for the mesh itself),
   replaced by that of the new level. */
static mote_status add_level(mote_levels *levels, const mote_mesh *mesh, uint32_t **chosen,
                             uint32_t **vertex)
{
    const uint32_t l = levels->depth;
    stage fine = {.positions = mesh->positions, .vertex = *vertex};
    fine.count = l == 0 ? mesh->vertex_count : levels->level[l - 1].count;
    fine.start = l == 0 ? mesh->ring_start : levels->level[l - 1].start;
    fine.neighbour = l == 0 ? mesh->ring : levels->level[l - 1].neighbour;
    fine.cell = malloc(fine.count * sizeof *fine.cell);
    if (!fine.cell)
        return no_memory();
    mote_level *level = &levels->level[l];
    ++levels->depth;
    level->count = choose_independent(&fine);
    join_cells(&fine);
    assert(level->count > 0);
    chosen[l] = calloc(level->count, sizeof *chosen[l]);
    uint32_t *names = malloc(level->count * sizeof *names);
    mote_status status = chosen[l] && names ? coarsen(&fine, level, chosen[l]) : no_memory();
    if (status == MOTE_OK) {
        for (uint32_t i = 0; i < level->count; ++i)
            names[i] = *vertex ? (*vertex)[chosen[l][i]] : chosen[l][i];
        free(*vertex);
        *vertex = names;
        names = NULL;
    }
    free(names);
    free(fine.cell);
    return status;
}

static bool worth_another(const mote_levels *levels, const mote_mesh *mesh)
{
    const uint32_t l = levels->depth;
    if (l == 0)
        return true;
    const uint32_t count = levels->level[l - 1].count;
    const uint32_t below = l == 1 ? mesh->vertex_count : levels->level[l - 2].count;
    return l < MOTE_LEVELS_MAX && count > MOTE_LEVELS_COARSEST && count < below - below / 8;
}

static void measure_spacing(const mote_levels *levels, const mote_mesh *mesh, mote_level *level)
{
    double sum = 0;
    for (uint32_t i = 0; i < level->count; ++i) {
        const mote_vec3 p = mesh->positions[levels->vertex[i]];
        for (uint32_t k = level->start[i]; k < level->start[i + 1]; ++k) {
            const uint32_t u = levels->vertex[level->neighbour[k]];
            sum += mote_length(mote_sub(mesh->positions[u], p));
        }
    }
    const uint32_t links = level->start[level->count];
    level->spacing = links ? sum / links : mesh->diagonal;
}

mote_status mote_levels_create(const mote_mesh *mesh, mote_levels **levels)
{
    mote_levels *made = calloc(1, sizeof *made);
    if (!made)
        return no_memory();
    uint32_t *chosen[MOTE_LEVELS_MAX] = {NULL};
    uint32_t *vertex = NULL;
    mote_status status = MOTE_OK;
    while (status == MOTE_OK && worth_another(made, mesh))
        status = add_level(made, mesh, chosen, &vertex);
    if (status == MOTE_OK) {
        made->vertex = malloc(made->level[0].count * sizeof *made->vertex);
        status = made->vertex ? number_alike(made, chosen) : no_memory();
    }
    for (uint32_t l = 0; l < MOTE_LEVELS_MAX; ++l)
        free(chosen[l]);
    free(vertex);
    if (status != MOTE_OK) {
        mote_levels_destroy(made);
        return status;
    }
    for (uint32_t l = 0; l < made->depth; ++l)
        measure_spacing(made, mesh, &made->level[l]);
    *levels = made;
    return MOTE_OK;
}

void mote_levels_destroy(mote_levels *levels)
{
    if (!levels)
        return;
    for (uint32_t l = 0; l < levels->depth; ++l) {
        free(levels->level[l].start);
        free(levels->level[l].neighbour);
    }
    free(levels->vertex);
    free(levels);
}

size_t mote_levels_bytes(const mote_levels *levels)
{
    size_t bytes = sizeof *levels + levels->level[0].count * sizeof *levels->vertex;
    for (uint32_t l = 0; l < levels->depth; ++l) {
        const mote_level *level = &levels->level[l];
        bytes += ((size_t)level->count + 1 + level->start[level->count]) * sizeof(uint32_t);
    }
    return bytes;
}

/* Chosen nodes and, for every node of the level, the squared distance to the nearest of them.
 */
typedef struct spread {
    const mote_levels *levels;
    const mote_mesh *mesh;
    uint32_t level_count;
    double *squared;        /* -1 for a chosen node; HUGE_VAL while none is chosen */
    unsigned char *covered; /* components with a chosen node */
} spread;

static mote_vec3 node_position(const spread *s, uint32_t node)
{
    return s->mesh->positions[s->levels->vertex[node]];
}

static void choose_node(spread *s, uint32_t node, bool measure)
{
    const mote_vec3 p = node_position(s, node);
    for (uint32_t i = 0; measure && i < s->level_count; ++i)
        s->squared[i] = fmin(s->squared[i], mote_distance_squared(node_position(s, i), p));
    s->squared[node] = -1;
    s->covered[s->mesh->component[s->levels->vertex[node]]] = 1;
}

/* The node after `from`, in a circle, on a component that has none yet. */
static uint32_t uncovered_node(const spread *s, uint32_t from)
{
    uint32_t i = from;
    while (s->covered[s->mesh->component[s->levels->vertex[i]]])
        i = i + 1 < s->level_count ? i + 1 : 0;
    return i;
}

static uint32_t farthest_node(const spread *s)
{
    uint32_t best = 0;
    for (uint32_t i = 1; i < s->level_count; ++i) {
        if (s->squared[i] > s->squared[best])
            best = i;
    }
    return best;
}

static uint32_t random_node(const spread *s, mote_random *random)
{
    uint32_t i;
    do
        i = (uint32_t)mote_random_below(random, s->level_count);
    while (s->squared[i] < 0);
    return i;
}

static void spread_nodes(spread *s, uint32_t count, bool farthest, uint64_t seed,
                         uint32_t *nodes)
{
    const uint32_t components = s->mesh->component_count;
    const bool measure = farthest && count > components;
    mote_random random = {seed};
    for (uint32_t i = 0; i < s->level_count; ++i)
        s->squared[i] = HUGE_VAL;
    for (uint32_t i = 0; i < count; ++i) {
        if (i == 0)
            nodes[i] = (uint32_t)mote_random_below(&random, s->level_count);
        else if (i < components)
            nodes[i] = uncovered_node(s, nodes[i - 1]);
        else
            nodes[i] = farthest ? farthest_node(s) : random_node(s, &random);
        choose_node(s, nodes[i], measure);
    }
}

mote_status mote_levels_spread(const mote_levels *levels, const mote_mesh *mesh, uint32_t level,
                               uint32_t count, bool farthest, uint64_t seed, uint32_t *nodes)
{
    spread s = {.levels = levels, .mesh = mesh, .level_count = levels->level[level].count};
    s.squared = malloc(s.level_count * sizeof *s.squared);
    s.covered = calloc(mesh->component_count, 1);
    if (s.squared && s.covered)
        spread_nodes(&s, count, farthest, seed, nodes);
    const bool made = s.squared && s.covered;
    free(s.squared);
    free(s.covered);
    return made ? MOTE_OK : no_memory();
}

mote_status mote_levels_home(const mote_levels *levels, const mote_mesh *mesh, uint32_t level,
                             uint32_t **home)
{
    uint32_t *made = malloc(mesh->vertex_count * sizeof *made);
    uint32_t *queue = malloc(mesh->vertex_count * sizeof *queue);
    if (!made || !queue) {
        free(made);
        free(queue);
        return no_memory();
    }
    memset(made, 0xff, mesh->vertex_count * sizeof *made);
    uint32_t tail = 0;
    for (; tail < levels->level[level].count; ++tail) {
        queue[tail] = levels->vertex[tail];
        made[queue[tail]] = tail;
    }
    for (uint32_t head = 0; head < tail; ++head) {
        const uint32_t v = queue[head];
        for (uint32_t k = mesh->ring_start[v]; k < mesh->ring_start[v + 1]; ++k) {
            const uint32_t u = MOTE_RING_VERTEX(mesh->ring[k]);
            if (made[u] == NONE) {
                made[u] = made[v];
                queue[tail++] = u;
            }
        }
    }
    free(queue);
    *home = made;
    return MOTE_OK;
}
