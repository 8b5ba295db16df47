/* The same bits for any number of threads, for laws worked out at once and one after the other, and
   however many steps are asked for at a time. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* Everything a result could differ in. */
typedef struct outcome {
    uint64_t hash;
    dem_ledger ledger;
    dem_wall_loads floor;
    int domains;
} outcome;

/* About 6000 grains, mixed, with friction and rolling friction, on a plane and in a turning mesh.
   */
static dem_world *bed_world(int threads, dem_wall *plane) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    dem_motion motion = DEM_MOTION;
    dem_wall wall;
    desc.threads = threads;
    desc.gravity = at(0, 0, -9.81);
    desc.dt = DEM_R(4e-6);
    desc.ledger = 1;
    desc.rolling_law = DEM_ROLLING_EPSD;
    desc.skin = DEM_R(2e-4);
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e7, 0.7, 0.3, 0.1);
    scene_block(world, glass, 19, 18, 18, 1e-3, 1, 2, 7);
    *plane = dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    wall = scene_floor(world, glass, -0.02, -0.02, 0.06, 0.06, 12, 12);
    motion.kind = DEM_MOTION_ROTATING;
    motion.axis = at(0, 0, 1);
    motion.point = at(0.018, 0.018, 0);
    motion.speed = 100;
    dem_wall_motion_set(world, wall, &motion);
    return world;
}
static outcome bed(int threads, int steps, int at_once) {
    dem_wall plane;
    dem_world *world = bed_world(threads, &plane);
    outcome out;
    int done;
    for (done = 0; done < steps; done += at_once) CHECK_EQ(scene_step(world, at_once), DEM_OK);
    memset(&out, 0, sizeof out);
    out.hash = dem_world_hash_get(world);
    out.ledger = dem_ledger_get(world);
    dem_wall_loads_get(world, plane, &out.floor);
    out.domains = dem_counters_get(world).domains;
    CHECK(dem_counters_get(world).contacts > 6000);
    CHECK(dem_counters_get(world).wall_contacts > 150);    /* each once, though plane and mesh are in one place */
    CHECK(dem_counters_get(world).rebuilds > 1);
    dem_world_destroy(world);
    return out;
}
static void check_same(const outcome *a, const outcome *b) {
    CHECK_EQ(a->hash, b->hash);
    CHECK(memcmp(&a->ledger, &b->ledger, sizeof a->ledger) == 0);
    CHECK(memcmp(&a->floor.force, &b->floor.force, sizeof a->floor.force) == 0);
    CHECK(memcmp(a->floor.impulse, b->floor.impulse, sizeof a->floor.impulse) == 0);
    CHECK(memcmp(&a->floor.work, &b->floor.work, sizeof a->floor.work) == 0);
}

static int block_species;                       /* of the last block: how many kinds of spheres */
/* A block of grains between planes or in a periodic box, law by law or all laws at once: its hash. They
   are of so many materials, all with the same properties; of 2, the second is that of `seconds` grains. */
static uint64_t block(int friction, int rolling, int ledger, int mixed, int periodic, int composed,
                      int materials, int seconds, int *whole) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    uint64_t hash;
    int k;
    desc.threads = 1;
    desc.ledger = ledger;
    desc.dt = DEM_R(2e-6);
    desc.allow_large_dt = 1;
    desc.skin = DEM_R(1.5e-3);                 /* wide: one list for the run, after the first */
    for (k = 0; k < 3 && periodic; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    desc.domain = box_of(0, 0, 0, 7*1.97e-3, 7*1.97e-3, 7*1.97e-3);
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e7, 0.8, friction ? 0.3 : 0, rolling ? 0.1 : 0);
    if (!periodic) dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    for (k = 1; k < materials; k++) scene_material(world, 1e7, 0.8, friction ? 0.3 : 0, rolling ? 0.1 : 0);
    scene_block(world, glass, 7, 7, 7, 1e-3, mixed, 1, 5);
    for (k = 0; k < world->bodies.count && materials > 1; k++)
        world->bodies.material[k] = 1 + (materials == 2 ? k < seconds : k%materials);
    world->composed = composed;
    CHECK_EQ(scene_step(world, 100), DEM_OK);
    *whole = demi_whole_stage(world, world->effects.uniform) != 0;
    block_species = world->effects.species_count;
    CHECK_EQ(dem_counters_get(world).rebuilds, 1);
    hash = dem_world_hash_get(world);
    if (ledger) {
        const dem_ledger book = dem_ledger_get(world);
        hash = demi_hash(hash, &book, sizeof book);
    }
    dem_world_destroy(world);
    return hash;
}

/* Up and down by 2 mm at 400 Hz, from its lowest, where it rests. */
static void kicking(double time, dem_pose *pose, void *user) {
    const double w = 2*3.14159265358979*400;
    (void)user;
    pose->position.z = (dem_real)(2e-3*(1 - cos(w*time)));
    pose->velocity.z = (dem_real)(2e-3*w*sin(w*time));
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a bed of 6000 grains has one hash, ledger and wall force for 1, 2, 3, 4 and 8 threads") {
        static const int threads[] = {2, 3, 4, 8};
        const outcome one = bed(1, 40, 40);
        size_t i;
        CHECK_EQ(one.domains, 4);
        for (i = 0; i < 4; i++) {
            const outcome many = bed(threads[i], 40, 40);
            check_same(&one, &many);
        }
    }
    TEST("where half of the bodies lie on a floor and half fall, no work group has more than 40 % of the contacts, and no thread more than 60 %") {
        static const char *const names[2] = {"cubes", "clusters"};
        int kind, i, d;
        for (kind = 0; kind < 2; kind++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material stone;
            dem_shape shape;
            int all = 0, most = 0, first = 0;
            desc.gravity = at(0, 0, -9.81);
            desc.dt = DEM_R(1e-6);
            desc.threads = 2;
            world = dem_world_create(&desc);
            stone = scene_material(world, 1e7, 0.7, 0.3, 0);
            if (kind) {
                static const dem_real two[6] = {DEM_R(-4e-4), 0, 0, DEM_R(4e-4), 0, 0};
                dem_cluster_desc pair = DEM_CLUSTER_DESC;
                pair.count = 2;
                pair.positions = two;
                pair.radius = DEM_R(6e-4);
                shape = dem_shape_cluster_add(world, &pair);
            } else shape = scene_box(world, 1.2e-3, 1.2e-3, 1.2e-3);
            dem_wall_plane_add(world, stone, at(0, 0, 0), at(0, 0, 1));
            for (i = 0; i < 2*900; i++)
                dem_body_add(world, stone, shape,         /* the tall column is divided along z */
                             at(3e-3*(i%30), 3e-3*(i/30%30), i < 900 ? 5.99e-4 : 4e-3 + 2e-4*(i - 900)), dem_quat_make(1, 0, 0, 0));
            CHECK_EQ(scene_step(world, 2), DEM_OK);
            for (d = 0; d < world->domain_count; d++) {
                const int here = world->domains[d].persistent_walls;
                all += here;
                if (world->domain_middle[d] < 0.5) first += here;
                if (here > most) most = here;
            }
            CHECK(all >= 900);
            if (5*most > 2*all) printf("    %s: %d of %d\n", names[kind], most, all);
            CHECK(5*most <= 2*all);
            CHECK_NEAR(1.0*first/all, 0.5, 0.1);           /* the first of two threads */
            dem_world_destroy(world);
        }
    }
    TEST("a frictionless ball in a sieve's hole keeps its spin, and fifty steps in one call or singly are the same") {
        uint64_t hash[2];
        int singly, i;
        for (singly = 0; singly < 2; singly++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_sieve_desc d = DEM_SIEVE_DESC;
            dem_world *w;
            dem_material m;
            dem_body b;
            desc.dt = DEM_R(5e-6);
            desc.threads = 1;
            w = dem_world_create(&desc);
            m = scene_material(w, 9.5e6, 0.7, 0, 0);
            d.kind = DEM_SIEVE_WIRES;
            d.aperture = DEM_R(1.9e-3);
            d.bar = DEM_R(8.8e-4);
            dem_wall_sieve_add(w, m, &d);
            b = dem_sphere_add(w, m, DEM_R(1.4e-3), at(0, 0, 0));
            scene_move(w, b, at(0, 0, -0.6), at(1, 2, 3));
            for (i = 0; i < (singly ? 50 : 1); i++) CHECK_EQ(dem_world_step(w, singly ? 1 : 50), DEM_OK);
            CHECK_EQ(dem_counters_get(w).wall_contacts > 0, 1);
            CHECK_NEAR(scene_state(w, b).spin.x, 1, 0);
            CHECK_NEAR(scene_state(w, b).spin.z, 3, 0);
            CHECK_NEAR(scene_state(w, b).torque.x, 0, 0);
            hash[singly] = dem_world_hash_get(w);
            dem_world_destroy(w);
        }
        CHECK_EQ(hash[0], hash[1]);
    }
    TEST("the common laws computed in one stage give the bits of law by law") {
        static const struct { int friction, rolling, ledger; } sets[] = {
            {0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}};
        size_t i;
        int mixed, periodic, at_once, by_law;
        for (i = 0; i < sizeof sets/sizeof *sets; i++)
            for (mixed = 0; mixed < 2; mixed++)
                for (periodic = 0; periodic < 2; periodic++) {
                    CHECK_EQ(block(sets[i].friction, sets[i].rolling, sets[i].ledger, mixed, periodic,
                                   0, 1, 0, &at_once),
                             block(sets[i].friction, sets[i].rolling, sets[i].ledger, mixed, periodic,
                                   1, 1, 0, &by_law));
                    CHECK_EQ(at_once, 1);
                    CHECK_EQ(by_law, 0);
                }
    }
    TEST("coefficients shared by all pairs, from a table, or per pair give the same bits") {
        static const struct { int materials, seconds, species; } sets[] = {
            {2, 1, 2}, {2, 150, 2}, {7, 0, 7}, {40, 0, DEMI_SPECIES + 1}};
        size_t i;
        int rolling, ledger, composed, whole;
        CHECK(DEMI_SPECIES < 40);
        for (rolling = 0; rolling < 2; rolling++)
            for (ledger = 0; ledger < 2; ledger++)
                for (composed = 0; composed < 2; composed++) {
                    const uint64_t alike = block(1, rolling, ledger, 0, 1, composed, 1, 0, &whole);
                    for (i = 0; i < sizeof sets/sizeof *sets; i++) {
                        CHECK_EQ(block(1, rolling, ledger, 0, 1, composed, sets[i].materials,
                                       sets[i].seconds, &whole), alike);
                        CHECK_EQ(block_species, sets[i].species);
                    }
                }
    }
    TEST("a short tile of one coefficient row reads nothing of the tile before") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        dem_material one;
        demi_run run[2];
        demi_tile *tile = (demi_tile *)calloc(1, sizeof *tile);
        demi_span span;
        int32_t row[DEMI_TILE];
        int k, q, wrong = 0;
        desc.threads = 1;
        world = dem_world_create(&desc);
        one = scene_material(world, 1e7, 0.8, 0.3, 0);
        scene_material(world, 4e7, 0.5, 0.1, 0);
        scene_block(world, one, 4, 4, 4, 1e-3, 0, 1, 5);
        for (k = 0; k < world->bodies.count; k++) world->bodies.material[k] = 1 + k%2;
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        CHECK_EQ(world->effects.species_count, 2);
        memset(&span, 0, sizeof span);
        span.row = row;
        run[0] = demi_run_of(world, DEM_R(1e-6), 0);
        run[1] = demi_run_of(world, DEM_R(1e-6), 1);
        demi_tile_begin(world, 0, tile);
        for (k = 0; k < 3; k++) {              /* mixed; short, all of row 3; long, all of row 3 */
            const int full = k == 1 ? DEMI_LANES : DEMI_TILE;
            for (q = 0; q < DEMI_TILE; q++) row[q] = k ? 3 : q%4;
            span.count = full;
            CHECK(demi_tile_coefs(world, &span, full, tile, run) == run + (k > 0));
            for (q = 0; q < full; q++) {
                dem_real coef[DEMI_PAIR_COLUMNS];
                demi_span_coefs(world, &span, q, coef);
                wrong += memcmp(&coef[DEMI_KN], &tile->coef[DEMI_KN][q], sizeof(dem_real)) != 0;
                wrong += memcmp(&coef[DEMI_MU], &tile->coef[DEMI_MU][q], sizeof(dem_real)) != 0;
            }
        }
        CHECK_EQ(wrong, 0);
        free(tile);
        dem_world_destroy(world);
    }
    TEST("a grain of a new material joins an existing list only if its coefficients already distinguish materials") {
        int materials;
        for (materials = 1; materials <= 2; materials++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material one;
            int k;
            desc.threads = 1;
            world = dem_world_create(&desc);
            one = scene_material(world, 1e7, 0.8, 0.1, 0);
            scene_material(world, 1e7, 0.8, 0.9, 0);
            scene_block(world, one, 4, 4, 4, 1e-3, 1, 0.1, 5);
            for (k = 0; k < world->bodies.count && materials == 2; k++) world->bodies.material[k] = 1 + k%2;
            CHECK_EQ(scene_step(world, 1), DEM_OK);
            CHECK_EQ(world->effects.species_count, DEMI_SPECIES + 1);
            CHECK_EQ(demi_join_possible(world, 0, DEM_R(1.1e-3)), 1);      /* another radius: yes */
            CHECK_EQ(demi_join_possible(world, 1, DEM_R(1e-3)), materials == 2);
            dem_world_destroy(world);
        }
    }
    TEST("a newly chosen time step starts on the same step for any division into calls") {
        uint64_t hash[3] = {0, 0, 0};
        int k;
        for (k = 0; k < 3; k++) {              /* a wall at 5 m/s kicks grains that were slow */
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material glass;
            dem_motion motion = DEM_MOTION;
            dem_wall wall;
            dem_real first;
            int i;
            desc.threads = 1;
            desc.skin = DEM_R(2e-4);
            world = dem_world_create(&desc);
            glass = scene_material(world, 1e7, 1, 0.3, 0);
            scene_block(world, glass, 4, 4, 4, 1e-3, 1, 0.01, 2);
            wall = scene_floor(world, glass, -0.01, -0.01, 0.02, 0.02, 1, 1);
            motion.kind = DEM_MOTION_USER;      /* nobody knows how fast it will be */
            motion.function = kicking;
            dem_wall_motion_set(world, wall, &motion);
            scene_step(world, 1);
            first = dem_counters_get(world).dt;
            if (k == 0) CHECK_EQ(scene_step(world, 400), DEM_OK);
            else for (i = 0; i < 400; i += 4*k - 3) CHECK_EQ(scene_step(world, 4*k - 3), DEM_OK);
            CHECK((double)dem_counters_get(world).dt < 0.9*(double)first);
            hash[k] = dem_world_hash_get(world);
            dem_world_destroy(world);
        }
        CHECK_EQ(hash[1], hash[0]);
        CHECK_EQ(hash[2], hash[0]);
    }
    return test_end();
}
