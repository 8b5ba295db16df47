/* Random mechanisms: trees and closed loops of ball joints and hinges, some bodies fixed, motors with and without a
   limit that press bodies against stops, 1 to 200 sweeps, steps from 0.1 to 2 ms. What joints hold never adds energy.
   The environment variable TEST_LONG has 10,000 of them. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

enum { MOST = 12 };
static const double radius = 4e-3;              /* m */
static int at_length(void) { return getenv("TEST_LONG") != 0; }
static double length_of(dem_vec3 v) { return sqrt((double)(v.x*v.x + v.y*v.y + v.z*v.z)); }

typedef struct mechanism {
    dem_world *world;
    int bodies, joints, gravity, contacts, motors, boxes;
} mechanism;
static dem_joint hold(mechanism *m, uint64_t *seed, dem_body a, dem_body b, dem_vec3 point) {
    dem_joint_desc desc = DEM_JOINT_DESC;
    dem_joint joint;
    desc.kind = scene_random(seed) < 0.5 ? DEM_JOINT_POINT : DEM_JOINT_REVOLUTE;
    desc.a = a;
    desc.b = b;
    desc.point = point;
    desc.axis = scene_at(seed, 2, -1, 2, -1, 2, -1);
    desc.collide = m->contacts && scene_random(seed) < 0.3;
    if (m->motors && desc.kind == DEM_JOINT_REVOLUTE && scene_random(seed) < 0.5) {
        desc.motor = scene_random(seed) < 0.7 ? DEM_MOTOR_SPEED : DEM_MOTOR_TORQUE;
        desc.speed = (dem_real)(60*scene_random(seed) - 30);
        desc.torque = (dem_real)(2e-6*scene_random(seed));
        if (desc.motor == DEM_MOTOR_SPEED && scene_random(seed) < 0.3) desc.torque = 0;
    }
    joint = dem_joint_add(m->world, &desc);
    if (joint.id) m->joints++;
    else dem_world_error_get(m->world);             /* both fixed: there is nothing to hold */
    return joint;
}
static mechanism mechanism_make(uint64_t *seed) {
    static const int sweeps[] = {1, 2, 3, 5, 10, 30, 200};
    const dem_body nobody = {0, 0};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material stuff;
    dem_body body[MOST];
    dem_vec3 place[MOST];
    dem_real corners[24];
    dem_shape box;
    mechanism m;
    int i, k;
    memset(&m, 0, sizeof m);
    m.bodies = 2 + (int)((MOST - 1)*scene_random(seed));
    m.gravity = scene_random(seed) < 0.4;
    m.contacts = scene_random(seed) < 0.4;
    m.motors = scene_random(seed) < 0.5;
    m.boxes = scene_random(seed) < 0.3;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.orientations = desc.ledger = desc.threads = 1;
    desc.dt = (dem_real)(1e-4*pow(20, scene_random(seed)));
    desc.sweeps = sweeps[(int)(7*scene_random(seed))];
    desc.gravity.z = DEM_R(-9.81)*(dem_real)m.gravity;
    m.world = dem_world_create(&desc);
    stuff = scene_material(m.world, 1e7, scene_random(seed), scene_random(seed), 0);
    for (i = 0; i < 24; i++) corners[i] = (dem_real)(radius*(i % 3 ? 0.4 : 0.9)*((i/3 >> i % 3 & 1) ? 1 : -1));
    box = dem_shape_polyhedron_add(m.world, 8, corners);
    if (m.contacts) dem_wall_plane_add(m.world, stuff, at(0, 0, -2*radius), at(0, 0, 1));
    for (i = 0; i < m.bodies; i++) {
        const int parent = (int)(i*scene_random(seed));
        double nearest;
        int tries = 0;
        do {                                    /* a place apart from all others, so that no overlap begins it */
            const dem_vec3 way = scene_at(seed, 2, -1, 2, -1, 2, -1);
            const dem_real far = (dem_real)(3*radius/(length_of(way) + 1e-9));
            place[i] = i ? dem_vec3_make(place[parent].x + far*way.x, place[parent].y + far*way.y,
                                         (dem_real)fabs((double)(place[parent].z + far*way.z))) : at(0, 0, 0);
            nearest = 1;
            for (k = 0; k < i; k++)
                nearest = fmin(nearest, length_of(dem_vec3_make(place[i].x - place[k].x, place[i].y - place[k].y,
                                                                place[i].z - place[k].z)));
        } while (nearest < 2.1*radius && ++tries < 50);
        body[i] = m.boxes ? dem_body_add(m.world, stuff, box, place[i], dem_quat_make(1, 0, 0, 0))
                          : dem_sphere_add(m.world, stuff, (dem_real)radius, place[i]);
        if (i && scene_random(seed) < 0.08) {
            dem_body_state s = scene_state(m.world, body[i]);
            s.fixed = 1;
            dem_body_set(m.world, body[i], &s);
        } else scene_move(m.world, body[i], scene_at(seed, 0.6, -0.3, 0.6, -0.3, 0.6, -0.3),
                          scene_at(seed, 40, -20, 40, -20, 40, -20));
        if (i) hold(&m, seed, body[i], body[parent], at((double)(place[i].x + place[parent].x)/2,
                    (double)(place[i].y + place[parent].y)/2, (double)(place[i].z + place[parent].z)/2));
    }
    if (scene_random(seed) < 0.6) hold(&m, seed, body[0], nobody, at(0, 0, radius));
    for (i = (int)(4*scene_random(seed)*scene_random(seed)*2); i > 0; i--) {   /* loops */
        const int a = (int)(m.bodies*scene_random(seed)), b = (int)(m.bodies*scene_random(seed));
        if (a != b) hold(&m, seed, body[a], body[b], at((double)(place[a].x + place[b].x)/2,
                         (double)(place[a].y + place[b].y)/2, (double)(place[a].z + place[b].z)/2));
    }
    return m;
}
/* J: kinetic and potential energy. */
static double energy_of(const mechanism *m) {
    const dem_totals t = dem_totals_get(m->world);
    return t.kinetic + t.rotational - (double)m->world->desc.gravity.z*
        t.mass*t.centre[2];
}
/* J, given by joints but for their motors in the step that comes */
static double given_of(const mechanism *m) {
    double given = 0;
    int i;
    for (i = 0; i < m->world->joint_count; i++) given += m->world->joints[i].held;
    return given;
}
/* J: what was lost in contacts and joints, which the ledger books together. */
static double lost_of(const mechanism *m) {
    const dem_ledger l = dem_ledger_get(m->world);
    return l.normal + l.slide + l.rolling;
}
static void mechanisms(void) {
    const int count = at_length() ? 10000 : 250, show = getenv("TEST_TABLES") != 0;
    uint64_t seed = 48;
    double worst[3] = {0, 0, 0};
    int i, k, ran = 0, joints = 0;
    for (i = 0; i < count; i++) {
        mechanism m = mechanism_make(&seed);
        double given = 0, coming = 0, over = 0, rise = 0, first = 0, lost = 0, most = 0;
        for (k = 0; k < 60 && dem_world_step(m.world, 1) == DEM_OK; k++) {   /* a motor may be too fast for the step */
            const double energy = energy_of(&m) - dem_ledger_get(m.world).walls;        /* less that of motors */
            most = fmax(most, dem_ledger_get(m.world).throughput + fabs(energy));
            if (k) given += coming;             /* from the second step on */
            else first = energy, lost = lost_of(&m);
            coming = given_of(&m);
            over = fmax(over, given + coming);
            rise = fmax(rise, energy - first - fmax(0, lost - lost_of(&m) - given));    /* less that of contacts */
        }
        if (show && fmax(over, rise) > 1e-9*most)
            printf("%d: gravity %d, contacts %d, motors %d, boxes %d, %d bodies, %d joints, %d sweeps, dt %g s: joints gave "
                   "%g, energy rose by %g of %g J\n", i, m.gravity, m.contacts, m.motors, m.boxes, m.bodies, m.joints,
                   m.world->desc.sweeps, (double)m.world->desc.dt, over, rise, most);
        worst[0] = fmax(worst[0], over/most);
        worst[1 + (m.boxes || m.gravity)] = fmax(worst[1 + (m.boxes || m.gravity)], rise/most);
        ran += k;
        joints += m.joints;
        dem_world_destroy(m.world);
    }
    if (show) printf("%d mechanisms, %d joints, %d steps: joints gave %g, energy rose by %g, with boxes or weight by %g\n",
                     count, joints, ran, worst[0], worst[1], worst[2]);
    CHECK(ran > 40*count && joints > 5*count);
    CHECK(worst[0] < 1e-12);                    /* round-off */
    CHECK(worst[1] < 1e-9);                     /* that of sums over 60 steps and of the ledger */
    /* worst[2] is printed only: contacts and joints undo overlaps and gaps by moving bodies, which lifts weights, and
       the rotation of boxes is of second order */
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("joints: constraints never add energy, in trees, loops and against stops, with 1 to 200 "
         "sweeps")
        mechanisms();
    return test_end();
}
