/* 08_advise.c - what accuracy costs in a scene of one's own: a drum that turns, tried on copies of it.

   Question: the power that the drum takes shall be right within 10 %. How long may the time step be, and how
   soft the grains? Guess, then run.

   dem_advise lets copies of a scene run on with other steps, other stiffnesses and other laws, each three times
   from places that hardly differ, so that a change is told from chance. Times depend on the machine, and with
   them which of the trials that keep within the tolerance is the cheapest.

   Build:     cc -O2 08_advise.c ../dem.c -lm
   Run:       08_advise [budget]                    (15 s of wall time)
   Expected:  a table of trials, and one sentence of advice; the world itself stays as it was */
#include "../dem.h"
#include <stdlib.h>

/* W, mean power since the loads were reset. Any function of the world will do; means are told from chance sooner
   than what is of one moment. */
static double power(const dem_world *world, void *drum) {
    dem_wall_loads loads;
    return dem_wall_loads_get(world, *(dem_wall *)drum, &loads) == DEM_OK ? loads.work/loads.time : 0;
}

int main(int argc, char **argv) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = 1;
    desc.thickness = 4e-3;                                          /* m, of the discs */
    desc.gravity.y = -9.81;                                         /* m/s2 */
    dem_world *world = dem_world_create(&desc);

    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    glass_desc.density = 2500;                                      /* kg/m3 */
    glass_desc.young = 2e7;                                         /* Pa */
    glass_desc.poisson = 0.25;
    glass_desc.restitution = 0.6;
    glass_desc.friction = 0.4;
    dem_material glass = dem_material_add(world, &glass_desc);

    dem_wall drum = dem_cylinder_add(world, glass, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 0, 1), 0.05, 1);
    dem_motion turning = DEM_MOTION;
    turning.kind = DEM_MOTION_ROTATING;
    turning.axis = dem_vec3_make(0, 0, 1);
    turning.speed = 5;                                              /* rad/s */
    dem_wall_motion(world, drum, &turning);
    dem_spheres_fill(world, glass, 2e-3, dem_box_make(-0.035, -0.035, 0, 0.035, 0.015, 0), 150, 1);
    dem_check_print(world, stdout);
    if (dem_world_run(world, 0.5, 0, 0) != DEM_OK) { puts(dem_world_error(world)); return 1; }

    dem_wall_loads_reset(world, drum);
    dem_advise_desc how = DEM_ADVISE_DESC;
    how.duration = 2;                                               /* s of simulated time, each trial */
    how.budget = argc > 1 ? atof(argv[1]) : 15;                     /* s of wall time, all of them */
    how.tolerance = 0.1;
    how.observable_count = 1;
    how.observables[0].name = "power";
    how.observables[0].unit = "W";
    how.observables[0].function = power;
    how.observables[0].user = &drum;
    how.progress = dem_progress_print;
    how.user = stderr;
    uint64_t before = dem_world_hash(world);
    dem_trials trials;
    if (dem_advise(world, &how, &trials) != DEM_OK) { puts(dem_world_error(world)); return 1; }
    dem_trials_print(&trials, stdout);
    int touched = dem_world_hash(world) != before;
    dem_world_destroy(world);
    return touched;
}
