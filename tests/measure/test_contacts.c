/* Reads of contacts: they change no bit of the run that follows, and give the forces of the last step where nothing has
   touched a contact since. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* Two spheres and two ellipsoids, one on the other, on a plane. */
static dem_world *stacks(dem_response response, dem_material *stuff) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc m = DEM_MATERIAL_DESC;
    dem_world *w;
    dem_shape egg;
    desc.gravity.z = -9.81;
    desc.response = response;
    desc.dt = response == DEM_RESPONSE_IMPULSES ? (dem_real)1e-4 : (dem_real)2e-5;
    w = dem_world_create(&desc);
    m.density = 2500;
    m.young = 1e7;
    m.poisson = (dem_real)0.3;
    m.restitution = (dem_real)0.5;
    m.friction = (dem_real)0.4;
    *stuff = dem_material_add(w, &m);
    dem_wall_plane_add(w, *stuff, at(0, 0, 0), at(0, 0, 1));
    egg = dem_shape_ellipsoid_add(w, at(0.01, 0.008, 0.006));
    dem_sphere_add(w, *stuff, (dem_real)0.01, at(0, 0, 0.01));
    dem_sphere_add(w, *stuff, (dem_real)0.01, at(0.002, 0, 0.0299));
    dem_body_add(w, *stuff, egg, at(0.05, 0, 0.006), dem_quat_make(1, 0, 0, 0));
    dem_body_add(w, *stuff, egg, at(0.052, 0, 0.0179), dem_quat_make(1, 0, 0, 0));
    dem_world_step(w, 200);
    return w;
}
/* A fill that finds no room. It drops the neighbour list all the same. */
static int crowded(dem_world *w, dem_material stuff) {
    return dem_spheres_fill(w, stuff, (dem_real)0.004,
                            dem_region_make(dem_box_make(-0.004, -0.004, 0.006, 0.004, 0.004, 0.014)), 3, 1);
}
typedef struct seen { dem_vec3 force[8]; int count; } seen;
static void see(const dem_contact_info *c, dem_real *memory, void *user) {
    seen *s = (seen *)user;
    (void)memory;
    if (s->count < 8) s->force[s->count++] = c->force;
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("a read after a fill without room gives the forces of the last step and changes no bit of the run, "
         "with both responses") {
        int response, i;
        for (response = 0; response < 2; response++) {
            const dem_response how = response ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS;
            dem_material stuff, other;
            dem_world *read = stacks(how, &stuff), *plain = stacks(how, &other);
            seen before = {{{0, 0, 0}}, 0}, after = {{{0, 0, 0}}, 0};
            CHECK(dem_contacts_each(read, see, &before) == 4);
            CHECK(crowded(read, stuff) == 0 && crowded(plain, other) == 0);
            CHECK(dem_contacts_each(read, see, &after) == 4);
            for (i = 0; i < 4; i++)
                CHECK(!memcmp(&before.force[i], &after.force[i], sizeof(dem_vec3)));
            dem_world_step(read, 50);
            dem_world_step(plain, 50);
            CHECK(dem_world_hash_get(read) == dem_world_hash_get(plain));
            dem_world_destroy(read);
            dem_world_destroy(plain);
        }
    }
    TEST("every read of contacts fails until a step or dem_contacts_each finds those of new bodies") {
        int how, check;
        for (how = 0; how < 2; how++)
            for (check = 0; check < 2; check++) {
                dem_material stuff;
                dem_world *world = stacks(how ? DEM_RESPONSE_IMPULSES : DEM_RESPONSE_SPRINGS, &stuff);
                seen all = {{{0, 0, 0}}, 0};
                dem_stress stress;
                int before;
                CHECK_EQ(dem_world_step(world, 5), DEM_OK);
                before = dem_contacts_get(world, 0, 0);
                CHECK(before > 0);
                CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);       /* nothing was added: all are known */
                CHECK_EQ(dem_contacts_get(world, 0, 0), before);
                CHECK(dem_sphere_add(world, stuff, DEM_R(0.01), dem_vec3_make(1, 1, DEM_R(0.00999))).slot > 0);
                if (check) CHECK(dem_world_check(world, 0, 0) >= 0);
                else CHECK_EQ(dem_candidates_rebuild(world), DEM_OK);
                CHECK(dem_candidates_get(world, 0, 0) >= 0);
                CHECK_EQ(dem_contacts_get(world, 0, 0), -1);
                CHECK_STR(dem_world_error_get(world), "contacts are not known");
                CHECK(dem_stress_get(world, &stress) != DEM_OK);
                CHECK_STR(dem_world_error_get(world), "contacts are not known");
                CHECK_EQ(dem_counters_get(world).wall_contacts, 0);
                CHECK_EQ(dem_contacts_each(world, see, &all), before + 1);
                CHECK_EQ(dem_contacts_get(world, 0, 0), before + 1);
                dem_world_destroy(world);
            }
    }
    return test_end();
}
