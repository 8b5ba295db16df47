/* What goes on after slabs were collected into a world, or were created from one that was changed: as in one world. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* The position, velocity and spin of a body are the same in two worlds, bit for bit. */
static int alike(const dem_world *a, const dem_world *b, dem_body body) {
    const dem_body_state x = scene_state(a, body), y = scene_state(b, body);
    return !memcmp(&x.position, &y.position, sizeof x.position) && !memcmp(&x.velocity, &y.velocity, sizeof x.velocity) &&
        !memcmp(&x.spin, &y.spin, sizeof x.spin);
}
/* A grain of 1 mm at a height z (m) that falls onto a floor at 0.2 m/s and slips on it. */
static dem_world *slipping(int integrator, double z, dem_body *grain, dem_wall *floor) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material stuff;
    desc.gravity = at(0, 0, -9.81);
    desc.dt = DEM_R(5e-6);
    desc.integrator = (dem_integrator)integrator;
    world = dem_world_create(&desc);
    stuff = scene_material(world, 1e7, 0.5, 0.3, 0);
    *floor = dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
    *grain = dem_sphere_add(world, stuff, DEM_R(1e-3), at(0, 0, z));
    scene_move(world, *grain, at(0.1, 0, -0.2), at(0, 0, 50));
    return world;
}
/* Runs a world, in one slab if `slab`. */
static void go(dem_world *world, int slab, int steps) {
    dem_slabs_desc d = DEM_SLABS_DESC;
    dem_slabs *slabs;
    d.count = 1;
    if (!slab) { CHECK_EQ(scene_step(world, steps), DEM_OK); return; }
    slabs = dem_slabs_create(world, &d);
    CHECK_EQ(dem_slabs_step(slabs, steps), DEM_OK);
    CHECK_EQ(dem_slabs_collect(slabs, world), DEM_OK);
    dem_slabs_destroy(slabs);
}
static void attracts(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    f->normal = 200*c->overlap - DEM_R(1e-3);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a scene that has run in slabs from its first step goes on with the bits of one world, for any integrator") {
        int integrator, again;
        for (integrator = 0; integrator < 5; integrator++)
            for (again = 0; again < 2; again++) {           /* in the world; in slabs that are created again */
                dem_body grain;
                dem_wall floor;
                dem_world *one = slipping(integrator, 0.999e-3, &grain, &floor);
                dem_world *other = slipping(integrator, 0.999e-3, &grain, &floor);
                go(one, 0, 20);
                go(other, 1, 20);
                CHECK_EQ(dem_counters_get(one).wall_contacts, 1);
                go(one, 0, 20);
                go(other, again, 20);
                CHECK(alike(one, other, grain));
                dem_world_destroy(one);
                dem_world_destroy(other);
            }
    }
    TEST("slabs that are created after a pair of materials was changed start as one world, for any integrator") {
        int integrator;
        for (integrator = 0; integrator < 5; integrator++) {
            dem_body grain;
            dem_wall floor;
            dem_world *world[2];
            int k;
            for (k = 0; k < 2; k++) {
                dem_material stuff;
                dem_pair pair;
                stuff.id = 1;
                world[k] = slipping(integrator, 0.999e-3, &grain, &floor);
                go(world[k], 0, 20);
                dem_pair_get(world[k], stuff, stuff, &pair);
                pair.friction = DEM_R(0.9);
                pair.restitution = DEM_R(0.1);
                CHECK_EQ(dem_pair_set(world[k], stuff, stuff, &pair), DEM_OK);
                go(world[k], k, 20);
            }
            CHECK(alike(world[0], world[1], grain));
            for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
        }
    }
    TEST("a belt that starts in a world collected from slabs drags what came onto it there, from the first step on") {
        int integrator;
        for (integrator = 0; integrator < 5; integrator++) {
            dem_body grain;
            dem_wall floor;
            dem_world *world[2];
            int k;
            for (k = 0; k < 2; k++) {
                world[k] = slipping(integrator, 1.002e-3, &grain, &floor);
                go(world[k], 0, 1);
                CHECK_EQ(dem_counters_get(world[k]).wall_contacts, 0);
                go(world[k], k, 20);
                CHECK_EQ(dem_candidates_rebuild(world[k]), DEM_OK);
                CHECK_EQ(dem_wall_surface_velocity_set(world[k], floor, at(0, 0.3, 0)), DEM_OK);
                go(world[k], 0, 1);
                CHECK_EQ(dem_counters_get(world[k]).wall_contacts, 1);
                go(world[k], 0, 1);
            }
            CHECK(alike(world[0], world[1], grain));
            for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
        }
    }
    TEST("a grain that a feed inserts within the range of a law is attracted at once, in a slab as in one world") {
        dem_world *world[2];
        dem_body resting;
        int k;
        for (k = 0; k < 2; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_feed_desc d = DEM_FEED_DESC;
            dem_material stuff;
            desc.dt = DEM_R(1e-5);
            desc.law = attracts;
            desc.law_stiffness = 200;
            desc.law_range = DEM_R(5e-4);
            world[k] = dem_world_create(&desc);
            stuff = scene_material(world[k], 1e7, 0.5, 0, 0);
            resting = dem_sphere_add(world[k], stuff, DEM_R(1e-2), at(0, 0, 0));
            d.material = stuff;
            d.class_count = 1;
            d.radius[0] = DEM_R(1e-2);
            d.amount[0] = 1;
            d.limited = 1;
            d.start = 20*1e-5 - 1e-9;
            d.box = box_of(0.0202, 0, 0, 0.0202, 0, 0);
            CHECK(dem_feed_add(world[k], &d).id);
            go(world[k], 0, 20);
            go(world[k], k, 1);
            CHECK_EQ(dem_body_counts_get(world[k]).present, 2);
        }
        CHECK((double)scene_state(world[0], resting).position.x > 0);
        CHECK(alike(world[0], world[1], resting));
        for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
    }
    TEST("slabs collected before their first step have the history of every contact, and so has a file of that world") {
        const char *path = "build/tmp/collected.dem";
        dem_slabs_desc d = DEM_SLABS_DESC;
        dem_body grain;
        dem_wall floor;
        dem_world *from = slipping(0, 0.999e-3, &grain, &floor), *to[2];
        dem_slabs *slabs;
        int k;
        for (k = 0; k < 2; k++) to[k] = slipping(0, 0.999e-3, &grain, &floor);
        go(from, 0, 20);
        d.count = 1;
        slabs = dem_slabs_create(from, &d);
        CHECK_EQ(dem_slabs_collect(slabs, to[0]), DEM_OK);
        dem_slabs_destroy(slabs);
        CHECK_EQ(dem_world_hash_get(to[0]), dem_world_hash_get(from));
        CHECK_EQ(dem_checkpoint_write(to[0], path), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(to[1], path), DEM_OK);
        CHECK_EQ(dem_world_hash_get(to[1]), dem_world_hash_get(from));
        remove(path);
        for (k = 0; k < 2; k++) dem_world_destroy(to[k]);
        dem_world_destroy(from);
    }
    TEST("a grain that changes slab in the first list keeps the springs of its contact with the floor") {
        dem_world *world[2];
        dem_body grain[2];
        dem_material stuff = {1};
        dem_wall floor;
        double was, is;
        int k;
        for (k = 0; k < 2; k++) {
            dem_slabs_desc d = DEM_SLABS_DESC;
            dem_slabs *slabs;
            world[k] = slipping(0, 0.999e-3, &grain[0], &floor);
            grain[1] = dem_sphere_add(world[k], stuff, DEM_R(1e-3), at(-0.0021, 0, 0.1));
            go(world[k], 0, 20);
            d.count = 3;
            scene_move(world[k], grain[0], at(0, 0, 0), at(0, 0, 0));      /* its spring is what moves it */
            slabs = k ? dem_slabs_create(world[k], &d) : 0;
            CHECK_EQ(k ? dem_slabs_step(slabs, 1) : dem_world_step(world[k], 1), DEM_OK);
            if (!k) continue;
            CHECK_EQ(dem_slabs_collect(slabs, world[k]), DEM_OK);
            dem_slabs_destroy(slabs);
        }
        was = (double)scene_state(world[0], grain[0]).velocity.x;
        is = (double)scene_state(world[1], grain[0]).velocity.x;
        CHECK(was < -1e-6 || was > 1e-6);
        CHECK_NEAR(is, was, 1e-6*fabs(was));
        for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
    }
    TEST("a collected world counts the contacts of the slabs' last step, not those of its own") {
        dem_slabs_desc d = DEM_SLABS_DESC;
        for (d.count = 1; d.count < 4; d.count++) {
            dem_world *world[3];                   /* one world; the one dealt to slabs; one that collects */
            dem_material stuff = {1};
            dem_slabs *slabs;
            dem_body grain;
            dem_wall floor;
            int k;
            for (k = 0; k < 3; k++) {
                world[k] = slipping(0, k < 2 ? 0.999e-3 : 0.01, &grain, &floor);
                dem_sphere_add(world[k], stuff, DEM_R(1e-3), at(0.00199, 0, k < 2 ? 0.999e-3 : 0.01));
                dem_sphere_add(world[k], stuff, DEM_R(1e-3), at(0.1, 0, k < 2 ? 0.999e-3 : 0.02));
                go(world[k], 0, 2);
            }
            CHECK_EQ(dem_counters_get(world[2]).wall_contacts, 0);
            go(world[0], 0, 2);
            slabs = dem_slabs_create(world[1], &d);
            CHECK_EQ(dem_slabs_step(slabs, 2), DEM_OK);
            CHECK_EQ(dem_slabs_collect(slabs, world[2]), DEM_OK);
            dem_slabs_destroy(slabs);
            CHECK_EQ(dem_candidates_rebuild(world[2]), DEM_OK);
            CHECK_EQ(dem_counters_get(world[0]).contacts, 1);
            CHECK_EQ(dem_counters_get(world[0]).wall_contacts, 3);
            CHECK_EQ(dem_counters_get(world[2]).contacts, 1);
            CHECK_EQ(dem_counters_get(world[2]).wall_contacts, 3);
            slabs = dem_slabs_create(world[0], &d);        /* it is what it was before, too */
            CHECK_EQ(dem_slabs_collect(slabs, world[2]), DEM_OK);
            dem_slabs_destroy(slabs);
            CHECK_EQ(dem_candidates_rebuild(world[2]), DEM_OK);
            CHECK_EQ(dem_counters_get(world[2]).wall_contacts, 3);
            for (k = 0; k < 3; k++) dem_world_destroy(world[k]);
        }
    }
    TEST("a servo wall that presses a grain knows its contact in the first step of slabs, as in one world") {
        dem_body grain;
        dem_wall floor;
        dem_servo s[2];
        int k;
        for (k = 0; k < 2; k++) {
            dem_motion m = DEM_MOTION;
            dem_world *world = slipping(0, 0.999e-3, &grain, &floor);
            m.kind = DEM_MOTION_SERVO;
            m.velocity = at(0, 0, 0.5);
            m.load = DEM_R(0.2);
            CHECK_EQ(dem_wall_motion_set(world, floor, &m), DEM_OK);
            go(world, 0, 20);
            go(world, k, 1);
            CHECK_EQ(dem_wall_servo_get(world, floor, &s[k]), DEM_OK);
            dem_world_destroy(world);
        }
        CHECK(s[0].stiffness > 0);
        CHECK(s[1].stiffness == s[0].stiffness && s[1].speed == s[0].speed);
    }
    TEST("a servo wall counts the contact of a grain once when the grain goes to another slab and is lent back") {
        double speed[2] = {0, 0}, stiffness[2] = {0, 0};
        int image, part;
        for (image = 0; image < 2; image++) {
            dem_world_desc d = DEM_WORLD_DESC;
            dem_material_desc m = DEM_MATERIAL_DESC;
            dem_sieve_desc sieve = DEM_SIEVE_DESC;
            dem_slabs_desc cut = DEM_SLABS_DESC;
            dem_motion push = DEM_MOTION;
            dem_material stuff;
            dem_wall lid;
            dem_servo s;
            dem_body grain;
            dem_body_state state;
            dem_world *w;
            d.dt = DEM_R(1.6e-6);
            w = dem_world_create(&d);
            m.density = 2000; m.young = DEM_R(5e6); m.restitution = DEM_R(0.8);
            stuff = dem_material_add(w, &m);
            sieve.kind = DEM_SIEVE_SLOTS; sieve.aperture = DEM_R(0.001); sieve.bar = DEM_R(0.0007);
            dem_wall_sieve_add(w, stuff, &sieve);
            dem_sphere_add(w, stuff, DEM_R(0.001), at(0, -0.007, 0));
            grain = dem_sphere_add(w, stuff, DEM_R(0.0012), at(0, -0.004, 0.001));
            CHECK_EQ(dem_body_get(w, grain, &state), DEM_OK);
            state.velocity = at(0, 0, 0.1);
            CHECK_EQ(dem_body_set(w, grain, &state), DEM_OK);
            lid = dem_wall_plane_add(w, stuff, at(0, 0, 0.0025), at(0, 0, -1));
            push.kind = DEM_MOTION_SERVO; push.velocity = at(0, 0, -0.5); push.load = 80; push.area = DEM_R(0.0002);
            CHECK_EQ(dem_wall_motion_set(w, lid, &push), DEM_OK);
            cut.count = 3; cut.axis = 1;
            for (part = 0; part < 2; part++) {     /* slabs begin again after 106 steps */
                dem_slabs *slabs = image ? dem_slabs_create(w, &cut) : 0;
                const int n = part ? 1 : 106;
                CHECK_EQ(slabs ? dem_slabs_step(slabs, n) : dem_world_step(w, n), DEM_OK);
                if (slabs) CHECK_EQ(dem_slabs_collect(slabs, w), DEM_OK);
                dem_slabs_destroy(slabs);
            }
            CHECK_EQ(dem_wall_servo_get(w, lid, &s), DEM_OK);
            speed[image] = (double)s.speed; stiffness[image] = (double)s.stiffness;
            dem_world_destroy(w);
        }
        CHECK(stiffness[0] > 0);
        CHECK_NEAR(stiffness[1], stiffness[0], 1e-6*stiffness[0]);
        CHECK_NEAR(speed[1], speed[0], 1e-6*fabs(speed[0]));
    }
    return test_end();
}
