/* Huge pages: the program asks for them where the system leaves that to programs, and not where
   it was told otherwise or another library is loaded first. */
#include "harness/base/heap_count.h"
#include "harness/base/record.h"
#include "tests/support/mote.h"
#include "tests/support/test.h"

#include <stdbool.h>

/* Whether the system leaves the choice to programs. */
static bool has_choice(void)
{
    char line[64] = "";
    FILE *file = fopen("/sys/kernel/mm/transparent_hugepage/enabled", "r");
    const bool is_read = file && fgets(line, sizeof line, file);
    if (file)
        (void)fclose(file);
    return is_read && strstr(line, "[madvise]");
}

/* Sets or removes a variable of the programs that are run from now on. */
static void set(const char *name, const char *value)
{
    assert_int_equal(value ? setenv(name, value, 1) : unsetenv(name), 0);
}

TEST(mote_asks_for_huge_pages_unless_told_otherwise)
{
    static const struct {
        const char *tunables, *preload, *says;
    } cases[] = {{NULL, NULL, "asked"},
                 {"", NULL, "asked"},
                 {"glibc.malloc.arena_max=4", NULL, "asked"},
                 {"glibc.malloc.hugetlb=1", NULL, "asked"},
                 {"glibc.malloc.arena_max=4:glibc.malloc.hugetlb=2", NULL, "asked"},
                 {"glibc.malloc.hugetlb=0", NULL, "not asked"},
                 {NULL, "libm.so.6", "not asked"}};
    for (size_t k = 0; k < ROWS_OF(cases); ++k) {
        json_t *manifest = NULL;
        if (cases[k].preload && !mote_heap_read().counted)
            continue; /* a sanitizer's library has to be the first */
        set("GLIBC_TUNABLES", cases[k].tunables);
        set("LD_PRELOAD", cases[k].preload);
        const int status =
            mote("run tt --method certified --frames 1-2 --replicates 1 --out %zu", k);
        set("GLIBC_TUNABLES", NULL);
        set("LD_PRELOAD", NULL);
        if (status != 0)
            fail_msg("case %zu: %s", k, said);
        char folder[8];
        (void)snprintf(folder, sizeof folder, "%zu", k);
        assert_int_equal(mote_record_read_json(folder, "manifest.json", &manifest), MOTE_OK);
        const char *says = json_string_value(json_object_get(manifest, "huge_pages"));
        assert_non_null(says);
        if (has_choice())
            assert_string_equal(says, cases[k].says);
        else
            assert_string_not_equal(says, "asked");
        json_decref(manifest);
    }
}
