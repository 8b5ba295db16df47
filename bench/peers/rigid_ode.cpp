// One heap of bench/rigid.h in ODE: quickstep, no sleeping; balls and blocks only. The last number of the line is the size
// of a real.
#include <ode/ode.h>
#include "bench/rigid.h"
#include <vector>

static dWorldID world;
static dJointGroupID joints;
static double touching;
static void touch(void *, dGeomID a, dGeomID b) {
    dContact contact[8];
    const dBodyID one = dGeomGetBody(a), other = dGeomGetBody(b);
    if (!one && !other) return;
    const int count = dCollide(a, b, 8, &contact[0].geom, sizeof *contact);
    touching += count > 0;
    for (int i = 0; i < count; i++) {
        contact[i].surface.mode = dContactApprox1;
        contact[i].surface.mu = RIGID_FRICTION;
        dJointAttach(dJointCreateContact(world, joints, &contact[i]), one, other);
    }
}
int main(int argc, char **argv) {
    rigid_heap h = rigid_begin(argc, argv);
    std::vector<dBodyID> bodies;
    double seconds = 0, kinetic = 0, height = 0;
    dMass mass;
    if (h.shape == RIGID_ROCKS) { fprintf(stderr, "rigid_ode: no rocks\n"); return 1; }
    dInitODE();
    world = dWorldCreate();
    joints = dJointGroupCreate(0);
    const dSpaceID space = dSweepAndPruneSpaceCreate(0, dSAP_AXES_XYZ);
    dWorldSetGravity(world, 0, 0, -9.81);
    if (h.most) dWorldSetQuickStepNumIterations(world, h.most);
    dWorldSetContactMaxCorrectingVel(world, 2);
    dWorldSetContactSurfaceLayer(world, 0.001);
    for (int k = 0; k < 5; k++) {
        double n[3], at;
        rigid_wall(k, n, &at);
        dCreatePlane(space, n[0], n[1], n[2], at);
    }
    if (h.shape == RIGID_BALLS) dMassSetSphere(&mass, RIGID_DENSITY, 0.5);
    else dMassSetBox(&mass, RIGID_DENSITY, 1, 1, 1);
    for (int i = 0; i < h.count; i++) {
        double x[3];
        rigid_place(&h, i, x);
        const dBodyID body = dBodyCreate(world);
        dBodySetMass(body, &mass);
        dBodySetPosition(body, x[0], x[1], x[2]);
        dGeomSetBody(h.shape == RIGID_BALLS ? dCreateSphere(space, 0.5) : dCreateBox(space, 1, 1, 1), body);
        bodies.push_back(body);
    }
    for (int step = 0; step < RIGID_SETTLE + RIGID_TIMED; step++) {
        const double since = rigid_seconds();
        if (step == RIGID_SETTLE) seconds = touching = 0;
        dSpaceCollide(space, 0, touch);
        dWorldQuickStep(world, RIGID_DT);
        dJointGroupEmpty(joints);
        seconds += rigid_seconds() - since;
    }
    for (size_t i = 0; i < bodies.size(); i++) {
        const dReal *v = dBodyGetLinearVel(bodies[i]);
        kinetic += 0.5*(v[0]*v[0] + v[1]*v[1] + v[2]*v[2]);
        height += dBodyGetPosition(bodies[i])[2];
    }
    rigid_tell(&h, seconds, touching/RIGID_TIMED, kinetic, height, dWorldGetQuickStepNumIterations(world), (int)sizeof(dReal));
    return 0;
}
