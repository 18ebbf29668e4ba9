#include "harness/process/crew.h"

#include "harness/base/clock.h"

/* The processes that run at the same time. */
typedef struct places {
    mote_child children[MOTE_CHILDREN_MAX]; /* [crew->places] */
    size_t tasks[MOTE_CHILDREN_MAX];
    double starts[MOTE_CHILDREN_MAX];
    uint32_t busy;
} places;

static mote_status start_task(const mote_crew *crew, places *p, size_t task)
{
    size_t place = 0;
    while (p->children[place].pid > 0)
        ++place;
    p->tasks[place] = task;
    p->starts[place] = mote_clock_seconds();
    const mote_status status = crew->start(crew->context, task, &p->children[place]);
    p->busy += p->children[place].pid > 0 ? 1 : 0;
    return status;
}

static mote_status finish_task(const mote_crew *crew, places *p)
{
    size_t place;
    bool ended = false;
    while (!ended) {
        const mote_status status = mote_child_look(p->children, crew->places, &place, &ended);
        if (status != MOTE_OK)
            return status;
        if (!ended && crew->meanwhile)
            crew->meanwhile(crew->context);
    }
    --p->busy;
    const mote_status status = crew->finish(crew->context, p->tasks[place], &p->children[place],
                                            mote_clock_seconds() - p->starts[place]);
    mote_child_release(&p->children[place]);
    return status;
}

mote_status mote_crew_run(const mote_crew *crew)
{
    places p = {.busy = 0};
    mote_status status = MOTE_OK;
    for (size_t next = 0; status == MOTE_OK && (next < crew->tasks || p.busy > 0);) {
        if (next < crew->tasks && p.busy < crew->places)
            status = start_task(crew, &p, next++);
        else
            status = finish_task(crew, &p);
    }
    mote_child_stop(p.children, crew->places);
    for (uint32_t i = 0; i < crew->places; ++i)
        mote_child_release(&p.children[i]);
    return status;
}
