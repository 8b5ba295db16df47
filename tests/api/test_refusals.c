/* What is refused, and what a refusal leads to: null pointers, values that nothing can be
   calculated with, scenes that lack what was refused, places without number. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../../examples/drum.h"
#include "../../examples/moldyn.h"
#include "../test.h"
#include "../scene.h"

static dem_world *plain_world(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = 1;
    desc.gravity = at(0, 0, -9.81);
    return dem_world_create(&desc);
}
static dem_material stone(dem_world *world) { return scene_material(world, 1e7, 0.5, 0.3, 0); }
/* A refusal names what is null; dem_result: 0 of a null world is not looked at. */
#define REFUSES(call) do { CHECK_EQ((call), DEM_ERROR_ARGUMENT); \
    if (world) CHECK_STR(dem_world_error_get(world), "null"); } while (0)
#define ANSWERS(call, what) do { CHECK_EQ((call), (what)); \
    if (world) CHECK_STR(dem_world_error_get(world), "null"); } while (0)

/* Every public function that takes a world, with a null one; all that can be null is null. */
static void null_world(void) {
    dem_world *world = 0;
    const dem_material m = {1};
    const dem_shape shape = {1};
    const dem_wall wall = {1};
    const dem_field field = {1};
    const dem_feed feed = {1};
    const dem_joint joint = {1};
    const dem_outlet outlet = {1};
    const dem_body body = {1, 1};
    const dem_vec3 x = at(0, 0, 1);
    const dem_box box = box_of(0, 0, 0, 1, 1, 1);
    const dem_quat q = dem_quat_make(1, 0, 0, 0);
    CHECK_STR(dem_world_error_get(world), "world is null");
    CHECK_STR(dem_world_error_get(world), "dem_world_create_error_get");
    dem_world_destroy(world);
    CHECK_EQ(dem_world_desc_get(world).planar, 0);
    CHECK_EQ(dem_material_add(world, 0).id, 0);
    REFUSES(dem_pair_get(world, m, m, 0));
    REFUSES(dem_pair_set(world, m, m, 0));
    REFUSES(dem_coefficients_get(world, m, m, 1, 1, 0));
    dem_pairs_print(world, stdout);
    CHECK_EQ(dem_sphere_add(world, m, 1, x).slot, 0);
    REFUSES(dem_spheres_add(world, m, 1, 0, 0, 0, 1));
    CHECK_EQ(dem_spheres_fill(world, m, 1, dem_region_make(box), 1, 1), 0);
    CHECK_EQ(dem_spheres_pack(world, m, 1, 0, dem_region_make(box), 1), 0);
    REFUSES(dem_body_remove(world, body));
    REFUSES(dem_body_get(world, body, 0));
    REFUSES(dem_body_set(world, body, 0));
    CHECK_EQ(dem_bodies_get(world).count, 0);
    CHECK(dem_bodies_get(world).positions == 0);
    CHECK_EQ(dem_body_id_get(world, 0).slot, 0);
    CHECK_EQ(dem_shape_ellipsoid_add(world, x).id, 0);
    CHECK_EQ(dem_shape_cluster_add(world, 0).id, 0);
    REFUSES(dem_shape_get(world, shape, 0));
    CHECK_EQ(dem_body_add(world, m, shape, x, q).slot, 0);
    REFUSES(dem_bodies_add(world, m, shape, 1, 0, 0, 0, 0, 0));
    CHECK_EQ(dem_bodies_fill(world, m, shape, dem_region_make(box), 1, 1), 0);
    CHECK_EQ(dem_body_counts_get(world).present, 0);
    CHECK_EQ(dem_wall_plane_add(world, m, x, x).id, 0);
    CHECK_EQ(dem_wall_cylinder_add(world, m, x, x, 1, 1).id, 0);
    CHECK_EQ(dem_wall_profile_add(world, m, 0, DEM_EDGE_RESOLVED).id, 0);
    CHECK_EQ(dem_wall_mesh_add(world, m, 0).id, 0);
    CHECK_EQ(dem_wall_grains_add(world, m, 1, 0, 1, 1).id, 0);
    CHECK_EQ(dem_wall_sieve_add(world, m, 0).id, 0);
    CHECK_EQ(dem_sieve_blinded_get(world, wall, 0), -1);
    REFUSES(dem_wall_motion_set(world, wall, 0));
    REFUSES(dem_wall_pose_get(world, wall, 0));
    REFUSES(dem_wall_remove(world, wall));
    REFUSES(dem_wall_loads_get(world, wall, 0));
    REFUSES(dem_wall_loads_reset(world, wall));
    CHECK_EQ(dem_joint_add(world, 0).id, 0);
    REFUSES(dem_joint_get(world, joint, 0));
    REFUSES(dem_joint_motor_set(world, joint, DEM_MOTOR_NONE, 0, 0));
    REFUSES(dem_joint_remove(world, joint));
    CHECK_EQ(dem_feed_add(world, 0).id, 0);
    REFUSES(dem_feed_get(world, feed, 0));
    CHECK_EQ(dem_outlet_add(world, 0).id, 0);
    REFUSES(dem_outlet_get(world, outlet, 0));
    REFUSES(dem_outlet_reset(world, outlet));
    REFUSES(dem_step_advice_get(world, 0));
    REFUSES(dem_world_step(world, 1));
    REFUSES(dem_world_run(world, 1, 0, 0));
    CHECK_EQ(dem_progress_print(world, 0, 0, 0), 0);
    CHECK(!(dem_world_time_get(world) > 0));
    CHECK_EQ(dem_world_steps_get(world), 0);
    CHECK_EQ(dem_world_hash_get(world), 0);
    CHECK_EQ(dem_counters_get(world).steps, 0);
    dem_overlap_max_reset(world);
    CHECK(!(dem_ledger_get(world).kinetic > 0));
    CHECK(!(dem_totals_get(world).mass > 0));
    CHECK_EQ(dem_contacts_get(world, 0, 0), -1);
    CHECK_EQ(dem_candidates_get(world, 0, 0), -1);
    REFUSES(dem_candidates_rebuild(world));
    CHECK_EQ(dem_field_add(world, 0).id, 0);
    REFUSES(dem_field_get(world, field, 0));
    REFUSES(dem_field_reset(world, field));
    REFUSES(dem_mesh_read(world, 0, 0, 0));
    REFUSES(dem_mesh_parse(world, 0, 0, 0, 0, 0));
    dem_mesh_free(world, 0);
    REFUSES(dem_profile_read(world, 0, 0));
    REFUSES(dem_profile_parse(world, 0, 0, 0, 0));
    dem_profile_free(world, 0);
    REFUSES(dem_vtp_write(world, 0));
    REFUSES(dem_vtk_write(world, 0));
    REFUSES(dem_xyz_write(world, 0));
    REFUSES(dem_walls_vtp_write(world, 0, 0, 1));
    REFUSES(dem_surfaces_vtp_write(world, 0));
    REFUSES(dem_wall_loads_csv_write(world, wall, 0));
    REFUSES(dem_checkpoint_write(world, 0));
    REFUSES(dem_checkpoint_read(world, 0));
    CHECK(dem_slabs_create(world, 0) == 0);
    dem_world_report(world, stdout);
}
/* Every public function that takes a pointer that has to lead somewhere, with a null one. */
static void null_pointers(dem_world *world) {
    const dem_material m = {1};
    const dem_shape shape = {1};
    const dem_wall wall = {1};
    const dem_field field = {1};
    const dem_feed feed = {1};
    const dem_joint joint = {1};
    const dem_outlet outlet = {1};
    dem_body body = dem_body_id_get(world, 0);
    dem_coefficients c;
    dem_mesh no_mesh = {3, 1, 0, 0};
    dem_slabs_desc two = DEM_SLABS_DESC;
    dem_slabs *slabs;
    dem_slab slab;
    ANSWERS(dem_material_add(world, 0).id, 0);
    REFUSES(dem_pair_get(world, m, m, 0));
    REFUSES(dem_pair_set(world, m, m, 0));
    REFUSES(dem_coefficients_get(world, m, m, 1, 1, 0));
    dem_pairs_print(world, 0);
    CHECK_EQ(dem_spheres_add(world, m, 1, 0, 0, 0, 1), DEM_ERROR_ARGUMENT);
    REFUSES(dem_body_get(world, body, 0));
    REFUSES(dem_body_set(world, body, 0));
    ANSWERS(dem_shape_cluster_add(world, 0).id, 0);
    REFUSES(dem_shape_get(world, shape, 0));
    CHECK_EQ(dem_bodies_add(world, m, shape, 1, 0, 0, 0, 0, 0), DEM_ERROR_ARGUMENT);
    ANSWERS(dem_wall_profile_add(world, m, 0, DEM_EDGE_RESOLVED).id, 0);
    ANSWERS(dem_wall_mesh_add(world, m, 0).id, 0);
    CHECK_EQ(dem_wall_mesh_add(world, m, &no_mesh).id, 0);
    CHECK_EQ(dem_wall_grains_add(world, m, 1, 0, 1, 1).id, 0);
    ANSWERS(dem_wall_sieve_add(world, m, 0).id, 0);
    REFUSES(dem_wall_motion_set(world, wall, 0));
    REFUSES(dem_wall_pose_get(world, wall, 0));
    REFUSES(dem_wall_loads_get(world, wall, 0));
    ANSWERS(dem_joint_add(world, 0).id, 0);
    REFUSES(dem_joint_get(world, joint, 0));
    ANSWERS(dem_feed_add(world, 0).id, 0);
    REFUSES(dem_feed_get(world, feed, 0));
    ANSWERS(dem_outlet_add(world, 0).id, 0);
    REFUSES(dem_outlet_get(world, outlet, 0));
    REFUSES(dem_step_advice_get(world, 0));
    ANSWERS(dem_progress_print(world, 0, 0, 0), 0);
    CHECK(dem_contacts_get(world, 0, 5) >= 0);
    CHECK(dem_candidates_get(world, 0, 5) >= 0);
    ANSWERS(dem_field_add(world, 0).id, 0);
    REFUSES(dem_field_get(world, field, 0));
    REFUSES(dem_mesh_read(world, 0, 0, 0));
    REFUSES(dem_mesh_read(world, 0, &no_mesh, 0));
    REFUSES(dem_mesh_parse(world, 0, 0, 0, 0, 0));
    dem_mesh_free(world, 0);
    REFUSES(dem_profile_read(world, 0, 0));
    REFUSES(dem_profile_parse(world, 0, 0, 0, 0));
    dem_profile_free(world, 0);
    REFUSES(dem_vtp_write(world, 0));
    REFUSES(dem_vtk_write(world, 0));
    REFUSES(dem_xyz_write(world, 0));
    REFUSES(dem_walls_vtp_write(world, 0, 0, 1));
    REFUSES(dem_surfaces_vtp_write(world, 0));
    REFUSES(dem_wall_loads_csv_write(world, wall, 0));
    REFUSES(dem_checkpoint_write(world, 0));
    REFUSES(dem_checkpoint_read(world, 0));
    dem_world_report(world, 0);
    CHECK(dem_slabs_create(world, 0) == 0);
    CHECK_STR(dem_world_error_get(world), "desc is null");
    two.count = 2;
    slabs = dem_slabs_create(world, &two);
    CHECK(slabs != 0);
    CHECK_EQ(dem_slabs_collect(slabs, 0), DEM_ERROR_ARGUMENT);
    CHECK_EQ(dem_slab_get(slabs, 0, 0), DEM_ERROR_ARGUMENT);
    dem_slabs_destroy(slabs);
    (void)c; (void)slab;
}
static void null_others(void) {
    dem_slab slab;
    CHECK_STR(dem_world_create_error_get(0), "desc is null");
    CHECK(dem_world_create(0) == 0);
    CHECK(!(dem_ellipsoids_contact_get(0, 0, 0).scale > 0));
    CHECK_EQ(drum_grains(1, 1, 0, 1, 0), 0);
    dem_slabs_destroy(0);
    CHECK_EQ(dem_slabs_step(0, 1), DEM_ERROR_ARGUMENT);
    CHECK_EQ(dem_slabs_collect(0, 0), DEM_ERROR_ARGUMENT);
    dem_slabs_loads_reset(0);
    CHECK_STR(dem_slabs_error_get(0), "null");
    CHECK_EQ(dem_slab_get(0, 0, &slab), DEM_ERROR_ARGUMENT);
    CHECK_EQ(dem_slabs_counters_get(0).steps, 0);
    CHECK_STR(dem_result_name_get((dem_result)-1), "unknown");
}

static void own_law(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    memory[0] += c->dt;
    push->normal = 1000*c->overlap;
}
static int everywhere(dem_vec3 x, dem_real radius, void *user) {
    (void)x; (void)radius;
    ++*(int *)user;
    return 1;
}

/* Grains that fly about in a box and, when asked, a feed above them. */
static dem_world *spare_world(scene_memory *f, int fed) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_feed_desc feed;
    dem_world *world;
    dem_material m;
    desc.threads = 1;
    desc.dt = DEM_R(2e-5);
    desc.allow_large_dt = 1;
    scene_memory_use(f, &desc);
    world = dem_world_create(&desc);
    m = scene_material(world, 1e6, 0.9, 0.3, 0);
    scene_block(world, m, 5, 5, 4, 1e-3, 1, 1, 3);
    if (!fed) return world;
    memset(&feed, 0, sizeof feed);
    feed.material = m; feed.class_count = 2; feed.rate = 2e4;
    feed.radius[0] = DEM_R(1e-3); feed.radius[1] = DEM_R(7e-4);
    feed.amount[0] = feed.amount[1] = 1;
    feed.box = box_of(0, 0, 0.02, 0.02, 0.02, 0.04);
    dem_feed_add(world, &feed);
    return world;
}
/* Step by step; one that got no memory is called again. */
static void spare_run(dem_world *world, int steps) {
    int i;
    for (i = 0; i < steps; i++) {
        dem_result result = dem_world_step(world, 1);
        if (result == DEM_ERROR_MEMORY) result = dem_world_step(world, 1);
        CHECK_EQ(result, DEM_OK);
    }
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("every public function rejects a null world, desc or output pointer and names it") {
        dem_world *world = plain_world();
        dem_material m = stone(world);
        dem_field_desc field;
        dem_feed_desc feed;
        dem_outlet_desc outlet;
        int i;
        null_world();
        null_others();
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 0.001));
        dem_sphere_add(world, m, DEM_R(1e-3), at(1, 0, 0.001));
        memset(&field, 0, sizeof field);
        field.box = box_of(0, 0, 0, 1, 1, 1);
        for (i = 0; i < 3; i++) field.cells[i] = 1;
        CHECK_EQ(dem_field_add(world, &field).id, 1);
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        null_pointers(world);
        dem_world_destroy(world);
        world = plain_world();
        m = stone(world);
        memset(&feed, 0, sizeof feed);
        feed.material = m; feed.class_count = 1; feed.rate = 1;
        feed.radius[0] = DEM_R(1e-3); feed.amount[0] = 1;
        CHECK_EQ(dem_feed_add(world, &feed).id, 1);
        memset(&outlet, 0, sizeof outlet);
        outlet.box = box_of(-1, -1, -2, 1, 1, -1);
        CHECK_EQ(dem_outlet_add(world, &outlet).id, 1);
        CHECK_EQ(dem_feed_get(world, dem_feed_add(world, &feed), 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_outlet_get(world, dem_outlet_add(world, &outlet), 0), DEM_ERROR_ARGUMENT);
        dem_world_destroy(world);
    }
    TEST("a run after an unread error fails and quotes it, and runs once it has been read or corrected") {
        dem_world *world = plain_world();
        dem_material_desc bad = DEM_MATERIAL_DESC, good = scene_stuff(1e7, 0.5, 0.3, 0);
        dem_material m;
        m = dem_material_add(world, &bad);      /* no density */
        CHECK_EQ(m.id, 0);
        CHECK_EQ(dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 1)).slot, 0);
        CHECK_EQ(dem_world_run(world, 0.01, 0, 0), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_world_steps_get(world), 0);
        CHECK_STR(dem_world_error_get(world), "dem_world_step: did not start");
        CHECK_STR(dem_world_error_get(world), "dem_material_add: density is 0");
        CHECK_EQ(dem_world_run(world, 0.01, 0, 0), DEM_OK);                 /* read */
        dem_material_add(world, &bad);
        m = dem_material_add(world, &good);     /* made good */
        CHECK_EQ(dem_world_step(world, 1), DEM_OK);
        CHECK_EQ(dem_sphere_add(world, m, -1, at(0, 0, 1)).slot, 0);
        CHECK_EQ(dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 0)).id, 0);
        dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 1));
        CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "dem_wall_plane_add");
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 0));
        dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
        CHECK_EQ(dem_world_step(world, 1), DEM_OK);
        CHECK_EQ(dem_world_step(world, 0), DEM_OK);
        dem_world_destroy(world);
    }
    TEST("read-only, removing and file calls that fail, and a full box, do not block a run") {
        dem_world *world = plain_world();
        const dem_material m = stone(world);
        const dem_body body = dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 1));
        dem_body_state state;
        dem_wall none;
        none.id = 7;
        CHECK_EQ(dem_body_remove(world, body), DEM_OK);
        CHECK_EQ(dem_body_remove(world, body), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_body_get(world, body, &state), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_wall_remove(world, none), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_vtp_write(world, "build/tmp/no such folder/x.vtp"), DEM_ERROR_FILE);
        CHECK_EQ(dem_checkpoint_read(world, "build/tmp/no such file"), DEM_ERROR_FILE);
        CHECK(dem_spheres_fill(world, m, DEM_R(1e-3), dem_region_make(box_of(0, 0, 0, 4e-3, 4e-3, 4e-3)), 99, 1) <
              99);
        CHECK_EQ(dem_world_step(world, 1), DEM_OK);
        dem_world_destroy(world);
    }
    TEST("twenty runs of 0.05 s end within half a step of 1 s, and time is a whole number of "
         "steps") {
        dem_world *world;
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_material m;
        int i;
        desc.threads = 1;
        desc.dt = DEM_R(3.3e-4);
        world = dem_world_create(&desc);
        m = scene_material(world, 1e4, 0.5, 0, 0);
        dem_sphere_add(world, m, DEM_R(0.1), at(0, 0, 0));
        for (i = 0; i < 20; i++) CHECK_EQ(dem_world_run(world, 0.05, 0, 0), DEM_OK);
        /* half a step, and the rounding of twenty sums */
        CHECK_NEAR(dem_world_time_get(world), 1, 1.65e-4*(1 + 1e-6));
        /* one product: rounded once */
        CHECK_NEAR(dem_world_time_get(world),
                   (double)dem_world_steps_get(world)*(double)desc.dt, 0);
        CHECK_EQ(dem_world_step(world, 7), DEM_OK);
        CHECK_EQ(dem_world_run(world, 0.5, 0, 0), DEM_OK);       /* from where it stands */
        CHECK_NEAR(dem_world_time_get(world), 1.5 + 7*3.3e-4, 3.3e-4);
        dem_world_destroy(world);
    }
    TEST("NaN in double precision is detected by its bits under any optimisation") {
        const double bad[] = {HUGE_VAL, -HUGE_VAL, HUGE_VAL - HUGE_VAL, -1};
        int i;
        for (i = 0; i < 4; i++) {
            dem_world *world = plain_world();
            dem_field_desc field;
            dem_feed_desc feed;
            dem_motion motion = DEM_MOTION;
            moldyn frames = MOLDYN;
            dem_wall wall;
            const dem_material m = stone(world);
            dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 1));
            CHECK_EQ(dem_world_run(world, bad[i], 0, 0), DEM_ERROR_ARGUMENT);
            memset(&field, 0, sizeof field);
            field.box = box_of(0, 0, 0, 1, 1, 1);
            field.cells[0] = field.cells[1] = field.cells[2] = 1;
            field.interval = bad[i];
            CHECK_EQ(dem_field_add(world, &field).id, 0);
            memset(&feed, 0, sizeof feed);
            feed.material = m; feed.class_count = 1; feed.radius[0] = 1; feed.amount[0] = 1;
            feed.rate = bad[i];
            CHECK_EQ(dem_feed_add(world, &feed).id, 0);
            feed.rate = 1; feed.amount[0] = bad[i];
            CHECK_EQ(dem_feed_add(world, &feed).id, 0);
            feed.amount[0] = 1; feed.start = bad[i];
            CHECK_EQ(dem_feed_add(world, &feed).id, 0);
            wall = dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            motion.kind = DEM_MOTION_TRANSLATING;
            motion.start = bad[i];
            if (i < 3) CHECK_EQ(dem_wall_motion_set(world, wall, &motion), DEM_ERROR_ARGUMENT);
            CHECK_EQ(moldyn_str_append(&frames, world, "build/tmp/refused.str", bad[i], 1, 0, 0),
                     DEM_ERROR_ARGUMENT);
            remove("build/tmp/refused.str");
            dem_world_destroy(world);
        }
    }
    TEST("radii whose mass or inverse mass is 0 or infinite are rejected with an error") {
        const double radius[] = {DEMI_SINGLE ? 1e-16 : 1e-110, DEMI_SINGLE ? 1e13 : 1e110,
                                 DEMI_SINGLE ? 1e-30 : 1e-300};
        const dem_real origin[3] = {0, 0, 0};
        int i;
        for (i = 0; i < 3; i++) {
            dem_world *world = plain_world();
            const dem_material m = stone(world);
            const dem_real r = (dem_real)radius[i];
            dem_feed_desc feed;
            dem_shape egg;
            CHECK_EQ(dem_sphere_add(world, m, r, at(0, 0, 0)).slot, 0);
            CHECK_STR(dem_world_error_get(world), "mass");
            CHECK_EQ(dem_spheres_fill(world, m, r, dem_region_make(box_of(0, 0, 0, 1, 1, 1)), 1, 1), 0);
            CHECK_EQ(dem_spheres_pack(world, m, r, 0, dem_region_make(box_of(0, 0, 0, 1, 1, 1)), 1), 0);
            memset(&feed, 0, sizeof feed);
            feed.material = m; feed.class_count = 1; feed.rate = 1;
            feed.radius[0] = r; feed.amount[0] = 1;
            CHECK_EQ(dem_feed_add(world, &feed).id, 0);
            egg = dem_shape_ellipsoid_add(world, at(1, 1, 1));
            CHECK_EQ(dem_bodies_add(world, m, egg, 1, origin, 0, 0, 0, &r), DEM_ERROR_ARGUMENT);
            CHECK_EQ(dem_body_counts_get(world).present, 0);
            dem_world_destroy(world);
        }
    }
    TEST("an unknown cluster mass rule, a NaN stiffness and a position beyond 1e15 m are rejected") {
        dem_world *world = plain_world();
        const dem_material m = stone(world);
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_cluster_desc cluster = DEM_CLUSTER_DESC;
        dem_real x[3] = {0, 0, 0};
        cluster.count = 1; cluster.positions = x; cluster.radius = 1;
        cluster.mass = (dem_cluster_mass)3;
        CHECK_EQ(dem_shape_cluster_add(world, &cluster).id, 0);
        CHECK_STR(dem_world_error_get(world), "mass is 3");
        desc.law_stiffness = (dem_real)(HUGE_VAL - HUGE_VAL);
        CHECK_STR(dem_world_create_error_get(&desc), "law_stiffness");
        desc.law_stiffness = -1;
        CHECK_STR(dem_world_create_error_get(&desc), "law_stiffness");
        CHECK_EQ(dem_sphere_add(world, m, 1, at(1.1e15, 0, 0)).slot, 0);
        CHECK_STR(dem_world_error_get(world), "1e+15 m");
        dem_world_destroy(world);
    }
    TEST("an unknown edge rule, and vertex counts of none, below none and beyond the limit are rejected") {
        dem_world *world = plain_world();
        const dem_material m = stone(world);
        dem_real x[4] = {0, 0, 1, 0};
        int32_t ends[2] = {0, 1};
        dem_profile profile;
        profile.vertex_count = 2; profile.segment_count = 1;
        profile.vertices = x; profile.segments = ends;
        CHECK_EQ(dem_wall_profile_add(world, m, &profile, (dem_edge_rule)3).id, 0);
        CHECK_STR(dem_world_error_get(world), "rule is 3");
        profile.segment_count = -1;
        CHECK_EQ(dem_wall_profile_add(world, m, &profile, DEM_EDGE_RESOLVED).id, 0);
        CHECK_STR(dem_world_error_get(world), "-1 elements; there must be at least one");
        profile.segment_count = 1; profile.vertex_count = INT_MAX;
        CHECK_EQ(dem_wall_profile_add(world, m, &profile, DEM_EDGE_RESOLVED).id, 0);
        CHECK_STR(dem_world_error_get(world), "2147483647 vertices");
        CHECK_EQ(dem_wall_grains_add(world, m, -3, x, 1, 1).id, 0);
        CHECK_STR(dem_world_error_get(world), "-3 vertices");
        profile.vertex_count = 2;
        CHECK_EQ(dem_wall_profile_add(world, m, &profile, DEM_EDGE_FRACTION).id, 1);
        dem_world_destroy(world);
    }
    TEST("a run stopped by an overlap is at the end of that step, and later failing calls change nothing") {
        dem_world *world = plain_world();
        const dem_material m = stone(world);
        dem_sieve_desc sieve = DEM_SIEVE_DESC;
        const dem_shape egg = dem_shape_ellipsoid_add(world, at(1e-3, 1e-3, 1.5e-3));
        uint64_t hash;
        dem_body_add(world, m, egg, at(0, 0, 0.01), dem_quat_make(1, 0, 0, 0));
        dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 0.02));
        dem_sphere_add(world, m, DEM_R(1e-3), at(1e-5, 0, 0.02));
        CHECK_EQ(dem_world_step(world, 5), DEM_ERROR_UNSTABLE);
        sieve.kind = DEM_SIEVE_REDUCED;
        sieve.aperture = DEM_R(1e-3);
        sieve.bar = DEM_R(2e-4);
        sieve.normal = at(0, 0, 1);
        hash = dem_world_hash_get(world);
        CHECK_EQ(dem_wall_sieve_add(world, m, &sieve).id, 0);
        CHECK_EQ(dem_world_step(world, 5), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "is a sieve");
        CHECK(dem_world_hash_get(world) == hash);
        dem_world_destroy(world);
    }
    TEST("a packing stops at its count in any box, and one with more positions than can be counted is rejected") {
        dem_world *world = plain_world();
        const dem_material m = stone(world);
        const dem_box huge = box_of(0, 0, 0, 1e6, 1e6, 1e6);
        int asked = 0;
        CHECK_EQ(dem_spheres_pack(world, m, 1, 0, dem_region_make(box_of(0, 0, 0, 1, 1, 1)), 0), 0);
        CHECK_STR(dem_world_error_get(world), "the box is smaller than one sphere");
        CHECK_EQ(dem_spheres_pack(world, m, DEM_R(1e-3), 0, dem_region_make(huge), 10), 10);
        CHECK_EQ(dem_spheres_pack(world, m, DEM_R(1e-3), 0, dem_region_make(huge), 0), 0);
        CHECK_STR(dem_world_error_get(world), "the box has room for");
        CHECK_EQ(dem_spheres_pack(world, m, DEM_R(1e-3), 0, dem_region_inside_make(huge, everywhere, &asked), 10), 10);
        CHECK(asked <= 20);                      /* those that are taken are asked, too */
        /* 1626^3 places: more than 2^32 */
        CHECK_EQ(dem_spheres_pack(world, m, 1, 0, dem_region_make(box_of(0, 0, 0, 3252, 3252, 3252)), 0), 0);
        CHECK_EQ(dem_body_counts_get(world).present, 20);
        CHECK_EQ(drum_grains(DEM_R(1e5), 1, DEM_R(1e-3), 1, 0), 0);
        CHECK_EQ(drum_grains(1, DEM_R(1e9), DEM_R(1e-3), 0, 0), 0);
        CHECK(drum_grains(1, 1, DEM_R(0.01), 1, 0) > 1000);
        dem_world_destroy(world);
    }
    TEST("ten thousand bodies at one position, or two heaps 1e12 m apart, are rejected in the search with an error") {
        const int n = 80000;
        dem_real *x = (dem_real *)calloc((size_t)n*3, sizeof(dem_real));
        int how, i;
        for (how = 0; how < 2; how++) {
            dem_world *world = plain_world();
            const dem_material m = stone(world);
            if (how) for (i = 0; i < n; i++) {
                x[3*i] = (dem_real)(i%2*1e12);
                x[3*i + 1] = (dem_real)(i/2%200*3e-3);
                x[3*i + 2] = (dem_real)(i/400*3e-3);
            }
            CHECK_EQ(dem_spheres_add(world, m, n, x, 0, 0, DEM_R(1e-3)), DEM_OK);
            CHECK_EQ(dem_world_step(world, 1), DEM_ERROR_ARGUMENT);
            CHECK_STR(dem_world_error_get(world), "in one cell");
            CHECK_EQ(dem_world_steps_get(world), 0);
            dem_world_destroy(world);
        }
        free(x);
    }
    TEST("a published friction table reads back pair by pair; unset static friction follows sliding friction") {
        /* sliding friction of wood pellets (1), steel (2), acrylic (3): rows of the kind printed in
           calibration papers */
        static const double table[3][3] = {{0.24, 0.34, 0.41}, {0.34, 0.15, 0.2}, {0.41, 0.2, 0.1}};
        dem_world *world = plain_world();
        dem_material m[3];
        dem_pair pair;
        int i, j;
        for (i = 0; i < 3; i++) m[i] = scene_material(world, 1e7, 0.5, 0.5, 0);
        for (i = 0; i < 3; i++)
            for (j = i; j < 3; j++) {
                dem_pair_get(world, m[i], m[j], &pair);
                CHECK_NEAR(pair.friction, 0.5, 1e-7);          /* rounded to single precision */
                CHECK(!(pair.friction_static > 0));
                pair.friction = (dem_real)table[i][j];
                CHECK_EQ(dem_pair_set(world, m[i], m[j], &pair), DEM_OK);
            }
        for (i = 0; i < 3; i++)
            for (j = 0; j < 3; j++) {
                dem_real coef[DEMI_COEFS];
                dem_pair_get(world, m[i], m[j], &pair);
                CHECK_NEAR(pair.friction, (dem_real)table[i][j], 0);
                demi_coefficients(world, i, j, 1, 1, 1, 0, coef);
                CHECK_NEAR(coef[DEMI_MU_STATIC], (dem_real)table[i][j], 0);
            }
        pair.friction_static = DEM_R(0.05);                    /* below the sliding one */
        CHECK_EQ(dem_pair_set(world, m[0], m[1], &pair), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "0 (the same as the sliding friction)");
        dem_world_destroy(world);
    }
    TEST("a run repeated after a failed allocation has the same feed, candidates and bits") {
        int fed, k;
        for (fed = 0; fed < 2; fed++) {
            scene_memory f, none;
            dem_world *plain = spare_world(&none, fed);
            spare_run(plain, 300);
            for (k = 1, f.refused = 1; f.refused && k < 60; k++) {
                dem_world *world = spare_world(&f, fed);
                const int before = test_now.wrong;
                f.refuse = f.calls + k;
                spare_run(world, 300);
                CHECK_EQ(dem_world_hash_get(world), dem_world_hash_get(plain));
                CHECK_EQ(dem_counters_get(world).candidates, dem_counters_get(plain).candidates);
                CHECK_EQ(dem_counters_get(world).rebuilds, dem_counters_get(plain).rebuilds);
                if (test_now.wrong > before)
                    printf("        with feed %d, allocation %d\n", fed, k);
                dem_world_destroy(world);
            }
            CHECK(k > 20);
            dem_world_destroy(plain);
        }
    }
    TEST("the hash is the same with a contact list and with its history in transit to the next one") {
        scene_memory none;
        dem_world *world = spare_world(&none, 0);
        uint64_t hash;
        scene_step(world, 40);
        CHECK(dem_contacts_get(world, 0, 0) > 10);
        hash = dem_world_hash_get(world);
        CHECK(demi_list_drop(world));
        CHECK(world->filed.count > 10);
        CHECK_EQ(dem_world_hash_get(world), hash);
        world->filed.memory[0] += DEM_R(1e-6);
        CHECK(dem_world_hash_get(world) != hash);
        dem_world_destroy(world);
    }
    TEST("a wall and a body that cannot touch are rejected when the second is added, in either order, and the scene "
         "still runs") {
        int order, kind, how;
        for (kind = 0; kind < 2; kind++)
            for (how = 0; how < 3; how++)
                for (order = 0; order < 2; order++) {
                    dem_world *world = plain_world();
                    const dem_material m = stone(world);
                    const dem_shape egg = dem_shape_ellipsoid_add(world, at(1e-3, 1e-3, 2e-3));
                    const dem_real x[3] = {0, 0, 1};
                    const char *call = how == 0 ? "dem_body_add" : how == 1 ? "dem_bodies_add"
                        : "dem_bodies_fill";
                    dem_sieve_desc sieve = DEM_SIEVE_DESC;
                    dem_profile profile;
                    dem_real p[4] = {-1, -1, 1, -1};
                    int32_t s[2] = {0, 1};
                    dem_region region;
                    uint64_t was = 0;
                    int turn;
                    sieve.kind = DEM_SIEVE_REDUCED;
                    sieve.aperture = DEM_R(0.01);
                    sieve.bar = DEM_R(0.002);
                    profile.vertex_count = 2; profile.segment_count = 1;
                    profile.vertices = p; profile.segments = s;
                    memset(&region, 0, sizeof region);
                    region.box = box_of(0, 0, 1, 1, 1, 2);
                    dem_sphere_add(world, m, DEM_R(1e-3), at(0, 0, 0.5));
                    for (turn = 0; turn < 2; turn++) {
                        const int before = world->bodies.count, walls = world->wall_count;
                        int done;
                        if (turn) was = dem_world_hash_get(world);
                        if (order == turn)
                            done = kind ? dem_wall_profile_add(world, m, &profile,
                                                          DEM_EDGE_FRACTION).id > 0
                                : dem_wall_sieve_add(world, m, &sieve).id > 0;
                        else if (how == 0)
                            done = dem_body_add(world, m, egg, at(0, 0, 1),
                                                dem_quat_make(1, 0, 0, 0)).slot != 0;
                        else if (how == 1)
                            done = dem_bodies_add(world, m, egg, 1, x, 0, 0, 0, 0) == DEM_OK;
                        else if (how == 2)
                            done = dem_bodies_fill(world, m, egg, dem_region_make(region.box), 3, 1) == 3;
                        else done = dem_bodies_fill(world, m, egg, region, 3, 1) == 3;
                        CHECK_EQ(done, !turn);
                        if (!turn) continue;
                        CHECK_EQ(world->bodies.count, before);
                        CHECK_EQ(world->wall_count, walls);
                        CHECK_EQ(dem_world_hash_get(world), was);
                    }
                    CHECK_STR(dem_world_error_get(world), order == 0 ? call : kind ? "dem_wall_profile_add"
                              : "dem_wall_sieve_add");
                    CHECK_STR(dem_world_error_get(world), kind ? "is a profile of DEM_EDGE_FRACTION"
                              : "is a sieve");
                    CHECK_STR(dem_world_error_get(world), kind ? "are not available" : "only for spheres");
                    CHECK_EQ(scene_step(world, 2), DEM_OK);
                    dem_world_destroy(world);
                }
    }
    TEST("a linked-list search of no bodies finds none") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        desc.threads = 1;
        desc.search = DEM_SEARCH_LINKED_LIST;
        world = dem_world_create(&desc);
        stone(world);
        CHECK_EQ(dem_world_step(world, 2), DEM_OK);
        dem_world_destroy(world);
    }
    TEST("no list is built from positions that are not finite: the error names the body at once") {
        dem_world *world = plain_world();
        const dem_material m = stone(world);
        int i;
        for (i = 0; i < 20; i++) dem_sphere_add(world, m, DEM_R(1e-3), at(0.003*i, 0, 0));
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        world->bodies.pos[4*7 + 1] = (dem_real)(HUGE_VAL - HUGE_VAL);
        CHECK_EQ(dem_candidates_rebuild(world), DEM_ERROR_UNSTABLE);
        CHECK_STR(dem_world_error_get(world), "body");
        dem_wall_plane_add(world, m, at(0, 0, -1), at(0, 0, 1));
        CHECK(dem_world_run(world, 1e-3, 0, 0) != DEM_OK);
        dem_spheres_fill(world, m, DEM_R(1e-3), dem_region_make(box_of(0, 0, 1, 1, 1, 2)), 5, 1);
        CHECK(dem_world_step(world, 40) != DEM_OK);
        dem_world_destroy(world);
    }
    TEST("a feed inserts no grain into a plane, cylinder, mesh or profile") {
        int kind;
        for (kind = 0; kind < 4; kind++) {
            dem_world *world = plain_world();
            const dem_material m = stone(world);
            dem_feed_desc feed;
            dem_feed_state state;
            dem_feed id;
            if (kind == 0) dem_wall_plane_add(world, m, at(0, 0, 0), at(0, 0, 1));
            if (kind == 1) dem_wall_cylinder_add(world, m, at(0, 0, 0), at(0, 0, 1), DEM_R(0.03), 1);
            if (kind == 2) scene_floor(world, m, -0.1, -0.1, 0.1, 0.1, 1, 1);
            if (kind == 3) scene_floor(world, m, -0.1, -0.1, 0.1, 0.1, 9, 9);
            memset(&feed, 0, sizeof feed);
            feed.material = m; feed.class_count = 1; feed.limited = 1;
            feed.radius[0] = DEM_R(2e-3); feed.amount[0] = 100;
            feed.box = box_of(-0.03, -0.03, -0.01, 0.03, 0.03, 0.03);
            id = dem_feed_add(world, &feed);
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            CHECK_EQ(dem_feed_get(world, id, &state), DEM_OK);
            CHECK(state.total > 50);
            /* one step of free fall: no contact yet */
            CHECK_NEAR(dem_counters_get(world).overlap_max, 0, 1e-6);
            dem_world_destroy(world);
        }
    }
    TEST("a writer follows a link, writes to a device directly and rejects a pipe") {
        const char *link = "build/tmp/link.vtp", *file = "build/tmp/linked.vtp";
        const char *null_link = "build/tmp/null.vtp", *pipe_name = "build/tmp/pipe.vtp";
        FILE *f;
        dem_world *world = plain_world();
        dem_sphere_add(world, stone(world), 1, at(0, 0, 0));
        remove(link); remove(file); remove(null_link); remove(pipe_name);
        CHECK(1);
        f = fopen(file, "wb");
        fputs("older", f);
        fclose(f);
        if (system("cd build/tmp && ln -s linked.vtp link.vtp && ln -s /dev/null null.vtp && "
                   "mkfifo pipe.vtp") == 0) {
            CHECK_EQ(dem_vtp_write(world, link), DEM_OK);
            CHECK_EQ(system("test -h build/tmp/link.vtp && grep -q VTKFile build/tmp/linked.vtp"),
                     0);
            CHECK_EQ(dem_vtp_write(world, null_link), DEM_OK);
            CHECK_EQ(dem_checkpoint_write(world, null_link), DEM_OK);
            CHECK_EQ(system("test -h build/tmp/null.vtp && test -c build/tmp/null.vtp"), 0);
            CHECK_EQ(dem_vtp_write(world, pipe_name), DEM_ERROR_FILE);
            CHECK_STR(dem_world_error_get(world), "is a pipe");
            CHECK_EQ(system("test -p build/tmp/pipe.vtp"), 0);
            remove(link);
            CHECK_EQ(system("ln -s link.vtp build/tmp/link.vtp"), 0);       /* to itself */
            CHECK_EQ(dem_vtp_write(world, link), DEM_ERROR_FILE);
        }
        remove(link); remove(file); remove(null_link); remove(pipe_name);
        dem_world_destroy(world);
    }
    TEST("the report describes a user-defined law and no built-in one") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        char text[4000] = "";
        FILE *f = fopen("build/tmp/report.txt", "w+b");
        desc.threads = 1;
        desc.law = own_law;
        desc.law_memory = 3;
        world = dem_world_create(&desc);
        scene_material(world, 1e6, 0.5, 0, 0);
        dem_world_report(world, f);
        rewind(f);
        CHECK(fread(text, 1, sizeof text - 1, f) > 100);
        CHECK_STR(text, "user-defined law; spins and torques are followed; 3 reals of memory");
        CHECK(!strstr(text, "no friction"));
        fclose(f);
        remove("build/tmp/report.txt");
        dem_world_destroy(world);
    }
    TEST("an empty region of an outlet or field is rejected with its corners, on each axis") {
        dem_world *world = plain_world();
        dem_outlet_desc outlet = DEM_OUTLET_DESC;
        dem_field_desc field;
        int k, way;
        memset(&field, 0, sizeof field);
        for (k = 0; k < 3; k++) field.cells[k] = 1;
        for (k = 0; k < 3; k++)
            for (way = 0; way < 3; way++) {     /* of no thickness, upside down, at infinity */
                dem_real x[3] = {1, 1, 1};
                x[k] = (dem_real)(way == 0 ? 0 : way == 1 ? -1 : 1e30);
                outlet.box = field.box = box_of(0, 0, 0, (double)x[0], (double)x[1], (double)x[2]);
                CHECK_EQ(dem_outlet_add(world, &outlet).id, 0);
                CHECK_STR(dem_world_error_get(world), "dem_outlet_add: the box goes from (0, 0, 0) to (");
                CHECK_EQ(dem_field_add(world, &field).id, 0);
                CHECK_STR(dem_world_error_get(world), "dem_field_add: the box goes from (0, 0, 0) to (");
            }
        dem_world_destroy(world);
    }
    TEST("a world never steps by 0 s: huge coefficients are rejected when set, and a step below 1e-20 s is rejected "
         "before the first step") {
        static const double large[] = {1e10, 1e20, 1e155, 1e300};
        dem_world_desc desc = DEM_WORLD_DESC;
        int field, i, normal;
        desc.threads = 1;
        desc.gravity.z = DEM_R(-9.81);
        for (i = 0; i < 4; i++)
            for (normal = 0; normal < 2; normal++)
                for (field = 0; field < 12; field++) {
                    dem_material_desc m = scene_stuff(1e6, 0.5, 0.5, 0.1);
                    const dem_real value = (dem_real)large[i];
                    dem_result result = DEM_OK;
                    dem_material stuff;
                    dem_pair pair;
                    dem_world *world;
                    desc.normal_law = normal ? DEM_NORMAL_LINEAR : DEM_NORMAL_HERTZ;
                    if (normal) m.stiffness = 1000;
                    world = dem_world_create(&desc);
                    if (field == 0) m.young = value;
                    if (field == 1) m.stiffness = value;
                    if (field == 2) m.friction = value;
                    if (field == 3) m.rolling_friction = value;
                    if (field == 4) m.stiffness_ratio = value;
                    stuff = dem_material_add(world, &m);
                    if (stuff.id) {
                        dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
                        dem_sphere_add(world, stuff, DEM_R(1e-3), at(0, 0, 1e-3));
                        dem_sphere_add(world, stuff, DEM_R(1e-3), at(0, 0, 3e-3));
                        dem_pair_get(world, stuff, stuff, &pair);
                        if (field == 5) pair.tangent_damping = value;
                        if (field == 6) pair.rolling_friction = value;
                        if (field == 7) pair.normal_damping = value;
                        if (field == 8) pair.stiffness_ratio = value;
                        if (field == 9) pair.shear_eff = value;
                        result = dem_pair_set(world, stuff, stuff, &pair);
                        if (result == DEM_OK && field == 10)
                            scene_move(world, dem_body_id_get(world, 0), at(0, large[i], 0), at(0, 0, 0));
                        if (result == DEM_OK && field == 11) {
                            dem_feed_desc feed = DEM_FEED_DESC;
                            feed.material = stuff; feed.class_count = 1; feed.rate = 1;
                            feed.radius[0] = DEM_R(1e-3); feed.amount[0] = 1;
                            feed.box = box_of(0, 0, 1, 1, 1, 2);
                            feed.velocity.x = value;
                            result = dem_feed_add(world, &feed).id ? DEM_OK : DEM_ERROR_ARGUMENT;
                        }
                    }
                    if (stuff.id && result == DEM_OK && dem_world_step(world, 1) == DEM_OK)
                        CHECK(world->clock.dt >= DEM_R(1e-20) && dem_world_time_get(world) > 0);
                    else CHECK(strlen(dem_world_error_get(world)) > 0);
                    dem_world_destroy(world);
                }
        for (i = 0; i < 5; i++) {
            static const double steps[] = {-1, 1e-21, 1e-37, 1e16, 1e30};
            dem_world *world = plain_world();
            desc.dt = (dem_real)steps[i];
            CHECK(!dem_world_create(&desc));
            CHECK_STR(dem_world_create_error_get(&desc), "dt must be 0 or 1e-20 to 1e15 s");
            CHECK_EQ(dem_world_dt_set(world, (dem_real)steps[i]), DEM_ERROR_ARGUMENT);
            CHECK_STR(dem_world_error_get(world), "must be 0 or 1e-20 to 1e+15 s");
            dem_world_destroy(world);
        }
        desc.dt = 0;
        desc.law = own_law;
        desc.law_memory = 3;
        desc.law_vectors = 1 << 30;
        CHECK(!dem_world_create(&desc));
        CHECK_STR(dem_world_create_error_get(&desc), "law_vectors");
    }
    return test_end();
}
