#define _DEFAULT_SOURCE /* usleep */
/* Tasks distributed to child processes: each once, a given number at a time, until one
   fails. */
#include "harness/process/crew.h"

#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define TASKS 12

typedef struct job {
    size_t number;
    unsigned sleep_us;
} job;

typedef struct record {
    size_t started, ended, running, most;
    size_t said[TASKS]; /* by each task's child, plus 1 */
    size_t skipped;     /* tasks whose number is a multiple of it are not started; 0: none */
    size_t failing;     /* finishing this task fails; TASKS: none */
    unsigned sleep_us;  /* of every child */
} record;

static mote_status say_number(void *context, int output)
{
    const job *j = context;
    (void)usleep(j->sleep_us);
    return mote_child_put(output, &j->number, sizeof j->number);
}

static mote_status start(void *context, size_t task, mote_child *child)
{
    record *r = context;
    job j = {task, r->sleep_us};
    ++r->started;
    if (r->skipped > 0 && task % r->skipped == 0)
        return MOTE_OK;
    r->running += 1;
    r->most = r->running > r->most ? r->running : r->most;
    return mote_child_start(say_number, &j, (mote_child_limits){.output_bytes = 64}, child);
}

static mote_status finish(void *context, size_t task, mote_child *child, double seconds)
{
    record *r = context;
    size_t number;
    --r->running;
    ++r->ended;
    assert_int_equal(child->end, MOTE_CHILD_DONE);
    assert_int_equal(child->size, sizeof number);
    memcpy(&number, child->output, sizeof number);
    r->said[task] += number + 1;
    assert_true(seconds >= r->sleep_us * 1e-6 && seconds < 60);
    return task == r->failing ? mote_fail(MOTE_ENUMERIC, "task %zu", task) : MOTE_OK;
}

static mote_status run(record *r, size_t tasks, uint32_t places)
{
    const mote_crew crew = {
        .tasks = tasks, .places = places, .context = r, .start = start, .finish = finish};
    return mote_crew_run(&crew);
}

TEST(mote_crew_run_does_each_task_once_so_many_at_a_time)
{
    static const uint32_t places[] = {1, 2, 5, MOTE_CHILDREN_MAX};
    for (int k = 0; k < 4; ++k) {
        record r = {.failing = TASKS, .sleep_us = 2000};
        assert_int_equal(run(&r, TASKS, places[k]), MOTE_OK);
        assert_int_equal(r.started, TASKS);
        assert_int_equal(r.ended, TASKS);
        assert_int_equal(r.most, places[k] < TASKS ? places[k] : TASKS);
        for (size_t i = 0; i < TASKS; ++i)
            assert_int_equal(r.said[i], i + 1);
    }
}

TEST(mote_crew_run_goes_on_past_tasks_without_a_child)
{
    record r = {.failing = TASKS, .skipped = 3};
    assert_int_equal(run(&r, TASKS, 2), MOTE_OK);
    assert_int_equal(r.ended, TASKS - 4);
    for (size_t i = 0; i < TASKS; ++i)
        assert_int_equal(r.said[i], i % 3 ? i + 1 : 0);
    record none = {.failing = TASKS, .skipped = 1};
    assert_int_equal(run(&none, TASKS, 2), MOTE_OK);
    assert_int_equal(none.ended, 0);
    assert_int_equal(run(&none, 0, 2), MOTE_OK);
}

/* The first failure ends the others: nothing starts after it. */
TEST(mote_crew_run_stops_at_the_first_failure)
{
    record r = {.failing = 4};
    assert_int_equal(run(&r, TASKS, 1), MOTE_ENUMERIC);
    assert_string_equal(mote_error_text(), "task 4");
    assert_int_equal(r.started, 5);
    record several = {.failing = 0, .sleep_us = 1000};
    assert_int_equal(run(&several, TASKS, 3), MOTE_ENUMERIC);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); /* none is left */
}
