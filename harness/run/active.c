#include "harness/run/active.h"

static bool is_near(const mote_scenario *scenario, const mote_truth *truth, uint32_t frame)
{
    return truth->distance[frame - 1] <= MOTE_ACTIVE_NEAR * scenario->length;
}

uint32_t mote_active_near(const mote_scenario *scenario, const mote_truth *truth,
                          mote_interval interval)
{
    uint32_t near = 0;
    for (uint32_t frame = interval.first; frame >= 1 && frame <= interval.last; ++frame)
        near += is_near(scenario, truth, frame);
    return near;
}

bool mote_active_holds(const mote_scenario *scenario, const mote_truth *truth,
                       mote_interval interval)
{
    const uint32_t frames = interval.first > 0 ? interval.last - interval.first + 1 : 0;
    return mote_active_near(scenario, truth, interval) >= MOTE_ACTIVE_SHARE * frames;
}

mote_interval mote_active_longest(const mote_scenario *scenario, const mote_truth *truth)
{
    mote_interval longest = {0, 0};
    uint32_t most = 0;
    for (uint32_t first = 1; first - 1 + most < truth->frames; ++first) {
        uint32_t near = 0;
        for (uint32_t last = first; last <= truth->frames; ++last) {
            const uint32_t frames = last - first + 1;
            near += is_near(scenario, truth, last);
            if (frames > most && near >= MOTE_ACTIVE_SHARE * frames) {
                most = frames;
                longest = (mote_interval){first, last};
            }
        }
    }
    return longest;
}
