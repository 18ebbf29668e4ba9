/* FCL's AABB models for several bodies: refitted bottom-up, queried by FCL's traversal node
   with the last pair of triangles as the first bound and a queue of 64 (the best setting that
   we found). */
#include "baselines/body_trees.h"
#include "baselines/fcl/fcl_adapter.hpp"

namespace
{

using Model = fcl::BVHModel<fcl::AABB<double>>;
using Node = fcl::detail::MeshDistanceTraversalNode<fcl::AABB<double>>;
using Result = fcl::DistanceResult<double>;
constexpr int QUEUE = 64;

struct ShapeModels {
    std::vector<std::unique_ptr<Model>> models;
    size_t used = 0;
};

struct FclBodies {
    mote_body_trees_setup setup;
    double scale, tolerance;
    std::vector<ShapeModels> shapes;
    std::vector<size_t> place;      /* which model of its shape a body has */
    std::vector<mote_vec3> written; /* world positions of the body being moved */

    Model &model(uint32_t body) const
    {
        return *shapes[setup.shape_of[body]].models[place[body]];
    }
};

/* Adds a model to those of a shape. */
mote_status add_model(FclBodies &s, uint32_t number)
{
    auto made = std::make_unique<Model>();
    const int code = mote_fcl::build_model(s.setup.shapes[number]->mesh, s.scale, *made);
    if (code != fcl::BVH_OK)
        return mote_fail(MOTE_ENUMERIC, "FCL could not build shape %u: code %d", number, code);
    s.shapes[number].models.push_back(std::move(made));
    return MOTE_OK;
}

mote_status create(const mote_body_trees_setup *setup, void **state)
{
    return mote_fcl::guard([&] {
        auto made = std::make_unique<FclBodies>();
        made->setup = *setup;
        made->scale = mote_fcl::scale_for(setup->length);
        made->tolerance = setup->tolerance * made->scale;
        made->shapes.resize(setup->shape_count);
        made->place.resize(setup->body_count);
        uint32_t most = 0;
        for (uint32_t i = 0; i < setup->shape_count; ++i)
            most = std::max(most, setup->shapes[i]->mesh->vertex_count);
        made->written.resize(most);
        mote_status status = MOTE_OK;
        for (uint32_t i = 0; setup->every && i < setup->body_count && status == MOTE_OK; ++i)
            status = add_model(*made, setup->shape_of[i]);
        if (status == MOTE_OK)
            *state = made.release();
        return status;
    });
}

void destroy(void *state)
{
    delete static_cast<FclBodies *>(state);
}

void begin(void *state)
{
    for (ShapeModels &shape : static_cast<FclBodies *>(state)->shapes)
        shape.used = 0;
}

mote_status room(void *state, uint32_t body, mote_vec3 **vertices)
{
    return mote_fcl::guard([&] {
        FclBodies &s = *static_cast<FclBodies *>(state);
        const uint32_t number = s.setup.shape_of[body];
        ShapeModels &shape = s.shapes[number];
        if (shape.used == shape.models.size()) {
            const mote_status status = add_model(s, number);
            if (status != MOTE_OK)
                return status;
        }
        s.place[body] = shape.used++;
        *vertices = s.written.data();
        return MOTE_OK;
    });
}

mote_status move(void *state, uint32_t body)
{
    return mote_fcl::guard([&] {
        FclBodies &s = *static_cast<FclBodies *>(state);
        return mote_fcl::replace_vertices(s.model(body), s.written.data(), s.scale,
                                          static_cast<int>(body), mote_fcl::REFIT_BOTTOM_UP);
    });
}

/* Nothing to do: models are refitted when they are moved. */
mote_status refit(void *)
{
    return MOTE_OK;
}

void box(const void *state, uint32_t body, mote_scene_box *box)
{
    const FclBodies &s = *static_cast<const FclBodies *>(state);
    const fcl::AABB<double> &root = s.model(body).getBV(0).bv;
    box->low = mote_fcl::from_fcl(root.min_, 1 / s.scale);
    box->high = mote_fcl::from_fcl(root.max_, 1 / s.scale);
}

/* The last answer's triangles as they are now. */
mote_fcl::Bound seed(const Model *const models[2], const mote_body_trees_memory &memory)
{
    mote_fcl::Bound bound;
    if (!memory.known)
        return bound;
    mote_vec3 corner[2][3];
    for (int b = 0; b < 2; ++b) {
        const fcl::Triangle &triangle = models[b]->tri_indices[memory.triangle[b]];
        for (int k = 0; k < 3; ++k)
            corner[b][k] = mote_fcl::from_fcl(models[b]->vertices[triangle[k]], 1);
    }
    bound.distance = std::sqrt(
        mote_triangle_triangle(corner[0], corner[1], &bound.witness[0], &bound.witness[1]));
    return bound;
}

template <class Traversal>
void drive(Traversal &node, Model *const models[2], Result &result, mote_answer *answer)
{
    mote_fcl::Transform identity[2] = {mote_fcl::Transform::Identity(),
                                       mote_fcl::Transform::Identity()};
    fcl::DistanceRequest<double> request(true);
    initialize(static_cast<Node &>(node), *models[0], identity[0], *models[1], identity[1],
               request, result);
    node.enable_statistics = true;
    node.rel_err = node.abs_err = 0;
    fcl::detail::distance(&node, nullptr, QUEUE);
    answer->counters.box_tests += static_cast<uint64_t>(node.num_bv_tests);
    answer->counters.triangle_tests += static_cast<uint64_t>(node.num_leaf_tests);
}

void ask(const FclBodies &s, Model *const models[2], mote_body_trees_memory *memory,
         mote_answer *answer)
{
    const bool contact_only = s.setup.ask == MOTE_ASK_CONTACT;
    const Model *const constant[2] = {models[0], models[1]};
    mote_fcl::Bound bound = seed(constant, *memory);
    answer->counters.triangle_tests += memory->known;
    Result result(std::min(bound.distance * (1 + 1e-9), std::numeric_limits<double>::max()));
    const double infinity = std::numeric_limits<double>::infinity();
    if (contact_only) /* nothing beyond the tolerance matters */
        result.min_distance =
            std::min(result.min_distance, std::nextafter(s.tolerance, infinity));
    const double enough = contact_only ? s.tolerance : 0;
    if (!(bound.distance <= enough)) {
        mote_fcl::EarlyNode<Node> node(enough);
        drive(node, models, result, answer);
    }
    const bool found = result.o1 != nullptr;
    const double distance = found ? result.min_distance : bound.distance;
    if (found)
        *memory = {{static_cast<uint32_t>(result.b1), static_cast<uint32_t>(result.b2)}, true};
    answer->has_contact = true;
    answer->contact = distance <= s.tolerance;
    answer->has_distance = !contact_only;
    answer->distance = contact_only ? 0 : distance / s.scale;
    /* FCL's points mean nothing where the surfaces intersect. */
    answer->has_witness = !contact_only && (!found || distance > 0);
    for (int b = 0; b < 2 && answer->has_witness; ++b)
        answer->witness[b] = found ? mote_fcl::from_fcl(result.nearest_points[b], 1 / s.scale)
                                   : mote_scale(bound.witness[b], 1 / s.scale);
}

mote_status query(void *state, const uint32_t body[2], mote_body_trees_memory *memory,
                  mote_answer *answer)
{
    return mote_fcl::guard([&] {
        const FclBodies &s = *static_cast<const FclBodies *>(state);
        Model *const models[2] = {&s.model(body[0]), &s.model(body[1])};
        ask(s, models, memory, answer);
        return MOTE_OK;
    });
}

} // namespace

extern "C" const mote_body_trees_kind mote_fcl_body_trees = {
    "fcl-aabb", create, destroy, begin, room, move, refit, box, query};
