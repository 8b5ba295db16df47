/* Restarts with changes: dem_checkpoint_read_changed takes the state of the file and the settings of the world. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static const char *const saved = "build/tmp/changed.ckpt";
static void must(dem_world *world, dem_result result) {
    CHECK_EQ(result, DEM_OK);
    if (result != DEM_OK) puts(dem_world_error_get(world));
}
static dem_world_desc settings(dem_response response) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity = at(0, 0, -10);
    desc.threads = 1;
    desc.response = response;
    desc.domain = box_of(0, 0, 0, 0.05, 0.03, 0.03);
    desc.boundary[0] = DEM_BOUNDARY_PERIODIC;
    desc.dt = (dem_real)(response == DEM_RESPONSE_IMPULSES ? 1e-4 : 1e-5);
    return desc;
}
static dem_real swells(const dem_body_state *body, dem_body id, double time, void *user) {
    (void)body; (void)id; (void)time; (void)user;
    return DEM_R(0.01);                        /* m/s */
}
/* Spheres and clusters in a trough. */
static dem_world *trough(const dem_world_desc *desc, double friction) {
    static const dem_real two[6] = {0, DEM_R(-1e-3), 0, 0, DEM_R(1e-3), 0};
    dem_world *world = dem_world_create(desc);
    const dem_material stuff = scene_material(world, 1e6, 0.5, friction, 0);
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    cluster.count = 2;
    cluster.positions = two;
    cluster.radius = DEM_R(1.5e-3);
    dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
    dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 1, 0));
    dem_wall_plane_add(world, stuff, at(0, 0.03, 0), at(0, -1, 0));
    CHECK_EQ(dem_spheres_fill(world, stuff, DEM_R(2e-3), dem_region_make(box_of(0, 0, 0, 0.05, 0.03, 0.03)), 120, 1), 120);
    CHECK_EQ(dem_bodies_fill(world, stuff, dem_shape_cluster_add(world, &cluster),
                             dem_region_make(box_of(0, 0, 0, 0.05, 0.03, 0.05)), 20, 2), 20);
    return world;
}
/* Sum of the magnitudes of the histories of all contacts: their first three reals. */
static void tell(const dem_contact_info *info, dem_real *memory, void *user) {
    double *sum = (double *)user;
    int k;
    (void)info;
    for (k = 0; k < 3; k++) *sum += fabs((double)memory[k]);
}
static double history(dem_world *world) {
    double sum = 0;
    dem_contacts_each(world, tell, &sum);
    return sum;
}
static double apart(const dem_world *a, const dem_world *b) {
    double most = 0;
    uint32_t k;
    for (k = 1; k <= 140; k++) {
        dem_body id;
        id.slot = k;
        id.generation = 1;
        most = fmax(most, fabs((double)scene_state(a, id).position.z - (double)scene_state(b, id).position.z) +
                    fabs((double)scene_state(a, id).velocity.z - (double)scene_state(b, id).velocity.z));
    }
    return most;
}
/* Sum over bodies and axes of |m v x|. A rounding of x by eps x is one of the velocity by eps x/dt, and of the kinetic
   energy by this sum times eps/dt. */
static double rounded(const dem_world *world) {
    double sum = 0;
    uint32_t k;
    for (k = 1; k <= 140; k++) {
        dem_body id;
        dem_body_state s;
        id.slot = k;
        id.generation = 1;
        s = scene_state(world, id);
        sum += (double)s.mass*(fabs((double)s.velocity.x*(double)s.position.x) +
                               fabs((double)s.velocity.y*(double)s.position.y) +
                               fabs((double)s.velocity.z*(double)s.position.z));
    }
    return sum;
}
static void twice(const dem_contact *c, dem_real *memory, dem_contact_force *force) {
    dem_law_hertz(c, memory, force);
    dem_law_spring(c, memory, force);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a restart with another step, integrator, ledger and orientations keeps positions and contact histories") {
        dem_world_desc desc = settings(DEM_RESPONSE_SPRINGS);
        dem_world *old = trough(&desc, 0.4), *fresh;
        double before;
        dem_ledger l;
        must(old, dem_world_step(old, 4000));
        must(old, dem_checkpoint_write(old, saved));
        before = history(old);
        CHECK(before > 0);
        desc.dt = DEM_R(5e-6);
        desc.ledger = 1;
        desc.orientations = 1;
        desc.integrator = DEM_INTEGRATOR_POSITION_VERLET;
        fresh = trough(&desc, 0.4);
        CHECK_EQ(dem_checkpoint_read_changed(fresh, saved, "dt ledger"), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(fresh), "integrator");
        must(fresh, dem_checkpoint_read_changed(fresh, saved, "dt ledger orientations integrator"));
        CHECK_STR(dem_checkpoint_changes_get(fresh), "dt: 1e-05 there, 5e-06 here");
        CHECK_STR(dem_checkpoint_changes_get(fresh), "ledger: 0 there, 1 here");
        CHECK_NEAR(apart(old, fresh), 0, 0);
        CHECK_REL(history(fresh), before, sizeof(dem_real) == 8 ? 1e-12 : 1e-5);
        CHECK_EQ(dem_world_desc_get(fresh).dt > DEM_R(4e-6) && dem_world_desc_get(fresh).dt < DEM_R(6e-6), 1);
        must(fresh, dem_world_step(fresh, 200));
        l = dem_ledger_get(fresh);
        CHECK(l.inserted > 0 && l.growth > 0);
        CHECK_NEAR(l.residual, 0, sizeof(dem_real) == 8 ? 2e-3*l.throughput
                   : fmin(0.1*l.throughput, 20*1.2e-7*rounded(fresh)/5e-6));
        must(old, dem_world_step(old, 100));
        /* the same motion, by another scheme; in single precision its velocities are differences of positions */
        CHECK_NEAR(apart(old, fresh), 0, sizeof(dem_real) == 8 ? 1e-3 : 20*1.2e-7*0.05/5e-6);
        dem_world_destroy(fresh);
        dem_world_destroy(old);
    }
    TEST("a restart may change laws, materials and pairs, and histories of other laws begin at 0") {
        dem_world_desc desc = settings(DEM_RESPONSE_SPRINGS);
        dem_world *old = trough(&desc, 0.4), *fresh;
        must(old, dem_world_step(old, 4000));
        must(old, dem_checkpoint_write(old, saved));
        desc.tangent_law = DEM_TANGENT_VISCOUS;
        fresh = trough(&desc, 0.2);
        CHECK_EQ(dem_checkpoint_read_changed(fresh, saved, "tangent_law"), DEM_ERROR_FORMAT);
        must(fresh, dem_checkpoint_read_changed(fresh, saved, "tangent_law materials pairs"));
        CHECK_STR(dem_checkpoint_changes_get(fresh), "friction of material 1: 0.4 there, 0.2 here");
        must(fresh, dem_world_step(fresh, 200));
        scene_report_has(fresh, "tangential: viscous");
        dem_world_destroy(fresh);
        desc.law = twice;
        desc.law_memory = 3;
        desc.law_vectors = 1;
        desc.tangent_law = DEM_TANGENT_AUTO;
        fresh = trough(&desc, 0.4);
        must(fresh, dem_checkpoint_read_changed(fresh, saved, "law law_memory law_vectors"));
        CHECK_NEAR(apart(old, fresh), 0, 0);
        CHECK_NEAR(history(fresh), 0, 0);
        must(fresh, dem_world_step(fresh, 200));
        CHECK(history(fresh) > 0);
        must(fresh, dem_checkpoint_write(fresh, saved));    /* and back to the built-in law */
        must(old, dem_checkpoint_read_changed(old, saved, "law law_memory law_vectors"));
        CHECK_NEAR(apart(old, fresh), 0, 0);
        must(old, dem_world_step(old, 100));
        dem_world_destroy(fresh);
        dem_world_destroy(old);
    }
    TEST("a restart of impulses may change the solver, and one without changes continues bit for bit") {
        dem_world_desc desc = settings(DEM_RESPONSE_IMPULSES);
        dem_world *old = trough(&desc, 0.4), *fresh = trough(&desc, 0.4);
        must(old, dem_world_step(old, 200));
        must(old, dem_checkpoint_write(old, saved));
        must(fresh, dem_checkpoint_read_changed(fresh, saved, ""));
        CHECK(!*dem_checkpoint_changes_get(fresh));
        must(old, dem_world_step(old, 50));
        must(fresh, dem_world_step(fresh, 50));
        CHECK(dem_world_hash_get(old) == dem_world_hash_get(fresh));
        dem_world_destroy(fresh);
        desc.solver = DEM_SOLVER_JACOBI;
        desc.sweeps = 400;
        desc.dt = DEM_R(5e-5);
        fresh = trough(&desc, 0.4);
        must(fresh, dem_checkpoint_read_changed(fresh, saved, "solver sweeps dt"));
        CHECK_STR(dem_checkpoint_changes_get(fresh), "solver: gauss_seidel there, jacobi here");
        must(fresh, dem_world_step(fresh, 50));
        CHECK(dem_counters_get(fresh).dt < DEM_R(6e-5));
        dem_world_destroy(fresh);
        dem_world_destroy(old);
    }
    TEST("the ledger books what springs hold more after a restart with a stiffer material") {
        dem_world_desc desc = settings(DEM_RESPONSE_SPRINGS);
        dem_material_desc stuff = scene_stuff(5e6, 0.5, 0.4, 0);
        dem_material m;
        dem_world *old, *fresh;
        dem_ledger l;
        m.id = 1;
        desc.ledger = 1;
        old = trough(&desc, 0.4);
        must(old, dem_world_step(old, 4000));
        must(old, dem_checkpoint_write(old, saved));
        fresh = trough(&desc, 0.4);
        must(fresh, dem_material_set(fresh, m, &stuff));
        must(fresh, dem_checkpoint_read_changed(fresh, saved, "materials pairs"));
        must(fresh, dem_world_step(fresh, 1));
        l = dem_ledger_get(fresh);
        CHECK(l.growth > 0.01*l.throughput);
        CHECK_NEAR(l.residual, dem_ledger_get(old).residual, 1e-3*l.throughput);
        dem_world_destroy(fresh);
        dem_world_destroy(old);
    }
    TEST("growth that begins with a restart does not count the time before it") {
        dem_world_desc desc = settings(DEM_RESPONSE_SPRINGS);
        dem_world *old = trough(&desc, 0.4), *fresh;
        dem_body one;
        double radius;
        one.slot = one.generation = 1;
        must(old, dem_world_step(old, 100));
        must(old, dem_checkpoint_write(old, saved));
        radius = (double)scene_state(old, one).radius;
        desc.growth = swells;
        fresh = trough(&desc, 0.4);
        must(fresh, dem_checkpoint_read_changed(fresh, saved, "growth"));
        must(fresh, dem_world_step(fresh, 10));
        CHECK_REL(scene_state(fresh, one).radius, radius + 0.01*1e-4, sizeof(dem_real) == 8 ? 1e-12 : 2e-6);
        dem_world_destroy(fresh);
        dem_world_destroy(old);
    }
    TEST("a restart refuses what may not differ, and then the world is as it was") {
        dem_world_desc desc = settings(DEM_RESPONSE_SPRINGS);
        dem_world *old = trough(&desc, 0.4), *fresh;
        uint64_t hash;
        must(old, dem_world_step(old, 100));
        must(old, dem_checkpoint_write(old, saved));
        desc.integrator = DEM_INTEGRATOR_POSITION_VERLET;
        desc.thickness = 2;
        fresh = trough(&desc, 0.4);
        must(fresh, dem_world_step(fresh, 10));
        hash = dem_world_hash_get(fresh);
        CHECK_EQ(dem_checkpoint_read_changed(fresh, saved, "integrator thickness"), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(fresh), "\"thickness\" is not a field of dem_world_desc that may differ");
        CHECK_EQ(dem_checkpoint_read_changed(fresh, saved, "integrator"), DEM_ERROR_FORMAT);
        CHECK_STR(dem_world_error_get(fresh), "thickness");
        CHECK(dem_world_hash_get(fresh) == hash);
        must(fresh, dem_world_step(fresh, 10));
        dem_world_destroy(fresh);
        dem_world_destroy(old);
    }
    remove(saved);
    return test_end();
}
