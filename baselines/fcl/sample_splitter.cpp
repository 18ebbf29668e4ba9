#include "baselines/fcl/sample_splitter.hpp"

#include <algorithm>
#include <new>

namespace mote_samples
{

Sides::Sides(const mote_body &body)
{
    if (mote_sample_boxes_init(&boxes, &body) != MOTE_OK) {
        mote_sample_boxes_free(&boxes);
        throw std::bad_alloc();
    }
}

Sides::~Sides()
{
    mote_sample_boxes_free(&boxes);
}

void Sides::choose(const unsigned *triangles, uint32_t count)
{
    told = 0;
    right.assign(count, false);
    if (count < 2)
        return;
    const mote_sample_split split = mote_sample_split_best(&boxes, triangles, count, 0);
    uint32_t on_the_right = 0;
    for (uint32_t i = 0; i < count; ++i) {
        right[i] = mote_sample_key(&boxes, split.pose, split.axis, triangles[i]) >= split.at;
        on_the_right += right[i];
    }
    const uint32_t least = std::max(count / 16, uint32_t{1});
    if (on_the_right >= least && count - on_the_right >= least)
        return;
    for (uint32_t i = 0; i < count; ++i)
        right[i] = i >= count / 2;
}

} // namespace mote_samples
