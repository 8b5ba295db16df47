/* Walls that a program leads: a motion or a belt set at every step costs only the contacts of that wall. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */
enum { PLANE, MESH, DISCS, LAW, WALLS };             /* DISCS: a planar world; LAW: a law by pointer */
enum { SLIDES, TURNS, BELT, MOTIONS };
static long called;                                  /* calls of the law */
static void counted(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    called++;
    f->normal = DEM_R(1e3)*c->overlap + DEM_R(0.02)*c->closing_speed;
    f->tangent = demi_scale(c->slip, DEM_R(-0.01));
}
/* A heap of discs (DISCS) or of grains of four shapes that falls on a floor. */
static dem_world *heap(int wall, dem_wall *floor) {
    const dem_real pair[6] = {DEM_R(-5e-4), 0, 0, DEM_R(5e-4), 0, 0};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_cluster_desc two = DEM_CLUSTER_DESC;
    dem_world *world;
    dem_material m;
    dem_shape shape[4];
    uint64_t seed = 3;
    int i;
    desc.threads = 1;
    desc.planar = wall == DISCS;
    desc.gravity = wall == DISCS ? at(0, -9.81, 0) : at(0, 0, -9.81);
    desc.dt = DEM_R(4e-6);
    desc.rolling_law = wall == LAW ? DEM_ROLLING_NONE : DEM_ROLLING_EPSD;
    if (wall == LAW) desc.law = counted;
    world = dem_world_create(&desc);
    if (!world) { puts(dem_world_create_error_get(&desc)); exit(1); }
    m = scene_material(world, 1e7, 0.5, 0.4, 0.1);
    two.count = 2; two.positions = pair; two.radius = DEM_R(8e-4);
    shape[0].id = 0;
    if (wall != DISCS) {
        shape[1] = dem_shape_cluster_add(world, &two);
        shape[2] = dem_shape_ellipsoid_add(world, at(1.2e-3, 1e-3, 8e-4));
        shape[3] = scene_box(world, 1.6e-3, 1.6e-3, 1.6e-3);
    }
    for (i = 0; i < 200; i++) {
        const int side = wall == DISCS ? 20 : 7;
        const dem_vec3 x = wall == DISCS ? at(2e-3*(i%side), 2e-3*(i/side) + 9.9e-4, 0)
            : at(2e-3*(i%side), 2e-3*(i/side%side), 2e-3*(i/side/side) + 9.9e-4);
        const dem_body b = wall == DISCS || i%4 == 0 ? dem_sphere_add(world, m, DEM_R(1e-3), x)
            : dem_body_add(world, m, shape[i%4], x, scene_turn(&seed));
        scene_move(world, b, at(0, 0, 0), wall == DISCS ? at(0, 0, 100) : at(50, -80, 100));
        scene_move(world, b, wall == DISCS ? at(0, -0.2, 0) : at(0, 0, -0.2), scene_state(world, b).spin);
    }
    *floor = wall == MESH ? scene_floor(world, m, -0.01, -0.01, 0.03, 0.03, 4, 4)
        : dem_wall_plane_add(world, m, at(0, 0, 0), wall == DISCS ? at(0, 1, 0) : at(0, 0, 1));
    return world;
}
/* Sets the motion of the floor, or its surface velocity (BELT). speed: m/s. */
static dem_result lead(dem_world *world, dem_wall floor, int motion, int planar, double speed) {
    dem_motion m = DEM_MOTION;
    if (motion == BELT) return dem_wall_surface_velocity_set(world, floor, at(speed, 0, 0));
    m.kind = motion == SLIDES ? DEM_MOTION_TRANSLATING : DEM_MOTION_ROTATING;
    m.velocity = planar ? at(speed, 0.1*speed, 0) : at(speed, 0.3*speed, 0.1*speed);
    m.axis = planar ? at(0, 0, 1) : at(0, 0.1, 1);
    m.point = at(0.005, 0, 0);
    m.speed = (dem_real)(50*speed);
    return dem_wall_motion_set(world, floor, &m);
}
/* Returns the largest difference of two arrays of n vectors over the largest number of the first. */
static double apart(const dem_real *a, const dem_real *b, int n) {
    double most = 0, off = 0;
    int i;
    for (i = 0; i < 4*n; i++) {
        if (i%4 == 3) continue;
        most = fmax(most, fabs((double)a[i]));
        off = fmax(off, fabs((double)a[i] - (double)b[i]));
    }
    return off/most;
}
/* Computes all forces and half-step velocities again. */
static void all_again(dem_world *world) {
    world->stage.forces_valid = 0;
    CHECK_EQ(demi_refresh(world), DEM_OK);
    demi_prime(world);
}

int main(int argc, char **argv) {
    int wall, motion;
    test_begin(argc, argv);
    TEST("a new wall speed changes forces on all shapes as if all contacts were evaluated again") {
        for (wall = 0; wall < WALLS; wall++)
            for (motion = 0; motion < MOTIONS; motion++) {
                dem_wall floor;
                dem_world *world = heap(wall, &floor);
                dem_real *before, *after, *half;
                size_t n;
                int count;
                CHECK_EQ(lead(world, floor, motion, wall == DISCS, 0.05), DEM_OK);
                CHECK_EQ(scene_step(world, 6), DEM_OK);
                count = world->bodies.count;
                n = 4*(size_t)count*sizeof(dem_real);
                before = (dem_real *)malloc(6*n);
                if (!before) exit(1);
                after = before + 8*count;
                half = before + 16*count;
                all_again(world);
                memcpy(before, world->bodies.force, n);
                memcpy(before + 4*count, world->bodies.torque, n);
                CHECK_EQ(lead(world, floor, motion, wall == DISCS, 0.15), DEM_OK);
                CHECK(world->stage.forces_valid && world->stage.primed && world->stage.list_valid);
                memcpy(after, world->bodies.force, n);
                memcpy(after + 4*count, world->bodies.torque, n);
                memcpy(half, world->bodies.half_vel, n);
                memcpy(half + 4*count, world->bodies.half_spin, n);
                CHECK(apart(before, after, 2*count) > 1e-3);
                all_again(world);
                /* round-off, because forces are subtracted and added */
                CHECK_NEAR(apart(world->bodies.force, after, count), 0, fine ? 1e-12 : 1e-4);
                CHECK_NEAR(apart(world->bodies.torque, after + 4*count, count), 0, fine ? 1e-12 : 1e-4);
                CHECK_NEAR(apart(world->bodies.half_vel, half, count), 0, fine ? 1e-12 : 1e-4);
                CHECK_NEAR(apart(world->bodies.half_spin, half + 4*count, count), 0, fine ? 1e-12 : 1e-4);
                free(before);
                dem_world_destroy(world);
            }
    }
    TEST("a wall led at every step calls a law 3 times per wall contact, once per other contact") {
        for (motion = 0; motion < MOTIONS; motion++) {
            dem_wall floor;
            dem_world *world = heap(LAW, &floor);
            long once, led, points = 0;
            int d, k;
            CHECK_EQ(lead(world, floor, motion, 0, 0.05), DEM_OK);
            CHECK_EQ(scene_step(world, 6), DEM_OK);
            called = 0;
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            once = called;
            for (d = 0; d < world->domain_count; d++)
                for (k = 0; k < world->domains[d].persistent; k++) points += demi_persistent_of(world, d)[k].b < 0;
            CHECK(points > 20 && points < once/2);
            CHECK_EQ(lead(world, floor, motion, 0, 0.06), DEM_OK);
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            led = called - once;
            CHECK_NEAR((double)(led - once), 2.0*(double)points, 0.1*(double)points);
            dem_world_destroy(world);
        }
    }
    TEST("a led wall gives the same bits after a restart") {
        for (wall = PLANE; wall <= MESH; wall++)
            for (motion = 0; motion < MOTIONS; motion++) {
                uint64_t hash[2];
                int way, k;
                for (way = 0; way < 2; way++) {
                    dem_wall floor;
                    dem_world *world = heap(wall, &floor);
                    for (k = 0; k < 60; k++) {
                        CHECK_EQ(lead(world, floor, motion, 0, 0.05 + 0.001*k), DEM_OK);
                        if (way && k == 30) {
                            CHECK_EQ(dem_checkpoint_write(world, "build/tmp/steering.dem"), DEM_OK);
                            dem_world_destroy(world);
                            world = heap(wall, &floor);
                            CHECK_EQ(lead(world, floor, motion, 0, 0.1), DEM_OK);
                            CHECK_EQ(dem_checkpoint_read(world, "build/tmp/steering.dem"), DEM_OK);
                        }
                        CHECK_EQ(scene_step(world, 1), DEM_OK);
                    }
                    hash[way] = dem_world_hash_get(world);
                    dem_world_destroy(world);
                }
                remove("build/tmp/steering.dem");
                CHECK(hash[0] == hash[1]);
            }
    }
    return test_end();
}
