#include "tests/support/peers/bullet_defects.h"

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

namespace
{

struct Listener : btManifoldResult {
    using btManifoldResult::btManifoldResult;

    void addContactPoint(const btVector3 &, const btVector3 &, btScalar) override
    {
        ++contacts;
    }

    int contacts = 0;
};

/* A triangle as a mesh whose memory Bullet reads directly. */
struct Body {
    Body(const float (&corners)[9], float size)
        : arrays(1, order, 12, 3, numbers, 12), shape(&arrays)
    {
        for (int i = 0; i < 9; ++i)
            numbers[i] = corners[i] * size;
        shape.setMargin(0);
        shape.updateBound();
        object.setCollisionShape(&shape);
    }

    void move(float x)
    {
        for (float &number : numbers)
            number += x;
        shape.postUpdate();
        shape.updateBound();
    }

    float numbers[9] = {};
    int order[3] = {0, 1, 2};
    btTriangleIndexVertexArray arrays;
    btGImpactMeshShape shape;
    btCollisionObject object;
};

} // namespace

int mote_bullet_contacts_after_a_move(float size, float x)
{
    Body a({-1, -1, 0, 1, -1, 0, 0, 1, 0}, size),
        b({0, -0.5F, -1, 0, -0.5F, 1, 0, 0.5F, 0}, size);
    a.move(x);
    b.move(x);
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
    const btCollisionObjectWrapper p(nullptr, &a.shape, &a.object, a.object.getWorldTransform(),
                                     -1, -1);
    const btCollisionObjectWrapper q(nullptr, &b.shape, &b.object, b.object.getWorldTransform(),
                                     -1, -1);
    Listener listener(&p, &q);
    btCollisionAlgorithm *algorithm =
        dispatcher.findAlgorithm(&p, &q, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    algorithm->processCollision(&p, &q, {}, &listener);
    algorithm->~btCollisionAlgorithm();
    dispatcher.freeCollisionAlgorithm(algorithm);
    return listener.contacts;
}
