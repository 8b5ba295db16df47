/* Joints and motors of worlds with impulses. Outside numbers: the compound pendulum, the fast top's precession
   (Goldstein, Classical Mechanics, 5.7), statics of beams and chains. A drum: a ring of spheres, once a body that a
   motor turns, once a wall of the same spheres that moves. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double g = 9.81;                   /* m/s2 */
static const double round_angle = 2*3.14159265358979;

static dem_world *jointed(double gravity, double dt, int threads, dem_material *m) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(0, 0, 0.5, 0);
    dem_world *world;
    desc.gravity.z = (dem_real)-gravity;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.orientations = 1;
    desc.dt = (dem_real)dt;
    desc.tolerance = DEM_R(1e-11);
    desc.sweeps = 2000;
    desc.ledger = 1;
    desc.threads = threads;
    world = dem_world_create(&desc);
    *m = dem_material_add(world, &stuff);
    return world;
}
static dem_body ball(dem_world *world, dem_material m, double radius, dem_vec3 x) {
    return dem_sphere_add(world, m, (dem_real)radius, x);
}
/* Joins a to b (or, when b is null, to the space) at a point; an axis of any length: a hinge about it. */
static dem_joint joined(dem_world *world, dem_body a, dem_body b, dem_vec3 point, dem_vec3 axis) {
    dem_joint_desc desc = DEM_JOINT_DESC;
    desc.kind = axis.x*axis.x + axis.y*axis.y + axis.z*axis.z > 0 ? DEM_JOINT_REVOLUTE : DEM_JOINT_POINT;
    desc.a = a;
    desc.b = b;
    desc.point = point;
    desc.axis = axis;
    return dem_joint_add(world, &desc);
}
static const dem_body nobody = {0, 0};
static dem_joint_state told(const dem_world *world, dem_joint joint) {
    dem_joint_state state;
    memset(&state, 0, sizeof state);
    CHECK_EQ(dem_joint_get(world, joint, &state), DEM_OK);
    return state;
}
static double mass_of(const dem_world *world) { return dem_totals_get(world).mass; }
static double energy_of(const dem_world *world) {       /* J, about the origin's height */
    const dem_totals t = dem_totals_get(world);
    return t.kinetic + t.rotational - t.mass*(double)dem_world_desc_get(world).gravity.z*t.centre[2];
}
/* The residual of the ledger, of what went through it. */
static double ledger_off(const dem_world *world) {
    const dem_ledger l = dem_ledger_get(world);
    return fabs(l.residual)/(l.throughput + 1e-300);
}

static void swings(void) {
    const double length = 0.1, radius = 0.02, dt = 5e-4, angle = 0.05;
    const double period = round_angle*sqrt((length*length + 0.4*radius*radius)/(g*length));
    dem_material m;
    dem_world *world = jointed(g, dt, 1, &m);
    const dem_body b = ball(world, m, radius, at(length*sin(angle), 0, -length*cos(angle)));
    const dem_joint joint = joined(world, b, nobody, at(0, 0, 0), at(0, 0, 0));
    double first = -1, last = 0, before = 0, gap = 0, top[2] = {-1e30, -1e30};
    int crossings = 0, i;
    for (i = 0; i < (int)(20.4*period/dt); i++) {
        dem_vec3 x;
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        x = scene_state(world, b).position;
        if (i && before < 0 && (double)x.x >= 0) {
            last = dem_world_time_get(world) - dt*(double)x.x/((double)x.x - before);
            if (first < 0) first = last;
            else crossings++;
        }
        before = (double)x.x;
        gap = fmax(gap, (double)told(world, joint).gap);
        if (i < period/dt) top[0] = fmax(top[0], energy_of(world));
        if (i > 19*period/dt) top[1] = fmax(top[1], energy_of(world));
    }
    CHECK(crossings == 19);
    CHECK_NEAR((last - first)/crossings, period*(1 + angle*angle/16), 2e-4*period);
    CHECK(gap < 1e-6);
    CHECK_NEAR(top[0], top[1], 1e-3*mass_of(world)*g*length*(1 - cos(angle)));
    CHECK_NEAR(ledger_off(world), 0, 1e-4);
    dem_world_destroy(world);
}

static void precesses(void) {
    const double length = 0.05, radius = 0.02, spin = 900, dt = 1e-4;
    dem_material m;
    dem_world *world = jointed(g, dt, 1, &m);
    const dem_body b = ball(world, m, radius, at(length, 0, 0));
    const double rate = g*length/(0.4*radius*radius*spin);       /* rad/s */
    dem_vec3 x;
    double turned;
    int i;
    joined(world, b, nobody, at(0, 0, 0), at(0, 0, 0));
    scene_move(world, b, at(0, rate*length, 0), at(spin, 0, rate));
    for (i = 0; i < 2000; i++) CHECK_EQ(scene_step(world, 1), DEM_OK);
    x = scene_state(world, b).position;
    turned = atan2((double)x.y, (double)x.x);
    CHECK_NEAR(turned, rate*2000*dt, 0.003*rate*2000*dt);
    CHECK(fabs((double)x.z) < 0.002*length);
    dem_world_destroy(world);
}

static void hangs(void) {
    const double radius = 0.01;
    dem_material m;
    dem_world *world = jointed(g, 1e-3, 1, &m);
    dem_body links[10], beam;
    dem_joint joints[10], held;
    dem_joint_desc desc = DEM_JOINT_DESC;
    dem_joint_state state;
    double weight;
    int i, step;
    for (i = 0; i < 10; i++) links[i] = ball(world, m, radius, at(0, 0, -(2*i + 1)*radius));
    weight = mass_of(world)/10*g;
    for (i = 0; i < 10; i++)
        joints[i] = joined(world, links[i], i ? links[i - 1] : nobody, at(0, 0, -2*i*radius), at(0, 0, 0));
    beam = ball(world, m, radius, at(0.2, 0, 0));
    desc.kind = DEM_JOINT_REVOLUTE;
    desc.motor = DEM_MOTOR_SPEED;
    desc.a = beam;
    desc.point = at(0.17, 0, 0);
    desc.axis = at(0, 3, 0);
    held = dem_joint_add(world, &desc);
    for (step = 0; step < 200; step++) CHECK_EQ(scene_step(world, 1), DEM_OK);
    for (i = 0; i < 10; i++) {
        state = told(world, joints[i]);
        CHECK_NEAR(state.force.z, (10 - i)*weight, 1e-6*weight);
        CHECK(fabs((double)state.force.x) < 1e-9*weight && (double)state.gap < 1e-9);
    }
    state = told(world, held);
    CHECK_NEAR(state.force.z, weight, 1e-6*weight);
    CHECK_NEAR(state.motor_torque, -weight*0.03, 1e-6*weight*0.03);   /* about y: it lifts what lies along x */
    CHECK_NEAR(state.torque.y, -weight*0.03, 1e-6*weight*0.03);
    CHECK(fabs((double)scene_state(world, beam).position.z) < 1e-9);
    dem_world_destroy(world);
}

static void turns(void) {
    const double radius = 0.02, dt = 1e-3, torque = 1e-4;
    dem_material m;
    dem_world *world = jointed(0, dt, 1, &m);
    const dem_body b = ball(world, m, radius, at(0, 0, 0));
    const dem_joint joint = joined(world, b, nobody, at(0, 0, 0), at(0, 0, 1));
    const double inertia = 0.4*mass_of(world)*radius*radius;
    dem_joint_state state;
    int i;
    CHECK_EQ(dem_joint_motor_set(world, joint, DEM_MOTOR_TORQUE, 0, (dem_real)torque), DEM_OK);
    for (i = 0; i < 100; i++) CHECK_EQ(scene_step(world, 1), DEM_OK);
    CHECK_NEAR(scene_state(world, b).spin.z, torque*100*dt/inertia, 1e-9*torque*100*dt/inertia);
    state = told(world, joint);
    CHECK_NEAR(state.motor_torque, torque, 1e-12);
    CHECK_NEAR(state.work, inertia*pow((double)scene_state(world, b).spin.z, 2)/2, 1e-9*state.work);
    CHECK_NEAR(state.turned, torque/inertia*dt*dt*100*101/2, 1e-9*state.turned);
    CHECK_NEAR(dem_ledger_get(world).walls, state.work, 1e-9*state.work);
    /* a speed with a limit: as fast as that allows, then none */
    CHECK_EQ(dem_joint_motor_set(world, joint, DEM_MOTOR_SPEED, 0, (dem_real)torque), DEM_OK);
    for (i = 0; i < 50; i++) CHECK_EQ(scene_step(world, 1), DEM_OK);
    CHECK_NEAR(scene_state(world, b).spin.z, torque*50*dt/inertia, 1e-9*torque*50*dt/inertia);
    for (i = 0; i < 60; i++) CHECK_EQ(scene_step(world, 1), DEM_OK);
    CHECK(fabs((double)scene_state(world, b).spin.z) < 1e-9 && fabs((double)told(world, joint).motor_torque) < 1e-9);
    CHECK_EQ(dem_joint_motor_set(world, joint, DEM_MOTOR_SPEED, 5, 0), DEM_OK);
    CHECK_EQ(scene_step(world, 1), DEM_OK);
    CHECK_NEAR(scene_state(world, b).spin.z, 5, 1e-9);
    CHECK_NEAR(ledger_off(world), 0, 1e-9);
    dem_world_destroy(world);
}

static void keeps(void) {
    dem_material m;
    dem_world *world = jointed(0, 1e-3, 1, &m);
    dem_body b[4];
    dem_totals first, last;
    double start, lost, momentum = 0, angular = 0;
    int i, k;
    for (i = 0; i < 4; i++) {
        b[i] = ball(world, m, 0.01 + 0.002*i, at(0.03*i, 0, 0.01*(i & 1)));
        scene_move(world, b[i], at(0.1*i, 0.3 - 0.2*(i & 1), 0.2*(i == 2)), at(0, 0, 0));
    }
    for (i = 1; i < 4; i++)
        joined(world, b[i], b[i - 1], at(0.03*i - 0.015, 0, 0.005), i == 2 ? at(0, 1, 0.3) : at(0, 0, 0));
    CHECK_EQ(scene_step(world, 1), DEM_OK);                    /* the first takes up what the joints forbid */
    first = dem_totals_get(world);
    start = first.kinetic + first.rotational + dem_ledger_get(world).normal;
    for (i = 0; i < 3000; i++) CHECK_EQ(scene_step(world, 1), DEM_OK);
    last = dem_totals_get(world);
    for (k = 0; k < 3; k++) {
        momentum = fmax(momentum, fabs(last.momentum[k] - first.momentum[k]));
        angular = fmax(angular, fabs(last.angular[k] - first.angular[k]));
    }
    CHECK(momentum < 1e-13 && angular < 1e-13);
    lost = dem_ledger_get(world).normal + dem_ledger_get(world).slide;      /* they hit each other */
    CHECK_NEAR(last.kinetic + last.rotational + lost, start, 0.005*start);
    CHECK_NEAR(ledger_off(world), 0, 1e-9);
    dem_world_destroy(world);
}

/* ---- forces of a chain in motion, against its equations of motion ---- */

enum { LINKS_MOST = 5 };
/* A plane chain of equal links that hangs at a pivot and is let go level: a link is jointed at the distance c, m, on both
   sides of its centre, has a mass, kg, and a moment of inertia, kg m2. The pivot moves along x by
   shake*(1 - cos(7 t)), m. The angles, rad, are those below the x axis; `rate`, rad/s; `back`: forces of the joints on
   their links along x and z, N. */
typedef struct chain {
    int links;
    double c, mass, inertia, shake, time, angle[LINKS_MOST], rate[LINKS_MOST], back[LINKS_MOST][2];
} chain;
static double chain_arm(const chain *o, int joint, int link) {      /* of link's centre, m */
    return joint > link ? 0 : joint == link ? o->c : 2*o->c;
}
/* The angular accelerations, rad/s2, by Gaussian elimination; sets the forces. */
static void chain_bend(chain *o, double *bend) {
    const int n = o->links;
    const double push = o->shake*49*cos(7*o->time);
    double a[LINKS_MOST][LINKS_MOST + 1], sum[2] = {0, 0};
    int i, j, k;
    for (i = 0; i < n; i++) {
        a[i][n] = 0;
        for (j = 0; j < n; j++) {
            double share = 0;
            for (k = 0; k < n; k++) share += o->mass*chain_arm(o, i, k)*chain_arm(o, j, k);
            a[i][j] = share*cos(o->angle[i] - o->angle[j]) + (i == j ? o->inertia : 0);
            a[i][n] += o->mass*chain_arm(o, i, j)*(g*cos(o->angle[i]) + push*sin(o->angle[i])) -
                share*sin(o->angle[i] - o->angle[j])*o->rate[j]*o->rate[j];
        }
    }
    for (i = 0; i < n; i++)
        for (j = 0; j < n; j++)
            for (k = n; k >= i && j != i; k--) a[j][k] -= a[j][i]/a[i][i]*a[i][k];
    for (i = 0; i < n; i++) bend[i] = a[i][n]/a[i][i];
    for (i = n - 1; i >= 0; i--) {
        sum[0] += o->mass*push;
        sum[1] += o->mass*g;
        for (j = 0; j < n; j++) {
            const double s = sin(o->angle[j]), c = cos(o->angle[j]), w2 = o->rate[j]*o->rate[j];
            sum[0] += o->mass*chain_arm(o, j, i)*(-s*bend[j] - c*w2);
            sum[1] += o->mass*chain_arm(o, j, i)*(-c*bend[j] + s*w2);
        }
        o->back[i][0] = sum[0];
        o->back[i][1] = sum[1];
    }
}
/* Runge and Kutta's step of fourth order. */
static void chain_step(chain *o, double dt) {
    static const double at_part[4] = {0, 0.5, 0.5, 1}, share[4] = {1, 2, 2, 1};
    chain sum = *o, now = *o;
    double bend[LINKS_MOST] = {0};
    int i, k;
    for (k = 0; k < 4; k++) {
        const chain last = now;
        now.time = o->time + at_part[k]*dt;
        for (i = 0; i < o->links; i++) {
            now.angle[i] = o->angle[i] + at_part[k]*dt*last.rate[i];
            now.rate[i] = o->rate[i] + at_part[k]*dt*bend[i];
        }
        chain_bend(&now, bend);
        for (i = 0; i < o->links; i++) {
            sum.angle[i] += share[k]*dt/6*now.rate[i];
            sum.rate[i] += share[k]*dt/6*bend[i];
        }
    }
    sum.time = o->time + dt;
    *o = sum;
    chain_bend(o, bend);
}
static void chain_shake(double time, dem_pose *pose, void *user) {
    const double shake = *(const double *)user;
    pose->position.x = (dem_real)(shake*(1 - cos(7*time)));
    pose->velocity.x = (dem_real)(shake*7*sin(7*time));
}
enum { LEVEL_HINGE, LEVEL_BALL, LEVEL_TWO, LEVEL_FIVE, LEVEL_SHAKEN, LEVELS };
static const char *const level_names[LEVELS] = {"rod on a hinge", "ball on a ball joint", "two rods on ball joints",
                                                "five balls on hinges", "rod on a shaken hinge"};
/* Largest error of a force of a joint in any step, and of the difference of two steps, over the largest force; rms of the
   first; largest rise of energy, J. */
typedef struct level_error { double most, jump, rms, rise, energy; } level_error;
static level_error level_run(int scene, double dt) {
    const int rods = scene != LEVEL_BALL && scene != LEVEL_FIVE;
    const double c = rods ? 0.5 : scene == LEVEL_BALL ? 0.1 : 0.025, radius = rods ? 0.01 : scene == LEVEL_BALL ? 0.02 : 0.01;
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_real centre[3] = {0, 0, 0}, radii[1] = {DEM_R(0.01)};
    dem_material m;
    dem_world *world = jointed(g, dt, 1, &m);
    dem_joint joints[LINKS_MOST];
    dem_body last = {0, 0};
    dem_wall wall = {0};
    level_error o = {0, 0, 0, 0, 0};
    double error[LINKS_MOST][2] = {{0}}, bend[LINKS_MOST], top = 0, first = 0;
    const int steps = (int)((dt < 5e-5 ? 0.3 : 0.6)/dt + 0.5);
    dem_shape rod;
    chain want;
    int i, k, e;
    memset(&want, 0, sizeof want);
    want.links = scene == LEVEL_TWO ? 2 : scene == LEVEL_FIVE ? 5 : 1;
    want.c = c;
    want.shake = scene == LEVEL_SHAKEN ? 0.05 : 0;
    cluster.count = 1;
    cluster.positions = centre;
    cluster.radii = radii;
    cluster.mass = DEM_CLUSTER_GIVEN;
    cluster.volume = DEM_R(4e-4);               /* of 2,500 kg/m3: 1 kg */
    for (i = 0; i < 3; i++) cluster.inertia[i] = (dem_real)((i < 2 ? 1/12.0 : 1e-4)/2500);
    rod = dem_shape_cluster_add(world, &cluster);
    if (want.shake > 0) {
        dem_motion motion = DEM_MOTION;
        wall = dem_wall_plane_add(world, m, at(0, 0, 9), at(0, 0, -1));
        motion.kind = DEM_MOTION_USER;
        motion.function = chain_shake;
        motion.user = &want.shake;
        CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
    }
    for (i = 0; i < want.links; i++) {
        const dem_vec3 x = at(c*(2*i + 1), 0, 0);
        const dem_body b = rods ? dem_body_add(world, m, rod, x, dem_quat_about(at(0, 1, 0), (dem_real)(round_angle/4)))
                                : ball(world, m, radius, x);
        dem_joint_desc desc = DEM_JOINT_DESC;
        desc.kind = scene == LEVEL_BALL || scene == LEVEL_TWO ? DEM_JOINT_POINT : DEM_JOINT_REVOLUTE;
        desc.a = b;
        desc.b = last;
        desc.wall = wall;
        desc.point = at(2*c*i, 0, 0);
        desc.axis = at(0, 1, 0);
        joints[i] = dem_joint_add(world, &desc);
        CHECK(joints[i].id);
        last = b;
    }
    want.mass = mass_of(world)/want.links;
    want.inertia = rods ? want.mass/12 : 0.4*want.mass*radius*radius;
    chain_step(&want, dt/2);                    /* forces are those in the middle of the next step */
    for (k = 0; k < steps; k++) {
        double energy;
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        energy = energy_of(world) - dem_ledger_get(world).walls;
        if (!k) first = energy;                 /* the pivot begins to move in the first step */
        o.rise = fmax(o.rise, energy - first);
        o.energy = fmax(o.energy, (double)dem_totals_get(world).kinetic);
        chain_step(&want, dt);
        chain_bend(&want, bend);
        for (i = 0; i < want.links; i++) {
            const dem_joint_state state = told(world, joints[i]);
            for (e = 0; e < 2; e++) {
                const double off = (double)(e ? state.force.z : state.force.x) - want.back[i][e];
                if (k) o.jump = fmax(o.jump, fabs(off - error[i][e]));
                error[i][e] = off;
                o.most = fmax(o.most, fabs(off));
                o.rms += off*off/(2*want.links*steps);
                top = fmax(top, fabs(want.back[i][e]));
            }
        }
    }
    o.rms = sqrt(o.rms)/top;
    o.most /= top;
    o.jump /= top;
    dem_world_destroy(world);
    return o;
}
static void smooth(void) {
    static const double steps[] = {1e-3, 1e-4, 1e-5};
    /* 1/s2: parts of errors in dt^2. The end of the chain of five cracks like a whip, at 300 rad/s. */
    static const double second[LEVELS] = {50, 50, 50, 1e4, 50};
    const int show = getenv("TEST_TABLES") != 0;
    int scene, k;
    for (scene = 0; scene < LEVELS; scene++) {
        for (k = 0; k < 3; k++) {
            const level_error o = level_run(scene, steps[k]);
            CHECK(o.rms < second[scene]*steps[k]*steps[k] + 1e-6);
            CHECK(o.most < 40*second[scene]*steps[k]*steps[k] + 5*steps[k]);
            CHECK(o.jump < 40*second[scene]*steps[k]*steps[k] + 5*steps[k]);
            CHECK(o.rise < 1e-14*o.energy);
            if (show) printf("%s, dt %g s: errors of force: %.2g, from step to step %.2g, rms %.2g; rise of energy %.2g of %g J\n",
                             level_names[scene], steps[k], o.most, o.jump, o.rms, o.rise, o.energy);
        }
    }
}

/* ---- what joints hold ---- */

static dem_shape slab(dem_world *world, double half, double across) {
    dem_real x[24];
    int i;
    for (i = 0; i < 24; i++) x[i] = (dem_real)((i/3 >> i % 3 & 1 ? 1 : -1)*(i % 3 ? across : half));
    return dem_shape_polyhedron_add(world, 8, x);
}
static void folds(void) {
    static const double steps[] = {1e-3, 2.5e-4};
    int i, k, s;
    for (s = 0; s < 4; s++) {
        const double pitch = 9e-3, dt = steps[s & 1];
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc stuff = scene_stuff(0, 0, 0.5, 0);
        dem_world *world;
        dem_material m;
        dem_body links[5];
        dem_shape box;
        double first, rise = 0;
        desc.gravity.z = (dem_real)-g;
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = (dem_real)dt;
        desc.threads = 1;
        desc.sweeps = s < 2 ? 0 : 1;
        world = dem_world_create(&desc);
        m = dem_material_add(world, &stuff);
        box = slab(world, 4e-3, 1e-3);
        for (i = 0; i < 5; i++) {
            links[i] = dem_body_add(world, m, box, at(pitch*i, 0, 0), dem_quat_make(1, 0, 0, 0));
            joined(world, links[i], i ? links[i - 1] : nobody, at(pitch*(i - 0.5), 0, 0), at(0, 1, 0));
        }
        first = energy_of(world);
        for (k = 0; k < (int)(0.8/dt); k++) {
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            rise = fmax(rise, energy_of(world) - first);
        }
        /* of what it can fall by: the rotation of boxes keeps energy to some 1e-3 where it folds, with 0.3 rad a step */
        CHECK(rise < 1e-3*mass_of(world)*g*pitch*2.5);
        dem_world_destroy(world);
    }
}
/* A chain along x of so many balls, held by its first one where there is gravity, else thrown by its last. */
static double chain_gap(int count, double gravity, double dt, int steps, double *rise) {
    const double pitch = 9e-3;
    dem_body *links = (dem_body *)malloc((size_t)count*sizeof *links);
    dem_joint *joints = (dem_joint *)malloc((size_t)count*sizeof *joints);
    dem_material m;
    dem_world *world = jointed(gravity, dt, 1, &m);
    const dem_joint none = {0};
    double gap = 0, first, most;
    int i, k;
    for (i = 0; i < count; i++) {
        links[i] = ball(world, m, 4e-3, at(pitch*i, 0, 0));
        joints[i] = i || gravity > 0 ? joined(world, links[i], i ? links[i - 1] : nobody, at(pitch*(i - 0.5), 0, 0),
                                              i % 3 ? at(0, 0, 0) : at(0, 1, 0)) : none;
    }
    if (!(gravity > 0)) scene_move(world, links[count - 1], at(0.3, 0.2, 1), at(0, 0, 0));
    first = most = energy_of(world);
    for (k = 0; k < steps; k++) {
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        most = fmax(most, energy_of(world));
        for (i = gravity > 0 ? 0 : 1; i < count; i++) gap = fmax(gap, (double)told(world, joints[i]).gap);
    }
    *rise = most - first;
    dem_world_destroy(world);
    free(links);
    free(joints);
    return gap/pitch;
}
static void long_chains(void) {
    double rise;
    CHECK(chain_gap(1000, 0, 1e-3, 30, &rise) < 1e-6);
    CHECK(rise < 1e-15);                        /* J, of 4e-4 */
    CHECK(chain_gap(1000, g, 1e-4, 30, &rise) < 1e-6);
    CHECK(rise < 1e-12);                        /* J: of 30 J that it could fall by */
}
/* A rod of four hinges whose axes are parallel: in space each loop of them holds three rows more than is needed. */
static void loops(void) {
    dem_material m;
    dem_world *world = jointed(0, 1e-3, 1, &m);
    dem_body b[4];
    dem_joint joints[5];
    double first, gap = 0, most = 0;
    int i, k;
    for (i = 0; i < 4; i++) b[i] = ball(world, m, 0.01, at(0.03*(i == 1 || i == 2), 0.03*(i > 1), 0));
    for (i = 0; i < 4; i++) {
        const int next = (i + 1) % 4;
        joints[i] = joined(world, b[i], b[next], at(i == 0 || i == 2 ? 0.015 : 0.03*(i == 1), i & 1 ? 0.015 : 0.03*(i == 2), 0),
                           at(0, 0, 1));
    }
    joints[4] = joined(world, b[0], nobody, at(0, 0, 0), at(0, 0, 1));
    scene_move(world, b[2], at(-0.2, 0.1, 0.05), at(0, 0, 3));
    CHECK_EQ(scene_step(world, 1), DEM_OK);
    first = energy_of(world);
    for (k = 0; k < 2000; k++) {
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        for (i = 0; i < 5; i++) gap = fmax(gap, (double)told(world, joints[i]).gap);
        most = fmax(most, dem_totals_get(world).kinetic + dem_totals_get(world).rotational);
    }
    CHECK(gap < 1e-6 && most < first*(1 + 1e-9));
    CHECK_NEAR(ledger_off(world), 0, 1e-6);
    dem_world_destroy(world);
}
static void fix(dem_world *world, dem_body body, int fixed, dem_vec3 velocity) {
    dem_body_state s = scene_state(world, body);
    s.fixed = fixed;
    s.velocity = velocity;
    s.spin = at(0, 0, 0);
    CHECK_EQ(dem_body_set(world, body, &s), DEM_OK);
}
/* A motor of a given torque, or speed, on a body against another one, a wall or the space, which cannot move. */
static void fixed_bodies(void) {
    int to, motor, i;
    for (to = 0; to < 3; to++)
        for (motor = 1; motor < 3; motor++) {
            dem_material m;
            dem_world *world = jointed(0, 1e-3, 1, &m);
            const dem_wall wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
            const dem_body a = ball(world, m, 0.01, at(0, 0, 0)), b = ball(world, m, 0.01, at(0.03, 0, 0));
            dem_joint_desc desc = DEM_JOINT_DESC;
            dem_joint joint;
            dem_joint_state o;
            dem_ledger before, after;
            fix(world, b, 1, at(0, 0, 0));
            desc.kind = DEM_JOINT_REVOLUTE;
            desc.a = a;
            if (to == 1) desc.b = b;
            if (to == 2) desc.wall = wall;
            desc.axis = at(0, 0, 1);
            desc.motor = (dem_motor)motor;
            desc.torque = DEM_R(1e-6);
            desc.speed = 10;
            joint = dem_joint_add(world, &desc);
            for (i = 0; i < 10; i++) CHECK_EQ(scene_step(world, 1), DEM_OK);
            CHECK(told(world, joint).motor_torque > 0 && told(world, joint).power > 0);
            fix(world, a, 1, at(0, 0, 0));
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            before = dem_ledger_get(world);
            for (i = 0; i < 50; i++) CHECK_EQ(scene_step(world, 1), DEM_OK);
            after = dem_ledger_get(world);
            o = told(world, joint);
            CHECK(!(fabs((double)o.motor_torque) > 0) && !(fabs((double)o.power) > 0));
            CHECK(!(fabs((double)o.force.x) + fabs((double)o.torque.z) > 0));
            CHECK_NEAR(after.walls, before.walls, 0);
            CHECK_NEAR(after.residual, before.residual, 1e-18);
            fix(world, a, 0, at(0, 0, 0));
            for (i = 0; i < 10; i++) CHECK_EQ(scene_step(world, 1), DEM_OK);
            CHECK(told(world, joint).power > 0);
            dem_world_destroy(world);
        }
}
/* A ball on a joint to a wall that turns; the wall turns from the second step on. */
static void driven(void) {
    dem_material m;
    dem_world *world = jointed(0, 1e-3, 1, &m);
    dem_joint_desc desc = DEM_JOINT_DESC;
    dem_motion motion = DEM_MOTION;
    dem_ledger l;
    dem_joint joint;
    double gap = 0;
    int i;
    desc.kind = DEM_JOINT_POINT;
    desc.a = ball(world, m, 0.01, at(0.1, 0, 0));
    desc.point = at(0.08, 0, 0);
    desc.wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
    motion.kind = DEM_MOTION_ROTATING;
    motion.axis = at(0, 0, 1);
    motion.speed = 5;
    CHECK_EQ(dem_wall_motion_set(world, desc.wall, &motion), DEM_OK);
    joint = dem_joint_add(world, &desc);
    for (i = 0; i < 300; i++) {
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        if (i > 2) gap = fmax(gap, (double)told(world, joint).gap);
    }
    l = dem_ledger_get(world);
    CHECK(l.kinetic > 0 && l.walls > 0 && gap < 1e-8);
    CHECK_NEAR(l.residual, 0, 1e-9*l.throughput);
    dem_world_destroy(world);
}
/* Memory, and what a step goes through, after so many have come and gone. */
static void ids(void) {
    dem_material m;
    dem_world *world = jointed(g, 1e-3, 1, &m);
    const dem_body a = ball(world, m, 0.01, at(0, 0, 0));
    const dem_joint first = joined(world, a, nobody, at(0, 0, 0.01), at(0, 0, 0));
    size_t memory = 0;
    int32_t last = first.id;
    int i;
    for (i = 0; i < 4000; i++) {
        const dem_body b = ball(world, m, 0.01, at(0.05, 0, 0));
        const dem_joint joint = joined(world, b, a, at(0.025, 0, 0), at(0, 0, 0));
        CHECK(joint.id > last);                 /* never given twice */
        last = joint.id;
        if (i & 1) CHECK_EQ(dem_joint_remove(world, joint), DEM_OK);
        CHECK_EQ(dem_body_remove(world, b), DEM_OK);
        if (i % 100 == 99) CHECK_EQ(scene_step(world, 1), DEM_OK);
        if (i == 999) memory = dem_counters_get(world).memory;
    }
    CHECK(dem_counters_get(world).memory == memory);
    CHECK_EQ(world->joint_count, 1);
    CHECK((double)told(world, first).gap < 1e-9);
    dem_world_destroy(world);
}
static void gone(void) {
    int what;
    for (what = 0; what < 3; what++) {
        dem_material m;
        dem_world *world = jointed(g, 1e-3, 1, &m);
        const dem_wall wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
        const dem_body a = ball(world, m, 0.01, at(0, 0, 0)), b = ball(world, m, 0.01, at(0.03, 0, 0));
        dem_joint_desc desc = DEM_JOINT_DESC;
        dem_joint_state state;
        dem_joint joint;
        desc.kind = DEM_JOINT_POINT;
        desc.a = a;
        if (what < 2) desc.b = b;
        else desc.wall = wall;
        joint = dem_joint_add(world, &desc);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        if (what < 2) CHECK_EQ(dem_body_remove(world, what ? a : b), DEM_OK);
        else CHECK_EQ(dem_wall_remove(world, wall), DEM_OK);
        CHECK(dem_joint_get(world, joint, &state) == DEM_ERROR_ARGUMENT && strstr(dem_world_error_get(world), "joint 1"));
        CHECK(dem_joint_motor_set(world, joint, DEM_MOTOR_NONE, 0, 0) == DEM_ERROR_ARGUMENT);
        CHECK(dem_joint_remove(world, joint) == DEM_ERROR_ARGUMENT);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        dem_world_destroy(world);
    }
}
static void unused_values(void) {
    static const int32_t unused[] = {-1, 99};
    const char *path = "build/tmp/joints_own.ckpt";
    dem_material m;
    dem_world *world = jointed(g, 1e-3, 1, &m);
    const dem_body a = ball(world, m, 0.01, at(0, 0, 0)), b = ball(world, m, 0.01, at(0.03, 0, 0));
    dem_joint joint = {0};
    uint64_t hash;
    int i;
    for (i = 0; i < 2; i++) {
        dem_joint_desc desc = DEM_JOINT_DESC;
        desc.kind = DEM_JOINT_REVOLUTE;
        desc.a = a;
        desc.b = b;
        desc.wall.id = unused[i];
        desc.axis = at(0, 0, 1);
        joint = dem_joint_add(world, &desc);
        CHECK(joint.id);
        desc.motor = DEM_MOTOR_TORQUE;
        desc.torque = DEM_R(1e13);
        CHECK(!dem_joint_add(world, &desc).id && strstr(dem_world_error_get(world), "1e+12"));
        desc.b.slot = 0;                        /* now the wall counts */
        desc.torque = 0;
        CHECK(!dem_joint_add(world, &desc).id && strstr(dem_world_error_get(world), "wall"));
    }
    CHECK(dem_joint_motor_set(world, joint, DEM_MOTOR_SPEED, DEM_R(-2e12), 0) == DEM_ERROR_ARGUMENT);
    CHECK_EQ(scene_step(world, 3), DEM_OK);
    CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
    hash = dem_world_hash_get(world);
    CHECK_EQ(dem_checkpoint_read(world, path), DEM_OK);
    CHECK(dem_world_hash_get(world) == hash);
    dem_world_destroy(world);
}
/* Where a ball, which is joined to a plane that begins to rotate about `middle`, is after 40 steps, relative to it. */
static dem_vec3 led_round(dem_vec3 middle) {
    dem_joint_desc desc = DEM_JOINT_DESC;
    dem_motion motion = DEM_MOTION;
    dem_material m;
    dem_world *world = jointed(0, 2e-4, 1, &m);
    const dem_wall wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
    dem_vec3 x = middle;
    x.x += DEM_R(0.02);
    desc.kind = DEM_JOINT_POINT;
    desc.a = ball(world, m, 0.005, x);
    desc.wall = wall;
    desc.point = x;
    CHECK(dem_joint_add(world, &desc).id);
    motion.kind = DEM_MOTION_ROTATING;
    motion.point = middle;
    motion.axis = at(0, 0, 1);
    motion.speed = 100;
    motion.ramp = 0.005;
    CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
    CHECK_EQ(scene_step(world, 40), DEM_OK);
    x = scene_state(world, desc.a).position;
    dem_world_destroy(world);
    return at(x.x - middle.x, x.y - middle.y, x.z - middle.z);
}
/* Fifty balls on top of each other, and one sweep. */
static void short_of_sweeps(void) {
    int stops, i;
    for (stops = 0; stops < 2; stops++) {
        FILE *out = tmpfile();
        char text[400];
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc stuff = scene_stuff(0, 0, 0.5, 0);
        dem_world *world;
        dem_material m;
        dem_result result;
        int said = 0;
        desc.gravity.z = (dem_real)-g;
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = DEM_R(1e-3);
        desc.sweeps = 1;
        desc.threads = 1;
        desc.unsolved_stops = stops;
        world = dem_world_create(&desc);
        m = dem_material_add(world, &stuff);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        for (i = 0; i < 50; i++) ball(world, m, 0.01, at(0, 0, 0.01 + 0.02*i));
        result = dem_world_run(world, 0.02, dem_progress_print, out);
        CHECK_EQ(result, stops ? DEM_ERROR_STOPPED : DEM_OK);
        CHECK(dem_counters_get(world).unsolved > 0);
        if (stops) CHECK(strstr(dem_world_error_get(world), "1 sweeps left") && strstr(dem_world_error_get(world), "step 1:"));
        else scene_report_has(world, "did not reach their tolerance");
        rewind(out);
        while (fgets(text, sizeof text, out)) said |= strstr(text, "above the tolerance") != 0;
        CHECK(stops || said);
        fclose(out);
        dem_world_destroy(world);
    }
}

/* ---- a drum ---- */

enum { RING = 80, GRAINS = 60, DRUM_STEPS = 3000 };
typedef struct drum { dem_world *world; dem_joint joint; dem_wall wall; } drum;
static const double drum_radius = 0.05;         /* m */
static const double drum_spin = 4;              /* rad/s */

static drum drum_make(int body) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(0, 0, 0.5, 0);
    dem_material m, smooth;
    dem_real ring[3*RING], radii[RING];
    drum d;
    int i;
    memset(&d, 0, sizeof d);
    desc.gravity.y = (dem_real)-g;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = DEM_R(5e-4);
    desc.tolerance = DEM_R(2e-4);
    desc.sweeps = 100;
    desc.threads = 1;
    desc.ledger = 1;
    d.world = dem_world_create(&desc);
    m = dem_material_add(d.world, &stuff);
    stuff.friction = 0;
    smooth = dem_material_add(d.world, &stuff);
    for (i = 0; i < RING; i++) {
        ring[3*i] = (dem_real)(drum_radius*cos(round_angle*i/RING));
        ring[3*i + 1] = (dem_real)(drum_radius*sin(round_angle*i/RING));
        ring[3*i + 2] = 0;
        radii[i] = DEM_R(0.004);
    }
    dem_wall_plane_add(d.world, smooth, at(0, 0, -0.0055), at(0, 0, 1));
    dem_wall_plane_add(d.world, smooth, at(0, 0, 0.0055), at(0, 0, -1));
    CHECK_EQ(dem_spheres_fill(d.world, m, DEM_R(0.003),
                              dem_region_make(dem_box_make(DEM_R(-0.033), DEM_R(-0.033), DEM_R(-0.0055), DEM_R(0.033), DEM_R(0.033), DEM_R(0.0055))),
                              GRAINS, 7), GRAINS);
    if (body) {
        dem_cluster_desc cluster = DEM_CLUSTER_DESC;
        dem_joint_desc joint = DEM_JOINT_DESC;
        dem_shape shape;
        cluster.count = RING;
        cluster.positions = ring;
        cluster.radii = radii;
        shape = dem_shape_cluster_add(d.world, &cluster);
        joint.kind = DEM_JOINT_REVOLUTE;
        joint.motor = DEM_MOTOR_SPEED;
        joint.a = dem_body_add(d.world, m, shape, at(0, 0, 0), dem_quat_make(1, 0, 0, 0));
        joint.axis = at(0, 0, 1);
        joint.speed = (dem_real)drum_spin;
        d.joint = dem_joint_add(d.world, &joint);
    } else {
        dem_motion motion = DEM_MOTION;
        d.wall = dem_wall_grains_add(d.world, m, RING, ring, DEM_R(0.004), 1);
        motion.kind = DEM_MOTION_ROTATING;
        motion.axis = at(0, 0, 1);
        motion.speed = (dem_real)drum_spin;
        CHECK_EQ(dem_wall_motion_set(d.world, d.wall, &motion), DEM_OK);
    }
    return d;
}

static void drums(void) {
    double torque[2], power[2];
    int body, i;
    for (body = 0; body < 2; body++) {
        const drum d = drum_make(body);
        double sum = 0, work = 0;
        CHECK(d.world && (d.joint.id || d.wall.id));
        for (i = 0; i < DRUM_STEPS; i++) {
            CHECK_EQ(scene_step(d.world, 1), DEM_OK);
            if (i < DRUM_STEPS/3) continue;
            if (body) {
                sum += (double)told(d.world, d.joint).motor_torque;
                work += (double)told(d.world, d.joint).power;
            } else {
                dem_wall_loads loads;
                CHECK_EQ(dem_wall_loads_get(d.world, d.wall, &loads), DEM_OK);
                sum -= (double)loads.torque_axial;
                work += (double)loads.power;
            }
        }
        torque[body] = sum/(DRUM_STEPS*2/3);
        power[body] = work/(DRUM_STEPS*2/3);
        if (body) {
            const dem_joint_state state = told(d.world, d.joint);
            CHECK_NEAR(state.turned, drum_spin*dem_world_time_get(d.world), 1e-9);
            CHECK((double)state.gap < 1e-5 && (double)state.tilt < 1e-5);
        }
        CHECK(ledger_off(d.world) < 0.02);
        dem_world_destroy(d.world);
    }
    CHECK(torque[0] > 0);
    CHECK_NEAR(torque[1], torque[0], 0.05*torque[0]);
    CHECK_NEAR(power[0], drum_spin*torque[0], 1e-9*power[0]);   /* the wall; the motor's has what drift gives, too */
    CHECK_NEAR(power[1], drum_spin*torque[1], 1e-5*power[1]);
}

static void refuses(void) {
    dem_world_desc springs = DEM_WORLD_DESC;
    dem_material m, steel;
    dem_material_desc stuff = scene_stuff(1e7, 0.5, 0.5, 0);
    dem_world *world = jointed(g, 1e-3, 1, &m), *other = dem_world_create(&springs), *still;
    const dem_body a = ball(world, m, 0.01, at(0, 0, 0)), b = ball(world, m, 0.01, at(0.03, 0, 0));
    dem_joint_desc desc = DEM_JOINT_DESC;
    dem_joint_state state;
    dem_joint joint;
    desc.a = a;
    CHECK(!dem_joint_add(world, &desc).id && strstr(dem_world_error_get(world), "kind is 0"));
    desc.kind = DEM_JOINT_REVOLUTE;
    CHECK(!dem_joint_add(world, &desc).id && strstr(dem_world_error_get(world), "axis"));
    desc.axis = at(0, 0, 1);
    desc.b = a;
    CHECK(!dem_joint_add(world, &desc).id && strstr(dem_world_error_get(world), "they are the same"));
    desc.b = nobody;
    desc.wall.id = 3;
    CHECK(!dem_joint_add(world, &desc).id && strstr(dem_world_error_get(world), "wall 3"));
    desc.wall.id = 0;
    desc.motor = DEM_MOTOR_SPEED;
    desc.torque = -1;
    CHECK(!dem_joint_add(world, &desc).id && strstr(dem_world_error_get(world), "motor is 1"));
    desc.torque = 0;
    desc.b = b;
    joint = dem_joint_add(world, &desc);
    CHECK(joint.id == 1);
    springs.response = DEM_RESPONSE_IMPULSES;
    springs.dt = DEM_R(1e-3);
    still = dem_world_create(&springs);
    desc.a = ball(still, dem_material_add(still, &stuff), 0.01, at(0, 0, 0));
    desc.b = nobody;
    CHECK(!dem_joint_add(still, &desc).id && strstr(dem_world_error_get(still), "orientations"));
    dem_world_destroy(still);
    steel = dem_material_add(other, &stuff);
    desc.a = ball(other, steel, 0.01, at(0, 0, 0));
    desc.b = nobody;
    CHECK(!dem_joint_add(other, &desc).id && strstr(dem_world_error_get(other), "contacts of this world are springs"));
    CHECK_EQ(scene_step(world, 1), DEM_OK);
    CHECK_EQ(dem_body_remove(world, b), DEM_OK);
    CHECK_EQ(scene_step(world, 1), DEM_OK);
    CHECK(dem_joint_get(world, joint, &state) == DEM_ERROR_ARGUMENT && strstr(dem_world_error_get(world), "joint 1"));
    CHECK(dem_joint_motor_set(world, joint, DEM_MOTOR_NONE, 0, 0) == DEM_ERROR_ARGUMENT);
    CHECK(dem_joint_remove(world, joint) == DEM_ERROR_ARGUMENT);
    dem_world_destroy(world);
    dem_world_destroy(other);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("joints: a sphere on a ball joint swings with the period of a compound pendulum, within 2e-4, for 20 swings")
        swings();
    TEST("joints: a fast top precesses by m g l over its angular momentum (Goldstein 5.7)")
        precesses();
    TEST("joints: each joint of a chain carries the weights below it, and a motor at rest holds a beam by its weight "
         "times its arm")
        hangs();
    TEST("joints: a motor drives at its torque, or up to its speed with at most its torque, and the ledger has its "
         "work")
        turns();
    TEST("joints: between free bodies they conserve momenta to round-off, and energy within 0.5 %")
        keeps();
    TEST("joints: forces of swinging chains follow their equations of motion in every step, and add no energy")
        smooth();
    TEST("joints: a motor-driven drum takes the torque and power of the same drum moved as a wall")
        drums();
    TEST("joints: impossible joints are rejected with an error message, and a joint is removed with its bodies")
        refuses();
    TEST("joints: a chain of five hinged boxes that folds up gains no energy, with 1 sweep or 200")
        folds();
    TEST("joints: a chain of 1,000 links holds every gap within 1e-6 of a link, thrown or hung up")
        long_chains();
    TEST("joints: an overconstrained closed loop of parallel hinges moves and stays closed")
        loops();
    TEST("joints: a motor between fixed bodies has no torque, power or work until one is freed")
        fixed_bodies();
    TEST("joints: a moving wall does work on the bodies joined to it, and the ledger has it")
        driven();
    TEST("joints: a wall that begins to rotate leads a ball alike wherever its axis is") {
        const dem_vec3 near_by = led_round(at(0, 0, 0)), far = led_round(at(0.5, -0.25, 0.125));
        const double eps = sizeof(dem_real) == 8 ? 1e-12 : 1e-6;
        CHECK_NEAR(far.x, near_by.x, eps);
        CHECK_NEAR(far.y, near_by.y, eps);
        CHECK_NEAR(far.z, near_by.z, eps);
        CHECK(near_by.y > 0.005);
    }
    TEST("joints: 4,000 joints and bodies added and removed leave memory and cost of a step unchanged")
        ids();
    TEST("joints: a joint ends with its body or wall, and its id is invalid at once")
        gone();
    TEST("joints: unused ids may have any value, torques beyond 1e12 N m are rejected, and checkpoints can be read")
        unused_values();
    TEST("impulses: steps above tolerance are counted, printed with progress, and end a run on request")
        short_of_sweeps();
    return test_end();
}
