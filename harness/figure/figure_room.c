#include "harness/figure/figure_room.h"

#include <math.h>

/* Half the width of a digit, half the height of a line, and half the size of a point. */
#define HALF_DIGIT 3.5
#define HALF_LINE 6.0
#define HALF_POINT 4.0

mote_rectangle mote_room_point(double x, double y)
{
    return (mote_rectangle){x, y, HALF_POINT, HALF_POINT};
}

static bool is_free(const mote_room *room, const mote_rectangle *wanted)
{
    for (size_t i = 0; i < room->count; ++i) {
        const mote_rectangle *other = &room->taken[i];
        if (fabs(other->x - wanted->x) < other->half_width + wanted->half_width &&
            fabs(other->y - wanted->y) < other->half_height + wanted->half_height)
            return false;
    }
    return true;
}

bool mote_room_find(mote_room *room, mote_rectangle point, double number, mote_rectangle *found)
{
    static const double sides[][2] = {{1, 1}, {-1, -1}, {1, -1}, {-1, 1}, {0, 1}, {0, -1}};
    const double half = (number < 10 ? 1 : number < 100 ? 2 : 3) * HALF_DIGIT;
    for (size_t k = 0; k < sizeof sides / sizeof sides[0]; ++k) {
        const mote_rectangle wanted = {point.x + sides[k][0] * (half + HALF_POINT + 0.5),
                                       point.y + sides[k][1] * (HALF_LINE + HALF_POINT + 0.5),
                                       half, HALF_LINE};
        if (!is_free(room, &wanted))
            continue;
        room->taken[room->count++] = wanted;
        *found = wanted;
        return true;
    }
    return false;
}
