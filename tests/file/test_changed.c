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

static dem_world_desc rolling(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = 1;
    desc.dt = DEM_R(1e-5);
    desc.ledger = 1;
    desc.gravity = at(1, 0, -9.81);
    return desc;
}
/* Spheres and clusters that roll on a floor and on each other, pressed together from the start, with values for
   every law that has a contact history. */
static dem_world *rollers(const dem_world_desc *desc) {
    static const dem_real two[6] = {0, 0, 0, DEM_R(3e-3), 0, 0};
    dem_world *world;
    dem_material_desc m = scene_stuff(1e7, 0.5, 0.3, 0.1);
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_material stuff;
    dem_shape pair;
    dem_pair own;
    int i;
    if (desc->normal_law == DEM_NORMAL_HYSTERETIC || desc->normal_law == DEM_NORMAL_LINEAR) {
        m.stiffness = DEM_R(5e3);
        m.stiffness_unloading = DEM_R(2e4);
        m.stiffness_adhesion = DEM_R(1e3);
    }
    world = dem_world_create(desc);
    stuff = dem_material_add(world, &m);
    dem_pair_get(world, stuff, stuff, &own);
    own.spinning_friction = DEM_R(0.1);
    dem_pair_set(world, stuff, stuff, &own);
    cluster.count = 2;
    cluster.positions = two;
    cluster.radius = DEM_R(4e-3);
    pair = dem_shape_cluster_add(world, &cluster);
    dem_wall_plane_add(world, stuff, at(0, 0, 0), at(0, 0, 1));
    for (i = 0; i < 12; i++) {                 /* each touches the floor or the body below */
        const dem_vec3 x = at(0.012*(i%6), 0, i < 6 ? 0.00399 : 0.01196);
        if (i%2) dem_body_add(world, stuff, pair, x, dem_quat_about(at(0, 1, 0), DEM_R(0.2)));
        else dem_sphere_add(world, stuff, DEM_R(4e-3), x);
    }
    return world;
}
/* Settings with another law than those of number `k`, and the fields that differ; 0: there are no more. */
static const char *other_law(int k, dem_world_desc *there, dem_world_desc *here) {
    *there = *here = rolling();
    switch (k) {
    case 0: here->tangent_law = DEM_TANGENT_MINDLIN_RESCALED; return "tangent_law";
    case 1: here->tangent_law = DEM_TANGENT_NONE; return "tangent_law";
    case 2: here->rolling_law = DEM_ROLLING_CONSTANT; return "rolling_law";
    case 3: here->rolling_law = DEM_ROLLING_NONE; return "rolling_law";
    case 4:
        there->normal_law = DEM_NORMAL_HYSTERETIC;
        here->normal_law = DEM_NORMAL_LINEAR;
        return "normal_law";
    case 5: there->cluster_contacts = DEM_CLUSTER_CONTACTS_SEPARATE; return "cluster_contacts";
    case 6: here->cluster_contacts = DEM_CLUSTER_CONTACTS_SEPARATE; return "cluster_contacts";
    case 7:
        here->law = twice;
        here->law_memory = 3;
        here->law_vectors = 1;
        return "law law_memory law_vectors";
    case 8: here->law = dem_law_hertz; return "law";
    default: return 0;
    }
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
    TEST("a restart with other materials mixes their pairs again, and pairs of dem_pair_set stay") {
        enum { HERE = 1, THERE = 2 };           /* which world has called dem_pair_set */
        static const struct { int set; const char *allowed; dem_result result; double expected; } rows[] = {
            {0, "materials", DEM_OK, 0.2}, {HERE | THERE, "materials", DEM_OK, 0.7},
            {HERE, "materials", DEM_ERROR_FORMAT, 0.7}, {THERE, "materials", DEM_ERROR_FORMAT, 0.2},
            {THERE, "materials pairs", DEM_OK, 0.2}, {0, "pairs", DEM_ERROR_FORMAT, 0.2}};
        int k, response, side;
        for (response = 0; response < 2; response++)
            for (k = 0; k < 6; k++) {
                dem_world_desc desc = settings(response ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS);
                dem_world *world[2];
                dem_material other = {2}, first = {1};
                dem_pair pair;
                for (side = 0; side < 2; side++) {      /* there, here */
                    world[side] = trough(&desc, side ? 0.2 : 0.4);
                    other = scene_material(world[side], 1e6, 0.5, side ? 0.2 : 0.4, 0);
                    dem_sphere_add(world[side], other, DEM_R(2e-3), at(0.02, 0.015, 0.05));
                    if (!(rows[k].set & (side ? HERE : THERE))) continue;
                    CHECK_EQ(dem_pair_get(world[side], first, other, &pair), DEM_OK);
                    pair.friction = DEM_R(0.7);
                    pair.friction_static = 0;
                    CHECK_EQ(dem_pair_set(world[side], first, other, &pair), DEM_OK);
                }
                must(world[0], dem_world_step(world[0], 50));
                must(world[0], dem_checkpoint_write(world[0], saved));
                CHECK_EQ(dem_checkpoint_read_changed(world[1], saved, rows[k].allowed), rows[k].result);
                if (rows[k].result != DEM_OK)
                    CHECK_STR(dem_world_error_get(world[1]), rows[k].set ? "(dem_pair_set) of materials 1 and 2"
                                                                         : "friction 0.4 of material 1,");
                CHECK_EQ(dem_pair_get(world[1], first, other, &pair), DEM_OK);
                CHECK_NEAR(pair.friction, rows[k].expected, 1e-7);
                CHECK_EQ(dem_pair_get(world[1], first, first, &pair), DEM_OK);
                CHECK_NEAR(pair.friction, 0.2, 1e-7);
                must(world[1], dem_world_step(world[1], 50));
                for (side = 0; side < 2; side++) dem_world_destroy(world[side]);
            }
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
    TEST("a checkpoint written between a restart with other laws and its first step continues like the restart") {
        static const char *const again = "build/tmp/again.ckpt";
        const char *allowed;
        dem_world_desc there, here;
        int k, i;
        for (k = 0; (allowed = other_law(k, &there, &here)) != 0; k++) {
            const int before = test_now.wrong;
            dem_world *old = rollers(&there), *fresh[3];     /* restarts; restarts and writes; reads that */
            for (i = 0; i < 3; i++) fresh[i] = rollers(&here);
            must(old, dem_world_step(old, 200));
            must(old, dem_checkpoint_write(old, saved));
            for (i = 0; i < 2; i++) must(fresh[i], dem_checkpoint_read_changed(fresh[i], saved, allowed));
            must(fresh[1], dem_checkpoint_write(fresh[1], again));
            must(fresh[2], dem_checkpoint_read(fresh[2], again));
            for (i = 0; i < 3; i++) must(fresh[i], dem_world_step(fresh[i], 50));
            for (i = 1; i < 3; i++) CHECK_EQ(dem_world_hash_get(fresh[i]), dem_world_hash_get(fresh[0]));
            if (test_now.wrong > before) printf("        with other laws of number %d: %s\n", k, allowed);
            for (i = 0; i < 3; i++) dem_world_destroy(fresh[i]);
            dem_world_destroy(old);
        }
        CHECK_EQ(k, 9);
        remove(again);
    }
    TEST("a scheduled checkpoint at the start of a restart with another law can be read") {
        static const char *const first = "build/tmp/first.ckpt";
        dem_world_desc there = rolling(), here = rolling();
        dem_world *old, *fresh;
        here.tangent_law = DEM_TANGENT_MINDLIN;
        old = rollers(&there);
        fresh = rollers(&here);
        must(old, dem_world_step(old, 100));
        must(old, dem_checkpoint_write(old, saved));
        CHECK(dem_output_every_add(fresh, DEM_OUTPUT_CHECKPOINT, first, 1e-3).id > 0);
        must(fresh, dem_checkpoint_read_changed(fresh, saved, "tangent_law"));
        must(fresh, dem_world_step(fresh, 5));           /* the file is that of the first of these steps */
        dem_world_destroy(fresh);
        fresh = rollers(&here);
        must(fresh, dem_checkpoint_read(fresh, first));
        CHECK_EQ(dem_world_steps_get(fresh), 100);
        dem_world_destroy(fresh);
        dem_world_destroy(old);
        remove(first);
    }
    TEST("a restart without a ledger ends the recording of contacts, and its checkpoint can be read") {
        dem_world_desc desc = rolling();
        dem_events_desc record = DEM_EVENTS_DESC;
        dem_material all;
        dem_impacts impacts;
        dem_world *old = rollers(&desc), *fresh;
        all.id = 0;
        must(old, dem_events_record(old, &record));
        must(old, dem_world_step(old, 200));
        must(old, dem_impacts_get(old, all, all, &impacts));
        CHECK(impacts.open > 5);
        must(old, dem_checkpoint_write(old, saved));
        desc.ledger = 0;
        fresh = rollers(&desc);
        must(fresh, dem_checkpoint_read_changed(fresh, saved, "ledger"));
        CHECK(dem_impacts_get(fresh, all, all, &impacts) != DEM_OK);
        must(fresh, dem_world_step(fresh, 20));
        must(fresh, dem_checkpoint_write(fresh, saved));
        must(fresh, dem_checkpoint_read(fresh, saved));
        must(fresh, dem_world_step(fresh, 20));
        CHECK_EQ(dem_world_steps_get(fresh), 240);
        dem_world_destroy(fresh);
        dem_world_destroy(old);
    }
    TEST("an allocation that fails within a restart with changes leaves the world as it was, and it runs on") {
        dem_world_desc there = rolling(), here = rolling(), now;
        const char *const allowed = "tangent_law dt integrator orientations materials pairs";
        const dem_material_desc soft = scene_stuff(5e6, 0.5, 0.3, 0.1);
        dem_result result = DEM_ERROR_MEMORY;
        scene_memory memory;
        dem_world *old = rollers(&there), *fresh, *plain;    /* tries to restart; never does */
        dem_material m;
        size_t bytes;
        long k;
        m.id = 1;
        must(old, dem_world_step(old, 100));
        must(old, dem_checkpoint_write(old, saved));
        here.tangent_law = DEM_TANGENT_MINDLIN;
        here.integrator = DEM_INTEGRATOR_POSITION_VERLET;
        here.orientations = 1;
        plain = rollers(&here);
        scene_memory_use(&memory, &here);
        fresh = rollers(&here);
        must(plain, dem_material_set(plain, m, &soft));
        must(fresh, dem_material_set(fresh, m, &soft));
        must(plain, dem_world_step(plain, 20));
        must(fresh, dem_world_step(fresh, 20));
        for (k = 1; k < 1000; k++) {
            dem_material_desc is;
            bytes = memory.bytes;
            memory.refuse = memory.calls + k;
            result = dem_checkpoint_read_changed(fresh, saved, allowed);
            memory.refuse = 0;
            if (result == DEM_OK) break;
            CHECK_EQ(result, DEM_ERROR_MEMORY);
            CHECK_STR(dem_world_error_get(fresh), "memory");
            CHECK_EQ(dem_world_hash_get(fresh), dem_world_hash_get(plain));
            now = dem_world_desc_get(fresh);
            CHECK(now.dt >= here.dt && now.dt <= here.dt);
            CHECK(now.tangent_law == here.tangent_law && now.integrator == here.integrator && now.orientations);
            must(fresh, dem_material_get(fresh, m, &is));
            CHECK_NEAR(is.young, 5e6, 1);
            CHECK_EQ(memory.bytes, bytes);
            if (k%4) continue;
            must(fresh, dem_world_step(fresh, 1));
            must(plain, dem_world_step(plain, 1));
            if (test_now.wrong) { printf("        at request %ld\n", k); break; }
        }
        CHECK_EQ(result, DEM_OK);
        CHECK(k > 20);
        must(fresh, dem_world_step(fresh, 20));
        dem_world_destroy(fresh);
        CHECK_EQ(memory.blocks, 0);
        CHECK_EQ(memory.wrong, 0);
        dem_world_destroy(plain);
        dem_world_destroy(old);
    }
    remove(saved);
    return test_end();
}
