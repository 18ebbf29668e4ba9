#include "baselines/broad_phase.h"
#include "baselines/fcl/fcl_adapter.hpp"

#include <array>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

namespace
{

using Pair = std::array<uint32_t, 2>;
static_assert(sizeof(Pair) == sizeof(uint32_t[2]), "pairs are handed out as they are");

/* A box without a geometry: the manager uses only the box. */
class Item : public fcl::CollisionObject<double>
{
  public:
    explicit Item(uint32_t body_) : fcl::CollisionObject<double>(nullptr), body(body_)
    {
    }

    void place(const mote_scene_box &box, double grow)
    {
        aabb.min_ = mote_fcl::Vector(box.low.x - grow, box.low.y - grow, box.low.z - grow);
        aabb.max_ = mote_fcl::Vector(box.high.x + grow, box.high.y + grow, box.high.z + grow);
    }

    uint32_t body;
};

bool collect(fcl::CollisionObject<double> *a, fcl::CollisionObject<double> *b, void *pairs)
{
    uint32_t i = static_cast<Item *>(a)->body, j = static_cast<Item *>(b)->body;
    static_cast<std::vector<Pair> *>(pairs)->push_back({std::min(i, j), std::max(i, j)});
    return false; /* go on */
}

mote_status check(const mote_scene_box &box, size_t i)
{
    mote_vec3 size = mote_sub(box.high, box.low);
    if (size.x >= 0 && size.y >= 0 && size.z >= 0 &&
        std::isfinite(mote_length(box.low) + mote_length(box.high)))
        return MOTE_OK;
    return mote_fail(MOTE_EINVAL, "box %zu is not finite, or inside out", i);
}

} // namespace

struct mote_broad_phase {
    std::vector<std::unique_ptr<Item>> items;
    fcl::DynamicAABBTreeCollisionManager<double> manager;
    std::vector<Pair> pairs;
};

mote_status mote_broad_phase_create(uint32_t body_count, mote_broad_phase **broad_phase)
{
    if (body_count < 1)
        return mote_fail(MOTE_EINVAL, "a broad phase needs at least one body");
    return mote_fcl::guard([&] {
        auto made = std::make_unique<mote_broad_phase>();
        made->items.reserve(body_count);
        for (uint32_t i = 0; i < body_count; ++i)
            made->items.push_back(std::make_unique<Item>(i));
        *broad_phase = made.release();
        return MOTE_OK;
    });
}

void mote_broad_phase_destroy(mote_broad_phase *broad_phase)
{
    delete broad_phase;
}

mote_status mote_broad_phase_pairs(mote_broad_phase *broad_phase, const mote_scene_box *boxes,
                                   double near, const uint32_t (**pairs)[2], size_t *count)
{
    for (size_t i = 0; i < broad_phase->items.size(); ++i) {
        mote_status status = check(boxes[i], i);
        if (status != MOTE_OK)
            return status;
    }
    return mote_fcl::guard([&] {
        for (size_t i = 0; i < broad_phase->items.size(); ++i)
            broad_phase->items[i]->place(boxes[i], near / 2);
        if (broad_phase->manager.empty()) {
            std::vector<fcl::CollisionObject<double> *> all;
            for (const auto &item : broad_phase->items)
                all.push_back(item.get());
            broad_phase->manager.registerObjects(all);
            broad_phase->manager.setup();
        } else {
            broad_phase->manager.update();
        }
        broad_phase->pairs.clear();
        broad_phase->manager.collide(&broad_phase->pairs, collect);
        std::sort(broad_phase->pairs.begin(), broad_phase->pairs.end());
        *pairs = reinterpret_cast<const uint32_t(*)[2]>(broad_phase->pairs.data());
        *count = broad_phase->pairs.size();
        return MOTE_OK;
    });
}
