/* A program that `mote race` can race, with something planted into one method or into the
   clock:

       MOTE_PLANT=slow:METHOD:SHARE     each query takes that share longer
       MOTE_PLANT=clock:NS              reading the clock takes that much longer, unnoticed by
                                        the measurement of its cost
       MOTE_PLANT=answer:METHOD:SHIFT   distances are larger by SHIFT
       MOTE_PLANT=crash:METHOD:FRAME    the process ends in this frame
       MOTE_PLANT=count:METHOD:N        each query counts N more box tests
       MOTE_PLANT=lack:METHOD:0         it does not have this method

   SHARE 0 is the program to compare with: the same code, with the same readings of the clock.
   mote_method_find and mote_clock_ns are wrapped (tests/CMakeLists.txt). */
#include "harness/base/memory.h"
#include "harness/race/race_child.h"
#include "harness/base/clock.h"

#include "core/method/method.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CALIBRATIONS 200
#define CALIBRATION_STEPS 2000

typedef enum what { NOTHING, SLOW, CLOCK, ANSWER, CRASH, COUNT, LACK } what;
static const char *const names[] = {"", "slow", "clock", "answer", "crash", "count", "lack"};

static struct {
    what what;
    char method[64];
    double value;
    double steps_a_ns;
    const mote_method *victim;
    mote_method planted;
    volatile uint64_t sink;
} plant;

const mote_method *__real_mote_method_find(const char *name);
const mote_method *__wrap_mote_method_find(const char *name);
uint64_t __real_mote_clock_ns(void);
uint64_t __wrap_mote_clock_ns(void);

/* Work that does not depend on memory, caches or branches. */
static void work(double ns)
{
    const uint64_t steps = ns > 0 ? (uint64_t)(ns * plant.steps_a_ns) : 0;
    uint64_t x = plant.sink | 1;
    for (uint64_t i = 0; i < steps; ++i)
        x = x * 6364136223846793005u + 1442695040888963407u;
    plant.sink = x;
}

static void calibrate(void)
{
    double least = HUGE_VAL;
    plant.steps_a_ns = 1;
    for (int i = 0; i < CALIBRATIONS; ++i) {
        const uint64_t start = __real_mote_clock_ns();
        work(CALIBRATION_STEPS);
        least = fmin(least, (double)(__real_mote_clock_ns() - start));
    }
    plant.steps_a_ns = CALIBRATION_STEPS / least;
}

static mote_status query(void *state, const mote_frame *frame, mote_answer *answer)
{
    const uint64_t start = __real_mote_clock_ns();
    const mote_status status = plant.victim->query(state, frame, answer);
    const double took = (double)(__real_mote_clock_ns() - start);
    if (plant.what == SLOW)
        work(plant.value * took);
    if (plant.what == ANSWER)
        answer->distance += plant.value;
    if (plant.what == COUNT)
        answer->counters.box_tests += (uint64_t)plant.value;
    if (plant.what == CRASH && (double)frame->number >= plant.value)
        abort();
    return status;
}

const mote_method *__wrap_mote_method_find(const char *name)
{
    const mote_method *found = __real_mote_method_find(name);
    if (!found || plant.what == NOTHING || plant.what == CLOCK ||
        strcmp(name, plant.method) != 0)
        return found;
    if (plant.what == LACK)
        return NULL;
    plant.victim = found;
    plant.planted = *found;
    plant.planted.query = query;
    return &plant.planted;
}

uint64_t __wrap_mote_clock_ns(void)
{
    const uint64_t now = __real_mote_clock_ns();
    if (plant.what == CLOCK)
        work(plant.value);
    return now;
}

static int read_plant(const char *text)
{
    const char *colon = strchr(text, ':'), *last = strrchr(text, ':');
    for (int k = SLOW; colon && k <= LACK; ++k) {
        if (strlen(names[k]) == (size_t)(colon - text) &&
            strncmp(text, names[k], (size_t)(colon - text)) == 0)
            plant.what = (what)k;
    }
    char *end = NULL;
    plant.value = last ? strtod(last + 1, &end) : 0;
    if (last > colon)
        (void)snprintf(plant.method, sizeof plant.method, "%.*s", (int)(last - colon - 1),
                       colon + 1);
    return plant.what != NOTHING && end && end != last + 1 && *end == '\0';
}

int main(int argc, char **argv)
{
    const char *text = getenv("MOTE_PLANT");
    if (argc < 2 || strcmp(argv[1], "race-child") != 0 || (text && !read_plant(text))) {
        (void)fprintf(stderr, "race_planted: for `mote race` alone, see its source\n");
        return 2;
    }
    calibrate();
    return mote_race_child(argc - 1, argv + 1);
}
