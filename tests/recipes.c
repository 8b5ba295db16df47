/* Uses what docs/extending*.md add to dem.h. tests/recipes.sh builds it with the patched header first on the include
   path. A law or integrator of a recipe must do what its page says, and must work with spheres, ellipsoids, clusters,
   meshes, threads, checkpoint and report without further edits. */
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
    CHECK(dem_world_hash_get(a) == dem_world_hash_get(b));
    CHECK(dem_world_hash_get(a) == dem_world_hash_get(c));
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
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
    scene_move(world, ball, at(0, 0, -speed), at(0, 0, 0));
    scene_step(world, 400);
    e = (double)scene_state(world, ball).velocity.z/speed;
    dem_world_destroy(world);
    return e;
}

static double energy_of_motion(const dem_world *world) {
    const dem_totals sum = dem_totals_get(world);
    return sum.kinetic + sum.rotational;
}
/* Frictionless, without loss: a capsule thrown askew onto a plane and, in mid-air, two at each other, one of them against
   a ball. */
static void rods_bounce(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material m;
    dem_shape rod;
    dem_body body[4];
    double start, turning, hits = 0;
    int i;
    desc.dt = DEM_R(1e-6);
    world = dem_world_create(&desc);
    m = scene_material(world, 1e7, 1, 0, 0);
    rod = dem_shape_capsule_add(world, DEM_R(0.01), DEM_R(0.004));
    CHECK(rod.id == 1);
    dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
    dem_wall_plane_add(world, m, at(0, 0, 0.06), at(0, 0, -1));
    body[0] = dem_body_add(world, m, rod, at(0, 0, 0.03), dem_quat_make(1, DEM_R(0.3), DEM_R(0.2), 0));
    body[1] = dem_body_add(world, m, rod, at(1, 0, 0.03), dem_quat_make(1, 0, 0, 0));
    body[2] = dem_body_add(world, m, rod, at(1.03, 0.007, 0.028), dem_quat_make(1, 1, DEM_R(0.2), 0));
    body[3] = dem_sphere_add(world, m, DEM_R(0.006), at(1.06, 0.003, 0.034));
    scene_move(world, body[0], at(0, 0, -1), at(0, 0, 0));
    scene_move(world, body[2], at(-1, 0, 0), at(0, 0, 0));
    scene_move(world, body[3], at(-1.5, 0, 0), at(0, 0, 0));
    start = energy_of_motion(world);
    for (i = 0; i < 4000; i++) {
        CHECK_EQ(scene_step(world, 100), DEM_OK);
        hits += dem_counters_get(world).contacts + dem_counters_get(world).wall_contacts;
    }
    CHECK(hits > 20);
    CHECK(dem_counters_get(world).contacts + dem_counters_get(world).wall_contacts == 0);
    CHECK_REL(energy_of_motion(world), start, 1e-4);
    for (turning = 0, i = 0; i < 3; i++)
        turning += (double)demi_dot(scene_state(world, body[i]).spin, scene_state(world, body[i]).spin);
    CHECK(turning > 100);
    dem_world_destroy(world);
}
/* Volume and moments beside those of 201 balls in a row, matter counted once. */
static void rods_weigh(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world = dem_world_create(&desc);
    dem_cluster_desc row = DEM_CLUSTER_DESC;
    static dem_real places[3*201];
    dem_shape_info rod, balls;
    int i;
    for (i = 0; i < 201; i++) places[3*i + 2] = DEM_R(1e-4)*(dem_real)(i - 100);
    row.count = 201;
    row.positions = places;
    row.radius = DEM_R(0.004);
    CHECK_EQ(dem_shape_get(world, dem_shape_capsule_add(world, DEM_R(0.01), DEM_R(0.004)), &rod), DEM_OK);
    CHECK_EQ(dem_shape_get(world, dem_shape_cluster_add(world, &row), &balls), DEM_OK);
    CHECK_REL(rod.volume, balls.volume, 2e-4);
    CHECK_REL(rod.inertia.x, balls.inertia.x, 2e-4);
    CHECK_REL(rod.inertia.z, balls.inertia.z, 2e-4);
    CHECK_REL(rod.radius, 0.014, 1e-12);
    dem_world_destroy(world);
}
/* A heap of capsules, balls and clusters between four planes: the same bits by 1 and 2 threads and on from a checkpoint. */
static void rods_rest(void) {
    static const dem_real places[6] = {DEM_R(-0.004), 0, 0, DEM_R(0.004), 0, 0};
    const char *path = "build/recipes/rods.ckpt";
    uint64_t hash[3] = {0, 0, 0};
    int run, i;
    for (run = 0; run < 3; run++) {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_cluster_desc two = DEM_CLUSTER_DESC;
        dem_world *world;
        dem_material m;
        dem_shape shape[2];
        desc.gravity.z = DEM_R(-9.81);
        desc.threads = 1 + (run == 1);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e6, 0.3, 0.5, 0.1);
        two.count = 2;
        two.positions = places;
        two.radius = DEM_R(0.005);
        shape[0] = dem_shape_capsule_add(world, DEM_R(0.006), DEM_R(0.004));
        shape[1] = dem_shape_cluster_add(world, &two);
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        for (i = 0; i < 4; i++)
            dem_wall_plane_add(world, m, at(i == 0 ? -0.02 : i == 1 ? 0.06 : 0, i == 2 ? -0.02 : i == 3 ? 0.06 : 0, 0),
                          at(i == 0 ? 1 : i == 1 ? -1 : 0, i == 2 ? 1 : i == 3 ? -1 : 0, 0));
        for (i = 0; i < 36; i++) {
            const dem_vec3 x = at(0.02*(i%3), 0.02*(i/3%3), 0.012 + 0.02*(i/9));
            if (i%3) dem_body_add(world, m, shape[i%3 - 1], x, dem_quat_make(1, DEM_R(0.3)*(dem_real)i, DEM_R(0.2), 1));
            else dem_sphere_add(world, m, DEM_R(0.005), x);
        }
        if (run < 2) CHECK_EQ(dem_world_run(world, 0.1, 0, 0), DEM_OK);
        if (run == 1) CHECK_EQ(dem_checkpoint_write(world, path), DEM_OK);
        if (run == 2) CHECK_EQ(dem_checkpoint_read(world, path), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0.9, 0, 0), DEM_OK);
        hash[run] = dem_world_hash_get(world);
        CHECK(dem_counters_get(world).contacts > 20);
        CHECK(energy_of_motion(world) < 1e-5);    /* it fell by some 2e-2 J */
        for (i = 0; i < 36; i++) CHECK(demi_at(world->bodies.pos + 4*i).z > DEM_R(0.0039));
        dem_world_destroy(world);
    }
    CHECK(hash[0] == hash[1] && hash[0] == hash[2]);
    remove(path);
}
static void rods_refused(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world = dem_world_create(&desc);
    dem_material m = scene_material(world, 1e6, 0.5, 0, 0);
    dem_shape rod;
    CHECK_EQ(dem_shape_capsule_add(world, 0, 1).id, 0);
    CHECK_STR(dem_world_error_get(world), "half_length is 0");
    rod = dem_shape_capsule_add(world, DEM_R(0.01), DEM_R(0.004));
    CHECK_EQ(dem_shape_ellipsoid_add(world, at(1, 2, 3)).id, 0);
    CHECK_STR(dem_world_error_get(world), "dem_shape_ellipsoid_add: contacts between shape 2, an ellipsoid, and shape 1, "
                                      "a capsule, are not available");
    scene_floor(world, m, -0.1, -0.1, 0.1, 0.1, 3, 3);
    CHECK_EQ(dem_body_add(world, m, rod, at(0, 0, 1), dem_quat_make(1, 0, 0, 0)).slot, 0);
    CHECK_STR(dem_world_error_get(world), "wall 1 is a mesh and the body a capsule");
    dem_world_destroy(world);
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
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        ball = dem_sphere_add(world, m, DEM_R(0.01), at(0, 0, 0.01));
        scene_move(world, ball, at(0.5, 0, 0), at(0, 0, 0));
        CHECK_EQ(dem_world_run(world, 0.2, 0, 0), DEM_OK);
        CHECK_REL(scene_state(world, ball).velocity.x, 0.5*5/7, 0.01);
        dem_world_destroy(world);
    }
    TEST("recipe for a wall: in a shell a ball swings as a rolling pendulum, clusters rest on both spheres, "
         "ellipsoids are rejected") {
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
            shell = dem_wall_shell_add(world, m, at(0, 0, 1), DEM_R(0.5));
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
            hash[k] = dem_world_hash_get(world);
            CHECK_EQ(dem_wall_pose_get(world, shell, &pose), DEM_OK);
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
            CHECK_EQ(dem_wall_shell_add(world, m, at(0, 0, 1), 0).id, 0);
            CHECK_STR(dem_world_error_get(world), "dem_wall_shell_add: radius is 0 m, must be > 0");
            CHECK_EQ(dem_wall_shell_add(world, m, at(0, 0, 1), DEM_R(0.05)).id, 1);
            pair = dem_shape_cluster_add(world, &two);
            ball = dem_body_add(world, m, pair, at(0.01, 0, 0.97), dem_quat_make(1, 0, 0, 0));
            CHECK_EQ(dem_body_add(world, m, dem_shape_ellipsoid_add(world, at(1, 2, 3)),
                                  at(0, 0, 1), dem_quat_make(1, 0, 0, 0)).slot, 0);
            CHECK_STR(dem_world_error_get(world), "wall 1 is a shell");
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
    TEST("recipe for a shape: capsules bounce without energy error, weigh and rotate as a row of balls, and rest "
         "among spheres") {
        rods_bounce();
        rods_weigh();
        rods_rest();
        rods_refused();
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
        dem_body_remove(a, dem_body_id_get(a, 5));
        CHECK_EQ(scene_step(a, 1000), DEM_OK);
        CHECK_EQ(dem_checkpoint_write(a, path), DEM_OK);
        dem_body_remove(b, dem_body_id_get(b, 5));
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
        desc.integrator = DEM_INTEGRATOR_TAYLOR;
        serves(desc, "Taylor (order 1)");
        desc.gravity.z = DEM_R(-9.81);
        desc.dt = DEM_R(1e-4);
        world = dem_world_create(&desc);
        ball = dem_sphere_add(world, scene_material(world, 1e6, 0.5, 0.3, 0), DEM_R(0.01), at(0, 0, 0));
        scene_step(world, 1000);
        t = dem_world_time_get(world);
        CHECK_REL(scene_state(world, ball).position.z, -9.81*t*t/2, 1e-10);
        CHECK_REL(scene_state(world, ball).velocity.z, -9.81*t, 1e-10);
        desc.integrator = (dem_integrator)((int)DEM_INTEGRATOR_TAYLOR + 1);
        CHECK(dem_world_create(&desc) == 0);
        dem_world_destroy(world);
    }
    return test_end();
}
