/* What `mote summarize --best` shows, also at the end of `make bench`: runs that the test
   writes itself. */
#include "harness/summary/screen.h"
#include "tests/support/stored_run.h"

/* Writes two replicates of two frames; the first is off by `error`. */
static void write_method(stored_cell cell, double ns, double error, int missed)
{
    static int number;
    for (cell.replicate = 1; cell.replicate <= 2; ++cell.replicate) {
        char id[32], rows[160];
        (void)snprintf(id, sizeof id, "c%d", ++number);
        (void)snprintf(rows, sizeof rows, "1,0,0,%g,0.5,%g,0,0,7\n2,0,0,%g,0,0,%d,1,7\n",
                       ns * (1 + 0.001 * cell.replicate), error, ns, 1 - missed);
        cell.id = id;
        cell.rows = rows;
        write_cell(cell);
    }
}

static int summarize_best(void)
{
    return mote("summarize --best .");
}

static size_t longest_line(const char *of)
{
    size_t most = 0;
    for (const char *line = of; *line; line += strcspn(line, "\n") + 1) {
        const size_t length = strcspn(line, "\n");
        most = length > most ? length : most;
    }
    return most;
}

/* Checks that the texts occur in this order. */
static void in_order(const char *const *parts, size_t count)
{
    const char *at = said;
    for (size_t i = 0; i < count; ++i) {
        const char *found = strstr(at, parts[i]);
        if (!found)
            fail_msg("no \"%s\" in its place in\n%s", parts[i], said);
        at = found + strlen(parts[i]);
    }
}
#define IN_ORDER(...)                                                                          \
    do {                                                                                       \
        static const char *const parts[] = {__VA_ARGS__};                                      \
        in_order(parts, sizeof parts / sizeof parts[0]);                                       \
    } while (false)

TEST(best_rows_are_sorted_by_time_and_the_front_is_marked)
{
    write_method((stored_cell){.method = "fcl-aabb"}, 1000, 0, 0);
    write_method((stored_cell){.method = "fcl-obb"}, 4000, 0, 0);
    write_method((stored_cell){.method = "exact"}, 50, 0, 0);
    write_method((stored_cell){.method = "rough"}, 5, 0.3, 1);
    assert_int_equal(summarize_best(), 0);
    IN_ORDER("s: 8 and 8 triangles, 2 frames, 2 replicates, caches hot\n", "best FCL", "method",
             "\n* rough ", "5.00 ns", "200", "3.0e-01", "50.0 %", " 1 ", "\n* exact ",
             "50.0 ns", "20.0", "100.0 %", "\n  fcl-aabb ", "1.00", "\n  fcl-obb ", "0.25",
             "\n* on the front", "best engine and best FCL:", "fcl-aabb\n");
    assert_true(longest_line(said) <= MOTE_SCREEN_WIDTH);
}

/* A method's configurations that are neither on a front nor its representative are only
   counted. */
TEST(rows_that_are_not_among_the_best_are_counted)
{
    static const char *const numbers[] = {"{\"n\": 1}", "{\"n\": 2}", "{\"n\": 3}"};
    for (int k = 0; k < 3; ++k)
        write_method((stored_cell){.method = "ours", .parameters = numbers[k]}, 10 + 10 * k, 0,
                     0);
    assert_int_equal(summarize_best(), 0);
    IN_ORDER("\n* ours:n=1 ", "2 more in the report\n");
    assert_null(strstr(said, "ours:n=2"));
}

/* The front has more rows than a screen: the least accurate are dropped, and the
   representatives of methods stay. */
TEST(a_long_front_is_cut_where_it_is_least_accurate)
{
    for (int k = 1; k <= 30; ++k) {
        char n[32];
        (void)snprintf(n, sizeof n, "{\"n\": %d}", k);
        write_method((stored_cell){.method = "ours", .parameters = n}, 10 * k, 0.5 - 0.01 * k,
                     0);
    }
    write_method((stored_cell){.method = "poor"}, 5, 0.9, 1);
    assert_int_equal(summarize_best(), 0);
    /* including the line that explains them */
    assert_int_equal(test_count(said, "\n* "), MOTE_SCREEN_ROWS + 1);
    IN_ORDER("\n* poor ", "\n* ours:n=12 ", "\n* ours:n=30 ", "11 more in the report");
    assert_null(strstr(said, "n=11 "));
}

/* Rows with positions given are never mixed with those that pay for deformation. */
TEST(rows_with_positions_given_stand_apart)
{
    write_method((stored_cell){.method = "fcl-aabb"}, 1000, 0, 0);
    write_method((stored_cell){.method = "ours"}, 50, 0, 0);
    write_method((stored_cell){.method = "ours", .parameters = "{\"positions\": \"given\"}"}, 5,
                 0, 0);
    assert_int_equal(summarize_best(), 0);
    IN_ORDER("\n* ours  ", "\n  fcl-aabb ", "\npositions=given", "method",
             "\n* ours:positions=given ");
}

/* With one replicate each, no row is certainly faster than another. */
TEST(rows_without_intervals_are_not_marked)
{
    static const char *const methods[] = {"a", "b"};
    for (int k = 0; k < 2; ++k)
        write_cell((stored_cell){.method = methods[k], .rows = ROWS});
    assert_int_equal(summarize_best(), 0);
    IN_ORDER("8 triangles, 4 frames, 1 replicate, caches hot\n", "\n  a ", "\n  b ");
    assert_null(strchr(said, '*'));
}

TEST(long_names_and_failures_keep_lines_short)
{
    static const char name[] = "a-method-with-a-name-that-is-longer-than-its-column";
    static const char much[] = "{\"key\": \"value\", \"other\": \"some other value of it\"}";
    write_method((stored_cell){.method = name, .parameters = much}, 50, 0, 0);
    write_cell((stored_cell){.method = "broken",
                             .status = "crashed",
                             .more = ", \"reason\": \"a reason of many words, of more than a "
                                     "line, so that it goes on in a second one below it\""});
    write_cell((stored_cell){
        .id = "lost", .method = name, .parameters = much, .replicate = 3, .status = "timeout"});
    assert_int_equal(summarize_best(), 0);
    IN_ORDER("\n* a-method-with", "\n    ", "50.0 ns", "\n    1 of 3 replicates failed\n",
             "\nbroken crashed: a reason", "\n  ");
    assert_true(longest_line(said) <= MOTE_SCREEN_WIDTH);
}

TEST(best_is_for_the_table_alone)
{
    write_method((stored_cell){.method = "ours"}, 50, 0, 0);
    mote_expect(2, "--best is for --format table", "summarize --best --format csv .");
}

/* Two replicates of four frames, the last of which takes `worst`. */
static void write_engine(const char *method, double ns, double worst, int missed)
{
    static int number;
    for (int replicate = 1; replicate <= 2; ++replicate) {
        char id[32], rows[200];
        (void)snprintf(id, sizeof id, "e%d", ++number);
        (void)snprintf(rows, sizeof rows,
                       "1,0,0,%g,0,0,%d,1,7\n2,0,0,%g,0,0,1,1,7\n3,0,0,%g,0,0,1,1,7\n"
                       "4,0,0,%g,0,0,1,1,7\n",
                       ns, 1 - missed, ns, ns, worst);
        write_cell(
            (stored_cell){.id = id, .method = method, .replicate = replicate, .rows = rows});
    }
}

/* The best engine by the median is not the one by the mean and the worst frame; one that misses
   a contact is none, nor is ours. */
TEST(engines_are_best_by_each_statistic)
{
    write_engine("ours", 1, 2, 0);
    write_engine("bullet-gimpact", 5, 5, 1);
    write_engine("ode", 10, 9000, 0);
    write_engine("coal-aabb", 20, 60, 0);
    write_engine("fcl-aabb", 40, 50, 0);
    write_engine("fcl-obb", 30, 7000, 0);
    assert_int_equal(mote("summarize --engines ."), 0);
    IN_ORDER(
        "4 frames, 2 replicates", "best FCL", "engine", "median", "mean", "p95", "worst",
        "\n  ours ", "1.00 ns", "1.25 ns", "2.00 ns", "30.0", "10.0", "\n  bullet-gimpact ",
        " 1 ", "\n* ode ", "9.00 us", "\n  coal-aabb ", "\n  fcl-obb ", "\n  fcl-aabb ",
        "\nbest engine of others (*): median 10.0 ns: ode; mean 30.0 ns: coal-aabb; p95 "
        "50.0 ns,",
        "worst", "fcl-aabb\n", "best FCL: median 30.0 ns: fcl-obb; mean 42.5", ": fcl-aabb\n");
    assert_true(longest_line(said) <= MOTE_SCREEN_WIDTH);
    mote_expect(2, "--engines is for --format table", "summarize --engines --format json .");
}

/* Times of cells that ran beside others are not comparable: such rows come last, and are best
   at nothing. */
TEST(rows_without_comparable_times_come_last)
{
    static const char *const order[] = {"a-beside", "b", "c-beside", "d"};
    for (size_t k = 0; k < ROWS_OF(order); ++k)
        write_method((stored_cell){.method = order[k],
                                   .more = strchr(order[k], '-') ? ", \"jobs\": 2" : ""},
                     10 + 10 * (double)k, 0, 0);
    write_method((stored_cell){.method = "fcl-obb", .more = ", \"jobs\": 2"}, 5, 0, 0);
    write_method((stored_cell){.method = "fcl-aabb"}, 500, 0, 0);
    write_method((stored_cell){.method = "fcl-rss"}, 1, 0, 1); /* misses a contact */
    assert_int_equal(mote("summarize --engines ."), 0);
    IN_ORDER("\n  fcl-rss ", "\n  b ", "\n  d ", "\n* fcl-aabb ", "\n  fcl-obb ", "-beside ",
             "-beside ", "\nbest FCL: median 500 ns, mean 500 ns, p95 5", ": fcl-aabb\n");
    assert_int_equal(summarize_best(), 0);
    IN_ORDER(" b ", "-beside ");
}

/* Every method is shown, however many there are. */
TEST(representatives_of_methods_are_never_dropped)
{
    for (int k = 1; k <= MOTE_SCREEN_ROWS + 4; ++k) {
        char name[16];
        (void)snprintf(name, sizeof name, "m%02d", k);
        write_method((stored_cell){.method = name}, 10 * k, 0.01 * (30 - k), 0);
    }
    assert_int_equal(summarize_best(), 0);
    IN_ORDER("\n* m01 ", "\n* m23 ", "\n* m24 ");
    assert_null(strstr(said, "more in the report"));
}

/* The rows that ratios are relative to are named, one or both. */
TEST(rivals_are_named)
{
    write_engine("ours", 5, 5, 0);
    assert_int_equal(summarize_best(), 0);
    assert_null(strstr(said, "best engine"));
    assert_null(strstr(said, "\nbest FCL"));
    assert_int_equal(mote("summarize --engines ."), 0);
    assert_null(strstr(said, "best engine of others"));
    write_engine("ode", 20, 20, 0);
    assert_int_equal(summarize_best(), 0);
    IN_ORDER("best engine: ode");
    assert_null(strstr(said, "best FCL:"));
    write_engine("fcl-aabb", 40, 40, 0);
    assert_int_equal(summarize_best(), 0);
    IN_ORDER("best engine: ode; best FCL:", "fcl-aabb");
}

/* What scenarios ask for, and which positions are given, stands in the headings of engines. */
TEST(headings_of_engines_say_what_is_asked)
{
    write_method((stored_cell){.method = "fcl-aabb", .more = ", \"ask\": \"contact\""}, 100, 0,
                 0);
    write_method((stored_cell){.method = "ours",
                               .more = ", \"ask\": \"contact\", \"told\": \"positions\"",
                               .parameters = "{\"positions\": \"given\"}"},
                 10, 0, 0);
    assert_int_equal(mote("summarize --engines ."), 0);
    IN_ORDER("s, asked for contact: 8 and 8 triangles", "\n* fcl-aabb ", "\npositions=given",
             "\n  ours");
    assert_null(strstr(said, "told the positions"));
    assert_int_equal(summarize_best(), 0);
    assert_non_null(strstr(said, "told the positions"));
}
