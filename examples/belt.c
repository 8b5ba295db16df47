/* belt.c - a finite belt that is fed at one end and discharges at the other: its drag and power beside mass flow times speed.
   Build: cc -O2 -I. -o belt examples/belt.c dem.c -lm       Run: ./belt

   The belt is a mesh that stays where it is; dem_wall_surface_velocity_set moves its surface. A grain that comes to rest on
   the belt has gained the momentum m V, so in steady flow the drag is the mass flow times the speed V. The power of the
   drive is drag times V. */
#include "dem.h"
#include <stdio.h>

int main(void) {
    const dem_real V = DEM_R(0.5);                                  /* m/s */
    dem_real corners[12] = {0, -1, 0, DEM_R(0.3), -1, 0, DEM_R(0.3), 1, 0, 0, 1, 0};
    int32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    dem_mesh mesh = {4, 2, corners, triangles};
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = DEM_R(-9.81);
    desc.domain.lo = dem_vec3_make(-1, -1, DEM_R(-0.05));           /* grains that fall below leave */
    desc.domain.hi = dem_vec3_make(1, 1, 1);
    desc.boundary[2] = DEM_BOUNDARY_OUTFLOW;
    dem_world *world = dem_world_create(&desc);
    dem_material_desc gravel = DEM_MATERIAL_DESC;
    gravel.density = 2500; gravel.young = DEM_R(1e6); gravel.restitution = DEM_R(0.3);
    gravel.friction = DEM_R(0.6); gravel.rolling_friction = DEM_R(0.3);
    dem_material stone = dem_material_add(world, &gravel);
    dem_wall belt = dem_wall_mesh_add(world, stone, &mesh);
    dem_wall_surface_velocity_set(world, belt, dem_vec3_make(V, 0, 0));
    dem_feed_desc feed = DEM_FEED_DESC;
    feed.material = stone; feed.class_count = 1; feed.amount[0] = 1;
    feed.radius[0] = DEM_R(0.004); feed.rate = 300;                 /* m, grains/s */
    feed.box.lo = dem_vec3_make(DEM_R(0.02), DEM_R(-0.03), DEM_R(0.006));
    feed.box.hi = dem_vec3_make(DEM_R(0.05), DEM_R(0.03), DEM_R(0.012));
    dem_feed_add(world, &feed);
    if (dem_world_run(world, 1, 0, 0) == DEM_OK) {                  /* s: as many leave as arrive */
        dem_wall_loads_reset(world, belt);
        dem_world_run(world, 1, 0, 0);
    }
    dem_wall_loads loads;
    dem_wall_loads_get(world, belt, &loads);
    const double mass = 2500*4*3.14159265358979/3*0.004*0.004*0.004, flow = 300*mass;   /* kg, kg/s */
    printf("drag      = %.4f N, mass flow times speed %.4f N\n", -loads.impulse[0]/loads.time, flow*(double)V);
    printf("power     = %.4f W, drag times speed %.4f W\n", loads.work/loads.time, -loads.impulse[0]/loads.time*(double)V);
    puts(dem_world_error_get(world));                               /* empty if all went well */
    dem_world_destroy(world);
    return 0;
}
