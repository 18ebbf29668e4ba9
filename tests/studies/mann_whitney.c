/* Our Mann-Whitney p for samples from standard input (make test-exports): each line two
   samples, numbers separated by blanks, the samples by "|". Prints a p a line. */
#include "harness/base/statistics.h"

#include <stdio.h>
#include <stdlib.h>

#define VALUES_MAX 4096

/* Reads numbers up to whatever is none; returns how many. */
static size_t read_sample(const char **text, double *values)
{
    size_t count = 0;
    for (char *end; count < VALUES_MAX; *text = end) {
        values[count] = strtod(*text, &end);
        if (end == *text)
            break;
        ++count;
    }
    return count;
}

int main(void)
{
    static double a[VALUES_MAX], b[VALUES_MAX], work[4 * VALUES_MAX];
    static char line[64 * VALUES_MAX];
    while (fgets(line, sizeof line, stdin)) {
        const char *text = line;
        size_t a_count = read_sample(&text, a);
        while (*text == ' ' || *text == '|')
            ++text;
        size_t b_count = read_sample(&text, b);
        (void)printf("%.17g\n", mote_statistics_mann_whitney(a, a_count, b, b_count, work));
    }
    return 0;
}
