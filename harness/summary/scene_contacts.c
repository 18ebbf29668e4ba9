#include "harness/summary/scene_contacts.h"

#include "harness/base/file.h"
#include "harness/base/memory.h"
#include "harness/base/record.h"

#include <stdlib.h>
#include <string.h>

/* Fields before the contact field in a line of cells/ID.pairs.csv. */
#define FIELDS_BEFORE_CONTACT 6

static int order(const mote_scene_contact *a, const mote_scene_contact *b)
{
    if (a->frame != b->frame)
        return a->frame < b->frame ? -1 : 1;
    for (int k = 0; k < 2; ++k) {
        if (a->body[k] != b->body[k])
            return a->body[k] < b->body[k] ? -1 : 1;
    }
    return 0;
}

size_t mote_scene_contacts_lacking(const mote_scene_contacts *of, const mote_scene_contacts *in,
                                   uint32_t last)
{
    size_t at = 0, count = 0;
    for (size_t k = 0; k < of->count && of->list[k].frame <= last; ++k) {
        while (at < in->count && order(&in->list[at], &of->list[k]) < 0)
            ++at;
        count += at == in->count || order(&in->list[at], &of->list[k]) != 0;
    }
    return count;
}

/* Reads a line "frame,body_a,body_b,steps,distance,lower,contact,..."; returns the next line,
   or NULL if the line is different. */
static const char *read_line(const char *line, mote_scene_contact *contact, bool *touches)
{
    uint32_t *const numbers[] = {&contact->frame, &contact->body[0], &contact->body[1]};
    const char *end = strchr(line, '\n'), *at = line;
    for (int field = 0; field < FIELDS_BEFORE_CONTACT; ++field) {
        char *after = NULL;
        const unsigned long value = strtoul(at, &after, 10);
        if (field < 3 && (after == at || value < 1 || value > UINT32_MAX))
            return NULL;
        if (field < 3)
            *numbers[field] = (uint32_t)value;
        at = strchr(at, ',');
        if (!end || !at || at++ > end)
            return NULL;
    }
    *touches = *at == '1';
    return end + 1;
}

static void add_contact(mote_scene_contacts *contacts, size_t *capacity,
                        const mote_scene_contact *contact)
{
    contacts->list =
        mote_reserve(contacts->list, contacts->count + 1, capacity, sizeof *contacts->list);
    contacts->list[contacts->count++] = *contact;
}

static mote_status read_lines(const char *path, const char *text, mote_scene_contacts *contacts)
{
    const char *line = strchr(text, '\n');
    mote_scene_contact contact;
    size_t capacity = 0, number = 1;
    if (!line)
        return mote_fail(MOTE_EINVAL, "%s:1: not the header of a cell's pairs", path);
    for (++line; *line;) {
        bool touches = false;
        ++number;
        line = read_line(line, &contact, &touches);
        const size_t count = contacts->count;
        if (!line || (touches && count > 0 && order(&contacts->list[count - 1], &contact) >= 0))
            return mote_fail(MOTE_EINVAL,
                             "%s:%zu: not a pair's row; frames and bodies ascend from 1", path,
                             number);
        if (touches)
            add_contact(contacts, &capacity, &contact);
    }
    return MOTE_OK;
}

mote_status mote_scene_contacts_read(const char *directory, const mote_stored_cell *cell,
                                     mote_scene_contacts *contacts)
{
    *contacts = (mote_scene_contacts){.count = 0};
    char *path = mote_format("%s/cells/%s.pairs.csv", directory, cell->id), *text = NULL;
    size_t size;
    mote_status status = mote_file_read(path, MOTE_PAIRS_LIMIT, &text, &size);
    if (status == MOTE_OK)
        status = read_lines(path, text, contacts);
    free(text);
    free(path);
    return status;
}

/* The rank of a row as a reference; the lowest is the best, UINT32_MAX: none. */
static uint32_t reference_rank(const mote_summary_row *row)
{
    static const char *const names[] = {"fcl-aabb", "aabb-tree", "certified"};
    const bool every = strcmp(mote_text_at(row->parameters, "refit"), "every") == 0;
    for (uint32_t i = 0; i < 3; ++i) {
        if (strcmp(row->method, names[i]) == 0)
            return 2 * i + (every ? 0 : 1);
    }
    return UINT32_MAX;
}

/* Whether rows ask the same of the same frames, though the budget may have cut one short: their
   contacts are compared as far as both have got. */
static bool asks_the_same(const mote_summary_row *a, const mote_summary_row *b)
{
    return mote_summary_by_scene(a, b) == 0 && mote_summary_by_asked_frames(a, b) == 0;
}

static const mote_summary_row *find_reference(const mote_summary_row *rows, size_t count,
                                              const mote_summary_row *row)
{
    const mote_summary_row *best = NULL;
    uint32_t least = UINT32_MAX;
    for (size_t k = 0; k < count; ++k) {
        const uint32_t rank = reference_rank(&rows[k]);
        if (rows[k].finished > 0 && rank < least && asks_the_same(&rows[k], row)) {
            least = rank;
            best = &rows[k];
        }
    }
    return best;
}

static double sum_of(const double *values, size_t count)
{
    double sum = 0;
    for (size_t k = 0; k < count; ++k)
        sum += values[k];
    return sum;
}

/* Counts from a row's own cells. */
static void count_own(mote_summary_row *row)
{
    double pairs = 0, contacts = 0, frames = 0;
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        if (!mote_stored_ran(cell))
            continue;
        pairs += sum_of(cell->scene[MOTE_SCENE_COLUMN_near_pairs], cell->frames);
        contacts += sum_of(cell->scene[MOTE_SCENE_COLUMN_pair_contacts], cell->frames);
        frames += (double)cell->frames;
    }
    row->near_pairs = frames > 0 ? pairs / frames : (double)NAN;
    row->contacts = row->finished > 0 ? contacts / (double)row->finished : (double)NAN;
}

/* Compares the contacts of a row's cells with the reference's. */
static mote_status count_differing(const char *directory, const mote_stored_cell *reference,
                                   const mote_scene_contacts *real, mote_summary_row *row)
{
    double missed = 0, wrong = 0;
    for (size_t r = 0; r < row->replicates; ++r) {
        const mote_stored_cell *cell = &row->cells[r];
        mote_scene_contacts said;
        if (!mote_stored_ran(cell))
            continue;
        const mote_status status = mote_scene_contacts_read(directory, cell, &said);
        const uint32_t own = cell->frame[cell->frames - 1];
        const uint32_t its = reference->frame[reference->frames - 1];
        const uint32_t last = own < its ? own : its;
        missed += (double)mote_scene_contacts_lacking(real, &said, last);
        wrong += (double)mote_scene_contacts_lacking(&said, real, last);
        free(said.list);
        if (status != MOTE_OK)
            return status;
    }
    row->missed = missed / (double)row->finished;
    row->false_contacts = wrong / (double)row->finished;
    return MOTE_OK;
}

mote_status mote_scene_contacts_count(const char *directory, mote_summary_row *rows,
                                      size_t count)
{
    mote_scene_contacts real = {.count = 0};
    const mote_summary_row *known = NULL; /* the row whose contacts are loaded */
    mote_status status = MOTE_OK;
    for (size_t k = 0; k < count && status == MOTE_OK; ++k) {
        mote_summary_row *row = &rows[k];
        if (row->bodies == 0 || row->finished == 0)
            continue;
        count_own(row);
        row->contacts_of = find_reference(rows, count, row);
        if (!row->contacts_of)
            continue;
        const mote_stored_cell *reference = row->contacts_of->first;
        if (row->contacts_of != known) {
            free(real.list);
            real = (mote_scene_contacts){.count = 0};
            known = row->contacts_of;
            status = mote_scene_contacts_read(directory, reference, &real);
        }
        if (status == MOTE_OK)
            status = count_differing(directory, reference, &real, row);
    }
    free(real.list);
    return status;
}
