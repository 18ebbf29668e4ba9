/* The file of a truth: a line that names its scenario, a CSV, and a last line with a hash of
   everything before it, so that a truncated or edited file is rejected. */
#include "harness/run/truth.h"

#include "harness/base/file.h"
#include "harness/base/hash.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COLUMNS "frame,distance,ax,ay,az,bx,by,bz,overruled\n"

char *mote_truth_path(const char *directory, const mote_scenario *scenario,
                      uint64_t fingerprint)
{
    return mote_format("%s/truth/%s-%016" PRIx64 "-%016" PRIx64 ".csv", directory,
                       scenario->name, fingerprint, mote_scenario_faces(scenario));
}

/* The first line up to the number of checked frames. A scenario may have any name. */
static char *first_part(const mote_scenario *scenario, uint64_t fingerprint, uint32_t frames)
{
    return mote_format("# truth of %s, fingerprint %016" PRIx64 ", faces %016" PRIx64
                       ", %u frames, ",
                       scenario->name, fingerprint, mote_scenario_faces(scenario), frames);
}

/* The same as older versions wrote it, without the faces. */
static char *old_first_part(const mote_scenario *scenario, uint64_t fingerprint)
{
    return mote_format("# truth of %s, fingerprint %016" PRIx64 ", %u frames, ", scenario->name,
                       fingerprint, scenario->frames);
}

#define FIRST_END " checked\n"

static void add_row(mote_text *text, const mote_truth *truth, uint32_t k)
{
    const mote_vec3 a = truth->witness_a[k];
    const mote_vec3 b = truth->witness_b[k];
    mote_text_add(text, "%u,%.17g,", k + 1, truth->distance[k]);
    if (isnan(a.x))
        mote_text_add(text, ",,,,,");
    else
        mote_text_add(text, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", a.x, a.y, a.z, b.x, b.y,
                      b.z);
    if (isnan(truth->overruled[k]))
        mote_text_add(text, ",\n");
    else
        mote_text_add(text, ",%.17g\n", truth->overruled[k]);
}

void mote_truth_seal(mote_text *text)
{
    const uint64_t hash = mote_hash_bytes(MOTE_HASH_START, text->data, text->size);
    mote_text_add(text, "# hash %016" PRIx64 "\n", hash);
}

mote_status mote_truth_write(const mote_scenario *scenario, const mote_truth *truth,
                             const char *path)
{
    mote_text text = {0};
    char *first = first_part(scenario, truth->fingerprint, truth->frames);
    mote_text_add(&text, "%s%u" FIRST_END COLUMNS, first, truth->checked);
    for (uint32_t k = 0; k < truth->frames; ++k)
        add_row(&text, truth, k);
    mote_truth_seal(&text);
    const mote_status status = mote_file_write(path, text.data, text.size);
    free(first);
    free(text.data);
    return status;
}

/* Reads "ax,ay,az,bx,by,bz,", where all six may be empty; NULL if the text differs. */
static const char *read_witness(const char *at, mote_truth *truth, uint32_t k)
{
    if (strncmp(at, ",,,,,,", 6) == 0)
        return at + 6;
    double number[6];
    for (int i = 0; i < 6; ++i) {
        char *end;
        number[i] = strtod(at, &end);
        if (end == at || *end != ',')
            return NULL;
        at = end + 1;
    }
    truth->witness_a[k] = mote_vec3_make(number[0], number[1], number[2]);
    truth->witness_b[k] = mote_vec3_make(number[3], number[4], number[5]);
    return at;
}

/* Reads "K,d,ax,ay,az,bx,by,bz,overruled\n"; NULL if the text differs. */
static const char *read_row(const char *at, mote_truth *truth, uint32_t k)
{
    char *end;
    if (strtoul(at, &end, 10) != k + 1 || *end != ',')
        return NULL;
    at = end + 1;
    truth->distance[k] = strtod(at, &end);
    if (end == at || *end != ',' || !(truth->distance[k] >= 0))
        return NULL;
    at = read_witness(end + 1, truth, k);
    if (!at || *at == '\n')
        return at ? at + 1 : NULL;
    truth->overruled[k] = strtod(at, &end);
    return end != at && *end == '\n' ? end + 1 : NULL;
}

bool mote_truth_unseal(char *text, size_t size)
{
    static const size_t last_size = sizeof "# hash 0123456789abcdef\n" - 1;
    if (size < last_size)
        return false;
    char *last = text + size - last_size;
    char expected[32];
    (void)snprintf(expected, sizeof expected, "# hash %016" PRIx64 "\n",
                   mote_hash_bytes(MOTE_HASH_START, text, size - last_size));
    bool same = strcmp(last, expected) == 0;
    *last = '\0';
    return same;
}

/* What follows a beginning of a text, or NULL; frees the beginning. */
static const char *behind(const char *text, char *beginning)
{
    const size_t length = strlen(beginning);
    const bool begins = strncmp(text, beginning, length) == 0;
    free(beginning);
    return begins ? text + length : NULL;
}

/* Reads the first line and the column names; NULL if they do not match this truth. */
static const char *read_head(const mote_scenario *scenario, uint64_t fingerprint,
                             const char *text, mote_truth *truth)
{
    static const char rest[] = FIRST_END COLUMNS;
    char *end = NULL;
    const char *number = behind(text, first_part(scenario, fingerprint, scenario->frames));
    if (!number)
        number = behind(text, old_first_part(scenario, fingerprint));
    const unsigned long checked = number ? strtoul(number, &end, 10) : 0;
    if (!number || checked > UINT32_MAX || strncmp(end, rest, strlen(rest)) != 0)
        return NULL;
    truth->checked = (uint32_t)checked;
    return end + strlen(rest);
}

static bool read_text(const mote_scenario *scenario, uint64_t fingerprint, char *text,
                      size_t size, mote_truth *truth)
{
    if (!mote_truth_unseal(text, size))
        return false;
    const char *at = read_head(scenario, fingerprint, text, truth);
    for (uint32_t k = 0; at && k < truth->frames; ++k)
        at = read_row(at, truth, k);
    truth->fingerprint = fingerprint;
    return at && *at == '\0';
}

mote_status mote_truth_read(const mote_scenario *scenario, uint64_t fingerprint,
                            const char *path, mote_truth **truth)
{
    char *text;
    size_t size;
    mote_status status = mote_file_read(path, (size_t)1 << 30, &text, &size);
    if (status != MOTE_OK)
        return status;
    mote_truth *made = mote_truth_allocate(scenario->frames);
    if (read_text(scenario, fingerprint, text, size, made)) {
        mote_truth_set_contacts(scenario, made);
        *truth = made;
    } else {
        mote_truth_destroy(made);
        status = mote_fail(MOTE_EINVAL, "%s: not the whole truth of %s; remove it", path,
                           scenario->name);
    }
    free(text);
    return status;
}
