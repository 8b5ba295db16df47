/* Feeds and outlets: what comes in by number and by mass, and what goes out. The relation "counts" (tests/relations) and
   build/screener --study hour check that between the two nothing is lost. The Makefile makes domains small
   (DEM_DOMAIN_BODIES), so that newcomers have neighbours in several. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../../examples/sorting.h"
#include "../test.h"
#include "../scene.h"

static dem_world *world_of(double g, double dt) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.normal_law = DEM_NORMAL_LINEAR;
    desc.gravity = at(0, 0, -g);
    desc.dt = (dem_real)dt;
    return dem_world_create(&desc);
}
static dem_material soft(dem_world *world, double stiffness) {
    dem_material_desc m = DEM_MATERIAL_DESC;
    m.density = 2500;
    m.poisson = DEM_R(0.25);
    m.stiffness = (dem_real)stiffness;
    m.restitution = DEM_R(0.4);
    m.friction = DEM_R(0.2);
    return dem_material_add(world, &m);
}
static dem_feed_desc feed_of(dem_material material, double rate) {
    dem_feed_desc f;
    memset(&f, 0, sizeof f);
    f.material = material;
    f.class_count = 3;
    f.radius[0] = DEM_R(0.002); f.radius[1] = DEM_R(0.003); f.radius[2] = DEM_R(0.004);
    f.amount[0] = 30; f.amount[1] = 20; f.amount[2] = 10;
    f.rate = rate;
    f.box = box_of(-0.05, -0.05, 0.2, 0.05, 0.05, 0.25);
    f.velocity = at(0, 0, -1);
    f.spread = DEM_R(0.1);
    f.seed = 11;
    return f;
}
/* Grains of each class in the world. */
static void present(const dem_world *world, const dem_feed_desc *f, int *count) {
    const dem_bodies b = dem_bodies_get(world);
    int i, k;
    for (k = 0; k < f->class_count; k++) count[k] = 0;
    for (i = 0; i < b.count; i++)
        for (k = 0; k < f->class_count; k++)
            count[k] += fabs((double)b.positions[4*i + 3] - (double)f->radius[k]) < 1e-6;
}

/* Contacts of bodies with others, in slots after the first `count`. */
static int touching_beyond(const dem_world *world, uint32_t count) {
    static dem_contact_info c[2000];
    const int n = dem_contacts_get(world, c, 2000);
    int i, found = 0;
    for (i = 0; i < n; i++) found += c[i].a.slot > count || c[i].b.slot > count;
    return found;
}

static dem_vec3 no_force(dem_vec3 position, dem_vec3 velocity, dem_real radius, dem_real mass, double time,
                         void *user) {
    (void)position; (void)velocity; (void)radius; (void)mass; (void)time; (void)user;
    return at(0, 0, 0);
}
/* A law with a range whose force is 1 mN of attraction across the gap, and a spring at touch. */
static void pulls(const dem_contact *c, dem_real *memory, dem_contact_force *f) {
    (void)memory;
    f->normal = c->overlap > 0 ? 1000*c->overlap : DEM_R(-1e-3);
}

int main(int argc, char **argv) {
    const dem_feed first = {1};
    test_begin(argc, argv);

    TEST("a feed of 100 grains/s inserts each grain when it is due, with random sizes by number") {
        dem_world *world = world_of(0, 1e-3);
        dem_material stuff = soft(world, 1);
        const dem_feed_desc d = feed_of(stuff, 100);
        dem_feed feed = dem_feed_add(world, &d);
        dem_feed_state s;
        double share, n = 3000;
        int i, k;
        for (i = 0; i < 30000; i++) {
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            if (i%1000 == 0) {
                dem_feed_get(world, feed, &s);
                CHECK_NEAR((double)s.total, 100*i*1e-3, 1e-9 + (i%10 ? 1 : 0));
            }
            /* they fly on without gravity: those far away are taken out */
            while (dem_bodies_get(world).count > 20) {
                dem_body_counts b;
                dem_body_remove(world, dem_body_id_get(world, 0));
                b = dem_body_counts_get(world);
                CHECK(b.inserted == b.present + b.removed + b.left);
            }
        }
        dem_feed_get(world, feed, &s);
        CHECK_NEAR((double)s.total, n, 1);
        for (k = 0; k < 3; k++) {                /* 30 : 20 : 10 */
            share = (3 - k)/6.0;
            CHECK_NEAR((double)s.fed[k]/n, share, 3*sqrt(share*(1 - share)/n));
        }
        dem_world_destroy(world);
    }

    TEST("a feed by mass keeps its rate in kg/s and its shares of mass") {
        dem_world *world = world_of(0, 1e-3);
        dem_material stuff = soft(world, 1);
        dem_feed_desc d = feed_of(stuff, 0.03);
        dem_feed feed;
        dem_feed_state s;
        double m, volume = 0;
        int i, k;
        d.by_mass = 1;
        feed = dem_feed_add(world, &d);
        for (i = 0; i < 20000; i++) {
            scene_step(world, 1);
            while (dem_bodies_get(world).count > 20)
                dem_body_remove(world, dem_body_id_get(world, 0));
        }
        dem_feed_get(world, feed, &s);
        CHECK_NEAR(s.mass, 0.03*20, 2500*4.19*0.004*0.004*0.004);      /* within a grain */
        for (k = 0; k < 3; k++) volume += (double)s.fed[k]*pow((double)d.radius[k], 3);
        for (k = 0; k < 3; k++) {
            m = (double)s.fed[k]*pow((double)d.radius[k], 3)/volume;
            CHECK_NEAR(m, (3 - k)/6.0, 0.04);    /* 750 of the large ones: 1/sqrt(750) */
        }
        dem_world_destroy(world);
    }

    TEST("a feed by mass keeps its rate with grains of any mass") {
        double radius;
        for (radius = 4e-3; radius > 1e-6; radius /= 20) {
            const double one = 2500*4/3.0*3.14159265358979*radius*radius*radius;
            dem_world *world = world_of(0, 1e-3);
            dem_feed_desc d = DEM_FEED_DESC;
            dem_feed_state s;
            dem_feed feed;
            d.material = soft(world, 1500*one);    /* alike contact times */
            d.class_count = 1;
            d.radius[0] = (dem_real)radius;
            d.amount[0] = 1000*one;
            d.by_mass = 1;
            d.rate = one/10e-3;                    /* a grain in ten steps */
            d.box = box_of(0, 0, 0, 1, 1, 1);
            feed = dem_feed_add(world, &d);
            CHECK_EQ(scene_step(world, 25), DEM_OK);
            dem_feed_get(world, feed, &s);
            CHECK_EQ((int)s.total, 2);
            dem_world_destroy(world);
        }
    }

    TEST("a limited feed inserts exactly its amount, at once or at a rate, and is then done") {
        int way;
        for (way = 0; way < 2; way++) {
            dem_world *world = world_of(9.81, 2e-5);
            dem_material stuff = soft(world, 1000);
            dem_feed_desc d = feed_of(stuff, way ? 2000 : 0);
            dem_feed_state s;
            dem_feed feed;
            int here[3];
            d.limited = 1;
            d.round = way;
            dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
            feed = dem_feed_add(world, &d);
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            dem_feed_get(world, feed, &s);
            if (!way) CHECK(s.total > 40);
            CHECK_EQ((int)s.total + (int)s.waiting, way ? 0 : 60);
            CHECK_EQ(scene_step(world, 4000), DEM_OK);
            dem_feed_get(world, feed, &s);
            present(world, &d, here);
            CHECK_EQ(here[0], 30);
            CHECK_EQ(here[1], 20);
            CHECK_EQ(here[2], 10);
            CHECK_EQ(s.done, 1);
            CHECK_EQ((int)s.waiting, 0);
            CHECK(dem_counters_get(world).overlap_max < DEM_R(0.2));   /* nobody began inside another */
            dem_world_destroy(world);
        }
    }

    TEST("dem_world_settle waits until every feed has inserted its grains") {
        /* all at once, at a rate, from 0.2 s on, by mass, until 0.15 s; each under springs and impulses */
        int way;
        for (way = 0; way < 10; way++) {
            const int kind = way/2;
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_feed_desc d = DEM_FEED_DESC;
            dem_feed_state s;
            dem_world *world;
            dem_feed feed;
            desc.gravity = at(0, 0, -9.81);
            if (way % 2) { desc.response = DEM_RESPONSE_IMPULSES; desc.dt = DEM_R(1e-3); }
            world = dem_world_create(&desc);
            d.material = scene_material(world, 1e6, 0.3, 0.4, 0.1);
            d.class_count = 1;
            d.radius[0] = DEM_R(0.002);
            d.amount[0] = kind == 3 ? 12*2500*4.0/3*3.14159265358979*8e-9 : 12;
            d.limited = kind != 4;
            d.by_mass = kind == 3;
            d.rate = kind == 0 ? 0 : kind == 3 ? d.amount[0]*10 : 100;
            d.start = kind == 2 ? 0.2 : 0;
            d.end = kind == 4 ? 0.125 : 0;
            d.box = box_of(-0.02, -0.02, 0.01, 0.02, 0.02, 0.02);
            dem_wall_plane_add(world, d.material, at(0, 0, 0), at(0, 0, 1));
            feed = dem_feed_add(world, &d);
            CHECK_EQ(dem_world_settle(world, 2, 0, 0, 0), DEM_OK);
            CHECK_EQ(dem_feed_get(world, feed, &s), DEM_OK);
            CHECK_EQ(s.done, 1);
            CHECK_EQ((int)s.total, 12);
            CHECK_EQ(dem_bodies_get(world).count, 12);
            CHECK(dem_world_time_get(world) > d.start + (d.rate > 0 ? 0.1 : 0));
            CHECK((double)dem_counters_get(world).speed_max < 0.1*sqrt(2*9.81*0.002));
            dem_world_destroy(world);
        }
    }

    TEST("dem_world_settle names a feed that never ends or is not done in time") {
        dem_world *world = world_of(9.81, 1e-4);
        dem_material stuff = soft(world, 100);
        dem_feed_desc d = feed_of(stuff, 1000);
        dem_feed_add(world, &d);
        CHECK_EQ(dem_world_settle(world, 0.1, 0, 0, 0), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "feed 1 has limited 0 and end 0 s");
        CHECK_EQ((int)dem_world_steps_get(world), 0);
        dem_world_destroy(world);
        world = world_of(0, 1e-4);
        stuff = soft(world, 100);
        d = feed_of(stuff, 1000);
        d.limited = 1;
        d.velocity = at(0, 0, 0);
        d.spread = 0;
        d.box = box_of(0, 0, 0, 0.01, 0.01, 0.01);              /* no room for all 60 */
        dem_feed_add(world, &d);
        CHECK_EQ(dem_world_settle(world, 0.1, 0, 0, 0), DEM_ERROR_ARGUMENT);    /* what is slow? */
        CHECK_EQ(dem_world_settle(world, 0.1, DEM_R(1e-3), 0, 0), DEM_ERROR_STOPPED);
        CHECK_STR(dem_world_error_get(world), "feed 1 is not done");
        CHECK_STR(dem_world_error_get(world), "waiting for room");
        CHECK_EQ(dem_world_settle(world, 1e-20, DEM_R(1e-3), 0, 0), DEM_ERROR_STOPPED);     /* and ends */
        dem_world_destroy(world);
    }

    TEST("errors distinguish an id never given from a removed wall, and a feed without classes gets advice") {
        dem_world *world = world_of(9.81, 1e-4);
        dem_material stuff = soft(world, 100);
        const dem_wall wall = dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
        dem_feed_desc d = feed_of(stuff, 1000);
        dem_feed_state fed;
        dem_outlet_state out;
        dem_wall other;
        dem_pose pose;
        const dem_feed feed = {2};
        const dem_outlet outlet = {2};
        other.id = 7;
        CHECK_EQ(dem_wall_pose_get(world, other, &pose), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "wall 7 does not exist, ids in this world are 1 to 1");
        CHECK_EQ(dem_wall_remove(world, wall), DEM_OK);
        CHECK_EQ(dem_wall_pose_get(world, wall, &pose), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "wall 1 does not exist any more, because dem_wall_remove removed it");
        CHECK_EQ(dem_feed_get(world, feed, &fed), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "check the id that dem_feed_add returned");
        CHECK_EQ(dem_outlet_get(world, outlet, &out), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "check the id that dem_outlet_add returned");
        d.class_count = 0;
        CHECK_EQ(dem_feed_add(world, &d).id, 0);
        CHECK_STR(dem_world_error_get(world), "set it to the number of entries of radius and amount");
        dem_world_destroy(world);
    }

    TEST("a feed without room holds its grains back until there is room") {
        dem_world *world = world_of(0, 1e-4);
        dem_material stuff = soft(world, 1);
        dem_feed_desc d = feed_of(stuff, 1000);
        dem_feed feed;
        dem_feed_state s;
        d.velocity = at(0, 0, 0);
        d.spread = 0;
        d.box = box_of(0, 0, 0, 0.01, 0.01, 0.01);
        feed = dem_feed_add(world, &d);
        scene_step(world, 1000);
        dem_feed_get(world, feed, &s);
        CHECK(s.total < 20);
        CHECK_NEAR((double)(s.total + s.waiting), 100, 1);
        while (dem_bodies_get(world).count) dem_body_remove(world, dem_body_id_get(world, 0));
        scene_step(world, 20);
        CHECK(dem_bodies_get(world).count > 0);
        dem_world_destroy(world);
    }

    TEST("the wall of an outlet cannot be removed, and the digest distinguishes feeds by their random state") {
        uint64_t hash[2];
        int i;
        for (i = 0; i < 2; i++) {
            dem_world *world = world_of(0, 1e-3);
            dem_material stuff = soft(world, 1);
            dem_feed_desc d = feed_of(stuff, 1);
            dem_wall wall = dem_wall_plane_add(world, stuff, at(5, 0, -3), at(0, 0, 1));
            dem_outlet_desc o;
            d.seed = (uint64_t)i;
            dem_feed_add(world, &d);
            hash[i] = dem_world_hash_get(world);
            CHECK_EQ(dem_wall_remove(world, dem_wall_plane_add(world, stuff, at(0, 0, -9), at(0, 0, 1))),
                     DEM_OK);
            memset(&o, 0, sizeof o);
            o.frame = wall;
            o.box = box_of(0, 0, 0, 1, 1, 1);
            CHECK(dem_outlet_add(world, &o).id > 0);
            CHECK_EQ(dem_wall_remove(world, wall), DEM_ERROR_ARGUMENT);
            CHECK_STR(dem_world_error_get(world), "outlet 1 moves with wall");
            dem_world_destroy(world);
        }
        CHECK(hash[0] != hash[1]);
    }

    TEST("a feed is done when its last grain is inserted: not while some wait, nor a step later") {
        dem_world *world = world_of(0, 1e-5);
        dem_material stuff = soft(world, 1000);
        dem_feed_desc d = feed_of(stuff, 1e5);
        dem_feed feed[2];
        dem_feed_state s;
        d.class_count = 1;
        d.end = 1e-3;
        d.velocity = at(1, 0, 0);
        d.spread = 0;
        d.box = box_of(0, 0, 0, 0, 0, 0);
        feed[0] = dem_feed_add(world, &d);
        d.limited = 1;
        d.rate = 0;
        d.amount[0] = 5;
        d.end = 0;
        d.box = box_of(1, 1, 1, 2, 2, 2);
        feed[1] = dem_feed_add(world, &d);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        dem_feed_get(world, feed[1], &s);
        CHECK_EQ((int)s.total, 5);
        CHECK_EQ(s.done, 1);
        CHECK_EQ(scene_step(world, 120), DEM_OK);
        dem_feed_get(world, feed[0], &s);
        CHECK((int)s.waiting > 90);
        CHECK_EQ(s.done, 0);
        d.amount[0] = 0.3;
        CHECK_EQ(dem_feed_add(world, &d).id, 0);
        CHECK_STR(dem_world_error_get(world), "which is 0.3 grains");
        dem_world_destroy(world);
    }

    TEST("a feed beyond a periodic domain finds the grains that it inserted there") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_feed_desc d;
        desc.normal_law = DEM_NORMAL_LINEAR;
        desc.dt = DEM_R(1e-5);
        desc.domain = box_of(0, 0, 0, 0.1, 0.1, 0.1);
        desc.boundary[0] = desc.boundary[1] = desc.boundary[2] = DEM_BOUNDARY_PERIODIC;
        world = dem_world_create(&desc);
        d = feed_of(soft(world, 1000), 5e4);
        d.class_count = 1;
        d.radius[0] = DEM_R(0.004);
        d.velocity = at(0, 0, 0);
        d.box = box_of(0.22, 0.22, 0.22, 0.26, 0.26, 0.26);
        dem_feed_add(world, &d);
        CHECK_EQ(scene_step(world, 400), DEM_OK);
        CHECK(dem_bodies_get(world).count > 15);
        CHECK((double)dem_counters_get(world).overlap_max < 0.1);
        dem_world_destroy(world);
    }

    TEST("outlets count by class and by wanted size, at rest and on a rotating wall") {
        dem_world *world = world_of(0, 1e-3);
        dem_material stuff = soft(world, 1);
        dem_wall wall = dem_wall_plane_add(world, stuff, at(5, 0, -3), at(0, 0, 1));
        dem_motion turn = DEM_MOTION;
        dem_outlet_desc d;
        dem_outlet outlet[2];
        dem_outlet_state s;
        sorting sorted;
        dem_body body;
        int i;
        turn.kind = DEM_MOTION_ROTATING;
        turn.axis = at(0, 0, 1);
        turn.point = at(5, 0, 0);
        turn.speed = DEM_R(3.14159265358979/2);
        dem_wall_motion_set(world, wall, &turn);
        memset(&d, 0, sizeof d);
        d.box = box_of(1, -1, -1, 2, 1, 1);
        d.class_count = 2;
        d.radius[0] = DEM_R(0.01); d.radius[1] = DEM_R(0.02);
        d.wanted_min = DEM_R(0.015);
        outlet[0] = dem_outlet_add(world, &d);
        d.frame = wall;                          /* local x turns to y in a second */
        d.box = box_of(1, -0.2, 2, 3, 0.2, 4);
        d.beyond = DEM_R(1.5);
        d.wanted_min = 0;
        outlet[1] = dem_outlet_add(world, &d);
        for (i = 0; i < 5; i++) {
            body = dem_sphere_add(world, stuff, i < 3 ? DEM_R(0.01) : DEM_R(0.021),
                                  at(0.5, 0.1*i, 0));
            scene_move(world, body, at(1, 0, 0), at(0, 0, 0));
        }
        dem_sphere_add(world, stuff, DEM_R(0.02), at(5, 2, 0));        /* taken after a second */
        dem_sphere_add(world, stuff, DEM_R(0.02), at(5, 1.4, 0));      /* not far enough out */
        scene_step(world, 450);
        dem_outlet_get(world, outlet[0], &s);
        CHECK_EQ((int)s.total, 0);
        scene_step(world, 100);
        dem_outlet_get(world, outlet[0], &s);
        CHECK_EQ((int)s.count[0], 3);
        CHECK_EQ((int)s.count[1], 2);
        CHECK_EQ((int)s.sorted, 2);
        CHECK_EQ((int)s.gangue, 3);
        CHECK_REL(s.gangue_mass, 3*2500*4/3.0*3.14159265358979e-6, 1e-6);
        CHECK_EQ(sorting_get(world, outlet, 2, &sorted), DEM_OK);
        CHECK_EQ(sorted.silent, 1);
        CHECK_REL(sorted.efficiency_number, 0.4/2, 1e-12);
        scene_step(world, 600);
        dem_outlet_get(world, outlet[1], &s);
        CHECK_EQ((int)s.total, 1);
        CHECK_EQ(dem_bodies_get(world).count, 1);
        CHECK_EQ(sorting_get(world, outlet, 2, &sorted), DEM_OK);
        CHECK_REL(sorted.efficiency_number, (0.4 + 1)/2, 1e-12);      /* eq 4.33 */
        CHECK_REL(sorted.gangue_number, 3/6.0, 1e-12);
        CHECK_REL(sorted.rate_number, 6/dem_world_time_get(world), 1e-9);
        dem_world_destroy(world);
    }

    TEST("inserted grains join the neighbour list and collide as with a list rebuilt for each, for every search") {
        static const dem_search searches[] = {DEM_SEARCH_GRID, DEM_SEARCH_ALL_PAIRS, DEM_SEARCH_LINKED_LIST};
        uint64_t hash[3], rebuilds[2] = {0, 0};
        double apart = 0;
        int way, i, s;
        for (s = 0; s < 3; s++) {
            dem_world *world[2];
            dem_feed_state f;
            for (way = 0; way < (s ? 1 : 2); way++) {    /* joining; a new list in every step */
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_material stuff;
                dem_feed_desc d;
                desc.normal_law = DEM_NORMAL_LINEAR;
                desc.gravity = at(0, 0, -9.81);
                desc.dt = DEM_R(1e-5);
                desc.skin = DEM_R(2e-3);
                desc.search = searches[s];
                desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
                desc.domain = box_of(-0.03, -0.03, 0, 0.03, 0.03, 0.1);
                world[way] = dem_world_create(&desc);
                stuff = soft(world[way], 1000);
                dem_wall_plane_add(world[way], stuff, at(0, 0, 0), at(0, 0, 1));
                scene_block(world[way], stuff, 12, 12, 4, 2e-3, 1, 0.02, 3);
                d = feed_of(stuff, 12500);                   /* one in eight steps, some onto the bed */
                d.class_count = 1;
                d.box = box_of(-0.03, -0.03, 0.02, 0.03, 0.03, 0.04);
                dem_feed_add(world[way], &d);
                for (i = 0; i < 800; i++) {
                    if (way) world[way]->margin.gone = 1;
                    CHECK_EQ(scene_step(world[way], 1), DEM_OK);
                }
                dem_feed_get(world[way], first, &f);
                CHECK(f.total > 90);
                CHECK(touching_beyond(world[way], 576) > 5);
                if (!s) rebuilds[way] = dem_counters_get(world[way]).rebuilds;
            }
            if (!s) {
                const dem_bodies b = dem_bodies_get(world[0]);
                for (i = 0; i < b.count; i++) {
                    dem_body_state x = scene_state(world[0], dem_body_id_get(world[0], i));
                    dem_body_state y = scene_state(world[1], dem_body_id_get(world[0], i));
                    const double dx = (double)(x.position.x - y.position.x);
                    const double dz = (double)(x.position.z - y.position.z);
                    if (fabs(dx) < 0.03) apart = DEMI_MAX(apart, fabs(dx));
                    apart = DEMI_MAX(apart, fabs(dz));
                }
                dem_world_destroy(world[1]);
            }
            hash[s] = dem_world_hash_get(world[0]);
            dem_world_destroy(world[0]);
        }
        CHECK(rebuilds[1] > 790);
        CHECK(rebuilds[0] < 12);
        CHECK(apart < (sizeof(dem_real) == 4 ? 2e-4 : 1e-12));     /* rounding, grown in collisions */
        CHECK(hash[0] == hash[1]);                                 /* whatever the search */
        CHECK(hash[0] == hash[2]);
    }

    TEST("an outlet removes a grain within half a skin or 64 steps, with hardly any extra list rebuild") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material stuff;
        dem_outlet_desc o;
        uint64_t rebuilds;
        double deepest = 0;
        int i, k, most = 0, gone = 0;
        static int since[400];
        desc.normal_law = DEM_NORMAL_LINEAR;
        desc.dt = DEM_R(1e-5);
        desc.skin = DEM_R(1e-3);
        world = dem_world_create(&desc);
        stuff = soft(world, 1000);
        for (i = 0; i < 400; i++)                /* one by one through x = 0, in 1500 steps, at 0.2 m/s */
            scene_move(world, dem_sphere_add(world, stuff, DEM_R(1e-3), at(-7.5e-6*i, 3e-3*i, 0)),
                       at(0.2, 0, 0), at(0, 0, 0));
        memset(&o, 0, sizeof o);
        o.box = box_of(0, -10, -10, 10, 10, 10);
        dem_outlet_add(world, &o);
        scene_step(world, 1);
        rebuilds = dem_counters_get(world).rebuilds;
        for (i = 0; i < 1600; i++) {
            dem_bodies b;
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            b = dem_bodies_get(world);
            for (k = 0; k < b.count; k++)
                if (b.positions[4*k] > 0) {
                    const uint32_t slot = dem_body_id_get(world, k).slot - 1;
                    deepest = DEMI_MAX(deepest, (double)b.positions[4*k]);
                    since[slot]++;
                    most = DEMI_MAX(most, since[slot]);
                }
        }
        gone = (int)dem_body_counts_get(world).left;
        CHECK_EQ(gone, 400);
        CHECK(most > 0 && most <= 64);
        CHECK(deepest < 0.5e-3 + 0.2*1e-5);
        CHECK((int)(dem_counters_get(world).rebuilds - rebuilds) <= 1600/64 + 8);
        dem_world_destroy(world);
    }

    TEST("a mixture feeds classes of different material, shape and size distribution in their fractions and "
         "orientations") {
        dem_world *world = world_of(0, 1e-4);
        const dem_material plastic = soft(world, 1), metal = soft(world, 1);
        dem_sizes fine_sizes = DEM_SIZES, wide = DEM_SIZES;
        dem_feed_desc d = feed_of(plastic, 0);
        dem_real points[24];
        dem_feed_state s;
        dem_feed feed;
        double sum[3] = {0, 0, 0}, square[3] = {0, 0, 0}, mass = 0, up = 0;
        int count[3] = {0, 0, 0}, i;
        for (i = 0; i < 24; i++) points[i] = (dem_real)((i%3 == 0 ? i/3 & 1 : i%3 == 1 ? i/3 & 2 : i/3 & 4) ? 1 : -1);
        fine_sizes.kind = DEM_SIZES_EXPONENTIAL;
        fine_sizes.by_count = 1;
        fine_sizes.min = DEM_R(0.001);
        fine_sizes.scale = DEM_R(0.0015);
        wide.kind = DEM_SIZES_NORMAL;
        wide.by_count = 1;
        wide.median = DEM_R(0.002);
        wide.deviation = DEM_R(0.0002);
        d.rate = 20000;
        d.spread = 0;
        d.velocity = at(0, 0, 0);
        d.box = box_of(-0.2, -0.2, 0, 0.2, 0.2, 0.1);
        d.materials[1] = d.materials[2] = metal;
        d.shapes[1] = dem_shape_ellipsoid_add(world, at(1, 1, 2));
        d.shapes[2] = dem_shape_polyhedron_add(world, 8, points);
        d.sizes[0] = &fine_sizes;
        d.sizes[2] = &wide;
        feed = dem_feed_add(world, &d);
        CHECK(feed.id);
        memset(&fine_sizes, 0, sizeof fine_sizes);      /* copied */
        for (i = 0; i < 2000; i++) {
            if (scene_step(world, 1) != DEM_OK) { CHECK(0); break; }
            while (dem_body_counts_get(world).present) {
                const dem_bodies b = dem_bodies_get(world);
                const dem_body id = dem_body_id_get(world, 0);
                const int k = b.shapes[0];
                const double r = cbrt((double)b.masses[0]/2500*3/4/3.14159265358979);
                CHECK_EQ(b.materials[0], k ? metal.id : plastic.id);
                sum[k] += r;
                square[k] += r*r;
                count[k]++;
                mass += (double)b.masses[0];
                if (k == 1) up += pow((double)dem_quat_rotate(scene_state(world, id).orientation, at(0, 0, 1)).z, 2);
                dem_body_remove(world, id);
            }
        }
        dem_feed_get(world, feed, &s);
        CHECK_EQ(s.total, count[0] + count[1] + count[2]);
        CHECK_NEAR(s.mass/mass, 1, 1e-6);
        CHECK(s.total > 3500);
        for (i = 0; i < 3; i++) {
            const double share = (3 - i)/6.0, n = (double)s.total;
            CHECK_EQ(s.fed[i], count[i]);
            CHECK_NEAR(count[i]/n, share, 4*sqrt(share*(1 - share)/n));
        }
        /* Zhang's: mean 1.5 mm, deviation the mean over the least; normal: 2 mm and .2 mm */
        CHECK_NEAR(sum[0]/count[0]*1e3, 1.5, 4*0.5/sqrt(count[0]));
        CHECK_NEAR(sqrt(square[0]/count[0] - pow(sum[0]/count[0], 2))*1e3, 0.5, 0.06);
        CHECK_NEAR(sum[1]/count[1]*1e3, 3, 1e-3);
        CHECK_NEAR(sum[2]/count[2]*1e3, 2, 4*0.2/sqrt(count[2]));
        CHECK_NEAR(sqrt(square[2]/count[2] - pow(sum[2]/count[2], 2))*1e3, 0.2, 0.02);
        CHECK_NEAR(up/count[1], 1.0/3, 4*0.3/sqrt(count[1]));
        dem_world_destroy(world);
    }

    TEST("a mixture resumes from a checkpoint and in slabs with the same bits; walls that cannot touch its shapes are "
         "rejected") {
        const char *path = "build/tmp/mixture.dem";
        uint64_t hash[3];
        int k;
        for (k = 0; k < 3; k++) {
            dem_world *world[2];
            int part;
            for (part = 0; part < 2; part++) {
                dem_material stuff;
                dem_sizes sizes = DEM_SIZES;
                dem_sieve_desc sieve = DEM_SIEVE_DESC;
                dem_feed_desc d;
                world[part] = world_of(9.81, 5e-6);
                stuff = soft(world[part], 1e3);
                d = feed_of(stuff, 20000);
                sizes.kind = DEM_SIZES_LOGNORMAL;
                sizes.median = DEM_R(0.003);
                sizes.spread = 0.2;
                d.sizes[0] = d.sizes[1] = &sizes;
                d.shapes[1] = dem_shape_ellipsoid_add(world[part], at(1, 1, 1.5));
                dem_wall_plane_add(world[part], stuff, at(0, 0, 0.19), at(0, 0, 1));
                CHECK(dem_feed_add(world[part], &d).id);
                sieve.kind = DEM_SIEVE_REDUCED;
                sieve.aperture = DEM_R(0.01);
                sieve.bar = DEM_R(0.002);
                CHECK(!dem_wall_sieve_add(world[part], stuff, &sieve).id);
                CHECK_STR(dem_world_error_get(world[part]), "ellipsoid");
            }
            CHECK_EQ(scene_step(world[0], 800), DEM_OK);
            if (k == 1) {
                CHECK_EQ(dem_checkpoint_write(world[0], path), DEM_OK);
                CHECK_EQ(dem_checkpoint_read(world[1], path), DEM_OK);
                CHECK_EQ(scene_step(world[1], 800), DEM_OK);
                remove(path);
            } else if (k == 2) {
                dem_slabs_desc desc = DEM_SLABS_DESC;
                dem_slabs *slabs;
                desc.count = 1;
                slabs = dem_slabs_create(world[0], &desc);
                CHECK_EQ(dem_slabs_step(slabs, 800), DEM_OK);
                CHECK_EQ(dem_slabs_collect(slabs, world[0]), DEM_OK);
                dem_slabs_destroy(slabs);
            } else CHECK_EQ(scene_step(world[0], 800), DEM_OK);
            CHECK(dem_body_counts_get(world[k == 1]).present > 50);
            CHECK_EQ(dem_candidates_rebuild(world[k == 1]), DEM_OK);
            hash[k] = dem_world_hash_get(world[k == 1]);
            CHECK(hash[k] == hash[0]);
            dem_world_destroy(world[0]);
            dem_world_destroy(world[1]);
        }
    }

    TEST("outflow and outlets remove a grain no earlier than it is there, with springs and impulses, on a wall that moves too") {
        int way, i, response;
        for (response = 0; response < 2; response++)
            for (way = 0; way < 3; way++) {             /* outflow; outlet at rest; outlet that a wall carries */
                const double dt = 1e-2, limit = 0.1004, pace = way == 2 ? -1 : 0;
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_outlet_desc outlet = DEM_OUTLET_DESC;
                dem_world *w;
                dem_material m;
                double x = 0;
                desc.response = response ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
                desc.normal_law = DEM_NORMAL_LINEAR;
                desc.dt = (dem_real)dt;
                desc.allow_large_dt = 1;
                desc.skin = DEM_R(1e-9);
                if (!way) {
                    desc.boundary[0] = DEM_BOUNDARY_OUTFLOW;
                    desc.domain = box_of(-1, -1, -1, limit, 1, 1);
                }
                w = dem_world_create(&desc);
                m = soft(w, 1);
                if (way == 2) {
                    dem_motion motion = DEM_MOTION;
                    outlet.frame = dem_wall_plane_add(w, m, at(0, 0, -0.5), at(0, 0, 1));
                    motion.kind = DEM_MOTION_TRANSLATING;
                    motion.velocity = at(pace, 0, 0);
                    CHECK_EQ(dem_wall_motion_set(w, outlet.frame, &motion), DEM_OK);
                }
                outlet.box = box_of(limit, -1, -1, 2, 1, 1);
                if (way) CHECK(dem_outlet_add(w, &outlet).id > 0);
                scene_move(w, dem_sphere_add(w, m, DEM_R(0.001), at(0, 0, 0)), at(1, 0, 0), at(0, 0, 0));
                for (i = 1; i < 30 && dem_bodies_get(w).count; i++) {
                    CHECK_EQ(scene_step(w, 1), DEM_OK);
                    x = i*dt;
                }
                CHECK(x > limit + pace*x && x - dt <= limit + pace*(x - dt) + 1e-6);
                dem_world_destroy(w);
            }
    }
    TEST("feeds and outlets with bad values are rejected with the value named") {
        dem_world *world = world_of(0, 1e-3);
        dem_material stuff = soft(world, 1);
        dem_feed_desc d = feed_of(stuff, 0);
        dem_outlet_desc o;
        dem_outlet none;
        sorting sorted;
        CHECK_EQ(dem_feed_add(world, &d).id, 0);
        CHECK_STR(dem_world_error_get(world), "needs `limited`");
        d.rate = 1;
        d.class_count = 0;
        CHECK_EQ(dem_feed_add(world, &d).id, 0);
        CHECK_STR(dem_world_error_get(world), "class_count is 0");
        d.class_count = 4;
        CHECK_EQ(dem_feed_add(world, &d).id, 0);
        CHECK_STR(dem_world_error_get(world), "class 3 has radius 0");
        d.class_count = 3;
        d.box.hi.x = -1;
        CHECK_EQ(dem_feed_add(world, &d).id, 0);
        CHECK_STR(dem_world_error_get(world), "lo is above hi");
        memset(&o, 0, sizeof o);
        o.wanted_min = 2;
        o.wanted_max = 1;
        CHECK_EQ(dem_outlet_add(world, &o).id, 0);
        CHECK_STR(dem_world_error_get(world), "wanted is 2 to 1");
        none.id = 3;
        CHECK_EQ(sorting_get(world, &none, 1, &sorted), DEM_ERROR_ARGUMENT);
        CHECK_STR(sorted.error, "outlet 3, number 1 of 1, does not exist");
        CHECK_EQ(sorting_get(world, &none, 1, 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(sorting_get(world, 0, 1, &sorted), DEM_ERROR_ARGUMENT);
        CHECK_STR(sorted.error, "outlets is null");
        CHECK_EQ(sorting_get(0, &none, 1, &sorted), DEM_ERROR_ARGUMENT);
        CHECK_STR(sorted.error, "world is null");
        dem_world_destroy(world);
    }

    TEST("an outlet with keep counts crossings of a plane in both directions by class, and its present grains") {
        dem_world *world[2];
        dem_outlet_desc d;
        dem_outlet below, only;
        dem_outlet_state s;
        dem_material a, b;
        int i, k;
        for (k = 0; k < 2; k++) {
            world[k] = world_of(9.81, 2e-5);
            a = soft(world[k], 5000);
            b = soft(world[k], 5000);
            dem_wall_plane_add(world[k], a, at(0, 0, 0), at(0, 0, 1));
            /* ten of each fall from above the plane z = .1 m, on to a floor from which the glass bounces back */
            for (i = 0; i < 10; i++) {
                dem_sphere_add(world[k], a, DEM_R(0.003), at(0.01*i, 0, 0.12));
                dem_sphere_add(world[k], b, DEM_R(0.005), at(0.02*i, 0.05, 0.13));
                dem_sphere_add(world[k], a, DEM_R(0.003), at(0.01*i, 0.1, 0.05));     /* these began below */
            }
            memset(&d, 0, sizeof d);
            d.box = box_of(-1, -1, -1, 1, 1, 0.1);
            d.keep = 1;
            d.class_count = 2;
            d.radius[0] = DEM_R(0.003);
            d.radius[1] = DEM_R(0.005);
            below = dem_outlet_add(world[k], &d);
            d.material = b;
            only = dem_outlet_add(world[k], &d);
            CHECK_EQ(below.id, 1);
            CHECK_EQ(only.id, 2);
        }
        dem_outlet_get(world[0], below, &s);
        CHECK_EQ((int)s.held_total, 10);
        CHECK_EQ((int)s.total, 0);
        CHECK_EQ(dem_world_run_to(world[0], 0.13, 0, 0), DEM_OK);    /* all are below */
        dem_outlet_get(world[0], below, &s);
        CHECK_EQ((int)s.count[0], 10);
        CHECK_EQ((int)s.count[1], 10);
        CHECK_EQ((int)s.held[0], 20);
        CHECK_EQ((int)s.back_total, 0);
        CHECK_REL(s.mass[0], 10*2500*4.18879020478639*0.003*0.003*0.003, sizeof(dem_real) == 8 ? 1e-9 : 1e-5);
        CHECK(s.last > 0.06 && s.last < 0.09);           /* sqrt(2 h/g), h = .02 and .03 m: .064 and .078 s */
        dem_outlet_get(world[0], only, &s);
        CHECK_EQ((int)s.count[0], 0);
        CHECK_EQ((int)s.total, 10);
        CHECK_EQ((int)dem_body_counts_get(world[0]).present, 30);
        CHECK_EQ(dem_checkpoint_write(world[0], "build/tmp/counts.ckpt"), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(world[1], "build/tmp/counts.ckpt"), DEM_OK);
        for (k = 0; k < 2; k++) {
            for (i = 0; i < 30; i++) {                   /* thrown up again: back through the plane */
                dem_body_state st = scene_state(world[k], dem_body_id_get(world[k], i));
                if ((double)st.radius > 0.004) scene_move(world[k], dem_body_id_get(world[k], i), at(0, 0, 2), at(0, 0, 0));
            }
            CHECK_EQ(dem_world_run_to(world[k], 0.23, 0, 0), DEM_OK);
            dem_outlet_get(world[k], below, &s);
            CHECK_EQ((int)s.back[1], 10);
            CHECK_EQ((int)s.back[0], 0);
            CHECK_EQ((int)s.count[1], 10);
            CHECK_EQ((int)s.held_total, 20);
            CHECK_REL(s.back_total_mass, 10*2500*4.18879020478639*0.005*0.005*0.005, sizeof(dem_real) == 8 ? 1e-9 : 1e-5);
        }
        CHECK(dem_world_hash_get(world[0]) == dem_world_hash_get(world[1]));
        CHECK_EQ(dem_outlet_reset(world[0], below), DEM_OK);
        dem_outlet_get(world[0], below, &s);
        CHECK_EQ((int)s.back_total + (int)s.total, 0);
        CHECK_EQ((int)s.held_total, 20);
        for (i = 2; i < 16; i++) CHECK_EQ(dem_outlet_add(world[0], &d).id, i + 1);
        CHECK_EQ(dem_outlet_add(world[0], &d).id, 0);
        CHECK_STR(dem_world_error_get(world[0]), "16 outlets that keep their grains");
        for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
    }

    TEST("a wall is added beside a feed whose classes beyond class_count hold no shape or material") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_feed_desc d = DEM_FEED_DESC;
        dem_world *world = dem_world_create(&desc);
        const dem_material stuff = scene_material(world, 1e7, 0.5, 0, 0);
        d.material = stuff;
        d.class_count = 1;
        d.radius[0] = DEM_R(0.005);
        d.amount[0] = 3;
        d.limited = 1;
        d.box = box_of(0, 0, 0.1, 0.1, 0.1, 0.2);
        d.shapes[1].id = 12345;                        /* unused */
        d.materials[2].id = 999;
        CHECK(dem_feed_add(world, &d).id);
        CHECK(dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1)).id);
        CHECK_EQ(dem_world_run(world, 0.01, 0, 0), DEM_OK);
        CHECK_EQ(dem_body_counts_get(world).present, 3);
        dem_world_destroy(world);
    }

    TEST("a feed inserts grains that fall alike in single steps and in one call, and from their insertion on") {
        enum { PLAIN, FIELD, REACHING, DENSE, SCENES };
        int scene, way, i;
        for (scene = PLAIN; scene < SCENES; scene++) {
            uint64_t hash[2];
            for (way = 0; way < 2; way++) {
                const int count = scene == DENSE ? 4000 : 10, steps = 410;
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_feed_desc d = DEM_FEED_DESC;
                dem_world *world;
                dem_material stuff;
                dem_ledger l;
                desc.gravity = at(0, 0, -9.81);
                desc.dt = scene == DENSE ? DEM_R(1e-5) : DEM_R(5e-6);
                desc.threads = 1;
                desc.ledger = 1;
                if (scene == FIELD) desc.force = no_force;
                if (scene == REACHING) { desc.law = pulls; desc.law_stiffness = 1000; desc.law_range = DEM_R(1e-4); }
                world = dem_world_create(&desc);
                stuff = scene_material(world, 1e7, 0.5, 0, 0);
                d.material = stuff;
                d.class_count = 1;
                d.radius[0] = DEM_R(1e-3);
                d.amount[0] = count;
                d.limited = 1;
                d.rate = scene == DENSE ? 1e6 : 1e4;   /* more than a list has room for, or one in 20 steps */
                d.box = scene == DENSE ? box_of(-0.03, -0.03, 0, 0.03, 0.03, 0.06)
                    : box_of(-0.1, -0.1, 0, 0.1, 0.1, 0.2);
                if (scene == DENSE) d.velocity = at(0, 0, -1);
                CHECK(dem_feed_add(world, &d).id);
                dem_sphere_add(world, stuff, DEM_R(1e-3), at(2, 0, 0));
                if (way) for (i = 0; i < steps; i++) CHECK_EQ(scene_step(world, 1), DEM_OK);
                else CHECK_EQ(scene_step(world, steps), DEM_OK);
                CHECK_EQ(dem_body_counts_get(world).present, count + 1);
                hash[way] = dem_world_hash_get(world);
                l = dem_ledger_get(world);
                if (scene != REACHING && scene != DENSE)       /* a kick too many is energy from nowhere */
                    CHECK(fabs(l.residual) < (sizeof(dem_real) == 4 ? 1e-4 : 1e-11)*l.throughput);
                dem_world_destroy(world);
            }
            CHECK(hash[0] == hash[1]);
        }
    }

    TEST("a grain of a new radius that a feed inserts far away leaves the others as they are, bit for bit, for any "
         "integrator") {
        int integrator, fed, i;
        for (integrator = 0; integrator < 5; integrator++) {
            dem_body_state state[2][2];
            for (fed = 0; fed < 2; fed++) {
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_feed_desc d = DEM_FEED_DESC;
                dem_world *world;
                dem_material stuff;
                dem_body grain[2];
                desc.gravity = at(0, 0, -9.81);
                desc.dt = DEM_R(5e-6);
                desc.integrator = (dem_integrator)integrator;
                world = dem_world_create(&desc);
                stuff = scene_material(world, 1e7, 0.5, 0.3, 0);
                dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
                for (i = 0; i < 2; i++) {      /* both touch the floor and slip */
                    grain[i] = dem_sphere_add(world, stuff, DEM_R(1e-3), at(0.01*i, 0, 0.999e-3));
                    scene_move(world, grain[i], at(0.1, 0, -0.1 + 0.05*i), at(0, 0, 50));
                }
                d.material = stuff;
                d.class_count = 1;
                d.radius[0] = DEM_R(2e-3);
                d.amount[0] = 1;
                d.limited = 1;
                d.start = 20*5e-6 - 1e-9;
                d.box = box_of(1, 0, 0.1, 1, 0, 0.1);
                if (fed) CHECK(dem_feed_add(world, &d).id);
                CHECK_EQ(scene_step(world, 20), DEM_OK);
                CHECK_EQ(dem_counters_get(world).wall_contacts, 2);
                CHECK_EQ(scene_step(world, 20), DEM_OK);
                CHECK_EQ(dem_body_counts_get(world).present, 2 + fed);
                for (i = 0; i < 2; i++) state[fed][i] = scene_state(world, grain[i]);
                dem_world_destroy(world);
            }
            for (i = 0; i < 2; i++)
                CHECK(!memcmp(&state[0][i].position, &state[1][i].position, sizeof state[0][i].position) &&
                      !memcmp(&state[0][i].velocity, &state[1][i].velocity, sizeof state[0][i].velocity) &&
                      !memcmp(&state[0][i].spin, &state[1][i].spin, sizeof state[0][i].spin));
        }
    }

    TEST("a grain that a feed inserts beside another one collides and is attracted as one that is added") {
        int impulses, fed, i;
        for (impulses = 0; impulses < 2; impulses++) {
            double x[2];
            for (fed = 0; fed < 2; fed++) {
                const double dt = impulses ? 1e-3 : 1e-5, R = 1e-2, from = 2*R + (impulses ? 1e-5 : 2e-4);
                const dem_vec3 velocity = impulses ? at(-2, 0, 0) : at(0, 0, 0);
                dem_world_desc desc = DEM_WORLD_DESC;
                dem_feed_desc d = DEM_FEED_DESC;
                dem_world *world;
                dem_material stuff;
                dem_body resting;
                desc.dt = (dem_real)dt;
                if (impulses) desc.response = DEM_RESPONSE_IMPULSES;
                else { desc.law = pulls; desc.law_stiffness = 1000; desc.law_range = DEM_R(5e-4); }
                world = dem_world_create(&desc);
                stuff = scene_material(world, 1e7, 0.5, 0, 0);
                resting = dem_sphere_add(world, stuff, (dem_real)R, at(0, 0, 0));
                dem_sphere_add(world, stuff, (dem_real)R, at(0.5, 0, 0));
                d.material = stuff;
                d.class_count = 1;
                d.radius[0] = (dem_real)R;
                d.amount[0] = 1;
                d.limited = 1;
                d.start = 20*dt - 1e-9;                /* in the first step after 20 */
                d.box = box_of(from, 0, 0, from, 0, 0);
                d.velocity = velocity;
                if (fed) CHECK(dem_feed_add(world, &d).id);
                CHECK_EQ(scene_step(world, 20), DEM_OK);
                if (!fed)
                    scene_move(world, dem_sphere_add(world, stuff, (dem_real)R, at(from, 0, 0)), velocity, at(0, 0, 0));
                for (i = 0; i < 4; i++) CHECK_EQ(scene_step(world, 1), DEM_OK);
                CHECK_EQ(dem_body_counts_get(world).present, 3);
                x[fed] = (double)scene_state(world, resting).position.x;
                dem_world_destroy(world);
            }
            CHECK(fabs(x[0]) > 1e-13);                 /* it has moved */
            CHECK_REL(x[1], x[0], sizeof(dem_real) == 4 ? 1e-4 : 1e-6);
        }
    }
    return test_end();
}
