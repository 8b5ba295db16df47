/* Angles of repose: of heaps and drums' charges that were built with a slope. */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

static double steep, lean;                           /* tan of the slope; 1: a cone, 0: a plane that rises along x */
static int below(dem_vec3 x, dem_real radius, void *user) {
    const double far = sqrt((double)(x.x*x.x + x.y*x.y));
    (void)user;
    return (double)(x.z + radius) < (lean > 0 ? 0.03 + steep*(double)x.x : steep*(0.05 - far));
}
static int below_turned(dem_vec3 x, dem_real radius, void *user) {      /* the same with gravity along -y */
    return below(dem_vec3_make(x.z, x.x, x.y), radius, user);
}
static int below_flat(dem_vec3 x, dem_real radius, void *user) {
    (void)user;
    return (double)(x.y + radius) < (lean > 0 ? 0.03 + steep*(double)x.x : steep*(0.05 - fabs((double)x.x)));
}
static dem_world *world_of(dem_vec3 g, int planar, dem_material *m) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_world *world;
    desc.gravity = g;
    desc.planar = planar;
    world = dem_world_create(&desc);
    *m = scene_material(world, 1e6, 0.5, 0.5, 0);
    return world;
}

int main(int argc, char **argv) {
    const double degree = acos(-1.0)/180;
    dem_box all;
    test_begin(argc, argv);
    memset(&all, 0, sizeof all);

    TEST("slopes of 15 to 35 degrees built into heaps and drums are measured within 1.5 degrees, for any gravity and "
         "in 2D") {
        int angle, way, drum;
        for (angle = 15; angle <= 35; angle += 10)
            for (way = 0; way < 3; way++)
                for (drum = 0; drum < 2; drum++) {
                    dem_material m;
                    dem_world *world = world_of(way == 0 ? at(0, 0, -9.81) : way == 1 ? at(0, -9.81, 0) : at(0, -1, 0), way == 2, &m);
                    dem_repose r;
                    dem_box box = way == 1 ? box_of(-0.06, 0, -0.06, 0.06, 0.06, 0.06)
                        : way == 2 ? box_of(-0.06, 0, -1, 0.06, 0.06, 1) : box_of(-0.06, -0.06, 0, 0.06, 0.06, 0.06);
                    steep = tan(angle*degree);
                    lean = drum;
                    CHECK(dem_spheres_pack(world, m, DEM_R(0.0011), 0,
                                           dem_region_inside_make(box, way == 2 ? below_flat : way == 1 ? below_turned : below, 0),
                                           0) >
                          (way == 2 ? 100 : 1000));
                    if (drum) {
                        /* shell goes towards +x at the bottom: up x axis */
                        const dem_vec3 axis = way == 0 ? at(0, -1, 0) : way == 1 ? at(-1, 0, 0) : at(0, 0, 1);
                        CHECK_EQ(dem_repose_drum_get(world, all, axis, &r), DEM_OK);
                        CHECK_NEAR(r.angle, angle*degree, 1.5*degree);
                        CHECK_EQ(dem_repose_drum_get(world, all, dem_vec3_make(-axis.x, -axis.y, -axis.z), &r), DEM_OK);
                        CHECK_NEAR(r.angle, -angle*degree, 1.5*degree);
                    } else {
                        CHECK_EQ(dem_repose_heap_get(world, all, &r), DEM_OK);
                        CHECK_NEAR(r.angle, angle*degree, 1.5*degree);
                        dem_sphere_add(world, m, DEM_R(0.0011), way == 0 ? at(0.2, 0, 0.5) : at(0.2, 0.5, 0));
                        CHECK_EQ(dem_repose_heap_get(world, box, &r), DEM_OK);
                        CHECK_NEAR(r.angle, angle*degree, 1.5*degree);
                    }
                    CHECK(r.places >= 4 && r.error < 3*degree);
                    if (test_now.wrong) printf("        angle %d way %d drum %d\n", angle, way, drum);
                    dem_world_destroy(world);
                }
    }

    TEST("stray grains and smaller heaps change no bit of the measured slope of a heap or drum") {
        int way, drum;
        for (way = 0; way < 2; way++)
            for (drum = 0; drum < 2; drum++) {
                const double r = 0.0011;
                dem_material m;
                dem_world *world = world_of(way ? at(0, -1, 0) : at(0, 0, -9.81), way, &m);
                dem_repose alone, with;
                dem_body_state state;
                dem_body body;
                int i, k;
                dem_box box = way ? box_of(-0.06, 0, -1, 0.06, 0.06, 1) : box_of(-0.06, -0.06, 0, 0.06, 0.06, 0.06);
                steep = tan(25*degree);
                lean = drum;
                dem_spheres_pack(world, m, (dem_real)r, 0, dem_region_inside_make(box, way ? below_flat : below, 0), 0);
                for (i = 0; i < 2; i++) {
                    dem_repose *to = i ? &with : &alone;
                    CHECK_EQ(drum ? dem_repose_drum_get(world, all, way ? at(0, 0, 1) : at(0, -1, 0), to)
                                  : dem_repose_heap_get(world, all, to), DEM_OK);
                    CHECK_NEAR(to->angle, 25*degree, 1.5*degree);
                    if (i) continue;
                    for (k = 0; k < 5; k++) dem_sphere_add(world, m, (dem_real)r, at(0.1 + 0.03*k, way ? r : 0, way ? 0 : r));
                    dem_sphere_add(world, m, (dem_real)(2*r), way ? at(0.07, -1, 0) : at(0.07, 0, -1));
                    dem_sphere_add(world, m, (dem_real)r, way ? at(0, 0.5, 0) : at(0, 0, 0.5));
                    dem_sphere_add(world, m, (dem_real)r, at(1e6, 0, 0));
                    dem_spheres_pack(world, m, (dem_real)r, 0,
                                     dem_region_make(box_of(-0.3, 0, 0, -0.25, 0.02, 0.02)), 50);
                    /* a floor of fixed grains holds them together, but is no heap */
                    for (k = 0; k < 200; k++) {
                        body = dem_sphere_add(world, m, (dem_real)r, way ? at(-0.3 + 0.0022*k, -r, 0) : at(-0.3 + 0.0022*k, 0, -r));
                        state = scene_state(world, body);
                        state.fixed = 1;
                        CHECK_EQ(dem_body_set(world, body, &state), DEM_OK);
                    }
                }
                CHECK(alone.places == with.places);
                CHECK_NEAR(with.angle, alone.angle, 0);          /* the same grains, in the same order */
                CHECK_NEAR(with.error, alone.error, 0);
                dem_world_destroy(world);
            }
    }

    TEST("a heap across periodic faces has the angle of the same heap in the middle of the box") {
        /* in the middle; across the faces of both axes; and a whole period away, as a body is set before a step */
        double angle[4];
        int k, i, places[4];
        for (k = 0; k < 4; k++) {
            const double by = k < 3 ? k*0.03 : 0.12;
            const dem_box part = box_of(-0.055, -0.055, 0, 0.055, 0.055, 0.06);
            dem_world_desc desc = DEM_WORLD_DESC;
            dem_world *world;
            dem_material m;
            dem_bodies all_of;
            dem_repose r;
            desc.gravity = at(0, 0, -9.81);
            desc.domain = box_of(-0.06, -0.06, -0.01, 0.06, 0.06, 0.1);
            desc.boundary[0] = desc.boundary[1] = DEM_BOUNDARY_PERIODIC;
            world = dem_world_create(&desc);
            m = scene_material(world, 1e6, 0.5, 0.5, 0);
            steep = tan(25*degree);
            lean = 0;
            CHECK(dem_spheres_pack(world, m, DEM_R(0.0011), 0,
                                   dem_region_inside_make(box_of(-0.055, -0.055, 0, 0.055, 0.055, 0.06), below, 0), 0) > 1000);
            all_of = dem_bodies_get(world);
            for (i = 0; i < all_of.count; i++) {
                const dem_body body = dem_body_id_get(world, i);
                dem_body_state s = scene_state(world, body);
                s.position.x += (dem_real)(by - (k < 3 && s.position.x + by > 0.06 ? 0.12 : 0));
                s.position.y += (dem_real)(by - (k < 3 && s.position.y + by > 0.06 ? 0.12 : 0));
                CHECK_EQ(dem_body_set(world, body, &s), DEM_OK);
            }
            CHECK_EQ(dem_repose_heap_get(world, all, &r), DEM_OK);
            angle[k] = r.angle;
            CHECK_NEAR(r.angle, 25*degree, 1.5*degree);
            places[k] = r.places;
            if (k == 3) {                       /* a box sees the place in the period */
                CHECK_EQ(dem_repose_heap_get(world, part, &r), DEM_OK);
                CHECK_EQ(r.places, places[0]);
            }
            dem_world_destroy(world);
        }
        for (k = 1; k < 4; k++) {
            CHECK_NEAR(angle[k], angle[0], 1e-6);
            CHECK_EQ(places[k], places[0]);
        }
    }
    TEST("without gravity, grains or a horizontal axis there is no slope, and the error says which") {
        dem_material m;
        dem_world *world = world_of(at(0, 0, 0), 0, &m);
        dem_repose r;
        CHECK_EQ(dem_repose_heap_get(world, all, &r), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "gravity is 0 m/s2");
        dem_world_gravity_set(world, at(0, 0, -9.81));
        CHECK_EQ(dem_repose_heap_get(world, all, &r), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "0 columns");
        dem_sphere_add(world, m, DEM_R(0.001), at(0, 0, 0));
        dem_sphere_add(world, m, DEM_R(0.001), at(1e9, 0, 0));
        CHECK_EQ(dem_repose_heap_get(world, all, &r), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_repose_drum_get(world, all, at(0, 0, 1), &r), DEM_ERROR_ARGUMENT);
        CHECK_STR(dem_world_error_get(world), "is vertical");
        CHECK_EQ(dem_repose_drum_get(world, all, at(0, 0, 0), &r), DEM_ERROR_ARGUMENT);
        CHECK_EQ(dem_repose_drum_get(world, all, at(0, 1, 0), 0), DEM_ERROR_ARGUMENT);
        dem_world_destroy(world);
    }
    return test_end();
}
