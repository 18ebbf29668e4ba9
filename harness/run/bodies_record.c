#include "harness/run/bodies_record.h"

#include "harness/base/file.h"
#include "harness/base/hash.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char *mote_bodies_cell_name(const mote_bodies *bodies, const mote_bodies_choice *choice,
                            uint32_t replicate)
{
    char *name = mote_format("%s-%.60s-%08" PRIx64 "-r%u", bodies->name, choice->text,
                             mote_hash_text(choice->text) >> 32, replicate);
    for (char *c = name; c && *c; ++c) {
        const bool plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
                           (*c >= '0' && *c <= '9') || *c == '.';
        *c = plain ? *c : '-';
    }
    return name;
}

static mote_status cannot(const char *name)
{
    return mote_fail(MOTE_EIO, "%s: cannot be written: %s", name, strerror(errno));
}

mote_status mote_bodies_record_open(const char *directory, const char *name,
                                    mote_bodies_record *record)
{
    static const char *const kinds[] = {"steps", "pairs"};
    FILE **files[] = {&record->steps, &record->pairs};
    *record = (mote_bodies_record){.steps = NULL};
    char *folder = mote_format("%s/bodies", directory);
    mote_status status = folder ? mote_directory_make(folder)
                                : mote_fail(MOTE_ENOMEM, "%s: no memory for a name", name);
    for (int k = 0; k < 2 && status == MOTE_OK; ++k) {
        record->part[k] = mote_format("%s/%s.%s.csv" MOTE_BODIES_PART, folder, name, kinds[k]);
        if (!record->part[k])
            status = mote_fail(MOTE_ENOMEM, "%s: no memory for a name", name);
        else if (!(*files[k] = fopen(record->part[k], "w")))
            status = cannot(record->part[k]);
    }
    free(folder);
    if (status != MOTE_OK) {
        (void)mote_bodies_record_close(record, false);
        return status;
    }
    (void)fputs("frame,near_pairs,new_pairs,contacts,motion_ns,bounds_ns,deform_ns,update_ns,"
                "broad_ns,query_ns,total_ns,positions,box_tests,triangle_tests,allocations\n",
                record->steps);
    (void)fputs("frame,body_a,body_b,steps,distance,lower,contact,ax,ay,az,bx,by,bz,positions,"
                "box_tests,triangle_tests\n",
                record->pairs);
    return MOTE_OK;
}

static void put_number(FILE *file, bool has, double value)
{
    if (has)
        (void)fprintf(file, ",%.17g", value);
    else
        (void)fputc(',', file);
}

static void put_pair(FILE *file, uint32_t frame, const mote_bodies_pair *pair)
{
    const mote_answer *a = &pair->answer;
    (void)fprintf(file, "%u,%u,%u,%u", frame, pair->body[0] + 1, pair->body[1] + 1,
                  pair->steps);
    put_number(file, a->has_distance, a->distance);
    put_number(file, a->has_lower, a->lower);
    if (a->has_contact)
        (void)fprintf(file, ",%d", a->contact);
    else
        (void)fputc(',', file);
    for (int k = 0; k < 2; ++k) {
        put_number(file, a->has_witness, a->witness[k].x);
        put_number(file, a->has_witness, a->witness[k].y);
        put_number(file, a->has_witness, a->witness[k].z);
    }
    (void)fprintf(file, ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 "\n", a->counters.positions,
                  a->counters.box_tests, a->counters.triangle_tests);
}

void mote_bodies_record_step(mote_bodies_record *record, const mote_bodies_timed *step,
                             const mote_bodies_pair *pairs, size_t count)
{
    const mote_bodies_step *s = &step->step;
    if (!record->steps)
        return;
    (void)fprintf(record->steps,
                  "%u,%zu,%zu,%zu,%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64
                  ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 "\n",
                  step->frame, s->pairs, s->fresh, s->contacts, step->motion_ns, s->bounds_ns,
                  s->deform_ns, s->update_ns, s->broad_ns, s->query_ns, step->total_ns,
                  s->counters.positions, s->counters.box_tests, s->counters.triangle_tests,
                  s->allocations);
    for (size_t k = 0; k < count; ++k)
        put_pair(record->pairs, step->frame, &pairs[k]);
}

static mote_status close_part(FILE *file, const char *part, bool whole)
{
    char *name = mote_format("%.*s", (int)(strlen(part) - strlen(MOTE_BODIES_PART)), part);
    const bool lost = ferror(file) != 0;
    bool good = fflush(file) == 0 && !lost && fsync(fileno(file)) == 0;
    good = fclose(file) == 0 && good;
    mote_status status = MOTE_OK;
    if (!name)
        status = mote_fail(MOTE_ENOMEM, "%s: no memory for its name", part);
    else if (whole && (!good || rename(part, name) != 0))
        status = cannot(name);
    if (!whole || status != MOTE_OK)
        (void)remove(part);
    free(name);
    return status;
}

mote_status mote_bodies_record_close(mote_bodies_record *record, bool whole)
{
    FILE *const files[] = {record->steps, record->pairs};
    mote_status status = MOTE_OK;
    for (int k = 0; k < 2; ++k) {
        mote_status closed =
            files[k] ? close_part(files[k], record->part[k], whole && status == MOTE_OK)
                     : MOTE_OK;
        status = status == MOTE_OK ? closed : status;
        free(record->part[k]);
    }
    *record = (mote_bodies_record){.steps = NULL};
    return status;
}
