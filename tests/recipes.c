/* What docs/extending.md adds to dem.h, in use: built by tests/recipes.sh with the patched header first on the include
   path. A law or integrator of a recipe must do what its page says, and serve spheres, ellipsoids, clusters, meshes,
   threads, checkpoint and report without another line. */
#define DEM_IMPLEMENTATION
#include <dem.h>
#include "test.h"
#include "scene.h"

/* Spheres of two sizes, ellipsoids and a cluster that fall on a mesh and on each other. */
static dem_world *mixture(dem_world_desc desc, int threads) {
    static const dem_real places[6] = {DEM_R(-0.004), 0, 0, DEM_R(0.004), 0, 0};
    static const dem_real radii[2] = {DEM_R(0.005), DEM_R(0.004)};
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_world *world;
    dem_material m;
    dem_pair pair;
    dem_shape shape[2];
    int i;
    desc.gravity.z = DEM_R(-9.81);
    desc.threads = threads;
    desc.impact_speed = 1;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.8, 0.4, 0.05);
    dem_pair_get(world, m, m, &pair);
    pair.normal_damping = 1;
    dem_pair_set(world, m, m, &pair);
    cluster.count = 2;
    cluster.positions = places;
    cluster.radii = radii;
    shape[0] = dem_shape_ellipsoid_add(world, at(0.004, 0.005, 0.006));
    shape[1] = dem_shape_cluster_add(world, &cluster);
    scene_floor(world, m, -0.1, -0.1, 0.1, 0.1, 3, 3);
    for (i = 0; i < 27; i++) {
        const dem_vec3 x = at(0.013*(i%3), 0.013*(i/3%3), 0.008 + 0.013*(i/9));
        if (i%3) dem_body_add(world, m, shape[i%3 - 1], x, dem_quat_make(1, DEM_R(0.3)*(dem_real)i, 0, 1));
        else dem_sphere_add(world, m, DEM_R(0.004) + DEM_R(0.0001)*(dem_real)i, x);
    }
    return world;
}
/* The same bits by 1 and 2 threads and after a checkpoint; reports call it by its name. */
static void serves(dem_world_desc desc, const char *name) {
    const char *path = "build/recipes/state.ckpt";
    dem_world *a = mixture(desc, 1), *b = mixture(desc, 2), *c = mixture(desc, 1);
    FILE *file = fopen("build/recipes/report.txt", "w+");
    static char text[20000];
    int walls = 0, pairs = 0, k;
    for (k = 0; k < 20; k++) {
        CHECK_EQ(scene_step(a, 100), DEM_OK);
        walls |= dem_counters_get(a).wall_contacts;
        pairs |= dem_counters_get(a).contacts;
    }
    CHECK(walls && pairs);
    CHECK_EQ(scene_step(b, 1000), DEM_OK);
    CHECK_EQ(dem_checkpoint_write(b, path), DEM_OK);
    CHECK_EQ(scene_step(b, 1000), DEM_OK);
    CHECK_EQ(dem_checkpoint_read(c, path), DEM_OK);
    CHECK_EQ(scene_step(c, 1000), DEM_OK);
    CHECK(dem_world_hash(a) == dem_world_hash(b));
    CHECK(dem_world_hash(a) == dem_world_hash(c));
    CHECK(file != 0);
    if (file) {
        dem_world_report(a, file);
        rewind(file);
        text[fread(text, 1, sizeof text - 1, file)] = 0;
        fclose(file);
        CHECK_STR(text, name);
    }
    remove(path);
    dem_world_destroy(a);
    dem_world_destroy(b);
    dem_world_destroy(c);
}
/* Restitution of a ball that meets a plane at a speed. */
static double bounce(dem_world_desc desc, double speed) {
    dem_world *world;
    dem_material m;
    dem_pair pair;
    dem_body ball;
    double e;
    desc.impact_speed = (dem_real)speed;
    desc.dt = 0;
    world = dem_world_create(&desc);
    m = scene_material(world, 1e7, 0.9, 0, 0);
    dem_pair_get(world, m, m, &pair);
    pair.normal_damping = 10;
    dem_pair_set(world, m, m, &pair);
    dem_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
    scene_move(world, ball, at(0, 0, -speed), at(0, 0, 0));
    scene_step(world, 400);
    e = (double)scene_state(world, ball).velocity.z/speed;
    dem_world_destroy(world);
    return e;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("recipe for a normal law: Kuwabara and Kono's dashpot, 1 - e ~ v^(1/5)") {
        dem_world_desc desc = DEM_WORLD_DESC;
        desc.normal_law = DEM_NORMAL_VISCOELASTIC;
        CHECK(1 - bounce(desc, 0.1) > 0.002);
        CHECK_REL((1 - bounce(desc, 3.2))/(1 - bounce(desc, 0.1)), 2, 0.05);
        serves(desc, "normal: viscoelastic");
        desc.normal_law = (dem_normal_law)((int)DEM_NORMAL_VISCOELASTIC + 1);
        CHECK(dem_world_create(&desc) == 0);    /* the limit moved, and by one */
    }
    TEST("recipe for a friction law: a sliding ball comes to roll at 5/7 of its speed") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material m;
        dem_body ball;
        desc.tangent_law = DEM_TANGENT_SMOOTH;
        serves(desc, "tangential: smooth");
        desc.gravity.z = DEM_R(-9.81);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e6, 0.5, 0.3, 0);
        dem_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
        scene_move(world, ball, at(0.5, 0, 0), at(0, 0, 0));
        CHECK_EQ(dem_world_run(world, 0.2, 0, 0), DEM_OK);
        CHECK_REL(scene_state(world, ball).velocity.x, 0.5*5/7, 0.01);
        dem_world_destroy(world);
    }
    TEST("recipe for a wall: in a shell a ball swings as a pendulum that also rolls, clusters come "
         "to rest on both their spheres, ellipsoids are refused by name") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_cluster_desc two = DEM_CLUSTER_DESC;
        static const dem_real places[6] = {DEM_R(-0.004), 0, 0, DEM_R(0.004), 0, 0};
        const char *path = "build/recipes/shell.ckpt";
        const double length = 0.5 - 0.01, start = 0.02;
        uint64_t hash[3] = {0, 0, 0};
        dem_material m;
        dem_body ball;
        dem_pose pose;
        int k;
        desc.gravity.z = DEM_R(-9.81);
        for (k = 0; k < 3; k++) {              /* 1 thread, 2 threads, on from a checkpoint */
            dem_world *world;
            dem_wall shell;
            desc.threads = 1 + (k == 1);
            world = dem_world_create(&desc);
            m = scene_material(world, 1e7, 0.5, 0.5, 0);
            shell = dem_shell_add(world, m, at(0, 0, 1), DEM_R(0.5));
            CHECK_EQ(shell.id, 1);
            ball = dem_sphere_add(world, m, DEM_R(0.01), at(length*sin(start), 0,
                                                            1 - length*cos(start)));
            if (k < 2) CHECK_EQ(dem_world_run(world, 0.5, 0, 0), DEM_OK);
            if (k == 1) CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
            if (k == 2) CHECK_EQ(dem_checkpoint_read(world, path), DEM_OK);
            /* half a period: pi sqrt(7 L/(5 g)) */
            CHECK_EQ(dem_world_run(world, 3.14159265358979*sqrt(1.4*length/9.81) - 0.5, 0, 0),
                     DEM_OK);
            CHECK_REL(scene_state(world, ball).position.x, -length*sin(start), 0.02);
            hash[k] = dem_world_hash(world);
            CHECK_EQ(dem_wall_pose(world, shell, &pose), DEM_OK);
            CHECK_NEAR(pose.position.z, 1, 1e-12);
            dem_world_destroy(world);
        }
        CHECK(hash[1] == hash[0] && hash[2] == hash[0]);
        {
            dem_world *world = dem_world_create(&desc);
            dem_shape pair;
            two.count = 2;
            two.positions = places;
            two.radius = DEM_R(0.005);
            m = scene_material(world, 1e6, 0.3, 0.5, 0.1);
            CHECK_EQ(dem_shell_add(world, m, at(0, 0, 1), 0).id, 0);
            CHECK_STR(dem_world_error(world), "dem_shell_add: radius is 0 m, must be > 0");
            CHECK_EQ(dem_shell_add(world, m, at(0, 0, 1), DEM_R(0.05)).id, 1);
            pair = dem_shape_cluster_add(world, &two);
            ball = dem_body_add(world, m, pair, at(0.01, 0, 0.97), dem_quat_make(1, 0, 0, 0));
            CHECK_EQ(dem_body_add(world, m, dem_shape_ellipsoid_add(world, at(1, 2, 3)),
                                  at(0, 0, 1), dem_quat_make(1, 0, 0, 0)).slot, 0);
            CHECK_STR(dem_world_error(world), "wall 1 is a shell");
            CHECK_EQ(dem_world_run(world, 2, 0, 0), DEM_OK);
            {   /* on both of its spheres, wherever friction holds it */
                const dem_vec3 x = scene_state(world, ball).position;
                CHECK_NEAR(sqrt((double)(x.x*x.x + x.y*x.y + (x.z - 1)*(x.z - 1))),
                           sqrt(0.045*0.045 - 0.004*0.004), 1e-4);   /* pressed in 4e-5 m */
                CHECK_NEAR(demi_length(scene_state(world, ball).velocity), 0, 1e-3);
            }
            dem_world_destroy(world);
        }
        remove(path);
    }
    TEST("recipe for a number of each body: it follows its body through sorts, removals, a "
         "checkpoint and slabs") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *a = mixture(desc, 1), *b = mixture(desc, 1);
        dem_slabs_desc deal = DEM_SLABS_DESC;
        dem_slabs *slabs;
        const char *path = "build/recipes/charge.ckpt";
        int i, round;
        for (i = 0; i < a->bodies.count; i++)
            a->bodies.charge[i] = (dem_real)(1 + a->bodies.slot[i]);
        dem_body_remove(a, dem_bodies_id(a, 5));
        CHECK_EQ(scene_step(a, 1000), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
        dem_body_remove(b, dem_bodies_id(b, 5));
        CHECK_EQ(dem_checkpoint_read(b, path), DEM_OK);
        CHECK_EQ(b->bodies.count, 26);
        for (round = 0; round < 2; round++) {
            for (i = 0; i < b->bodies.count; i++)
                CHECK_NEAR(b->bodies.charge[i], (dem_real)(1 + b->bodies.slot[i]), 0);
            if (round) break;
            deal.count = 2;
            slabs = dem_slabs_create(b, &deal);
            CHECK_EQ(dem_slabs_step(slabs, 300), DEM_OK);
            for (i = 0; i < b->bodies.count; i++) b->bodies.charge[i] = 0;
            CHECK_EQ(dem_slabs_collect(slabs, b), DEM_OK);
            dem_slabs_destroy(slabs);
        }
        remove(path);
        dem_world_destroy(a);
        dem_world_destroy(b);
    }
    TEST("recipe for an integrator: exact where the force is constant") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_body ball;
        double t;
        desc.integrator = DEM_TAYLOR;
        serves(desc, "Taylor (order 1)");
        desc.gravity.z = DEM_R(-9.81);
        desc.dt = DEM_R(1e-4);
        world = dem_world_create(&desc);
        ball = dem_sphere_add(world, scene_material(world, 1e6, 0.5, 0.3, 0), DEM_R(0.01), at(0, 0, 0));
        scene_step(world, 1000);
        t = dem_world_time(world);
        CHECK_REL(scene_state(world, ball).position.z, -9.81*t*t/2, 1e-10);
        CHECK_REL(scene_state(world, ball).velocity.z, -9.81*t, 1e-10);
        desc.integrator = (dem_integrator)((int)DEM_TAYLOR + 1);
        CHECK(dem_world_create(&desc) == 0);
        dem_world_destroy(world);
    }
    return test_end();
}
