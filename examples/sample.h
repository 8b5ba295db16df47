/* sample.h - samples for tests of materials in periodic cells: shear.c, triaxial.c and oedometer.c share it. Include it after
   dem.h and study.h. Spheres of diameter SAMPLE_D with radii that differ by 10 %, of glass but softer. */
#ifndef SAMPLE_H
#define SAMPLE_H
static const double SAMPLE_D = 1e-3, SAMPLE_DENSITY = 2500, SAMPLE_PI = 3.14159265358979;          /* m, kg/m3 */

/* A loose cell (solid fraction 0.3) whose sides x and z are those of a cube at a solid fraction of 0.58. walls: planes bound
   it along y, wall 1 below and wall 2 above; else it is periodic along all axes. */
STUDY_FN dem_world *sample_make(int grains, double young, double friction, int walls, dem_material *m) {
    const double volume = grains*SAMPLE_PI*SAMPLE_D*SAMPLE_D*SAMPLE_D/6, side = cbrt(volume/0.58);
    const dem_real w = (dem_real)side, h = (dem_real)(volume/0.3/side/side);
    const dem_world_desc desc = {.domain = {{0, 0, 0}, {w, h, w}}, .impact_speed = DEM_R(0.1), .boundary =
        {DEM_BOUNDARY_PERIODIC, walls ? DEM_BOUNDARY_OPEN : DEM_BOUNDARY_PERIODIC, DEM_BOUNDARY_PERIODIC}};
    const dem_material_desc stuff = {.density = (dem_real)SAMPLE_DENSITY, .young = (dem_real)young, .poisson = DEM_R(0.3),
                                     .restitution = DEM_R(0.7), .friction = (dem_real)friction};
    const dem_sizes sizes = {.min = (dem_real)(0.45*SAMPLE_D), .max = (dem_real)(0.55*SAMPLE_D)};
    dem_world *world = dem_world_create(&desc);
    *m = dem_material_add(world, &stuff);
    if (walls) {
        dem_wall_plane_add(world, *m, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 1, 0));
        dem_wall_plane_add(world, *m, dem_vec3_make(0, h, 0), dem_vec3_make(0, -1, 0));
    }
    if (dem_sizes_fill(world, *m, &sizes, dem_region_make(desc.domain), grains, 1) < grains)
        study_fail("%s", dem_world_error_get(world));
    return world;
}
/* Runs the world, and deforms its cell as `d` says from now on (null: as before). */
STUDY_FN void sample_run(dem_world *world, const dem_cell_desc *d, double seconds) {
    if (study.failures) return;
    if ((d && dem_cell_set(world, d) != DEM_OK) || dem_world_run(world, seconds, 0, 0) != DEM_OK)
        study_fail("%s", dem_world_error_get(world));
}
/* Averages the stress over `seconds`, in 200 samples: mean[0] shear stress -xy, [1] stress yy, [2] mean of xx, yy and zz, Pa,
   [3] solid fraction, [4] stress zz. Returns the standard error of mean[0]/mean[2], from ten blocks. */
STUDY_FN double sample_average(dem_world *world, double seconds, double mean[5]) {
    double block[2] = {0, 0}, ratio = 0, square = 0;
    mean[0] = mean[1] = mean[2] = mean[3] = mean[4] = 0;
    for (int n = 0; n < 200; n++) {
        dem_stress s;
        sample_run(world, 0, seconds/200);
        if (study.failures || dem_stress_get(world, &s) != DEM_OK) return 0;
        const double p = (s.total[0] + s.total[1] + s.total[2])/3;
        mean[0] -= s.total[3]/200; mean[1] += s.total[1]/200; mean[2] += p/200; mean[3] += s.solid/200; mean[4] += s.total[2]/200;
        block[0] -= s.total[3]; block[1] += p;
        if (n%20 < 19) continue;
        ratio += block[0]/block[1]/10;
        square += block[0]/block[1]*block[0]/block[1]/10;
        block[0] = block[1] = 0;
    }
    return sqrt(fmax(square - ratio*ratio, 0)/9);
}
#endif
