#include "harness/process/huge_pages.h"

#include "harness/base/file.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <unistd.h>

#define CHOICE "/sys/kernel/mm/transparent_hugepage/enabled"
#define VARIABLE "GLIBC_TUNABLES"
#define TUNABLE "glibc.malloc.hugetlb"

/* The word in brackets of a line like "always [madvise] never"; "" if there is none. */
static void read_choice(char word[16])
{
    char line[64] = "";
    FILE *file = fopen(CHOICE, "r");
    word[0] = '\0';
    if (!file)
        return;
    if (fgets(line, sizeof line, file) && strchr(line, '['))
        (void)snprintf(word, 16, "%.*s", (int)strcspn(strchr(line, '[') + 1, "]"),
                       strchr(line, '[') + 1);
    (void)fclose(file);
}

static const char *tunables(void)
{
    const char *value = getenv(VARIABLE);
    return value ? value : "";
}

const char *mote_huge_pages(void)
{
    char choice[16];
    read_choice(choice);
    if (strcmp(choice, "always") == 0)
        return "always";
    if (strcmp(choice, "never") == 0)
        return "never";
    if (strcmp(choice, "madvise") != 0)
        return "unknown";
    const char *asked = strstr(tunables(), TUNABLE "=");
    return asked && asked[sizeof TUNABLE] != '0' ? "asked" : "not asked";
}

void mote_huge_pages_ask(char **argv)
{
    if (strcmp(mote_huge_pages(), "not asked") != 0 || strstr(tunables(), TUNABLE) ||
        getenv("LD_PRELOAD") ||
        getauxval(AT_SECURE)) /* then the variable would be dropped, again and again */
        return;
    char *before = mote_format("%s", tunables());
    char *wanted = mote_format("%s%s" TUNABLE "=1", before, before[0] ? ":" : "");
    if (setenv(VARIABLE, wanted, 1) == 0)
        (void)execv("/proc/self/exe", argv);
    (void)(before[0] ? setenv(VARIABLE, before, 1) : unsetenv(VARIABLE));
    free(before);
    free(wanted);
}
