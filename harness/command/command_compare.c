/* mote compare BASE NEW: is one run better or worse than another? */
#include "harness/command/command.h"
#include "harness/base/options.h"
#include "harness/base/record.h"
#include "harness/compare/compare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEFAULT_FLOOR 0.02

static void print_table(const mote_comparison *c)
{
    int width = 4;
    size_t tested = 0;
    for (size_t i = 0; i < c->count; ++i) {
        int length = (int)strlen(c->changes[i].name);
        width = length > width ? length : width;
        tested += c->changes[i].p == c->changes[i].p ? 1 : 0;
    }
    (void)printf(
        "time new / base, 95 %% interval, p corrected over %zu row%s; an effect counts "
        "from %.1f %% on\n",
        tested, tested == 1 ? "" : "s", 100 * c->floor);
    if (c->other_machine)
        (void)printf("the processors differ: times only as ratios to fcl-aabb, within a wide "
                     "margin; counts, bytes and accuracy as they are\n");
    for (size_t i = 0; i < c->count; ++i) {
        const mote_change *change = &c->changes[i];
        (void)printf("%-*s ", width, change->name);
        if (isfinite(change->ratio) && isfinite(change->interval.low))
            (void)printf("%6.3f [%5.3f, %5.3f] p %-7.2g %-9s", change->ratio,
                         change->interval.low, change->interval.high, change->p,
                         mote_verdict_names[change->verdict]);
        else if (isfinite(change->ratio)) /* too few replicates */
            (void)printf("%6.3f %-24s %-9s", change->ratio, "no interval",
                         mote_verdict_names[change->verdict]);
        else
            (void)printf("%-41s", change->is_reference ? "what times are compared with" : "-");
        (void)printf(" %s%s%s\n",
                     change->worse    ? "WORSE "
                     : change->better ? "better "
                                      : "",
                     change->what.size ? ": " : "", change->what.size ? change->what.data : "");
    }
    if (c->only_base || c->only_new)
        (void)printf("without a partner: %zu rows of BASE, %zu of NEW\n", c->only_base,
                     c->only_new);
    (void)printf("%s\n", c->worse ? "worse"
                         : c->undecided
                             ? "undecided: times vary too much, replicates or rows are missing"
                             : "same or better");
}

static json_t *change_json(const mote_change *change)
{
    return json_pack(
        "{s:s, s:o, s:o, s:o, s:o, s:s, s:b, s:b, s:o, s:s}", "name", change->name, "ratio",
        mote_json_number(change->ratio), "ci_low", mote_json_number(change->interval.low),
        "ci_high", mote_json_number(change->interval.high), "p", mote_json_number(change->p),
        "verdict", mote_verdict_names[change->verdict], "worse", change->worse, "better",
        change->better, "smallest_change", mote_json_number(change->smallest_change), "what",
        change->what.size ? change->what.data : "");
}

static int print_json(const mote_comparison *c)
{
    json_t *rows = json_array();
    for (size_t i = 0; i < c->count; ++i)
        (void)json_array_append_new(rows, change_json(&c->changes[i]));
    json_t *object =
        json_pack("{s:i, s:s, s:f, s:b, s:b, s:i, s:i, s:o}", "schema", 1, "verdict",
                  c->worse       ? "worse"
                  : c->undecided ? "undecided"
                                 : "same-or-better",
                  "floor", c->floor, "other_machine", c->other_machine, "instructions_compared",
                  c->instructions, "only_base", (int)c->only_base, "only_new", (int)c->only_new,
                  "rows", rows);
    return mote_json_put(object, MOTE_JSON_FLAGS, stdout) == MOTE_OK ? MOTE_EXIT_DONE
                                                                     : mote_command_fail();
}

const mote_option mote_options_compare[] = {
    {"format", "table|json", "how to print it (default: table)"},
    {"floor", "SHARE",
     "smaller differences of time do not count (default: 0.02, or the runs' own noise where "
     "that is larger)"},
    {NULL, NULL, NULL}};

int mote_command_compare(int argc, char **argv)
{
    mote_option_reader reader = mote_option_begin(mote_options_compare, argc, argv);
    const char *runs[2] = {NULL, NULL}, *value;
    size_t count = 0;
    bool json = false;
    double floor = DEFAULT_FLOOR;
    for (int option; (option = mote_option_next(&reader, &value)) != MOTE_OPTION_END;) {
        if (option == MOTE_OPTION_ERROR)
            return MOTE_EXIT_USAGE;
        if (option == 1 && !mote_read_real(value, 0, 10, &floor))
            return mote_command_usage(
                argv[0], "--floor %s: expected a share from 0 to 10, 0.05 for 5 %%", value);
        if (option == 0 && strcmp(value, "table") != 0 && strcmp(value, "json") != 0)
            return mote_command_usage(argv[0], "--format %s: choose table or json", value);
        if (option == 0)
            json = strcmp(value, "json") == 0;
        if (option == MOTE_OPTION_PLAIN && count == 2)
            return mote_command_usage(argv[0], "%s: two runs at a time", value);
        if (option == MOTE_OPTION_PLAIN)
            runs[count++] = value;
    }
    if (count < 2)
        return mote_command_usage(argv[0],
                                  "two runs are needed; write `mote compare BASE NEW`");
    mote_comparison c;
    if (mote_compare(runs[0], runs[1], floor, &c) != MOTE_OK)
        return mote_command_fail();
    int code = c.worse       ? MOTE_EXIT_CHECK_FAILED
               : c.undecided ? MOTE_EXIT_UNDECIDED
                             : MOTE_EXIT_DONE;
    if (json)
        code = print_json(&c) == MOTE_EXIT_DONE ? code : MOTE_EXIT_BAD_INPUT;
    else
        print_table(&c);
    mote_comparison_free(&c);
    return mote_command_finish(code);
}
