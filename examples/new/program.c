/* NAME.c - grains fall on a floor. Change it as you like.

   tcc -I. dem.c -run NAME.c                                   starts at once, but the run takes 20 times as long
   cc -O2 -I. -o NAME NAME.c dem.c -lm && ./NAME               fast; add -fopenmp for threads
   Then open NAME.html in a browser. The beginning of dem.h is the manual; docs/how_to.md has short recipes. */
#include "dem.h"
#include <stdio.h>

int main(void) {
    /* the world: a field that stays zero is absent or chosen for you */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -9.81;                             /* m/s2 */
    desc.ledger = 1;                                    /* 1: account for energy; 0 costs nothing */
    dem_world *world = dem_world_create(&desc);

    /* the material of grains and walls; softer grains allow longer steps: keep overlaps below 1 to 5 % */
    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    glass_desc.density = 2500;                          /* kg/m3 */
    glass_desc.young = 1e6;                             /* Pa; glass has 6.4e10 */
    glass_desc.poisson = 0.23;
    glass_desc.restitution = 0.66;                      /* speed after an impact over speed before */
    glass_desc.friction = 0.4;
    glass_desc.rolling_friction = 0.1;
    dem_material glass = dem_material_add(world, &glass_desc);

    /* walls, and 200 grains of 2 mm radius at random places in a box (m) */
    dem_wall_plane_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1));
    dem_spheres_fill(world, glass, 2e-3,
                     dem_region_make(dem_box_make(-0.015, -0.015, 0, 0.015, 0.015, 0.1)), 200, 1);
    dem_world_check_print(world, stderr);               /* prints likely mistakes */

    /* the run: half a second, with 60 frames of a replay */
    dem_replay *replay = dem_replay_open(world, "NAME.html", NULL);
    for (int k = 0; k <= 60; k++) {
        if (k > 0 && dem_world_run(world, 0.5/60, dem_progress_print, stderr) != DEM_OK) break;
        dem_replay_value_set(replay, "kinetic energy (J)", dem_totals_get(world).kinetic);
        dem_replay_frame_write(replay);
    }
    dem_replay_close(replay);
    if (*dem_world_error_get(world)) printf("%s\n", dem_world_error_get(world));
    dem_world_report(world, stdout);                    /* bodies, time step and its limit, effects, overlaps, energy */
    dem_world_destroy(world);
    return 0;
}
