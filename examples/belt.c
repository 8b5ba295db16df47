/* belt.c - a finite belt that is fed at one end and discharges at the other: its drag and power beside mass flow times speed.
   Build: cc -O2 -I. -o belt examples/belt.c dem.c -lm       Run: ./belt

   The belt is a mesh that stays where it is; dem_wall_surface_velocity_set moves its surface. A grain that comes to rest on
   the belt has gained the momentum m V, so in steady flow the drag is the mass flow times the speed V. The power of the
   drive is drag times V. */
#include "dem.h"
#include <math.h>

int main(void) {
    const double V = 0.5, r = 4e-3, mass = 2500*4*3.14159265358979/3*r*r*r, flow = 300*mass;    /* m/s, m, kg, kg/s */
    dem_real corners[12] = {0, -1, 0, 0.3, -1, 0, 0.3, 1, 0, 0, 1, 0};                          /* m */
    int32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    const dem_mesh mesh = {4, 2, corners, triangles};
    const dem_world_desc desc = {.gravity = {0, 0, -9.81}, .domain = {{-1, -1, -0.05}, {1, 1, 1}},
        .boundary = {DEM_BOUNDARY_OPEN, DEM_BOUNDARY_OPEN, DEM_BOUNDARY_OUTFLOW}};              /* grains that fall below leave */
    const dem_material_desc gravel = {.density = 2500, .young = 1e6, .restitution = 0.3, .friction = 0.6, .rolling_friction = 0.3};
    dem_world *world = dem_world_create(&desc);
    const dem_material stone = dem_material_add(world, &gravel);
    const dem_feed_desc feed = {.material = stone, .class_count = 1, .amount = {1}, .radius = {r}, .rate = 300, /* grains/s */
        .box = {{0.02, -0.03, 0.006}, {0.05, 0.03, 0.012}}};
    const dem_wall belt = dem_wall_mesh_add(world, stone, &mesh);
    dem_wall_surface_velocity_set(world, belt, dem_vec3_make(V, 0, 0));
    dem_feed_add(world, &feed);
    for (int k = 0; k < 2; k++) {                                   /* 1 s until as many leave as arrive; 1 s is measured */
        dem_wall_loads_reset(world, belt);
        if (dem_world_run(world, 1, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
    }
    dem_wall_loads loads;
    dem_wall_loads_get(world, belt, &loads);
    const double drag = -loads.impulse[0]/loads.time, power = loads.work/loads.time;
    printf("drag      = %.4f N, mass flow times speed %.4f N\n", drag, flow*V);
    printf("power     = %.4f W, drag times speed %.4f W\n", power, drag*V);
    dem_world_destroy(world);
    return !(fabs(drag/(flow*V) - 1) < 0.01 && fabs(power/(drag*V) - 1) < 0.01);
}
