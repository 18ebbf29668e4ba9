/* Any text as the summaries of two runs, compared: the base's before a line of "====", the new
   one's after it. */
#include "harness/compare/compare.h"
#include "tests/fuzz/fuzz.h"

#include <stdio.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[2] = {"base.json", "new.json"};
    char paths[2][128];
    const char *folder = fuzz_two_files(data, size, names);
    for (int k = 0; k < 2; ++k)
        (void)snprintf(paths[k], sizeof paths[k], "%s/%s", folder, names[k]);
    mote_comparison comparison;
    if (mote_compare(paths[0], paths[1], 0.05, &comparison) == MOTE_OK)
        mote_comparison_free(&comparison);
    return 0;
}
