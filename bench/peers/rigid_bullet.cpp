// One heap of bench/rigid.h in Bullet: sequential impulses, no sleeping. The last number of the line is the size of a real.
#include <btBulletDynamicsCommon.h>
#include "bench/rigid.h"
#include <vector>

int main(int argc, char **argv) {
    rigid_heap h = rigid_begin(argc, argv);
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broad;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &broad, &solver, &configuration);
    const btScalar friction = btScalar(sqrt(RIGID_FRICTION));          // Bullet multiplies those of both bodies
    std::vector<btCollisionShape *> shapes;
    std::vector<btRigidBody *> bodies;
    double mass[RIGID_KINDS], seconds, contacts = 0, kinetic = 0, height = 0;
    world.setGravity(btVector3(0, 0, btScalar(-9.81)));
    if (h.most) world.getSolverInfo().m_numIterations = h.most;
    for (int k = 0; k < 5; k++) {
        double n[3], at;
        rigid_wall(k, n, &at);
        btCollisionShape *plane = new btStaticPlaneShape(btVector3(btScalar(n[0]), btScalar(n[1]), btScalar(n[2])), btScalar(at));
        btRigidBody *wall = new btRigidBody(0, nullptr, plane);
        wall->setFriction(friction);
        wall->setRestitution(0);
        world.addRigidBody(wall);
    }
    for (int k = 0; k < RIGID_KINDS; k++) {
        double x[3*RIGID_POINTS];
        const int count = rigid_points(&h, k, x);
        btVector3 inertia;
        if (h.shape == RIGID_BALLS) { shapes.push_back(new btSphereShape(btScalar(0.5))); mass[k] = RIGID_DENSITY*M_PI/6; }
        else if (h.shape == RIGID_BLOCKS) {
            shapes.push_back(new btBoxShape(btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))));
            mass[k] = RIGID_DENSITY;
        } else {                                // its centre is the mean of the points, its mass that of 0.6 m3
            btConvexHullShape *hull = new btConvexHullShape;
            double centre[3] = {0, 0, 0};
            for (int i = 0; i < 3*count; i++) centre[i%3] += x[i]/count;
            for (int i = 0; i < count; i++) hull->addPoint(btVector3(btScalar(x[3*i] - centre[0]),
                btScalar(x[3*i + 1] - centre[1]), btScalar(x[3*i + 2] - centre[2])), i == count - 1);
            hull->setMargin(btScalar(0.01));
            shapes.push_back(hull);
            mass[k] = RIGID_DENSITY*0.6;
        }
        shapes[(size_t)k]->calculateLocalInertia(btScalar(mass[k]), inertia);
    }
    for (int i = 0; i < h.count; i++) {
        const int k = i%RIGID_KINDS;
        double x[3];
        btVector3 inertia;
        btTransform place;
        rigid_place(&h, i, x);
        place.setIdentity();
        place.setOrigin(btVector3(btScalar(x[0]), btScalar(x[1]), btScalar(x[2])));
        shapes[(size_t)k]->calculateLocalInertia(btScalar(mass[k]), inertia);
        btRigidBody *body = new btRigidBody(btScalar(mass[k]), new btDefaultMotionState(place), shapes[(size_t)k], inertia);
        body->setFriction(friction);
        body->setRestitution(0);
        body->setActivationState(DISABLE_DEACTIVATION);
        world.addRigidBody(body);
        bodies.push_back(body);
    }
    for (int step = 0; step < RIGID_SETTLE; step++) world.stepSimulation(btScalar(RIGID_DT), 0);
    seconds = 0;
    for (int step = 0; step < RIGID_TIMED; step++) {
        const double since = rigid_seconds();
        world.stepSimulation(btScalar(RIGID_DT), 0);
        seconds += rigid_seconds() - since;
        for (int i = 0; i < dispatcher.getNumManifolds(); i++)
            contacts += (dispatcher.getManifoldByIndexInternal(i)->getNumContacts() > 0)/(double)RIGID_TIMED;
    }
    for (size_t i = 0; i < bodies.size(); i++) {
        kinetic += 0.5*(double)bodies[i]->getLinearVelocity().length2();
        height += (double)bodies[i]->getWorldTransform().getOrigin().z();
    }
    rigid_tell(&h, seconds, contacts, kinetic, height, world.getSolverInfo().m_numIterations, (int)sizeof(btScalar));
    return 0;
}
