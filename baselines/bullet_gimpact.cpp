/* bullet-gimpact: Bullet's GImpact collision of two triangle meshes, for contact only. Built
   only where Bullet's collision library is installed. Single precision, as Debian's library is
   used by others; trees of quantised boxes are built over the rest pose and refitted in each
   frame.

   GImpact collects every contact and cannot be asked for one. stop=yes ends it at the first by
   an exception thrown out of its callback. This is faster where bodies touch, but not how
   Bullet is normally used, so it is not the default. Bullet's public contactPairTest and its
   closest-point algorithms find no contact between two GImpact meshes, so the algorithm for
   contact points is called. */
#include "baselines/guard.hpp"
#include "baselines/physics_engine.h"

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <memory>
#include <type_traits>
#include <vector>

namespace
{

enum ParameterIndex { UPDATE, STOP, POSITIONS, PARAMETER_COUNT };

const mote_parameter parameters[PARAMETER_COUNT] = {
    {"update", MOTE_PARAMETER_CHOICE, 0, 0, "refit|none", "refit",
     "how a tree follows a changed shape; none: rigid bodies, by their poses"},
    {"stop", MOTE_PARAMETER_CHOICE, 0, 0, "no|yes", "no",
     "yes: an exception ends the query at the first contact"},
    {"positions", MOTE_PARAMETER_CHOICE, 0, 0, "deform|given", "deform",
     "deform: pay for deforming all vertices; given: they come free of charge"},
};

struct FirstContact {
};

/* Receives contacts, and keeps only whether there was one. */
class Listener : public btManifoldResult
{
  public:
    Listener(const btCollisionObjectWrapper *a, const btCollisionObjectWrapper *b, bool stop_)
        : btManifoldResult(a, b), stop(stop_)
    {
    }

    void addContactPoint(const btVector3 &, const btVector3 &, btScalar depth) override
    {
        ++points;
        if (depth > 0)
            return;
        contact = true;
        if (stop)
            throw FirstContact();
    }

    bool contact = false;
    uint64_t points = 0;

  private:
    bool stop;
};

/* Bullet may be compiled for floats or doubles. */
template <class Scalar> mote_status write_vertices(mote_physics *engine, int b, Scalar *to)
{
    if constexpr (std::is_same_v<Scalar, float>)
        return mote_physics_write_floats(engine, b, to);
    else
        return mote_physics_write_doubles(engine, b, to);
}

/* One body in Bullet, which reads vertices and triangles where they lie here. */
struct Body {
    std::vector<btScalar> vertices; /* 3 a vertex */
    std::vector<int> triangles;
    std::unique_ptr<btTriangleIndexVertexArray> arrays;
    std::unique_ptr<btGImpactMeshShape> shape;
    btCollisionObject object;
};

class Pair
{
  public:
    Pair(const mote_physics &engine_, bool stop_) : engine(engine_), stop(stop_)
    {
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
        for (int b = 0; b < 2; ++b)
            build(b);
    }

    mote_status update(const mote_frame *frame);
    void query(mote_answer *answer);

  private:
    void build(int b);
    mote_status refit(int b);
    void place(int b);

    mote_physics engine;
    bool stop;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    Body body[2];
};

void Pair::build(int b)
{
    const mote_mesh *mesh = engine.body[b].mesh;
    Body &made = body[b];
    made.vertices.resize(3 * static_cast<size_t>(mesh->vertex_count));
    write_vertices(&engine, b, made.vertices.data()); /* were checked with the setup */
    made.triangles.reserve(3 * static_cast<size_t>(mesh->triangle_count));
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        for (int k = 0; k < 3; ++k)
            made.triangles.push_back(static_cast<int>(mesh->triangles[i][k]));
    }
    made.arrays = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh->triangle_count), made.triangles.data(),
        static_cast<int>(3 * sizeof(int)), static_cast<int>(mesh->vertex_count),
        made.vertices.data(), static_cast<int>(3 * sizeof(btScalar)));
    made.shape = std::make_unique<btGImpactMeshShape>(made.arrays.get());
    made.shape->setMargin(0);
    made.shape->updateBound();
    made.object.setCollisionShape(made.shape.get());
}

void Pair::place(int b)
{
    const mote_physics_body &state = engine.body[b];
    btMatrix3x3 rotation;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            rotation[i][j] = static_cast<btScalar>(state.rotation.m[i][j]);
    }
    const btVector3 translation(static_cast<btScalar>(state.translation.x),
                                static_cast<btScalar>(state.translation.y),
                                static_cast<btScalar>(state.translation.z));
    body[b].object.setWorldTransform(btTransform(rotation, translation));
}

mote_status Pair::refit(int b)
{
    const mote_status status = write_vertices(&engine, b, body[b].vertices.data());
    if (status != MOTE_OK)
        return status;
    body[b].shape->postUpdate();  /* its parts no longer fit, */
    body[b].shape->updateBound(); /* which refits them */
    return MOTE_OK;
}

mote_status Pair::update(const mote_frame *frame)
{
    for (int b = 0; b < 2; ++b) {
        mote_status status = mote_physics_follow(&engine, frame, b);
        if (status == MOTE_OK && engine.body[b].refit)
            status = refit(b);
        if (status != MOTE_OK)
            return status;
        place(b);
    }
    return MOTE_OK;
}

void Pair::query(mote_answer *answer)
{
    const btCollisionObjectWrapper a(nullptr, body[0].shape.get(), &body[0].object,
                                     body[0].object.getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper b(nullptr, body[1].shape.get(), &body[1].object,
                                     body[1].object.getWorldTransform(), -1, -1);
    const auto give_back = [this](btCollisionAlgorithm *used) {
        used->~btCollisionAlgorithm();
        dispatcher.freeCollisionAlgorithm(used);
    };
    const std::unique_ptr<btCollisionAlgorithm, decltype(give_back)> algorithm(
        dispatcher.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS), give_back);
    Listener listener(&a, &b, stop);
    const btDispatcherInfo info;
    try {
        algorithm->processCollision(&a, &b, info, &listener);
    } catch (const FirstContact &) {
    }
    answer->has_contact = true;
    answer->contact = listener.contact;
    answer->counters.triangle_tests = listener.points;
}

mote_traits traits(const double *values)
{
    return mote_physics_traits(static_cast<mote_physics_update>(values[UPDATE]),
                               values[POSITIONS] > 0);
}

template <class Body> mote_status guard(Body &&body) noexcept
{
    return mote_guard("Bullet", body);
}

mote_status create(const mote_setup *setup, void **state)
{
    mote_physics engine;
    const mote_physics_update mode = static_cast<mote_physics_update>(setup->values[UPDATE]);
    const mote_status status = mote_physics_begin(&engine, setup, mode, "Bullet's GImpact");
    if (status != MOTE_OK)
        return status;
    return guard([&] {
        *state = new Pair(engine, setup->values[STOP] > 0);
        return MOTE_OK;
    });
}

void destroy(void *state)
{
    delete static_cast<Pair *>(state);
}

mote_status update(void *state, const mote_frame *frame)
{
    return guard([&] { return static_cast<Pair *>(state)->update(frame); });
}

mote_status query(void *state, const mote_frame *, mote_answer *answer)
{
    return guard([&] {
        static_cast<Pair *>(state)->query(answer);
        return MOTE_OK;
    });
}

} // namespace

MOTE_METHOD(bullet_gimpact) = {"bullet-gimpact",
                               "Bullet GImpact: quantised box trees, refitted; contact only",
                               parameters,
                               PARAMETER_COUNT,
                               traits,
                               create,
                               destroy,
                               update,
                               query,
                               nullptr};
