/* Finds room for numbers beside the points of a figure, in the figure's units. */
#ifndef MOTE_HARNESS_FIGURE_ROOM_H
#define MOTE_HARNESS_FIGURE_ROOM_H

#include <stdbool.h>
#include <stddef.h>

/* A rectangle, by its middle. */
typedef struct mote_rectangle {
    double x, y, half_width, half_height;
} mote_rectangle;

/* The places already taken; the caller ensures that `taken` has room for one more. */
typedef struct mote_room {
    mote_rectangle *taken;
    size_t count;
} mote_room;

/* The place taken by a point itself. */
mote_rectangle mote_room_point(double x, double y);

/* Finds a place beside a point for a whole number, >= 0, and takes it; false if there is
   none. */
bool mote_room_find(mote_room *room, mote_rectangle point, double number,
                    mote_rectangle *found);

#endif
