/* Twisting friction with springs: a moment about the normal of mu_spin R* F. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const int fine = sizeof(dem_real) == 8;       /* double precision */
static const double R = 0.01, MU = 0.03;
static dem_world *stage(int rolling, int gravity, double twisting, dem_material *m) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_pair pair;
    if (gravity) desc.gravity.z = DEM_R(-9.81);
    desc.ledger = 1;
    desc.threads = 1;
    desc.dt = DEM_R(2e-5);
    desc.rolling_law = (dem_rolling_law)rolling;
    world = dem_world_create(&desc);
    *m = scene_material(world, 1e6, 0.5, 0.5, 0.1);
    dem_pair_get(world, *m, *m, &pair);
    pair.spinning_friction = (dem_real)twisting;
    CHECK_EQ(dem_pair_set(world, *m, *m, &pair), DEM_OK);
    return world;
}
/* Balls pressed between two plates or as a heap, with spins. */
static dem_world *heap(double twisting, int threads) {
    dem_material m;
    dem_world *world = stage(DEM_ROLLING_AUTO, 1, twisting, &m);
    uint64_t seed = 9;
    int i;
    (void)threads;
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    dem_wall_cylinder_add(world, m, at(0, 0, 0), at(0, 0, 1), DEM_R(0.05), 1);
    for (i = 0; i < 48; i++) {
        const dem_body b = dem_sphere_add(world, m, DEM_R(0.008), scene_at(&seed, 1e-3, 0.018*(i%4 - 1.5), 1e-3, 0.018*(i/4%4 - 1.5), 1e-3,
                                                                          0.009 + 0.018*(i/16)));
        scene_move(world, b, at(0, 0, 0), scene_at(&seed, 40, -20, 40, -20, 200, -100));
    }
    return world;
}
/* Sets, or reads, the twisting spring and one along y; memory: three reals of friction, then twisting. */
typedef struct springs { int sets; double friction, twisting; int seen; } springs;
static void spring_of(const dem_contact_info *c, dem_real *memory, void *user) {
    springs *s = (springs *)user;
    (void)c;
    if (s->sets) { memory[1] = DEM_R(1e-9); memory[3] = DEM_R(1e-3); }
    s->friction = (double)memory[1];
    s->twisting = (double)memory[3];
    s->seen++;
}

/* Kinetic energy, J, of a body 0.1 s after it was set spinning on a floor, at rest before that. effect 0: none; 1: friction; 2:
   rolling; 3: spinning friction, each alone. later: set 0.02 s after the spin was. */
enum { BALL, CLUMP, EGG, SHAPES };
static double spun_down(int impulses, int shape, int effect, int later) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    const dem_real centre[3] = {0, 0, 0}, radius[1] = {(dem_real)R};
    dem_shape form = {0};
    dem_world *world;
    dem_material m;
    dem_pair pair;
    dem_body b;
    double energy;
    int part;
    desc.gravity.z = DEM_R(-9.81);
    desc.threads = 1;
    desc.ledger = 1;
    if (impulses) { desc.response = DEM_RESPONSE_IMPULSES; desc.dt = DEM_R(5e-4); }
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.5, 0, 0);
    cluster.count = 1;
    cluster.positions = centre;
    cluster.radii = radius;
    if (shape == CLUMP) form = dem_shape_cluster_add(world, &cluster);
    if (shape == EGG) form = dem_shape_ellipsoid_add(world, at(R, R, R));
    CHECK(shape == BALL || form.id);
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    b = shape == BALL ? dem_sphere_add(world, m, (dem_real)R, at(0, 0, R))
        : dem_body_add(world, m, form, at(0, 0, R), dem_quat_make(1, 0, 0, 0));
    CHECK(b.slot);
    CHECK_EQ(dem_world_run(world, 0.05, 0, 0), DEM_OK);
    scene_move(world, b, at(0, 0, 0), at(30, 0, 30));
    for (part = 0; part < 2; part++) {
        if (part == later) {
            CHECK_EQ(dem_pair_get(world, m, m, &pair), DEM_OK);
            if (effect == 1) pair.friction = DEM_R(0.1);
            if (effect == 2) pair.rolling_friction = DEM_R(0.02);
            if (effect == 3) pair.spinning_friction = DEM_R(0.02);
            CHECK_EQ(dem_pair_set(world, m, m, &pair), DEM_OK);
        }
        CHECK_EQ(dem_world_run(world, part ? 0.08 : 0.02, 0, 0), DEM_OK);
    }
    energy = dem_ledger_get(world).kinetic + dem_ledger_get(world).rotational;
    dem_world_destroy(world);
    return energy;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("friction, rolling and spinning friction each act alone, from the start or set later, by springs and impulses") {
        int impulses, shape, effect;
        for (impulses = 0; impulses < 2; impulses++)
            for (shape = 0; shape < SHAPES; shape++) {
                const double free = spun_down(impulses, shape, 0, 0);
                for (effect = 1; effect < 4; effect++) {
                    const double now = free - spun_down(impulses, shape, effect, 0);
                    const double late = free - spun_down(impulses, shape, effect, 1);
                    CHECK(now > 0.05*free);
                    /* a fifth of the time is missing; what a constant torque takes is a parabola of time */
                    CHECK(late > 0.7*now && late < (effect == 1 ? 1.01 : 0.95)*now);
                }
            }
    }

    TEST("a ball that spins on a plane slows by 5 mu_spin g/(2 R) per second under every rolling law, stops, and stays") {
        int rolling;
        for (rolling = DEM_ROLLING_NONE; rolling <= DEM_ROLLING_EPSD; rolling++) {
            dem_material m;
            dem_world *world = stage(rolling, 1, MU, &m);
            const double rate = 2.5*MU*9.81/R, t = 0.2;
            dem_body b;
            dem_ledger before, l;
            if (rolling == DEM_ROLLING_STEP) { dem_world_destroy(world); continue; }    /* acts about the normal itself */
            dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            b = dem_sphere_add(world, m, (dem_real)R, at(0, 0, R));
            CHECK_EQ(dem_world_run(world, 0.3, 0, 0), DEM_OK);         /* settles */
            scene_move(world, b, at(0, 0, 0), at(0, 0, 30));
            CHECK_EQ(dem_world_step(world, 1), DEM_OK);
            before = dem_ledger_get(world);
            CHECK_EQ(dem_world_run(world, t, 0, 0), DEM_OK);
            CHECK_REL((double)scene_state(world, b).spin.z, 30 - rate*t, 1e-3);
            l = dem_ledger_get(world);
            CHECK_REL(l.rolling - before.rolling, before.rotational - l.rotational, fine ? 1e-4 : 1e-2);
            CHECK_EQ(dem_world_run(world, 0.4, 0, 0), DEM_OK);
            CHECK_NEAR(scene_state(world, b).spin.z, 0, fine ? 1e-6 : 1e-3);
            CHECK(fabs(dem_ledger_get(world).residual) < (fine ? 1e-4 : 2e-2)*dem_ledger_get(world).throughput);
            dem_world_destroy(world);
        }
    }
    TEST("two balls that spin against each other about the line of centres exchange mu_spin R* F, equal and opposite") {
        dem_material m;
        dem_world *world = stage(DEM_ROLLING_NONE, 0, MU, &m);
        const dem_body a = dem_sphere_add(world, m, (dem_real)R, at(0, 0, 0)), b = dem_sphere_add(world, m, (dem_real)R, at(1.99*R, 0, 0));
        dem_rail_desc d = DEM_RAIL_DESC;
        dem_body_state s, o;
        d.axes = DEM_RAIL_ALL;
        d.spin.x = 10;
        dem_body_rail_set(world, a, &d);
        d.spin.x = -10;
        dem_body_rail_set(world, b, &d);
        CHECK_EQ(dem_world_run(world, 0.01, 0, 0), DEM_OK);
        {
            dem_rail_state r, q;
            CHECK_EQ(dem_body_reaction_get(world, a, &r), DEM_OK);
            CHECK_EQ(dem_body_reaction_get(world, b, &q), DEM_OK);
            CHECK_REL((double)r.torque.x, MU*R/2*(double)r.force.x, 1e-4);    /* R* is R/2; the rail presses and turns */
            CHECK_NEAR((double)(r.torque.x + q.torque.x)/(double)r.torque.x, 0, fine ? 1e-9 : 1e-3);
            CHECK(r.torque.x > 0);
        }
        s = scene_state(world, a); o = scene_state(world, b);
        CHECK_NEAR((double)(s.spin.x + o.spin.x), 0, 1e-6);
        dem_world_destroy(world);
    }
    TEST("twisting friction is absent at no cost, resumes from a checkpoint, and comes and goes during a run") {
        char path[] = "build/tmp/test_twisting.checkpoint";
        dem_world *world = heap(MU, 1), *again = heap(MU, 1), *none = heap(0, 1);
        dem_material m;
        dem_pair pair;
        m.id = 1;
        CHECK_EQ(scene_step(world, 1500), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        CHECK_EQ(scene_step(world, 1000), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(again, path), DEM_OK);
        CHECK_EQ(scene_step(again, 1000), DEM_OK);
        CHECK(dem_world_hash_get(again) == dem_world_hash_get(world));
        CHECK(fabs(dem_ledger_get(world).residual) < (fine ? 1e-3 : 2e-2)*dem_ledger_get(world).throughput);
        CHECK_EQ(scene_step(none, 2500), DEM_OK);
        CHECK(dem_world_hash_get(none) != dem_world_hash_get(world));
        CHECK(dem_ledger_get(none).rotational > 1.05*dem_ledger_get(world).rotational);
        CHECK_EQ(none->laws.memory, 6);                 /* as without the law */
        CHECK_EQ(world->laws.memory, 7);
        dem_pair_get(world, m, m, &pair);
        pair.spinning_friction = 0;
        dem_pair_set(world, m, m, &pair);
        CHECK_EQ(scene_step(world, 200), DEM_OK);
        CHECK_EQ(world->laws.memory, 6);
        pair.spinning_friction = (dem_real)MU;
        dem_pair_set(world, m, m, &pair);
        CHECK_EQ(scene_step(world, 200), DEM_OK);
        CHECK_EQ(world->laws.memory, 7);
        dem_world_destroy(world);
        dem_world_destroy(again);
        dem_world_destroy(none);
        remove(path);
    }
    TEST("when one of two merged contacts of a cluster ends, the other keeps the moment of its twisting spring") {
        int ball;
        for (ball = 0; ball < 2; ball++) {             /* on a plane; on a large fixed ball */
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_cluster_desc two = DEM_CLUSTER_DESC;
            dem_real x[6] = {DEM_R(-0.3), 0, 0, DEM_R(0.3), 0, 0};
            dem_world *world;
            dem_material m;
            dem_pair pair;
            dem_body body, other;
            dem_body_state s;
            springs set = {1, 0, 0, 0}, before = {0, 0, 0, 0}, after = {0, 0, 0, 0};
            desc.dt = DEM_R(1e-7);
            desc.tangent_law = DEM_TANGENT_SPRING;
            world = dem_world_create(&desc);
            m = scene_material(world, 1e7, 0.9, 1, 0);
            dem_pair_get(world, m, m, &pair);
            pair.spinning_friction = 1000;             /* no limit */
            CHECK_EQ(dem_pair_set(world, m, m, &pair), DEM_OK);
            two.count = 2;
            two.positions = x;
            two.radius = 1;
            body = dem_body_add(world, m, dem_shape_cluster_add(world, &two), at(0, 0, 1 - 1e-3),
                                dem_quat_make(1, 0, 0, 0));
            if (!ball) dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            else {
                other = dem_sphere_add(world, m, 1000, at(0, 0, -1000));
                s = scene_state(world, other);
                s.fixed = 1;
                dem_body_set(world, other, &s);
            }
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            dem_contacts_each(world, spring_of, &set);
            CHECK_EQ(scene_step(world, 2), DEM_OK);
            dem_contacts_each(world, spring_of, &before);
            CHECK_EQ(before.seen, 2);
            s = scene_state(world, body);
            s.velocity = s.spin = at(0, 0, 0);
            s.orientation = dem_quat_about(at(0, 1, 0), DEM_R(0.01));      /* tilted: one sphere touches */
            s.position.z = (dem_real)(1 + 0.3*sin(0.01) - 1e-3);
            dem_body_set(world, body, &s);
            CHECK_EQ(scene_step(world, 2), DEM_OK);
            dem_contacts_each(world, spring_of, &after);
            CHECK_EQ(after.seen, 1);
            /* half the weight becomes all of it, so half the spring has the same moment; two steps relax it alike */
            CHECK_REL(after.friction, before.friction/2, 1e-3);
            CHECK_REL(after.twisting, before.twisting/2*before.twisting/1e-3, 1e-2);
            dem_world_destroy(world);
        }
    }
    return test_end();
}
