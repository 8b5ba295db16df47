/* sweep.c - a parameter study on all cores: the angle of repose of a heap of discs over their friction, for two rolling
   resistances, each point the mean of several heaps with its standard error.

   Build:     make build/sweep, or cc -O2 -o sweep sweep.c ../dem.c -lm      (in the folder examples)
   Run:       ./sweep --seeds 4, or the same again after an interruption: heaps whose row is in the CSV are not run again
   Output:    sweep.csv, one row per heap; sweep.svg, the curves with error bars */
#include "../dem.h"
#include "study.h"

/* A case: pours a column of 120 discs of two sizes between two walls, lifts the walls, and measures the slope of the
   heap that remains. parameter: friction, rolling resistance, seed; result: angle (degrees), grains in the heap. */
static int heap(const double *parameter, double *result, void *user) {
    const double R = 0.005, half = 0.03;                                /* m: radius; half the width of the column */
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.planar = 1;
    desc.thickness = (dem_real)0.01;                                    /* m */
    desc.gravity.y = (dem_real)-9.81;                                   /* m/s2 */
    desc.threads = 1;
    dem_world *world = dem_world_create(&desc);
    dem_material_desc wood_desc = DEM_MATERIAL_DESC;
    wood_desc.density = 700;                                            /* kg/m3 */
    wood_desc.young = (dem_real)3e6;                                    /* Pa, softened */
    wood_desc.poisson = (dem_real)0.3;
    wood_desc.restitution = (dem_real)0.3;
    wood_desc.friction = (dem_real)parameter[0];
    wood_desc.rolling_friction = (dem_real)parameter[1];
    const dem_material wood = dem_material_add(world, &wood_desc);
    wood_desc.friction = (dem_real)0.8;                                 /* a rough floor: the heap does not spread on it */
    wood_desc.rolling_friction = (dem_real)0.3;
    const dem_material floor = dem_material_add(world, &wood_desc);
    dem_wall_plane_add(world, floor, dem_vec3_make(0, 0, 0), dem_vec3_make(0, 1, 0));
    dem_real corners[8] = {(dem_real)-half, 0, (dem_real)-half, (dem_real)0.4, (dem_real)half, 0, (dem_real)half, (dem_real)0.4};
    int32_t sides[4] = {0, 1, 2, 3};
    dem_profile sheets = {4, 2, corners, sides};
    const dem_wall column = dem_wall_profile_add(world, wood, &sheets, DEM_EDGE_RESOLVED);
    int placed = 0;
    for (int k = 0; k < 2; k++)
        placed += dem_spheres_fill(world, wood, (dem_real)(k ? 0.8*R : R), dem_region_make(dem_box_make((dem_real)-half, 0, 0,
                                   (dem_real)half, (dem_real)0.39, 0)), 60, (uint64_t)(2*parameter[2] + k));
    dem_motion up = DEM_MOTION;
    up.kind = DEM_MOTION_TRANSLATING;
    up.velocity.y = (dem_real)0.3;                                      /* m/s */
    up.start = 0.3;                                                     /* s: when all have fallen */
    dem_wall_motion_set(world, column, &up);
    dem_repose slope;
    int bad = placed != 120 || dem_world_run(world, 1.2, 0, 0) != DEM_OK ||
        dem_repose_heap_get(world, dem_box_make(0, 0, 0, 0, 0, 0), &slope) != DEM_OK;
    if (bad) fprintf(stderr, "friction %g, seed %g, %d discs: %s\n", parameter[0], parameter[2], placed, dem_world_error_get(world));
    else {
        result[0] = slope.angle*180/3.14159265358979;
        result[1] = slope.places;
    }
    (void)user;
    dem_world_destroy(world);
    return bad;
}

int main(int argc, char **argv) {
    enum { FRICTIONS = 5, ROLLINGS = 2, SEEDS = 32 };
    static const double friction[FRICTIONS] = {0.1, 0.2, 0.3, 0.5, 0.8}, rolling[ROLLINGS] = {0.05, 0.3};
    static const char *const names[ROLLINGS] = {"rolling resistance 0.05", "rolling resistance 0.3"};
    static double parameter[FRICTIONS*ROLLINGS*SEEDS*3], result[FRICTIONS*ROLLINGS*SEEDS*2];
    double mean[ROLLINGS][FRICTIONS], error[ROLLINGS][FRICTIONS];
    int seeds = 4, jobs = 0;
    const char *out = "build/sweep_results";
    const study_option table[] = {
        {"seeds", STUDY_INT, &seeds, 2, SEEDS, "", "heaps per point"},
        {"jobs", STUDY_INT, &jobs, 0, 256, "", "processes at a time; 0: one per core"},
        {"out", STUDY_TEXT, &out, 0, 0, "", "folder of the results"}};
    study_options(argc, argv, "angle of repose of discs over friction", table, 3);
    study_begin(out);
    study_sweep sweep = {"sweep.csv", "friction,rolling,seed,angle_deg,places", FRICTIONS*ROLLINGS*seeds, 3, 2, parameter, heap, 0, jobs};
    for (int i = 0; i < sweep.cases; i++) {
        parameter[3*i] = friction[i/seeds%FRICTIONS];
        parameter[3*i + 1] = rolling[i/seeds/FRICTIONS];
        parameter[3*i + 2] = i%seeds;
    }
    study_sweep_run(&sweep, result);
    study_figure figure = {0};
    figure.x1 = 0.9;
    figure.title = "Angle of repose of discs";
    figure.x_label = "friction between discs";
    figure.y_label = "angle of repose (degrees)";
    for (int r = 0; r < ROLLINGS; r++) {
        for (int f = 0; f < FRICTIONS; f++)
            mean[r][f] = study_mean(result + 2*(r*FRICTIONS + f)*seeds, seeds, 2, &error[r][f]);
        study_curve(&figure, names[r], STUDY_LINE, FRICTIONS, friction, mean[r]);
        study_bars(&figure, FRICTIONS, friction, mean[r], error[r]);
        study_result(r ? "angle_rough" : "angle_smooth", mean[r][3], "degrees");        /* at friction 0.5 */
        study_result(r ? "angle_rough_error" : "angle_smooth_error", error[r][3], "degrees");
    }
    study_figure_write(&figure, "sweep.svg");
    return study_end();
}
