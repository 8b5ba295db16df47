/* NAME.c - grains that fall on a floor: change what you like.

   tcc -I. dem.c -run NAME.c                                   starts at once, runs 20 times as long
   cc -O2 -I. -o NAME NAME.c dem.c -lm && ./NAME               fast; -fopenmp for threads
   Then open NAME.html in a browser. What else there is: the first lines of dem.h, and examples/. */
#include "dem.h"
#include <stdio.h>

int main(void) {
    /* the world: what is left at zero is not simulated, or chosen for you */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -9.81;                             /* m/s2 */
    desc.ledger = 1;                                    /* where the energy goes; 0: not asked, not paid */
    dem_world *world = dem_world_create(&desc);

    /* what grains and walls are made of; softer grains allow longer steps: keep overlaps below 1 to 5 % */
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
    dem_world_check_print(world, stderr);                     /* what looks wrong, before it runs */

    /* the run: half a second, filmed 60 times */
    dem_replay *film = dem_replay_open(world, "NAME.html", NULL);
    for (int k = 0; k <= 60; k++) {
        if (k > 0 && dem_world_run(world, 0.5/60, dem_progress_print, stderr) != DEM_OK) break;
        dem_replay_value_set(film, "kinetic energy (J)", dem_totals_get(world).kinetic);
        dem_replay_frame_write(film);
    }
    dem_replay_close(film);
    if (*dem_world_error_get(world)) printf("%s\n", dem_world_error_get(world));
    dem_world_report(world, stdout);                    /* what was simulated, its price, the step and what binds it */
    dem_world_destroy(world);
    return 0;
}
