/* 05_silo.c - lesson 5: a silo. You learn: loads on walls; a fit with error bars.

   Build:     cc -O2 -o 05_silo 05_silo.c ../dem.c -lm      (in the folder examples)
   Run:       ./05_silo or, with a replay of the highest column and its loads, ./05_silo --replay
   Question:  A tube is filled with beads, up to three diameters high. Water that is twice as high presses twice as
              hard on the floor. And beads? Draw the load on the floor against the height, then run. */
#include "../dem.h"
#include "lesson.h"

enum { HEIGHTS = 4, SEEDS = 3 };
static const double R = 2e-3, D = 24e-3, mu = 0.4, g = 9.81, pi = 3.14159265;   /* m, beads; m, tube; -; m/s2 */
typedef struct column { double height, floor, wall, weight, overlap; } column;   /* m, N, N, N, radii */

static double janssen(double rho_b, double K, double H) {
    const double lambda = D/(4*mu*K);
    return rho_b*g*pi*D*D/4*lambda*(1 - exp(-H/lambda));
}
/* Fills the tube with beads and measures them at rest. Returns 1 if the run failed. */
static int fill(int count, int seed, int record, column *out) {
    dem_world_desc desc = DEM_WORLD_DESC;
    desc.gravity.z = -g;
    dem_world *world = dem_world_create(&desc);
    dem_material_desc glass_desc = DEM_MATERIAL_DESC;
    glass_desc.density = 2500;                                      /* kg/m3 */
    glass_desc.young = 6e6;                                         /* Pa, softened */
    glass_desc.poisson = 0.25;
    glass_desc.restitution = 0.3;
    glass_desc.friction = mu;
    dem_material glass = dem_material_add(world, &glass_desc);
    dem_vec3 origin = dem_vec3_make(0, 0, 0), up = dem_vec3_make(0, 0, 1);
    dem_wall floor = dem_wall_plane_add(world, glass, origin, up);
    dem_wall tube = dem_wall_cylinder_add(world, glass, origin, up, D/2, 1);    /* 1: beads are inside */
    dem_motion drawn = DEM_MOTION;
    drawn.kind = DEM_MOTION_TRANSLATING;
    drawn.velocity.z = 0.01;                                        /* m/s */
    dem_wall_motion_set(world, tube, &drawn);
    dem_region box = dem_region_make(dem_box_make(-D/2, -D/2, 0, D/2, D/2, 0.006 + count*3e-4));
    if (dem_spheres_fill(world, glass, R, box, count, (uint64_t)seed) < count) puts(dem_world_error_get(world));

    dem_replay_desc replay_desc = DEM_REPLAY_DESC;
    replay_desc.interval = 0.005;                                   /* s */
    dem_replay *replay = record ? dem_replay_open(world, "05_silo.html", &replay_desc) : 0;
    dem_wall_loads below, around;
    for (int i = 0; i < 70; i++) {                                  /* means after 0.25 s: all is at rest */
        if (i == 50) dem_wall_loads_reset(world, floor), dem_wall_loads_reset(world, tube);
        if (i == 50) dem_overlap_max_reset(world);
        if (dem_world_run(world, 0.005, 0, 0) != DEM_OK) { puts(dem_world_error_get(world)); return 1; }
        dem_wall_loads_get(world, floor, &below);
        dem_wall_loads_get(world, tube, &around);
        dem_replay_value_set(replay, "load on the floor (N)", -below.force.z);
        dem_replay_value_set(replay, "load on the wall (N)", -around.force.z);
    }
    dem_totals totals = dem_totals_get(world);
    out->height = 2*totals.centre[2];                               /* twice the height of the centre of mass */
    out->floor = -below.impulse[2]/below.time;                      /* means: the force of one step oscillates */
    out->wall = -around.impulse[2]/around.time;
    out->weight = g*totals.mass;
    out->overlap = dem_counters_get(world).overlap_max;
    dem_replay_close(replay);
    dem_world_destroy(world);
    return 0;
}

int main(int argc, char **argv) {
    const int record = lesson_begin(argc, argv, "05_silo"), count[HEIGHTS] = {75, 150, 300, 450};
    double height[HEIGHTS], weight[HEIGHTS], load[HEIGHTS], error[HEIGHTS], worst = 0, overlap = 0;
    for (int i = 0; i < HEIGHTS; i++) {
        double loads[SEEDS];
        height[i] = weight[i] = 0;
        for (int seed = 0; seed < SEEDS; seed++) {                  /* three fillings, for an error bar */
            column c;
            if (fill(count[i], seed + 1, record && i == HEIGHTS - 1 && !seed, &c)) return 1;
            loads[seed] = c.floor;
            height[i] += c.height/(double)SEEDS;
            weight[i] += c.weight/(double)SEEDS;
            worst = fmax(worst, fabs((c.floor + c.wall)/c.weight - 1));
            overlap = fmax(overlap, c.overlap);
        }
        load[i] = lesson_mean(loads, SEEDS, &error[i]);
    }
    const double rho_b = weight[HEIGHTS - 1]/(g*pi*D*D/4*height[HEIGHTS - 1]);  /* kg/m3, bulk density */
    double K = 0, least = 1e300;
    for (double k = 0.1; k < 1.5; k += 0.001) {                     /* least squares: one K for all heights */
        double sum = 0;
        for (int i = 0; i < HEIGHTS; i++) sum += pow(load[i] - janssen(rho_b, k, height[i]), 2);
        if (sum < least) { least = sum; K = k; }
    }
    for (int i = 0; i < HEIGHTS; i++) {
        char name[64];
        snprintf(name, sizeof name, "H/D %.2f, weight %.4f N: floor [N]", height[i]/D, weight[i]);
        lesson_row(name, load[i], error[i], janssen(rho_b, K, height[i]), 12);
    }
    lesson_range("K, horizontal over vertical pressure", K, 0, 0.3, 1);
    lesson_range("load on the floor over weight, highest column", load[HEIGHTS - 1]/weight[HEIGHTS - 1], 0, 0.2, 0.45);
    lesson_claim("floor and wall together carry the weight within 1 %", worst < 0.01);
    lesson_range("largest overlap [radii]", overlap, 0, 0, 0.05);
    return lesson_end();
}

/* STOP: answer the question before you read on.
   Theory:    Janssen 1895. Beads rub against the wall, so each layer passes part of its weight to the wall. Let the
              horizontal pressure be K times the vertical one, and let friction mu act in full. With the bulk density
              rho_b and the diameter D the floor carries
                  W = rho_b g (pi D^2/4) lambda (1 - exp(-H/lambda)),   lambda = D/(4 mu K):
              never more than the weight of a column of height lambda. Friction points up only while beads move down
              along the wall, so the tube moves up slowly during the whole run.
   Output:    loads on the floor at four heights, within 12 % of the formula with one fitted K between 0.3 and 1 */
/* Exercises for ./05_silo --check N VALUE. {2: 1 to 3 by 0.1} is 2 or, for --seed NAME, in that range. */
const char *const exercises[2] = {
    "A very high column of wheat: D = {1: 0.5 to 2 by 0.1} m, rho_b = {800: 600 to 900 by 10} kg/m3, "
    "K = {0.5: 0.3 to 0.7 by 0.05}, mu = {0.6: 0.3 to 0.7 by 0.05}. What does the floor carry, in N?",
    "At which H/D does the floor carry half of the weight if mu = {0.4: 0.3 to 0.7 by 0.05}, "
    "K = {0.5: 0.3 to 0.7 by 0.05}?"};
/* Marking. Stop here if you want to find the answers yourself. */
double answer(int exercise, const double *x) {
    double s = 1;                                                   /* H/lambda: (1 - exp(-s))/s = 1/2 */
    for (int i = 0; i < 60; i++) s = 2*(1 - exp(-s));
    return exercise == 1 ? x[1]*9.81*pi/4*pow(x[0], 3)/(4*x[3]*x[2]) : s/(4*x[0]*x[1]);
}
