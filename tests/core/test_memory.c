/* Memory: where it comes from, that all of it goes back, that a warm step takes none, and that
   running out of it at any moment leaves a world that goes on. The allocator counts, keeps the size
   in front of every block, fills what it gives and what it takes back, and can refuse the k-th
   request. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static dem_world_desc counted(scene_memory *c) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.threads = 1;
    desc.gravity = at(0, 0, -9.81);
    scene_memory_use(c, &desc);
    return desc;
}

/* Whether the call that just failed may be made again: only when memory was refused, and then it
   must have said so. */
static int again(dem_world *world, scene_memory *c, int failed, const char *call) {
    if (!failed) {
        if (c->refused) c->refused = 0;        /* it coped: fine */
        return 0;
    }
    if (!c->refused) {
        CHECK(!"a call failed though memory was there");
        printf("        %s\n", dem_world_error_get(world));
        return 0;
    }
    CHECK_STR(dem_world_error_get(world), call);
    CHECK_STR(dem_world_error_get(world), "memory");
    c->refused = 0;
    return 1;
}
/* CALL: a dem_result; must be DEM_ERROR_MEMORY when it fails. ID: an id, null when it fails. */
#define CALL(name, expression) do { \
        const dem_result r_ = (expression); \
        if (r_ != DEM_OK) CHECK_EQ(r_, DEM_ERROR_MEMORY); \
        if (!again(world, c, r_ != DEM_OK, name)) break; } while (1)
#define ID(name, value, expression) do { \
        value = (expression); \
        if (!again(world, c, value.id == 0, name)) break; } while (1)

/* Every call that takes memory, once at least; a refused one is made again. */
static void scenario(scene_memory *c, dem_search search, long refuse, uint64_t *hash) {
    static const char stl[] =
        "9 1\n0 0 0\n1 0 0\n0 1 0\n1 1 1\n2 1 1\n3 1 1\n4 1 1\n5 1 1\n6 1 1\n1 2 3\n";
    static const dem_real beads[] = {DEM_R(0.05), 0, DEM_R(-0.02), DEM_R(0.052), 0, DEM_R(-0.02),
        DEM_R(0.054), 0, DEM_R(-0.02), DEM_R(0.056), 0, DEM_R(-0.02), DEM_R(0.058), 0,
            DEM_R(-0.02)};
    static const dem_real beads_high[] = {0, DEM_R(0.03), DEM_R(0.03), 0, DEM_R(0.031), DEM_R(0.0339)};
    dem_world_desc desc = counted(c);
    dem_cluster_desc cluster = DEM_CLUSTER_DESC;
    dem_shape egg, rod;
    dem_world *world;
    dem_material glass;
    dem_wall plane, drum, mesh_wall;
    dem_field_desc field_desc;
    dem_field field;
    dem_mesh mesh;
    dem_mesh_health health;
    dem_motion motion = DEM_MOTION;
    dem_body body;
    dem_body_counts b;
    uint64_t present;
    int i, n;
    desc.search = search;
    desc.ledger = 1;
    desc.dt = DEM_R(1e-6);
    c->refuse = refuse;
    while (!(world = dem_world_create(&desc))) {
        CHECK(c->refused);
        CHECK_EQ(c->blocks, 0);
        CHECK(*dem_world_create_error_get(&desc) == 0);
        CHECK(*dem_world_error_get(world) != 0);
        if (!c->refused) return;
        c->refused = 0;
    }
    c->refused = 0;
    ID("dem_material_add", glass, scene_material(world, 1e7, 0.5, 0.3, 0.1));
    ID("dem_wall_plane_add", plane, dem_wall_plane_add(world, glass, at(0, 0, -0.03), at(0, 0, 1)));
    ID("dem_wall_cylinder_add", plane, dem_wall_cylinder_add(world, glass, at(0, 0, 0), at(0, 0, 1), 1, 1));
    ID("dem_wall_profile_add", drum, scene_drum(world, glass, 0, 0, 0.1, 24));
    ID("dem_wall_mesh_add", mesh_wall, scene_floor(world, glass, -0.02, -0.02, 0.06, 0.06, 4, 4));
    ID("dem_wall_grains_add", plane, dem_wall_grains_add(world, glass, 5, beads, DEM_R(1e-3), 1));
    motion.kind = DEM_MOTION_ROTATING;
    motion.axis = at(0, 0, 1);
    motion.speed = 10;
    CALL("dem_wall_motion_set", dem_wall_motion_set(world, mesh_wall, &motion));
    memset(&field_desc, 0, sizeof field_desc);
    field_desc.box = box_of(0, 0, 0, 0.02, 0.02, 0.02);
    for (i = 0; i < 3; i++) field_desc.cells[i] = 3;
    field_desc.interval = 1e-5;
    for (i = 0; i < 5; i++) ID("dem_field_add", field, dem_field_add(world, &field_desc));
    CALL("dem_spheres_add", scene_block(world, glass, 3, 3, 4, 2e-3, 1, 0.5, 3));
    do n = dem_spheres_fill(world, glass, DEM_R(1e-3), dem_region_make(box_of(0.02, 0, 0, 0.03, 0.01, 0.01)), 9,
                            1);
    while (again(world, c, n == 0, "dem_spheres_fill"));
    CHECK_EQ(n, 9);
    ID("dem_shape_ellipsoid_add", egg, dem_shape_ellipsoid_add(world, at(1e-3, 1.5e-3, 2e-3)));
    cluster.count = 5;
    cluster.positions = beads;
    cluster.radius = DEM_R(2e-3);
    ID("dem_shape_cluster_add", rod, dem_shape_cluster_add(world, &cluster));
    CALL("dem_bodies_add", dem_bodies_add(world, glass, rod, 2, beads_high, 0, 0, 0, 0));
    do n = dem_bodies_fill(world, glass, egg, dem_region_make(box_of(0.02, 0.01, 0, 0.03, 0.02, 0.01)), 4, 1);
    while (again(world, c, n == 0, "dem_bodies_fill"));
    CHECK_EQ(n, 4);
    CALL("dem_world_step", dem_world_step(world, 3));
    /* while contacts have memory, and more than there is room for */
    do {
        present = dem_body_counts_get(world).present;
        n = dem_spheres_pack(world, glass, DEM_R(1e-3), 0, dem_region_make(box_of(0, 0, 0.02, 0.01, 0.01, 0.03)),
                             60);
        CHECK_EQ(dem_body_counts_get(world).present, present + (uint64_t)n);
        if (n < 60) CHECK_EQ(n, 0);            /* its sentence says that nothing was changed */
    } while (again(world, c, n < 60, "dem_spheres_pack"));
    CALL("dem_world_step", dem_world_step(world, 3));
    body = dem_body_id_get(world, 5);
    CALL("dem_body_remove", dem_body_remove(world, body));
    CALL("dem_world_step", dem_world_step(world, 3));
    ID("dem_wall_plane_add", plane, dem_wall_plane_add(world, glass, at(0, 0, -0.04), at(0, 0, 1)));
    CALL("dem_world_step", dem_world_step(world, 1));
    CALL("dem_wall_remove", dem_wall_remove(world, plane));
    CALL("dem_candidates_rebuild", dem_candidates_rebuild(world));
    CALL("dem_world_step", dem_world_step(world, 3));
    CALL("dem_checkpoint_write", dem_checkpoint_write(world, "build/tmp/memory.ckpt"));
    CALL("dem_checkpoint_read", dem_checkpoint_read(world, "build/tmp/memory.ckpt"));
    CALL("dem_world_step", dem_world_step(world, 3));
    CALL("dem_mesh_parse", dem_mesh_parse(world, "text", stl, sizeof stl - 1, &mesh, &health));
    dem_mesh_free(world, &mesh);
    CALL("dem_vtp_write", dem_vtp_write(world, "build/tmp/memory.vtp"));
    CALL("dem_surfaces_vtp_write", dem_surfaces_vtp_write(world, "build/tmp/memory.vtp"));
    CALL("dem_walls_vtp_write", dem_walls_vtp_write(world, "build/tmp/memory.vtp", 0, 1));
    c->refuse = 0;
    CHECK_EQ(dem_world_step(world, 100), DEM_OK);
    b = dem_body_counts_get(world);
    CHECK_EQ(b.inserted, b.present + b.removed + b.left);
    CHECK_EQ(b.inserted, 36 + 9 + 6 + 60);
    CHECK_EQ(b.removed, 1);
    CHECK_EQ(b.present, dem_bodies_get(world).count);
    CHECK(dem_counters_get(world).contacts > 10);
    CHECK_EQ(dem_counters_get(world).memory, c->bytes);
    *hash = dem_world_hash_get(world);
    dem_world_destroy(world);
    CHECK_EQ(c->blocks, 0);
    CHECK_EQ(c->bytes, 0);
    CHECK_EQ(c->wrong, 0);
}

/* The other searches share all requests but their own with the grid: a quarter of the points will do. */
static void refuse_each(dem_search search) {
    const long points = search == DEM_SEARCH_GRID ? 400 : 100;
    scene_memory c;
    uint64_t hash;
    long k, calls, step;
    scenario(&c, search, 0, &hash);
    calls = c.calls;
    CHECK(calls > 50);
    step = calls > points ? calls/points : 1;
    for (k = 1; k <= calls && test_now.wrong == 0; k += step) {
        scenario(&c, search, k, &hash);
        if (test_now.wrong) printf("        at request %ld of %ld\n", k, calls);
    }
}

/* A packing at rest under gravity, in a box of planes over a mesh, with friction and rolling
   friction. */
static dem_world *packing(scene_memory *c, int threads, double skin, dem_search search) {
    dem_world_desc desc = counted(c);
    dem_world *world;
    dem_material glass;
    int k;
    desc.threads = threads;
    desc.skin = (dem_real)skin;
    desc.search = search;
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e6, 0.2, 0.5, 0.1);
    for (k = 0; k < 4; k++)
        dem_wall_plane_add(world, glass, at(k == 1 ? 0.0257 : 0, k == 3 ? 0.0257 : 0, 0),
                      at((k == 0) - (k == 1), (k == 2) - (k == 3), 0));
    scene_floor(world, glass, -0.01, -0.01, 0.04, 0.04, 5, 5);
    scene_block(world, glass, 6, 6, 6, 2.1e-3, 1, 0.1, 3);
    return world;
}

/* 60 bodies that fall in on their middle, so that lists grow on the way: spheres, or spheres, clusters
   and ellipsoids in turn. */
static void swarm_add(dem_world *world, int mixed) {
    static const dem_real pair[6] = {0, 0, 0, DEM_R(1e-3), 0, 0};
    const dem_material glass = scene_material(world, 1e7, 0.9, 0.3, 0);
    dem_cluster_desc two = DEM_CLUSTER_DESC;
    dem_shape shapes[3] = {{0}, {0}, {0}};
    int i;
    if (mixed) {
        two.count = 2;
        two.positions = pair;
        two.radius = DEM_R(7e-4);
        shapes[1] = dem_shape_cluster_add(world, &two);
        shapes[2] = dem_shape_ellipsoid_add(world, at(8e-4, 1e-3, 1.3e-3));
    }
    for (i = 0; i < 60; i++) {
        const double x = (i%4 - 1.5)*5e-3, y = (i/4%4 - 1.5)*5e-3, z = (i/16 - 1.5)*5e-3;
        const dem_body b = mixed && i%3 ? dem_body_add(world, glass, shapes[i%3], at(x, y, z),
                                                       dem_quat_about(at(1, i, 2), 1))
            : dem_sphere_add(world, glass, DEM_R(1e-3), at(x, y, z));
        scene_move(world, b, at(-600*x, -600*y, -600*z), at(0, 0, 0));
    }
}
/* Runs the swarm with every search; then again for every request for memory (with the grid; every third with the other
   searches), which is refused once. The hash is that of the run in which none was. */
static void swarm_each(int mixed) {
    int search;
    for (search = DEM_SEARCH_ALL_PAIRS; search <= DEM_SEARCH_HIERARCHICAL; search++) {
        uint64_t hash = 0;
        long k, calls = 1;
        for (k = 0; k <= calls && test_now.wrong == 0; k += k && search != DEM_SEARCH_GRID ? 3 : 1) {
            scene_memory c;
            dem_world_desc desc = counted(&c);
            dem_world *world;
            long before;
            int tries = 0, failed = 0;
            desc.dt = DEM_R(4e-6);
            desc.search = (dem_search)search;
            desc.gravity = at(0, 0, 0);
            world = dem_world_create(&desc);
            swarm_add(world, mixed);
            before = c.calls;
            c.refuse = k ? before + k : 0;
            while ((dem_world_steps_get(world) < 500 || failed) && tries < 1000) {
                const dem_result r = dem_world_step(world, 1);
                failed = r != DEM_OK;
                if (failed) { tries++; CHECK_EQ(r, DEM_ERROR_MEMORY); }
            }
            if (k == 0) { calls = c.calls - before; hash = dem_world_hash_get(world); }
            CHECK(k == 0 || tries > 0);
            CHECK((double)dem_counters_get(world).overlap_max > 0);
            CHECK_EQ(dem_world_steps_get(world), 500);
            CHECK_EQ(dem_world_hash_get(world), hash);
            if (test_now.wrong) printf("        at request %ld of %ld\n", k, calls);
            dem_world_destroy(world);
            CHECK_EQ(c.blocks, 0);
        }
    }
}

/* 300 grains of which some have crossed a periodic face since the last list, and many new ones: the
   next list needs more memory. Request `refuse` from here on gets none; 1 when that came to pass.
   Whether or not it did, what the hash tells of must be as before. */
static int search_refused(long refuse) {
    scene_memory c;
    dem_world_desc desc = counted(&c);
    dem_world *world;
    dem_material stuff;
    uint64_t hash;
    int i, k, refused;
    desc.gravity = at(0, 0, 0);
    desc.domain = box_of(0, 0, 0, 0.1, 0.1, 0.1);
    desc.skin = DEM_R(0.004);
    desc.dt = DEM_R(2e-6);
    for (k = 0; k < 3; k++) desc.boundary[k] = DEM_BOUNDARY_PERIODIC;
    world = dem_world_create(&desc);
    stuff = scene_material(world, 1e7, 1, 0.3, 0);
    CHECK_EQ(dem_spheres_fill(world, stuff, DEM_R(0.002), dem_region_make(desc.domain), 300, 1), 300);
    for (i = 0; i < 300; i++)
        scene_move(world, dem_body_id_get(world, i), at(-2, -2, -2), at(0, 0, 0));
    for (k = 0, i = 300; k < 100 && i == 300; k++) {
        CHECK_EQ(scene_step(world, 10), DEM_OK);
        for (i = 0; i < 300 && world->bodies.pos[4*i] >= 0; i++) continue;
    }
    CHECK(i < world->bodies.count);                   /* one stands outside */
    CHECK_EQ(dem_spheres_fill(world, stuff, DEM_R(0.002), dem_region_make(desc.domain), 1200, 2), 1200);
    hash = dem_world_hash_get(world);
    c.refuse = c.calls + refuse;
    refused = dem_candidates_rebuild(world) != DEM_OK;
    CHECK_EQ(refused, c.refused);
    CHECK_EQ(dem_world_hash_get(world), hash);
    c.refuse = 0;
    CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
    CHECK_EQ(dem_world_hash_get(world), hash);
    dem_world_destroy(world);
    CHECK_EQ(c.blocks, 0);
    return refused;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a step of a packing at rest allocates nothing, with one thread and with two") {
        int threads;
        for (threads = 1; threads <= 2; threads++) {
            scene_memory c;
            dem_world *world = packing(&c, threads, 0, DEM_SEARCH_AUTO);
            long before;
            CHECK_EQ(scene_step(world, 1500), DEM_OK);
            before = c.calls;
            CHECK_EQ(scene_step(world, 1000), DEM_OK);
            CHECK_EQ(c.calls, before);
            dem_world_destroy(world);
            CHECK_EQ(c.blocks, 0);
        }
    }
    TEST("a step that rebuilds its list allocates nothing, for any search") {
        int search;
        for (search = DEM_SEARCH_ALL_PAIRS; search <= DEM_SEARCH_HIERARCHICAL; search++) {
            scene_memory c;
            dem_world *world = packing(&c, 1, -1, (dem_search)search);
            long before;
            CHECK_EQ(scene_step(world, 1500), DEM_OK);     /* grains still spread, and cells with
                                                              them, up to step 600 or so */
            before = c.calls;
            CHECK_EQ(scene_step(world, 1000), DEM_OK);
            CHECK_EQ(c.calls, before);
            CHECK(dem_counters_get(world).rebuilds > 1000);
            dem_world_destroy(world);
            CHECK_EQ(c.blocks, 0);
        }
    }
    TEST("all memory comes from the world's allocator and returns to it in the same sizes") {
        scene_memory c;
        uint64_t hash;
        scenario(&c, DEM_SEARCH_AUTO, 0, &hash);
        CHECK(c.most > 100000);
    }
    TEST("read-only calls allocate nothing: contacts, candidates, ledger, totals, report, hash") {
        scene_memory c;
        dem_world *world = packing(&c, 1, 0, DEM_SEARCH_AUTO);
        static dem_contact_info infos[2000];
        static uint32_t slots[8000];
        dem_advice advice;
        FILE *nowhere = tmpfile();
        long before;
        scene_step(world, 10);
        before = c.calls;
        CHECK(dem_contacts_get(world, infos, 2000) > 0);
        CHECK(dem_candidates_get(world, slots, 4000) > 0);
        dem_ledger_get(world);
        dem_totals_get(world);
        dem_counters_get(world);
        dem_world_hash_get(world);
        dem_step_advice_get(world, &advice);
        if (nowhere) { dem_world_report(world, nowhere); fclose(nowhere); }
        CHECK_EQ(c.calls, before);
        dem_world_destroy(world);
    }
    TEST("each failing allocation is reported and the world continues (grid)") {
        refuse_each(DEM_SEARCH_GRID);
    }
    TEST("each failing allocation is reported and the world continues (linked list)") {
        refuse_each(DEM_SEARCH_LINKED_LIST);
    }
    TEST("each failing allocation is reported and the world continues (bins)") {
        refuse_each(DEM_SEARCH_BINS);
    }
    TEST("each failing allocation is reported and the world continues (hierarchical)") {
        refuse_each(DEM_SEARCH_HIERARCHICAL);
    }
    TEST("repeating a step in which an allocation failed gives the run without failure") {
        swarm_each(0);
    }
    TEST("repeating a step in which an allocation failed gives the run without failure, with clusters and ellipsoids") {
        swarm_each(1);
    }
    TEST("a large checkpoint that runs out of memory while being read leaves the small world as "
         "it was") {
        scene_memory c, d;
        dem_world_desc desc = counted(&c);
        dem_world *big, *small;
        dem_material glass;
        uint64_t hash, end = 0;
        long k;
        int result = DEM_ERROR_MEMORY;
        desc.gravity = at(0, 0, 0);
        desc.dt = DEM_R(1e-6);
        big = dem_world_create(&desc);
        glass = scene_material(big, 1e7, 0.5, 0.3, 0);
        scene_block(big, glass, 16, 16, 17, 1e-3, 1, 0.1, 1);  /* four domains */
        CHECK_EQ(scene_step(big, 2), DEM_OK);
        CHECK_EQ(dem_counters_get(big).domains, 4);
        CHECK_EQ(dem_checkpoint_write(big, "build/tmp/memory.ckpt"), DEM_OK);
        dem_world_destroy(big);
        for (k = 1; k < 100 && result == DEM_ERROR_MEMORY && test_now.wrong == 0; k++) {
            desc = counted(&d);
            desc.gravity = at(0, 0, 0);
            desc.dt = DEM_R(1e-6);
            small = dem_world_create(&desc);
            scene_material(small, 1e7, 0.5, 0.3, 0);
            scene_block(small, glass, 3, 3, 3, 1e-3, 1, 0.1, 1);
            scene_step(small, 2);
            hash = dem_world_hash_get(small);
            d.refuse = d.calls + k;
            result = dem_checkpoint_read(small, "build/tmp/memory.ckpt");
            d.refuse = 0;
            if (result != DEM_OK) {
                CHECK_EQ(result, DEM_ERROR_MEMORY);
                CHECK_EQ(dem_world_hash_get(small), hash);
                CHECK_EQ(scene_step(small, 50), DEM_OK);
                if (k == 1) end = dem_world_hash_get(small);
                CHECK_EQ(dem_world_hash_get(small), end);
                CHECK_EQ(dem_bodies_get(small).count, 27);
            } else CHECK_EQ(dem_bodies_get(small).count, 16*16*17);
            dem_world_destroy(small);
            CHECK_EQ(d.blocks, 0);
            CHECK_EQ(d.wrong, 0);
            if (test_now.wrong) printf("        at request %ld\n", k);
        }
        CHECK_EQ(result, DEM_OK);
        CHECK(k > 10);
        remove("build/tmp/memory.ckpt");
        remove("build/tmp/memory.vtp");
    }
    TEST("a rebuilt list changes no hash after crossings of a periodic face, even if an allocation fails") {
        long k = 1;
        while (search_refused(k)) k++;
        CHECK(k > 5);
    }
    TEST("after a failed search contacts of all domains stay in the hash, in checkpoints and in the run") {
        const char *path = "build/tmp/domains.ckpt";
        const int count = DEM_DOMAIN_BODIES + 10;      /* two domains; without 20 of them one */
        scene_memory c, none;
        dem_world_desc desc = counted(&c), plain = counted(&none);
        dem_world *world[3];
        dem_material m;
        uint64_t hash;
        int i, k;
        desc.dt = plain.dt = DEM_R(1e-5);
        for (k = 0; k < 3; k++) {              /* refused once; never; from a checkpoint */
            world[k] = dem_world_create(k ? &plain : &desc);
            m = scene_material(world[k], 1e6, 0.5, 0.3, 0);
            dem_wall_plane_add(world[k], m, at(0, 0, 0), at(0, 0, 1));
            for (i = 0; i < count; i++) {
                const dem_body b = dem_sphere_add(world[k], m, DEM_R(1e-3),
                                                  at(0.0021*(i%50), 0.0021*(i/50), 9.99e-4));
                scene_move(world[k], b, at(0.01, 0, 0), at(0, 0, 0));
            }
            CHECK_EQ(scene_step(world[k], 50), DEM_OK);
            CHECK_EQ(world[k]->domain_count, 2);
            for (i = 0; i < 20; i++)
                dem_body_remove(world[k], dem_body_id_get(world[k], world[k]->bodies.count - 1));
        }
        hash = dem_world_hash_get(world[0]);
        CHECK(hash == dem_world_hash_get(world[1]));
        CHECK_EQ(dem_checkpoint_write(world[0], path), DEM_OK);
        CHECK_EQ(dem_checkpoint_read(world[0], path), DEM_OK);  /* its lists fit now: new ones take room */
        for (i = 1, k = 0; i < 40; i++) {
            c.refuse = c.calls + i;
            c.refused = 0;
            if (dem_candidates_rebuild(world[0]) == DEM_OK) break;
            k++;
            CHECK(c.refused);
            CHECK(dem_world_hash_get(world[0]) == hash);
            CHECK_EQ(dem_checkpoint_write(world[0], path), DEM_OK);
            CHECK_EQ(dem_checkpoint_read(world[2], path), DEM_OK);
            CHECK(dem_world_hash_get(world[2]) == hash);
        }
        CHECK(k > 0);
        c.refuse = 0;
        CHECK_EQ(world[0]->domain_count, 1);
        for (k = 0; k < 3; k++) CHECK_EQ(scene_step(world[k], 50), DEM_OK);
        CHECK(dem_world_hash_get(world[0]) == dem_world_hash_get(world[1]));
        CHECK(dem_world_hash_get(world[0]) == dem_world_hash_get(world[2]));
        for (k = 0; k < 3; k++) dem_world_destroy(world[k]);
        CHECK_EQ(c.blocks + none.blocks, 0);
        remove(path);
    }
    return test_end();
}
