/* Bodies on rails: locked axes move as prescribed, free axes as forces tell, and reactions are those of closed forms. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */
enum { BALL, EGG, BRICK, CLUSTER, SHAPES };
static dem_world *stage(int integrator, double dt, dem_material *m) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    desc.gravity = at(0.5, 0, -9.81);
    desc.ledger = 1;
    desc.dt = (dem_real)dt;
    desc.integrator = (dem_integrator)integrator;
    world = dem_world_create(&desc);
    *m = scene_material(world, 1e7, 0.5, 0.5, 0);
    return world;
}
/* A body of any shape with three different moments, askew. */
static dem_body body_of(dem_world *world, dem_material m, int shape, dem_vec3 x) {
    const dem_real three[9] = {0, 0, 0, DEM_R(0.008), 0, 0, 0, DEM_R(0.005), 0};
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_shape s;
    cluster.count = 3; cluster.positions = three; cluster.radius = DEM_R(0.005);
    if (shape == BALL) return dem_sphere_add(world, m, DEM_R(0.01), x);
    s = shape == EGG ? dem_shape_ellipsoid_add(world, at(0.02, 0.01, 0.007)) : shape == BRICK
        ? scene_box(world, 0.03, 0.02, 0.01) : dem_shape_cluster_add(world, &cluster);
    return dem_body_add(world, m, s, x, dem_quat_about(at(1, 2, 3), DEM_R(0.7)));
}
static dem_rail_desc rail_of(int axes, dem_vec3 velocity, dem_vec3 spin) {
    dem_rail_desc d = DEM_RAIL_DESC;
    d.axes = axes; d.velocity = velocity; d.spin = spin;
    return d;
}
static dem_rail_state rail_now(const dem_world *world, dem_body body) {
    dem_rail_state s;
    memset(&s, 0, sizeof s);
    CHECK_EQ(dem_body_reaction_get(world, body, &s), DEM_OK);
    return s;
}
/* A box with a paddle on a rail among grains. */
static dem_world *mixer(dem_body *paddle) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_rail_desc rail = rail_of(DEM_RAIL_ALL, at(0, 0, 0), at(0, 0, 12));
    dem_world *world;
    dem_material m;
    uint64_t seed = 3;
    int i;
    desc.gravity.z = DEM_R(-9.81);
    desc.dt = DEM_R(1.5e-5);
    desc.threads = 1;
    desc.ledger = 1;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.5, 0.5, 0);
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    dem_wall_cylinder_add(world, m, at(0, 0, 0), at(0, 0, 1), DEM_R(0.03), 1);
    *paddle = dem_body_add(world, m, scene_box(world, 0.05, 0.004, 0.012), at(0, 0, 0.008), dem_quat_make(1, 0, 0, 0));
    CHECK_EQ(dem_body_rail_set(world, *paddle, &rail), DEM_OK);
    for (i = 0; i < 80; i++)
        dem_sphere_add(world, m, DEM_R(0.002), scene_at(&seed, 4e-4, 0.0045*(i%8 - 3.5), 4e-4, 0.0045*(i/8%5 - 2), 1e-4,
                                                        0.018 + 0.0045*(i/40)));
    return world;
}
/* A path as a user writes it: a loop with a rotation about an axis that turns. */
static void user_path(double t, dem_pose *p, void *user) {
    const double a = sin(7*t), c = cos(a), s = sin(a), rate = 7*cos(7*t);
    int k;
    (void)user;
    for (k = 0; k < 9; k++) p->rotation[k] = 0;
    p->rotation[0] = p->rotation[8] = (dem_real)c;
    p->rotation[2] = (dem_real)s; p->rotation[6] = (dem_real)-s; p->rotation[4] = 1;
    p->position = at(0.1*sin(9*t), 0, -1 + 0.05*sin(4*t));
    p->velocity = at(0.9*cos(9*t), 0, 0.2*cos(4*t));
    p->spin = at(0, rate, 0);
}
enum { TURNS, SLIDES, SHAKES, OWN, TABLE, PRESSES, PATHS };
static const dem_motion_row path_rows[] = {{0, {0, 0, 0}, {1, 0, 0, 0}, 1}, {0.04, {DEM_R(0.02), DEM_R(-0.01), 0}, {DEM_R(0.8), DEM_R(0.6), 0, 0}, -1},
    {0.15, {DEM_R(0.05), 0, DEM_R(0.03)}, {DEM_R(0.6), 0, DEM_R(0.48), DEM_R(0.64)}, 2}, {0.3, {0, 0, 0}, {1, 0, 0, 0}, 1}};
/* Adds a wall that moves. */
static dem_wall path_add(dem_world *world, dem_material m, int path) {
    static const dem_motion_kind kinds[] = {DEM_MOTION_ROTATING, DEM_MOTION_TRANSLATING, DEM_MOTION_OSCILLATING, DEM_MOTION_USER,
                                            DEM_MOTION_TABLE, DEM_MOTION_SERVO};
    const dem_wall wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
    dem_motion motion = DEM_MOTION;
    motion.kind = kinds[path];
    motion.axis = at(1, 2, 3);
    motion.point = at(0.01, 0, 0.02);
    motion.speed = 20;
    motion.velocity = at(0.1, 0.2, path == PRESSES ? -0.3 : 0.4);
    motion.amplitude = DEM_R(0.01);
    motion.frequency = 11;
    motion.ramp = path == TURNS || path == SLIDES ? 0.05 : 0;
    motion.function = user_path;
    if (path >= TABLE) { motion.table = path_rows; motion.table_count = 4; motion.table_repeats = 1; }
    CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_OK);
    return wall;
}
/* Returns where a point of a wall at x is in another pose. */
static dem_vec3 path_at(const dem_pose *from, const dem_pose *to, dem_vec3 x) {
    return demi_add(to->position, demi_rotate(to->rotation, demi_unrotate(from->rotation, demi_sub(x, from->position))));
}
int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a body on a rail keeps its place and attitude on its wall, for every motion of the wall") {
        int path, scheme, shape;
        for (path = 0; path < PATHS; path++) for (scheme = 0; scheme < 5; scheme++) for (shape = 0; shape < SHAPES; shape++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_rail_desc d = rail_of(DEM_RAIL_ALL, at(0, 0, 0), at(0, 0, 0));
            dem_material m;
            dem_pose first, last;
            dem_world *world, *again;
            dem_body b;
            dem_body_state s;
            dem_ledger l;
            dem_vec3 x, axis, turned;
            uint64_t hash;
            desc.gravity = at(0.5, 0, -9.81);
            desc.dt = DEM_R(1e-4);
            desc.allow_large_dt = desc.orientations = desc.ledger = 1;
            desc.integrator = (dem_integrator)scheme;
            world = dem_world_create(&desc);
            m = scene_material(world, 1e5, 0.5, 0.5, 0);
            d.wall = path_add(world, m, path);
            b = body_of(world, m, shape, at(0.05, 0.02, 0));
            CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_OK);
            CHECK_EQ(dem_wall_pose_get(world, d.wall, &first), DEM_OK);
            axis = dem_quat_unrotate(scene_state(world, b).orientation, at(1, 2, -1));
            CHECK_EQ(scene_step(world, 1001), DEM_OK);
            CHECK_EQ(dem_checkpoint_write(world, "build/tmp/rails.ckpt"), DEM_OK);
            CHECK_EQ(scene_step(world, 1002), DEM_OK);
            CHECK_EQ(dem_wall_pose_get(world, d.wall, &last), DEM_OK);
            s = scene_state(world, b);
            x = path_at(&first, &last, at(0.05, 0.02, 0));
            CHECK_NEAR(demi_length(demi_sub(s.position, x)), 0, fine ? 1e-13 : 2e-5);
            turned = demi_sub(path_at(&first, &last, at(1, 2, -1)), path_at(&first, &last, at(0, 0, 0)));
            CHECK_NEAR(demi_length(demi_sub(dem_quat_rotate(s.orientation, axis), turned)), 0, fine ? 1e-12 : 5e-4);
            l = dem_ledger_get(world);
            CHECK(fabs(l.residual) < (scheme == 1 || scheme == 2 ? 5e-2 : 2e-3)*l.throughput);
            hash = dem_world_hash_get(world);
            again = dem_world_create(&desc);
            m = scene_material(again, 1e5, 0.5, 0.5, 0);
            path_add(again, m, path);
            body_of(again, m, shape, at(0.05, 0.02, 0));
            CHECK_EQ(dem_checkpoint_read(again, "build/tmp/rails.ckpt"), DEM_OK);
            CHECK_EQ(scene_step(again, 1002), DEM_OK);
            CHECK(dem_world_hash_get(again) == hash);
            dem_world_destroy(world);
            dem_world_destroy(again);
        }
        remove("build/tmp/rails.ckpt");
    }
    TEST("motion along a rail relative to a rotating wall is of second order with every integrator") {
        int scheme, free, k;
        for (free = 0; free < 2; free++) for (scheme = 0; scheme < 5; scheme++) {
            double off[3];
            for (k = 0; k < 3; k++) {           /* x' = v - w (y - y0), y' = w x: the exact path is a cycloid */
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_rail_desc d = rail_of(free ? DEM_RAIL_X : DEM_RAIL_X | DEM_RAIL_Y, at(0.3, 0, 0), at(0, 0, 0));
                dem_motion turn = DEM_MOTION;
                dem_material m;
                dem_world *world;
                dem_body b;
                double t, x;
                desc.dt = (dem_real)(4e-3/(1 << k));
                desc.allow_large_dt = 1;
                desc.integrator = (dem_integrator)scheme;
                world = dem_world_create(&desc);
                m = scene_material(world, 1e3, 0.5, 0.5, 0);
                d.wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
                turn.kind = DEM_MOTION_ROTATING;
                turn.axis = at(0, 0, 1);
                turn.speed = 5;
                CHECK_EQ(dem_wall_motion_set(world, d.wall, &turn), DEM_OK);
                b = dem_sphere_add(world, m, DEM_R(0.005), at(0.1, 0.05, 0));
                scene_move(world, b, at(0, 0.4, 0), at(0, 0, 0));
                CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_OK);
                CHECK_EQ(scene_step(world, 100 << k), DEM_OK);
                t = dem_world_time_get(world);
                x = free ? 0.1 + 0.3*t - 5*(0.05*t + 0.2*t*t) : 0.1*cos(5*t) - 0.05*sin(5*t) + 0.06*sin(5*t);
                off[k] = fabs((double)scene_state(world, b).position.x - x);
                dem_world_destroy(world);
            }
            if (fine) CHECK(off[1] < off[0]/3.8 + 1e-12 && off[2] < off[1]/3.8 + 1e-12);
            CHECK_NEAR(off[2], 0, 2e-5);
        }
    }
    TEST("the reaction of a shaken rail is m a, with an error of second order in the step") {
        double off[3];
        int k;
        for (k = 0; k < 3 && fine; k++) {
            dem_material m;
            dem_world *world = stage(0, 8e-5/(1 << k), &m);
            const dem_body b = body_of(world, m, BALL, at(0.1, 0, 0));
            dem_rail_desc d = rail_of(DEM_RAIL_ALL, at(0, 0, 0), at(0, 0, 0));
            dem_motion shake = DEM_MOTION;
            double t, w = 2*DEMI_PI*11;
            d.wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
            shake.kind = DEM_MOTION_OSCILLATING;
            shake.velocity = at(1, 0, 0);
            shake.amplitude = DEM_R(0.01);
            shake.frequency = 11;
            CHECK_EQ(dem_wall_motion_set(world, d.wall, &shake), DEM_OK);
            CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_OK);
            CHECK_EQ(scene_step(world, 500 << k), DEM_OK);
            t = dem_world_time_get(world);
            off[k] = fabs((double)rail_now(world, b).force.x/(double)scene_state(world, b).mass + 0.5 + 0.01*w*w*sin(w*t));
            CHECK_NEAR(scene_state(world, b).velocity.x, 0.01*w*cos(w*t), 1e-4);
            dem_world_destroy(world);
        }
        CHECK(!fine || (off[0] > 3.8*off[1] && off[1] > 3.8*off[2] && off[2] < 1e-2));
    }
    TEST("a rail holds locked axes with every integrator and shape, and free axes fall as they would") {
        int scheme, shape;
        for (scheme = 0; scheme < 5; scheme++) for (shape = 0; shape < SHAPES; shape++) {
            dem_material m;
            dem_world *world = stage(scheme, 2e-5, &m);
            const dem_body b = body_of(world, m, shape, at(0, 0, 1));
            const dem_rail_desc d = rail_of(DEM_RAIL_Z | DEM_RAIL_Y | DEM_RAIL_SPIN_X | DEM_RAIL_SPIN_Y, at(9, 0.3, 0), at(0, 0, 9));
            dem_body_state s = scene_state(world, b);
            const dem_quat start = s.orientation;
            dem_quat turned;
            const double t = 0.2;
            dem_ledger l;
            s.spin = at(7, 7, 5);                       /* x and y end at once, z stays */
            dem_body_set(world, b, &s);
            CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_OK);
            CHECK_EQ(dem_world_run(world, t, 0, 0), DEM_OK);
            s = scene_state(world, b);
            CHECK_NEAR(s.position.x, 0.25*t*t, fine ? (scheme == 1 || scheme == 2 ? 2e-6 : 1e-12) : 1e-4);
            CHECK_NEAR(s.position.y, 0.3*t, fine ? 1e-12 : 1e-4);
            CHECK_NEAR(s.position.z, 1, fine ? 1e-13 : 1e-5);
            CHECK_NEAR(s.spin.z, 5, fine ? 1e-9 : 1e-3);
            CHECK_NEAR(s.spin.x, 0, fine ? 1e-7 : 1e-3);
            CHECK_NEAR(s.spin.y, 0, fine ? 1e-7 : 1e-3);
            if (shape) {                                /* about z alone */
                turned = dem_quat_multiply(dem_quat_about(at(0, 0, 1), (dem_real)(5*t)), start);
                CHECK_NEAR(dem_quat_rotate(s.orientation, at(1, 2, 3)).x, dem_quat_rotate(turned, at(1, 2, 3)).x, fine ? 1e-9 : 1e-3);
                CHECK_NEAR(dem_quat_rotate(s.orientation, at(1, 2, 3)).z, dem_quat_rotate(turned, at(1, 2, 3)).z, fine ? 1e-9 : 1e-3);
            }
            CHECK_REL(rail_now(world, b).force.z, 9.81*(double)s.mass, 1e-5);
            l = dem_ledger_get(world);
            if (scheme != 1 && scheme != 2) CHECK(fabs(l.residual) < (fine ? 1e-8 : 1e-4)*l.throughput);
            dem_body_rail_set(world, b, &DEM_RAIL_DESC);
            CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
            CHECK_NEAR(scene_state(world, b).position.z, 1 - 9.81*0.01/2, fine ? 2e-4 : 1e-3);
            dem_world_destroy(world);
        }
    }
    TEST("a pendulum led by a wall feels m (w^2 r + g cos a) along its arm and m g sin a across it") {
        int shape;
        for (shape = 0; shape < SHAPES; shape++) {
            dem_material m;
            dem_world *world = stage(0, 1e-5, &m);
            const dem_body b = body_of(world, m, shape, at(0.1, 0, 0));
            const dem_wall arm = scene_floor(world, m, 0.3, 0.3, 0.35, 0.35, 1, 1);
            dem_rail_desc d = rail_of(DEM_RAIL_ALL, at(0, 0, 0), at(0, 0, 0));
            dem_motion turn = DEM_MOTION;
            dem_rail_state r;
            double a, c, s, mass;
            turn.kind = DEM_MOTION_ROTATING;
            turn.axis = at(0, 1, 0);                    /* from x towards -z */
            turn.speed = 4;
            dem_wall_motion_set(world, arm, &turn);
            d.wall = arm;
            CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_OK);
            CHECK_EQ(dem_world_run(world, 0.3, 0, 0), DEM_OK);
            r = rail_now(world, b);
            mass = (double)scene_state(world, b).mass;
            a = 4*dem_world_time_get(world);
            c = cos(a); s = sin(a);
            CHECK_NEAR(scene_state(world, b).position.x, 0.1*c, fine ? 1e-9 : 1e-4);
            CHECK_NEAR(scene_state(world, b).position.z, -0.1*s, fine ? 1e-9 : 1e-4);
            CHECK_REL((double)r.force.x, mass*(-1.6*c - 0.5), fine ? 1e-6 : 2e-2);
            CHECK_REL((double)r.force.z, mass*(1.6*s + 9.81), fine ? 1e-6 : 2e-2);
            if (fine) CHECK_REL(r.power, (double)r.force.x*-0.4*s + (double)r.force.z*-0.4*c, 1e-6);
            dem_world_destroy(world);
        }
    }
    TEST("a body that spins askew at constant speed needs the torque w x J w") {
        dem_material m;
        dem_world *world = stage(0, 2e-5, &m);
        const dem_body b = body_of(world, m, BRICK, at(0, 0, 0));
        const dem_rail_desc d = rail_of(DEM_RAIL_ALL, at(0, 0, 0), at(3, -4, 12));
        dem_rail_state r;
        dem_body_state s;
        dem_vec3 w, L;
        double most;
        CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0.31, 0, 0), DEM_OK);
        r = rail_now(world, b);
        s = scene_state(world, b);
        w = dem_quat_unrotate(dem_quat_multiply(s.orientation, demi_shape_of(world, 0)->frame), d.spin);
        L = dem_quat_rotate(dem_quat_multiply(s.orientation, demi_shape_of(world, 0)->frame),
                            dem_vec3_make(w.x*s.moments.x, w.y*s.moments.y, w.z*s.moments.z));
        most = fabs((double)r.torque.x) + fabs((double)r.torque.y) + fabs((double)r.torque.z);
        CHECK_NEAR(((double)r.torque.x - (-4*(double)L.z - 12*(double)L.y))/most, 0, fine ? 1e-6 : 5e-2);
        CHECK_NEAR(((double)r.torque.y - (12*(double)L.x - 3*(double)L.z))/most, 0, fine ? 1e-6 : 5e-2);
        CHECK_NEAR(((double)r.torque.z - (3*(double)L.y + 4*(double)L.x))/most, 0, fine ? 1e-6 : 5e-2);
        dem_world_destroy(world);
    }
    TEST("a roller with a prescribed speed drives a free one until both rims move alike; its work is heat and energy") {
        dem_material m;
        dem_world *world = stage(0, 5e-6, &m);
        const dem_body drive = dem_sphere_add(world, m, DEM_R(0.02), at(0, 0, 0));
        const dem_body idle = dem_sphere_add(world, m, DEM_R(0.01), at(0.02995, 0, 0));
        const dem_rail_desc first = rail_of(DEM_RAIL_ALL, at(0, 0, 0), at(0, 0, 10));
        const dem_rail_desc second = rail_of(DEM_RAIL_ALL - DEM_RAIL_SPIN_Z, at(0, 0, 0), at(0, 0, 0));
        dem_rail_state d, i;
        dem_ledger l;
        double start;
        dem_body_rail_set(world, idle, &second);
        dem_body_rail_set(world, drive, &first);
        CHECK_EQ(dem_world_step(world, 1), DEM_OK);
        start = dem_ledger_get(world).residual;         /* the spring that presses them was not booked */
        CHECK_EQ(dem_world_run(world, 0.2, 0, 0), DEM_OK);
        CHECK_REL(-0.00998333*(double)scene_state(world, idle).spin.z, 0.0199667*10, 2e-3);
        d = rail_now(world, drive);
        i = rail_now(world, idle);
        CHECK_REL((double)d.force.x, -(double)i.force.x - 0.5*((double)scene_state(world, idle).mass +
                  (double)scene_state(world, drive).mass), fine ? 1e-9 : 1e-2);
        l = dem_ledger_get(world);
        CHECK_REL(l.walls, d.work + i.work, fine ? 1e-9 : 1e-3);
        /* half of the work on the idle roller is heat while its rim slides */
        CHECK_REL(-i.work + d.work, (double)scene_state(world, idle).inertia*pow((double)scene_state(world, idle).spin.z, 2), 0.02);
        CHECK(fabs(l.residual - start) < (fine ? 1e-4 : 2e-2)*l.walls);
        dem_world_destroy(world);
    }
    TEST("a mixer's paddle on a rail continues from a checkpoint with the same bits") {
        char path[] = "build/tmp/test_rails.checkpoint";
        dem_body paddle;
        dem_world *world = mixer(&paddle), *again;
        dem_rail_state r, other;
        CHECK_EQ(scene_step(world, 2000), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        CHECK_EQ(scene_step(world, 1500), DEM_OK);
        again = mixer(&paddle);
        dem_body_rail_set(again, paddle, &DEM_RAIL_DESC);
        CHECK_EQ(dem_checkpoint_read(again, path), DEM_OK);
        CHECK_EQ(scene_step(again, 1500), DEM_OK);
        CHECK(dem_world_hash_get(again) == dem_world_hash_get(world));
        r = rail_now(world, paddle);
        other = rail_now(again, paddle);
        CHECK_NEAR(other.work, r.work, 0);
        CHECK(r.work > 1e-6);
        CHECK_NEAR(scene_state(world, paddle).position.z, 0.008, fine ? 1e-15 : 1e-9);
        CHECK(fabs(dem_ledger_get(world).residual) < (fine ? 1e-2 : 5e-2)*dem_ledger_get(world).throughput);
        {                       /* a wall in the place of one that was removed has a larger id */
            dem_rail_desc d = rail_of(DEM_RAIL_X, at(0, 0, 0), at(0, 0, 0));
            dem_material m;
            m.id = 1;
            CHECK_EQ(dem_wall_remove(world, dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1))), DEM_OK);
            d.wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
            CHECK_EQ(dem_body_rail_set(world, paddle, &d), DEM_OK);
            CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(world, path), DEM_OK);
        }
        dem_body_remove(world, paddle);                 /* its rail goes with it */
        CHECK_EQ(scene_step(world, 50), DEM_OK);
        CHECK(dem_body_reaction_get(world, paddle, &r) != DEM_OK);
        dem_world_destroy(world);
        dem_world_destroy(again);
        remove(path);
    }
    TEST("a body on a rail of a rotating wall goes on from the position that dem_body_set gives it, also far away") {
        int k;
        for (k = 0; k < 2; k++) {               /* read and set alike leaves the path; a new x counts as given */
            dem_rail_desc rail = rail_of(DEM_RAIL_X | DEM_RAIL_Y, at(0, 0, 0), at(0, 0, 0));
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_motion turn = DEM_MOTION;
            dem_world *world;
            dem_material m;
            dem_body body;
            dem_body_state s;
            double angle, x;
            desc.dt = DEM_R(1e-4);
            desc.allow_large_dt = 1;
            desc.domain = box_of(0, 0, 0, 0.1, 0.1, 0.1);
            desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
            desc.skin = DEM_R(1e-3);
            world = dem_world_create(&desc);
            m = scene_material(world, 1e7, 0.5, 0.3, 0);
            rail.wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
            turn.kind = DEM_MOTION_ROTATING;
            turn.point = at(k ? 0.05 : 0.09, 0.05, 0);
            turn.axis = at(0, 0, 1);
            turn.speed = 10;
            CHECK_EQ(dem_wall_motion_set(world, rail.wall, &turn), DEM_OK);
            body = dem_sphere_add(world, m, DEM_R(0.005), k ? at(0.01, 0.05, 0.05) : at(0.09, 0.03, 0.05));
            CHECK_EQ(dem_body_rail_set(world, body, &rail), DEM_OK);
            CHECK_EQ(dem_world_run(world, k ? 1e-4 : 0.1, 0, 0), DEM_OK);
            s = scene_state(world, body);
            if (k) s.position.x = DEM_R(0.09);
            if (k) s.position.y = DEM_R(0.05);
            CHECK_EQ(dem_body_set(world, body, &s), DEM_OK);
            CHECK_EQ(dem_world_run(world, k ? 0.1 : 0.2, 0, 0), DEM_OK);
            s = scene_state(world, body);
            angle = 10*(dem_world_time_get(world) - (k ? 1e-4 : 0));
            x = (double)s.position.x - (k ? 0.05 + 0.04*cos(angle) : 0.09 + 0.02*sin(angle));
            CHECK_NEAR(x - 0.1*floor(x/0.1 + 0.5), 0, 1e-5);
            CHECK_NEAR(s.position.y, k ? 0.05 + 0.04*sin(angle) : 0.05 - 0.02*cos(angle), 1e-5);
            dem_world_destroy(world);
        }
    }
    TEST("the rail of a removed body hinders neither a deforming cell nor slabs") {
        int slabs, removed;
        for (slabs = 0; slabs < 2; slabs++)
            for (removed = 0; removed < 2; removed++) {
                const dem_rail_desc rail = rail_of(DEM_RAIL_X, at(0, 0, 0), at(0, 0, 0));
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_slabs_desc cut = DEM_SLABS_DESC;
                dem_cell_desc cell = DEM_CELL_DESC;
                dem_slabs *s;
                dem_world *world;
                dem_material m;
                dem_body body;
                int k;
                desc.dt = DEM_R(1e-5);
                desc.domain = box_of(0, 0, 0, 1, 0.1, 0.1);
                for (k = 0; k < 3; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
                world = dem_world_create(&desc);
                m = scene_material(world, 1e7, 0.5, 0.3, 0);
                body = dem_sphere_add(world, m, DEM_R(0.005), at(0.5, 0.05, 0.05));
                for (k = 0; k < 20; k++) dem_sphere_add(world, m, DEM_R(0.005), at(0.02 + 0.045*k, 0.02, 0.05));
                CHECK_EQ(dem_body_rail_set(world, body, &rail), DEM_OK);
                CHECK_EQ(scene_step(world, 2), DEM_OK);
                if (removed) CHECK_EQ(dem_body_remove(world, body), DEM_OK);
                cut.count = 2;
                cell.rate = at(-1, 0, 0);
                if (slabs) {
                    s = dem_slabs_create(world, &cut);
                    CHECK_EQ(s != 0, removed);
                    dem_slabs_destroy(s);
                } else CHECK_EQ(dem_cell_set(world, &cell), removed ? DEM_OK : DEM_ERROR_ARGUMENT);
                if (!removed) CHECK_STR(dem_world_error_get(world), "on rails");
                CHECK_EQ(scene_step(world, 2), DEM_OK);
                dem_world_destroy(world);
            }
    }
    TEST("a body on a rail stays a part of its rotating wall when it crosses a periodic face") {
        int face, k;
        for (face = 0; face < 2; face++) {
            const double c = face ? 0.09 : 0.05;        /* m, the axis: its circle crosses x = 0.1 or no face */
            dem_rail_desc rail = rail_of(DEM_RAIL_X | DEM_RAIL_Y, at(0, 0, 0), at(0, 0, 0));
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_motion turn = DEM_MOTION;
            dem_world *world;
            dem_material m;
            dem_body body;
            desc.dt = DEM_R(1e-4);
            desc.allow_large_dt = 1;
            desc.domain = box_of(0, 0, 0, 0.1, 0.1, 0.1);
            desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
            desc.skin = DEM_R(1e-3);                    /* positions are wrapped when lists are made */
            world = dem_world_create(&desc);
            m = scene_material(world, 1e7, 0.5, 0.3, 0);
            rail.wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
            turn.kind = DEM_MOTION_ROTATING;
            turn.point = at(c, 0.05, 0);
            turn.axis = at(0, 0, 1);
            turn.speed = 10;
            CHECK_EQ(dem_wall_motion_set(world, rail.wall, &turn), DEM_OK);
            body = dem_sphere_add(world, m, DEM_R(0.005), at(c, 0.03, 0.05));
            CHECK_EQ(dem_body_rail_set(world, body, &rail), DEM_OK);
            for (k = 0; k < 8; k++) {
                dem_body_state s;
                double angle, x;
                CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
                angle = 10*dem_world_time_get(world);
                s = scene_state(world, body);
                x = (double)s.position.x - (c + 0.02*sin(angle));
                CHECK_NEAR(x - 0.1*floor(x/0.1 + 0.5), 0, fine ? 1e-12 : 1e-5);
                CHECK_NEAR(s.position.y, 0.05 - 0.02*cos(angle), fine ? 1e-12 : 1e-5);
            }
            dem_world_destroy(world);
        }
    }
    TEST("a body on a rail keeps its velocity along locked axes, whatever sets velocities, and no energy appears") {
        int way, shape;
        for (shape = 0; shape < SHAPES; shape++)
            for (way = 0; way < 3; way++) {
                const dem_rail_desc rail = rail_of(DEM_RAIL_X | DEM_RAIL_SPIN_Y, at(0.1, 0, 0), at(0, 2, 0));
                dem_selection all = DEM_SELECTION;
                dem_material m;
                dem_world *world = stage(0, 1e-5, &m);
                dem_body body = body_of(world, m, shape, at(0, 0, 0));
                dem_body_state s;
                dem_ledger l;
                body_of(world, m, shape, at(1, 0, 0));
                CHECK_EQ(dem_body_rail_set(world, body, &rail), DEM_OK);
                CHECK_EQ(scene_step(world, 10), DEM_OK);
                s = scene_state(world, body);
                s.velocity = at(3, 2, 1);
                s.spin = at(30, 20, 10);
                if (way == 0) CHECK_EQ(dem_body_set(world, body, &s), DEM_OK);
                if (way == 1) CHECK_EQ(dem_bodies_velocity_set(world, &all, s.velocity, s.spin), 2);
                if (way == 2) CHECK_EQ(dem_temperature_set(world, 1, 3), DEM_OK);
                s = scene_state(world, body);
                CHECK_NEAR(s.velocity.x, 0.1, 1e-5);
                CHECK_NEAR(s.spin.y, 2, 1e-4);
                CHECK(s.velocity.y < -0.01 || s.velocity.y > 0.01);
                CHECK_EQ(scene_step(world, 10), DEM_OK);
                l = dem_ledger_get(world);
                CHECK_NEAR(l.residual, 0, 1e-4*l.throughput);
                dem_world_destroy(world);
            }
    }
    TEST("a wall with a new motion takes bodies on its rails along at once, and the ledger closes") {
        int shape, kind;
        for (shape = 0; shape < SHAPES; shape++)
            for (kind = 0; kind < 2; kind++) {
                dem_rail_desc rail = rail_of(DEM_RAIL_ALL, at(0, 0, 0), at(0, 0, 0));
                dem_motion d = DEM_MOTION;
                dem_material m;
                dem_world *world = stage(0, 1e-5, &m);
                const dem_body body = body_of(world, m, shape, at(0.1, 0, 0));
                dem_body_state s;
                dem_ledger l;
                rail.wall = dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
                CHECK_EQ(dem_body_rail_set(world, body, &rail), DEM_OK);
                CHECK_EQ(scene_step(world, kind ? 5 : 0), DEM_OK);
                d.kind = kind ? DEM_MOTION_ROTATING : DEM_MOTION_TRANSLATING;
                d.velocity = at(0, 0.5, 0);
                d.axis = at(0, 0, 1);
                d.speed = 5;
                CHECK_EQ(dem_wall_motion_set(world, rail.wall, &d), DEM_OK);
                s = scene_state(world, body);
                CHECK_NEAR(s.velocity.y, 0.5, 1e-6);
                CHECK_NEAR(s.spin.z, kind ? 5 : 0, 1e-5);
                CHECK_EQ(scene_step(world, 10), DEM_OK);
                l = dem_ledger_get(world);
                CHECK(l.kinetic > 0.5*l.inserted && l.inserted > 0);
                CHECK_NEAR(l.residual, 0, 1e-5*l.inserted);
                dem_world_destroy(world);
            }
    }
    TEST("the rail of a body that was fixed gives no force, torque or power, and its work stays") {
        const dem_rail_desc rail = rail_of(DEM_RAIL_ALL, at(0, 0, 0.1), at(0, 0, 0));
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        dem_body body;
        dem_body_state s;
        dem_rail_state r;
        double work;
        desc.gravity = at(0, 0, -9.81);
        desc.dt = DEM_R(1e-5);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e7, 0.5, 0.5, 0);
        body = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0));
        CHECK_EQ(dem_body_rail_set(world, body, &rail), DEM_OK);
        CHECK_EQ(scene_step(world, 100), DEM_OK);
        r = rail_now(world, body);
        s = scene_state(world, body);
        CHECK_REL(r.force.z, 9.81*(double)s.mass, 1e-5);
        CHECK_REL(r.power, 0.981*(double)s.mass, 1e-5);
        work = r.work;
        CHECK(work > 0);
        s.fixed = 1;
        CHECK_EQ(dem_body_set(world, body, &s), DEM_OK);
        CHECK_EQ(scene_step(world, 100), DEM_OK);
        r = rail_now(world, body);
        CHECK_NEAR(r.force.z, 0, 0);
        CHECK_NEAR(r.torque.x, 0, 0);
        CHECK_NEAR(r.power, 0, 0);
        CHECK_NEAR(r.work, work, 0);
        dem_world_destroy(world);
    }
    TEST("dem.h refuses rails of fixed bodies, with impulses, in slabs, and of axes that a planar world locks") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_slabs_desc slabs = DEM_SLABS_DESC;
        dem_rail_desc d = rail_of(DEM_RAIL_ALL, at(0, 0, 0), at(0, 0, 0));
        dem_rail_state r;
        dem_material m;
        dem_world *world = stage(0, 1e-5, &m);
        const dem_body b = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0));
        dem_body_state s = scene_state(world, b);
        CHECK_EQ(dem_body_reaction_get(world, b, &r), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "has no rail");
        d.axes = 64;
        CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "axes is 64");
        d.axes = 1;
        d.wall.id = 3;
        CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "wall 3 does not exist");
        d.wall.id = 0;
        d.velocity.x = (dem_real)HUGE_VAL;
        CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "velocity is");
        d.velocity.x = 0;
        CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_OK);
        slabs.count = 2;
        CHECK(dem_slabs_create(world, &slabs) == 0);
        CHECK_STR(dem_world_error_get(world), "1 bodies are on rails");
        s.fixed = 1;
        dem_body_set(world, b, &s);
        CHECK_EQ(dem_body_rail_set(world, b, &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "is fixed");
        dem_world_destroy(world);
        desc.planar = 1;
        world = dem_world_create(&desc);
        m = scene_material(world, 1e7, 0.5, 0.5, 0);
        d.axes = DEM_RAIL_ALL;
        CHECK_EQ(dem_body_rail_set(world, dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0)), &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "a planar world locks Z");
        dem_world_destroy(world);
        desc.planar = 0;
        desc.response = DEM_RESPONSE_IMPULSES;
        desc.dt = DEM_R(1e-3);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e7, 0.5, 0.5, 0);
        CHECK_EQ(dem_body_rail_set(world, dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0)), &d), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "contacts of this world are impulses");
        dem_world_destroy(world);
    }
    return test_end();
}
