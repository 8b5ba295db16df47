/* Prints the digest of 200 grains of two sizes after 3000 steps: friction, rolling, a turning wall. tests/cross.sh runs it
   on other systems and processors, where it must be the same. */
#include "dem.h"
#include <stdio.h>

int main(void) {
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_material_desc glass = DEM_MATERIAL_DESC;
    dem_motion motion = DEM_MOTION;
    dem_world *w;
    dem_material stuff;
    dem_wall drum;
    int k;
    desc.gravity.y = DEM_R(-9.81);
    desc.dt = DEM_R(2e-5);
    desc.rolling_law = DEM_ROLLING_EPSD;
    desc.ledger = 1;
    w = dem_world_create(&desc);
    glass.density = 2500; glass.young = DEM_R(1e6); glass.poisson = DEM_R(0.25); glass.restitution = DEM_R(0.6);
    glass.friction = DEM_R(0.4); glass.rolling_friction = DEM_R(0.1);
    stuff = dem_material_add(w, &glass);
    drum = dem_wall_cylinder_add(w, stuff, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1), DEM_R(0.03), 1);
    motion.kind = DEM_MOTION_ROTATING; motion.axis = dem_vec3_make(0, 0, 1); motion.speed = 5;
    dem_wall_motion_set(w, drum, &motion);
    for (k = 0; k < 2; k++)
        dem_wall_plane_add(w, stuff, dem_vec3_make(0, 0, (dem_real)(k ? 0.01 : -0.01)), dem_vec3_make(0, 0, (dem_real)(k ? -1 : 1)));
    for (k = 0; k < 200; k++)
        dem_sphere_add(w, stuff, (dem_real)(k%2 ? 0.0015 : 0.002), dem_vec3_make((dem_real)(0.0045*(k%10 - 4.5)),
                       (dem_real)(0.0042*(k/40) - 0.008), (dem_real)(0.0045*(k/10%4 - 1.5))));
    if (dem_world_step(w, 3000) != DEM_OK) { puts(dem_world_error_get(w)); return 1; }
    printf("%016llx %d\n", (unsigned long long)dem_world_hash_get(w), dem_counters_get(w).contacts);
    dem_world_destroy(w);
    return 0;
}
