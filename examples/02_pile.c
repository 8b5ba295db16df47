/* 02_pile.c - beads settle in a tube, the tube is drawn up, and they slump into a heap.

   Beads of three sizes, with friction and rolling friction (without the latter spheres on a smooth floor
   run apart). What floor and tube carry is read from the loads of these walls, averaged over a while.

   How much of the weight hangs on the tube by friction depends on how the beads came to rest: those that
   fell in and bounced may even be wedged downwards. Once the tube moves up slowly, all of the friction
   points up, and Janssen's law holds: the floor carries (1 - exp(-s))/s of the weight, s = 4 mu K H/D for
   a column of height H in a tube of diameter D; K, about .4, is how hard beads push sideways.

   Build:     cc -O2 02_pile.c ../dem.c -lm; run with --replay: a film, 02_pile.html
   Expected:  while the tube is drawn up the floor carries about a third of the weight, floor and tube together
              all of it within 2 %; without the tube the floor alone, within 1 %; pile.vtp opens in ParaView */
#include "../dem.h"
#include <string.h>

int main(int argc, char **argv) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -9.81;                                         /* m/s2 */
    dem_world *world = dem_world_create(&desc);

    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    glass_desc.density = 2500;                                      /* kg/m3 */
    glass_desc.young = 2e7;                                         /* Pa; softened, see the report */
    glass_desc.poisson = 0.23;
    glass_desc.restitution = 0.4;
    glass_desc.friction = 0.5;
    glass_desc.rolling_friction = 0.2;
    dem_material glass = dem_material_add(world, &glass_desc);
    dem_vec3 origin = dem_vec3_make(0, 0, 0), up = dem_vec3_make(0, 0, 1);
    dem_wall ground = dem_plane_add(world, glass, origin, up);
    dem_wall tube = dem_cylinder_add(world, glass, origin, up, 0.008, 1);

    /* three fillings of one box inside the tube: the later ones find what room the earlier ones left */
    dem_box box = dem_box_make(-0.0055, -0.0055, 0, 0.0055, 0.0055, 0.16);  /* m */
    int count = dem_spheres_fill(world, glass, 2.0e-3, box, 100, 1);
    count += dem_spheres_fill(world, glass, 1.5e-3, box, 100, 2);
    count += dem_spheres_fill(world, glass, 1.0e-3, box, 100, 3);
    double weight = 9.81*dem_totals_get(world).mass;                /* N */
    printf("%d beads, %.4f N\n", count, weight);

    dem_replay_desc film_desc = DEM_REPLAY_DESC;
    film_desc.interval = 0.01;                                  /* s */
    dem_replay *film = argc > 1 && !strcmp(argv[1], "--replay") ? dem_replay_open(world, "02_pile.html", &film_desc) : 0;
    dem_check_print(world, stdout);
    printf("time [s]  kinetic energy [J]  centre of mass [mm]  floor/weight  tube/weight\n");
    double on_floor = 0, on_tube = 0;                               /* shares of the weight */
    int wrong = 0;
    for (int i = 1; i <= 12; i++) {
        dem_wall_loads below, around = {0};
        dem_wall_loads_reset(world, ground);
        if (i <= 6) dem_wall_loads_reset(world, tube);
        if (dem_world_run(world, 0.1, 0, 0) != DEM_OK) { puts(dem_world_error(world)); return 1; }
        dem_wall_loads_get(world, ground, &below);
        if (i <= 6) dem_wall_loads_get(world, tube, &around);
        dem_totals totals = dem_totals_get(world);
        on_floor = -below.impulse[2]/below.time/weight;             /* the force on the floor points down */
        on_tube = i <= 6 ? -around.impulse[2]/around.time/weight : 0;
        printf("%8.2f  %18.3e  %19.3f  %12.4f  %11.4f\n", dem_world_time(world),
               totals.kinetic + totals.rotational, 1e3*totals.centre[2], on_floor, on_tube);
        if (i == 4) {
            dem_motion draw = DEM_MOTION;
            draw.kind = DEM_MOTION_TRANSLATING;
            draw.velocity.z = 2e-3;                                 /* m/s */
            dem_wall_motion(world, tube, &draw);
            printf("          the tube is drawn up, slowly\n");
        }
        if (i == 6) {
            wrong += !(on_floor < 0.7) || !(on_floor + on_tube > 0.98 && on_floor + on_tube < 1.02);
            dem_wall_remove(world, tube);
            printf("          the tube is taken away\n");
        }
    }
    if (dem_vtp_write(world, "pile.vtp") != DEM_OK) { puts(dem_world_error(world)); return 1; }
    dem_world_report(world, stdout);                                /* what was simulated, and its price */

    dem_balance balance = dem_balance_get(world);
    wrong += !(on_floor > 0.99 && on_floor < 1.01) || balance.present != (uint64_t)count;
    dem_replay_close(film);                                         /* without --replay there is none */
    dem_world_destroy(world);
    return wrong;
}
