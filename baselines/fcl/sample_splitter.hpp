/* What a splitter of FCL's trees needs to split by sample poses (core/body/sample_split.h);
   Coal's splitter cannot be replaced. FCL asks for a rule, and then for each triangle on which
   side of it the centre lies. A rule about centres at rest cannot separate what is apart only
   in another pose. So the sides of all triangles are chosen when the rule is asked for, and
   handed out one by one. */
#ifndef MOTE_BASELINES_SAMPLE_SPLITTER_HPP
#define MOTE_BASELINES_SAMPLE_SPLITTER_HPP

#include "core/body/sample_split.h"

#include <cstddef>
#include <vector>

namespace mote_samples
{

class Sides
{
  public:
    /* Throws std::bad_alloc. The body need not outlive it. */
    explicit Sides(const mote_body &body);
    ~Sides();
    Sides(const Sides &) = delete;
    Sides &operator=(const Sides &) = delete;

    /* Chooses a side for each of a node's triangles; halves them in their order where the best
       split would leave less than a sixteenth on one side, so that a tree stays shallow. Throws
       std::bad_alloc. */
    void choose(const unsigned *triangles, uint32_t count);

    /* Whether the next triangle, in the order given to choose, is on the right. */
    bool next() const
    {
        return right[told++];
    }

  private:
    mote_sample_boxes boxes;
    std::vector<bool> right;
    mutable std::size_t told = 0;
};

} // namespace mote_samples

#endif
