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

static uint64_t run(dem_law_fn law, int mixed, int periodic, int reals, int ledger, int *inlined) {
    own_numbers numbers = {DEM_R(4e7), DEM_R(0.01), DEM_R(0.3)};
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    dem_material glass;
    uint64_t hash;
    desc.threads = 1;
    desc.gravity = at(0, 0, -9.81);
    desc.dt = DEM_R(2e-6);
    desc.law = law;
    desc.law_user = &numbers;
    desc.law_memory = reals;
    desc.ledger = ledger;
    desc.law_vectors = 1;
    desc.law_stiffness = DEM_R(5e3);
    desc.domain = box_of(0, 0, 0, 0.015, 0.015, 0.015);
    if (periodic) desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
    world = dem_world_create(&desc);
    glass = scene_material(world, 1e7, 0.5, 0.3, 0);
    dem_wall_plane_add(world, glass, at(0, 0, 0), at(0, 0, 1));
    scene_block(world, glass, 7, 7, 7, 1e-3, mixed, 1, 3);
    CHECK_EQ(scene_step(world, 200), DEM_OK);
    CHECK(dem_counters_get(world).wall_contacts > 0);
    *inlined = demi_whole_stage(world, world->effects.uniform) == demi_stage_own_inlined;
    hash = dem_world_hash_get(world);
    dem_world_destroy(world);
    return hash;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);

    TEST("a law named by DEM_LAW is inlined and gives the bits of the same law by pointer") {
        static const int reals[] = {3, 4, 5, 12};
        int mixed, periodic, inlined, asked, k, ledger;
        for (mixed = 0; mixed < 2; mixed++)
            for (periodic = 0; periodic < 2; periodic++)
                for (k = 0; k < 4; k++)
                    for (ledger = 0; ledger < 2; ledger++) {
                        CHECK_EQ(run(own_law, mixed, periodic, reals[k], ledger, &inlined),
                                 run(by_pointer, mixed, periodic, reals[k], ledger, &asked));
                        CHECK_EQ(inlined, 1);
                        CHECK_EQ(asked, 0);
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
