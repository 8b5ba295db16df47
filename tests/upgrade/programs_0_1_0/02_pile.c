/* 02_pile.c - beads settle in a tube, the tube is taken away, and they slump into a heap.

   Beads of three sizes, with friction and rolling friction (without the latter spheres on a smooth floor
   run apart). The force on the floor is read from the channels of the wall, averaged over a while. In the
   tube part of the weight hangs on the wall by friction (Janssen); without it the floor carries it all.

   Build:     cc -O2 02_pile.c -lm
   Expected:  the floor's mean force equals the weight within 1 %; pile.vtp opens in ParaView */
#define DEM_IMPLEMENTATION
#include "../dem.h"

int main(void) {
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
    dem_wall tube = dem_cylinder_add(world, glass, origin, up, 0.0115, 1);

    /* three fillings of one box inside the tube: the later ones find what room the earlier ones left */
    dem_box box = dem_box_make(-0.008, -0.008, 0, 0.008, 0.008, 0.06);  /* m */
    int count = dem_spheres_fill(world, glass, 2.0e-3, box, 100, 1);
    count += dem_spheres_fill(world, glass, 1.5e-3, box, 100, 2);
    count += dem_spheres_fill(world, glass, 1.0e-3, box, 100, 3);
    double weight = 9.81*dem_totals_get(world).mass;                /* N */
    printf("%d beads, %.4f N\n", count, weight);

    printf("time [s]  kinetic energy [J]  centre of mass [mm]  floor's force/weight\n");
    double ratio = 0;
    for (int i = 1; i <= 8; i++) {
        dem_channels channels;
        dem_wall_channels_reset(world, ground);
        if (dem_world_run(world, 0.1, 0, 0) != DEM_OK) { puts(dem_world_error(world)); return 1; }
        dem_wall_channels(world, ground, &channels);
        dem_totals totals = dem_totals_get(world);
        ratio = -channels.impulse[2]/channels.time/weight;          /* the force on the floor points down */
        printf("%8.2f  %18.3e  %19.3f  %20.4f\n", dem_world_time(world),
               totals.kinetic + totals.rotational, 1e3*totals.centre[2], ratio);
        if (i == 3) {
            dem_wall_remove(world, tube);
            printf("          the tube is taken away\n");
        }
    }
    if (dem_vtp_write(world, "pile.vtp") != DEM_OK) { puts(dem_world_error(world)); return 1; }
    dem_world_report(world, stdout);                                /* what was simulated, and its price */

    dem_balance balance = dem_balance_get(world);
    int wrong = !(ratio > 0.99 && ratio < 1.01) || balance.present != (uint64_t)count;
    dem_world_destroy(world);
    return wrong;
}
