/* Rigid grains, kept apart by impulses (desc.response). Outside numbers:
     Tasora & Anitescu, Int. J. Numer. Methods Eng. 81 (2010): the convex law opens by mu v dt
     Chrono's unit tests: balls on a bin weigh what they weigh; stacks of spheres stand
   Blocks are clusters of spheres at the corners of boxes. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const double g = 9.81;                   /* m/s2 */
static const double exact = sizeof(dem_real) == 4 ? 1e-4 : 1e-9;    /* round-off of some hundred steps */

static dem_world *rigid(double gravity, double dt, double restitution, double friction, dem_cone cone, int threads,
                        dem_material *m) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material_desc stuff = scene_stuff(0, restitution, friction, 0);
    desc.gravity.z = (dem_real)-gravity;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = (dem_real)dt;
    desc.cone = cone;
    desc.tolerance = DEM_R(1e-11);
    desc.sweeps = 20000;
    desc.ledger = 1;
    desc.threads = threads;
    world = dem_world_create(&desc);
    *m = dem_material_add(world, &stuff);
    return world;
}
/* A box of edges a, b, c (m) that stands on four (of eight) spheres of radius r at its corners. */
static dem_shape block(dem_world *world, double a, double b, double c, double r) {
    dem_cluster_desc desc = DEM_CLUSTER_DESC;
    dem_real places[24], radii[8];
    int k;
    for (k = 0; k < 8; k++) {
        places[3*k] = (dem_real)((k & 1 ? 0.5 : -0.5)*(a - 2*r));
        places[3*k + 1] = (dem_real)((k & 2 ? 0.5 : -0.5)*(b - 2*r));
        places[3*k + 2] = (dem_real)((k & 4 ? 0.5 : -0.5)*(c - 2*r));
        radii[k] = (dem_real)r;
    }
    desc.count = 8;
    desc.positions = places;
    desc.radii = radii;
    return dem_shape_cluster_add(world, &desc);
}
/* A block at rest on a slope of this angle, given by the direction of gravity. Its speed downhill after a time. */
static double slides(double angle, double friction, double width, double height, double seconds, double *spin) {
    dem_material m;
    dem_world *world = rigid(0, 1e-3, 0, friction, DEM_CONE_COULOMB, 1, &m);
    dem_body body;
    dem_body_state s;
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    body = dem_body_add(world, m, block(world, width, width, height, 0.1*width), at(0, 0, height/2),
                        dem_quat_make(1, 0, 0, 0));
    dem_world_gravity_set(world, at(g*sin(angle), 0, -g*cos(angle)));
    CHECK_EQ(dem_world_run(world, seconds, 0, 0), DEM_OK);
    s = scene_state(world, body);
    if (spin) *spin = (double)s.spin.y;
    dem_world_destroy(world);
    return (double)s.velocity.x;
}
/* Three discs, two on a floor that touch and one in the groove: by how much the lower ones have come apart, m. */
static double pyramid(double between, double floor) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material_desc stuff = scene_stuff(0, 0, between, 0);
    dem_material disc, ground;
    dem_pair pair;
    dem_body left, right;
    double apart;
    desc.planar = 1;
    desc.gravity.y = (dem_real)-g;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = DEM_R(1e-3);
    desc.tolerance = DEM_R(1e-10);
    desc.sweeps = 20000;
    world = dem_world_create(&desc);
    disc = dem_material_add(world, &stuff);
    ground = dem_material_add(world, &stuff);
    dem_pair_get(world, disc, ground, &pair);
    pair.friction = (dem_real)floor;
    dem_pair_set(world, disc, ground, &pair);
    dem_wall_plane_add(world, ground, at(0, 0, 0), at(0, 1, 0));
    left = dem_sphere_add(world, disc, DEM_R(0.1), at(-0.1, 0.1, 0));
    right = dem_sphere_add(world, disc, DEM_R(0.1), at(0.1, 0.1, 0));
    dem_sphere_add(world, disc, DEM_R(0.1), at(0, 0.1 + 0.1*sqrt(3.0), 0));
    CHECK_EQ(dem_world_run(world, 1, 0, 0), DEM_OK);
    apart = (double)(scene_state(world, right).position.x - scene_state(world, left).position.x) - 0.2;
    dem_world_destroy(world);
    return apart;
}
/* Grains of all kinds that fall into a drum which turns. */
static dem_world *drum(int grains) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(0, 0.3, 0.4, 0.05);
    dem_motion turning = DEM_MOTION;
    dem_world *world;
    dem_material m;
    dem_wall shell;
    dem_shape shapes[2];
    int k;
    desc.gravity.z = (dem_real)-g;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = DEM_R(5e-4);
    desc.ledger = 1;
    desc.threads = 1;
    world = dem_world_create(&desc);
    m = dem_material_add(world, &stuff);
    shell = dem_wall_cylinder_add(world, m, at(0, 0, 0), at(0, 1, 0), DEM_R(0.05), 1);
    turning.kind = DEM_MOTION_ROTATING;
    turning.axis = at(0, 1, 0);
    turning.speed = 5;
    dem_wall_motion_set(world, shell, &turning);
    dem_wall_plane_add(world, m, at(0, -0.015, 0), at(0, 1, 0));
    dem_wall_plane_add(world, m, at(0, 0.015, 0), at(0, -1, 0));
    shapes[0] = dem_shape_ellipsoid_add(world, at(0.003, 0.002, 0.0025));
    shapes[1] = block(world, 0.006, 0.004, 0.004, 0.001);
    for (k = 0; k < 2; k++)
        dem_bodies_fill(world, m, shapes[k],
                        dem_region_make(box_of(-0.035, -0.015, -0.035, 0.035, 0.015, 0.035)), grains/8,
                        (uint64_t)k + 1);
    dem_spheres_fill(world, m, DEM_R(0.002),
                     dem_region_make(box_of(-0.035, -0.015, -0.035, 0.035, 0.015, 0.035)), grains, 3);
    return world;
}

/* --- order of a step: the same motion in steps of h and h/2, against one in steps of h/16 --- */

enum { TUBE_SLIDES, TUBE_ROLLS, TUBE_FAST, BALL_SLIDES, BALL_ROLLS, WALL_SHAKES, EGG_ROCKS, HINGE, TWO_LINKS, CORIOLIS, ORDERS };
static const char *const order_names[ORDERS] = {"sliding in a tube", "rolling in a tube", "rolling round in a tube",
    "sliding off a ball", "rolling off a ball", "carried by a shaken floor", "ellipsoid rocking without friction",
    "pendulum on a hinge", "double pendulum of ball joints", "Coriolis force on a floor"};
static void order_shake(double time, dem_pose *pose, void *user) {
    (void)user;
    pose->position = at(0.002*sin(40*time), 0, 0.002*sin(30*time));
    pose->velocity = at(0.08*cos(40*time), 0, 0.06*cos(30*time));
    pose->spin = at(0, 0, 0);
}
static dem_vec3 order_coriolis(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    (void)x; (void)radius; (void)time; (void)user;
    return dem_vec3_make(10*mass*v.y, -10*mass*v.x, 0);
}
/* Where the body is in the end, and the kinetic energy (J), in steps of dt. */
static dem_vec3 order_run(int scene, double dt, double *energy) {
    const double gravity = scene == TUBE_FAST ? 0 : 9.81, friction = scene == TUBE_ROLLS || scene == TUBE_FAST ||
        scene == BALL_ROLLS || scene == WALL_SHAKES ? 0.9 : 0, seconds = scene == CORIOLIS ? 1 : 0.25;
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(0, 0, friction, 0);
    dem_joint_desc joint = DEM_JOINT_DESC;
    dem_motion motion = DEM_MOTION;
    dem_world *world;
    dem_material m;
    dem_body body;
    dem_body_state s;
    dem_ledger ledger;
    dem_vec3 x;
    desc.gravity.z = (dem_real)-gravity;
    desc.response = DEM_RESPONSE_IMPULSES;
    desc.dt = (dem_real)dt;
    desc.tolerance = DEM_R(1e-12);
    desc.sweeps = 2000;
    desc.orientations = desc.ledger = desc.threads = 1;
    if (scene == CORIOLIS) desc.force = order_coriolis;
    world = dem_world_create(&desc);
    m = dem_material_add(world, &stuff);
    if (scene <= TUBE_FAST) {
        dem_wall_cylinder_add(world, m, at(0, 0, 0), at(0, 1, 0), DEM_R(0.1), 1);
        body = dem_sphere_add(world, m, DEM_R(0.01), at(0.09*sin(1.), 0, -0.09*cos(1.)));
        if (scene == TUBE_FAST) scene_move(world, body, at(-3.6*cos(1.), 0, -3.6*sin(1.)), at(0, -360, 0));
    } else if (scene <= BALL_ROLLS) {
        body = dem_sphere_add(world, m, DEM_R(0.3), at(0, 0, 0));
        s = scene_state(world, body);
        s.fixed = 1;
        dem_body_set(world, body, &s);
        body = dem_sphere_add(world, m, DEM_R(0.1), at(0.4*sin(0.3), 0, 0.4*cos(0.3)));
    } else if (scene == WALL_SHAKES || scene == CORIOLIS || scene == EGG_ROCKS) {
        const dem_wall floor = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        if (scene == EGG_ROCKS) body = dem_body_add(world, m, dem_shape_ellipsoid_add(world, at(0.02, 0.01, 0.01)),
            at(0, 0, sqrt(pow(0.02*sin(0.6), 2) + pow(0.01*cos(0.6), 2))), dem_quat_make(DEM_R(0.955336489125606), 0,
                                                                                    DEM_R(0.2955202066613396), 0));
        else body = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
        if (scene == CORIOLIS) scene_move(world, body, at(1, 0, 0), at(0, 0, 0));
        if (scene == WALL_SHAKES) {
            motion.kind = DEM_MOTION_USER;
            motion.function = order_shake;
            CHECK_EQ(dem_wall_motion_set(world, floor, &motion), DEM_OK);
            scene_move(world, body, at(0, 0, 0.06), at(0, 0, 0));
        }
    } else {
        joint.kind = scene == HINGE ? DEM_JOINT_REVOLUTE : DEM_JOINT_POINT;
        joint.axis = scene == HINGE ? at(0, 1, 0) : at(0, 0, 0);
        body = joint.a = dem_sphere_add(world, m, DEM_R(0.05), at(0.2*sin(1.), 0, -0.2*cos(1.)));
        dem_joint_add(world, &joint);
        if (scene == TWO_LINKS) {
            joint.b = body;
            joint.point = at(0.2*sin(1.) + 0.1, 0, -0.2*cos(1.));
            body = joint.a = dem_sphere_add(world, m, DEM_R(0.05), at(0.2*sin(1.) + 0.2, 0, -0.2*cos(1.)));
            dem_joint_add(world, &joint);
        }
    }
    CHECK_EQ(scene_step(world, (int)(seconds/dt + 0.5)), DEM_OK);
    x = scene_state(world, body).position;
    ledger = dem_ledger_get(world);
    *energy = ledger.kinetic + ledger.rotational;
    dem_world_destroy(world);
    return x;
}
/* Errors of place (m) and of kinetic energy (parts) in steps of `dt` and half of it; the order of the place. */
static double order_of(int scene, double dt, double error[2], double part[2]) {
    double e[3];
    dem_vec3 x[3];
    int k;
    for (k = 0; k < 3; k++) x[k] = order_run(scene, k < 2 ? dt/(k + 1) : dt/16, &e[k]);
    for (k = 0; k < 2; k++) {
        error[k] = sqrt(pow((double)(x[k].x - x[2].x), 2) + pow((double)(x[k].y - x[2].y), 2) +
                        pow((double)(x[k].z - x[2].z), 2));
        part[k] = fabs(e[k]/e[2] - 1);
    }
    return log(error[0]/error[1])/log(2.);
}

/* Work of force fields: gravity as a field, and a constant force and torque. */
static dem_vec3 field_weight(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    (void)x; (void)v; (void)radius; (void)time; (void)user;
    return at(0, 0, -g*(double)mass);
}
static void field_wrench(const dem_body_state *body, dem_body id, double time, dem_vec3 *force, dem_vec3 *torque,
                         void *user) {
    (void)id; (void)time; (void)user;
    *force = at(0.5*(double)body->mass, 0, 0);
    *torque = at(0, 30*(double)body->inertia, 0);
}
/* In the plane a slope of 0.2; out of it user[0], m/s2. */
static dem_vec3 field_oblique(dem_vec3 x, dem_vec3 v, dem_real radius, dem_real mass, double time, void *user) {
    (void)x; (void)v; (void)radius; (void)time;
    return at(0.2*g*(double)mass, 0, *(const double *)user*(double)mass);
}
static void field_askew(const dem_body_state *body, dem_body id, double time, dem_vec3 *force, dem_vec3 *torque,
                        void *user) {
    const double a = *(const double *)user*(double)body->mass*(double)body->radius;
    (void)id; (void)time;
    *force = at(0, 0, a);
    *torque = at(a, a, 0);
}
/* Keeps the largest distance, m, of the position that the function receives from that of a flight at 2 m/s. */
static void reals_late(dem_real *reals, const dem_real *rates, const dem_body_state *body, dem_body id, double time,
                       dem_real dt, void *user) {
    double *worst = (double *)user;
    (void)rates; (void)id; (void)dt;
    *worst = fmax(*worst, fabs((double)body->position.x - 2*time));
    reals[0] = body->position.x;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("impulses: a sphere leaves a wall and another sphere with -e times its approach speed, to round-off, for e "
         "from 0 to 1") {
        int k, both;
        for (k = 0; k <= 10; k++)
            for (both = 0; both < 2; both++) {
                dem_material m;
                dem_world *world = rigid(0, 1e-3, 0.1*k, 0.5, DEM_CONE_COULOMB, 1, &m);
                dem_body a, b = {0, 0};
                dem_totals t;
                if (both) b = dem_sphere_add(world, m, DEM_R(0.008), at(0, 0, 0));
                else dem_wall_plane_add(world, m, at(0, 0, 0.008), at(0, 0, 1));
                a = dem_sphere_add(world, m, DEM_R(0.005), at(0, 0, 0.0301));
                scene_move(world, a, at(0, 0, -2), at(0, 0, 0));
                t = dem_totals_get(world);
                CHECK_EQ(scene_step(world, 30), DEM_OK);
                CHECK_NEAR(scene_state(world, a).velocity.z - (both ? scene_state(world, b).velocity.z : 0), 0.2*k, 1e-13);
                CHECK_NEAR(dem_ledger_get(world).residual, 0, 1e-14);
                if (both) CHECK_NEAR(dem_totals_get(world).momentum[2], t.momentum[2], 1e-15);
                CHECK((double)dem_counters_get(world).overlap_max < 1e-12);
                dem_world_destroy(world);
            }
    }
    TEST("impulses: a sliding sphere rolls at 5/7 of its speed; Coulomb's law keeps it on the floor, the convex one "
         "lifts it mu v dt") {
        int cone;
        for (cone = 0; cone < 2; cone++) {
            dem_material m;
            dem_world *world = rigid(g, 1e-3, 0, 0.3, (dem_cone)cone, 1, &m);
            dem_body ball;
            dem_body_state s;
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            ball = dem_sphere_add(world, m, DEM_R(0.005), at(0, 0, 0.005));
            scene_move(world, ball, at(1, 0, 0), at(0, 0, 0));
            CHECK_EQ(scene_step(world, 50), DEM_OK);
            s = scene_state(world, ball);
            /* places are those of the step, slip that of its beginning */
            if (cone) CHECK_REL(s.position.z - 0.005, 0.3*1e-3*(double)(s.velocity.x - s.spin.y*DEM_R(0.005)), 0.05);
            else CHECK_NEAR(s.position.z, 0.005, 1e-9);
            CHECK_EQ(scene_step(world, 450), DEM_OK);
            s = scene_state(world, ball);
            CHECK_REL(s.velocity.x, 5.0/7, 1e-9);
            CHECK_REL(s.spin.y*DEM_R(0.005), 5.0/7, 1e-9);
            CHECK_NEAR(s.position.z, 0.005, 1e-9);
            CHECK_REL(dem_ledger_get(world).slide, dem_totals_get(world).mass*(1 - 25.0/49 - 10.0/49)/2, 1e-6);
            dem_world_destroy(world);
        }
    }
    TEST("impulses: a block sticks on a slope up to atan mu, slides at g (sin - mu cos) above, and tips at b/h if "
         "twice as high") {
        const double pi = 3.14159265358979, limit = atan(0.5), part = 0.05*pi/180;
        double spin;
        CHECK_NEAR(slides(limit - part, 0.5, 0.1, 0.05, 0.2, 0), 0, 1e-7);
        CHECK(slides(limit + part, 0.5, 0.1, 0.05, 0.2, 0) > 1e-4);
        CHECK_REL(slides(0.7, 0.5, 0.1, 0.05, 0.2, 0), 0.2*g*(sin(0.7) - 0.5*cos(0.7)), 1e-3);
        /* the feet stand 0.8 of the width apart, the centre is half of the height up */
        slides(atan(0.4) - 0.2*pi/180, 2, 0.1, 0.2, 0.2, &spin);
        CHECK_NEAR(spin, 0, 1e-6);
        slides(atan(0.4) + 0.2*pi/180, 2, 0.1, 0.2, 0.2, &spin);
        CHECK(spin > 1e-3);
    }
    TEST("impulses: motion by more than a radius per step is rejected, unless law_range is twice that distance") {
        int k;
        for (k = 0; k < 2; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = scene_stuff(0, 0, 0, 0);
            dem_material m;
            dem_world *world;
            dem_body ball;
            desc.response = DEM_RESPONSE_IMPULSES;
            desc.dt = DEM_R(1e-3);
            desc.law_range = k ? DEM_R(0.01) : DEM_R(0.001);
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            ball = dem_sphere_add(world, m, DEM_R(0.0005), at(0, 0, 0.02));
            scene_move(world, ball, at(0, 0, -4), at(0, 0, 0));
            if (k) {
                CHECK_EQ(scene_step(world, 10), DEM_OK);
                CHECK_NEAR((double)scene_state(world, ball).position.z, 0.0005, 1e-8);
            } else {
                CHECK_EQ(dem_world_step(world, 10), DEM_ERROR_TIME_STEP);
                CHECK_STR(dem_world_error_get(world), "law_range of twice that distance");
            }
            dem_world_destroy(world);
        }
    }
    TEST("impulses: a sphere that was just given 0.5 radii per step does not enter a wall 0.2 radii away") {
        int how;
        for (how = 0; how < 3; how++) {         /* the lists of the first step must know the new speed */
            const double r = 0.005, v = 0.5*r/1e-3;
            const dem_real x[3] = {0, 0, DEM_R(1.2*0.005)}, fast[3] = {0, 0, (dem_real)-v};
            dem_material m;
            dem_world *world = rigid(0, 1e-3, 1, 0, DEM_CONE_COULOMB, 1, &m);
            const dem_selection all = DEM_SELECTION;
            dem_body ball;
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            CHECK_EQ(dem_spheres_add(world, m, 1, x, how ? 0 : fast, 0, (dem_real)r), DEM_OK);
            ball = dem_body_id_get(world, 0);
            if (how) CHECK_EQ(scene_step(world, 3), DEM_OK);
            if (how == 1) scene_move(world, ball, at(0, 0, -v), at(0, 0, 0));
            if (how == 2) CHECK_EQ(dem_bodies_velocity_set(world, &all, at(0, 0, -v), at(0, 0, 0)), 1);
            CHECK_EQ(scene_step(world, 6), DEM_OK);
            CHECK((double)dem_counters_get(world).overlap_max < exact);
            CHECK_REL(scene_state(world, ball).velocity.z, v, exact);
            dem_world_destroy(world);
        }
    }
    TEST("two spheres at the same position stop the run as unstable, with springs and with impulses") {
        int impulses;
        for (impulses = 0; impulses < 2; impulses++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material m;
            int k;
            if (impulses) {
                desc.response = DEM_RESPONSE_IMPULSES;
                desc.dt = DEM_R(1e-3);
            }
            world = dem_world_create(&desc);
            m = scene_material(world, 1e7, 0.5, 0.3, 0);
            for (k = 0; k < 2; k++) dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0));
            CHECK_EQ(dem_world_step(world, 10), DEM_ERROR_UNSTABLE);
            CHECK_STR(dem_world_error_get(world), "overlap by 2");
            dem_world_destroy(world);
        }
    }
    TEST("impulses: a block that slides at 5 m/s with mu 0.5 stops after 2.54842 m and 1.01937 s") {
        dem_material m;
        dem_world *world = rigid(g, 1e-3, 0, 0.5, DEM_CONE_COULOMB, 1, &m);
        dem_body body;
        double stopped = 0;
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        body = dem_body_add(world, m, block(world, 0.4, 0.4, 0.05, 0.01), at(0, 0, 0.025), dem_quat_make(1, 0, 0, 0));
        scene_move(world, body, at(5, 0, 0), at(0, 0, 0));
        while (dem_world_time_get(world) < 1.2) {
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            if (scene_state(world, body).velocity.x > DEM_R(1e-6)) stopped = dem_world_time_get(world);
        }
        CHECK_NEAR(stopped, 1.01937, 2e-3);
        CHECK_REL(scene_state(world, body).position.x, 2.54842, 1.5e-3);
        CHECK_NEAR(scene_state(world, body).velocity.x, 0, 1e-9);
        dem_world_destroy(world);
    }
    TEST("impulses: eight balls in a bin load it with their weight and rest") {
        dem_material m;
        dem_world *world = rigid(g, 5e-3, 0, 0.4, DEM_CONE_COULOMB, 1, &m);
        dem_wall_loads loads;
        dem_wall floor = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        int k;
        for (k = 0; k < 8; k++) dem_sphere_add(world, m, DEM_R(0.05), at(0.2*(k%4), 0.2*(k/4), 0.06));
        CHECK_EQ(dem_world_run(world, 0.25, 0, 0), DEM_OK);
        for (k = 0; k < 50; k++) {
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            CHECK_EQ(dem_wall_loads_get(world, floor, &loads), DEM_OK);
            CHECK_REL(-loads.force.z, dem_totals_get(world).mass*g, 1e-9);
        }
        CHECK(dem_totals_get(world).kinetic < 1e-12);
        dem_world_destroy(world);
    }
    TEST("impulses: stacks of 5, 10 and 50 spheres of 1 m are stable for 10 s without drift or spin, and contacts "
         "carry the weight") {
        static const int counts[3] = {5, 10, 50};
        int l, k;
        for (l = 0; l < 3; l++) {
            dem_material m;
            dem_world *world = rigid(g, 1e-2, 0, 0.5, DEM_CONE_COULOMB, 1, &m);
            dem_contact_info info[64];
            dem_body_state s;
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            for (k = 0; k < counts[l]; k++) dem_sphere_add(world, m, 1, at(0, 0, 1 + 2*k));
            CHECK_EQ(dem_world_run(world, 10, 0, 0), DEM_OK);
            CHECK(dem_totals_get(world).kinetic/dem_totals_get(world).mass < 1e-12);
            for (k = 0; k < counts[l]; k++) {
                s = scene_state(world, dem_body_id_get(world, k));
                CHECK(fabs((double)s.position.x) < 1e-6 && fabs((double)s.position.y) < 1e-6);
                CHECK((double)(s.spin.x*s.spin.x + s.spin.y*s.spin.y + s.spin.z*s.spin.z) < 1e-12);
                CHECK_NEAR(fmod((double)s.position.z, 2), 1, 1e-5);
            }
            CHECK_EQ(dem_contacts_get(world, info, 64), counts[l]);
            dem_world_destroy(world);
        }
    }
    TEST("impulses: a pyramid of three discs is stable with friction 2 - sqrt 3 in it and 0.0893 below, and falls "
         "with 2 % less") {
        const double between = 2 - sqrt(3.0), floor = 0.0893164;
        CHECK_NEAR(pyramid(1.02*between, 1.02*floor), 0, 1e-4);
        CHECK(pyramid(0.98*between, 1.02*floor) > 1e-2);
        CHECK(pyramid(1.02*between, 0.98*floor) > 1e-2);
    }
    TEST("impulses: a ball a thousand times as heavy rests on a light one, and a light one on it") {
        int up;
        for (up = 0; up < 2; up++) {
            dem_material m;
            dem_world *world = rigid(g, 1e-3, 0, 0.5, DEM_CONE_COULOMB, 1, &m);
            const double below = up ? 0.001 : 0.01, above = up ? 0.01 : 0.001;
            dem_body top;
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            dem_sphere_add(world, m, (dem_real)below, at(0, 0, below));
            top = dem_sphere_add(world, m, (dem_real)above, at(0, 0, 2*below + above));
            CHECK_EQ(scene_step(world, 2000), DEM_OK);
            CHECK_NEAR(scene_state(world, top).position.z, 2*below + above, 1e-8);
            CHECK(dem_counters_get(world).unsolved <= 1);              /* the first step, which remembers nothing */
            dem_world_destroy(world);
        }
    }
    TEST("impulses: in 20,000 random impacts of two spheres energy never rises, momenta hold to round-off, the ledger "
         "closes") {
        uint64_t random = 7;
        double most = -1, off = 0, left = 0;
        int k, i;
        for (k = 0; k < 20000; k++) {
            dem_material m;
            dem_world *world = rigid(0, 2e-4, scene_random(&random), scene_random(&random), (dem_cone)(k%2), 1, &m);
            dem_totals before, after;
            for (i = 0; i < 2; i++) {
                const dem_body ball = dem_sphere_add(world, m, (dem_real)(0.002 + 0.02*scene_random(&random)),
                                                     at(i ? 0.05 : 0, 0.01*scene_random(&random), 0));
                scene_move(world, ball, scene_at(&random, 1, i ? -2 : 1, 1, -0.5, 1, -0.5),
                           scene_at(&random, 200, -100, 200, -100, 200, -100));
            }
            before = dem_totals_get(world);
            if (scene_step(world, 150) != DEM_OK) { CHECK(0); dem_world_destroy(world); break; }
            after = dem_totals_get(world);
            most = fmax(most, (after.kinetic + after.rotational)/(before.kinetic + before.rotational) - 1);
            left = fmax(left, fabs(dem_ledger_get(world).residual)/(before.kinetic + before.rotational));
            for (i = 0; i < 3; i++) {
                off = fmax(off, fabs(after.momentum[i] - before.momentum[i])/before.mass);
                off = fmax(off, fabs(after.angular[i] - before.angular[i])/before.mass);
            }
            dem_world_destroy(world);
        }
        CHECK(most < 1e-13);
        CHECK(left < 1e-12);
        CHECK_NEAR(off, 0, 1e-13);
    }
    TEST("impulses: a corner that leaves the floor while another one hits it does not give the cube energy") {
        /* 0.7 % before: the impact throws the first corner back, and the floor must not stop it at a lower speed */
        dem_material m;
        dem_world *world = rigid(0, 1e-4, 1, 0, DEM_CONE_COULOMB, 1, &m);
        dem_real corners[24];
        dem_totals before, after;
        dem_body cube;
        int k;
        for (k = 0; k < 24; k++) corners[k] = (dem_real)(k/3 >> k%3 & 1 ? 1.5e-3 : -1.5e-3);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 1, 0));
        cube = dem_body_add(world, m, dem_shape_polyhedron_add(world, 8, corners),
                            at(2.5511509824517801e-05, 0.001802258796961366, 5.9082572810084658e-05),
                            dem_quat_make(DEM_R(0.33188137152246849), DEM_R(0.040451932597704403),
                                          DEM_R(-0.9422776439771422), DEM_R(0.018199946328551955)));
        scene_move(world, cube, at(-0.035885107097084493, -0.97319408881114922, 0.11237330090289091),
                   at(6.1205380159238505, -2.9927923206877995, -19.531059083163427));
        before = dem_totals_get(world);
        CHECK_EQ(scene_step(world, 8), DEM_OK);
        after = dem_totals_get(world);
        CHECK_NEAR((after.kinetic + after.rotational)/(before.kinetic + before.rotational), 1, 1e-12);
        CHECK(after.momentum[1] > 0);
        dem_world_destroy(world);
    }
    TEST("impulses: in a drum with grains of all kinds the power of the wall becomes heat") {
        dem_world *world = drum(200);
        dem_ledger l;
        CHECK_EQ(scene_step(world, 200), DEM_OK);
        CHECK(dem_counters_get(world).contacts > 50);
        CHECK(dem_counters_get(world).sweeps > 0);
        l = dem_ledger_get(world);
        CHECK(l.walls > 0);
        CHECK_NEAR(l.residual/l.throughput, 0, 0.02);
        dem_world_destroy(world);
    }
    TEST("impulses: loads on drum walls equal the change of momenta to round-off, and power is spin times torque") {
        dem_world *world = drum(200);
        const dem_vec3 down = at(0, 0, -g);
        double force = 0, torque = 0, power = 0, weight, size = 0;
        int step, k, i;
        CHECK_EQ(scene_step(world, 150), DEM_OK);
        weight = g*dem_totals_get(world).mass;
        for (step = 0; step < 50; step++) {
            const dem_totals before = dem_totals_get(world);
            dem_wall_loads loads[3];
            dem_totals after;
            double p[3], turn;
            for (k = 0; k < 3; k++) {
                const dem_wall wall = {k + 1};
                CHECK_EQ(dem_wall_loads_get(world, wall, &loads[k]), DEM_OK);
            }
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            after = dem_totals_get(world);
            memcpy(p, before.momentum, sizeof p);
            p[2] += before.mass*(double)down.z*5e-4;
            turn = before.angular[1] - before.mass*before.centre[0]*(double)down.z*5e-4;
            for (k = 0; k < 3; k++) {
                p[0] -= (double)loads[k].force.x*5e-4;
                p[1] -= (double)loads[k].force.y*5e-4;
                p[2] -= (double)loads[k].force.z*5e-4;
                turn -= (double)loads[k].torque.y*5e-4;
            }
            for (i = 0; i < 3; i++) force = fmax(force, fabs(after.momentum[i] - p[i])/5e-4);
            torque = fmax(torque, fabs(after.angular[1] - turn)/5e-4);
            size = fmax(size, fabs((double)loads[0].torque.y));
            power = fmax(power, fabs((double)loads[0].power + 5*(double)loads[0].torque.y));
        }
        CHECK_NEAR(force/weight, 0, 1e-9);
        CHECK_NEAR(torque/size, 0, 1e-3);
        CHECK_NEAR(power/(5*size), 0, 1e-9);
        dem_world_destroy(world);
    }
    TEST("impulses: impulse and work of a wall are those of the steps done, from the first step on and when a body is "
         "set") {
        int mode;
        for (mode = 0; mode < 3; mode++) {
            dem_motion rise = DEM_MOTION;
            dem_material m;
            dem_world *world = rigid(0, 1e-3, 0.5, 0.3, DEM_CONE_COULOMB, 1, &m);
            const dem_wall floor = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            const dem_body ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
            dem_wall_loads loads;
            dem_body_state s = scene_state(world, ball);
            dem_pose pose;
            double gained = 0;                  /* kg m/s, by the floor alone */
            int k;
            rise.kind = DEM_MOTION_TRANSLATING;
            rise.velocity = at(0, 0, 0.5);
            CHECK_EQ(dem_wall_motion_set(world, floor, &rise), DEM_OK);
            for (k = 0; k < (mode == 2 ? 10 : 1); k++) {
                s = scene_state(world, ball);
                dem_wall_pose_get(world, floor, &pose);
                if (mode) {                     /* once in contact with the floor at rest: in the first step */
                    s.position.z = pose.position.z + DEM_R(0.01);
                    s.velocity.z = -1;
                    CHECK_EQ(dem_body_set(world, ball, &s), DEM_OK);
                }
                gained -= (double)s.mass*(double)s.velocity.z;
                CHECK_EQ(dem_world_run(world, 0.02, 0, 0), DEM_OK);
                s = scene_state(world, ball);
                gained += (double)s.mass*(double)s.velocity.z;
            }
            CHECK_EQ(dem_wall_loads_get(world, floor, &loads), DEM_OK);
            CHECK_REL(-loads.impulse[2], gained, exact);
            CHECK_REL(loads.work, 0.5*gained, exact);
            CHECK_REL(dem_ledger_get(world).walls, loads.work, exact);
            CHECK_NEAR(loads.time, dem_world_time_get(world), 1e-12);
            CHECK_NEAR(dem_ledger_get(world).residual, 0, exact*dem_ledger_get(world).throughput);
            dem_world_destroy(world);
        }
    }
    TEST("impulses: the ledger books the work of desc.force and desc.body_force, and closes") {
        int fields;
        for (fields = 1; fields < 4; fields++) {        /* bit 0: desc.force, bit 1: desc.body_force */
            dem_world_desc desc = DEM_WORLD_DESC;
            const dem_material_desc stuff = scene_stuff(0, 0.5, 0.5, 0);
            dem_world *world;
            dem_material m;
            dem_body ball;
            dem_body_state s;
            dem_ledger l;
            double work = 0;                            /* J, energy of motion at constant acceleration */
            desc.response = DEM_RESPONSE_IMPULSES;
            desc.dt = DEM_R(1e-3);
            desc.ledger = 1;
            if (fields & 1) desc.force = field_weight;
            if (fields & 2) desc.body_force = field_wrench;
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.2));
            CHECK_EQ(scene_step(world, 150), DEM_OK);                   /* in flight */
            s = scene_state(world, ball);
            if (fields & 1) work += (double)s.mass*pow(g*0.15, 2)/2;
            if (fields & 2) work += (double)s.mass*pow(0.5*0.15, 2)/2 + (double)s.inertia*pow(30*0.15, 2)/2;
            CHECK_REL(dem_ledger_get(world).force, work, exact);
            CHECK_EQ(scene_step(world, 250), DEM_OK);                   /* and with impacts on the floor */
            l = dem_ledger_get(world);
            CHECK(!(fields & 1) || l.normal > 0);
            CHECK_NEAR(l.residual/l.throughput, 0, exact);
            dem_world_destroy(world);
        }
    }
    TEST("impulses: a world without dt, with a user-defined law, an integrator or an unknown choice is rejected") {
        dem_world_desc desc = DEM_WORLD_DESC;
        desc.response = DEM_RESPONSE_IMPULSES;
        CHECK_STR(dem_world_create_error_get(&desc), "dt is 0 s");
        desc.dt = DEM_R(1e-3);
        CHECK_STR(dem_world_create_error_get(&desc), "");
        desc.integrator = DEM_INTEGRATOR_LEAPFROG;
        CHECK_STR(dem_world_create_error_get(&desc), "integrator");
        desc.integrator = DEM_INTEGRATOR_SYMPLECTIC_EULER;
        desc.cone = (dem_cone)2;
        CHECK_STR(dem_world_create_error_get(&desc), "cone or solver is not one of the enum values");
        desc.cone = DEM_CONE_CONVEX;
        desc.sweeps = -1;
        CHECK_STR(dem_world_create_error_get(&desc), "sweeps");
    }
    TEST("impulses: the step may change in mid-run but not be left to the library, which fails without effect") {
        dem_material m;
        dem_world *world = rigid(g, 1e-3, 0, 0.5, DEM_CONE_COULOMB, 1, &m);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.02));
        CHECK_EQ(scene_step(world, 10), DEM_OK);
        CHECK_EQ(dem_world_dt_set(world, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "impulses");
        CHECK_EQ(scene_step(world, 10), DEM_OK);
        CHECK_NEAR(dem_world_time_get(world), 0.02, 1e-12);
        CHECK_EQ(dem_world_dt_set(world, DEM_R(5e-4)), DEM_OK);
        CHECK_EQ(scene_step(world, 10), DEM_OK);
        CHECK_NEAR(dem_world_time_get(world), 0.025, 1e-12);
        dem_world_destroy(world);
    }
    TEST("impulses: across a periodic face two grains collide and a pile rests as in the middle of the box") {
        double speed[2], high[2];
        int over, k;
        for (over = 0; over < 2; over++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = scene_stuff(0, 0.5, 0.3, 0);
            dem_world *world;
            dem_material m;
            dem_body a, b;
            desc.response = DEM_RESPONSE_IMPULSES;
            desc.dt = DEM_R(1e-3);
            desc.domain = box_of(0, 0, 0, 1, 1, 1);
            for (k = 0; k < 2; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            dem_wall_plane_add(world, m, at(0, 0, 0.1), at(0, 0, 1));
            a = dem_sphere_add(world, m, DEM_R(0.05), at(over ? 0.06 : 0.44, 0.5, 0.5));
            b = dem_sphere_add(world, m, DEM_R(0.05), at(over ? 0.94 : 0.56, 0.5, 0.53));
            scene_move(world, a, at(over ? -2 : 2, 0, 0), at(0, 0, 0));
            CHECK_EQ(scene_step(world, 60), DEM_OK);
            speed[over] = fabs((double)scene_state(world, b).velocity.x);
            CHECK_EQ(dem_world_gravity_set(world, at(0, 0, -g)), DEM_OK);
            CHECK_EQ(scene_step(world, 500), DEM_OK);
            high[over] = (double)scene_state(world, b).position.z;
            dem_world_destroy(world);
        }
        CHECK(speed[0] > 0.5);
        CHECK_NEAR(speed[0], speed[1], 1e-12);
        CHECK_NEAR(high[0], high[1], 1e-9);
    }
    TEST("impulses: no period and no floor is too short for grains because they are fast") {
        /* a period of 4.6 radii; a floor longer than the period, which ends 1.05 radii beyond its faces; after a
           fall from 2 m three steps of a grain are 12 radii */
        const double r = 1e-3, period = 4.6*r, end = 1.05*r;
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc stuff = scene_stuff(0, 1, 0, 0);
        dem_world *world;
        dem_material m;
        dem_body body;
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.gravity = at(0, 0, -g);
        desc.dt = DEM_R(1e-4);
        desc.domain = box_of(-1, 0, -0.1, 1, period, 3);
        desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
        desc.ledger = 1;
        world = dem_world_create(&desc);
        m = dem_material_add(world, &stuff);
        scene_floor(world, m, -0.02, -end, 0.02, period + end, 2, 1);
        body = dem_sphere_add(world, m, (dem_real)r, at(0.001, 0, 2));
        CHECK_EQ(dem_world_run(world, 1, 0, 0), DEM_OK);
        CHECK_NEAR(scene_state(world, body).velocity.z, sqrt(2*g*(2 - r)) - g*(1 - sqrt(2*(2 - r)/g)), 5e-3);
        dem_world_destroy(world);
    }
    TEST("impulses: contacts keep their history when friction is set, and the next step needs no more sweeps") {
        int later, sweeps[2];
        for (later = 0; later < 2; later++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = scene_stuff(0, 0, 0, 0);
            dem_world *world;
            dem_material m;
            uint64_t was;
            int k;
            desc.gravity.z = (dem_real)-g;
            desc.response = DEM_RESPONSE_IMPULSES;
            desc.dt = DEM_R(1e-3);
            desc.tolerance = DEM_R(1e-9);
            desc.sweeps = 20000;
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            for (k = 0; k < 20; k++) dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01 + 0.02*k));
            CHECK_EQ(scene_step(world, 50), DEM_OK);
            if (later) {
                stuff.friction = DEM_R(0.5);
                stuff.rolling_friction = DEM_R(0.1);
                CHECK(dem_material_add(world, &stuff).id != 0);
            }
            was = dem_world_hash_get(world);
            CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
            CHECK(dem_world_hash_get(world) == was);
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            sweeps[later] = dem_counters_get(world).sweeps;
            dem_world_destroy(world);
        }
        CHECK_EQ(sweeps[1], sweeps[0]);
        CHECK(sweeps[0] <= 3);
    }
    TEST("impulses: the report counts friction between two materials as used once they have touched") {
        int touch, k;
        for (touch = 0; touch < 2; touch++) {
            dem_effect all[DEM_EFFECTS];
            dem_material m, other;
            dem_world *world = rigid(g, 1e-3, 0, 0.5, DEM_CONE_COULOMB, 1, &m);
            dem_material_desc stuff = scene_stuff(0, 0, 0.3, 0);
            other = dem_material_add(world, &stuff);
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            dem_sphere_add(world, other, DEM_R(0.01), at(0, 0, touch ? 0.0101 : 1));
            CHECK_EQ(scene_step(world, 20), DEM_OK);
            CHECK_EQ(dem_effects_get(world, 0, all), DEM_EFFECTS);
            for (k = 0; strcmp(all[k].name, "friction"); k++) continue;
            CHECK_EQ(all[k].state, touch ? DEM_EFFECT_ACTIVE : DEM_EFFECT_IDLE);
            CHECK(strstr(all[k].text, "impulses") != 0);
            dem_world_destroy(world);
        }
    }
    TEST("impulses: what begins to move between two steps is felt before it overlaps") {
        /* everything rests at gaps of 0.05 R; then a wall, or a body, moves by 0.09 R in each step, or a rod turns. The
           first step finds contacts of a body that was set where it was set, half a step early */
        int kind;
        for (kind = 0; kind < 3; kind++) {
            dem_material m;
            dem_world *world = rigid(0, 1e-3, 0, 0, DEM_CONE_COULOMB, 1, &m);
            const double r = 0.01, fast = 0.09*r/1e-3;
            const dem_shape rod = block(world, 10*r, 2*r, 2*r, 0.9*r);
            const dem_wall wall = dem_wall_plane_add(world, m, at(-1.05*r, 0, 0), at(1, 0, 0));
            const dem_body ball = dem_sphere_add(world, m, (dem_real)r, at(0, 0, 0));
            const dem_body other = kind == 2 ? dem_body_add(world, m, rod, at(4.5*r, 2.05*r, 0), dem_quat_make(1, 0, 0, 0))
                : dem_sphere_add(world, m, (dem_real)r, at(2.05*r, 0, 0));
            dem_motion motion = DEM_MOTION;
            CHECK_EQ(dem_world_step(world, 20), DEM_OK);
            CHECK_EQ(dem_counters_get(world).contacts + dem_counters_get(world).wall_contacts, 0);
            motion.kind = DEM_MOTION_TRANSLATING;
            motion.velocity = at(fast, 0, 0);
            if (kind == 0) CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
            if (kind == 1) scene_move(world, other, at(-fast, 0, 0), at(0, 0, 0));
            if (kind == 2) scene_move(world, other, at(0, 0, 0), at(0, 0, fast/(5*r)));
            dem_overlap_max_reset(world);
            CHECK_EQ(dem_world_step(world, 20), DEM_OK);
            CHECK((double)dem_counters_get(world).overlap_max < (kind ? 0.04 : 1e-3));
            CHECK(fabs((double)scene_state(world, ball).position.x) > 1e-4*r);
            dem_world_destroy(world);
        }
    }

    TEST("impulses: walls, bodies, joints and forces of velocity are followed to second order in dt") {
        int scene;
        if (sizeof(dem_real) == 4) printf("SKIP: single precision ends above the errors that are compared\n");
        else for (scene = 0; scene < ORDERS; scene++) {
            double error[2], part[2], fine[2];
            double order = order_of(scene, scene == EGG_ROCKS ? 5e-4 : 1e-3, error, part);
            if (strstr(order_names[scene], "pendulum")) {    /* the guard of energy, which acts in some */
                order_of(scene, 2e-3, error, part);          /* steps, changes errors by 2 either way: */
                order_of(scene, 5e-4, fine, part);           /* over three halvings of dt */
                error[1] = fine[1];
                order = log(error[0]/error[1])/log(8.0);
            }
            if (getenv("DEM_TABLES")) printf("| %s | %.2g | %.2g | %.2f |\n", order_names[scene], error[0], error[1], order);
            CHECK(order > 1.7 && order < 2.5);  /* the reference has its own error, 1/64 of the second's */
        }
    }
    TEST("impulses: a ball that rolls round in a tube at 40 rad/s keeps its energy to 1e-6 in 1,000 steps") {
        double start = 0, energy;
        dem_material m;
        dem_world *world = rigid(0, 1e-5, 0, 0.9, DEM_CONE_COULOMB, 1, &m);
        dem_body body;
        int k;
        dem_wall_cylinder_add(world, m, at(0, 0, 0), at(0, 1, 0), DEM_R(0.1), 1);
        body = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, -0.09));
        scene_move(world, body, at(3.6, 0, 0), at(0, 360, 0));
        for (k = 0; k < 2; k++) {
            CHECK_EQ(scene_step(world, k ? 1000 : 10), DEM_OK);        /* the first find the wall's curve */
            energy = dem_ledger_get(world).kinetic + dem_ledger_get(world).rotational;
            if (k) CHECK_NEAR(energy/start, 1, sizeof(dem_real) == 4 ? 1e-4 : 1e-6);
            start = energy;
        }
        dem_world_destroy(world);
    }
    TEST("impulses: a Coriolis force on a floor adds no energy in 20 revolutions, to 0.2 %") {
        double start, energy;
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material_desc stuff = scene_stuff(0, 0.5, 0, 0);
        dem_world *world;
        dem_material m;
        dem_body body;
        desc.gravity.z = (dem_real)-g;
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = DEM_R(2e-3);
        desc.force = order_coriolis;
        desc.ledger = 1;
        world = dem_world_create(&desc);
        m = dem_material_add(world, &stuff);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        body = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
        scene_move(world, body, at(1, 0, 0), at(0, 0, 0));
        start = dem_ledger_get(world).kinetic;
        CHECK_EQ(scene_step(world, 6283), DEM_OK);                     /* 10 rad/s */
        energy = dem_ledger_get(world).kinetic;
        CHECK_NEAR(energy/start, 1, 2e-3);
        dem_world_destroy(world);
    }
    TEST("impulses: forces out of a planar world's plane, and torques about its axes, change no motion in it") {
        dem_body_state s[2][2];
        int askew, k;
        for (askew = 0; askew < 2; askew++) {
            const dem_real corners[8] = {DEM_R(-0.01), DEM_R(-0.005), DEM_R(0.01), DEM_R(-0.005),
                                         DEM_R(0.01), DEM_R(0.005), DEM_R(-0.01), DEM_R(0.005)};
            const dem_material_desc stuff = scene_stuff(0, 0.3, 0.5, 0.05);
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material m;
            dem_body body[2];
            double off = askew ? 100 : 0;
            desc.planar = 1;
            desc.gravity.y = (dem_real)-g;
            desc.response = DEM_RESPONSE_IMPULSES;
            desc.dt = DEM_R(1e-3);
            desc.force = field_oblique;
            desc.force_user = &off;
            desc.body_force = field_askew;
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 1, 0));
            body[0] = dem_body_add(world, m, dem_shape_polygon_add(world, 4, corners), at(0, 0.005, 0),
                                   dem_quat_make(1, 0, 0, 0));          /* friction holds it */
            body[1] = dem_sphere_add(world, m, DEM_R(0.01), at(0.1, 0.01, 0));      /* it rolls away */
            CHECK_EQ(scene_step(world, 100), DEM_OK);
            for (k = 0; k < 2; k++) s[askew][k] = scene_state(world, body[k]);
            dem_world_destroy(world);
        }
        CHECK_NEAR(s[0][0].velocity.x, 0, 1e-6);
        CHECK(s[0][1].velocity.x > DEM_R(0.05));
        for (k = 0; k < 2; k++) {
            CHECK_NEAR(s[1][k].position.x, s[0][k].position.x, 0);
            CHECK_NEAR(s[1][k].position.y, s[0][k].position.y, 0);
            CHECK_NEAR(s[1][k].velocity.x, s[0][k].velocity.x, 0);
            CHECK_NEAR(s[1][k].spin.z, s[0][k].spin.z, 0);
            CHECK_NEAR(s[1][k].velocity.z, 0, 0);
        }
    }
    TEST("impulses: rolling and spinning friction bring bodies in a plane to rest, with fixed neighbours or none") {
        int kind, law;
        for (kind = 0; kind < 4; kind++) for (law = 1; law < 4; law++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_material_desc stuff = scene_stuff(0, 0.2, 0.5, law & 1 ? 0.1 : 0);
            dem_real square[8] = {DEM_R(-1e-3), DEM_R(-1e-3), DEM_R(1e-3), DEM_R(-1e-3), DEM_R(1e-3), DEM_R(1e-3),
                                  DEM_R(-1e-3), DEM_R(1e-3)};
            dem_world *world;
            dem_material m;
            dem_pair pair;
            dem_shape shape = {0};
            dem_body body[3];
            dem_body_state s;
            int i;
            desc.planar = 1;
            desc.thickness = DEM_R(1e-3);
            desc.gravity.y = (dem_real)-g;
            desc.response = DEM_RESPONSE_IMPULSES;
            desc.dt = DEM_R(1e-3);
            desc.tolerance = sizeof(dem_real) == 4 ? DEM_R(1e-5) : DEM_R(1e-9);
            desc.sweeps = 2000;
            world = dem_world_create(&desc);
            m = dem_material_add(world, &stuff);
            dem_pair_get(world, m, m, &pair);
            pair.spinning_friction = law & 2 ? DEM_R(0.1) : 0;
            CHECK_EQ(dem_pair_set(world, m, m, &pair), DEM_OK);
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 1, 0));
            if (kind < 2) shape = dem_shape_polygon_add(world, 4, square);
            for (i = 0; i < 3; i++) {                                  /* a pile, or a disc among polygons */
                const dem_vec3 x = at(1e-4*i, 1.001e-3 + 2.001e-3*i, 0);
                body[i] = kind < 2 ? dem_body_add(world, m, shape, x, dem_quat_make(1, 0, 0, 0))
                    : dem_sphere_add(world, m, DEM_R(1e-3), at(kind == 2 ? 3e-3*i : 2e-3*i, 1e-3, 0));
            }
            if (kind == 1) {
                s = scene_state(world, body[0]);
                s.fixed = 1;
                dem_body_set(world, body[0], &s);
            }
            CHECK_EQ(scene_step(world, 300), DEM_OK);
            for (i = 0; i < 3; i++) {
                s = scene_state(world, body[i]);
                CHECK(fabs((double)s.velocity.y) < 1e-4 && fabs((double)s.velocity.x) < 1e-4 &&
                      fabs((double)s.spin.z) < 1e-1 && s.position.y > DEM_R(0.9e-3));
            }
            dem_world_destroy(world);
        }
    }
    TEST("impulses: desc.body_reals_fn receives the position at the end of the step, as it does with springs") {
        int impulses;
        for (impulses = 0; impulses < 2; impulses++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material m;
            dem_body ball;
            double worst = 0;
            desc.dt = DEM_R(1e-3);
            desc.body_reals = "x";
            desc.body_reals_fn = reals_late;
            desc.body_reals_user = &worst;
            if (impulses) desc.response = DEM_RESPONSE_IMPULSES;
            else desc.allow_large_dt = 1;
            world = dem_world_create(&desc);
            m = scene_material(world, 1e7, 0.5, 0.3, 0);
            ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0));
            scene_move(world, ball, at(2, 0, 0), at(0, 0, 0));
            CHECK_EQ(scene_step(world, 50), DEM_OK);
            CHECK_NEAR(scene_state(world, ball).position.x, 2*dem_world_time_get(world), 1e-2*exact);
            CHECK_NEAR(worst, 0, 1e-2*exact);            /* a step is 2e-3 m */
            dem_world_destroy(world);
        }
    }
    return test_end();
}
