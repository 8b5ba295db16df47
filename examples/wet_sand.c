/* wet_sand.c - how much water does a sand castle need?

   Sand fills a mould and contains a little water; then the mould is removed. Dry sand collapses. In wet sand a liquid bridge
   attracts any two grains that have touched, with the force 2 pi R g cos t in contact (surface tension g, contact angle t),
   until they are (1 + t/2) V^(1/3) apart. This is a law with a range: examples/laws/capillary.h has source and limits.

   Question:  In contact the force of a bridge does not depend on its volume. Is a castle with a hundred times as much water in
              every bridge stronger? Can a castle be made of gravel? (The force is proportional to R, the weight to R^3.)
   Build:     cc -O2 -o wet_sand wet_sand.c ../dem.c -lm      (in the folder examples)
   Output:    dry sand, and gravel with the most water, keep less than 0.3 of their height. The more water sand has, the more
              it keeps: above 0.7 with 0.01 R^3 per bridge. A bridge that extends farther takes more work to break. wet.vtp
              is for ParaView. About 17 s on one core
   Exercises: Which of surface tension, angle and volume makes a castle of 4 mm gravel possible? Up to which R does water hold
              a castle? */
#include "../dem.h"
#include "laws/capillary.h"

/* Removes a mould of radius 6 R from grains of radius R (m) with bridges of the volume water R^3 (0: dry). Returns the final
   height of the centre of mass over that in the mould; -1: the run failed. */
static double castle(double R, double water, const char *picture) {
    capillary bridge = {0.073, 0.3, 1};                             /* N/m, rad: water; volume below */
    dem_world_desc desc = DEM_WORLD_DESC;
    dem_vec3 origin = dem_vec3_make(0, 0, 0), up = dem_vec3_make(0, 0, 1);
    double fall = sqrt(2*12*R/9.81), before, after;                 /* s, over the height of the heap */
    bridge.volume = (dem_real)(water > 0 ? water*R*R*R : 1e-30);
    if (!(water > 0)) bridge.tension = 0;
    desc.gravity.z = -9.81;
    desc.law = capillary_law;
    desc.law_user = &bridge;
    desc.law_memory = 5;
    desc.law_vectors = 1;
    desc.law_range = (dem_real)(1.1*capillary_rupture(&bridge));    /* beyond rupture, where the law ends a bridge */
    dem_world *world = dem_world_create(&desc);

    dem_material_desc sand_desc = DEM_MATERIAL_DESC;
    sand_desc.density = 2500;
    sand_desc.young = (dem_real)(5e9*R);                           /* Pa, proportional to R: equal relative overlaps */
    sand_desc.poisson = 0.25;
    sand_desc.restitution = 0.4;
    sand_desc.friction = 0.5;
    dem_material sand = dem_material_add(world, &sand_desc);
    dem_wall_plane_add(world, sand, origin, up);
    dem_wall mould = dem_wall_cylinder_add(world, sand, origin, up, (dem_real)(6*R), 1);
    dem_region inside = {0};
    inside.box = dem_box_make((dem_real)(-6*R), (dem_real)(-6*R), 0, (dem_real)(6*R), (dem_real)(6*R), (dem_real)(40*R));
    inside.cylinder = 'z';
    dem_spheres_fill(world, sand, (dem_real)R, inside, 250, 1);

    if (dem_world_run(world, 3*fall, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return -1; }
    before = dem_totals_get(world).centre[2];
    dem_wall_remove(world, mould);
    if (dem_world_run(world, 3*fall, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return -1; }
    after = dem_totals_get(world).centre[2];
    if (picture && dem_vtp_write(world, picture) != DEM_OK) puts(dem_world_error_get(world));
    dem_world_destroy(world);
    return after/before;
}

int main(void) {
    static const struct { const char *what; double R, water; const char *picture; } rows[] = {
        {"sand, dry", 5e-4, 0, 0}, {"sand, bridges of 1e-6 R^3", 5e-4, 1e-6, 0},
        {"sand, bridges of 1e-4 R^3", 5e-4, 1e-4, 0}, {"sand, bridges of 1e-2 R^3", 5e-4, 1e-2, "wet.vtp"},
        {"gravel, bridges of 1e-2 R^3", 4e-3, 1e-2, 0}};
    double last = 0;
    int k, wrong = 0;
    printf("%-32s  final height over height in the mould\n", "");
    for (k = 0; k < 5; k++) {
        const double kept = castle(rows[k].R, rows[k].water, rows[k].picture);
        printf("%-32s  %.2f\n", rows[k].what, kept);
        wrong += !(k < 4 ? kept > last : kept > 0) || (k%4 == 0 && kept > 0.3) || (k == 3 && kept < 0.7);
        last = kept;
    }
    return wrong;
}
