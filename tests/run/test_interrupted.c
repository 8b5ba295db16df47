/* Steps that ran out of memory: whatever a program does between the failure and the next step, and however it goes on,
   the bits are those of a run that had memory. Each scene runs once for every request of its steps, or every third or
   fifth, which is refused. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

typedef enum part {
    SPRINGS = 0, IMPULSES = 1, ELLIPSOIDS = 2, FEED = 4, JOINTS = 8, CHOSEN = 16, CSV = 32, PERIODIC = 64,
    POLYHEDRA = 128, LEDGER = 256
} part;
/* How a run goes on after the failure. */
typedef enum how { REPEATED, LOOKED_AT, RUN_ON, RESTARTED, HOWS } how;

static const char *const csv = "build/tmp/interrupted.csv", *const ckpt = "build/tmp/interrupted.ckpt";
static const char *const looked = "build/tmp/interrupted_look.csv";

/* 48 bodies that fall in on their middle onto a moving plane: lists grow on the way. */
static dem_world *collapse(scene_memory *c, unsigned parts) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_motion motion = DEM_MOTION;
    dem_world *world;
    dem_material glass;
    dem_shape shape = {0};
    dem_wall plane;
    dem_body last = {0, 0};
    const double size = parts & IMPULSES ? 10 : 1, rate = parts & IMPULSES ? 40 : 700;
    int i;
    desc.threads = 1;
    desc.gravity = at(0, 0, -9.81);
    desc.response = parts & IMPULSES ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
    desc.orientations = (parts & JOINTS) != 0;
    desc.dt = parts & CHOSEN ? 0 : (dem_real)(parts & IMPULSES ? 5e-4 : parts & POLYHEDRA ? 2e-6 : 4e-6);
    desc.ledger = (parts & LEDGER) != 0;
    if (parts & PERIODIC) {
        desc.domain = box_of(-0.012*size, -0.012*size, -0.1*size, 0.012*size, 0.012*size, 0.1*size);
        desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    }
    scene_memory_use(c, &desc);
    world = dem_world_create(&desc);
    glass = parts & IMPULSES ? scene_material(world, 0, 0.5, 0.3, 0) : scene_material(world, 1e7, 0.7, 0.3, 0.05);
    plane = dem_wall_plane_add(world, glass, at(0, 0, -0.009*size), at(0, 0, 1));
    motion.kind = DEM_MOTION_OSCILLATING;
    motion.velocity = at(0, 0, 1);
    motion.amplitude = (dem_real)(1e-3*size);
    motion.frequency = (dem_real)(100/sqrt(size));
    CHECK_EQ(dem_wall_motion_set(world, plane, &motion), DEM_OK);
    if (parts & ELLIPSOIDS) shape = dem_shape_ellipsoid_add(world, at(8e-4*size, 1e-3*size, 1.3e-3*size));
    if (parts & POLYHEDRA) shape = scene_box(world, 1.6e-3*size, 1.3e-3*size, 1e-3*size);
    for (i = 0; i < 48; i++) {
        const double x = (i%4 - 1.5)*5e-3, y = (i/4%4 - 1.5)*5e-3, z = (i/16 - 1)*5e-3;
        const dem_vec3 place = at(x*size, y*size, z*size);
        const dem_body b = shape.id && i%2 ? dem_body_add(world, glass, shape, place, dem_quat_about(at(1, i, 2), 1))
            : dem_sphere_add(world, glass, (dem_real)(1e-3*size), place);
        if (parts & JOINTS && i%4 && i < 16) {
            dem_joint_desc joint = DEM_JOINT_DESC;
            joint.kind = DEM_JOINT_POINT;
            joint.a = b;
            joint.b = last;
            joint.point = at((x - 2.5e-3)*size, y*size, z*size);
            dem_joint_add(world, &joint);
        }
        scene_move(world, b, at(-rate*x*size, -rate*y*size, -rate*z*size), at(0, 0, i));
        last = b;
    }
    if (parts & FEED) {
        dem_feed_desc feed;
        dem_outlet_desc outlet;
        memset(&feed, 0, sizeof feed);
        memset(&outlet, 0, sizeof outlet);
        feed.material = glass;
        feed.class_count = 2;
        feed.rate = 5e4/sqrt(size);
        feed.radius[0] = (dem_real)(1e-3*size);
        feed.radius[1] = (dem_real)(7e-4*size);
        feed.amount[0] = feed.amount[1] = 1;
        feed.velocity = at(0, 0, -3);
        feed.box = box_of(-0.01*size, -0.01*size, 0.01*size, 0.01*size, 0.01*size, 0.03*size);
        dem_feed_add(world, &feed);
        outlet.box = box_of(-0.003*size, -0.003*size, -0.009*size, 0.003*size, 0.003*size, -0.007*size);
        dem_outlet_add(world, &outlet);
    }
    if (parts & CSV) dem_output_every_add(world, DEM_OUTPUT_CSV, csv, 8e-6);
    CHECK(*dem_world_error_get(world) == 0);
    return world;
}
static uint64_t digest(const char *path) {
    static char text[100000];
    FILE *f = fopen(path, "rb");
    size_t n;
    if (!f) return 0;
    n = fread(text, 1, sizeof text, f);
    fclose(f);
    return demi_hash(DEMI_HASH_START, text, n);
}
/* Calls that only look, and a call that takes no step: it writes the output that is due, if that has failed. */
static void look(dem_world *world) {
    const uint64_t hash = dem_world_hash_get(world);
    uint64_t file;
    CHECK_EQ(dem_world_step(world, 0), DEM_OK);
    file = digest(csv);
    CHECK_EQ(dem_bodies_csv_write(world, looked), DEM_OK);
    dem_ledger_get(world);
    dem_totals_get(world);
    CHECK_EQ(dem_world_hash_get(world), hash);
    CHECK_EQ(digest(csv), file);
}
/* What became of a run. */
typedef struct result { uint64_t hash, steps, file; int refused, moved; } result;
/* Runs `steps` steps, or with a chosen time step to a time, and goes on after each refusal. */
static result run(unsigned parts, int steps, how way, long refuse, long *calls) {
    const double to = parts & CHOSEN ? 2e-3 : 0;
    scene_memory c, other;
    dem_world *world = collapse(&c, parts);
    const double end = to > 0 ? to : steps*(double)dem_world_desc_get(world).dt;
    const long before = c.calls;
    result r = {0, 0, 0, 0, 0};
    int tries;
    c.refuse = refuse ? before + refuse : 0;
    for (tries = 0; tries < 5; tries++) {
        const uint64_t now = dem_world_steps_get(world);
        const dem_result done = to > 0 || (way == RUN_ON && r.refused) ? dem_world_run_to(world, end, 0, 0)
            : dem_world_step(world, steps - (int)now);
        if (done == DEM_OK) break;
        CHECK_EQ(done, DEM_ERROR_MEMORY);
        CHECK_STR(dem_world_error_get(world), "memory");
        CHECK_EQ(dem_counters_get(world).steps, dem_world_steps_get(world));
        r.refused++;
        r.moved += world->stage.moved != 0;
        if (way == LOOKED_AT) look(world);
        if (way == RUN_ON) {                   /* to where the bodies are already */
            CHECK_EQ(dem_world_run_to(world, dem_world_time_get(world), 0, 0), DEM_OK);
            CHECK(!world->stage.moved);
        }
        if (way == RESTARTED) {
            dem_world *fresh = collapse(&other, parts);
            CHECK_EQ(dem_checkpoint_write(world, ckpt), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(fresh, ckpt), DEM_OK);
            CHECK_EQ(dem_world_steps_get(fresh), dem_world_steps_get(world));
            dem_world_destroy(world);
            world = fresh;
        }
    }
    CHECK(tries < 5);
    r.hash = dem_world_hash_get(world);
    r.steps = dem_world_steps_get(world);
    r.file = parts & CSV ? digest(csv) : 0;
    *calls = c.calls - before;
    dem_world_destroy(world);
    return r;
}
/* Contacts of all steps up to that number of steps or, with a chosen time step, up to 2 ms. */
static long contacts(unsigned parts, uint64_t steps) {
    scene_memory c;
    dem_world *world = collapse(&c, parts);
    long sum = 0;
    while (parts & CHOSEN ? dem_world_time_get(world) < 2e-3 : dem_world_steps_get(world) < steps) {
        if (scene_step(world, 1) != DEM_OK) break;
        sum += dem_counters_get(world).contacts + dem_counters_get(world).wall_contacts;
    }
    dem_world_destroy(world);
    return sum;
}
/* Refuses every by-th request of the steps, and goes on in a different way after each. */
static void interrupts(unsigned parts, int steps, int by) {
    long k, calls, none;
    const result base = run(parts, steps, REPEATED, 0, &calls);
    int refused = 0, moved = 0;
    CHECK(contacts(parts, (uint64_t)steps) > 20);
    for (k = 1; k <= calls && test_now.wrong == 0; k += by) {
        const result r = run(parts, steps, (how)(k%HOWS), k, &none);
        refused += r.refused;
        moved += r.moved;
        CHECK_EQ(r.steps, base.steps);
        CHECK_EQ(r.hash, base.hash);
        CHECK_EQ(r.file, base.file);
        if (test_now.wrong) printf("        at request %ld of %ld\n", k, calls);
    }
    CHECK(refused > calls/by/2);
    CHECK(moved > 5);
    remove(csv);
    remove(ckpt);
    remove(looked);
}

/* Every pruned list asks for memory, because that of isolated bodies is taken away (with gravity there are none), and
   is refused it once. */
static void prunes(void) {
    scene_memory c[2];
    dem_world *world[2];
    int i, k, refused = 0;
    for (k = 0; k < 2; k++) world[k] = collapse(&c[k], SPRINGS);
    for (i = 0; i < 400 && test_now.wrong == 0; i++) {
        for (k = 0; k < 2; k++) {
            demi_free(world[k], world[k]->quiet);
            world[k]->quiet = 0;
        }
        c[1].refuse = c[1].calls + 1;
        if (dem_world_step(world[1], 1) == DEM_ERROR_MEMORY) {
            refused += world[1]->stage.moved && world[1]->stage.list_valid;
            CHECK_EQ(scene_step(world[1], 1), DEM_OK);
        }
        CHECK_EQ(scene_step(world[0], 1), DEM_OK);
        CHECK_EQ(dem_world_hash_get(world[1]), dem_world_hash_get(world[0]));
        CHECK_NEAR(world[1]->margin.span, world[0]->margin.span, 0);
        CHECK_NEAR(world[1]->margin.age, world[0]->margin.age, 0);
    }
    CHECK(refused > 10);
    for (k = 0; k < 2; k++) dem_world_destroy(world[k]);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a refused request of memory in a step changes no bit of a run: springs") {
        interrupts(SPRINGS, 400, 1);
    }
    TEST("a refused request of memory in a step changes no bit of a run: a chosen time step") {
        interrupts(SPRINGS | CHOSEN | LEDGER | PERIODIC, 0, 1);
    }
    TEST("a refused request of memory in a step changes no bit of a run and of its outputs") { interrupts(SPRINGS | CSV, 401, 3); }
    TEST("a refused request of memory in a step changes no bit of a run: ellipsoids and feeds") { interrupts(ELLIPSOIDS | FEED, 400, 3); }
    TEST("a refused request of memory in a step changes no bit of a run: boxes") { interrupts(POLYHEDRA, 600, 3); }
    TEST("a refused request of memory in a step changes no bit of a run: impulses and feeds") { interrupts(IMPULSES | FEED | LEDGER, 60, 5); }
    TEST("a refused request of memory in a step changes no bit of a run: joints") { interrupts(IMPULSES | JOINTS, 45, 1); }
    TEST("a refused request of memory in a step changes no bit of a run: joined boxes") {
        interrupts(IMPULSES | POLYHEDRA | JOINTS | PERIODIC, 50, 3);
    }
    TEST("a repeated step makes the pruned list that had found no memory") { prunes(); }
    return test_end();
}
