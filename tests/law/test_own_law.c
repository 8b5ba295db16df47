/* A law of one's own, inlined into the loops by DEM_LAW, gives the same bits as by pointer. The
   first include gives the types that the law is written with, the second the implementation. */
#include "../../dem.h"

/* Hertz with friction and memory, as a user would write it: stiffness and damping of the desc's
   user. */
typedef struct own_numbers { dem_real stiffness, damping, friction; } own_numbers;
DEM_INLINE void own_law(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    const own_numbers *u = (const own_numbers *)c->user;
    const dem_real k = u->stiffness*c->overlap;
    const dem_vec3 s = dem_memory_rotate(c, dem_vec3_make(memory[0], memory[1], memory[2]));
    const dem_real x = s.x + c->dt*c->slip.x, y = s.y + c->dt*c->slip.y, z = s.z + c->dt*c->slip.z;
    const dem_real square = k*k*(x*x + y*y + z*z), fn = k*c->overlap + u->damping*c->closing_speed;
    const dem_real limit = fn > 0 ? u->friction*fn : 0;
    dem_real cut = 1;
    if (square > limit*limit) cut = limit*limit/square;
    push->normal = fn;
    push->tangent = dem_vec3_make(-k*x*cut, -k*y*cut, -k*z*cut);
    memory[0] = x*cut; memory[1] = y*cut; memory[2] = z*cut;
}
#define DEM_LAW own_law
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static void by_pointer(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    own_law(c, memory, push);
}

/* The same law for rows of contacts, for each number of reals that the tests use. It is called outside of contact
   too, where it divides by zero. */
DEM_INLINE void own_nan(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    own_law(c, memory, push);
    push->normal *= c->overlap/c->overlap;
    memory[0] *= c->overlap/c->overlap;
    push->energy.elastic = push->normal*c->overlap/2;
}
static void nan_by_pointer(const dem_contact *c, dem_real *memory, dem_contact_force *push) {
    own_nan(c, memory, push);
}
DEM_LAW_ROWS(rows_3, own_nan, 3)
DEM_LAW_ROWS(rows_4, own_nan, 4)
DEM_LAW_ROWS(rows_5, own_nan, 5)
DEM_LAW_ROWS(rows_12, own_nan, 12)

typedef struct own_scene { int mixed, periodic, reals, ledger, clusters, threads; dem_real range; } own_scene;
static uint64_t run(dem_law_fn law, dem_law_rows_fn rows, const own_scene *s, int *by_rows) {
    own_numbers numbers = {DEM_R(4e7), DEM_R(0.01), DEM_R(0.3)};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    uint64_t hash;
    desc.threads = s->threads;
    desc.gravity = at(0, 0, -9.81);
    desc.dt = DEM_R(2e-6);
    desc.law = law;
    desc.law_rows = rows;
    desc.law_user = &numbers;
    desc.law_memory = s->reals;
    desc.ledger = s->ledger;
    desc.law_vectors = 1;
    desc.law_stiffness = DEM_R(5e3);
    desc.law_range = s->range;
    desc.domain = box_of(0, 0, 0, 0.015, 0.015, 0.015);
    if (s->periodic) desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e7, 0.5, 0.3, 0);
    dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    if (s->clusters) {
        dem_cluster_desc pair = DEM_CLUSTER_DESC;
        const dem_real places[6] = {0, 0, 0, DEM_R(1e-3), 0, 0}, radii[2] = {DEM_R(1e-3), DEM_R(0.8e-3)};
        const dem_region region = dem_region_make(box_of(0, 0, 0.004, 0.015, 0.015, 0.012));
        pair.count = 2; pair.positions = places; pair.radii = radii;
        CHECK(dem_bodies_fill(world, glass, dem_shape_cluster_add(world, &pair), region, 12, 5) == 12);
    }
    scene_block(world, glass, 7, 7, 2, 1e-3, s->mixed, 1, 3);
    CHECK_EQ(scene_step(world, 100), DEM_OK);
    CHECK(dem_counters_get(world).wall_contacts > 0);
    *by_rows = demi_own_rows(world) != 0;
    hash = dem_world_hash_get(world);
    dem_world_destroy(world);
    return hash;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a law named by DEM_LAW is inlined and gives the bits of the same law by pointer") {
        static const int reals[] = {3, 4, 5, 12};
        int inlined, asked, k, e;
        for (e = 0; e < 8; e++)
            for (k = 0; k < 4; k++) {
                own_scene scene = {0};
                scene.mixed = e & 1; scene.periodic = e >> 1 & 1; scene.ledger = e >> 2;
                scene.reals = reals[k]; scene.threads = 1;
                CHECK_EQ(run(own_law, 0, &scene, &inlined), run(by_pointer, 0, &scene, &asked));
                CHECK_EQ(inlined, 1);
                CHECK_EQ(asked, 0);
            }
    }
    TEST("a law for rows of contacts gives the bits of the same law by pointer, whatever it returns outside of contact") {
        static const int reals[] = {3, 4, 5, 12};
        static const dem_law_rows_fn fns[] = {rows_3, rows_4, rows_5, rows_12};
        int rows, asked, k, e;
        for (e = 0; e < 16; e++)
            for (k = 0; k < 4; k += 1 + (e > 3)) {
                own_scene scene = {0};
                scene.mixed = e & 1; scene.clusters = e >> 1 & 1; scene.ledger = e >> 2 & 1;
                scene.range = e >> 3 ? DEM_R(1e-4) : 0; scene.periodic = k & 1;
                scene.reals = reals[k]; scene.threads = 1 + (e == 2);
                CHECK_EQ(run(nan_by_pointer, fns[k], &scene, &rows), run(nan_by_pointer, 0, &scene, &asked));
                CHECK_EQ(rows, 1);
                CHECK_EQ(asked, 0);
            }
    }
    TEST("a law for rows needs the law by pointer, which dem.h calls if law_who is set; the report says which it calls") {
        dem_world_desc desc = DEM_WORLD_DESC;
        dem_world *world;
        int who;
        desc.law_rows = rows_3;
        CHECK(!dem_world_create(&desc));
        CHECK(strstr(dem_world_create_error_get(&desc), "law_rows is set, but law is null") != 0);
        for (who = 0; who < 2; who++) {
            desc.law = nan_by_pointer;
            desc.law_memory = 3;
            desc.law_who = who;
            world = dem_world_create(&desc);
            dem_sphere_add(world, scene_material(world, 1e7, 1, 0, 0), 1, at(0, 0, 0));
            CHECK_EQ(demi_own_rows(world) != 0, !who);
            scene_report_has(world, who ? "law_who is set" : "row by row");
            dem_world_destroy(world);
        }
    }
    TEST("the report says when desc.law differs from DEM_LAW, is null, or uses law_who") {
        static const char *const says[] = {"DEM_LAW names another law", "desc.law is null, so it does not act",
                                           "law_who is set"};
        int k;
        for (k = 0; k < 3; k++) {
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            desc.law = k == 0 ? by_pointer : k == 1 ? 0 : own_law;
            desc.law_memory = k == 1 ? 0 : 3;
            desc.law_who = k == 2;
            world = dem_world_create(&desc);
            dem_sphere_add(world, scene_material(world, 1e7, 1, 0, 0), 1, at(0, 0, 0));
            scene_report_has(world, says[k]);
            dem_world_destroy(world);
        }
    }
    TEST("a world without a user-defined law uses the built-in ones in a program with DEM_LAW") {
        dem_world *world = dem_world_create(&DEM_WORLD_DESC);
        dem_material glass = scene_material(world, 1e7, 1, 0, 0);
        dem_contact_info c;
        dem_coefficients k;
        dem_sphere_add(world, glass, 1, at(0, 0, 0));
        dem_sphere_add(world, glass, 1, at(0, 0, 1.99));
        CHECK_EQ(scene_step(world, 1), DEM_OK);
        CHECK_EQ(dem_contacts_get(world, &c, 1), 1);
        dem_coefficients_get(world, glass, glass, 1, 1, &k);
        CHECK_REL(c.force.z, -(double)k.kn*pow((double)c.overlap, 1.5), sizeof(dem_real) == 8 ? 1e-12 : 1e-5);
        dem_world_destroy(world);
    }
    return test_end();
}
