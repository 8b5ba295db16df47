/* Shapes in other units of length: powers of two are exact, so every bit must be the same (>>shapes). */
#define DEM_IMPLEMENTATION
#include "../../dem.h"
#include "../test.h"
#include "../scene.h"

/* Position after 300 steps, in m, of the upper of two bodies that collide; all lengths are in units of 1/`unit` m. */
static dem_vec3 units_collide(int kind, double unit) {
    dem_world_desc d = DEM_WORLD_DESC;
    dem_material_desc stuff = scene_stuff(5e6/unit, 0.6, 0.4, 0.1);
    const dem_quat q = dem_quat_make(DEM_R(0.9), DEM_R(0.3), DEM_R(0.2), DEM_R(0.1));
    dem_material m;
    dem_shape shape;
    dem_body upper;
    dem_world *w;
    dem_vec3 x;
    d.gravity = at(0, 0, -9.81*unit);
    d.dt = DEM_R(2e-6);
    w = dem_world_create(&d);
    stuff.density = (dem_real)(2500/(unit*unit*unit));
    m = dem_material_add(w, &stuff);
    if (kind == 0) shape = dem_shape_ellipsoid_add(w, at(1e-3*unit, 7e-4*unit, 5e-4*unit));
    else {
        dem_real corners[24];
        int i, k;
        for (i = 0; i < 8; i++)
            for (k = 0; k < 3; k++) corners[3*i + k] = (dem_real)((i >> k & 1 ? 6e-4 : -6e-4)*unit);
        shape = dem_shape_polyhedron_add(w, 8, corners);
    }
    dem_body_add(w, m, shape, at(0, 0, 0), q);
    upper = dem_body_add(w, m, shape, at(2e-4*unit, 1e-4*unit, 1.8e-3*unit), dem_quat_make(1, 0, 0, 0));
    scene_move(w, upper, at(0.1*unit, 0, -1.5*unit), at(30, 20, 10));
    CHECK(dem_world_step(w, 300) == DEM_OK);
    CHECK(fabs((double)scene_state(w, upper).velocity.z) < 1.4*unit);      /* it has hit */
    x = scene_state(w, upper).position;
    dem_world_destroy(w);
    return at((double)x.x/unit, (double)x.y/unit, (double)x.z/unit);
}

int main(int argc, char **argv) {
    test_begin(argc, argv);
    TEST("ellipsoids and cubes collide with the same bits in units of 2^-12 and 2^12 m") {
        static const double units[] = {4096, 1.0/4096};     /* fourth roots are exact, too */
        int kind, k;
        for (kind = 0; kind < 2; kind++)
            for (k = 0; k < 2; k++) {
                const dem_vec3 x = units_collide(kind, 1), y = units_collide(kind, units[k]);
                CHECK_EQ(memcmp(&x, &y, sizeof x), 0);
            }
    }
    return test_end();
}
